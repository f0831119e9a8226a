// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stress/trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>

#include "tests/stress/command.hpp"

namespace sunder::stress {
namespace {

namespace fs = std::filesystem;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// One seed's files and what was found out so far.
struct Run {
  const Kind& kind;
  const Bench& bench;
  fs::path stem;
  Trial trial;

  bool is_short() const { return bench.seconds < kMostSeconds; }
  /// Of a command: two minutes, or what is left of the trial's.
  Limits limits() const {
    const double left = is_short() ? bench.seconds - trial.seconds : kMostSeconds;
    return {static_cast<unsigned>(std::max(1.0, std::ceil(left)))};
  }
  /// A command that was given up: nothing that it did is judged.
  bool gives_up(const Outcome& outcome) {
    if (!is_short() || outcome.signal != SIGALRM) return false;
    return trial.too_long = true;
  }
  fs::path file(const char* suffix) const { return stem.string() + suffix; }
  void fail(const std::string& what) { trial.failures.push_back(what); }
  void measure(const char* name, double value, double limit) {
    trial.measures.push_back({name, value, limit});
    if (trial.measures.back().failed())
      fail(std::string(name) + " = " + std::to_string(value) + ", limit " + std::to_string(limit));
  }
};

bool prepare(Run& run, std::uint64_t seed) {
  Dice dice(seed);
  Scene scene = run.kind.make(dice);
  if (!scene.model.empty()) {
    std::ofstream(run.file(".obj")) << scene.model;
    scene.json["solids"][0]["file"] = run.file(".obj").filename().string();
  }
  std::ofstream file(run.file(".json"));
  file << scene.json.dump(1) << '\n';
  return file.good();
}

/// Exit 0 and a report, a refusal, or a failure.
bool run_verb(Run& run, const std::vector<std::string>& more, Json& report) {
  const fs::path out = run.file("-report.json");
  std::vector<std::string> words = {run.bench.program, run.kind.verb, run.file(".json"),
                                    "--quiet",         "--report",    out};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run_command(words, run.stem, run.limits());
  run.trial.seconds += outcome.seconds;
  if (run.gives_up(outcome)) return false;
  // The report may say that an asset is not sound: exit 1, judged by its numbers.
  if (outcome.exit_code == 0 || outcome.exit_code == 1) {
    report = Json::parse(std::ifstream(out), nullptr, false);
    fs::remove(out);
    if (report.is_discarded()) run.fail("its report is no JSON");
    return !report.is_discarded();
  }
  run.trial.refused = outcome.exit_code == 3 && !outcome.talk.empty();
  if (fs::exists(out)) run.fail("wrote a report and then failed");
  if (!run.trial.refused)
    run.fail(outcome.signal != 0
                 ? "ended by signal " + std::to_string(outcome.signal) +
                       (outcome.signal == SIGALRM ? " (time limit)" : "")
                 : "exit code " + std::to_string(outcome.exit_code) + ": " + outcome.talk);
  return false;
}

double number(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : kNaN;
}

void judge_same(Run& run, const Json& report, const std::vector<std::string>& more,
                const char* what) {
  Json other;
  if (run_verb(run, more, other) && other["hash"] != report["hash"])
    run.fail(std::string("another result ") + what);
}

/// What the file holds, m³.
double judge_file(Run& run) {
  const fs::path glb = run.file(".glb"), out = run.file("-check.json");
  const Outcome outcome = run_command(
      {run.bench.program, "check", glb, "--quiet", "--report", out}, run.stem, run.limits());
  run.trial.seconds += outcome.seconds;
  const Json report = Json::parse(std::ifstream(out), nullptr, false);
  fs::remove(out);
  fs::remove(glb);
  if (run.gives_up(outcome)) return 0;
  if (report.is_discarded()) {
    run.fail("its file cannot be checked: " + outcome.talk);
    return 0;
  }
  run.measure("open_chunks of the file", number(report, "open_chunks"), 0);
  if (outcome.exit_code != 0) run.fail("its file is not sound: " + outcome.talk);
  return number(report, "volume");
}

void judge_asset(Run& run, const Json& report, bool other_threads) {
  for (const char* key : {"open_chunks", "nonmanifold_chunks", "inverted_chunks",
                          "overlapping_pairs", "self_crossing_chunks", "unmatched_faces"})
    run.measure(key, number(report, key), 0);
  run.measure("volume_error", number(report, "volume_error"), 1e-6);
  if (report["sound"] != true) run.fail("it is not sound");
  judge_file(run);
  if (other_threads && !run.trial.too_long) judge_same(run, report, {"--threads", "1"}, "with one thread");
}

/// Without skipping the same breaks, and the same bytes.
void judge_skipping(Run& run, const Json& report) {
  Json other;
  if (!run_verb(run, {"--no-skip"}, other)) return;
  for (const char* key : {"broken_joints", "broken_bonds", "chunks_freed"})
    if (other[key].is_array() ? other[key].size() != report[key].size() : other[key] != report[key])
      run.fail(std::string("another number of ") + key + " without skipping");
  if (other["hash"] != report["hash"])
    run.fail("another result without skipping");
}

void judge_run(Run& run, const Json& report, bool again) {
  const Json& energy = report["energy"];
  const double in = number(energy, "in"), potential = number(energy, "potential"),
               strain = number(energy, "strain");
  // Contacts hold bodies within parts of a millimetre: what lifts everything by one is not
  // resolved.
  const double unresolved = 1e-3 * 9.81 * 2500 * judge_file(run);
  if (run.trial.too_long) return;
  const double scale = std::abs(in) + std::abs(potential) + std::abs(strain) + unresolved;
  run.measure("momentum_error", number(report, "momentum_error"), 1e-9);
  run.measure("numerical share of the energy", std::abs(number(energy, "numerical")) / scale, 1e-3);
  // A bucket that gives instead of taking would be energy from nowhere.
  run.measure("energy from cracks", -number(energy, "fracture") / scale, 1e-3);
  run.measure("energy from contacts",
              -(number(energy, "friction") + number(energy, "contact")) / scale, 1e-2);
  run.measure("kinetic energy beyond what went in",
              (number(energy, "kinetic") - (in - potential - strain)) / scale, 1e-2);
  run.trial.measures.push_back({"penetration, m (not judged)", number(report, "penetration_max"),
                                std::numeric_limits<double>::infinity()});
  if (!again) return;
  judge_same(run, report, {"--threads", "1"}, "with one thread");
  if (!run.trial.too_long) judge_skipping(run, report);
}

}  // namespace

std::span<const Kind> kinds() {
  static constexpr std::array<Kind, 6> list = {{{"wall", "fracture", wall_scene},
                                                {"solid", "fracture", solid_scene},
                                                {"broken-model", "fracture", broken_model_scene},
                                                {"impact", "impact", impact_scene},
                                                {"building", "collapse", building_scene},
                                                {"panels", "collapse", panel_scene}}};
  return list;
}

Trial try_seed(const Kind& kind, std::uint64_t seed, const Bench& bench) {
  Run run{kind, bench, bench.folder / (kind.name + ("-" + std::to_string(seed))), {}};
  Json report;
  if (!prepare(run, seed))
    run.fail("cannot write " + run.file(".json").string());
  else if (run_verb(run, {"-o", run.file(".glb")}, report)) {
    // Every third scene twice: the same in another way.
    const bool again = seed % 3 == 0;
    if (std::string_view(kind.verb) == "fracture")
      judge_asset(run, report, again);
    else
      judge_run(run, report, again);
  }
  if (run.trial.failures.empty()) {
    fs::remove(run.file(".json"));
    fs::remove(run.file(".obj"));
  }
  fs::remove(run.file(".glb"));
  return run.trial;
}

}  // namespace sunder::stress
