// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/frame_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "meshing/error.hpp"
#include "stocked_frame.hpp"

namespace sunder {
namespace {

constexpr double kG = 9.81;

/// A frame of explicit nodes; the first `supports` are held.
Frame lines(const std::vector<Vec3>& nodes, std::size_t supports,
            const std::vector<std::array<std::uint32_t, 2>>& members,
            FrameMember::Kind kind = FrameMember::Kind::beam, std::uint32_t section = 1) {
  Frame frame = stocked_frame();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    frame.nodes.push_back({"node" + std::to_string(i), nodes[i], i < supports});
  for (std::size_t i = 0; i < members.size(); ++i) {
    FrameMember member;
    member.name = "member" + std::to_string(i);
    member.kind = kind;
    member.from = members[i][0];
    member.to = members[i][1];
    member.section = section;
    frame.members.push_back(member);
  }
  return frame;
}

/// Nodes along x from the origin, each with the next.
Frame straight(const std::vector<double>& at, std::vector<std::uint32_t> supports) {
  std::vector<Vec3> nodes;
  std::vector<std::array<std::uint32_t, 2>> members;
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    nodes.push_back({at[i], 0, 0});
    if (i > 0) members.push_back({i - 1, i});
  }
  Frame frame = lines(nodes, 0, members);
  for (const std::uint32_t i : supports) frame.nodes[i].support = true;
  join(frame);
  return frame;
}

double shear_modulus(const Frame& frame) {
  return frame.steels[0].youngs_modulus / (2 * (1 + frame.steels[0].poisson_ratio));
}

std::uint32_t joint_of(const Frame& frame, const std::string& name) {
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    if (frame.joints[j].name == name) return j;
  ADD_FAILURE() << "no joint " << name;
  return 0;
}

std::uint32_t part_of(const Frame& frame, const std::string& name) {
  for (std::uint32_t part = 0; part < frame.part_count(); ++part)
    if (frame.part_name(part) == name) return part;
  ADD_FAILURE() << "no part " << name;
  return 0;
}

Frame tower(std::size_t x, std::size_t z, std::size_t storeys, double wall = 0) {
  Frame frame = stocked_frame();
  add_regular(frame, regular(x, z, storeys, wall));
  join(frame);
  return frame;
}

double relative(double value, double expected) {
  return std::fabs(value - expected) / std::fabs(expected);
}

double norm(const JointLoad& load) {
  return std::max(length(load.force), length(load.torque));
}

/// Largest difference between the loads of joints of the same name, by the largest load.
double difference(const Frame& frame_a, const FrameSolver& a, const Frame& frame_b,
                  const FrameSolver& b) {
  std::map<std::string, std::uint32_t> names;
  for (std::uint32_t j = 0; j < frame_a.joints.size(); ++j) names[frame_a.joints[j].name] = j;
  double largest = 0, worst = 0;
  for (std::uint32_t j = 0; j < frame_b.joints.size(); ++j) {
    const JointLoad other = b.joint_load(j);
    const JointLoad one = a.joint_load(names.at(frame_b.joints[j].name));
    largest = std::max(largest, norm(other));
    worst = std::max(worst, norm({one.force - other.force, one.torque - other.torque}));
  }
  return worst / largest;
}

TEST(FrameSolver, ACantileverBendsAsTheTimoshenkoBeam) {
  const double span = 3;
  const Frame frame = straight({0, span}, {0});
  const Section& s = frame.sections[1];
  const double ei = 210e9 * s.iy, ga = shear_modulus(frame) * s.avz;
  FrameSolver solver(frame);
  solver.solve({.gravity = {}, .contacts = {{0, {span, 0, 0}, {0, -1e4, 0}}}});
  const double sag = 1e4 * span * span * span / (3 * ei) + 1e4 * span / ga;
  EXPECT_LT(relative(-solver.displacement(1).y, sag), 1e-12);
  EXPECT_LT(relative(-solver.rotation(1).z, 1e4 * span * span / (2 * ei)), 1e-12);
  EXPECT_LT(relative(solver.reaction(0).y, 1e4), 1e-12);
  EXPECT_LT(relative(solver.reaction_moment(0).z, 1e4 * span), 1e-12);
  EXPECT_LT(relative(solver.strain_energy(), 1e4 * sag / 2), 1e-12);
  solver.solve({});
  const double q = 7850 * s.area * kG;
  EXPECT_LT(relative(-solver.displacement(1).y,
                     q * std::pow(span, 4) / (8 * ei) + q * span * span / (2 * ga)),
            1e-12);
  // Hogging: the section force at the beginning is what the part beyond gives the held face.
  EXPECT_LT(relative(std::fabs(solver.joint_load(0).torque.y), q * span * span / 2), 1e-12);
  EXPECT_LT(relative(std::fabs(solver.joint_load(0).force.z), q * span), 1e-12);
  solver.solve({.gravity = {}, .contacts = {{0, {span, 0, 0.2}, {5e4, 0, 0}}}});
  EXPECT_LT(relative(solver.displacement(1).x, 5e4 * span / (210e9 * s.area)), 1e-12);
  EXPECT_LT(relative(solver.axial(0), 5e4), 1e-12);
  EXPECT_LT(relative(solver.joint_load(0).force.x, 5e4), 1e-12);
  EXPECT_LT(relative(std::fabs(solver.joint_load(0).torque.z), 1e4), 1e-12);
}

TEST(FrameSolver, ABeamFixedAtBothEndsTakesPLBy8) {
  const Frame frame = straight({0, 2.5, 5}, {0, 2});
  const Section& s = frame.sections[1];
  FrameSolver solver(frame);
  solver.solve({.gravity = {}, .contacts = {{0, {2.5, 0, 0}, {0, -2e4, 0}}}});
  const double ga = shear_modulus(frame) * s.avz;
  EXPECT_LT(
      relative(-solver.displacement(1).y, 2e4 * 125 / (192 * 210e9 * s.iy) + 2e4 * 5 / (4 * ga)),
      1e-12);
  EXPECT_LT(relative(solver.reaction_moment(0).z, 2e4 * 5 / 8), 1e-12);
  // One member between two supports has no node that moves.
  const Frame single = straight({0, 5}, {0, 1});
  FrameSolver held(single);
  held.solve({});
  EXPECT_LT(relative(held.reaction_moment(0).z, 7850 * s.area * kG * 25 / 12), 1e-12);
}

TEST(FrameSolver, AMemberInTwoPiecesIsTheSame) {
  for (const double at : {0.37, 2.0, 4.9}) {
    const Frame whole = straight({0, 5, 7}, {0}), split = straight({0, at, 5, 7}, {0});
    FrameSolver a(whole), b(split);
    const FrameLoads::OnPart tip{1, {6, 0, 0.1}, {3e4, -1e4, 4e3}};
    a.solve({.contacts = {tip}});
    b.solve({.contacts = {{2, tip.point, tip.force}}});
    EXPECT_LT(length(a.displacement(2) - b.displacement(3)), 1e-10 * length(a.displacement(2)));
    EXPECT_LT(length(a.rotation(2) - b.rotation(3)), 1e-10 * length(a.rotation(2)));
    EXPECT_LT(length(a.reaction_moment(0) - b.reaction_moment(0)),
              1e-10 * length(a.reaction_moment(0)));
  }
}

/// Half the load at either top: sway u, rotation t and rise v of the posts, Euler–Bernoulli.
TEST(FrameSolver, APortalSwaysAsBySlopeDeflection) {
  const double h = 3.5, span = 6, load = 2e4;
  Frame frame = lines({{0, 0, 0}, {span, 0, 0}, {0, h, 0}, {span, h, 0}}, 2, {{0, 2}, {1, 3}},
                      FrameMember::Kind::post, 0);
  FrameMember beam;
  beam.name = "beam";
  beam.from = 2;
  beam.to = 3;
  beam.section = 1;
  frame.members.push_back(beam);
  join(frame);
  FrameSolver solver(frame, {.shear = false});
  solver.solve(
      {.gravity = {},
       .contacts = {{0, {0, h, 0}, {load / 2, 0, 0}}, {1, {span, h, 0}, {load / 2, 0, 0}}}});
  const double e = 210e9, post = e * frame.sections[0].iz, girder = e * frame.sections[1].iy;
  // Energy: post 12 u²/h³ − 12 u t/h² + 4 t²/h, girder 6 (t − 2 v/L)²/L, axial v²/h; per EI, EA.
  const double b = 12 * girder / span, c = e * frame.sections[0].area / h;
  // v from its own row: 2 c v = (2/L) b (t − 2 v/L); t: 8 EI/h t − 12 EI/h² u + b (t − 2 v/L) = 0.
  const double k = b * 2 * c / (2 * c + 4 * b / (span * span));  // b (t − 2 v/L) = k t
  const double per_sway = 12 * post / (h * h) / (8 * post / h + k);
  const double sway = load / (24 * post / (h * h * h) - 12 * post / (h * h) * per_sway);
  EXPECT_LT(relative(solver.displacement(2).x, sway), 1e-11);
  EXPECT_LT(relative(-solver.rotation(2).z, per_sway * sway), 1e-11);
  const double foot = 6 * post / (h * h) * sway - 2 * post / h * per_sway * sway;
  EXPECT_LT(relative(solver.reaction_moment(0).z, foot), 1e-11);
  EXPECT_LT(relative(solver.reaction(0).x, -load / 2), 1e-11);
}

TEST(FrameSolver, ATripodOfHingedBarsIsATruss) {
  const double h = 4, r = 3, load = 1e5;
  std::vector<Vec3> nodes;
  for (int i = 0; i < 3; ++i)
    nodes.push_back(
        {r * std::cos(2.0943951023931953 * i), 0, r * std::sin(2.0943951023931953 * i)});
  nodes.push_back({0, h, 0});
  Frame frame = lines(nodes, 3, {{0, 3}, {1, 3}, {2, 3}});
  JointClass hinge;
  hinge.name = "beam";
  hinge.rigid = false;
  frame.classes = {hinge};
  join(frame);
  FrameSolver solver(frame);
  solver.solve({.gravity = {}, .contacts = {{0, {0, h, 0}, {0, -load, 0}}}});
  const double bar = std::hypot(h, r);
  for (std::uint32_t m = 0; m < 3; ++m)
    EXPECT_LT(relative(solver.axial(m), -load * bar / (3 * h)), 1e-9);
  EXPECT_LT(relative(-solver.displacement(3).y,
                     load * bar * bar * bar / (3 * h * h * 210e9 * frame.sections[1].area)),
            1e-9);
  EXPECT_TRUE(solver.mechanisms().empty());
}

/// The masses per metre of the reference: 117 and 42.2 kg/m.
Frame reference_tower(std::size_t x, std::size_t z, std::size_t storeys) {
  Frame frame = tower(x, z, storeys);
  frame.steels.push_back(frame.steels[0]);
  frame.steels[0].density = 117 / frame.sections[0].area;
  frame.steels[1].density = 42.2 / frame.sections[1].area;
  for (FrameMember& member : frame.members)
    if (member.kind == FrameMember::Kind::beam) member.steel = 1;
  return frame;
}

struct Roof {
  double mean = 0, largest = 0, least = 1e300;  ///< sag, mm
};
Roof roof_of(const Frame& frame, const FrameSolver& solver, double height) {
  Roof roof;
  int count = 0;
  for (std::uint32_t n = 0; n < frame.nodes.size(); ++n) {
    if (frame.nodes[n].position.y < height - 0.1) continue;
    const double sag = -1e3 * solver.displacement(n).y;
    roof.mean += sag;
    roof.largest = std::max(roof.largest, sag);
    roof.least = std::min(roof.least, sag);
    ++count;
  }
  roof.mean /= count;
  return roof;
}

double foot_load(const Frame& frame, const FrameSolver& solver, const std::string& post) {
  return -1e-3 * solver.joint_load(joint_of(frame, post + "@ground")).force.x;
}

double largest_beam_moment(const Frame& frame, const FrameSolver& solver) {
  double largest = 0;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    if (frame.joints[j].kind == FrameJoint::Kind::beam_end)
      largest = std::max(largest, std::fabs(solver.joint_load(j).torque.y));
  return 1e-3 * largest;
}

// Against frame3dd and CalculiX 2.20 (252 members, Euler–Bernoulli, slabs a quarter per edge).
TEST(FrameSolver, TwelveStoreysSagAsTheReference) {
  const Frame frame = reference_tower(3, 3, 12);
  FrameSolver solver(frame, {.shear = false});
  solver.solve({});
  const Roof roof = roof_of(frame, solver, 42);
  EXPECT_NEAR(roof.largest, 10.975, 6e-4);
  EXPECT_NEAR(roof.mean, 5.539, 6e-4);
  EXPECT_NEAR(roof.least, 3.551, 6e-4);
  EXPECT_NEAR(foot_load(frame, solver, "post_0_0_0"), 485.6, 0.05);
  EXPECT_NEAR(foot_load(frame, solver, "post_1_0_0"), 865.1, 0.05);
  EXPECT_NEAR(foot_load(frame, solver, "post_0_1_0"), 841.2, 0.05);
  EXPECT_NEAR(foot_load(frame, solver, "post_1_1_0"), 1538.9, 0.05);
  EXPECT_NEAR(largest_beam_moment(frame, solver), 44.64, 6e-3);
  EXPECT_LT(solver.residual(), 1e-10);
  FrameSolver sheared(frame);
  sheared.solve({});
  EXPECT_NEAR(roof_of(frame, sheared, 42).largest, 11.010, 1e-3);  // of our own
}

TEST(FrameSolver, SixStoreysCarryAsTheReference) {
  const Frame frame = reference_tower(5, 4, 6);
  FrameSolver solver(frame, {.shear = false});
  solver.solve({});
  const Roof roof = roof_of(frame, solver, 21);
  EXPECT_NEAR(roof.mean, 1.962, 6e-4);
  EXPECT_NEAR(roof.largest, 3.187, 6e-4);
  EXPECT_NEAR(foot_load(frame, solver, "post_0_0_0"), 228.656, 6e-4);
  EXPECT_NEAR(foot_load(frame, solver, "post_2_1_0"), 814.817, 6e-4);
  EXPECT_NEAR(foot_load(frame, solver, "post_1_1_0"), 818.561, 6e-4);
  EXPECT_NEAR(largest_beam_moment(frame, solver), 35.44, 6e-3);
}

TEST(FrameSolver, ReactionsBalanceTheWeightInAnyDirection) {
  const Frame frame = tower(4, 3, 4, 0.2);
  double mass = 0;
  const std::vector<PartSolid> solids = solids_of(frame);
  for (std::uint32_t part = 0; part < frame.part_count(); ++part) {
    const bool on_ground =
        part >= frame.wall_part(0) && frame.walls[part - frame.wall_part(0)].edges[0] == kNoPart;
    if (!on_ground) mass += solids[part].mass;
  }
  for (const Vec3 gravity : {Vec3{0, -kG, 0}, Vec3{2, -kG, 0.7}, Vec3{0, 0, 3}}) {
    FrameSolver solver(frame);
    const FrameLoads::OnPart push{frame.slab_part(2), {7, 4, 2}, {1e4, 2e4, -3e4}};
    solver.solve({.gravity = gravity, .contacts = {push}});
    Vec3 sum;
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (frame.joints[j].kind == FrameJoint::Kind::base) sum = sum + solver.reaction(j);
    EXPECT_LT(length(sum + push.force + mass * gravity), 1e-12 * mass * length(gravity));
    EXPECT_LT(solver.residual(), 1e-10);
  }
}

TEST(FrameSolver, ReactionsBalanceTheMomentOfContacts) {
  Frame frame = tower(3, 3, 2, 0.2);
  JointClass hinge;  // beams free at both ends still pass the torsion of a load beside them
  hinge.name = "hinge";
  hinge.rigid = false;
  frame.classes.push_back(hinge);
  for (FrameJoint& joint : frame.joints)
    if (joint.name.starts_with("beam_x_1_1_0@"))
      joint.joint_class = static_cast<std::uint32_t>(frame.classes.size() - 1);
  FrameSolver solver(frame);
  // Of this wall only the joints above and below are left: in line.
  solver.break_joints(std::vector{joint_of(frame, "wall_x_1_0_1@post_1_0_1"),
                                  joint_of(frame, "wall_x_1_0_1@post_2_0_1")});
  const Vec3 about{1, 2, 3};
  for (const char* name : {"slab_0_1_1", "wall_x_0_0_1", "wall_z_0_1_0", "post_1_1_1",
                           "wall_x_1_0_1", "beam_x_1_1_0"}) {
    const FrameLoads::OnPart push{part_of(frame, name), {5.3, 4.2, 5.9}, {3e4, 2e4, -1e4}};
    solver.solve({.gravity = {}, .contacts = {push}});
    Vec3 moment = cross(push.point - about, push.force);
    const double scale = length(moment);
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
      if (frame.joints[j].kind != FrameJoint::Kind::base) continue;
      moment = moment + solver.reaction_moment(j) +
               cross(frame.joints[j].point - about, solver.reaction(j));
    }
    EXPECT_LT(length(moment), 1e-10 * scale) << name;
  }
}

