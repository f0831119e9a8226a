// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>

#include "tests/stress/scenes.hpp"

namespace sunder::stress {
namespace {

struct Storeys {
  int x = 0, z = 0, count = 0;
  double bay_x = 0, bay_z = 0, height = 0;
};

Json joints(Dice& dice) {
  const auto one = [&](bool post) {
    Json made = {{"strength", dice.log_between(0.3, 2)},
                 {"interaction", dice.pick({"box", "linear", "ec3-i", "ellipsoid"})}};
    if (dice.chance(0.5)) made["rotation_capacity"] = dice.log_between(0.005, 0.2);
    if (post) made["bearing"] = true;
    return made;
  };
  return {{"post", one(true)}, {"beam", one(false)}};
}

Json building(Dice& dice, const Storeys& s) {
  Json made = {{"posts", {s.x, s.z}},
               {"storeys", s.count},
               {"storey_height", s.height},
               {"bay", {s.bay_x, s.bay_z}},
               {"post_section", dice.pick({"HEB200", "HEB300", "HEA300", "SHS250x12.5"})},
               {"beam_section", dice.pick({"IPE240", "IPE300", "IPE400", "HEA200"})},
               {"steel", dice.pick({"s235", "s355"})},
               {"live_load", dice.pick({0.0, 1000.0, 3000.0})},
               {"post_rule", dice.pick({"ec3", "euler", "unbraced", "none"})}};
  if (dice.chance(0.6)) made["joints"] = joints(dice);
  if (dice.chance(0.2)) made["slab"] = false;
  if (dice.chance(0.3)) made["walls"] = {{"thickness", dice.between(0.05, 0.3)}};
  return made;
}

std::string post_name(Dice& dice, const Storeys& s) {
  return "post_" + std::to_string(dice.whole(0, s.x - 1)) + "_" +
         std::to_string(dice.whole(0, s.z - 1)) + "_" + std::to_string(dice.whole(0, s.count - 1));
}

Json ball(Dice& dice, const Storeys& s) {
  const double radius = dice.log_between(0.1, 1);
  const double speed = dice.log_between(1, 60);
  const double aim_x = dice.unit() * s.bay_x * (s.x - 1), aim_y = dice.unit() * s.height * s.count;
  const double z = s.bay_z * (s.z - 1) + 2 * radius + dice.between(1, 3);
  return {{"radius", radius},
          {"mass", dice.log_between(10, 20000)},
          {"position", {aim_x, std::max(aim_y, 1.1 * radius), z}},
          {"velocity", {speed * dice.between(-0.3, 0.3), speed * dice.between(-0.2, 0.2), -speed}}};
}

Json simulation(Dice& dice) {
  Json made = {{"duration", dice.between(0.5, 2)},
               {"step", dice.log_between(1e-3, 0.02)},
               {"iterations", dice.whole(4, 40)},
               {"max_error", dice.log_between(1e-3, 0.2)}};
  if (dice.chance(0.2)) {
    made["solver"] = "bullet";
    made["settle"] = 0.3;
  }
  if (dice.chance(0.2)) made["quasi_static"] = true;
  if (dice.chance(0.2)) made["p_delta"] = true;
  if (dice.chance(0.2)) made["diaphragms"] = true;
  return made;
}

Scene scene_of(Dice& dice, Json building, const Storeys& s) {
  Json made = {{"sunder", 1}, {"seed", dice.whole(1, 1 << 30)}, {"building", std::move(building)}};
  const int what = dice.whole(0, 3);
  if (what != 1 || dice.chance(0.3)) made["projectiles"] = Json::array({ball(dice, s)});
  if (what == 1) made["scenario"] = {{"remove", Json::array({post_name(dice, s)})}};
  if (what == 2) made["scenario"] = {{"load_rate", dice.log_between(1e3, 1e5)}};
  made["simulation"] = simulation(dice);
  return {made, ""};
}

Storeys storeys(Dice& dice, int most) {
  return {dice.whole(2, most), dice.whole(2, most), dice.whole(1, most),
          dice.between(2, 9),  dice.between(2, 9),  dice.between(2.2, 6)};
}

}  // namespace

Scene building_scene(Dice& dice) {
  const Storeys s = storeys(dice, 4);
  return scene_of(dice, building(dice, s), s);
}

Scene panel_scene(Dice& dice) {
  const Storeys s = storeys(dice, 3);
  Json made = building(dice, s);
  const auto grid = [&](double size) {
    return Json{{"type", "voronoi-grid"}, {"cell", size}, {"jitter", dice.unit()}};
  };
  const double least = std::min(s.bay_x, s.bay_z);
  if (dice.chance(0.7))
    made["slab"] = {{"thickness", dice.between(0.08, 0.3)},
                    {"material", dice.pick({"concrete-c30-reinforced", "concrete-c30"})},
                    {"pattern", grid(least / dice.between(2, 6))}};
  if (dice.chance(0.7))
    made["walls"] = {{"thickness", dice.between(0.06, 0.25)},
                     {"material", dice.pick({"brick", "gypsum", "float-glass"})},
                     {"pattern", grid(std::min(least, s.height) / dice.between(2, 6))}};
  return scene_of(dice, std::move(made), s);
}

}  // namespace sunder::stress
