// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>

#include "io/run_page.hpp"

namespace sunder {
namespace {

std::string lede_of(const ImpactResult& r) {
  if (r.broken_bonds == 0)
    return "Nothing broke in " + moment_text(r.simulated_s) + ": the largest utilisation was " +
           digits_text(r.max_utilisation) + ", and 1 breaks.";
  std::string text = count_text(r.broken_bonds) + " bonds broke and " + count_text(r.chunks_freed) +
                     " of " + count_text(r.chunks) + " chunks came loose in " +
                     moment_text(r.simulated_s) + ".";
  const std::vector<BreakEvent>& events = r.recording.events;
  if (!events.empty())
    text +=
        joined({" The first wall to crack was “", r.recording.walls[events[0].wall].asset.wall.name,
                "”, at ", moment_text(events[0].time), "."});
  return text;
}

void write_head(HtmlPage& page, const ImpactReport& report, const PageSource& source) {
  const SimulationParams& simulation = report.settings.simulation;
  const ImpactResult& r = report.result;
  page.lede(lede_of(r));
  const std::vector<std::pair<std::string, std::string>> facts = {
      {"input", source.input},
      {"seed", std::to_string(report.seed)},
      {"simulated", moment_text(r.simulated_s)},
      {"computed in", time_text(report.wall_s)},
      {"step", time_text(simulation.step)}};
  page.facts(facts);
  page.end_header();
  page.notices(r.warnings);
  const std::vector<Tile> tiles = {
      {"chunks freed", count_text(r.chunks_freed),
       "of " + count_text(r.chunks) + ", " + count_text(r.chunks_split) + " broke again"},
      {"bonds broken", count_text(r.broken_bonds), digits_text(r.crack_area) + " m² of cracks"},
      {"mass freed", digits_text(r.freed_mass) + "\u00a0kg",
       "the heaviest body " + digits_text(r.largest_freed_mass) + "\u00a0kg"},
      {"largest utilisation", digits_text(r.max_utilisation), "1 breaks"},
      {"energy in", quantity_text(r.energy_in, "J"), "of the projectiles"},
      {"a step", time_text(1e-3 * r.step_ms_median),
       "95 % within " + time_text(1e-3 * r.step_ms_p95) + ", longest " +
           time_text(1e-3 * r.step_ms_max)}};
  page.tiles(tiles);
}

std::vector<Html> curves_of(const std::vector<RunSample>& series) {
  if (series.empty()) return {};
  return {
      count_curve("Broken bonds", series, &RunSample::broken_bonds, 3,
                  "Bonds and anchors of all walls so far."),
      count_curve("Moving bodies", series, &RunSample::moving, 2, "Bodies that are not at rest."),
      utilisation_curve(series,
                        "Demand by capacity of the blows since the sample before; above the "
                        "dashed line something breaks.")};
}

void write_course(HtmlPage& page, const ImpactResult& r) {
  const EnergyLedger& e = r.energy;
  const EnergyKind kinds[] = {
      {"kinetic", e.kinetic, &RunSample::kinetic, "of everything that still moves"},
      {"potential", e.potential, &RunSample::potential, "of its height, against the start"},
      {"fracture", e.fracture, &RunSample::fracture, "new crack surface"},
      {"friction", e.friction, &RunSample::friction, "sliding"},
      {"contact", e.contact, &RunSample::contact, "crushing and blows that do not bounce"},
      {"numerical", e.numerical, &RunSample::numerical, "what remains: the error"}};
  const std::vector<RunSample>& series = r.recording.series;
  write_course(page, curves_of(series), series, r.energy_in, kinds);
}

void write_trust(HtmlPage& page, const ImpactResult& r, const RunSettings& asked) {
  const SimulationParams& simulation = asked.simulation;
  const AccuracyRow rows[] = {
      settings_row(asked),
      momentum_row(r.momentum_error),
      numerical_row(r.energy, r.energy_in),
      {"Energy made", share_text(std::max(r.energy_peak_ratio - 1, 0.0)),
       std::max(r.energy_peak_ratio - 1, 0.0),
       "How far mechanical energy ever was above what had gone in: a simulation must not make "
       "any."},
      penetration_row(r.penetration_max)};
  const std::pair<std::string, std::string> settings[] = {
      {"step", time_text(simulation.step)},
      {"substeps", count_text(r.substeps)},
      {"iterations", std::to_string(simulation.iterations)},
      {"chosen by max_error", chosen_text(asked.choice)}};
  write_accuracy(page, simulation.max_error, rows, settings);
}

void write_breaks(HtmlPage& page, const Recording& recording) {
  if (recording.events.empty()) return;
  page.open_section("What broke first");
  HtmlTable table{
      "nlnnnn",
      {cells({"time, s", "wall", "speed", "utilisation", "bonds broken", "chunks freed"})}};
  for (const BreakEvent& event : recording.events) {
    assert(event.wall < recording.walls.size());
    table.rows.push_back(
        cells({moment_cell(event.time), recording.walls[event.wall].asset.wall.name,
               digits_text(event.speed) + "\u00a0m/s", digits_text(event.utilisation),
               count_text(event.bonds_broken), count_text(event.chunks_freed)}));
  }
  write_first(page, std::move(table), "breaks");
  page.close_section();
}

void write_rest(HtmlPage& page, const ImpactResult& r) {
  const SkippedRow rows[] = {
      {"Walls that nothing touched", r.walls_untouched, "They stand, and cost nothing."},
      {"Collision shapes not built", r.hulls_not_built, "Of chunks that nothing came near."},
      {"Steps of chunks without a body of their own", r.chunk_steps_not_simulated,
       "What hangs together moves, or stands, as one."},
      {"Steps of bodies asleep", r.body_steps_asleep, "They rest until something touches them."},
      {"Cells not searched", r.cells_not_searched,
       "When a break was followed, only the part of the wall round it was looked at."},
      {"Poses not stored", r.poses_not_recorded, "They are those of the step before."}};
  write_skipped(page, rows);
}

}  // namespace

std::string impact_page(const ImpactReport& report, const PageSource& source) {
  const ImpactResult& r = report.result;
  HtmlPage page("impact report", source.input);
  write_head(page, report, source);
  write_course(page, r);
  write_trust(page, r, report.settings);
  write_projectiles(page, r.projectiles, true);
  write_breaks(page, r.recording);
  write_rest(page, r);
  write_reproduction(page, source, report.seed, r.hash, report.version, report.times);
  return page.finish(report.version);
}

}  // namespace sunder
