// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/sites.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr int kFinestCell = 20;  // log2 of the most lattice units along a grid cell
// Draws around a focus before a site is drawn from the whole box, for foci that lie far outside.
constexpr std::uint64_t kFocusAttempts = 256;

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::geometry, message);
}

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

double grid_count(double length, double cell) {
  return std::max(1.0, std::round(length / cell));
}

double cell_count(Vec2 size, double cell) {
  return grid_count(size.x, cell) * grid_count(size.y, cell);
}

// The smallest cell that makes at most kMaxCells cells, rounded up by less than 0.1 %.
double smallest_cell(Vec2 size) {
  double cell = std::sqrt(size.x / kMaxCells * size.y);
  while (!(cell_count(size, cell) <= kMaxCells)) cell *= 1.001;
  return cell;
}

std::uint64_t sort_key(Site site) {
  return static_cast<std::uint64_t>(site.x) << 32 | static_cast<std::uint32_t>(site.y);
}

// Indices of the points that repeat an earlier point, ascending.
std::vector<std::uint32_t> repeats(std::span<const Site> points) {
  std::vector<std::uint64_t> keys(points.size());
  std::ranges::transform(points, keys.begin(), sort_key);
  std::ranges::sort(keys);
  if (std::ranges::adjacent_find(keys) == keys.end()) return {};

  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t k) { return sort_key(points[k]); });
  std::vector<std::uint32_t> result;
  for (std::size_t i = 1; i < order.size(); ++i)
    if (points[order[i]] == points[order[i - 1]]) result.push_back(order[i]);
  std::ranges::sort(result);
  return result;
}

// `count` distinct sites; draw(k, attempt) gives a candidate for site k.
template <class Draw>
Sites distinct_sites(const Lattice& lattice, std::uint32_t count, Draw draw) {
  const double places =
      static_cast<double>(lattice.width + 1) * static_cast<double>(lattice.height + 1);
  if (count == 0 || count > kMaxCells || count > places / 2)
    refuse(text("sites: count = ", count, " is outside 1 … ",
                std::min<double>(kMaxCells, std::floor(places / 2))));
  Sites sites;
  sites.lattice = lattice;
  sites.points.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) sites.points[k] = draw(k, 0);
  std::vector<std::uint32_t> again = repeats(sites.points);
  for (std::uint64_t attempt = 1; !again.empty(); ++attempt) {
    for (std::uint32_t k : again) sites.points[k] = draw(k, attempt);
    again = repeats(sites.points);
  }
  return sites;
}

Site uniform_site(const Lattice& lattice, std::uint64_t bits) {
  const auto scale = [](std::uint64_t half, std::int64_t extent) {
    return static_cast<std::int32_t>(half * static_cast<std::uint64_t>(extent + 1) >> 32);
  };
  return {scale(bits >> 32, lattice.width), scale(bits & 0xFFFFFFFFu, lattice.height)};
}

bool in_box(const Lattice& lattice, Vec2 metres) {
  const double x = (metres.x - lattice.origin.x) / lattice.step.x;
  const double y = (metres.y - lattice.origin.y) / lattice.step.y;
  return x >= -0.5 && y >= -0.5 && x <= static_cast<double>(lattice.width) + 0.5 &&
         y <= static_cast<double>(lattice.height) + 0.5;
}

Site snap(const Lattice& lattice, Vec2 metres) {
  const LatticePoint point = lattice.nearest(metres);
  return {static_cast<std::int32_t>(point.x), static_cast<std::int32_t>(point.y)};
}

}  // namespace

GridShape make_grid(Vec2 origin, Vec2 size, double cell) {
  if (!(size.x > 0 && size.y > 0 && std::isfinite(size.x) && std::isfinite(size.y)))
    refuse("a wall needs a finite width and height above 0");
  if (!(cell > 0 && std::isfinite(cell))) refuse(text("cell = ", cell, " m is not above 0"));
  if (!(cell_count(size, cell) <= kMaxCells))
    refuse(text("cell = ", cell, " m makes more than ", kMaxCells, " cells of a wall of ", size.x,
                " x ", size.y, " m; the smallest cell that fits is ", smallest_cell(size), " m"));
  const double columns = grid_count(size.x, cell), rows = grid_count(size.y, cell);
  const double width = size.x / columns, height = size.y / rows;
  GridShape grid;
  grid.columns = static_cast<std::int32_t>(columns);
  grid.rows = static_cast<std::int32_t>(rows);
  for (int fineness = kFinestCell; fineness >= 0; --fineness) {
    const double unit = std::max(width, height) / static_cast<double>(1 << fineness);
    grid.cell_width = std::max(1, static_cast<std::int32_t>(std::lround(width / unit)));
    grid.cell_height = std::max(1, static_cast<std::int32_t>(std::lround(height / unit)));
    grid.lattice.width = std::int64_t{grid.columns} * grid.cell_width;
    grid.lattice.height = std::int64_t{grid.rows} * grid.cell_height;
    if (grid.lattice.width <= kMaxExtent && grid.lattice.height <= kMaxExtent) break;
  }
  grid.lattice.origin = origin;
  grid.lattice.step = {size.x / static_cast<double>(grid.lattice.width),
                       size.y / static_cast<double>(grid.lattice.height)};
  return grid;
}

