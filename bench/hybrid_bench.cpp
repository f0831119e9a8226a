// SPDX-License-Identifier: GPL-3.0-or-later
// The elastic solver of frame buildings against statics, dynamics and rigid bodies: the tables of
// "The elastic solver" in docs/accuracy.md and docs/performance.md.
// Usage: bench_hybrid [statics|dynamics|precision|updates|splits|steps|work]
#include "bench/hybrid_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "bench/report.hpp"
#include "fracture/support_graph.hpp"
#include "meshing/random.hpp"
#include "sim/frame_solver.hpp"
#include "sim/step_times.hpp"

namespace sunder {
namespace {

constexpr double kG = 9.81;

bool over(const FrameNode& node, Vec3 foot) {
  return std::hypot(node.position.x - foot.x, node.position.z - foot.z) < 1e-9;
}

/// What a post must carry at its foot: the weight of its line and what the beams give it, from the
/// section forces at their ends.
double carried_on(const Frame& frame, const FrameSolver& solver, Vec3 foot) {
  double sum = 0;
  for (const FrameMember& m : frame.members)
    if (m.kind == FrameMember::Kind::post && over(frame.nodes[m.from], foot))
      sum += kG * frame.steels[m.steel].density * frame.sections[m.section].area * frame.length(m);
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const FrameJoint& joint = frame.joints[j];
    if (joint.kind != FrameJoint::Kind::beam_end || !over(frame.nodes[joint.node], foot)) continue;
    const double up = (joint.axes * solver.joint_load(j).force).y;
    sum += joint.end_a == 0 ? -up : up;
  }
  return sum;
}

struct Roof {
  double mean = 0, most = 0;
};
Roof roof_of(const Frame& frame, const FrameSolver& solver) {
  double top = 0, count = 0;
  for (const FrameNode& node : frame.nodes) top = std::max(top, node.position.y);
  Roof roof;
  for (std::uint32_t i = 0; i < frame.nodes.size(); ++i) {
    if (frame.nodes[i].position.y != top) continue;
    roof.mean -= solver.displacement(i).y;
    roof.most = std::max(roof.most, -solver.displacement(i).y);
    ++count;
  }
  roof.mean /= count;
  return roof;
}

void print_statics(const Size& size, bool shear, const char* expected) {
  const Frame frame = building_of(size);
  FrameSolver solver(frame, {.shear = shear});
  solver.solve({});
  double weight = 0, sum = 0, worst = 0;
  for (const PartSolid& part : solids_of(frame)) weight += kG * part.mass;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    if (frame.joints[j].b != kNoPart) continue;
    const double up = solver.reaction(j).y;
    sum += up;
    worst = std::max(worst, std::fabs(up / carried_on(frame, solver, frame.joints[j].point) - 1));
  }
  const Roof roof = roof_of(frame, solver);
  const auto foot = [&](Vec3 at) {
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (frame.joints[j].b == kNoPart && length(frame.joints[j].point - at) < 1e-9)
        return solver.reaction(j).y / 1e3;
    return 0.0;
  };
  std::printf("| %s | %s | %.3f / %.3f | %s | %.2f / %.2f / %.2f / %.2f | %.1e | %.1e | %.1e |\n",
              name_of(size).c_str(), shear ? "on" : "off", 1e3 * roof.most, 1e3 * roof.mean,
              expected, foot({}), foot({6, 0, 0}), foot({0, 0, 6}), foot({6, 0, 6}), worst,
              sum / weight - 1, solver.residual());
}

struct Difference {
  double displacement = 0, force = 0;  ///< largest, by the largest
};
Difference difference(const Frame& frame, const FrameSolver& solver, const Frame& rest,
                      const FrameSolver& fresh) {
  Difference most;
  double largest_u = 0, largest_f = 0;
  for (std::uint32_t i = 0; i < frame.nodes.size(); ++i) {
    const Vec3 u = fresh.displacement(i);
    largest_u = std::max(largest_u, length(u));
    most.displacement = std::max(most.displacement, length(solver.displacement(i) - u));
  }
  std::map<std::string, std::uint32_t> names;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) names[frame.joints[j].name] = j;
  for (std::uint32_t j = 0; j < rest.joints.size(); ++j) {
    const Vec3 force = fresh.joint_load(j).force;
    largest_f = std::max(largest_f, length(force));
    const Vec3 ours = solver.joint_load(names.at(rest.joints[j].name)).force;
    most.force = std::max(most.force, length(ours - force));
  }
  return {most.displacement / largest_u, most.force / largest_f};
}

