// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/inner_forces.hpp"

#include <algorithm>
#include <cmath>

#include "sim/divided_members.hpp"

namespace sunder {
namespace {

void count_in(SolveCounts& counts, const FactorCounts& own) {
  counts.full += own.full;
  counts.update += own.partial + own.low_rank;
}

}  // namespace

InnerForces::InnerForces(const CollapseScene& scene, RigidWorld& world,
                         const std::vector<PartSolid>& solids, const BuildingBodies& bodies,
                         const PartLinks& links)
    : scene_(scene), world_(world), solids_(solids), bodies_(bodies), links_(links) {}

void InnerForces::forget_changes() {
  for (const std::uint32_t piece : live_) state_[piece].is_live = false;
  live_.clear();
}

void InnerForces::mark_live(std::uint32_t piece) {
  if (!state_[piece].is_live) live_.push_back(piece);
  state_[piece].is_live = true;
}

/// In its own axes, those that the undeformed frame has.
Vec3 InnerForces::spin_of(std::uint32_t piece) const {
  const BodyId body = bodies_.pieces()[piece].body;
  return rotate(conjugate(world_.pose(body).rotation), world_.angular_velocity(body));
}

/// Whether centrifugal accelerations at the piece's rim differ from those at the last solve by more
/// than the error asked for of them, or of gravity.
bool InnerForces::spins_anew(std::uint32_t piece) const {
  const double radius = bodies_.pieces()[piece].radius;
  const Vec3 was = state_[piece].spin, is = spin_of(piece);
  const double change = length(is - was) * (length(is) + length(was)) * radius;
  const double scale = std::max(scene_.simulation.gravity, dot(was, was) * radius);
  return change > scene_.simulation.max_error * scale;
}

void InnerForces::follow(std::span<const std::uint32_t> touched, const FrameTouches& touches) {
  std::vector<std::uint32_t> changed;
  for (const std::uint32_t part : touched)
    if (bodies_.is_loose(part)) changed.push_back(bodies_.piece_of(part));
  std::ranges::sort(changed);
  for (const std::uint32_t piece : jointed_) {
    if (!std::ranges::binary_search(changed, piece) && !spins_anew(piece)) {
      ++skipped_;
    } else {
      solve(piece, touches);
    }
  }
}

void InnerForces::make_model(std::uint32_t piece) {
  std::vector<std::uint32_t> parts = bodies_.pieces()[piece].parts;
  std::ranges::sort(parts);
  auto model = std::make_unique<Model>();
  model->sub = sub_frame(scene_.frame, parts, links_.joints_within(parts));
  FrameSolverParams params;
  params.slabs = scene_.simulation.diaphragms ? "diaphragm" : "load";
  params.free = true;
  for (const std::uint32_t part : parts)
    if (part >= scene_.frame.wall_part(0)) params.wall_mass.push_back(solids_[part].mass);
  model->solver = std::make_unique<FrameSolver>(model->sub.frame, params);
  model->part_count = parts.size();
  state_[piece].model = std::move(model);
}

void InnerForces::drop_model(State& state) {
  if (!state.model) return;
  count_in(past_, state.model->solver->counts());
  state.model.reset();
}

/// Loads of what touches it now; of what nothing touches and does not spin they are nothing.
void InnerForces::solve(std::uint32_t piece, const FrameTouches& touches) {
  State& state = state_[piece];
  const BuildingBodies::Piece& loose = bodies_.pieces()[piece];
  FrameLoads loads;
  loads.gravity = {0, -scene_.simulation.gravity, 0};
  for (const std::uint32_t part : touches.active())
    if (bodies_.is_loose(part) && bodies_.piece_of(part) == piece)
      loads.contacts.push_back(touches.load_on(part));
  mark_live(piece);
  const bool spins = state.spin != Vec3{} || spins_anew(piece);
  state.is_loaded = spins || !loads.contacts.empty();
  if (!state.is_loaded) return;
  if (!state.model) make_model(piece);
  const SubFrame& sub = state.model->sub;
  for (FrameLoads::OnPart& contact : loads.contacts) contact.part = sub.part(contact.part);
  if (bodies_.live() > 0) loads.live.assign(sub.frame.slabs.size(), bodies_.live());
  state.spin = spin_of(piece);
  loads.spins.push_back({sub.part(std::ranges::min(loose.parts)), state.spin});
  state.model->solver->solve(loads);
  residual_ = std::max(residual_, state.model->solver->residual());
}

/// The largest of the pieces that a piece became keeps its model, if that is still worth it.
void InnerForces::inherit(std::uint32_t heir, std::uint32_t old,
                          std::span<const std::uint32_t> broken) {
  State& from = state_[old];
  if (!from.model) return;
  const std::vector<std::uint32_t>& parts = bodies_.pieces()[heir].parts;
  if (parts.size() < 2 || 2 * parts.size() < from.model->sub.parts.size()) return drop_model(from);
  Model& model = *from.model;
  std::vector<std::uint32_t> cut, gone;
  for (const std::uint32_t j : broken) {
    const FrameJoint& joint = scene_.frame.joints[j];
    const bool within =
        std::ranges::binary_search(parts, joint.a) && std::ranges::binary_search(parts, joint.b);
    if (within && model.sub.joint(j) != kNoPart) cut.push_back(model.sub.joint(j));
  }
  if (parts.size() < model.part_count)
    for (std::uint32_t i = 0; i < model.sub.parts.size(); ++i)
      if (!std::ranges::binary_search(parts, model.sub.parts[i])) gone.push_back(i);
  if (!cut.empty()) model.solver->break_joints(cut);
  if (!gone.empty()) model.solver->remove_parts(gone);
  model.part_count = parts.size();
  state_[heir].model = std::move(from.model);
}

void InnerForces::start(std::size_t first_new, std::span<const std::uint32_t> old,
                        std::span<const std::uint32_t> broken, const FrameTouches& touches) {
  const std::span<const BuildingBodies::Piece> pieces = bodies_.pieces();
  state_.resize(pieces.size());
  std::erase_if(jointed_, [&](std::uint32_t piece) { return pieces[piece].body == kNoBody; });
  unheld_.clear();
  std::vector<std::uint32_t> anew;
  for (const std::uint32_t piece : old) {
    if (pieces[piece].body != kNoBody) {
      inherit(piece, piece, broken);
      anew.push_back(piece);
      continue;
    }
    const Model* model = state_[piece].model.get();
    std::uint32_t largest = kNoPart;
    for (std::size_t i = first_new; model && i < pieces.size(); ++i) {
      if (model->sub.part(pieces[i].parts[0]) == kNoPart) continue;
      if (largest == kNoPart || pieces[i].parts.size() > pieces[largest].parts.size())
        largest = static_cast<std::uint32_t>(i);
    }
    if (largest != kNoPart) inherit(largest, piece, broken);
    drop_model(state_[piece]);
  }
  for (std::size_t i = first_new; i < pieces.size(); ++i)
    if (pieces[i].parts.size() > 1) anew.push_back(static_cast<std::uint32_t>(i));
  for (const std::uint32_t piece : anew) {
    if (piece >= first_new) jointed_.push_back(piece);
    for (const std::uint32_t part : links_.unheld(pieces[piece].parts)) unheld_.push_back(part);
    solve(piece, touches);
  }
}

JointLoad InnerForces::load(std::uint32_t j) const {
  const State& state = state_[bodies_.piece_of(scene_.frame.joints[j].a)];
  if (!state.is_loaded) return {};
  return state.model->solver->joint_load(state.model->sub.joint(j));
}

bool InnerForces::find_span(std::uint32_t member, MemberSpan& span) const {
  const State& state = state_[bodies_.piece_of(member)];
  return state.is_loaded && state.model->solver->find_span(state.model->sub.part(member), span);
}

void InnerForces::make_room(std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t& part : unheld_) part = moved_up(part, first, count);
  for (State& state : state_)
    if (state.model)
      for (std::uint32_t& part : state.model->sub.parts) part = moved_up(part, first, count);
}

SolveCounts InnerForces::solves() const {
  SolveCounts counts = past_;
  for (const State& state : state_)
    if (state.model) count_in(counts, state.model->solver->counts());
  return counts;
}

}  // namespace sunder
