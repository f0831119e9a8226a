// SPDX-License-Identifier: GPL-3.0-or-later
// Exact arithmetic of Voronoi cells. Clipping by the bisectors of sites in rings around the cell,
// up to the security radius: Rycroft, "Voro++", Chaos 19 (2009). The certificate is Delaunay's
// lemma for cells: positive edges that pair up make the cells a Voronoi diagram.
#include <algorithm>
#include <cmath>

#include "fracture/voronoi.hpp"
#include "fracture/voronoi_detail.hpp"

namespace sunder {
namespace {

LatticePoint offset(const Sites& sites, std::uint32_t from, std::uint32_t to) {
  const Site a = sites.points[from], b = sites.points[to];
  return {std::int64_t{b.x} - a.x, std::int64_t{b.y} - a.y};
}

// The box's side as a line relative to a site.
LatticeLine side_line(const Sites& sites, std::uint32_t base, std::uint32_t side) {
  const Site p = sites.points[base];
  switch (side) {
    case 0: return {0, -1, 2 * std::int64_t{p.y}};
    case 1: return {1, 0, 2 * (sites.lattice.width - p.x)};
    case 2: return {0, 1, 2 * (sites.lattice.height - p.y)};
    default: return {-1, 0, 2 * std::int64_t{p.x}};
  }
}

LatticeLine line_to(const Sites& sites, std::uint32_t base, std::int32_t neighbour) {
  return neighbour < 0 ? side_line(sites, base, static_cast<std::uint32_t>(~neighbour))
                       : bisector(offset(sites, base, static_cast<std::uint32_t>(neighbour)));
}

// An edge of usual length measures 2^80 on the finest lattice, 2^20 less for each of the box's
// sides next to it. One 2^18 times as short is looked at again once its ends have coordinates.
constexpr auto kBrief = static_cast<Int128>(kBriefEdge);
constexpr int kBrieferBySide = 20;  // log2

// > 0 when the cell turns left from one edge to the next; exact.
std::int64_t turn(const LatticeLine& p, const LatticeLine& q) {
  return p.a * q.b - q.a * p.b;
}

// Signed length of the edge on `line` from the one before to the one after, times factors above 0:
// the determinant of the three lines. `entry` and `exit` are the turns at its ends. Exact.
Int128 edge_length(const LatticeLine& before, const LatticeLine& line, const LatticeLine& after,
                   std::int64_t entry, std::int64_t exit) {
  return static_cast<Int128>(before.c) * exit - static_cast<Int128>(line.c) * turn(before, after) +
         static_cast<Int128>(after.c) * entry;
}

struct Exact {
  using Line = LatticeLine;
  using Point = LatticeCrossing;
  static Line line(const LatticeLine& l) { return l; }
  static Point meet(const Line& p, const Line& q) { return intersection(p, q); }
  static int side(const Line& line, const Point& point) { return side_of(line, point); }
  // Squared distance from the base, doubled coordinates.
  static double reach(const Point& point) {
    const Vec2 p = rounded(point);
    return 4 * dot(p, p);
  }
};

struct Fast {
  struct Line {
    double a, b, c;
  };
  using Point = Vec2;
  static Line line(const LatticeLine& l) {
    return {static_cast<double>(l.a), static_cast<double>(l.b), static_cast<double>(l.c)};
  }
  static Point meet(const Line& p, const Line& q) {
    const double w = p.a * q.b - q.a * p.b;
    return {(p.c * q.b - q.c * p.b) / w, (p.a * q.c - q.a * p.c) / w};
  }
  static int side(const Line& line, const Point& point) {
    const double value = line.a * point.x + line.b * point.y - line.c;
    return (value > 0) - (value < 0);
  }
  static double reach(const Point& point) { return dot(point, point); }
};

// The convex polygon that is left of the box around one site.
template <class Arithmetic>
class Clipper {
 public:
  using Line = typename Arithmetic::Line;
  using Point = typename Arithmetic::Point;

