// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/collapse_report.hpp"

#include <algorithm>
#include <cassert>

namespace sunder {
namespace {

void write_joints(JsonLines& json, const Frame& frame, const CollapseResult& r) {
  json.open("broken_joints", '[');
  for (const JointBreak& each : r.broken_joints) {
    json.open('{');
    json.text("joint", joint_name(frame, r, each.joint));
    json.number("time", each.time);
    json.number("utilisation", each.utilisation);
    json.text("mode", each.mode);
    json.text("rule", each.rule);
    json.text("component", each.component);
    json.close();
  }
  json.close();
  json.open("yielded_joints", '[');
  for (const JointYield& each : r.yielded_joints) {
    json.open('{');
    json.text("joint", joint_name(frame, r, each.joint));
    json.number("time", each.time);
    json.number("utilisation", each.utilisation);
    json.number("rotation", each.rotation);
    json.close();
  }
  json.close();
  const auto counts = count_by_mode(r);
  json.open("broken_by", '{');
  for (std::size_t i = 0; i < counts.size(); ++i) json.count(kBreakModes[i], counts[i]);
  json.close();
  json.count("broken_at_rest", r.broken_at_rest);
  json.count("members_divided", r.members_divided);
  json.open("buckles", '[');
  for (const Buckling& each : r.buckles) {
    json.open('{');
    json.number("time", each.time);
    json.text("what", each.what);
    json.close();
  }
  json.close();
}

void write_damage(JsonLines& json, const Frame& frame, const CollapseResult& r) {
  json.count("bodies", r.bodies);
  json.count("merged_bodies", r.merged_bodies);
  json.count("parts_freed", r.parts_freed);
  json.open("panels", '{');
  json.count("count", r.panels);
  json.count("meshed", r.panels_meshed);
  json.count("broken", r.panels_broken);
  json.count("solves", r.panel_solves);
  json.close();
  json.count("chunks", r.chunks);
  json.count("chunks_freed", r.chunks_freed);
  json.count("chunks_split", r.chunks_split);
  write_joints(json, frame, r);
  json.count("broken_bonds", r.broken_bonds);
  json.number("crack_area", r.crack_area);
  json.number("max_utilisation", r.max_utilisation);
  json.number("utilisation_at_rest", r.utilisation_at_rest);
  json.number("first_failure_load", r.first_failure_load);
  json.number("joint_gap", r.joint_gap);
  json.open("sag", '{');
  json.number("mean", r.sag_mean);
  json.number("max", r.sag_max);
  json.text("node", r.sag_node);
  json.number("end", r.sag_end);
  json.close();
}

void write_reactions(JsonLines& json, const Frame& frame, const CollapseResult& r) {
  json.open("reactions", '{');
  json.number("weight", r.weight);
  json.number("error", r.reaction_error);
  json.open("supports", '[');
  for (const SupportReaction& each : r.supports) {
    assert(each.node < frame.nodes.size());
    json.open('{');
    json.text("node", frame.nodes[each.node].name);
    json.point("force", each.force);
    json.point("torque", each.torque);
    json.close();
  }
  json.close();
  json.point("impulse", {r.reactions[0], r.reactions[1], r.reactions[2]});
  json.close();
}

void write_balance(JsonLines& json, const CollapseResult& r) {
  json.number("momentum_error", r.momentum_error);
  json.number("penetration_max", r.penetration_max);
  json.open("energy", '{');
  write_ledger(json, r.energy_in, r.energy);
  json.number("joint", r.joint_work);
  json.number("damping", r.damping);
  json.number("plastic", r.plastic);
  json.close();
}

void write_solver(JsonLines& json, const SimulationParams& params, const CollapseResult& r) {
  json.open("solver", '{');
  json.text("name", params.solver);
  json.text("joint_solver", params.joint_solver);
  json.count("iterations", static_cast<std::uint64_t>(params.iterations));
  json.truth("warm_start", params.warm_start);
  json.number("step", params.step);
  json.count("fallbacks", r.solver_fallbacks);
  json.number("residual", r.residual);
  json.close();
}

void write_skipped(JsonLines& json, const CollapseResult& r) {
  json.open("skipped", '{');
  json.count("body_steps_asleep", r.body_steps_asleep);
  json.count("joint_steps_not_read", r.joint_steps_not_read);
  json.count("poses_not_recorded", r.poses_not_recorded);
  json.count("panels_not_meshed", r.panels_not_meshed);
  json.count("panel_solves", r.panel_solves_skipped);
  json.close();
}

}  // namespace

std::array<std::uint64_t, kBreakModes.size()> count_by_mode(const CollapseResult& result) {
  std::array<std::uint64_t, kBreakModes.size()> counts{};
  for (std::size_t i = 0; i < counts.size(); ++i)
    counts[i] = static_cast<std::uint64_t>(
        std::ranges::count(result.broken_joints, kBreakModes[i], &JointBreak::mode));
  return counts;
}

const std::string& joint_name(const Frame& frame, const CollapseResult& result,
                              std::uint32_t joint) {
  return joint < frame.joints.size() ? frame.joints[joint].name
                                     : result.recording.joints[joint].name;
}

std::string collapse_report_json(const CollapseReport& report) {
  return json_text([&](JsonLines& json) {
    const CollapseScene& scene = report.scene;
    const CollapseResult& result = report.result;
    json.open('{');
    write_run(json, report.version, scene.seed, report.wall_s, result);
    write_settings(json, report.settings);
    write_damage(json, scene.frame, result);
    write_reactions(json, scene.frame, result);
    write_balance(json, result);
    write_projectiles(json, result.projectiles);
    write_solver(json, scene.simulation, result);
    write_solves_and_hash(json, result.solves, result.hash);
    write_skipped(json, result);
    write_end(json, result.warnings, report.times);
    json.close();
  });
}

}  // namespace sunder
