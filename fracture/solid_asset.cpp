// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_asset.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fracture/solid_parts.hpp"
#include "fracture/solid_pattern.hpp"
#include "meshing/error.hpp"
#include "meshing/parallel.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

std::uint64_t solid_seed(std::uint64_t seed, const std::string& name) {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return random_bits(seed, hash);
}

void check_numbers(const SolidModel& solid, const ModelSurface& surface) {
  for (const Vec3& v : surface.mesh.vertices)
    if (!std::isfinite(v.x + v.y + v.z))
      throw Error(ErrorCode::geometry, "solid " + solid.name + ": a coordinate is not finite");
  for (const auto& t : surface.mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= surface.mesh.vertices.size())
        throw Error(ErrorCode::geometry, "solid " + solid.name + ": a corner " + std::to_string(v) +
                                             " is no vertex of its mesh");
  if (surface.mesh.triangles.size() >= SolidPartition::kInner || surface.mesh.triangles.empty())
    throw Error(ErrorCode::geometry, "solid " + solid.name + ": no surface of 1 … 2^31 triangles");
}

// The frame with a shift of its own for each attempt: the first has none, the others are so small
// that they change nothing but which side of a plane an exact contact is on.
SolidFrame shifted(SolidFrame frame, std::uint64_t seed, int attempt) {
  if (attempt == 0) return frame;
  const double size = 0x1p-18 * std::exp2(2 * attempt - 2);
  const auto part = [&](std::uint64_t axis) {
    const double sign = random_unit(seed, axis, 3) < 0.5 ? -1 : 1;
    return sign * size *
           (0.5 + 0.5 * random_unit(seed, axis, static_cast<std::uint64_t>(attempt) + 8));
  };
  frame.shift = {part(0), part(1), part(2)};
  return frame;
}

struct Cut {
  SolidComplex complex;
  CutSolid cut;
};

Cut cut_model(const SolidModel& solid, const TriMesh& mesh, std::uint64_t seed, int threads) {
  constexpr int kAttempts = 8;
  const InsideTest box(mesh);
  const SolidFrame frame = make_solid_frame(box.low(), box.high());
  SolidComplex complex = make_solid_complex(solid.pattern, mesh, frame, seed);
  for (int attempt = 0;; ++attempt) {
    const SolidFrame moved = shifted(frame, seed, attempt);
    std::vector<Vec3> steps;
    steps.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) steps.push_back(moved.to_steps(v));
    try {
      CutSolid cut = cut_solid(mesh, steps, frame, complex, threads);
      return {std::move(complex), std::move(cut)};
    } catch (const ExactContact& contact) {
      if (attempt < kAttempts) continue;
      const Vec3 at = mesh.vertices[mesh.triangles[contact.triangle][0]];
      std::ostringstream text;
      text << "solid " << solid.name << ": a triangle without area near (" << at.x << ", " << at.y
           << ", " << at.z << ") m";
      throw Error(ErrorCode::geometry, text.str());
    }
  }
}

}  // namespace

std::string SolidAsset::chunk_name(std::uint32_t chunk) const {
  const std::size_t digits =
      std::max<std::size_t>(4, std::to_string(std::max(1u, partition.chunk_count()) - 1).size());
  std::string number = std::to_string(chunk);
  number.insert(0, digits - std::min(digits, number.size()), '0');
  return solid.name + "_chunk_" + number;
}

bool SolidAsset::has_rough_faces() const {
  const auto* slices = std::get_if<SolidSlicesParams>(&solid.pattern);
  return solid.roughness > 0 || (slices && slices->amplitude > 0);
}

SolidAsset fracture_solid(const SolidModel& solid, ModelSurface surface, double density,
                          const FractureParams& params) {
  check_numbers(solid, surface);
  SolidAsset asset;
  asset.solid = solid;
  asset.density = density;
  asset.surface = std::move(surface);
  const TriMesh& mesh = asset.surface.mesh;
  asset.volume_expected = mass_properties(mesh).volume;
  if (!(asset.volume_expected > 0))
    throw Error(ErrorCode::geometry, "solid " + solid.name + ": the surface faces inwards");
  const Cut cut = cut_model(solid, mesh, solid_seed(params.seed, solid.name), params.threads);
  asset.stats.exact_predicates = cut.cut.exact_predicates;
  asset.partition = partition_solid(mesh, {}, cut.complex, cut.cut, params.threads, asset.stats);
  asset.chunks = solid_masses(asset.partition, params.threads);
  asset.bonds = solid_bonds(asset.partition);
  return asset;
}

}  // namespace sunder