Sites jittered_sites(const GridShape& grid, double jitter, std::uint64_t seed) {
  if (!(jitter >= 0 && jitter <= 1)) refuse(text("jitter = ", jitter, " is outside [0, 1]"));
  Sites sites;
  sites.lattice = grid.lattice;
  sites.columns = grid.columns, sites.rows = grid.rows;
  sites.cell_width = grid.cell_width, sites.cell_height = grid.cell_height;
  const std::int64_t range_x = std::llround(jitter * grid.cell_width);
  const std::int64_t range_y = std::llround(jitter * grid.cell_height);
  const std::int64_t low_x = (grid.cell_width - range_x) / 2;
  const std::int64_t low_y = (grid.cell_height - range_y) / 2;
  sites.points.reserve(static_cast<std::size_t>(grid.columns) *
                       static_cast<std::size_t>(grid.rows));
  for (std::int64_t j = 0; j < grid.rows; ++j)
    for (std::int64_t i = 0; i < grid.columns; ++i) {
      const std::uint64_t bits = random_bits(seed, sites.points.size());
      const auto in_range = [](std::uint64_t half, std::int64_t range) {
        return static_cast<std::int64_t>(half * static_cast<std::uint64_t>(range) >> 32);
      };
      const std::int64_t x = i * grid.cell_width + low_x + in_range(bits >> 32, range_x);
      const std::int64_t y = j * grid.cell_height + low_y + in_range(bits & 0xFFFFFFFFu, range_y);
      sites.points.push_back({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)});
    }
  return sites;
}

Sites random_sites(const Lattice& lattice, std::uint32_t count, std::uint64_t seed) {
  return distinct_sites(lattice, count, [&](std::uint32_t k, std::uint64_t attempt) {
    return uniform_site(lattice, random_bits(seed, k, attempt));
  });
}

Sites given_sites(const Lattice& lattice, std::span<const Vec2> metres) {
  if (metres.empty() || metres.size() > kMaxCells)
    refuse(text("sites: ", metres.size(), " are given, valid are 1 … ", kMaxCells));
  Sites sites;
  sites.lattice = lattice;
  for (std::size_t k = 0; k < metres.size(); ++k) {
    if (!in_box(lattice, metres[k]))
      refuse(text("sites: site ", k, " at (", metres[k].x, ", ", metres[k].y,
                  ") m lies outside the wall's bounding box"));
    sites.points.push_back(snap(lattice, metres[k]));
  }
  const std::vector<std::uint32_t> dropped = repeats(sites.points);
  sites.duplicates_dropped = static_cast<std::uint32_t>(dropped.size());
  std::size_t kept = 0;
  auto next = dropped.begin();
  for (std::uint32_t k = 0; k < sites.points.size(); ++k) {
    if (next != dropped.end() && *next == k)
      ++next;
    else
      sites.points[kept++] = sites.points[k];
  }
  sites.points.resize(kept);
  return sites;
}

Sites focused_sites(const Lattice& lattice, std::span<const Vec2> focus_points, FocusParams params,
                    std::uint64_t seed) {
  if (focus_points.empty()) refuse("focused sites need at least one focus point");
  if (!(params.radius > 0 && std::isfinite(params.radius)))
    refuse(text("radius = ", params.radius, " m is not above 0"));
  if (!(params.share >= 0 && params.share <= 1))
    refuse(text("share = ", params.share, " is outside [0, 1]"));
  return distinct_sites(lattice, params.count, [&](std::uint32_t k, std::uint64_t attempt) {
    // Four draws an attempt: whether, which focus, distance, angle.
    for (std::uint64_t draw = attempt * kFocusAttempts * 4;
         random_unit(seed, k, draw) < params.share; draw += 4) {
      if (draw >= (attempt + 1) * kFocusAttempts * 4) break;
      const double which = random_unit(seed, k, draw + 1);
      const Vec2 focus =
          focus_points[static_cast<std::size_t>(which * static_cast<double>(focus_points.size()))];
      const double distance = params.radius * random_unit(seed, k, draw + 2);
      const Vec2 place = focus + distance * unit_at_turns(random_unit(seed, k, draw + 3));
      if (in_box(lattice, place)) return snap(lattice, place);
    }
    return uniform_site(lattice, random_bits(seed ^ 0x9E3779B97F4A7C15u, k, attempt));
  });
}

}  // namespace sunder
