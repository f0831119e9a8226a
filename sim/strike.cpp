// SPDX-License-Identifier: GPL-3.0-or-later
// What breaks when two things meet. Demand and capacity of every bond follow from the blow
// (sim/blow.hpp); the speed behind a hole from Recht and Ipson; momentum is handed over exactly,
// and the energy of new cracks comes out of what the striker lost.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "fracture/local_web.hpp"
#include "meshing/elementary.hpp"
#include "meshing/random.hpp"
#include "sim/edge_blow.hpp"
#include "sim/wall_run.hpp"

namespace sunder {
namespace {

/// A contact's normal that leans more than this from the wall's is one in its plane.
constexpr double kFaceContact = 0.7;
/// Slower contacts are not looked at, m/s.
constexpr double kLeastSpeed = 0.5;
constexpr double kGroundModulus = 30e9;  // Pa, concrete
/// Bonds of islands up to this size are looked at one by one, of larger ones by place.
constexpr std::size_t kSmallIsland = 256;
constexpr std::uint32_t kMostRadial = 48;
/// What takes longer to leave its hole is held by its neighbours, s.
constexpr double kLongestExit = 0.15;

}  // namespace

Striker WallRun::striker_of(const Meeting& m) const {
  const Owner who = owner(m.striker);
  const Island& struck = islands_[m.island];
  const WallState& wall = walls_[struck.wall];
  const double yields =
      struck.body == kNoBody ? 0 : world_.inverse_mass_at(struck.body, m.point, m.normal);
  const bool fixed = who.kind == Owner::Kind::ground || who.kind == Owner::Kind::collider;
  const double moves = fixed ? 0 : world_.inverse_mass_at(m.striker, m.point, m.normal);
  Striker striker;
  // What counts in a collision is the reduced mass.
  striker.mass = 1 / (moves + yields);
  switch (who.kind) {
    case Owner::Kind::projectile: {
      const Projectile& p = shots_[who.index].projectile;
      striker.radius = p.radius;
      striker.youngs_modulus = p.youngs_modulus;
      striker.poisson_ratio = p.poisson_ratio;
      break;
    }
    case Owner::Kind::island: {
      const WallState& other = walls_[islands_[who.index].wall];
      striker.radius = other.half_thickness;
      striker.youngs_modulus = other.material.youngs_modulus;
      striker.poisson_ratio = other.material.poisson_ratio;
      break;
    }
    default:
      striker.radius = wall.half_thickness;
      striker.youngs_modulus = kGroundModulus;
      striker.poisson_ratio = 0.2;
  }
  if (!(striker.youngs_modulus > 0)) striker.youngs_modulus = kGroundModulus;
  return striker;
}

WallRun::Answer WallRun::answer_to(const Meeting& m) const {
  const Island& island = islands_[m.island];
  const WallState& wall = walls_[island.wall];
  const Pose back = inverse(pose_of(island));
  const Vec3 at = back * m.point, normal = rotate(back.rotation, m.normal);
  Answer answer;
  answer.centre = {at.x, at.y};
  answer.front = normal.z > 0 ? 1 : -1;
  answer.in_plane = std::abs(normal.z) < kFaceContact;
  answer.striker = striker_of(m);
  const double thickness = 2 * wall.half_thickness;
  answer.blow = answer.in_plane ? edge_blow_of(answer.striker, m.speed, thickness, wall.material)
                                : blow_of(answer.striker, m.speed, thickness, wall.material);
  return answer;
}

double WallRun::utilisation(const Answer& answer, double distance, const WallState& wall) const {
  const double thickness = 2 * wall.half_thickness;
  if (answer.in_plane) return edge_utilisation_at(answer.blow, distance, thickness, wall.material);
  if (answer.blow.is_global) return utilisation_at(answer.blow, distance, thickness, wall.material);
  return 0;
}

void WallRun::note_hit(const Meeting& m, const Answer& answer) {
  result_.max_utilisation = std::max(result_.max_utilisation, answer.blow.utilisation);
  const Owner who = owner(m.striker);
  if (who.kind != Owner::Kind::projectile || result_.projectiles[who.index].hit) return;
  ProjectileOutcome& outcome = result_.projectiles[who.index];
  outcome.hit = true;
  outcome.speed_before = m.solved ? m.speed : length(world_.velocity(m.striker));
  outcome.ballistic_speed = answer.blow.ballistic_speed;
  outcome.contact_force = answer.blow.force;
  shots_[who.index].wall = islands_[m.island].wall;
  shots_[who.index].side = answer.front;
}

void WallRun::strike(const Meeting& m) {
  const Answer answer = answer_to(m);
  const Island& island = islands_[m.island];
  walls_[island.wall].touched = true;
  note_hit(m, answer);
  if (m.speed > answer.blow.ballistic_speed && answer.blow.utilisation > 1) {
    go_through(m, answer);
  } else if (!m.solved) {
    bounce(m, island.body, walls_[island.wall].surface());
  }
}

// The island's chunks that the blow may concern: all of a small one, else those around the contact.
std::vector<std::uint32_t> WallRun::chunks_near(const Island& island, Vec2 centre,
                                                double reach) const {
  std::vector<std::uint32_t> locals;
  if (island.chunks.size() <= kSmallIsland) {
    locals.resize(island.chunks.size());
    std::iota(locals.begin(), locals.end(), 0u);
  } else {
    const WallState& wall = walls_[island.wall];
    const Vec2 half{reach, reach};
    for (const std::uint32_t cell : wall.bins.cells_in(centre - half, centre + half)) {
      const auto at = std::ranges::lower_bound(island.chunks, wall.chunk_of_cell[cell]);
      if (at != island.chunks.end() && *at == wall.chunk_of_cell[cell])
        locals.push_back(static_cast<std::uint32_t>(at - island.chunks.begin()));
    }
  }
  std::erase_if(locals, [&](std::uint32_t local) { return !island.graph->is_present(local); });
  return locals;
}

// What the striker touches is in its way. The plug of a light one is wider: chunks whose middle
// lies in it, so that its mass does not depend on their size.
bool WallRun::is_in_footprint(const WallState& wall, const ChunkState& chunk, const Answer& answer,
                              double footprint) const {
  if (chunk.cell == kNoCell || !(footprint > 0)) return false;
  const Vec2 middle{chunk.mass.centroid.x, chunk.mass.centroid.y};
  return length(middle - answer.centre) < footprint ||
         distance_to_cell(wall.asset.pattern, chunk.cell, answer.centre) <
             std::min(answer.striker.radius, footprint);
}

// Bonds that the blow over-stresses, most over-stressed first, as far as the energy lasts. What
// lies in the footprint is sheared out whatever its bonds' distance.
std::vector<WallRun::Crack> WallRun::cracks(const Island& island, const Answer& answer,
                                            double footprint, double budget) const {
  const WallState& wall = walls_[island.wall];
  const double reach = std::max(answer.blow.crack_radius, footprint);
  std::vector<Crack> found;
  for (const std::uint32_t local : chunks_near(island, answer.centre, reach)) {
    const ChunkState& chunk = wall.chunks[island.chunks[local]];
    const bool is_sheared = std::ranges::binary_search(woven_, island.chunks[local]) ||
                            is_in_footprint(wall, chunk, answer, footprint);
    for (const std::uint32_t bond : island.graph->bonds_of(local)) {
      if (!island.graph->is_intact(bond)) continue;
      const Vec3 c = island.bonds[bond].centroid;
      const double distance = length(Vec2{c.x, c.y} - answer.centre);
      const double own = distance < reach ? utilisation(answer, distance, wall) : 0;
      const double used = is_sheared ? std::max(own, answer.blow.utilisation) : own;
      if (used > 1) found.push_back({bond, used});
    }
  }
  return affordable(island, std::move(found), budget);
}

// The most used first, as far as the energy lasts; a bond found from both its chunks counts once,
// with the larger demand.
std::vector<WallRun::Crack> WallRun::affordable(const Island& island, std::vector<Crack> found,
                                                double budget) const {
  std::ranges::sort(found, [](const Crack& a, const Crack& b) {
    return a.bond != b.bond ? a.bond < b.bond : a.utilisation > b.utilisation;
  });
  found.erase(std::ranges::unique(found, {}, &Crack::bond).begin(), found.end());
  std::ranges::sort(found, [](const Crack& a, const Crack& b) {
    return a.utilisation != b.utilisation ? a.utilisation > b.utilisation : a.bond < b.bond;
  });
  const double energy = walls_[island.wall].material.fracture_energy;
  std::erase_if(found, [&](const Crack& crack) {
    const double cost = energy * island.bonds[crack.bond].area;
    if (cost > budget) return true;
    budget -= cost;
    return false;
  });
  return found;
}

// A glass-like wall gets its damage where it was hit: corners by the square root of the speed, size
// by the reach of the bending stress, radial cracks no longer than the energy lasts.
SpiderwebParams WallRun::web_of(const WallState& wall, const Answer& answer, double footprint,
                                double speed, double budget, std::uint64_t seed) const {
  SpiderwebParams params = *wall.web();
  const double thickness = 2 * wall.half_thickness;
  // Rounded up or down by chance, so that the mean over many hits is the law's.
  const double expected = radial_crack_count(speed, thickness, wall.material);
  const auto corners = static_cast<std::int64_t>(
      std::clamp(std::floor(expected + random_unit(seed, 1)), 3.0, double{kMostRadial}));
  params.min_points = params.max_points = corners;
  // Spokes, the polygon around them and the rings: no larger than the energy pays for.
  const double length_per_radius =
      static_cast<double>(corners) + 6.3 * (1 + 0.5 * static_cast<double>(params.rings));
  const double energy_per_radius = length_per_radius * thickness * wall.material.fracture_energy;
  params.max_radius = std::max(answer.blow.crack_radius, 1.25 * footprint);
  if (energy_per_radius > 0)
    params.max_radius = std::clamp(budget / energy_per_radius, 0.5 * footprint, params.max_radius);
  params.min_radius = 0.7 * params.max_radius;
  if (params.radial > 0) {
    params.radial = corners;
    const double energy_per_length =
        static_cast<double>(corners) * thickness * wall.material.fracture_energy;
    if (energy_per_length > 0)
      params.reach = std::min(params.reach, 0.5 * budget / energy_per_length);
    if (params.reach < 1.2 * params.max_radius) params.radial = 0;
  }
  return params;
}

void WallRun::weave_web(std::uint32_t index, const Answer& answer, double footprint, double speed,
                        double budget) {
  const std::uint32_t wall_index = islands_[index].wall;
  WallState& wall = walls_[wall_index];
  const std::uint64_t seed = random_bits(scene_.seed, wall_index, wall.hits);
  std::vector<std::uint8_t> intact(wall.asset.pattern.cell_count());
  for (std::uint32_t cell = 0; cell < intact.size(); ++cell)
    intact[cell] = wall.chunks[wall.chunk_of_cell[cell]].island == index;
  const LocalWeb web = local_web(wall.asset, intact, answer.centre,
                                 web_of(wall, answer, footprint, speed, budget, seed), seed,
                                 wall.bins.cell_at(wall.asset.pattern, answer.centre));
  if (web.added.empty()) return;
  for (const std::uint32_t cell : web.removed) lower_collider(wall_index, wall.chunk_of_cell[cell]);
  const std::vector<std::uint32_t> fresh = wall.replace(web.removed, web.new_vertices, web.added);
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    wall.chunks[fresh[i]].island = index;
    if (web.is_damaged[i]) woven_.push_back(fresh[i]);
  }
  std::ranges::sort(woven_);
  join_again(index);
  if (!params_.skip && islands_[index].body == kNoBody)
    for (const std::uint32_t chunk : fresh) raise_collider(wall_index, chunk);
}

