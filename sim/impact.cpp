// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/impact.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "sim/impact_run.hpp"
#include "sim/step_times.hpp"

namespace sunder {
namespace {

/// A step is divided at most so often; what would need more is told.
constexpr double kMostSubsteps = 4096;
/// Contacts of projectiles that end a substep early, per step; later ones are left to the solver.
constexpr int kMostArrivals = 64;

/// Connected chunks by their bonds: the smallest chunk of each one's component, and whether it
/// has an anchor.
struct Components {
  std::vector<std::uint32_t> root;
  std::vector<std::uint8_t> anchored;  // by root
};

Components components_of(std::uint32_t count, std::span<const Bond> bonds) {
  Components result{std::vector<std::uint32_t>(count), std::vector<std::uint8_t>(count, 0)};
  std::iota(result.root.begin(), result.root.end(), 0u);
  const auto find = [&](std::uint32_t c) {
    while (result.root[c] != c) c = result.root[c] = result.root[result.root[c]];
    return c;
  };
  for (const Bond& bond : bonds) {
    if (bond.b == kWorld) continue;
    const std::uint32_t a = find(bond.a), b = find(bond.b);
    result.root[std::max(a, b)] = std::min(a, b);
  }
  for (std::uint32_t c = 0; c < count; ++c) result.root[c] = find(c);
  for (const Bond& bond : bonds)
    if (bond.b == kWorld) result.anchored[result.root[bond.a]] = 1;
  return result;
}

WorldParams world_params(const SimulationParams& simulation) {
  WorldParams world;
  world.gravity = simulation.gravity;
  world.iterations = static_cast<int>(simulation.iterations);
  world.has_ground = simulation.ground;
  world.ground_height = simulation.ground_height;
  world.sleep = simulation.sleep;
  return world;
}

}  // namespace

ImpactRun::ImpactRun(const ImpactScene& scene, const ImpactParams& params)
    : scene_(scene), params_(params), world_(world_params(scene.simulation)) {
  if (scene.simulation.ground) own(kGround, {Owner::Kind::ground, 0, 0});
  add_walls();
  for (const Projectile& projectile : scene.projectiles) {
    Shot shot;
    shot.projectile = projectile;
    shots_.push_back(shot);
    result_.projectiles.emplace_back();
    result_.projectiles.back().name = projectile.name;
    result_.projectiles.back().ballistic_speed = std::numeric_limits<double>::infinity();
  }
}

void ImpactRun::own(BodyId body, Owner owner) {
  if (owners_.size() <= body) owners_.resize(body + 1);
  owners_[body] = owner;
}

// What hangs on no anchor is a body from the start; of a wall without anchors the component with
// most chunks is the wall.
void ImpactRun::add_walls() {
  for (const ImpactWall& wall : scene_.walls) walls_.emplace_back(wall);
  least_thickness_ = std::numeric_limits<double>::infinity();
  std::vector<std::vector<std::vector<std::uint32_t>>> loose;
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    least_thickness_ = std::min(least_thickness_, 2 * walls_[w].half_thickness);
    loose.push_back(add_wall(w));
  }
  for (std::uint32_t w = 0; w < walls_.size(); ++w)
    for (const std::vector<std::uint32_t>& members : loose[w]) {
      const std::vector<Bond> bonds = bonds_among(members, walls_[w].asset.bonds);
      const std::uint32_t island = free_island(w, members, bonds);
      islands_[island].track = recorder_.add_track(kNoTrack);
      add_body_of(island, motion_of(islands_[island]));
    }
  if (!params_.skip)
    for (std::uint32_t w = 0; w < walls_.size(); ++w) raise_colliders_near(w, {}, {});
}

// Island w; returns the components that are not part of it.
std::vector<std::vector<std::uint32_t>> ImpactRun::add_wall(std::uint32_t w) {
  const auto count = static_cast<std::uint32_t>(walls_[w].chunks.size());
  const std::vector<Bond>& bonds = walls_[w].asset.bonds;
  const Components parts = components_of(count, bonds);
  std::vector<std::vector<std::uint32_t>> members(count), loose;
  for (std::uint32_t c = 0; c < count; ++c) members[parts.root[c]].push_back(c);
  const bool anchored = std::ranges::any_of(parts.anchored, [](auto flag) { return flag != 0; });
  const auto most = std::ranges::max_element(members, {}, &std::vector<std::uint32_t>::size);
  const auto largest = static_cast<std::uint32_t>(most - members.begin());
  std::vector<std::uint32_t> main;
  for (std::uint32_t c = 0; c < count; ++c) {
    const std::uint32_t root = parts.root[c];
    if (anchored ? parts.anchored[root] != 0 : root == largest)
      main.push_back(c);
    else if (root == c)
      loose.push_back(members[c]);
  }
  islands_.push_back(main.size() == count
                         ? make_island(walls_[w], w, std::move(main), bonds)
                         : make_island(walls_[w], w, main, bonds_among(main, bonds)));
  for (const std::uint32_t c : islands_[w].chunks) walls_[w].chunks[c].island = w;
  if (!anchored) {
    islands_[w].track = recorder_.add_track(kNoTrack);
    add_body_of(w, motion_of(islands_[w]));
  }
  return loose;
}

Pose ImpactRun::pose_of(const Island& island) const {
  return island.body == kNoBody ? walls_[island.wall].standing : world_.pose(island.body);
}

