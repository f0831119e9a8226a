// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/run_page.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

/// Lines that stay below this share of the largest are left out of a plot.
constexpr double kVisible = 2e-3;
/// From here up a plot of utilisations has decades.
constexpr double kManyFold = 8;

Html bar(double share, int colour) {
  if (share == 0) return {};
  const int tenths = static_cast<int>(std::lround(1000 * std::clamp(share, 0.0, 1.0)));
  return {joined({"<i class=\"bar c", std::to_string(colour), "\" style=\"width:",
                  std::to_string(tenths / 10), ".", std::to_string(tenths % 10), "%\"></i>"})};
}

bool is_met(const AccuracyRow& row, double asked) {
  return *row.share <= asked;  // false for what is no number
}

std::string verdict(std::span<const AccuracyRow> rows, double asked) {
  std::size_t judged = 0, met = 0;
  for (const AccuracyRow& row : rows) {
    if (!row.share) continue;
    ++judged;
    met += is_met(row, asked);
  }
  const std::string all = std::to_string(judged), limit = share_text(asked);
  if (met == judged)
    return joined({"All ", all, " relative errors of this run are within the ", limit,
                   " asked for (max_error)."});
  return joined({std::to_string(judged - met), " of ", all,
                 " relative errors of this run exceed the ", limit, " asked for (max_error)."});
}

std::vector<double> values_of(std::span<const RunSample> series, double RunSample::*value) {
  std::vector<double> values;
  for (const RunSample& sample : series) values.push_back(sample.*value);
  return values;
}
std::vector<double> values_of(std::span<const RunSample> series, std::uint64_t RunSample::*value) {
  std::vector<double> values;
  for (const RunSample& sample : series) values.push_back(static_cast<double>(sample.*value));
  return values;
}

double largest_of(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

HtmlTable ledger(double energy_in, std::span<const EnergyKind> kinds) {
  double most = std::abs(energy_in);
  for (const EnergyKind& kind : kinds) most = std::max(most, std::abs(kind.end));
  const auto share = [&](double value) { return most > 0 ? std::abs(value) / most : 0; };
  HtmlTable table{"wnb", {cells({"", "energy", ""})}};
  table.rows.push_back({with_note("in", "of projectiles, loads and the ground's motion"),
                        escaped(quantity_text(energy_in, "J")), bar(share(energy_in), 9)});
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const EnergyKind& kind = kinds[i];
    table.rows.push_back({with_note(kind.name, kind.meaning), escaped(quantity_text(kind.end, "J")),
                          bar(share(kind.end), static_cast<int>(i % 10))});
  }
  return table;
}

}  // namespace

Html with_note(std::string_view text, std::string_view note) {
  return {joined({escaped(text).text, "<small>", escaped(note).text, "</small>"})};
}

std::vector<Html> cells(std::span<const std::string> texts) {
  std::vector<Html> row;
  for (const std::string& text : texts) row.push_back(escaped(text));
  return row;
}

// ---- accuracy
// ------------------------------------------------------------------------------------

void write_accuracy(HtmlPage& page, double asked, std::span<const AccuracyRow> rows,
                    std::span<const std::pair<std::string, std::string>> settings) {
  page.open_section("How far to trust the numbers", verdict(rows, asked));
  page.paragraph(
      "They say how exactly the model's equations were solved. How well the model fits a building "
      "or a wall is another question: see “What it cannot” in the documentation.");
  HtmlTable table{"wnl", {cells({"measure", "this run", ""})}};
  const std::string limit = share_text(asked);
  for (const AccuracyRow& row : rows) {
    const Html judged = !row.share           ? badge("open", "not asked")
                        : is_met(row, asked) ? badge("good", joined({"within ", limit}))
                                             : badge("bad", joined({"above ", limit}));
    table.rows.push_back({with_note(row.name, row.meaning), escaped(row.value), judged});
  }
  page.table(table);
  page.facts(settings);
  page.close_section();
}