// Share of the speed behind the hole that a chunk gets: all of it in the footprint, less in the
// cone of 45° through which the wall's thickness spreads the load, none beyond: a cracked wall
// passes no bending on.
struct SpeedProfile {
  Vec2 centre;
  double footprint, spread;
  double at(double distance) const {
    return std::clamp(1 - (distance - footprint) / spread, 0.0, 1.0);
  }
  double of(const WallState& wall, std::uint32_t chunk) const {
    const ChunkState& state = wall.chunks[chunk];
    const double middle = at(length(Vec2{state.mass.centroid.x, state.mass.centroid.y} - centre));
    if (state.cell == kNoCell) return middle;
    return (middle + at(distance_to_cell(wall.asset.pattern, state.cell, centre))) / 2;
  }
};

// Speed of approach that breaking may use: of a contact that the solver has answered, what is left
// and what the contact took, as far as that energy was lost and not passed on to something else.
double WallRun::usable_speed(const Meeting& m) const {
  if (!m.solved) return m.speed;
  const double left = -dot(world_.velocity_at(m.striker, m.point), m.normal);
  const double inverse_mass = world_.inverse_mass_at(m.striker, m.point, m.normal);
  const double taken = left + m.impulse * inverse_mass;
  const double lost = std::sqrt(left * left + 2 * unspent_ * inverse_mass);
  return std::clamp(std::min(taken, lost), 0.0, m.speed);
}

