// SPDX-License-Identifier: GPL-3.0-or-later
// Panels as elements of a frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshing/error.hpp"
#include "sim/frame_solver.hpp"
#include "sim/panels.hpp"
#include "stocked_frame.hpp"

namespace sunder {
namespace {

/// From a panel's frame to the world: a slab lies, its y is the world's -z.
const Quaternion kLaid{-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};

const FrameSolverParams kPanels{.panels = true};

Frame breakable(std::size_t x, std::size_t z, std::size_t storeys) {
  Frame frame = stocked_frame();
  add_regular(frame, regular(x, z, storeys));
  frame.patterns.emplace_back();
  for (FrameSlab& slab : frame.slabs) slab.pattern = 0;
  join(frame);
  return frame;
}

/// The corners of a slab in the order of a laid panel: y up is z down.
std::array<std::uint32_t, 4> corners_of(const Frame& frame, const FrameSlab& slab) {
  Vec3 middle;
  for (const std::uint32_t n : slab.nodes) middle = middle + 0.25 * frame.nodes[n].position;
  std::array<std::uint32_t, 4> corners{};
  for (const std::uint32_t n : slab.nodes) {
    const Vec3 p = frame.nodes[n].position;
    corners[p.z > middle.z ? (p.x < middle.x ? 0 : 1) : (p.x < middle.x ? 3 : 2)] = n;
  }
  return corners;
}

/// A slab of a frame as chunks.
struct Slab {
  Slab(const Frame& frame, std::uint32_t slab, std::uint64_t seed, double cell = 1.5)
      : asset(panel_asset({.size = {6, 6}, .thickness = 0.15, .cell = cell}, seed)),
        hold(panel_hold({6, 6}, true)),
        network(asset, panel_concrete(), hold),
        nodes(corners_of(frame, frame.slabs[slab])),
        part(frame.slab_part(slab)) {}
  PanelElement element(bool loaded = false) {
    PanelElement result = element_of(network, nodes, kLaid, loaded);
    result.at_rest = at_rest;
    return result;
  }
  WallAsset asset;
  PanelHold hold;
  ChunkNetwork network;
  std::array<std::uint32_t, 4> nodes;
  std::uint32_t part;
  PanelFreedoms at_rest{};
};

std::vector<std::uint32_t> bonds_of(const WallAsset& asset, std::uint64_t seed, double share) {
  std::vector<std::uint32_t> bonds;
  for (std::uint32_t b = 0; b < asset.bonds.size(); ++b)
    if (random_unit(seed, b) < share) bonds.push_back(b);
  return bonds;
}

double largest(std::span<const double> v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::fabs(x));
  return most;
}

double difference(std::span<const double> a, std::span<const double> b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::fabs(a[i] - b[i]));
  return most / largest(b);
}

/// Largest difference of the joints' loads, by the largest.
double joints_apart(const Frame& frame, const FrameSolver& a, const FrameSolver& b) {
  double most = 0, worst = 0;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const JointLoad x = a.joint_load(j), y = b.joint_load(j);
    most = std::max({most, length(y.force), length(y.torque)});
    worst = std::max({worst, length(x.force - y.force), length(x.torque - y.torque)});
  }
  return worst / most;
}

FrameLoads pushed(const Frame& frame) {
  return {.contacts = {{2, frame.nodes[frame.members[2].to].position, {3e4, 1e4, -2e4}}}};
}

