// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_sense.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/panels.hpp"

namespace sunder {
namespace {

PanelFreedoms out_of_plane(std::uint64_t seed, double size) {
  PanelFreedoms g = random_freedoms(seed, size);
  for (std::size_t c = 0; c < 4; ++c) g[6 * c] = g[6 * c + 1] = g[6 * c + 5] = 0;
  return g;
}

TEST(PanelSense, NoMotionAddsMoreThanItSaysWhateverElseLoadsThePanel) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const PanelKind kind{.size = {2 + 4 * random_unit(seed, 1), 3}, .cell = 0.7};
    const PanelHold hold = panel_hold(kind.size, true);
    ChunkNetwork network(panel_asset(kind, seed), panel_concrete(), hold);
    const PanelSense sense(network, hold.corners);
    network.set_gravity({0.3, -1, -9.81 * random_unit(seed, 2)});
    const PanelFreedoms before = out_of_plane(seed, 1e-3);
    const double used = network.highest(before);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const PanelFreedoms more = out_of_plane(100 * seed + i, 1e-3 * random_unit(seed, i));
      PanelFreedoms after = before;
      for (std::size_t k = 0; k < 24; ++k) after[k] += more[k];
      EXPECT_LE(network.highest(after), used + sense.added(more)) << "seed " << seed << ", " << i;
    }
  }
}

TEST(PanelSense, WhatOneMotionAsksIsSaidExactly) {
  const PanelKind kind{.size = {4, 3}};
  const PanelHold hold = panel_hold(kind.size, true);
  ChunkNetwork network(panel_asset(kind, 5), panel_concrete(), hold);
  const PanelSense sense(network, hold.corners);
  PanelFreedoms bent{};
  for (std::size_t c = 0; c < 4; ++c) bent[6 * c + 4] = hold.corners[c].x - 2;  // w = -(x - 2)²/2
  EXPECT_NEAR(sense.added(bent) / network.highest(bent), 1, 1e-3);
}

TEST(PanelSense, MovingAsAPlaneAsksForNothing) {
  const PanelKind kind{.size = {4, 3}};
  const PanelHold hold = panel_hold(kind.size, true);
  ChunkNetwork network(panel_asset(kind, 6), panel_concrete(), hold);
  const PanelSense sense(network, hold.corners);
  const PanelFreedoms plane = rigid_freedoms(hold, {0, 0, 0.01}, {0.002, -0.003, 0});
  PanelFreedoms bent{};
  bent[2] = 0.01;
  EXPECT_LT(sense.added(plane), 1e-6 * sense.added(bent));
  bent[0] = 1e-9;
  EXPECT_TRUE(std::isinf(sense.added(bent)));
}

}  // namespace
}  // namespace sunder