// Energy of cracks that the solver had left to a striker it threw back.
void WallRun::take_from_rebound(const Meeting& m, double energy) {
  const double left = -dot(world_.velocity_at(m.striker, m.point), m.normal);
  if (!(energy > 0) || left >= 0) return;
  const double mass = 1 / world_.inverse_mass_at(m.striker, m.point, m.normal);
  const double then = -std::sqrt(std::max(left * left - 2 * energy / mass, 0.0));
  const Vec3 impulse = mass * (left - then) * m.normal;
  world_.apply_impulse(m.striker, impulse, m.point);
  impulse_ = impulse_ + impulse;
}

void WallRun::go_through(Meeting m, const Answer& answer) {
  m.speed = usable_speed(m);
  const std::uint32_t wall_index = islands_[m.island].wall;
  const double mass = 1 / world_.inverse_mass_at(m.striker, m.point, m.normal);
  const Material material = walls_[wall_index].material;
  // A free wall moves off with a part of the energy: the reduced mass counts.
  const double budget = 0.5 * std::min(mass, answer.striker.mass) * m.speed * m.speed;
  const bool local = !answer.blow.is_global;
  const double footprint = local ? answer.blow.crack_radius : answer.striker.radius;
  const double energy_before = world_.kinetic_energy();
  if (walls_[wall_index].web() && m.island < walls_.size() && !answer.in_plane)
    weave_web(m.island, answer, footprint, m.speed, budget);
  if (!islands_[m.island].graph) {
    if (!m.solved) bounce(m, islands_[m.island].body, walls_[wall_index].surface());
    return;
  }
  std::vector<Crack> broken = cracks(islands_[m.island], answer, footprint, budget);
  const std::size_t driven = broken.size();
  if (material.stored_energy > 0 && !broken.empty()) add_all_bonds(m.island, broken);
  const Freed freed = break_bonds(m.island, broken, driven);
  woven_.clear();
  walls_[wall_index].hits += !broken.empty();
  const double crack_energy = material.fracture_energy * freed.driven_area;
  result_.energy.fracture += crack_energy;
  if (freed.bonds > 0)
    recorder_.add_event(
        {now_, wall_index, m.point, m.speed, answer.blow.utilisation, freed.bonds, freed.chunks});
  const bool passed = hand_over(m, answer, freed, mass, footprint);
  if (!passed && m.solved) take_from_rebound(m, crack_energy - unspent_);
  const double spent = world_.kinetic_energy() - energy_before + crack_energy;
  result_.energy.contact -= spent;
  const double from_solver = m.solved ? std::clamp(spent, 0.0, unspent_) : 0;
  if (m.solved) {
    unspent_ = std::max(unspent_ - spent, 0.0);
    world_.spend(m.striker, spent);
  }
  const double energy_between = world_.kinetic_energy();
  if (!passed && !m.solved)
    bounce(m, islands_[m.island].body, walls_[wall_index].surface(), crack_energy);
  const double lost = energy_between - world_.kinetic_energy();
  result_.energy.contact += stick_together(m, freed, spent - from_solver - lost);
}

