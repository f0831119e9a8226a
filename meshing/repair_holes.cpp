// SPDX-License-Identifier: GPL-3.0-or-later
// Holes after P. Liepa, "Filling holes in meshes", 2003: of all triangulations of the loop the one
// whose sharpest bend is least, then of least area, by dynamic programming.
#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "meshing/repair_draft.hpp"
#include "meshing/surface_edges.hpp"

namespace sunder {
namespace {

using Loop = std::vector<std::uint32_t>;
using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

// Bend (1 - cos of the angle between normals), then area, m².
using Cost = std::pair<double, double>;
constexpr double kForbidden = 3;  // bends are at most 2

// The least triangulation of one loop.
class HoleFiller {
 public:
  HoleFiller(const TriMesh& mesh, const Loop& loop, const std::map<DirectedEdge, Vec3>& normals)
      : mesh_(mesh), loop_(loop), normals_(normals), size_(loop.size()) {
    best_.resize(size_ * size_);
    middle_.resize(size_ * size_);
  }

  std::vector<Corners> fill() {
    for (std::size_t span = 2; span < size_; ++span)
      for (std::size_t i = 0; i + span < size_; ++i) find_best(i, i + span);
    if (best_[size_ - 1].first >= kForbidden) return {};
    std::vector<Corners> triangles;
    collect(0, size_ - 1, triangles);
    return triangles;
  }

 private:
  Vec3 place(std::size_t i) const { return mesh_.vertices[loop_[i]]; }
  std::size_t slot(std::size_t i, std::size_t k) const { return i * size_ + k; }

  Vec3 normal(std::size_t i, std::size_t m, std::size_t k) const {
    const Vec3 n = cross(place(m) - place(i), place(k) - place(i));
    const double size = length(n);
    return size > 0 ? (1 / size) * n : Vec3{};
  }
  // Of what lies over the side i → k: a face of the mesh, or the fill's own.
  Vec3 normal_over(std::size_t i, std::size_t k) const {
    if (k == i + 1 || (i == 0 && k == size_ - 1)) {
      const auto [from, to] =
          k == i + 1 ? std::pair(loop_[k], loop_[i]) : std::pair(loop_[0], loop_[size_ - 1]);
      const auto found = normals_.find({from, to});
      return found == normals_.end() ? Vec3{} : found->second;
    }
    return normal(i, middle_[slot(i, k)], k);
  }

  void find_best(std::size_t i, std::size_t k) {
    const bool is_last = i == 0 && k == size_ - 1;
    Cost& best = best_[slot(i, k)];
    best = {std::numeric_limits<double>::infinity(), 0};
    const bool exists = !is_last && (normals_.contains({loop_[i], loop_[k]}) ||
                                     normals_.contains({loop_[k], loop_[i]}));
    for (std::size_t m = i + 1; m < k; ++m) {
      const Vec3 n = normal(i, m, k);
      const Cost &left = best_[slot(i, m)], &right = best_[slot(m, k)];
      double bend = std::max(left.first, right.first);
      bend = std::max({bend, 1 - dot(n, normal_over(i, m)), 1 - dot(n, normal_over(m, k))});
      if (is_last) bend = std::max(bend, 1 - dot(n, normal_over(i, k)));
      if (exists || is_flat(place(i), place(m), place(k))) bend = kForbidden;
      const double area = 0.5 * length(cross(place(m) - place(i), place(k) - place(i)));
      const Cost cost{bend, left.second + right.second + area};
      if (cost >= best) continue;
      best = cost;
      middle_[slot(i, k)] = static_cast<std::uint32_t>(m);
    }
  }

  void collect(std::size_t i, std::size_t k, std::vector<Corners>& triangles) const {
    std::vector<std::pair<std::size_t, std::size_t>> stack{{i, k}};
    while (!stack.empty()) {
      std::tie(i, k) = stack.back();
      stack.pop_back();
      if (k < i + 2) continue;
      const std::size_t m = middle_[slot(i, k)];
      triangles.push_back({loop_[i], loop_[m], loop_[k]});
      stack.emplace_back(i, m);
      stack.emplace_back(m, k);
    }
  }

