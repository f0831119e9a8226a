// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_building.hpp"

#include <algorithm>
#include <utility>

#include "io/strip_steps.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr double kLongestEnd = 0.5;    // m, that shows stress …
constexpr double kEndShare = 0.25;     // … and of the member's length
constexpr double kAtRest = 0.95;       // share of the moving parts that rest at the last picture
constexpr double kAfterBreak = 0.3;    // s, shown after the last joint broke
constexpr double kBreakWeight = 0.35;  // of broken joints beside time, where pictures are chosen

StripPart box_of(const RecordedPart& part) {
  const Box box = bounding_box(part.outline.outline);
  StripPart result;
  result.outline = rectangle(box.high - box.low, box.low);
  result.across.assign(result.outline.size(), StripPart::kBorder);
  if (part.has_ends) result.end = std::min(kLongestEnd, 2 * kEndShare * part.half_length);
  return result;
}

// Corners of a region one after the other, the region on the left of every loop.
struct Corners {
  std::vector<Vec2> points;
  IndexLoops loops;
  std::vector<std::uint32_t> next;  // of each corner, along its loop
};

Corners corners_of(const Region& region) {
  Corners result;
  const auto add = [&result](Loop loop, bool is_outer) {
    if ((area(loop) > 0) != is_outer) std::ranges::reverse(loop);
    const auto begin = static_cast<std::uint32_t>(result.points.size());
    const auto count = static_cast<std::uint32_t>(loop.size());
    std::vector<std::uint32_t>& indices = result.loops.emplace_back();
    for (std::uint32_t i = 0; i < count; ++i) {
      indices.push_back(begin + i);
      result.next.push_back(begin + (i + 1 == count ? 0 : i + 1));
      result.points.push_back(loop[i]);
    }
  };
  add(region.outline, true);
  for (const Loop& opening : region.openings) add(opening, false);
  return result;
}

// A slab or wall in convex parts.
std::vector<StripPart> plates_of(const RecordedPart& part) {
  std::vector<StripPart> result;
  const Corners corners = corners_of(part.outline);
  for (const std::vector<std::uint32_t>& convex : convex_parts(corners.points, corners.loops)) {
    StripPart& plate = result.emplace_back();
    for (std::size_t i = 0; i < convex.size(); ++i) {
      const std::uint32_t next = convex[i + 1 == convex.size() ? 0 : i + 1];
      const bool is_border = corners.next[convex[i]] == next;
      plate.outline.push_back(corners.points[convex[i]]);
      plate.across.push_back(is_border ? StripPart::kBorder : StripPart::kInside);
    }
  }
  return result;
}

// What of a part lies where dot(p, axis) <= limit.
StripPart clipped(const StripPart& part, Vec2 axis, double limit) {
  StripPart result = part;
  result.outline.clear(), result.across.clear();
  for (std::size_t i = 0; i < part.outline.size(); ++i) {
    const Vec2 p = part.outline[i], q = part.outline[i + 1 == part.outline.size() ? 0 : i + 1];
    const double p_over = dot(p, axis) - limit, q_over = dot(q, axis) - limit;
    if (p_over <= 0) {
      result.outline.push_back(p);
      result.across.push_back(part.across[i]);
    }
    if ((p_over < 0 && q_over > 0) || (p_over > 0 && q_over < 0)) {
      result.outline.push_back(p + (p_over / (p_over - q_over)) * (q - p));
      result.across.push_back(p_over < 0 ? StripPart::kInside : part.across[i]);
    } else if (p_over == 0 && q_over > 0) {
      result.across.back() = StripPart::kInside;
    }
  }
  return result;
}

// Times at which joints broke, ascending.
std::vector<double> break_times(const Recording& recording) {
  std::vector<double> times;
  for (const RecordedJoint& joint : recording.joints) {
    if (joint.broken <= recording.times.back()) times.push_back(joint.broken);
  }
  std::ranges::sort(times);
  return times;
}

// When nearly all parts have come to rest and the last joint has long broken.
double rest_time(const Recording& recording, double last_break) {
  std::vector<std::uint32_t> ends;
  for (const RecordedPart& part : recording.parts) {
    const TimeRange moving = moving_range(recording, part.track);
    if (moving.first < moving.end) ends.push_back(moving.end - 1);
  }
  double time = last_break + kAfterBreak;
  if (!ends.empty()) {
    std::ranges::sort(ends);
    const double last = kAtRest * static_cast<double>(ends.size() - 1);
    time = std::max(time, recording.times[ends[static_cast<std::size_t>(last)]]);
  }
  return std::min(time, recording.times.back());
}

}  // namespace

std::vector<StripPart> building_parts(const Recording& recording) {
  std::vector<StripPart> result;
  for (std::uint32_t p = 0; p < recording.parts.size(); ++p) {
    const RecordedPart& part = recording.parts[p];
    std::vector<StripPart> convex;
    if (part.has_ends) {
      convex.push_back(box_of(part));
    } else {
      convex = plates_of(part);
    }
    for (StripPart& strip_part : convex) {
      strip_part.wall = static_cast<std::uint32_t>(recording.walls.size());
      strip_part.chunk = p;
      strip_part.half = part.half_length;
      result.push_back(std::move(strip_part));
    }
  }
  return result;
}

std::array<StripPart, 2> halves_of(const StripPart& part) {
  std::array<StripPart, 2> halves{part, part};
  const Box box = bounding_box(part.outline);
  const Vec2 size = box.high - box.low;
  if (2 * part.half >= std::max(size.x, size.y)) {
    for (StripPart& half : halves) half.half = 0.5 * part.half;
    halves[0].middle -= halves[0].half, halves[0].has_front = false;
    halves[1].middle += halves[1].half, halves[1].has_back = false;
    return halves;
  }
  const Vec2 axis = size.x >= size.y ? Vec2{1, 0} : Vec2{0, 1};
  const double middle = 0.5 * dot(box.low + box.high, axis);
  halves[0] = clipped(part, axis, middle);
  halves[1] = clipped(part, -1.0 * axis, -middle);
  return halves;
}

std::vector<std::uint32_t> building_steps(const Recording& recording, int frames) {
  const std::vector<double> breaks = break_times(recording);
  const double begin = breaks.empty() ? recording.times[0] : breaks.front();
  const double end = breaks.empty() ? recording.times.back() : rest_time(recording, breaks.back());
  const std::uint32_t first = step_at(recording, begin), last = step_at(recording, end);
  const auto progress = [&](std::uint32_t step) {
    const double time = recording.times[step];
    const double passed = (time - begin) / (end - begin);
    if (breaks.empty()) return passed;
    const auto broken = std::ranges::upper_bound(breaks, time) - breaks.begin();
    const double share = static_cast<double>(broken) / static_cast<double>(breaks.size());
    return (1 - kBreakWeight) * passed + kBreakWeight * share;
  };
  std::vector<std::uint32_t> steps;
  if (frames > 1 && first > 0) steps.push_back(0);
  const int shares = frames - static_cast<int>(steps.size()) - 1;
  std::uint32_t step = first;
  const double before = first < last ? progress(first) : 0;
  for (int i = 0; i < shares; ++i) {
    const double wanted = before + (1 - before) * i / shares;
    while (step < last && progress(step) < wanted) ++step;
    steps.push_back(step);
  }
  steps.push_back(last);
  return steps;
}

}  // namespace sunder
