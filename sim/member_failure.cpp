// SPDX-License-Identifier: GPL-3.0-or-later
// Which posts and beams fail between their ends: they divide there, and what joins the parts fails
// as an overloaded joint does; it parts, or bends.
#include <algorithm>

#include "sim/collapse_run.hpp"
#include "sim/part_pose.hpp"

namespace sunder {

void CollapseRun::add_members() {
  drawn_nodes_ = static_cast<std::uint32_t>(frame_.nodes.size());
  for (std::uint32_t m = 0; m < frame_.members.size(); ++m) {
    const std::uint32_t joint_class = class_within(frame_, m, joints_of_[m]);
    const Section& section = frame_.sections[frame_.members[m].section];
    members_.push_back({joint_class, strength_within(frame_, m, joint_class),
                        std::max(section.height, section.width)});
  }
}

/// Only what has changed is looked at, and what a bound does not clear.
std::vector<CollapseRun::Weak> CollapseRun::weak_members() {
  std::vector<Weak> weak;
  if (params_.skip && members_known_ && !motion_->any_live()) return weak;
  members_known_ = true;
  MemberSpan span;
  for (std::uint32_t m = 0; m < members_.size(); ++m) {
    const Member& member = members_[m];
    if (member.is_part || !motion_->find_span(m, span) || !may_fail_inside(span, member.strength))
      continue;
    if (const auto place = weakest_inside(span, member.strength, member.margin)) {
      weak.push_back({m, *place});
      note_use(place->utilisation);
    }
  }
  return weak;
}

bool CollapseRun::is_brittle(const Weak& weak) const {
  return frame_.classes[members_[weak.member].joint_class].rotation_capacity <= 0;
}

/// Whether a joint joins the parts of one member.
bool CollapseRun::is_inside(std::uint32_t j) const {
  const std::uint32_t node = frame_.joints[j].node;
  return node != kNoPart && node >= drawn_nodes_;
}

void CollapseRun::divide_members(const std::vector<Weak>& weak) {
  if (weak.empty()) return;
  motion_->settle_breaks();
  std::vector<MemberCut> cuts;
  for (const auto& [m, place] : weak)
    cuts.push_back({m, place.at, members_[m].joint_class, members_[m].strength});
  motion_->begin_divisions(cuts);
  std::vector<MemberDivision> divisions;
  std::vector<std::array<PartSolid, 2>> solids;
  for (const MemberCut& cut : cuts) {
    divisions.push_back(divide_member(
        frame_, cut, [this](std::uint32_t j) { return j >= joints_.size() || joints_[j].intact; }));
    solids.push_back(divide_part(divisions.back()));
  }
  intact_joints_ += frame_.joints.size() - joints_.size();
  joints_.resize(frame_.joints.size());
  joints_of_.assign(frame_.part_count(), {});
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    joints_of_[frame_.joints[j].a].push_back(j);
    if (frame_.joints[j].b != kNoPart) joints_of_[frame_.joints[j].b].push_back(j);
  }
  posts_.list_again();
  motion_->end_divisions(divisions);
  if (panels_)
    panels_->make_room(divisions.front().part, static_cast<std::uint32_t>(divisions.size()));
  for (std::size_t i = 0; i < divisions.size(); ++i)
    if (motion_->stands(divisions[i].member))
      kinks_.add(divisions[i], solids[i],
                 [this](std::uint32_t node) { return motion_->displacement(node); });
  result_.members_divided += divisions.size();
  all_known_ = posts_known_ = members_known_ = false;
  std::vector<Failure> failures;
  for (std::size_t i = 0; i < divisions.size(); ++i) {
    if (!is_brittle(weak[i])) continue;  // it bends, or breaks, when its load is read
    const FrameJoint& joint = frame_.joints[divisions[i].joint];
    failures.push_back({divisions[i].joint, weak[i].place.utilisation, "strength",
                        std::string(name_of(joint.strength.interaction)),
                        std::string(weak[i].place.component), true});
  }
  break_joints(std::move(failures));
}

/// Solids, tracks and tables by part. Returns the solids of the parts.
std::array<PartSolid, 2> CollapseRun::divide_part(const MemberDivision& division) {
  const std::uint32_t m = division.member, part = division.part;
  const PartSolid whole = solids_[m];
  const double z = dot(frame_.nodes[division.node].position - whole.centre, whole.axes.z);
  const auto [first, second] = divided(whole, z);
  solids_[m] = first;
  solids_.insert(solids_.begin() + part, second);
  parts_.insert(parts_.begin() + part, parts_[m]);
  const auto shift = [&](const PartSolid& half) {
    return Pose{{0, 0, dot(half.centre - whole.centre, whole.axes.z)}, {}};
  };
  if (parts_[m].track != kNoTrack)
    parts_[part].track = recorder_.divide_track(parts_[m].track, shift(first), shift(second));
  ++present_parts_;
  members_[m].is_part = true;
  members_.push_back(members_[m]);
  return {first, second};
}

/// Poses in which what bends between its ends is drawn while it stands.
Kinks::Poses CollapseRun::follow_kinks() {
  if (kinks_.none()) return {};
  return kinks_.follow([this](std::uint32_t node) { return motion_->displacement(node); },
                       [this](const MemberDivision& division) {
                         return joints_[division.joint].intact &&
                                motion_->stands(division.member) && motion_->stands(division.part);
                       });
}

}  // namespace sunder
