// SPDX-License-Identifier: GPL-3.0-or-later
// Plastic hinges of the standing frame. In time they turn in the dynamic solver; the static one
// holds them as they are left.
#include <algorithm>
#include <cassert>

#include "sim/standing_frame.hpp"

namespace sunder {
namespace {

constexpr double kTurnsBack = 1e-12;  // rad in a step
constexpr double kEndless = 3.2;      // rad: above all capacities

}  // namespace

std::vector<StandingFrame::Hinge> StandingFrame::stiff_hinges() const {
  std::vector<Hinge> hinges = in_use().hinges();
  for (Hinge& hinge : hinges) hinge.flows = false;
  return hinges;
}

const StandingFrame::Hinge* StandingFrame::hinge(std::uint32_t j) const {
  const auto found = std::ranges::lower_bound(hinges_, j, {}, &Hinge::joint);
  return found == hinges_.end() || found->joint != j ? nullptr : &*found;
}

/// Displacements go on; what the hinges take up in turning is lost.
void StandingFrame::set_hinges(const std::vector<Hinge>& hinges) {
  const double before = energy();
  in_use().set_hinges(hinges);
  if (in_time()) {
    stand_on();
  } else {
    solve_static();
  }
  const std::vector<Hinge> turned = in_use().hinges();
  if (!in_time() && (is_short_ || turn_endlessly(turned))) {
    hold_hinges(hinges);
  } else {
    hinges_ = turned;
  }
  losses_.plastic += before - energy();
  is_live_ = true;
}

/// At rest: hinges make the frame a mechanism.
bool StandingFrame::turn_endlessly(const std::vector<Hinge>& hinges) const {
  return !static_.frame->mechanisms().empty() ||
         std::ranges::any_of(hinges, [](const Hinge& hinge) {
           return hinge.flows && length(hinge.rotation) > kEndless;
         });
}

/// At rest there is no state with these hinges: it stays as it was, but those that went beyond
/// their capacity, or all, count as turned too far.
void StandingFrame::hold_hinges(std::vector<Hinge> hinges) {
  const std::vector<std::uint32_t> beyond = beyond_;
  for (Hinge& hinge : hinges) {
    const Hinge* was = this->hinge(hinge.joint);
    hinge.rotation = was == nullptr ? Vec3{} : was->rotation;
    hinge.flows = false;
  }
  static_.frame->set_hinges(hinges);
  solve_static();
  hinges_ = static_.frame->hinges();
  for (const Hinge& hinge : hinges) {
    if (!beyond.empty() && !std::ranges::binary_search(beyond, hinge.joint)) continue;
    const auto is = std::ranges::find(hinges_, hinge.joint, &Hinge::joint);
    is->flows = true;
    is->rotation = {0, kEndless, 0};
  }
}

/// Flowing ones that have turned back since, as they were, stiff.
std::vector<StandingFrame::Hinge> StandingFrame::turned_back(const std::vector<Hinge>& now) const {
  assert(now.size() == hinges_.size() && "hinges come and go when breaks are settled");
  std::vector<Hinge> stiff;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (!now[i].flows) continue;
    const double work = dot(now[i].moment, now[i].rotation - hinges_[i].rotation);
    if (work >= -kTurnsBack * length(now[i].moment)) continue;
    stiff.push_back(hinges_[i]);
    stiff.back().flows = false;
  }
  return stiff;
}

/// In time the step is done again with hinges stiff that would turn back in it: their free way back
/// is none that they went.
void StandingFrame::follow_step() {
  if (hinges_.empty()) return;
  for (std::size_t round = 0; in_time() && round < hinges_.size(); ++round) {
    const std::vector<Hinge> stiff = turned_back(in_use().hinges());
    if (stiff.empty()) break;
    go_back();
    // Its moment is that of its rotation: nothing changes yet.
    dynamic_.frame->set_hinges(stiff);
    dynamic_.frame->load_vector(laid_, f_);
    dynamic_.frame->set_displacements(u_, laid_);
    hinges_ = in_use().hinges();
    begin_step();
    end_step();
  }
  follow_hinges();
}

void StandingFrame::follow_hinges() {
  if (hinges_.empty()) return;
  const double work = take_turns();
  if (!in_time()) losses_.damping -= work;  // where what is lost at rest was booked
}

/// Less has to be borne, or other ends bear it: what would turn back is stiff as it was.
void StandingFrame::keep_turned() {
  const std::vector<Hinge> left = in_use().hinges();
  std::erase_if(hinges_, [&](const Hinge& hinge) {
    return !std::ranges::binary_search(left, hinge.joint, {}, &Hinge::joint);
  });
  for (std::size_t round = 0; round < hinges_.size(); ++round) {
    const std::vector<Hinge> stiff = turned_back(in_use().hinges());
    if (stiff.empty()) break;
    in_use().set_hinges(stiff);
    in_time() ? stand_on() : solve_static();
  }
  losses_.plastic += turned_work();
  hinges_ = in_use().hinges();
}

/// Of hinges since they were noted last, J.
double StandingFrame::turned_work() const {
  if (hinges_.empty()) return 0;
  const std::vector<Hinge> now = in_use().hinges();
  double work = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i].flows) work += dot(now[i].moment, now[i].rotation - hinges_[i].rotation);
  return work;
}

/// The work of what has turned, J, is plastic; what has turned back is stiff.
double StandingFrame::take_turns() {
  const std::vector<Hinge> now = in_use().hinges();
  const std::vector<Hinge> stiff = turned_back(now);
  const double work = turned_work();
  losses_.plastic += work;
  hinges_ = now;
  if (!stiff.empty()) set_hinges(stiff);
  return work;
}

}  // namespace sunder
