// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "meshing/error.hpp"
#include "sim/buckling.hpp"
#include "sim/frame_motion.hpp"
#include "sim/frame_solver.hpp"
#include "sim/frames.hpp"

namespace sunder {
namespace {

constexpr double kGravity = 9.81;

CollapseScene hybrid_scene(std::size_t posts, std::size_t rows, std::size_t storeys) {
  CollapseScene scene = regular_scene(posts, rows, storeys);
  scene.simulation.solver = "hybrid";
  return scene;
}

/// Without the run: a motion whose joints the test breaks.
struct Rig {
  explicit Rig(const CollapseScene& given)
      : scene(given), solids(solids_of(scene.frame)), world(WorldParams{}) {
    motion = elastic_motion(scene, world, solids);
    motion->settle({});
  }
  void step() {
    world.step(scene.simulation.step);
    now += scene.simulation.step;
    motion->follow(now, scene.simulation.step, true);
  }
  void cut(const std::vector<std::uint32_t>& joints) {
    for (const std::uint32_t j : joints) motion->break_joint(j, true);
    motion->settle_breaks();
  }
  std::vector<std::uint32_t> feet() const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t j = 0; j < scene.frame.joints.size(); ++j)
      if (scene.frame.joints[j].b == kNoPart) found.push_back(j);
    return found;
  }
  CollapseScene scene;
  std::vector<PartSolid> solids;
  RigidWorld world;
  std::unique_ptr<FrameMotion> motion;
  double now = 0;
};

double tip_mass(const Frame& frame) {
  return 2 * frame.steels[1].density * frame.sections[0].area;  // two bars of a metre
}

/// A beam without mass from a wall, two short heavy bars across its tip, a prop under it.
CollapseScene propped_cantilever(double length) {
  CollapseScene scene;
  Frame& frame = scene.frame;
  frame = empty_frame();
  SteelGrade heavy = frame.steels[0];
  heavy.name = "heavy";
  heavy.density = 1e3 / frame.sections[0].area;
  frame.steels[0].density = 1e-3;
  frame.steels.push_back(heavy);
  frame.nodes = {{"wall", {0, 4, 0}, true},
                 {"tip", {length, 4, 0}, false},
                 {"back", {length, 4, -1}, false},
                 {"front", {length, 4, 1}, false},
                 {"foot", {length, 0, 0}, true}};
  using Kind = FrameMember::Kind;
  frame.members = {{"beam", Kind::beam, 0, 1, 0, 0, 0},
                   {"bar_back", Kind::beam, 1, 2, 0, 1, 0},
                   {"bar_front", Kind::beam, 1, 3, 0, 1, 0},
                   {"prop", Kind::post, 4, 1, 0, 0, 0}};
  join(frame);
  scene.scenario.remove = {"prop"};
  scene.rules.breaking = false;
  SimulationParams& simulation = scene.simulation;
  simulation.ground = false;
  simulation.damping_mass = simulation.damping_stiffness = 0;
  simulation.history_step = simulation.step;
  simulation.duration = 2;
  return scene;
}

double tip_stiffness(const Frame& frame, double length) {
  const Section& section = frame.sections[0];
  const SteelGrade& steel = frame.steels[0];
  const double shear = steel.youngs_modulus / (2 * (1 + steel.poisson_ratio));
  return 1 / (std::pow(length, 3) / (3 * steel.youngs_modulus * section.iy) +
              length / (shear * section.avz));
}

/// Moment of a joint at every sample.
std::vector<double> moments(const CollapseResult& result, const Frame& frame, const char* name) {
  const std::uint32_t joint = joint_named(frame, name);
  const Recording& recording = result.recording;
  std::vector<double> found;
  for (std::size_t t = 0; t < recording.sample_times.size(); ++t)
    found.push_back(std::fabs(
        static_cast<double>(recording.samples[t * recording.joints.size() + joint].torque[1])));
  return found;
}

