// SPDX-License-Identifier: GPL-3.0-or-later
// Slabs and walls as elements of a frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "meshing/error.hpp"
#include "sim/frame_solver.hpp"
#include "sim/panels.hpp"
#include "sim/part_pose.hpp"
#include "stocked_frame.hpp"

namespace sunder {
namespace {

Frame breakable(std::size_t x, std::size_t z, std::size_t storeys, double walls = 0) {
  Frame frame = stocked_frame();
  add_regular(frame, regular(x, z, storeys, walls));
  join(frame);
  return frame;
}

const std::array<std::uint32_t, 4>& nodes_of(const Frame& frame, std::uint32_t part) {
  return part < frame.wall_part(0) ? frame.slabs[part - frame.slab_part(0)].nodes
                                   : frame.walls[part - frame.wall_part(0)].nodes;
}

/// Room for all of them, without stiffness yet.
FrameSolverParams with_panels(const Frame& frame, double mass = 0) {
  FrameSolverParams params{.mass = mass};
  for (std::uint32_t part = frame.slab_part(0); part < frame.part_count(); ++part)
    params.panels.push_back({part, nodes_of(frame, part), {}, {}});
  return params;
}

/// A slab or wall of a frame as chunks from node to node.
struct Chunks {
  Chunks(const Frame& frame, std::uint32_t number, std::uint64_t seed, double cell = 1.5)
      : part(number), nodes(nodes_of(frame, number)) {
    const Vec3 a = frame.nodes[nodes[0]].position, b = frame.nodes[nodes[1]].position;
    const Vec3 d = frame.nodes[nodes[3]].position;
    const Vec2 size{length(b - a), length(d - a)};
    const Axes axes{1 / size.x * (b - a), 1 / size.y * (d - a),
                    1 / (size.x * size.y) * cross(b - a, d - a)};
    to_world = rotation_of(axes);
    asset = panel_asset({.size = size, .thickness = 0.15, .cell = cell}, seed);
    hold = straight_hold(size);
    network.emplace(asset, panel_concrete(), hold);
    for (std::size_t i = 0; i < 12; ++i) at_rest[i] = 1e-4 * (2 * random_unit(seed, 200 + i) - 1);
  }
  PanelElement element() { return {part, nodes, stiffness_of(*network, to_world), at_rest}; }
  std::uint32_t part;
  std::array<std::uint32_t, 4> nodes;
  Quaternion to_world;
  WallAsset asset;
  PanelHold hold;
  std::optional<ChunkNetwork> network;
  Twelve at_rest{};
};

void set(FrameSolver& solver, const PanelElement& element) {
  solver.set_panels({&element, 1});
}

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

/// The frame and the panel's chunks, with all their freedoms, in one system.
std::vector<double> dense_solution(const Frame& frame, const Chunks& panel) {
  FrameSolver bare(frame);
  WallAsset left = panel.asset;
  left.bonds.clear();
  for (std::uint32_t b = 0; b < panel.asset.bonds.size(); ++b)
    if (panel.network->is_intact(b)) left.bonds.push_back(panel.asset.bonds[b]);
  const Dense of_panel = DensePanel(left, panel_concrete(), panel.hold, panel.network->sites()).k;
  const std::size_t chunks = of_panel.size - 24, count = bare.freedoms();
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
  // Each row of the panel's corners as shares of the frame's rows; those of supports stand still.
  std::vector<std::vector<std::pair<std::size_t, double>>> place(of_panel.size);
  std::vector<double> rest(of_panel.size);
  for (std::size_t i = 0; i < chunks; ++i) place[i] = {{i, 1}};
  for (std::size_t i = 0; i < 24; ++i) {
    if (i % 6 >= 3) continue;
    const Vec3 axis{i % 3 == 0 ? 1.0 : 0, i % 3 == 1 ? 1.0 : 0, i % 3 == 2 ? 1.0 : 0};
    const Vec3 v = rotate(panel.to_world, axis);
    const std::size_t triple = 3 * (i / 6);
    rest[chunks + i] = v.x * panel.at_rest[triple] + v.y * panel.at_rest[triple + 1] +
                       v.z * panel.at_rest[triple + 2];
    const std::size_t own = bare.freedom(panel.nodes[i / 6]);
    if (own == FrameSolver::kHeld) continue;
    const std::size_t first = chunks + own;
    place[chunks + i] = {{first, v.x}, {first + 1, v.y}, {first + 2, v.z}};
  }
  for (std::size_t r = 0; r < of_panel.size; ++r) {
    long double back = 0;
    for (std::size_t c = 0; c < of_panel.size; ++c) {
      back += of_panel(r, c) * rest[c];
      if (of_panel(r, c) == 0) continue;
      for (const auto& [row, a] : place[r])
        for (const auto& [at, b] : place[c]) k(row, at) += of_panel(r, c) * a * b;
    }
    for (const auto& [row, a] : place[r]) f[row] += a * back;
  }
  const Column exact = solved(k, f);
  std::vector<double> u(count);
  for (std::size_t i = 0; i < count; ++i) u[i] = static_cast<double>(exact[chunks + i]);
  return u;
}

TEST(FramePanels, ASlabOrWallIsAsOneDenseMatrixOfItsChunksAndTheFrame) {
  const Frame frame = breakable(2, 2, 1, 0.1);
  for (const char* name : {"slab_0_0_0", "wall_x_0_1_0"})
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      Chunks panel(frame, find_part(frame, name), seed, 2.5);
      for (int step = 0; step < 2; ++step) {
        if (step == 1) panel.network->break_bonds(bonds_of(panel.asset, seed, 0.1));
        ASSERT_TRUE(panel.network->loose_chunks().empty()) << name << ", seed " << seed;
        FrameSolver bare(frame), solver(frame, with_panels(frame));
        set(solver, panel.element());
        solver.solve(pushed(frame));
        bare.solve(pushed(frame));
        const std::vector<double> u = dense_solution(frame, panel);
        EXPECT_LT(difference(solver.displacements(), u), 1e-9) << name << ", seed " << seed;
        EXPECT_GT(difference(bare.displacements(), u), 1e-3) << name << ", seed " << seed;
      }
    }
}

TEST(FramePanels, AWallResistsRackingAsAShearPanel) {
  const Frame frame = breakable(2, 2, 1, 0.1);
  const Matrix12 k = Chunks(frame, find_part(frame, "wall_x_0_1_0"), 3).element().stiffness;
  double racking = 0;  // force along x of the upper corners, both moved by one
  for (const std::size_t r : {6, 9})
    for (const std::size_t c : {6, 9}) racking += k.at[12 * r + c];
  const double g = 33.6e9 / 2, area = 6 * 0.15;
  EXPECT_NEAR(racking / (g * area / 3.5), 1, 1e-7);
}

TEST(FramePanels, TheGroundAndThePanelsNodesThereCarryTheLoads) {
  const Frame frame = breakable(2, 2, 2);
  Chunks slab(frame, frame.slab_part(1), 4);
  FrameSolver bare(frame), solver(frame, with_panels(frame));
  set(solver, slab.element());
  solver.solve(pushed(frame));
  bare.solve(pushed(frame));
  EXPECT_LT(solver.residual(), 1e-10);
  Vec3 a, b, turn_a, turn_b;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    if (frame.joints[j].b != kNoPart) continue;
    const Vec3 at = frame.nodes[frame.joints[j].node].position;
    a = a + solver.reaction(j);
    b = b + bare.reaction(j);
    turn_a = turn_a + solver.reaction_moment(j) + cross(at, solver.reaction(j));
    turn_b = turn_b + bare.reaction_moment(j) + cross(at, bare.reaction(j));
  }
  EXPECT_LT(length(a - b), 1e-10 * length(b));
  EXPECT_LT(length(turn_a - turn_b), 1e-10 * length(turn_b));
}

