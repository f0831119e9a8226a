// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text << "solid pattern: ";
  (text << ... << parts);
  throw Error(ErrorCode::geometry, text.str());
}

// Whether a site at a place (steps) leaves the complex what it must be (see voronoi_complex).
bool is_near(Vec3 p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 2 * SolidFrame::kHalf;
}

LatticeSite site_at(Vec3 metres, const SolidFrame& frame) {
  const Vec3 p = (1 / frame.step) * (metres - frame.centre);
  if (!is_near(p))
    refuse("a site at (", metres.x, ", ", metres.y, ", ", metres.z,
           ") m is farther from the solid than its own size");
  const auto snap = [](double v) { return static_cast<std::int64_t>(std::round(v)); };
  return {snap(p.x), snap(p.y), snap(p.z)};
}

double& part(Vec3& v, std::size_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
double part(const Vec3& v, std::size_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// Two directions across a unit vector, right-handed with it.
std::array<Vec3, 2> across(Vec3 n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const Vec3 axis = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 side = cross(axis, n);
  const Vec3 u = (1 / length(side)) * side;
  return {u, cross(n, u)};
}

// Planes across the axes at coordinates in metres: those within the solid, ascending, different.
// A plane in which faces of the solid lie is moved by 2^-9 steps to the side on which they have
// nothing behind them: otherwise a cell on that side would get skins of no thickness.
std::array<std::vector<double>, 3> planes_within(std::array<std::vector<double>, 3> metres,
                                                 const TriMesh& mesh, const InsideTest& box,
                                                 const SolidFrame& frame) {
  constexpr double kSame = 0x1p-6, kMove = 0x1p-9;  // steps
  for (std::size_t a = 0; a < 3; ++a) {
    const auto steps = [&](double v) { return (v - part(frame.centre, a)) / frame.step; };
    std::vector<double> kept;
    std::ranges::sort(metres[a]);
    for (const double v : metres[a]) {
      const double s = steps(v);
      if (s > steps(part(box.low(), a)) + kSame && s < steps(part(box.high(), a)) - kSame &&
          (kept.empty() || s > kept.back() + kSame))
        kept.push_back(s);
    }
    std::vector<double> lean(kept.size());  // area of the faces in each plane, by direction
    for (const auto& t : mesh.triangles) {
      const Vec3 p = mesh.vertices[t[0]], q = mesh.vertices[t[1]], r = mesh.vertices[t[2]];
      const double s = steps(part(p, a));
      if (std::abs(steps(part(q, a)) - s) > kSame || std::abs(steps(part(r, a)) - s) > kSame)
        continue;
      const auto at = std::ranges::lower_bound(kept, s - kSame);
      if (at == kept.end() || *at > s + kSame) continue;
      const Vec3 area = cross(q - p, r - p);
      lean[static_cast<std::size_t>(at - kept.begin())] += part(area, a);
    }
    for (std::size_t k = 0; k < kept.size(); ++k)
      if (lean[k] != 0) kept[k] += lean[k] > 0 ? kMove : -kMove;
    metres[a] = std::move(kept);
  }
  return metres;
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
  SolidComplex operator()(const SolidSlicesParams& p) const {
    const InsideTest box(mesh);
    const Vec3 size = box.high() - box.low();
    std::array<std::vector<double>, 3> at;
    double cells = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const double count = part(p.slices, a);
      if (!(count >= 0 && count == std::floor(count) && count <= kMaxSolidCells))
        refuse("slices = ", count, ", valid are whole numbers from 0");
      cells *= count + 1;
      for (double k = 0; k < std::min(count, 1e6); ++k) {
        const double spacing = part(size, a) / (count + 1);
        const double vary = p.offset_variation * (random_unit(seed, draw_of(a, k), 0) - 0.5);
        at[a].push_back(part(box.low(), a) + spacing * (k + 1 + vary));
      }
    }
    check_cells(cells);
    if (p.angle_variation == 0) return grid_complex(planes_within(at, mesh, box, frame));
    return plane_complex(tilted(at, p.angle_variation, 0.5 * (box.low() + box.high())));
  }

  // Slices turned about where they cross the solid's middle line, each its own way.
  std::vector<SolidComplex::Plane> tilted(const std::array<std::vector<double>, 3>& at,
                                          double angle, Vec3 middle) const {
    std::vector<SolidComplex::Plane> planes;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t k = 0; k < at[a].size(); ++k) {
        const std::uint64_t draw = draw_of(a, static_cast<double>(k));
        Vec3 axis, through = middle;
        part(axis, a) = 1;
        part(through, a) = at[a][k];
        const auto [u, v] = across(axis);
        const Vec2 turn = unit_at_turns(random_unit(seed, draw, 1));
        const Vec2 lean =
            unit_at_turns(angle * random_unit(seed, draw, 2) / (2 * std::numbers::pi));
        const Vec3 n = lean.x * axis + lean.y * (turn.x * u + turn.y * v);
        planes.push_back({n, dot(n, (1 / frame.step) * (through - frame.centre))});
      }
    return planes;
  }

  static std::uint64_t draw_of(std::size_t axis, double k) {
    return 3 * static_cast<std::uint64_t>(k) + axis;
  }
  static void check_cells(double cells) {
    if (!(cells <= kMaxSolidCells))
      refuse("it would make ", cells, " cells, valid are up to ", kMaxSolidCells);
  }

  SolidComplex operator()(const SolidRadialParams& p) const {
    const double size = length(p.axis);
    if (!(size > 0)) refuse("axis has no length");
    if (p.rays < 1 || p.rings < 1 || !(p.radius > 0))
      refuse("rays = ", p.rays, ", rings = ", p.rings, ", radius = ", p.radius,
             ", valid are 1 and more, above 0");
    check_cells(static_cast<double>(p.rays) * static_cast<double>(p.rings + 1));
    const InsideTest box(mesh);
    const Vec3 n = (1 / size) * p.axis;
    const auto [u, v] = across(n);
    const Vec3 middle = 0.5 * (box.low() + box.high());
    const Vec3 centre = p.centre + dot(middle - p.centre, n) * n;  // cells run along the axis
    std::vector<LatticeSite> sites;
    for (std::int64_t ring = 0; ring <= p.rings; ++ring)
      for (std::int64_t ray = 0; ray < p.rays; ++ray) {
        const auto draw = static_cast<std::uint64_t>(ring * p.rays + ray);
        const auto vary = [&](std::uint64_t k) {
          return p.variability * (random_unit(seed, draw, k) - 0.5);
        };
        const double radius =
            p.radius * (static_cast<double>(ring) + 0.5 + vary(0)) / static_cast<double>(p.rings);
        const Vec2 turn =
            unit_at_turns((static_cast<double>(ray) + 0.5 + vary(1)) / static_cast<double>(p.rays));
        const Vec3 at = centre + radius * (turn.x * u + turn.y * v);
        if (is_near((1 / frame.step) * (at - frame.centre))) sites.push_back(site_at(at, frame));
      }
    if (sites.empty()) refuse("no ray or ring comes near the solid");
    return complex_of(sites);
  }

  SolidComplex operator()(const SolidBrickParams& p) const {
    if (!(p.brick.x > 0 && p.brick.y > 0 && p.brick.z > 0 && p.mortar >= 0))
      refuse("brick = (", p.brick.x, ", ", p.brick.y, ", ", p.brick.z, ") m, mortar = ", p.mortar,
             " m, valid are above 0, from 0");
    const InsideTest box(mesh);
    const Vec3 low = box.low(), size = box.high() - box.low();
    const Vec3 pitch = p.brick + Vec3{p.mortar, p.mortar, p.mortar};
    check_cells((2 * size.x / pitch.x + 1) * (size.y / pitch.y + 1) * (size.z / pitch.z + 1) *
                (p.mortar > 0 ? 8 : 1));
    std::array<std::vector<double>, 3> at;
    const auto add_row = [&](std::size_t a, double first) {
      for (double k = -1; first + k * part(pitch, a) < part(size, a); ++k) {
        const double start = part(low, a) + first + k * part(pitch, a);
        at[a].push_back(start);
        if (p.mortar > 0) at[a].push_back(start + part(p.brick, a));
      }
    };
    const double shift = (p.offset - std::floor(p.offset)) * pitch.x;
    for (std::size_t a = 0; a < 3; ++a) add_row(a, 0);
    add_row(0, shift);
    const auto planes = planes_within(at, mesh, box, frame);
    SolidComplex complex = grid_complex(planes);
    complex.labels = brick_labels(p, low, pitch, shift, planes);
    return complex;
  }

  // A label for each brick, another for the joints above, behind and to the right of it.
  std::vector<std::uint32_t> brick_labels(const SolidBrickParams& p, Vec3 low, Vec3 pitch,
                                          double shift,
                                          const std::array<std::vector<double>, 3>& planes) const {
    // Middle of the cells between planes, as bricks from the lowest corner.
    const auto middle = [&](std::size_t a, std::size_t i) {
      constexpr double kEnd = SolidFrame::kHalf;
      const double from = i == 0 ? -kEnd : planes[a][i - 1];
      const double to = i == planes[a].size() ? kEnd : planes[a][i];
      // The outermost cells are those next to their one plane.
      const double at = i == 0 && i < planes[a].size()   ? to - 0x1p-4
                        : i == planes[a].size() && i > 0 ? from + 0x1p-4
                                                         : (from + to) / 2;
      return part(frame.centre, a) + frame.step * at - part(low, a);
    };
    std::map<std::array<std::int64_t, 4>, std::uint32_t> labels;
    std::vector<std::uint32_t> result;
    for (std::size_t k = 0; k <= planes[2].size(); ++k)
      for (std::size_t j = 0; j <= planes[1].size(); ++j)
        for (std::size_t i = 0; i <= planes[0].size(); ++i) {
          Vec3 at{middle(0, i), middle(1, j), middle(2, k)};
          const double course = std::floor(at.y / pitch.y);
          if (std::fmod(std::abs(course), 2) == 1) at.x -= shift;
          bool joint = false;
          std::array<std::int64_t, 4> key{};
          for (std::size_t a = 0; a < 3; ++a) {
            const double number = std::floor(part(at, a) / part(pitch, a));
            joint |= part(at, a) - number * part(pitch, a) > part(p.brick, a);
            key[a] = static_cast<std::int64_t>(number);
          }
          key[3] = joint;
          result.push_back(
              labels.try_emplace(key, static_cast<std::uint32_t>(labels.size())).first->second);
        }
    return result;
  }
};

}  // namespace

SolidComplex make_solid_complex(const SolidPatternParams& pattern, const TriMesh& mesh,
                                const SolidFrame& frame, std::uint64_t seed) {
  return std::visit(ComplexMaker{mesh, frame, seed}, pattern);
}

}  // namespace sunder