// What a free wall lost to a blow depends on all of its mass; where cracks took more than what is
// left of it and what broke off, they moved with it for a moment before they did.
double WallRun::stick_together(const Meeting& m, const Freed& freed, double energy) {
  if (!(energy > 0)) return 0;
  std::vector<BodyId> bodies{m.striker};
  if (islands_[m.island].body != kNoBody) bodies.push_back(islands_[m.island].body);
  for (const std::uint32_t i : freed.islands) bodies.push_back(islands_[i].body);
  std::ranges::sort(bodies);
  bodies.erase(std::ranges::unique(bodies).begin(), bodies.end());
  return world_.slow_together(bodies, energy);
}

// Momentum from the striker to what came loose: everything in its way moves on with it. False when
// nothing in its way came loose.
bool WallRun::hand_over(const Meeting& m, const Answer& answer, const Freed& freed, double mass,
                        double footprint) {
  const WallState& wall = walls_[islands_[m.island].wall];
  const double density = wall.material.density;
  // What a light striker punches out moves as one plug.
  const double spread =
      answer.blow.is_global ? 2 * wall.half_thickness : std::numeric_limits<double>::infinity();
  const SpeedProfile profile{answer.centre, footprint, spread};
  double plug = 0, plug_energy = 0;  // Σ m φ, Σ m φ²
  bool way_is_free = false;
  for (const std::uint32_t i : freed.islands)
    for (const std::uint32_t chunk : islands_[i].chunks) {
      const double share = profile.of(wall, chunk);
      const double chunk_mass = density * wall.chunks[chunk].mass.volume;
      plug += chunk_mass * share;
      plug_energy += chunk_mass * share * share;
      way_is_free |= share > 0.5;
    }
  if (!way_is_free) return false;
  double speed = residual_speed(mass, plug, m.speed, answer.blow.ballistic_speed);
  // What is left after the cracks bounds the speed; the anchors only take momentum away.
  const double crack_energy = wall.material.fracture_energy * freed.driven_area;
  const double left = std::max(0.5 * mass * m.speed * m.speed - crack_energy, 0.0);
  speed = std::min(speed, std::sqrt(2 * left / (mass + plug_energy)));
  const double now = m.solved ? -dot(world_.velocity_at(m.striker, m.point), m.normal) : m.speed;
  const Vec3 along = -1.0 * m.normal;
  const Island& rest = islands_[m.island];
  if (rest.body != kNoBody) {
    // A free-standing wall takes at most what makes it as fast as the hole's edge.
    const double rest_mass = 1 / world_.inverse_mass_at(rest.body, m.point, m.normal);
    speed = std::max(speed, mass * m.speed / (mass + plug + rest_mass));
    const double passed = std::max(mass * (m.speed - speed) - plug * speed, 0.0);
    world_.apply_impulse(rest.body, passed * along, m.point);
  } else {
    speed = std::min(speed, mass * m.speed / (mass + plug));
    impulse_ = impulse_ + (mass * (now - speed) - plug * speed) * m.normal;
  }
  world_.apply_impulse(m.striker, mass * (now - speed) * m.normal, m.point);
  for (const std::uint32_t i : freed.islands) push_island(i, profile, speed, along);
  return true;
}

