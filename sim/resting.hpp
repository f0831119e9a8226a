// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "sim/world_body.hpp"

// Internal to the rigid world: what lies still, on what, and how hard.
namespace sunder {

/// By a body's id; null: it was removed.
using FindBody = std::function<const Body*(BodyId)>;

/// A contact of a body that falls asleep, with something below it.
struct Bearing {
  Support support;  ///< share: not yet known
  Vec3 force;       ///< on what is below, N
  Vec3 normal;      ///< from what is below
};

/// What a body rests on, by the forces of its last step; where the solver let go of it in that very
/// step, alike on all that is below it.
std::vector<Support> supports_of(std::span<const Bearing> bearings);

/// Forces on colliders that never move, of all that sleeps; `sleepers` by rank. Each hands on its
/// own weight and what it was handed, from the top down; what rests on something awake is its.
std::vector<RestingLoad> resting_loads(std::span<Body* const> sleepers, double gravity,
                                       const FindBody& find);

/// Of those that sleep and lie on nothing but fixed and merged bodies, `count` are merged, those
/// that slept first before others. Returns how many there were.
std::size_t merge(std::span<Body* const> sleepers, std::size_t count, const FindBody& find);

}  // namespace sunder
