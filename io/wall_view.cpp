// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/wall_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <unordered_map>

#include "io/printable.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

constexpr std::size_t kLongestName = 56;

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(ErrorCode::output, where + ": " + what);
}

// The exponent bits are looked at together, so that the loop runs in vector registers.
bool all_finite(std::span<const float> values) {
  std::uint32_t found = 0;
  for (const float value : values) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    found |= (bits & 0x7F800000u) + 0x00800000u;
  }
  return (found & 0x80000000u) == 0;
}

bool is_unit(float squared_length) {
  return (squared_length > 1 - 1e-4f) & (squared_length < 1 + 1e-4f);  // false for NaN
}

// Squares first, sixteen vertices a turn, faults counted as integers: that runs in vector registers
// although a vertex has three numbers.
bool all_unit(std::span<const float> normals) {
  constexpr std::size_t kTurn = 48;
  std::uint32_t faults = 0;
  for (; normals.size() >= kTurn; normals = normals.subspan(kTurn)) {
    float square[kTurn];
    for (std::size_t k = 0; k < kTurn; ++k) square[k] = normals[k] * normals[k];
    for (std::size_t k = 0; k < kTurn; k += 3)
      faults += is_unit(square[k] + square[k + 1] + square[k + 2]) ? 0u : 1u;
  }
  for (std::size_t k = 0; k + 3 <= normals.size(); k += 3) {
    const float x = normals[k], y = normals[k + 1], z = normals[k + 2];
    faults += is_unit(x * x + y * y + z * z) ? 0u : 1u;
  }
  return faults == 0;
}

bool is_finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// A name without the digits at its end, which is what the chunks of one wall share.
std::string_view stem_of(std::string_view name) {
  return name.substr(0, name.find_last_not_of("0123456789") + 1);
}

void check_names(std::span<const WallView> walls) {
  std::set<std::string_view> names, stems;
  for (const WallView& wall : walls) {
    if (!is_portable(wall.name) || !is_portable(wall.first_chunk)) {
      refuse("wall name \"" + wall.name + "\"",
             "with its chunks' numbers it must have 1 to 56 characters of A-Z a-z 0-9 _ -");
    }
    if (wall.material.empty() || printable(wall.material, 200) != wall.material) {
      refuse(wall.name, "its material's name is not 1 to 200 printable characters of UTF-8");
    }
    if (!names.insert(wall.name).second || !stems.insert(stem_of(wall.first_chunk)).second) {
      refuse("wall name \"" + wall.name + "\"", "is used twice");
    }
  }
  for (const WallView& wall : walls) {
    const std::string longest = hull_name(wall.hulls.nodes, wall.first_chunk, 0);
    if (wall.hulls.set && !is_portable(longest)) {
      refuse("wall name \"" + wall.name + "\"", "is too long for hulls: \"" + longest + "\" has " +
                                                    std::to_string(longest.size()) +
                                                    " characters, the most is 56");
    }
    if (stems.contains(stem_of(wall.name))) {
      refuse("wall name \"" + wall.name + "\"", "is like a chunk's of another wall");
    }
  }
}

void check_sizes(const WallView& wall) {
  const std::size_t count = wall.chunk_count();
  if (wall.chunks.size() != count || wall.vertex_begin.size() != count + 1) {
    refuse(wall.name, "the tables of its chunks differ in length");
  }
  if (wall.part_begin[0] != 0 || !std::ranges::is_sorted(wall.part_begin) ||
      wall.part_begin.back() != wall.parts.size()) {
    refuse(wall.name, "the parts of its chunks are not in order");
  }
  if (wall.vertex_begin[0] != 0 || !std::ranges::is_sorted(wall.vertex_begin)) {
    refuse(wall.name, "the vertex ranges of its chunks are not in order");
  }
  const std::size_t vertices = wall.vertex_begin.back();
  if (wall.positions.size() != 3 * vertices || wall.normals.size() != 3 * vertices ||
      wall.uvs.size() != 2 * vertices ||
      (!wall.colours.empty() && wall.colours.size() != 4 * vertices)) {
    refuse(wall.name, "its vertex arrays differ in length");
  }
}

