// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/impact_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/same_keys.hpp"
#include "io/scene.hpp"
#include "io/schema_validator.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

const SimulationParams kSimulation{.step = 0.0078125, .iterations = 12};
const ErrorFront kFront{"impact", "of the \"sag\"", "", "the rest", {}};

using Json = nlohmann::ordered_json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A result whose numbers all differ, so that none can stand in another's place unnoticed.
ImpactResult sample_result() {
  ImpactResult r;
  r.steps = 1200, r.substeps = 1300, r.simulated_s = 5.25;
  r.step_ms_median = 0.5, r.step_ms_p95 = 1.5, r.step_ms_max = 2.5;
  r.bodies = 31, r.merged_bodies = 9, r.chunks = 210, r.chunks_freed = 32, r.chunks_split = 3,
  r.broken_bonds = 77;
  r.crack_area = 12.125, r.freed_mass = 640.5, r.largest_freed_mass = 90.25;
  r.freed_by_decade = {11, 12, 13, 14, 15, 16};
  r.max_utilisation = 4.75;
  r.reactions[0] = 0.25, r.reactions[1] = 6280.5, r.reactions[2] = -3.5;
  r.momentum_error = 1e-13, r.penetration_max = 0.001;
  r.energy = {101, 102, 103, 104, 105, 106, -0.125};
  r.energy_in = 25700, r.energy_peak_ratio = 1.0000001;
  r.projectiles = {{"ball", true, true, 10.5, 3.25, 9.75, 2.5e6},
                   {"late", false, false, 0, 0, kInfinity, 0}};
  r.hash = 0x00ab0000000000cdu;
  r.walls_untouched = 1, r.hulls_not_built = 170, r.chunk_steps_not_simulated = 200000;
  r.body_steps_asleep = 9000, r.cells_not_searched = 180, r.poses_not_recorded = 210000;
  r.warnings = {"a \"quoted\" word", "line\nbreak \\ µ"};
  r.recording.walls.resize(2);
  r.recording.walls[0].asset.wall.name = "front";
  r.recording.walls[1].asset.wall.name = "back";
  r.recording.events = {{0.5, 1, {3, 1.5, 0.1}, 10.25, 4.75, 70, 30},
                        {0.625, 0, {-1, 2, 0}, 7.5, 1.25, 7, 2}};
  return r;
}

std::string sample_text(const ImpactResult& result) {
  return impact_report_json({"0.1.0",
                             7,
                             result,
                             1.75,
                             {{"simulate", 1.5}, {"write", 0.25}},
                             {kSimulation, kFront, {0.05, {"step"}, 0.03}}});
}

Json sample_json() {
  return Json::parse(sample_text(sample_result()));
}

const SchemaValidator& validator() {
  static const SchemaValidator schema(json_schema("impact-report"));
  return schema;
}

bool schema_accepts(const Json& report) {
  return validator().accepts(report.dump());
}

TEST(ImpactReport, EveryNumberStandsUnderItsKey) {
  const Json expected = Json::parse(R"json({
    "version": "0.1.0", "seed": 7, "steps": 1200, "substeps": 1300, "simulated_s": 5.25,
    "wall_s": 1.75, "step_ms": {"median": 0.5, "p95": 1.5, "max": 2.5},
    "settings": {"max_error": 0.05, "chosen": ["step"], "step": 0.0078125, "iterations": 12,
                 "expected_error": 0.03, "met": true, "error_is": "of the \"sag\"",
                 "not_in_it": "the rest"}, "bodies": 31, "merged_bodies": 9,
    "chunks": 210, "chunks_freed": 32, "chunks_split": 3, "broken_joints": [], "broken_bonds": 77,
    "crack_area": 12.125, "freed_mass": 640.5,
    "freed": {"largest_mass": 90.25, "by_decade": [11, 12, 13, 14, 15, 16]},
    "max_utilisation": 4.75, "sag": null, "reactions": {"impulse": [0.25, 6280.5, -3.5]},
    "momentum_error": 1e-13, "penetration_max": 0.001,
    "energy": {"in": 25700, "kinetic": 101, "potential": 102, "strain": 103, "fracture": 104,
               "friction": 105, "contact": 106, "numerical": -0.125, "peak_ratio": 1.0000001},
    "projectiles": [
      {"name": "ball", "hit": true, "perforated": true, "speed_before": 10.5,
       "residual_speed": 3.25, "ballistic_speed": 9.75, "contact_force": 2.5e6},
      {"name": "late", "hit": false, "perforated": false, "speed_before": 0, "residual_speed": 0,
       "ballistic_speed": null, "contact_force": 0}],
    "breaks": [
      {"time": 0.5, "wall": "back", "point": [3, 1.5, 0.1], "speed": 10.25, "utilisation": 4.75,
       "bonds_broken": 70, "chunks_freed": 30},
      {"time": 0.625, "wall": "front", "point": [-1, 2, 0], "speed": 7.5, "utilisation": 1.25,
       "bonds_broken": 7, "chunks_freed": 2}],
    "solves": {"full": 0, "update": 0, "skipped": 0}, "hash": "00ab0000000000cd",
    "skipped": {"walls_untouched": 1, "hulls_not_built": 170, "chunk_steps_not_simulated": 200000,
                "body_steps_asleep": 9000, "cells_not_searched": 180,
                "poses_not_recorded": 210000},
    "warnings": ["a \"quoted\" word", "line\nbreak \\ µ"],
    "time": {"simulate_s": 1.5, "write_s": 0.25}})json");
  const Json written = sample_json();
  EXPECT_EQ(written, expected) << Json::diff(expected, written).dump(1);
  auto other = expected.begin();
  for (auto each = written.begin(); each != written.end(); ++each, ++other) {
    EXPECT_EQ(each.key(), other.key());  // ordered as documented
  }
}