/// Times at which a history passes a value upwards.
std::vector<double> rising(const std::vector<double>& values, double value, double step) {
  std::vector<double> times;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i - 1] < value && values[i] >= value)
      times.push_back(step * (static_cast<double>(i - 1) +
                              (value - values[i - 1]) / (values[i] - values[i - 1])));
  return times;
}

TEST(Hybrid, IntactBuildingIsAtRestAsItsFrameSolverSays) {
  CollapseScene scene = hybrid_scene(3, 3, 3);
  scene.simulation.duration = 0.5;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_EQ(r.bodies, 0u);
  EXPECT_TRUE(r.recording.tracks.empty());
  EXPECT_EQ(r.solves.skipped, r.steps);
  EXPECT_LT(r.reaction_error, 1e-12);
  EXPECT_LT(r.residual, 1e-10);
  FrameSolver solver(scene.frame);
  solver.solve({});
  const auto top = std::ranges::find(scene.frame.nodes, r.sag_node, &FrameNode::name);
  ASSERT_NE(top, scene.frame.nodes.end());
  const auto node = static_cast<std::uint32_t>(top - scene.frame.nodes.begin());
  EXPECT_NEAR(r.sag_max, -solver.displacement(node).y, 1e-12 * r.sag_max);
  EXPECT_EQ(r.energy.numerical, 0);
}

/// One mode: the load that the prop bore comes twice, and the mass rings with its own period.
TEST(Hybrid, SuddenRemovalOfAPropDoublesItsLoad) {
  const double length = 6;
  const CollapseScene scene = propped_cantilever(length);
  const CollapseResult r = simulate_collapse(scene);
  const std::vector<double> moment = moments(r, scene.frame, "beam@ground");
  const double at_rest = moment.front();
  const double weight = tip_mass(scene.frame) * kGravity;
  const double peak = *std::ranges::max_element(moment);
  EXPECT_NEAR((peak - at_rest) / (weight * length - at_rest), 2, 0.02);
  const std::vector<double> times = rising(moment, weight * length, scene.simulation.step);
  ASSERT_GE(times.size(), 4u);
  const double period = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  const double closed =
      2 * std::numbers::pi * std::sqrt(tip_mass(scene.frame) / tip_stiffness(scene.frame, length));
  EXPECT_NEAR(period, closed, 0.01 * closed);
  EXPECT_LT(std::fabs(r.energy.numerical),
            1e-9 * weight * weight / tip_stiffness(scene.frame, length));
}

TEST(Hybrid, RayleighDampingTakesItsShareOfEachSwing) {
  const double length = 6, ratio = 0.02;
  for (const bool by_mass : {true, false}) {
    CollapseScene scene = propped_cantilever(length);
    const double omega = std::sqrt(tip_stiffness(scene.frame, length) / tip_mass(scene.frame));
    (by_mass ? scene.simulation.damping_mass : scene.simulation.damping_stiffness) =
        by_mass ? 2 * ratio * omega : 2 * ratio / omega;
    const CollapseResult r = simulate_collapse(scene);
    const std::vector<double> moment = moments(r, scene.frame, "beam@ground");
    const double rest = tip_mass(scene.frame) * kGravity * length;
    std::vector<double> peaks;
    for (std::size_t i = 1; i + 1 < moment.size(); ++i)
      if (moment[i] > rest && moment[i] >= moment[i - 1] && moment[i] > moment[i + 1])
        peaks.push_back(moment[i] - rest);
    ASSERT_GE(peaks.size(), 4u);
    const double decay = std::log(peaks.front() / peaks.back()) /
                         static_cast<double>(peaks.size() - 1) / (2 * std::numbers::pi);
    EXPECT_NEAR(decay, ratio, 0.02 * ratio) << (by_mass ? "mass" : "stiffness");
    EXPECT_GT(r.damping, 0);
    EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * r.damping);
  }
}

