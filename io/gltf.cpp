// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "io/gltf_binary.hpp"
#include "io/gltf_document.hpp"
#include "io/gltf_layout.hpp"
#include "io/image_file.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

void refuse_above_4_gib(std::uint64_t size) {
  if (size > UINT32_MAX) {
    throw Error(ErrorCode::output, "a .glb holds at most 4 GiB, this asset needs " +
                                       std::to_string(size >> 20) + " MiB: write .gltf");
  }
}

}  // namespace

void write_glb(std::span<const WallView> walls, ByteSink& out, const Recording* recording,
               std::optional<std::uint32_t> step) {
  const GltfLayout layout = lay_out_gltf(walls, recording, step, true);
  refuse_above_4_gib(layout.binary_size);
  // The length of the JSON is known when it has been written; the header is filled in at the end.
  const std::array<std::byte, 20> room{};
  out.write(room);
  const std::uint64_t json_size = write_gltf_document(walls, layout, "", out);
  const bool has_binary = layout.binary_size > 0;
  const std::uint64_t size = 20 + json_size + (has_binary ? 8 + layout.binary_size : 0);
  refuse_above_4_gib(size);
  if (has_binary) {
    const std::uint32_t head[] = {static_cast<std::uint32_t>(layout.binary_size), 0x004E4942};
    out.write(std::as_bytes(std::span(head)));
    write_gltf_binary(walls, layout, out);
  }
  const std::uint32_t head[] = {0x46546C67, 2, static_cast<std::uint32_t>(size),
                                static_cast<std::uint32_t>(json_size), 0x4E4F534A};
  out.rewrite_front(std::as_bytes(std::span(head)));
}

void write_gltf(std::span<const WallView> walls, const std::string& binary_name, ByteSink& json,
                ByteSink& binary, const Recording* recording, std::optional<std::uint32_t> step) {
  const GltfLayout layout = lay_out_gltf(walls, recording, step, false);
  write_gltf_document(walls, layout, percent_encoded(binary_name), json);
  write_gltf_binary(walls, layout, binary);
}

}  // namespace sunder
