// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "meshing/vec.hpp"

namespace sunder {

/// Valid values of a number: [low, high], or (low, high] when `open`.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open = false;
  bool contains(double value) const { return (open ? value > low : value >= low) && value <= high; }
};

/// One row of a parameter struct's table: name in files, member, unit, what it does, valid values.
/// The same row feeds the scene reader, its range checks, the JSON schema and the documentation.
template <class Params>
struct Field {
  using Member =
      std::variant<double Params::*, std::int64_t Params::*, bool Params::*, std::string Params::*,
                   std::vector<std::string> Params::*, std::vector<Vec2> Params::*, Vec3 Params::*,
                   std::vector<Vec3> Params::*>;
  std::string_view name;
  Member member;
  std::string_view unit;
  std::string_view effect;
  Range range = {};
  std::span<const std::string_view> choices = {};  ///< valid words of a text (or list of texts)
  bool required = false;
};

/// The table of a parameter struct; specialised beside each struct.
template <class Params>
std::span<const Field<Params>> fields();

}  // namespace sunder