AccuracyRow settings_row(const RunSettings& settings) {
  const std::optional<double>& expected = settings.choice.expected;
  return {"Expected of the settings", expected ? share_text(*expected) : "not known",
          settings.choice.is_asked ? expected : std::nullopt,
          "Measured with settings no finer than these: " + settings.front.error +
              ". Not in it: " + settings.front.not_in_it + "."};
}

std::string chosen_text(const ErrorChoice& choice) {
  std::string text;
  for (const std::string& key : choice.chosen) text += (text.empty() ? "" : ", ") + key;
  return text.empty() ? "none" : text;
}

double energy_set_free(const EnergyLedger& energy) {
  return std::max(0.0, -energy.potential) + std::max(0.0, -energy.strain);
}

AccuracyRow numerical_row(const EnergyLedger& energy, double energy_in) {
  const double turned_over = std::abs(energy_in) + energy_set_free(energy);
  const double share = turned_over > 0 ? std::abs(energy.numerical) / turned_over : 0;
  return {"Numerical share of the energy", share_text(share), share,
          "Energy that the books cannot place at the end, by what went in and what falling and "
          "sagging set free. It should be next to nothing."};
}

AccuracyRow momentum_row(double error) {
  return {"Momentum", share_text(error), error,
          "Largest change of momentum in a step that no force explains, by the largest momentum of "
          "the run."};
}

AccuracyRow penetration_row(double depth) {
  return {"Penetration",
          quantity_text(depth, "m"),
          {},
          "Deepest overlap of two bodies at the end of a step."};
}

// ---- energy and curves
// ---------------------------------------------------------------------------

Html energy_curve(std::span<const RunSample> series, std::span<const EnergyKind> kinds,
                  double height) {
  Plot plot{.title = "Energy over time",
            .times = values_of(series, &RunSample::time),
            .lines = {},
            .unit = "J",
            .height = height};
  double most = 0;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    plot.lines.push_back(
        {kinds[i].name, values_of(series, kinds[i].over_time), static_cast<int>(i % 10)});
    most = std::max(most, largest_of(plot.lines.back().values));
  }
  std::erase_if(plot.lines,
                [&](const PlotLine& line) { return largest_of(line.values) <= kVisible * most; });
  return figure_of(plot, plot.lines.size() < kinds.size()
                             ? "Kinds below 0.2 % of the largest are not drawn."
                             : "");
}

void write_course(HtmlPage& page, std::vector<Html> curves, std::span<const RunSample> series,
                  double energy_in, std::span<const EnergyKind> kinds) {
  const bool fills_a_row = curves.size() % 2 == 1;
  if (fills_a_row && !series.empty()) curves.push_back(energy_curve(series, kinds, 270));
  if (!curves.empty()) {
    page.open_section("What happened");
    page.figures(curves);
    page.close_section();
  }
  page.open_section("Where the energy went",
                    "All kinds add up to the energy that went in, at every time. Potential energy "
                    "is counted from the start, so what falls makes it negative.");
  const HtmlTable table = ledger(energy_in, kinds);
  if (fills_a_row || series.empty()) {
    page.table(table);
  } else {
    const double height = 44 * static_cast<double>(table.rows.size());
    const Html figures[] = {energy_curve(series, kinds, std::clamp(height, 270.0, 500.0)),
                            figure_of("Ledger at the end", table)};
    page.figures(figures);
  }
  page.close_section();
}

Html count_curve(std::string title, std::span<const RunSample> series,
                 std::uint64_t RunSample::*count, int colour, std::string_view caption) {
  const PlotLine line{{}, values_of(series, count), colour};
  return figure_of(Plot{.title = std::move(title),
                        .times = values_of(series, &RunSample::time),
                        .lines = {line},
                        .unit = {},
                        .is_count = true},
                   caption);
}

