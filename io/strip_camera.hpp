// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "meshing/vec.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// Size of one picture of a strip in its own units, tenths of a pixel.
constexpr double kStripWidth = 10000, kStripHeight = 6400;

/// A pinhole camera without roll, looking slightly down.
struct StripCamera {
  Vec3 eye, right, up, back;   ///< unit vectors, right-handed; it looks along -back
  double focal = 1;            ///< picture units per unit of slope
  double nearest = 0.01;       ///< what is nearer than this is not drawn, m
  double width = kStripWidth;  ///< about the picture's middle, of what is worth showing
  Vec3 light{0, 1, 0};         ///< unit, to the sun: over a shoulder, on the side that walls face

  /// {right, up, distance along the line of sight}, m.
  Vec3 see(Vec3 world) const {
    const Vec3 d = world - eye;
    return {dot(d, right), dot(d, up), -dot(d, back)};
  }
  /// Picture coordinates, y down; only of what lies in front.
  Vec2 project(Vec3 seen) const {
    const double scale = focal / seen.z;
    return {0.5 * kStripWidth + scale * seen.x, 0.5 * kStripHeight - scale * seen.y};
  }
};

/// One camera for all steps of a strip. It stands on the side of the most broken wall from which
/// more of the moving chunks are seen past the standing walls, 40° off the wall's normal, and so
/// near that the walls and what happens close to them fill the picture: 0.6 of a wall's width or
/// height (the smaller) on the side that chunks leave by, and the ground below it (at a height in
/// m; none: not shown) if that is no farther than the wall is high. What flies beyond is cut off.
/// A building is seen whole as it stood, with some ground around it and projectiles that start
/// near, from the corner next to where the first projectile comes from or the first joint breaks.
StripCamera place_camera(const Recording& recording, std::span<const std::uint32_t> steps,
                         std::optional<double> ground = {});

/// Where the frame of chunk `chunk` is at a step, and the track it moves along (kNoTrack: stands).
struct ChunkPlace {
  Pose pose;
  std::uint32_t track = kNoTrack;
};
ChunkPlace place_of(const Recording& recording, const RecordedWall& wall, std::uint32_t chunk,
                    std::uint32_t step);

}  // namespace sunder
