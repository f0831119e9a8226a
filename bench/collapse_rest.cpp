// SPDX-License-Identifier: GPL-3.0-or-later
// A building at rest: how far it sags, what its joints carry and what a step costs, by solver.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>

#include "bench/collapse_accuracy.hpp"
#include "bench/peers_bullet_frame.hpp"
#include "bench/report.hpp"
#include "bench/work_precision.hpp"
#include "sim/step_times.hpp"
#include "tests/sim/frames.hpp"

namespace sunder {
namespace {

/// As simulate_collapse begins.
constexpr int kPrimedSteps = 4, kPrimedFactor = 100;

// The elastic frame of 3 × 3 posts and 12 storeys, by finite elements (see docs/accuracy.md).
constexpr double kElasticMost = 10.975e-3, kElasticCorner = 485.6e3, kElasticCentre = 1538.9e3;

const char* name_of(JointSolver solver) {
  switch (solver) {
    case JointSolver::nncg: return "NNCG";
    case JointSolver::dantzig: return "Dantzig";
    case JointSolver::lemke: return "Lemke";
    case JointSolver::sequential_impulse: break;
  }
  return "sequential impulses";
}

std::string step_text(double step) {
  return "1/" + std::to_string(std::lround(1 / step)) + " s";
}

/// Base joints sorted out by place.
struct Base {
  std::vector<std::uint32_t> all, corners;
  std::uint32_t centre = 0;
};

Base base_of(const Assembly& assembly) {
  Base base;
  Vec3 low{1e300, 0, 1e300}, high{-1e300, 0, -1e300};
  for (std::uint32_t j = 0; j < assembly.joints.size(); ++j) {
    if (assembly.joints[j].b != kNoPart) continue;
    base.all.push_back(j);
    const Vec3 p = assembly.joints[j].point;
    low = {std::min(low.x, p.x), 0, std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), 0, std::max(high.z, p.z)};
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t j : base.all) {
    const Vec3 p = assembly.joints[j].point;
    if ((p.x == low.x || p.x == high.x) && (p.z == low.z || p.z == high.z))
      base.corners.push_back(j);
    const double away = length(p - 0.5 * (low + high));
    if (away >= nearest) continue;
    nearest = away;
    base.centre = j;
  }
  return base;
}

void note_sag(const FrameWorld& world, const Assembly& assembly, double& mean, double& most,
              double& off) {
  mean = 0, most = -std::numeric_limits<double>::infinity(), off = 0;
  for (const Assembly::Top& top : assembly.tops) {
    const double sag = top.stood.y - world.place(top.part, top.stood).y;
    mean += sag / static_cast<double>(assembly.tops.size());
    most = std::max(most, sag);
    off = std::max(off, std::fabs(sag));
  }
}

void note_joints(const FrameWorld& world, const Frame& frame, Rest& result) {
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    result.gap = std::max(result.gap, world.gap(j));
    const PartReaction reaction = world.reaction(j);
    const double use = utilisation_of(frame, j, reaction);
    result.overloaded += use >= 1;
    result.utilisation = std::max(result.utilisation, use);
    if (frame.joints[j].kind == FrameJoint::Kind::beam_end)
      result.beam_moment = std::max(result.beam_moment, std::fabs(reaction.torque.y));
  }
}

/// Joints that are over their strength now or were before.
void note_overloads(const FrameWorld& world, const Frame& frame, std::vector<std::uint8_t>& ever) {
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    if (utilisation_of(frame, j, world.reaction(j)) >= 1) ever[j] = 1;
}

