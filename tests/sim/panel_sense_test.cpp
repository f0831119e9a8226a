// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_sense.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/panels.hpp"

namespace sunder {
namespace {

/// A rectangle, or as crooked as a bay may be.
PanelHold hold_of(Vec2 size, std::uint64_t seed) {
  PanelHold hold = straight_hold(size);
  if (seed % 2 == 0) return hold;
  for (std::size_t c = 0; c < 4; ++c)
    hold.corners[c] = hold.corners[c] +
                      0.4 * Vec3{random_unit(seed, 20 + c) - 0.5, random_unit(seed, 30 + c) - 0.5};
  return hold;
}

TEST(PanelSense, NoMotionAddsMoreThanItSaysWhateverElseLoadsThePanel) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const PanelKind kind{.size = {2 + 4 * random_unit(seed, 1), 3}, .cell = 0.7};
    const PanelHold hold = hold_of(kind.size, seed);
    ChunkNetwork network(panel_asset(kind, seed), panel_concrete(), hold);
    const PanelSense sense(network, hold.corners);
    network.set_gravity({0.3, -1, -9.81 * random_unit(seed, 2)});
    const PanelFreedoms before = random_freedoms(seed, 1e-3);
    const double used = network.highest(before);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const PanelFreedoms more = random_freedoms(100 * seed + i, 1e-3 * random_unit(seed, i));
      PanelFreedoms after = before;
      for (std::size_t k = 0; k < 24; ++k) after[k] += more[k];
      EXPECT_LE(network.highest(after), used + sense.added(more)) << "seed " << seed << ", " << i;
    }
  }
}

TEST(PanelSense, WhatOneMotionAsksIsSaidExactly) {
  const PanelKind kind{.size = {4, 3}};
  const PanelHold hold = straight_hold(kind.size);
  ChunkNetwork network(panel_asset(kind, 5), panel_concrete(), hold);
  const PanelSense sense(network, hold.corners);
  PanelFreedoms twisted{}, sheared{};
  for (std::size_t c = 0; c < 4; ++c) {
    twisted[6 * c + 2] = c % 2 == 0 ? 1e-3 : -1e-3;
    sheared[6 * c] = 1e-4 * hold.corners[c].y;
  }
  EXPECT_NEAR(sense.added(twisted) / network.highest(twisted), 1, 1e-3);
  EXPECT_NEAR(sense.added(sheared) / network.highest(sheared), 1, 1e-3);
}

TEST(PanelSense, MovingAsARigidBodyAsksForNothing) {
  const PanelKind kind{.size = {4, 3}};
  for (const std::uint64_t seed : {6, 7}) {
    const PanelHold hold = hold_of(kind.size, seed);
    ChunkNetwork network(panel_asset(kind, seed), panel_concrete(), hold);
    const PanelSense sense(network, hold.corners);
    const PanelFreedoms rigid = rigid_freedoms(hold, {0.02, -0.03, 0.01}, {0.002, -0.003, 0.004});
    PanelFreedoms strained{};
    strained[2] = 0.01;
    EXPECT_LT(sense.added(rigid), 1e-9 * sense.added(strained)) << seed;
  }
}

}  // namespace
}  // namespace sunder
