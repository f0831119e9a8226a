// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fracture/asset.hpp"
#include "sim/frame.hpp"
#include "sim/impact.hpp"
#include "sim/projectile.hpp"
#include "sim/recording.hpp"
#include "sim/simulation_params.hpp"

namespace sunder {

/// How posts fail beside their joints.
struct BreakingRules {
  /// "ec3": a post between braced nodes fails at the buckling resistance of EN 1993-1-1, 6.3.1;
  /// "euler": at its Euler load; "unbraced": the joint of two posts fails when the last beam joint
  /// at it is gone (the paper's rule); "none".
  std::string post_rule = "ec3";
  bool breaking = true;    ///< false: joints hold whatever happens, to see sag and forces
  bool hit_breaks = true;  ///< a joint that a projectile touches fails (the paper's rule)
  bool members_divide = true;  ///< posts and beams fail between their ends too ("hybrid" only)
  /// Loads are judged by their mean over so long, s (first-order lag): a blow of impulse J on rigid
  /// members shows as J/load_time, as on an elastic one, where it is J ω. The default is T/2π of a
  /// loaded floor beam (IPE300, 6 m, a slab's weight: 8 Hz). 0: the force of a single step, as the
  /// paper has it, which grows without bound as the step shrinks.
  double load_time = 0.02;
};
template <>
std::span<const Field<BreakingRules>> fields();

/// Acceleration of the ground at times ascending from 0, linear in between, 0 after the last, m/s².
struct GroundMotion {
  std::vector<double> times;
  std::vector<Vec3> accelerations;
  Vec3 at(double time) const;
};

/// What happens to the building besides projectiles.
struct Scenario {
  std::vector<std::string> remove;  ///< parts taken away at time 0 (alternate path method)
  double load_rate = 0;        ///< N/m² per s by which every slab's live load rises from time 0
                               ///< until the first joint or post fails
  GroundMotion ground_motion;  ///< empty: none
};

struct CollapseScene {
  std::uint64_t seed = 1;
  Frame frame;
  /// Of the frame's patterns, by number: the wall of those that are a file's.
  std::vector<std::optional<WallAsset>> assets = {};
  std::vector<Projectile> projectiles;
  Scenario scenario;
  BreakingRules rules;
  SimulationParams simulation;
};

struct CollapseParams {
  bool skip = true;          ///< false: nothing sleeps, loads of all joints are read in every step
  bool keep_history = true;  ///< loads of joints go into the recording
  Progress progress = {};
};

/// Factors of the frame solver.
struct SolveCounts {
  std::uint64_t full = 0, update = 0;
  std::uint64_t skipped = 0;  ///< steps in which nothing had to be solved
};

/// When the standing frame had no second-order equilibrium any more.
struct Buckling {
  double time = 0;   ///< s
  std::string what;  ///< names the node, its storey (height) and members
};

/// Why a joint broke.
struct JointBreak {
  std::uint32_t joint = 0;
  double time = 0;         ///< s
  double utilisation = 0;  ///< demand by capacity of what broke it
  /// "strength" (its rule and component beside), "hit", "buckling", "unbraced", "removed",
  /// "unheld", "panel" (what it held fell apart), "mechanism" (it moved too far to stand)
  std::string_view mode;
  std::string rule;  ///< interaction, "ec3", "euler", "paper"; name of the projectile or the panel
  std::string component;  ///< N, Vy, Vz, T, My, Mz, rotation; "" otherwise
};

/// A joint that became a plastic hinge.
struct JointYield {
  std::uint32_t joint = 0;
  double time = 0;         ///< when it did so first, s
  double utilisation = 0;  ///< then
  double rotation = 0;     ///< farthest that it turned, rad
};

/// Mean load that a support carries at rest, world axes.
struct SupportReaction {
  std::uint32_t node = 0;
  Vec3 force, torque;  ///< that the ground gives, N, N m (about the node)
};

struct CollapseResult {
  std::uint64_t steps = 0, substeps = 0;
  double simulated_s = 0;
  double step_ms_median = 0, step_ms_p95 = 0, step_ms_max = 0;
  std::uint64_t bodies = 0;                ///< moving bodies at the end
  std::uint64_t merged_bodies = 0;         ///< of them: at rest and fixed
  std::uint64_t parts_freed = 0;           ///< members, slabs, walls no longer joined to the ground
  std::vector<JointBreak> broken_joints;   ///< by time, then joint
  std::vector<JointYield> yielded_joints;  ///< by time, then joint
  std::uint64_t members_divided = 0;      ///< between their ends, to part or to bend there
  std::uint64_t broken_at_rest = 0;       ///< of them, before a projectile, removal, load or motion
  double max_utilisation = 0;             ///< of any joint or post at any time from 0 on
  double utilisation_at_rest = 0;         ///< at time 0
  double weight = 0;                      ///< of the building, N
  std::vector<SupportReaction> supports;  ///< at the end of settling: mean of its last half
  double reaction_error = 0;         ///< |sum of the supports − weight that they carry| / weight
  double sag_mean = 0, sag_max = 0;  ///< of the highest nodes of posts at time 0, m down
  std::string sag_node;              ///< where it is largest
  double sag_end = 0;                ///< largest of those still standing at the end, m
  std::vector<Buckling> buckles;     ///< after time 0 with `p_delta`; from then on first order
  double joint_gap = 0;              ///< widest between the two sides of an intact joint, m
  double first_failure_load =
      0;                     ///< live load at the first failure of a rising load, N/m²; 0: none
  double reactions[3] = {};  ///< impulse that the ground gave from time 0 on, N s
  double momentum_error = 0;
  double penetration_max = 0;
  EnergyLedger energy;    ///< `numerical` holds what the solver's drift correction did not
  double damping = 0;     ///< taken by the damping of a ringing frame, J
  double plastic = 0;     ///< work of plastic hinges, J
  SolveCounts solves;     ///< of the frame solver
  double residual = 0;    ///< its largest |K u − f| / |f|
  double joint_work = 0;  ///< lost in joints (rigid ones: shocks and correction), J
  double energy_in = 0;   ///< of projectiles, added loads and ground motion, J
  // Of slabs and walls that can break.
  std::uint64_t panels = 0;         ///< how many there are
  std::uint64_t panels_meshed = 0;  ///< that became walls of chunks
  std::uint64_t panels_broken = 0;  ///< in which something cracked
  std::uint64_t panel_solves = 0;   ///< of their networks of chunks
  std::uint64_t chunks = 0, chunks_freed = 0, chunks_split = 0;
  std::uint64_t broken_bonds = 0;
  double crack_area = 0;               ///< m², one side
  std::uint64_t solver_fallbacks = 0;  ///< steps in which a direct solver failed
  std::vector<ProjectileOutcome> projectiles;
  std::uint64_t hash = 0;
  // What was not done.
  std::uint64_t body_steps_asleep = 0;
  std::uint64_t joint_steps_not_read = 0;
  std::uint64_t poses_not_recorded = 0;
  std::uint64_t panels_not_meshed = 0;     ///< that could break, and never had to
  std::uint64_t panel_solves_skipped = 0;  ///< of networks, in steps in which nothing had changed
  std::vector<std::string> warnings;
  Recording recording;
};

/// Brings a frame building down with every member a rigid body (the solver "bullet"). Same scene,
/// same bits. Throws Error{input} for a frame with defects, an unknown part to remove, a projectile
/// that starts inside the building or below the ground.
CollapseResult simulate_collapse(const CollapseScene& scene, const CollapseParams& params = {});

}  // namespace sunder