TEST(FrameSolver, DisplacementsAreReciprocal) {
  const Frame frame = tower(3, 2, 2);
  FrameSolver solver(frame);
  const std::uint32_t post = part_of(frame, "post_1_0_1"), beam = part_of(frame, "beam_x_1_1_0");
  const std::uint32_t top = frame.members[post].to, end = frame.members[beam].to;
  solver.solve({.gravity = {}, .contacts = {{post, frame.nodes[top].position, {1e4, 0, 0}}}});
  const double there = solver.displacement(end).z;
  solver.solve({.gravity = {}, .contacts = {{beam, frame.nodes[end].position, {0, 0, 1e4}}}});
  EXPECT_LT(std::fabs(solver.displacement(top).x - there),
            1e-12 * length(solver.displacement(end)));
}

/// The frame without some of its joints.
Frame without_joints(Frame frame, const std::vector<std::uint32_t>& broken) {
  std::vector<FrameJoint> kept;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    if (std::ranges::find(broken, j) == broken.end()) kept.push_back(frame.joints[j]);
  frame.joints = kept;
  return frame;
}

TEST(FrameSolver, BreakingIsBuildingWithout) {
  const Frame frame = tower(3, 3, 3, 0.2);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    std::mt19937_64 random(seed);
    FrameSolver solver(frame, {.slabs = "load"});
    std::vector<std::uint32_t> broken;
    FrameLoads loads;
    loads.contacts = {{frame.slab_part(3), {3, 7, 9}, {2e4, -5e4, 1e4}},
                      {7, {3, 2, 1}, {0, 0, 9e3}}};
    for (int batch = 0; batch < 4; ++batch) {
      std::vector<std::uint32_t> now;
      for (std::uint64_t i = 0; i < 1 + random() % 6; ++i)
        now.push_back(static_cast<std::uint32_t>(random() % frame.joints.size()));
      solver.break_joints(now);
      broken.insert(broken.end(), now.begin(), now.end());
    }
    solver.solve(loads);
    const Frame rest = without_joints(frame, broken);
    FrameSolver fresh(rest);
    fresh.solve(loads);
    EXPECT_LT(difference(frame, solver, rest, fresh), 1e-9) << "seed " << seed;
    EXPECT_LT(solver.residual(), 1e-10) << "seed " << seed;
    EXPECT_EQ(solver.loose_parts(), fresh.loose_parts()) << "seed " << seed;
  }
}

