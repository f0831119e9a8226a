// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/suggest.hpp"

#include <algorithm>

namespace sunder {
namespace {

constexpr std::size_t kMostEdits = 2;
constexpr std::size_t kMostListed = 24;

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit) {
  const std::size_t gap = std::max(a.size(), b.size()) - std::min(a.size(), b.size());
  if (gap > limit) return limit + 1;  // also keeps a hostile word from costing anything
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char ca = lower(a[i - 1]), cb = lower(b[j - 1]);
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, row[j - 1] + (ca != cb)});
      if (i > 1 && j > 1 && ca == lower(b[j - 2]) && lower(a[i - 2]) == cb) {
        next[j] = std::min(next[j], before[j - 2] + 1);
      }
    }
    before.swap(row);
    row.swap(next);
  }
  return std::min(row[b.size()], limit + 1);
}

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates) {
  std::string_view best;
  std::size_t best_distance = kMostEdits + 1;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > word.size() + kMostEdits ||
        word.size() > candidate.size() + kMostEdits) {
      continue;
    }
    const std::size_t distance = edit_distance(word, candidate, kMostEdits);
    if (distance < best_distance && distance < std::min(word.size(), candidate.size())) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string hint_for(std::string_view word, std::span<const std::string_view> candidates) {
  std::string hint;
  const std::string_view near = nearest_word(word, candidates);
  if (!near.empty()) hint += ", did you mean \"" + std::string(near) + "\"?";
  if (candidates.empty()) return hint;
  hint += near.empty() ? "; valid: " : " Valid: ";
  for (std::size_t i = 0; i < std::min(candidates.size(), kMostListed); ++i) {
    hint += (i ? ", " : "") + std::string(candidates[i]);
  }
  if (candidates.size() > kMostListed) hint += ", …";
  return hint;
}

}  // namespace sunder
