// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/sim/impact_scenes.hpp"

namespace sunder {

/// One corner of what users may ask for: a wall of which every chunk comes loose at the first hit
/// (toughened glass of hardly any strength) or of a real material, and a ball for its middle.
struct StabilityCell {
  const char* axis = "";
  const char* material = "";  ///< "": the one that comes loose
  double mass_ratio = 10;     ///< ball to chunk
  double mass = 0;            ///< of the ball instead, kg
  double step = 1.0 / 240;
  int iterations = 20;
  double thickness = 0.1;
  double travel = 0;  ///< v·step / thickness; 0: at `speed`
  double speed = 20, radius = 0.15;
  double offset = 0;  ///< of everything along x, y and z, m
  double jitter = 1.0;
  double width = 1.5, height = 1, cell = 0.25;
  double duration = 0.3;
};

inline std::string name_of(const StabilityCell& c) {
  char text[300];
  std::snprintf(text, sizeof text,
                "%s: %s ratio %g (or %g kg), step 1/%g, %d iterations, thickness %g m, travel %g, "
                "offset %g m, "
                "jitter %g, %g x %g m of %g m",
                c.axis, c.material, c.mass_ratio, c.mass, std::round(1 / c.step), c.iterations,
                c.thickness, c.travel, c.offset, c.jitter, c.width, c.height, c.cell);
  return text;
}

inline ImpactScene scene_of(const StabilityCell& c) {
  Shot shot;
  shot.width = c.width, shot.height = c.height, shot.thickness = c.thickness;
  const bool is_loose = std::string(c.material).empty();
  shot.material = is_loose ? "toughened-glass" : c.material;
  shot.pattern = R"({"type": "voronoi-grid", "cell": )" + number_text_of(c.cell) +
                 R"(, "jitter": )" + number_text_of(c.jitter) + "}";
  shot.radius = c.radius;
  const double density = find_material(builtin_materials(), shot.material).density;
  shot.mass = c.mass > 0 ? c.mass : c.mass_ratio * density * c.cell * c.cell * c.thickness;
  shot.speed = c.travel > 0 ? c.travel * c.thickness / c.step : c.speed;
  shot.step = c.step;
  shot.duration = c.duration;
  shot.simulation = ", \"iterations\": " + std::to_string(c.iterations);
  ImpactScene scene = impact_scene_of(shot);
  Material& material = scene.walls[0].material;
  if (is_loose) {
    material.tensile_strength = material.compressive_strength = 1;
    material.fracture_energy = 1e-6;
  }
  const Vec3 by{c.offset, c.offset, c.offset};
  Vec3& wall = scene.walls[0].asset.wall.position;
  wall = wall + by;
  scene.projectiles[0].position = scene.projectiles[0].position + by;
  scene.simulation.ground_height += c.offset;
  return scene;
}

inline bool is_number(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline bool is_number(const Pose& pose) {
  const Quaternion& q = pose.rotation;
  return is_number(pose.position) &&
         std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) < 1e-9;
}

/// Every number of the report; a ballistic speed may be infinite.
inline bool is_number(const ImpactResult& r) {
  const EnergyLedger& e = r.energy;
  std::vector<double> all{e.kinetic,           e.potential,       e.strain,
                          e.fracture,          e.friction,        e.contact,
                          e.numerical,         r.energy_in,       r.crack_area,
                          r.freed_mass,        r.max_utilisation, r.reactions[0],
                          r.reactions[1],      r.reactions[2],    r.momentum_error,
                          r.simulated_s,       r.penetration_max, r.energy_peak_ratio,
                          r.largest_freed_mass};
  for (const ProjectileOutcome& p : r.projectiles) {
    all.insert(all.end(), {p.speed_before, p.residual_speed, p.contact_force});
    if (std::isnan(p.ballistic_speed)) return false;
  }
  return std::ranges::all_of(all, [](double x) { return std::isfinite(x); });
}

/// How far something of this mass can be from where it began, if it had all the energy there is.
inline double reach_of(double mass, double energy, double gravity, double time) {
  return std::sqrt(2 * energy / mass) * time + 0.5 * gravity * time * time;
}

inline std::string fault_of_tracks(const Recording& recording) {
  for (std::size_t t = 0; t < recording.tracks.size(); ++t) {
    const Track& track = recording.tracks[t];
    if (track.parent != kNoTrack && track.parent >= t) return "a track's parent is out of range";
    // Without poses: it broke again in the step in which it came loose.
    if (!track.poses.empty() && track.first + track.poses.size() > recording.times.size())
      return "a track is longer than the recording";
    for (const Pose& pose : track.poses)
      if (!is_number(pose)) return "a pose is not a number";
  }
  return "";
}

/// Something is where it cannot be: above its energy, below the ground by more than its size.
inline std::string fault_of_places(const ImpactScene& scene, const ImpactResult& result) {
  const SimulationParams& simulation = scene.simulation;
  const Recording& recording = result.recording;
  const WallAsset& before = scene.walls[0].asset;
  const WallAsset& asset = recording.walls[0].asset;
  const double weight = before.density * before.volume_expected * simulation.gravity;
  const double height = bounding_box(before.wall.region.outline).high.y;
  const Projectile& ball = scene.projectiles[0];
  const double drop = ball.position.y - simulation.ground_height;
  const double energy = result.energy_in + weight * height + ball.mass * simulation.gravity * drop;
  const Pose standing{asset.wall.position, asset.wall.rotation};
  const auto last = static_cast<std::uint32_t>(recording.times.size() - 1);
  for (std::uint32_t i = 0; i <= last; ++i) {
    const double time = recording.times[i];
    const std::uint32_t flown = recording.projectiles[0].track;
    const Vec3 centre = pose_at(recording, flown, i, {ball.position, {}}).position;
    const double slack = 1e-9 * length(ball.position) + 1e-6;
    if (length(centre - ball.position) >
        reach_of(ball.mass, energy, simulation.gravity, time) + slack)
      return "the ball is further than its energy allows";
    if (centre.y < simulation.ground_height - ball.radius) return "the ball sank";
    for (std::uint32_t c = 0; c < asset.chunks.size(); ++c) {
      const MassProperties& chunk = asset.chunks[c];
      const Vec3 stood = standing * chunk.centroid;
      const Vec3 at = pose_at(recording, recording.walls[0].track[c], i, standing) * chunk.centroid;
      const double mass = asset.density * chunk.volume, size = 2 * before.wall.thickness + 0.5;
      if (length(at - stood) > reach_of(mass, energy, simulation.gravity, time) + size)
        return "chunk " + std::to_string(c) + " is further than its energy allows";
      if (at.y < simulation.ground_height - size) return "chunk " + std::to_string(c) + " sank";
    }
  }
  return "";
}

/// "" or what went wrong.
inline std::string fault_of(const StabilityCell& cell, ImpactResult* out = nullptr) {
  const ImpactScene scene = scene_of(cell);
  const ImpactResult result = simulate_impact(scene);
  if (out) *out = result;
  if (!is_number(result)) return "a number of the report is not one";
  if (!result.projectiles[0].hit) return "the ball missed the wall";
  if (result.energy_peak_ratio > 1.001)
    return "energy grew: peak ratio " + std::to_string(result.energy_peak_ratio);
  if (result.momentum_error > 1e-3)
    return "momentum error " + number_text_of(result.momentum_error);
  const RecordedWall& wall = result.recording.walls[0];
  if (wall.track.size() != result.chunks || wall.asset.chunks.size() != result.chunks)
    return "chunks of the report are not those of the recording";
  double volume = 0;
  for (const MassProperties& chunk : wall.asset.chunks) volume += chunk.volume;
  const double expected = scene.walls[0].asset.volume_expected;
  if (!(std::abs(volume / expected - 1) < 1e-6)) return "volume was lost";
  for (const std::uint32_t track : wall.track)
    if (track != kNoTrack && track >= result.recording.tracks.size())
      return "a track is out of range";
  const std::string fault = fault_of_tracks(result.recording);
  return fault.empty() ? fault_of_places(scene, result) : fault;
}

inline std::vector<StabilityCell> mass_ratio_cells() {
  std::vector<StabilityCell> cells;
  for (const double ratio : {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1000.0})
    for (const double step : {1.0 / 30, 1.0 / 240})
      for (const int iterations : {4, 20})
        cells.push_back(
            {.axis = "mass ratio", .mass_ratio = ratio, .step = step, .iterations = iterations});
  return cells;
}

inline std::vector<StabilityCell> step_cells() {
  std::vector<StabilityCell> cells;
  for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 1000})
    for (const int iterations : {4, 20, 100, 500})
      cells.push_back({.axis = "step and iterations",
                       .step = step,
                       .iterations = iterations,
                       .duration = iterations == 500 ? 0.15 : 0.3});
  return cells;
}

