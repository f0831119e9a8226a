// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sim/frame.hpp"

namespace sunder {

/// Sections, steel and materials, no parts yet. HEB300 and IPE300 as the mills print them.
inline Frame stocked_frame() {
  Frame frame;
  frame.sections = {{.name = "HEB300",
                     .height = 0.3,
                     .width = 0.3,
                     .web = 0.011,
                     .flange = 0.019,
                     .radius = 0.027,
                     .area = 149.1e-4,
                     .iy = 25170e-8,
                     .iz = 8563e-8,
                     .it = 185e-8,
                     .wpl_y = 1869e-6,
                     .wpl_z = 870.1e-6,
                     .avy = 114e-4,
                     .avz = 47.43e-4,
                     .wt = 97.4e-6,
                     .source = "ArcelorMittal"},
                    {.name = "IPE300",
                     .height = 0.3,
                     .width = 0.15,
                     .web = 0.0071,
                     .flange = 0.0107,
                     .radius = 0.015,
                     .area = 53.81e-4,
                     .iy = 8356e-8,
                     .iz = 603.8e-8,
                     .it = 20.12e-8,
                     .wpl_y = 628.4e-6,
                     .wpl_z = 125.2e-6,
                     .avy = 32.1e-4,
                     .avz = 25.68e-4,
                     .wt = 18.8e-6,
                     .source = "ArcelorMittal"}};
  frame.steels = {{.name = "s235", .source = "EN 1993-1-1, table 3.1"}};
  frame.materials = {{.name = "concrete-c30", .density = 2400, .source = ""},
                     {.name = "brick", .density = 1800, .source = ""}};
  return frame;
}

/// Storeys alike, each 3.5 m, bays of 6 m.
inline RegularBuilding regular(std::size_t posts_x, std::size_t posts_z, std::size_t storeys,
                               double wall_thickness = 0) {
  RegularBuilding building;
  building.bays_x.assign(posts_x - 1, 6);
  building.bays_z.assign(posts_z - 1, 6);
  building.storeys.assign(storeys, {.wall_thickness = wall_thickness});
  return building;
}

inline Frame joined(const RegularBuilding& building) {
  Frame frame = stocked_frame();
  add_regular(frame, building);
  join(frame);
  return frame;
}

inline std::uint32_t add_node(Frame& frame, Vec3 position, bool support = false) {
  const auto number = static_cast<std::uint32_t>(frame.nodes.size());
  frame.nodes.push_back({"node_" + std::to_string(number), position, support});
  return number;
}

inline std::uint32_t add_member(Frame& frame, const std::string& name, FrameMember::Kind kind,
                                std::uint32_t from, std::uint32_t to, std::uint32_t section = 1) {
  frame.members.push_back({.name = name, .kind = kind, .from = from, .to = to, .section = section});
  return static_cast<std::uint32_t>(frame.members.size()) - 1;
}
inline std::uint32_t add_beam(Frame& frame, const std::string& name, std::uint32_t from,
                              std::uint32_t to) {
  return add_member(frame, name, FrameMember::Kind::beam, from, to);
}

/// Number of the part with that name; kNoPart: none.
inline std::uint32_t find_part(const Frame& frame, const std::string& name) {
  for (std::uint32_t p = 0; p < frame.part_count(); ++p) {
    if (frame.part_name(p) == name) return p;
  }
  return kNoPart;
}

/// One line per defect: "<part> <what>".
inline std::string text_of(const std::vector<FrameDefect>& defects) {
  std::string text;
  for (const FrameDefect& d : defects) text += d.part + " " + d.what + "\n";
  return text;
}

}  // namespace sunder
