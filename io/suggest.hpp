// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

/// Insertions, deletions, replacements and swaps of neighbours that turn a into b, capital and
/// small ASCII letters being equal (optimal string alignment). Never counts beyond `limit` + 1.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit = 2);

/// The candidate at most two edits from `word`, the first of the nearest; empty when none is, or
/// when nothing of the word would be left.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

/// `, did you mean "jitter"? Valid: cell, jitter`, the question only when there is a near one. A
/// long list of candidates is cut.
std::string hint_for(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace sunder