// The chunks keep all their freedoms there, beside the frame's.
TEST(FramePanels, ASlabOnPostsIsAsOneDenseMatrix) {
  const Frame frame = breakable(2, 2, 1);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Slab slab(frame, 0, seed, 2.5);
    slab.network.set_gravity({0, 0, -9.81});
    slab.at_rest = random_freedoms(seed, 1e-4);
    for (int step = 0; step < 2; ++step) {
      if (step == 1) slab.network.break_bonds(bonds_of(slab.asset, seed, 0.1));
      if (!slab.network.loose_chunks().empty()) continue;
      FrameSolver bare(frame), solver(frame, kPanels);
      solver.set_panel(slab.part, slab.element(true));
      solver.solve(pushed(frame));
      WallAsset left = slab.asset;
      if (step == 1) {
        left.bonds.clear();
        for (std::uint32_t b = 0; b < slab.asset.bonds.size(); ++b)
          if (slab.network.is_intact(b)) left.bonds.push_back(slab.asset.bonds[b]);
      }
      const Dense panel = DensePanel(left, panel_concrete(), slab.hold, slab.network.sites()).k;
      const std::size_t chunks = panel.size - 24, count = bare.freedoms();
      Dense k(chunks + count);
      Column f(k.size);
      std::vector<double> unit(count), column(count), load(count);
      for (std::size_t c = 0; c < count; ++c) {
        unit.assign(count, 0);
        unit[c] = 1;
        bare.stiffness_times(unit, column);
        for (std::size_t r = 0; r < count; ++r) k(chunks + r, chunks + c) = column[r];
      }
      bare.load_vector(pushed(frame), load);
      for (std::size_t r = 0; r < count; ++r) f[chunks + r] = load[r];
      // Each row of the panel's corners as shares of the frame's rows.
      std::vector<std::vector<std::pair<std::size_t, double>>> place(panel.size);
      std::vector<double> rest(panel.size);
      for (std::size_t i = 0; i < chunks; ++i) place[i] = {{i, 1}};
      for (std::size_t i = 0; i < 24; ++i) {
        const Vec3 axis{i % 3 == 0 ? 1.0 : 0, i % 3 == 1 ? 1.0 : 0, i % 3 == 2 ? 1.0 : 0};
        const Vec3 v = rotate(kLaid, axis);
        const std::size_t first = chunks + bare.freedom(slab.nodes[i / 6]) + (i % 6 < 3 ? 0 : 3);
        place[chunks + i] = {{first, v.x}, {first + 1, v.y}, {first + 2, v.z}};
        const std::size_t triple = i - i % 3;
        rest[chunks + i] = v.x * slab.at_rest[triple] + v.y * slab.at_rest[triple + 1] +
                           v.z * slab.at_rest[triple + 2];
      }
      for (std::size_t r = 0; r < panel.size; ++r) {
        long double back = 0;
        for (std::size_t c = 0; c < panel.size; ++c) {
          back += panel(r, c) * rest[c];
          if (panel(r, c) == 0) continue;
          for (const auto& [row, a] : place[r])
            for (const auto& [at, b] : place[c]) k(row, at) += panel(r, c) * a * b;
        }
        for (const auto& [row, a] : place[r]) f[row] += a * back;
      }
      for (std::size_t c = 0; c < slab.asset.chunks.size(); ++c)
        f[6 * c + 2] -= 2400 * slab.asset.chunks[c].volume * 9.81;
      const Column exact = solved(k, f);
      std::vector<double> u(count);
      for (std::size_t i = 0; i < count; ++i) u[i] = static_cast<double>(exact[chunks + i]);
      EXPECT_LT(difference(solver.displacements(), u), 1e-9) << "seed " << seed;
      bare.solve(pushed(frame));
      EXPECT_GT(difference(bare.displacements(), u), 1e-3) << "seed " << seed;
      // The slab's joints carry what its edges' anchors do in the dense solution.
      FrameSolver again(frame, kPanels);
      again.set_panel(slab.part, slab.element(true));
      again.set_displacements(u, pushed(frame));
      EXPECT_LT(joints_apart(frame, solver, again), 1e-9) << "seed " << seed;
    }
  }
}

/// Force and moment about a point of all that the ground gives.
JointLoad ground(const Frame& frame, const FrameSolver& solver) {
  JointLoad sum;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    if (frame.joints[j].b != kNoPart) continue;
    const Vec3 force = solver.reaction(j);
    sum.force = sum.force + force;
    sum.torque = sum.torque + solver.reaction_moment(j) +
                 cross(frame.nodes[frame.joints[j].node].position, force);
  }
  return sum;
}

