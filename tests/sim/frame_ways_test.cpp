// SPDX-License-Identifier: GPL-3.0-or-later
// Ways of masses that are read part by part, against those of the whole building.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "sim/frame_solver.hpp"
#include "stocked_frame.hpp"

namespace sunder {
namespace {

using Ways = std::vector<FrameSolver::MassWay>;
using Numbers = std::vector<std::uint32_t>;

Frame tower() {
  Frame frame = stocked_frame();
  add_regular(frame, regular(3, 3, 2, 0.2));
  join(frame);
  return frame;
}

Numbers all_of(std::size_t count) {
  Numbers numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

Numbers some_of(std::size_t count, std::size_t of, std::mt19937& random) {
  Numbers numbers = all_of(of);
  std::ranges::shuffle(numbers, random);
  numbers.resize(count);
  return numbers;
}

void expect_same_bits(const FrameSolver::MassWay& a, const FrameSolver::MassWay& b) {
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.moved, b.moved);
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_EQ(a.turned, b.turned);
  for (const double SymMat3::*each :
       {&SymMat3::xx, &SymMat3::yy, &SymMat3::zz, &SymMat3::xy, &SymMat3::xz, &SymMat3::yz})
    EXPECT_EQ(a.inertia.*each, b.inertia.*each);
}

/// Broken here and there, people on its slabs, a push on one of its parts.
struct Building {
  explicit Building(const Frame& of, std::mt19937& random) : frame(of), solver(of) {
    solver.break_joints(some_of(random() % 12, frame.joints.size(), random));
    const auto part = static_cast<std::uint32_t>(random() % frame.part_count());
    solver.solve({.contacts = {{part, {3, 4, 5}, {2e4, -3e4, 1e4}}}, .live = live});
  }
  Ways ways(const Numbers& parts) const { return solver.ways_of_displacements(live, parts); }

  const Frame& frame;
  std::vector<double> live = std::vector<double>(frame.slabs.size(), 2e3);
  FrameSolver solver;
};

TEST(FrameWays, ThoseOfSomePartsAreThoseOfAll) {
  const Frame frame = tower();
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Building building(frame, random);
    const Ways all = building.ways(all_of(frame.part_count()));
    const Numbers some = some_of(7, frame.part_count(), random);
    const Ways of_some = building.ways(some);
    for (std::size_t i = 0; i < some.size(); ++i) expect_same_bits(of_some[i], all[some[i]]);
    std::vector<double> speeds(building.solver.freedoms());
    for (double& each : speeds) each = static_cast<double>(random() % 1000);
    const Ways moving = building.solver.ways_of(speeds, all_of(frame.part_count()));
    const Ways some_moving = building.solver.ways_of(speeds, some);
    for (std::size_t i = 0; i < some.size(); ++i) expect_same_bits(some_moving[i], moving[some[i]]);
  }
}

TEST(FrameWays, HeightOfMassesIsTheSumOfTheirWaysUp) {
  const Frame frame = tower();
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    Building building(frame, random);
    for (int breaks = 0; breaks < 3; ++breaks) {
      double sum = 0;
      for (const FrameSolver::MassWay& way : building.ways(all_of(frame.part_count())))
        sum += way.moved.y;
      EXPECT_EQ(building.solver.height_of_masses(building.live), sum) << "seed " << seed;
      building.solver.break_joints(some_of(3, frame.joints.size(), random));
    }
  }
}

TEST(FrameWays, BreakChangesThoseOfThePartsThatAreNamedAlone) {
  const Frame frame = tower();
  std::size_t changed = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Building building(frame, random);
    Numbers joints = some_of(1 + random() % 3, frame.joints.size(), random);
    const Numbers leaving = some_of(random() % 2, frame.part_count(), random);
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      for (const std::uint32_t part : leaving)
        if (frame.joints[j].a == part || frame.joints[j].b == part) joints.push_back(j);
    const Numbers named = building.solver.parts_at(joints, leaving);
    EXPECT_LT(named.size(), frame.part_count());
    const Ways before = building.ways(all_of(frame.part_count()));
    building.solver.take_out(joints, leaving);
    const Ways after = building.ways(all_of(frame.part_count()));
    for (std::uint32_t part = 0; part < frame.part_count(); ++part) {
      if (std::ranges::binary_search(named, part)) {
        changed += before[part].moved == after[part].moved ? 0 : 1;
      } else {
        expect_same_bits(before[part], after[part]);
      }
    }
  }
  EXPECT_GT(changed, 30u);
}

}  // namespace
}  // namespace sunder