TEST(ImpactReport, HasALinePerKeyBreakAndProjectile) {
  const std::string text = sample_text(sample_result());
  EXPECT_TRUE(text.starts_with("{\n  \"version\": \"0.1.0\",\n  \"seed\": 7,\n"));
  EXPECT_NE(text.find("\n  \"broken_joints\": [],\n"), std::string::npos);
  EXPECT_NE(text.find("\n  \"projectiles\": [\n    {\"name\": \"ball\", \"hit\": true, "),
            std::string::npos);
  EXPECT_NE(text.find("\"contact_force\": 0}\n  ],\n  \"breaks\": [\n    {\"time\": 0.5, "),
            std::string::npos);
  EXPECT_TRUE(text.ends_with("\n  \"time\": {\"simulate_s\": 1.5, \"write_s\": 0.25}\n}\n"));
  std::size_t keys = sample_json().size(), entries = 2 + 2 + 2, closing = 3;
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')),
            keys + entries + closing + 2);
}

TEST(ImpactReport, NumbersReadBackAsTheSameDoubles) {
  for (std::uint64_t i = 0; i < 500; ++i) {
    ImpactResult result;
    result.crack_area = std::ldexp(random_unit(23, i, 0) - 0.5,
                                   static_cast<int>(random_bits(23, i, 1) % 400) - 200);
    result.energy.numerical = -1e-9 * random_unit(23, i, 2);
    const Json written = Json::parse(sample_text(result));
    EXPECT_EQ(written["crack_area"].get<double>(), result.crack_area) << "case " << i;
    EXPECT_EQ(written["energy"]["numerical"].get<double>(), result.energy.numerical);
  }
  ImpactResult result;
  result.chunk_steps_not_simulated = ~std::uint64_t{0};
  EXPECT_EQ(Json::parse(sample_text(result))["skipped"]["chunk_steps_not_simulated"],
            ~std::uint64_t{0});
}

TEST(ImpactReport, WhatIsNotFiniteIsNull) {
  ImpactResult result;
  result.max_utilisation = std::numeric_limits<double>::quiet_NaN();
  result.energy_peak_ratio = -kInfinity;
  const Json written = Json::parse(sample_text(result));
  EXPECT_TRUE(written["max_utilisation"].is_null());
  EXPECT_TRUE(written["energy"]["peak_ratio"].is_null());
}

TEST(ImpactReport, HashHasSixteenDigits) {
  for (const auto& [hash, digits] : {std::pair<std::uint64_t, const char*>{0, "0000000000000000"},
                                     {0xF, "000000000000000f"},
                                     {0x0123456789abcdef, "0123456789abcdef"},
                                     {~std::uint64_t{0}, "ffffffffffffffff"}}) {
    ImpactResult result;
    result.hash = hash;
    EXPECT_EQ(Json::parse(sample_text(result))["hash"], digits);
  }
}

TEST(ImpactReport, ManyBreaksAreAllWritten) {
  ImpactResult result = sample_result();
  result.recording.events.assign(20000, result.recording.events[0]);
  EXPECT_EQ(Json::parse(sample_text(result))["breaks"].size(), 20000u);
}

// --- Schema ----------------------------------------------------------------------------------

TEST(ImpactReportSchema, DescribesEveryKeyThatIsWritten) {
  const Json schema = Json::parse(json_schema("impact-report"));
  EXPECT_EQ(schema["title"], "sunder report of impact");
  const Json written = sample_json();
  expect_same_keys(schema, written, "");
  EXPECT_TRUE(schema_accepts(written));
  EXPECT_TRUE(schema_accepts(Json::parse(sample_text({}))));
}

TEST(ImpactReportSchema, RefusesAWrongReport) {
  const std::pair<const char*, Json> rows[] = {
      {"/steps", -1},
      {"/steps", 1.5},
      {"/sag", 0.1},
      {"/hash", "xyz"},
      {"/energy/in", nullptr},
      {"/energy", Json::object()},
      {"/freed/by_decade", {1, 2, 3}},
      {"/reactions/impulse", {1, 2}},
      {"/projectiles/0/hit", 1},
      {"/projectiles/0/residual_speed", nullptr},
      {"/breaks/1/wall", 0},
      {"/breaks/1/point", {0, 0}},
      {"/breaks/0/bonds_broken", -1},
      {"/solves/full", "none"},
      {"/skipped/body_steps_asleep", 0.5},
      {"/warnings/0", nullptr},
      {"/time/write_s", -1},
  };
  for (const auto& [place, value] : rows) {
    Json wrong = sample_json();
    wrong[Json::json_pointer(place)] = value;
    EXPECT_FALSE(schema_accepts(wrong)) << place << " = " << value;
  }
  const Json written = sample_json();
  for (const auto& [key, each] : written.items()) {
    Json wrong = written;
    wrong.erase(key);
    EXPECT_FALSE(schema_accepts(wrong)) << key;
  }
}

TEST(ImpactReportSchema, TellsTheTwoKindsOfReportApart) {
  const SchemaValidator other(json_schema("report"));
  EXPECT_FALSE(other.accepts(sample_text(sample_result())));
}

}  // namespace
}  // namespace sunder