// The network's own solution of the same corners, edge by edge.
TEST(FramePanels, ItsJointsCarryWhatTheAnchorsOfTheirEdgesDo) {
  const Frame frame = breakable(2, 3, 2);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Slab slab(frame, 2, seed);
    slab.network.set_gravity({0, 0, -9.81});
    slab.network.break_bonds(bonds_of(slab.asset, seed, 0.05));
    FrameSolver bare(frame), solver(frame, kPanels);
    solver.set_panel(slab.part, slab.element(true));
    const FrameLoads loads = pushed(frame);
    solver.solve(loads);
    bare.solve(loads);
    PanelFreedoms corners{};
    for (std::size_t c = 0; c < 4; ++c) {
      const Vec3 u = rotate(conjugate(kLaid), solver.displacement(slab.nodes[c]));
      const Vec3 r = rotate(conjugate(kLaid), solver.rotation(slab.nodes[c]));
      std::ranges::copy(std::array{u.x, u.y, u.z, r.x, r.y, r.z}, corners.begin() + 6 * c);
    }
    const PanelState state = slab.network.solve(corners);
    Vec3 middle;
    for (const std::uint32_t n : slab.nodes) middle = middle + 0.25 * frame.nodes[n].position;
    double largest_force = 0;
    for (std::size_t k = 0; k < 4; ++k)
      largest_force =
          std::max(largest_force,
                   length(slab.network.reaction(state, static_cast<std::uint32_t>(k), {}).force));
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
      const FrameJoint& joint = frame.joints[j];
      if (joint.a != slab.part) continue;
      std::uint32_t edge = 4;
      for (std::uint32_t k = 0; k < 4; ++k) {
        const FrameMember& m = frame.members[joint.b];
        const std::uint32_t p = slab.nodes[k], q = slab.nodes[(k + 1) % 4];
        if ((m.from == p && m.to == q) || (m.from == q && m.to == p)) edge = k;
      }
      ASSERT_LT(edge, 4u);
      const Vec3 origin = middle - rotate(kLaid, Vec3{3, 3, 0});
      const Vec3 about = rotate(conjugate(kLaid), joint.point - origin);
      const Reaction anchors = slab.network.reaction(state, edge, about);
      const JointLoad with = solver.joint_load(j), without = bare.joint_load(j);
      const Vec3 force = joint.axes * (with.force - without.force);
      const Vec3 torque = joint.axes * (with.torque - without.torque);
      EXPECT_LT(length(force + rotate(kLaid, anchors.force)), 1e-9 * largest_force) << seed;
      EXPECT_LT(length(torque + rotate(kLaid, anchors.moment)), 6e-9 * largest_force) << seed;
    }
  }
}

TEST(FramePanels, TheGroundCarriesWeightContactsAndWhatPanelsAreLoadedBy) {
  const Frame frame = breakable(2, 2, 2);
  Slab slab(frame, 1, 4);
  FrameSolver bare(frame), solver(frame, kPanels);
  slab.at_rest = random_freedoms(7, 1e-4);
  solver.set_panel(slab.part, slab.element());
  solver.solve(pushed(frame));
  bare.solve(pushed(frame));
  EXPECT_LT(solver.residual(), 1e-10);
  const JointLoad a = ground(frame, solver), b = ground(frame, bare);
  EXPECT_LT(length(a.force - b.force), 1e-10 * length(b.force));
  EXPECT_LT(length(a.torque - b.torque), 1e-10 * length(b.torque));
  const double before = length(a.force);
  slab.network.set_gravity({0, 0, -9.81});
  solver.set_panel(slab.part, slab.element(true));
  solver.solve(pushed(frame));
  EXPECT_NEAR(length(ground(frame, solver).force - b.force), slab.network.mass() * 9.81,
              1e-10 * before);
}

/// Moment that a slab's edges put on a hinged end of the member along one of them, world.
Vec3 passed_by(const Frame& frame, const FrameSolver& solver, const PanelElement& element,
               const FrameJoint& joint) {
  PanelFreedoms moved{};
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 u = solver.displacement(element.nodes[c]), r = solver.rotation(element.nodes[c]);
    std::ranges::copy(std::array{u.x, u.y, u.z, r.x, r.y, r.z},
                      moved.begin() + static_cast<std::ptrdiff_t>(6 * c));
  }
  const FrameMember& m = frame.members[joint.a];
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t p = element.nodes[k], q = element.nodes[(k + 1) % 4];
    if (!(m.from == p && m.to == q) && !(m.from == q && m.to == p)) continue;
    std::array<double, 3> moment{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t row = (joint.node == p ? 3 : 9) + i;
      moment[i] = -element.load[k][row];
      for (std::size_t c = 0; c < 24; ++c)
        moment[i] -= element.edges[k][24 * row + c] * (moved[c] - element.at_rest[c]);
    }
    return {moment[0], moment[1], moment[2]};
  }
  return {};
}