void WallRun::push_island(std::uint32_t index, const SpeedProfile& profile, double speed,
                          Vec3 along) {
  const Island& island = islands_[index];
  const WallState& wall = walls_[island.wall];
  const Pose pose = world_.pose(island.body);
  double fastest = 0;
  for (const std::uint32_t chunk : island.chunks) {
    const double share = profile.of(wall, chunk);
    if (share <= 0) continue;
    const MassProperties& mass = wall.chunks[chunk].mass;
    world_.apply_impulse(island.body, wall.material.density * mass.volume * share * speed * along,
                         pose * mass.centroid);
    fastest = std::max(fastest, share * speed);
  }
  const double leaves_in = 1.2 * 2 * wall.half_thickness / fastest;
  if (fastest > 0 && leaves_in < kLongestExit) world_.exempt(island.body, leaves_in);
}

// Toughened glass: once it cracks, what toughening stored breaks the rest.
void WallRun::add_all_bonds(std::uint32_t index, std::vector<Crack>& broken) const {
  const Island& island = islands_[index];
  std::vector<std::uint8_t> listed(island.bonds.size(), 0);
  for (const Crack& crack : broken) listed[crack.bond] = 1;
  for (std::uint32_t b = 0; b < island.bonds.size(); ++b)
    if (!listed[b] && island.graph->is_intact(b)) broken.push_back({b, 1});
}