TEST(FramePanels, MembersAreInBalanceAndPanelsTwistNone) {
  const Frame frame = breakable(3, 2, 2, 0.1);
  FrameSolver solver(frame, with_panels(frame));
  for (const char* name : {"slab_1_0_0", "wall_x_0_1_1", "wall_z_0_0_0"})
    set(solver, Chunks(frame, find_part(frame, name), 5).element());
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
    // Of beams alone: posts also get what panels put on their nodes.
    if (frame.members[joint.a].kind != FrameMember::Kind::beam) continue;
    add(joint.a, frame.nodes[joint.node].position, solver.reaction(j), solver.reaction_moment(j));
  }
  for (std::uint32_t m = 0; m < frame.members.size(); ++m) {
    const FrameMember& member = frame.members[m];
    if (member.kind != FrameMember::Kind::beam) continue;
    const Vec3 a = frame.nodes[member.from].position, b = frame.nodes[member.to].position;
    const double mass = frame.steels[0].density * frame.sections[member.section].area;
    add(m, 0.5 * (a + b), {0, -9.81 * mass * length(b - a), 0}, {});
    EXPECT_LT(length(force[m]), 1e-10 * most) << member.name;
    EXPECT_LT(length(moment[m]), 1e-9 * most) << member.name;  // arms of some 10 m
  }
}

