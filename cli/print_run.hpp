// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "cli/options.hpp"
#include "cli/stopwatch.hpp"
#include "io/run_report.hpp"
#include "io/scene.hpp"
#include "sim/impact.hpp"

namespace sunder {

// What impact and collapse print of a run on standard error.

/// A count as printf takes it with %llu.
inline unsigned long long as_count(std::uint64_t value) {
  return value;
}

/// One line; `joint` is what joints took, where there are any, J.
void print_ledger(double energy_in, const EnergyLedger& energy, std::optional<double> joint = {});

/// One line; Result is ImpactResult or CollapseResult.
template <class Result>
void print_steps(const Result& result, std::uint64_t seed) {
  std::fprintf(stderr,
               "%llu steps (%llu substeps), ms a step: %.3g median, %.3g p95, %.3g longest, "
               "seed %llu\n",
               as_count(result.steps), as_count(result.substeps), result.step_ms_median,
               result.step_ms_p95, result.step_ms_max, as_count(seed));
}

/// Of a scene that gives `max_error`: what was chosen for it and what is to be expected; nothing
/// for another.
void print_settings(const RunSettings& settings);

/// Files that were written; with -v also which of the `unused` keys the scene gives to no purpose,
/// and the time of each part of the run.
void print_end(const Options& options, const Scene& scene, std::string_view verb,
               std::initializer_list<std::string_view> unused, const Stopwatch& watch);

}  // namespace sunder
