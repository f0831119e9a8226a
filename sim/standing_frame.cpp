// SPDX-License-Identifier: GPL-3.0-or-later
// The standing frame: loads, what it has lost, its solvers, energy. In time: standing_motion.cpp.
#include "sim/standing_frame.hpp"

#include <algorithm>

#include "meshing/error.hpp"

namespace sunder {
StandingFrame::StandingFrame(const CollapseScene& scene) : scene_(scene), frame_(scene.frame) {}

FrameSolverParams StandingFrame::static_params() const {
  FrameSolverParams params;
  params.p_delta = scene_.simulation.p_delta;
  params.slabs = scene_.simulation.diaphragms ? "diaphragm" : "load";
  if (has_panels_)
    for (const Panel& panel : panels_) params.panels.push_back(panel.element);
  return params;
}

/// What the trapezoidal rule factors: K + (2/dt) C + (4/dt²) M with C = α M + β K.
StandingFrame::Factored StandingFrame::factored_in_time() const {
  const double dt = scene_.simulation.step;
  return {1 + 2 / dt * scene_.simulation.damping_stiffness,
          4 / (dt * dt) + 2 / dt * scene_.simulation.damping_mass};
}

FrameSolverParams StandingFrame::dynamic_params() const {
  FrameSolverParams params = static_params();
  params.p_delta = false;
  params.tips = true;
  const Factored factored = factored_in_time();
  params.stiffness = factored.stiffness;
  params.mass = factored.mass;
  return params;
}

StandingFrame::~StandingFrame() {
  stops_ = true;
}

void StandingFrame::settle(const Progress& progress) {
  FrameSolverParams params = static_params();
  const double share =
      scene_.simulation.settle / (scene_.simulation.settle + scene_.simulation.duration);
  if (progress) params.progress = [progress, share](double done) { progress(share * done); };
  static_.frame = std::make_unique<FrameSolver>(frame_, params);
  solve_static();
  is_settled_ = true;
  if (may_ring() && frame_.patterns.empty()) begin_dynamic();
}

/// In a thread of its own.
void StandingFrame::begin_dynamic() {
  FrameSolverParams ringing = dynamic_params();
  ringing.progress = [&stops = stops_](double) {
    if (stops) throw Error(ErrorCode::input, "the factor is not needed any more");
  };
  ahead_ = std::async(std::launch::async, [this, ringing, &like = *static_.frame] {
    return std::make_unique<FrameSolver>(frame_, ringing, like);
  });
}

void StandingFrame::set_panels(std::vector<PanelElement> elements) {
  std::ranges::sort(elements, {}, &PanelElement::part);
  for (PanelElement& element : elements) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Vec3 u = static_.frame->displacement(element.nodes[corner]);
      element.at_rest[3 * corner] = u.x;
      element.at_rest[3 * corner + 1] = u.y;
      element.at_rest[3 * corner + 2] = u.z;
    }
    panels_.push_back({element});
  }
  if (!may_ring()) return;
  take_in_panels();
  begin_dynamic();
}

std::optional<Twelve> StandingFrame::panel_motion(std::uint32_t part) const {
  const std::uint32_t known = known_part(part);
  if (has_panels_) return in_use().panel_motion(known);
  const auto number = [](const Panel& panel) { return panel.element.part; };
  if (std::ranges::binary_search(panels_, known, {}, number)) return Twelve{};
  return {};
}

/// A solver that has room for the panels takes the place of the one that found the state at rest.
void StandingFrame::take_in_panels() {
  if (has_panels_ || panels_.empty()) return;
  has_panels_ = true;
  const std::vector<double> u(static_.frame->displacements().begin(),
                              static_.frame->displacements().end());
  static_ = {std::make_unique<FrameSolver>(frame_, static_params())};
  bring_up_to_date(static_);
  const FrameLoads weight{.gravity = {0, -scene_.simulation.gravity, 0}};
  if (scene_.simulation.p_delta) {
    static_.frame->solve(weight);
  } else {
    static_.frame->set_displacements(u, weight);
  }
}

/// Later than at time 0: when parts are removed joints pass to others, and it is needed at once.
bool StandingFrame::may_ring() const {
  const Scenario& scenario = scene_.scenario;
  if (scene_.simulation.quasi_static || !scenario.remove.empty()) return false;
  return !scene_.projectiles.empty() || scenario.load_rate > 0 ||
         !scenario.ground_motion.times.empty();
}

std::vector<SupportReaction> StandingFrame::supports() const {
  std::vector<SupportReaction> supports;
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    if (frame_.joints[j].b != kNoPart) continue;
    supports.push_back({frame_.joints[j].node, in_use().reaction(j), in_use().reaction_moment(j)});
  }
  return supports;
}

