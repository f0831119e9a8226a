// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "meshing/trig.hpp"
#include "sim/frame.hpp"
#include "sim/stocked_frame.hpp"

namespace sunder {
namespace {

using Kind = FrameMember::Kind;

PartSolid solid_named(const Frame& frame, const std::string& name) {
  return solid_of(frame, find_part(frame, name));
}

double total_mass(const Frame& frame) {
  double mass = 0;
  for (const PartSolid& solid : solids_of(frame)) mass += solid.mass;
  return mass;
}

void expect_vec(Vec3 a, Vec3 b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// --- Mass ---

TEST(PartSolid, MassOfTheBuildingIsThatOfItsDrawing) {
  const Frame frame = joined(regular(3, 3, 12));
  const double steel = (108 * 3.5 * 149.1e-4 + 144 * 6 * 53.81e-4) * 7850;
  EXPECT_NEAR(total_mass(frame), steel + 48 * 12960, 1e-5);
  EXPECT_NEAR(total_mass(frame), 703e3, 0.5e3);  // as published
}

TEST(PartSolid, MassDoesNotChangeWithThePosition) {
  RegularBuilding building = regular(3, 4, 2, 0.1);
  const double here = total_mass(joined(building));
  building.position = {-1234.5, 67.8, 910.25};
  EXPECT_NEAR(total_mass(joined(building)), here, 1e-9 * here);
}

TEST(PartSolid, LiveLoadIsMassByStandardGravity) {
  RegularBuilding building = regular(2, 2, 1);
  building.storeys[0].live_load = 2000;
  EXPECT_NEAR(solid_named(joined(building), "slab_0_0_0").mass, 12960 + 36 * 2000 / 9.81, 1e-9);
}

// --- Members ---

TEST(PartSolid, PostsGoFromNodeToNode) {
  const PartSolid post = solid_named(joined(regular(2, 2, 2)), "post_1_0_1");
  expect_vec(post.centre, {6, 5.25, 0});
  EXPECT_NEAR(post.half_length, 1.75, 1e-12);
  expect_vec(post.axes.x, {-1, 0, 0});
  expect_vec(post.axes.y, {0, 0, 1});
  expect_vec(post.axes.z, {0, 1, 0});
  EXPECT_EQ(post.hull, rectangle({0.3, 0.3}, {-0.15, -0.15}));
  EXPECT_EQ(post.material, "steel");
  EXPECT_EQ(post.outline.outline.size(), 12u);
  const double m = 149.1e-4 * 3.5 * 7850, along = 3.5 * 3.5 / 12;
  EXPECT_NEAR(post.mass, m, 1e-9);
  EXPECT_NEAR(post.inertia.xx, m * (25170e-8 / 149.1e-4 + along), 1e-9);
  EXPECT_NEAR(post.inertia.yy, m * (8563e-8 / 149.1e-4 + along), 1e-9);
  EXPECT_NEAR(post.inertia.zz, m * (25170e-8 + 8563e-8) / 149.1e-4, 1e-9);
}

TEST(PartSolid, BeamsEndShortOfThePosts) {
  RegularBuilding building = regular(3, 2, 2);
  building.storeys[1].post_section = "IPE300";  // 0.15 wide along x
  const Frame frame = joined(building);
  const PartSolid lower = solid_named(frame, "beam_x_0_0_0");
  EXPECT_NEAR(2 * lower.half_length, 6 - 2 * (0.15 + 0.005), 1e-12);
  expect_vec(lower.centre, {3, 3.5, 0});
  expect_vec(lower.axes.z, {1, 0, 0});
  EXPECT_NEAR(lower.mass, 53.81e-4 * 6 * 7850, 1e-9);
  EXPECT_NEAR(2 * solid_named(frame, "beam_x_0_0_1").half_length, 6 - 2 * (0.075 + 0.005), 1e-12);
  EXPECT_NEAR(2 * solid_named(frame, "beam_z_0_0_1").half_length, 6 - 2 * (0.15 + 0.005), 1e-12);
}

TEST(PartSolid, BeamsStayClearOfTheEdgeOfAPostThatIsTurned) {
  Frame frame = joined(regular(2, 2, 1));
  frame.members[find_part(frame, "post_0_0_0")].roll = std::acos(-1.0) / 4;
  EXPECT_NEAR(2 * solid_named(frame, "beam_x_0_0_0").half_length,
              6 - 0.15 * std::sqrt(2) - 0.15 - 2 * 0.005, 1e-12);
}

TEST(PartSolid, BeamsWithoutPostsKeepAGapOnly) {
  Frame frame = stocked_frame();
  const std::uint32_t left = add_node(frame, {0, 5, 0}, true), right = add_node(frame, {6, 5, 0});
  add_beam(frame, "long", left, right);
  add_beam(frame, "short", right, add_node(frame, {6.008, 5, 0}, true));
  EXPECT_NEAR(solid_of(frame, 0).half_length, 2.995, 1e-12);
  EXPECT_NEAR(solid_of(frame, 1).half_length, 0.002, 1e-12);  // nothing would remain: its half
}

TEST(PartSolid, RoundTubesCollideAsTwelveSides) {
  Frame frame = stocked_frame();
  frame.sections.push_back(with_properties(
      {.name = "CHS", .shape = "chs", .height = 0.2, .width = 0.2, .web = 0.01, .source = ""}));
  const std::uint32_t foot = add_node(frame, {}, true), head = add_node(frame, {0, 3, 0});
  add_member(frame, "post", Kind::post, foot, head, 2);
  add_beam(frame, "beam", head, add_node(frame, {4, 3, 3}));
  const PartSolid post = solid_of(frame, 0);
  ASSERT_EQ(post.hull.size(), 12u);
  EXPECT_NEAR(area(post.hull), 12 * 0.5 * 0.01 * 0.5, 1e-12);  // 12 triangles of 30°
  EXPECT_EQ(post.outline.openings.size(), 1u);
  frame.sections[2].width = 0;  // the diameter is the height
  EXPECT_EQ(solid_of(frame, 0).hull, post.hull);
  EXPECT_NEAR(2 * solid_of(frame, 1).half_length, 5 - 0.1 - 2 * 0.005, 1e-12);
}

// --- Slabs ---

TEST(PartSolid, SlabsAreOctagonsOnTopOfTheirBeams) {
  const PartSolid slab = solid_named(joined(regular(2, 2, 1)), "slab_0_0_0");
  expect_vec(slab.centre, {3, 3.5 + 0.15 + 0.075, 3});
  expect_vec(slab.axes.z, {0, 1, 0});
  EXPECT_NEAR(slab.half_length, 0.075, 1e-12);
  EXPECT_EQ(slab.material, "concrete-c30");
  EXPECT_NEAR(slab.mass, 12960, 1e-9);
  // A square of 5.99 m, each corner cut at 45°, half a post's diagonal and the gap from the node.
  const double from_corner = 0.15 * std::sqrt(2) + 0.005 - 0.005 * std::sqrt(2);
  ASSERT_EQ(slab.hull.size(), 8u);
  EXPECT_NEAR(area(slab.hull), 5.99 * 5.99 - 4 * from_corner * from_corner, 1e-9);
}

/// On four beams between supports, without posts.
Frame slab_on(const std::array<Vec3, 4>& corners) {
  Frame frame = stocked_frame();
  for (const Vec3 corner : corners) add_node(frame, corner, true);
  const char* names[] = {"left", "front", "right", "back"};
  for (std::uint32_t i = 0; i < 4; ++i) add_beam(frame, names[i], i, (i + 1) % 4);
  frame.slabs = {{.name = "slab", .nodes = {0, 1, 2, 3}, .beams = {0, 1, 2, 3}, .thickness = 0.2}};
  join(frame);
  return frame;
}

TEST(PartSolid, SlabsLieOnTheHighestOfTheirCorners) {
  const Frame frame = slab_on({Vec3{0, 2, 0}, {0, 2, 6}, {6, 2.0008, 6}, {6, 2, 0}});
  ASSERT_EQ(text_of(defects_of(frame)), "");
  EXPECT_NEAR(solid_of(frame, 4).centre.y, 2.0008 + 0.15 + 0.1, 1e-6);
}

TEST(PartSolid, SlabsOfAnyQuadrilateralHaveTheInertiaOfTheirHull) {
  const PartSolid slab = solid_of(slab_on({Vec3{0, 2, 0}, {1, 2, 6}, {9, 2, 8}, {5, 2, -1}}), 4);
  // Midpoints of edges integrate quadratics over a triangle exactly.
  double size = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  const auto add = [&](double weight, Vec2 p) {
    size += weight;
    x += weight * p.x;
    y += weight * p.y;
    xx += weight * p.x * p.x;
    yy += weight * p.y * p.y;
    xy += weight * p.x * p.y;
  };
  for (std::size_t i = 1; i + 1 < slab.hull.size(); ++i) {
    const Vec2 a = slab.hull[0], b = slab.hull[i], c = slab.hull[i + 1];
    const double third = cross(b - a, c - a) / 6;
    add(third, 0.5 * (a + b));
    add(third, 0.5 * (b + c));
    add(third, 0.5 * (c + a));
  }
  EXPECT_NEAR(x / size, 0, 1e-12);
  EXPECT_NEAR(y / size, 0, 1e-12);
  EXPECT_GT(std::fabs(xy / size), 0.1);
  EXPECT_NEAR(slab.inertia.xx, slab.mass * (yy / size + 0.04 / 12), 1e-7);
  EXPECT_NEAR(slab.inertia.yy, slab.mass * (xx / size + 0.04 / 12), 1e-7);
  EXPECT_NEAR(slab.inertia.zz, slab.mass * (xx + yy) / size, 1e-7);
  EXPECT_NEAR(slab.inertia.xy, -slab.mass * xy / size, 1e-7);
}

TEST(PartSolid, SlabsWithoutPostsAreWholeAndHaveTheInertiaOfACuboid) {
  const Frame frame = slab_on({Vec3{0, 2, 0}, {0, 2, 7}, {4, 2, 7}, {4, 2, 0}});
  ASSERT_EQ(text_of(defects_of(frame)), "");
  const PartSolid slab = solid_of(frame, 4);
  ASSERT_EQ(slab.hull.size(), 4u);
  EXPECT_NEAR(area(slab.hull), 3.99 * 6.99, 1e-12);
  EXPECT_NEAR(slab.mass, 0.2 * 28 * 2400, 1e-9);
  expect_vec(slab.centre, {2, 2.25, 3.5});
  expect_vec(slab.axes.x, {0, 0, 1});  // along its first beam
  EXPECT_NEAR(slab.inertia.xx, slab.mass / 12 * (3.99 * 3.99 + 0.04), 1e-8);
  EXPECT_NEAR(slab.inertia.yy, slab.mass / 12 * (6.99 * 6.99 + 0.04), 1e-8);
  EXPECT_NEAR(slab.inertia.zz, slab.mass / 12 * (3.99 * 3.99 + 6.99 * 6.99), 1e-8);
  EXPECT_NEAR(slab.inertia.xy, 0, 1e-8);
}

TEST(PartSolid, SlabsOfEitherWindingAreTheSame) {
  Frame frame = joined(regular(2, 2, 1));
  const PartSolid one = solid_named(frame, "slab_0_0_0");
  FrameSlab& slab = frame.slabs[0];
  slab.nodes = {slab.nodes[0], slab.nodes[3], slab.nodes[2], slab.nodes[1]};
  slab.beams = {slab.beams[3], slab.beams[2], slab.beams[1], slab.beams[0]};
  const PartSolid other = solid_named(frame, "slab_0_0_0");
  EXPECT_GT(area(other.hull), 0);
  EXPECT_NEAR(area(other.hull), area(one.hull), 1e-9);
  EXPECT_NEAR(other.mass, one.mass, 1e-9);
  expect_vec(other.centre, one.centre, 1e-9);
}

// --- Walls ---

TEST(PartSolid, WallsFillTheBayBetweenSteelAndFloors) {
  const Frame frame = joined(regular(2, 2, 2, 0.1));
  const PartSolid ground = solid_named(frame, "wall_x_0_0_0");
  const double width = 6 - 2 * (0.15 + 0.005);
  Box box = bounding_box(ground.hull);
  EXPECT_NEAR(box.high.x - box.low.x, width, 1e-12);
  EXPECT_NEAR(box.high.y - box.low.y, 3.5 - 0.15 - 2 * 0.005, 1e-12);
  expect_vec(ground.centre, {3, (3.5 - 0.15) / 2, 0});
  expect_vec(ground.axes.z, {0, 0, -1});  // outwards
  EXPECT_NEAR(ground.mass, 1800 * 0.1 * width * 3.34, 1e-9);
  EXPECT_NEAR(ground.inertia.zz, ground.mass / 12 * (width * width + 3.34 * 3.34), 1e-8);
  EXPECT_EQ(ground.material, "brick");
  const PartSolid upper = solid_named(frame, "wall_z_0_0_1");
  box = bounding_box(upper.hull);
  EXPECT_NEAR(box.high.y - box.low.y, 3.5 - 0.3 - 0.15 - 2 * 0.005, 1e-12);
  EXPECT_NEAR(upper.centre.y - box.high.y, 3.5 + 0.15 + 0.15 + 0.005, 1e-12);
}

TEST(PartSolid, WallsStandOnBeamsWhereThereIsNoFloor) {
  RegularBuilding building = regular(2, 2, 2, 0.1);
  building.storeys[0].slab_thickness = 0;
  const PartSolid wall = solid_named(joined(building), "wall_x_0_0_1");
  EXPECT_NEAR(wall.centre.y - bounding_box(wall.hull).high.y, 3.5 + 0.15 + 0.005, 1e-12);
}

// --- All together ---

std::vector<Vec3> corners_of(const PartSolid& s) {
  std::vector<Vec3> corners;
  for (const Vec2 p : s.hull) {
    for (const double z : {-s.half_length, s.half_length}) {
      corners.push_back(s.centre + s.axes * Vec3{p.x, p.y, z});
    }
  }
  return corners;
}

std::vector<Vec3> edges_of(const PartSolid& s) {
  std::vector<Vec3> edges{s.axes.z};
  for (std::size_t i = 0; i < s.hull.size(); ++i) {
    const Vec2 edge = s.hull[(i + 1) % s.hull.size()] - s.hull[i];
    edges.push_back(edge.x * s.axes.x + edge.y * s.axes.y);
  }
  return edges;
}

/// Widest gap along any axis that can separate two convex prisms; negative: they overlap.
double gap_between(const PartSolid& a, const PartSolid& b) {
  const std::vector<Vec3> of_a = corners_of(a), of_b = corners_of(b);
  double widest = -1e300;
  const auto project = [&](Vec3 axis) {
    const double size = length(axis);
    if (size < 1e-9) return;
    double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
    for (const auto* corners : {&of_a, &of_b}) {
      const int i = corners == &of_b;
      for (const Vec3 p : *corners) {
        low[i] = std::min(low[i], dot(axis, p) / size);
        high[i] = std::max(high[i], dot(axis, p) / size);
      }
    }
    widest = std::max({widest, low[1] - high[0], low[0] - high[1]});
  };
  const std::vector<Vec3> edges_a = edges_of(a), edges_b = edges_of(b);
  for (const auto* edges : {&edges_a, &edges_b}) {
    for (const Vec3 e : *edges) project(e), project(cross((*edges)[0], e));
  }
  for (const Vec3 e : edges_a) {
    for (const Vec3 f : edges_b) project(cross(e, f));
  }
  return widest;
}

void expect_no_overlap(const Frame& frame) {
  const std::vector<PartSolid> solids = solids_of(frame);
  for (std::uint32_t a = 0; a < solids.size(); ++a) {
    for (std::uint32_t b = a + 1; b < solids.size(); ++b) {
      EXPECT_GT(gap_between(solids[a], solids[b]), -1e-9)
          << frame.part_name(a) << " and " << frame.part_name(b);
    }
  }
}

TEST(PartSolid, SolidsOfARegularBuildingDoNotOverlap) {
  expect_no_overlap(joined(regular(3, 3, 2, 0.2)));
}

TEST(PartSolid, SolidsOfASetBackWithUnequalSectionsDoNotOverlap) {
  RegularBuilding building = regular(3, 3, 3, 0.2);
  building.bays_x = {4, 5};
  building.storeys[1].beam_section = "HEB300";
  building.storeys[2].post_section = "IPE300";
  building.storeys[2].bays_x = {0, 1};
  building.storeys[2].bays_z = {1, 2};
  expect_no_overlap(joined(building));
}

TEST(PartSolid, OneAndAllGiveTheSame) {
  const Frame frame = joined(regular(3, 2, 2, 0.1));
  const std::vector<PartSolid> all = solids_of(frame);
  ASSERT_EQ(all.size(), frame.part_count());
  for (std::uint32_t p = 0; p < all.size(); ++p) {
    const PartSolid one = solid_of(frame, p);
    EXPECT_EQ(one.hull, all[p].hull);
    EXPECT_EQ(one.centre, all[p].centre);
    EXPECT_EQ(one.inertia, all[p].inertia);
  }
}

}  // namespace
}  // namespace sunder
