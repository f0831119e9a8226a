// SPDX-License-Identifier: GPL-3.0-or-later
// Frame buildings for tests and benchmarks.
#pragma once

#include "sim/collapse.hpp"

namespace sunder {

inline Section i_section(const char* name, double height, double width, double web, double flange,
                         double radius, const char* curve_y, const char* curve_z) {
  Section section;
  section.name = name;
  section.height = height;
  section.width = width;
  section.web = web;
  section.flange = flange;
  section.radius = radius;
  section.curve_y = curve_y;
  section.curve_z = curve_z;
  return with_properties(section);
}

/// A frame's catalogue: HEB200, HEB300, IPE300, S235, C30 concrete, brick.
inline Frame empty_frame() {
  Frame frame;
  frame.sections = {i_section("HEB300", 0.3, 0.3, 0.011, 0.019, 0.027, "b", "c"),
                    i_section("HEB200", 0.2, 0.2, 0.009, 0.015, 0.018, "b", "c"),
                    i_section("IPE300", 0.3, 0.15, 0.0071, 0.0107, 0.015, "a", "b")};
  SteelGrade steel;
  steel.name = "s235";
  frame.steels = {steel};
  Material concrete, brick;
  concrete.name = "concrete-c30";
  concrete.density = 2400;
  brick.name = "brick";
  brick.density = 1800;
  frame.materials = {concrete, brick};
  return frame;
}

/// posts × rows × storeys, 6 m bays, 3.5 m high, no walls; joined. Every part a rigid body.
inline CollapseScene regular_scene(std::size_t posts, std::size_t rows, std::size_t storeys,
                                   const StoreyParams& storey = {}) {
  CollapseScene scene;
  scene.simulation.solver = "bullet";
  scene.frame = empty_frame();
  RegularBuilding building;
  building.bays_x.assign(posts - 1, 6);
  building.bays_z.assign(rows - 1, 6);
  building.storeys.assign(storeys, storey);
  add_regular(scene.frame, building);
  join(scene.frame);
  return scene;
}

inline std::uint32_t part_named(const Frame& frame, const std::string& name) {
  for (std::uint32_t part = 0; part < frame.part_count(); ++part)
    if (frame.part_name(part) == name) return part;
  return kNoPart;
}
inline std::uint32_t joint_named(const Frame& frame, const std::string& name) {
  for (std::uint32_t joint = 0; joint < frame.joints.size(); ++joint)
    if (frame.joints[joint].name == name) return joint;
  return kNoPart;
}

}  // namespace sunder
