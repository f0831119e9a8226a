// SPDX-License-Identifier: GPL-3.0-or-later
// The grid of what may be asked for: nothing explodes, sinks, is lost or is no number.
#include <gtest/gtest.h>

#include "tests/sim/stability_sweep.hpp"

namespace sunder {
namespace {

void expect_calm(const std::vector<StabilityCell>& cells) {
  std::size_t failures = 0;
  for (const StabilityCell& cell : cells) {
    const std::string fault = fault_of(cell);
    EXPECT_EQ(fault, "") << name_of(cell);
    failures += fault.empty() ? 0 : 1;
  }
  EXPECT_EQ(failures, 0u) << "of " << cells.size();
}

TEST(Stability, AnyRatioOfMassesIsCalm) {
  expect_calm(mass_ratio_cells());
}

TEST(Stability, AnyStepAndAnyIterationsAreCalm) {
  expect_calm(step_cells());
}

TEST(Stability, AnyThicknessIsCalmHereAndTenKilometresAway) {
  expect_calm(thickness_cells());
}

TEST(Stability, AnyJitterIsCalmHereAndTenKilometresAway) {
  expect_calm(jitter_cells());
}

TEST(Stability, ConcreteIsCalm) {
  expect_calm(material_cells("concrete-c30"));
}

TEST(Stability, BrickIsCalm) {
  expect_calm(material_cells("brick"));
}

TEST(Stability, GlassIsCalm) {
  expect_calm(material_cells("float-glass"));
}

TEST(Stability, WhatFliesAThousandThicknessesInAStepHits) {
  expect_calm(tunnelling_cells());
}

TEST(Stability, TenThousandChunksComeLooseAtOnce) {
  ImpactResult result;
  EXPECT_EQ(fault_of(crowd_cell(), &result), "");
  EXPECT_GE(result.chunks_freed, 9900u);
  EXPECT_EQ(result.chunks_freed, result.chunks);
}

}  // namespace
}  // namespace sunder
