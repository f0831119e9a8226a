// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/repair_draft.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "meshing/surface_defects.hpp"
#include "meshing/surface_edges.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr int kMostFlatPasses = 20;

std::vector<EdgeUse> all_uses(const TriMesh& mesh) {
  return edge_uses(mesh.triangles, std::vector<bool>(mesh.triangles.size(), true));
}

void use_vertices(Draft& draft, const std::vector<std::uint32_t>& instead) {
  for (Corners& t : draft.mesh().triangles)
    for (std::uint32_t& v : t) v = instead[v];
}

std::uint64_t drop_equal_corners(Draft& draft) {
  std::vector<bool> keep;
  for (const Corners& t : draft.mesh().triangles)
    keep.push_back(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
  keep_triangles(draft, keep);
  return static_cast<std::uint64_t>(std::count(keep.begin(), keep.end(), false));
}

std::uint64_t drop_duplicates(Draft& draft) {
  std::vector<std::pair<Corners, std::uint32_t>> order;
  for (std::uint32_t t = 0; t < draft.mesh().triangles.size(); ++t) {
    Corners c = draft.mesh().triangles[t];
    std::sort(c.begin(), c.end());
    order.emplace_back(c, t);
  }
  std::sort(order.begin(), order.end());
  std::vector<bool> keep(order.size(), true);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (order[i].first == order[i - 1].first) keep[order[i].second] = false;
  keep_triangles(draft, keep);
  return static_cast<std::uint64_t>(std::count(keep.begin(), keep.end(), false));
}

void drop_doubles(Draft& draft) {
  if (const auto count = drop_equal_corners(draft); count > 0)
    draft.steps.push_back(counted(count, "face", "faces") + " with two equal corners dropped");
  if (const auto count = drop_duplicates(draft); count > 0)
    draft.steps.push_back(counted(count, "duplicate face", "duplicate faces") + " dropped");
}

std::string metres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g m", value);
  return text;
}

Corner between(const Corner& a, const Corner& b, double share) {
  const auto s = static_cast<float>(share);
  Corner c;
  float size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    c.normal[i] = a.normal[i] + s * (b.normal[i] - a.normal[i]);
    size += c.normal[i] * c.normal[i];
  }
  if (size > 0)
    for (float& n : c.normal) n /= std::sqrt(size);
  for (std::size_t i = 0; i < 2; ++i) c.uv[i] = a.uv[i] + s * (b.uv[i] - a.uv[i]);
  for (std::size_t i = 0; i < 4; ++i) c.colour[i] = a.colour[i] + s * (b.colour[i] - a.colour[i]);
  return c;
}

// Cuts triangle t from its corner opposite to edge k at vertex `at`, which lies on the edge.
void cut_edge(Draft& draft, std::uint32_t t, std::size_t k, std::uint32_t at) {
  ModelSurface& s = draft.surface;
  const std::size_t k1 = (k + 1) % 3;
  const Vec3 a = s.mesh.vertices[s.mesh.triangles[t][k]];
  const Vec3 b = s.mesh.vertices[s.mesh.triangles[t][k1]];
  const double share = length(s.mesh.vertices[at] - a) / length(b - a);
  const Corner corner = between(s.corners[3 * t + k], s.corners[3 * t + k1], share);
  Corners second = s.mesh.triangles[t];
  std::array<Corner, 3> second_corners{s.corners[3 * t], s.corners[3 * t + 1],
                                       s.corners[3 * t + 2]};
  second[k] = at;
  second_corners[k] = corner;
  s.mesh.triangles[t][k1] = at;
  s.corners[3 * t + k1] = corner;
  s.mesh.triangles.push_back(second);
  s.corners.insert(s.corners.end(), second_corners.begin(), second_corners.end());
  s.material.push_back(s.material[t]);
  draft.is_new.push_back(draft.is_new[t]);
}

