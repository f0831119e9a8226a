// SPDX-License-Identifier: GPL-3.0-or-later
// Work against precision: a building that stands, by every solver of rigid members and by hybrid;
// and the elastic frame that rings, by its step.
#include <algorithm>
#include <cmath>
#include <functional>

#include "bench/report.hpp"
#include "bench/ringing.hpp"
#include "bench/standing_precision.hpp"
#include "bench/work_precision.hpp"
#include "sim/step_times.hpp"

namespace sunder {
namespace {

constexpr double kBudget = 2;  // s of processor time, for solvers that are too slow

struct Run {
  Method method;
  RigidStanding found;
};

std::vector<Method> methods() {
  using enum Method::Engine;
  using enum JointSolver;
  std::vector<Method> all;
  const auto add = [&](Method::Engine engine, JointSolver solver, double step,
                       std::initializer_list<int> counts, double compliance = 0) {
    for (const int count : counts) all.push_back({engine, solver, count, step, compliance, true});
  };
  for (const double step : {1.0 / 60, 1.0 / 240}) {
    add(bullet, sequential_impulse, step, {10, 50, 200, 1000});
    add(bullet, nncg, step, {10, 50, 200});
  }
  add(bullet, dantzig, 1.0 / 60, {50}, 1e-9);
  add(bullet, lemke, 1.0 / 60, {50}, 1e-9);
  add(cold, sequential_impulse, 1.0 / 60, {50, 200});
  add(warm, sequential_impulse, 1.0 / 60, {30, 50});
  add(warm, sequential_impulse, 1.0 / 240, {10, 30});
  return all;
}

/// Standing: a step, its loads judged; the start with all that has to be solved for it, spread over
/// a second.
Spread hybrid_time(const Frame& frame) {
  std::vector<double> ms;
  for (int run = 0; run < 7; ++run)
    ms.push_back(cost_ms([&] {
      Standing standing(frame, 1.0 / 60);
      standing.judge();
      for (int i = 0; i < 60; ++i) standing.step();
    }));
  return spread_of(ms);
}

/// What is plotted of a standing building, and how far off a run is in it.
struct Figure {
  const char *block, *axis;
  std::function<double(const RigidStanding&)> error;
};

WorkPlot plot_of(const Figure& figure, const std::vector<Run>& runs, const Spread& hybrid) {
  WorkPlot plot{
      .block = figure.block,
      .title = "3 × 3 posts, 2 storeys stand for 3 s from a cold start",
      .error_axis = figure.axis,
      .time_axis = "processor ms per simulated second",
      .least_error = 1e-4,
      .none = "reference",
      .omissions =
          "Bullet's featherstone joints and soft bodies, and its direct solvers without the "
          "compliance c, which fail ([table](#direct-solvers)); PhysX and Jolt, which Debian does "
          "not package (quoted in [the plot of sag](#sag-forces-and-cost-at-rest)). The reference "
          "is the frame's finite-element solution, so that hybrid, which uses it, has no error "
          "here: how far that is from CalculiX is in [a table of its own]"
          "(#irregular-frames-against-calculix). Its time is start, solution and a second of "
          "steps. Failed: over 1000 % off.",
      .points = {}};
  for (const auto& [method, found] : runs) {
    const double off = figure.error(found), steps = 1 / method.step;
    plot.points.push_back(
        {.method = name_of(method) + text(", 1/%.0f s", steps),
         .knobs = text("1/%.0f s, %d iterations", steps, method.iterations),
         .label = method.compliance > 0 ? "" : std::to_string(method.iterations),
         .error = off,
         .time = {steps * found.rest_ms, steps * found.rest_least, steps * found.rest_most},
         .failed = !(off < 10)});
  }
  plot.points.push_back(
      {.method = "hybrid", .knobs = "1/60 s", .label = "", .error = 0, .time = hybrid});
  return plot;
}

void plot_standing() {
  const Frame frame = building_of({3, 3, 2});
  const Truth truth = truth_of(frame);
  std::vector<Run> runs;
  for (const Method& method : methods())
    runs.push_back({method, stand(frame, truth, method, kBudget)});
  const Spread hybrid = hybrid_time(frame);
  const Figure figures[] = {
      {"hybrid work-sag", "mean sag of the roof, relative error",
       [&](const RigidStanding& r) { return std::fabs(r.sag / truth.sag - 1); }},
      {"hybrid work-feet", "the worst foot's force, relative error",
       [](const RigidStanding& r) { return r.foot; }},
      {"hybrid work-moments", "beam ends' moments, rms error by the largest",
       [](const RigidStanding& r) { return r.rms; }}};
  for (const Figure& figure : figures) publish(plot_of(figure, runs, hybrid));
}

void plot_ringing() {
  const RingingCase ringing({4, 5, 6}, "post_2_1_0");
  WorkPlot plot{.block = "hybrid ringing",
                .title = "4 × 5 posts, 6 storeys: a post is taken away, the frame rings for 1.5 s",
                .error_axis = "relative error against all modes of the frame",
                .time_axis = "processor ms per simulated second",
                .least_error = 1e-9,
                .omissions =
                    "rigid members, which do not ring; debris, whose motion after a "
                    "collision has no closed form; damping. Deflection: the largest, of "
                    "the node above the post; period: the time of its fourth passage "
                    "through its place at rest; moments of beams' ends and forces of feet "
                    "nearby: the largest of each, by the largest change.",
                .points = {}};
  std::vector<std::pair<double, Swinging>> runs;
  for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480, 1.0 / 1000})
    runs.push_back({step, ringing.stepped(step)});
  using Error = RingingCase::Error;
  for (const auto& [name, error] :
       {std::pair{"deflection", &Error::deflection}, std::pair{"period", &Error::period},
        std::pair{"moments", &Error::moments}, std::pair{"feet", &Error::feet}})
    for (const auto& [step, swinging] : runs)
      plot.points.push_back({.method = name,
                             .knobs = text("1/%.0f s", 1 / step),
                             .label = text("1/%.0f", 1 / step),
                             .error = ringing.error(swinging).*error,
                             .time = swinging.ms});
  publish(plot);
}

}  // namespace

void measure_work() {
  plot_standing();
  plot_ringing();
}

}  // namespace sunder
