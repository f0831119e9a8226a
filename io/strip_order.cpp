// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_order.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace sunder {
namespace {

// The best separating plane so far: how far apart it keeps the two, and where the eye is.
struct Separation {
  double gap = -std::numeric_limits<double>::infinity();
  bool is_other_in_front = false;
  void offer(double other_gap, double eye, bool flipped) {
    if (other_gap <= gap) return;
    gap = other_gap;
    is_other_in_front = (eye > 0) != flipped;
  }
};

// Least distance of the other solid's points along `axis` of this one's frame; a sphere's is that
// of its centre less its radius.
struct Others {
  std::vector<Vec3> points;
  double radius = 0;
  double least(Vec3 axis, double offset) const {
    double result = std::numeric_limits<double>::infinity();
    for (const Vec3 p : points) result = std::min(result, dot(p, axis));
    return result - radius - offset;
  }
};

// Faces of `a` as separating planes; `flipped`: a is the second of the pair.
void separate_by_faces(const StripSolid& a, const StripSolid& b, bool flipped, Separation& best) {
  const Pose into = inverse(a.pose);
  Others others{{}, b.outline.empty() ? b.half : 0};
  for (const Vec3 p : b.corners) others.points.push_back(into * p);
  if (a.outline.empty()) {
    const double size = length(others.points[0]);
    if (!b.outline.empty() || size == 0) return;  // the prism's faces decide
    const Vec3 axis = (1 / size) * others.points[0];
    best.offer(others.least(axis, a.half), dot(a.eye, axis) - a.half, flipped);
    return;
  }
  best.offer(others.least({0, 0, 1}, a.half), a.eye.z - a.half, flipped);
  best.offer(others.least({0, 0, -1}, a.half), -a.eye.z - a.half, flipped);
  for (std::size_t i = 0; i < a.outline.size(); ++i) {
    const Vec2 p = a.outline[i], q = a.outline[i + 1 == a.outline.size() ? 0 : i + 1];
    const double size = length(q - p);
    if (size == 0) continue;
    const Vec3 axis{(q.y - p.y) / size, (p.x - q.x) / size, 0};
    const double offset = axis.x * p.x + axis.y * p.y;
    best.offer(others.least(axis, offset), dot(a.eye, axis) - offset, flipped);
  }
}

// Directions of a prism's edges, world.
std::vector<Vec3> edges_of(const StripSolid& solid) {
  std::vector<Vec3> edges = {solid.corners[solid.outline.size()] - solid.corners[0]};
  for (std::size_t i = 0; i < solid.outline.size(); ++i) {
    const std::size_t next = i + 1 == solid.outline.size() ? 0 : i + 1;
    edges.push_back(solid.corners[next] - solid.corners[i]);
  }
  return edges;
}

// Planes along an edge of each.
void separate_by_edges(const StripSolid& a, const StripSolid& b, Separation& best) {
  const Vec3 eye = a.pose * a.eye;
  const std::vector<Vec3> edges = edges_of(b);
  for (const Vec3 p : edges_of(a)) {
    for (const Vec3 q : edges) {
      Vec3 axis = cross(p, q);
      const double size = length(axis);
      if (size <= 1e-6 * length(p) * length(q)) continue;
      // Towards b.
      axis = ((dot(b.corners[0] - a.corners[0], axis) < 0 ? -1 : 1) / size) * axis;
      double a_end = -std::numeric_limits<double>::infinity(), b_begin = -a_end;
      for (const Vec3 corner : a.corners) a_end = std::max(a_end, dot(corner, axis));
      for (const Vec3 corner : b.corners) b_begin = std::min(b_begin, dot(corner, axis));
      best.offer(b_begin - a_end, dot(eye, axis) - 0.5 * (a_end + b_begin), false);
    }
  }
}

bool is_in_front(const StripSolid& of, const StripSolid& solid) {
  Separation best;
  separate_by_faces(of, solid, false, best);
  separate_by_faces(solid, of, true, best);
  if (best.gap < 0 && !of.outline.empty() && !solid.outline.empty()) {
    separate_by_edges(of, solid, best);
  }
  return best.is_other_in_front;
}

// An edge of a that leaves b outside.
bool has_separating_edge(std::span<const Vec2> a, std::span<const Vec2> b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec2 p = a[i], along = a[i + 1 == a.size() ? 0 : i + 1] - p;
    if (std::ranges::all_of(b, [&](Vec2 q) { return cross(along, q - p) <= 0; })) return true;
  }
  return false;
}

bool overlap(const StripSolid& a, const StripSolid& b) {
  const Box &p = a.screen, &q = b.screen;
  if (p.low.x >= q.high.x || q.low.x >= p.high.x) return false;
  if (p.low.y >= q.high.y || q.low.y >= p.high.y) return false;
  return !has_separating_edge(a.silhouette, b.silhouette) &&
         !has_separating_edge(b.silhouette, a.silhouette);
}