/// The building without these joints, factored anew.
Difference against_refactor(const Frame& frame, const std::vector<std::uint32_t>& broken,
                            const FrameSolver& solver, double& refactor_ms) {
  Frame rest = frame;
  for (std::size_t i = broken.size(); i-- > 0;) rest.joints.erase(rest.joints.begin() + broken[i]);
  std::unique_ptr<FrameSolver> fresh;
  refactor_ms = cost_ms([&] { fresh = std::make_unique<FrameSolver>(rest); });
  fresh->solve({});
  return difference(frame, solver, rest, *fresh);
}

void print_update(const Size& size, const Frame& frame, std::size_t k, bool scattered, int runs) {
  const std::vector<std::uint32_t> joints = beam_joints(frame, k, scattered);
  std::vector<double> make, update, solve;
  Difference off;
  std::uint64_t corrections = 0;
  double anew = 0;
  for (int i = 0; i < runs; ++i) {
    std::unique_ptr<FrameSolver> solver;
    make.push_back(cost_ms([&] { solver = std::make_unique<FrameSolver>(frame); }));
    solver->solve({});
    update.push_back(cost_ms([&] { solver->break_joints(joints); }));
    solve.push_back(cost_ms([&] { solver->solve({}); }));
    corrections = solver->counts().low_rank;
    if (i == 0) off = against_refactor(frame, joints, *solver, anew);
  }
  std::printf("| %s | %zu %s | %s | %.3g / %.3g | %.3g / %.3g | %.3g | %.1e | %.1e |\n",
              name_of(size).c_str(), joints.size(), scattered ? "scattered" : "near each other",
              corrections > 0 ? "correction" : "fronts anew", percentile(update, 0),
              percentile(update, 0.5), percentile(solve, 0), percentile(solve, 0.5),
              percentile(make, 0), off.displacement, off.force);
  std::fflush(stdout);
}

void print_largest() {
  const Size size{20, 20, 60};
  const Frame frame = building_of(size);
  std::unique_ptr<FrameSolver> solver;
  const double make = cost_ms([&] { solver = std::make_unique<FrameSolver>(frame); });
  const double first = cost_ms([&] { solver->solve({}); });
  for (const std::size_t k : {1, 10}) {
    const std::vector<std::uint32_t> joints = beam_joints(frame, k, false);
    const std::uint64_t before = solver->counts().low_rank;
    const double update = cost_ms([&] { solver->break_joints(joints); });
    const double solve = cost_ms([&] { solver->solve({}); });
    std::printf(
        "| %s, once (first solve %.0f ms) | %zu near each other | %s | %.0f | %.0f | %.0f | "
        "residual %.1e | – |\n",
        name_of(size).c_str(), first, k,
        solver->counts().low_rank > before ? "correction" : "fronts anew", update, solve, make,
        solver->residual());
    std::fflush(stdout);
  }
}

/// Wall time: reading the processor time would take as long as what is measured.
double clock_us(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
      .count();
}

/// Which parts hang on the ground, by union and find.
class Grounded {
 public:
  explicit Grounded(const Frame& frame) : frame_(frame), above_(frame.part_count() + 1) {}
  void find(const std::vector<std::uint8_t>& intact) {
    std::iota(above_.begin(), above_.end(), 0u);
    for (std::uint32_t j = 0; j < intact.size(); ++j) {
      if (intact[j] == 0) continue;
      const FrameJoint& joint = frame_.joints[j];
      above_[root(joint.a)] = root(joint.b == kNoPart ? ground() : joint.b);
    }
  }
  bool holds(std::uint32_t part) { return root(part) == root(ground()); }

 private:
  std::uint32_t ground() const { return static_cast<std::uint32_t>(above_.size()) - 1; }
  std::uint32_t root(std::uint32_t part) {
    while (above_[part] != part) part = above_[part] = above_[above_[part]];
    return part;
  }
  const Frame& frame_;
  std::vector<std::uint32_t> above_;
};

