// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers against others of the same building: in the same order again, of a piece alone, after
// other loads.
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <memory>
#include <random>
#include <stdexcept>

#include "meshing/error.hpp"
#include "sim/frame_solver.hpp"
#include "stocked_frame.hpp"

namespace sunder {
namespace {

Frame tower(std::size_t x, std::size_t z, std::size_t storeys, double wall = 0) {
  Frame frame = stocked_frame();
  frame.materials[0].youngs_modulus = 3e10;
  add_regular(frame, regular(x, z, storeys, wall));
  join(frame);
  return frame;
}

std::vector<double> displacements_under(FrameSolver& solver, const FrameLoads& loads) {
  solver.solve(loads);
  return {solver.displacements().begin(), solver.displacements().end()};
}

TEST(FrameSolver, TheOrderOfAnotherGivesTheSameBits) {
  const Frame frame = tower(4, 3, 5, 0.2);
  FrameSolver first(frame);
  first.break_joints(std::vector<std::uint32_t>{3, 40, 77});
  for (const FrameSolverParams& params :
       {FrameSolverParams{}, FrameSolverParams{.stiffness = 1.1, .mass = 3e4}}) {
    FrameSolver anew(frame, params), again(frame, params, first);
    const std::vector<std::uint32_t> broken{5, 11, 120};
    anew.break_joints(broken);
    again.break_joints(broken);
    const FrameLoads loads{.contacts = {{7, {3, 2, 1}, {0, 0, 9e3}}}};
    EXPECT_EQ(displacements_under(again, loads), displacements_under(anew, loads));
    EXPECT_EQ(again.counts().nonzeros, anew.counts().nonzeros);
  }
}

TEST(FrameSolver, AnotherIsMadeWhileTheFirstIsAtWork) {
  const Frame frame = tower(4, 3, 5);
  const FrameLoads loads{.contacts = {{7, {3, 2, 1}, {0, 0, 9e3}}}};
  FrameSolver first(frame);
  auto made = std::async(std::launch::async, [&] {
    return std::make_unique<FrameSolver>(frame, FrameSolverParams{}, first);
  });
  for (std::uint32_t joint = 0; joint < 5; ++joint) {
    first.break_joints({&joint, 1});
    first.solve(loads);
  }
  FrameSolver anew(frame);
  EXPECT_EQ(displacements_under(*made.get(), loads), displacements_under(anew, loads));
}

TEST(FrameSolver, TheOrderOfAnotherFrameIsRefused) {
  const Frame frame = tower(3, 3, 2), larger = tower(3, 3, 3);
  const FrameSolver solver(frame), other(larger);
  EXPECT_THROW(FrameSolver(larger, {}, solver), Error);
  // As many nodes, but slabs join more of them.
  EXPECT_THROW(FrameSolver(frame, {.slabs = "diaphragm"}, solver), Error);
}

/// Parts of a frame as one of their own; in `of` the part for each of its parts.
struct Piece {
  Frame frame;
  std::vector<std::uint32_t> joint_of, wall_of;
  std::vector<std::uint32_t> part_in;  ///< by the whole's parts
};

/// Largest set of parts above the ground that joints not broken connect.
std::vector<std::uint8_t> flying(const Frame& frame, const std::vector<std::uint8_t>& broken) {
  const std::uint32_t ground = frame.part_count();
  std::vector<std::uint32_t> group(ground + 1);
  for (std::uint32_t i = 0; i <= ground; ++i) group[i] = i;
  for (bool merged = true; merged;) {
    merged = false;
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
      if (broken[j]) continue;
      std::uint32_t& a = group[frame.joints[j].a];
      std::uint32_t& b = group[std::min(frame.joints[j].b, ground)];
      merged |= a != b;
      a = b = std::max(a, b);
    }
  }
  std::vector<std::uint32_t> size(ground + 1, 0);
  for (std::uint32_t part = 0; part < ground; ++part) size[group[part]] += group[part] != ground;
  const auto most = static_cast<std::uint32_t>(std::ranges::max_element(size) - size.begin());
  std::vector<std::uint8_t> chosen(ground);
  for (std::uint32_t part = 0; part < ground; ++part) chosen[part] = group[part] == most;
  return chosen;
}

Piece piece_of(const Frame& whole, const std::vector<std::uint8_t>& chosen,
               const std::vector<std::uint8_t>& broken) {
  Piece piece{whole, {}, {}, std::vector<std::uint32_t>(whole.part_count(), kNoPart)};
  Frame& frame = piece.frame;
  frame.members.clear(), frame.slabs.clear(), frame.walls.clear(), frame.joints.clear();
  for (FrameNode& node : frame.nodes) node.support = false;
  const auto part = [&](std::uint32_t old) {
    return old == kNoPart ? kNoPart : piece.part_in[old];
  };
  std::uint32_t count = 0;
  for (std::uint32_t old = 0; old < whole.part_count(); ++old)
    if (chosen[old]) piece.part_in[old] = count++;
  for (std::uint32_t m = 0; m < whole.members.size(); ++m)
    if (chosen[m]) frame.members.push_back(whole.members[m]);
  for (std::uint32_t s = 0; s < whole.slabs.size(); ++s) {
    if (!chosen[whole.slab_part(s)]) continue;
    FrameSlab& slab = frame.slabs.emplace_back(whole.slabs[s]);
    for (std::uint32_t& beam : slab.beams) beam = part(beam);
  }
  for (std::uint32_t w = 0; w < whole.walls.size(); ++w) {
    if (!chosen[whole.wall_part(w)]) continue;
    FrameWall& wall = frame.walls.emplace_back(whole.walls[w]);
    for (std::uint32_t& edge : wall.edges) edge = part(edge);
    piece.wall_of.push_back(w);
  }
  for (std::uint32_t j = 0; j < whole.joints.size(); ++j) {
    if (broken[j] || !chosen[whole.joints[j].a]) continue;
    FrameJoint& joint = frame.joints.emplace_back(whole.joints[j]);
    joint.a = part(joint.a);
    joint.b = part(joint.b);
    piece.joint_of.push_back(j);
  }
  return piece;
}

/// A tower whose upper half comes off, with some joints of it broken.
std::vector<std::uint8_t> broken_at(const Frame& frame, double height, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::uint8_t> broken(frame.joints.size());
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const FrameJoint& joint = frame.joints[j];
    const bool splice = joint.kind == FrameJoint::Kind::splice ||
                        (joint.kind == FrameJoint::Kind::wall && joint.axes.x.y > 0.5);
    broken[j] = (splice && std::fabs(joint.point.y - height) < 0.3) || random() % 9 == 0;
  }
  return broken;
}

