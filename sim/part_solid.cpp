// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "meshing/trig.hpp"
#include "sim/frame.hpp"

namespace sunder {
namespace {

constexpr double kLoadGravity = 9.81;  // m/s² by which a live load becomes mass
constexpr std::uint32_t kRoundCorners = 12;
constexpr Vec3 kUp{0, 1, 0};

Vec3 unit(Vec3 v) {
  return (1 / length(v)) * v;
}

/// Half sizes of a section along its y and z.
Vec2 half_size(const Section& section) {
  if (section.shape == "chs") return {section.height / 2, section.height / 2};
  return {section.width / 2, section.height / 2};
}

/// How far a member's bounding rectangle (a round one's circle) reaches from its axis.
double half_extent(const Frame& frame, const FrameMember& member, Vec3 direction) {
  const Axes axes = axes_of(frame, member);
  const Section& section = frame.sections[member.section];
  const Vec2 half = half_size(section);
  const Vec2 across{half.x * dot(axes.y, direction), half.y * dot(axes.z, direction)};
  return section.shape == "chs" ? length(across) : std::fabs(across.x) + std::fabs(across.y);
}

/// Half the diagonal of a member's bounding rectangle.
double half_diagonal(const Frame& frame, const FrameMember& member) {
  const Section& section = frame.sections[member.section];
  return section.shape == "chs" ? section.height / 2 : length(half_size(section));
}

double top_of(const Frame& frame, const FrameSlab& slab) {
  double node = frame.nodes[slab.nodes[0]].position.y, deepest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    node = std::max(node, frame.nodes[slab.nodes[i]].position.y);
    deepest = std::max(deepest, half_extent(frame, frame.members[slab.beams[i]], kUp));
  }
  return node + deepest + slab.thickness;
}

/// What a part must make room for.
class Neighbours {
 public:
  explicit Neighbours(const Frame& frame);
  /// Posts that end at the node.
  std::span<const std::uint32_t> posts_at(std::uint32_t node) const {
    return {posts_.data() + begin_[node], posts_.data() + begin_[node + 1]};
  }
  /// Height of the floor on a beam, -infinity if it carries none.
  double floor_on(std::uint32_t beam) const { return floor_[beam]; }

 private:
  std::vector<std::uint32_t> begin_, posts_;
  std::vector<double> floor_;
};

Neighbours::Neighbours(const Frame& frame)
    : begin_(frame.nodes.size() + 1, 0),
      floor_(frame.members.size(), -std::numeric_limits<double>::infinity()) {
  const auto is_post = [](const FrameMember& m) { return m.kind == FrameMember::Kind::post; };
  for (const FrameMember& m : frame.members) {
    if (!is_post(m)) continue;
    ++begin_[m.from + 1];
    ++begin_[m.to + 1];
  }
  for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
  posts_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t m = 0; m < frame.members.size(); ++m) {
    if (!is_post(frame.members[m])) continue;
    posts_[next[frame.members[m].from]++] = m;
    posts_[next[frame.members[m].to]++] = m;
  }
  for (const FrameSlab& slab : frame.slabs) {
    const double top = top_of(frame, slab);
    for (const std::uint32_t beam : slab.beams) floor_[beam] = std::max(floor_[beam], top);
  }
}

/// [low, high] without a gap at each end; where nothing remains, its middle half.
struct Span {
  double low = 0, high = 0;
  double middle() const { return (low + high) / 2; }
  double size() const { return high - low; }
};
Span shortened(Span whole, double low_gap, double high_gap) {
  if (whole.size() - low_gap - high_gap < kJointGap) low_gap = high_gap = whole.size() / 4;
  return {whole.low + low_gap, whole.high - high_gap};
}

Loop box_loop(Vec2 half) {
  return rectangle({2 * half.x, 2 * half.y}, {-half.x, -half.y});
}

Loop hull_of(const Section& section) {
  if (section.shape != "chs") return box_loop(half_size(section));
  Loop hull;
  for (std::uint32_t i = 0; i < kRoundCorners; ++i) {
    hull.push_back(section.height / 2 * unit_at_turns(double{1} * i / kRoundCorners));
  }
  return hull;
}

/// Second moments about the centroid by area, m²: of x², y² and x y; sizes in metres.
struct Spread {
  double xx = 0, yy = 0, xy = 0;
};

/// Moments of inertia of a prism of length 2 `half_length` along z.
SymMat3 prism_inertia(double mass, const Spread& spread, double half_length) {
  const double along = half_length * half_length / 3;
  return {.xx = mass * (spread.yy + along),
          .yy = mass * (spread.xx + along),
          .zz = mass * (spread.xx + spread.yy),
          .xy = -mass * spread.xy};
}

