// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/impact.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "sim/recorder.hpp"
#include "sim/rigid_world.hpp"
#include "sim/step_times.hpp"
#include "sim/wall_run.hpp"

namespace sunder {
namespace {

/// A step is divided at most so often; what would need more is told.
constexpr double kMostSubsteps = 4096;
/// Contacts of projectiles that end a substep early, per step; later ones are left to the solver.
constexpr int kMostArrivals = 64;

WorldParams world_params(const SimulationParams& simulation) {
  WorldParams world;
  world.gravity = simulation.gravity;
  world.iterations = static_cast<int>(simulation.iterations);
  world.has_ground = simulation.ground;
  world.ground_height = simulation.ground_height;
  world.sleep = simulation.sleep;
  world.max_bodies = static_cast<std::uint32_t>(simulation.max_bodies);
  return world;
}

/// One impact test: moves time on.
class ImpactRun {
 public:
  ImpactRun(const ImpactScene& scene, const ImpactParams& params);
  ImpactResult run();

 private:
  void step_once(double end);
  double next_substep(double left);
  void advance(double dt);
  void note_energy();
  void record(double time);
  EnergyLedger ledger() const;
  void sample();
  double largest_energy_scale() const;
  ImpactResult outcome();

  const ImpactScene& scene_;
  const ImpactParams& params_;
  RigidWorld world_;
  Recorder recorder_;
  ImpactResult result_;
  WallRun walls_;
  std::vector<RunSample> series_;
  double now_ = 0, next_sample_ = 0, most_used_ = 0;
  Vec3 impulse_;  ///< that the world's fixed bodies gave, N s
  double largest_momentum_ = 0, largest_momentum_error_ = 0, largest_excess_ = 0;
};

ImpactRun::ImpactRun(const ImpactScene& scene, const ImpactParams& params)
    : scene_(scene),
      params_(params),
      world_(world_params(scene.simulation)),
      walls_(scene, params, world_, recorder_, result_, {}) {}

ImpactResult ImpactRun::run() {
  const SimulationParams& simulation = scene_.simulation;
  const auto steps =
      static_cast<std::uint64_t>(std::ceil(simulation.duration / simulation.step - 1e-9));
  std::vector<double> milliseconds;
  walls_.launch_due(0);
  sample();
  for (std::uint64_t i = 1; i <= steps; ++i) {
    const auto start = std::chrono::steady_clock::now();
    step_once(std::min(static_cast<double>(i) * simulation.step, simulation.duration));
    record(now_);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    milliseconds.push_back(took.count());
    if (params_.progress) params_.progress(now_ / simulation.duration);
  }
  result_.steps = steps;
  result_.simulated_s = now_;
  result_.step_ms_median = percentile(milliseconds, 0.5);
  result_.step_ms_p95 = percentile(milliseconds, 0.95);
  result_.step_ms_max = percentile(milliseconds, 1);
  return outcome();
}

void ImpactRun::step_once(double end) {
  int arrivals = 0;
  const double least = scene_.simulation.step / kMostSubsteps;
  while (end - now_ > 1e-3 * least) {
    walls_.launch_due(now_ + least);
    double dt = next_substep(end - now_);
    const std::optional<WallRun::Arrival> arrival =
        arrivals < kMostArrivals ? walls_.next_arrival(dt) : std::nullopt;
    if (arrival) dt = arrival->time;
    if (dt > 1e-3 * least) {
      advance(dt);
      walls_.after_step(now_);
    }
    if (!arrival) continue;
    ++arrivals;
    walls_.arrive(*arrival);
  }
  now_ = end;
}

double ImpactRun::next_substep(double left) {
  double dt = left;
  for (std::uint32_t s = 0; s < scene_.projectiles.size(); ++s)
    if (walls_.shot_body(s) == kNoBody && scene_.projectiles[s].time > now_)
      dt = std::min(dt, scene_.projectiles[s].time - now_);
  const double least = scene_.simulation.step / kMostSubsteps;
  const double limit = walls_.prepare(dt);
  if (limit < std::min(least, dt) && result_.warnings.empty())
    result_.warnings.push_back(
        "something moved further in a step than its own size even with the step divided by " +
        std::to_string(static_cast<int>(kMostSubsteps)) + "; give a smaller \"step\"");
  return std::min(dt, std::max(limit, least));
}

void ImpactRun::advance(double dt) {
  const Vec3 before = world_.momentum();
  world_.step(dt);
  now_ += dt;
  ++result_.substeps;
  const Vec3 reaction = world_.reaction(), after = world_.momentum();
  impulse_ = impulse_ + reaction;
  largest_momentum_ = std::max({largest_momentum_, length(before), length(after)});
  largest_momentum_error_ =
      std::max(largest_momentum_error_, length(after - before - reaction - world_.weight()));
  result_.penetration_max = std::max(result_.penetration_max, world_.overlap());
  const StepWork work = world_.work();
  result_.energy.contact += work.contact;
  result_.energy.friction += work.friction;
}

void ImpactRun::note_energy() {
  const double mechanical = world_.kinetic_energy() + world_.potential_energy() - walls_.baseline();
  largest_excess_ = std::max(largest_excess_, mechanical - result_.energy_in);
}

void ImpactRun::record(double time) {
  recorder_.add_time(time);
  walls_.record_islands();
  walls_.record_shots();
  note_energy();
  if (time + 1e-9 >= next_sample_) sample();
}

EnergyLedger ImpactRun::ledger() const {
  EnergyLedger e = result_.energy;
  e.kinetic = world_.kinetic_energy();
  e.potential = world_.potential_energy() - walls_.baseline();
  e.numerical = result_.energy_in - e.kinetic - e.potential - e.fracture - e.friction - e.contact;
  return e;
}

/// The result's largest utilisation is that since the sample before, until the run ends.
void ImpactRun::sample() {
  next_sample_ = now_ + scene_.simulation.history_step;
  most_used_ = std::max(most_used_, result_.max_utilisation);
  const EnergyLedger e = ledger();
  RunSample& s = series_.emplace_back();
  s.time = now_;
  s.kinetic = e.kinetic, s.potential = e.potential, s.fracture = e.fracture;
  s.friction = e.friction, s.contact = e.contact, s.numerical = e.numerical;
  s.broken_bonds = result_.broken_bonds;
  s.moving = world_.awake_count();
  s.max_utilisation = std::exchange(result_.max_utilisation, 0);
}

ImpactResult ImpactRun::outcome() {
  ImpactResult& r = result_;
  if (series_.back().time < now_) sample();
  r.max_utilisation = most_used_;
  r.bodies = world_.body_count();
  r.merged_bodies = world_.merged_count();
  r.energy = ledger();
  r.energy_peak_ratio = 1 + largest_excess_ / std::max(r.energy_in, largest_energy_scale());
  r.momentum_error = largest_momentum_ > 0 ? largest_momentum_error_ / largest_momentum_ : 0;
  const Vec3 impulse = impulse_ + walls_.impulse();
  r.reactions[0] = impulse.x, r.reactions[1] = impulse.y, r.reactions[2] = impulse.z;
  std::vector<RecordedWall> recorded = walls_.finish();
  r.hash = recorder_.hash();
  r.recording = recorder_.take();
  r.recording.walls = std::move(recorded);
  r.recording.seed = scene_.seed;
  r.recording.series = std::move(series_);
  for (std::uint32_t i = 0; i < scene_.projectiles.size(); ++i)
    r.recording.projectiles.push_back({scene_.projectiles[i], walls_.shot_track(i)});
  return std::move(r);
}

double ImpactRun::largest_energy_scale() const {
  const EnergyLedger& e = result_.energy;
  return std::max({1e-9, e.contact + e.friction, -e.potential});
}

}  // namespace

ImpactResult simulate_impact(const ImpactScene& scene, const ImpactParams& params) {
  return ImpactRun(scene, params).run();
}

}  // namespace sunder