// What the solver's contacts of the last step break: debris against walls, bodies against anything.
void WallRun::meet_contacts() {
  std::span<const Contact> contacts = world_.contacts();
  std::vector<Contact> renamed;
  if (!renamed_.empty()) renamed.assign(contacts.begin(), contacts.end()), contacts = renamed;
  for (Contact& contact : renamed)
    for (const Renamed& body : renamed_) {
      if (contact.a == body.old && contact.part_a == body.prism) contact.a = body.now;
      if (contact.b == body.old && contact.part_b == body.prism) contact.b = body.now;
    }
  for (std::size_t begin = 0, end = 0; begin < contacts.size(); begin = end) {
    Meeting m;
    double impulse = 0;
    Vec3 point;
    for (end = begin; end < contacts.size() && contacts[end].a == contacts[begin].a &&
                      contacts[end].b == contacts[begin].b;
         ++end) {
      const double weight = contacts[end].impulse;
      impulse += weight;
      point = point + weight * contacts[end].point;
      m.speed = std::max(m.speed, contacts[end].approach);
    }
    // A projectile's first hit is noted however slow it is.
    const bool is_shot = owner(contacts[begin].a).kind == Owner::Kind::projectile;
    if (m.speed < (is_shot ? 0 : kLeastSpeed) || !(impulse > 0)) continue;
    m.point = (1 / impulse) * point;
    m.solved = true;
    m.impulse = impulse;
    const Contact& first = contacts[begin];
    meet(first.a, first.b, -1.0 * first.normal, m);
    meet(first.b, first.a, first.normal, m);
  }
}

// Most contacts break nothing: a first look at what they ask of the chunks they touch.
bool WallRun::is_gentle(const Meeting& m) const {
  const Island& island = islands_[m.island];
  const WallState& wall = walls_[island.wall];
  const Striker striker = striker_of(m);
  const double thickness = 2 * wall.half_thickness;
  const Vec3 normal = rotate(conjugate(pose_of(island).rotation), m.normal);
  const Owner who = owner(m.striker);
  if (who.kind == Owner::Kind::projectile && !result_.projectiles[who.index].hit)
    return false;  // it is to be noted
  if (std::abs(normal.z) >= kFaceContact)
    return !(utilisation_of(striker, m.speed, thickness, wall.material) > 1);
  return !(edge_force_of(striker, m.speed, wall.material) >
           least_edge_force(striker, thickness, wall.material));
}

/// `struck` is what may break; the normal points from it to the other.
void WallRun::meet(BodyId struck, BodyId striker, Vec3 normal, Meeting m) {
  const Owner what = owner(struck);
  const Owner::Kind kind = owner(striker).kind;
  if (kind == Owner::Kind::none || kind == Owner::Kind::gone) return;  // broke a moment ago
  m.striker = striker;
  m.normal = normal;
  if (what.kind == Owner::Kind::collider) {
    m.island = what.index;
    if (!is_gentle(m)) strike(m);
  } else if (what.kind == Owner::Kind::island) {
    m.island = what.index;
    const double e =
        std::sqrt(walls_[islands_[m.island].wall].material.restitution * restitution_of(striker));
    const double loss = 0.5 * striker_of(m).mass * m.speed * m.speed * (1 - e * e);
    if (islands_[m.island].chunks.size() == 1)
      split_chunk(m, loss);
    else if (!is_gentle(m))
      break_in_contact(m, loss);
  }
}

