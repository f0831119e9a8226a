// SPDX-License-Identifier: GPL-3.0-or-later
// Projectiles on their way: when they meet the ground or a wall's face, in closed form. A substep
// ends there, so that bounce and breaking happen at the place and speed of the contact, whatever
// the step; what touches edges, debris or rests is the contact solver's.
#include <algorithm>
#include <cmath>

#include "meshing/error.hpp"
#include "sim/wall_run.hpp"

namespace sunder {
namespace {

/// A body counts as fast when it covers more than this share of its own size in a substep, at a
/// max_error of 0.01.
constexpr double kStepShare = 0.5;
/// A substep ends this share of the radius before the contact, so that rounding does not let the
/// solver find it too.
constexpr double kRoom = 1e-6;

/// Time until s = u t + a t²/2, s >= 0; infinity if never.
double time_to(double s, double u, double a) {
  const double root = u * u + 2 * a * s;
  if (root < 0) return std::numeric_limits<double>::infinity();
  const double sum = u + std::sqrt(root);
  return sum > 0 ? 2 * s / sum : std::numeric_limits<double>::infinity();
}

}  // namespace

double distance_to_cell(const Pattern& pattern, std::uint32_t cell, Vec2 point) {
  double least = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (const LoopRange loop : loops_of(pattern, cell))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const Vec2 a = pattern.vertices[pattern.corners[k]];
      const Vec2 b = pattern.vertices[pattern.corners[loop.next(k)]];
      least = std::min(least, length(from_segment(point, a, b)));
      if ((a.y > point.y) != (b.y > point.y))
        inside ^= (cross(b - a, point - a) > 0) == (b.y > a.y);
    }
  return inside ? 0 : least;
}

void WallRun::launch(std::uint32_t index) {
  Shot& shot = shots_[index];
  const Projectile& p = shot.projectile;
  refuse_overlap(shot);
  const BodyParams body = body_of(p, index);
  shot.body = world_.add_sphere(body, p.radius);
  own(shot.body, {Owner::Kind::projectile, index, 0});
  shot.track = recorder_.add_track(kNoTrack);
  recorder_.add_pose(shot.track, body.pose);
  result_.energy_in += 0.5 * p.mass * dot(p.velocity, p.velocity);
  baseline_ += p.mass * scene_.simulation.gravity * p.position.y;
}

void WallRun::refuse_overlap(const Shot& shot) const {
  const Projectile& p = shot.projectile;
  const auto fail = [&](const std::string& where) {
    throw Error(ErrorCode::input, "projectile \"" + p.name + "\" starts " + where +
                                      "; move its position or change its radius");
  };
  const SimulationParams& simulation = scene_.simulation;
  if (simulation.ground && p.position.y - p.radius < simulation.ground_height)
    fail("below the ground (y = " + std::to_string(simulation.ground_height) + " m)");
  for (std::uint32_t i = 0; i < islands_.size(); ++i) {
    // Debris of an earlier hit may lie anywhere: contacts push out of it.
    if (i >= walls_.size() && now_ > 0) break;
    const WallState& wall = walls_[islands_[i].wall];
    if (i < walls_.size() && wall.is_waiting) continue;
    const Vec3 local = inverse(pose_of(islands_[i])) * p.position;
    const double beyond = std::max(std::abs(local.z) - wall.half_thickness, 0.0);
    if (beyond >= p.radius) continue;
    const double reach = std::sqrt(p.radius * p.radius - beyond * beyond);
    const Vec2 at{local.x, local.y}, half{reach, reach};
    for (const std::uint32_t cell : wall.bins.cells_in(at - half, at + half))
      if (wall.chunks[wall.chunk_of_cell[cell]].island == i &&
          distance_to_cell(wall.asset.pattern, cell, at) < reach)
        fail("inside wall \"" + wall.asset.wall.name + "\"");
  }
}

namespace {

double gap_between(const RigidWorld::Bounds& a, Vec3 low, Vec3 high) {
  return length(Vec3{std::max({low.x - a.high.x, a.low.x - high.x, 0.0}),
                     std::max({low.y - a.high.y, a.low.y - high.y, 0.0}),
                     std::max({low.z - a.high.z, a.low.z - high.z, 0.0})});
}

}  // namespace