// ---- loads
// ---------------------------------------------------------------------------------------

Vec3 StandingFrame::gravity() const {
  const Vec3 weight{0, -scene_.simulation.gravity, 0};
  const GroundMotion& motion = scene_.scenario.ground_motion;
  return motion.times.empty() || now_ <= 0 ? weight : weight - motion.at(now_);
}

FrameLoads StandingFrame::loads() const {
  FrameLoads result;
  result.gravity = gravity();
  if (live_ > 0) result.live.assign(frame_.slabs.size(), live_);
  result.contacts = contacts_;
  return result;
}

/// The contacts of all loads.
FrameLoads StandingFrame::touching() const {
  FrameLoads contacts;
  contacts.gravity = {};
  contacts.contacts = contacts_;
  return contacts;
}

/// What the loads have beyond contacts and weight.
FrameLoads StandingFrame::shaking() const {
  FrameLoads motion = loads();
  motion.contacts.clear();
  motion.gravity = gravity() + Vec3{0, scene_.simulation.gravity, 0};
  return motion;
}

/// The number that the solvers know a part of the scene's frame by.
std::uint32_t StandingFrame::known_part(std::uint32_t part) const {
  return part < frame_.slab_part(0) ? part : part - members_since_;
}

void StandingFrame::set_contacts(std::vector<FrameLoads::OnPart> contacts) {
  contacts_ = std::move(contacts);
  for (FrameLoads::OnPart& contact : contacts_) contact.part = known_part(contact.part);
}

void StandingFrame::add_live(double more) {
  live_ += more;
  if (in_time()) {
    stand_on();
    follow_hinges();
  }
}

// ---- solvers
// -------------------------------------------------------------------------------------

void StandingFrame::bring_up_to_date(Solver& solver) const {
  const std::span<const std::uint32_t> joints(broken_), parts(gone_);
  if (solver.joints < joints.size()) solver.frame->break_joints(joints.subspan(solver.joints));
  if (solver.parts < parts.size()) solver.frame->remove_parts(parts.subspan(solver.parts));
  for (std::size_t i = solver.masses; i < masses_.size(); ++i)
    solver.frame->set_plate_mass(masses_[i].first, masses_[i].second);
  std::vector<PanelElement> elements;
  solver.panels.resize(has_panels_ ? panels_.size() : 0);
  for (std::size_t i = 0; i < solver.panels.size(); ++i) {
    if (solver.panels[i] == panels_[i].set) continue;
    solver.panels[i] = panels_[i].set;
    elements.push_back(panels_[i].element);
  }
  solver.frame->set_panels(elements);
  solver.masses = masses_.size();
  solver.joints = joints.size();
  solver.parts = parts.size();
}

/// One that knows of nothing yet: all at once, so that on the way no pieces hang on nothing.
void StandingFrame::tell_all(Solver& solver) const {
  solver.frame->take_out(broken_, gone_);
  solver.joints = broken_.size();
  solver.parts = gone_.size();
  bring_up_to_date(solver);
  solver.frame->take_parted();
}

/// With the hinges that are left to it.
void StandingFrame::solve_static() {
  std::vector<double> from;
  is_short_ = false;
  try {
    bring_up_to_date(static_);
    static_.frame->take_parted();
    from.assign(static_.frame->displacements().begin(), static_.frame->displacements().end());
    if (has_rung_ && !hinges_.empty()) static_.frame->set_hinges(hinges_);
    static_.frame->solve(loads());
  } catch (const Error&) {
    if (!is_settled_ || is_first_order_ || !scene_.simulation.p_delta) throw;
    solve_anew();
  }
  residual_ = std::max(residual_, static_.frame->residual());
  is_live_ = true;
  if (is_settled_ && scene_.simulation.quasi_static && scene_.rules.breaking) keep_in_range(from);
}

/// What the stiffness knows of axial forces may be from before something broke: from none. Second
/// order has no state where the frame buckles: then, and from then on, in first order.
void StandingFrame::solve_anew() {
  const std::vector<Hinge> hinges = has_rung_ ? hinges_ : static_.frame->hinges();
  if (ahead_.valid()) ahead_.wait();
  FrameSolverParams params = static_params();
  const auto solve = [&] {
    static_ = {std::make_unique<FrameSolver>(frame_, params, *static_.frame)};
    bring_up_to_date(static_);
    static_.frame->set_hinges(hinges);
    static_.frame->solve(loads());
  };
  try {
    solve();
  } catch (const Error& error) {
    buckling_ = {now_, error.what()};
    is_first_order_ = true;
    params.p_delta = false;
    solve();
  }
}

