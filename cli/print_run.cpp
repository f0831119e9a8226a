// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/print_run.hpp"

namespace sunder {

void print_ledger(double energy_in, const EnergyLedger& energy, std::optional<double> joint) {
  std::fprintf(stderr,
               "energy in %.4g J: kinetic %.4g, potential %.4g, fracture %.4g, contact %.4g, "
               "friction %.4g, ",
               energy_in, energy.kinetic, energy.potential, energy.fracture, energy.contact,
               energy.friction);
  if (joint) std::fprintf(stderr, "joints %.4g, ", *joint);
  std::fprintf(stderr, "numerical %.2g\n", energy.numerical);
}

void print_settings(const RunSettings& settings) {
  const ErrorChoice& choice = settings.choice;
  if (choice.chosen.empty()) return;
  std::fprintf(stderr,
               "for an error of %.3g: steps of %.4g s, %lld iterations, expected %.2g (%s)\n",
               choice.asked, settings.simulation.step,
               static_cast<long long>(settings.simulation.iterations), choice.expected.value_or(0),
               settings.front.error.c_str());
}

void print_end(const Options& options, const Scene& scene, std::string_view verb,
               std::initializer_list<std::string_view> unused, const Stopwatch& watch) {
  for (const auto& path : options.outputs) std::fprintf(stderr, "wrote %s\n", path.c_str());
  if (!options.history.empty()) std::fprintf(stderr, "wrote %s\n", options.history.c_str());
  if (!options.verbose) return;
  for (const std::string& key : given_keys(scene, unused))
    std::fprintf(stderr, "\"%s\" is not used by %.*s\n", key.c_str(), static_cast<int>(verb.size()),
                 verb.data());
  for (const auto& [step, seconds] : watch.steps())
    std::fprintf(stderr, "%-8s %8.3f ms\n", step.c_str(), 1e3 * seconds);
}

}  // namespace sunder
