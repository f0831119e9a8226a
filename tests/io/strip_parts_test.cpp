// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "io/moment.hpp"
#include "io/sample_asset.hpp"
#include "io/sample_building.hpp"
#include "io/sight.hpp"
#include "io/strip_building.hpp"
#include "io/strip_camera.hpp"
#include "io/strip_steps.hpp"
#include "io/strip_stress.hpp"
#include "io/strip_svg.hpp"

namespace sunder {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

// --- stress

JointSample sample_of(float force, float torque) {
  JointSample sample;
  sample.force_utilisation = force, sample.torque_utilisation = torque;
  return sample;
}

// A beam whose end 0 stands on end 1 of a post that another beam ends at too.
Recording two_beams_on_a_post(double first_breaks, double second_breaks) {
  Recording recording;
  recording.times = {0, 1, 2};
  recording.parts.resize(3);
  for (RecordedPart& part : recording.parts) part.has_ends = true;
  recording.joints.resize(2);
  for (std::uint32_t j = 0; j < 2; ++j) {
    RecordedJoint& joint = recording.joints[j];
    joint.part_a = j + 1, joint.end_a = 0, joint.part_b = 0, joint.end_b = 1;
    joint.broken = j == 0 ? first_breaks : second_breaks;
  }
  recording.sample_times = {0, 1, 2};
  recording.samples = {sample_of(0.1f, 0.2f), sample_of(0.3f, 0.1f), sample_of(0.5f, 0.6f),
                       sample_of(0.2f, 0.8f), sample_of(0, 0),       sample_of(0.7f, 0.4f)};
  return recording;
}

TEST(StripStress, AnEndBearsTheMostOfItsJointsAtTheNextSample) {
  const Recording recording = two_beams_on_a_post(kNever, kNever);
  const auto at_start = end_loads(recording, 0), later = end_loads(recording, 0.5);
  EXPECT_EQ(at_start[0][1].force, 0.3f);
  EXPECT_EQ(at_start[0][1].torque, 0.2f);
  EXPECT_EQ(later[0][1].force, 0.5f);
  EXPECT_EQ(later[0][1].torque, 0.8f);
  EXPECT_EQ(later[1][0].force, 0.5f);
  EXPECT_EQ(later[0][0].force, 0);  // nothing ends there
  EXPECT_EQ(later[1][1].torque, 0);
  EXPECT_EQ(end_loads(recording, 9)[2][0].force, 0.7f);  // after the last sample
}

TEST(StripStress, AFailedJointShowsAtTheEndItHeldAndWhereNoOtherHolds) {
  const Recording recording = two_beams_on_a_post(1.5, 1.8);
  const auto before = end_loads(recording, 1), one = end_loads(recording, 1.6);
  EXPECT_FALSE(before[1][0].has_failed);
  EXPECT_TRUE(one[1][0].has_failed);
  EXPECT_FALSE(one[2][0].has_failed);
  EXPECT_FALSE(one[0][1].has_failed);  // the post still carries the other beam
  EXPECT_EQ(one[0][1].force, 0.7f);
  EXPECT_TRUE(end_loads(recording, 2)[0][1].has_failed);
  EXPECT_FALSE(end_loads(recording, 2)[0][0].has_failed);
}

TEST(StripStress, AJointInBetweenAndTheGroundHaveNoEnd) {
  Recording recording = two_beams_on_a_post(kNever, 0);
  recording.joints[0].end_b = 2;
  recording.joints[1].part_b = kNoTrack;
  const auto loads = end_loads(recording, 0);
  EXPECT_EQ(loads[0][1].force, 0);
  EXPECT_FALSE(loads[0][1].has_failed);
  EXPECT_TRUE(loads[2][0].has_failed);
}

TEST(StripStress, RedIsForceGreenTorqueYellowBothAndBlueAFailedJoint) {
  const StressLight force = light_of({0.6, 0, false}), torque = light_of({0, 0.4, false});
  const StressLight both = light_of({0.8, 0.8, false}), failed = light_of({0.2, 0.1, true});
  EXPECT_GT(force.colour[0], 200);
  EXPECT_LT(force.colour[1], 60);
  EXPECT_LT(force.colour[2], 60);
  EXPECT_GT(torque.colour[1], 150);
  EXPECT_LT(torque.colour[0], 60);
  EXPECT_GT(both.colour[0], 200);
  EXPECT_GT(both.colour[1], 180);
  EXPECT_LT(both.colour[2], 60);
  EXPECT_GT(failed.colour[2], 200);
  EXPECT_LT(failed.colour[0], 60);
  EXPECT_EQ(force.strength, 0.6);
  EXPECT_EQ(torque.strength, 0.4);
  EXPECT_EQ(failed.strength, 1);
  EXPECT_EQ(light_of({7, 0.1, false}).strength, 1);
  EXPECT_EQ(light_of({7, 7, false}).colour, both.colour);
  EXPECT_EQ(light_of({}).strength, 0);
}

// --- parts

TEST(StripBuilding, MembersAreBoxesAndSlabsKeepTheirCorners) {
  const Recording recording = sample_building({.posts_x = 2, .posts_z = 2, .storeys = 1});
  std::vector<double> areas(recording.parts.size(), 0);
  for (const StripPart& part : building_parts(recording)) {
    areas[part.chunk] += area(part.outline);
    const bool is_member = recording.parts[part.chunk].has_ends;
    EXPECT_EQ(part.end, is_member ? 0.5 : 0);
  }
  for (std::size_t p = 0; p < areas.size(); ++p) {
    EXPECT_NEAR(areas[p], area(recording.parts[p].outline), 1e-9) << recording.parts[p].name;
  }
}

TEST(StripBuilding, TheBoxOfAnISectionIsItsBoundingRectangleAndShortMembersHaveShortEnds) {
  Recording recording;
  recording.parts.resize(1);
  RecordedPart& part = recording.parts[0];
  part.has_ends = true, part.half_length = 0.6;
  part.outline.outline = {{-0.1, -0.2}, {0.1, -0.2},  {0.1, -0.19},   {0.01, -0.19},
                          {0.01, 0.2},  {-0.01, 0.2}, {-0.01, -0.19}, {-0.1, -0.19}};
  const std::vector<StripPart> parts = building_parts(recording);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(area(parts[0].outline), 0.2 * 0.4, 1e-15);
  EXPECT_NEAR(parts[0].end, 0.3, 1e-15);
}

TEST(StripBuilding, HalvesOfAPartAreAsMuchAsTheWhole) {
  StripPart part;
  part.outline = {{-1, -2}, {3, -2}, {3, 0}, {1, 4}, {-1, 4}};
  part.across.assign(5, StripPart::kBorder);
  for (const double half : {0.1, 5.0}) {
    part.half = half;
    double volume = 0;
    std::ptrdiff_t inside = 0;
    for (const StripPart& piece : halves_of(part)) {
      EXPECT_EQ(piece.outline.size(), piece.across.size());
      volume += 2 * piece.half * area(piece.outline);
      inside += std::ranges::count(piece.across, StripPart::kInside);
      inside += !piece.has_back + !piece.has_front;
      EXPECT_LT(2 * piece.half * area(piece.outline), 0.7 * 2 * half * area(part.outline));
    }
    EXPECT_NEAR(volume, 2 * half * area(part.outline), 1e-12);
    EXPECT_EQ(inside, 2);  // one face each, where they meet
  }
}

// --- steps and camera

TEST(StripBuilding, StepsAreTheStartTheFirstBreakAndTheEnd) {
  const Recording recording = sample_building({.reach = 10});
  double first = kNever;
  for (const RecordedJoint& joint : recording.joints) first = std::min(first, joint.broken);
  for (const int frames : {2, 3, 6, 9}) {
    const std::vector<std::uint32_t> steps = strip_steps(recording, frames);
    ASSERT_EQ(steps.size(), static_cast<std::size_t>(frames));
    EXPECT_EQ(steps[0], 0u);
    EXPECT_EQ(steps.back(), strip_steps(recording, 2).back());
    EXPECT_TRUE(std::ranges::is_sorted(steps));
    if (frames > 2) {
      EXPECT_EQ(steps[1], step_at(recording, first));
      EXPECT_GE(recording.times[steps[1]], first);
    }
  }
  EXPECT_EQ(strip_steps(recording, 1).size(), 1u);
  const Recording still = sample_building();
  EXPECT_EQ(strip_steps(still, 3),
            (std::vector<std::uint32_t>{0, step_at(still, still.times.back() / 2),
                                        static_cast<std::uint32_t>(still.times.size()) - 1}));
}

TEST(StripBuilding, TheCameraSeesAllThatStoodAndTheBallThatComesFromNear) {
  for (const std::uint32_t storeys : {1u, 6u, 12u}) {
    const Recording recording =
        sample_building({.posts_x = 3, .posts_z = 4, .storeys = storeys, .reach = 8});
    const StripCamera camera = place_camera(recording, strip_steps(recording, 6), 0.0);
    const double left = 0.5 * (kStripWidth - camera.width), right = left + camera.width;
    const auto expect_seen = [&](Vec3 point) {
      const Vec3 seen = camera.see(point);
      ASSERT_GT(seen.z, camera.nearest);
      const Vec2 p = camera.project(seen);
      EXPECT_GT(p.x, left);
      EXPECT_LT(p.x, right);
      EXPECT_GT(p.y, 0);
      EXPECT_LT(p.y, kStripHeight);
    };
    for (const RecordedPart& part : recording.parts) {
      for (const double z : {-part.half_length, part.half_length}) {
        for (const Vec2 p : part.outline.outline) expect_seen(part.standing * Vec3{p.x, p.y, z});
      }
    }
    if (storeys == 12) expect_seen(recording.projectiles[0].projectile.position);
    EXPECT_GT(camera.eye.y, 0.5 * 3.5 * storeys);  // above the middle
    EXPECT_GT(camera.eye.x, 6);                    // on the side the ball comes from
    EXPECT_GT(camera.eye.z, -9);
  }
}

// --- order

// Solids of a recording's parts as a strip has them.
struct Seen {
  std::vector<StripPart> parts;
  std::vector<StripSolid> solids;
};

void see_part(const StripPart& part, const Pose& pose, const StripCamera& camera, Seen& seen) {
  StripSolid& solid = seen.solids.emplace_back();
  solid.outline = part.outline;
  solid.half = part.half;
  solid.pose = pose;
  solid.eye = inverse(pose) * camera.eye;
  solid.body = part.chunk;
  std::vector<Vec2> picture;
  for (const double z : {-part.half, part.half}) {
    for (const Vec2 p : part.outline) {
      solid.corners.push_back(pose * Vec3{p.x, p.y, z});
      picture.push_back(camera.project(camera.see(solid.corners.back())));
    }
  }
  solid.silhouette = convex_hull(picture);
  solid.screen = bounding_box(solid.silhouette);
  solid.distance = length(pose.position - camera.eye);
}

Seen see_all(const Recording& recording, std::uint32_t step, const StripCamera& camera) {
  Seen seen;
  seen.parts = building_parts(recording);
  for (const StripPart& part : seen.parts) {
    see_part(part, pose_of(recording, recording.parts[part.chunk], step), camera, seen);
  }
  return seen;
}

// The oracle is ray casting.
TEST(StripBuilding, EveryLineOfSightThroughAStandingFrameEndsAtTheNearestPart) {
  const Recording recording = sample_building({.has_walls = true});
  const StripCamera camera = place_camera(recording, strip_steps(recording, 2), 0.0);
  const Seen seen = see_all(recording, 0, camera);
  std::vector<Vec3> rays;
  for (std::uint64_t k = 0; k < 1500; ++k) {
    const double x = (random_unit(1, k, 1) - 0.5) * kStripWidth / camera.focal;
    const double y = (random_unit(1, k, 2) - 0.5) * kStripHeight / camera.focal;
    rays.push_back(x * camera.right + y * camera.up - camera.back);
  }
  const Sights sights = look_along(rays, seen.solids, painters_order(seen.solids));
  EXPECT_GT(sights.right, 500u);
  EXPECT_EQ(sights.wrong, 0u);
}

TEST(StripBuilding, APostBehindASlabIsPaintedBeforeItAndOneInFrontAfterIt) {
  StripPart slab, post;
  slab.outline = rectangle({6, 6}, {-3, -3}), slab.half = 0.1;
  post.outline = rectangle({0.3, 0.3}, {-0.15, -0.15}), post.half = 2, post.chunk = 1;
  StripCamera camera{{0, 4, 20}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 10000, 0.01};
  const Quaternion upright = turned({1, 0, 0}, -0.25);
  for (const double z : {-4.0, 4.0}) {  // of the post; the slab lies about the origin
    Seen seen;
    see_part(slab, {{0, 0, 0}, upright}, camera, seen);
    see_part(post, {{0.5, 0, z}, upright}, camera, seen);
    const std::vector<std::uint32_t> order = painters_order(seen.solids);
    EXPECT_EQ(order,
              z < 0 ? (std::vector<std::uint32_t>{1, 0}) : (std::vector<std::uint32_t>{0, 1}));
  }
}

// Three rods, each over the next.
TEST(StripBuilding, ARingIsCutAtOneOfItsOwnAndHalvesOfThatCanBePutInOrder) {
  const StripCamera camera{{0, 0, 20}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 10000, 0.01};
  Seen seen;
  seen.parts.resize(4);
  const auto rod_pose = [](int k) {
    const Pose rod{{0, -0.9, 0}, turned({0, 1, 0}, 0.04)};  // its right end is nearer
    return Pose{rotate(turned({0, 0, 1}, k / 3.0), rod.position),
                turned({0, 0, 1}, k / 3.0) * rod.rotation * turned({0, 1, 0}, 0.25)};
  };
  for (int k = 0; k < 3; ++k) {
    StripPart& rod = seen.parts[static_cast<std::size_t>(k)];
    rod.outline = rectangle({0.2, 0.2}, {-0.1, -0.1}), rod.half = 3;
    rod.chunk = static_cast<std::uint32_t>(k);
    see_part(rod, rod_pose(k), camera, seen);
  }
  StripPart& wide = seen.parts[3];  // in front of all, in no ring, its middle farthest away
  wide.outline = rectangle({30, 2}, {-15, -1}), wide.half = 0.1, wide.chunk = 3;
  see_part(wide, {{15, -1, 2}, {}}, camera, seen);
  for (int k = 0; k < 3; ++k) {
    ASSERT_GT(seen.solids[3].distance, seen.solids[static_cast<std::size_t>(k)].distance);
  }
  std::vector<std::uint32_t> cut;
  painters_order(seen.solids, &cut);
  ASSERT_EQ(cut.size(), 1u);
  ASSERT_LT(cut[0], 3u);
  const auto halves = halves_of(seen.parts[cut[0]]);
  const Pose pose = seen.solids[cut[0]].pose;
  seen.solids.erase(seen.solids.begin() + cut[0]);
  for (const StripPart& half : halves) {
    see_part(half, pose * Pose{{0, 0, half.middle}, {}}, camera, seen);
  }
  cut.clear();
  const std::vector<std::uint32_t> order = painters_order(seen.solids, &cut);
  EXPECT_TRUE(cut.empty());
  EXPECT_EQ(order.size(), 5u);
  EXPECT_EQ(seen.solids[order.back()].body, 3u);
}

// --- pictures

TEST(StripBuilding, HasACaptionPerPictureAndALegend) {
  const Recording recording = sample_building({.posts_x = 2, .posts_z = 2, .reach = 5});
  const std::string svg = draw_strip(recording);
  EXPECT_EQ(count_of(svg, "<svg"), 7u);
  EXPECT_EQ(count_of(svg, "<g "), count_of(svg, "</g>"));
  EXPECT_EQ(count_of(svg, "class=\"legend\""), 1u);
  for (const char* words : {">force<", ">torque<", ">both<", ">failed joint<"}) {
    EXPECT_EQ(count_of(svg, words), 1u) << words;
  }
  EXPECT_EQ(count_of(svg, " broken</text>"), 6u);
  EXPECT_EQ(count_of(svg, ">0.00 s, 0 joints broken<"), 1u);
  const std::string all = std::to_string(broken_joints(recording, recording.times.back()));
  EXPECT_GE(count_of(svg, " s, " + all + " joints broken<"), 1u);
  EXPECT_EQ(count_of(svg, "nan") + count_of(svg, "inf"), 0u);
}

TEST(StripBuilding, AWallHasNeitherLegendNorJoints) {
  const std::string svg = draw_strip(sample_recording({sample_wall("facade", 6, 4)}));
  EXPECT_EQ(count_of(svg, "legend") + count_of(svg, "joint"), 0u);
}

TEST(StripBuilding, APartThatWasTakenAwayIsNotDrawn) {
  Recording recording = sample_building({.posts_x = 2, .posts_z = 2, .storeys = 1});
  const std::string before = draw_strip(recording, {.frames = 1});
  for (RecordedPart& part : recording.parts) part.removed = 0;
  const std::string after = draw_strip(recording, {.frames = 1});
  EXPECT_GT(count_of(before, "<path"), count_of(after, "<path") + 20);
}

TEST(StripBuilding, LightIsOnlyAtEndsThatBearSomething) {
  Recording recording = sample_building({.posts_x = 2, .posts_z = 2, .storeys = 1});
  const std::string with = draw_strip(recording, {.frames = 1});
  std::ranges::fill(recording.samples, JointSample());
  const std::string without = draw_strip(recording, {.frames = 1});
  // Feet and heads of four posts and both ends of four beams.
  EXPECT_EQ(count_of(with, "\" stroke-opacity=\"0."), 16u);
  EXPECT_EQ(count_of(without, "\" stroke-opacity=\"0."), 0u);
}

TEST(StripBuilding, TwiceGivesTheSameBytesAndManyPartsStaySmall) {
  const Recording recording = sample_building({.reach = 10});
  ASSERT_EQ(recording.parts.size(), 378u);
  const std::string svg = draw_strip(recording);
  EXPECT_EQ(svg, draw_strip(recording));
  EXPECT_LT(svg.size(), 1'500'000u);
  EXPECT_EQ(count_of(svg, "nan") + count_of(svg, "inf"), 0u);
}

TEST(StripBuilding, SamplesThatAreNotNumbersGiveNoLight) {
  Recording recording = sample_building({.posts_x = 2, .posts_z = 2, .storeys = 1});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::ranges::fill(recording.samples, sample_of(nan, nan));
  const std::string svg = draw_strip(recording, {.frames = 1});
  EXPECT_EQ(count_of(svg, "nan"), 0u);
}

}  // namespace
}  // namespace sunder
