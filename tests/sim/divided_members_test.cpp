// SPDX-License-Identifier: GPL-3.0-or-later
// Members that fail between their ends: places and loads in closed form, the divided frame against
// the whole one, runs.
#include "sim/divided_members.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshing/random.hpp"
#include "sim/frame_solver.hpp"
#include "sim/member_span.hpp"
#include "tests/sim/frames.hpp"

namespace sunder {
namespace {

double random_in(double low, double high, std::uint64_t seed, std::uint64_t what) {
  return low + (high - low) * static_cast<double>(random_bits(seed, what, 7) >> 11) * 0x1p-53;
}

JointStrength ipe300(Interaction interaction = Interaction::linear) {
  const Frame frame = empty_frame();
  return section_strength(frame.sections[2], frame.steels[0], interaction);
}

/// Between hinges, under q downwards.
MemberSpan hinged(double length, double q) {
  MemberSpan span;
  span.length = length;
  span.load_a = span.load_b = {0, 0, -q};
  span.start.force = {0, 0, -q * length / 2};
  return span;
}

TEST(MemberSpan, AHingedBeamFailsInItsMiddleAtEightMByLSquared) {
  const JointStrength strength = ipe300();
  const double length = 6, q = 8 * strength.torque.y / (length * length);
  EXPECT_FALSE(weakest_inside(hinged(length, (1 - 1e-12) * q), strength, 0.3));
  EXPECT_FALSE(may_fail_inside(hinged(length, 0.45 * q), strength));
  const auto place = weakest_inside(hinged(length, 1.5 * q), strength, 0.3);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->at, 3, 1e-14);
  EXPECT_NEAR(place->utilisation, 1.5, 1e-14);
  EXPECT_EQ(place->component, "My");
}

TEST(MemberSpan, ATriangularLoadFailsItAtLByRootThree) {
  const JointStrength strength = ipe300();
  const double length = 6, q = 9 * std::sqrt(3.0) * strength.torque.y / (length * length);
  MemberSpan span;
  span.length = length;
  span.load_b = {0, 0, -2 * q};
  span.start.force = {0, 0, -2 * q * length / 6};
  const auto place = weakest_inside(span, strength, 0.3);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->at, length / std::sqrt(3.0), 1e-13);
  EXPECT_NEAR(place->utilisation, 2, 1e-13);
}

TEST(MemberSpan, APointLoadFailsItWhereItIs) {
  const JointStrength strength = ipe300();
  const double length = 6, at = 2.2, p = strength.torque.y * length / (at * (length - at));
  MemberSpan span;
  span.length = length;
  span.start.force = {0, 0, -1.25 * p * (length - at) / length};
  span.points = {{at, {0, 0, -1.25 * p}, {}}};
  const auto place = weakest_inside(span, strength, 0.3);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->at, at);
  EXPECT_NEAR(place->utilisation, 1.25, 1e-14);
  EXPECT_FALSE(weakest_inside(span, strength, 2.3)) << "too near the end";
}

TEST(MemberSpan, CantileversAndFixedBeamsFailAtTheirEnds) {
  const JointStrength strength = ipe300();
  const double length = 6, q = 24 * strength.torque.y / (length * length);
  MemberSpan span = hinged(length, 0.99 * q);
  span.start.torque = {0, 0.99 * q * length * length / 12, 0};
  EXPECT_FALSE(weakest_inside(span, strength, 0.3)) << "1.98 at its ends, 0.99 in its middle";
  span = hinged(length, q);
  span.start.force = {0, 0, -q * length};
  span.start.torque = {0, q * length * length / 2, 0};
  EXPECT_NEAR(load_at(span, length, true).torque.y, 0, 1e-9 * strength.torque.y);
  EXPECT_FALSE(weakest_inside(span, strength, 0.3));
}

