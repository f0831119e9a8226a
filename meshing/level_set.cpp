// SPDX-License-Identifier: GPL-3.0-or-later
// Signs by winding numbers: A. Jacobson, L. Kavan and O. Sorkine-Hornung, "Robust inside-outside
// segmentation using generalized winding numbers", 2013, asked once per region that distances prove
// to be on one side. The sound surface is linear interpolation in Kuhn's six tetrahedra of a cell.
#include "meshing/level_set.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "meshing/error.hpp"
#include "meshing/level_set_module.hpp"
#include "meshing/surface_edges.hpp"

namespace sunder {
namespace {

using Place = std::array<std::int32_t, 3>;

// No value is nearer to 0, so that no vertex of the surface falls on a lattice point.
constexpr float kLeast = 1e-3f;
// What is nearer lies on the surface, where winding numbers jump.
constexpr float kOnSurface = 1e-4f;

float off_zero(float value) {
  return value < 0 ? std::min(value, -kLeast) : std::max(value, kLeast);
}

double area(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += 0.5 * length(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]],
                              mesh.vertices[t[2]] - mesh.vertices[t[0]]));
  return sum;
}

void refuse(double voxels, double voxel) {
  if (voxels <= kMostVoxels) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "a level set with voxels of %.3g m would take about %.3g of them, more than %.3g; a "
      "larger max_error takes fewer",
      voxel, voxels, kMostVoxels);
  throw Error(ErrorCode::geometry, text);
}

// Calls visit(i, k) for each pair of values at lattice points that differ by `step`; i ascends.
template <class Visit>
void for_neighbours(const std::vector<VoxelValue>& values, Place step, Visit visit) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Place to{values[i].at[0] + step[0], values[i].at[1] + step[1], values[i].at[2] + step[2]};
    while (k < values.size() && values[k].at < to) ++k;
    if (k < values.size() && values[k].at == to) visit(i, k);
  }
}

// Whether p, or with `about` > 0 a point of eight that far beside it along each axis, is inside. A
// point on a solid's surface is inside by that, so that edges along the lattice stay sharp; one on
// a sheet is not.
bool is_inside(const TriangleTree& tree, Vec3 p, double about) {
  if (about == 0) return tree.winding_number(p) > 0.5;
  for (int c = 0; c < 8; ++c) {
    const Vec3 beside{c & 1 ? about : -about, c & 2 ? about : -about, c & 4 ? about : -about};
    if (tree.winding_number(p + beside) > 0.5) return true;
  }
  return false;
}

// Gives unsigned distances the sign of their side.
void set_signs(LevelSet& set, const TriMesh& closed) {
  ParitySets sides(set.values.size());
  for (const Place step : {Place{0, 0, 1}, Place{0, 1, 0}, Place{1, 0, 0}})
    for_neighbours(set.values, step, [&](std::size_t i, std::size_t k) {
      // A ball without surface around one holds the other.
      if (std::max(set.values[i].value, set.values[k].value) > 1.001f)
        sides.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));
    });
  // Asked at the point of each region that is farthest from the surface.
  std::vector<std::uint32_t> farthest(set.values.size(), ~0u);
  for (std::uint32_t i = 0; i < set.values.size(); ++i) {
    std::uint32_t& best = farthest[sides.find(i).root];
    if (best == ~0u || set.values[i].value > set.values[best].value) best = i;
  }
  const TriangleTree tree(closed);
  std::vector<bool> inside(set.values.size());
  for (std::uint32_t i = 0; i < set.values.size(); ++i)
    if (farthest[i] != ~0u)
      inside[i] = is_inside(tree, set.place(set.values[farthest[i]].at),
                            set.values[farthest[i]].value > kOnSurface ? 0 : set.voxel / 8);
  for (std::uint32_t i = 0; i < set.values.size(); ++i) {
    float& value = set.values[i].value;
    value = off_zero(inside[sides.find(i).root] ? -std::max(value, kLeast) : value);
  }
}