/// Runs in a child process: libraries may crash or take for ever. False: it did; `why` says how.
bool apart(const std::function<Rest()>& run, Rest& result, std::string& why) {
  int ends[2];
  if (pipe(ends) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    const Rest found = run();
    const bool written = write(ends[1], &found, sizeof found) == sizeof found;
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  const bool complete = read(ends[0], &result, sizeof result) == sizeof result;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (complete) return true;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  why = signal == SIGALRM ? "not done in 60 s" : "crashes (signal " + std::to_string(signal) + ")";
  return false;
}

struct Row {
  Method method;
  Rest rest;
};

void print_rest(const Row& row) {
  const Rest& r = row.rest;
  std::printf(
      "| %s | %s | %d | %.4g / %.4g | %.4g / %.4g | %.3g | %.1e | %.1f (%+.0f %%) | %.1f (%+.0f "
      "%%) "
      "| %.2f | %.0f | %.0f |\n",
      name_of(row.method).c_str(), step_text(row.method.step).c_str(), row.method.iterations,
      1e3 * r.sag_mean, 1e3 * r.sag_max, 1e3 * r.sag_mean_end, 1e3 * r.sag_max_end, 1e3 * r.gap,
      r.sum, r.corner / 1e3, 100 * (r.corner / kElasticCorner - 1), r.centre / 1e3,
      100 * (r.centre / kElasticCentre - 1), r.step_ms, r.start_ms, r.step_ms / row.method.step);
  std::fflush(stdout);
}

/// `is_long`: with those too that iterate most.
std::vector<Method> methods_at_rest(bool is_long) {
  using enum Method::Engine;
  std::vector<Method> methods;
  const auto add = [&](Method::Engine engine, double step, std::initializer_list<int> counts,
                       JointSolver solver = JointSolver::sequential_impulse) {
    for (const int count : counts)
      methods.push_back({.engine = engine, .solver = solver, .iterations = count, .step = step});
  };
  add(bullet, 1.0 / 60, {10, 50, 200});
  if (is_long) add(bullet, 1.0 / 60, {1000});
  add(bullet, 1.0 / 240, {50});
  add(bullet, 1.0 / 60, {50}, JointSolver::nncg);
  if (is_long) add(bullet, 1.0 / 60, {200}, JointSolver::nncg);
  add(cold, 1.0 / 60, {10, 50, 200});
  if (is_long) add(cold, 1.0 / 60, {1000});
  add(cold, 1.0 / 60, {50}, JointSolver::nncg);
  add(warm, 1.0 / 60, {10, 30, 50});
  if (is_long) add(warm, 1.0 / 60, {200});
  add(warm, 1.0 / 240, {10, 30});
  if (is_long) add(warm, 1.0 / 240, {50});
  add(warm, 1.0 / 60, {50}, JointSolver::nncg);
  methods.push_back({.iterations = 30, .step = 1.0 / 240, .primed = false});
  return methods;
}

std::vector<Row> sag_table(const Frame& frame, bool is_long) {
  const Block block("collapse_accuracy rest");
  std::printf(
      "| method | step | iterations | sag at 5 s mean / most, mm | at 10 s, mm | widest gap mm | "
      "sum "
      "of base reactions / weight − 1 | corner post kN (against %.1f) | centre post kN (against "
      "%.1f) | ms per step | ms of the first %d steps | ms per simulated s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      kElasticCorner / 1e3, kElasticCentre / 1e3, kPrimedSteps);
  std::vector<Row> rows;
  for (const Method& method : methods_at_rest(is_long)) {
    rows.push_back({method, rest(frame, method, 10)});
    print_rest(rows.back());
  }
  return rows;
}

void print_overload(const char* building, const Frame& frame, const Row& row) {
  const Rest& r = row.rest;
  std::printf("| %s | %s | %s | %d | %.0f of %zu | %.0f | %.3g | %.1f |\n", building,
              name_of(row.method).c_str(), step_text(row.method.step).c_str(),
              row.method.iterations, r.overloaded, frame.joints.size(), r.ever_overloaded,
              r.utilisation, r.beam_moment / 1e3);
  std::fflush(stdout);
}

/// A building at rest under its own weight with the strengths of its steel: nothing may break.
void overload_table(const Frame& tall, const std::vector<Row>& rows) {
  const Block block("collapse_accuracy overload");
  std::printf(
      "| building | method | step | iterations | joints over their strength at the end | at any "
      "time from the start | largest utilisation | largest moment of a beam's end, kN m "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) print_overload("3 × 3 × 12", tall, row);
  const Frame frame = regular_scene(4, 5, 6).frame;
  using enum Method::Engine;
  for (const Method& method : {Method{.engine = bullet, .iterations = 200, .step = 1.0 / 60},
                               Method{.engine = cold, .iterations = 50, .step = 1.0 / 60},
                               Method{.engine = cold, .iterations = 200, .step = 1.0 / 60},
                               Method{.engine = warm, .iterations = 50, .step = 1.0 / 60},
                               Method{.engine = warm, .iterations = 30, .step = 1.0 / 240}})
    print_overload("4 × 5 × 6", frame, {method, rest(frame, method, 5)});
}

/// Against the sag of the elastic frame, which rigid joints cannot have.
void plot_sag(const std::vector<Row>& rows) {
  WorkPlot plot{.block = "collapse_accuracy sag",
                .title = "3 × 3 posts, 12 storeys at rest: rigid members",
                .error_axis = "largest sag or rise of a roof post after 10 s, m",
                .time_axis = "ms per simulated second, one core",
                .least_error = 1e-7,
                .omissions =
                    "direct solvers, which do not get through twelve storeys ([below](#direct-"
                    "solvers)); featherstone joints; the elastic solver, whose sag is the mark by "
                    "itself. Jolt and PhysX are quoted, from another machine. Failed: still "
                    "sinking after 10 s.",
                .points = {},
                .marks = {{kElasticMost, "elastic frame: 10.98 mm"}}};
  for (const auto& [method, r] : rows) {
    if (!method.primed) continue;
    const bool sinks = r.sag_mean_end > 1.1 * r.sag_mean && r.sag_mean_end > 0.01;
    const std::string step = step_text(method.step);
    plot.points.push_back({.method = name_of(method) + ", " + step,
                           .knobs = text("%s, %d iterations", step.c_str(), method.iterations),
                           .label = std::to_string(method.iterations),
                           .error = r.off,
                           .time = {r.step_ms / method.step, r.step_ms_least / method.step,
                                    r.step_ms_most / method.step},
                           .failed = sinks});
  }
  const auto quote = [&](const char* name, const char* iterations, double sag, double step_ms) {
    const double ms = 60 * step_ms;
    plot.points.push_back({.method = name,
                           .knobs = text("1/60 s, %s iterations", iterations),
                           .label = iterations,
                           .error = sag,
                           .time = {ms, ms, ms},
                           .quoted = true});
  };
  quote("Jolt, quoted", "200", 14.7e-3, 4.6);
  quote("PhysX TGS, quoted", "50", 9.0e-3, 2.6);
  quote("PhysX TGS, quoted", "200", 0.95e-3, 9.8);
  publish(plot);
}

}  // namespace

std::string name_of(const Method& method) {
  using enum Method::Engine;
  std::string name = method.engine == bullet ? "Bullet" : "sunder";
  if (method.solver == JointSolver::sequential_impulse || method.engine == warm ||
      method.solver == JointSolver::nncg)
    name += method.engine == bullet ? "" : method.engine == cold ? ", cold" : ", warm";
  if (method.solver != JointSolver::sequential_impulse)
    name += std::string(", ") + name_of(method.solver);
  if (method.compliance > 0) name += ", c = 1e-9";
  if (method.engine == warm && !method.primed) name += " from nothing";
  return name;
}

std::unique_ptr<FrameWorld> frame_world(const Assembly& assembly, const Method& method) {
  if (method.engine == Method::Engine::bullet)
    return bullet_frame(assembly, {.solver = method.solver,
                                   .iterations = method.iterations,
                                   .compliance = method.compliance});
  return rigid_frame(assembly, {.iterations = method.iterations,
                                .joint_solver = method.solver,
                                .warm_start = method.engine == Method::Engine::warm,
                                .sleep = false});
}

double step_once(FrameWorld& world, const Method& method, int number) {
  if (method.engine == Method::Engine::warm && method.primed && number <= kPrimedSteps)
    world.set_iterations(method.iterations * (number < kPrimedSteps ? kPrimedFactor : 1));
  const std::clock_t begin = std::clock();
  world.step(method.step);
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double utilisation_of(const Frame& frame, std::uint32_t j, const PartReaction& reaction) {
  const FrameJoint& joint = frame.joints[j];
  const double side = joint.end_a == 1 ? 1 : -1;
  return utilisation({side * reaction.force, side * reaction.torque}, joint.strength).total;
}

Rest rest(const Frame& frame, const Method& method, double seconds, double budget_s) {
  const Assembly assembly = assembly_of(frame);
  const Base base = base_of(assembly);
  const auto world = frame_world(assembly, method);
  const int steps = static_cast<int>(std::lround(seconds / method.step));
  Rest result;
  std::vector<double> ms, base_forces(assembly.joints.size(), 0);
  std::vector<std::uint8_t> overloaded(frame.joints.size(), 0);
  double used = 0, sampled = 0;
  for (int i = 0; i < steps && used < 1e3 * budget_s; ++i) {
    ms.push_back(step_once(*world, method, i));
    used += ms.back();
    if (i < kPrimedSteps) result.start_ms += ms.back();
    note_overloads(*world, frame, overloaded);
    if (2 * i < steps) note_sag(*world, assembly, result.sag_mean, result.sag_max, result.off);
    if (2 * i < steps) continue;
    ++sampled;
    for (const std::uint32_t j : base.all)
      base_forces[j] += (assembly.joints[j].axes * world->reaction(j).force).y;
  }
  note_sag(*world, assembly, result.sag_mean_end, result.sag_max_end, result.off);
  note_joints(*world, frame, result);
  for (const std::uint32_t j : base.all) result.sum += base_forces[j] / sampled;
  result.sum = result.sum / assembly.weight() - 1;
  result.ever_overloaded = static_cast<double>(std::ranges::count(overloaded, 1));
  for (const std::uint32_t j : base.corners)
    result.corner += base_forces[j] / sampled / static_cast<double>(base.corners.size());
  result.centre = base_forces[base.centre] / sampled;
  result.step_ms = percentile(ms, 0.5);
  result.step_ms_least = percentile(ms, 0.05);
  result.step_ms_most = percentile(ms, 0.95);
  result.steps = static_cast<double>(ms.size());
  result.fallbacks = static_cast<double>(world->fallbacks());
  return result;
}

void measure_direct_solvers() {
  const Block block("collapse_accuracy direct");
  std::printf(
      "| method | storeys | joints | steps done | failed and iterated instead | sag mean mm | "
      "widest gap mm | ms per step |\n|---|---|---|---|---|---|---|---|\n");
  using enum Method::Engine;
  for (const JointSolver solver : {JointSolver::dantzig, JointSolver::lemke}) {
    const std::size_t highest = solver == JointSolver::dantzig ? 4 : 3;
    for (const auto& [engine, compliance] :
         {std::pair{bullet, 0.0}, std::pair{bullet, 1e-9}, std::pair{cold, 0.0}}) {
      for (std::size_t storeys = 1; storeys <= highest; ++storeys) {
        const Frame frame = regular_scene(3, 3, storeys).frame;
        const Method method{.engine = engine,
                            .solver = solver,
                            .iterations = 50,
                            .step = 1.0 / 60,
                            .compliance = compliance};
        Rest r;
        std::string why;
        const std::string name = name_of(method);
        if (!apart([&] { return rest(frame, method, 1, 1); }, r, why)) {
          std::printf("| %s | %zu | %zu | %s | | | | |\n", name.c_str(), storeys,
                      frame.joints.size(), why.c_str());
          continue;
        }
        std::printf("| %s | %zu | %zu | %.0f | %.0f | %.3g | %.3g | %.1f |\n", name.c_str(),
                    storeys, frame.joints.size(), r.steps, r.fallbacks, 1e3 * r.sag_mean_end,
                    1e3 * r.gap, r.step_ms);
        std::fflush(stdout);
      }
    }
  }
}

void measure_rest(bool is_long) {
  const Frame frame = regular_scene(3, 3, 12).frame;
  const std::vector<Row> rows = sag_table(frame, is_long);
  plot_sag(rows);
  overload_table(frame, rows);
}

}  // namespace sunder
