// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/imported_asset.hpp"

#include <algorithm>

namespace sunder {
namespace {

ImportedChunk receive_chunk(AnswerReader& in) {
  ImportedChunk chunk;
  chunk.name = in.text();
  chunk.positions = in.array<float>();
  chunk.triangles = in.array<std::uint32_t>();
  chunk.inner = in.array<std::uint8_t>();
  const std::size_t vertices = chunk.positions.size() / 3;
  if (chunk.positions.size() % 3 != 0 || chunk.triangles.size() != 3 * chunk.inner.size() ||
      std::ranges::any_of(chunk.triangles, [&](std::uint32_t v) { return v >= vertices; })) {
    AnswerReader::fail();
  }
  return chunk;
}

}  // namespace

void send_asset(const ImportedAsset& asset, AnswerWriter& out) {
  out.value(asset.has_chunks);
  out.value(asset.has_materials);
  out.value(static_cast<std::uint64_t>(asset.walls.size()));
  for (const ImportedWall& wall : asset.walls) {
    out.text(wall.name);
    out.text(wall.material);
    out.value(wall.kind);
    out.value(wall.volume_expected);
    out.value(wall.bonds);
    out.value(static_cast<std::uint64_t>(wall.chunks.size()));
    for (const ImportedChunk& chunk : wall.chunks) {
      out.text(chunk.name);
      out.array(chunk.positions);
      out.array(chunk.triangles);
      out.array(chunk.inner);
    }
  }
}

ImportedAsset receive_asset(AnswerReader& in) {
  ImportedAsset asset;
  asset.has_chunks = in.value<std::uint8_t>() != 0;
  asset.has_materials = in.value<std::uint8_t>() != 0;
  const std::uint64_t walls = in.count(4);
  for (std::uint64_t w = 0; w < walls; ++w) {
    ImportedWall wall;
    wall.name = in.text();
    wall.material = in.text();
    const auto kind = in.value<std::uint8_t>();
    if (kind > static_cast<std::uint8_t>(SoupWall::Kind::solid)) AnswerReader::fail();
    wall.kind = static_cast<SoupWall::Kind>(kind);
    wall.volume_expected = in.value<double>();
    wall.bonds = in.value<std::uint64_t>();
    const std::uint64_t chunks = in.count(4);
    for (std::uint64_t c = 0; c < chunks; ++c) wall.chunks.push_back(receive_chunk(in));
    asset.walls.push_back(std::move(wall));
  }
  return asset;
}

}  // namespace sunder
