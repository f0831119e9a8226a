// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/joint_history.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "io/export_files.hpp"
#include "io/json_lines.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::string_view kSuffixes[] = {".csv", ".json"};
constexpr std::string_view kColumns[] = {
    "N", "Vy", "Vz", "T", "My", "Mz", "force_utilisation", "torque_utilisation", "utilisation"};

std::array<float, std::size(kColumns)> values_of(const JointSample& s) {
  return {s.force[0],  s.force[1],          s.force[2],           s.torque[0],  s.torque[1],
          s.torque[2], s.force_utilisation, s.torque_utilisation, s.utilisation};
}

const JointSample& sample(const Recording& recording, std::size_t time, std::size_t joint) {
  return recording.samples[time * recording.joints.size() + joint];
}

// --- CSV --------------------------------------------------------------------------------------

// As RFC 4180 asks.
std::string csv_field(const std::string& name) {
  if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
  std::string field = "\"";
  for (const char c : name) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

void write_value(TextWriter& out, float value) {
  if (std::isfinite(value)) return out.number(value);
  out.text(std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
}

void write_csv(const Recording& recording, TextWriter& out) {
  out.text("time,joint");
  for (const std::string_view column : kColumns) {
    out.text(",");
    out.text(column);
  }
  out.text("\n");
  std::vector<std::string> names;
  for (const RecordedJoint& joint : recording.joints) names.push_back(csv_field(joint.name));
  for (std::size_t t = 0; t < recording.sample_times.size(); ++t) {
    for (std::size_t j = 0; j < names.size(); ++j) {
      if (recording.sample_times[t] >= recording.joints[j].broken) continue;
      out.exact(recording.sample_times[t]);
      out.text(",");
      out.text(names[j]);
      for (const float value : values_of(sample(recording, t, j))) {
        out.text(",");
        write_value(out, value);
      }
      out.text("\n");
    }
  }
}

// --- JSON -------------------------------------------------------------------------------------

std::string_view part_name(const Recording& recording, std::uint32_t part) {
  if (part == kNoTrack) return "ground";
  assert(part < recording.parts.size());
  return recording.parts[part].name;
}

void write_joint(const Recording& recording, std::size_t j, JsonLines& json) {
  const RecordedJoint& joint = recording.joints[j];
  json.open('{');
  json.text("name", joint.name);
  json.text("a", part_name(recording, joint.part_a));
  json.text("b", part_name(recording, joint.part_b));
  json.number("broken", joint.broken);
  const auto count =
      static_cast<std::size_t>(std::ranges::lower_bound(recording.sample_times, joint.broken) -
                               recording.sample_times.begin());
  for (std::size_t column = 0; column < std::size(kColumns); ++column) {
    json.open(kColumns[column], '[');
    for (std::size_t t = 0; t < count; ++t)
      json.float32(values_of(sample(recording, t, j))[column]);
    json.close();
  }
  json.close();
}

void write_json(const Recording& recording, TextWriter& out) {
  JsonLines json(out);
  json.open('{');
  json.open("times", '[');
  for (const double time : recording.sample_times) json.number(time);
  json.close();
  json.open("joints", '[');
  for (std::size_t j = 0; j < recording.joints.size(); ++j) write_joint(recording, j, json);
  json.close();
  json.close();
  out.text("\n");
}

}  // namespace

bool is_history_suffix(const std::string& suffix) {
  return std::ranges::find(kSuffixes, suffix) != std::end(kSuffixes);
}

void write_joint_history(const Recording& recording, const std::filesystem::path& path) {
  assert(recording.samples.size() == recording.sample_times.size() * recording.joints.size());
  const std::string suffix = suffix_of(path);
  if (!is_history_suffix(suffix)) {
    throw Error(ErrorCode::usage,
                "suffix \"" + suffix + "\" of a joint history is not one of .csv .json");
  }
  OutputFile file(path);
  FileSink sink(file);
  TextWriter out(sink);
  suffix == ".csv" ? write_csv(recording, out) : write_json(recording, out);
  out.flush();
  file.commit();
}

}  // namespace sunder