/// Each break's least time of some runs: the machine may be shared.
std::vector<double> split_times(const Frame& frame, const std::vector<Bond>& bonds,
                                const std::vector<std::uint32_t>& order) {
  std::vector<double> least(order.size(), 1e300);
  for (int run = 0; run < 5; ++run) {
    SupportGraph graph(frame.part_count(), bonds);
    graph.break_bonds({});
    for (std::size_t i = 0; i < order.size(); ++i)
      least[i] = std::min(least[i], clock_us([&] { graph.break_bonds({&order[i], 1}); }));
  }
  return least;
}

void print_split(const Size& size, std::uint32_t compare_every) {
  const Frame frame = building_of(size);
  std::vector<Bond> bonds;
  std::vector<std::uint32_t> order(frame.joints.size());
  for (const FrameJoint& joint : frame.joints)
    bonds.push_back({joint.a, joint.b == kNoPart ? kWorld : joint.b, 1, {}, {}});
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [](std::uint32_t j) { return random_unit(11, j); });
  const std::vector<double> ours = split_times(frame, bonds, order);
  SupportGraph graph(frame.part_count(), bonds);
  std::vector<std::uint8_t> intact(frame.joints.size(), 1);
  Grounded grounded(frame);
  std::vector<double> theirs;
  std::uint64_t compared = 0, wrong = 0;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    graph.break_bonds({&order[i], 1});
    intact[order[i]] = 0;
    if (i % compare_every != 0) continue;
    theirs.push_back(clock_us([&] { grounded.find(intact); }));
    for (std::uint32_t part = 0; part < frame.part_count(); ++part, ++compared)
      wrong += grounded.holds(part) != graph.is_present(part);
  }
  std::printf("| %s | %zu | %.2f | %.2f | %.1f | %.1f | %llu of %llu |\n", name_of(size).c_str(),
              order.size(), percentile(ours, 0.5), percentile(ours, 0.99), percentile(ours, 1),
              percentile(theirs, 0.5), static_cast<unsigned long long>(wrong),
              static_cast<unsigned long long>(compared));
}

}  // namespace

void measure_statics() {
  const Block block("hybrid statics");
  std::printf(
      "| building | shear | sag of the roof, most / mean mm | expected | foot of "
      "corner / edge x / edge z / inner post kN | worst foot against its line | all feet against "
      "weight | residual |\n|---|---|---|---|---|---|---|---|\n");
  print_statics({3, 3, 12}, false, "10.975 / 5.539");
  print_statics({3, 3, 12}, true, "–");
  print_statics({5, 4, 6}, false, "3.187 / 1.962");
  print_statics({5, 4, 6}, true, "–");
  print_statics({10, 10, 30}, false, "70.7 / 57.9");
  print_statics({10, 10, 30}, true, "–");
}

void measure_updates() {
  const Block block("hybrid updates");
  std::printf(
      "| building | joints broken | way | "
      "update ms, least / median | solve ms, least / median | solver made anew ms, least | "
      "displacements off | joint forces off |\n|---|---|---|---|---|---|---|---|\n");
  for (const Size& size : {Size{3, 3, 12}, Size{4, 5, 6}, Size{10, 10, 30}}) {
    const Frame frame = building_of(size);
    for (const bool scattered : {false, true})
      for (const std::size_t k : {1, 10, 100})
        print_update(size, frame, k, scattered, size.x < 10 ? 11 : 3);
  }
  print_largest();
}

void measure_splits() {
  const Block block("hybrid splits");
  std::printf(
      "| building | joints | "
      "median µs | p99 µs | worst µs | union-find, all anew, median µs | parts told wrong "
      "|\n|---|---|---|---|---|---|---|\n");
  print_split({3, 3, 12}, 1);
  print_split({4, 5, 6}, 1);
  print_split({10, 10, 30}, 10);
}

}  // namespace sunder

int main(int count, char** values) {
  const std::string part = count > 1 ? values[1] : "";
  const std::pair<const char*, void (*)()> all[] = {{"statics", sunder::measure_statics},
                                                    {"dynamics", sunder::measure_dynamics},
                                                    {"precision", sunder::measure_precision},
                                                    {"updates", sunder::measure_updates},
                                                    {"splits", sunder::measure_splits},
                                                    {"steps", sunder::measure_steps},
                                                    {"work", sunder::measure_work}};
  for (const auto& [name, measure] : all)
    if (part.empty() || part == name) measure();
}