// Its end joints, what it carries and its weight, about the origin. Of beams on hinges what the
// slab puts on their ends as moments goes on to the posts.
void expect_balance(const Frame& frame, bool hinged) {
  for (std::uint32_t s = 0; s < frame.slabs.size(); ++s) {
    Slab slab(frame, s, 10 + s);
    slab.at_rest = random_freedoms(s, 1e-4);
    slab.network.set_gravity({0, 0, -9.81});
    FrameSolver solver(frame, kPanels);
    solver.set_panel(slab.part, slab.element(true));
    solver.solve({});
    std::vector<Vec3> force(frame.members.size()), moment(force.size());
    const auto add = [&](std::uint32_t m, Vec3 at, Vec3 f, Vec3 turn) {
      force[m] = force[m] + f;
      moment[m] = moment[m] + turn + cross(at, f);
    };
    double most = 0;
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
      const FrameJoint& joint = frame.joints[j];
      const JointLoad load = solver.joint_load(j);
      most = std::max(most, length(load.force));
      if (joint.node == kNoPart) {
        add(joint.b, joint.point, joint.axes * load.force, joint.axes * load.torque);
        continue;
      }
      const Vec3 at = frame.nodes[joint.node].position;
      const bool beam = frame.members[joint.a].kind == FrameMember::Kind::beam;
      add(joint.a, at, solver.reaction(j), solver.reaction_moment(j));
      if (!frame.classes[joint.joint_class].rigid)
        add(joint.b, at, {}, passed_by(frame, solver, slab.element(true), joint));
      const double side = joint.end_a == 1 ? -1 : 1;
      const Vec3 passed =
          hinged && beam ? Vec3{} : side * passed_by(frame, solver, slab.element(true), joint);
      EXPECT_LT(length(joint.axes * solver.panel_moment(j) - passed), 1e-10 * most) << joint.name;
      if (joint.b != kNoPart)
        add(joint.b, at, -1 * solver.reaction(j), -1 * solver.reaction_moment(j));
    }
    for (std::uint32_t m = 0; m < frame.members.size(); ++m) {
      const FrameMember& member = frame.members[m];
      const Vec3 a = frame.nodes[member.from].position, b = frame.nodes[member.to].position;
      const double mass = frame.steels[0].density * frame.sections[member.section].area;
      add(m, 0.5 * (a + b), {0, -9.81 * mass * length(b - a), 0}, {});
      EXPECT_LT(length(force[m]), 1e-10 * most) << member.name;
      if (hinged && member.kind == FrameMember::Kind::beam) continue;
      EXPECT_LT(length(moment[m]), 1e-9 * most) << member.name;  // arms of some 10 m
    }
  }
}

TEST(FramePanels, EveryMemberIsInBalance) {
  Frame frame = breakable(3, 2, 2);
  expect_balance(frame, false);
  for (const FrameJoint& joint : frame.joints)
    if (joint.node != kNoPart && frame.members[joint.a].kind == FrameMember::Kind::beam)
      frame.classes[joint.joint_class].rigid = false;
  expect_balance(frame, true);
}

TEST(FramePanels, RigidMotionsStrainNoPanel) {
  const Frame frame = breakable(3, 2, 2);
  FrameSolver bare(frame), solver(frame, kPanels);
  Slab slab(frame, 1, 3);
  slab.network.break_bonds(bonds_of(slab.asset, 3, 0.05));
  solver.set_panel(slab.part, slab.element());
  std::vector<double> u(solver.freedoms()), a(u.size()), b(u.size()), stretched(u.size());
  for (const auto& [move, turn] :
       {std::pair{Vec3{1, 2, 3}, Vec3{}}, {Vec3{}, Vec3{0.3, -1, 0.5}}}) {
    for (std::uint32_t n = 0; n < frame.nodes.size(); ++n) {
      const std::size_t first = solver.freedom(n);
      if (first == FrameSolver::kHeld) continue;
      const Vec3 v = move + cross(turn, frame.nodes[n].position);
      std::ranges::copy(std::array{v.x, v.y, v.z, turn.x, turn.y, turn.z},
                        u.begin() + static_cast<std::ptrdiff_t>(first));
    }
    solver.stiffness_times(u, a);
    bare.stiffness_times(u, b);
    const PanelMatrix k = stiffness_of(slab.element());
    EXPECT_LT(difference(a, b) * largest(b), 1e-9 * largest(k) * largest(u));
  }
}