TEST(FrameSolver, TurningTheFrameTurnsNothingInItsJoints) {
  const Frame frame = tower(3, 2, 3, 0.2);
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](Vec3 v) { return Vec3{c * v.x + s * v.z, v.y, -s * v.x + c * v.z}; };
  Frame turned = frame;
  for (FrameNode& node : turned.nodes) node.position = turn(node.position);
  for (FrameMember& member : turned.members)
    if (member.kind == FrameMember::Kind::post) member.roll += angle;
  join(turned);
  FrameSolver a(frame), b(turned);
  const Vec3 gravity{1, -kG, 2}, point{4, 7.3, 5}, force{1e4, 2e4, 3e4};
  const std::uint32_t slab = frame.slab_part(1);
  a.solve({.gravity = gravity, .contacts = {{slab, point, force}}});
  b.solve({.gravity = turn(gravity), .contacts = {{slab, turn(point), turn(force)}}});
  EXPECT_LT(difference(frame, a, turned, b), 1e-10);
}

/// The same frame with its nodes and members in the opposite order.
Frame reversed(const Frame& frame) {
  Frame other = frame;
  const auto nodes = static_cast<std::uint32_t>(frame.nodes.size());
  const auto members = static_cast<std::uint32_t>(frame.members.size());
  std::ranges::reverse(other.nodes);
  std::ranges::reverse(other.members);
  for (FrameMember& m : other.members) {
    m.from = nodes - 1 - m.from;
    m.to = nodes - 1 - m.to;
  }
  for (FrameSlab& slab : other.slabs) {
    for (std::uint32_t& n : slab.nodes) n = nodes - 1 - n;
    for (std::uint32_t& m : slab.beams) m = members - 1 - m;
  }
  join(other);
  return other;
}

