// SPDX-License-Identifier: GPL-3.0-or-later
// Work against precision: what rigid bodies make of a building that stands, and what it costs.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/hybrid_bench.hpp"
#include "bench/report.hpp"
#include "bench/standing_precision.hpp"
#include "sim/frame_solver.hpp"
#include "sim/step_times.hpp"

namespace sunder {
namespace {

constexpr double kFrame = 1.0 / 60, kAtRest = 3, kMean = 0.5;  // s

}  // namespace

Truth truth_of(const Frame& frame) {
  FrameSolver solver(frame);
  solver.solve({});
  Truth truth;
  const Assembly assembly = assembly_of(frame);
  for (const Assembly::Top& top : assembly.tops)
    truth.sag -= solver.displacement(frame.members[top.part].to).y /
                 static_cast<double>(assembly.tops.size());
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const bool is_foot = frame.joints[j].b == kNoPart;
    const bool is_beam = frame.joints[j].kind == FrameJoint::Kind::beam_end;
    truth.foot.push_back(is_foot ? solver.reaction(j).y : 0);
    truth.moment.push_back(is_beam ? solver.joint_load(j).torque.y : 0);
    truth.largest_moment = std::max(truth.largest_moment, std::fabs(truth.moment.back()));
  }
  return truth;
}

namespace {

/// Errors of feet and beam ends, from sums of reactions.
void note_errors(const Frame& frame, const Truth& truth, const std::vector<PartReaction>& sums,
                 double count, RigidStanding& found) {
  double squares = 0, beams = 0;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const FrameJoint& joint = frame.joints[j];
    if (joint.b == kNoPart)
      found.foot = std::max(found.foot,
                            std::fabs((joint.axes * sums[j].force).y / count / truth.foot[j] - 1));
    if (joint.kind != FrameJoint::Kind::beam_end) continue;
    const double side = joint.end_a == 1 ? 1 : -1;
    const double off = (side * sums[j].torque.y / count - truth.moment[j]) / truth.largest_moment;
    found.moment = std::max(found.moment, std::fabs(off));
    squares += off * off;
    ++beams;
  }
  found.rms = std::sqrt(squares / beams);
}

Projectile ball() {
  Projectile p;
  p.radius = 0.3;
  p.mass = 888;
  p.position = {-1, 1.9, 12.05};
  p.velocity = {40, 0, 0};
  return p;
}

}  // namespace

RigidStanding stand(const Frame& frame, const Truth& truth, const Method& method, double budget_s) {
  const Assembly assembly = assembly_of(frame);
  const auto world = frame_world(assembly, method);
  const int steps = static_cast<int>(std::lround(kAtRest / method.step));
  const int taken = static_cast<int>(std::lround(kMean / method.step));
  std::vector<double> rest, rings;
  std::vector<PartReaction> sums(assembly.joints.size());
  double used = 0, count = 0;
  for (int i = 0; i < steps && used < 1e3 * budget_s; ++i) {
    rest.push_back(step_once(*world, method, i));
    used += rest.back();
    const bool is_last = i + 1 == steps || used >= 1e3 * budget_s;
    if (i < steps - taken && !is_last) continue;
    ++count;
    for (std::uint32_t j = 0; j < sums.size(); ++j) {
      const PartReaction now = world->reaction(j);
      sums[j].force = sums[j].force + now.force;
      sums[j].torque = sums[j].torque + now.torque;
    }
  }
  RigidStanding found;
  for (const Assembly::Top& top : assembly.tops)
    found.sag += (top.stood.y - world->place(top.part, top.stood).y) /
                 static_cast<double>(assembly.tops.size());
  note_errors(frame, truth, sums, count, found);
  found.rest_ms = percentile(rest, 0.5);
  found.rest_least = percentile(rest, 0.05);
  found.rest_most = percentile(rest, 0.95);
  found.steps = static_cast<double>(rest.size());
  found.failures = static_cast<double>(world->fallbacks());
  if (used >= 1e3 * budget_s) return found;
  world->add_ball(ball());
  for (int i = 0; i < taken; ++i) rings.push_back(step_once(*world, method, steps + i));
  found.hit_ms = percentile(rings, 0.5);
  return found;
}

namespace {

void print_rigid(const Size& size, const Frame& frame, const Truth& truth, const Method& method) {
  const RigidStanding r = stand(frame, truth, method);
  std::printf(
      "| %s | %s | %d | 1/%.0f s | %.3g (%+.3g) | %.0f %% | %.0f %% / %.0f %% | %.3g | %.3g |\n",
      name_of(size).c_str(), name_of(method).c_str(), method.iterations, 1 / method.step,
      1e3 * r.sag, 1e3 * (r.sag - truth.sag), 100 * r.foot, 100 * r.moment, 100 * r.rms, r.rest_ms,
      r.hit_ms);
  std::fflush(stdout);
}

void print_hybrid(const Size& size, const Frame& frame, const Truth& truth, double step) {
  Standing standing(frame, step);
  standing.judge();
  const auto steps = [&](int count) {
    std::vector<double> ms;
    for (int i = 0; i < count; ++i)
      ms.push_back(cost_ms([&] {
        standing.step();
        standing.judge();
      }));
    return percentile(ms, 0.5);
  };
  steps(5);
  const double rest = steps(240);
  standing.break_joints(beam_joints(frame, 1, false));
  const double rings = steps(60);
  std::printf("| %s | hybrid | – | 1/%.0f s | %.4g (the reference) | – | – | %.2g | %.3g |\n",
              name_of(size).c_str(), 1 / step, 1e3 * truth.sag, rest, rings);
}

}  // namespace

void measure_precision() {
  const Block block("hybrid precision");
  std::printf(
      "| building | method | iterations | step | mean sag mm (off) "
      "| worst foot off | beam ends' moments off by the largest: worst / rms | standing ms a step "
      "| "
      "hit or ringing ms a step |\n|---|---|---|---|---|---|---|---|---|\n");
  using enum Method::Engine;
  for (const Size& size : {Size{3, 3, 12}, Size{4, 5, 6}}) {
    const Frame frame = building_of(size);
    const Truth truth = truth_of(frame);
    for (const int iterations : {10, 50, 200, 1000}) {
      if (iterations == 1000 && size.x > 3) continue;  // as wrong, at five times the cost
      print_rigid(size, frame, truth, {.engine = bullet, .iterations = iterations, .step = kFrame});
    }
    print_rigid(size, frame, truth, {.engine = cold, .iterations = 200, .step = kFrame});
    print_rigid(size, frame, truth, {.engine = warm, .iterations = 50, .step = kFrame});
    print_rigid(size, frame, truth, {.engine = warm, .iterations = 30, .step = 1.0 / 240});
    print_hybrid(size, frame, truth, kFrame);
    print_hybrid(size, frame, truth, 1.0 / 240);
  }
}

}  // namespace sunder
