// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/report.hpp"

#include <cmath>
#include <cstdio>

#include "io/text_writer.hpp"

namespace sunder {
namespace {

std::string exact(double value) {
  if (!std::isfinite(value)) return "null";
  char buffer[kNumberRoom];
  return {buffer, put_exact(buffer, value)};
}

// Only quotes and backslashes need care: the texts are our own and names.
std::string quoted_json(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

// Builds one JSON object, a key per line.
class JsonObject {
 public:
  explicit JsonObject(int depth) : indent_(2 * static_cast<std::size_t>(depth), ' ') {}

  void add(const std::string& key, const std::string& value) {
    text_ += (text_.empty() ? "{\n" : ",\n") + indent_ + '"' + key + "\": " + value;
  }
  void add(const std::string& key, double value) { add(key, exact(value)); }
  void add(const std::string& key, std::uint64_t value) { add(key, std::to_string(value)); }

  std::string close() const {
    return text_.empty() ? "{}" : text_ + '\n' + indent_.substr(2) + '}';
  }

 private:
  std::string text_, indent_;
};

std::string repair_json(const ReportedRepair& reported) {
  const Repair& repair = reported.repair;
  std::string steps;
  for (const std::string& step : repair.steps)
    steps += (steps.empty() ? "" : ", ") + quoted_json(step);
  JsonObject json(3);
  json.add("solid", quoted_json(reported.solid));
  json.add("found", quoted_json(repair.before.text()));
  json.add("steps", '[' + steps + ']');
  json.add("volume_before", repair.volume_before);
  json.add("volume_after", repair.volume_after);
  json.add("hausdorff", repair.hausdorff);
  json.add("voxel", repair.voxel);
  return json.close();
}

std::string repairs_json(const std::vector<ReportedRepair>& repairs) {
  std::string list;
  for (const ReportedRepair& each : repairs) list += (list.empty() ? "" : ", ") + repair_json(each);
  return '[' + list + ']';
}

}  // namespace

std::string report_json(const Report& report) {
  const Soundness& s = report.soundness;
  char hash[32];
  std::snprintf(hash, sizeof hash, "\"%016llx\"", static_cast<unsigned long long>(s.hash));
  JsonObject times(2), skipped(2);
  for (const auto& [step, seconds] : report.times) times.add(step + "_s", seconds);
  for (const auto& [what, count] : report.skipped) skipped.add(what, count);

  JsonObject json(1);
  json.add("version", '"' + report.version + '"');
  json.add("seed", report.seed);
  json.add("sound", std::string(s.is_sound() ? "true" : "false"));
  json.add("chunks", s.chunks);
  json.add("triangles", s.triangles);
  json.add("bonds", s.bonds);
  json.add("volume", s.volume);
  json.add("volume_expected", s.volume_expected);
  json.add("volume_error", s.volume_error());
  json.add("open_chunks", s.open_chunks);
  json.add("nonmanifold_chunks", s.nonmanifold_chunks);
  json.add("inverted_chunks", s.inverted_chunks);
  json.add("overlapping_pairs", s.overlapping_pairs);
  json.add("self_crossing_chunks", s.self_crossing_chunks);
  json.add("crossing_surfaces", s.crossing_surfaces);
  json.add("unmatched_faces", s.unmatched_faces);
  json.add("slivers", s.slivers);
  json.add("slivers_merged", report.slivers_merged);
  json.add("min_chunk_volume", s.min_chunk_volume);
  json.add("hash", std::string(hash));
  json.add("repair", repairs_json(report.repairs));
  json.add("time", times.close());
  json.add("skipped", skipped.close());
  return json.close() + '\n';
}

}  // namespace sunder