TEST(FrameSolver, TheOrderOfPartsIsNoMatter) {
  const Frame frame = tower(4, 3, 3), other = reversed(frame);
  FrameSolver a(frame), b(other);
  a.solve({});
  b.solve({});
  EXPECT_LT(difference(frame, a, other, b), 1e-11);
}

TEST(FrameSolver, AMirroredFrameCarriesTheSame) {
  const Frame frame = tower(4, 3, 3);
  FrameSolver solver(frame);
  solver.break_joints(std::vector{joint_of(frame, "beam_x_0_0_0@post_0_0_0")});
  FrameSolver mirror(frame);
  mirror.break_joints(std::vector{joint_of(frame, "beam_x_2_0_0@post_3_0_0")});
  solver.solve({});
  mirror.solve({});
  for (int x = 0; x < 4; ++x)
    for (int z = 0; z < 3; ++z) {
      const auto post = [&](int at) {
        return "post_" + std::to_string(at) + "_" + std::to_string(z) + "_0";
      };
      EXPECT_LT(relative(foot_load(frame, solver, post(x)), foot_load(frame, mirror, post(3 - x))),
                1e-11);
    }
}

TEST(FrameSolver, ABrokenBeamHangsOnItsOtherEnd) {
  const Frame frame = tower(2, 2, 1);
  FrameSolver solver(frame);
  solver.break_joints(std::vector{joint_of(frame, "beam_x_0_0_0@post_1_0_0")});
  solver.solve({});
  const double steel = 7850 * frame.sections[1].area * 6 * kG, slab = 12960 * kG / 4;
  const JointLoad load = solver.joint_load(joint_of(frame, "beam_x_0_0_0@post_0_0_0"));
  EXPECT_LT(relative(std::fabs(load.force.z), steel + slab), 1e-12);
  EXPECT_LT(relative(std::fabs(load.torque.y), 3 * (steel + slab)), 1e-12);
  EXPECT_NEAR(load.force.x, 0, 1e-6);
  EXPECT_TRUE(solver.loose_parts().empty());
  // Without the other end the beam is gone; the slab lies on the two opposite beams it has left.
  solver.break_joints(std::vector{joint_of(frame, "beam_x_0_0_0@post_0_0_0")});
  solver.solve({});
  EXPECT_EQ(solver.loose_parts(), std::vector{part_of(frame, "beam_x_0_0_0")});
  const auto passed = [&](const char* beam) {
    return -solver.joint_load(joint_of(frame, std::string("slab_0_0_0@") + beam)).force.x;
  };
  EXPECT_LT(relative(passed("beam_z_0_0_0"), 2 * slab), 1e-12);
  EXPECT_LT(relative(passed("beam_z_1_0_0"), 2 * slab), 1e-12);
  EXPECT_NEAR(passed("beam_x_0_1_0"), 0, 1e-9 * slab);
}

