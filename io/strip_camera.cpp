// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "io/strip_scene.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr double kAzimuth = 40.0 / 360, kElevation = 11.0 / 360;  // turns
constexpr double kBuildingElevation = 13.0 / 360;
constexpr double kHalfWidth = 0.36;  // slope of the picture's side
constexpr double kMargin = 1.06;
constexpr double kDebris = 0.6;      // depth of the debris shown, of the wall's smaller side
constexpr double kApron = 0.25;      // width of the ground shown around a building, of its height
constexpr double kNarrowest = 5500;  // picture of a tower, picture units
constexpr double kNear = 0.4;  // distance of a projectile's start that is shown, of its diagonal

Vec3 unit(Vec3 v) {
  const double size = length(v);
  return size > 0 ? (1 / size) * v : Vec3{0, 0, 1};
}

// Corners of a wall's bounding box, world.
std::vector<Vec3> corners_of(const WallAsset& wall) {
  const Box box = bounding_box(wall.wall.region.outline);
  const Pose pose{wall.wall.position, wall.wall.rotation};
  std::vector<Vec3> corners;
  for (const double x : {box.low.x, box.high.x}) {
    for (const double y : {box.low.y, box.high.y}) {
      for (const double z : {-0.5, 0.5})
        corners.push_back(pose * Vec3{x, y, z * wall.wall.thickness});
    }
  }
  return corners;
}

// What the picture is to show whole, and what it had better not hide.
struct Interest {
  std::vector<Vec3> frame, chunks, projectiles;
};

// Along the wall's normal: +1 or -1, where chunks went at last; 0 if none left it. None counts for
// more than the wall's thickness.
double debris_side(const Recording& recording, const RecordedWall& wall, std::uint32_t step) {
  const Pose back = inverse({wall.asset.wall.position, wall.asset.wall.rotation});
  const double thickness = wall.asset.wall.thickness;
  double sum = 0;
  for (std::uint32_t c = 0; c < wall.track.size(); ++c) {
    const ChunkPlace place = place_of(recording, wall, c, step);
    if (place.track == kNoTrack) continue;
    const Vec3 centroid = wall.asset.chunks[c].centroid;
    sum += std::clamp((back * (place.pose * centroid)).z - centroid.z, -thickness, thickness);
  }
  return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

// Adds a wall, the ground below it, and as far out as is shown the height of the wall's foot.
void frame_wall(const WallAsset& asset, double side, std::optional<double> ground,
                std::vector<Vec3>& points) {
  const Box box = bounding_box(asset.wall.region.outline);
  const double small = std::min(box.high.x - box.low.x, box.high.y - box.low.y);
  const std::vector<Vec3> corners = corners_of(asset);
  const auto [lowest, highest] = std::ranges::minmax(corners, {}, &Vec3::y);
  double floor = lowest.y;
  if (ground && floor - *ground <= std::max(highest.y - lowest.y, small)) {
    floor = std::min(floor, *ground);
  }
  const Vec3 out = rotate(asset.wall.rotation, {0, 0, side * kDebris * small});
  for (const Vec3 p : corners) {
    points.push_back(p);
    points.push_back({p.x, floor, p.z});
    points.push_back({p.x + out.x, lowest.y, p.z + out.z});
  }
}

Interest find_interest(const Recording& recording, std::span<const std::uint32_t> steps,
                       std::optional<double> ground) {
  Interest result;
  for (const RecordedWall& wall : recording.walls) {
    frame_wall(wall.asset, debris_side(recording, wall, steps.back()), ground, result.frame);
    for (std::uint32_t c = 0; c < wall.track.size(); ++c) {
      for (const std::uint32_t step : steps) {
        const ChunkPlace place = place_of(recording, wall, c, step);
        if (place.track != kNoTrack) {
          result.chunks.push_back(place.pose * wall.asset.chunks[c].centroid);
        }
      }
    }
  }
  for (const RecordedProjectile& recorded : recording.projectiles) {
    const Pose start{recorded.projectile.position, {}};
    for (const std::uint32_t step : steps) {
      result.projectiles.push_back(pose_at(recording, recorded.track, step, start).position);
    }
  }
  return result;
}

// The wall that most chunks left.
const RecordedWall* most_broken(const Recording& recording) {
  const RecordedWall* result = nullptr;
  std::ptrdiff_t most = -1;
  for (const RecordedWall& wall : recording.walls) {
    const std::ptrdiff_t moved =
        std::ranges::count_if(wall.track, [](std::uint32_t track) { return track != kNoTrack; });
    if (moved > most) most = moved, result = &wall;
  }
  return result;
}

void point_along(StripCamera& camera, Vec3 back) {
  camera.back = unit(back);
  camera.right = unit(cross(Vec3{0, 1, 0}, camera.back));
  camera.up = cross(camera.back, camera.right);
}

// Looks along -back from so far that all points fill the picture. A camera sees p if
// |right·(p - eye)| <= k back·(eye - p), and the same for up: four planes, each pushed out to the
// farthest point.
StripCamera fitted(Vec3 back, std::span<const Vec3> points) {
  constexpr double kSlopeX = kHalfWidth / kMargin, kSlopeY = kSlopeX * kStripHeight / kStripWidth;
  StripCamera camera;
  point_along(camera, back);
  camera.focal = 0.5 * kStripWidth / kHalfWidth;
  const auto reach = [&](Vec3 side, double slope) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3 p : points) most = std::max(most, dot(p, side + slope * camera.back));
    return most;
  };
  const double right = reach(camera.right, kSlopeX), left = reach(-1.0 * camera.right, kSlopeX);
  const double top = reach(camera.up, kSlopeY), bottom = reach(-1.0 * camera.up, kSlopeY);
  const double depth = std::max((right + left) / (2 * kSlopeX), (top + bottom) / (2 * kSlopeY));
  camera.eye =
      0.5 * (right - left) * camera.right + 0.5 * (top - bottom) * camera.up + depth * camera.back;
  double middle = 0;
  for (const Vec3 p : points) middle += dot(p, camera.back) / static_cast<double>(points.size());
  camera.nearest = 0.05 * (depth - middle);
  return camera;
}