// A face without area: its corner between the others, and what lies over its longest edge. No face
// if it has an area, or more than one neighbour there.
struct FlatFace {
  std::uint32_t face = kNone, middle = 0, neighbour = kNone;
  std::size_t edge = 0;  // of the neighbour
};
FlatFace find_flat(const TriMesh& mesh, std::uint32_t t, std::span<const EdgeUse> uses) {
  const Corners& c = mesh.triangles[t];
  const auto place = [&](std::size_t k) { return mesh.vertices[c[k % 3]]; };
  if (!is_flat(place(0), place(1), place(2))) return {};
  std::size_t k = 0;  // of the longest edge
  for (std::size_t i = 1; i < 3; ++i)
    if (length(place(i + 1) - place(i)) > length(place(k + 1) - place(k))) k = i;
  FlatFace flat{t, c[(k + 2) % 3], kNone, 0};
  const auto [low, high] = std::minmax(c[k], c[(k + 1) % 3]);
  auto use = std::lower_bound(uses.begin(), uses.end(), EdgeUse{low, high, 0, false});
  std::uint32_t others = 0;
  for (; use != uses.end() && use->low == low && use->high == high; ++use)
    if (use->triangle != t) {
      ++others;
      flat.neighbour = use->triangle;
    }
  if (others > 1) return {};
  if (others == 0) return flat;
  const Corners& n = mesh.triangles[flat.neighbour];
  if (std::ranges::find(n, flat.middle) != n.end()) return flat;  // folded onto it: both flat
  while (std::minmax(n[flat.edge], n[(flat.edge + 1) % 3]) != std::minmax(c[k], c[(k + 1) % 3]))
    ++flat.edge;
  return flat;
}

}  // namespace

std::string counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

Draft make_draft(const ModelSurface& surface) {
  assert(surface.corners.size() == 3 * surface.mesh.triangles.size());
  return {surface, std::vector<bool>(surface.mesh.triangles.size(), false), {}};
}

void keep_triangles(Draft& draft, const std::vector<bool>& keep) {
  ModelSurface& s = draft.surface;
  std::size_t to = 0;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    s.mesh.triangles[to] = s.mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) s.corners[3 * to + k] = s.corners[3 * t + k];
    s.material[to] = s.material[t];
    draft.is_new[to] = draft.is_new[t];
    ++to;
  }
  s.mesh.triangles.resize(to);
  s.corners.resize(3 * to);
  s.material.resize(to);
  draft.is_new.resize(to);
}

void turn_triangles(Draft& draft, const std::vector<bool>& turn) {
  ModelSurface& s = draft.surface;
  for (std::size_t t = 0; t < turn.size(); ++t) {
    if (!turn[t]) continue;
    std::swap(s.mesh.triangles[t][1], s.mesh.triangles[t][2]);
    std::swap(s.corners[3 * t + 1], s.corners[3 * t + 2]);
    for (std::size_t k = 0; k < 3; ++k)
      for (float& n : s.corners[3 * t + k].normal) n = -n;
  }
}

void drop_bad_numbers(Draft& draft) {
  const TriMesh& mesh = draft.mesh();
  std::vector<bool> keep;
  for (const Corners& t : mesh.triangles)
    keep.push_back(std::ranges::all_of(t, [&](std::uint32_t v) {
      if (v >= mesh.vertices.size()) return false;
      const Vec3 p = mesh.vertices[v];
      return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    }));
  const auto count = static_cast<std::uint64_t>(std::count(keep.begin(), keep.end(), false));
  if (count == 0) return;
  keep_triangles(draft, keep);
  draft.steps.push_back(counted(count, "face", "faces") + " with bad numbers dropped");
}

void join_equal_vertices(Draft& draft) {
  const auto& vertices = draft.mesh().vertices;
  std::vector<bool> used(vertices.size());
  for (const Corners& t : draft.mesh().triangles)
    for (const std::uint32_t v : t) used[v] = true;
  std::vector<std::uint32_t> order, instead(vertices.size());
  for (std::uint32_t v = 0; v < vertices.size(); ++v)
    if (used[v]) order.push_back(v);
  const auto key = [&](std::uint32_t v) {
    const Vec3 p = vertices[v];
    return std::tuple(p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(key(a), a) < std::pair(key(b), b);
  });
  std::uint64_t count = 0;
  std::iota(instead.begin(), instead.end(), 0u);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) != key(order[i - 1])) continue;
    instead[order[i]] = instead[order[i - 1]];
    ++count;
  }
  if (count > 0) {
    use_vertices(draft, instead);
    draft.steps.push_back(counted(count, "vertex", "vertices") + " joined with an equal one");
  }
  drop_doubles(draft);
}

