// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/wall_run.hpp"

#include <algorithm>
#include <numeric>

namespace sunder {
namespace {

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

}  // namespace

WallRun::WallRun(const ImpactScene& scene, const ImpactParams& impact, RigidWorld& world,
                 Recorder& recorder, ImpactResult& result, Params params)
    : scene_(scene),
      params_(impact),
      host_(std::move(params)),
      world_(world),
      recorder_(recorder),
      result_(result),
      least_thickness_(std::numeric_limits<double>::infinity()) {
  if (scene.simulation.ground) own(kGround, {Owner::Kind::ground, 0, 0});
  for (const ImpactWall& wall : scene.walls) walls_.emplace_back(wall);
  walls_.resize(walls_.size() + host_.waiting);
  islands_.resize(walls_.size());
  const auto given = static_cast<std::uint32_t>(scene.walls.size());
  std::vector<std::vector<std::vector<std::uint32_t>>> loose;
  for (std::uint32_t w = 0; w < given; ++w) {
    loose.push_back(add_wall(w, false));
    const std::vector<Bond>& bonds = islands_[w].bonds;
    if (std::ranges::none_of(bonds, [](const Bond& bond) { return bond.b == kWorld; }))
      move_main(w, {walls_[w].standing, {}, {}, {}}, kNoTrack);
  }
  for (std::uint32_t w = 0; w < given; ++w)
    move_loose(w, loose[w], {walls_[w].standing, {}, {}, {}}, kNoTrack);
  if (!params_.skip)
    for (std::uint32_t w = 0; w < given; ++w) raise_colliders_near(w, {}, {});
  for (const Projectile& projectile : scene.projectiles) {
    Shot shot;
    shot.projectile = projectile;
    shots_.push_back(shot);
    result_.projectiles.emplace_back();
    result_.projectiles.back().name = projectile.name;
    result_.projectiles.back().ballistic_speed = std::numeric_limits<double>::infinity();
  }
}

void WallRun::own(BodyId body, Owner owner) {
  if (owners_.size() <= body) owners_.resize(body + 1);
  owners_[body] = owner;
}

// What hangs on no anchor is a body from the start; of a wall without anchors, or a free one, the
// component with most chunks is island w. Returns the others.
std::vector<std::vector<std::uint32_t>> WallRun::add_wall(std::uint32_t w, bool is_free) {
  const auto count = static_cast<std::uint32_t>(walls_[w].chunks.size());
  std::vector<Bond>& bonds = walls_[w].asset.bonds;
  if (is_free) {
    std::erase_if(bonds, [](const Bond& bond) { return bond.b == kWorld; });
    walls_[w].asset.wall.anchors.clear();  // nor do cells that a web adds have any
  }
  least_thickness_ = std::min(least_thickness_, 2 * walls_[w].half_thickness);
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
  islands_[w] = main.size() == count ? make_island(walls_[w], w, std::move(main), bonds)
                                     : make_island(walls_[w], w, main, bonds_among(main, bonds));
  for (const std::uint32_t c : islands_[w].chunks) walls_[w].chunks[c].island = w;
  return loose;
}

/// Bodies of what does not stand; `track` is what they moved along before.
void WallRun::move_loose(std::uint32_t w, const std::vector<std::vector<std::uint32_t>>& loose,
                         const Motion& motion, std::uint32_t track) {
  for (const std::vector<std::uint32_t>& members : loose) {
    const std::vector<Bond> bonds = bonds_among(members, walls_[w].asset.bonds);
    const std::uint32_t island = free_island(w, members, bonds);
    islands_[island].track = recorder_.add_track(track);
    add_body_of(island, motion);
  }
}

void WallRun::move_main(std::uint32_t w, const Motion& motion, std::uint32_t track) {
  islands_[w].track = recorder_.add_track(track);
  add_body_of(w, motion);
}

void WallRun::stand(std::uint32_t w, const ImpactWall& what) {
  walls_[w] = WallState(what);
  move_loose(w, add_wall(w, false), {walls_[w].standing, {}, {}, {}}, kNoTrack);
  if (!params_.skip) raise_colliders_near(w, {}, {});
}

void WallRun::set_free(std::uint32_t w, const ImpactWall& what, const Motion& motion,
                       std::uint32_t track) {
  walls_[w] = WallState(what);
  const std::vector<std::vector<std::uint32_t>> loose = add_wall(w, true);
  move_main(w, motion, track);
  move_loose(w, loose, motion, track);
}

void WallRun::let_go(std::uint32_t w, const Motion& motion, std::uint32_t track) {
  const Island island = std::move(islands_[w]);
  islands_[w] = {};
  islands_[w].wall = w;
  std::vector<std::uint32_t> locals;
  for (std::uint32_t local = 0; local < island.chunks.size(); ++local)
    if (!island.graph || island.graph->is_present(local)) locals.push_back(local);
  std::vector<std::uint32_t> members;
  for (const std::uint32_t local : locals) {
    members.push_back(island.chunks[local]);
    lower_collider(w, members.back());
  }
  if (members.empty()) return;
  std::vector<Bond> bonds = intact_bonds(island, locals);
  const Components parts = components_of(static_cast<std::uint32_t>(members.size()), bonds);
  std::vector<std::vector<std::uint32_t>> groups(members.size());
  for (std::uint32_t i = 0; i < members.size(); ++i) groups[parts.root[i]].push_back(i);
  for (const std::vector<std::uint32_t>& group : groups) {
    if (group.empty()) continue;
    std::vector<std::uint32_t> chunks;
    for (const std::uint32_t i : group) chunks.push_back(members[i]);
    const std::uint32_t moved = free_island(w, std::move(chunks), bonds_among(group, bonds));
    islands_[moved].track = recorder_.add_track(track);
    add_body_of(moved, motion);
  }
}

void WallRun::break_standing(std::uint32_t w, std::span<const std::uint32_t> bonds,
                             double utilisation) {
  std::vector<Crack> found;
  for (const std::uint32_t bond : bonds) found.push_back({bond, utilisation});
  const Freed freed = break_bonds(w, found, found.size());
  walls_[w].touched = true;
  result_.max_utilisation = std::max(result_.max_utilisation, utilisation);
  const Vec3 centre =
      walls_[w].standing * (0.5 * Vec3{walls_[w].size_low.x + walls_[w].size_high.x,
                                       walls_[w].size_low.y + walls_[w].size_high.y, 0});
  recorder_.add_event({now_, w, centre, 0, utilisation, freed.bonds, freed.chunks});
}

Pose WallRun::pose_of(const Island& island) const {
  return island.body == kNoBody ? walls_[island.wall].standing : world_.pose(island.body);
}

std::optional<WallRun::ChunkPlace> WallRun::standing_chunk(BodyId body) const {
  if (body >= owners_.size() || owners_[body].kind != Owner::Kind::collider) return {};
  const Owner& what = owners_[body];
  if (walls_[what.index].chunks[what.chunk].collider != body) return {};
  return ChunkPlace{what.index, what.chunk};
}

WallRun::Owner WallRun::owner(BodyId body) const {
  const Owner known = body < owners_.size() ? owners_[body] : Owner{};
  if (known.kind != Owner::Kind::none || !host_.foreign) return known;
  switch (host_.foreign(body)) {
    case Foreign::fixed: return {Owner::Kind::ground, 0, 0};
    case Foreign::moving: return {Owner::Kind::foreign, 0, 0};
    default: return {};
  }
}

void WallRun::launch_due(double until) {
  for (std::uint32_t s = 0; s < shots_.size(); ++s)
    if (shots_[s].body == kNoBody && shots_[s].projectile.time <= until) launch(s);
}

void WallRun::follow_shot(std::uint32_t shot, BodyId body, std::uint32_t track) {
  shots_[shot].body = body;
  shots_[shot].track = track;
  own(body, {Owner::Kind::projectile, shot, 0});
}

double WallRun::prepare(double dt) {
  list_standing();
  raise_colliders(dt);
  return distance_limit(dt);
}

void WallRun::after_step(double now) {
  now_ = now;
  const StepWork work = world_.work();
  unspent_ = std::max(work.contact + work.friction, 0.0);
  meet_contacts();
  renamed_.clear();
  watch_projectiles();
}

void WallRun::record_pose(BodyId body, std::uint32_t track, bool force) {
  if (world_.is_awake(body) || force) {
    recorder_.add_pose(track, world_.pose(body));
  } else {
    ++result_.body_steps_asleep;
    ++result_.poses_not_recorded;
  }
}

void WallRun::record_islands() {
  for (const std::uint32_t i : live_)
    record_pose(islands_[i].body, islands_[i].track, recorder_.is_empty(islands_[i].track));
}

void WallRun::record_shots() {
  for (const Shot& shot : shots_)
    if (shot.body != kNoBody) record_pose(shot.body, shot.track, false);
  for (std::uint32_t w = 0; w < walls_.size(); ++w)
    if (islands_[w].body == kNoBody && !walls_[w].is_waiting) {
      const std::uint64_t count = islands_[w].graph ? islands_[w].graph->present_count() : 1;
      result_.chunk_steps_not_simulated += count;
      result_.poses_not_recorded += count;
    }
}

// Through is through: behind the far face of what is left, seen from where it hit.
void WallRun::watch_projectiles() {
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

void WallRun::count_freed() {
  ImpactResult& r = result_;
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
}

std::vector<RecordedWall> WallRun::finish() {
  count_freed();
  ImpactResult& r = result_;
  std::vector<RecordedWall> recorded;
  for (const WallState& wall : walls_) {
    if (wall.is_waiting) {
      recorded.emplace_back();
      continue;
    }
    recorded.push_back(wall.recorded([&](std::uint32_t chunk) {
      const Island& island = islands_[wall.chunks[chunk].island];
      return island.body == kNoBody ? kNoTrack : island.track;
    }));
    r.chunks += recorded.back().track.size();
    r.walls_untouched += !wall.touched;
    for (const ChunkState& chunk : wall.chunks)
      r.hulls_not_built += chunk.island != kNoIsland && !chunk.has_hull;
  }
  return recorded;
}

}  // namespace sunder
