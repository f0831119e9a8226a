// SPDX-License-Identifier: GPL-3.0-or-later
// The module that is linked to OpenVDB: distances by its mesh-to-volume conversion, surfaces by its
// dual contouring (K. Museth, "VDB: High-Resolution Sparse Volumes with Dynamic Topology", 2013).
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "meshing/level_set_module.hpp"

namespace sunder {
namespace {

tbb::task_arena arena_of(int threads) {
  const int most = tbb::this_task_arena::max_concurrency();
  return tbb::task_arena(threads > 0 ? std::min(threads, most) : most);
}

std::vector<VoxelValue> distances(const TriMesh& mesh, float band, int threads) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> faces;
  for (const Vec3 p : mesh.vertices) points.emplace_back(p.x, p.y, p.z);
  for (const auto& t : mesh.triangles) faces.emplace_back(t[0], t[1], t[2]);
  openvdb::FloatGrid::Ptr grid;
  arena_of(threads).execute([&] {
    grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I>(points, faces),
        openvdb::math::Transform(), band, band, openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  });
  std::vector<VoxelValue> values;
  values.reserve(grid->activeVoxelCount());
  for (auto it = grid->cbeginValueOn(); it; ++it) {
    const openvdb::Coord at = it.getCoord();
    values.push_back({{at.x(), at.y(), at.z()}, *it});
  }
  return values;
}

LevelSetModule::Quads quads(const std::vector<VoxelValue>& values, float band, int threads) {
  const auto grid = openvdb::FloatGrid::create(band);
  auto accessor = grid->getAccessor();
  for (const VoxelValue& v : values)
    accessor.setValue(openvdb::Coord(v.at[0], v.at[1], v.at[2]), v.value);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> faces;
  arena_of(threads).execute([&] {
    openvdb::tools::signedFloodFill(grid->tree());
    openvdb::tools::volumeToMesh(*grid, points, faces, 0.0);
  });
  LevelSetModule::Quads result;
  for (const auto& p : points) result.vertices.push_back({p.x(), p.y(), p.z()});
  for (const auto& q : faces) result.quads.push_back({q[0], q[1], q[2], q[3]});
  return result;
}

}  // namespace
}  // namespace sunder

extern "C" __attribute__((visibility("default")))
const sunder::LevelSetModule sunder_level_set_module{sunder::distances, sunder::quads};