MemberSpan random_span(std::uint64_t seed, double size) {
  std::uint64_t i = 0;
  const auto vec = [&](double scale) {
    Vec3 v;
    v.x = scale * random_in(-1, 1, seed, i++);
    v.y = scale * random_in(-1, 1, seed, i++);
    v.z = scale * random_in(-1, 1, seed, i++);
    return v;
  };
  MemberSpan span;
  span.length = random_in(2, 8, seed, i++);
  span.load_a = vec(size / 4), span.load_b = vec(size / 4), span.turn = vec(size / 20);
  span.start = {vec(size), vec(size / 10)};
  const std::uint64_t points = random_bits(seed, i++, 7) % 3;
  for (std::uint64_t p = 0; p < points; ++p)
    span.points.push_back({random_in(0, span.length, seed, i++), vec(size), vec(size / 10)});
  std::ranges::sort(span.points, {}, &MemberSpan::Point::at);
  return span;
}

TEST(MemberSpan, NoSampleIsWorseThanThePlaceOrTheBoundSays) {
  const JointStrength strength = ipe300();
  int found = 0, cleared = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const MemberSpan span = random_span(seed, 2e3 * (1 + 5 * static_cast<double>(seed % 60)));
    const auto use = [&](double at) {
      return utilisation(load_at(span, at, true), strength).total;
    };
    double most = 0, inner = 0;
    for (int i = 0; i <= 400; ++i) {
      const double u = use(i * span.length / 400);
      most = std::max(most, u);
      if (i > 0 && i < 400) inner = std::max(inner, u);
    }
    if (!may_fail_inside(span, strength)) {
      ++cleared;
      EXPECT_LT(most, 1) << "seed " << seed;
    }
    const double ends = std::max(use(0), use(span.length));
    const auto place = weakest_inside(span, strength, 0);
    if (place) {
      ++found;
      EXPECT_GE(place->utilisation, 1);
    }
    // Shear alone may be most within: its plateaus and ends are the joints'.
    const bool bends = inner > 1.001 && inner > 1.01 * ends;
    if (bends && place) {
      EXPECT_GE(place->utilisation, inner * (1 - 1e-9)) << "seed " << seed;
    }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(cleared, 5);
}

/// Seen from its other end.
MemberSpan mirrored(const MemberSpan& span) {
  const auto along = [](Vec3 v) { return Vec3{-v.x, v.y, v.z}; };
  const auto about = [](Vec3 v) { return Vec3{v.x, -v.y, -v.z}; };
  const JointLoad end = load_at(span, span.length, true);
  MemberSpan result = span;
  result.start = {-1 * along(end.force), -1 * about(end.torque)};
  result.load_a = along(span.load_b), result.load_b = along(span.load_a);
  result.turn = about(span.turn);
  std::ranges::reverse(result.points);
  for (MemberSpan::Point& point : result.points)
    point = {span.length - point.at, along(point.force), about(point.moment)};
  return result;
}

TEST(MemberSpan, TheMirroredOneFailsInTheMirroredPlace) {
  const JointStrength strength = ipe300();
  int found = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const MemberSpan span = random_span(seed, 3e5);
    const auto place = weakest_inside(span, strength, 0.1);
    const auto other = weakest_inside(mirrored(span), strength, 0.1);
    ASSERT_EQ(place.has_value(), other.has_value()) << "seed " << seed;
    if (!place) continue;
    ++found;
    EXPECT_NEAR(place->utilisation, other->utilisation, 1e-9 * place->utilisation);
    EXPECT_NEAR(place->at, span.length - other->at, 1e-6) << "seed " << seed;
  }
  EXPECT_GT(found, 50);
}

TEST(DividedMembers, PartsWeighAndTurnAsTheWhole) {
  const CollapseScene scene = regular_scene(2, 2, 1);
  const PartSolid whole = solid_of(scene.frame, part_named(scene.frame, "beam_x_0_0_0"));
  const auto [a, b] = divided(whole, 0.7);
  EXPECT_NEAR(a.mass + b.mass, whole.mass, 1e-12 * whole.mass);
  EXPECT_NEAR(
      length((a.mass / whole.mass) * a.centre + (b.mass / whole.mass) * b.centre - whole.centre), 0,
      1e-13);
  const double da = dot(a.centre - whole.centre, whole.axes.z),
               db = dot(b.centre - whole.centre, whole.axes.z);
  EXPECT_NEAR(a.inertia.xx + b.inertia.xx + a.mass * da * da + b.mass * db * db, whole.inertia.xx,
              1e-11 * whole.inertia.xx);
  EXPECT_NEAR(a.inertia.zz + b.inertia.zz, whole.inertia.zz, 1e-12 * whole.inertia.zz);
  EXPECT_NEAR(da + a.half_length, db - b.half_length, 1e-14);
}

