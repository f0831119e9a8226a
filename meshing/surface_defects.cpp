// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/surface_defects.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <tuple>

#include "meshing/surface_edges.hpp"
#include "meshing/triangle_tree.hpp"

namespace sunder {
namespace {

using Kind = SurfaceDefect::Kind;

constexpr const char* kNames[][2] = {{"open edge", "open edges"},
                                     {"non-manifold edge", "non-manifold edges"},
                                     {"non-manifold vertex", "non-manifold vertices"},
                                     {"flipped face", "flipped faces"},
                                     {"self-intersection", "self-intersections"},
                                     {"duplicate face", "duplicate faces"},
                                     {"degenerate face", "degenerate faces"},
                                     {"inside-out shell", "inside-out shells"},
                                     {"bad number", "bad numbers"}};

// Collects what is wrong with one mesh. A triangle that is wrong in itself (bad number, equal
// corners, duplicate) is left out of what follows, so that its fault is told once.
struct Diagnosis {
  const TriMesh& mesh;
  std::size_t most;
  SurfaceDiagnosis result{};
  std::vector<bool> sound{};                   // finite, three corners, no duplicate
  std::vector<bool> has_area{};                // sound, and not flat
  std::vector<std::uint32_t> broken_shells{};  // open, or meeting themselves or another

  Vec3 corner(std::uint32_t t, std::size_t k) const { return mesh.vertices[mesh.triangles[t][k]]; }
  Vec3 middle_of(std::uint32_t t) const {
    return (1.0 / 3) * (corner(t, 0) + corner(t, 1) + corner(t, 2));
  }
  Vec3 middle_of(const EdgeUse& e) const {
    return 0.5 * (mesh.vertices[e.low] + mesh.vertices[e.high]);
  }
  void add(Kind kind, std::uint32_t a, std::uint32_t b, Vec3 place) {
    ++result.counts[static_cast<std::size_t>(kind)];
    result.defects.push_back({kind, a, b, place});
  }

  void look_at_triangles();
  void look_at_duplicates();
  void look_at_edges(std::span<const EdgeUse> uses, const Orientation& orientation);
  void look_at_vertices(std::span<const EdgeUse> uses);
  void look_at_crossings(const TriangleTree& tree, const Orientation& orientation);
  void look_at_shells(const TriangleTree& tree, const Orientation& orientation);
  void finish();
};

void Diagnosis::look_at_triangles() {
  const auto is_good = [&](std::uint32_t v) {
    if (v >= mesh.vertices.size()) return false;
    const Vec3 p = mesh.vertices[v];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners& c = mesh.triangles[t];
    sound.push_back(false);
    has_area.push_back(false);
    const auto bad = std::find_if_not(c.begin(), c.end(), is_good);
    if (bad != c.end()) {
      add(Kind::bad_number, t, t, *bad < mesh.vertices.size() ? mesh.vertices[*bad] : Vec3{});
      continue;
    }
    sound[t] = c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
    has_area[t] = sound[t] && !is_flat(corner(t, 0), corner(t, 1), corner(t, 2));
    if (!has_area[t]) add(Kind::degenerate_face, t, t, middle_of(t));
  }
}

void Diagnosis::look_at_duplicates() {
  std::vector<std::pair<Corners, std::uint32_t>> order;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!sound[t]) continue;
    Corners c = mesh.triangles[t];
    std::sort(c.begin(), c.end());
    order.emplace_back(c, t);
  }
  std::sort(order.begin(), order.end());
  std::uint32_t first = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (order[i].first != order[i - 1].first) continue;
    if (i < 2 || order[i - 1].first != order[i - 2].first) first = order[i - 1].second;
    const std::uint32_t t = order[i].second;
    add(Kind::duplicate_face, t, first, middle_of(t));
    sound[t] = has_area[t] = false;
  }
}

void Diagnosis::look_at_edges(std::span<const EdgeUse> uses, const Orientation& orientation) {
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    const std::uint32_t a = edge[0].triangle, b = edge[edge.size() > 1].triangle;
    if (edge.size() != 2)
      add(edge.size() == 1 ? Kind::open_edge : Kind::nonmanifold_edge, a, b, middle_of(edge[0]));
    else if (orientation.one_sided[orientation.shell[a]] && edge[0].forward == edge[1].forward)
      add(Kind::flipped_face, a, b, middle_of(edge[0]));
    else
      return;
    for (const EdgeUse& use : edge) broken_shells.push_back(orientation.shell[use.triangle]);
  });
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t shell = orientation.shell[t];
    if (!sound[t] || !orientation.flipped[t] || orientation.one_sided[shell]) continue;
    add(Kind::flipped_face, t, t, middle_of(t));
    broken_shells.push_back(shell);
  }
}

