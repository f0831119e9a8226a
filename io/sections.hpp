// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "io/json_place.hpp"
#include "sim/section.hpp"

namespace sunder {

/// Built-in sections and steels (data/sections.json, compiled in).
const std::vector<Section>& builtin_sections();
const std::vector<SteelGrade>& builtin_steels();

/// Reads a list of sections: one with a known name changes the values it gives, another is added
/// and must give its shape and dimensions. What follows from dimensions that are given, and is not
/// given itself, is computed (with_properties). Throws as Place::fail.
void read_sections(const Place& list, std::vector<Section>& sections);
/// Reads a list of steels: one with a known name changes the values it gives, another is added and
/// must give its yield and ultimate strength.
void read_steels(const Place& list, std::vector<SteelGrade>& steels);

/// `unknown section "x", did you mean …`; empty when the section is there.
std::string section_fault(const std::vector<Section>& sections, const std::string& name);
/// The same of a steel.
std::string steel_fault(const std::vector<SteelGrade>& steels, const std::string& name);

}  // namespace sunder