TEST(FrameSolver, ASlabOnTwoJointsIsLoose) {
  const Frame frame = tower(3, 2, 2);
  FrameSolver solver(frame);
  solver.break_joints(std::vector{joint_of(frame, "slab_0_0_1@beam_x_0_0_1")});
  EXPECT_TRUE(solver.loose_parts().empty());
  solver.break_joints(std::vector{joint_of(frame, "slab_0_0_1@beam_z_0_0_1")});
  EXPECT_EQ(solver.loose_parts(), std::vector{part_of(frame, "slab_0_0_1")});
  solver.solve({});
  Vec3 sum;
  double mass = 0;
  for (const PartSolid& solid : solids_of(frame)) mass += solid.mass;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    if (frame.joints[j].kind == FrameJoint::Kind::base) sum = sum + solver.reaction(j);
  EXPECT_LT(relative(sum.y, (mass - 12960) * kG), 1e-12);
  solver.remove_parts(std::vector{part_of(frame, "slab_0_0_1")});
  EXPECT_TRUE(solver.loose_parts().empty());
}

TEST(FrameSolver, ASlabHoldsNoPieceToTheRest) {
  const Frame frame = tower(2, 2, 1);
  FrameSolver solver(frame);
  EXPECT_TRUE(solver.bridging_joints().empty());
  std::vector<std::uint32_t> broken;
  for (const char* name : {"beam_x_0_0_0@post_1_0_0", "beam_x_0_1_0@post_1_1_0"})
    broken.push_back(joint_of(frame, name));
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    if (frame.joints[j].b == kNoPart && frame.joints[j].point.x > 1) broken.push_back(j);
  solver.break_joints(broken);
  // Two posts and the beam between them hang on nothing but the slab.
  EXPECT_EQ(solver.bridging_joints(), std::vector{joint_of(frame, "slab_0_0_0@beam_z_1_0_0")});
}

TEST(FrameSolver, WaysOfMassesAreTheWorkOfTheirWeight) {
  const Frame frame = tower(3, 2, 2);
  FrameSolver solver(frame);
  solver.break_joints(std::vector{joint_of(frame, "beam_x_0_0_0@post_1_0_0"),
                                  joint_of(frame, "slab_1_0_1@beam_x_1_0_1")});
  const FrameLoads loads{.live = std::vector<double>(frame.slabs.size(), 2e3)};
  solver.solve(loads);
  double sum = 0;
  std::vector<std::uint32_t> parts(frame.part_count());
  std::iota(parts.begin(), parts.end(), 0u);
  for (const FrameSolver::MassWay& way : solver.ways_of_displacements(loads.live, parts))
    sum += way.moved.y;
  EXPECT_LT(sum, 0);
  EXPECT_LT(relative(-kG * sum, solver.work_of(loads)), 1e-12);
}

