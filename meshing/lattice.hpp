// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstdint>

#include "meshing/vec.hpp"

namespace sunder {

__extension__ using Int128 = __int128;

/// Largest lattice extent, per axis: every predicate below is then exact in 128 bits.
constexpr std::int64_t kMaxExtent = std::int64_t{1} << 30;

/// Point of a wall's integer lattice.
struct LatticePoint {
  std::int64_t x = 0, y = 0;
  friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
  friend auto operator<=>(const LatticePoint&, const LatticePoint&) = default;
};
constexpr LatticePoint operator+(LatticePoint a, LatticePoint b) {
  return {a.x + b.x, a.y + b.y};
}
constexpr LatticePoint operator-(LatticePoint a, LatticePoint b) {
  return {a.x - b.x, a.y - b.y};
}

/// The integer frame in which a wall's pattern is decided: lattice point X stands for
/// `origin + X * step` metres. Decisions are made on integers, exactly; metres only place things.
/// `width` and `height` are the lattice sizes of the bounding box, 1 … kMaxExtent.
/// The two steps differ by less than 2^-20 of themselves on a wall at least 2^-10 as high as wide.
struct Lattice {
  Vec2 origin;
  Vec2 step{1, 1};
  std::int64_t width = 1, height = 1;

  Vec2 to_metres(Vec2 point) const {
    return {origin.x + point.x * step.x, origin.y + point.y * step.y};
  }
  Vec2 to_metres(LatticePoint point) const {
    return to_metres(Vec2{static_cast<double>(point.x), static_cast<double>(point.y)});
  }
  /// Nearest lattice point, clamped to the bounding box.
  LatticePoint nearest(Vec2 metres) const;
};

/// Lattice over a box of `size` metres with its lower left corner at `origin`, as fine as
/// kMaxExtent allows. Throws Error{geometry} unless both sizes are finite and positive.
Lattice make_lattice(Vec2 origin, Vec2 size);

/// Line a·x' + b·y' = c in doubled coordinates x' = 2 (x - base), y' = 2 (y - base) relative to
/// some base point; the inside is where a·x' + b·y' < c. |a|, |b| <= 2^30, |c| <= 2^62.
struct LatticeLine {
  std::int64_t a = 0, b = 0, c = 0;
  friend bool operator==(const LatticeLine&, const LatticeLine&) = default;
};

/// Points as near to `base` as to `base + d`: d·x' = |d|².
constexpr LatticeLine bisector(LatticePoint d) {
  return {d.x, d.y, d.x * d.x + d.y * d.y};
}

/// Line through two points given relative to the base; what lies left of p → q is inside.
constexpr LatticeLine line_through(LatticePoint p, LatticePoint q) {
  const LatticePoint d = q - p;
  return {d.y, -d.x, 2 * (d.y * p.x - d.x * p.y)};
}

/// Twice the signed area of triangle (0, p, q); exact.
constexpr std::int64_t cross(LatticePoint p, LatticePoint q) {
  return p.x * q.y - p.y * q.x;
}

/// > 0 when a → b → c turns left, 0 when straight; exact.
constexpr std::int64_t orientation(LatticePoint a, LatticePoint b, LatticePoint c) {
  return cross(b - a, c - a);
}

/// Exact intersection of two lines in homogeneous doubled coordinates, w != 0.
struct LatticeCrossing {
  Int128 x = 0, y = 0, w = 1;
};

/// Where two lines that are not parallel meet. |x|, |y| < 2^94, |w| < 2^62; w > 0.
constexpr LatticeCrossing intersection(const LatticeLine& p, const LatticeLine& q) {
  LatticeCrossing r{static_cast<Int128>(p.c) * q.b - static_cast<Int128>(q.c) * p.b,
                    static_cast<Int128>(p.a) * q.c - static_cast<Int128>(q.a) * p.c,
                    static_cast<Int128>(p.a) * q.b - static_cast<Int128>(q.a) * p.b};
  assert(r.w != 0);
  if (r.w < 0) r = {-r.x, -r.y, -r.w};
  return r;
}

/// A lattice point as a crossing.
constexpr LatticeCrossing crossing_at(LatticePoint relative) {
  return {2 * relative.x, 2 * relative.y, 1};
}

/// +1 outside the line, 0 on it, -1 inside; exact.
constexpr int side_of(const LatticeLine& line, const LatticeCrossing& point) {
  const Int128 value = line.a * point.x + line.b * point.y - line.c * point.w;
  return (value > 0) - (value < 0);
}

/// The same for a lattice point relative to the line's base; exact.
constexpr int side_of(const LatticeLine& line, LatticePoint relative) {
  const Int128 value = static_cast<Int128>(line.a) * (2 * relative.x) +
                       static_cast<Int128>(line.b) * (2 * relative.y) - line.c;
  return (value > 0) - (value < 0);
}

/// A crossing in lattice units relative to the base, rounded; error below 2 ulp of each coordinate.
inline Vec2 rounded(const LatticeCrossing& p) {
  const double w = 2 * static_cast<double>(p.w);
  return {static_cast<double>(p.x) / w, static_cast<double>(p.y) / w};
}

}  // namespace sunder
