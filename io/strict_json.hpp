// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/json_value.hpp"

namespace sunder {

/// Limits that keep a hostile file from costing more than a small multiple of its size.
constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;
constexpr std::size_t kMaxJsonValues = std::size_t{1} << 23;
constexpr std::size_t kMaxJsonDepth = 64;

/// Parses one JSON value, stricter than the grammar: no duplicate keys, no integer outside 64 bits,
/// no number that overflows or vanishes, no NUL in texts, no nesting above kMaxJsonDepth, UTF-8
/// only (a byte order mark is skipped). Minus zero becomes zero.
/// Throws Error{input} `name:line: what` or `name:line: /json/pointer: what`.
JsonValue parse_json(std::string_view text, const std::string& name);

/// Content of a regular file of at most `limit` bytes. Throws Error{input} naming the path for
/// anything else: a folder, a pipe, a device, a file that is not there.
std::string read_text_file(const std::filesystem::path& path, std::size_t limit = kMaxJsonBytes);

}  // namespace sunder