/// Whether any chunk of a wall stands.
bool WallRun::stands(std::uint32_t wall) const {
  const Island& island = islands_[wall];
  return island.body == kNoBody && !island.chunks.empty() &&
         (!island.graph || island.graph->present_count() > 0);
}

WallRun::NearWall WallRun::nearest_wall(const RigidWorld::Bounds& bounds) const {
  NearWall nearest;
  for (const StandingWall& wall : standing_)
    if (const double gap = gap_between(bounds, wall.low, wall.high); gap < nearest.gap)
      nearest = {gap, wall.thickness};
  return nearest;
}

void WallRun::list_standing() {
  standing_.clear();
  for (std::uint32_t w = 0; w < walls_.size(); ++w)
    if (stands(w))
      standing_.push_back({walls_[w].low, walls_[w].high, 2 * walls_[w].half_thickness, w});
}

double WallRun::nearest_gap(const Shot& shot) const {
  const RigidWorld::Bounds bounds = world_.bounds(shot.body);
  double nearest = nearest_wall(bounds).gap;
  const auto consider = [&](BodyId other) {
    const RigidWorld::Bounds b = world_.bounds(other);
    nearest = std::min(nearest, gap_between(bounds, b.low, b.high));
  };
  for (const std::uint32_t i : live_) consider(islands_[i].body);
  for (const Shot& other : shots_)
    if (&other != &shot && other.body != kNoBody) consider(other.body);
  return nearest;
}

// The longest substep in which nothing could pass through something else: a projectile near
// anything covers a share of its radius at most, debris near a wall of its own size: the solver
// looks along its path. The ground has no other side.
double WallRun::distance_limit(double dt) const {
  const double share =
      kStepShare * std::clamp(std::sqrt(scene_.simulation.max_error / 0.01), 0.1, 1.0);
  double limit = dt;
  for (const std::uint32_t i : live_) {
    if (!world_.is_awake(islands_[i].body)) continue;
    const double speed = length(world_.velocity(islands_[i].body));
    if (speed * limit <= share * least_thickness_) continue;
    const RigidWorld::Bounds bounds = world_.bounds(islands_[i].body);
    const NearWall near = nearest_wall(bounds);
    const double size = std::max(near.thickness, length(bounds.high - bounds.low));
    limit = std::min(limit, std::max(share * size, 0.5 * near.gap) / speed);
  }
  for (const Shot& shot : shots_) {
    if (shot.body == kNoBody || !world_.is_awake(shot.body)) continue;
    const double speed = length(world_.velocity(shot.body));
    if (speed * limit <= share * shot.projectile.radius) continue;
    limit =
        std::min(limit, std::max(share * shot.projectile.radius, 0.5 * nearest_gap(shot)) / speed);
  }
  return limit;
}

void WallRun::raise_colliders(double dt) {
  const auto near = [&](BodyId body) {
    if (!world_.is_awake(body)) return;
    const RigidWorld::Bounds b = world_.bounds(body);
    const double speed = length(world_.velocity(body));
    // What a contact may add to its speed in this substep stays below this.
    const double turn = std::min(length(world_.angular_velocity(body)) * dt, 2.0);
    const double margin =
        0.05 + (speed + scene_.simulation.gravity * dt) * dt + turn * length(b.high - b.low);
    const Vec3 m{margin, margin, margin};
    const Vec3 low = b.low - m, high = b.high + m;
    for (const StandingWall& wall : standing_) {
      if (low.x > wall.high.x || low.y > wall.high.y || low.z > wall.high.z ||
          high.x < wall.low.x || high.y < wall.low.y || high.z < wall.low.z)
        continue;
      raise_colliders_near(wall.wall, low, high);
    }
  };
  if (!params_.skip) return;
  for (const Shot& shot : shots_)
    if (shot.body != kNoBody) near(shot.body);
  for (const std::uint32_t i : live_) near(islands_[i].body);
  if (!host_.foreign || standing_.empty()) return;
  for (const BodyId body : world_.awake())
    if (owner(body).kind == Owner::Kind::foreign) near(body);
}

void WallRun::raise_colliders_around(BodyId body) {
  constexpr double kMargin = 0.05;  // m
  const RigidWorld::Bounds b = world_.bounds(body);
  const Vec3 m{kMargin, kMargin, kMargin}, low = b.low - m, high = b.high + m;
  for (std::uint32_t w = 0; w < walls_.size(); ++w)
    if (stands(w) && gap_between({low, high}, walls_[w].low, walls_[w].high) <= 0)
      raise_colliders_near(w, low, high);
}

