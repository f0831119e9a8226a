// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text << "solid pattern: ";
  (text << ... << parts);
  throw Error(ErrorCode::geometry, text.str());
}

LatticeSite site_at(Vec3 metres, const SolidFrame& frame) {
  const Vec3 p = (1 / frame.step) * (metres - frame.centre);
  const auto snap = [](double v) {
    return static_cast<std::int64_t>(
        std::round(std::clamp(v, -SolidFrame::kHalf, SolidFrame::kHalf)));
  };
  return {snap(p.x), snap(p.y), snap(p.z)};
}

// Different ones, in the order in which they come.
SolidComplex complex_of(const std::vector<LatticeSite>& sites) {
  std::vector<std::pair<LatticeSite, std::size_t>> order;
  for (std::size_t i = 0; i < sites.size(); ++i) order.emplace_back(sites[i], i);
  std::ranges::sort(order);
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (k == 0 || order[k].first != order[k - 1].first) kept.push_back(order[k].second);
  std::ranges::sort(kept);
  std::vector<LatticeSite> distinct;
  for (const std::size_t i : kept) distinct.push_back(sites[i]);
  return voronoi_complex(distinct);
}

// Draws sites one by one: each depends on (seed, its number) only.
struct SiteMaker {
  const SolidVoronoiParams& params;
  const InsideTest& inside;
  const TriMesh& mesh;
  std::uint64_t seed;
  static constexpr std::uint64_t kTries = 4096;

  double draw(std::uint64_t i, std::uint64_t k) const { return random_unit(seed, i, k); }

  Vec3 uniform(std::uint64_t i) const {
    const Vec3 low = inside.low(), size = inside.high() - low;
    for (std::uint64_t k = 0; k < kTries; ++k) {
      const Vec3 p = low + Vec3{draw(i, 3 * k) * size.x, draw(i, 3 * k + 1) * size.y,
                                draw(i, 3 * k + 2) * size.z};
      if (inside.contains(p)) return p;
    }
    // A solid of nearly no volume: on its surface.
    const auto& t = mesh.triangles[random_bits(seed, i, 3 * kTries) % mesh.triangles.size()];
    const double a = draw(i, 3 * kTries + 1), b = (1 - a) * draw(i, 3 * kTries + 2);
    const Vec3 o = mesh.vertices[t[0]];
    return o + a * (mesh.vertices[t[1]] - o) + b * (mesh.vertices[t[2]] - o);
  }

  Vec3 near_point(std::uint64_t i) const {
    constexpr std::uint64_t kStart = std::uint64_t{1} << 40;
    const auto& centre = params.points[random_bits(seed, i, kStart) % params.points.size()];
    for (std::uint64_t k = 0; k < 64; ++k) {
      const auto part = [&](std::uint64_t axis) {
        return 2 * draw(i, kStart + 4 * k + axis + 1) - 1;
      };
      const Vec3 d{part(0), part(1), part(2)};
      const double square = dot(d, d);
      if (square > 1 || square == 0) continue;
      const Vec3 p = centre + (params.radius * std::sqrt(square)) * d;  // denser to the centre
      if (inside.contains(p)) return p;
    }
    return uniform(i);
  }

  Vec3 site(std::uint64_t i) const {
    const bool near = !params.points.empty() && draw(i, ~std::uint64_t{0}) < params.share;
    return near ? near_point(i) : uniform(i);
  }
};

struct ComplexMaker {
  const TriMesh& mesh;
  const SolidFrame& frame;
  std::uint64_t seed;

  SolidComplex operator()(const SolidVoronoiParams& p) const {
    std::vector<LatticeSite> sites;
    if (p.sites.empty()) {
      if (p.count < 1 || p.count > kMaxSolidCells)
        refuse("count = ", p.count, ", valid are 1 … ", kMaxSolidCells);
      const InsideTest inside(mesh);
      const SiteMaker maker{p, inside, mesh, seed};
      for (std::int64_t i = 0; i < p.count; ++i)
        sites.push_back(site_at(maker.site(static_cast<std::uint64_t>(i)), frame));
    }
    for (const Vec3& site : p.sites) sites.push_back(site_at(site, frame));
    if (static_cast<std::int64_t>(sites.size()) > kMaxSolidCells)
      refuse(sites.size(), " sites are given, valid are 1 … ", kMaxSolidCells);
    return complex_of(sites);
  }
  SolidComplex operator()(const SolidSlicesParams&) const { refuse("slices are not made yet"); }
  SolidComplex operator()(const SolidRadialParams&) const { refuse("radial is not made yet"); }
  SolidComplex operator()(const SolidBrickParams&) const { refuse("bricks are not made yet"); }
};

}  // namespace

SolidComplex make_solid_complex(const SolidPatternParams& pattern, const TriMesh& mesh,
                                const SolidFrame& frame, std::uint64_t seed) {
  return std::visit(ComplexMaker{mesh, frame, seed}, pattern);
}

}  // namespace sunder