  Clipper(const Sites& sites, std::uint32_t cell) : sites_(sites), cell_(cell) {
    for (std::int32_t side = 0; side < 4; ++side)
      edges_.push_back({Arithmetic::line(line_to(sites, cell, ~side)), {}, 0, ~side});
    for (int k = 0; k < 4; ++k) set_start(edges_[k], edges_[(k + 3) % 4].line, edges_[k].line);
    measure();
  }

  // A site nearer than this (squared, rounded up) can matter.
  double reach() const { return reach_; }

  // Cuts off what is strictly nearer to the other site, so that a tie leaves no edge of length 0.
  void cut(std::uint32_t other) {
    const LatticePoint d = offset(sites_, cell_, other);
    const double distance = static_cast<double>(d.x) * static_cast<double>(d.x) +
                            static_cast<double>(d.y) * static_cast<double>(d.y);
    if (other == cell_ || distance > reach_) return;
    const Line line = Arithmetic::line(bisector(d));
    sides_.clear();
    for (const Edge& edge : edges_) sides_.push_back(Arithmetic::side(line, edge.start));
    if (std::ranges::find(sides_, 1) == sides_.end()) return;
    replace_outside(line, static_cast<std::int32_t>(other));
    measure();
  }

  Star star() const {
    Star result;
    for (const Edge& edge : edges_) result.push_back(edge.neighbour);
    std::ranges::rotate(result, std::ranges::min_element(result));
    return result;
  }

 private:
  struct Edge {
    Line line;
    Point start;
    double reach;
    std::int32_t neighbour;
  };

  static void set_start(Edge& edge, const Line& before, const Line& line) {
    edge.start = Arithmetic::meet(before, line);
    edge.reach = Arithmetic::reach(edge.start);
  }

  void replace_outside(const Line& line, std::int32_t neighbour) {
    kept_.clear();
    const std::size_t size = edges_.size();
    const auto after = [&](std::size_t k) { return k + 1 == size ? 0 : k + 1; };
    for (std::size_t k = 0; k < size; ++k) {
      const std::size_t end = after(k);
      if (sides_[k] >= 0 && sides_[end] >= 0) continue;
      kept_.push_back(edges_[k]);
      if (sides_[k] > 0) set_start(kept_.back(), line, edges_[k].line);
      if (sides_[end] > 0) {
        kept_.push_back({line, {}, 0, neighbour});
        set_start(kept_.back(), edges_[k].line, line);
      } else if (sides_[end] == 0 && sides_[after(end)] > 0) {
        kept_.push_back({line, edges_[end].start, edges_[end].reach, neighbour});
      }
    }
    edges_.swap(kept_);
  }

  void measure() {
    reach_ = 0;
    for (const Edge& edge : edges_) reach_ = std::max(reach_, edge.reach);
    reach_ *= 1 + 1e-9;  // more than the rounding of any reach
  }

