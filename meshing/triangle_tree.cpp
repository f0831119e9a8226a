// SPDX-License-Identifier: GPL-3.0-or-later
// Nearest point of a triangle: C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5. Solid
// angle: A. van Oosterom and J. Strackee, 1983. Winding numbers: A. Jacobson, L. Kavan and
// O. Sorkine-Hornung, 2013; far parts as dipoles: G. Barill et al., 2018.
#include "meshing/triangle_tree.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numbers>
#include <tuple>

namespace sunder {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A part is far from 2.3 of its radii on (Barill et al. use 2).
constexpr double kFar = 2.3;

void grow(Box3& box, Vec3 p) {
  box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
  box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
}

constexpr Box3 kNothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

double along(Vec3 p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

int longest_axis(const Box3& box) {
  const Vec3 size = box.high - box.low;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

// Weights of the corners in the triangle's point nearest to p.
std::array<double, 3> nearest_weights(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

double solid_angle(Vec3 a, Vec3 b, Vec3 c) {
  const double la = length(a), lb = length(b), lc = length(c);
  return 2 * std::atan2(dot(a, cross(b, c)),
                        la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

}  // namespace

bool Box3::overlaps(const Box3& other) const {
  return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
         other.low.y <= high.y && low.z <= other.high.z && other.low.z <= high.z;
}

double Box3::distance2(Vec3 p) const {
  const Vec3 d{std::max({low.x - p.x, p.x - high.x, 0.0}),
               std::max({low.y - p.y, p.y - high.y, 0.0}),
               std::max({low.z - p.z, p.z - high.z, 0.0})};
  return dot(d, d);
}

Box3 box_of(const TriMesh& mesh) {
  Box3 box = kNothing;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) grow(box, mesh.vertices[v]);
  return mesh.triangles.empty() ? Box3{} : box;
}

TriangleTree::TriangleTree(const TriMesh& mesh, const std::vector<bool>& keep) : mesh_(&mesh) {
  boxes_.assign(mesh.triangles.size(), kNothing);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!keep.empty() && !keep[t]) continue;
    order_.push_back(t);
    for (int k = 0; k < 3; ++k) grow(boxes_[t], corner(t, k));
  }
  nodes_.reserve(order_.size());
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t TriangleTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node{kNothing, begin, end, 0, 0, {}, {}, 0, 0};
  for (std::uint32_t i = begin; i < end; ++i) {
    grow(node.box, boxes_[order_[i]].low);
    grow(node.box, boxes_[order_[i]].high);
  }
  nodes_.push_back(node);
  if (end - begin > kLeafSize) {
    const int axis = longest_axis(node.box);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto key = [&](std::uint32_t t) {
      return std::pair(along(boxes_[t].low, axis) + along(boxes_[t].high, axis), t);
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    node.left = build(begin, middle);
    node.right = build(middle, end);
  }
  summarise(node);
  nodes_[index] = node;
  return index;
}

// Area, normal and centre from the node's triangles or its branches.
void TriangleTree::summarise(Node& node) const {
  Vec3 weighted;
  const auto add = [&](double area, Vec3 normal, Vec3 centre) {
    node.area += area;
    node.normal = node.normal + normal;
    weighted = weighted + area * (centre - node.box.low);
  };
  if (node.left != 0) {
    for (const std::uint32_t branch : {node.left, node.right})
      add(nodes_[branch].area, nodes_[branch].normal, nodes_[branch].centre);
  } else {
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const Vec3 a = corner(order_[i], 0), b = corner(order_[i], 1), c = corner(order_[i], 2);
      const Vec3 n = 0.5 * cross(b - a, c - a);
      add(length(n), n, a + (1.0 / 3) * ((b - a) + (c - a)));
    }
  }
  const Vec3 middle = 0.5 * (node.box.high - node.box.low);
  node.centre = node.box.low + (node.area > 0 ? (1 / node.area) * weighted : middle);
  const Vec3 to_low = node.centre - node.box.low, to_high = node.box.high - node.centre;
  const Vec3 reach{std::max(to_low.x, to_high.x), std::max(to_low.y, to_high.y),
                   std::max(to_low.z, to_high.z)};
  node.radius = length(reach);
}

double TriangleTree::distance2(Vec3 p, std::uint32_t triangle, std::array<double, 3>& w) const {
  const Vec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  w = nearest_weights(p, a, b, c);
  const Vec3 d = p - (a + w[1] * (b - a) + w[2] * (c - a));
  return dot(d, d);
}

TriangleTree::Nearest TriangleTree::nearest(Vec3 p) const {
  assert(!nodes_.empty());
  Nearest best;
  double best2 = kInfinity;
  // A branch leaves one box behind: halves make the tree less than 40 deep.
  std::array<std::pair<double, std::uint32_t>, 64> stack;
  std::size_t size = 0;
  stack[size++] = {nodes_[0].box.distance2(p), 0};
  while (size > 0) {
    const auto [bound, index] = stack[--size];
    if (bound > best2) continue;
    const Node& node = nodes_[index];
    if (node.left == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        std::array<double, 3> weights;
        const double d2 = distance2(p, order_[i], weights);
        if (std::pair(d2, order_[i]) >= std::pair(best2, best.triangle)) continue;
        best2 = d2;
        best = {0, order_[i], weights};
      }
      continue;
    }
    std::pair<double, std::uint32_t> near{nodes_[node.left].box.distance2(p), node.left};
    std::pair<double, std::uint32_t> far{nodes_[node.right].box.distance2(p), node.right};
    if (far < near) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
  best.distance = std::sqrt(best2);
  return best;
}

bool TriangleTree::is_within(Vec3 p, double distance, std::uint32_t triangle) const {
  std::array<double, 3> weights;
  return triangle < boxes_.size() && distance2(p, triangle, weights) <= distance * distance;
}

double TriangleTree::winding_number(Vec3 p) const {
  double angle = 0;
  std::vector<std::uint32_t> stack;
  if (!nodes_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const Node& node = nodes_[stack.back()];
    stack.pop_back();
    const Vec3 to = node.centre - p;
    const double distance = length(to);
    if (distance > kFar * node.radius) {
      angle += dot(node.normal, to) / (distance * distance * distance);
    } else if (node.left == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        angle += solid_angle(corner(order_[i], 0) - p, corner(order_[i], 1) - p,
                             corner(order_[i], 2) - p);
    } else {
      stack.push_back(node.left);
      stack.push_back(node.right);
    }
  }
  return angle / (4 * std::numbers::pi);
}

bool TriangleTree::any_overlapping(
    const std::function<bool(std::uint32_t, std::uint32_t)>& wanted) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack;
  if (!nodes_.empty()) stack.emplace_back(0, 0);
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    const Node &na = nodes_[a], &nb = nodes_[b];
    if (a == b && na.left != 0) {
      stack.insert(stack.end(), {{na.left, na.left}, {na.right, na.right}, {na.left, na.right}});
    } else if (a != b && !na.box.overlaps(nb.box)) {
      continue;
    } else if (na.left != 0 && (nb.left == 0 || na.end - na.begin >= nb.end - nb.begin)) {
      stack.insert(stack.end(), {{na.left, b}, {na.right, b}});
    } else if (nb.left != 0) {
      stack.insert(stack.end(), {{a, nb.left}, {a, nb.right}});
    } else {
      for (std::uint32_t i = na.begin; i < na.end; ++i)
        for (std::uint32_t k = a == b ? i + 1 : nb.begin; k < nb.end; ++k)
          if (boxes_[order_[i]].overlaps(boxes_[order_[k]]) && wanted(order_[i], order_[k]))
            return true;
    }
  }
  return false;
}

