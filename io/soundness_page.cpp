// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "io/run_page.hpp"

namespace sunder {
namespace {

std::string volume_text(double volume) {
  if (volume >= 0.01 || !(volume > 0)) return digits_text(volume) + "\u00a0m³";
  if (volume >= 1e-6) return digits_text(1e6 * volume) + "\u00a0cm³";
  return digits_text(1e9 * volume) + "\u00a0mm³";
}

void write_faults(HtmlPage& page, const Soundness& s) {
  page.open_section("Faults",
                    "Counted in the float32 triangles that a file holds; points are "
                    "equal when their bits are.");
  const SkippedRow faults[] = {
      {"Open chunks", s.open_chunks, "An edge has a triangle on one side only."},
      {"Chunks that are no manifold", s.nonmanifold_chunks, "An edge has more than two triangles."},
      {"Chunks inside out", s.inverted_chunks, "Closed, but the volume is not above 0."},
      {"Pairs of chunks that overlap", s.overlapping_pairs, "Two chunks in one place."},
      {"Chunks that cross themselves", s.self_crossing_chunks, "Of solids."},
      {"Outer surfaces that cross", s.crossing_surfaces, "Of solids."},
      {"Crack triangles without a partner", s.unmatched_faces,
       "Every crack face must be the exact reverse of one of the neighbour's."}};
  HtmlTable table{"wnl", {cells({"fault", "found", ""})}};
  for (const SkippedRow& fault : faults)
    table.rows.push_back({with_note(fault.name, fault.meaning), escaped(count_text(fault.count)),
                          fault.count == 0 ? badge("good", "none") : badge("bad", "fault")});
  page.table(table);
  page.close_section();
}

void write_repairs(HtmlPage& page, const std::vector<ReportedRepair>& repairs) {
  if (repairs.empty()) return;
  page.open_section("Repairs");
  HtmlTable table{"lwwnnn",
                  {cells({"solid", "found", "done", "volume before", "after", "moved at most"})}};
  for (const ReportedRepair& each : repairs) {
    std::string steps;
    for (const std::string& step : each.repair.steps) steps += (steps.empty() ? "" : ", ") + step;
    table.rows.push_back(
        cells({each.solid, each.repair.before.text(), steps, volume_text(each.repair.volume_before),
               volume_text(each.repair.volume_after), quantity_text(each.repair.hausdorff, "m")}));
  }
  page.table(table);
  page.close_section();
}

}  // namespace

std::string soundness_page(const Report& report, const PageSource& source) {
  const Soundness& s = report.soundness;
  const bool is_known = std::isfinite(s.volume_expected);
  HtmlPage page("soundness report", source.input);
  page.lede(s.is_sound()
                ? "Sound: every chunk is closed, neighbours match bit for bit, and together "
                  "they fill the whole once."
                : "Not sound: see the faults below.");
  page.end_header();
  const std::vector<Tile> tiles = {
      {"chunks", count_text(s.chunks), count_text(s.bonds) + " bonds"},
      {"triangles", count_text(s.triangles), ""},
      {"volume", volume_text(s.volume),
       is_known ? "off by " + share_text(s.volume_error()) : "the right one is not known"},
      {"smallest chunk", volume_text(s.min_chunk_volume), ""},
      {"slivers", count_text(s.slivers),
       "merged into neighbours: " + count_text(report.slivers_merged)}};
  page.tiles(tiles);
  write_faults(page, s);
  write_repairs(page, report.repairs);
  write_reproduction(page, source, report.seed, s.hash, report.version, report.times);
  return page.finish(report.version);
}

}  // namespace sunder
