// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <unordered_set>

#include "sim/frame.hpp"
#include "sim/frame_numbers.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kMostParts = 200000;
constexpr std::size_t kMostNamed = 5;               // of the parts that are not connected
constexpr double kShortest = 1e-3, kLongest = 1e3;  // m
constexpr double kFarthest = 1e5;                   // m from the origin
constexpr double kFlat = 1e-3;                      // m that a slab or wall may be out of plane
constexpr double kStraight = 1e-6;                  // sine of a corner that is none

std::string metres(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.6g m", value);
  return buffer;
}

class Defects {
 public:
  explicit Defects(const Frame& frame) : frame_(frame) {}

  void add(const std::string& part, const std::string& what) { found_.push_back({part, what}); }
  void check_names();
  void check_nodes();
  void check_members();
  void check_slabs();
  void check_walls();
  void check_joints();
  void check_connection();
  std::vector<FrameDefect> take() { return std::move(found_); }

 private:
  void check_once(const std::string& name, std::unordered_set<std::string_view>& seen);
  void check_length(const FrameMember& member);
  void check_thickness(const std::string& name, double thickness);
  void check_edges(const std::string& name, const std::array<std::uint32_t, 4>& nodes,
                   const std::array<std::uint32_t, 4>& edges);
  void check_plan(const FrameSlab& slab);
  bool is_upright_rectangle(const FrameWall& wall) const;
  bool is_dangling(const FrameJoint& joint) const;
  void add_some(const std::vector<std::uint32_t>& parts, const std::string& what);
  Vec3 at(std::uint32_t node) const { return frame_.nodes[node].position; }

  const Frame& frame_;
  std::vector<FrameDefect> found_;
};

void Defects::check_once(const std::string& name, std::unordered_set<std::string_view>& seen) {
  if (!seen.insert(name).second) add(name, "is a name that occurs twice");
}

void Defects::check_names() {
  std::unordered_set<std::string_view> nodes, parts, joints;
  parts.insert("ground");
  for (const FrameNode& node : frame_.nodes) check_once(node.name, nodes);
  for (std::uint32_t p = 0; p < frame_.part_count(); ++p) check_once(frame_.part_name(p), parts);
  for (const FrameJoint& joint : frame_.joints) check_once(joint.name, joints);
}

void Defects::check_nodes() {
  bool supported = false;
  for (const FrameNode& node : frame_.nodes) {
    supported |= node.support;
    const Vec3 p = node.position;
    const double far = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    if (!std::isfinite(p.x + p.y + p.z)) {
      add(node.name, "has a position that is not finite");
    } else if (far > kFarthest) {
      add(node.name, "is " + metres(far) + " from the origin, more than " + metres(kFarthest));
    }
  }
  if (!supported) add("frame", "has no support");
}

void Defects::check_length(const FrameMember& member) {
  const double length = frame_.length(member);
  if (length < kShortest) {
    add(member.name, "has zero length");
  } else if (length > kLongest) {
    add(member.name, "is " + metres(length) + " long, more than " + metres(kLongest));
  }
}

void Defects::check_members() {
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const FrameMember& member : frame_.members) {
    check_length(member);
    if (!std::isfinite(member.roll)) add(member.name, "has a roll that is not finite");
    if (!pairs.insert(std::minmax(member.from, member.to)).second) {
      add(member.name, "joins the same nodes as another member");
    }
    if (member.kind == FrameMember::Kind::post && at(member.from).y > at(member.to).y) {
      add(member.name, "stands on its head: it must go from the lower node to the upper one");
    }
  }
}

void Defects::check_thickness(const std::string& name, double thickness) {
  if (!(thickness > 0)) {
    add(name, "has no thickness");
  } else if (thickness < kShortest || thickness > kLongest) {
    add(name, "is " + metres(thickness) + " thick, outside " + metres(kShortest) + " to " +
                  metres(kLongest));
  }
}

/// Edge i must join corners i and i + 1.
void Defects::check_edges(const std::string& name, const std::array<std::uint32_t, 4>& nodes,
                          const std::array<std::uint32_t, 4>& edges) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (edges[i] == kNoPart) continue;
    const FrameMember& edge = frame_.members[edges[i]];
    const std::uint32_t a = nodes[i], b = nodes[(i + 1) % 4];
    if ((edge.from == a && edge.to == b) || (edge.from == b && edge.to == a)) continue;
    add(name, edge.name + " does not join its corners " + frame_.nodes[a].name + " and " +
                  frame_.nodes[b].name);
  }
}

/// Level, and a convex quadrilateral in plan.
void Defects::check_plan(const FrameSlab& slab) {
  double low = at(slab.nodes[0]).y, high = low;
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = at(slab.nodes[i]);
    low = std::min(low, p.y);
    high = std::max(high, p.y);
    const Vec3 a = p - at(slab.nodes[(i + 3) % 4]), b = at(slab.nodes[(i + 1) % 4]) - p;
    const double turn = a.z * b.x - a.x * b.z;
    const double straight = kStraight * std::hypot(a.x, a.z) * std::hypot(b.x, b.z);
    left += turn > straight;
    right += turn < -straight;
  }
  if (high - low > kFlat) {
    add(slab.name, "is not flat: its corners differ by " + metres(high - low) + " in height");
  }
  if (left != 4 && right != 4) add(slab.name, "is not convex in plan");
}