TEST(FrameSolver, APushOnASlabIsSharedByItsJoints) {
  const Frame frame = tower(2, 2, 1);
  FrameSolver solver(frame);
  const Vec3 point{4, 3.5, 5}, force{3e4, -4e4, 1e4};
  solver.solve({.gravity = {}, .contacts = {{frame.slab_part(0), point, force}}});
  Vec3 sum, moment = cross(point, force);
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const FrameJoint& joint = frame.joints[j];
    if (joint.kind != FrameJoint::Kind::slab) continue;
    const Vec3 on_beam = joint.axes * solver.joint_load(j).force;
    sum = sum + on_beam;
    moment = moment - cross(joint.point, on_beam);
  }
  EXPECT_LT(length(sum - force), 1e-12 * length(force));
  EXPECT_LT(length(moment), 1e-11 * length(force));
}

TEST(FrameSolver, ARotatingRodPullsItselfApart) {
  for (const int pieces : {2, 4, 6, 16}) {
    std::vector<double> at;
    for (int i = 0; i <= pieces; ++i) at.push_back(8.0 * i / pieces);
    const Frame frame = straight(at, {});
    FrameSolver solver(frame);
    solver.solve({.gravity = {}, .spins = {{0, {0, 20, 0}}}});
    const double mass = 7850 * frame.sections[1].area * 8;
    const auto m = static_cast<std::size_t>(pieces / 2);
    const std::string joint = "member" + std::to_string(m) + "@member" + std::to_string(m - 1);
    EXPECT_LT(relative(solver.joint_load(joint_of(frame, joint)).force.x, mass * 400 * 8 / 8),
              1e-12);
    EXPECT_LT(solver.pin_force(), 1e-9 * mass * 400 * 8);
  }
}

// The polar inertia of the section, p per metre: torque-free, the axis of a rod spinning at (a, b,
// 0) precesses, which leaves couples p a b per metre and a load −12 a b p x/L² across.
TEST(FrameSolver, ATumblingRodBendsByItsPolarInertia) {
  const double span = 8, a = 30, b = 20;
  const Frame frame = straight({0, 2, 4, 8}, {});
  const Section& s = frame.sections[1];
  FrameSolver solver(frame);
  solver.solve({.gravity = {}, .spins = {{0, {a, b, 0}}}});
  const double polar = 7850 * (s.iy + s.iz);
  const JointLoad quarter = solver.joint_load(joint_of(frame, "member1@member0"));
  EXPECT_LT(relative(quarter.torque.y, 3.0 / 32 * a * b * polar * span), 1e-8);
  const JointLoad middle = solver.joint_load(joint_of(frame, "member2@member1"));
  EXPECT_LT(std::fabs(middle.torque.y), 1e-8 * a * b * polar * span);
}

TEST(FrameSolver, AFreeBeamHitAtItsEndBends4PLBy27) {
  const double span = 6, load = 1e4;
  const Frame frame = straight({0, 2, 5, 6}, {});
  for (const bool shear : {false, true}) {
    FrameSolver solver(frame, {.shear = shear});
    solver.solve({.contacts = {{0, {0, 0, 0}, {0, load, 0}}}});
    const JointLoad third = solver.joint_load(joint_of(frame, "member1@member0"));
    EXPECT_LT(relative(std::fabs(third.torque.y), 4 * load * span / 27), 1e-12);
    EXPECT_LT(solver.pin_force(), 1e-9 * load);
  }
}

TEST(FrameSolver, ACutOffHalfDoesNotFeelItsPin) {
  const Frame frame = tower(5, 4, 6), other = reversed(frame);
  const auto cut = [](const Frame& f) {
    std::vector<std::uint32_t> joints;
    for (std::uint32_t j = 0; j < f.joints.size(); ++j)
      if (f.joints[j].kind == FrameJoint::Kind::splice &&
          std::fabs(f.joints[j].point.y - 10.5) < 0.1)
        joints.push_back(j);
    return joints;
  };
  FrameSolver a(frame), b(other);
  a.break_joints(cut(frame));
  b.break_joints(cut(other));
  const auto loads = [](const Frame& f) {
    FrameLoads l;
    const std::uint32_t beam = part_of(f, "beam_x_0_0_5");
    l.contacts = {{beam, {2, 21, 0.1}, {3e5, 2e5, -1e5}},
                  {part_of(f, "slab_2_1_4"), {13, 17, 7}, {0, -2e5, 4e4}}};
    l.spins = {{beam, {0.3, -0.5, 0.2}}};
    return l;
  };
  a.solve(loads(frame));
  b.solve(loads(other));
  EXPECT_LT(a.pin_force(), 1e-8 * 3e5);
  EXPECT_LT(b.pin_force(), 1e-8 * 3e5);
  EXPECT_LT(difference(frame, a, other, b), 1e-8);
}

TEST(FrameSolver, AMechanismIsNamed) {
  Frame frame = lines({{0, 0, 0}, {6, 0, 0}, {0, 3, 0}, {6, 3, 0}}, 2, {{0, 2}, {1, 3}, {2, 3}});
  JointClass hinge;
  hinge.name = "beam";
  hinge.rigid = false;
  frame.classes = {hinge};
  join(frame);
  try {
    const FrameSolver solver(frame);
    FAIL() << "a linkage of four bars stands";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    const std::string what = error.what();
    EXPECT_NE(what.find("node node"), std::string::npos) << what;
    EXPECT_NE(what.find("3 m high"), std::string::npos) << what;
    EXPECT_NE(what.find("member2"), std::string::npos) << what;
  }
}