// Colliders of standing chunks in a world box; of all when nothing is to be skipped.
void WallRun::raise_colliders_near(std::uint32_t w, Vec3 low, Vec3 high) {
  if (!stands(w)) return;
  const WallState& wall = walls_[w];
  if (!params_.skip) {
    for (const std::uint32_t chunk : std::vector(islands_[w].chunks)) raise_collider(w, chunk);
    return;
  }
  const auto [from, to] = bounds_of(inverse(wall.standing), low, high);
  if (from.z > wall.half_thickness || to.z < -wall.half_thickness) return;
  for (const std::uint32_t cell : wall.bins.cells_in({from.x, from.y}, {to.x, to.y}))
    raise_collider(w, wall.chunk_of_cell[cell]);
}

void WallRun::raise_collider(std::uint32_t w, std::uint32_t chunk) {
  ChunkState& state = walls_[w].chunks[chunk];
  if (state.collider != kNoBody || state.island != w) return;
  const std::uint64_t order = kStandingOrder + host_.order + (std::uint64_t{w} << 32) + chunk;
  state.collider =
      world_.add_static(walls_[w].standing, walls_[w].prisms(chunk), walls_[w].surface(), order);
  own(state.collider, {Owner::Kind::collider, w, chunk});
  state.has_hull = true;
  if (host_.on_collider) host_.on_collider(w, state.collider);
}

std::optional<WallRun::Arrival> WallRun::next_arrival(double dt) const {
  std::optional<Arrival> first;
  const auto consider = [&](std::optional<Arrival> arrival) {
    if (arrival && (!first || arrival->time < first->time)) first = arrival;
  };
  for (std::uint32_t s = 0; s < shots_.size(); ++s) {
    if (shots_[s].body == kNoBody || !world_.is_awake(shots_[s].body)) continue;
    consider(arrival_at_ground(s, dt));
    for (std::uint32_t w = 0; w < walls_.size(); ++w)
      if (!islands_[w].chunks.empty()) consider(arrival_at_wall(s, w, dt));
  }
  return first;
}

// Slower contacts are the solver's: it stops them, as resting things need it.
double WallRun::least_arrival_speed() const {
  return 0.05 + 2 * scene_.simulation.gravity * scene_.simulation.step;
}

std::optional<WallRun::Arrival> WallRun::arrival_at_ground(std::uint32_t s, double dt) const {
  const SimulationParams& simulation = scene_.simulation;
  if (!simulation.ground) return {};
  const Shot& shot = shots_[s];
  const Vec3 centre = world_.centre(shot.body);
  const double gap = centre.y - shot.projectile.radius - simulation.ground_height;
  const double speed = -world_.velocity(shot.body).y, g = simulation.gravity;
  // The solver takes the speed at a substep's end for the whole of it: leave it that much room.
  const double room = std::max(gap - 0.5 * g * dt * dt - kRoom * shot.projectile.radius, 0.0);
  const double time = time_to(room, speed, g);
  if (!(time <= dt) || !(speed + g * time > least_arrival_speed())) return {};
  const double height = simulation.ground_height;
  return Arrival{time, s, kNoIsland, {centre.x, height, centre.z}, {0, 1, 0}};
}