TEST(Hybrid, EnergyOfAWholeCollapseIsAccounted) {
  CollapseScene scene = hybrid_scene(3, 2, 3);
  scene.scenario.remove = {"post_0_0_0", "post_1_0_0", "post_2_0_0"};
  scene.simulation.duration = 2;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_GT(r.parts_freed, 30u);
  ASSERT_LT(r.energy.potential, -1e6);
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-8 * -r.energy.potential);
}

/// Cut off from its wall while the ground's jolt makes it ring.
TEST(Hybrid, PieceThatLeavesHasTheMomentumOfItsParts) {
  const double length_of_beam = 6;
  CollapseScene scene = propped_cantilever(length_of_beam);
  scene.frame.members.pop_back();
  scene.frame.nodes.pop_back();
  join(scene.frame);
  scene.scenario.ground_motion = {{0, 1}, {{0, 5, 0}, {0, 5, 0}}};
  scene.simulation.step = 1e-3;
  Rig rig(scene);
  std::vector<double> sag;
  for (int i = 0; i < 81; ++i) {
    rig.step();
    sag.push_back(rig.motion->sag(0));
  }
  // At the end of the last step, by the parabola through three.
  const double speed = -(3 * sag[80] - 4 * sag[79] + sag[78]) / (2 * scene.simulation.step);
  ASSERT_LT(speed, -0.1);
  rig.cut({joint_named(rig.scene.frame, "beam@ground")});
  ASSERT_EQ(rig.motion->bodies(), 1u);
  const double momentum = tip_mass(scene.frame) * speed;
  EXPECT_NEAR(rig.world.momentum().y, momentum, 2e-3 * -momentum);
  const Vec3 wall = scene.frame.nodes[0].position;
  EXPECT_NEAR(rig.world.angular_momentum(wall).z, length_of_beam * momentum,
              2e-3 * length_of_beam * -momentum);
}

/// Where it hung: the frame's sag is no height to fall again, and what it had stored is lost.
TEST(Hybrid, PieceStartsWhereItHungAndItsStrainIsLost) {
  Rig rig(hybrid_scene(2, 2, 2));
  const double strain = rig.motion->strain(), sag = rig.motion->potential();
  ASSERT_GT(strain, 1);
  rig.cut(rig.feet());
  ASSERT_EQ(rig.motion->bodies(), 1u);
  EXPECT_NEAR(rig.motion->losses().fracture, strain, 1e-9 * strain);
  EXPECT_NEAR(rig.world.potential_energy() - rig.motion->baseline(), sag, 1e-6 * -sag);
}

/// It lies on three beams instead of four, and has not moved.
TEST(Hybrid, SlabThatLosesAJointGivesNoEnergy) {
  Rig rig(hybrid_scene(3, 2, 2));
  const double before = rig.motion->strain() + rig.motion->potential();
  rig.cut({joint_named(rig.scene.frame, "slab_0_0_0@beam_x_0_0_0")});
  EXPECT_EQ(rig.motion->bodies(), 0u);
  EXPECT_NEAR(rig.motion->losses().fracture, 0, 1e-9 * -before);
  EXPECT_NEAR(rig.motion->strain() + rig.motion->potential(), before, 1e-9 * -before);
}

/// Each break on its own, all on the way down: strain is released, nothing is lifted.
TEST(Hybrid, NoBreakOfAFrameAtRestGivesEnergy) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    Rig rig(hybrid_scene(3, 2, 2));
    std::mt19937 random(seed);
    double last = 0;
    for (int i = 0; i < 12; ++i) {
      rig.cut({static_cast<std::uint32_t>(random() % rig.scene.frame.joints.size())});
      const double now = rig.motion->losses().fracture;
      EXPECT_GE(now, last - 1e-6) << "seed " << seed << ", break " << i;
      last = now;
    }
  }
}

