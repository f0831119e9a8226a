// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_binary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "io/gltf_series.hpp"

namespace sunder {
namespace {

// Collects what is converted on the way out into large writes.
class BinaryWriter {
 public:
  explicit BinaryWriter(ByteSink& sink) : sink_(sink), buffer_(kSize) {}
  ~BinaryWriter() = default;

  template <class T>
  void put(T value) {
    if (used_ + sizeof value > kSize) flush();
    std::memcpy(buffer_.data() + used_, &value, sizeof value);
    used_ += sizeof value;
  }
  void put(Vec3 v) {
    put(std::array{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
  }
  // Texture coordinates, v turned down as glTF wants it: a block at a time, in vector registers.
  void put_uvs(std::span<const float> uvs) {
    std::array<float, 4096> block;
    while (!uvs.empty()) {
      const std::size_t count = std::min(uvs.size(), block.size());
      for (std::size_t i = 0; i + 1 < count; i += 2) {
        block[i] = uvs[i];
        block[i + 1] = 1.0f - uvs[i + 1];
      }
      if (used_ + count * sizeof(float) > kSize) flush();
      std::memcpy(buffer_.data() + used_, block.data(), count * sizeof(float));
      used_ += count * sizeof(float);
      uvs = uvs.subspan(count);
    }
  }
  void flush() {
    if (used_ > 0) sink_.write(std::span(buffer_).first(used_));
    used_ = 0;
  }

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 18;
  ByteSink& sink_;
  std::vector<std::byte> buffer_;
  std::size_t used_ = 0;
};

void write_bonds(std::span<const Bond> bonds, BinaryWriter& out) {
  for (const Bond& bond : bonds) {
    out.put(std::array{bond.a, bond.b});
  }
  for (const Bond& bond : bonds) out.put(static_cast<float>(bond.area));
  for (const Bond& bond : bonds) out.put(bond.centroid);
  for (const Bond& bond : bonds) out.put(bond.normal);
}

void write_indices(std::span<const std::uint32_t> indices, bool is_short, BinaryWriter& out) {
  if (!is_short) {
    for (const std::uint32_t index : indices) out.put(index);
    return;
  }
  for (const std::uint32_t index : indices) out.put(static_cast<std::uint16_t>(index));
  if (indices.size() % 2 != 0) out.put(std::uint16_t{0});
}

void write_sphere_vertices(const std::vector<double>& radii, BinaryWriter& out) {
  if (radii.empty()) return;
  const SphereMesh sphere = sphere_mesh();
  for (const double radius : radii) {
    for (const Vec3 v : sphere.vertices) out.put(radius * v);
  }
}

// Calls put(pose) for every key of every history.
template <class Put>
void for_each_pose(const GltfLayout& layout, const Put& put) {
  const GltfAnimation& animation = layout.animation;
  for (const GltfAnimation::History& history : animation.histories) {
    const GltfAnimation::Keys keys = animation.key_ranges[history.keys];
    for (std::uint32_t k = 0; k < keys.count; ++k) {
      put(pose_of(*layout.recording, animation, history, keys.first + k), k == 0);
    }
  }
}

// q and -q are one attitude: the sign nearer to the key before keeps interpolation on the short
// way in players that do not see to it.
void write_rotations(const GltfLayout& layout, BinaryWriter& out) {
  Quaternion last;
  for_each_pose(layout, [&](const Pose& pose, bool is_first) {
    Quaternion q = pose.rotation;
    const double size = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const double along = q.x * last.x + q.y * last.y + q.z * last.z + q.w * last.w;
    const double scale = (is_first ? q.w < 0 : along < 0) ? -1 / size : 1 / size;
    q = {scale * q.x, scale * q.y, scale * q.z, scale * q.w};
    out.put(std::array{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
                       static_cast<float>(q.w)});
    last = q;
  });
}

void write_glow_times(const GltfParts& parts, BinaryWriter& out) {
  for (const GltfParts::Glow& glow : parts.glows) {
    for (const std::uint32_t key : glow.keys) out.put(parts.grid[key]);
  }
}

void write_times(const GltfLayout& layout, BinaryWriter& out) {
  for (std::uint64_t k = 0; k < layout.common_times(); ++k) {
    out.put(static_cast<float>(layout.recording->times[layout.animation.steps[k]]));
  }
  write_glow_times(layout.parts, out);
}

void write_poses(const GltfLayout& layout, BinaryWriter& out) {
  const GltfAnimation& animation = layout.animation;
  for_each_pose(layout, [&out](const Pose& pose, bool) { out.put(pose.position); });
  for (std::uint32_t i = 0; i < animation.scale_count(); ++i) {
    out.put(i == 1 ? Vec3{1, 1, 1} : Vec3{0, 0, 0});
  }
  write_rotations(layout, out);
}

void write_weights(const GltfParts& parts, BinaryWriter& out) {
  for (const GltfParts::Glow& glow : parts.glows) {
    for (const auto& weights : glow.weights) {
      for (const std::uint8_t weight : weights) {
        out.put(static_cast<float>(weight) / static_cast<float>(kLightSteps));
      }
    }
  }
}

void write_part_lists(const GltfParts& parts, BinaryWriter& out) {
  for (const GltfParts::Shape& shape : parts.shapes) {
    write_indices(shape.mesh.indices, shape.index_width() == 2, out);
  }
}

void write_colours(const GltfLayout& layout, BinaryWriter& out) {
  if (layout.parts.colour_count == 0) return;
  for_each_colour(*layout.recording, layout.parts, [&out](const Colour& colour) {
    out.put(Vec3{colour[0], colour[1], colour[2]});
  });
}

}  // namespace

void write_gltf_binary(std::span<const WallView> walls, const GltfLayout& layout, ByteSink& sink) {
  const auto pass = [&sink](std::span<const float> values) {
    if (!values.empty()) sink.write(std::as_bytes(values));
  };
  const GltfParts& parts = layout.parts;
  BinaryWriter out(sink);
  for (const WallView& wall : walls) pass(wall.positions);
  write_sphere_vertices(layout.radii, out);
  out.flush();
  for (const GltfParts::Shape& shape : parts.shapes) pass(shape.mesh.positions);
  for (std::uint32_t v = 0; v < parts.still_count; ++v) out.put(Vec3{});
  out.flush();
  for (const WallView& wall : walls)
    if (wall.hulls.set) pass(wall.hulls.set->positions);
  for (const WallView& wall : walls) pass(wall.normals);
  if (!layout.radii.empty()) write_sphere_vertices({1}, out);
  out.flush();
  for (const GltfParts::Shape& shape : parts.shapes) pass(shape.mesh.normals);
  for (const WallView& wall : walls) out.put_uvs(wall.uvs);
  for (const GltfParts::Shape& shape : parts.shapes) out.put_uvs(shape.mesh.uvs);
  for (const WallView& wall : walls) {
    for (std::size_t i = 0; i + 4 <= wall.colours.size(); i += 4) {
      out.put(std::array{wall.colours[i], wall.colours[i + 1], wall.colours[i + 2]});
    }
  }
  write_colours(layout, out);
  for (const UniqueLists::List& list : layout.lists.lists) {
    write_indices(list.indices, list.largest <= kLargestShortIndex, out);
  }
  if (!layout.radii.empty()) {
    for (const std::uint16_t index : sphere_mesh().indices) out.put(index);
  }
  write_part_lists(parts, out);
  for (const WallView& wall : walls) {
    if (!wall.hulls.set) continue;
    for (const std::uint16_t index : wall.hulls.set->indices) out.put(index);
  }
  for (const WallView& wall : walls) write_bonds(wall.bonds, out);
  write_times(layout, out);
  write_poses(layout, out);
  write_weights(parts, out);
  for_each_utilisation(layout, [&out](std::uint16_t value) { out.put(value); });
  out.flush();
  for (const GltfImage& image : layout.images) {
    sink.write(image.bytes);
    for (std::size_t size = image.bytes.size(); size % 4 != 0; ++size) out.put(std::byte{0});
    out.flush();
  }
}

}  // namespace sunder
