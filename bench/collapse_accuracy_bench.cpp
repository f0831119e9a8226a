// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of frame buildings in docs/accuracy.md and docs/performance.md: sag, forces and cost
// against Bullet itself, closed forms, a hit, and how far one collapse can be trusted.
// Usage: bench_collapse_accuracy [rest|direct|forms|hit|trust] [long]
// long: more iterations at rest too, 20 starts instead of 6
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "bench/collapse_accuracy.hpp"
#include "bench/report.hpp"
#include "meshing/random.hpp"
#include "sim/step_times.hpp"
#include "tests/sim/frames.hpp"

namespace sunder {
namespace {

constexpr double kFrame = 1.0 / 60;  // s, of a picture on the screen

/// 888 kg, 0.3 m, 40 m/s, against the middle of a facade's post on the ground.
Projectile ball() {
  Projectile p;
  p.name = "ball";
  p.radius = 0.3;
  p.mass = 888;
  p.position = {-3, 1.9, 12.05};
  p.velocity = {40, 0, 0};
  return p;
}

struct Times {
  double median = 0, p95 = 0, most = 0;
};
Times times_of(const std::vector<double>& ms) {
  return {percentile(ms, 0.5), percentile(ms, 0.95), percentile(ms, 1)};
}

void print_times(const std::string& name, const Method& method, const char* phase,
                 const Times& times, const std::string& broken) {
  std::printf("| %s | 1/%.0f s | %d | %s | %.3g | %.3g | %.3g | %.0f | %s |\n", name.c_str(),
              1 / method.step, method.iterations, phase, times.median, times.p95, times.most,
              1e3 / (times.median * kFrame / method.step), broken.c_str());
  std::fflush(stdout);
}

Times timed_steps(FrameWorld& world, const Method& method, double seconds, int first) {
  std::vector<double> ms;
  const int steps = static_cast<int>(std::lround(seconds / method.step));
  for (int i = 0; i < steps; ++i) ms.push_back(step_once(world, method, first + i));
  return times_of(ms);
}

/// Joints that hold, the solver alone: the same work for all.
void time_unbreakable(const Frame& frame, const Method& method) {
  const Assembly assembly = assembly_of(frame);
  const auto world = frame_world(assembly, method);
  const double settle = 3;
  timed_steps(*world, method, settle, 0);
  const int settled = static_cast<int>(std::lround(settle / method.step));
  const std::string name = name_of(method) + ", joints that hold";
  print_times(name, method, "at rest, awake", timed_steps(*world, method, 1, settled), "–");
  world->add_ball(ball());
  print_times(name, method, "3 s from the hit", timed_steps(*world, method, 3, settled), "–");
}

CollapseScene scene_of(const Method& method, double settle, double duration) {
  CollapseScene scene = regular_scene(4, 5, 6);
  scene.simulation.solver = "bullet";
  scene.simulation.step = method.step;
  scene.simulation.iterations = method.iterations;
  scene.simulation.warm_start = method.engine == Method::Engine::warm;
  scene.simulation.settle = settle;
  scene.simulation.duration = duration;
  return scene;
}

void strengthen(CollapseScene& scene, double factor) {
  for (FrameJoint& joint : scene.frame.joints) {
    joint.strength.force = factor * joint.strength.force;
    joint.strength.torque = factor * joint.strength.torque;
  }
}

/// Runs a scene; processor time of each step from time 0 on.
CollapseResult timed(const CollapseScene& scene, Times& times) {
  std::vector<std::clock_t> ends;
  const CollapseResult r =
      simulate_collapse(scene, {.progress = [&](double) { ends.push_back(std::clock()); }});
  std::vector<double> ms;
  for (std::size_t i = ends.size() - r.steps + 1; i < ends.size(); ++i)
    ms.push_back(1e3 * static_cast<double>(ends[i] - ends[i - 1]) / CLOCKS_PER_SEC);
  times = times_of(ms);
  return r;
}

/// All of simulate_collapse: loads are read and judged, poses recorded, joints break.
void time_collapse(const Method& method) {
  const std::string name = name_of(method) + ", whole";
  for (const bool sleep : {false, true}) {
    CollapseScene scene = scene_of(method, sleep ? 6 : 3, 1);
    scene.simulation.sleep = sleep;
    scene.rules.breaking = false;
    Times times;
    const CollapseResult r = timed(scene, times);
    const char* phase = !sleep                     ? "at rest, awake"
                        : r.body_steps_asleep == 0 ? "at rest, does not fall asleep in 6 s"
                                                   : "at rest, asleep";
    print_times(name, method, phase, times, "–");
  }
  for (const double factor : {10, 1}) {
    CollapseScene scene = scene_of(method, 3, 3);
    scene.projectiles = {ball()};
    strengthen(scene, factor);
    Times times;
    const CollapseResult r = timed(scene, times);
    char phase[60], broken[80];
    std::snprintf(phase, sizeof phase, "3 s from the hit, strength × %.0f", factor);
    std::snprintf(broken, sizeof broken, "%zu (%llu before the hit), %llu parts freed",
                  r.broken_joints.size(), static_cast<unsigned long long>(r.broken_at_rest),
                  static_cast<unsigned long long>(r.parts_freed));
    print_times(name, method, phase, times, broken);
  }
}

void measure_hit() {
  const Block block("collapse_accuracy hit");
  std::printf(
      "| method | step | iterations | phase | median ms | p95 ms | longest ms | pictures of 1/60 s "
      "per second | joints broken |\n|---|---|---|---|---|---|---|---|---|\n");
  using enum Method::Engine;
  const std::vector<Method> methods{{.engine = cold, .iterations = 200, .step = kFrame},
                                    {.engine = warm, .iterations = 50, .step = kFrame},
                                    {.engine = warm, .iterations = 30, .step = 1.0 / 240}};
  const Frame frame = regular_scene(4, 5, 6).frame;
  time_unbreakable(frame, {.engine = bullet, .iterations = 200, .step = kFrame});
  for (const Method& method : methods) time_unbreakable(frame, method);
  for (const Method& method : methods) time_collapse(method);
}

/// Least and most of a number over runs.
struct Range {
  double least = 1e300, most = -1e300;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

CollapseScene hit_scene(double factor) {
  CollapseScene scene = scene_of({}, 1, 1.5);
  strengthen(scene, factor);
  scene.projectiles = {ball()};
  return scene;
}

/// The ball starts up to a micrometre aside.
void scatter(double factor, int runs) {
  Range freed, broken, fall;
  std::vector<int> times_broken;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(runs); ++seed) {
    CollapseScene scene = hit_scene(factor);
    const auto aside = [&](std::uint64_t n) { return 1e-6 * (2 * random_unit(seed, n) - 1); };
    scene.projectiles[0].position =
        scene.projectiles[0].position + Vec3{aside(1), aside(2), aside(3)};
    const CollapseResult r = simulate_collapse(scene, {.keep_history = false});
    times_broken.resize(scene.frame.joints.size(), 0);
    for (const JointBreak& b : r.broken_joints) ++times_broken[b.joint];
    freed.add(static_cast<double>(r.parts_freed));
    broken.add(static_cast<double>(r.broken_joints.size()));
    fall.add(r.energy.potential / 1e6);
  }
  const auto some =
      times_broken.size() - static_cast<std::size_t>(std::ranges::count(times_broken, 0));
  std::printf("| × %.0f | %d | %.0f … %.0f | %.0f … %.0f | %td of %zu | %.3f … %.3f |\n", factor,
              runs, freed.least, freed.most, broken.least, broken.most,
              std::ranges::count(times_broken, runs), some, fall.least, fall.most);
  std::fflush(stdout);
}

void print_choice(const char* what, const CollapseScene& scene) {
  const CollapseResult r = simulate_collapse(scene, {.keep_history = false});
  std::printf("| %s | %llu | %zu | %llu | %.3f |\n", what,
              static_cast<unsigned long long>(r.parts_freed), r.broken_joints.size(),
              static_cast<unsigned long long>(r.broken_at_rest), r.energy.potential / 1e6);
  std::fflush(stdout);
}

/// The same hit where something is chosen otherwise that is not in the drawing.
void choices(double factor) {
  const Block block(factor > 1 ? "collapse_accuracy choices-strong" : "collapse_accuracy choices");
  std::printf(
      "| strength × %.0f | parts freed of %u | joints broken | before the hit | potential "
      "energy, "
      "MJ |\n|---|---|---|---|---|\n",
      factor, hit_scene(factor).frame.part_count());
  const CollapseScene scene = hit_scene(factor);
  print_choice("as it is: 1/240 s, 30 iterations, load_time 0.02 s", scene);
  for (const double time : {0.0, 0.05, 0.1}) {
    CollapseScene other = scene;
    other.rules.load_time = time;
    char what[40];
    std::snprintf(what, sizeof what, "load_time %g s", time);
    print_choice(what, other);
  }
  if (factor <= 1) return;  // all comes down whatever is chosen
  CollapseScene other = scene;
  other.simulation.step = 1.0 / 480;
  print_choice("1/480 s", other);
  other.simulation.step = 1.0 / 60;
  print_choice("1/60 s", other);
  other = scene;
  other.simulation.iterations = 100;
  print_choice("100 iterations", other);
  other = scene;
  for (FrameJoint& joint : other.frame.joints) joint.strength.interaction = Interaction::box;
  print_choice("strength rule box", other);
  other = scene;
  other.rules.post_rule = "unbraced";
  print_choice("post rule unbraced", other);
}

void measure_trust(bool is_long) {
  {
    const Block block("collapse_accuracy scatter");
    std::printf(
        "| strength | runs | parts freed after 1.5 s | joints broken | broken in all runs, of "
        "those broken in any | potential energy, MJ |\n|---|---|---|---|---|---|\n");
    for (const double factor : {1, 2}) scatter(factor, is_long ? 20 : 6);
  }
  choices(1);
  choices(2);
}

}  // namespace
}  // namespace sunder

int main(int count, char** values) {
  std::string part;
  bool is_long = false;
  for (int i = 1; i < count; ++i)
    if (std::string(values[i]) == "long")
      is_long = true;
    else
      part = values[i];
  const auto wanted = [&](const char* name) { return part.empty() || part == name; };
  if (wanted("rest")) sunder::measure_rest(is_long);
  if (wanted("direct")) sunder::measure_direct_solvers();
  if (wanted("forms")) sunder::measure_closed_forms();
  if (wanted("hit")) sunder::measure_hit();
  if (wanted("trust")) sunder::measure_trust(is_long);
}