/// Under other loads; in balance at any time, what they leave over counts as damping.
void StandingFrame::balance() {
  const double before = energy();
  const double pushed = solve_pushed();
  losses_.damping += before + pushed - energy();
}

/// At rest; contacts give the frame the mean of their forces before and after times the way. What
/// they gave, J, is in the books.
double StandingFrame::solve_pushed() {
  const FrameLoads pushes = touching();
  const bool touched = !pushed_.contacts.empty() || !pushes.contacts.empty();
  const auto work = [&] {
    return touched ? static_.frame->work_of(pushed_) + static_.frame->work_of(pushes) : 0;
  };
  const double before = work(), had = energy();
  solve_static();
  double given = (work() - before) / 2;
  // Short of a balance it is pushed with no more force than it resists.
  if (is_short_) given = std::min(given, std::max(0.0, energy() + turned_work() - had));
  if (touched) {
    const std::span<const double> found = static_.frame->displacements();
    static_.frame->set_displacements(std::vector<double>(found.begin(), found.end()), loads());
  }
  losses_.contact -= given;
  pushed_ = pushes;
  return given;
}

void StandingFrame::make_dynamic() {
  if (ahead_.valid()) {
    dynamic_ = {ahead_.get()};
    dynamic_.panels.assign(panels_.size(), 1);
  } else {
    dynamic_ = {std::make_unique<FrameSolver>(frame_, dynamic_params(), *static_.frame)};
  }
  tell_all(dynamic_);
  dynamic_.frame->set_hinges(static_.frame->hinges());
  v_.assign(dynamic_.frame->freedoms(), 0);
  for (std::vector<double>* each :
       {&f_, &way_, &f_next_, &springs_, &right_, &scratch_, &momentum_, &momentum_before_})
    each->resize(v_.size());
}

void StandingFrame::take_out(std::span<const std::uint32_t> joints,
                             std::span<const std::uint32_t> parts,
                             std::span<const std::uint32_t> changed) {
  broken_.insert(broken_.end(), joints.begin(), joints.end());
  for (const std::uint32_t part : parts) gone_.push_back(known_part(part));
  if (!in_time()) return bring_up_to_date(static_);
  const std::vector<std::uint32_t> at = known_parts(changed);
  const std::vector<FrameSolver::MassWay> before = dynamic_.frame->ways_of(v_, at);
  bring_up_to_date(dynamic_);
  const FrameSolver::Parted parted = dynamic_.frame->take_parted();
  FrameSolver::part_motion(parted, u_);
  FrameSolver::part_motion(parted, v_);
  const std::vector<FrameSolver::BegunTip> tips = dynamic_.frame->begun_tips();
  FrameSolver::begin_tips(tips, u_, true);
  FrameSolver::begin_tips(tips, v_, false);
  is_momentum_known_ = false;
  dynamic_.frame->keep_momentum(at, before, v_);
}

/// Of the static solver's displacements, whose free ends are rigid arms.
std::vector<double> StandingFrame::with_tips(std::span<const double> nodes) const {
  std::vector<double> all(dynamic_.frame->freedoms(), 0);
  std::ranges::copy(nodes, all.begin());
  dynamic_.frame->rest_tips(all, loads());
  return all;
}

std::vector<std::uint32_t> StandingFrame::known_parts(std::span<const std::uint32_t> parts) const {
  std::vector<std::uint32_t> known(parts.begin(), parts.end());
  for (std::uint32_t& part : known) part = known_part(part);
  return known;
}

std::vector<FrameSolver::MassWay> StandingFrame::ways(std::span<const std::uint32_t> parts) const {
  return in_use().ways_of_displacements(loads().live, known_parts(parts));
}

std::vector<FrameSolver::MassWay> StandingFrame::speeds(
    std::span<const std::uint32_t> parts) const {
  return in_use().ways_of(v_, known_parts(parts));
}

std::vector<std::uint32_t> StandingFrame::parts_at(std::span<const std::uint32_t> joints,
                                                   std::span<const std::uint32_t> parts) const {
  std::vector<std::uint32_t> at = in_use().parts_at(joints, known_parts(parts));
  for (std::uint32_t& part : at) part = moved_up(part, frame_.slab_part(0), members_since_);
  return at;
}

void StandingFrame::set_plate_mass(std::uint32_t part, double mass) {
  masses_.emplace_back(known_part(part), mass);
  if (in_time()) bring_up_to_date(dynamic_);
}

void StandingFrame::change_panels(std::span<const PanelStiffness> changed) {
  for (const PanelStiffness& each : changed) {
    const std::uint32_t known = known_part(each.part);
    const auto panel =
        std::ranges::lower_bound(panels_, known, {}, [](const Panel& p) { return p.element.part; });
    if (panel == panels_.end() || panel->element.part != known) continue;  // it lost an edge
    panel->element.stiffness = each.stiffness;
    ++panel->set;
  }
  if (in_time()) bring_up_to_date(dynamic_);
}

