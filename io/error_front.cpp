// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/error_front.hpp"

#include <algorithm>
#include <limits>

namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Steps are written with ten digits.
constexpr double kSameStep = 1 + 1e-6;

using Points = std::vector<const FrontPoint*>;

Points with_solver(const Points& points, const std::string& solver) {
  Points kept;
  for (const FrontPoint* p : points)
    if (!p->solver || *p->solver == solver) kept.push_back(p);
  return kept;
}

// Points of the measured step nearest above: they are not finer than what is given.
Points with_step(const Points& points, double step) {
  double nearest = kInfinity;
  for (const FrontPoint* p : points)
    if (p->step && *p->step * kSameStep >= step) nearest = std::min(nearest, *p->step);
  Points kept;
  for (const FrontPoint* p : points)
    if (!p->step || *p->step == nearest) kept.push_back(p);
  return kept;
}

Points with_iterations(const Points& points, std::int64_t iterations) {
  std::int64_t nearest = 0;
  for (const FrontPoint* p : points)
    if (p->iterations && *p->iterations <= iterations) nearest = std::max(nearest, *p->iterations);
  Points kept;
  for (const FrontPoint* p : points)
    if (!p->iterations || *p->iterations == nearest) kept.push_back(p);
  return kept;
}

// The cheapest that is exact enough, or the most exact.
const FrontPoint* best(const Points& points, double asked) {
  const FrontPoint *cheapest = nullptr, *most_exact = nullptr;
  for (const FrontPoint* p : points) {
    if (p->error <= asked && (!cheapest || p->time_ms < cheapest->time_ms)) cheapest = p;
    if (!most_exact || p->error < most_exact->error) most_exact = p;
  }
  return cheapest ? cheapest : most_exact;
}

}  // namespace

ErrorChoice choose_settings(const ErrorFront& front, std::span<const std::string_view> given,
                            SimulationParams& simulation) {
  const auto is_given = [&](std::string_view key) { return std::ranges::count(given, key) > 0; };
  ErrorChoice choice;
  choice.asked = simulation.max_error;
  Points points;
  for (const FrontPoint& point : front.points) points.push_back(&point);
  if (is_given("solver")) points = with_solver(points, simulation.solver);
  if (is_given("step")) points = with_step(points, simulation.step);
  if (is_given("iterations")) points = with_iterations(points, simulation.iterations);
  const FrontPoint* point = best(points, choice.asked);
  if (!point) return choice;
  choice.expected = point->error;
  const auto choose = [&](const char* key, auto& value, const auto& found) {
    if (!found || is_given(key)) return;
    value = *found;
    choice.chosen.emplace_back(key);
  };
  choose("iterations", simulation.iterations, point->iterations);
  choose("solver", simulation.solver, point->solver);
  choose("step", simulation.step, point->step);
  return choice;
}

ErrorChoice expected_error(const ErrorFront& front, const SimulationParams& simulation) {
  constexpr std::string_view kAll[] = {"solver", "step", "iterations"};
  SimulationParams same = simulation;
  return choose_settings(front, kAll, same);
}

}  // namespace sunder