/// A building whose member divides carries as before, wherever that is, slabs and contacts on it.
TEST(DividedMembers, AJointMoreChangesNoOtherLoad) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const CollapseScene scene = regular_scene(2, 2, 2, {.slab_thickness = 0.15, .live_load = 2000});
    Frame frame = scene.frame;
    const auto m = static_cast<std::uint32_t>(random_bits(seed, 0, 1) % frame.members.size());
    const double whole = frame.length(frame.members[m]);
    const double at = random_in(0.1, 0.9, seed, 2) * whole;
    FrameLoads loads;
    loads.contacts = {{m, solid_of(frame, m).centre + Vec3{0, 0.1, 0}, {3e4, -5e4, 2e4}}};
    FrameSolver before(scene.frame);
    before.solve(loads);
    const Six moved =
        before.motion_within(m, at, before.displacements(), FrameSolver::OnMember::all);
    MemberSpan span;
    ASSERT_TRUE(before.find_span(m, span));
    const MemberDivision division = divide_member(
        frame, {m, at, frame.joints[0].joint_class, ipe300()}, [](std::uint32_t) { return true; });
    EXPECT_EQ(division.part, scene.frame.members.size());
    const bool beyond = dot(loads.contacts[0].point - frame.nodes[division.node].position,
                            axes_of(frame, frame.members[m]).x) > 0;
    loads.contacts[0].part = beyond ? division.part : m;
    FrameSolver after(frame);
    after.solve(loads);
    double size = 0;
    for (std::uint32_t n = 0; n < scene.frame.nodes.size(); ++n)
      size = std::max(size, length(before.displacement(n)));
    for (std::uint32_t n = 0; n < scene.frame.nodes.size(); ++n)
      EXPECT_NEAR(length(before.displacement(n) - after.displacement(n)), 0, 1e-9 * size);
    for (std::uint32_t j = 0; j < scene.frame.joints.size(); ++j) {
      if (scene.frame.joints[j].node == kNoPart) continue;
      EXPECT_NEAR(length(before.joint_load(j).torque - after.joint_load(j).torque), 0, 1e-2)
          << scene.frame.joints[j].name << ", seed " << seed;
    }
    const Vec3 there = after.displacement(division.node);
    EXPECT_NEAR(length(there - Vec3{moved[0], moved[1], moved[2]}), 0, 1e-9 * size);
    const JointLoad within = load_at(span, at, true), joint = after.joint_load(division.joint);
    EXPECT_NEAR(length(within.torque - joint.torque), 0, 1e-2) << "seed " << seed;
    EXPECT_NEAR(length(within.force - joint.force), 0, 1e-2) << "seed " << seed;
  }
}

/// Four posts and hinged beams, a floor on them.
CollapseScene hinged_floor(double rotation_capacity) {
  CollapseScene scene;
  scene.frame = empty_frame();
  RegularBuilding building;
  building.storeys = {StoreyParams{}};
  add_regular(scene.frame, building);
  scene.frame.classes = {{.name = "beam", .rigid = false, .rotation_capacity = rotation_capacity}};
  join(scene.frame);
  scene.scenario.load_rate = 2e4;
  scene.simulation.quasi_static = true;
  scene.simulation.duration = 1.2;
  return scene;
}

/// What a beam of the floor carries by its own weight and a quarter of the floor, N/m.
double line_load(const CollapseScene& scene, double live) {
  const Frame& frame = scene.frame;
  const double own = frame.steels[0].density * frame.sections[2].area;
  const double floor = 0.15 * frame.materials[0].density * scene.simulation.gravity + live;
  return own * scene.simulation.gravity + floor * 36 / 4 / 6;
}

