// SPDX-License-Identifier: GPL-3.0-or-later
// Joints, posts and buildings against closed forms.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bench/collapse_accuracy.hpp"
#include "bench/report.hpp"
#include "sim/buckling.hpp"
#include "tests/sim/frames.hpp"
#include "tests/sim/plastic_blocks.hpp"

namespace sunder {
namespace {

constexpr double kGravity = 9.81;
constexpr int kPosts = 12, kBoxes = 8;
constexpr double kPostMass = 600, kPostHeight = 3.5, kBoxMass = 50, kLength = 4;

std::vector<Method> methods_of_cases() {
  using enum Method::Engine;
  std::vector<Method> methods;
  for (const Method::Engine engine : {bullet, cold})
    for (const int iterations : {10, 50, 200, 1000})
      methods.push_back({.engine = engine, .iterations = iterations, .step = 1.0 / 60});
  for (const double step : {1.0 / 60, 1.0 / 240})
    for (const int iterations : {10, 30, 200})
      methods.push_back({.engine = warm, .iterations = iterations, .step = step});
  return methods;
}

/// Load of the base joint: its mean over the second half of 10 s; descent of the top at the end.
struct Held {
  PartReaction base;
  double sag = 0;
};
Held hold(const Assembly& assembly, const Method& method) {
  const auto world = frame_world(assembly, method);
  const int steps = static_cast<int>(std::lround(10 / method.step));
  Held held;
  for (int i = 0; i < steps; ++i) {
    step_once(*world, method, i);
    if (2 * i < steps) continue;
    const PartReaction now = world->reaction(0);
    const double share = 1.0 / (steps - steps / 2);
    held.base.force = held.base.force + share * now.force;
    held.base.torque = held.base.torque + share * now.torque;
    held.base.torque_at_centre = held.base.torque_at_centre + share * now.torque_at_centre;
  }
  const Assembly::Top& top = assembly.tops.back();
  held.sag = top.stood.y - world->place(top.part, top.stood).y;
  return held;
}

void static_loads() {
  const Section post = i_section("HEB200", 0.2, 0.2, 0.009, 0.015, 0.018, "b", "c");
  const SteelGrade steel;
  double elastic = 0;
  for (int k = 0; k < kPosts; ++k)
    elastic +=
        (kPosts - k) * kPostMass * kGravity * kPostHeight / (steel.youngs_modulus * post.area);
  const double weight = kPosts * kPostMass * kGravity, shear = kBoxes * kBoxMass * kGravity;
  const double moment = shear * kLength / 2;
  const Block block("collapse_accuracy statics");
  std::printf(
      "| method | step | iterations | column: base force off %.0f N | its top sags, mm (elastic "
      "HEB200: %.2f) | cantilever: shear off %.0f N | moment off %.0f N m | torque about the "
      "body's "
      "centre, N m | tip sags, mm |\n|---|---|---|---|---|---|---|---|---|\n",
      weight, 1e3 * elastic, shear, moment);
  const Assembly column = column_of(kPosts, kPostMass, kPostHeight);
  const Assembly beam = cantilever_of(kBoxes, kBoxMass, kLength);
  for (const Method& method : methods_of_cases()) {
    const Held upright = hold(column, method), along = hold(beam, method);
    std::printf("| %s | 1/%.0f s | %d | %+.1e | %.3g | %+.1e | %+.1e | %.0f | %.3g |\n",
                name_of(method).c_str(), 1 / method.step, method.iterations,
                upright.base.force.x / weight - 1, 1e3 * upright.sag,
                along.base.force.y / shear - 1, along.base.torque.z / moment - 1,
                along.base.torque_at_centre.z, 1e3 * along.sag);
    std::fflush(stdout);
  }
}

/// Four posts under a slab whose load rises until one fails: the largest force at a foot before.
double force_at_failure(double height, const std::string& rule, std::string& mode) {
  StoreyParams storey;
  storey.height = height;
  storey.post_section = "HEB200";
  CollapseScene scene = regular_scene(2, 2, 1, storey);
  for (FrameJoint& joint : scene.frame.joints) {
    joint.strength.force = 1e3 * joint.strength.force;
    joint.strength.torque = 1e3 * joint.strength.torque;
  }
  const double resistance =
      buckling_resistance(scene.frame.sections[1], scene.frame.steels[0], {height, height});
  scene.simulation.solver = "bullet";
  scene.rules.post_rule = rule;
  scene.scenario.load_rate = 4 * resistance / 36 / 4;  // a post's share within some 4 s
  scene.simulation.duration = rule == "ec3" ? 5 : 50;
  scene.simulation.history_step = scene.simulation.step;
  const CollapseResult r = simulate_collapse(scene);
  if (r.broken_joints.empty()) return 0;
  mode = r.broken_joints[0].mode;
  const Recording& recording = r.recording;
  const auto at = std::ranges::lower_bound(recording.sample_times, r.broken_joints[0].time - 1e-9);
  const auto sample = static_cast<std::size_t>(at - recording.sample_times.begin()) - 1;
  double largest = 0;
  for (std::size_t j = 0; j < recording.joints.size(); ++j) {
    if (recording.joints[j].part_b != kNoTrack) continue;
    const JointSample& load = recording.samples[sample * recording.joints.size() + j];
    largest = std::max(largest, -static_cast<double>(load.force[0]));
  }
  return largest;
}

void buckling() {
  const Block block("collapse_accuracy buckling");
  std::printf(
      "| free length | N_b,Rd by EN 1993-1-1, curve c, kN | independently | simulated rising load: "
      "force in the sample before the first failure, kN | off | what failed first | Euler load, kN "
      "| of that of 3.5 m |\n|---|---|---|---|---|---|---|---|\n");
  const Frame frame = empty_frame();
  const Section& section = frame.sections[1];
  const SteelGrade& steel = frame.steels[0];
  const double shortest = euler_load(section, steel, {3.5, 3.5});
  for (const auto& [height, expected] : {std::pair{3.5, 1289}, {7.0, 594}, {10.5, 303}}) {
    const double resistance = buckling_resistance(section, steel, {height, height});
    std::string mode = "nothing";
    const double reached = force_at_failure(height, "ec3", mode);
    const double euler = euler_load(section, steel, {height, height});
    std::printf("| %.1f m | %.1f | %d | %.1f | %+.2f %% | %s | %.1f | 1/%.3f |\n", height,
                resistance / 1e3, expected, reached / 1e3, 100 * (reached / resistance - 1),
                mode.c_str(), euler / 1e3, shortest / euler);
  }
}

/// M/M_pl that the blocks leave at an axial load of this share of N_pl.
double moment_beside(const Section& section, double axial) {
  double low = 0, high = 2;
  for (int i = 0; i < 60; ++i) {
    const double moment = (low + high) / 2;
    (exact_strength(section, axial, moment).axial > axial ? low : high) = moment;
  }
  return low;
}

void strength_rules() {
  const Section section = with_properties(
      {.name = "HEB200", .shape = "i", .height = 0.2, .width = 0.2, .web = 0.009, .flange = 0.015});
  const Block block("collapse_accuracy rules");
  std::printf("| rule | least | most | M/M_pl at N/N_pl = 0.5 (exact: %.4f) |\n|---|---|---|---|\n",
              moment_beside(section, 0.5));
  const SteelGrade steel{.name = "s235"};
  for (const std::string_view name : {"box", "ellipsoid", "linear", "ec3-i"}) {
    const JointStrength strength = section_strength(section, steel, interaction_named(name));
    const auto use = [&](double n, double m) {
      return utilisation({{n * strength.force.x, 0, 0}, {0, m * strength.torque.y, 0}}, strength)
          .total;
    };
    double least = 1e300, most = -1e300;
    for (int degrees = 5; degrees <= 85; degrees += 5) {
      const double turn = std::numbers::pi / 180 * degrees, n = std::cos(turn), m = std::sin(turn);
      const Plastic exact = exact_strength(section, n, m);
      const double error = 1 / use(n, m) / std::hypot(exact.axial, exact.moment) - 1;
      least = std::min(least, error), most = std::max(most, error);
    }
    double low = 0, high = 2;
    for (int i = 0; i < 60; ++i) {
      const double m = (low + high) / 2;
      (use(0.5, m) <= 1 ? low : high) = m;
    }
    std::printf("| %s | %+.1f %% | %+.1f %% | %.4f |\n", std::string(name).c_str(), 100 * least,
                100 * most, low);
  }
}

/// Compression at a post's foot over time, and what it amounts to before and after.
struct FootLoad {
  double before = 0, after = 0, peak = 0;
};
FootLoad foot_load(const CollapseResult& r, const Frame& frame, const std::string& post) {
  const std::uint32_t joint = joint_named(frame, post + "@ground");
  const std::size_t joints = r.recording.joints.size(), samples = r.recording.sample_times.size();
  const auto force = [&](std::size_t t) {
    return -static_cast<double>(r.recording.samples[t * joints + joint].force[0]);
  };
  FootLoad load{.before = force(0)};
  const std::size_t last = samples - samples / 4;
  for (std::size_t t = last; t < samples; ++t)
    load.after += force(t) / static_cast<double>(samples - last);
  for (std::size_t t = 1; t < samples; ++t) load.peak = std::max(load.peak, force(t));
  return load;
}

void removed_posts() {
  const Block block("collapse_accuracy removal");
  std::printf(
      "| removed | its load kN | neighbour | before kN | after kN | overshoot, single step | mean "
      "over 0.02 s | elastic frame: deflection, neighbours' forces "
      "|\n|---|---|---|---|---|---|---|---"
      "|\n");
  struct Case {
    const char *post, *neighbour, *elastic;
  };
  for (const Case& c : {Case{"post_0_2_0", "post_0_1_0", "1.91, 2.65"},
                        {"post_1_2_0", "post_1_1_0", "1.95, 2.96"},
                        {"post_0_0_0", "post_0_1_0", "1.74, 2.26"}}) {
    CollapseScene scene = regular_scene(4, 5, 6);
    scene.simulation.solver = "bullet";
    scene.rules.breaking = false;
    scene.rules.post_rule = "none";
    scene.scenario.remove = {c.post};
    scene.simulation.settle = 3;
    scene.simulation.duration = 3;
    scene.simulation.sleep = false;
    scene.simulation.iterations = 30;
    scene.simulation.history_step = scene.simulation.step;
    const FootLoad mean = foot_load(simulate_collapse(scene), scene.frame, c.neighbour);
    scene.rules.load_time = 0;
    const CollapseResult r = simulate_collapse(scene);
    const FootLoad load = foot_load(r, scene.frame, c.neighbour);
    const auto overshoot = [](const FootLoad& l) {
      return (l.peak - l.before) / (l.after - l.before);
    };
    std::printf("| %s | %.1f | %s | %.1f | %.1f | %.3f | %.3f | %s |\n", c.post,
                foot_load(r, scene.frame, c.post).before / 1e3, c.neighbour, load.before / 1e3,
                load.after / 1e3, overshoot(load), overshoot(mean), c.elastic);
    std::fflush(stdout);
  }
}

}  // namespace

void measure_closed_forms() {
  static_loads();
  buckling();
  strength_rules();
  removed_posts();
}

}  // namespace sunder