TEST(FramePanels, RigidMotionsStrainNoPanel) {
  const Frame frame = breakable(3, 2, 2, 0.1);
  FrameSolver bare(frame), solver(frame, with_panels(frame));
  double stiffest = 0;
  for (const char* name : {"slab_1_0_0", "wall_z_2_0_1"}) {
    Chunks panel(frame, find_part(frame, name), 3);
    panel.network->break_bonds(bonds_of(panel.asset, 3, 0.05));
    set(solver, panel.element());
    stiffest = std::max(stiffest, largest(panel.element().stiffness.at));
  }
  std::vector<double> u(solver.freedoms()), a(u.size()), b(u.size());
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
    EXPECT_LT(difference(a, b) * largest(b), 1e-9 * stiffest * largest(u));
  }
}

TEST(FramePanels, UpdatesAreAsIfBuiltAnewAndWithoutStiffnessAsBefore) {
  const Frame frame = breakable(3, 3, 2, 0.1);
  const FrameLoads loads = pushed(frame);
  const std::uint32_t parts[] = {frame.slab_part(0), frame.slab_part(3), frame.wall_part(2),
                                 frame.wall_part(9)};
  for (const double mass : {0.0, 1e4}) {
    const FrameSolverParams params = with_panels(frame, mass);
    FrameSolver bare(frame, {.mass = mass}), solver(frame, params);
    std::vector<Chunks> panels;
    for (std::uint32_t i = 0; i < 4; ++i) panels.emplace_back(frame, parts[i], i);
    for (int step = 0; step < 4; ++step) {
      std::vector<PanelElement> elements;
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (step > 0)
          panels[i].network->break_bonds(bonds_of(panels[i].asset, 10 * i + step, 0.1 * step));
        elements.push_back(panels[i].element());
      }
      FrameSolver anew(frame, params);
      for (FrameSolver* each : {&solver, &anew}) {
        each->set_panels(elements);
        each->solve(loads);
      }
      EXPECT_LT(difference(solver.displacements(), anew.displacements()), 1e-9) << step;
      EXPECT_LT(joints_apart(frame, solver, anew), 1e-9) << step;
      EXPECT_LT(solver.residual(), 1e-10);
    }
    for (Chunks& panel : panels) {
      PanelElement nothing = panel.element();
      nothing.stiffness = {};
      set(solver, nothing);
    }
    solver.solve(loads);
    bare.solve(loads);
    EXPECT_LT(difference(solver.displacements(), bare.displacements()), 1e-9);
    EXPECT_LT(joints_apart(frame, solver, bare), 1e-9);
    EXPECT_LT(std::fabs(solver.strain_energy() / bare.strain_energy() - 1), 1e-9);
  }
}

