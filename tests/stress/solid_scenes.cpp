// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cstdio>
#include <numbers>
#include <vector>

#include "tests/stress/scenes.hpp"

namespace sunder::stress {
namespace {

struct Model {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> faces;
};

/// A grid of quads that closes in both directions: a ring of any cross-section.
Model ring(Dice& dice) {
  const int around = dice.whole(3, 40), across = dice.whole(3, 24);
  const double thin = dice.between(0.02, 0.45), flat = dice.log_between(0.1, 3);
  Model made;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double r = 1 + thin * std::cos(b);
      made.points.push_back({r * std::cos(a), thin * flat * std::sin(b), r * std::sin(a)});
    }
  const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      made.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      made.faces.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return made;
}

/// A star-shaped body about the origin: round, a box's like, or bumpy.
Model blob(Dice& dice) {
  const int around = dice.whole(3, 36), rows = dice.whole(1, 20);
  const double bumps = dice.pick({0.0, 0.1, 0.5});
  const std::array<double, 3> stretch = {dice.log_between(0.2, 5), dice.log_between(0.2, 5),
                                         dice.log_between(0.2, 5)};
  Model made;
  const auto add = [&](double x, double y, double z) {
    const double r = 1 + bumps * (dice.unit() - 0.5);
    made.points.push_back({r * x * stretch[0], r * y * stretch[1], r * z * stretch[2]});
  };
  add(0, 1, 0);
  add(0, -1, 0);
  for (int i = 1; i <= rows; ++i)
    for (int j = 0; j < around; ++j) {
      const double a = std::numbers::pi * i / (rows + 1), b = 2 * std::numbers::pi * j / around;
      add(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
    }
  const auto at = [&](int i, int j) { return 2 + (i - 1) * around + j % around; };
  for (int j = 0; j < around; ++j) {
    made.faces.push_back({0, at(1, j + 1), at(1, j)});
    made.faces.push_back({1, at(rows, j), at(rows, j + 1)});
    for (int i = 1; i < rows; ++i) {
      made.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      made.faces.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return made;
}

Model box(Dice& dice) {
  const double x = dice.log_between(0.01, 3), y = dice.log_between(0.1, 3);
  Model made;
  for (int i = 0; i < 8; ++i)
    made.points.push_back({(i & 1) * x, (i >> 1 & 1) * y, (i >> 2) * 1.0});
  made.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return made;
}

Model any_model(Dice& dice) {
  switch (dice.whole(0, 2)) {
    case 0: return ring(dice);
    case 1: return blob(dice);
    default: return box(dice);
  }
}

void damage(Dice& dice, Model& model) {
  std::vector<std::array<int, 3>> kept;
  const double missing = dice.pick({0.0, 0.02, 0.1}), turned = dice.pick({0.0, 0.05, 1.0}),
               doubled = dice.pick({0.0, 0.05});
  for (auto face : model.faces) {
    if (dice.chance(missing)) continue;
    if (dice.chance(turned)) std::swap(face[0], face[1]);
    kept.push_back(face);
    if (dice.chance(doubled)) kept.push_back(face);
  }
  if (!kept.empty()) model.faces = kept;
}

std::string obj(const Model& model, double scale, double away) {
  std::string text;
  char line[128];
  for (const auto& p : model.points) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", scale * (p[0] + away),
                  scale * (p[1] + away), scale * (p[2] - away));
    text += line;
  }
  for (const auto& f : model.faces) {
    std::snprintf(line, sizeof line, "f %d %d %d\n", f[0] + 1, f[1] + 1, f[2] + 1);
    text += line;
  }
  return text;
}

Json solid_pattern(Dice& dice, double scale, double away) {
  const double middle = scale * away;
  switch (dice.whole(0, 3)) {
    case 0: {
      Json made = {{"type", "voronoi"}, {"chunks", dice.whole(1, 120)}};
      if (dice.chance(0.3)) {
        made["near"] = Json::array({Json{middle, middle, -middle}});
        made["radius"] = scale * dice.log_between(0.01, 1);
      }
      return made;
    }
    case 1: {
      Json made = {{"type", "slices"},
                   {"slices", {dice.whole(0, 5), dice.whole(0, 5), dice.whole(0, 5)}},
                   {"offset_variation", dice.unit()},
                   {"angle_variation_deg", dice.pick({0.0, 10.0, 40.0})}};
      if (dice.chance(0.3)) {
        made["amplitude"] = scale * 0.03;
        made["wavelength"] = scale * dice.between(0.2, 1);
      }
      return made;
    }
    case 2:
      return {{"type", "radial"},
              {"centre", {middle, middle, -middle}},
              {"axis", {dice.unit(), dice.unit(), 1.0}},
              {"rays", dice.whole(2, 16)},
              {"rings", dice.whole(0, 5)},
              {"radius", scale * dice.between(0.3, 2)}};
    default:
      return {{"type", "brick"},
              {"brick", {scale * 0.7, scale * 0.3, scale * 0.4}},
              {"mortar", dice.chance(0.5) ? scale * 0.02 : 0.0}};
  }
}

Scene scene_of(Dice& dice, const Model& model, bool repair) {
  const double scale = dice.log_between(1e-3, 1e3);
  const double away = dice.pick({0.0, 1.0, 20.0});
  Json solid = {{"file", kModelFile}, {"pattern", solid_pattern(dice, scale, away)}};
  if (repair) solid["repair"] = true;
  if (!repair && dice.chance(0.2)) solid["roughness"] = scale * 0.01;
  solid["position"] = {dice.between(-10, 10), 0, 0};
  solid["rotation_deg"] = {dice.between(-90, 90), dice.between(-90, 90), 0};
  return {{{"sunder", 1}, {"seed", dice.whole(1, 1 << 30)}, {"solids", Json::array({solid})}},
          obj(model, scale, away)};
}

}  // namespace

Scene solid_scene(Dice& dice) {
  const Model model = any_model(dice);
  return scene_of(dice, model, false);
}

Scene broken_model_scene(Dice& dice) {
  Model model = any_model(dice);
  damage(dice, model);
  return scene_of(dice, model, true);
}

}  // namespace sunder::stress