/// Where a beam begins, from its node on: behind the faces of the posts there.
double start_of(const Frame& frame, const Neighbours& near, const FrameMember& beam,
                std::uint32_t node) {
  const Vec3 x = axes_of(frame, beam).x;
  const double level = std::max(std::hypot(x.x, x.z), 1e-9);
  const Vec3 away{x.x / level, 0, x.z / level};
  double face = 0;
  for (const std::uint32_t post : near.posts_at(node)) {
    face = std::max(face, half_extent(frame, frame.members[post], away));
  }
  return face / level + kJointGap;
}

PartSolid member_solid(const Frame& frame, const Neighbours& near, const FrameMember& member) {
  const Section& section = frame.sections[member.section];
  const Axes axes = axes_of(frame, member);
  const double full = frame.length(member);
  Span span{0, full};
  if (member.kind == FrameMember::Kind::beam) {
    span = shortened(span, start_of(frame, near, member, member.from),
                     start_of(frame, near, member, member.to));
  }
  PartSolid solid;
  solid.outline = outline_of(section);
  solid.hull = hull_of(section);
  solid.half_length = span.size() / 2;
  solid.centre = frame.nodes[member.from].position + span.middle() * axes.x;
  solid.axes = {axes.y, axes.z, axes.x};
  solid.mass = frame.steels[member.steel].density * section.area * full;
  solid.inertia = prism_inertia(
      solid.mass, {section.iz / section.area, section.iy / section.area, 0}, solid.half_length);
  solid.material = "steel";
  return solid;
}

/// The side of the line through `at` that `normal` points to, of a convex counter-clockwise loop.
Loop clipped(const Loop& loop, Vec2 at, Vec2 normal) {
  Loop result;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 a = loop[i], b = loop[i + 1 == loop.size() ? 0 : i + 1];
    const double side_a = dot(a - at, normal), side_b = dot(b - at, normal);
    if (side_a >= 0) result.push_back(a);
    if ((side_a > 0 && side_b < 0) || (side_a < 0 && side_b > 0)) {
      result.push_back(a + (side_a / (side_a - side_b)) * (b - a));
    }
  }
  return result;
}

Vec2 centroid(const Loop& loop) {
  Vec2 sum;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec2 a = loop[i] - loop[0], b = loop[i + 1] - loop[0];
    sum = sum + cross(a, b) / 6 * (a + b);
  }
  return loop[0] + 1 / area(loop) * sum;
}

/// Of a loop about the origin, which is its centroid.
Spread spread_of(const Loop& loop) {
  Spread sum;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 a = loop[i], b = loop[i + 1 == loop.size() ? 0 : i + 1];
    const double twice = cross(a, b);
    sum.xx += twice * (a.x * a.x + a.x * b.x + b.x * b.x) / 12;
    sum.yy += twice * (a.y * a.y + a.y * b.y + b.y * b.y) / 12;
    sum.xy += twice * (2 * a.x * a.y + a.x * b.y + b.x * a.y + 2 * b.x * b.y) / 24;
  }
  const double size = area(loop);
  return {sum.xx / size, sum.yy / size, sum.xy / size};
}

/// A corner of a slab: the node in plan and how far posts reach around it.
struct Corner {
  Vec2 node;
  double clear = 0;
};

/// The bay, counter-clockwise, `kJointGap` short all around and with its corners cut.
Loop slab_loop(const std::array<Corner, 4>& corners) {
  Loop loop;
  for (const Corner& c : corners) loop.push_back(c.node);
  const Loop bay = loop;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 here = bay[i], ahead = bay[(i + 1) % 4] - here, behind = bay[(i + 3) % 4] - here;
    const Vec2 along = 1 / length(ahead) * ahead;
    const Vec2 inward{-along.y, along.x};
    loop = clipped(loop, here + kJointGap * inward, inward);
    if (corners[i].clear == 0) continue;
    const Vec2 both = along + 1 / length(behind) * behind;
    const Vec2 into = 1 / length(both) * both;
    loop = clipped(loop, here + (corners[i].clear + kJointGap) * into, into);
  }
  if (loop.size() >= 3 && area(loop) > kJointGap * kJointGap) return loop;
  const Vec2 middle = centroid(bay);
  loop.clear();
  for (const Vec2 p : bay) loop.push_back(middle + 0.5 * (p - middle));
  return loop;
}