TEST(FramePanels, UpdatesAreAsIfBuiltAnewAndWithoutPanelsAsBefore) {
  const Frame frame = breakable(3, 3, 3);
  const FrameLoads loads = pushed(frame);
  for (const double mass : {0.0, 1e4}) {
    const FrameSolverParams params{.mass = mass, .panels = true};
    FrameSolver bare(frame, params), solver(frame, params);
    std::vector<Slab> slabs;
    for (std::uint32_t s = 0; s < 4; ++s) slabs.emplace_back(frame, 2 * s, s);
    for (int step = 0; step < 4; ++step) {
      FrameSolver anew(frame, params);
      for (std::uint32_t s = 0; s < 4; ++s) {
        if (step > 0)
          slabs[s].network.break_bonds(bonds_of(slabs[s].asset, 10 * s + step, 0.1 * step));
        slabs[s].at_rest = random_freedoms(s, 1e-4);
        solver.set_panel(slabs[s].part, slabs[s].element());
        anew.set_panel(slabs[s].part, slabs[s].element());
      }
      solver.solve(loads);
      anew.solve(loads);
      EXPECT_LT(difference(solver.displacements(), anew.displacements()), 1e-9) << step;
      EXPECT_LT(joints_apart(frame, solver, anew), 1e-9) << step;
      EXPECT_LT(solver.residual(), 1e-10);
    }
    for (const Slab& slab : slabs) solver.clear_panel(slab.part);
    solver.solve(loads);
    bare.solve(loads);
    EXPECT_LT(difference(solver.displacements(), bare.displacements()), 1e-9);
    EXPECT_LT(joints_apart(frame, solver, bare), 1e-9);
    EXPECT_LT(std::fabs(solver.strain_energy() / bare.strain_energy() - 1), 1e-9);
  }
}

TEST(FramePanels, GoWithTheirJointsAndBeams) {
  const Frame frame = breakable(2, 2, 2);
  for (const char* name : {"slab_0_0_1@beam_x_0_0_1", "beam_x_0_0_1@post_0_0_1"}) {
    std::uint32_t joint = kNoPart;
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (frame.joints[j].name == name) joint = j;
    ASSERT_NE(joint, kNoPart) << name;
    FrameSolver bare(frame), solver(frame, kPanels);
    Slab slab(frame, 1, 1);
    solver.set_panel(slab.part, slab.element());
    for (FrameSolver* each : {&bare, &solver}) {
      each->break_joints({&joint, 1});
      each->solve({});
    }
    EXPECT_LT(difference(solver.displacements(), bare.displacements()), 1e-9) << name;
    EXPECT_LT(joints_apart(frame, solver, bare), 1e-9) << name;
  }
}

TEST(FramePanels, AreRefusedWhereThereIsNone) {
  const Frame frame = breakable(2, 2, 1);
  Slab slab(frame, 0, 1);
  PanelElement wrong = slab.element();
  wrong.nodes[0] = wrong.nodes[1];
  FrameSolver solver(frame, kPanels);
  EXPECT_THROW(solver.set_panel(slab.part, wrong), Error);
  EXPECT_THROW(solver.set_panel(0, slab.element()), Error);
  EXPECT_THROW(FrameSolver(frame).set_panel(slab.part, slab.element()), Error);
  Frame whole = frame;
  whole.slabs[0].pattern = kNoPart;
  EXPECT_THROW(FrameSolver(whole, kPanels).set_panel(slab.part, slab.element()), Error);
}

