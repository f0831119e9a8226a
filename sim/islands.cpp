// SPDX-License-Identifier: GPL-3.0-or-later
// Islands of a run: breaking bonds, and the bodies that what came loose moves as.
#include <algorithm>
#include <cassert>

#include "sim/wall_run.hpp"

namespace sunder {
// Breaks bonds of an island and makes bodies of what came loose; they go on as it moved.
WallRun::Freed WallRun::break_bonds(std::uint32_t index, std::span<const Crack> cracks,
                                    std::size_t driven) {
  Freed freed;
  std::vector<std::uint32_t> bonds;
  for (std::size_t i = 0; i < cracks.size(); ++i) {
    bonds.push_back(cracks[i].bond);
    const Bond& bond = islands_[index].bonds[cracks[i].bond];
    result_.crack_area += bond.area;
    if (i < driven) freed.driven_area += bond.area;
    if (index < walls_.size() && walls_[index].web()) note_broken(index, bond);
  }
  std::ranges::sort(bonds);
  const SupportGraph::Change change = islands_[index].graph->break_bonds(bonds, !params_.skip);
  freed.bonds = static_cast<std::uint32_t>(change.broken.size());
  result_.broken_bonds += change.broken.size();
  result_.cells_not_searched +=
      islands_[index].graph->present_count() -
      std::min<std::uint64_t>(change.chunks_searched, islands_[index].graph->present_count());
  if (change.islands.empty()) return freed;
  const Motion motion = motion_of(islands_[index]);
  for (const SupportGraph::Island& part : change.islands) {
    freed.islands.push_back(detach(index, part.chunks, motion));
    freed.chunks += static_cast<std::uint32_t>(part.chunks.size());
  }
  if (islands_[index].body != kNoBody) keep_rest(index, motion);
  return freed;
}

// A wall with a web may get new cells; they keep the cracks of the old ones.
void WallRun::note_broken(std::uint32_t index, Bond bond) {
  const Island& island = islands_[index];
  bond.a = island.chunks[bond.a];
  if (bond.b != kWorld) bond.b = island.chunks[bond.b];
  walls_[island.wall].crack(bond);
}

// An island whose cells were replaced: its chunks and the bonds among them that never broke.
void WallRun::join_again(std::uint32_t index) {
  const std::uint32_t wall_index = islands_[index].wall;
  const WallState& wall = walls_[wall_index];
  std::vector<std::uint32_t> members;
  for (std::uint32_t c = 0; c < wall.chunks.size(); ++c)
    if (wall.chunks[c].island == index) members.push_back(c);
  std::vector<Bond> bonds;
  for (Bond bond : wall.asset.bonds) {
    if (wall.is_cracked(bond)) continue;
    bond.a = wall.chunk_of_cell[bond.a];
    if (bond.b != kWorld) bond.b = wall.chunk_of_cell[bond.b];
    bonds.push_back(bond);
  }
  Island island = make_island(wall, wall_index, members, bonds_among(members, bonds));
  island.body = islands_[index].body;
  island.track = islands_[index].track;
  islands_[index] = std::move(island);
}

WallRun::Motion WallRun::motion_of(const Island& island) const {
  Motion motion{walls_[island.wall].standing, {}, {}, {}};
  if (island.body == kNoBody) return motion;
  return {world_.pose(island.body), world_.centre(island.body), world_.velocity(island.body),
          world_.angular_velocity(island.body)};
}

// `locals` count in the island's chunks.
std::uint32_t WallRun::detach(std::uint32_t from, std::span<const std::uint32_t> locals,
                              const Motion& motion) {
  const std::uint32_t wall = islands_[from].wall;
  std::vector<std::uint32_t> members;
  for (const std::uint32_t local : locals) members.push_back(islands_[from].chunks[local]);
  std::vector<Bond> bonds = intact_bonds(islands_[from], locals);
  for (const std::uint32_t chunk : members) lower_collider(wall, chunk);
  const std::uint32_t island = free_island(wall, std::move(members), bonds);
  islands_[island].track = recorder_.add_track(islands_[from].track);
  add_body_of(island, motion);
  return island;
}

std::vector<Bond> WallRun::intact_bonds(const Island& island,
                                        std::span<const std::uint32_t> locals) const {
  std::vector<Bond> bonds;
  if (locals.size() < 2) return bonds;
  const auto place = [&](std::uint32_t local) {
    const auto at = std::ranges::lower_bound(locals, local);
    return at != locals.end() && *at == local ? static_cast<std::uint32_t>(at - locals.begin())
                                              : kNoCell;
  };
  for (std::uint32_t i = 0; i < locals.size(); ++i)
    for (const std::uint32_t b : island.graph->bonds_of(locals[i])) {
      Bond bond = island.bonds[b];
      if (!island.graph->is_intact(b) || bond.b == kWorld || bond.a != locals[i]) continue;
      bond.a = i;
      bond.b = place(bond.b);
      if (bond.b != kNoCell) bonds.push_back(bond);
    }
  return bonds;
}

// The part of a moving island that the others left: its largest, so there is one.
void WallRun::keep_rest(std::uint32_t index, const Motion& motion) {
  std::vector<std::uint32_t> locals, members;
  for (std::uint32_t local = 0; local < islands_[index].chunks.size(); ++local)
    if (islands_[index].graph->is_present(local)) locals.push_back(local);
  assert(!locals.empty());
  world_.remove(islands_[index].body);
  own(islands_[index].body, {Owner::Kind::gone, 0, 0});
  for (const std::uint32_t local : locals) members.push_back(islands_[index].chunks[local]);
  const std::vector<Bond> bonds = intact_bonds(islands_[index], locals);
  const std::uint32_t wall = islands_[index].wall, track = islands_[index].track;
  islands_[index] = make_island(walls_[wall], wall, members, bonds);
  islands_[index].track = recorder_.add_track(track);
  std::erase(live_, index);
  add_body_of(index, motion);
}

std::uint32_t WallRun::free_island(std::uint32_t wall, std::vector<std::uint32_t> members,
                                   std::span<const Bond> bonds) {
  const auto index = static_cast<std::uint32_t>(islands_.size());
  for (const std::uint32_t chunk : members) walls_[wall].chunks[chunk].island = index;
  islands_.push_back(make_island(walls_[wall], wall, std::move(members), bonds));
  return index;
}

void WallRun::lower_collider(std::uint32_t wall, std::uint32_t chunk) {
  ChunkState& state = walls_[wall].chunks[chunk];
  if (state.collider == kNoBody) return;
  world_.remove(state.collider);
  own(state.collider, {Owner::Kind::gone, 0, 0});
  state.collider = kNoBody;
}

void WallRun::add_body_of(std::uint32_t index, const Motion& motion) {
  Island& island = islands_[index];
  WallState& wall = walls_[island.wall];
  BodyParams body = wall.body_of(island.chunks);
  body.pose = motion.pose;
  const Vec3 centre = motion.pose * body.centroid;
  body.velocity = motion.velocity + cross(motion.angular_velocity, centre - motion.centre);
  body.angular_velocity = motion.angular_velocity;
  body.order = kMovingOrder + host_.order + serial_++;
  std::vector<Prism> prisms;
  for (const std::uint32_t chunk : island.chunks) {
    for (Prism& prism : wall.prisms(chunk)) prisms.push_back(std::move(prism));
    wall.chunks[chunk].has_hull = true;
  }
  island.body = world_.add_body(body, prisms);
  own(island.body, {Owner::Kind::island, index, 0});
  if (recorder_.parent(island.track) == kNoTrack)
    baseline_ += body.mass * scene_.simulation.gravity * centre.y;
  live_.push_back(index);
}

}  // namespace sunder
