// SPDX-License-Identifier: GPL-3.0-or-later
// What a step costs: standing, hit, ringing, with debris; beside Bullet in the same run.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "bench/collapse_accuracy.hpp"
#include "bench/hybrid_bench.hpp"
#include "bench/report.hpp"
#include "sim/frame_solver.hpp"
#include "sim/step_times.hpp"

namespace sunder {
namespace {

constexpr double kFrame = 1.0 / 60;  // s
constexpr std::size_t kBroken = 10;

struct Line {
  std::string what;
  std::vector<double> ms;
};

void print(const Size& size, const Line& line, double bullet) {
  const double median = percentile(line.ms, 0.5);
  std::printf("| %s | %s | %.3g | %.3g | %.3g | %.3g | %.3g |\n", name_of(size).c_str(),
              line.what.c_str(), percentile(line.ms, 0), median, percentile(line.ms, 0.95),
              percentile(line.ms, 1), bullet / median);
  std::fflush(stdout);
}

Line time_rigid(const Frame& frame, const Method& method, int steps) {
  const Assembly assembly = assembly_of(frame);
  const auto world = frame_world(assembly, method);
  Line line{name_of(method) + ", " + std::to_string(method.iterations) + " iterations, 1/" +
                std::to_string(std::lround(1 / method.step)) + " s, standing",
            {}};
  // Later than the first few, which iterate more.
  for (int i = 10; i < 10 + steps; ++i) line.ms.push_back(step_once(*world, method, i));
  return line;
}

/// What the frame solver does in the step of a hit: update, solve, all loads judged.
Line time_solver(const Frame& frame, int runs) {
  Line line{"hit: solver alone, 10 joints broken, all loads judged", {}};
  const std::vector<std::uint32_t> joints = beam_joints(frame, kBroken, false);
  std::vector<std::uint8_t> intact(frame.joints.size(), 1);
  for (const std::uint32_t j : joints) intact[j] = 0;
  double largest = 0;
  for (int i = 0; i < runs; ++i) {
    FrameSolver solver(frame);
    solver.solve({});
    line.ms.push_back(cost_ms([&] {
      solver.break_joints(joints);
      solver.solve({});
      for (std::uint32_t j = 0; j < intact.size(); ++j)
        if (intact[j] != 0)
          largest =
              std::max(largest, utilisation(solver.joint_load(j), frame.joints[j].strength).total);
    }));
  }
  return line;
}

Line time_start(const Frame& frame, int runs) {
  Line line{"start-up: factor, solve, all loads; colliders", {}};
  for (int i = 0; i < runs; ++i)
    line.ms.push_back(cost_ms([&] {
      Standing standing(frame, kFrame);
      standing.judge();
    }));
  return line;
}

std::vector<double> timed_steps(Standing& standing, int steps) {
  std::vector<double> ms;
  for (int i = 0; i < steps; ++i)
    ms.push_back(cost_ms([&] {
      standing.step();
      standing.judge();
    }));
  return ms;
}

/// The hit as the run has it: for the first one what rings is factored ahead, if there was time.
std::vector<Line> time_hits(const Frame& frame, int runs) {
  Line first{"hit: whole step, 10 joints, first, factored ahead", {}},
      at_once{"hit: whole step, 10 joints, first, with the factor of what rings", {}},
      later{"hit: whole step, 10 joints, while it rings", {}}, rings{"rings, nothing breaks", {}};
  const std::vector<std::uint32_t> joints = beam_joints(frame, kBroken, false);
  const std::vector<std::uint32_t> others = beam_joints(frame, 30, false);
  std::vector<std::uint32_t> next;
  std::ranges::set_difference(others, joints, std::back_inserter(next));
  next.resize(kBroken);
  for (int i = 0; i < runs; ++i) {
    Standing standing(frame, kFrame, true, true), other(frame, kFrame);
    const auto hit = [&](Standing& building, const std::vector<std::uint32_t>& broken) {
      return cost_ms([&] {
        building.step();
        building.break_joints(broken);
        building.judge();
      });
    };
    standing.judge();
    other.judge();
    wait_for_threads();
    first.ms.push_back(hit(standing, joints));
    at_once.ms.push_back(hit(other, joints));
    const std::vector<double> steps = timed_steps(standing, 10);
    rings.ms.insert(rings.ms.end(), steps.begin(), steps.end());
    later.ms.push_back(hit(standing, next));
  }
  return {first, at_once, later, rings};
}

/// Every joint of the parts nearest to the roof's corner breaks: they fall on the floors below.
Line time_debris(const Frame& frame, double step, std::size_t parts) {
  const std::vector<PartSolid> solids = solids_of(frame);
  Vec3 corner;
  for (const FrameNode& node : frame.nodes) corner.y = std::max(corner.y, node.position.y);
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::uint32_t part = 0; part < solids.size(); ++part)
    order.push_back({length(solids[part].centre - corner), part});
  std::ranges::sort(order);
  std::vector<std::uint8_t> falls(solids.size(), 0);
  for (std::size_t i = 0; i < parts; ++i) falls[order[i].second] = 1;
  std::vector<std::uint32_t> joints;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    if (falls[frame.joints[j].a] != 0 ||
        (frame.joints[j].b != kNoPart && falls[frame.joints[j].b] != 0))
      joints.push_back(j);
  Standing standing(frame, step);
  standing.break_joints(joints);
  Line line;
  line.ms = timed_steps(standing, static_cast<int>(1 / step));
  line.what = "debris: " + std::to_string(standing.motion().bodies()) + " pieces, 1 s, 1/" +
              std::to_string(std::lround(1 / step)) + " s";
  return line;
}

void measure(const Size& size, std::size_t debris, int runs) {
  const Frame frame = building_of(size);
  const Method plain{.engine = Method::Engine::bullet, .iterations = 200, .step = kFrame};
  const Line bullet = time_rigid(frame, plain, size.x < 10 ? 60 : 4);
  const double scale = percentile(bullet.ms, 0.5);
  print(size, bullet, scale);
  print(size, time_rigid(frame, {}, size.x < 10 ? 60 : 8), scale);
  print(size, time_start(frame, runs), scale);
  {
    Standing standing(frame, kFrame);
    standing.judge();
    timed_steps(standing, 5);
    print(size, {"standing, nothing happens", timed_steps(standing, 120)}, scale);
  }
  print(size, time_solver(frame, runs), scale);
  for (const Line& line : time_hits(frame, runs)) print(size, line, scale);
  for (const double step : {kFrame, 1.0 / 240})
    print(size, time_debris(frame, step, debris), scale);
}

}  // namespace

void measure_steps() {
  const Block block("hybrid steps");
  std::printf(
      "| building | step | least ms | median ms | p95 ms | longest ms | Bullet, 200 "
      "iterations, by this (medians) |\n|---|---|---|---|---|---|---|\n");
  measure({3, 3, 12}, 26, 15);
  measure({4, 5, 6}, 64, 15);
  measure({10, 10, 30}, 362, 3);
}

}  // namespace sunder
