// SPDX-License-Identifier: GPL-3.0-or-later
// Members of the standing frame divide: its solvers are made anew with a node for each, which
// starts where the place was that it stands for. In time without what contacts bend on the way
// between the ends: what they push there was not yet in motion.
#include <algorithm>

#include "sim/standing_frame.hpp"

namespace sunder {

namespace {

/// Whether a member along an edge of a panel divided, at one of these nodes.
bool has_divided_edge(const Frame& frame, const PanelElement& panel,
                      std::span<const std::uint32_t> nodes) {
  for (const std::uint32_t node : nodes) {
    std::vector<std::uint32_t> ends;  // of the whole
    for (const FrameMember& member : frame.members) {
      if (member.from == node) ends.push_back(member.to);
      if (member.to == node) ends.push_back(member.from);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const auto is_end = [&](std::uint32_t corner) {
        return std::ranges::count(ends, corner) > 0;
      };
      if (is_end(panel.nodes[k]) && is_end(panel.nodes[(k + 1) % 4])) return true;
    }
  }
  return false;
}

}  // namespace

void StandingFrame::begin_divisions(std::span<const MemberCut> cuts) {
  undivided_ = {};
  if (cuts.empty()) return;
  undivided_.in_time = in_time();
  undivided_.hinges = stiff_hinges();
  if (!undivided_.in_time) return;
  undivided_.nodes = in_use().freedoms() - 6 * frame_.members.size();
  using OnMember = FrameSolver::OnMember;
  for (const MemberCut& cut : cuts) {
    undivided_.u.push_back(in_use().motion_within(cut.member, cut.at, u_, OnMember::weight));
    undivided_.v.push_back(in_use().motion_within(cut.member, cut.at, v_, OnMember::nothing));
  }
}

void StandingFrame::end_divisions(std::uint32_t count, std::span<const std::uint32_t> nodes,
                                  std::vector<FrameLoads::OnPart> contacts,
                                  std::vector<std::uint32_t> not_standing) {
  const std::uint32_t first = frame_.slab_part(0);
  members_since_ += count;
  if (nodes.empty()) return;
  if (ahead_.valid()) {  // it reads the frame
    stops_ = true;
    ahead_.wait();
    ahead_ = {};
    stops_ = false;
  }
  const std::vector<TipState> tips =
      undivided_.in_time ? tips_of(*dynamic_.frame, u_, v_) : std::vector<TipState>();
  for (auto& [part, mass] : masses_) part = moved_up(part, first, members_since_);
  for (Panel& panel : panels_)
    panel.element.part = moved_up(panel.element.part, first, members_since_);
  members_since_ = 0;
  frame_ = scene_.frame;
  gone_ = std::move(not_standing);
  std::erase_if(panels_,
                [&](const Panel& p) { return has_divided_edge(frame_, p.element, nodes); });
  set_contacts(std::move(contacts));
  dynamic_ = {};
  const std::vector<double> u = u_, v = v_;
  const double quiet_for = quiet_for_;
  start_anew(undivided_.hinges);
  is_live_ = true;
  can_step_again_ = false;
  pushed_ = touching();
  if (!undivided_.in_time) return;
  wake();
  quiet_for_ = quiet_for;
  // Nodes that there were keep their places: those that came in are the last.
  std::copy_n(u.begin(), undivided_.nodes, u_.begin());
  std::copy_n(v.begin(), undivided_.nodes, v_.begin());
  take_tips(tips);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto at = static_cast<long>(dynamic_.frame->freedom(nodes[i]));
    std::ranges::copy(undivided_.u[i], u_.begin() + at);
    std::ranges::copy(undivided_.v[i], v_.begin() + at);
  }
  stand_on();
}

}  // namespace sunder