void Defects::check_slabs() {
  for (const FrameSlab& slab : frame_.slabs) {
    check_thickness(slab.name, slab.thickness);
    if (!(slab.live_load >= 0) || std::isinf(slab.live_load)) {
      add(slab.name, "has a live load that is negative or not finite");
    }
    check_edges(slab.name, slab.nodes, slab.beams);
    check_plan(slab);
  }
}

bool Defects::is_upright_rectangle(const FrameWall& wall) const {
  const Vec3 left = at(wall.nodes[0]), right = at(wall.nodes[1]);
  const Vec3 up_right = at(wall.nodes[2]) - right, up_left = at(wall.nodes[3]) - left;
  const auto leans = [](Vec3 up) { return std::hypot(up.x, up.z) > kFlat || up.y < kShortest; };
  return std::fabs(right.y - left.y) <= kFlat && std::fabs(up_right.y - up_left.y) <= kFlat &&
         !leans(up_left) && !leans(up_right) &&
         std::hypot(right.x - left.x, right.z - left.z) >= kShortest;
}

void Defects::check_walls() {
  for (const FrameWall& wall : frame_.walls) {
    check_thickness(wall.name, wall.thickness);
    check_edges(wall.name, wall.nodes, wall.edges);
    if (!is_upright_rectangle(wall)) add(wall.name, "is not flat: no upright rectangle");
  }
}

bool Defects::is_dangling(const FrameJoint& joint) const {
  return joint.a >= frame_.part_count() || joint.a == joint.b ||
         (joint.b >= frame_.part_count() && joint.b != kNoPart);
}

void Defects::check_joints() {
  for (const FrameJoint& joint : frame_.joints) {
    if (is_dangling(joint)) add(joint.name, "does not join two parts of the frame");
    const Vec3 f = joint.strength.force, t = joint.strength.torque;
    if (!(f.x > 0 && f.y > 0 && f.z > 0 && t.x > 0 && t.y > 0 && t.z > 0)) {
      add(joint.name, "has no strength: each of the six must be above 0");
    }
  }
}

void Defects::add_some(const std::vector<std::uint32_t>& parts, const std::string& what) {
  const std::size_t named = std::min(kMostNamed, parts.size());
  for (std::size_t i = 0; i < named; ++i) add(frame_.part_name(parts[i]), what);
  if (parts.size() > named) {
    add("frame",
        "has " + std::to_string(parts.size() - named) + " more parts of which each " + what);
  }
}

/// Disjoint sets by joints; the ground is one more part.
void Defects::check_connection() {
  const std::uint32_t ground = frame_.part_count();
  std::vector<std::uint32_t> above(ground + 1), joints(ground + 1, 0);
  for (std::uint32_t p = 0; p <= ground; ++p) above[p] = p;
  const auto root = [&](std::uint32_t p) {
    for (; above[p] != p; p = above[p]) above[p] = above[above[p]];
    return p;
  };
  for (const FrameJoint& joint : frame_.joints) {
    if (is_dangling(joint)) continue;
    const std::uint32_t b = std::min(joint.b, ground);
    ++joints[joint.a];
    ++joints[b];
    above[root(joint.a)] = root(b);
  }
  std::vector<std::uint32_t> alone, adrift;
  for (std::uint32_t p = 0; p < ground; ++p) {
    if (joints[p] == 0) {
      alone.push_back(p);
    } else if (root(p) != root(ground)) {
      adrift.push_back(p);
    }
  }
  add_some(alone, "meets nothing");
  add_some(adrift, "is not connected to the ground");
}

template <class Numbers>
bool all_below(const Numbers& numbers, std::size_t count, bool none_allowed = false) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [&](std::uint32_t n) { return n < count || (none_allowed && n == kNoPart); });
}

}  // namespace

std::vector<FrameDefect> dangling_numbers(const Frame& frame) {
  std::vector<FrameDefect> found;
  const std::size_t nodes = frame.nodes.size(), members = frame.members.size();
  for (const FrameMember& m : frame.members) {
    if (m.from >= nodes || m.to >= nodes) found.push_back({m.name, "ends at no node"});
    if (m.section >= frame.sections.size()) found.push_back({m.name, "has no section"});
    if (m.steel >= frame.steels.size()) found.push_back({m.name, "has no steel grade"});
  }
  for (const FrameSlab& s : frame.slabs) {
    if (!all_below(s.nodes, nodes)) found.push_back({s.name, "has a corner at no node"});
    if (!all_below(s.beams, members)) found.push_back({s.name, "lies on a beam that is not there"});
    if (s.material >= frame.materials.size()) found.push_back({s.name, "has no material"});
  }
  for (const FrameWall& w : frame.walls) {
    if (!all_below(w.nodes, nodes)) found.push_back({w.name, "has a corner at no node"});
    if (!all_below(w.edges, members, true)) {
      found.push_back({w.name, "has an edge on a member that is not there"});
    }
    if (w.material >= frame.materials.size()) found.push_back({w.name, "has no material"});
  }
  return found;
}

std::vector<FrameDefect> defects_of(const Frame& frame) {
  if (frame.part_count() > kMostParts) {
    return {{"frame", "has " + std::to_string(frame.part_count()) + " parts, more than " +
                          std::to_string(kMostParts)}};
  }
  std::vector<FrameDefect> dangling = dangling_numbers(frame);
  if (!dangling.empty()) return dangling;
  Defects defects(frame);
  defects.check_names();
  defects.check_nodes();
  defects.check_members();
  defects.check_slabs();
  defects.check_walls();
  defects.check_joints();
  defects.check_connection();
  return defects.take();
}

}  // namespace sunder