TEST(DividedMembers, FloorBeamsBreakInTheirMiddlesAtEightMByLSquared) {
  const CollapseScene scene = hinged_floor(0);
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_EQ(r.members_divided, 4u);
  const double moment = ipe300().torque.y;
  int seen = 0;
  for (const JointBreak& each : r.broken_joints) {
    if (each.joint < scene.frame.joints.size()) continue;
    const std::string& name = r.recording.joints[each.joint].name;
    if (!name.ends_with("@3.000m")) continue;
    ++seen;
    EXPECT_EQ(each.mode, "strength");
    EXPECT_EQ(each.component, "My");
    const double rate = scene.scenario.load_rate, step = scene.simulation.step;
    const double now = line_load(scene, rate * each.time) * 36 / 8 / moment;
    const double before = line_load(scene, rate * (each.time - step)) * 36 / 8 / moment;
    EXPECT_NEAR(each.utilisation, now, 1e-9);
    EXPECT_LT(before, 1) << name;
  }
  EXPECT_EQ(seen, 4);
  EXPECT_GT(r.parts_freed, 4u);
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * std::fabs(r.energy.potential));
  EXPECT_LT(r.momentum_error, 1e-12);
}

TEST(DividedMembers, PartsStandInOneLineFromTheFirstFrame) {
  const CollapseScene scene = hinged_floor(0);
  const CollapseResult r = simulate_collapse(scene);
  const auto part = [&](const std::string& name) -> const RecordedPart& {
    return *std::ranges::find(r.recording.parts, name, &RecordedPart::name);
  };
  EXPECT_EQ(std::ranges::count(r.recording.parts, "beam_x_0_0_0", &RecordedPart::name), 0);
  const RecordedPart &a = part("beam_x_0_0_0_a"), &b = part("beam_x_0_0_0_b");
  const Vec3 end = a.standing * Vec3{0, 0, a.half_length};
  EXPECT_NEAR(length(end - b.standing * Vec3{0, 0, -b.half_length}), 0, 1e-12);
  EXPECT_NEAR(end.x, 3, 1e-12);
  EXPECT_EQ(a.outline.outline, b.outline.outline);
  EXPECT_EQ(r.recording.samples.size(),
            r.recording.sample_times.size() * r.recording.joints.size());
}

TEST(DividedMembers, ABeamThatBendsStaysKinked) {
  CollapseScene scene = hinged_floor(0.2);
  scene.simulation.quasi_static = false;
  scene.simulation.duration = 1.5;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_GT(r.members_divided, 0u);
  EXPECT_GT(r.plastic, 0);
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * r.plastic);
  double most = 0;
  for (const JointYield& each : r.yielded_joints)
    if (each.joint >= scene.frame.joints.size()) most = std::max(most, each.rotation);
  EXPECT_GT(most, 0.1);
  double kink = 0;
  for (std::size_t i = 0; i < r.recording.parts.size(); ++i) {
    const RecordedPart& a = r.recording.parts[i];
    if (!a.name.ends_with("_a")) continue;
    const std::string other = a.name.substr(0, a.name.size() - 1) + "b";
    const RecordedPart& b = *std::ranges::find(r.recording.parts, other, &RecordedPart::name);
    const std::string within = a.name.substr(0, a.name.size() - 2) + "@";
    const auto hinge = std::ranges::find_if(r.recording.joints, [&](const RecordedJoint& joint) {
      return joint.name.starts_with(within) && joint.name.ends_with("m");
    });
    ASSERT_NE(hinge, r.recording.joints.end()) << within;
    for (std::uint32_t t = 0; t < r.recording.times.size(); ++t) {
      if (r.recording.times[t] >= hinge->broken) break;  // free to turn on
      const Pose p = pose_at(r.recording, a.track, t, a.standing),
                 q = pose_at(r.recording, b.track, t, b.standing);
      const Vec3 gap = p * Vec3{0, 0, a.half_length} - q * Vec3{0, 0, -b.half_length};
      EXPECT_LT(length(gap), 0.05);
      kink = std::max(kink,
                      length(cross(rotate(p.rotation, {0, 0, 1}), rotate(q.rotation, {0, 0, 1}))));
    }
  }
  EXPECT_NEAR(kink, most, 0.1 * most) << "the halves turn against each other as the hinge did";
}

