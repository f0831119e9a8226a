// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/json_lines.hpp"
#include "sim/collapse.hpp"
#include "sim/impact.hpp"

namespace sunder {

// What the reports of impact and collapse have in common, written once.

/// Seconds that each part of a run took: "simulate" → 1.5.
using RunTimes = std::vector<std::pair<std::string, double>>;

/// version … step_ms; Result is ImpactResult or CollapseResult.
template <class Result>
void write_run(JsonLines& json, std::string_view version, std::uint64_t seed, double wall_s,
               const Result& result) {
  json.text("version", version);
  json.count("seed", seed);
  json.count("steps", result.steps);
  json.count("substeps", result.substeps);
  json.number("simulated_s", result.simulated_s);
  json.number("wall_s", wall_s);
  json.open("step_ms", '{');
  json.number("median", result.step_ms_median);
  json.number("p95", result.step_ms_p95);
  json.number("max", result.step_ms_max);
  json.close();
}

/// The keys of "energy" that every run has, into an open object.
void write_ledger(JsonLines& json, double energy_in, const EnergyLedger& energy);
void write_projectiles(JsonLines& json, const std::vector<ProjectileOutcome>& projectiles);
std::string hash_text(std::uint64_t hash);  ///< 16 hexadecimal digits
/// "solves": zeros as long as there is no static solver; "hash": 16 hexadecimal digits.
void write_solves_and_hash(JsonLines& json, const SolveCounts& solves, std::uint64_t hash);
/// "warnings" and "time", the last keys of a report.
void write_end(JsonLines& json, const std::vector<std::string>& warnings, const RunTimes& times);

}  // namespace sunder