std::vector<std::array<std::uint32_t, 2>> TriangleTree::overlapping_boxes() const {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  any_overlapping([&](std::uint32_t a, std::uint32_t b) {
    pairs.push_back({std::min(a, b), std::max(a, b)});
    return false;
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<std::uint32_t> TriangleTree::along_x(Vec3 p) const {
  std::vector<std::uint32_t> found, stack;
  const Box3 ray{p, {kInfinity, p.y, p.z}};
  if (!nodes_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const Node& node = nodes_[stack.back()];
    stack.pop_back();
    if (!node.box.overlaps(ray)) continue;
    if (node.left != 0) {
      stack.push_back(node.left);
      stack.push_back(node.right);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      if (boxes_[order_[i]].overlaps(ray)) found.push_back(order_[i]);
  }
  return found;
}

double farthest(const TriMesh& a, const TriangleTree& b, double spacing) {
  const auto steps_of = [&](const std::array<std::uint32_t, 3>& t, double most) {
    const Vec3 p = a.vertices[t[0]], q = a.vertices[t[1]], r = a.vertices[t[2]];
    const double longest = std::max({length(q - p), length(r - q), length(p - r)});
    return std::max(1.0, std::ceil(longest / most));
  };
  const auto samples = [&] {
    double sum = 0;
    for (const auto& t : a.triangles) {
      const double n = steps_of(t, spacing);
      sum += (n + 1) * (n + 2) / 2;
    }
    return sum;
  };
  while (samples() > kMostSamples && samples() > 3.5 * static_cast<double>(a.triangles.size()))
    spacing *= 2;
  double most = 0;
  std::uint32_t last = ~0u;  // the nearest of the last point: mostly enough to rule one out
  for (const auto& t : a.triangles) {
    const Vec3 p = a.vertices[t[0]], q = a.vertices[t[1]], r = a.vertices[t[2]];
    const int n = static_cast<int>(steps_of(t, spacing));
    for (int i = 0; i <= n; ++i)
      for (int k = 0; i + k <= n; ++k) {
        const double u = static_cast<double>(i) / n, v = static_cast<double>(k) / n;
        const Vec3 at = p + u * (q - p) + v * (r - p);
        if (b.is_within(at, most, last)) continue;
        const auto nearest = b.nearest(at);
        last = nearest.triangle;
        most = std::max(most, nearest.distance);
      }
  }
  return most;
}

}  // namespace sunder
