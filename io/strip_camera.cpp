// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr double kAzimuth = 40.0 / 360, kElevation = 11.0 / 360;  // turns
constexpr double kHalfWidth = 0.36;                               // slope of the picture's side
constexpr double kMargin = 1.1;
constexpr double kMostFar = 1.75;   // times the distance that the walls alone would need
constexpr double kOutliers = 0.03;  // share of chunks that may leave the picture

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

// What the picture is to show.
struct Interest {
  std::vector<Vec3> walls, chunks, projectiles;
};

Interest find_interest(const Recording& recording, std::span<const std::uint32_t> steps) {
  Interest result;
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const RecordedWall& wall : recording.walls) {
    for (const Vec3 p : corners_of(wall.asset)) {
      result.walls.push_back(p);
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    for (std::uint32_t c = 0; c < wall.track.size(); ++c) {
      for (const std::uint32_t step : steps) {
        const ChunkPlace place = place_of(recording, wall, c, step);
        if (place.track != kNoTrack) {
          result.chunks.push_back(place.pose * wall.asset.chunks[c].centroid);
        }
      }
    }
  }
  const Vec3 centre = 0.5 * (low + high);
  const double reach = 0.75 * length(high - low);
  for (const RecordedProjectile& recorded : recording.projectiles) {
    const Pose start{recorded.projectile.position, {}};
    for (const std::uint32_t step : steps) {
      const Vec3 at = pose_at(recording, recorded.track, step, start).position;
      if (length(at - centre) < reach) result.projectiles.push_back(at);
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

// Extent of points in a direction that widens with depth; `outliers`: share left out.
double reach_of(std::span<const Vec3> points, Vec3 direction, double outliers) {
  std::vector<double> reach;
  for (const Vec3 p : points) reach.push_back(dot(p, direction));
  if (reach.empty()) return -std::numeric_limits<double>::infinity();
  const auto skip = static_cast<std::size_t>(outliers * static_cast<double>(reach.size()));
  std::ranges::nth_element(reach, reach.begin() + static_cast<std::ptrdiff_t>(skip),
                           std::greater<>());
  return reach[skip];
}

// How far points reach to the four sides of a picture, and the distance that shows them all. A
// camera looking along -back sees p if |right·(p - eye)| <= k back·(eye - p), and the same for up:
// four planes, each pushed out to the farthest point.
struct Extent {
  double right = 0, left = 0, top = 0, bottom = 0;
};
constexpr double kSlopeX = kHalfWidth / kMargin, kSlopeY = kSlopeX * kStripHeight / kStripWidth;

Extent extent_of(const StripCamera& camera, const Interest& interest) {
  const auto reach = [&](Vec3 side, double slope) {
    const Vec3 direction = side + slope * camera.back;
    double result = reach_of(interest.walls, direction, 0);
    result = std::max(result, reach_of(interest.chunks, direction, kOutliers));
    return std::max(result, reach_of(interest.projectiles, direction, 0));
  };
  return {reach(camera.right, kSlopeX), reach(-1.0 * camera.right, kSlopeX),
          reach(camera.up, kSlopeY), reach(-1.0 * camera.up, kSlopeY)};
}

double depth_of(const Extent& extent) {
  return std::max((extent.right + extent.left) / (2 * kSlopeX),
                  (extent.top + extent.bottom) / (2 * kSlopeY));
}

StripCamera fitted(Vec3 back, const Interest& interest) {
  StripCamera camera;
  point_along(camera, back);
  camera.focal = 0.5 * kStripWidth / kHalfWidth;
  double middle = 0;
  for (const Vec3 p : interest.walls) middle += dot(p, camera.back);
  middle /= std::max<double>(1, static_cast<double>(interest.walls.size()));
  const Extent walls = extent_of(camera, {interest.walls, {}, {}});
  const Extent all = extent_of(camera, interest);
  const double near = depth_of(walls) - middle;
  const double depth = middle + std::min(depth_of(all) - middle, kMostFar * near);
  // The walls are shown whole, the rest as far as there is room.
  const double across = std::clamp(0.5 * (all.right - all.left), walls.right - kSlopeX * depth,
                                   kSlopeX * depth - walls.left);
  const double height = std::clamp(0.5 * (all.top - all.bottom), walls.top - kSlopeY * depth,
                                   kSlopeY * depth - walls.bottom);
  camera.eye = across * camera.right + height * camera.up + depth * camera.back;
  camera.nearest = 0.05 * (depth - middle);
  return camera;
}

bool is_hidden_by(const WallAsset& wall, Vec3 eye, Vec3 point) {
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

StripCamera place_camera(const Recording& recording, std::span<const std::uint32_t> steps) {
  const Interest interest = find_interest(recording, steps);
  Vec3 normal{0, 0, 1};
  if (const RecordedWall* wall = most_broken(recording)) {
    normal = rotate(wall->asset.wall.rotation, {0, 0, 1});
  }
  normal.y = 0;
  normal = length(normal) > 0.2 ? unit(normal) : Vec3{0, 0, 1};  // a slab: any side will do
  const Vec3 along = cross(Vec3{0, 1, 0}, normal);
  const Vec2 turn = unit_at_turns(kAzimuth), rise = unit_at_turns(kElevation);
  StripCamera best;
  double most = -1;
  for (const double side : {1.0, -1.0}) {
    for (const double hand : {1.0, -1.0}) {
      const Vec3 flat = side * turn.x * normal + hand * turn.y * along;
      const StripCamera camera = fitted(rise.x * flat + Vec3{0, rise.y, 0}, interest);
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
