// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sunder {

/// "image/png" or "image/jpeg", the two that glTF knows, by a file's first bytes; "" for another.
std::string mime_of_image(const std::string& path);
/// The bytes of a file. Throws Error{output} if it cannot be read.
std::vector<std::byte> read_bytes(const std::string& path);

/// Everything but letters, digits, '/' and -._~ as %XX (RFC 3986).
std::string percent_encoded(const std::string& path);

}  // namespace sunder
