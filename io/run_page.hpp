// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/html_page.hpp"
#include "io/report_page.hpp"

namespace sunder {

// What the pages of impact and collapse have in common.

/// A measure of how exactly a run was computed.
struct AccuracyRow {
  std::string name;
  std::string value;              ///< as it is shown
  std::optional<double> share{};  ///< relative: to be compared with the error asked for
  std::string meaning;            ///< a sentence
};
/// "How far to trust the numbers": what was asked for, what the run achieved, what was chosen
/// (name and value).
void write_accuracy(HtmlPage& page, double asked, std::span<const AccuracyRow> rows,
                    std::span<const std::pair<std::string, std::string>> settings);
/// By falling, and by what stands, J.
double energy_set_free(const EnergyLedger& energy);
/// Numerical energy by what was turned over: what went in and what was set free.
AccuracyRow numerical_row(const EnergyLedger& energy, double energy_in);
AccuracyRow momentum_row(double error);
/// What was measured with settings as coarse as the run's, see choose_settings.
AccuracyRow settings_row(const RunSettings& settings);
/// "step, iterations", or "none" when the scene gives them.
std::string chosen_text(const ErrorChoice& choice);
AccuracyRow penetration_row(double depth);

/// A count over time.
Html count_curve(std::string title, std::span<const RunSample> series,
                 std::uint64_t RunSample::*count, int colour, std::string_view caption);
/// The largest utilisation over time, with the line at which something breaks.
Html utilisation_curve(std::span<const RunSample> series, std::string_view caption);

/// A kind of energy: its name, its value at the end and over time.
struct EnergyKind {
  std::string name;
  double end = 0;  ///< J
  double RunSample::*over_time = nullptr;
  std::string meaning;
};
/// "What happened": curves; and "Where the energy went": lines over time and the ledger at the end.
/// Without a series there are no curves.
void write_course(HtmlPage& page, std::vector<Html> curves, std::span<const RunSample> series,
                  double energy_in, std::span<const EnergyKind> kinds);

/// A projectile's name, speed, outcome …; `ballistic`: walls know what speed they need.
void write_projectiles(HtmlPage& page, std::span<const ProjectileOutcome> projectiles,
                       bool ballistic);

/// Something that was not done: how often, and what that means.
struct SkippedRow {
  std::string name;
  std::uint64_t count = 0;
  std::string meaning;
};
void write_skipped(HtmlPage& page, std::span<const SkippedRow> rows);

/// The command, and what identifies the run.
void write_reproduction(HtmlPage& page, const PageSource& source, std::uint64_t seed,
                        std::uint64_t hash, std::string_view version, const RunTimes& times);

/// Rows of a table of which the first are shown and the rest folded away, at most so many.
constexpr std::size_t kRowsShown = 12, kRowsKept = 2000;
void write_first(HtmlPage& page, HtmlTable table, std::string_view what);

/// A cell with a smaller text below.
Html with_note(std::string_view text, std::string_view note);
/// Cells of one kind, escaped.
std::vector<Html> cells(std::span<const std::string> texts);
inline std::vector<Html> cells(std::initializer_list<std::string> texts) {
  return cells(std::span(texts.begin(), texts.size()));
}

}  // namespace sunder