std::optional<WallRun::Arrival> WallRun::arrival_at_wall(std::uint32_t s, std::uint32_t w,
                                                         double dt) const {
  const Shot& shot = shots_[s];
  const WallState& wall = walls_[w];
  const Island& island = islands_[w];
  const Pose pose = pose_of(island);
  const Vec3 centre = world_.centre(shot.body);
  const Vec3 drift = island.body == kNoBody ? Vec3{} : world_.velocity_at(island.body, centre);
  const Quaternion back = conjugate(pose.rotation);
  const Vec3 p = inverse(pose) * centre;
  const Vec3 v = rotate(back, world_.velocity(shot.body) - drift);
  const Vec3 g = rotate(back, {0, -scene_.simulation.gravity, 0});
  const double side = p.z > 0 ? 1 : -1;
  const double gap = side * p.z - wall.half_thickness - shot.projectile.radius;
  const double speed = -side * v.z, gain = -side * g.z;
  if (gap < -0.5 * shot.projectile.radius) return {};  // in a hole
  const double room =
      std::max(gap - 0.5 * std::abs(gain) * dt * dt - kRoom * shot.projectile.radius, 0.0);
  const double time = time_to(room, speed, gain);
  if (!(time <= dt) || !(speed + gain * time > least_arrival_speed())) return {};
  const Vec2 at{p.x + v.x * time + 0.5 * g.x * time * time,
                p.y + v.y * time + 0.5 * g.y * time * time};
  const std::uint32_t cell = wall.bins.cell_at(wall.asset.pattern, at);
  if (cell == kNoCell || wall.chunks[wall.chunk_of_cell[cell]].island != w) return {};
  return Arrival{time, s, w, pose * Vec3{at.x, at.y, side * wall.half_thickness},
                 rotate(pose.rotation, {0, 0, side})};
}

bool WallRun::is_there(const Arrival& arrival) const {
  if (arrival.island == kNoIsland) return true;
  const WallState& wall = walls_[arrival.island];
  const Vec3 at = inverse(pose_of(islands_[arrival.island])) * arrival.point;
  const std::uint32_t cell = wall.bins.cell_at(wall.asset.pattern, {at.x, at.y});
  return cell != kNoCell && wall.chunks[wall.chunk_of_cell[cell]].island == arrival.island;
}

void WallRun::arrive(const Arrival& arrival) {
  const Shot& shot = shots_[arrival.shot];
  Vec3 relative = world_.velocity(shot.body);
  if (arrival.island != kNoIsland && islands_[arrival.island].body != kNoBody)
    relative = relative - world_.velocity_at(islands_[arrival.island].body, arrival.point);
  const double speed = -dot(relative, arrival.normal);
  // Something else stopped it on the way, or broke what it was going to meet.
  if (!(speed > 0) || !is_there(arrival)) return;
  if (arrival.island == kNoIsland) {
    bounce({shot.body, kNoIsland, arrival.point, arrival.normal, speed, false}, kNoBody,
           ground_surface());
    return;
  }
  strike({shot.body, arrival.island, arrival.point, arrival.normal, speed, false});
}

Surface WallRun::ground_surface() const {
  return WorldParams{}.ground;
}

// Closed form: normal impulse by restitution, tangential one by Coulomb until it no longer slides.
void WallRun::bounce(const Meeting& m, BodyId other, const Surface& surface, double spent) {
  const Owner who = owner(m.striker);
  const Projectile& p = shots_[who.index].projectile;
  const double mu = std::sqrt(p.friction * surface.friction);
  const auto relative = [&] {
    const Vec3 v = world_.velocity_at(m.striker, m.point);
    return other == kNoBody ? v : v - world_.velocity_at(other, m.point);
  };
  const auto inverse_mass = [&](Vec3 direction) {
    return world_.inverse_mass_at(m.striker, m.point, direction) +
           (other == kNoBody ? 0 : world_.inverse_mass_at(other, m.point, direction));
  };
  const auto push = [&](Vec3 impulse) {
    world_.apply_impulse(m.striker, impulse, m.point);
    if (other == kNoBody)
      impulse_ = impulse_ + impulse;
    else
      world_.apply_impulse(other, -1.0 * impulse, m.point);
  };
  // What cracks took does not come back: e² is the share of the energy that does.
  const double lost = 2 * spent * inverse_mass(m.normal) / (m.speed * m.speed);
  const double e = std::sqrt(std::clamp(1 - lost, 0.0, p.restitution * surface.restitution));
  const double before = world_.kinetic_energy();
  const double normal_impulse = (1 + e) * m.speed / inverse_mass(m.normal);
  push(normal_impulse * m.normal);
  const double between = world_.kinetic_energy();
  result_.energy.contact += before - between;
  const Vec3 v = relative();
  const Vec3 sliding = v - dot(v, m.normal) * m.normal;
  const double slip = length(sliding);
  if (slip < 1e-9) return;
  const Vec3 along = (1 / slip) * sliding;
  const double stops = slip / inverse_mass(along);
  push(-std::min(mu * normal_impulse, stops) * along);
  result_.energy.friction += between - world_.kinetic_energy();
}

}  // namespace sunder
