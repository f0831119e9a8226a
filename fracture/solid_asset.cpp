// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_asset.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fracture/solid_parts.hpp"
#include "fracture/solid_pattern.hpp"
#include "fracture/solid_warp.hpp"
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
  const auto* slices = std::get_if<SolidSlicesParams>(&solid.pattern);
  const bool waves = slices && slices->amplitude != 0;
  if (!(solid.roughness >= 0 && solid.roughness_size >= 0 && solid.uv_scale > 0) ||
      (waves && !(slices->amplitude > 0 && slices->wavelength > 0)))
    throw Error(ErrorCode::geometry,
                "solid " + solid.name +
                    ": roughness, roughness_size, amplitude, wavelength or uv_scale is out of "
                    "range; valid are from 0, wavelength and uv_scale above 0");
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

// The frame with a shift of its own for each attempt: the first has none, the others move the
// pattern by a billionth of the solid's size. The last take only exact contacts for contacts.
SolidFrame shifted(SolidFrame frame, std::uint64_t seed, int attempt) {
  if (attempt == 0) return frame;
  const auto part = [&](std::uint64_t axis) {
    const double sign = random_unit(seed, axis, 3) < 0.5 ? -1 : 1;
    return sign * 0x1p-11 *
           (0.5 + 0.5 * random_unit(seed, axis, static_cast<std::uint64_t>(attempt) + 8));
  };
  frame.shift = {part(0), part(1), part(2)};
  if (attempt > 4) frame.near = 0;
  return frame;
}

// A mesh in the places in which it is cut, and in those that its parts are shown in.
struct Cutter {
  const SolidModel& solid;
  const TriMesh& mesh;
  const TriMesh& shown;
  std::uint64_t seed;
  int threads;
  SolidComplex complex{};

  CutSolid cut() {
    constexpr int kAttempts = 8;
    const InsideTest box(mesh);
    const SolidFrame frame = make_solid_frame(box.low(), box.high());
    complex = make_solid_complex(solid.pattern, mesh, frame, seed);
    for (int attempt = 0;; ++attempt) {
      const SolidFrame moved = shifted(frame, seed, attempt);
      std::vector<Vec3> steps;
      steps.reserve(mesh.vertices.size());
      for (const Vec3& v : mesh.vertices) steps.push_back(moved.to_steps(v));
      try {
        return cut_solid(mesh, shown, steps, moved, complex, threads);
      } catch (const ExactContact& contact) {
        if (attempt == kAttempts) refuse(contact);
      }
    }
  }

  [[noreturn]] void refuse(const ExactContact& contact) const {
    const Vec3 at = shown.vertices[shown.triangles[contact.triangle][0]];
    std::ostringstream text;
    text << "solid " << solid.name << ": a triangle without area near (" << at.x << ", " << at.y
         << ", " << at.z << ") m";
    throw Error(ErrorCode::geometry, text.str());
  }
};

std::uint64_t cut_triangles(const CutSolid& cut) {
  std::uint64_t count = 0;
  std::vector<std::uint8_t> seen;
  for (const auto& p : cut.polygons) {
    if (p.triangle >= seen.size()) seen.resize(p.triangle + 1);
    count += seen[p.triangle]++ == 1;
    seen[p.triangle] = std::min<std::uint8_t>(seen[p.triangle], 2);
  }
  return count;
}

void cut_flat(SolidAsset& asset, std::uint64_t seed, int threads) {
  const TriMesh& mesh = asset.surface.mesh;
  Cutter cutter{asset.solid, mesh, mesh, seed, threads};
  CutSolid cut = cutter.cut();
  flip_flat_triangles(cut);
  asset.stats.exact_predicates = cut.exact_predicates;
  asset.stats.triangles_cut = cut_triangles(cut);
  asset.partition = partition_solid(mesh, {}, cutter.complex, cut, threads, asset.stats);
  if (!cutter.complex.labels.empty()) merge_outer_triangles(mesh, asset.partition);
  asset.chunks = solid_masses(asset.partition, threads);
}

bool all_face_outwards(const std::vector<MassProperties>& chunks) {
  return std::ranges::all_of(chunks, [](const auto& chunk) { return chunk.volume > 0; });
}

