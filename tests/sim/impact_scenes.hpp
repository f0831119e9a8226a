// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "io/impact_scene.hpp"
#include "sim/impact.hpp"

namespace sunder {

/// A wall in the plane z = 0, hit in the middle by one ball from the front.
struct Shot {
  double width = 3, height = 2, thickness = 0.2;
  std::string material = "concrete-c30", pattern = R"({"type": "voronoi-grid", "cell": 0.25})";
  std::string anchors = R"(["bottom"])";
  double radius = 0.25, mass = 514, speed = 10;
  double duration = 0.5, step = 1.0 / 240;
  std::string simulation = "";  ///< more keys: ", \"gravity\": 0"
  std::uint64_t seed = 1;
};

inline std::string number_text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

inline std::string scene_text_of(const Shot& s) {
  const auto n = number_text_of;
  return R"({"sunder": 1, "seed": )" + std::to_string(s.seed) +
         R"(, "walls": [{"name": "wall", "outline": {"rect": [)" + n(s.width) + ", " +
         n(s.height) + R"(]}, "thickness": )" + n(s.thickness) + R"(, "material": ")" +
         s.material + R"(", "anchors": )" + s.anchors + R"(, "pattern": )" + s.pattern +
         R"(}], "projectiles": [{"radius": )" + n(s.radius) + R"(, "mass": )" + n(s.mass) +
         R"(, "position": [)" + n(s.width / 2) + ", " + n(s.height / 2) + ", " +
         n(s.thickness / 2 + 1.2 * s.radius) + R"(], "velocity": [0, 0, )" + n(-s.speed) +
         R"(]}], "simulation": {"duration": )" + n(s.duration) + R"(, "step": )" + n(s.step) +
         s.simulation + "}}";
}

inline ImpactScene impact_scene_of(const Shot& shot) {
  return impact_scene(parse_scene(scene_text_of(shot), "shot.json"));
}

inline ImpactResult run(const Shot& shot, const ImpactParams& params = {}) {
  return simulate_impact(impact_scene_of(shot), params);
}

}  // namespace sunder
