// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/page_zlib.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>

namespace sunder {

std::string deflate_raw(std::string_view bytes) {
  constexpr int kRaw = -15, kMemory = 8, kLevel = 6;
  constexpr std::size_t kBlock = std::size_t{1} << 18;
  constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, kRaw, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string packed, block(kBlock, '\0');
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    if (stream.avail_in == 0) {
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
      stream.avail_in = static_cast<uInt>(std::min(bytes.size(), kMost));
      bytes.remove_prefix(stream.avail_in);
    }
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(kBlock);
    state = deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
    packed.append(block, 0, kBlock - stream.avail_out);
  }
  deflateEnd(&stream);
  return packed;
}

}  // namespace sunder
