// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/error_front.hpp"
#include "io/json_lines.hpp"
#include "io/scene.hpp"
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

/// What a run was asked for and what its settings are known to give.
struct RunSettings {
  const SimulationParams& simulation;
  const ErrorFront& front;
  ErrorChoice choice;
};
/// Of a scene that is run as `job`, "impact" or "collapse".
RunSettings run_settings(const Scene& scene, std::string_view job);
/// A warning for settings that are not as exact as the scene asks for; empty otherwise.
std::string shortfall(const Scene& scene, const RunSettings& settings);
/// "settings": an object.
void write_settings(JsonLines& json, const RunSettings& settings);

/// The keys of "energy" that every run has, into an open object.
void write_ledger(JsonLines& json, double energy_in, const EnergyLedger& energy);
void write_projectiles(JsonLines& json, const std::vector<ProjectileOutcome>& projectiles);
/// "solves": zeros as long as there is no static solver; "hash": 16 hexadecimal digits.
void write_solves_and_hash(JsonLines& json, const SolveCounts& solves, std::uint64_t hash);
/// "warnings" and "time", the last keys of a report.
void write_end(JsonLines& json, const std::vector<std::string>& warnings, const RunTimes& times);

}  // namespace sunder
