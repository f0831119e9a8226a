// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/error_front.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/impact_scene.hpp"
#include "io/run_report.hpp"
#include "io/scene.hpp"
#include "meshing/random.hpp"
#include "sim/impact.hpp"

namespace sunder {
namespace {

ErrorFront small_front() {
  return {"impact",
          "",
          "",
          "",
          {{1.0 / 60, 10, {}, 0.1, 1},
           {1.0 / 240, 10, {}, 0.02, 4},
           {1.0 / 240, 50, {}, 0.01, 9},
           {1.0 / 1000, 10, {}, 0.001, 20}}};
}

TEST(ErrorFront, TakesTheCheapestThatIsExactEnough) {
  for (const auto& [asked, step, iterations] : {std::tuple{0.5, 1.0 / 60, 10},
                                                {0.1, 1.0 / 60, 10},
                                                {0.05, 1.0 / 240, 10},
                                                {0.01, 1.0 / 240, 50},
                                                {0.002, 1.0 / 1000, 10}}) {
    SimulationParams simulation{.max_error = asked};
    const ErrorChoice choice = choose_settings(small_front(), {}, simulation);
    EXPECT_DOUBLE_EQ(simulation.step, step) << asked;
    EXPECT_EQ(simulation.iterations, iterations) << asked;
    EXPECT_TRUE(choice.is_met());
    EXPECT_EQ(choice.chosen, (std::vector<std::string>{"iterations", "step"}));
  }
}

TEST(ErrorFront, TakesTheMostExactAndSaysSoWhenNoneIsExactEnough) {
  SimulationParams simulation{.max_error = 1e-9};
  const ErrorChoice choice = choose_settings(small_front(), {}, simulation);
  EXPECT_DOUBLE_EQ(simulation.step, 1.0 / 1000);
  EXPECT_FALSE(choice.is_met());
  EXPECT_EQ(choice.expected, 0.001);
}

TEST(ErrorFront, LeavesWhatIsGivenAndExpectsNoMoreOfIt) {
  constexpr std::string_view kGiven[] = {"step", "duration", "max_error"};
  SimulationParams simulation{.step = 1.0 / 300, .max_error = 0.01};
  const ErrorChoice choice = choose_settings(small_front(), kGiven, simulation);
  EXPECT_DOUBLE_EQ(simulation.step, 1.0 / 300);
  EXPECT_EQ(simulation.iterations, 50);  // of 1/240, the measured step nearest above
  EXPECT_EQ(choice.expected, 0.01);
  SimulationParams coarse{.step = 0.1};
  EXPECT_FALSE(expected_error(small_front(), coarse).expected);
}

TEST(ErrorFront, BuiltInFrontsAreFronts) {
  for (const char* job : {"impact", "collapse"}) {
    const ErrorFront& front = error_front(job);
    ASSERT_GE(front.points.size(), 3u) << job;
    for (std::size_t i = 1; i < front.points.size(); ++i) {
      EXPECT_GE(front.points[i].time_ms, front.points[i - 1].time_ms);
      EXPECT_LT(front.points[i].error, front.points[i - 1].error);
    }
  }
}

// Whatever a scene gives besides.
TEST(ErrorFront, AskingForLessErrorNeverGivesMore) {
  for (const char* job : {"impact", "collapse"})
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
      const auto draw = [&](std::uint64_t i) { return random_unit(seed, 0, i); };
      std::vector<std::string_view> given;
      SimulationParams loose;
      if (draw(0) < 0.3) given.emplace_back("step");
      if (draw(1) < 0.3) given.emplace_back("iterations");
      loose.step = std::pow(10, -4 + 3 * draw(2));
      loose.iterations = 1 + static_cast<std::int64_t>(100 * draw(3));
      SimulationParams strict = loose;
      loose.max_error = std::pow(10, -4 + 4 * draw(4));
      strict.max_error = loose.max_error * draw(5);
      const ErrorFront& front = error_front(job);
      const auto a = choose_settings(front, given, loose),
                 b = choose_settings(front, given, strict);
      ASSERT_EQ(a.expected.has_value(), b.expected.has_value());
      EXPECT_LE(b.expected.value_or(0), a.expected.value_or(0)) << job << seed;
      EXPECT_EQ(a.is_met(), a.expected && *a.expected <= a.asked);
    }
}

/// A ball that slides to rolling on the ground: 5/7 of its speed is left (for any friction).
double rolling_error(double asked) {
  const std::string text = R"({"sunder": 1, "walls": [{"outline": {"rect": [1, 1]},
    "position": [0, 0, -50], "anchors": ["bottom"]}], "projectiles": [{"radius": 0.1, "mass": 30,
    "position": [0, 0.1, 0], "velocity": [3, 0, 0], "friction": 0.4, "restitution": 0}],
    "simulation": {"duration": 1.5, "max_error": )" +
                           std::to_string(asked) + "}}";
  const ImpactResult run = simulate_impact(impact_scene(parse_scene(text, "rolling.json")));
  const Recording& r = run.recording;
  const Pose start{r.projectiles[0].projectile.position, {}};
  const auto end = static_cast<std::uint32_t>(r.times.size() - 1), before = end * 3 / 4;
  const auto x = [&](std::uint32_t i) {
    return pose_at(r, r.projectiles[0].track, i, start).position.x;
  };
  const double speed = (x(end) - x(before)) / (r.times[end] - r.times[before]);
  return std::abs(speed / (3.0 * 5 / 7) - 1);
}

TEST(ErrorFront, ARunIsAsExactAsItWasAskedToBe) {
  for (const double asked : {0.3, 0.05, 0.01, 0.002}) EXPECT_LE(rolling_error(asked), asked);
}

TEST(ErrorFront, ASceneThatGivesMaxErrorGetsItsSettings) {
  const char* head = R"({"sunder": 1, "walls": [{}], "simulation": {)";
  const Scene open = parse_scene(std::string(head) + "\"max_error\": 0.1}}", "a.json");
  const Scene plain = parse_scene(std::string(head) + "}}", "b.json");
  const Scene fixed = parse_scene(std::string(head) + "\"max_error\": 0.1, \"step\": 0.003}}", "c");
  EXPECT_FALSE(plain.error_choice);
  EXPECT_DOUBLE_EQ(plain.simulation.step, 1.0 / 240);
  ASSERT_TRUE(open.error_choice);
  EXPECT_GT(open.simulation.step, 1.0 / 240);
  EXPECT_DOUBLE_EQ(fixed.simulation.step, 0.003);
  EXPECT_TRUE(shortfall(open, run_settings(open, "impact")).empty());
  const Scene strict = parse_scene(std::string(head) + "\"max_error\": 1e-9}}", "d.json");
  EXPECT_NE(shortfall(strict, run_settings(strict, "impact")).find("1e-9"), std::string::npos);
}

}  // namespace
}  // namespace sunder
