// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/strip_stress.hpp"
#include "io/wall_view.hpp"

namespace sunder {

/// Red, green and blue, 0 … 1.
using Colour = std::array<double, 3>;

/// Brightness of the lights on a member's ends, 0 … 1: force, torque and failure at end 0, then at
/// end 1. They are the utilisations, cut off at 1; where a joint failed only that light is on.
constexpr std::size_t kLights = 6;
using Lights = std::array<double, kLights>;
Lights lights_of(const std::array<EndLoad, 2>& loads);

/// Loads below this utilisation are not shown.
constexpr double kLeastLight = 1.0 / 64;
bool is_lit(const Lights& lights);

/// What a light at full brightness adds to a member's own colour. Cut off at 0 and 1, the sum is
/// pure red for force, green for torque, yellow for both, blue for failure.
Colour light_colour(std::size_t light, const Colour& own);
/// Colour of a vertex whose nearness to the ends is `near` (see PartMesh).
Colour lit_colour(const Colour& own, const Lights& lights, const float* near);

/// Members are darker than walls of the same material and dull enough to show the lights.
struct MemberLook {
  std::array<std::uint8_t, 3> colour{};  ///< sRGB
  double roughness = 0.5, metallic = 0;
};
MemberLook member_look(std::string_view material);
/// White: the colour is in the vertices.
ViewMaterial member_material(const std::string& material);

}  // namespace sunder