TEST(FrameSolver, WhatStopsToStandIsHeldAndToldOf) {
  Frame frame = lines({{0, 0, 0}, {3, 3, 0}, {0, 3, 0}}, 2, {{0, 2}, {1, 2}});
  JointClass pin;
  pin.name = "pin";
  pin.rigid = false;
  frame.classes = {pin};
  join(frame, {{"member0", "ground", "node0", "pin"},
               {"member1", "ground", "node1", "beam"},
               {"member1", "member0", "node2", "beam"}});
  FrameSolver solver(frame);
  solver.solve({});
  EXPECT_TRUE(solver.mechanisms().empty());
  solver.break_joints(std::vector<std::uint32_t>{1});
  solver.solve({});
  ASSERT_EQ(solver.mechanisms().size(), 1u);
  EXPECT_EQ(solver.mechanisms()[0].node, 2u);
  EXPECT_NE(solver.mechanisms()[0].what.find("node node2"), std::string::npos);
  EXPECT_TRUE(std::isfinite(solver.displacement(2).x));
  // What hangs on one hinge alone is loose.
  solver.break_joints(std::vector<std::uint32_t>{2});
  EXPECT_TRUE(solver.mechanisms().empty());
  EXPECT_EQ(solver.loose_parts(), (std::vector<std::uint32_t>{0, 1}));
}

TEST(FrameSolver, LiveLoadsAndPartsGoneShowAtTheGround) {
  const Frame frame = tower(3, 2, 2);
  FrameSolver solver(frame);
  const auto weight = [&](const FrameLoads& loads) {
    solver.solve(loads);
    double sum = 0;
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (frame.joints[j].kind == FrameJoint::Kind::base) sum += solver.reaction(j).y;
    return sum;
  };
  const double before = weight({});
  std::vector<double> live(frame.slabs.size(), 0);
  live[1] = 2500;
  EXPECT_LT(relative(weight({.live = live}) - before, 2500 * 36), 1e-9);
  // A beam of the roof, and with it a quarter less of the slab's joints but not of its weight.
  solver.remove_parts(std::vector{part_of(frame, "beam_x_0_0_1")});
  EXPECT_LT(relative(before - weight({}), 7850 * frame.sections[1].area * 6 * kG), 1e-9);
  EXPECT_TRUE(solver.loose_parts().empty());
  EXPECT_EQ(norm(solver.joint_load(joint_of(frame, "slab_0_0_1@beam_x_0_0_1"))), 0);
}

TEST(FrameSolver, UnitsThatSlippedAreRefused) {
  const Frame frame = tower(2, 2, 1);
  const auto refused = [](const Frame& f, const char* word) {
    try {
      const FrameSolver solver(f);
      return false;
    } catch (const Error& error) {
      return std::string(error.what()).find(word) != std::string::npos;
    }
  };
  Frame inertia = frame, area = frame, modulus = frame;
  inertia.sections[0].iy *= 1e3;
  EXPECT_TRUE(refused(inertia, "section HEB300: iy"));
  inertia.sections[0].iy *= 1e-9;
  EXPECT_TRUE(refused(inertia, "section HEB300: iy"));
  area.sections[1].area = 53.81;
  EXPECT_TRUE(refused(area, "section IPE300: area"));
  modulus.steels[0].youngs_modulus = 210e3;
  EXPECT_TRUE(refused(modulus, "steel s235: youngs_modulus"));
}

TEST(FrameSolver, AChainOfGivenJointsParts) {
  // Two beams meet at node 1; a third hangs on the second of them.
  Frame frame = lines({{0, 0, 0}, {3, 0, 0}, {6, 0, 0}, {3, 0, 2}}, 0, {{0, 1}, {1, 2}, {1, 3}});
  frame.nodes[0].support = frame.nodes[2].support = true;
  join(frame, {{"member0", "ground", "node0", "beam"},
               {"member1", "ground", "node2", "beam"},
               {"member1", "member0", "node1", "beam"},
               {"member2", "member1", "node1", "beam"}});
  FrameSolver solver(frame);
  solver.solve({});
  const double weight = 7850 * frame.sections[1].area * 2 * kG;
  const Vec3 end = solver.joint_load(3).force;
  EXPECT_LT(relative(std::fabs(end.z), weight), 1e-10);
  solver.break_joints(std::vector<std::uint32_t>{2});
  solver.solve({});
  // Now both hang on the ground, and the third goes with the second.
  EXPECT_LT(relative(solver.reaction(0).y, 1.5 * weight), 1e-10);
  EXPECT_LT(relative(solver.reaction(1).y, 2.5 * weight), 1e-10);
  EXPECT_LT(relative(std::fabs(solver.joint_load(3).force.z), weight), 1e-10);
}

TEST(FrameSolver, ARingOfGivenJointsIsRefused) {
  Frame frame = lines({{0, 0, 0}, {3, 0, 0}, {6, 0, 0}, {3, 0, 2}}, 1, {{0, 1}, {1, 2}, {1, 3}});
  join(frame, {{"member0", "ground", "node0", "beam"},
               {"member1", "member0", "node1", "beam"},
               {"member2", "member1", "node1", "beam"},
               {"member2", "member0", "node1", "beam"}});
  EXPECT_THROW(FrameSolver{frame}, Error);
}