void weld_open_edges(Draft& draft, double distance) {
  const auto& vertices = draft.mesh().vertices;
  std::vector<bool> open(vertices.size());
  for_each_edge(all_uses(draft.mesh()), [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) open[edge[0].low] = open[edge[0].high] = true;
  });
  std::vector<std::uint32_t> order, instead(vertices.size());
  std::iota(instead.begin(), instead.end(), 0u);
  for (std::uint32_t v = 0; v < vertices.size(); ++v)
    if (open[v]) order.push_back(v);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(vertices[a].x, a) < std::pair(vertices[b].x, b);
  });
  std::uint64_t count = 0;
  double moved = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    // To the nearest of those that stay where they are, so that nothing moves further than told.
    double best = distance;
    for (std::size_t k = i; k-- > 0;) {
      if (vertices[order[i]].x - vertices[order[k]].x > distance) break;
      const double d = length(vertices[order[i]] - vertices[order[k]]);
      if (instead[order[k]] != order[k] || d > best) continue;
      best = d;
      instead[order[i]] = order[k];
    }
    if (instead[order[i]] == order[i]) continue;
    ++count;
    moved = std::max(moved, best);
  }
  if (count == 0) return;
  use_vertices(draft, instead);
  draft.steps.push_back(counted(count, "vertex", "vertices") + " of open edges moved by up to " +
                        metres(moved) + " to join cracks (nothing further apart than " +
                        metres(distance) + " is joined)");
  drop_doubles(draft);
}

void take_out_flat_faces(Draft& draft) {
  std::uint64_t count = 0;
  // Each pass takes out flat faces none of which touches another's neighbour; cutting may leave
  // flat ones for the next, as chains of flat faces do.
  bool again = true;
  for (int pass = 0; pass < kMostFlatPasses && again; ++pass) {
    again = false;
    const auto uses = all_uses(draft.mesh());
    const std::size_t size = draft.mesh().triangles.size();
    std::vector<bool> keep(size, true), touched(size);
    for (std::uint32_t t = 0; t < size; ++t) {
      if (touched[t]) continue;
      const FlatFace flat = find_flat(draft.mesh(), t, uses);
      if (flat.face == kNone || (flat.neighbour != kNone && touched[flat.neighbour])) continue;
      keep[t] = false;
      touched[t] = again = true;
      ++count;
      if (flat.neighbour == kNone) continue;
      touched[flat.neighbour] = true;
      const Corners& n = draft.mesh().triangles[flat.neighbour];
      if (std::ranges::find(n, flat.middle) != n.end())
        keep[flat.neighbour] = false;
      else
        cut_edge(draft, flat.neighbour, flat.edge, flat.middle);
    }
    keep.resize(draft.mesh().triangles.size(), true);
    keep_triangles(draft, keep);
  }
  if (count > 0)
    draft.steps.push_back(counted(count, "face", "faces") +
                          " without area taken out, neighbours cut to fit");
}

void turn_flipped_faces(Draft& draft) {
  const auto orientation = orient(draft.mesh().triangles, all_uses(draft.mesh()));
  const auto count = std::count(orientation.flipped.begin(), orientation.flipped.end(), true);
  if (count == 0) return;
  turn_triangles(draft, orientation.flipped);
  draft.steps.push_back(
      counted(static_cast<std::uint64_t>(count), "flipped face", "flipped faces") + " turned over");
}

