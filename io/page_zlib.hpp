// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace sunder {

/// Raw deflate (RFC 1951, no header) of the bytes. Same bytes, same result with the same zlib.
std::string deflate_raw(std::string_view bytes);

}  // namespace sunder