TEST(FrameSolver, SecondOrderIsTheBeamColumn) {
  std::vector<Vec3> nodes;
  std::vector<std::array<std::uint32_t, 2>> members;
  for (std::uint32_t i = 0; i <= 16; ++i) {
    nodes.push_back({0, 0.5 * i, 0});
    if (i > 0) members.push_back({i - 1, i});
  }
  Frame frame = lines(nodes, 1, members, FrameMember::Kind::post, 0);
  join(frame);
  const double h = 8, ei = 210e9 * frame.sections[0].iz,
               euler = 9.869604401089358 * ei / (4 * h * h);
  FrameSolver solver(frame, {.shear = false, .p_delta = true});
  for (const double share : {0.2, 0.5, 0.9}) {
    const double load = share * euler, k = std::sqrt(load / ei);
    solver.solve({.gravity = {}, .contacts = {{15, {0, h, 0}, {1e3, -load, 0}}}});
    EXPECT_LT(relative(solver.displacement(16).x, 1e3 * (std::tan(k * h) - k * h) / (k * load)),
              1e-4)
        << share;
  }
  const FrameLoads too_much{.gravity = {}, .contacts = {{15, {0, h, 0}, {1e3, -1.05 * euler, 0}}}};
  EXPECT_THROW(solver.solve(too_much), Error);
  solver.solve({.gravity = {}, .contacts = {{15, {0, h, 0}, {1e3, 0, 0}}}});
  EXPECT_LT(relative(solver.displacement(16).x, 1e3 * h * h * h / (3 * ei)), 1e-10);
}

/// The freedom that moves a node along x (0), y, z.
std::size_t freedom_of(FrameSolver& solver, std::uint32_t node, int axis) {
  std::vector<double> u(solver.freedoms(), 0);
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = 1;
    solver.set_displacements(u, {});
    const Vec3 d = solver.displacement(node);
    u[i] = 0;
    if (d == Vec3{axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0}) return i;
  }
  ADD_FAILURE() << "node " << node << " does not move";
  return 0;
}

TEST(FrameSolver, ADiaphragmShearsAsItsConcrete) {
  Frame frame = tower(2, 2, 1);
  for (Material& material : frame.materials) material.youngs_modulus = 30e9;
  FrameSolver bare(frame), stiff(frame, {.slabs = "diaphragm"});
  std::vector<double> u(bare.freedoms(), 0), force(u.size());
  const double strain = 1e-3;
  double least = 1e300;
  for (const FrameNode& node : frame.nodes) least = std::min(least, node.position.z);
  for (std::uint32_t n = 0; n < frame.nodes.size(); ++n)
    if (!frame.nodes[n].support)
      u[freedom_of(bare, n, 0)] = strain * (frame.nodes[n].position.z - least);
  const auto energy = [&](const FrameSolver& solver) {
    solver.stiffness_times(u, force);
    double sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) sum += u[i] * force[i] / 2;
    return sum;
  };
  const double shear = 30e9 / (2 * (1 + frame.materials[0].poisson_ratio));
  EXPECT_LT(relative(energy(stiff) - energy(bare), shear * 0.15 * 36 * strain * strain / 2), 1e-9);
  // Its joints pass shear flow × edge along the beams, all the way around.
  stiff.set_displacements(u, {.gravity = {}});
  const double flow = shear * 0.15 * strain;
  Vec3 moment;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    if (frame.joints[j].kind == FrameJoint::Kind::slab) {
      const FrameJoint& joint = frame.joints[j];
      EXPECT_LT(relative(std::fabs(stiff.joint_load(j).force.y), flow * 6), 1e-9);
      moment = moment + cross(joint.point, joint.axes * stiff.joint_load(j).force);
    }
  }
  EXPECT_LT(std::fabs(moment.y), 1e-9 * flow * 36);
}

TEST(FrameSolver, RigidMotionsHaveTheMassOfTheParts) {
  const Frame frame = straight({0, 1.5, 4}, {});
  FrameSolver solver(frame);
  std::vector<double> u(solver.freedoms(), 0), force(u.size());
  for (std::uint32_t n = 0; n < 3; ++n) u[freedom_of(solver, n, 1)] = 1;
  solver.mass_times(u, force);
  double sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i) sum += u[i] * force[i];
  EXPECT_LT(relative(sum, 7850 * frame.sections[1].area * 4), 1e-12);
}

TEST(FrameSolver, TheSystemIsStiffnessAndMass) {
  const Frame frame = tower(3, 2, 2, 0.2);
  FrameSolver solver(frame, {.stiffness = 1.5, .mass = 2e4});
  solver.break_joints(std::vector{joint_of(frame, "beam_x_0_0_0@post_1_0_0"),
                                  joint_of(frame, "slab_1_0_1@beam_x_1_0_1"),
                                  joint_of(frame, "wall_x_0_0_1@beam_x_0_0_0")});
  std::vector<double> f(solver.freedoms()), u(f.size()), k(f.size()), m(f.size());
  solver.load_vector({}, f);
  solver.solve_system(f, u);
  solver.stiffness_times(u, k);
  solver.mass_times(u, m);
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    worst = std::max(worst, std::fabs(1.5 * k[i] + 2e4 * m[i] - f[i]));
    largest = std::max(largest, std::fabs(f[i]));
  }
  EXPECT_LT(worst, 1e-10 * largest);
}

}  // namespace
}  // namespace sunder