TEST(Hybrid, SplittingAFlyingPieceKeepsMomentumAndAngularMomentum) {
  Rig rig(hybrid_scene(2, 2, 3));
  rig.cut(rig.feet());
  ASSERT_EQ(rig.motion->bodies(), 1u);
  BodyId body = 0;
  while (rig.motion->part_of(body, 0) == kNoPart) ++body;
  rig.world.set_velocity(body, {3, 5, -2}, {0.3, -0.7, 0.2});
  for (int i = 0; i < 5; ++i) rig.step();
  const Vec3 about{1, 2, 3};
  for (const char* name : {"post_0_0_2@post_0_0_1", "beam_x_0_0_2@post_0_0_2",
                           "beam_z_0_0_2@post_0_0_2", "post_1_1_1@post_1_1_0"}) {
    const Vec3 momentum = rig.world.momentum(), angular = rig.world.angular_momentum(about);
    const double energy = rig.world.kinetic_energy();
    rig.cut({joint_named(rig.scene.frame, name)});
    EXPECT_LT(length(rig.world.momentum() - momentum), 1e-10 * length(momentum)) << name;
    EXPECT_LT(length(rig.world.angular_momentum(about) - angular), 1e-10 * length(angular));
    EXPECT_NEAR(rig.world.kinetic_energy(), energy, 1e-10 * energy);
  }
  EXPECT_GE(rig.motion->bodies(), 2u);
}

/// Union-find over the joints that are left, ground as one more part: pieces without it.
std::size_t loose_pieces(const Frame& frame, const std::vector<std::uint8_t>& intact) {
  std::vector<std::uint32_t> parent(frame.part_count() + 1);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i];
    return i;
  };
  for (std::uint32_t j = 0; j < intact.size(); ++j) {
    const std::uint32_t b = frame.joints[j].b == kNoPart ? frame.part_count() : frame.joints[j].b;
    if (intact[j] != 0) parent[root(frame.joints[j].a)] = root(b);
  }
  std::size_t count = 0;
  for (std::uint32_t part = 0; part <= frame.part_count(); ++part) count += parent[part] == part;
  return count - 1;
}

TEST(Hybrid, PiecesAreThoseOfUnionFindWhateverBreaksFirst) {
  const CollapseScene scene = hybrid_scene(2, 2, 2);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    std::mt19937_64 random(seed);
    Rig rig(scene);
    std::vector<std::uint32_t> order(scene.frame.joints.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, random);
    std::vector<std::uint8_t> intact(order.size(), 1);
    for (std::size_t i = 0; i < order.size(); i += 3) {
      std::vector<std::uint32_t> batch(
          order.begin() + static_cast<std::ptrdiff_t>(i),
          order.begin() + static_cast<std::ptrdiff_t>(std::min(i + 3, order.size())));
      for (const std::uint32_t j : batch) intact[j] = 0;
      rig.cut(batch);
      ASSERT_EQ(rig.motion->bodies(), loose_pieces(scene.frame, intact))
          << "seed " << seed << ", " << i;
    }
  }
}

TEST(Hybrid, FallIsWeightlessInsideAndLandingIsNot) {
  CollapseScene scene = hybrid_scene(2, 2, 1);
  for (FrameNode& node : scene.frame.nodes) node.position.y += 3;
  join(scene.frame);
  scene.simulation.damping_mass = 0;
  Rig rig(scene);
  const std::uint32_t joint = joint_named(rig.scene.frame, "beam_x_0_0_0@post_0_0_0");
  const double at_rest = length(rig.motion->load(joint).torque);
  rig.cut(rig.feet());
  double in_flight = 0, landed = 0;
  while (rig.now < 1.2) {
    rig.step();
    double& largest = rig.world.contacts().empty() && rig.now < 0.7 ? in_flight : landed;
    largest = std::max(largest, length(rig.motion->load(joint).torque));
  }
  EXPECT_LT(in_flight, 1e-6 * at_rest);
  EXPECT_GT(landed, 0.1 * at_rest);
}

