// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "io/sample_asset.hpp"
#include "io/sample_recording.hpp"
#include "io/sight.hpp"
#include "io/strip_camera.hpp"
#include "io/strip_order.hpp"
#include "io/strip_scene.hpp"
#include "io/strip_steps.hpp"
#include "io/strip_svg.hpp"

namespace sunder {
namespace {

Recording sample(std::uint64_t seed = 1) {
  return sample_recording({sample_wall("facade", 12, 6, seed)}, {.hit = {3, 1.5}, .seed = seed});
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

TEST(StripSteps, BeginBeforeTheBreakAndGrowApart) {
  const Recording recording = sample();
  const std::vector<std::uint32_t> steps = strip_steps(recording, 6);
  ASSERT_EQ(steps.size(), 6u);
  std::uint32_t first = UINT32_MAX, last = 0;
  for (const std::uint32_t track : recording.walls[0].track) {
    if (track == kNoTrack) continue;
    first = std::min(first, moving_range(recording, track).first);
    last = std::max(last, moving_range(recording, track).end - 1);
  }
  EXPECT_LT(steps.front(), first);
  EXPECT_EQ(recording.times[steps.front() + 1], recording.events[0].time);
  EXPECT_LE(steps.back(), last);
  for (std::size_t i = 3; i < steps.size(); ++i) {
    EXPECT_GT(steps[i] - steps[i - 1], steps[i - 1] - steps[i - 2]);
  }
  const double hit = recording.events[0].time;
  const auto is_soon = [&](std::uint32_t step) { return recording.times[step] < hit + 0.5; };
  EXPECT_GE(std::ranges::count_if(steps, is_soon), 4);
}

// The sample with balls that hit it at these times, each followed by chunks that break again and by
// more of the wall.
Recording sample_with_hits(const std::vector<double>& hits) {
  Recording recording = sample();
  const Projectile ball = recording.projectiles[0].projectile;
  recording.projectiles.clear();
  recording.events.clear();
  for (std::size_t h = 0; h < hits.size(); ++h) {
    const double x = 0.6 + 0.7 * static_cast<double>(h);
    Projectile projectile = ball;
    projectile.name = "ball" + std::to_string(h);
    projectile.time = hits[h] - 0.01;
    projectile.position = {x, 1.5, 0.4};
    recording.projectiles.push_back({projectile, kNoTrack});
    recording.events.push_back({hits[h], 0, {x, 1.5, 0.1}, 10, 3, 20, 9});
    recording.events.push_back({hits[h] + 0.06, 0, {x, 0, -1}, 2, 1, 0, 3});
    recording.events.push_back({hits[h] + 0.07, 0, {x, 1.8, 0.1}, 2, 1, 2, 1});
  }
  std::ranges::stable_sort(recording.events, {}, &BreakEvent::time);
  return recording;
}

bool is_shown(const Recording& recording, const std::vector<std::uint32_t>& steps, double hit) {
  return std::ranges::any_of(steps, [&](std::uint32_t step) {
    const double later = recording.times[step] - hit;
    return later > 0.05 && later < 0.15;
  });
}

TEST(StripSteps, ShowEachHitShortlyAfterIt) {
  const std::vector<double> lists[] = {
      {0.2}, {0.2, 0.7, 1.2}, {0.2, 0.35, 1.4}, {0.2, 0.25}, {0.2, 0.29, 0.31, 1.7}};
  for (const std::vector<double>& hits : lists) {
    const Recording recording = sample_with_hits(hits);
    for (int frames = static_cast<int>(hits.size()) + 2; frames < 15; ++frames) {
      const std::vector<std::uint32_t> steps = strip_steps(recording, frames);
      EXPECT_LE(steps.size(), static_cast<std::size_t>(frames));
      EXPECT_LT(recording.times[steps[0]], hits[0]);
      for (const double hit : hits) {
        EXPECT_TRUE(is_shown(recording, steps, hit))
            << hits.size() << " hits, " << frames << " frames, hit at " << hit << " s";
      }
    }
  }
}

TEST(StripSteps, LeaveHitsOutWhereFramesAreFewButNeverTheStartAndTheEnd) {
  const Recording recording = sample_with_hits({0.2, 0.7, 1.2});
  const std::vector<std::uint32_t> one = strip_steps(recording, 1);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_TRUE(is_shown(recording, one, 0.2));
  const std::vector<std::uint32_t> six = strip_steps(recording, 6);
  for (const int frames : {2, 3, 4}) {
    const std::vector<std::uint32_t> steps = strip_steps(recording, frames);
    ASSERT_EQ(steps.size(), static_cast<std::size_t>(frames));
    EXPECT_EQ(steps.front(), six.front());
    EXPECT_EQ(steps.back(), six.back());
  }
  EXPECT_TRUE(is_shown(recording, strip_steps(recording, 3), 0.2));
}

TEST(StripSteps, AreEvenWhereNothingBreaksAndNeverTwiceTheSame) {
  Recording recording = sample();
  std::ranges::fill(recording.walls[0].track, kNoTrack);
  recording.events.clear();
  EXPECT_EQ(
      strip_steps(recording, 2),
      (std::vector<std::uint32_t>{0, static_cast<std::uint32_t>(recording.times.size()) - 1}));
  Recording still;
  still.times = {0};
  still.walls = recording.walls;
  EXPECT_EQ(strip_steps(still, 6), std::vector<std::uint32_t>{0});
  EXPECT_EQ(strip_steps(sample(), 1).size(), 1u);
}

// Boxes that do not touch, seen from the origin: rods and plates of many sizes, turned at random.
class RandomBoxes {
 public:
  RandomBoxes(std::uint64_t seed, std::size_t count, bool may_touch) {
    outlines_.reserve(count);  // solids point into it
    for (std::uint64_t id = 0; solids.size() < count; ++id) add(seed, id, may_touch);
  }
  std::vector<StripSolid> solids;

 private:
  struct Frame {
    Vec3 axis[3];
    double half[3];
  };
  void add(std::uint64_t seed, std::uint64_t id, bool may_touch) {
    const auto noise = [&](std::uint64_t k) { return random_unit(seed, id, k) - 0.5; };
    const double x = 0.1 + 1.2 * random_unit(seed, id, 1), y = 0.1 + 0.8 * random_unit(seed, id, 2);
    StripSolid solid;
    solid.half = 0.02 + 0.2 * random_unit(seed, id, 3);
    solid.pose.rotation = turned({noise(4), noise(5), noise(6)}, 0.4 * noise(7));
    solid.pose.position = {5 * noise(8), 5 * noise(9), -7 + 5 * noise(10)};
    Frame frame{{}, {x, y, solid.half}};
    frame.axis[0] = rotate(solid.pose.rotation, {1, 0, 0});
    frame.axis[1] = rotate(solid.pose.rotation, {0, 1, 0});
    frame.axis[2] = rotate(solid.pose.rotation, {0, 0, 1});
    for (std::size_t i = 0; i < solids.size() && !may_touch; ++i) {
      if (!are_apart(frame, frames_[i], solids[i].pose.position - solid.pose.position)) return;
    }
    frames_.push_back(frame);
    outlines_.push_back({{-x, -y}, {x, -y}, {x, y}, {-x, y}});
    solid.outline = outlines_.back();
    solid.eye = inverse(solid.pose) * Vec3{};
    solid.body = static_cast<std::uint32_t>(id);
    place_on_screen(solid);
    solids.push_back(solid);
  }
  // Separating axes of two boxes: faces of both, and pairs of edges.
  static bool are_apart(const Frame& a, const Frame& b, Vec3 between) {
    const auto separates = [&](Vec3 axis) {
      if (length(axis) < 1e-6) return false;
      double reach = 0;
      for (int i = 0; i < 3; ++i) {
        reach += a.half[i] * std::abs(dot(a.axis[i], axis));
        reach += b.half[i] * std::abs(dot(b.axis[i], axis));
      }
      return std::abs(dot(between, axis)) > reach;
    };
    for (int i = 0; i < 3; ++i) {
      if (separates(a.axis[i]) || separates(b.axis[i])) return true;
      for (int k = 0; k < 3; ++k) {
        if (separates(cross(a.axis[i], b.axis[k]))) return true;
      }
    }
    return false;
  }
  static void place_on_screen(StripSolid& solid) {
    const StripCamera camera{{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, 0.01, {}};
    std::vector<Vec2> picture;
    for (const double side : {-solid.half, solid.half}) {
      for (const Vec2 p : solid.outline) {
        solid.corners.push_back(solid.pose * Vec3{p.x, p.y, side});
        picture.push_back(camera.project(camera.see(solid.corners.back())));
      }
    }
    solid.silhouette = convex_hull(picture);
    solid.screen = bounding_box(solid.silhouette);
    solid.distance = length(solid.pose.position);
  }
  std::vector<std::vector<Vec2>> outlines_;
  std::vector<Frame> frames_;
};

std::vector<Vec3> random_rays(std::uint64_t seed) {
  std::vector<Vec3> rays;
  for (std::uint64_t k = 0; k < 1500; ++k) {
    rays.push_back({random_unit(seed, k, 17) - 0.5, random_unit(seed, k, 18) - 0.5, -1});
  }
  return rays;
}

// The oracle is ray casting: of all solids a line of sight meets, the nearest is painted last.
TEST(PaintersOrder, TheNearestSolidOfEveryLineOfSightIsPaintedLast) {
  Sights painted, by_distance;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const RandomBoxes boxes(seed, 120, false);
    const std::vector<std::uint32_t> order = painters_order(boxes.solids);
    ASSERT_EQ(order.size(), boxes.solids.size());
    const std::vector<Vec3> rays = random_rays(seed);
    const Sights a = look_along(rays, boxes.solids, order);
    painted.right += a.right, painted.wrong += a.wrong;
    std::vector<std::uint32_t> sorted = order;
    std::ranges::sort(sorted, std::greater<>(),
                      [&](std::uint32_t i) { return boxes.solids[i].distance; });
    const Sights b = look_along(rays, boxes.solids, sorted);
    by_distance.right += b.right, by_distance.wrong += b.wrong;
  }
  EXPECT_GT(painted.right, 5000u);
  EXPECT_EQ(painted.wrong, 0u);
  EXPECT_GT(by_distance.wrong, 50u);  // it is not too easy
}

TEST(PaintersOrder, PaintsEverySolidOnceEvenIfTheyOverlap) {
  std::vector<std::uint32_t> order = painters_order(RandomBoxes(1, 300, true).solids);
  ASSERT_EQ(order.size(), 300u);
  std::ranges::sort(order);
  for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

TEST(StripCamera, ShowsTheWallsWholeFromTheSideThatChunksFlyTo) {
  for (const double degrees : {0.0, 50.0, 180.0, 235.0}) {
    WallAsset wall = sample_wall("facade", 12, 6);
    wall.wall.rotation = rotation_from_degrees({0, degrees, 0});
    wall.wall.position = {20, 0, -7};
    const Recording recording = sample_recording({wall}, {.hit = {3, 1.5}});
    const StripCamera camera = place_camera(recording, strip_steps(recording, 6));
    const Pose pose{wall.wall.position, wall.wall.rotation};
    EXPECT_LT((inverse(pose) * camera.eye).z, 0) << degrees;  // the ball flies along -z
    for (const double x : {0.0, 6.0}) {
      for (const double y : {0.0, 3.0}) {
        const Vec2 p = camera.project(camera.see(pose * Vec3{x, y, 0}));
        EXPECT_GT(p.x, 0);
        EXPECT_LT(p.x, kStripWidth);
        EXPECT_GT(p.y, 0);
        EXPECT_LT(p.y, kStripHeight);
      }
    }
    EXPECT_NEAR(dot(camera.right, camera.back), 0, 1e-12);
    EXPECT_NEAR(dot(camera.light, camera.light), 1, 1e-12);
    // The wall's seen side is lit.
    EXPECT_GT(dot(rotate(pose.rotation, {0, 0, -1}), camera.light), 0.4);
  }
}

TEST(StripCamera, MovesWithTheScene) {
  const Recording plain = sample();
  WallAsset wall = plain.walls[0].asset;
  wall.wall.rotation = rotation_from_degrees({0, 90, 0});
  wall.wall.position = {4, 0, 9};
  const Recording moved = sample_recording({wall}, {.hit = {3, 1.5}});
  const Pose pose{wall.wall.position, wall.wall.rotation};
  const StripCamera a = place_camera(plain, strip_steps(plain, 6));
  const StripCamera b = place_camera(moved, strip_steps(moved, 6));
  EXPECT_NEAR(length(pose * a.eye - b.eye), 0, 1e-9);
  EXPECT_NEAR(length(rotate(pose.rotation, a.back) - b.back), 0, 1e-12);
}

// Height of the first wall's upright edges in the picture, as shares of the picture's.
std::vector<double> heights_of(const Recording& recording, std::optional<double> ground) {
  const Wall& wall = recording.walls[0].asset.wall;
  const StripCamera camera = place_camera(recording, strip_steps(recording, 6), ground);
  const Box box = bounding_box(wall.region.outline);
  const Pose pose{wall.position, wall.rotation};
  std::vector<double> heights;
  for (const double x : {box.low.x, box.high.x}) {
    const Vec2 top = camera.project(camera.see(pose * Vec3{x, box.high.y, 0}));
    const Vec2 foot = camera.project(camera.see(pose * Vec3{x, box.low.y, 0}));
    heights.push_back((foot.y - top.y) / kStripHeight);
  }
  return heights;
}

TEST(StripCamera, StandsAsNearHoweverFarChunksAndBallsFly) {
  const WallAsset wall = sample_wall("facade", 6, 6);
  const auto heights = [&](double speed) {
    return heights_of(sample_recording({wall}, {.hit = {1.5, 1.5}, .speed = speed}), 0.0);
  };
  for (const double height : heights(10)) EXPECT_GT(height, 0.55);
  EXPECT_EQ(heights(10), heights(80));
}

TEST(StripCamera, ShowsTheGroundBelowAWallThatIsNear) {
  WallAsset wall = sample_wall("pane", 4, 3);  // 1.5 m high
  const auto ground_in_picture = [&](double height) {
    wall.wall.position.y = height;
    const Recording recording = sample_recording({wall}, {.hit = {1, 0.75}, .radius = 0.6});
    const StripCamera camera = place_camera(recording, strip_steps(recording, 6), 0.0);
    return camera.project(camera.see({1, 0, 0})).y / kStripHeight;
  };
  EXPECT_LT(ground_in_picture(0), 1);
  EXPECT_LT(ground_in_picture(1), 1);
  EXPECT_GT(ground_in_picture(1), 0.8);
  EXPECT_GT(ground_in_picture(2), 1);
}

TEST(StripParts, TileEveryChunkWithItsEdges) {
  WallAsset wall = sample_wall("facade", 12, 6);
  Recording recording = sample_recording({wall});
  const std::vector<StripPart> parts = strip_parts(recording);
  ASSERT_GE(parts.size(), wall.chunks.size());
  std::map<std::uint32_t, double> areas;
  std::size_t borders = 0, shared = 0;
  for (const StripPart& part : parts) {
    EXPECT_GT(area(part.outline), 0);
    areas[part.chunk] += area(part.outline);
    borders += std::ranges::count(part.across, StripPart::kBorder);
    for (const std::uint32_t beyond : part.across) shared += beyond < wall.chunks.size();
  }
  for (const auto& [chunk, sum] : areas) EXPECT_NEAR(sum, cell_area(wall.pattern, chunk), 1e-12);
  EXPECT_EQ(borders, 2u * (12 + 6));
  EXPECT_EQ(shared, 2u * (11 * 6 + 12 * 5));
}

TEST(Strip, HasAPictureAndATimePerFrame) {
  const Recording recording = sample();
  for (const int frames : {1, 2, 6, 7}) {
    const std::string svg = draw_strip(recording, {.frames = frames});
    EXPECT_TRUE(svg.starts_with("<svg "));
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    EXPECT_EQ(count_of(svg, "<svg"), static_cast<std::size_t>(frames) + 1);
    EXPECT_EQ(count_of(svg, "<svg"), count_of(svg, "</svg>"));
    EXPECT_EQ(count_of(svg, "<g "), count_of(svg, "</g>"));
    EXPECT_EQ(count_of(svg, " s</text>"), static_cast<std::size_t>(frames));
    EXPECT_EQ(count_of(svg, "nan") + count_of(svg, "inf"), 0u);
  }
}

TEST(Strip, AStandingWallShowsNoBrokenFaces) {
  Recording recording = sample();
  std::ranges::fill(recording.walls[0].track, kNoTrack);
  recording.projectiles.clear();
  const std::string svg = draw_strip(recording, {.frames = 1});
  // Caps and the narrow sides of the border are of outer colour, and one run paints all caps that
  // show nothing else: far fewer paths than chunks.
  EXPECT_LT(count_of(svg, "<path"), 2u * (12 + 6) * 3);
  EXPECT_EQ(count_of(svg, "<circle"), 0u);
}

// Segments of the lines that paths of a kind draw.
std::size_t segments_of(const std::string& svg, const std::string& opening) {
  std::size_t found = 0;
  for (std::size_t at = svg.find(opening); at != std::string::npos;
       at = svg.find(opening, at + 1)) {
    const std::size_t begin = at + opening.size();
    found += count_of(svg.substr(begin, svg.find('"', begin) - begin), "l");
  }
  return found;
}

TEST(Strip, AStandingOpaqueWallShowsItsBorderAndNoSeams) {
  Recording recording = sample();
  std::ranges::fill(recording.walls[0].track, kNoTrack);
  const std::string svg = draw_strip(recording, {.frames = 1});
  EXPECT_EQ(segments_of(svg, "<path fill=\"none\" d=\""), 2u * (12 + 6));
  EXPECT_EQ(count_of(svg, "class=\"crack\""), 0u);
}

std::vector<std::string> pictures_of(const std::string& svg) {
  std::vector<std::string> pictures;
  for (std::size_t at = svg.find("<svg x="); at != std::string::npos;) {
    const std::size_t next = svg.find("<svg x=", at + 1);
    pictures.push_back(svg.substr(at, next - at));
    at = next;
  }
  return pictures;
}

TEST(Strip, GlassShowsAllItsCracksOnceSomethingOfItBroke) {
  for (const std::string material : {"float-glass", "toughened-glass", "glass", "pmma"}) {
    Recording recording = sample();
    recording.walls[0].asset.wall.material = material;
    std::ranges::fill(recording.walls[0].track, kNoTrack);
    const std::vector<std::string> pictures = pictures_of(draw_strip(recording, {.frames = 3}));
    ASSERT_EQ(pictures.size(), 3u) << material;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      // Each of the seams belongs to two chunks.
      EXPECT_EQ(segments_of(pictures[i], "<path class=\"crack\" d=\""),
                i == 0 ? 0u : 2u * (11 * 6 + 12 * 5))
          << material << ", picture " << i;
      EXPECT_EQ(segments_of(pictures[i], "<path class=\"edge\" d=\""), 2u * (12 + 6));
    }
  }
}

TEST(Strip, APaneShowsNoCracksOfAnother) {
  WallAsset other = sample_wall("other", 2, 2);
  other.wall.position = {8, 0, 0};
  Recording recording = sample_recording({sample_wall("facade", 12, 6), other}, {});
  recording.walls[1].asset.wall.material = "float-glass";
  EXPECT_EQ(count_of(draw_strip(recording), "<path class=\"crack\""), 0u);
  recording.events[0].wall = 1;
  EXPECT_GT(count_of(draw_strip(recording), "<path class=\"crack\""), 0u);
}

TEST(Strip, TwiceGivesTheSameBytes) {
  Recording recording = sample();
  recording.walls[0].asset.wall.material = "float-glass";
  EXPECT_EQ(draw_strip(recording), draw_strip(recording));
}

TEST(Strip, WithoutGroundThereIsNoGroundAndNoShadow) {
  const std::string svg = draw_strip(sample(), {.frames = 2, .has_ground = false});
  EXPECT_EQ(count_of(svg, "url(#soft)"), 0u);
  EXPECT_EQ(count_of(svg, "fill=\"url(#land)"), 0u);
  EXPECT_GT(count_of(draw_strip(sample(), {.frames = 2}), "url(#soft)"), 0u);
}

TEST(Strip, StaysSmallForManyChunks) {
  const WallAsset wall = sample_wall("facade", 25, 20);  // 500 chunks, all of them flying
  const Recording recording = sample_recording({wall}, {.steps = 120, .hit = {6, 5}, .radius = 30});
  EXPECT_LT(draw_strip(recording).size(), 3'000'000u);
}

}  // namespace
}  // namespace sunder