void split_vertices(Draft& draft, double apart) {
  TriMesh& mesh = draft.mesh();
  const auto fans = find_fans(mesh.triangles, all_uses(mesh));
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> by_vertex;
  for (std::uint32_t corner = 0; corner < fans.size(); ++corner)
    by_vertex[{mesh.triangles[corner / 3][corner % 3], fans[corner]}].push_back(corner);
  std::uint64_t count = 0;
  const std::vector<Vec3> before = mesh.vertices;
  for (auto it = by_vertex.begin(); it != by_vertex.end();) {
    const std::uint32_t vertex = it->first.first;
    auto end = it;
    while (end != by_vertex.end() && end->first.first == vertex) ++end;
    const bool is_split = std::next(it) != end;
    count += is_split;
    for (bool is_first = true; it != end; ++it, is_first = false) {
      if (!is_split) continue;
      Vec3 sum;
      for (const std::uint32_t corner : it->second)
        for (const std::uint32_t v : mesh.triangles[corner / 3])
          if (v < before.size()) sum = sum + (before[v] - before[vertex]);
      const double size = length(sum);
      const Vec3 place = before[vertex] + (size > 0 ? apart / size : 0) * sum;
      const auto target = is_first ? vertex : static_cast<std::uint32_t>(mesh.vertices.size());
      if (is_first)
        mesh.vertices[vertex] = place;
      else
        mesh.vertices.push_back(place);
      for (const std::uint32_t corner : it->second) mesh.triangles[corner / 3][corner % 3] = target;
    }
  }
  if (count > 0)
    draft.steps.push_back(counted(count, "vertex", "vertices") +
                          " where parts met in a point split and drawn apart by " + metres(apart));
}

void turn_shells(Draft& draft) {
  const auto diagnosis = diagnose(draft.mesh(), draft.mesh().triangles.size());
  if (diagnosis.counts[static_cast<std::size_t>(SurfaceDefect::Kind::inside_out)] == 0) return;
  const auto orientation = orient(draft.mesh().triangles, all_uses(draft.mesh()));
  std::vector<bool> turn_shell(draft.mesh().triangles.size()), turn;
  std::uint64_t count = 0;
  for (const SurfaceDefect& d : diagnosis.defects)
    if (d.kind == SurfaceDefect::Kind::inside_out) {
      turn_shell[orientation.shell[d.a]] = true;
      ++count;
    }
  for (const std::uint32_t shell : orientation.shell) turn.push_back(turn_shell[shell]);
  turn_triangles(draft, turn);
  draft.steps.push_back(counted(count, "inside-out shell", "inside-out shells") +
                        " turned over (one inside another bounds a cavity)");
}

void drop_empty_shells(Draft& draft, double thickness) {
  const TriMesh& mesh = draft.mesh();
  const auto uses = all_uses(mesh);
  const auto shell = orient(mesh.triangles, uses).shell;
  std::vector<bool> open(shell.size());
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) open[shell[edge[0].triangle]] = true;
  });
  std::vector<double> volume(shell.size()), area(shell.size());
  for (std::size_t t = 0; t < shell.size(); ++t) {
    const Vec3 base = mesh.vertices[mesh.triangles[shell[t]][0]];
    const auto place = [&](std::size_t k) { return mesh.vertices[mesh.triangles[t][k]] - base; };
    const Vec3 normal = cross(place(1) - place(0), place(2) - place(0));
    volume[shell[t]] += dot(place(0), normal) / 6;
    area[shell[t]] += length(normal) / 2;
  }
  std::vector<bool> keep;
  std::uint64_t count = 0;
  for (std::uint32_t t = 0; t < shell.size(); ++t) {
    const std::uint32_t s = shell[t];
    keep.push_back(open[s] || std::abs(volume[s]) > thickness / 2 * area[s]);
    count += !keep[t] && shell[t] == t;
  }
  if (count == 0 || std::ranges::none_of(keep, [](bool kept) { return kept; })) return;
  keep_triangles(draft, keep);
  draft.steps.push_back(counted(count, "shell", "shells") + " enclosing nothing dropped");
}

void drop_unused_vertices(Draft& draft) {
  TriMesh& mesh = draft.mesh();
  std::vector<std::uint32_t> to(mesh.vertices.size(), kNone);
  for (const Corners& t : mesh.triangles)
    for (const std::uint32_t v : t) to[v] = 0;
  std::uint32_t next = 0;
  for (std::uint32_t v = 0; v < to.size(); ++v) {
    if (to[v] == kNone) continue;
    mesh.vertices[next] = mesh.vertices[v];
    to[v] = next++;
  }
  if (next == mesh.vertices.size()) return;
  mesh.vertices.resize(next);
  use_vertices(draft, to);
}

}  // namespace sunder
