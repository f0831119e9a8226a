// SPDX-License-Identifier: GPL-3.0-or-later
// Random scenes of every kind through the program as a user runs it, judged by what must hold in
// all of them. A scene that fails stays as a file; the command that repeats it is printed.
//   stress PROGRAM FOLDER [--minutes M] [--seed S] [--only KIND] [--known FILE]
// FILE: lines of a kind and a seed that fail as is known; others make the program end with 1.
// Of a run of less than ten minutes a scene gets a fifth; one that takes longer is given up. So a
// few long ones neither eat the time of all others nor keep the run from ending.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/stress/trial.hpp"

namespace sunder::stress {
namespace {

struct Options {
  Bench bench;
  double minutes = 2;
  std::uint64_t seed = 1;
  std::string only;
  std::set<std::string> known;  ///< "kind seed" of scenes that fail, as is known
};

struct Worst {
  double value = 0, limit = 0;
  std::uint64_t seed = 0, failed = 0;
};

/// What became of one kind.
struct Row {
  const Kind* kind = nullptr;
  std::uint64_t started = 0, done = 0, refused = 0, too_long = 0, failed = 0;
  double seconds = 0, longest = 0;
  std::uint64_t longest_seed = 0;
  std::map<std::string, Worst> worst;
};

class Table {
 public:
  Table(const Options& options) : options_(options) {
    for (const Kind& kind : kinds())
      if (options.only.empty() || options.only == kind.name) rows_.emplace_back().kind = &kind;
  }
  bool empty() const { return rows_.empty(); }

  /// The kind that had least time so far, and its next seed.
  std::pair<Row*, std::uint64_t> next() {
    const std::lock_guard lock(mutex_);
    Row& row = *std::ranges::min_element(rows_, {}, [](const Row& r) {
      return r.seconds + 0.1 * static_cast<double>(r.started - r.done);
    });
    return {&row, options_.seed + row.started++};
  }

  void add(Row& row, std::uint64_t seed, const Trial& trial) {
    const std::lock_guard lock(mutex_);
    ++row.done;
    row.refused += trial.refused ? 1 : 0;
    row.too_long += trial.too_long ? 1 : 0;
    row.failed += trial.failures.empty() ? 0 : 1;
    const bool known = options_.known.contains(row.kind->name + (' ' + std::to_string(seed)));
    unexpected_ += !trial.failures.empty() && !known ? 1 : 0;
    row.seconds += trial.seconds;
    if (trial.seconds > row.longest) {
      row.longest = trial.seconds;
      row.longest_seed = seed;
    }
    for (const Measure& m : trial.measures) keep(row.worst[m.name], m, seed);
    for (const std::string& failure : trial.failures)
      std::fprintf(stderr, "%s %llu: %s\n", row.kind->name, static_cast<unsigned long long>(seed),
                   failure.c_str());
    if (known)
      std::fprintf(stderr, "  %s\n", trial.failures.empty() ? "known to fail: holds" : "known");
    if (!trial.failures.empty())
      std::fprintf(stderr, "  repeat with: sunder %s %s/%s-%llu.json\n", row.kind->verb,
                   options_.bench.folder.c_str(), row.kind->name,
                   static_cast<unsigned long long>(seed));
  }

  /// Markdown on stdout; whether nothing failed but what is known.
  bool print() const {
    std::printf(
        "| scenes | tried | refused | given up | failed | longest s (seed) |\n"
        "|---|---|---|---|---|---|\n");
    for (const Row& row : rows_)
      std::printf("| %s | %llu | %llu | %llu | %llu | %.1f (%llu) |\n", row.kind->name,
                  count(row.done), count(row.refused), count(row.too_long), count(row.failed),
                  row.longest, count(row.longest_seed));
    std::printf("\n| scenes | what | worst (seed) | limit | failed |\n|---|---|---|---|---|\n");
    for (const Row& row : rows_)
      for (const auto& [name, worst] : row.worst)
        std::printf("| %s | %s | %.2g (%llu) | %.2g | %llu |\n", row.kind->name, name.c_str(),
                    worst.value, count(worst.seed), worst.limit, count(worst.failed));
    return unexpected_ == 0;
  }

 private:
  static unsigned long long count(std::uint64_t n) { return n; }
  static void keep(Worst& worst, const Measure& measure, std::uint64_t seed) {
    worst.limit = measure.limit;
    worst.failed += measure.failed() ? 1 : 0;
    if (worst.seed != 0 && !(measure.value > worst.value)) return;
    worst.value = measure.value;
    worst.seed = seed;
  }

  const Options& options_;
  std::mutex mutex_;
  std::vector<Row> rows_;
  std::uint64_t unexpected_ = 0;
};

void work(const Options& options, Table& table) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(60 * options.minutes);
  const auto until_end = [&] {
    while (Clock::now() < end) {
      const auto [row, seed] = table.next();
      table.add(*row, seed, try_seed(*row->kind, seed, options.bench));
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = std::max(1u, std::thread::hardware_concurrency()); i > 0; --i)
    threads.emplace_back(until_end);
}

bool parse(int argc, char** argv, Options& options) {
  if (argc < 3) return false;
  options.bench = {argv[1], argv[2]};
  for (int i = 3; i + 1 < argc; i += 2) {
    const std::string_view key = argv[i];
    if (key == "--minutes")
      options.minutes = std::atof(argv[i + 1]);
    else if (key == "--seed")
      options.seed = std::strtoull(argv[i + 1], nullptr, 10);
    else if (key == "--only")
      options.only = argv[i + 1];
    else if (key == "--known") {
      std::ifstream lines(argv[i + 1]);
      if (!lines) return false;
      for (std::string line; std::getline(lines, line);) options.known.insert(line);
    } else
      return false;
  }
  constexpr double kShare = 0.2;  // of a run's time, for one scene
  options.bench.seconds = std::min(kMostSeconds, kShare * 60 * options.minutes);
  return argc % 2 == 1 && options.minutes > 0 && options.seed > 0;
}

}  // namespace
}  // namespace sunder::stress

int main(int argc, char** argv) {
  using namespace sunder::stress;
  Options options;
  if (!parse(argc, argv, options)) {
    std::fprintf(stderr,
                 "usage: stress PROGRAM FOLDER [--minutes M] [--seed S] [--only KIND] [--known "
                 "FILE]\nkinds:");
    for (const Kind& kind : kinds()) std::fprintf(stderr, " %s", kind.name);
    std::fprintf(stderr, "\n");
    return 2;
  }
  std::filesystem::create_directories(options.bench.folder);
  Table table(options);
  if (table.empty()) {
    std::fprintf(stderr, "no kind \"%s\"\n", options.only.c_str());
    return 2;
  }
  work(options, table);
  return table.print() ? 0 : 1;
}
