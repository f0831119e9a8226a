// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_steps.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "io/strip_building.hpp"
#include "meshing/elementary.hpp"

namespace sunder {
namespace {

constexpr double kAfterHit = 0.09;  // s, when a hit is shown
constexpr double kLeast = 0.06;     // s, when the last of several is
constexpr double kTogether = 0.08;  // s, hits closer than this share a picture
constexpr double kSettle = 0.5;     // s, shown after the last hit even if nothing moves any more
constexpr double kAtRest = 0.95;    // share of the moving chunks that rest at the last picture

// Steps at which the first chunk begins to move and nearly all have come to rest; empty if none
// moves.
TimeRange moving_steps(const Recording& recording) {
  std::uint32_t first = UINT32_MAX;
  std::vector<std::uint32_t> ends;
  for (const RecordedWall& wall : recording.walls) {
    for (const std::uint32_t track : wall.track) {
      const TimeRange moving = moving_range(recording, track);
      if (moving.first >= moving.end) continue;
      first = std::min(first, moving.first);
      ends.push_back(moving.end - 1);
    }
  }
  if (ends.empty()) return {};
  std::ranges::sort(ends);
  return {first, ends[static_cast<std::size_t>(kAtRest * static_cast<double>(ends.size() - 1))]};
}

// Hits that one picture shows, and a share of the pictures.
struct Act {
  double first = 0, last = 0;  // s, of its hits
  double end = 0;              // s, of the next act's first hit or of the recording's motion
  int pictures = 1, intervals = 1;

  double offset() const { return std::max(kAfterHit, last - first + kLeast); }
  double growth() const {  // log of the factor from one picture's time to the next one's
    return log_of(std::max(1.0, (end - first) / offset())) / intervals;
  }
};

std::size_t nearest_projectile(const Recording& recording, const BreakEvent& event) {
  const std::uint32_t step = step_at(recording, event.time);
  std::size_t result = recording.projectiles.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < recording.projectiles.size(); ++p) {
    const auto& [projectile, track] = recording.projectiles[p];
    if (projectile.time > event.time) continue;
    const Pose pose = pose_at(recording, track, step, {projectile.position, {}});
    const double distance = length(pose.position - event.point) - projectile.radius;
    if (distance < least) least = distance, result = p;
  }
  return result;
}

std::vector<Act> find_acts(const Recording& recording, TimeRange moving) {
  std::set<std::pair<std::size_t, std::uint32_t>> known;
  std::vector<double> hits;
  for (const BreakEvent& event : recording.events) {
    if (event.bonds_broken == 0) continue;  // a chunk broke, not a wall
    if (known.emplace(nearest_projectile(recording, event), event.wall).second) {
      hits.push_back(event.time);
    }
  }
  std::ranges::sort(hits);
  if (hits.empty() && moving.first < moving.end) hits.push_back(recording.times[moving.first]);
  std::vector<Act> acts;
  for (const double time : hits) {
    if (!acts.empty() && time - acts.back().first < kTogether) {
      acts.back().last = time;
    } else {
      acts.push_back({.first = time, .last = time});
    }
  }
  return acts;
}

// At most `most` of them, evenly chosen.
std::vector<Act> thinned(const std::vector<Act>& acts, std::size_t most) {
  if (acts.size() <= most) return acts;
  std::vector<Act> result;
  for (std::size_t i = 0; i < most; ++i) result.push_back(acts[i * acts.size() / most]);
  return result;
}

// Shares pictures out: one for each act and one for the end, more where they are farthest apart.
void share_out(std::vector<Act>& acts, int pictures, double end) {
  for (std::size_t i = 0; i < acts.size(); ++i) {
    acts[i].end = i + 1 < acts.size() ? acts[i + 1].first : end;
  }
  acts.back().pictures = 2;
  for (int left = pictures - static_cast<int>(acts.size()) - 1; left > 0; --left) {
    Act& sparse = *std::ranges::max_element(acts, {}, &Act::growth);
    ++sparse.pictures, ++sparse.intervals;
  }
}

std::vector<std::uint32_t> even_steps(const Recording& recording, int frames) {
  std::vector<std::uint32_t> steps;
  for (int i = 0; i < frames; ++i) {
    const double t = frames > 1 ? static_cast<double>(i) / (frames - 1) : 0.5;
    steps.push_back(
        step_at(recording, recording.times[0] + t * (recording.times.back() - recording.times[0])));
  }
  return steps;
}

std::vector<std::uint32_t> eventful_steps(const Recording& recording, std::vector<Act> acts,
                                          TimeRange moving, int frames) {
  const std::vector<double>& times = recording.times;
  if (frames == 1) return {step_at(recording, acts[0].first + acts[0].offset())};
  std::uint32_t begin = step_at(recording, acts[0].first);
  if (moving.first < moving.end) begin = std::min(begin, moving.first);
  const double settled = std::min(times.back(), acts.back().last + kSettle);
  const double end = std::max(times[moving.end], settled);
  std::vector<std::uint32_t> steps{begin > 0 ? begin - 1 : 0};
  acts = thinned(acts, static_cast<std::size_t>(frames - 2));
  if (acts.empty()) return {steps[0], step_at(recording, end)};
  share_out(acts, frames - 1, end);
  for (const Act& act : acts) {
    const double growth = act.growth();
    for (int i = 0; i < act.pictures; ++i) {
      const double later = act.offset() * exp_of(growth * i);
      steps.push_back(step_at(recording, act.first + later));
    }
  }
  return steps;
}

}  // namespace

std::uint32_t step_at(const Recording& recording, double time) {
  const auto next = std::ranges::lower_bound(recording.times, time - 1e-12);
  return static_cast<std::uint32_t>(std::min(next, recording.times.end() - 1) -
                                    recording.times.begin());
}

std::vector<std::uint32_t> strip_steps(const Recording& recording, int frames) {
  const TimeRange moving = moving_steps(recording);
  const std::vector<Act> acts = find_acts(recording, moving);
  std::vector<std::uint32_t> steps = !recording.parts.empty() ? building_steps(recording, frames)
                                     : acts.empty()
                                         ? even_steps(recording, frames)
                                         : eventful_steps(recording, acts, moving, frames);
  std::ranges::sort(steps);
  const auto repeated = std::ranges::unique(steps);
  steps.erase(repeated.begin(), repeated.end());
  return steps;
}

}  // namespace sunder