// Corners, edges and joints of a turned panel are the same.
TEST(FramePanels, TheFirstCornerIsNoMatter) {
  const Frame frame = breakable(2, 2, 1);
  Slab slab(frame, 0, 2);
  slab.at_rest = random_freedoms(5, 1e-4);
  PanelElement element = slab.element(), shifted = element;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t from = (k + 1) % 4;
    shifted.nodes[k] = element.nodes[from];
    for (std::size_t i = 0; i < 6; ++i) shifted.at_rest[6 * k + i] = element.at_rest[6 * from + i];
    for (std::size_t r = 0; r < 12; ++r)
      for (std::size_t c = 0; c < 24; ++c)
        shifted.edges[k][24 * r + c] = element.edges[from][24 * r + (c + 6) % 24];
  }
  FrameSolver a(frame, kPanels), b(frame, kPanels);
  a.set_panel(slab.part, element);
  b.set_panel(slab.part, shifted);
  a.solve(pushed(frame));
  b.solve(pushed(frame));
  EXPECT_LT(difference(a.displacements(), b.displacements()), 1e-11);
  EXPECT_LT(joints_apart(frame, a, b), 1e-11);
}

// A grid of squares on four posts, pulled at rest towards its middle.
TEST(FramePanels, ASymmetricSlabMovesItsPostsAlike) {
  const Frame frame = breakable(2, 2, 1);
  Slab slab(frame, 0, 1);
  const WallAsset asset = panel_asset({{6, 6}, 0.15, 1.5, 0}, 1);
  ChunkNetwork network(asset, panel_concrete(), slab.hold);
  network.set_gravity({0, 0, -9.81});
  PanelElement element = element_of(network, slab.nodes, kLaid, true);
  Vec3 middle;
  for (const std::uint32_t n : slab.nodes) middle = middle + 0.25 * frame.nodes[n].position;
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 in = -1e-4 * (frame.nodes[slab.nodes[c]].position - middle);
    element.at_rest[6 * c] = in.x;
    element.at_rest[6 * c + 2] = in.z;
  }
  FrameSolver solver(frame, kPanels);
  solver.set_panel(slab.part, element);
  solver.solve({});
  const Vec3 first = solver.displacement(slab.nodes[0]);
  EXPECT_LT(first.y, -1e-5);
  EXPECT_GT(std::fabs(first.x), 1e-5);
  const double signs[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 u = solver.displacement(slab.nodes[c]);
    const Vec3 mirrored{signs[c][0] * first.x, first.y, signs[c][1] * first.z};
    EXPECT_LT(length(u - mirrored), 1e-9 * length(first)) << "corner " << c;
  }
}

// The trapezoidal rule keeps the energy of a linear system but for rounding.
TEST(FramePanels, ARingingFrameKeepsItsEnergy) {
  const Frame frame = breakable(2, 2, 2);
  const double dt = 2e-3;
  FrameSolver solver(frame, {.mass = 4 / (dt * dt), .panels = true});
  Slab slab(frame, 1, 6);
  slab.at_rest = random_freedoms(2, 1e-3);
  slab.network.set_gravity({0, 0, -9.81});
  solver.set_panel(slab.part, slab.element(true));
  const std::size_t count = solver.freedoms();
  std::vector<double> u(count), v(count), f(count), springs(count), momentum(count), w(count);
  const FrameLoads loads;
  solver.load_vector(loads, f);
  const auto energy = [&] {
    solver.set_displacements(u, loads);
    solver.mass_times(v, momentum);
    double kinetic = 0;
    for (std::size_t i = 0; i < count; ++i) kinetic += v[i] * momentum[i] / 2;
    return std::pair{kinetic + solver.strain_energy() - solver.work_of(loads), kinetic};
  };
  const double first = energy().first;
  double most = 0, worst = 0;
  for (int step = 0; step < 1000; ++step) {
    solver.stiffness_times(u, springs);
    solver.mass_times(v, momentum);
    for (std::size_t i = 0; i < count; ++i) w[i] = 2 * f[i] - 2 * springs[i] + 4 / dt * momentum[i];
    std::vector<double> way(count);
    solver.solve_system(w, way);
    for (std::size_t i = 0; i < count; ++i) {
      u[i] += way[i];
      v[i] = 2 / dt * way[i] - v[i];
    }
    if (step % 10 != 0) continue;
    const auto [now, kinetic] = energy();
    most = std::max(most, kinetic);
    worst = std::max(worst, std::fabs(now - first));
  }
  EXPECT_GT(most, 10);
  EXPECT_LT(worst, 1e-9 * most);
}

}  // namespace
}  // namespace sunder