void check_indices(const WallView& wall) {
  std::vector<std::uint32_t> needed(wall.lists.size(), 0);  // vertices a list needs
  for (std::size_t i = 0; i < wall.lists.size(); ++i) {
    const IndexList list = wall.lists[i];
    if (list.begin > wall.indices.size() || list.count > wall.indices.size() - list.begin ||
        list.count % 3 != 0) {
      refuse(wall.name, "index list " + std::to_string(i) + " is not whole triangles");
    }
    for (const std::uint32_t index : wall.indices.subspan(list.begin, list.count)) {
      if (index == UINT32_MAX) refuse(wall.name, "an index is out of range");
      needed[i] = std::max(needed[i], index + 1);
    }
  }
  for (std::uint32_t chunk = 0; chunk < wall.chunk_count(); ++chunk) {
    for (const auto [material, list] : wall.parts_of(chunk)) {
      if (list >= wall.lists.size() || material >= wall.materials.size() ||
          needed[list] > wall.vertex_count(chunk)) {
        refuse(wall.name, "chunk " + std::to_string(chunk) + " has an index out of range");
      }
    }
  }
}

void check_numbers(const WallView& wall) {
  if (!all_finite(wall.positions)) refuse(wall.name, "a vertex is not finite in float32");
  if (!all_unit(wall.normals)) {
    refuse(wall.name, "a normal is not of length 1");
  }
  if (!all_finite(wall.uvs)) refuse(wall.name, "a texture coordinate is not finite");
  if (!all_finite(wall.colours)) refuse(wall.name, "a colour is not finite");
  const Quaternion q = wall.rotation;
  const double turn = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!is_finite(wall.position) || !(std::abs(turn - 1) < 1e-6) || !std::isfinite(wall.thickness) ||
      !std::isfinite(wall.density) || !std::isfinite(wall.volume_expected)) {
    refuse(wall.name, "its position, rotation or a property is not finite");
  }
  for (std::size_t i = 0; i < wall.chunks.size(); ++i) {
    const MassProperties& p = wall.chunks[i];
    if (!std::isfinite(p.volume) || !is_finite(p.centroid) ||
        !is_finite({p.inertia.xx, p.inertia.yy, p.inertia.zz}) ||
        !is_finite({p.inertia.xy, p.inertia.xz, p.inertia.yz})) {
      refuse(wall.name, "the mass of chunk " + std::to_string(i) + " is not finite");
    }
  }
  for (const Bond& bond : wall.bonds) {
    const bool exists =
        bond.a < wall.chunk_count() && (bond.b < wall.chunk_count() || bond.b == kWorld);
    if (!exists || !std::isfinite(bond.area) || !is_finite(bond.centroid) ||
        !is_finite(bond.normal)) {
      refuse(wall.name, "a bond joins chunks that do not exist, or is not finite");
    }
  }
}

ViewMaterial material_of(std::string name, const std::array<std::uint8_t, 3>& rgb, double metallic,
                         double roughness) {
  return {.name = std::move(name),
          .colour = {linear(rgb[0]), linear(rgb[1]), linear(rgb[2])},
          .metallic = metallic,
          .roughness = roughness};
}

std::uint64_t hash_of(std::span<const std::uint32_t> values) {
  std::uint64_t hash = values.size();
  for (const std::uint32_t value : values) hash = mix_bits(hash ^ value);
  return hash;
}

}  // namespace

ViewMaterial outer_material(const std::string& material) {
  const MaterialLook look = look_of(material);
  return material_of(material + "_outer", look.outer, look.metallic, look.outer_roughness);
}

ViewMaterial inner_material(const std::string& material) {
  const MaterialLook look = look_of(material);
  return material_of(material + "_inner", look.inner, look.metallic, look.inner_roughness);
}

void show_meshes(const RenderMeshes& meshes, WallView& view) {
  view.positions = meshes.positions;
  view.normals = meshes.normals;
  view.uvs = meshes.uvs;
  view.vertex_begin = meshes.vertex_begin;
  view.indices = meshes.indices;
  view.lists.assign(meshes.lists.begin(), meshes.lists.end());
  view.materials = {outer_material(view.material), inner_material(view.material)};
  view.parts.clear();
  view.parts.reserve(2 * meshes.outer.size());
  view.part_begin.assign(1, 0);
  view.part_begin.reserve(meshes.outer.size() + 1);
  for (std::size_t c = 0; c < meshes.outer.size(); ++c) {
    if (meshes.outer[c] != RenderMeshes::kNoList) view.parts.push_back({0, meshes.outer[c]});
    if (meshes.inner[c] != RenderMeshes::kNoList) view.parts.push_back({1, meshes.inner[c]});
    view.part_begin.push_back(static_cast<std::uint32_t>(view.parts.size()));
  }
}

WallView view_of(const WallAsset& wall, const RenderMeshes& meshes) {
  WallView view{.name = wall.wall.name,
                .first_chunk = wall.chunk_name(0),
                .material = wall.wall.material,
                .position = wall.wall.position,
                .rotation = wall.wall.rotation,
                .thickness = wall.wall.thickness,
                .density = wall.density,
                .volume_expected = wall.volume_expected,
                .chunks = wall.chunks,
                .bonds = wall.bonds};
  show_meshes(meshes, view);
  return view;
}

