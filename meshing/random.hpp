// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace sunder {

/// 64 well-mixed bits from a 64-bit key: Pelle Evensen's "moremur" finaliser, a bijection.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x ^= x >> 27;
  x *= 0x3C79AC492BA7B653u;
  x ^= x >> 33;
  x *= 0x1C69B3F74AC4AE35u;
  x ^= x >> 27;
  return x;
}

/// Counter-based generator: the draw for an element is a pure function of (seed, element, draw),
/// so it depends neither on how many elements exist nor on the thread that asks.
/// Same bits on every machine; not for cryptography.
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t element,
                                    std::uint64_t draw = 0) {
  const std::uint64_t key = mix_bits(seed + 0x9E3779B97F4A7C15u);
  return mix_bits(mix_bits(key ^ (element * 0xD1342543DE82EF95u)) + draw * 0x9E3779B97F4A7C15u);
}

/// Uniform in [0, 1), 53 bits.
constexpr double random_unit(std::uint64_t seed, std::uint64_t element, std::uint64_t draw = 0) {
  return static_cast<double>(random_bits(seed, element, draw) >> 11) * 0x1p-53;
}

}  // namespace sunder
