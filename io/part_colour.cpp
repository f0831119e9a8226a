// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/part_colour.hpp"

#include <algorithm>

namespace sunder {

Lights lights_of(const std::array<EndLoad, 2>& loads) {
  Lights lights{};
  for (std::size_t end = 0; end < 2; ++end) {
    const EndLoad& load = loads[end];
    if (load.has_failed) {
      lights[3 * end + 2] = 1;
      continue;
    }
    lights[3 * end] = std::clamp(load.force, 0.0, 1.0);
    lights[3 * end + 1] = std::clamp(load.torque, 0.0, 1.0);
  }
  return lights;
}

bool is_lit(const Lights& lights) {
  return std::ranges::any_of(lights, [](double light) { return light > kLeastLight; });
}

// The light's own channel grows by 1, the others lose what the member has: so two lights together
// still add up to 1 in both their channels.
Colour light_colour(std::size_t light, const Colour& own) {
  Colour colour{-own[0], -own[1], -own[2]};
  colour[light % 3] = 1;
  return colour;
}

Colour lit_colour(const Colour& own, const Lights& lights, const float* near) {
  Colour colour = own;
  for (std::size_t light = 0; light < kLights; ++light) {
    const double share = lights[light] * static_cast<double>(near[light / 3]);
    const Colour full = light_colour(light, own);
    for (std::size_t k = 0; k < 3; ++k) colour[k] += share * full[k];
  }
  for (double& channel : colour) channel = std::clamp(channel, 0.0, 1.0);
  return colour;
}

MemberLook member_look(std::string_view material) {
  const MaterialLook look = look_of(material);
  MemberLook member{.roughness = look.outer_roughness, .metallic = 0.3 * look.metallic};
  for (std::size_t k = 0; k < 3; ++k) {
    member.colour[k] = static_cast<std::uint8_t>(look.outer[k] * 5 / 8);
  }
  return member;
}

ViewMaterial member_material(const std::string& material) {
  const MemberLook look = member_look(material);
  return {.name = material, .metallic = look.metallic, .roughness = look.roughness};
}

}  // namespace sunder
