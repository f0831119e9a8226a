// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/resting.hpp"

#include <algorithm>
#include <utility>

namespace sunder {
namespace {

/// Contacts whose force holds less than this share of what leans on them are no support, N.
constexpr double kNoForce = 1e-9;
/// Contacts steeper than this carry no weight where forces are not known: rise of the normal.
constexpr double kLevel = 0.2;
/// Weight that still goes round among bodies that lean on each other when no more is handed on.
constexpr double kRest = 1e-6;
constexpr int kMostRounds = 50;

}  // namespace

std::vector<Support> supports_of(std::span<const Bearing> bearings) {
  std::vector<Support> supports;
  double down = 0;
  for (const Bearing& bearing : bearings) down += std::max(-bearing.force.y, 0.0);
  const bool is_known = down > kNoForce;
  double level = 0;
  for (const Bearing& bearing : bearings) level += bearing.normal.y > kLevel ? 1 : 0;
  for (const Bearing& bearing : bearings) {
    if (is_known ? !(bearing.force.y < 0) : !(bearing.normal.y > kLevel)) continue;
    supports.push_back(bearing.support);
    supports.back().share = is_known ? (1 / down) * bearing.force : Vec3{0, -1 / level, 0};
  }
  return supports;
}

std::vector<RestingLoad> resting_loads(std::span<Body* const> sleepers, double gravity,
                                       const FindBody& find) {
  std::vector<const Body*> order(sleepers.begin(), sleepers.end());
  std::ranges::stable_sort(order,
                           [](const Body* a, const Body* b) { return a->centre.y > b->centre.y; });
  std::vector<std::size_t> place;  // in `order`, by id
  double pending = 0;
  std::vector<double> due(order.size()), handed(order.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (place.size() <= order[i]->id) place.resize(order[i]->id + 1, order.size());
    place[order[i]->id] = i;
    pending += due[i] = order[i]->mass * gravity;
  }
  const double rest = kRest * pending;
  for (int round = 0; round < kMostRounds && pending > rest; ++round) {
    pending = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const double weight = std::exchange(due[i], 0);
      handed[i] += weight;
      for (const Support& support : order[i]->supports) {
        const std::size_t below = support.on < place.size() ? place[support.on] : order.size();
        if (below == order.size()) continue;
        due[below] -= weight * support.share.y;
        if (below < i) pending -= weight * support.share.y;
      }
    }
  }
  std::vector<RestingLoad> loads;
  for (const Body* body : sleepers) {
    const double weight = handed[place[body->id]];
    for (const Support& support : body->supports) {
      const Body* on = find(support.on);
      if (on != nullptr && !on->moves && !on->is_ground())
        loads.push_back({support.on, support.part, support.point, weight * support.share});
    }
  }
  return loads;
}

std::size_t merge(std::span<Body* const> sleepers, std::size_t count, const FindBody& find) {
  std::vector<Body*> order;
  for (Body* body : sleepers)
    if (!body->is_merged && !body->supports.empty()) order.push_back(body);
  std::ranges::sort(order, {}, [](const Body* body) { return std::pair(body->slept, body->id); });
  const auto is_fixed = [&](const Support& support) {
    const Body* on = find(support.on);
    return on != nullptr && (!on->moves || on->is_merged);
  };
  std::size_t merged = 0;
  for (bool any = true; any && merged < count;) {
    any = false;
    for (Body* body : order) {
      if (merged == count) break;
      if (body->is_merged || !std::ranges::all_of(body->supports, is_fixed)) continue;
      body->is_merged = any = true;
      ++merged;
    }
  }
  return merged;
}

}  // namespace sunder
