// SPDX-License-Identifier: GPL-3.0-or-later
// A post taken away at once from an elastic frame without damping: how far it swings past statics.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/hybrid_bench.hpp"
#include "bench/report.hpp"
#include "sim/frame_solver.hpp"
#include "tests/sim/stocked_frame.hpp"

namespace sunder {
namespace {

constexpr double kStep = 0.0005, kTime = 3;  // s

/// What swings: a deflection, the load of one joint.
struct Swing {
  double before = 0, rest = 0, peak = 0;
  void note(double value) {
    if (std::fabs(value - before) > std::fabs(peak - before)) peak = value;
  }
  double factor() const { return (peak - before) / (rest - before); }
};

/// Deflection of the node over the removed post, by the same rule in time on a solver of its own.
Swing deflection(const Frame& intact, std::uint32_t post, bool shear) {
  Frame frame = intact;
  hand_over_joints(frame, post);
  const std::uint32_t top = frame.members[post].to;
  FrameSolver statics(frame, {.shear = shear});
  FrameSolver moves(frame, {.shear = shear, .mass = 4 / (kStep * kStep)});
  statics.solve({});
  const std::span<const double> stood = statics.displacements();
  std::vector<double> u(stood.begin(), stood.end());
  Swing swing{-statics.displacement(top).y, 0, 0};
  for (FrameSolver* solver : {&statics, &moves}) solver->remove_parts({&post, 1});
  statics.solve({});
  swing.rest = -statics.displacement(top).y;
  swing.peak = swing.before;
  std::vector<double> f(u.size()), v(u.size(), 0), next(u.size()), product(u.size());
  moves.load_vector({}, f);
  const std::size_t vertical = moves.freedom(top) + 1;
  for (double time = 0; time < kTime; time += kStep) {
    moves.stiffness_times(u, product);
    for (std::size_t i = 0; i < u.size(); ++i) next[i] = 2 * (f[i] - product[i]);
    moves.mass_times(v, product);
    for (std::size_t i = 0; i < u.size(); ++i) next[i] += 4 / kStep * product[i];
    moves.solve_system(next, product);
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] += product[i];
      v[i] = 2 / kStep * product[i] - v[i];
    }
    swing.note(-u[vertical]);
  }
  return swing;
}

/// Of the joints that the removed post's neighbours have: those whose load grows most.
struct Neighbours {
  Swing moment, axial;
};

/// The same through the solver "hybrid".
Neighbours forces(const Frame& intact, std::uint32_t post) {
  Frame after = intact;
  hand_over_joints(after, post);
  FrameSolver statics(after);
  statics.solve({});
  const auto value = [&](std::uint32_t j, const JointLoad& load) {
    return intact.joints[j].kind == FrameJoint::Kind::beam_end ? std::fabs(load.torque.y)
                                                               : -load.force.x;
  };
  std::vector<Swing> swings(intact.joints.size());
  std::vector<std::uint32_t> watched;
  const Vec3 top = intact.nodes[intact.members[post].to].position;
  for (std::uint32_t j = 0; j < swings.size(); ++j) {
    const FrameJoint& joint = after.joints[j];
    const bool is_beam = joint.kind == FrameJoint::Kind::beam_end;
    if (joint.a == post || joint.b == post || (!is_beam && joint.b != kNoPart)) continue;
    if (length(joint.point - top) > 8) continue;
    if (is_beam && std::fabs(joint.point.y - top.y) > 1) continue;
    watched.push_back(j);
    swings[j].before = swings[j].peak = value(j, statics.joint_load(j));
  }
  statics.remove_parts({&post, 1});
  statics.solve({});
  for (const std::uint32_t j : watched) swings[j].rest = value(j, statics.joint_load(j));
  Standing standing(intact, kStep, false);
  standing.remove(post);
  for (double time = 0; time < kTime; time += kStep) {
    standing.step();
    for (const std::uint32_t j : watched) swings[j].note(value(j, standing.motion().load(j)));
  }
  Neighbours found;
  for (const std::uint32_t j : watched) {
    const bool is_beam = intact.joints[j].kind == FrameJoint::Kind::beam_end;
    Swing& most = is_beam ? found.moment : found.axial;
    if (swings[j].peak - swings[j].before > most.peak - most.before) most = swings[j];
  }
  return found;
}

void print_case(const Size& size, const char* post, const char* expected) {
  const Frame frame = building_of(size);
  const std::uint32_t part = find_part(frame, post);
  const Swing w = deflection(frame, part, false), sheared = deflection(frame, part, true);
  const Neighbours n = forces(frame, part);
  std::printf(
      "| %s, %s | %.1f → %.1f | %.2f | %s | %.1f → %.1f | %.2f | %.0f → %.0f → %.0f | %.2f | %.0f "
      "→ "
      "%.0f → %.0f | %.2f |\n",
      name_of(size).c_str(), post, 1e3 * w.rest, 1e3 * w.peak, w.peak / w.rest, expected,
      1e3 * sheared.rest, 1e3 * sheared.peak, sheared.peak / sheared.rest, n.moment.before / 1e3,
      n.moment.rest / 1e3, n.moment.peak / 1e3, n.moment.factor(), n.axial.before / 1e3,
      n.axial.rest / 1e3, n.axial.peak / 1e3, n.axial.factor());
  std::fflush(stdout);
}

}  // namespace

void measure_dynamics() {
  const Block block("hybrid dynamics");
  std::printf(
      "| post | deflection above it, static → "
      "largest mm, no shear | factor | reference: mm, factor; moment, foot | with shear | factor | "
      "beam end's moment, before "
      "→ "
      "static → largest kN m | factor of the change | neighbour's foot kN | factor of the change "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  print_case({5, 4, 6}, "post_2_0_0", "31.3 → 59.8, 1.91; 2.20, 2.65");
  print_case({5, 4, 6}, "post_2_1_0", "40.8 → 79.5, 1.95; 2.01, 2.96");
  print_case({5, 4, 6}, "post_0_0_0", "31.1 → 54.0, 1.74; 2.03, 2.26");
  print_case({3, 3, 12}, "post_0_1_0", "34.5 → 61.3, 1.78; 1.80, 3.52");
}

}  // namespace sunder