struct PieceLoads {
  FrameLoads whole, piece;
};

PieceLoads loads_on(const Piece& piece, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  PieceLoads loads;
  for (std::uint32_t old = 0; old < piece.part_in.size(); ++old) {
    if (piece.part_in[old] == kNoPart || random() % 6 != 0) continue;
    const Vec3 point{6 + 6 * any(random), 14 + 4 * any(random), 6 + 6 * any(random)};
    const Vec3 force{2e5 * any(random), 2e5 * any(random), 2e5 * any(random)};
    loads.whole.contacts.push_back({old, point, force});
    loads.piece.contacts.push_back({piece.part_in[old], point, force});
  }
  for (std::uint32_t old = 0; old < piece.part_in.size(); ++old) {
    const std::uint32_t part = piece.part_in[old];
    if (part >= piece.frame.members.size()) continue;
    loads.whole.spins.push_back({old, {0.3, -0.5, 0.2}});
    loads.piece.spins.push_back({part, {0.3, -0.5, 0.2}});
  }
  return loads;
}

/// Largest difference between the loads of the joints of a piece, by the largest of them.
double difference(const Piece& piece, const FrameSolver& alone, const FrameSolver& within) {
  double largest = 0, worst = 0;
  for (std::uint32_t j = 0; j < piece.joint_of.size(); ++j) {
    const JointLoad a = alone.joint_load(j), b = within.joint_load(piece.joint_of[j]);
    largest = std::max({largest, length(b.force), length(b.torque)});
    worst = std::max({worst, length(a.force - b.force), length(a.torque - b.torque)});
  }
  return worst / largest;
}

