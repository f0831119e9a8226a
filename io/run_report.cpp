// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/run_report.hpp"

#include "io/printable.hpp"

namespace sunder {
namespace {

std::string hex_digits(std::uint64_t value) {
  std::string digits(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) digits[i] = "0123456789abcdef"[value & 15];
  return digits;
}

}  // namespace

RunSettings run_settings(const Scene& scene, std::string_view job) {
  const ErrorFront& front = error_front(job);
  return {scene.simulation, front,
          scene.error_choice ? *scene.error_choice : expected_error(front, scene.simulation)};
}

std::string shortfall(const Scene& scene, const RunSettings& settings) {
  if (!scene.error_choice || settings.choice.is_met()) return {};
  const std::string asked = "max_error = " + number_text(settings.choice.asked);
  if (!settings.choice.expected)
    return asked +
           ": nothing was measured with settings as coarse as the scene's; what it gives is "
           "not known";
  return asked + " is less than the settings give: " + number_text(*settings.choice.expected) +
         " was measured (" + settings.front.error + ")";
}

void write_settings(JsonLines& json, const RunSettings& settings) {
  const ErrorChoice& choice = settings.choice;
  json.open("settings", '{');
  json.number("max_error", choice.asked);
  json.open("chosen", '[');
  for (const std::string& key : choice.chosen) json.text(key);
  json.close();
  json.number("step", settings.simulation.step);
  json.count("iterations", static_cast<std::uint64_t>(settings.simulation.iterations));
  if (choice.expected)
    json.number("expected_error", *choice.expected);
  else
    json.null("expected_error");
  json.truth("met", choice.is_met());
  json.text("error_is", settings.front.error);
  json.text("not_in_it", settings.front.not_in_it);
  json.close();
}

void write_ledger(JsonLines& json, double energy_in, const EnergyLedger& energy) {
  json.number("in", energy_in);
  json.number("kinetic", energy.kinetic);
  json.number("potential", energy.potential);
  json.number("strain", energy.strain);
  json.number("fracture", energy.fracture);
  json.number("friction", energy.friction);
  json.number("contact", energy.contact);
  json.number("numerical", energy.numerical);
}

void write_projectiles(JsonLines& json, const std::vector<ProjectileOutcome>& projectiles) {
  json.open("projectiles", '[');
  for (const ProjectileOutcome& each : projectiles) {
    json.open('{');
    json.text("name", each.name);
    json.truth("hit", each.hit);
    json.truth("perforated", each.perforated);
    json.number("speed_before", each.speed_before);
    json.number("residual_speed", each.residual_speed);
    json.number("ballistic_speed", each.ballistic_speed);
    json.number("contact_force", each.contact_force);
    json.close();
  }
  json.close();
}

void write_solves_and_hash(JsonLines& json, const SolveCounts& solves, std::uint64_t hash) {
  json.open("solves", '{');
  json.count("full", solves.full);
  json.count("update", solves.update);
  json.count("skipped", solves.skipped);
  json.close();
  json.text("hash", hex_digits(hash));
}

void write_end(JsonLines& json, const std::vector<std::string>& warnings, const RunTimes& times) {
  json.open("warnings", '[');
  for (const std::string& warning : warnings) json.text(warning);
  json.close();
  json.open("time", '{');
  for (const auto& [step, seconds] : times) json.number(step + "_s", seconds);
  json.close();
}

}  // namespace sunder
