// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/collapse_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "io/same_keys.hpp"
#include "io/scene.hpp"
#include "io/schema_validator.hpp"

namespace sunder {
namespace {

const SimulationParams kSimulation{.step = 0.0078125, .iterations = 12};
const ErrorFront kFront{"collapse", "of the \"sag\"", "", "the rest", {}};

using Json = nlohmann::ordered_json;

CollapseScene sample_scene() {
  CollapseScene scene;
  scene.seed = 7;
  for (const char* name : {"foot_a", "foot_b", "top_a"})
    scene.frame.nodes.push_back({name, {}, false});
  scene.frame.joints.resize(3);
  scene.frame.joints[0].name = "post_a@ground";
  scene.frame.joints[1].name = "beam@post_a";
  scene.frame.joints[2].name = "beam@post_b";
  scene.simulation.solver = "bullet";
  scene.simulation.joint_solver = "nncg";
  scene.simulation.iterations = 200;
  scene.simulation.step = 0.0078125;
  return scene;
}

/// A result whose numbers all differ, so that none can stand in another's place unnoticed.
CollapseResult sample_result() {
  CollapseResult r;
  r.steps = 1200, r.substeps = 1300, r.simulated_s = 5.25;
  r.step_ms_median = 0.5, r.step_ms_p95 = 1.5, r.step_ms_max = 2.5;
  r.panels = 40, r.panels_meshed = 41, r.panels_broken = 42, r.panel_solves = 43;
  r.chunks = 44, r.chunks_freed = 45, r.chunks_split = 46, r.broken_bonds = 47;
  r.crack_area = 48.5, r.panels_not_meshed = 49, r.panel_solves_skipped = 50;
  r.bodies = 31, r.merged_bodies = 9, r.parts_freed = 32, r.broken_at_rest = 1, r.members_divided = 3;
  r.buckles = {{0.625, "at a node"}};
  r.broken_joints = {{2, -0.25, 1.125, "strength", "linear", "My"},
                     {0, 0.5, 0, "hit", "ball", ""},
                     {1, 0.75, 1.0625, "buckling", "ec3", ""}};
  r.yielded_joints = {{1, 0.125, 1.25, 0.03125}};
  r.max_utilisation = 4.75, r.utilisation_at_rest = 0.375;
  r.weight = 840500, r.reaction_error = 1e-6;
  r.supports = {{0, {1, 420000, 2}, {3, 4, 5}}, {1, {-1, 420500, -2}, {6, 7, 8}}};
  r.sag_mean = 0.001, r.sag_max = 0.002, r.sag_node = "top_a", r.sag_end = 0.003;
  r.joint_gap = 0.0005, r.first_failure_load = 12500;
  r.reactions[0] = 0.25, r.reactions[1] = 6280.5, r.reactions[2] = -3.5;
  r.momentum_error = 1e-13, r.penetration_max = 0.0625;
  r.energy = {101, 102, 103, 104, 105, 106, -0.125};
  r.joint_work = 107, r.energy_in = 25700, r.solver_fallbacks = 9;
  r.damping = 108, r.plastic = 109, r.residual = 1e-12, r.solves = {11, 12, 13};
  r.projectiles = {{"ball", true, false, 10.5, 3.25, 9.75, 2.5e6}};
  r.hash = 0x00ab0000000000cdu;
  r.body_steps_asleep = 9000, r.joint_steps_not_read = 8000, r.poses_not_recorded = 210000;
  r.warnings = {"a \"quoted\" word"};
  return r;
}

Json json_of(const CollapseScene& scene, const CollapseResult& result) {
  return Json::parse(collapse_report_json({"0.1.0",
                                           scene,
                                           result,
                                           1.75,
                                           {{"simulate", 1.5}, {"write", 0.25}},
                                           {kSimulation, kFront, {0.05, true, {"step"}, 0.03}}}));
}

Json sample_json() {
  return json_of(sample_scene(), sample_result());
}

const SchemaValidator& validator() {
  static const SchemaValidator schema(json_schema("collapse-report"));
  return schema;
}

bool schema_accepts(const Json& report) {
  return validator().accepts(report.dump());
}

TEST(CollapseReport, EveryNumberStandsUnderItsKey) {
  const Json expected = Json::parse(R"json({
    "version": "0.1.0", "seed": 7, "steps": 1200, "substeps": 1300, "simulated_s": 5.25,
    "wall_s": 1.75, "step_ms": {"median": 0.5, "p95": 1.5, "max": 2.5},
    "settings": {"max_error": 0.05, "asked": true, "chosen": ["step"], "step": 0.0078125, "iterations": 12,
                 "expected_error": 0.03, "met": true, "error_is": "of the \"sag\"",
                 "not_in_it": "the rest"}, "bodies": 31,
    "merged_bodies": 9,
    "parts_freed": 32, "panels": {"count": 40, "meshed": 41, "broken": 42, "solves": 43},
    "chunks": 44, "chunks_freed": 45, "chunks_split": 46,
    "broken_joints": [
      {"joint": "beam@post_b", "time": -0.25, "utilisation": 1.125, "mode": "strength",
       "rule": "linear", "component": "My"},
      {"joint": "post_a@ground", "time": 0.5, "utilisation": 0, "mode": "hit", "rule": "ball",
       "component": ""},
      {"joint": "beam@post_a", "time": 0.75, "utilisation": 1.0625, "mode": "buckling",
       "rule": "ec3", "component": ""}],
    "yielded_joints": [
      {"joint": "beam@post_a", "time": 0.125, "utilisation": 1.25, "rotation": 0.03125}],
    "broken_by": {"strength": 1, "hit": 1, "buckling": 1, "unbraced": 0, "removed": 0,
                  "unheld": 0, "panel": 0, "mechanism": 0},
    "broken_at_rest": 1, "members_divided": 3, "buckles": [{"time": 0.625, "what": "at a node"}], "broken_bonds": 47,
    "crack_area": 48.5, "max_utilisation": 4.75,
    "utilisation_at_rest": 0.375, "first_failure_load": 12500, "joint_gap": 0.0005,
    "sag": {"mean": 0.001, "max": 0.002, "node": "top_a", "end": 0.003},
    "reactions": {"weight": 840500, "error": 1e-6,
                  "supports": [
                    {"node": "foot_a", "force": [1, 420000, 2], "torque": [3, 4, 5]},
                    {"node": "foot_b", "force": [-1, 420500, -2], "torque": [6, 7, 8]}],
                  "impulse": [0.25, 6280.5, -3.5]},
    "momentum_error": 1e-13, "penetration_max": 0.0625,
    "energy": {"in": 25700, "kinetic": 101, "potential": 102, "strain": 103, "fracture": 104,
               "friction": 105, "contact": 106, "numerical": -0.125, "joint": 107,
               "damping": 108, "plastic": 109},
    "projectiles": [
      {"name": "ball", "hit": true, "perforated": false, "speed_before": 10.5,
       "residual_speed": 3.25, "ballistic_speed": 9.75, "contact_force": 2.5e6}],
    "solver": {"name": "bullet", "joint_solver": "nncg", "iterations": 200, "warm_start": true,
               "step": 0.0078125, "fallbacks": 9,
               "residual": 1e-12},
    "solves": {"full": 11, "update": 12, "skipped": 13}, "hash": "00ab0000000000cd",
    "skipped": {"body_steps_asleep": 9000, "joint_steps_not_read": 8000,
                "poses_not_recorded": 210000, "panels_not_meshed": 49, "panel_solves": 50},
    "warnings": ["a \"quoted\" word"],
    "time": {"simulate_s": 1.5, "write_s": 0.25}})json");
  const Json written = sample_json();
  EXPECT_EQ(written, expected) << Json::diff(expected, written).dump(1);
}

TEST(CollapseReport, EveryBrokenJointIsCountedInItsMode) {
  CollapseResult result;
  constexpr std::size_t kOften[kBreakModes.size()] = {5, 1, 4, 2, 3, 6, 7, 8};
  for (std::size_t mode = 0; mode < kBreakModes.size(); ++mode)
    result.broken_joints.insert(result.broken_joints.end(), kOften[mode],
                                {1, 0.5, 2, kBreakModes[mode], "", ""});
  const Json written = json_of(sample_scene(), result);
  std::size_t sum = 0;
  for (std::size_t mode = 0; mode < kBreakModes.size(); ++mode) {
    EXPECT_EQ(written["broken_by"][std::string(kBreakModes[mode])], kOften[mode]);
    sum += kOften[mode];
  }
  EXPECT_EQ(written["broken_joints"].size(), sum);
}

// --- Schema ----------------------------------------------------------------------------------

TEST(CollapseReportSchema, DescribesEveryKeyThatIsWritten) {
  const Json schema = Json::parse(json_schema("collapse-report"));
  EXPECT_EQ(schema["title"], "sunder report of collapse");
  const Json written = sample_json();
  expect_same_keys(schema, written, "");
  EXPECT_TRUE(schema_accepts(written));
  EXPECT_TRUE(schema_accepts(json_of({}, {})));
}

TEST(CollapseReportSchema, RefusesAWrongReport) {
  const std::pair<const char*, Json> rows[] = {
      {"/steps", -1},
      {"/parts_freed", 1.5},
      {"/broken_joints/0/joint", 0},
      {"/broken_joints/1/mode", "magic"},
      {"/broken_joints/2/time", nullptr},
      {"/broken_by/hit", -1},
      {"/panels", 3},
      {"/panels/broken", -1},
      {"/crack_area", nullptr},
      {"/skipped/panels_not_meshed", 0.5},
      {"/sag", nullptr},
      {"/sag/node", 3},
      {"/reactions/weight", "heavy"},
      {"/reactions/supports/1/force", {1, 2}},
      {"/reactions/supports/0/torque/2", "x"},
      {"/reactions/impulse", {1, 2}},
      {"/energy/joint", nullptr},
      {"/projectiles/0/hit", 1},
      {"/solver/iterations", 0.5},
      {"/solver/warm_start", 1},
      {"/solver/fallbacks", -1},
      {"/hash", "xyz"},
      {"/skipped/joint_steps_not_read", 0.5},
      {"/warnings/0", nullptr},
      {"/time/write_s", -1},
  };
  for (const auto& [place, value] : rows) {
    Json wrong = sample_json();
    wrong.at(Json::json_pointer(place)) = value;
    EXPECT_FALSE(schema_accepts(wrong)) << place << " = " << value;
  }
  const Json written = sample_json();
  for (const auto& [key, each] : written.items()) {
    Json wrong = written;
    wrong.erase(key);
    EXPECT_FALSE(schema_accepts(wrong)) << key;
  }
}

TEST(CollapseReportSchema, TellsTheKindsOfReportApart) {
  for (const char* other : {"report", "impact-report"}) {
    const SchemaValidator schema(json_schema(other));
    EXPECT_FALSE(schema.accepts(sample_json().dump())) << other;
  }
}

}  // namespace
}  // namespace sunder