TEST(Hybrid, SameSceneSameBitsAlsoWithoutSkipping) {
  CollapseScene scene = hybrid_scene(3, 2, 2);
  scene.scenario.remove = {"post_0_0_0"};
  scene.projectiles.resize(1);
  scene.projectiles[0] = {.name = "ball",
                          .radius = 0.5,
                          .mass = 2000,
                          .position = {-3, 4, 0.2},
                          .velocity = {20, 0, 0}};
  scene.simulation.duration = 0.7;
  const CollapseResult one = simulate_collapse(scene), two = simulate_collapse(scene);
  const CollapseResult all = simulate_collapse(scene, {.skip = false});
  EXPECT_EQ(one.hash, two.hash);
  EXPECT_EQ(one.hash, all.hash);
  EXPECT_EQ(one.energy.numerical, two.energy.numerical);
  EXPECT_EQ(one.max_utilisation, all.max_utilisation);
  EXPECT_EQ(one.broken_joints.size(), all.broken_joints.size());
}

/// In balance at any time the prop's load comes once.
TEST(Hybrid, QuasiStaticFrameDoesNotSwing) {
  CollapseScene scene = propped_cantilever(6);
  scene.simulation.quasi_static = true;
  scene.simulation.duration = 0.2;
  const CollapseResult r = simulate_collapse(scene);
  const std::vector<double> moment = moments(r, scene.frame, "beam@ground");
  const double closed = tip_mass(scene.frame) * kGravity * 6;
  EXPECT_NEAR(*std::ranges::max_element(moment), closed, 1e-5 * closed);
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * r.damping + 1e-9);
}

/// Four posts share a slab evenly: the first fails when a quarter of all it bears is its
/// resistance.
TEST(Hybrid, RisingLoadFailsADeterminateFrameAtTheClosedForm) {
  StoreyParams storey;
  storey.height = 10.5;
  storey.post_section = "HEB200";
  CollapseScene scene = regular_scene(2, 2, 1, storey);
  scene.simulation.solver = "hybrid";
  for (FrameJoint& joint : scene.frame.joints) {
    joint.strength.force = 1e3 * joint.strength.force;
    joint.strength.torque = 1e3 * joint.strength.torque;
  }
  scene.rules.post_rule = "euler";
  scene.rules.members_divide = false;  // the beams bear it too
  scene.scenario.load_rate = 4e5;
  scene.simulation.quasi_static = true;
  scene.simulation.step = 1e-3;
  scene.simulation.duration = 1.5;
  const CollapseResult r = simulate_collapse(scene);
  const double resistance =
      euler_load(scene.frame.sections[1], scene.frame.steels[0], {10.5, 10.5});
  EXPECT_NEAR(r.first_failure_load, (4 * resistance - r.weight) / 36, 2 * 400);
  ASSERT_FALSE(r.broken_joints.empty());
  EXPECT_EQ(r.broken_joints[0].mode, "buckling");
}

/// A corner shot away: pieces fall there, the rest stands.
TEST(Hybrid, BuildingFallsWhereItsCornerIsShotAway) {
  CollapseScene scene = hybrid_scene(4, 5, 6);
  for (FrameJoint& joint : scene.frame.joints) {
    joint.strength.force = 3 * joint.strength.force;
    joint.strength.torque = 3 * joint.strength.torque;
  }
  scene.projectiles.resize(1);
  scene.projectiles[0] = {.name = "ball",
                          .radius = 0.9,
                          .mass = 8000,
                          .position = {-1.5, 1.8, 0.1},
                          .velocity = {30, 0, 0}};
  scene.simulation.duration = 0.5;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_GT(r.broken_joints.size(), 2u);
  EXPECT_LT(r.parts_freed, scene.frame.part_count() / 2);
  EXPECT_TRUE(r.projectiles[0].hit);
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * r.energy_in);
  EXPECT_GT(r.energy.contact + r.energy.friction + r.energy.fracture, 0);
}

