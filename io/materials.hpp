// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "io/json_place.hpp"
#include "io/scene.hpp"

namespace sunder {

/// True for 1 to 40 letters, digits, _ and -.
bool is_name(std::string_view text);
/// Text of a key `name`: letters, digits, _ and - only, 1 to 40 of them. Throws as Place::fail.
std::string name_at(const Place& place);

/// Reads a list of materials: one with a known name changes the values it gives, another is added.
void read_materials(const Place& list, std::vector<Material>& materials);

/// `unknown material "x", did you mean …`; empty when the material is there.
std::string material_fault(const std::vector<Material>& materials, const std::string& name);

}  // namespace sunder
