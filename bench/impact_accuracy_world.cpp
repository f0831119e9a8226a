// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms of rigid-body mechanics against sim/rigid_world.hpp, over steps and iterations.
#include <cstdio>
#include <functional>

#include "bench/impact_accuracy.hpp"
#include "bench/report.hpp"

namespace sunder {
namespace {

constexpr double kSteps[] = {1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 1000};

void print_rows(const AccuracyRows& rows) {
  for (const AccuracyRow& row : rows) print_accuracy_row(row);
}

/// Of each figure the worst of 10, 20 and 50 iterations.
void print_worst(const std::function<AccuracyRows(const Fineness&)>& measure) {
  std::vector<AccuracyRows> by_step;
  for (const double step : kSteps) {
    AccuracyRows most = measure({step, 10});
    for (const int iterations : {20, 50}) {
      const AccuracyRows rows = measure({step, iterations});
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].error() >= most[i].error()) most[i] = rows[i];
    }
    for (AccuracyRow& row : most) row.iterations = "10, 20, 50: worst";
    by_step.push_back(most);
  }
  for (std::size_t i = 0; i < by_step[0].size(); ++i)
    for (const AccuracyRows& rows : by_step) print_accuracy_row(rows[i]);
}

}  // namespace

void print_accuracy_header() {
  std::printf(
      "| case | quantity | step | iterations | measured | expected | error | source |\n"
      "|---|---|---|---|---|---|---|---|\n");
}

void print_accuracy_row(const AccuracyRow& row) {
  const bool relative = row.expected != 0;
  std::printf("| %s | %s | %s | %s | %.7g | %.7g | %.1e%s | %s |\n", row.name.c_str(),
              row.quantity.c_str(), row.step.c_str(), row.iterations.c_str(), row.measured,
              row.expected, relative ? row.error() : row.error() * row.scale,
              relative ? "" : " abs.", row.source.c_str());
  std::fflush(stdout);
}

void measure_rigid_world() {
  const Engine ours = our_engine();
  {
    const Block block("impact_accuracy head-on");
    print_accuracy_header();
    for (const double speed : {2.0, 20.0})
      for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 1000})
        print_rows(head_on(ours, speed, {.step = dt}));
  }
  {
    const Block block("impact_accuracy spin");
    print_accuracy_header();
    for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 1000, 1.0 / 4000})
      print_rows(free_spin(ours, {.step = dt}));
  }
  {
    const Block block("impact_accuracy tower");
    print_accuracy_header();
    for (const double dt : kSteps)
      for (const int iterations : {10, 20, 50}) print_rows(tower(ours, {dt, iterations}));
  }
  {
    const Block block("impact_accuracy heavy");
    print_accuracy_header();
    for (const double ratio : {100.0, 300.0, 1000.0})
      for (const int iterations : {20, 50, 80})
        print_rows(heavy_on_light(ours, ratio, {.iterations = iterations}));
  }
  {
    const Block block("impact_accuracy motion");
    print_accuracy_header();
    print_worst([&](const Fineness& fineness) { return plain_motion(ours, fineness); });
  }
  const Block block("impact_accuracy rocking");
  print_accuracy_header();
  for (const double dt : kSteps) print_rows(rocking(ours, {.step = dt}));
  for (const double dt : kSteps) print_rows(toppling(ours, {.step = dt}));
}

}  // namespace sunder