/// What stands is fixed for the world; a light post must not get more than the heavy ball lost.
TEST(Hybrid, BlowGivesTheFrameNoMoreThanTheBallLost) {
  for (const bool breaking : {true, false}) {
    CollapseScene scene = hybrid_scene(2, 2, 2);
    scene.rules.breaking = breaking;
    scene.projectiles.resize(1);
    scene.projectiles[0] = {.name = "ball",
                            .radius = 0.5,
                            .mass = 5000,
                            .position = {-2, 1.8, 0.1},
                            .velocity = {30, 0, 0}};
    scene.simulation.duration = 0.15;
    const CollapseResult r = simulate_collapse(scene);
    EXPECT_TRUE(r.projectiles[0].hit);
    EXPECT_LT(r.energy.kinetic + r.energy.strain + r.energy.potential, r.energy_in);
    EXPECT_GT(r.energy.contact + r.energy.friction + r.energy.fracture + r.damping, 0);
    EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * r.energy_in);
  }
}

/// No model is made of a piece that falls; one when it lands.
TEST(Hybrid, PieceIsSolvedWhenItIsLoadedFirst) {
  CollapseScene scene = hybrid_scene(2, 2, 1);
  for (FrameNode& node : scene.frame.nodes) node.position.y += 3;
  join(scene.frame);
  Rig rig(scene);
  const std::uint32_t joint = joint_named(rig.scene.frame, "beam_x_0_0_0@post_0_0_0");
  rig.cut(rig.feet());
  while (rig.now < 0.5) rig.step();  // what stands, nothing, falls quiet
  const SolveCounts before = rig.motion->solves();
  while (rig.now < 0.7) {
    rig.step();
    EXPECT_EQ(length(rig.motion->load(joint).force), 0);
    EXPECT_FALSE(rig.motion->is_live(joint));
  }
  EXPECT_EQ(rig.motion->solves().full, before.full);
  EXPECT_GT(rig.motion->solves().skipped, before.skipped);
  while (rig.now < 1) rig.step();
  EXPECT_EQ(rig.motion->solves().full, before.full + 1);
  EXPECT_GT(length(rig.motion->load(joint).force), 0);
  EXPECT_LT(rig.motion->residual(), 1e-10);
}

/// The factor of what rings is made in the background if something is on its way; whether it is
/// ready when it is needed is not to be seen.
TEST(Hybrid, FactorMadeAheadGivesTheSameBits) {
  CollapseScene scene = hybrid_scene(3, 3, 2);
  Rig at_need(scene);
  scene.projectiles.emplace_back();
  Rig ahead(scene);
  const std::vector<std::uint32_t> joints{7, 8, 20};
  for (Rig* rig : {&at_need, &ahead}) {
    EXPECT_EQ(rig->motion->solves().full, 1u);
    rig->step();
    rig->cut(joints);
    for (int i = 0; i < 20; ++i) rig->step();
    EXPECT_EQ(rig->motion->solves().full, 2u);
  }
  for (std::uint32_t j = 0; j < scene.frame.joints.size(); ++j) {
    if (std::ranges::find(joints, j) != joints.end()) continue;
    EXPECT_EQ(at_need.motion->load(j).force, ahead.motion->load(j).force);
    EXPECT_EQ(at_need.motion->load(j).torque, ahead.motion->load(j).torque);
  }
  EXPECT_EQ(at_need.motion->strain(), ahead.motion->strain());
}