TEST(FrameSolver, APieceAloneCarriesAsWithinTheBuilding) {
  const Frame frame = tower(3, 3, 5, 0.2);
  std::vector<double> wall_mass;
  for (const PartSolid& solid : solids_of(frame)) wall_mass.push_back(solid.mass);
  for (const char* slabs : {"load", "diaphragm"}) {
    FrameSolver like(frame, {.slabs = slabs});
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const std::vector<std::uint8_t> broken = broken_at(frame, 7, seed);
      const Piece piece = piece_of(frame, flying(frame, broken), broken);
      ASSERT_GT(piece.frame.members.size(), 30u) << "seed " << seed;
      FrameSolver within(frame, {.slabs = slabs}, like);
      std::vector<std::uint32_t> off;
      for (std::uint32_t j = 0; j < broken.size(); ++j)
        if (broken[j]) off.push_back(j);
      within.break_joints(off);
      FrameSolverParams params{.slabs = slabs, .free = true};
      for (const std::uint32_t wall : piece.wall_of)
        params.wall_mass.push_back(wall_mass[frame.wall_part(wall)]);
      FrameSolver alone(piece.frame, params);
      const PieceLoads loads = loads_on(piece, seed);
      within.solve(loads.whole);
      alone.solve(loads.piece);
      EXPECT_LT(difference(piece, alone, within), 1e-9) << slabs << ", seed " << seed;
      EXPECT_LT(alone.pin_force(), 1e-8 * 2e5) << slabs << ", seed " << seed;
    }
  }
}

TEST(FrameSolver, AFreePieceMayBeAMechanism) {
  Frame frame = stocked_frame();
  for (const Vec3 at : {Vec3{0, 3, 0}, Vec3{2, 3, 0}, Vec3{2, 5, 0}, Vec3{0, 5, 0}})
    frame.nodes.push_back({"node" + std::to_string(frame.nodes.size()), at, false});
  for (std::uint32_t i = 0; i < 4; ++i)
    frame.members.push_back({.name = "bar" + std::to_string(i),
                             .kind = FrameMember::Kind::beam,
                             .from = i,
                             .to = (i + 1) % 4,
                             .section = 1,
                             .steel = 0,
                             .roll = 0});
  JointClass pin;
  pin.name = "pin";
  pin.rigid = false;
  frame.classes = {pin};
  join(frame, {{"bar0", "bar3", "node0", "pin"},
               {"bar1", "bar0", "node1", "pin"},
               {"bar2", "bar1", "node2", "pin"},
               {"bar3", "bar2", "node3", "pin"}});
  EXPECT_THROW(FrameSolver{frame}, Error);
  FrameSolver solver(frame, {.free = true});
  solver.solve({.gravity = {}, .contacts = {{0, {1, 3, 0}, {0, 1e3, 0}}}});
  EXPECT_FALSE(solver.mechanisms().empty());
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    EXPECT_TRUE(std::isfinite(length(solver.joint_load(j).force)));
}

