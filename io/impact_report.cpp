// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/impact_report.hpp"

#include <cassert>
#include <cmath>

#include "io/text_writer.hpp"

namespace sunder {
namespace {

class StringSink : public ByteSink {
 public:
  explicit StringSink(std::string& text) : text_(text) {}
  void write(std::span<const std::byte> bytes) override {
    text_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void rewrite_front(std::span<const std::byte> bytes) override {
    assert(bytes.size() <= text_.size());
    std::memcpy(text_.data(), bytes.data(), bytes.size());
  }

 private:
  std::string& text_;
};

/// Nested objects and lists: a line for each key of the outer object and for each entry of a list
/// there, everything below on that line.
class JsonLines {
 public:
  explicit JsonLines(TextWriter& out) : out_(out) {}

  void open(char bracket) {
    begin();
    out_.text(bracket == '{' ? "{" : "[");
    levels_.push_back({bracket});
  }
  void open(std::string_view key, char bracket) {
    name(key);
    open(bracket);
  }
  void close() {
    const Level level = levels_.back();
    if (level.count > 0 && has_lines()) line(levels_.size() - 1);
    levels_.pop_back();
    out_.text(level.bracket == '{' ? "}" : "]");
  }

  void number(double value) {
    begin();
    if (std::isfinite(value)) {
      out_.exact(value);
    } else {
      out_.text("null");
    }
  }
  void count(std::uint64_t value) {
    begin();
    out_.integer(value);
  }
  void text(std::string_view value) {
    begin();
    out_.quoted(value);
  }
  void number(std::string_view key, double value) {
    name(key);
    number(value);
  }
  void count(std::string_view key, std::uint64_t value) {
    name(key);
    count(value);
  }
  void text(std::string_view key, std::string_view value) {
    name(key);
    text(value);
  }
  void truth(std::string_view key, bool value) { word(key, value ? "true" : "false"); }
  void null(std::string_view key) { word(key, "null"); }

 private:
  struct Level {
    char bracket = '{';
    std::size_t count = 0;  ///< entries so far
  };

  bool has_lines() const {
    return levels_.size() == 1 || (levels_.size() == 2 && levels_.back().bracket == '[');
  }
  void line(std::size_t depth) {
    out_.text("\n");
    for (std::size_t i = 0; i < depth; ++i) out_.text("  ");
  }
  // What stands before an entry; nothing more after its key.
  void begin() {
    if (levels_.empty() || named_) {
      named_ = false;
      return;
    }
    if (levels_.back().count++ > 0) out_.text(has_lines() ? "," : ", ");
    if (has_lines()) line(levels_.size());
  }
  void name(std::string_view key) {
    text(key);
    out_.text(": ");
    named_ = true;
  }
  void word(std::string_view key, std::string_view value) {
    name(key);
    begin();
    out_.text(value);
  }

  TextWriter& out_;
  std::vector<Level> levels_;
  bool named_ = false;
};

void write_point(JsonLines& json, std::string_view key, Vec3 point) {
  json.open(key, '[');
  for (const double each : {point.x, point.y, point.z}) json.number(each);
  json.close();
}

std::string hex_digits(std::uint64_t value) {
  std::string digits(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) digits[i] = "0123456789abcdef"[value & 15];
  return digits;
}

void write_run(JsonLines& json, const ImpactReport& report) {
  const ImpactResult& r = report.result;
  json.text("version", report.version);
  json.count("seed", report.seed);
  json.count("steps", r.steps);
  json.count("substeps", r.substeps);
  json.number("simulated_s", r.simulated_s);
  json.number("wall_s", report.wall_s);
  json.open("step_ms", '{');
  json.number("median", r.step_ms_median);
  json.number("p95", r.step_ms_p95);
  json.number("max", r.step_ms_max);
  json.close();
}

void write_damage(JsonLines& json, const ImpactResult& r) {
  json.count("bodies", r.bodies);
  json.count("chunks", r.chunks);
  json.count("chunks_freed", r.chunks_freed);
  json.count("chunks_split", r.chunks_split);
  json.open("broken_joints", '[');
  json.close();
  json.count("broken_bonds", r.broken_bonds);
  json.number("crack_area", r.crack_area);
  json.number("freed_mass", r.freed_mass);
  json.open("freed", '{');
  json.number("largest_mass", r.largest_freed_mass);
  json.open("by_decade", '[');
  for (const std::uint64_t each : r.freed_by_decade) json.count(each);
  json.close();
  json.close();
  json.number("max_utilisation", r.max_utilisation);
  json.null("sag");
}

void write_balance(JsonLines& json, const ImpactResult& r) {
  json.open("reactions", '{');
  write_point(json, "impulse", {r.reactions[0], r.reactions[1], r.reactions[2]});
  json.close();
  json.number("momentum_error", r.momentum_error);
  json.number("penetration_max", r.penetration_max);
  json.open("energy", '{');
  json.number("in", r.energy_in);
  json.number("kinetic", r.energy.kinetic);
  json.number("potential", r.energy.potential);
  json.number("strain", r.energy.strain);
  json.number("fracture", r.energy.fracture);
  json.number("friction", r.energy.friction);
  json.number("contact", r.energy.contact);
  json.number("numerical", r.energy.numerical);
  json.number("peak_ratio", r.energy_peak_ratio);
  json.close();
}

void write_projectiles(JsonLines& json, const ImpactResult& r) {
  json.open("projectiles", '[');
  for (const ProjectileOutcome& each : r.projectiles) {
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

void write_breaks(JsonLines& json, const Recording& recording) {
  json.open("breaks", '[');
  for (const BreakEvent& event : recording.events) {
    assert(event.wall < recording.walls.size());
    json.open('{');
    json.number("time", event.time);
    json.text("wall", recording.walls[event.wall].asset.wall.name);
    write_point(json, "point", event.point);
    json.number("speed", event.speed);
    json.number("utilisation", event.utilisation);
    json.count("bonds_broken", event.bonds_broken);
    json.count("chunks_freed", event.chunks_freed);
    json.close();
  }
  json.close();
}

void write_work(JsonLines& json, const ImpactResult& r) {
  json.open("solves", '{');
  for (const char* key : {"full", "update", "skipped"}) json.count(key, 0);
  json.close();
  json.text("hash", hex_digits(r.hash));
  json.open("skipped", '{');
  json.count("walls_untouched", r.walls_untouched);
  json.count("hulls_not_built", r.hulls_not_built);
  json.count("chunk_steps_not_simulated", r.chunk_steps_not_simulated);
  json.count("body_steps_asleep", r.body_steps_asleep);
  json.count("cells_not_searched", r.cells_not_searched);
  json.count("poses_not_recorded", r.poses_not_recorded);
  json.close();
  json.open("warnings", '[');
  for (const std::string& warning : r.warnings) json.text(warning);
  json.close();
}

}  // namespace

std::string impact_report_json(const ImpactReport& report) {
  std::string text;
  StringSink sink(text);
  TextWriter out(sink);
  JsonLines json(out);
  json.open('{');
  write_run(json, report);
  write_damage(json, report.result);
  write_balance(json, report.result);
  write_projectiles(json, report.result);
  write_breaks(json, report.result.recording);
  write_work(json, report.result);
  json.open("time", '{');
  for (const auto& [step, seconds] : report.times) json.number(step + "_s", seconds);
  json.close();
  json.close();
  out.text("\n");
  out.flush();
  return text;
}

}  // namespace sunder
