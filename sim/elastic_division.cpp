// SPDX-License-Identifier: GPL-3.0-or-later
// Members that divide, for the solver "hybrid": the same state with a node more.
#include <cassert>

#include "sim/elastic_motion.hpp"

namespace sunder {

bool ElasticMotion::find_span(std::uint32_t member, MemberSpan& span) const {
  if (bodies_.stands(member)) return standing_.find_span(member, span);
  return bodies_.is_loose(member) && inner_.find_span(member, span);
}

void ElasticMotion::begin_divisions(std::span<const MemberCut> cuts) {
  assert(broken_.empty() && yielding_.empty() && "breaks are settled first");
  std::vector<MemberCut> standing;
  for (const MemberCut& cut : cuts)
    if (bodies_.stands(cut.member)) standing.push_back(cut);
  undivided_ = standing.empty() ? 0 : standing_.energy();
  standing_.begin_divisions(standing);
}

/// What touches the whole goes on to touch the part where it does; at the cut both, in halves.
void ElasticMotion::divide_touch(const MemberDivision& division) {
  constexpr double kAtCut = 1e-9;  // m
  const FrameMember& second = frame_.members[division.part];
  const Vec3 cut = frame_.nodes[division.node].position;
  const Vec3 along = axes_of(frame_, second).x;
  const double beyond = dot(touches_[division.member].point - cut, along);
  touches_.divide(division.member, division.part,
                  std::abs(beyond) <= kAtCut ? 0.5 : beyond > 0 ? 1 : 0);
}

void ElasticMotion::end_divisions(std::span<const MemberDivision> divisions) {
  const auto first = divisions.front().part;
  const auto count = static_cast<std::uint32_t>(divisions.size());
  std::vector<std::uint32_t> standing, pieces;
  touches_.make_room(first, count);
  inner_.make_room(first, count);
  bodies_.make_room(first, count);
  const auto make_room = [&](auto& list) { list.insert(list.begin() + first, count, {}); };
  make_room(places_);
  make_room(offsets_);
  link_again();
  const std::size_t first_new = bodies_.pieces().size();
  for (const MemberDivision& division : divisions) {
    divide_touch(division);
    offsets_[division.part] = offsets_[division.member];
    places_[division.part] = places_[division.member];
    if (bodies_.stands(division.member)) standing.push_back(division.node);
    const std::uint32_t piece = bodies_.divide(division.member, division.part);
    if (piece != kNoPart) pieces.push_back(piece);
  }
  standing_.end_divisions(count, standing, standing_contacts(), bodies_.not_standing());
  if (!standing.empty()) fracture_ += undivided_ - standing_.energy();
  for (const std::uint32_t piece : pieces) inner_.forget(piece);
  if (!pieces.empty()) inner_.start(first_new, pieces, {}, touches_);
}

}  // namespace sunder