  const Sites& sites_;
  std::uint32_t cell_;
  std::vector<Edge> edges_, kept_;
  std::vector<int> sides_;
  double reach_ = 0;
};

// Whether a star word holds with room to spare; every edge, as that is cheaper than choosing.
bool surely_holds(const Sites& sites, const Stars& stars, std::uint32_t cell) {
  const StarWord word = stars.words[cell];
  const int size = star_size(word);
  const Site site = sites.points[cell];
  LatticeLine lines[10];  // the last, all, the first
  for (int k = 0; k < size; ++k) {
    const std::int64_t other = std::int64_t{cell} + stars.offset[star_code(word, k)];
    const Site q = sites.points[static_cast<std::size_t>(other)];
    lines[k + 1] = bisector({std::int64_t{q.x} - site.x, std::int64_t{q.y} - site.y});
  }
  lines[0] = lines[size];
  lines[size + 1] = lines[1];
  std::int64_t entry = turn(lines[0], lines[1]);
  bool holds = size >= 3;
  for (int k = 1; k <= size; ++k) {
    const std::int64_t exit = turn(lines[k], lines[k + 1]);
    holds &= entry > 0;
    holds &= edge_length(lines[k - 1], lines[k], lines[k + 1], entry, exit) >= kBrief;
    entry = exit;
  }
  return holds;
}

// Visits the buckets of ring r around bucket (i, j).
template <class Visit>
void visit_ring(const Buckets& buckets, std::int64_t i, std::int64_t j, std::int64_t r,
                Visit visit) {
  const std::int64_t left = std::max<std::int64_t>(i - r, 0);
  const std::int64_t right = std::min<std::int64_t>(i + r, buckets.columns - 1);
  for (std::int64_t y = std::max<std::int64_t>(j - r, 0);
       y <= std::min<std::int64_t>(j + r, buckets.rows - 1); ++y) {
    const std::int64_t row = y * buckets.columns;
    if (y == j - r || y == j + r) {
      for (std::int64_t x = left; x <= right; ++x) buckets.visit(row + x, visit);
      continue;
    }
    if (i - r >= 0) buckets.visit(row + i - r, visit);
    if (i + r < buckets.columns) buckets.visit(row + i + r, visit);
  }
}

// Least distance from a site in bucket (i, j) to sites beyond ring r; infinite when there are none.
double distance_beyond(const Buckets& buckets, Site site, std::int64_t i, std::int64_t j,
                       std::int64_t r) {
  double distance = INFINITY;
  const auto consider = [&](bool exists, std::int64_t gap) {
    if (exists) distance = std::min(distance, static_cast<double>(gap));
  };
  consider(i - r > 0, site.x - (i - r) * buckets.width);
  consider(i + r + 1 < buckets.columns, (i + r + 1) * buckets.width - site.x);
  consider(j - r > 0, site.y - (j - r) * buckets.height);
  consider(j + r + 1 < buckets.rows, (j + r + 1) * buckets.height - site.y);
  return distance;
}

template <class Arithmetic>
Star clip_cell(const Sites& sites, const Buckets& buckets, std::uint32_t cell) {
  const Site site = sites.points[cell];
  const std::int64_t i = site.x / buckets.width, j = site.y / buckets.height;
  Clipper<Arithmetic> clipper(sites, cell);
  for (std::int64_t r = 0;; ++r) {
    visit_ring(buckets, i, j, r, [&](std::uint32_t other) { clipper.cut(other); });
    const double beyond = distance_beyond(buckets, site, i, j, r);
    if (beyond * beyond > clipper.reach()) return clipper.star();
  }
}

}  // namespace

Buckets::Buckets(const Sites& sites) {
  if (sites.columns > 0) {
    columns = sites.columns, rows = sites.rows;
    width = sites.cell_width, height = sites.cell_height;
    return;
  }
  const double area =
      static_cast<double>(sites.lattice.width) * static_cast<double>(sites.lattice.height);
  const double side = std::sqrt(1.5 * area / static_cast<double>(sites.points.size()));
  width = height = std::max<std::int64_t>(1, std::llround(side));
  columns = static_cast<std::int32_t>(sites.lattice.width / width + 1);
  rows = static_cast<std::int32_t>(sites.lattice.height / height + 1);
  const auto bucket_of = [&](Site site) { return site.y / height * columns + site.x / width; };
  begin_.assign(static_cast<std::size_t>(std::int64_t{columns} * rows) + 1, 0);
  for (const Site& site : sites.points) ++begin_[bucket_of(site) + 1];
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  order_.resize(sites.points.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t k = 0; k < sites.points.size(); ++k)
    order_[next[bucket_of(sites.points[k])]++] = k;
}

Star clip_cell_fast(const Sites& sites, const Buckets& buckets, std::uint32_t cell) {
  return clip_cell<Fast>(sites, buckets, cell);
}

Star clip_cell_exactly(const Sites& sites, const Buckets& buckets, std::uint32_t cell) {
  return clip_cell<Exact>(sites, buckets, cell);
}

std::vector<std::int32_t> exact_cell(const Sites& sites, std::uint32_t site) {
  Clipper<Exact> clipper(sites, site);
  for (std::uint32_t k = 0; k < sites.points.size(); ++k) clipper.cut(k);
  return clipper.star();
}

std::uint32_t doubtful_cells(const Sites& sites, const Stars& stars, std::uint32_t begin,
                             std::uint32_t end, std::uint32_t* doubtful) {
  std::uint32_t count = 0;
  for (std::uint32_t cell = begin; cell < end; ++cell) {
    doubtful[count] = cell;
    count += stars.is_list(cell) || !surely_holds(sites, stars, cell);
  }
  return count;
}

Verdict certify(const Sites& sites, const Stars& stars, std::uint32_t cell, bool all_edges,
                CloseEdges& close) {
  std::int32_t buffer[8];
  const std::span<const std::int32_t> star = stars.star(cell, buffer);
  const std::size_t size = star.size();
  if (size < 3) return Verdict::wrong;
  LatticeLine before = line_to(sites, cell, star[size - 1]);
  LatticeLine line = line_to(sites, cell, star[0]);
  std::int64_t entry = turn(before, line);
  Verdict verdict = Verdict::good;
  for (std::size_t k = 0; k < size; ++k) {
    const LatticeLine after = line_to(sites, cell, star[k + 1 == size ? 0 : k + 1]);
    const std::int64_t exit = turn(line, after);
    if (entry <= 0) return Verdict::wrong;
    if (all_edges || star[k] < 0 || star[k] > static_cast<std::int32_t>(cell)) {
      const Int128 length = edge_length(before, line, after, entry, exit);
      const int sides = (star[k == 0 ? size - 1 : k - 1] < 0) + (star[k] < 0) +
                        (star[k + 1 == size ? 0 : k + 1] < 0);
      if (length < kBrief >> (kBrieferBySide * sides)) {
        if (length < 0) return Verdict::wrong;
        (length == 0 ? close.ties : close.brief).push_back(star[k]);
        verdict = Verdict::close;
      }
    }
    before = line, line = after, entry = exit;
  }
  return verdict;
}

bool meets(const Sites& sites, const std::int32_t (&generators)[3], std::uint32_t site) {
  const auto base = static_cast<std::uint32_t>(generators[0]);
  const LatticeCrossing point =
      intersection(line_to(sites, base, generators[1]), line_to(sites, base, generators[2]));
  return side_of(bisector(offset(sites, base, site)), point) == 0;
}

Vec2 place_of(const Sites& sites, const std::int32_t (&generators)[3]) {
  const auto base = static_cast<std::uint32_t>(generators[0]);
  const LatticeLine p = line_to(sites, base, generators[1]);
  const LatticeLine q = line_to(sites, base, generators[2]);
  constexpr std::int64_t kSmall = std::int64_t{1} << 50;
  const Vec2 relative =
      generators[2] >= 0 && std::max(p.c, q.c) < kSmall
          ? circle_centre(Double2{static_cast<double>(p.a), static_cast<double>(p.b)},
                          Double2{static_cast<double>(q.a), static_cast<double>(q.b)})
          : rounded(intersection(p, q));
  const Site site = sites.points[base];
  Vec2 place{site.x + relative.x, site.y + relative.y};
  for (const std::int32_t generator : generators) {
    if (generator >= 0) continue;
    switch (~generator) {
      case 0: place.y = 0; break;
      case 1: place.x = static_cast<double>(sites.lattice.width); break;
      case 2: place.y = static_cast<double>(sites.lattice.height); break;
      default: place.x = 0;
    }
  }
  return sites.lattice.to_metres(place);
}

}  // namespace sunder
