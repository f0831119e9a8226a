// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle of no area, as straight rows of corners leave on a facet's border, shares its longest
// side with another of the facet: the other two corners of both are joined instead.
#include <algorithm>
#include <map>

#include "fracture/solid_cut.hpp"

namespace sunder {
namespace {

constexpr double kFlat = 1e-13;  // height by longest side: rounding
using Triangle = std::array<std::uint32_t, 3>;
using Link = std::array<std::uint32_t, 2>;

struct Flipper {
  const std::vector<Vec3>& places;
  std::span<Triangle> triangles;  // of one facet
  std::map<Link, std::size_t> triangle_at{};

  // Height above the longest side by its length, and where that side starts.
  std::pair<double, std::size_t> flatness(const Triangle& t) const {
    std::pair<double, std::size_t> longest{-1, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 d = places[t[(k + 1) % 3]] - places[t[k]];
      longest = std::max(longest, std::pair{dot(d, d), k});
    }
    const double area = length(cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]));
    return {longest.first > 0 ? area / longest.first : 0, longest.second};
  }

  void enter(std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k)
      triangle_at[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
  }

  // Whether triangle t was flat and is no more.
  bool flip(std::size_t t) {
    const auto [height, k] = flatness(triangles[t]);
    const std::uint32_t b = triangles[t][k], a = triangles[t][(k + 1) % 3],
                        m = triangles[t][(k + 2) % 3];
    const auto other = triangle_at.find({a, b});
    if (height >= kFlat || other == triangle_at.end()) return false;
    const std::size_t o = other->second;
    const std::uint32_t c = triangles[o][0] ^ triangles[o][1] ^ triangles[o][2] ^ a ^ b;
    const Triangle first{a, m, c}, second{m, b, c};
    if (std::min(flatness(first).first, flatness(second).first) < kFlat ||
        triangle_at.contains({m, c}) || triangle_at.contains({c, m}))
      return false;
    triangle_at.erase({a, b});
    triangle_at.erase({b, a});
    triangles[t] = first;
    triangles[o] = second;
    enter(t);
    enter(o);
    return true;
  }

  void run() {
    const auto is_flat = [&](const Triangle& t) { return flatness(t).first < kFlat; };
    if (std::ranges::none_of(triangles, is_flat)) return;
    for (std::size_t t = 0; t < triangles.size(); ++t) enter(t);
    for (bool flipped = true; flipped;) {
      flipped = false;
      for (std::size_t t = 0; t < triangles.size(); ++t) flipped |= flip(t);
    }
  }
};

}  // namespace

void flip_flat_triangles(CutSolid& cut) {
  for (std::size_t f = 0; f + 1 < cut.facet_triangle_begin.size(); ++f) {
    const std::uint32_t begin = cut.facet_triangle_begin[f];
    const auto count = cut.facet_triangle_begin[f + 1] - begin;
    if (count > 1) Flipper{cut.places, std::span(cut.facet_triangles).subspan(begin, count)}.run();
  }
}

}  // namespace sunder
