// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "fracture/asset.hpp"
#include "sim/material.hpp"
#include "sim/projectile.hpp"
#include "sim/recording.hpp"
#include "sim/simulation_params.hpp"

namespace sunder {

/// A wall and what it is made of. A wall without anchors stands free. The asset is one of file
/// precision (see recover_wall), so that a wall in memory and one from a file are the same.
struct ImpactWall {
  WallAsset asset;
  Material material;
};

struct ImpactScene {
  std::uint64_t seed = 1;
  std::vector<ImpactWall> walls;
  std::vector<Projectile> projectiles;
  SimulationParams simulation;
};

struct ImpactParams {
  /// False: does all the work that the scene does not need (colliders of every chunk from the start,
  /// islands searched anew after every break), to prove that the outcome is the same.
  bool skip = true;
  Progress progress = {};
};

/// Where the energy that went in is, J. Sum of all = energy at the start.
struct EnergyLedger {
  double kinetic = 0;    ///< of everything that moves, at the end
  double potential = 0;  ///< of it, against where it stood (or started)
  double strain = 0;     ///< stored elastically; 0: walls are rigid between breaks
  double fracture = 0;   ///< G_f × new crack area, less what toughening had stored
  double friction = 0;
  double contact = 0;    ///< crushing, inelastic contacts, what walls and ground took
  double numerical = 0;  ///< what remains: the error of the simulation
};

/// What became of a projectile.
struct ProjectileOutcome {
  std::string name;
  bool hit = false;         ///< met a wall
  bool perforated = false;  ///< left the wall on the other side
  double speed_before = 0;  ///< at the first contact with a wall, m/s
  double residual_speed = 0;    ///< behind the wall (0: did not get through), m/s
  double ballistic_speed = 0;   ///< that the wall has for it at the first contact, m/s; inf: never
  double contact_force = 0;     ///< peak at the first contact, N
};

struct ImpactResult {
  std::uint64_t steps = 0, substeps = 0;
  double simulated_s = 0;
  double step_ms_median = 0, step_ms_p95 = 0, step_ms_max = 0;
  std::uint64_t bodies = 0;        ///< moving bodies at the end
  std::uint64_t merged_bodies = 0; ///< of them: at rest and fixed
  std::uint64_t chunks = 0;        ///< of all walls, at the end
  std::uint64_t chunks_freed = 0;  ///< no longer part of a standing wall
  std::uint64_t chunks_split = 0;  ///< free chunks that broke again
  std::uint64_t broken_bonds = 0;
  double crack_area = 0;     ///< m², one side
  double freed_mass = 0;     ///< kg
  double largest_freed_mass = 0;  ///< of one body at the end, kg
  /// Freed bodies by mass: counts in decades below the heaviest, heaviest first.
  std::array<std::uint64_t, 6> freed_by_decade{};
  double max_utilisation = 0;
  double reactions[3] = {};      ///< impulse that ground and anchors gave, N s
  double momentum_error = 0;     ///< largest over the steps, relative to the largest momentum
  double penetration_max = 0;    ///< deepest overlap at the end of a step, m
  EnergyLedger energy;
  double energy_in = 0;          ///< kinetic energy of the projectiles at their start, J
  double energy_peak_ratio = 0;  ///< largest mechanical energy over what had gone in by then
  std::vector<ProjectileOutcome> projectiles;
  std::uint64_t hash = 0;        ///< of all poses and breaks, bit for bit
  // What was not done.
  std::uint64_t walls_untouched = 0;
  std::uint64_t hulls_not_built = 0;
  std::uint64_t chunk_steps_not_simulated = 0;  ///< chunks × steps without a body of their own
  std::uint64_t body_steps_asleep = 0;
  std::uint64_t cells_not_searched = 0;         ///< by the bounded search for islands
  std::uint64_t poses_not_recorded = 0;
  std::vector<std::string> warnings;
  Recording recording;
};

/// Runs an impact test. Same scene, same bits, on every run and machine.
/// Throws Error{input} that names the projectile and wall when a projectile starts inside a wall or
/// below the ground.
ImpactResult simulate_impact(const ImpactScene& scene, const ImpactParams& params = {});

}  // namespace sunder
