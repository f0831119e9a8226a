// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <string>

#include "cli/outputs.hpp"
#include "cli/print_soundness.hpp"
#include "cli/progress.hpp"
#include "cli/run.hpp"
#include "cli/stopwatch.hpp"
#include "fracture/measure.hpp"
#include "io/import.hpp"
#include "io/report.hpp"

namespace sunder {
namespace {

// Counts and volume, one line.
std::string details_of(const ImportedAsset& asset, const Soundness& s) {
  const auto count = [](std::uint64_t value) { return std::to_string(value); };
  char volume[64], error[32] = "";
  std::snprintf(volume, sizeof volume, "volume %.9g m³", s.volume);
  if (!std::isnan(s.volume_expected))
    std::snprintf(error, sizeof error, " (off by %.1e)", s.volume_error());
  return (asset.has_chunks ? "  " + count(s.chunks) + " chunks, "
                           : "  one solid, the format keeps no chunks apart: ") +
         count(s.triangles) + " triangles, " +
         (asset.has_chunks ? count(s.bonds) + " bonds, " : "") + volume + error + '\n';
}

}  // namespace

int run_check(const Options& options) {
  int exit_code = kExitOk;
  for (const auto& path : options.inputs) {
    Stopwatch watch;
    const ImportedAsset asset = import_asset(path);
    watch.lap("read");
    std::vector<SoupWall> soups;
    for (const ImportedWall& wall : asset.walls) soups.push_back(soup_of(asset, wall));
    ProgressBar bar("measuring", !options.quiet);
    Report report{
        SUNDER_VERSION, 0, measure(soups, [&](double done) { bar.update(done); }), 0, {}, {}};
    watch.lap("measure");
    report.times = watch.steps();
    if (!report.soundness.is_sound()) exit_code = kExitCheckFailed;
    if (!options.json && !options.quiet)
      print_soundness(stdout, path, report.soundness, details_of(asset, report.soundness));
    write_report(options, report_json(report),
                 [&] { return soundness_page(report, page_source(options)); });
  }
  return exit_code;
}

}  // namespace sunder