/// Wrecks with free pieces, mechanisms and hinges that turn. A displacement is known to 1e-16 of
/// it, and a post resists with some 1e9 N/m: beside a load of 1e5 N that is 1e-12 per metre.
TEST(FrameSolver, AWreckIsSolvedToTheRoundingOfItsDisplacements) {
  const Frame frame = tower(4, 4, 5, 0.2);
  const FrameSolver like(frame);
  const FrameLoads loads{.contacts = {{7, {3, 2, 1}, {1e5, 0, 9e3}}}};
  std::size_t mechanisms = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 random(seed);
    FrameSolver solver(frame, {}, like);
    for (int round = 0; round < 6; ++round) {
      std::vector<std::uint32_t> broken;
      for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
        if (random() % 9 == 0) broken.push_back(j);
      solver.break_joints(broken);
      for (int i = 0; i < 4; ++i) {
        const auto joint = static_cast<std::uint32_t>(random() % frame.joints.size());
        solver.set_hinges(std::vector<FrameSolver::Hinge>{{joint, {0, 1e4, 0}, {}, true}});
      }
      solver.solve(loads);
      double largest = 0;
      for (const double u : solver.displacements()) largest = std::max(largest, std::fabs(u));
      EXPECT_LT(solver.residual(), 1e-12 * (1 + largest)) << "seed " << seed << ", round " << round;
      mechanisms += solver.mechanisms().size();
    }
  }
  EXPECT_GT(mechanisms, 5u);
}

FrameLoads random_loads(const Frame& frame, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  FrameLoads loads;
  if (random() % 6 == 0) loads.gravity = {3 * any(random), -9.81, 0};
  if (random() % 8 == 0) loads.gravity = {};
  if (random() % 6 == 0) loads.live.assign(frame.slabs.size(), 1000 * any(random) * any(random));
  for (std::uint64_t i = random() % 8; i > 0; --i) {
    const auto part = static_cast<std::uint32_t>(random() % frame.part_count());
    const Vec3 force{1e5 * any(random), 1e5 * any(random), 1e5 * any(random)};
    loads.contacts.push_back({part, {6 + 6 * any(random), 8, 6 + 6 * any(random)}, force});
  }
  return loads;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::fabs(a[i] - b[i]));
    largest = std::max(largest, std::fabs(b[i]));
  }
  return worst / std::max(largest, 1e-300);
}

/// Numbers that tell all that loads and displacements leave in a solver.
std::vector<double> told_by(const Frame& frame, const FrameSolver& solver) {
  std::vector<double> numbers;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const JointLoad load = solver.joint_load(j);
    for (const Vec3 v : {load.force, load.torque}) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  }
  return numbers;
}

/// Weight, contacts and hinges come and go in a solver; another has never seen but the last.
TEST(FrameSolver, LoadsThatComeAndGoLeaveNoTrace) {
  const Frame frame = tower(3, 3, 3, 0.2);
  for (const char* slabs : {"load", "diaphragm"}) {
    const FrameSolverParams params{.slabs = slabs, .stiffness = 1.2, .mass = 1e4};
    FrameSolver solver(frame, params);
    std::mt19937_64 random(7);
    std::vector<std::uint32_t> broken;
    std::vector<FrameSolver::Hinge> hinges;
    for (int step = 0; step < 40; ++step) {
      if (step % 10 == 9) {
        broken.push_back(static_cast<std::uint32_t>(random() % frame.joints.size()));
        solver.break_joints({&broken.back(), 1});
      }
      if (step % 10 == 4) {
        const auto joint = static_cast<std::uint32_t>(random() % frame.joints.size());
        hinges = solver.hinges();
        hinges.push_back({joint, {0, 1e4, -2e3}, {0, 1e-3, 0}, step % 20 == 4});
        solver.set_hinges({&hinges.back(), 1});
      }
      const FrameLoads loads = random_loads(frame, random), other = random_loads(frame, random);
      hinges = solver.hinges();
      std::vector<double> u(solver.freedoms()), f(u.size()), g(u.size());
      for (double& value : u) value = 1e-3 * std::sin(static_cast<double>(random() % 1000));
      solver.set_displacements(u, loads);
      const double work = solver.work_of(other);
      solver.load_vector(other, f);
      solver.set_displacements(u, loads);

      FrameSolver fresh(frame, params, solver);
      fresh.break_joints(broken);
      fresh.set_hinges(hinges);
      fresh.load_vector(other, g);
      EXPECT_LT(distance(f, g), 1e-13) << slabs << ", step " << step;
      fresh.stiffness_times(u, g);
      solver.stiffness_times(u, f);
      EXPECT_LT(distance(f, g), 1e-13) << slabs << ", step " << step;
      fresh.set_displacements(u, loads);
      EXPECT_LT(distance(told_by(frame, solver), told_by(frame, fresh)), 1e-12)
          << slabs << ", step " << step;
      EXPECT_NEAR(work, fresh.work_of(other), 1e-12 * 1e5) << slabs << ", step " << step;
      EXPECT_NEAR(solver.strain_energy(), fresh.strain_energy(), 1e-12 * fresh.strain_energy());
    }
  }
}