void sort_by_place(std::vector<VoxelValue>& values) {
  std::sort(values.begin(), values.end(),
            [](const VoxelValue& a, const VoxelValue& b) { return a.at < b.at; });
}

// The surface in the tetrahedra of a lattice. A vertex is known by the lattice edge it is on.
class TetrahedraSurface {
 public:
  explicit TetrahedraSurface(const LevelSet& set) : set_(set) {
    for (std::uint32_t c = 1; c < 8; ++c) {
      neighbours_[c].assign(set.values.size(), kNone);
      for_neighbours(
          set.values, {int(c & 1), int(c >> 1 & 1), int(c >> 2)},
          [&](std::size_t i, std::size_t k) { neighbours_[c][i] = static_cast<std::uint32_t>(k); });
    }
  }

  TriMesh mesh() {
    for (std::uint32_t i = 0; i < set_.values.size(); ++i) add_cell(i);
    number_vertices();
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  using Edge = std::array<std::uint32_t, 2>;  // inside, outside

  void add_cell(std::uint32_t first) {
    // Kuhn: along each order of the axes from corner 0 to corner 7, with its handedness.
    static constexpr std::uint32_t kPaths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
    std::array<std::uint32_t, 8> corners{first};
    int inside = set_.values[first].value < 0;
    for (std::uint32_t c = 1; c < 8; ++c) {
      corners[c] = neighbours_[c][first];
      if (corners[c] == kNone) return;
      inside += set_.values[corners[c]].value < 0;
    }
    if (inside == 0 || inside == 8) return;
    for (const auto& path : kPaths)
      add_tetrahedron({corners[0], corners[path[0]], corners[path[1]], corners[7]});
  }

  // Right-handed: (b - a) × (c - a) · (d - a) > 0.
  void add_tetrahedron(std::array<std::uint32_t, 4> t) {
    const auto is_inside = [&](std::uint32_t i) { return set_.values[i].value < 0; };
    // Even turns that bring the inner corners first keep the hand.
    static constexpr std::array<std::uint32_t, 4> kTurns[12] = {
        {0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2}, {1, 2, 0, 3}, {1, 3, 2, 0},
        {2, 0, 1, 3}, {2, 1, 3, 0}, {2, 3, 0, 1}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 2, 1, 0}};
    const auto inner = std::count_if(t.begin(), t.end(), is_inside);
    if (inner == 0 || inner == 4) return;
    for (const auto& turn : kTurns) {
      const std::array<std::uint32_t, 4> u{t[turn[0]], t[turn[1]], t[turn[2]], t[turn[3]]};
      if (!std::is_partitioned(u.begin(), u.end(), is_inside)) continue;
      if (inner == 1) return add(Edge{u[0], u[1]}, Edge{u[0], u[2]}, Edge{u[0], u[3]});
      if (inner == 3) return add(Edge{u[0], u[3]}, Edge{u[1], u[3]}, Edge{u[2], u[3]});
      add(Edge{u[0], u[2]}, Edge{u[0], u[3]}, Edge{u[1], u[3]});
      return add(Edge{u[0], u[2]}, Edge{u[1], u[3]}, Edge{u[1], u[2]});
    }
  }

  void add(Edge a, Edge b, Edge c) { corners_.insert(corners_.end(), {a, b, c}); }

  void number_vertices() {
    std::vector<Edge> edges = corners_;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const Edge& e : edges) {
      const VoxelValue &in = set_.values[e[0]], &out = set_.values[e[1]];
      // Away from both ends by more than rounding takes.
      const double share =
          std::clamp(double(in.value) / (double(in.value) - double(out.value)), 1e-3, 1 - 1e-3);
      const Vec3 from = set_.place(in.at), to = set_.place(out.at);
      mesh_.vertices.push_back(from + share * (to - from));
    }
    const auto index = [&](const Edge& e) {
      return static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), e) -
                                        edges.begin());
    };
    for (std::size_t i = 0; i < corners_.size(); i += 3)
      mesh_.triangles.push_back(
          {index(corners_[i]), index(corners_[i + 1]), index(corners_[i + 2])});
  }

  const LevelSet& set_;
  std::array<std::vector<std::uint32_t>, 8> neighbours_;
  std::vector<Edge> corners_;
  TriMesh mesh_;
};

