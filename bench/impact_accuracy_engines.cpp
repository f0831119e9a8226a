// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies with closed forms by several engines: work against precision.
#include <cmath>
#include <ctime>
#include <functional>

#include "bench/impact_accuracy.hpp"
#include "bench/report.hpp"
#include "bench/work_precision.hpp"

namespace sunder {
namespace {

constexpr double kSteps[] = {1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480, 1.0 / 1000};
constexpr int kRuns = 3;
constexpr double kFailed = 1;  // a hundred per cent off

struct Problem {
  const char *block, *title, *error_axis, *omissions;
  double seconds;  ///< simulated
  std::function<AccuracyRows(const Engine&, const Fineness&)> run;
};

AccuracyRows rocking_and_toppling(const Engine& engine, const Fineness& fineness) {
  AccuracyRows rows = rocking(engine, fineness);
  for (const AccuracyRow& row : toppling(engine, fineness)) rows.push_back(row);
  return rows;
}

double cpu_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

WorkPoint point_of(const Problem& problem, const Engine& engine, const Fineness& fineness) {
  std::vector<double> ms;
  AccuracyRows rows;
  for (int run = 0; run < kRuns; ++run) {
    const double start = cpu_ms();
    rows = problem.run(engine, fineness);
    ms.push_back((cpu_ms() - start) / problem.seconds);
  }
  const double error = worst(rows).error();
  return {.method = text("%s, %d iterations", engine.name.c_str(), fineness.iterations),
          .knobs = text("%s, %d iterations", step_text(fineness.step).c_str(), fineness.iterations),
          .label = text("1/%.0f", 1 / fineness.step),
          .error = error,
          .time = spread_of(ms),
          .failed = !(error < kFailed)};
}

}  // namespace

void measure_engines() {
  const char* engines =
      "PhysX, Jolt and MuJoCo, which Debian does not package; shapes of other kinds; sleeping "
      "bodies. Bullet 3.24 and ODE 0.16.2 with their default settings, in double precision.";
  const Problem problems[] = {
      {"impact_accuracy work-tower", "A tower of ten cubes of 1 t stands for 10 s",
       "largest of lean by a cube's edge, speed left by √(g · 1 m), height lost, relative", engines,
       10, [](const Engine& e, const Fineness& f) { return tower(e, f); }},
      {"impact_accuracy work-rocking", "A rocking block (Housner) and a wall that topples",
       "largest relative error of times, amplitude and speed", engines, 4.2, rocking_and_toppling},
      {"impact_accuracy work-motion", "Fall, two bounces, three slopes",
       "largest relative error of ways, heights and speeds", engines, 9,
       [](const Engine& e, const Fineness& f) { return plain_motion(e, f); }},
      {"impact_accuracy work-head-on", "Ball and chunk collide head-on at 20 m/s, e = 0.5",
       "largest relative error of both speeds and the energy left", engines, 0.1,
       [](const Engine& e, const Fineness& f) { return head_on(e, 20, f); }}};
  for (const Problem& problem : problems) {
    WorkPlot plot{.block = problem.block,
                  .title = problem.title,
                  .error_axis = problem.error_axis,
                  .time_axis = "processor ms per simulated second",
                  .least_error = 1e-12,
                  .none = "< 10⁻¹²",
                  .omissions = problem.omissions,
                  .points = {}};
    for (const Engine& engine : {our_engine(), bullet_engine(), ode_engine()})
      for (const int iterations : {10, 20, 50})
        for (const double step : kSteps)
          plot.points.push_back(point_of(problem, engine, {step, iterations}));
    publish(plot);
  }
}

}  // namespace sunder
