// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/solid_scene.hpp"

#include "cli/usage.hpp"

namespace sunder {
namespace {

std::string crater_json(const std::string& text) {
  constexpr const char* kForm = "X,Y,Z:RADIUS or X,Y,Z:RADIUS:DEPTH in metres";
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() != 2 && parts.size() != 3) usage("--carve " + text + ": expected " + kForm);
  std::string json = "{\"centre\": " + triple_json("--carve", text, parts[0], kForm);
  const auto add = [&](const char* key, const std::string& part) {
    json +=
        std::string(", \"") + key + "\": " + numbers("--carve", text, part, ':', 1, kForm).front();
  };
  add("radius", parts[1]);
  if (parts.size() == 3) add("depth", parts[2]);
  return json + "}";
}

}  // namespace

std::string scene_text(const std::string& model, const SolidOptions& solid,
                       const PatternOptions& pattern) {
  std::string text = "{\"sunder\": 1, \"solids\": [{\"file\": " + quoted(model);
  for (const auto& [key, value] : solid.keys) {
    const bool is_text = key == "name" || key == "material";
    if (!value.empty())
      text += ", \"" + key + "\": " + (is_text ? quoted(value) : value_json(value));
  }
  if (solid.repair) text += ", \"repair\": true";
  std::vector<std::string> craters;
  for (const std::string& crater : solid.craters) craters.push_back(crater_json(crater));
  if (!craters.empty()) text += ", \"craters\": " + list_json(craters);
  return text + ", \"pattern\": " + pattern_json("voronoi", pattern, solid.forms) + "}]}";
}

}  // namespace sunder
