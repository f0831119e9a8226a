// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/frame_touches.hpp"

#include <algorithm>

#include "sim/divided_members.hpp"

namespace sunder {
namespace {

constexpr double kNoForce = 1;  // N: contacts below it are over
/// Of the load time: what is left of a piece gives way so fast.
constexpr double kGivesWay = 0.25;

}  // namespace

void FrameTouches::add(std::uint32_t part, Vec3 point, Vec3 impulse, double approach) {
  FrameTouch& touch = of_[part];
  const double size = length(impulse);
  touch.impulse = touch.impulse + impulse;
  touch.size += size;
  touch.weighted = touch.weighted + size * point;
  touch.approach = std::max(touch.approach, approach);
  if (listed_[part] == 0) list_.push_back(part);
  listed_[part] = 1;
}

std::vector<std::uint32_t> FrameTouches::end_step(double dt, double load_time, double max_error) {
  const double share = dt / (dt + load_time);
  std::vector<std::uint32_t> changed;
  std::ranges::sort(list_);
  for (const std::uint32_t part : list_) {
    FrameTouch& touch = of_[part];
    if (!touch.is_active && touch.size == 0) continue;
    if (touch.size > 0) touch.point = (1 / touch.size) * touch.weighted;
    touch.owed = touch.owed + touch.impulse - (last_dt_ / 2) * (touch.before + touch.force);
    touch.before = touch.force;
    const Vec3 whole = touch.force + touch.held_back;
    Vec3 force = whole + share * ((1 / dt) * touch.impulse - whole);
    if (touch.held_back != Vec3{}) {
      const double stays = kGivesWay * load_time / (dt + kGivesWay * load_time);
      touch.held_back = stays * (force - touch.force);
      if (length(touch.held_back) < max_error * length(force)) touch.held_back = {};
      force = force - touch.held_back;
    }
    const double change = length(force - touch.force);
    if (change > max_error * std::max(length(touch.force), kNoForce)) changed.push_back(part);
    touch.force = force;
    touch.borne = 1;
    touch.is_active = std::max(length(force), length(touch.held_back)) > kNoForce;
    if (!touch.is_active) touch.approach = 0, touch.owed = {}, touch.striker = kNoBody;
    touch.impulse = touch.weighted = {};
    touch.size = 0;
  }
  last_dt_ = dt;
  std::erase_if(list_, [&](std::uint32_t part) {
    if (of_[part].is_active) return false;
    listed_[part] = 0;
    return true;
  });
  list_active();
  return changed;
}

void FrameTouches::list_active() {
  active_.clear();
  for (const std::uint32_t part : list_)
    if (of_[part].is_active) active_.push_back(part);
  std::ranges::sort(active_);
}

void FrameTouches::limit(std::uint32_t part, double share) {
  FrameTouch& touch = of_[part];
  touch.force = share * touch.force;
  touch.borne *= share;
  touch.is_active = length(touch.force) > kNoForce;
  list_active();
}

void FrameTouches::hold_back(std::uint32_t part, double share) {
  FrameTouch& touch = of_[part];
  touch.held_back = touch.held_back + (1 - share) * touch.force;
  touch.force = share * touch.force;
}

Vec3 FrameTouches::end(std::uint32_t part) {
  const Vec3 back = owed(part, 1);
  forget(part);
  return back;
}

void FrameTouches::make_room(std::uint32_t first, std::uint32_t count) {
  of_.insert(of_.begin() + first, count, {});
  listed_.insert(listed_.begin() + first, count, 0);
  for (std::uint32_t& part : list_) part = moved_up(part, first, count);
  for (std::uint32_t& part : active_) part = moved_up(part, first, count);
}

void FrameTouches::divide(std::uint32_t part, std::uint32_t new_part, double share) {
  if (listed_[part] == 0 || share == 0) return;
  FrameTouch& old = of_[part];
  const auto scaled = [&old](double by) {
    FrameTouch touch = old;
    touch.impulse = by * old.impulse;
    touch.size = by * old.size;
    touch.weighted = by * old.weighted;
    touch.force = by * old.force;
    touch.held_back = by * old.held_back;
    touch.before = by * old.before;
    touch.owed = by * old.owed;
    return touch;
  };
  of_[new_part] = scaled(share);
  list_.push_back(new_part);
  listed_[new_part] = 1;
  if (share == 1) {
    forget(part);
  } else {
    old = scaled(1 - share);
  }
  std::ranges::sort(list_);
  list_active();
}

void FrameTouches::forget(std::uint32_t part) {
  of_[part] = {};
  if (listed_[part] == 0) return;
  listed_[part] = 0;
  std::erase(list_, part);
  std::erase(active_, part);
}

}  // namespace sunder
