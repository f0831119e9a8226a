// SPDX-License-Identifier: GPL-3.0-or-later
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <span>

#include "io/collapse_report.hpp"
#include "io/report_schema.hpp"

namespace sunder {
namespace {

using Json = nlohmann::ordered_json;

/// A value of a report.
struct ReportKey {
  const char* name;
  const char* type;
  const char* description;
};

constexpr ReportKey kReportKeys[] = {
    {"version", "string", "Version of the program."},
    {"seed", "integer", "Seed of the random numbers."},
    {"sound", "boolean",
     "True when no chunk is open, not manifold or inverted, none overlap or cross itself, every "
     "inner face is "
     "matched, and the volume is right to 1e-6 where the one expected is known."},
    {"chunks", "integer", "Chunks of all walls."},
    {"triangles", "integer", "Triangles of all chunks."},
    {"bonds", "integer", "Bonds between chunks and anchors to the world."},
    {"volume", "number", "Sum of the chunks' volumes. Unit: m³."},
    {"volume_expected", "number",
     "Of walls, area of the outlines less the openings, by thickness; of solids, volume of the "
     "model. "
     "Unit: m³."},
    {"volume_error", "number", "Difference of the two by the volume expected."},
    {"open_chunks", "integer", "Chunks with an edge that only one triangle has."},
    {"nonmanifold_chunks", "integer", "Chunks with an edge of more than two triangles."},
    {"inverted_chunks", "integer", "Closed chunks whose volume is not above 0."},
    {"overlapping_pairs", "integer",
     "Pairs of chunks whose front faces overlap; of a solid, pairs with the same outer face."},
    {"self_crossing_chunks", "integer",
     "Chunks of solids that cross themselves by more than rounding to float32 moves corners."},
    {"crossing_surfaces", "integer",
     "Solids whose outer faces cross each other by more than that."},
    {"unmatched_faces", "integer", "Inner triangles without exactly one partner in another chunk."},
    {"slivers", "integer",
     "Chunks whose front is thinner than 1:50; of a solid, chunks with less than a thousandth of "
     "the volume of the cube over their diagonal."},
    {"slivers_merged", "integer", "Cells that were merged because they were too small."},
    {"min_chunk_volume", "number", "Volume of the smallest chunk. Unit: m³."},
    {"hash", "string", "Of all triangles, bit for bit; 16 hexadecimal digits."},
    {"repair", "array", "What was done to the models of solids that were none."},
};

constexpr ReportKey kRepairKeys[] = {
    {"solid", "string", "Name of the solid."},
    {"found", "string", "What was wrong with its model."},
    {"steps", "array", "What was done, in order."},
    {"volume_before", "number", "Volume that the model encloses, as far as it does. Unit: m³."},
    {"volume_after", "number", "Volume of the solid made of it. Unit: m³."},
    {"hausdorff", "number", "Largest distance between the two surfaces. Unit: m."},
    {"voxel", "number", "Size of the level set's voxels; 0: none was needed. Unit: m."},
};

// Of every run of a simulation: first keys, then …
constexpr ReportKey kRunKeys[] = {
    {"version", "string", "Version of the program."},
    {"seed", "integer", "Seed of the random numbers."},
    {"steps", "integer", "Steps, one recorded pose each."},
    {"substeps", "integer", "Parts that the steps were divided into, all together."},
    {"simulated_s", "number", "Time that was simulated. Unit: s."},
    {"wall_s", "number", "Time that the run took. Unit: s."},
    {"step_ms", "object", "Time that a step took. Unit: ms."},
    {"settings", "object", "The error asked for, and what the settings are known to give."},
};

constexpr ReportKey kImpactKeys[] = {
    {"bodies", "integer", "Moving bodies at the end."},
    {"merged_bodies", "integer", "Of them: at rest, and fixed until what they lie on goes."},
    {"chunks", "integer", "Chunks of all walls at the end."},
    {"chunks_freed", "integer", "Chunks that are no longer part of a standing wall."},
    {"chunks_split", "integer", "Free chunks that broke again."},
    {"broken_joints", "array", "Joints of a building that broke; empty without one."},
    {"broken_bonds", "integer", "Bonds and anchors that broke."},
    {"crack_area", "number", "New crack surface, one side counted. Unit: m²."},
    {"freed_mass", "number", "Mass that is no longer part of a standing wall. Unit: kg."},
    {"freed", "object", "Sizes of the bodies that came free."},
    {"max_utilisation", "number", "Largest demand divided by capacity; 1 breaks."},
    {"sag", "null", "Of a building; null without one. Unit: m."},
    {"reactions", "object", "What ground and anchors gave."},
    {"momentum_error", "number",
     "Largest violation of the balance of momentum in a step, by the largest momentum."},
    {"penetration_max", "number", "Deepest overlap of two bodies at the end of a step. Unit: m."},
    {"energy", "object", "Where the energy went. Unit: J."},
    {"projectiles", "array", "What became of each projectile."},
    {"breaks", "array", "What broke, in order of time."},
};

// … and last ones.
constexpr ReportKey kRunEndKeys[] = {
    {"solves", "object", "Solves of the static solver; zeros: there was none."},
    {"hash", "string", "Of all poses and breaks, bit for bit; 16 hexadecimal digits."},
    {"skipped", "object", "What was not done because nothing needed it."},
    {"warnings", "array", "What limits the trust in these numbers."},
    {"time", "object", "What each part of the run took, keys end in _s. Unit: s."},
};

constexpr ReportKey kCollapseKeys[] = {
    {"bodies", "integer", "Moving bodies at the end."},
    {"merged_bodies", "integer", "Of them: at rest, and fixed until what they lie on goes."},
    {"parts_freed", "integer", "Members, slabs and walls no longer joined to the ground."},
    {"panels", "object", "Slabs and walls that can break into chunks."},
    {"chunks", "integer", "Chunks of those that were meshed, at the end."},
    {"chunks_freed", "integer", "Chunks that no longer hang on the frame."},
    {"chunks_split", "integer", "Free chunks that broke again."},
    {"broken_joints", "array", "Joints that broke, in order of time."},
    {"yielded_joints", "array", "Joints that became plastic hinges, in order of time."},
    {"broken_by", "object", "How many broke in which mode."},
    {"broken_at_rest", "integer",
     "Of them, before a projectile, a removal, a load or a motion of the ground."},
    {"members_divided", "integer",
     "Posts and beams that failed between their ends, to part or to bend there."},
    {"buckles", "array",
     "When what stands had no second-order equilibrium any more; from then on it is solved in "
     "first order."},
    {"broken_bonds", "integer", "Bonds and anchors of slabs and walls that broke."},
    {"crack_area", "number", "New crack surface, one side counted. Unit: m²."},
    {"max_utilisation", "number", "Largest of any joint or post from time 0 on; 1 breaks."},
    {"utilisation_at_rest", "number", "Largest of any joint or post at time 0."},
    {"first_failure_load", "number",
     "Live load at the first failure under a rising load; 0: none. Unit: N/m²."},
    {"joint_gap", "number", "Widest between the two sides of an intact joint. Unit: m."},
    {"sag", "object", "How far the highest nodes of posts went down. Unit: m."},
    {"reactions", "object", "What the ground gave."},
    {"momentum_error", "number",
     "Largest violation of the balance of momentum in a step, by the largest momentum."},
    {"penetration_max", "number", "Deepest overlap of two bodies at the end of a step. Unit: m."},
    {"energy", "object", "Where the energy went. Unit: J."},
    {"projectiles", "array", "What became of each projectile."},
    {"solver", "object", "How the motion was solved."},
};

constexpr ReportKey kJointBreakKeys[] = {
    {"joint", "string", "Name of the joint: part@part or part@ground."},
    {"time", "number", "Unit: s."},
    {"utilisation", "number", "Demand divided by capacity of what broke it."},
    {"mode", "string", "Why it broke."},
    {"rule", "string",
     "Its interaction of forces and torques, the rule of posts, or the projectile that hit."},
    {"component", "string",
     "The largest share: N, Vy, Vz, T, My or Mz; rotation of a plastic hinge that has turned as "
     "far as it can; empty in other modes."},
};

constexpr ReportKey kBucklingKeys[] = {
    {"time", "number", "Unit: s."},
    {"what", "string", "Where: the node, its storey (height) and members."},
};

constexpr ReportKey kJointYieldKeys[] = {
    {"joint", "string", "Name of the joint: part@part or part@ground."},
    {"time", "number", "When it yielded first. Unit: s."},
    {"utilisation", "number", "Demand divided by capacity then."},
    {"rotation", "number", "Farthest that the hinge turned. Unit: rad."},
};

constexpr ReportKey kModeKeys[] = {
    {"strength", "integer", "Forces and torques exceeded those of the joint."},
    {"hit", "integer", "A projectile touched it."},
    {"buckling", "integer", "The post below or above buckled."},
    {"unbraced", "integer", "The last beam at the joint of two posts was gone."},
    {"removed", "integer", "Its part was taken away by the scenario."},
    {"unheld", "integer", "What it held had lost too many other joints to be in balance."},
    {"panel", "integer", "The slab or wall that it held fell apart, or hit something as it fell."},
    {"mechanism", "integer",
     "It held what moved without resistance, or had moved too far to stand."},
};

constexpr ReportKey kPanelKeys[] = {
    {"count", "integer", "How many there are."},
    {"meshed", "integer", "That had to be made as walls of chunks."},
    {"broken", "integer", "In which a bond or an anchor broke."},
    {"solves", "integer", "Solutions of their networks of chunks."},
};

constexpr ReportKey kSagKeys[] = {
    {"mean", "number", "At time 0, mean of the nodes."},
    {"max", "number", "At time 0, the largest."},
    {"node", "string", "Where it is largest."},
    {"end", "number", "The largest of those that still stand at the end."},
};

constexpr ReportKey kBuildingReactionKeys[] = {
    {"weight", "number", "Of the building. Unit: N."},
    {"error", "number", "Sum of the supports' forces and the weight, by the weight, at rest."},
    {"supports", "array", "What each support carries at rest."},
};

constexpr ReportKey kSupportKeys[] = {
    {"node", "string", "Name of the node."},
    {"force", "array", "Of the ground on the building, x, y and z. Unit: N."},
    {"torque", "array", "About the node, x, y and z. Unit: N m."},
};

constexpr ReportKey kSolverKeys[] = {
    {"name", "string", "The solver that ran."},
    {"joint_solver", "string", "Bullet's way to solve joints."},
    {"iterations", "integer", "A step."},
    {"warm_start", "boolean", "Joints start from the impulses of the last step."},
    {"step", "number", "As in the scene. Unit: s."},
    {"fallbacks", "integer", "Steps in which a direct solver failed and iterations took over."},
    {"residual", "number",
     "Largest error of equilibrium of the frame solver, by the largest load; 0: it is not used."},
};

constexpr ReportKey kStepKeys[] = {
    {"median", "number", "Half of the steps took less."},
    {"p95", "number", "19 of 20 steps took less."},
    {"max", "number", "The longest step."},
};

constexpr ReportKey kFreedKeys[] = {
    {"largest_mass", "number", "Heaviest body that came free. Unit: kg."},
    {"by_decade", "array",
     "Bodies that came free with a mass from a tenth of the heaviest to it, from a hundredth to a "
     "tenth …"},
};

constexpr ReportKey kReactionKeys[] = {
    {"impulse", "array", "Sum over the run, x, y and z. Unit: N s."},
};

constexpr ReportKey kEnergyKeys[] = {
    {"in", "number", "Of the projectiles at their start; by loads and motion of the ground."},
    {"kinetic", "number", "Of everything that moves at the end."},
    {"potential", "number", "Of it, against where it stood or started."},
    {"strain", "number", "Stored elastically."},
    {"fracture", "number", "Taken by new cracks, less what toughening had stored."},
    {"friction", "number", "Lost by sliding."},
    {"contact", "number", "Lost by crushing and contacts that are not elastic."},
    {"numerical", "number", "What remains: the error of the simulation."},
};

constexpr ReportKey kPeakKeys[] = {
    {"peak_ratio", "number", "Largest mechanical energy by what had gone in by then."},
};

constexpr ReportKey kJointWorkKeys[] = {
    {"joint", "number", "Lost in rigid joints: shocks, and the correction of their drift."},
    {"damping", "number", "Taken by the damping of a ringing frame."},
    {"plastic", "number", "Work of plastic hinges."},
};

constexpr ReportKey kProjectileKeys[] = {
    {"name", "string", "As in the scene."},
    {"hit", "boolean", "Met a wall or a part of a building."},
    {"perforated", "boolean", "Left the wall on the other side."},
    {"speed_before", "number", "At that first contact. Unit: m/s."},
    {"residual_speed", "number", "Behind the wall; 0: it did not get through. Unit: m/s."},
    {"ballistic_speed", "number|null",
     "From which it goes through the wall, by the model; null: never. Unit: m/s."},
    {"contact_force", "number", "Peak at the first contact, by the model. Unit: N."},
};

constexpr ReportKey kBreakKeys[] = {
    {"time", "number", "Unit: s."},
    {"wall", "string", "Name of the wall."},
    {"point", "array", "Of the contact, x, y and z in the world. Unit: m."},
    {"speed", "number", "Of approach. Unit: m/s."},
    {"utilisation", "number", "Demand divided by capacity where it was largest."},
    {"bonds_broken", "integer", "Bonds and anchors that broke."},
    {"chunks_freed", "integer", "Chunks that came free."},
};

constexpr ReportKey kSolveKeys[] = {
    {"full", "integer", "With a new factorisation."},
    {"update", "integer", "With an updated factorisation."},
    {"skipped", "integer", "Not needed: no load had changed."},
};

constexpr ReportKey kSkippedKeys[] = {
    {"walls_untouched", "integer", "Walls that nothing hit: no collision shapes, no motion."},
    {"hulls_not_built", "integer", "Collision shapes of chunks that nothing came near."},
    {"chunk_steps_not_simulated", "integer", "Chunks × steps without a body of their own."},
    {"body_steps_asleep", "integer", "Bodies × steps at rest."},
    {"cells_not_searched", "integer", "Cells that the search for islands left out."},
    {"poses_not_recorded", "integer", "Poses of what did not move."},
};

constexpr ReportKey kCollapseSkippedKeys[] = {
    {"body_steps_asleep", "integer", "Bodies × steps at rest."},
    {"joint_steps_not_read", "integer", "Joints × steps whose load was known without asking."},
    {"poses_not_recorded", "integer", "Poses of what did not move."},
    {"panels_not_meshed", "integer", "Slabs and walls that could break, and never had to."},
    {"panel_solves", "integer", "Networks × steps in which nothing had changed for them."},
};

constexpr ReportKey kSettingKeys[] = {
    {"max_error", "number", "Relative error asked for."},
    {"asked", "boolean", "Whether the scene gives it, or it is the default."},
    {"chosen", "array", "Keys of the simulation that were chosen for it."},
    {"step", "number", "Unit: s."},
    {"iterations", "integer", "Of the contact solver."},
    {"expected_error", "number|null",
     "Measured with settings no finer than these; null: nothing comparable was measured."},
    {"met", "boolean", "Whether that is at most what was asked for."},
    {"error_is", "string", "What that error is."},
    {"not_in_it", "string", "What it says nothing about."},
};

/// An object of the keys of these tables, all of them required.
Json object_of(std::initializer_list<std::span<const ReportKey>> tables) {
  Json properties = Json::object(), required = Json::array();
  for (const std::span<const ReportKey> keys : tables) {
    for (const ReportKey& key : keys) {
      Json schema{{"type", key.type}, {"description", key.description}};
      if (schema["type"] == "number|null") schema["type"] = {"number", "null"};
      if (schema["type"] == "integer") schema["minimum"] = 0;
      properties[key.name] = std::move(schema);
      required.push_back(key.name);
    }
  }
  return {{"type", "object"}, {"properties", properties}, {"required", required}};
}

Json object_of(std::span<const ReportKey> keys) {
  return object_of({keys});
}

/// Says what is in a key that object_of only named.
void fill(Json& key, Json content) {
  key.update(content);
}

Json list_of(Json items) {
  return {{"items", std::move(items)}};
}

Json list_of(std::size_t size, Json items) {
  return {{"items", std::move(items)}, {"minItems", size}, {"maxItems", size}};
}

Json seconds() {
  return {{"patternProperties", {{"_s$", {{"type", "number"}, {"minimum", 0}}}}}};
}

Json point_schema() {
  return list_of(3, {{"type", "number"}});
}

/// What every run of a simulation has.
void fill_run(Json& properties) {
  fill(properties["step_ms"], object_of(kStepKeys));
  fill(properties["settings"], object_of(kSettingKeys));
  fill(properties["settings"]["properties"]["chosen"], list_of({{"type", "string"}}));
  fill(properties["projectiles"], list_of(object_of(kProjectileKeys)));
  fill(properties["solves"], object_of(kSolveKeys));
  properties["hash"]["pattern"] = "^[0-9a-f]{16}$";
  fill(properties["warnings"], list_of({{"type", "string"}}));
  fill(properties["time"], seconds());
}

std::string text_of(const char* title, const Json& schema) {
  Json whole{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  whole.update(schema);
  whole["additionalProperties"] = true;
  return whole.dump(2) + '\n';
}

}  // namespace

std::string report_schema() {
  Json schema = object_of(kReportKeys);
  Json& properties = schema["properties"];
  // A measure that a format cannot tell is null, not left out.
  for (const char* key : {"volume_expected", "volume_error", "min_chunk_volume"}) {
    properties[key]["type"] = {"number", "null"};
  }
  properties["hash"]["pattern"] = "^[0-9a-f]{16}$";
  fill(properties["repair"], list_of(object_of(kRepairKeys)));
  properties["repair"]["items"]["properties"]["steps"]["items"] = {{"type", "string"}};
  properties["time"] = {{"type", "object"},
                        {"description", "What each step took, keys end in _s. Unit: s."}};
  fill(properties["time"], seconds());
  properties["skipped"] = {{"type", "object"},
                           {"description", "What was not done because nothing needed it."}};
  schema["required"] = {"sound", "chunks", "triangles", "volume", "hash"};
  return text_of("sunder report of fracture and check", schema);
}

std::string impact_report_schema() {
  Json schema = object_of({kRunKeys, kImpactKeys, kRunEndKeys});
  Json& properties = schema["properties"];
  const Json count{{"type", "integer"}, {"minimum", 0}};
  fill_run(properties);
  fill(properties["broken_joints"], list_of({{"type", "object"}}));
  fill(properties["freed"], object_of(kFreedKeys));
  fill(properties["freed"]["properties"]["by_decade"], list_of(6, count));
  fill(properties["reactions"], object_of(kReactionKeys));
  fill(properties["reactions"]["properties"]["impulse"], point_schema());
  fill(properties["energy"], object_of({kEnergyKeys, kPeakKeys}));
  Json event = object_of(kBreakKeys);
  fill(event["properties"]["point"], point_schema());
  fill(properties["breaks"], list_of(std::move(event)));
  fill(properties["skipped"], object_of(kSkippedKeys));
  return text_of("sunder report of impact", schema);
}

std::string collapse_report_schema() {
  Json schema = object_of({kRunKeys, kCollapseKeys, kRunEndKeys});
  Json& properties = schema["properties"];
  fill_run(properties);
  Json joint = object_of(kJointBreakKeys);
  joint["properties"]["mode"]["enum"] = kBreakModes;
  fill(properties["broken_joints"], list_of(std::move(joint)));
  fill(properties["yielded_joints"], list_of(object_of(kJointYieldKeys)));
  fill(properties["buckles"], list_of(object_of(kBucklingKeys)));
  fill(properties["broken_by"], object_of(kModeKeys));
  fill(properties["panels"], object_of(kPanelKeys));
  fill(properties["sag"], object_of(kSagKeys));
  fill(properties["reactions"], object_of({kBuildingReactionKeys, kReactionKeys}));
  Json& reactions = properties["reactions"]["properties"];
  fill(reactions["impulse"], point_schema());
  Json support = object_of(kSupportKeys);
  for (const char* key : {"force", "torque"}) fill(support["properties"][key], point_schema());
  fill(reactions["supports"], list_of(std::move(support)));
  fill(properties["energy"], object_of({kEnergyKeys, kJointWorkKeys}));
  fill(properties["solver"], object_of(kSolverKeys));
  fill(properties["skipped"], object_of(kCollapseSkippedKeys));
  return text_of("sunder report of collapse", schema);
}

}  // namespace sunder