bool is_portable(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
}

void validate(std::span<const WallView> walls) {
  check_names(walls);
  for (const WallView& wall : walls) {
    check_sizes(wall);
    check_indices(wall);
    check_numbers(wall);
  }
  if (std::ranges::all_of(walls, [](const WallView& wall) { return wall.chunk_count() == 0; })) {
    throw Error(ErrorCode::output, "there are no chunks to write");
  }
}

void ChunkNames::operator++() {
  for (std::size_t at = name_.size(); at-- > 0;) {
    if (name_[at] < '0' || name_[at] > '9') return;
    if (name_[at] != '9') {
      ++name_[at];
      return;
    }
    name_[at] = '0';
  }
}

UniqueLists unique_lists(std::span<const WallView> walls) {
  constexpr std::uint32_t kUnseen = UINT32_MAX;
  UniqueLists result;
  std::unordered_multimap<std::uint64_t, std::uint32_t> known;  // only looked up, never walked
  const auto find_or_add = [&](std::span<const std::uint32_t> indices) {
    const std::uint64_t hash = hash_of(indices);
    const auto [begin, end] = known.equal_range(hash);
    for (auto it = begin; it != end; ++it) {
      if (std::ranges::equal(result.lists[it->second].indices, indices)) return it->second;
    }
    const auto id = static_cast<std::uint32_t>(result.lists.size());
    const std::uint32_t largest = indices.empty() ? 0 : *std::ranges::max_element(indices);
    result.lists.push_back({indices, largest});
    known.emplace(hash, id);
    return id;
  };
  for (const WallView& wall : walls) {
    std::vector<std::uint32_t>& ids = result.of_wall.emplace_back(wall.lists.size(), kUnseen);
    for (const ViewPart& part : wall.parts) {
      if (ids[part.list] != kUnseen) continue;
      const IndexList range = wall.lists[part.list];
      if (range.count == 0) continue;
      ids[part.list] = find_or_add(wall.indices.subspan(range.begin, range.count));
    }
  }
  return result;
}

MaterialLook look_of(std::string_view material) {
  struct Known {
    std::string_view word;
    MaterialLook look;
  };
  static constexpr Known kKnown[] = {{"concrete", {{176, 174, 168}, {132, 124, 114}, 0.9, 1, 0}},
                                     {"brick", {{168, 92, 70}, {196, 122, 92}, 0.9, 1, 0}},
                                     {"glass", {{178, 208, 214}, {120, 178, 170}, 0.08, 0.3, 0}},
                                     {"pmma", {{190, 214, 222}, {140, 190, 200}, 0.1, 0.3, 0}},
                                     {"gypsum", {{226, 220, 208}, {240, 236, 228}, 0.95, 1, 0}},
                                     {"plaster", {{226, 220, 208}, {240, 236, 228}, 0.95, 1, 0}},
                                     {"stone", {{150, 146, 136}, {186, 178, 162}, 0.85, 1, 0}},
                                     {"wood", {{150, 108, 70}, {206, 168, 118}, 0.8, 0.95, 0}},
                                     {"timber", {{150, 108, 70}, {206, 168, 118}, 0.8, 0.95, 0}},
                                     {"steel", {{140, 144, 150}, {184, 188, 194}, 0.45, 0.35, 1}}};
  for (const Known& known : kKnown) {
    if (material.find(known.word) != std::string_view::npos) return known.look;
  }
  std::uint64_t hash = material.size();
  for (const char c : material) hash = mix_bits(hash ^ static_cast<unsigned char>(c));
  MaterialLook look;
  for (std::size_t i = 0; i < 3; ++i) {
    look.outer[i] = static_cast<std::uint8_t>(130 + (hash >> (8 * i)) % 80);
    look.inner[i] = static_cast<std::uint8_t>(look.outer[i] * 3 / 4);
  }
  return look;
}

double linear(std::uint8_t channel) {
  return std::floor(linear_channel(channel / 255.0) * 1e4 + 0.5) / 1e4;
}

// A cubic that follows the sRGB curve to 0.002; pow would differ between machines.
double linear_channel(double srgb) {
  return srgb * (srgb * (srgb * 0.305306011 + 0.682171111) + 0.012522878);
}

double srgb_channel(double linear) {
  double low = 0, high = 1;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (linear_channel(middle) < linear ? low : high) = middle;
  }
  return high;
}

}  // namespace sunder
