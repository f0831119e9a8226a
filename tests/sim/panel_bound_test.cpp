// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/panels.hpp"

namespace sunder {
namespace {

PanelPlate plate_of(const PanelKind& kind) {
  PanelPlate plate{kind.size, kind.thickness, {}};
  const char* sides[] = {"bottom", "right", "top", "left"};
  for (std::size_t k = 0; k < 4; ++k)
    plate.held[k] = std::ranges::find(kind.anchors, sides[k]) != kind.anchors.end();
  return plate;
}

PanelKind random_kind(std::uint64_t seed) {
  const auto draw = [&](std::uint64_t k) { return random_unit(seed, k, 9); };
  PanelKind kind{.size = {2 + 6 * draw(1), 2 + 6 * draw(2)}, .thickness = 0.05 + 0.3 * draw(3)};
  kind.cell = std::min({kind.size.x, kind.size.y, 3.0}) / (3 + 5 * draw(4));
  if (seed % 2 == 0) {
    kind.anchors = {kAllSides[seed / 2 % 4]};
    for (std::uint64_t k = 0; k < 4; ++k)
      if (kAllSides[k] != kind.anchors[0] && draw(5 + k) < 0.6)
        kind.anchors.push_back(kAllSides[k]);
  }
  return kind;
}

TEST(PanelBound, NoNetworkIsUtilisedMoreOverRandomMotionsAndWeights) {
  std::vector<double> shares;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const PanelKind kind = random_kind(seed);
    const WallAsset asset = panel_asset(kind, seed);
    ChunkNetwork network(asset, panel_concrete(), panel_hold(kind.size));
    for (std::uint64_t k = 0; k < 4; ++k) {
      PanelFreedoms g{};
      if (k > 0) g = random_freedoms(10 * seed + k, 1e-4);
      if (k == 3) g[random_bits(seed, 1) % 24] = 1e-2;
      const auto draw = [&](std::uint64_t i) { return 2 * random_unit(seed, i, 20 + k) - 1; };
      const Vec3 gravity{10 * draw(1), 10 * draw(2), 10 * draw(3)};
      network.set_gravity(gravity);
      const double bound = panel_stress_bound(plate_of(kind), panel_concrete(), g, gravity);
      shares.push_back(highest(network.solve(g)) / bound);
      EXPECT_LT(shares.back(), 1) << "seed " << seed << " motion " << k;
    }
  }
  std::ranges::sort(shares);
  EXPECT_GT(shares[shares.size() / 2], 0.02);  // and it is of use
}

TEST(PanelBound, RigidMotionsStressNothing) {
  const PanelHold hold = panel_hold({4, 3});
  const PanelFreedoms g = rigid_freedoms(hold, {1, 2, 3}, {0.1, -0.2, 0.3});
  EXPECT_NEAR(panel_stress_bound({{4, 3}, 0.1}, panel_concrete(), g, {}), 0, 1e-9);
}

TEST(PanelBound, IsASeminorm) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const PanelPlate plate{{4, 3}, 0.1};
    const PanelFreedoms a = random_freedoms(seed, 1), b = random_freedoms(seed + 100, 1);
    PanelFreedoms sum{}, twice{};
    for (std::size_t i = 0; i < 24; ++i) {
      sum[i] = a[i] + b[i];
      twice[i] = -2 * a[i];
    }
    const auto bound = [&](const PanelFreedoms& g) {
      return panel_stress_bound(plate, panel_concrete(), g, {});
    };
    EXPECT_LE(bound(sum), (bound(a) + bound(b)) * (1 + 1e-12));
    EXPECT_NEAR(bound(twice), 2 * bound(a), 1e-9 * bound(a));
  }
}

}  // namespace
}  // namespace sunder