inline std::vector<StabilityCell> thickness_cells() {
  std::vector<StabilityCell> cells;
  for (const double thickness : {0.001, 0.01, 0.03, 0.1, 1.0})
    for (const double step : {1.0 / 30, 1.0 / 240})
      for (const double offset : {0.0, 1e4})
        cells.push_back(
            {.axis = "thickness", .step = step, .thickness = thickness, .offset = offset});
  return cells;
}

inline std::vector<StabilityCell> jitter_cells() {
  std::vector<StabilityCell> cells;
  for (const double jitter : {0.0, 0.5, 1.0})
    for (const double offset : {0.0, 1e4})
      for (const double thickness : {0.02, 0.2})
        cells.push_back(
            {.axis = "jitter", .thickness = thickness, .offset = offset, .jitter = jitter});
  return cells;
}

inline std::vector<StabilityCell> tunnelling_cells() {
  std::vector<StabilityCell> cells;
  for (const double travel : {0.5, 1.0, 10.0, 100.0, 1000.0})
    for (const double thickness : {0.001, 0.02, 0.2})
      for (const double step : {1.0 / 30, 1.0 / 240}) {
        const double speed = travel * thickness / step;
        if (speed < 1) continue;  // falls more than it flies
        cells.push_back({.axis = "tunnelling",
                         .step = step,
                         .thickness = thickness,
                         .travel = travel,
                         .width = 1,
                         .height = 1,
                         .duration = 0.04 / speed + 4 * step});
      }
  return cells;
}

inline std::vector<StabilityCell> material_cells(const char* material) {
  const bool is_thin = std::string(material) == "float-glass";
  std::vector<StabilityCell> cells;
  for (const double step : {1.0 / 30, 1.0 / 60})
    for (const int iterations : {4, 7, 9, 20})
      cells.push_back({.axis = "real material",
                       .material = material,
                       .mass = 514,
                       .step = step,
                       .iterations = iterations,
                       .thickness = is_thin ? 0.01 : 0.2,
                       .speed = 10,
                       .radius = 0.25,
                       .width = 3,
                       .height = 2,
                       .duration = is_thin ? 0.2 : 0.5});
  return cells;
}

/// All chunks of a wall of 10,000 free at once, for a step.
inline StabilityCell crowd_cell() {
  return {.axis = "10,000 chunks free at once",
          .thickness = 0.05,
          .width = 10,
          .height = 10,
          .cell = 0.1,
          .duration = 1.0 / 240};
}

}  // namespace sunder
