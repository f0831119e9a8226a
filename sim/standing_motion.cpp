// SPDX-License-Identifier: GPL-3.0-or-later
// The standing frame in time.
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/standing_frame.hpp"

namespace sunder {
namespace {

/// A frame rings no more when its kinetic energy stays below this share of the strain energy.
constexpr double kQuietShare = 1e-10;
constexpr double kQuietAfter = 0.25;  // s

double product_of(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

void StandingFrame::wake() {
  quiet_for_ = 0;
  take_in_panels();
  const bool rang = std::exchange(rings_, true);
  if (rang || scene_.simulation.quasi_static) return;
  if (!dynamic_.frame) make_dynamic();
  bring_up_to_date(dynamic_);
  dynamic_.frame->take_parted();  // they move as at rest
  has_rung_ = true;
  dynamic_.frame->begun_tips();  // they have been at rest
  u_ = with_tips(static_.frame->displacements());
  std::ranges::fill(v_, 0.0);
  stand_on();
}

/// The momentum M v and the elastic forces K u at the beginning, and what the loads do until then.
void StandingFrame::begin_step() {
  can_step_again_ = !contacts_.empty();
  if (!in_time()) {
    const std::span<const double> u = static_.frame->displacements();
    if (can_step_again_)
      before_step_ = {{u.begin(), u.end()}, {}, {}, {}, pushed_, {}, losses_, given_};
    return;
  }
  if (!hinges_.empty() || (can_step_again_ && !scene_.projectiles.empty()))
    before_step_ = {u_, v_, f_, laid_, pushed_, shaken_, losses_, given_};
  find_momentum();
  dynamic_.frame->stiffness_times(u_, springs_);
  v_before_ = v_;
  solve_step();
}

/// K* w = f₀ + f₁ − 2 K u₀ + (4/dt) M v₀, u₁ = u₀ + w, v₁ = (2/dt) w − v₀ with the loads at both
/// ends: the trapezoidal rule on M v' = f − K u − C v, u' = v. Damping is in K* alone.
void StandingFrame::solve_step() {
  const double dt = scene_.simulation.step;
  dynamic_.frame->load_vector(loads(), f_next_);
  for (std::size_t i = 0; i < f_.size(); ++i)
    right_[i] = f_[i] + f_next_[i] - 2 * springs_[i] + 4 / dt * momentum_[i];
  dynamic_.frame->solve_system(right_, way_);
  for (std::size_t i = 0; i < v_.size(); ++i) v_[i] = 2 / dt * way_[i] - v_before_[i];
}

void StandingFrame::end_step() {
  is_live_ = true;
  if (!in_time()) {
    balance();
    return;
  }
  for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += way_[i];
  std::swap(f_, f_next_);
  move_on();
  account_for_damping();
}

/// To where the last step began.
void StandingFrame::go_back() {
  pushed_ = before_step_.pushed;
  losses_ = before_step_.losses;
  given_ = before_step_.given;
  if (!in_time()) {
    FrameLoads then = loads();
    then.contacts = pushed_.contacts;
    static_.frame->set_displacements(before_step_.u, then);
    return;
  }
  u_ = before_step_.u;
  v_ = before_step_.v;
  is_momentum_known_ = false;
  f_ = before_step_.f;
  laid_ = before_step_.laid;
  shaken_ = before_step_.shaken;
  dynamic_.frame->set_displacements(u_, laid_);
}

/// Hinges that turned stiff in it stay so.
void StandingFrame::step_again() {
  go_back();
  hinges_ = in_use().hinges();
  begin_step();
  end_step();
  follow_step();
}

double StandingFrame::speed_along(FrameLoads::OnPart contact) const {
  contact.part = known_part(contact.part);
  return dynamic_.frame->power_of(contact, v_) / length(contact.force);
}

/// To u_. Contacts and the ground's own motion give the frame the mean of their forces at both ends
/// of the step times the way.
void StandingFrame::move_on() {
  const FrameLoads now = loads(), pushes = touching(), shakes = shaking();
  const bool touched = !pushed_.contacts.empty() || !pushes.contacts.empty();
  const bool shaken = !scene_.scenario.ground_motion.times.empty();
  FrameSolver& solver = *dynamic_.frame;
  const auto work = [&] {
    return std::pair{touched ? solver.work_of(pushed_) + solver.work_of(pushes) : 0,
                     shaken ? solver.work_of(shaken_) + solver.work_of(shakes) : 0};
  };
  const auto [contact_before, ground_before] = work();
  solver.set_displacements(u_, now);
  const auto [contact_after, ground_after] = work();
  losses_.contact -= (contact_after - contact_before) / 2;
  given_ += (ground_after - ground_before) / 2;
  if (touched || shaken) solver.set_displacements(u_, now);  // its loads again
  laid_ = now;
  pushed_ = pushes;
  shaken_ = shakes;
}

void StandingFrame::find_momentum() const {
  if (!is_momentum_known_) dynamic_.frame->mass_times(v_, momentum_);
  is_momentum_known_ = true;
}

/// Damping takes dt v̄ᵀ C v̄ with v̄ = w/dt; M w = dt (M v₀ + M v₁)/2, K w = K u₁ − K u₀.
void StandingFrame::account_for_damping() {
  const double dt = scene_.simulation.step;
  std::vector<double>&mass_way = momentum_before_, &spring_way = springs_;
  std::swap(momentum_, momentum_before_);
  is_momentum_known_ = false;
  find_momentum();
  dynamic_.frame->stiffness_times(u_, scratch_);
  for (std::size_t i = 0; i < way_.size(); ++i) {
    mass_way[i] = dt / 2 * (mass_way[i] + momentum_[i]);
    spring_way[i] = scratch_[i] - spring_way[i];
  }
  losses_.damping += (scene_.simulation.damping_mass * product_of(way_, mass_way) +
                      scene_.simulation.damping_stiffness * product_of(way_, spring_way)) /
                     dt;
  note_residual(mass_way, spring_way);
}

/// Of K* w, by the largest load, while anything stands.
void StandingFrame::note_residual(const std::vector<double>& mass_way,
                                  const std::vector<double>& spring_way) {
  if (gone_.size() == frame_.part_count()) return;
  const Factored params = factored_in_time();
  double load = 0, rest = 0;
  for (std::size_t i = 0; i < right_.size(); ++i) {
    load = std::max({load, std::fabs(f_[i]), std::fabs(right_[i])});
    const double left = params.stiffness * spring_way[i] + params.mass * mass_way[i];
    rest = std::max(rest, std::fabs(right_[i] - left));
  }
  if (load > 0) residual_ = std::max(residual_, rest / load);
}

void StandingFrame::fall_quiet(double dt) {
  if (!scene_.simulation.sleep || !scene_.scenario.ground_motion.times.empty()) return;
  const bool is_quiet = !in_time() || kinetic() <= kQuietShare * dynamic_.frame->strain_energy();
  quiet_for_ = is_quiet ? quiet_for_ + dt : 0;
  if (quiet_for_ < kQuietAfter) return;
  const double before = energy();
  if (in_time() && !hinges_.empty()) {
    hinges_ = stiff_hinges();
    dynamic_.frame->set_hinges(hinges_);
  }
  rings_ = false;
  solve_static();
  if (has_rung_)
    dynamic_.frame->set_displacements(with_tips(static_.frame->displacements()), loads());
  losses_.damping += before - energy();
}

/// The ringing frame's forces follow its displacements anew.
void StandingFrame::stand_on() {
  const FrameLoads now = loads();
  is_momentum_known_ = false;
  dynamic_.frame->load_vector(now, f_);
  dynamic_.frame->set_displacements(u_, now);
  laid_ = now;
  pushed_ = touching();
  shaken_ = shaking();
}

StandingFrame::Motion StandingFrame::motion(std::uint32_t node) const {
  const std::size_t first = dynamic_.frame->freedom(node);
  if (first == FrameSolver::kHeld) return {};
  return {{v_[first], v_[first + 1], v_[first + 2]}, {v_[first + 3], v_[first + 4], v_[first + 5]}};
}

std::optional<StandingFrame::TipMotion> StandingFrame::tip(std::uint32_t member) const {
  if (!in_time() || member >= frame_.slab_part(0)) return {};
  const std::size_t at = dynamic_.frame->freedom_of_tip(member);
  if (at == FrameSolver::kHeld) return {};
  return TipMotion{{u_[at], u_[at + 1], u_[at + 2]}, {v_[at], v_[at + 1], v_[at + 2]}};
}

}  // namespace sunder
