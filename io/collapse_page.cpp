// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>

#include "io/run_page.hpp"

namespace sunder {
namespace {

/// Those that came in where members divided too.
std::size_t joint_count(const CollapseReport& report) {
  return std::max(report.scene.frame.joints.size(), report.result.recording.joints.size());
}

std::size_t part_count(const CollapseReport& report) {
  return report.scene.frame.part_count() + report.result.members_divided;
}

const std::string& joint_name(const CollapseReport& report, std::uint32_t joint) {
  return joint_name(report.scene.frame, report.result, joint);
}

std::string lede_of(const CollapseReport& report) {
  const CollapseResult& r = report.result;
  const std::string joints = count_text(joint_count(report)), time = moment_text(r.simulated_s);
  const auto first = std::ranges::find_if(
      r.broken_joints, [](const JointBreak& each) { return each.mode != "removed"; });
  if (first == r.broken_joints.end()) {
    const std::string but =
        r.broken_joints.empty()
            ? ""
            : joined({" but the ", count_text(r.broken_joints.size()), " of what was taken away"});
    return joined({"The building stands: in ", time, " none of its ", joints, " joints broke", but,
                   ". The largest utilisation was ", digits_text(r.max_utilisation),
                   report.scene.rules.breaking ? "; 1 breaks."
                                               : "; 1 would break, but joints were told to hold."});
  }
  return joined({count_text(r.broken_joints.size()), " of ", joints, " joints broke and ",
                 count_text(r.parts_freed), " of ", count_text(part_count(report)),
                 " parts came loose in ", time, ". The first joint to go was ",
                 joint_name(report, first->joint), ", at ", moment_text(first->time), " (",
                 first->mode, ")."});
}

std::vector<Tile> tiles_of(const CollapseReport& report) {
  const CollapseResult& r = report.result;
  std::vector<Tile> tiles = {
      {"joints broken", count_text(r.broken_joints.size()),
       "of " + count_text(joint_count(report)) +
           (r.yielded_joints.empty() ? "" : ", " + count_text(r.yielded_joints.size()) + " bent")},
      {"parts loose", count_text(r.parts_freed), "of " + count_text(part_count(report))},
      {"utilisation at rest", digits_text(r.utilisation_at_rest),
       "1 breaks; later up to " + digits_text(r.max_utilisation)}};
  if (r.panels > 0)
    tiles.push_back({"slabs and walls broken", count_text(r.panels_broken),
                     "of " + count_text(r.panels) + "; " + count_text(r.broken_bonds) + " bonds, " +
                         digits_text(r.crack_area) + " m² of cracks"});
  if (r.first_failure_load > 0)
    tiles.push_back(
        {"load at first failure", digits_text(1e-3 * r.first_failure_load), "kN/m² of live load"});
  tiles.push_back({"energy set free", quantity_text(energy_set_free(r.energy), "J"),
                   quantity_text(r.energy_in, "J") + " went in"});
  tiles.push_back({"a step", time_text(1e-3 * r.step_ms_median),
                   "95 % within " + time_text(1e-3 * r.step_ms_p95) + ", longest " +
                       time_text(1e-3 * r.step_ms_max)});
  return tiles;
}

void write_head(HtmlPage& page, const CollapseReport& report, const PageSource& source) {
  const CollapseResult& r = report.result;
  page.lede(lede_of(report));
  const std::vector<std::pair<std::string, std::string>> facts = {
      {"input", source.input},
      {"seed", std::to_string(report.scene.seed)},
      {"solver", report.scene.simulation.solver},
      {"simulated", moment_text(r.simulated_s)},
      {"computed in", time_text(report.wall_s)}};
  page.facts(facts);
  page.end_header();
  page.notices(r.warnings);
  page.tiles(tiles_of(report));
}

std::vector<Html> curves_of(const CollapseReport& report) {
  const std::vector<RunSample>& series = report.result.recording.series;
  if (series.empty()) return {};
  std::vector<Html> curves = {
      count_curve("Broken joints", series, &RunSample::broken_joints, 1,
                  joined({"Of ", count_text(joint_count(report)), " joints."})),
      utilisation_curve(series,
                        "Demand by capacity of the joint or post that is used most; it breaks at "
                        "the dashed line.")};
  if (report.result.panels > 0)
    curves.push_back(
        count_curve("Broken bonds", series, &RunSample::broken_bonds, 3, "In slabs and walls."));
  curves.push_back(
      count_curve("Moving bodies", series, &RunSample::moving, 2, "Bodies that are not at rest."));
  return curves;
}

void write_course(HtmlPage& page, const CollapseReport& report) {
  const CollapseResult& r = report.result;
  const EnergyLedger& e = r.energy;
  std::vector<EnergyKind> kinds = {
      {"kinetic", e.kinetic, &RunSample::kinetic, "of everything that still moves"},
      {"potential", e.potential, &RunSample::potential, "of its height, against standing"},
      {"fracture", e.fracture, &RunSample::fracture,
       "stored where something broke, and new crack surface"},
      {"friction", e.friction, &RunSample::friction, "sliding"},
      {"contact", e.contact, &RunSample::contact, "crushing and blows that do not bounce"},
      {"strain", e.strain, &RunSample::strain,
       "of what stands: elastic, and its weight as it sags"},
      {"damping", r.damping, &RunSample::damping, "of the ringing frame"},
      {"plastic", r.plastic, &RunSample::plastic, "bent joints"}};
  if (report.scene.simulation.solver == "bullet")
    kinds.push_back({"joints", r.joint_work, &RunSample::joint, "shocks in rigid joints"});
  kinds.push_back({"numerical", e.numerical, &RunSample::numerical, "what remains: the error"});
  write_course(page, curves_of(report), r.recording.series, r.energy_in, kinds);
}

void write_trust(HtmlPage& page, const CollapseReport& report) {
  const CollapseResult& r = report.result;
  const SimulationParams& simulation = report.scene.simulation;
  const bool is_hybrid = simulation.solver == "hybrid";
  std::vector<AccuracyRow> rows = {
      settings_row(report.settings),
      {"Reactions", share_text(r.reaction_error), r.reaction_error,
       "How far the sum of what the feet bear at rest is off the building's weight."},
      momentum_row(r.momentum_error),
      numerical_row(r.energy, r.energy_in)};
  if (is_hybrid)
    rows.push_back({"Residual", share_text(r.residual), r.residual,
                    "How far forces were out of balance in the elastic frame, at worst."});
  rows.push_back({"Joint gap",
                  quantity_text(r.joint_gap, "m"),
                  {},
                  is_hybrid ? "Widest opening between the two sides of a joint that holds: this "
                              "solver leaves none."
                            : "Widest opening between the two sides of a joint that holds."});
  rows.push_back(penetration_row(r.penetration_max));
  std::vector<std::pair<std::string, std::string>> settings = {
      {"solver", simulation.solver},
      {"step", time_text(simulation.step)},
      {"substeps", count_text(r.substeps)},
      {"iterations", std::to_string(simulation.iterations)},
      {"chosen by max_error", chosen_text(report.settings.choice)}};
  if (is_hybrid)
    settings.emplace_back("factors of the frame", count_text(r.solves.full) + " full, " +
                                                      count_text(r.solves.update) + " updates");
  else
    settings.emplace_back("joints by", simulation.joint_solver + ", " +
                                           count_text(r.solver_fallbacks) + " fallbacks");
  write_accuracy(page, simulation.max_error, rows, settings);
}

std::string modes_of(const CollapseResult& r) {
  std::string text;
  const auto counts = count_by_mode(r);
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0)
      text +=
          (text.empty() ? "" : ", ") + count_text(counts[i]) + " " + std::string(kBreakModes[i]);
  return text;
}

void write_breaks(HtmlPage& page, const CollapseReport& report) {
  const CollapseResult& r = report.result;
  if (r.broken_joints.empty()) return;
  page.open_section("What broke first", "By mode: " + modes_of(r) + ".");
  HtmlTable table{"nllln",
                  {cells({"time, s", "joint", "mode", "rule or cause, component", "utilisation"})}};
  for (const JointBreak& each : r.broken_joints) {
    const bool has_both = !each.rule.empty() && !each.component.empty();
    table.rows.push_back(
        cells({moment_cell(each.time), joint_name(report, each.joint), std::string(each.mode),
               each.rule + (has_both ? ", " : "") + each.component,
               each.utilisation > 0 ? digits_text(each.utilisation) : "–"}));
  }
  write_first(page, std::move(table), "broken joints");
  page.close_section();
}

void write_bent(HtmlPage& page, const CollapseReport& report) {
  const CollapseResult& r = report.result;
  if (r.yielded_joints.empty()) return;
  page.open_section("What bent first", "Joints that became plastic hinges.");
  HtmlTable table{"nlnn", {cells({"time, s", "joint", "utilisation", "farthest rotation"})}};
  for (const JointYield& each : r.yielded_joints)
    table.rows.push_back(
        cells({moment_cell(each.time), joint_name(report, each.joint),
               digits_text(each.utilisation), digits_text(1e3 * each.rotation) + "\u00a0mrad"}));
  write_first(page, std::move(table), "bent joints");
  page.close_section();
}

void write_standing(HtmlPage& page, const CollapseResult& r) {
  page.open_section("How it stands", "Before anything happens, under its weight and live load.");
  HtmlTable table{"wn", {cells({"measure", "value"})}};
  const auto add = [&](std::string_view name, const std::string& value) {
    table.rows.push_back({escaped(name), escaped(value)});
  };
  add("Weight", quantity_text(r.weight, "N"));
  add("Supports", count_text(r.supports.size()));
  add("Sag of the highest nodes, mean", quantity_text(r.sag_mean, "m"));
  add("Sag, largest" + (r.sag_node.empty() ? "" : ", at " + r.sag_node),
      quantity_text(r.sag_max, "m"));
  add("Largest utilisation of a joint or post", digits_text(r.utilisation_at_rest));
  add("Joints that broke before anything happened", count_text(r.broken_at_rest));
  add("Sag of what still stands at the end", quantity_text(r.sag_end, "m"));
  page.table(table);
  page.close_section();
}

void write_rest(HtmlPage& page, const CollapseReport& report) {
  const CollapseResult& r = report.result;
  std::vector<SkippedRow> rows = {
      {"Steps of bodies asleep", r.body_steps_asleep, "They rest until something touches them."},
      {"Readings of joints", r.joint_steps_not_read,
       "Their loads were the same as when they were read before."},
      {"Poses not stored", r.poses_not_recorded, "They are those of the step before."}};
  if (report.scene.simulation.solver == "hybrid")
    rows.push_back(
        {"Solutions of the frame", r.solves.skipped, "Steps in which no load had changed."});
  if (r.panels > 0) {
    rows.push_back({"Slabs and walls without chunks", r.panels_not_meshed,
                    "They could break and never had to: each is one shape."});
    rows.push_back(
        {"Solutions of slabs and walls", r.panel_solves_skipped, "Nothing had changed for them."});
  }
  write_skipped(page, rows);
}

}  // namespace

std::string collapse_page(const CollapseReport& report, const PageSource& source) {
  const CollapseResult& r = report.result;
  HtmlPage page("collapse report", source.input);
  write_head(page, report, source);
  write_course(page, report);
  write_trust(page, report);
  write_standing(page, r);
  write_projectiles(page, r.projectiles, false);
  write_breaks(page, report);
  write_bent(page, report);
  write_rest(page, report);
  write_reproduction(page, source, report.scene.seed, r.hash, report.version, report.times);
  return page.finish(report.version);
}

}  // namespace sunder