/// Where no hinge turns work is that of the nodal loads.
TEST(FrameSolver, WorkIsLoadsTimesDisplacements) {
  const Frame frame = tower(3, 2, 3, 0.2);
  FrameSolver solver(frame, {.mass = 1e4});
  std::mt19937_64 random(3);
  std::vector<double> f(solver.freedoms()), u(f.size());
  for (int step = 0; step < 20; ++step) {
    for (double& value : u) value = 1e-3 * std::cos(static_cast<double>(random() % 1000));
    solver.set_displacements(u, {});
    const FrameLoads loads = random_loads(frame, random);
    solver.load_vector(loads, f);
    double work = 0;
    for (std::size_t i = 0; i < f.size(); ++i) work += f[i] * u[i];
    EXPECT_NEAR(solver.work_of(loads), work, 1e-12 * 1e5) << "step " << step;
  }
}

/// The rounds of the second order leave one shear in the diaphragms, not their sum.
TEST(FrameSolver, UnderSmallLoadsSecondOrderIsFirstOrderAlsoInDiaphragms) {
  const Frame frame = tower(3, 3, 3);
  FrameSolver first(frame, {.slabs = "diaphragm"});
  FrameSolver second(frame, {.p_delta = true, .slabs = "diaphragm"}, first);
  const FrameLoads loads{.gravity = {0, -1e-3, 0}, .contacts = {{5, {0, 7, 0}, {30, 0, 20}}}};
  first.solve(loads);
  second.solve(loads);
  EXPECT_LT(distance(told_by(frame, second), told_by(frame, first)), 1e-5);
}

TEST(FrameSolver, ProgressRisesToOneAndMayStop) {
  const Frame frame = tower(4, 4, 6);
  std::vector<double> told;
  FrameSolverParams params;
  params.progress = [&](double share) { told.push_back(share); };
  FrameSolver solver(frame, params);
  ASSERT_GT(told.size(), 5u);
  EXPECT_GT(told.front(), 0);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(told.back(), 1);
  const std::size_t first = told.size();
  solver.break_joints(std::vector<std::uint32_t>{3, 40, 77});
  EXPECT_EQ(told.size(), first);
  params.progress = [](double share) {
    if (share > 0.5) throw std::runtime_error("stop");
  };
  EXPECT_THROW(FrameSolver(frame, params, solver), std::runtime_error);
}

/// A bay of so many storeys whose mass is in the floors, 3.5 m high, its beams in bending
/// `beam_share` times as stiff as its posts.
Frame shear_building(std::size_t storeys, double beam_share) {
  Frame frame = stocked_frame();
  Section& post = frame.sections[0];
  post.height = post.width = 0.1;
  post.area = 0.01;  // stiff along, for its bending
  post.iy = post.iz = 1.2e-8;
  post.it = 1e-8;
  Section& beam = frame.sections[1];
  beam.height = beam.width = 1;
  beam.area = 0.5;
  beam.iy = beam.iz = beam.it = 5e-4;
  frame.steels.push_back(frame.steels[0]);
  frame.steels[1].youngs_modulus = beam_share * 210e9 * post.iy / beam.iy;
  for (SteelGrade& steel : frame.steels) steel.density = 1e-6;
  add_regular(frame, regular(2, 2, storeys));
  for (FrameMember& member : frame.members)
    member.steel = member.kind == FrameMember::Kind::beam ? 1 : 0;
  join(frame);
  return frame;
}