void turn_over(TriMesh& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace

LevelSet level_set(const TriMesh& closed, double voxel, int threads) {
  assert(!closed.triangles.empty() && voxel > 0);
  refuse(area(closed) / (voxel * voxel) * 2 * LevelSet::kBand, voxel);
  LevelSet set{voxel, box_of(closed).low, {}};
  TriMesh on_lattice = closed;
  for (Vec3& p : on_lattice.vertices) p = (1 / voxel) * (p - set.origin);
  set.values = level_set_module().distances(on_lattice, LevelSet::kBand, threads);
  refuse(static_cast<double>(set.values.size()), voxel);
  sort_by_place(set.values);
  set_signs(set, closed);
  return set;
}

void take_away(LevelSet& set, const Box3& box, const std::function<double(Vec3)>& distance) {
  const auto lattice = [&](Vec3 p, double more) {
    const Vec3 q = (1 / set.voxel) * (p - set.origin);
    return Place{static_cast<std::int32_t>(std::floor(q.x + more)),
                 static_cast<std::int32_t>(std::floor(q.y + more)),
                 static_cast<std::int32_t>(std::floor(q.z + more))};
  };
  const Place low = lattice(box.low, -LevelSet::kBand),
              high = lattice(box.high, LevelSet::kBand + 1);
  double count = 1;
  for (std::size_t k = 0; k < 3; ++k) count *= high[k] - low[k] + 1;
  refuse(count, set.voxel);
  // Between the band's values along a line the sign stays that of the last.
  std::vector<VoxelValue> cut;
  for (Place at = low; at[0] <= high[0]; ++at[0])
    for (at[1] = low[1]; at[1] <= high[1]; ++at[1]) {
      auto next =
          std::lower_bound(set.values.begin(), set.values.end(), Place{at[0], at[1], INT32_MIN},
                           [](const VoxelValue& v, const Place& p) { return v.at < p; });
      float between = LevelSet::kBand;
      for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
        for (; next != set.values.end() && next->at < at; ++next)
          if (next->at[0] == at[0] && next->at[1] == at[1])
            between = std::copysign(LevelSet::kBand, next->value);
        const bool is_given = next != set.values.end() && next->at == at;
        const auto hollow = static_cast<float>(
            std::min<double>(-distance(set.place(at)) / set.voxel, LevelSet::kBand));
        const float value = std::max(is_given ? next->value : between, hollow);
        if (is_given)
          next->value = off_zero(value);
        else if (std::abs(value) < LevelSet::kBand)
          cut.push_back({at, off_zero(value)});
      }
    }
  set.values.insert(set.values.end(), cut.begin(), cut.end());
  sort_by_place(set.values);
}

TriMesh smooth_surface(const LevelSet& set, int threads) {
  const auto made = level_set_module().quads(set.values, LevelSet::kBand, threads);
  TriMesh mesh;
  for (const Vec3 p : made.vertices) mesh.vertices.push_back(set.origin + set.voxel * p);
  for (const auto& q : made.quads) {
    const Vec3 d = mesh.vertices[q[2]] - mesh.vertices[q[0]];
    const Vec3 e = mesh.vertices[q[3]] - mesh.vertices[q[1]];
    const std::uint32_t first = dot(d, d) <= dot(e, e) ? 0 : 1;
    mesh.triangles.push_back({q[first], q[first + 1], q[first + 2]});
    mesh.triangles.push_back({q[first], q[first + 2], q[(first + 3) % 4]});
  }
  if (mass_properties(mesh).volume < 0) turn_over(mesh);
  return mesh;
}

TriMesh sound_surface(const LevelSet& set) {
  return TetrahedraSurface(set).mesh();
}

}  // namespace sunder
