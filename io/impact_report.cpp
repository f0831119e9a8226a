// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/impact_report.hpp"

#include <cassert>

#include "io/run_report.hpp"

namespace sunder {
namespace {

void write_damage(JsonLines& json, const ImpactResult& r) {
  json.count("bodies", r.bodies);
  json.count("merged_bodies", r.merged_bodies);
  json.count("chunks", r.chunks);
  json.count("chunks_freed", r.chunks_freed);
  json.count("chunks_split", r.chunks_split);
  json.open("broken_joints", '[');
  json.close();
  json.count("broken_bonds", r.broken_bonds);
  json.number("crack_area", r.crack_area);
  json.number("freed_mass", r.freed_mass);
  json.open("freed", '{');
  json.number("largest_mass", r.largest_freed_mass);
  json.open("by_decade", '[');
  for (const std::uint64_t each : r.freed_by_decade) json.count(each);
  json.close();
  json.close();
  json.number("max_utilisation", r.max_utilisation);
  json.null("sag");
}

void write_balance(JsonLines& json, const ImpactResult& r) {
  json.open("reactions", '{');
  json.point("impulse", {r.reactions[0], r.reactions[1], r.reactions[2]});
  json.close();
  json.number("momentum_error", r.momentum_error);
  json.number("penetration_max", r.penetration_max);
  json.open("energy", '{');
  write_ledger(json, r.energy_in, r.energy);
  json.number("peak_ratio", r.energy_peak_ratio);
  json.close();
}

void write_breaks(JsonLines& json, const Recording& recording) {
  json.open("breaks", '[');
  for (const BreakEvent& event : recording.events) {
    assert(event.wall < recording.walls.size());
    json.open('{');
    json.number("time", event.time);
    json.text("wall", recording.walls[event.wall].asset.wall.name);
    json.point("point", event.point);
    json.number("speed", event.speed);
    json.number("utilisation", event.utilisation);
    json.count("bonds_broken", event.bonds_broken);
    json.count("chunks_freed", event.chunks_freed);
    json.close();
  }
  json.close();
}

void write_work(JsonLines& json, const ImpactResult& r) {
  write_solves_and_hash(json, {}, r.hash);
  json.open("skipped", '{');
  json.count("walls_untouched", r.walls_untouched);
  json.count("hulls_not_built", r.hulls_not_built);
  json.count("chunk_steps_not_simulated", r.chunk_steps_not_simulated);
  json.count("body_steps_asleep", r.body_steps_asleep);
  json.count("cells_not_searched", r.cells_not_searched);
  json.count("poses_not_recorded", r.poses_not_recorded);
  json.close();
}

}  // namespace

std::string impact_report_json(const ImpactReport& report) {
  return json_text([&](JsonLines& json) {
    const ImpactResult& result = report.result;
    json.open('{');
    write_run(json, report.version, report.seed, report.wall_s, result);
    write_settings(json, report.settings);
    write_damage(json, result);
    write_balance(json, result);
    write_projectiles(json, result.projectiles);
    write_breaks(json, result.recording);
    write_work(json, result);
    write_end(json, result.warnings, report.times);
    json.close();
  });
}

}  // namespace sunder