ImpactResult ImpactRun::run() {
  const SimulationParams& simulation = scene_.simulation;
  const auto steps =
      static_cast<std::uint64_t>(std::ceil(simulation.duration / simulation.step - 1e-9));
  std::vector<double> milliseconds;
  for (std::uint32_t s = 0; s < shots_.size(); ++s)
    if (shots_[s].projectile.time <= 0) launch(s);
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
    for (std::uint32_t s = 0; s < shots_.size(); ++s)
      if (shots_[s].body == kNoBody && shots_[s].projectile.time <= now_ + least) launch(s);
    double dt = next_substep(end - now_);
    const std::optional<Arrival> arrival =
        arrivals < kMostArrivals ? next_arrival(dt) : std::nullopt;
    if (arrival) dt = arrival->time;
    if (dt > 1e-3 * least) {
      advance(dt);
      meet_contacts();
      watch_projectiles();
    }
    if (!arrival) continue;
    ++arrivals;
    arrive(*arrival);
  }
  now_ = end;
}

double ImpactRun::next_substep(double left) {
  double dt = left;
  for (const Shot& shot : shots_)
    if (shot.body == kNoBody && shot.projectile.time > now_)
      dt = std::min(dt, shot.projectile.time - now_);
  raise_colliders(dt);
  const double least = scene_.simulation.step / kMostSubsteps;
  const double limit = distance_limit(dt);
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
  unspent_ = std::max(work.contact + work.friction, 0.0);
}

void ImpactRun::note_energy() {
  const double mechanical = world_.kinetic_energy() + world_.potential_energy() - baseline_;
  largest_excess_ = std::max(largest_excess_, mechanical - result_.energy_in);
}

void ImpactRun::record(double time) {
  recorder_.add_time(time);
  const auto pose = [&](BodyId body, std::uint32_t track, bool force) {
    if (world_.is_awake(body) || force) {
      recorder_.add_pose(track, world_.pose(body));
    } else {
      ++result_.body_steps_asleep;
      ++result_.poses_not_recorded;
    }
  };
  for (const std::uint32_t i : live_)
    pose(islands_[i].body, islands_[i].track, recorder_.is_empty(islands_[i].track));
  for (const Shot& shot : shots_)
    if (shot.body != kNoBody) pose(shot.body, shot.track, false);
  for (std::uint32_t w = 0; w < walls_.size(); ++w)
    if (islands_[w].body == kNoBody) {
      const std::uint64_t count = islands_[w].graph ? islands_[w].graph->present_count() : 1;
      result_.chunk_steps_not_simulated += count;
      result_.poses_not_recorded += count;
    }
  note_energy();
}

// Through is through: behind the far face of what is left, seen from where it hit.
void ImpactRun::watch_projectiles() {
  for (std::uint32_t s = 0; s < shots_.size(); ++s) {
    const Shot& shot = shots_[s];
    ProjectileOutcome& outcome = result_.projectiles[s];
    if (shot.body == kNoBody || !outcome.hit || outcome.perforated) continue;
    const WallState& wall = walls_[shot.wall];
    const Vec3 local = inverse(pose_of(islands_[shot.wall])) * world_.centre(shot.body);
    if (-shot.side * local.z < wall.half_thickness + shot.projectile.radius) continue;
    if (local.x < wall.size_low.x || local.x > wall.size_high.x || local.y < wall.size_low.y ||
        local.y > wall.size_high.y)
      continue;
    outcome.perforated = true;
    outcome.residual_speed = length(world_.velocity(shot.body));
  }
}

ImpactResult ImpactRun::outcome() {
  ImpactResult& r = result_;
  r.bodies = world_.body_count();
  r.energy.kinetic = world_.kinetic_energy();
  r.energy.potential = world_.potential_energy() - baseline_;
  r.energy.numerical = r.energy_in - r.energy.kinetic - r.energy.potential - r.energy.fracture -
                       r.energy.friction - r.energy.contact;
  r.energy_peak_ratio = 1 + largest_excess_ / std::max(r.energy_in, largest_energy_scale());
  r.momentum_error = largest_momentum_ > 0 ? largest_momentum_error_ / largest_momentum_ : 0;
  r.reactions[0] = impulse_.x, r.reactions[1] = impulse_.y, r.reactions[2] = impulse_.z;
  std::vector<double> freed;
  for (const std::uint32_t i : live_) {
    const double mass = walls_[islands_[i].wall].body_of(islands_[i].chunks).mass;
    r.freed_mass += mass;
    freed.push_back(mass);
    r.chunks_freed += islands_[i].chunks.size();
  }
  if (!freed.empty()) r.largest_freed_mass = std::ranges::max(freed);
  for (const double mass : freed) {
    std::size_t decade = 0;
    for (double at = r.largest_freed_mass / 10; mass < at && decade < 5; at /= 10) ++decade;
    ++r.freed_by_decade[decade];
  }
  r.hash = recorder_.hash();
  std::uint64_t chunks = 0;
  std::vector<RecordedWall> recorded;
  for (const WallState& wall : walls_) {
    recorded.push_back(wall.recorded([&](std::uint32_t chunk) {
      const Island& island = islands_[wall.chunks[chunk].island];
      return island.body == kNoBody ? kNoTrack : island.track;
    }));
    chunks += recorded.back().track.size();
    r.walls_untouched += !wall.touched;
    for (const ChunkState& chunk : wall.chunks)
      r.hulls_not_built += chunk.island != kNoIsland && !chunk.has_hull;
  }
  r.chunks = chunks;
  r.recording = recorder_.take();
  r.recording.walls = std::move(recorded);
  for (const Shot& shot : shots_) r.recording.projectiles.push_back({shot.projectile, shot.track});
  return std::move(r);
}

double ImpactRun::largest_energy_scale() const {
  const EnergyLedger& e = result_.energy;
  return std::max({1e-9, e.contact + e.friction, -e.potential});
}

ImpactResult simulate_impact(const ImpactScene& scene, const ImpactParams& params) {
  return ImpactRun(scene, params).run();
}

}  // namespace sunder