// A cantilever with the shape functions N of a beam's free end is as heavy at ξ as 1/(Nᵀ M⁻¹ N), so
// that m/(m + that) is left of the energy while it has no time to bend back.
TEST(Hybrid, LightBeamsMoveOnWithWhatStrikesThem) {
  constexpr double kLength = 20, kAt = 0.8;
  CollapseScene scene;
  Frame& frame = scene.frame;
  frame = empty_frame();
  frame.nodes = {{"wall", {0, 4, 0}, true}, {"tip", {kLength, 4, 0}, false}};
  frame.members = {{.name = "beam", .from = 0, .to = 1}};
  join(frame);
  const double shift = kAt * kAt * (3 - 2 * kAt), turn = kAt * kAt * (kAt - 1);
  const double beam = frame.steels[0].density * frame.sections[0].area * kLength;
  const double light = beam / 3 / (4 * shift * shift + 44 * shift * turn + 156 * turn * turn);
  scene.rules.breaking = false;
  scene.rules.load_time = 1e-6;
  SimulationParams& simulation = scene.simulation;
  simulation.solver = "hybrid";
  simulation.ground = false;
  simulation.gravity = 0;
  simulation.damping_mass = simulation.damping_stiffness = 0;
  simulation.step = simulation.history_step = 1e-3;
  simulation.duration = 0.005;
  for (const double ratio : {0.3, 1.0, 10.0}) {
    Projectile ball;
    ball.radius = 0.2;
    ball.mass = ratio * light;
    ball.position = {kAt * kLength, 4.3651, 0};
    ball.velocity = {0, -10, 0};
    scene.projectiles = {ball};
    const CollapseResult r = simulate_collapse(scene);
    const auto is_struck = [](const RunSample& s) { return s.contact != 0; };
    const auto struck = std::ranges::find_if(r.recording.series, is_struck);
    ASSERT_NE(struck, r.recording.series.end());
    const double left = ratio / (ratio + 1);
    EXPECT_NEAR(struck->kinetic / r.energy_in, left, 0.02 * left) << ratio;
  }
}

TEST(Hybrid, WhatRingsIsFactoredOnlyWhereItRings) {
  CollapseScene scene = hybrid_scene(2, 2, 2);
  scene.simulation.duration = 0.1;
  EXPECT_EQ(simulate_collapse(scene).solves.full, 1u);
  Projectile ball;
  ball.position = {-50, 5, 0};
  scene.projectiles = {ball};
  EXPECT_EQ(simulate_collapse(scene).solves.full, 1u) << "it misses";
  scene.scenario.load_rate = 1e3;
  EXPECT_EQ(simulate_collapse(scene).solves.full, 2u);
  scene.simulation.quasi_static = true;
  EXPECT_EQ(simulate_collapse(scene).solves.full, 1u);
}

/// The first factor counts as the time to settle.
TEST(Hybrid, ProgressRisesFromTheFirstFactorOn) {
  CollapseScene scene = hybrid_scene(4, 4, 8);
  scene.simulation.settle = 1;
  scene.simulation.duration = 0.05;
  std::vector<double> told;
  simulate_collapse(scene, {.progress = [&](double done) { told.push_back(done); }});
  EXPECT_TRUE(std::ranges::is_sorted(told));
  const double settled = 1 / 1.05;
  EXPECT_GT(std::ranges::count_if(told, [&](double done) { return done < 0.99 * settled; }), 5);
  EXPECT_NEAR(told.back(), 1, 1e-12);
}