bool is_hidden_by(const WallAsset& wall, Vec3 eye, Vec3 point) {
  if (is_glass(wall.wall.material)) return false;
  const Pose back = inverse({wall.wall.position, wall.wall.rotation});
  const Vec3 a = back * eye, b = back * point;
  if ((a.z > 0) == (b.z > 0)) return false;
  const double t = a.z / (a.z - b.z);
  const Box box = bounding_box(wall.wall.region.outline);
  const double x = a.x + t * (b.x - a.x), y = a.y + t * (b.y - a.y);
  return x > box.low.x && x < box.high.x && y > box.low.y && y < box.high.y;
}

// Share of the moving chunks (and, with less weight, of the projectiles' places) that are seen.
double visibility(const Recording& recording, const StripCamera& camera, const Interest& interest) {
  const auto share = [&](std::span<const Vec3> points) {
    std::size_t seen = 0;
    for (const Vec3 p : points) {
      seen += std::ranges::none_of(recording.walls, [&](const RecordedWall& wall) {
        return is_hidden_by(wall.asset, camera.eye, p);
      });
    }
    return points.empty() ? 0.0 : static_cast<double>(seen) / static_cast<double>(points.size());
  };
  return share(interest.chunks) + 0.3 * share(interest.projectiles);
}

// Corners of a part's bounding box where it stands, world.
std::vector<Vec3> corners_of(const RecordedPart& part) {
  std::vector<Vec3> corners;
  const Box box = bounding_box(part.outline.outline);
  for (const double x : {box.low.x, box.high.x}) {
    for (const double y : {box.low.y, box.high.y}) {
      for (const double z : {-part.half_length, part.half_length}) {
        corners.push_back(part.standing * Vec3{x, y, z});
      }
    }
  }
  return corners;
}

// Along world axes, as the building stood.
struct Bounds {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  Vec3 middle() const { return 0.5 * (low + high); }
  Vec3 size() const { return high - low; }
};

Bounds bounds_of(std::span<const Vec3> points) {
  Bounds result;
  for (const Vec3 p : points) {
    result.low = {std::min(result.low.x, p.x), std::min(result.low.y, p.y),
                  std::min(result.low.z, p.z)};
    result.high = {std::max(result.high.x, p.x), std::max(result.high.y, p.y),
                   std::max(result.high.z, p.z)};
  }
  return result;
}

// Where it begins to break: what flies at it comes from there; else its first broken joint.
Vec3 origin_of_collapse(const Recording& recording, Vec3 middle) {
  if (!recording.projectiles.empty()) return recording.projectiles[0].projectile.position;
  const auto first = std::ranges::min_element(recording.joints, {}, &RecordedJoint::broken);
  return first == recording.joints.end() || std::isinf(first->broken) ? middle : first->point;
}