PartSolid slab_solid(const Frame& frame, const Neighbours& near, const FrameSlab& slab) {
  const Vec3 origin = frame.nodes[slab.nodes[0]].position;
  const Vec3 side = frame.nodes[slab.nodes[1]].position - origin;
  const Vec3 x = unit({side.x, 0, side.z});
  const Axes axes{x, cross(kUp, x), kUp};
  std::array<Corner, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 from_origin = frame.nodes[slab.nodes[i]].position - origin;
    corners[i].node = {dot(from_origin, axes.x), dot(from_origin, axes.y)};
    for (const std::uint32_t post : near.posts_at(slab.nodes[i])) {
      corners[i].clear = std::max(corners[i].clear, half_diagonal(frame, frame.members[post]));
    }
  }
  Loop bay;
  for (const Corner& c : corners) bay.push_back(c.node);
  if (area(bay) < 0) std::reverse(corners.begin(), corners.end());
  Loop loop = slab_loop(corners);
  const Vec2 middle = centroid(loop);
  for (Vec2& p : loop) p = p - middle;
  const Material& material = frame.materials[slab.material];
  PartSolid solid;
  solid.outline = {loop, {}};
  solid.hull = loop;
  solid.half_length = slab.thickness / 2;
  solid.centre = origin + middle.x * axes.x + middle.y * axes.y;
  solid.centre.y = top_of(frame, slab) - slab.thickness / 2;
  solid.axes = axes;
  solid.mass =
      std::fabs(area(bay)) * (material.density * slab.thickness + slab.live_load / kLoadGravity);
  solid.inertia = prism_inertia(solid.mass, spread_of(loop), solid.half_length);
  solid.material = material.name;
  return solid;
}

/// From the floor on its lower beam to the underside of the upper one.
Span height_of(const Frame& frame, const Neighbours& near, const FrameWall& wall) {
  Span span{frame.nodes[wall.nodes[0]].position.y, frame.nodes[wall.nodes[3]].position.y};
  if (const std::uint32_t lower = wall.edges[0]; lower != kNoPart) {
    span.low =
        std::max(span.low + half_extent(frame, frame.members[lower], kUp), near.floor_on(lower));
  }
  if (const std::uint32_t upper = wall.edges[2]; upper != kNoPart) {
    span.high -= half_extent(frame, frame.members[upper], kUp);
  }
  return shortened(span, kJointGap, kJointGap);
}

PartSolid wall_solid(const Frame& frame, const Neighbours& near, const FrameWall& wall) {
  const Vec3 left = frame.nodes[wall.nodes[0]].position;
  const Vec3 bottom = frame.nodes[wall.nodes[1]].position - left;
  const double bay = std::hypot(bottom.x, bottom.z);
  const Vec3 x{bottom.x / bay, 0, bottom.z / bay};
  const auto face = [&](std::uint32_t post) {
    return kJointGap + (post == kNoPart ? 0 : half_extent(frame, frame.members[post], x));
  };
  const Span along = shortened({0, bay}, face(wall.edges[3]), face(wall.edges[1]));
  const Span up = height_of(frame, near, wall);
  const Material& material = frame.materials[wall.material];
  const Loop loop = box_loop({along.size() / 2, up.size() / 2});
  PartSolid solid;
  solid.outline = {loop, {}};
  solid.hull = loop;
  solid.half_length = wall.thickness / 2;
  solid.centre = left + along.middle() * x;
  solid.centre.y = up.middle();
  solid.axes = {x, kUp, cross(x, kUp)};
  solid.mass = material.density * wall.thickness * area(loop);
  solid.inertia = prism_inertia(solid.mass, spread_of(loop), solid.half_length);
  solid.material = material.name;
  return solid;
}

PartSolid make_solid(const Frame& frame, const Neighbours& near, std::uint32_t part) {
  if (part < frame.slab_part(0)) return member_solid(frame, near, frame.members[part]);
  if (part < frame.wall_part(0)) {
    return slab_solid(frame, near, frame.slabs[part - frame.slab_part(0)]);
  }
  return wall_solid(frame, near, frame.walls[part - frame.wall_part(0)]);
}

}  // namespace

PartSolid solid_of(const Frame& frame, std::uint32_t part) {
  return make_solid(frame, Neighbours(frame), part);
}

std::vector<PartSolid> solids_of(const Frame& frame) {
  const Neighbours near(frame);
  std::vector<PartSolid> solids;
  solids.reserve(frame.part_count());
  for (std::uint32_t part = 0; part < frame.part_count(); ++part) {
    solids.push_back(make_solid(frame, near, part));
  }
  return solids;
}

}  // namespace sunder