void Diagnosis::look_at_vertices(std::span<const EdgeUse> uses) {
  const auto fans = find_fans(mesh.triangles, uses);
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> first(mesh.vertices.size(), kNone), told(mesh.vertices.size(), kNone);
  for (std::uint32_t corner = 0; corner < fans.size(); ++corner) {
    const std::uint32_t t = corner / 3;
    if (!sound[t]) continue;
    const std::uint32_t v = mesh.triangles[t][corner % 3];
    if (first[v] == kNone) first[v] = fans[corner];
    if (first[v] == fans[corner] || told[v] != kNone) continue;
    told[v] = t;
    add(Kind::nonmanifold_vertex, first[v] / 3, t, mesh.vertices[v]);
  }
}

void Diagnosis::look_at_crossings(const TriangleTree& tree, const Orientation& orientation) {
  for (const auto& [a, b] : tree.overlapping_boxes()) {
    if (!meet_apart(mesh.vertices, mesh.triangles[a], mesh.triangles[b])) continue;
    add(Kind::self_intersection, a, b, 0.5 * (middle_of(a) + middle_of(b)));
    broken_shells.insert(broken_shells.end(), {orientation.shell[a], orientation.shell[b]});
  }
}

// Of each closed shell: inside how many other closed ones it lies, and which way it faces.
void Diagnosis::look_at_shells(const TriangleTree& tree, const Orientation& orientation) {
  std::vector<std::vector<std::uint32_t>> members(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (sound[t]) members[orientation.shell[t]].push_back(t);
  for (const std::uint32_t shell : broken_shells) members[shell].clear();
  for (std::uint32_t shell = 0; shell < members.size(); ++shell) {
    if (members[shell].empty()) continue;
    double volume = 0;
    const Vec3 p = corner(members[shell][0], 0);
    for (const std::uint32_t t : members[shell])
      volume += dot(corner(t, 0) - p, cross(corner(t, 1) - p, corner(t, 2) - p));
    bool is_cavity = false;  // inside an odd number of others
    for (const std::uint32_t t : tree.along_x(p)) {
      const std::uint32_t other = orientation.shell[t];
      if (other != shell && !members[other].empty() &&
          crossing(p, corner(t, 0), corner(t, 1), corner(t, 2)) != 0)
        is_cavity = !is_cavity;
    }
    if (is_cavity ? volume >= 0 : volume <= 0)
      add(Kind::inside_out, shell, shell, middle_of(shell));
  }
}

void Diagnosis::finish() {
  std::vector<SurfaceDefect>& all = result.defects;
  std::stable_sort(all.begin(), all.end(), [](const SurfaceDefect& a, const SurfaceDefect& b) {
    return std::tuple(a.kind, a.a, a.b) < std::tuple(b.kind, b.a, b.b);
  });
  std::array<std::size_t, kSurfaceDefectKinds> seen{};
  std::erase_if(
      all, [&](const SurfaceDefect& d) { return ++seen[static_cast<std::size_t>(d.kind)] > most; });
}

}  // namespace

const char* name_of(SurfaceDefect::Kind kind) {
  return kNames[static_cast<std::size_t>(kind)][0];
}

bool SurfaceDiagnosis::is_solid() const {
  return std::ranges::all_of(counts, [](std::uint64_t count) { return count == 0; });
}

std::string SurfaceDiagnosis::text() const {
  std::string text;
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    if (counts[kind] == 0) continue;
    if (!text.empty()) text += "; ";
    text += std::to_string(counts[kind]) + " " + kNames[kind][counts[kind] > 1];
    const auto first = std::ranges::find(defects, static_cast<Kind>(kind), &SurfaceDefect::kind);
    if (first == defects.end()) continue;
    char where[160];
    std::snprintf(where, sizeof where, ", %snear (%.6g, %.6g, %.6g) m at triangle %u",
                  counts[kind] > 1 ? "first " : "", first->place.x, first->place.y, first->place.z,
                  first->a);
    text += where;
  }
  return text;
}

SurfaceDiagnosis diagnose(const TriMesh& mesh, std::size_t most) {
  Diagnosis d{mesh, most};
  d.look_at_triangles();
  d.look_at_duplicates();
  const auto uses = edge_uses(mesh.triangles, d.sound);
  const Orientation orientation = orient(mesh.triangles, uses);
  d.look_at_edges(uses, orientation);
  d.look_at_vertices(uses);
  const TriangleTree tree(mesh, d.has_area);
  d.look_at_crossings(tree, orientation);
  d.look_at_shells(tree, orientation);
  d.finish();
  return std::move(d.result);
}

SurfaceDiagnosis diagnose(const ModelSurface& surface, std::size_t most) {
  return diagnose(surface.mesh, most);
}

}  // namespace sunder