TEST(FramePanels, GoForGoodWithTheirJointsAndMembers) {
  const Frame frame = breakable(2, 2, 2, 0.1);
  for (const auto& [part, name] : {std::pair{"slab_0_0_1", "slab_0_0_1@beam_x_0_0_1"},
                                   {"slab_0_0_1", "beam_x_0_0_1@post_0_0_1"},
                                   {"wall_x_0_1_0", "wall_x_0_1_0@post_0_1_0"},
                                   {"wall_x_0_1_1", "post_1_1_1@post_1_1_0"}}) {
    std::uint32_t joint = kNoPart;
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (frame.joints[j].name == name) joint = j;
    ASSERT_NE(joint, kNoPart) << name;
    FrameSolver bare(frame), solver(frame, with_panels(frame));
    Chunks panel(frame, find_part(frame, part), 1);
    set(solver, panel.element());
    solver.solve({});
    EXPECT_TRUE(solver.panel_motion(panel.part)) << name;
    for (FrameSolver* each : {&bare, &solver}) {
      each->break_joints({&joint, 1});
      if (each == &solver) set(solver, panel.element());
      each->solve({});
    }
    EXPECT_FALSE(solver.panel_motion(panel.part)) << name;
    EXPECT_LT(difference(solver.displacements(), bare.displacements()), 1e-9) << name;
    EXPECT_LT(joints_apart(frame, solver, bare), 1e-9) << name;
  }
}

TEST(FramePanels, TellHowTheirCornersMovedFromWhereTheyAreAtRest) {
  const Frame frame = breakable(2, 2, 1, 0.1);
  FrameSolver solver(frame, with_panels(frame));
  Chunks wall(frame, frame.wall_part(0), 2);
  EXPECT_FALSE(FrameSolver(frame).panel_motion(wall.part));
  set(solver, wall.element());
  solver.solve(pushed(frame));
  const Twelve moved = solver.panel_motion(wall.part).value();
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 u = solver.displacement(wall.nodes[c]);
    EXPECT_DOUBLE_EQ(moved[3 * c], u.x - wall.at_rest[3 * c]);
    EXPECT_DOUBLE_EQ(moved[3 * c + 1], u.y - wall.at_rest[3 * c + 1]);
    EXPECT_DOUBLE_EQ(moved[3 * c + 2], u.z - wall.at_rest[3 * c + 2]);
  }
}

TEST(FramePanels, AreRefusedWhereThereIsNone) {
  const Frame frame = breakable(2, 2, 1);
  Chunks slab(frame, frame.slab_part(0), 1);
  PanelElement wrong = slab.element();
  wrong.nodes[0] = wrong.nodes[1];
  FrameSolver solver(frame, with_panels(frame));
  EXPECT_THROW(set(solver, wrong), Error);
  wrong = slab.element();
  for (const std::uint32_t part : {0u, frame.part_count()}) {
    wrong.part = part;
    EXPECT_THROW(set(solver, wrong), Error);
  }
  FrameSolver bare(frame);
  EXPECT_THROW(set(bare, slab.element()), Error);
  for (const std::uint32_t part : {0u, frame.part_count()}) {
    FrameSolverParams params;
    params.panels = {slab.element()};
    params.panels[0].part = part;
    EXPECT_THROW(FrameSolver(frame, params), Error);
  }
}

// Corners of a turned panel are the same.
TEST(FramePanels, TheFirstCornerIsNoMatter) {
  const Frame frame = breakable(2, 2, 1);
  Chunks slab(frame, frame.slab_part(0), 2);
  const PanelElement element = slab.element();
  PanelElement shifted = element;
  for (std::size_t i = 0; i < 12; ++i) {
    shifted.nodes[i / 3] = element.nodes[(i / 3 + 1) % 4];
    shifted.at_rest[i] = element.at_rest[(i + 3) % 12];
    for (std::size_t c = 0; c < 12; ++c)
      shifted.stiffness.at[12 * i + c] = element.stiffness.at[12 * ((i + 3) % 12) + (c + 3) % 12];
  }
  FrameSolver a(frame, with_panels(frame)), b(frame, with_panels(frame));
  set(a, element);
  set(b, shifted);
  a.solve(pushed(frame));
  b.solve(pushed(frame));
  EXPECT_LT(difference(a.displacements(), b.displacements()), 1e-11);
  EXPECT_LT(joints_apart(frame, a, b), 1e-11);
}

// The trapezoidal rule keeps the energy of a linear system but for rounding.
TEST(FramePanels, ARingingFrameKeepsItsEnergy) {
  const Frame frame = breakable(2, 2, 2, 0.1);
  const double dt = 2e-3;
  FrameSolver solver(frame, with_panels(frame, 4 / (dt * dt)));
  set(solver, Chunks(frame, frame.slab_part(1), 6).element());
  set(solver, Chunks(frame, frame.wall_part(1), 6).element());
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