Html utilisation_curve(std::span<const RunSample> series, std::string_view caption) {
  const PlotLine line{{}, values_of(series, &RunSample::max_utilisation), 0};
  return figure_of(Plot{.title = "Largest utilisation",
                        .times = values_of(series, &RunSample::time),
                        .lines = {line},
                        .unit = {},
                        .is_log = largest_of(line.values) > kManyFold,
                        .mark = 1},
                   caption);
}

// ---- tables
// --------------------------------------------------------------------------------------

void write_projectiles(HtmlPage& page, std::span<const ProjectileOutcome> projectiles,
                       bool ballistic) {
  if (projectiles.empty()) return;
  page.open_section("Projectiles");
  HtmlTable table{"llnn", {cells({"projectile", "outcome", "speed at the hit", "peak force"})}};
  if (ballistic) {
    table.style += "nn";
    for (const char* name : {"needed to get through", "speed behind"})
      table.rows[0].push_back(escaped(name));
  }
  const auto speed = [](double value) { return digits_text(value) + "\u00a0m/s"; };
  for (const ProjectileOutcome& p : projectiles) {
    std::vector<Html> row = cells({p.name,
                                   !p.hit         ? "met nothing"
                                   : p.perforated ? "got through"
                                   : ballistic    ? "did not get through"
                                                  : "hit",
                                   p.hit ? speed(p.speed_before) : "–",
                                   p.hit ? quantity_text(p.contact_force, "N") : "–"});
    if (ballistic) {
      const bool is_known = p.hit && std::isfinite(p.ballistic_speed);
      row.push_back(escaped(is_known ? speed(p.ballistic_speed) : "–"));
      row.push_back(escaped(p.perforated ? speed(p.residual_speed) : "–"));
    }
    table.rows.push_back(std::move(row));
  }
  page.table(table);
  page.close_section();
}

void write_skipped(HtmlPage& page, std::span<const SkippedRow> rows) {
  page.open_section("What was not computed",
                    "Work that this scene did not need. It changes no result: with --no-skip "
                    "everything is computed, and the hash is the same.");
  HtmlTable table{"wn", {cells({"left out", "how often"})}};
  for (const SkippedRow& row : rows)
    table.rows.push_back({with_note(row.name, row.meaning), escaped(count_text(row.count))});
  page.table(table);
  page.close_section();
}

void write_reproduction(HtmlPage& page, const PageSource& source, std::uint64_t seed,
                        std::uint64_t hash, std::string_view version, const RunTimes& times) {
  page.open_section("Once more",
                    "The same scene, seed and version give the same result, bit for "
                    "bit, on any number of threads.");
  if (!source.command.empty()) page.code(source.command);
  std::vector<std::pair<std::string, std::string>> facts = {{"input", source.input},
                                                            {"seed", std::to_string(seed)},
                                                            {"hash", hash_text(hash)},
                                                            {"version", std::string(version)}};
  for (const auto& [step, seconds] : times) facts.emplace_back(step, time_text(seconds));
  page.facts(facts);
  page.close_section();
}

void write_first(HtmlPage& page, HtmlTable table, std::string_view what) {
  const std::size_t count = table.rows.size() - 1;
  HtmlTable rest{table.style, {table.rows[0]}};
  if (count > kRowsShown) {
    const std::size_t end = 1 + std::min(count, kRowsKept);
    rest.rows.insert(rest.rows.end(), table.rows.begin() + 1 + kRowsShown,
                     table.rows.begin() + static_cast<std::ptrdiff_t>(end));
    table.rows.resize(1 + kRowsShown);
  }
  page.table(table);
  if (count <= kRowsShown) return;
  page.folded(joined({"The other ", count_text(count - kRowsShown), " ", what}), rest);
  if (count > kRowsKept)
    page.paragraph(joined({"The last ", count_text(count - kRowsKept),
                           " are in the JSON report (--report FILE.json)."}));
}

}  // namespace sunder
