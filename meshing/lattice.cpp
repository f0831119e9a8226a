// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/lattice.hpp"

#include <algorithm>
#include <cmath>

#include "meshing/error.hpp"

namespace sunder {

LatticePoint Lattice::nearest(Vec2 metres) const {
  const auto snap = [](double value, std::int64_t limit) {
    return std::clamp<std::int64_t>(std::llround(value), 0, limit);
  };
  return {snap((metres.x - origin.x) / step.x, width),
          snap((metres.y - origin.y) / step.y, height)};
}

Lattice make_lattice(Vec2 origin, Vec2 size) {
  if (!(size.x > 0 && size.y > 0 && std::isfinite(size.x) && std::isfinite(size.y)))
    throw Error(ErrorCode::geometry, "a wall needs a finite width and height above 0");
  const double unit = std::max(size.x, size.y) / static_cast<double>(kMaxExtent);
  const auto extent = [&](double length) {
    return std::clamp<std::int64_t>(std::llround(length / unit), 1, kMaxExtent);
  };
  Lattice lattice{origin, {}, extent(size.x), extent(size.y)};
  lattice.step = {size.x / static_cast<double>(lattice.width),
                  size.y / static_cast<double>(lattice.height)};
  return lattice;
}

}  // namespace sunder