  const TriMesh& mesh_;
  const Loop& loop_;
  const std::map<DirectedEdge, Vec3>& normals_;
  std::size_t size_;
  std::vector<Cost> best_;
  std::vector<std::uint32_t> middle_;
};

// Edges that faces beside the mesh's would have to run along, with the fan each of them ends in.
struct OpenEdge {
  std::uint32_t from = 0, to = 0;
  std::uint32_t fan_from = 0, fan_to = 0;
};

std::vector<OpenEdge> open_edges(const TriMesh& mesh) {
  const auto uses = edge_uses(mesh.triangles, std::vector<bool>(mesh.triangles.size(), true));
  const auto fans = find_fans(mesh.triangles, uses);
  const auto fan_at = [&](std::uint32_t t, std::uint32_t v) {
    std::uint32_t k = 0;
    while (mesh.triangles[t][k] != v) ++k;
    return fans[3 * t + k];
  };
  std::vector<OpenEdge> open;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    const auto forward = std::ranges::count(edge, true, &EdgeUse::forward);
    auto excess = 2 * forward - static_cast<std::ptrdiff_t>(edge.size());
    for (const EdgeUse& use : edge) {
      if (excess == 0 || use.forward != (excess > 0)) continue;
      excess += use.forward ? -1 : 1;
      const auto [from, to] =
          use.forward ? std::pair(use.high, use.low) : std::pair(use.low, use.high);
      open.push_back({from, to, fan_at(use.triangle, from), fan_at(use.triangle, to)});
    }
  });
  return open;
}

bool is_one_face(const TriMesh& mesh, const Loop& loop) {
  return loop.size() == 3 && std::ranges::any_of(mesh.triangles, [&](const Corners& t) {
           return std::is_permutation(t.begin(), t.end(), loop.begin());
         });
}

}  // namespace

std::vector<Loop> open_loops(const TriMesh& mesh) {
  const std::vector<OpenEdge> edges = open_edges(mesh);
  std::multimap<std::uint32_t, std::size_t> from;
  for (std::size_t e = 0; e < edges.size(); ++e) from.emplace(edges[e].from, e);
  std::vector<Loop> loops;
  while (!from.empty()) {
    // Walks on, around the fan it came by where it can, and cuts a loop off where it meets itself.
    std::vector<std::size_t> path;
    std::set<std::uint32_t> on_path;
    const auto take = [&](std::multimap<std::uint32_t, std::size_t>::iterator it) {
      path.push_back(it->second);
      on_path.insert(it->first);
      from.erase(it);
    };
    take(from.begin());
    while (!path.empty()) {
      const OpenEdge& last = edges[path.back()];
      if (on_path.contains(last.to)) {
        Loop loop;
        bool is_done = false;
        while (!is_done) {
          const std::uint32_t v = edges[path.back()].from;
          loop.push_back(v);
          on_path.erase(v);
          path.pop_back();
          is_done = v == last.to;
        }
        std::reverse(loop.begin(), loop.end());
        loops.push_back(std::move(loop));
        continue;
      }
      const auto [begin, end] = from.equal_range(last.to);
      assert(begin != end);  // as many open edges leave a vertex as come to it
      const auto same = std::find_if(
          begin, end, [&](const auto& it) { return edges[it.second].fan_from == last.fan_to; });
      take(same != end ? same : begin);
    }
  }
  return loops;
}

void fill_holes(Draft& draft) {
  std::map<DirectedEdge, Vec3> normals;
  ModelSurface& s = draft.surface;
  const auto know = [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k)
      normals[{s.mesh.triangles[t][k], s.mesh.triangles[t][(k + 1) % 3]}] = face_normal(s.mesh, t);
  };
  const std::vector<Loop> loops = open_loops(s.mesh);
  if (loops.empty()) return;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) know(t);
  std::uint64_t count = 0, edges = 0;
  for (const Loop& loop : loops) {
    if (loop.size() < 3 || loop.size() > kMostHoleEdges || is_one_face(s.mesh, loop)) continue;
    const auto fill = HoleFiller(s.mesh, loop, normals).fill();
    for (const Corners& t : fill) {
      s.mesh.triangles.push_back(t);
      s.corners.resize(s.corners.size() + 3);
      s.material.push_back(0);
      draft.is_new.push_back(true);
      know(s.mesh.triangles.size() - 1);
    }
    count += !fill.empty();
    edges += fill.empty() ? 0 : loop.size();
  }
  if (count > 0)
    draft.steps.push_back(counted(count, "hole", "holes") + " of " + std::to_string(edges) +
                          " edges" + (count > 1 ? " together" : "") + " filled");
}

}  // namespace sunder