// What the picture of a building shows: its parts as they stood, ground around them for what falls,
// and projectiles that start near.
std::vector<Vec3> building_frame(const Recording& recording, std::optional<double> ground) {
  std::vector<Vec3> points;
  for (const RecordedPart& part : recording.parts) {
    const std::vector<Vec3> corners = corners_of(part);
    points.insert(points.end(), corners.begin(), corners.end());
  }
  const Bounds bounds = bounds_of(points);
  const Vec3 size = bounds.size();
  const double apron = kApron * std::max(size.y, 0.5 * std::min(size.x, size.z));
  for (const double x : {bounds.low.x - apron, bounds.high.x + apron}) {
    for (const double z : {bounds.low.z - apron, bounds.high.z + apron}) {
      points.push_back({x, ground.value_or(bounds.low.y), z});
    }
  }
  for (const auto& [projectile, track] : recording.projectiles) {
    const Vec3 p = projectile.position;
    const Vec3 nearest{std::clamp(p.x, bounds.low.x, bounds.high.x),
                       std::clamp(p.y, bounds.low.y, bounds.high.y),
                       std::clamp(p.z, bounds.low.z, bounds.high.z)};
    if (length(p - nearest) < kNear * length(size)) points.push_back(p);
  }
  return points;
}

// From the corner next to where the collapse begins, the longer side of the plan seen more.
StripCamera place_building_camera(const Recording& recording, std::optional<double> ground) {
  const std::vector<Vec3> points = building_frame(recording, ground);
  const Bounds bounds = bounds_of(points);
  const Vec3 size = bounds.size();
  const Vec3 from = origin_of_collapse(recording, bounds.middle()) - bounds.middle();
  const Vec2 turn = unit_at_turns(kAzimuth), rise = unit_at_turns(kBuildingElevation);
  const bool is_deep = size.z > size.x;
  const Vec3 flat{(from.x < 0 ? -1 : 1) * (is_deep ? turn.x : turn.y), 0,
                  (from.z < 0 ? -1 : 1) * (is_deep ? turn.y : turn.x)};
  StripCamera camera = fitted(rise.x * flat + Vec3{0, rise.y, 0}, points);
  double reach = 0;
  for (const Vec3 p : points) {
    reach = std::max(reach, std::abs(camera.project(camera.see(p)).x - 0.5 * kStripWidth));
  }
  camera.width = std::clamp(2 * kMargin * reach, kNarrowest, kStripWidth);
  const Vec3 face = is_deep ? Vec3{flat.x, 0, 0} : Vec3{0, 0, flat.z};
  const double side = dot(face, camera.right) < 0 ? -1 : 1;
  const Vec3 level = unit({camera.back.x, 0, camera.back.z});
  camera.light = unit(0.75 * side * camera.right + 0.6 * level + Vec3{0, 1, 0});
  return camera;
}

}  // namespace

ChunkPlace place_of(const Recording& recording, const RecordedWall& wall, std::uint32_t chunk,
                    std::uint32_t step) {
  const std::vector<Track>& tracks = recording.tracks;
  std::uint32_t track = wall.track[chunk];
  while (track != kNoTrack && (step < tracks[track].first || tracks[track].poses.empty())) {
    track = tracks[track].parent;
  }
  const Pose standing{wall.asset.wall.position, wall.asset.wall.rotation};
  return {pose_at(recording, track, step, standing), track};
}

StripCamera place_camera(const Recording& recording, std::span<const std::uint32_t> steps,
                         std::optional<double> ground) {
  if (!recording.parts.empty()) return place_building_camera(recording, ground);
  const Interest interest = find_interest(recording, steps, ground);
  Vec3 normal{0, 0, 1};
  if (const RecordedWall* wall = most_broken(recording)) {
    const double side = debris_side(recording, *wall, steps.back());
    normal = rotate(wall->asset.wall.rotation, {0, 0, side < 0 ? -1.0 : 1.0});
  }
  normal.y = 0;
  normal = length(normal) > 0.2 ? unit(normal) : Vec3{0, 0, 1};  // a slab: any side will do
  const Vec3 along = cross(Vec3{0, 1, 0}, normal);
  const Vec2 turn = unit_at_turns(kAzimuth), rise = unit_at_turns(kElevation);
  StripCamera best;
  double most = -1;
  for (const double side : {1.0, -1.0}) {
    for (const double hand : {-1.0, 1.0}) {  // chunks that leave the wall go right, or left
      const Vec3 flat = side * turn.x * normal + hand * turn.y * along;
      const StripCamera camera = fitted(rise.x * flat + Vec3{0, rise.y, 0}, interest.frame);
      const double seen = visibility(recording, camera, interest);
      if (seen <= most + 0.02) continue;
      most = seen;
      best = camera;
      const Vec3 level = unit({camera.back.x, 0, camera.back.z});
      best.light = unit(-0.75 * side * hand * camera.right + 0.6 * level + Vec3{0, 1, 0});
    }
  }
  return best;
}

}  // namespace sunder
