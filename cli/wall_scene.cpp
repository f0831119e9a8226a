// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/wall_scene.hpp"

#include "cli/usage.hpp"

namespace sunder {
namespace {

std::string opening_json(const std::string& text) {
  constexpr const char* kForm = "WxH@X,Y in metres";
  const std::vector<std::string> parts = split(text, '@');
  if (parts.size() != 2) usage("--opening " + text + ": expected " + kForm);
  const auto size = numbers("--opening", text, parts[0], 'x', 2, kForm);
  const auto at = numbers("--opening", text, parts[1], ',', 2, kForm);
  return "{\"rect\": [" + size[0] + ", " + size[1] + "], \"at\": [" + at[0] + ", " + at[1] + "]}";
}

}  // namespace

std::string scene_text(const WallOptions& wall, const PatternOptions& pattern) {
  const auto size =
      numbers("--wall", wall.size, wall.size, 'x', 3, "WIDTHxHEIGHTxTHICKNESS in metres");
  std::string text = "{\"sunder\": 1, \"walls\": [{\"outline\": {\"rect\": [" + size[0] + ", " +
                     size[1] + "]}, \"thickness\": " + size[2];
  for (const auto& [key, value] : wall.keys)
    if (!value.empty())
      text += ", \"" + key + "\": " + (key == "min_cell" ? value_json(value) : quoted(value));
  std::vector<std::string> openings, anchors;
  for (const std::string& opening : wall.openings) openings.push_back(opening_json(opening));
  if (!openings.empty()) text += ", \"openings\": " + list_json(openings);
  if (!wall.anchors.empty())
    for (const std::string& side : split(wall.anchors, ',')) anchors.push_back(quoted(side));
  if (!anchors.empty()) text += ", \"anchors\": " + list_json(anchors);
  return text + ", \"pattern\": " + pattern_json("voronoi-grid", pattern, wall.forms) + "}]}";
}

}  // namespace sunder