// Cuts the warped solid and moves what comes of it back. False if a chunk is turned inside out or
// crosses itself: straight triangles between moved points may, though the displacement does not.
bool cut_rough(SolidAsset& asset, const SolidWarp& warp, std::uint64_t seed, int threads) {
  const FineMesh fine = refined(asset.surface.mesh, warp.edge());
  TriMesh moved = fine.mesh;
  for_each_range(moved.vertices.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) moved.vertices[v] = warp.warped(moved.vertices[v]);
  });
  Cutter cutter{asset.solid, moved, fine.mesh, seed, threads};
  CutSolid cut = cutter.cut();
  refine_facets(cut, warp.edge());
  for_each_range(cut.places.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      cut.places[v] =
          v < cut.surface_places.size() ? cut.surface_places[v] : warp.unwarped(cut.places[v]);
  });
  flip_flat_triangles(cut);
  asset.stats = {};
  asset.stats.exact_predicates = cut.exact_predicates;
  asset.stats.triangles_cut = cut_triangles(cut);
  asset.stats.roughness = warp.roughness();
  asset.stats.amplitude = warp.amplitude();
  asset.partition =
      partition_solid(fine.mesh, fine.parents, cutter.complex, cut, threads, asset.stats);
  merge_outer_triangles(asset.surface.mesh, asset.partition);
  asset.chunks = solid_masses(asset.partition, threads);
  return all_face_outwards(asset.chunks) && !has_crossings(asset.partition, asset.origin);
}

// The size of a typical chunk.
double chunk_size(const SolidModel& solid, double volume) {
  double count = 100;
  if (const auto* p = std::get_if<SolidVoronoiParams>(&solid.pattern))
    count = p->sites.empty() ? static_cast<double>(p->count) : static_cast<double>(p->sites.size());
  if (const auto* p = std::get_if<SolidSlicesParams>(&solid.pattern))
    count = (p->slices.x + 1) * (p->slices.y + 1) * (p->slices.z + 1);
  if (const auto* p = std::get_if<SolidRadialParams>(&solid.pattern))
    count = static_cast<double>(p->rays * (p->rings + 1));
  if (const auto* p = std::get_if<SolidBrickParams>(&solid.pattern))
    count = volume / (p->brick.x * p->brick.y * p->brick.z);
  return std::cbrt(volume / std::max(count, 1.0));
}

// With as much of the roughness as the solid bears: thin places, whose two sides the fine mesh
// moves differently, and cracks that graze the surface may not bear all of it, or none.
void cut_asset(SolidAsset& asset, std::uint64_t seed, int threads) {
  constexpr double kLeastShare = 0.05;
  const double chunk = chunk_size(asset.solid, asset.volume_expected);
  for (double share = 1; share >= kLeastShare; share /= 2) {
    const SolidWarp warp(asset.solid, chunk, share, seed);
    if (warp.is_none()) break;
    try {
      if (cut_rough(asset, warp, seed, threads)) return;
    } catch (const Error&) {
      // Cut flat, it tells for itself what is wrong.
    }
  }
  asset.stats = {};
  cut_flat(asset, seed, threads);
}

// The last word on a surface that only looked sound: one that meets itself can pass unseen where no
// crack runs through the place.
void verify(const SolidAsset& asset) {
  constexpr double kRounding = 1e-9;
  double sum = 0;
  for (const auto& chunk : asset.chunks) {
    sum += chunk.volume;
    if (chunk.volume >= -kRounding * asset.volume_expected) continue;
    std::ostringstream text;
    text << "solid " << asset.solid.name << ": the surface faces inwards near (" << chunk.centroid.x
         << ", " << chunk.centroid.y << ", " << chunk.centroid.z << ") m";
    throw Error(ErrorCode::geometry, text.str());
  }
  if (!(std::abs(sum - asset.volume_expected) <= kRounding * asset.volume_expected)) {
    std::ostringstream text;
    text << "solid " << asset.solid.name << ": its chunks fill " << sum << " m³ of "
         << asset.volume_expected << " m³; valid is a closed surface that does not meet itself";
    throw Error(ErrorCode::geometry, text.str());
  }
}

void move_to_origin(SolidAsset& asset) {
  const Vec3 origin = asset.origin;
  if (origin == Vec3{}) return;
  for (Vec3& v : asset.surface.mesh.vertices) v = v - origin;
  for (Vec3& v : asset.partition.vertices) v = v - origin;
  for (MassProperties& chunk : asset.chunks) chunk.centroid = chunk.centroid - origin;
  asset.solid.position = asset.solid.position + rotate(asset.solid.rotation, origin);
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
  asset.origin = origin_for(mesh);
  if (!(asset.volume_expected > 0))
    throw Error(ErrorCode::geometry, "solid " + solid.name + ": the surface faces inwards");
  const auto tell = [&](double share) {
    if (params.progress) params.progress(share);
  };
  tell(0);
  cut_asset(asset, solid_seed(params.seed, solid.name), params.threads);
  tell(0.9);
  verify(asset);
  move_to_origin(asset);
  asset.bonds = solid_bonds(asset.partition);
  tell(1);
  return asset;
}

}  // namespace sunder