TEST(DividedMembers, WithoutTheRuleNoneDivides) {
  CollapseScene scene = hinged_floor(0);
  scene.rules.members_divide = false;
  EXPECT_EQ(simulate_collapse(scene).members_divided, 0u);
}

/// A small building that a ball hits from above or from the side.
CollapseScene hit(std::uint64_t seed) {
  const std::size_t storeys = 1 + seed % 2;
  StoreyParams storey;
  storey.post_section = seed % 3 == 0 ? "HEB200" : "HEB300";
  CollapseScene scene = regular_scene(2, 2, storeys, storey);
  scene.simulation.solver = "hybrid";
  scene.frame.classes[0].rotation_capacity = seed % 4 == 1 ? 0.05 : 0;
  scene.frame.classes[1].rotation_capacity = seed % 4 >= 2 ? 0.1 : 0;
  Projectile ball;
  ball.name = "ball";
  ball.radius = 0.4;
  ball.mass = random_in(500, 8000, seed, 1);
  const double height = 3.5 * static_cast<double>(storeys);
  const double speed = random_in(5, 25, seed, 3);
  if (seed % 2 == 0) {
    ball.position = {random_in(1, 5, seed, 2), height + 1.5, random_in(-0.05, 0.05, seed, 4)};
    ball.velocity = {0, -speed, 0};
  } else {
    ball.position = {-1.5, random_in(0.8, height - 0.8, seed, 2), random_in(-0.1, 0.1, seed, 4)};
    ball.velocity = {speed, 0, 0};
  }
  scene.projectiles = {ball};
  scene.simulation.duration = 0.4;
  return scene;
}

TEST(DividedMembers, BlowsLeaveTheBooksClosed) {
  std::uint64_t divided = 0;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const CollapseResult r = simulate_collapse(hit(seed));
    divided += r.members_divided;
    const double scale = std::max(r.energy_in, std::fabs(r.energy.potential));
    EXPECT_LT(std::fabs(r.energy.numerical), 1e-8 * scale) << "seed " << seed;
    EXPECT_LT(r.momentum_error, 1e-12) << "seed " << seed;
  }
  EXPECT_GT(divided, 5u);
}

TEST(DividedMembers, BlowsGiveAFrameNoMoreThanTheyBring) {
  for (std::uint64_t seed = 1; seed < 48; seed += 2) {
    CollapseScene scene = hit(seed);
    for (const bool divide : {false, true}) {
      scene.rules.members_divide = divide;
      const CollapseResult r = simulate_collapse(scene);
      EXPECT_GT(r.energy.contact, -0.01 * r.energy_in) << "seed " << seed;
      const double released = -r.energy.potential - r.energy.strain;
      EXPECT_LT(r.energy.kinetic, 1.01 * r.energy_in + released) << "seed " << seed;
    }
  }
}

TEST(DividedMembers, SkippingChangesNothingAndRunsRepeat) {
  std::uint64_t divided = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const CollapseResult skipped = simulate_collapse(hit(seed));
    const CollapseResult whole = simulate_collapse(hit(seed), {.skip = false});
    EXPECT_EQ(skipped.hash, simulate_collapse(hit(seed)).hash) << "seed " << seed;
    EXPECT_EQ(skipped.members_divided, whole.members_divided) << "seed " << seed;
    ASSERT_EQ(skipped.broken_joints.size(), whole.broken_joints.size()) << "seed " << seed;
    for (std::size_t i = 0; i < whole.broken_joints.size(); ++i)
      EXPECT_EQ(skipped.broken_joints[i].joint, whole.broken_joints[i].joint);
    divided += whole.members_divided;
  }
  EXPECT_GT(divided, 0u);
}

}  // namespace
}  // namespace sunder