double WallRun::restitution_of(BodyId body) const {
  const Owner who = owner(body);
  switch (who.kind) {
    case Owner::Kind::projectile: return shots_[who.index].projectile.restitution;
    case Owner::Kind::island: return walls_[islands_[who.index].wall].material.restitution;
    case Owner::Kind::collider: return walls_[who.index].material.restitution;
    default: return ground_surface().restitution;
  }
}

void WallRun::break_in_contact(const Meeting& m, double loss) {
  const Answer answer = answer_to(m);
  walls_[islands_[m.island].wall].touched = true;
  note_hit(m, answer);
  if (!(answer.blow.utilisation > 1) || !islands_[m.island].graph) return;
  const std::uint32_t wall = islands_[m.island].wall;
  std::vector<Crack> broken = cracks(islands_[m.island], answer, 0, std::min(loss, unspent_));
  if (broken.empty()) return;
  const std::size_t driven = broken.size();
  if (walls_[wall].material.stored_energy > 0) add_all_bonds(m.island, broken);
  const Freed freed = break_bonds(m.island, broken, driven);
  const double energy = walls_[wall].material.fracture_energy * freed.driven_area;
  result_.energy.fracture += energy;
  result_.energy.contact -= energy;  // the solver counted it there
  unspent_ -= energy;
  world_.spend(m.striker, energy);
  recorder_.add_event(
      {now_, wall, m.point, m.speed, answer.blow.utilisation, freed.bonds, freed.chunks});
}

void WallRun::split_chunk(const Meeting& m, double loss) {
  const std::uint32_t wall_index = islands_[m.island].wall;
  WallState& wall = walls_[wall_index];
  const std::uint32_t chunk = islands_[m.island].chunks.front();
  if (wall.chunks[chunk].depth >= scene_.simulation.break_depth) return;
  if (!(wall.material.tensile_strength > 0)) return;
  const double thickness = 2 * wall.half_thickness, size = std::sqrt(wall.area(chunk));
  const double used = edge_force_of(striker_of(m), m.speed, wall.material) /
                      splitting_force(size, thickness, wall.material);
  if (!(used > 1)) return;
  const auto count = static_cast<std::uint32_t>(std::clamp(2 + used, 3.0, 6.0));
  const double energy = wall.material.fracture_energy * 0.5 * count * size * thickness;
  if (energy > std::min(loss, unspent_)) return;
  const Vec3 c = wall.chunks[chunk].mass.centroid;
  const Vec3 at = inverse(pose_of(islands_[m.island])) * m.point;
  const Vec2 middle{0.5 * (c.x + at.x), 0.5 * (c.y + at.y)};
  const std::vector<std::uint32_t> parts = wall.split(chunk, middle, count);
  if (parts.empty()) return;
  const Motion motion = motion_of(islands_[m.island]);
  const std::uint32_t track = islands_[m.island].track;
  world_.remove(islands_[m.island].body);
  own(islands_[m.island].body, {Owner::Kind::gone, 0, 0});
  std::erase(live_, m.island);
  islands_[m.island].body = kNoBody;
  for (const std::uint32_t part : parts) {
    const std::uint32_t island = free_island(wall_index, {part}, {});
    islands_[island].track = recorder_.add_track(track);
    add_body_of(island, motion);
  }
  ++result_.chunks_split;
  result_.max_utilisation = std::max(result_.max_utilisation, used);
  result_.crack_area += 0.5 * count * size * thickness;
  result_.energy.fracture += energy;
  result_.energy.contact -= energy;
  unspent_ -= energy;
  world_.spend(m.striker, energy);
  recorder_.add_event(
      {now_, wall_index, m.point, m.speed, used, 0, static_cast<std::uint32_t>(parts.size())});
}

}  // namespace sunder
