// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "sim/collapse.hpp"

namespace sunder {
namespace {

constexpr std::string_view kPostRules[] = {"ec3", "euler", "unbraced", "none"};

}  // namespace

template <>
std::span<const Field<BreakingRules>> fields() {
  using P = BreakingRules;
  static const Field<P> table[] = {
      {.name = "post_rule",
       .member = &P::post_rule,
       .unit = "",
       .effect =
           "How posts fail beside their joints: ec3 at the buckling resistance of EN 1993-1-1, "
           "6.3.1, euler at the Euler load of the length between braced nodes, unbraced when "
           "the last beam at a joint of two posts is gone, none never.",
       .choices = kPostRules},
      {"breaking", &P::breaking, "",
       "Whether anything fails; false: joints and posts hold whatever happens, to see sag and "
       "forces."},
      {"hit_breaks", &P::hit_breaks, "", "Whether a joint that a projectile touches fails."},
      {"members_divide", &P::members_divide, "",
       "Whether posts and beams fail between their ends too; with the solver hybrid."},
      {"load_time",
       &P::load_time,
       "s",
       "Loads are judged by their mean over so long; 0: by the force of a single step, which grows "
       "without bound as the step shrinks.",
       {0, 10}},
  };
  return table;
}

Vec3 GroundMotion::at(double time) const {
  if (times.empty() || time < times.front() || time > times.back()) return {};
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.end()) return accelerations.back();
  const auto next = static_cast<std::size_t>(after - times.begin());
  const double share = (time - times[next - 1]) / (times[next] - times[next - 1]);
  return accelerations[next - 1] + share * (accelerations[next] - accelerations[next - 1]);
}

}  // namespace sunder