/// Circular frequency of a free vibration from the rest shape under forces on the floors: what the
/// trapezoidal rule makes of it, ω' of tan(ω' dt/2) = ω dt/2, taken back.
double frequency_of(const Frame& frame, const std::vector<double>& forces, double dt) {
  FrameSolver rest(frame, {.shear = false});
  FrameSolver moving(frame, {.shear = false, .mass = 4 / (dt * dt)}, rest);
  FrameLoads pushes{.gravity = {}};
  for (std::uint32_t m = 0; m < frame.members.size(); ++m) {
    if (frame.members[m].kind != FrameMember::Kind::post) continue;
    const Vec3 top = frame.nodes[frame.members[m].to].position;
    const auto floor = static_cast<std::size_t>(std::lround(top.y / 3.5)) - 1;
    pushes.contacts.push_back({m, top, {forces[floor], 0, 0}});
  }
  rest.solve(pushes);
  std::vector<double> u(rest.displacements().begin(), rest.displacements().end());
  const std::vector<double> shape = u;
  std::vector<double> v(u.size()), f(u.size()), w(u.size()), in_mode;
  const auto dot_with = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  for (int step = 0; step < 300; ++step) {
    moving.mass_times(shape, f);
    in_mode.push_back(dot_with(f, u));
    moving.mass_times(v, w);
    moving.stiffness_times(u, f);
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = 4 / dt * w[i] - 2 * f[i];
    moving.solve_system(f, w);
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] += w[i];
      v[i] = 2 / dt * w[i] - v[i];
    }
  }
  // In a mode q₋ + q₊ = 2 cos(ω' dt) q.
  double over = 0, under = 0;
  for (std::size_t i = 1; i + 1 < in_mode.size(); ++i) {
    over += in_mode[i] * (in_mode[i - 1] + in_mode[i + 1]) / 2;
    under += in_mode[i] * in_mode[i];
  }
  return 2 / dt * std::tan(std::acos(over / under) / 2);
}

/// ω = 2 √(k/m) sin((2r − 1) π/(4n + 2)), at floor i the shape sin(i (2r − 1) π/(2n + 1)), for k =
/// 12 EI/h³ of each of four posts. What is left are the beams' bending, by the inverse of their
/// share, and the posts' stretch.
TEST(FrameSolver, AShearBuildingSwingsInItsClosedFormModes) {
  const double pi = 3.14159265358979, n = 5;
  const double stiffness = 4 * 12 * 210e9 * 1.2e-8 / (3.5 * 3.5 * 3.5);
  const double mass = 2400 * 0.15 * 36;
  for (const int mode : {1, 2}) {
    const double angle = (2 * mode - 1) * pi / (2 * n + 1);
    const double expected = 2 * std::sqrt(stiffness / mass) * std::sin(angle / 2);
    std::vector<double> shape;
    for (int floor = 1; floor <= n; ++floor) shape.push_back(1e3 * std::sin(floor * angle));
    std::vector<double> errors;
    for (const double share : {1e2, 1e3, 1e5}) {
      const Frame frame = shear_building(5, share);
      errors.push_back(1 - frequency_of(frame, shape, 0.05 / expected) / expected);
    }
    EXPECT_NEAR(errors[0] / errors[1], 10, 0.5) << "mode " << mode << ", error " << errors[0];
    EXPECT_LT(errors[0], 2e-2) << "mode " << mode;
    EXPECT_LT(std::fabs(errors[2]), 1e-4) << "mode " << mode;
  }
}

}  // namespace
}  // namespace sunder