/// Against the load beyond which the frame solver finds no second-order equilibrium.
TEST(Hybrid, FrameThatBucklesInTheRunGoesOnAndIsTold) {
  CollapseScene scene = hybrid_scene(2, 2, 2);
  scene.simulation.p_delta = scene.simulation.quasi_static = true;
  scene.rules.breaking = false;
  scene.rules.post_rule = "none";
  const auto buckles = [&](double live) {
    FrameSolver solver(scene.frame, {.p_delta = true});
    FrameLoads loads;
    loads.live.assign(scene.frame.slabs.size(), live);
    try {
      solver.solve(loads);
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  double low = 0, high = 1e7;
  ASSERT_TRUE(buckles(high));
  while (high - low > 1e-4 * high) (buckles((low + high) / 2) ? high : low) = (low + high) / 2;
  scene.scenario.load_rate = high / 0.5;
  scene.simulation.duration = 0.6;
  const CollapseResult r = simulate_collapse(scene);
  ASSERT_EQ(r.buckles.size(), 1u);
  EXPECT_NEAR(r.buckles[0].time, 0.5, 1.01 * scene.simulation.step);
  EXPECT_NE(r.buckles[0].what.find("node_"), std::string::npos) << r.buckles[0].what;
  EXPECT_EQ(r.warnings.size(), 1u);
  EXPECT_TRUE(std::isfinite(r.energy.strain));
  scene.scenario.load_rate = 0;
  for (FrameSlab& slab : scene.frame.slabs) slab.live_load = high;
  EXPECT_THROW(simulate_collapse(scene), Error) << "before anything happens it is an error";
}

TEST(Hybrid, MechanismIsAnErrorThatNamesItsNode) {
  CollapseScene scene;
  Frame& frame = scene.frame;
  frame = empty_frame();
  frame.nodes = {{"left", {0, 0, 0}, true},
                 {"top_left", {0, 3, 0}, false},
                 {"top_right", {5, 3, 0}, false},
                 {"right", {5, 0, 0}, true}};
  using Kind = FrameMember::Kind;
  frame.members = {{"post_left", Kind::post, 0, 1, 0, 0, 0},
                   {"post_right", Kind::post, 3, 2, 0, 0, 0},
                   {"beam", Kind::beam, 1, 2, 2, 0, 0}};
  frame.classes = built_in_classes();
  for (JointClass& joint : frame.classes) joint.rigid = false;
  join(frame);
  try {
    simulate_collapse(scene);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("top_"), std::string::npos) << error.what();
  }
}

bool is_finite(const CollapseResult& r) {
  const double numbers[] = {
      r.max_utilisation, r.energy.kinetic,  r.energy.potential, r.energy.strain, r.energy.fracture,
      r.energy.contact,  r.energy.friction, r.energy.numerical, r.damping,       r.residual,
      r.sag_max,         r.sag_end,         r.reactions[0],     r.reactions[1],  r.energy_in};
  for (const Track& track : r.recording.tracks)
    for (const Pose& pose : track.poses)
      if (!std::isfinite(dot(pose.position, pose.position))) return false;
  return std::ranges::all_of(numbers, [](double value) { return std::isfinite(value); });
}

CollapseScene random_scene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto below = [&](std::uint64_t count) { return random() % count; };
  CollapseScene scene = hybrid_scene(2 + below(2), 2 + below(2), 1 + below(2));
  for (std::uint64_t i = below(4); i > 0; --i)
    scene.scenario.remove.push_back(
        scene.frame.part_name(static_cast<std::uint32_t>(below(scene.frame.members.size()))));
  if (below(2) == 0) {
    scene.projectiles.resize(1);
    scene.projectiles[0] = {.name = "ball",
                            .radius = 0.4,
                            .mass = std::pow(10, 1 + static_cast<double>(below(4))),
                            .position = {-2, 1.0 + static_cast<double>(below(5)), 0.3},
                            .velocity = {5.0 + static_cast<double>(below(60)), 0, 0}};
  }
  if (below(4) == 0) scene.scenario.ground_motion = {{0, 0.2}, {{3, 0, 1}, {-8, 2, 0}}};
  if (below(4) == 0) scene.scenario.load_rate = 1e5;
  for (Material& material : scene.frame.materials) material.youngs_modulus = 3e10;
  scene.simulation.quasi_static = below(4) == 0;
  scene.simulation.diaphragms = below(3) == 0;
  scene.simulation.duration = 0.25;
  return scene;
}

/// Nothing is ever not a number, and energy goes nowhere unseen.
TEST(Hybrid, RandomScenesStayFiniteAndAccounted) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const CollapseResult r = simulate_collapse(random_scene(seed));
    EXPECT_TRUE(is_finite(r)) << "seed " << seed;
    const double turned = r.energy.kinetic + std::fabs(r.energy.potential) +
                          std::fabs(r.energy_in) + std::fabs(r.energy.fracture);
    EXPECT_LE(std::fabs(r.energy.numerical), 1e-7 * turned) << "seed " << seed;
  }
}

}  // namespace
}  // namespace sunder