void StandingFrame::carry_on() {
  if (in_time()) {
    stand_on();
  } else {
    solve_static();
    pushed_ = touching();
  }
  keep_turned();
  is_live_ = true;
}

std::vector<std::uint32_t> StandingFrame::loose_parts() const {
  std::vector<std::uint32_t> parts = in_use().loose_parts();
  for (std::uint32_t& part : parts) part = moved_up(part, frame_.slab_part(0), members_since_);
  return parts;
}

/// Happens at time 0.
void StandingFrame::rejoin() {
  const std::vector<Hinge> hinges = stiff_hinges();
  const Solver old = std::move(dynamic_);
  const std::vector<double> u = u_, v = v_;
  const bool rang = in_time();
  frame_ = scene_.frame;
  start_anew(hinges);
  if (rang) take_state(*old.frame, u, v);
}

/// At rest, with solvers made anew.
void StandingFrame::start_anew(const std::vector<Hinge>& hinges) {
  rings_ = has_rung_ = false;
  has_panels_ = !panels_.empty();
  FrameSolverParams params = static_params();
  params.p_delta &= !is_first_order_;
  static_ = {std::make_unique<FrameSolver>(frame_, params)};
  tell_all(static_);
  static_.frame->set_hinges(hinges);
  hinges_ = static_.frame->hinges();
  solve_static();
}

/// Of a solver of the same nodes in another order.
void StandingFrame::take_state(const FrameSolver& old, const std::vector<double>& u,
                               const std::vector<double>& v) {
  wake();
  for (std::uint32_t node = 0; node < frame_.nodes.size(); ++node) {
    const std::size_t from = old.freedom(node), to = dynamic_.frame->freedom(node);
    if (from == FrameSolver::kHeld || to == FrameSolver::kHeld) continue;
    std::copy_n(u.data() + from, 6, u_.data() + to);
    std::copy_n(v.data() + from, 6, v_.data() + to);
  }
  take_tips(tips_of(old, u, v));
  stand_on();
}

std::vector<StandingFrame::TipState> StandingFrame::tips_of(const FrameSolver& solver,
                                                            const std::vector<double>& u,
                                                            const std::vector<double>& v) const {
  std::vector<TipState> tips;
  for (std::uint32_t m = 0; m < frame_.members.size(); ++m) {
    const std::size_t at = solver.freedom_of_tip(m);
    if (at == FrameSolver::kHeld) continue;
    TipState& tip = tips.emplace_back();
    tip.member = m;
    std::copy_n(u.data() + at, 6, tip.u.begin());
    std::copy_n(v.data() + at, 6, tip.v.begin());
  }
  return tips;
}

void StandingFrame::take_tips(const std::vector<TipState>& tips) {
  for (const TipState& tip : tips) {
    std::uint32_t member = tip.member;
    if (dynamic_.frame->freedom_of_tip(member) == FrameSolver::kHeld) {  // it divided
      const auto is_rest = [node = frame_.members[member].to](const FrameMember& other) {
        return other.from == node;
      };
      const auto rest = std::ranges::find_if(frame_.members, is_rest);
      member = static_cast<std::uint32_t>(rest - frame_.members.begin());
      if (rest == frame_.members.end()) continue;
    }
    const std::size_t at = dynamic_.frame->freedom_of_tip(member);
    if (at == FrameSolver::kHeld) continue;
    std::ranges::copy(tip.u, u_.data() + at);
    std::ranges::copy(tip.v, v_.data() + at);
  }
}

// ---- energy
// --------------------------------------------------------------------------------------

double StandingFrame::kinetic() const {
  if (!in_time()) return 0;
  find_momentum();
  double twice = 0;
  for (std::size_t i = 0; i < v_.size(); ++i) twice += v_[i] * momentum_[i];
  return twice / 2;
}

double StandingFrame::strain() const {
  return ledger().strain_energy();
}

double StandingFrame::potential() const {
  return scene_.simulation.gravity * ledger().height_of_masses(loads().live);
}

double StandingFrame::energy() const {
  return kinetic() + strain() + potential();
}

SolveCounts StandingFrame::solves() const {
  SolveCounts counts;
  for (const Solver* solver : {&static_, &dynamic_}) {
    if (!solver->frame) continue;
    const FactorCounts own = solver->frame->counts();
    counts.full += own.full;
    counts.update += own.partial + own.low_rank;
  }
  return counts;
}

}  // namespace sunder