// Which solids have to wait for which.
struct Waiting {
  std::vector<std::vector<std::uint32_t>> after;  // painted only after this one
  std::vector<std::uint32_t> count;               // how many it waits for
};

Waiting find_waiting(std::span<const StripSolid> solids) {
  Waiting result{std::vector<std::vector<std::uint32_t>>(solids.size()),
                 std::vector<std::uint32_t>(solids.size(), 0)};
  std::vector<std::uint32_t> by_left(solids.size());
  for (std::uint32_t i = 0; i < by_left.size(); ++i) by_left[i] = i;
  std::ranges::sort(by_left, {},
                    [&](std::uint32_t i) { return std::pair(solids[i].screen.low.x, i); });
  std::vector<std::uint32_t> open;  // whose picture has not ended yet, from left to right
  for (const std::uint32_t i : by_left) {
    const StripSolid& a = solids[i];
    std::erase_if(open, [&](std::uint32_t k) { return solids[k].screen.high.x <= a.screen.low.x; });
    for (const std::uint32_t k : open) {
      const StripSolid& b = solids[k];
      if (a.body == b.body && a.is_flat && b.is_flat) continue;
      if (!overlap(a, b)) continue;
      const bool b_later = is_in_front(a, b);
      result.after[b_later ? i : k].push_back(b_later ? k : i);
      ++result.count[b_later ? k : i];
    }
    open.push_back(i);
  }
  return result;
}

class Painter {
 public:
  explicit Painter(std::span<const StripSolid> solids)
      : solids_(solids), waiting_(find_waiting(solids)), done_(solids.size(), false) {
    for (std::uint32_t i = 0; i < solids.size(); ++i) {
      left_.insert({-solids[i].distance, i});
      if (waiting_.count[i] == 0) add_ready(i);
    }
  }

  std::vector<std::uint32_t> run(std::vector<std::uint32_t>* cut) {
    while (!left_.empty()) {
      std::uint32_t next = ready_.empty() ? left_.begin()->second : ready_.begin()->second;
      if (ready_.empty() && cut) cut->push_back(next = find_in_ring());
      paint(next);
      if (solids_[next].is_flat) paint_flat(solids_[next].body);
    }
    return std::move(order_);
  }

 private:
  using Entry = std::pair<double, std::uint32_t>;  // farthest first
  void add_ready(std::uint32_t i) {
    ready_.insert({-solids_[i].distance, i});
    if (solids_[i].is_flat) flat_[solids_[i].body].push_back(i);
  }
  void paint(std::uint32_t i) {
    done_[i] = true;
    order_.push_back(i);
    left_.erase({-solids_[i].distance, i});
    ready_.erase({-solids_[i].distance, i});
    for (const std::uint32_t k : waiting_.after[i]) {
      if (--waiting_.count[k] == 0 && !done_[k]) add_ready(k);
    }
  }
  // The farthest solid of a ring of solids that hide each other, one the farthest one left waits
  // for.
  std::uint32_t find_in_ring() {
    if (before_.empty()) find_before();
    std::vector<std::uint32_t> way;
    std::map<std::uint32_t, std::size_t> place_on_way;
    std::uint32_t i = left_.begin()->second;
    while (place_on_way.try_emplace(i, way.size()).second) {
      way.push_back(i);
      i = *std::ranges::find_if(before_[i], [this](std::uint32_t k) { return !done_[k]; });
    }
    way.erase(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(place_on_way[i]));
    return *std::ranges::max_element(way, {},
                                     [this](std::uint32_t k) { return solids_[k].distance; });
  }
  void find_before() {
    before_.resize(solids_.size());
    for (std::uint32_t i = 0; i < before_.size(); ++i) {
      for (const std::uint32_t k : waiting_.after[i]) before_[k].push_back(i);
    }
  }
  // All flat solids of the body that are ready, and those that become so.
  void paint_flat(std::uint32_t body) {
    std::vector<std::uint32_t>& list = flat_[body];
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!done_[list[i]]) paint(list[i]);
    }
    list.clear();
  }

  std::span<const StripSolid> solids_;
  Waiting waiting_;
  std::vector<std::vector<std::uint32_t>> before_;  // whom each waits for; filled for rings
  std::vector<bool> done_;
  std::vector<std::uint32_t> order_;
  std::set<Entry> left_, ready_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> flat_;  // ready ones, per body
};

}  // namespace

// Andrew's monotone chain.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::ranges::sort(points, {}, [](Vec2 p) { return std::pair(p.x, p.y); });
  std::vector<Vec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const Vec2 p : points) {
      while (hull.size() >= base + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

std::vector<std::uint32_t> painters_order(std::span<const StripSolid> solids,
                                          std::vector<std::uint32_t>* cut) {
  return Painter(solids).run(cut);
}

}  // namespace sunder
