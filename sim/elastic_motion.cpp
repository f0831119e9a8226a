// SPDX-License-Identifier: GPL-3.0-or-later
// A building as what it is: pieces that hang together, elastic inside. The piece on the ground
// stands still in the world and rings, when something happens to it, in the frame solver alone
// (trapezoidal rule: Newmark's method with 1/4, 1/2, here without accelerations, so that it starts
// right after a break). What comes loose is one rigid body each, whose inner forces follow from its
// contacts by inertia relief.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "fracture/support_graph.hpp"
#include "sim/frame_motion.hpp"
#include "sim/frame_solver.hpp"
#include "sim/part_pose.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kStanding = 0xFFFFFFFEu, kGone = 0xFFFFFFFFu;  ///< instead of a piece
/// A frame rings no more when its kinetic energy stays below this share of the strain energy.
constexpr double kQuietShare = 1e-10;
constexpr double kQuietAfter = 0.25;  // s
constexpr double kNoForce = 1;        // N: contacts below it are over
constexpr double kTurnsBack = 1e-12;  // rad in a step
constexpr double kEndless = 3.2;      // rad: above all capacities

FrameSolverParams solver_params(const CollapseScene& scene) {
  FrameSolverParams params;
  params.p_delta = scene.simulation.p_delta;
  params.slabs = scene.simulation.diaphragms ? "diaphragm" : "load";
  return params;
}
/// What the trapezoidal rule factors: K + (2/dt) C + (4/dt²) M with C = α M + β K.
FrameSolverParams dynamic_params(const CollapseScene& scene) {
  FrameSolverParams params = solver_params(scene);
  params.p_delta = false;
  const double dt = scene.simulation.step;
  params.stiffness = 1 + 2 / dt * scene.simulation.damping_stiffness;
  params.mass = 4 / (dt * dt) + 2 / dt * scene.simulation.damping_mass;
  return params;
}

class ElasticMotion final : public FrameMotion {
 public:
  ElasticMotion(const CollapseScene& scene, RigidWorld& world,
                const std::vector<PartSolid>& solids);
  void settle(const Progress& progress) override;
  void follow(double now, double dt, bool ends_step) override;
  JointLoad load(std::uint32_t joint) const override;
  bool is_live(std::uint32_t joint) const override;
  void break_joint(std::uint32_t joint, bool bears_on) override;
  HingeState hinge(std::uint32_t joint) const override;
  bool yield(std::uint32_t joint, Vec3 moment) override;
  bool redistributes() const override { return true; }
  bool settle_breaks() override;
  std::vector<std::uint32_t> unheld_joints() const override;
  double borne(std::uint32_t part) const override { return touches_[part].borne; }
  Vec3 give_back(std::uint32_t part, double share) override;
  void rejoin(std::span<const std::uint32_t> joints) override;
  void remove_part(std::uint32_t part) override;
  void add_load(double more) override;
  bool stands(std::uint32_t part) const override { return piece_of_[part] == kStanding; }
  BodyId give_up_shape(std::uint32_t part) override;
  void take_shape(std::uint32_t part, BodyId body) override;
  void set_mass(std::uint32_t part, double mass) override;
  Leaving release(std::uint32_t part) override;
  Pose pose(std::uint32_t part) const override;
  bool is_moving(std::uint32_t part) const override;
  std::uint32_t part_of(BodyId body, std::uint32_t prism) const override;
  double sag(std::uint32_t member) const override;
  std::vector<SupportReaction> supports() const override { return supports_; }
  double unsupported() const override;
  double joint_gap(std::uint32_t) const override { return 0; }
  std::uint64_t bodies() const override;
  double kinetic() const override;
  double strain() const override;
  double potential() const override;
  double baseline() const override { return baseline_; }
  MotionLosses losses() const override { return losses_; }
  double given() const override { return given_; }
  SolveCounts solves() const override;
  double residual() const override { return residual_; }

 private:
  /// What hangs together and moves.
  struct Piece {
    BodyId body = kNoBody;
    std::vector<std::uint32_t> parts;
    bool loaded_anew = false;
  };
  /// Force of what touches a part, and where; the part's own undeformed place.
  struct Touch {
    Vec3 impulse;         ///< since the last step ended
    double size = 0;      ///< sum of the impulses' sizes
    Vec3 weighted;        ///< their places, by size
    Vec3 force, point;    ///< mean over the load time
    double approach = 0;  ///< of what struck it, fastest since it is active, m/s
    Vec3 before;          ///< the force at the end of the step before
    Vec3 owed;            ///< impulse that was taken and is not yet passed on, before the last step
    double borne = 1;     ///< share of the blow that the frame could take
    bool is_active = false;
  };
  /// The standing frame before a step that may have to be done again.
  struct Moment {
    std::vector<double> u, v, f;
    FrameLoads pushed, shaken;
    MotionLosses losses;
    double given = 0;
  };
  void list_joints();
  void add_collider(std::uint32_t part);
  void note_contacts();
  void touch(const Contact& contact, std::uint32_t part, Vec3 impulse);
  double speed_ahead(std::uint32_t part, const Touch& touch) const;
  void limit_blows();
  void step_again();
  bool update_touches(double dt);
  void solve_standing();
  void account_for_damping(const std::vector<double>& w);
  void move_on(const FrameLoads& now);
  void take_state(const FrameSolver& old, const std::vector<double>& u,
                  const std::vector<double>& v);
  FrameSolver& standing() const;
  void stand_on();
  void set_hinges(const std::vector<FrameSolver::Hinge>& hinges);
  void stiffen_loose();
  bool settle_hinges();
  bool turn_endlessly(const std::vector<FrameSolver::Hinge>& hinges) const;
  void hold_hinges(std::vector<FrameSolver::Hinge> hinges);
  void follow_hinges();
  std::vector<FrameSolver::Hinge> standing_hinges() const;
  std::vector<FrameSolver::Hinge> stiff_hinges() const;
  FrameLoads touching() const;
  FrameLoads shaking() const;
  FrameSolver& ledger() const { return dynamic_ ? *dynamic_ : *static_; }
  void make_dynamic();
  void wake();
  void fall_quiet(double dt);
  FrameLoads loads(bool of_pieces) const;
  void solve_static();
  void balance();
  double mass_of(std::uint32_t part) const;
  BodyParams body_of(const std::vector<std::uint32_t>& parts) const;
  Vec3 velocity_of_end(std::uint32_t part, std::uint32_t node) const;
  std::vector<std::uint32_t> nodes_of(std::uint32_t part) const;
  Vec3 velocity_at(std::uint32_t part, Vec3 point) const;
  void take_frames_motion(BodyParams& body, const std::vector<std::uint32_t>& parts) const;
  void add_piece(std::vector<std::uint32_t> parts, BodyParams body);
  void detach(std::vector<std::uint32_t> parts);
  std::vector<std::vector<std::uint32_t>> components(const std::vector<std::uint32_t>& parts) const;
  void stop_turning();
  void split(std::uint32_t piece);
  double frame_energy() const;
  Vec3 gravity() const;

  const CollapseScene& scene_;
  const Frame& frame_;
  RigidWorld& world_;
  const std::vector<PartSolid>& solids_;
  std::unique_ptr<FrameSolver> static_;
  std::unique_ptr<FrameSolver> dynamic_;  ///< made when the frame rings first
  SupportGraph graph_;
  std::vector<std::uint8_t> intact_;
  std::vector<std::vector<std::uint32_t>> joints_of_;      ///< by part
  std::vector<std::uint32_t> piece_of_;                    ///< by part
  std::vector<BodyId> collider_of_;                        ///< by part
  std::vector<double> mass_left_;                          ///< by part, kg
  std::vector<std::vector<std::uint32_t>> parts_of_body_;  ///< by BodyId: prism → part
  std::vector<Piece> pieces_;
  std::vector<Touch> touches_;                         ///< by part
  std::vector<double> u_, v_, f_, scratch_, product_;  ///< of the standing frame, when it rings
  std::vector<std::uint32_t> broken_;                  ///< since breaks were settled
  std::vector<std::array<std::uint32_t, 2>> apart_;    ///< parts that bear on each other no more
  std::vector<FrameSolver::Hinge> hinges_;             ///< of the standing frame, by joint
  std::vector<FrameSolver::Hinge> yielding_;           ///< since breaks were settled
  std::vector<SupportReaction> supports_;
  double live_ = 0;  ///< added, N/m²
  double now_ = 0, since_step_ = 0, last_dt_ = 0, quiet_for_ = 0;
  bool rings_ = false, loads_changed_ = false;
  std::uint64_t serial_ = 0, skipped_ = 0;
  Moment before_step_;
  bool can_step_again_ = false;
  std::vector<double> momentum_;  ///< M v_, if it is known
  bool is_momentum_known_ = false;
  FrameLoads pushed_, shaken_;  ///< contacts and motion of the ground at the last loads
  double baseline_ = 0, given_ = 0;
  MotionLosses losses_;
  double residual_ = 0;
};

std::vector<Bond> bonds_of(const Frame& frame) {
  std::vector<Bond> bonds;
  for (const FrameJoint& joint : frame.joints)
    bonds.push_back({joint.a, joint.b == kNoPart ? kWorld : joint.b, 1, {}, {}});
  return bonds;
}

ElasticMotion::ElasticMotion(const CollapseScene& scene, RigidWorld& world,
                             const std::vector<PartSolid>& solids)
    : scene_(scene),
      frame_(scene.frame),
      world_(world),
      solids_(solids),
      static_(std::make_unique<FrameSolver>(scene.frame, solver_params(scene))),
      graph_(scene.frame.part_count(), bonds_of(scene.frame)),
      intact_(scene.frame.joints.size(), 1),
      joints_of_(scene.frame.part_count()),
      piece_of_(scene.frame.part_count(), kStanding),
      collider_of_(scene.frame.part_count(), kNoBody),
      touches_(scene.frame.part_count()) {
  list_joints();
  for (const PartSolid& solid : solids) mass_left_.push_back(solid.mass);
  for (std::uint32_t part = 0; part < frame_.part_count(); ++part) add_collider(part);
}

void ElasticMotion::list_joints() {
  for (std::vector<std::uint32_t>& list : joints_of_) list.clear();
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    joints_of_[frame_.joints[j].a].push_back(j);
    if (frame_.joints[j].b != kNoPart) joints_of_[frame_.joints[j].b].push_back(j);
  }
}

void ElasticMotion::add_collider(std::uint32_t part) {
  const Prism prism{solids_[part].hull, solids_[part].half_length};
  const BodyId body = world_.add_static(pose_of(solids_[part]), {&prism, 1},
                                        surface_of(frame_, part), kStandingOrder + part);
  collider_of_[part] = body;
  take_shape(part, body);
}

Vec3 ElasticMotion::gravity() const {
  const Vec3 weight{0, -scene_.simulation.gravity, 0};
  const GroundMotion& motion = scene_.scenario.ground_motion;
  return motion.times.empty() || now_ <= 0 ? weight : weight - motion.at(now_);
}

FrameLoads ElasticMotion::loads(bool of_pieces) const {
  FrameLoads result;
  result.gravity = gravity();
  if (live_ > 0) result.live.assign(frame_.slabs.size(), live_);
  for (std::uint32_t part = 0; part < touches_.size(); ++part) {
    const bool is_free = piece_of_[part] < pieces_.size();
    if (touches_[part].is_active && (of_pieces || !is_free))
      result.contacts.push_back({part, touches_[part].point, touches_[part].force});
  }
  if (!of_pieces) return result;
  for (const Piece& piece : pieces_) {
    if (piece.body == kNoBody || piece.parts.size() < 2) continue;
    const Quaternion back = conjugate(world_.pose(piece.body).rotation);
    result.spins.push_back({piece.parts[0], rotate(back, world_.angular_velocity(piece.body))});
  }
  return result;
}

/// The frame's elastic state under its weight; nothing moves.
void ElasticMotion::settle(const Progress&) {
  solve_static();
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    if (frame_.joints[j].b != kNoPart) continue;
    supports_.push_back({frame_.joints[j].node, static_->reaction(j), static_->reaction_moment(j)});
  }
}

/// Under other loads; in balance at any time, what they leave over counts as damping.
void ElasticMotion::balance() {
  const bool books = scene_.simulation.quasi_static;
  const double before = books ? frame_energy() : 0;
  solve_static();
  if (books) losses_.damping += before - frame_energy();
}

void ElasticMotion::solve_static() {
  static_->solve(loads(true));
  residual_ = std::max(residual_, static_->residual());
  loads_changed_ = true;
}

// ---- contacts --------------------------------------------------------------------------------

std::uint32_t ElasticMotion::part_of(BodyId body, std::uint32_t prism) const {
  if (body >= parts_of_body_.size() || parts_of_body_[body].empty()) return kNoPart;
  const std::vector<std::uint32_t>& parts = parts_of_body_[body];
  return parts.size() == 1 ? parts.front() : parts[prism];
}

void ElasticMotion::note_contacts() {
  for (const Contact& contact : world_.contacts()) {
    const Vec3 on_a = contact.impulse * contact.normal + contact.tangential;
    if (const std::uint32_t part = part_of(contact.a, contact.part_a); part != kNoPart)
      touch(contact, part, on_a);
    if (const std::uint32_t part = part_of(contact.b, contact.part_b); part != kNoPart)
      touch(contact, part, -1.0 * on_a);
  }
}

/// Point and impulse are turned back to where the part stood.
void ElasticMotion::touch(const Contact& contact, std::uint32_t part, Vec3 impulse) {
  Vec3 point = contact.point;
  if (piece_of_[part] < pieces_.size()) {
    const Pose back = inverse(world_.pose(pieces_[piece_of_[part]].body));
    point = back * point;
    impulse = rotate(back.rotation, impulse);
  }
  Touch& touch = touches_[part];
  const double size = length(impulse);
  touch.impulse = touch.impulse + impulse;
  touch.size += size;
  touch.weighted = touch.weighted + size * point;
  touch.approach = std::max(touch.approach, contact.approach);
}

/// Of the place that is touched, along the force, beyond the speed of what struck it.
double ElasticMotion::speed_ahead(std::uint32_t part, const Touch& touch) const {
  const double fall = scene_.simulation.gravity * scene_.rules.load_time;
  const Vec3 along = (1 / length(touch.force)) * touch.force;
  return dot(velocity_at(part, touch.point), along) - touch.approach - fall;
}

/// The world takes what stands for fixed, so that light parts would get more speed than what struck
/// them had: after a step in which they did, it is done again with as much force as they can take.
void ElasticMotion::limit_blows() {
  if (!can_step_again_) return;
  std::vector<std::pair<std::uint32_t, double>> ahead;
  for (std::uint32_t part = 0; part < touches_.size(); ++part) {
    if (!touches_[part].is_active || piece_of_[part] != kStanding) continue;
    const double speed = speed_ahead(part, touches_[part]);
    if (speed > 0) ahead.emplace_back(part, speed);
  }
  if (ahead.empty()) return;
  std::swap(v_, before_step_.v);
  for (auto& [part, speed] : ahead) {
    const double before = speed_ahead(part, touches_[part]);
    speed = before < 0 ? before / (before - speed) : 0;
  }
  std::swap(v_, before_step_.v);
  for (const auto& [part, share] : ahead) {
    touches_[part].force = share * touches_[part].force;
    touches_[part].borne = share;
    touches_[part].is_active = length(touches_[part].force) > kNoForce;
  }
  step_again();
}

Vec3 ElasticMotion::give_back(std::uint32_t part, double share) {
  if (piece_of_[part] != kStanding) return {};
  Touch& touch = touches_[part];
  touch.force = share * touch.force;
  if (can_step_again_) step_again();
  const Vec3 back = touch.owed - (last_dt_ / 2) * (touch.before + touch.force);
  touch = {};
  if (rings_ && dynamic_) stand_on();
  return back;
}

void ElasticMotion::step_again() {
  u_ = before_step_.u;
  v_ = before_step_.v;
  is_momentum_known_ = false;
  f_ = before_step_.f;
  pushed_ = before_step_.pushed;
  shaken_ = before_step_.shaken;
  losses_ = before_step_.losses;
  given_ = before_step_.given;
  dynamic_->set_displacements(u_, loads(false));
  solve_standing();
}

/// Forces follow the impulses by a first-order lag; true if any changed by more than asked for.
bool ElasticMotion::update_touches(double dt) {
  const double share = dt / (dt + scene_.rules.load_time);
  bool changed = false;
  for (std::uint32_t part = 0; part < touches_.size(); ++part) {
    Touch& touch = touches_[part];
    if (!touch.is_active && touch.size == 0) continue;
    if (touch.size > 0) touch.point = (1 / touch.size) * touch.weighted;
    touch.owed = touch.owed + touch.impulse - (last_dt_ / 2) * (touch.before + touch.force);
    touch.before = touch.force;
    const Vec3 force = touch.force + share * ((1 / dt) * touch.impulse - touch.force);
    const double change = length(force - touch.force);
    if (change > scene_.simulation.max_error * std::max(length(touch.force), kNoForce)) {
      changed = true;
      if (piece_of_[part] < pieces_.size()) pieces_[piece_of_[part]].loaded_anew = true;
    }
    touch.force = force;
    touch.borne = 1;
    touch.is_active = length(force) > kNoForce;
    if (!touch.is_active) touch.approach = 0, touch.owed = {};
    touch.impulse = touch.weighted = {};
    touch.size = 0;
  }
  last_dt_ = dt;
  return changed;
}

void ElasticMotion::follow(double now, double dt, bool ends_step) {
  now_ = now;
  since_step_ += dt;
  note_contacts();
  loads_changed_ = can_step_again_ = false;
  for (Piece& piece : pieces_) piece.loaded_anew = false;
  if (!ends_step) return;
  const bool changed = update_touches(since_step_);
  bool standing_changed = !scene_.scenario.ground_motion.times.empty();
  for (std::uint32_t part = 0; changed && part < touches_.size(); ++part)
    standing_changed |= touches_[part].is_active && piece_of_[part] == kStanding;
  if (standing_changed) wake();
  const bool pieces_changed = std::ranges::any_of(pieces_, &Piece::loaded_anew);
  if (pieces_changed) balance();
  if (rings_) {
    solve_standing();
    limit_blows();
    follow_hinges();
    fall_quiet(since_step_);
  }
  skipped_ += !rings_ && !pieces_changed;
  since_step_ = 0;
}

// ---- the standing frame in time -----------------------------------------------------------------

void ElasticMotion::make_dynamic() {
  dynamic_ = std::make_unique<FrameSolver>(frame_, dynamic_params(scene_));
  std::vector<std::uint32_t> gone, broken;
  for (std::uint32_t part = 0; part < piece_of_.size(); ++part)
    if (piece_of_[part] != kStanding) gone.push_back(part);
  for (std::uint32_t j = 0; j < intact_.size(); ++j)
    if (intact_[j] == 0) broken.push_back(j);
  if (!broken.empty()) dynamic_->break_joints(broken);
  if (!gone.empty()) dynamic_->remove_parts(gone);
  dynamic_->set_hinges(static_->hinges());
  v_.assign(dynamic_->freedoms(), 0);
  f_.resize(v_.size());
  scratch_.resize(v_.size());
  product_.resize(v_.size());
}

/// Starts from the state at rest.
void ElasticMotion::wake() {
  quiet_for_ = 0;
  if (rings_ || scene_.simulation.quasi_static) {
    rings_ = true;
    return;
  }
  rings_ = true;
  if (!dynamic_) make_dynamic();
  const std::span<const double> rest = static_->displacements();
  u_.assign(rest.begin(), rest.end());
  std::ranges::fill(v_, 0);
  stand_on();
}

/// K* w = f₀ + f₁ − 2 K u₀ + (4/dt) M v₀, u₁ = u₀ + w, v₁ = (2/dt) w − v₀ with the loads at both
/// ends: the trapezoidal rule on M v' = f − K u − C v, u' = v. Damping is in K* alone.
void ElasticMotion::solve_standing() {
  loads_changed_ = true;
  if (scene_.simulation.quasi_static) {
    balance();
    return;
  }
  const double dt = scene_.simulation.step;
  const FrameLoads now = loads(false);
  can_step_again_ = hinges_.empty() && !now.contacts.empty();
  if (can_step_again_) before_step_ = {u_, v_, f_, pushed_, shaken_, losses_, given_};
  std::vector<double>& next = scratch_;
  dynamic_->load_vector(now, next);
  for (std::size_t i = 0; i < next.size(); ++i) std::swap(f_[i], next[i]), next[i] += f_[i];
  dynamic_->stiffness_times(u_, product_);
  for (std::size_t i = 0; i < next.size(); ++i) next[i] -= 2 * product_[i];
  if (!is_momentum_known_) {
    momentum_.resize(v_.size());
    dynamic_->mass_times(v_, momentum_);
  }
  for (std::size_t i = 0; i < next.size(); ++i) next[i] += 4 / dt * momentum_[i];
  dynamic_->solve_system(next, product_);
  for (std::size_t i = 0; i < next.size(); ++i) {
    u_[i] += product_[i];
    v_[i] = 2 / dt * product_[i] - v_[i];
  }
  account_for_damping(product_);
  move_on(now);
}

/// To u_. Contacts and the ground's own motion give the frame the mean of their forces at both ends
/// of the step times the way.
void ElasticMotion::move_on(const FrameLoads& now) {
  const FrameLoads pushes = touching(), shakes = shaking();
  const bool touched = !pushed_.contacts.empty() || !pushes.contacts.empty();
  const bool shaken = !scene_.scenario.ground_motion.times.empty();
  const auto work = [&] {
    return std::pair{touched ? dynamic_->work_of(pushed_) + dynamic_->work_of(pushes) : 0,
                     shaken ? dynamic_->work_of(shaken_) + dynamic_->work_of(shakes) : 0};
  };
  const auto [contact_before, ground_before] = work();
  dynamic_->set_displacements(u_, now);
  const auto [contact_after, ground_after] = work();
  losses_.contact -= (contact_after - contact_before) / 2;
  given_ += (ground_after - ground_before) / 2;
  if (touched || shaken) dynamic_->set_displacements(u_, now);  // its loads again
  pushed_ = pushes;
  shaken_ = shakes;
}

/// The contacts of all loads.
FrameLoads ElasticMotion::touching() const {
  FrameLoads contacts;
  contacts.gravity = {};
  contacts.contacts = loads(false).contacts;
  return contacts;
}

/// What the loads have beyond contacts and weight.
FrameLoads ElasticMotion::shaking() const {
  FrameLoads motion = loads(false);
  motion.contacts.clear();
  motion.gravity = gravity() + Vec3{0, scene_.simulation.gravity, 0};
  return motion;
}

/// Damping takes dt v̄ᵀ C v̄ with v̄ = w/dt.
void ElasticMotion::account_for_damping(const std::vector<double>& w) {
  const double dt = scene_.simulation.step;
  const auto dot_with = [&](const std::vector<double>& y) {
    double sum = 0;
    for (std::size_t i = 0; i < w.size(); ++i) sum += w[i] * y[i];
    return sum;
  };
  std::vector<double>& y = scratch_;
  const double by_mass = scene_.simulation.damping_mass / 2;  // M w = dt (M v₀ + M v₁)/2
  losses_.damping += by_mass * dot_with(momentum_);
  dynamic_->mass_times(v_, momentum_);
  is_momentum_known_ = true;
  losses_.damping += by_mass * dot_with(momentum_);
  if (scene_.simulation.damping_stiffness > 0) {
    dynamic_->stiffness_times(w, y);
    losses_.damping += scene_.simulation.damping_stiffness / dt * dot_with(y);
  }
}

void ElasticMotion::fall_quiet(double dt) {
  if (!scene_.simulation.sleep || !scene_.scenario.ground_motion.times.empty()) return;
  const bool is_quiet =
      scene_.simulation.quasi_static || kinetic() <= kQuietShare * dynamic_->strain_energy();
  quiet_for_ = is_quiet ? quiet_for_ + dt : 0;
  if (quiet_for_ < kQuietAfter) return;
  const double before = frame_energy();
  if (dynamic_ && !hinges_.empty()) {
    hinges_ = stiff_hinges();
    dynamic_->set_hinges(hinges_);
    static_->set_hinges(hinges_);
  }
  solve_static();
  rings_ = false;
  if (dynamic_) dynamic_->set_displacements(static_->displacements(), loads(false));
  losses_.damping += before - frame_energy();
}

// ---- plastic hinges
// ------------------------------------------------------------------------------ In time they turn
// in the dynamic solver; the static one holds them as they are left.

FrameSolver& ElasticMotion::standing() const {
  return rings_ && dynamic_ ? *dynamic_ : *static_;
}

/// The ringing frame's forces follow its displacements anew.
void ElasticMotion::stand_on() {
  const FrameLoads now = loads(false);
  is_momentum_known_ = false;
  dynamic_->load_vector(now, f_);
  dynamic_->set_displacements(u_, now);
  pushed_ = touching();
  shaken_ = shaking();
}

std::vector<FrameSolver::Hinge> ElasticMotion::standing_hinges() const {
  std::vector<FrameSolver::Hinge> hinges = standing().hinges();
  std::erase_if(hinges, [&](const FrameSolver::Hinge& hinge) {
    return piece_of_[frame_.joints[hinge.joint].a] != kStanding;
  });
  return hinges;
}

std::vector<FrameSolver::Hinge> ElasticMotion::stiff_hinges() const {
  std::vector<FrameSolver::Hinge> hinges = standing_hinges();
  for (FrameSolver::Hinge& hinge : hinges) hinge.flows = false;
  return hinges;
}

FrameMotion::HingeState ElasticMotion::hinge(std::uint32_t j) const {
  const auto found = std::ranges::lower_bound(hinges_, j, {}, &FrameSolver::Hinge::joint);
  if (found == hinges_.end() || found->joint != j) return {};
  return {found->flows, length(found->rotation)};
}

/// What has come loose bends no more.
bool ElasticMotion::yield(std::uint32_t j, Vec3 moment) {
  if (piece_of_[frame_.joints[j].a] != kStanding || !standing().can_bend(j)) return false;
  yielding_.push_back({j, moment, {}, true});
  return true;
}

/// Displacements go on; what the hinges take up in turning is lost.
void ElasticMotion::set_hinges(const std::vector<FrameSolver::Hinge>& hinges) {
  const double before = frame_energy();
  standing().set_hinges(hinges);
  const bool in_time = rings_ && dynamic_;
  if (in_time) {
    stand_on();
  } else {
    static_->solve(loads(true));
  }
  const std::vector<FrameSolver::Hinge> turned = standing_hinges();
  if (!in_time && turn_endlessly(turned)) {
    hold_hinges(hinges);
  } else {
    hinges_ = turned;
  }
  losses_.plastic += before - frame_energy();
  loads_changed_ = true;
}

/// At rest: hinges make the frame a mechanism.
bool ElasticMotion::turn_endlessly(const std::vector<FrameSolver::Hinge>& hinges) const {
  return !static_->mechanisms().empty() ||
         std::ranges::any_of(hinges, [](const FrameSolver::Hinge& hinge) {
           return hinge.flows && length(hinge.rotation) > kEndless;
         });
}

/// At rest there is no state with these hinges: it stays as it was, but they count as turned too
/// far.
void ElasticMotion::hold_hinges(std::vector<FrameSolver::Hinge> hinges) {
  for (FrameSolver::Hinge& hinge : hinges) {
    const auto was = std::ranges::find(hinges_, hinge.joint, &FrameSolver::Hinge::joint);
    hinge.rotation = was == hinges_.end() ? Vec3{} : was->rotation;
    hinge.flows = false;
  }
  static_->set_hinges(hinges);
  static_->solve(loads(true));
  hinges_ = standing_hinges();
  for (const FrameSolver::Hinge& hinge : hinges) {
    const auto is = std::ranges::find(hinges_, hinge.joint, &FrameSolver::Hinge::joint);
    is->flows = true;
    is->rotation = {0, kEndless, 0};
  }
}

/// Where the static solver turns hinges it keeps only those of what stands.
void ElasticMotion::stiffen_loose() {
  std::vector<FrameSolver::Hinge> hinges = static_->hinges();
  std::erase_if(hinges, [&](const FrameSolver::Hinge& hinge) {
    return !hinge.flows || piece_of_[frame_.joints[hinge.joint].a] == kStanding;
  });
  for (FrameSolver::Hinge& hinge : hinges) hinge.flows = false;
  static_->set_hinges(hinges);
}

bool ElasticMotion::settle_hinges() {
  if (yielding_.empty()) return false;
  wake();
  set_hinges(yielding_);
  yielding_.clear();
  return true;
}

/// After a step of the standing frame. A hinge that would turn back is stiff, as it was before.
void ElasticMotion::follow_hinges() {
  if (hinges_.empty()) return;
  const std::vector<FrameSolver::Hinge> now = standing_hinges();
  assert(now.size() == hinges_.size() && "hinges come and go when breaks are settled");
  std::vector<FrameSolver::Hinge> stiff;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (!now[i].flows) continue;
    const double work = dot(now[i].moment, now[i].rotation - hinges_[i].rotation);
    losses_.plastic += work;
    if (!rings_ || !dynamic_) losses_.damping -= work;  // where what is lost at rest was booked
    if (work >= -kTurnsBack * length(now[i].moment)) continue;
    stiff.push_back(hinges_[i]);
    stiff.back().flows = false;
  }
  hinges_ = now;
  if (!stiff.empty()) set_hinges(stiff);
}

// ---- joints
// --------------------------------------------------------------------------------------

JointLoad ElasticMotion::load(std::uint32_t j) const {
  const bool stands = piece_of_[frame_.joints[j].a] == kStanding;
  return stands && rings_ && !scene_.simulation.quasi_static ? dynamic_->joint_load(j)
                                                             : static_->joint_load(j);
}

bool ElasticMotion::is_live(std::uint32_t j) const {
  return loads_changed_ && piece_of_[frame_.joints[j].a] != kGone;
}

void ElasticMotion::break_joint(std::uint32_t j, bool bears_on) {
  const FrameJoint& joint = frame_.joints[j];
  intact_[j] = 0;
  broken_.push_back(j);
  if (!bears_on && joint.b != kNoPart) apart_.push_back({joint.a, joint.b});
}

double ElasticMotion::frame_energy() const {
  return kinetic() + strain() + potential();
}

/// A member that lost one end hangs on the other as a rigid arm, whose inertia is far above what
/// turned at that node before: next to nothing of its angular momentum is left as speed.
void ElasticMotion::stop_turning() {
  const auto is_held = [&](std::uint32_t part, std::uint32_t node) {
    return std::ranges::any_of(joints_of_[part], [&](std::uint32_t j) {
      return frame_.joints[j].node == node && intact_[j] != 0;
    });
  };
  for (const std::uint32_t j : broken_) {
    for (const std::uint32_t part : {frame_.joints[j].a, frame_.joints[j].b}) {
      if (part >= frame_.members.size() || piece_of_[part] != kStanding) continue;
      const FrameMember& member = frame_.members[part];
      if (is_held(part, member.from) == is_held(part, member.to)) continue;
      const std::size_t first =
          dynamic_->freedom(is_held(part, member.from) ? member.from : member.to);
      if (first != FrameSolver::kHeld) std::fill_n(v_.begin() + static_cast<long>(first) + 3, 3, 0);
    }
  }
}

/// The elastic state goes on with the joints gone: displacements are continuous, forces are not.
bool ElasticMotion::settle_breaks() {
  const bool bent = settle_hinges();
  if (broken_.empty()) return bent;
  std::ranges::sort(broken_);
  const bool of_standing = std::ranges::any_of(
      broken_, [&](std::uint32_t j) { return piece_of_[frame_.joints[j].a] == kStanding; });
  const double before = frame_energy() + world_.kinetic_energy();
  if (of_standing) wake();
  if (dynamic_) static_->set_hinges(stiff_hinges());
  static_->break_joints(broken_);
  if (dynamic_) dynamic_->break_joints(broken_);
  std::vector<std::uint32_t> of_graph, split_pieces;
  for (const std::uint32_t j : broken_) {
    const std::uint32_t piece = piece_of_[frame_.joints[j].a];
    if (piece < pieces_.size()) split_pieces.push_back(piece);
  }
  for (SupportGraph::Island& island : graph_.break_bonds(broken_).islands) {
    std::erase_if(island.chunks, [&](std::uint32_t part) { return piece_of_[part] != kStanding; });
    if (!island.chunks.empty()) detach(std::move(island.chunks));
  }
  std::ranges::sort(split_pieces);
  split_pieces.erase(std::ranges::unique(split_pieces).begin(), split_pieces.end());
  for (const std::uint32_t piece : split_pieces) split(piece);
  if (dynamic_) stop_turning();
  broken_.clear();
  for (const auto& [a, b] : apart_) {
    const auto body = [&](std::uint32_t part) {
      return piece_of_[part] < pieces_.size() ? pieces_[piece_of_[part]].body : collider_of_[part];
    };
    if (body(a) != kNoBody && body(b) != kNoBody && body(a) != body(b))
      world_.separate(body(a), body(b));
  }
  apart_.clear();
  stiffen_loose();
  static_->solve(loads(true));
  if (rings_ && dynamic_) stand_on();
  hinges_ = standing_hinges();
  loads_changed_ = true;
  losses_.fracture += before - frame_energy() - world_.kinetic_energy();
  return true;
}

/// Joints of parts that what is left of their joints cannot hold.
std::vector<std::uint32_t> ElasticMotion::unheld_joints() const {
  std::vector<std::uint32_t> joints;
  for (const std::uint32_t part : static_->loose_parts()) {
    if (piece_of_[part] == kGone) continue;
    for (const std::uint32_t j : joints_of_[part])
      if (intact_[j] != 0) joints.push_back(j);
  }
  return joints;
}

// ---- pieces
// --------------------------------------------------------------------------------------

double ElasticMotion::mass_of(std::uint32_t part) const {
  const std::uint32_t first = frame_.slab_part(0), end = frame_.wall_part(0);
  const bool is_slab = part >= first && part < end;
  const double gravity = scene_.simulation.gravity;
  const double added = is_slab && live_ > 0 ? live_ * slab_area(frame_, part - first) / gravity : 0;
  return mass_left_[part] + added;
}

/// Mass, centroid and inertia of parts where they stood.
BodyParams ElasticMotion::body_of(const std::vector<std::uint32_t>& parts) const {
  BodyParams body;
  body.mass = 0;
  std::uint32_t heaviest = parts[0];
  for (const std::uint32_t part : parts) {
    const double mass = mass_of(part);
    body.mass += mass;
    body.centroid = body.centroid + mass * solids_[part].centre;
    if (mass > mass_of(heaviest)) heaviest = part;
  }
  body.centroid = (1 / body.mass) * body.centroid;
  for (const std::uint32_t part : parts) {
    const double mass = mass_of(part), share = mass / solids_[part].mass;
    const SymMat3 own = rotated(solids_[part].axes, solids_[part].inertia);
    const Vec3 r = solids_[part].centre - body.centroid;
    SymMat3& sum = body.inertia;
    sum.xx += share * own.xx + mass * (r.y * r.y + r.z * r.z);
    sum.yy += share * own.yy + mass * (r.x * r.x + r.z * r.z);
    sum.zz += share * own.zz + mass * (r.x * r.x + r.y * r.y);
    sum.xy += share * own.xy - mass * r.x * r.y;
    sum.xz += share * own.xz - mass * r.x * r.z;
    sum.yz += share * own.yz - mass * r.y * r.z;
  }
  body.surface = surface_of(frame_, heaviest);
  return body;
}

std::vector<std::uint32_t> ElasticMotion::nodes_of(std::uint32_t part) const {
  if (part < frame_.members.size()) return {frame_.members[part].from, frame_.members[part].to};
  const auto& nodes = part < frame_.wall_part(0) ? frame_.slabs[part - frame_.slab_part(0)].nodes
                                                 : frame_.walls[part - frame_.wall_part(0)].nodes;
  return {nodes.begin(), nodes.end()};
}

/// Of a part at its node; an end whose joint broke earlier goes with the part's other end.
Vec3 ElasticMotion::velocity_of_end(std::uint32_t part, std::uint32_t node) const {
  std::uint32_t held = node;
  const auto holds = [&](std::uint32_t j) {
    return frame_.joints[j].node == held &&
           (intact_[j] != 0 || std::ranges::binary_search(broken_, j));
  };
  if (part < frame_.members.size() && std::ranges::none_of(joints_of_[part], holds)) {
    const FrameMember& member = frame_.members[part];
    held = member.from == node ? member.to : member.from;
    if (std::ranges::none_of(joints_of_[part], holds)) held = node;
  }
  const std::size_t first = dynamic_->freedom(held);
  if (first == FrameSolver::kHeld) return {};
  const Vec3 turn{v_[first + 3], v_[first + 4], v_[first + 5]};
  return Vec3{v_[first], v_[first + 1], v_[first + 2]} +
         cross(turn, frame_.nodes[node].position - frame_.nodes[held].position);
}

/// Of a member linear between its ends, of a plate the mean of its corners.
Vec3 ElasticMotion::velocity_at(std::uint32_t part, Vec3 point) const {
  const std::vector<std::uint32_t> nodes = nodes_of(part);
  if (nodes.size() > 2) {
    Vec3 sum;
    for (const std::uint32_t node : nodes) sum = sum + velocity_of_end(part, node);
    return 0.25 * sum;
  }
  const Vec3 from = frame_.nodes[nodes[0]].position;
  const Vec3 along = frame_.nodes[nodes[1]].position - from;
  const double share = std::clamp(dot(point - from, along) / dot(along, along), 0.0, 1.0);
  return (1 - share) * velocity_of_end(part, nodes[0]) + share * velocity_of_end(part, nodes[1]);
}

/// The rigid motion with the momentum and angular momentum of the parts. Between its nodes a part's
/// velocity is linear in each direction: neighbours share their masses as finite elements do.
void ElasticMotion::take_frames_motion(BodyParams& body,
                                       const std::vector<std::uint32_t>& parts) const {
  if (!rings_ || !dynamic_) return;
  Vec3 momentum, angular;
  for (const std::uint32_t part : parts) {
    const std::vector<std::uint32_t> nodes = nodes_of(part);
    const std::size_t count = nodes.size();
    const double share = mass_of(part) / (count == 2 ? 6 : 36), size = count == 2 ? 2 : 4;
    Vec3 middle;
    for (const std::uint32_t node : nodes)
      middle = middle + (1 / size) * frame_.nodes[node].position;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 arm = solids_[part].centre + frame_.nodes[nodes[i]].position - middle;
      for (std::size_t j = 0; j < count; ++j) {
        const std::size_t apart = (i + count - j) % count;
        const double parted = apart == 0 ? size : apart == 2 ? 1 : size / 2;
        const Vec3 p = share * parted * velocity_of_end(part, nodes[j]);
        momentum = momentum + p;
        angular = angular + cross(arm - body.centroid, p);
      }
    }
  }
  body.velocity = (1 / body.mass) * momentum;
  body.angular_velocity = inverse(body.inertia) * angular;
}

void ElasticMotion::add_piece(std::vector<std::uint32_t> parts, BodyParams body) {
  std::vector<Prism> prisms;
  for (const std::uint32_t part : parts)
    prisms.push_back(
        {solids_[part].hull, solids_[part].half_length, solids_[part].centre, solids_[part].axes});
  body.order = kMovingOrder + serial_++;
  const auto index = static_cast<std::uint32_t>(pieces_.size());
  Piece piece;
  piece.body = world_.add_body(body, prisms);
  for (const std::uint32_t part : parts) piece_of_[part] = index;
  if (parts_of_body_.size() <= piece.body) parts_of_body_.resize(piece.body + 1);
  parts_of_body_[piece.body] = parts;
  piece.parts = std::move(parts);
  piece.loaded_anew = true;
  pieces_.push_back(std::move(piece));
}

/// What no longer hangs on the ground.
void ElasticMotion::detach(std::vector<std::uint32_t> parts) {
  BodyParams body = body_of(parts);
  take_frames_motion(body, parts);
  baseline_ += body.mass * scene_.simulation.gravity * body.centroid.y;
  for (const std::uint32_t part : parts)
    if (collider_of_[part] != kNoBody) give_up_shape(part);
  if (dynamic_) dynamic_->remove_parts(parts);
  add_piece(std::move(parts), body);
}

/// Parts that intact joints connect, piece by piece.
std::vector<std::vector<std::uint32_t>> ElasticMotion::components(
    const std::vector<std::uint32_t>& parts) const {
  std::vector<std::vector<std::uint32_t>> found;
  std::vector<std::uint32_t> sorted(parts);
  std::ranges::sort(sorted);
  std::vector<std::uint8_t> reached(sorted.size(), 0);
  const auto place = [&](std::uint32_t part) {
    return static_cast<std::size_t>(std::ranges::lower_bound(sorted, part) - sorted.begin());
  };
  for (const std::uint32_t seed : sorted) {
    if (reached[place(seed)] != 0) continue;
    std::vector<std::uint32_t> group{seed};
    reached[place(seed)] = 1;
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const std::uint32_t j : joints_of_[group[i]]) {
        const FrameJoint& joint = frame_.joints[j];
        if (intact_[j] == 0 || joint.b == kNoPart) continue;
        const std::uint32_t other = joint.a == group[i] ? joint.b : joint.a;
        if (reached[place(other)] != 0) continue;
        reached[place(other)] = 1;
        group.push_back(other);
      }
    }
    std::ranges::sort(group);
    found.push_back(std::move(group));
  }
  return found;
}

/// A piece in which joints broke: its parts go on with the motion it had.
void ElasticMotion::split(std::uint32_t index) {
  std::vector<std::vector<std::uint32_t>> groups = components(pieces_[index].parts);
  if (groups.size() < 2) return;
  const BodyId old = pieces_[index].body;
  const Pose pose = world_.pose(old);
  const Vec3 centre = world_.centre(old), velocity = world_.velocity(old),
             spin = world_.angular_velocity(old);
  parts_of_body_[old].clear();
  world_.remove(old);
  pieces_[index].body = kNoBody;
  pieces_[index].parts.clear();
  for (std::vector<std::uint32_t>& group : groups) {
    BodyParams body = body_of(group);
    body.pose = pose;
    body.angular_velocity = spin;
    body.velocity = velocity + cross(spin, pose * body.centroid - centre);
    add_piece(std::move(group), body);
  }
}

/// Happens at time 0: the solvers are made anew, their state is the same.
void ElasticMotion::rejoin(std::span<const std::uint32_t> joints) {
  if (joints.empty()) return;
  const double before = frame_energy();
  const std::vector<FrameSolver::Hinge> hinges = stiff_hinges();
  static_ = std::make_unique<FrameSolver>(frame_, solver_params(scene_));
  const std::unique_ptr<FrameSolver> old = std::move(dynamic_);
  const std::vector<double> u = u_, v = v_;
  const bool rang = rings_ && old;
  rings_ = false;
  graph_ = SupportGraph(frame_.part_count(), bonds_of(frame_));
  list_joints();
  std::vector<std::uint32_t> broken, gone;
  for (std::uint32_t j = 0; j < intact_.size(); ++j)
    if (intact_[j] == 0) broken.push_back(j);
  for (std::uint32_t part = 0; part < piece_of_.size(); ++part)
    if (piece_of_[part] == kGone) gone.push_back(part);
  if (!broken.empty()) {
    static_->break_joints(broken);
    graph_.break_bonds(broken);
  }
  if (!gone.empty()) static_->remove_parts(gone);
  static_->set_hinges(hinges);
  hinges_ = standing_hinges();
  solve_static();
  if (rang) take_state(*old, u, v);
  losses_.fracture += before - frame_energy();
}

/// Of a solver of the same nodes in another order.
void ElasticMotion::take_state(const FrameSolver& old, const std::vector<double>& u,
                               const std::vector<double>& v) {
  wake();
  for (std::uint32_t node = 0; node < frame_.nodes.size(); ++node) {
    const std::size_t from = old.freedom(node), to = dynamic_->freedom(node);
    if (from == FrameSolver::kHeld || to == FrameSolver::kHeld) continue;
    std::copy_n(u.data() + from, 6, u_.data() + to);
    std::copy_n(v.data() + from, 6, v_.data() + to);
  }
  stand_on();
}

void ElasticMotion::remove_part(std::uint32_t part) {
  const std::uint32_t index = piece_of_[part];
  assert(index < pieces_.size() && pieces_[index].parts.size() == 1 && "its joints are broken");
  const BodyId body = pieces_[index].body;
  baseline_ -= mass_of(part) * scene_.simulation.gravity * solids_[part].centre.y;
  const double before = world_.kinetic_energy() + frame_energy();
  parts_of_body_[body].clear();
  world_.remove(body);
  pieces_[index].body = kNoBody;
  pieces_[index].parts.clear();
  piece_of_[part] = kGone;
  static_->remove_parts({&part, 1});
  given_ += world_.kinetic_energy() + frame_energy() - before;
  hinges_ = standing_hinges();
}

BodyId ElasticMotion::give_up_shape(std::uint32_t part) {
  const BodyId body = collider_of_[part];
  parts_of_body_[body].clear();
  world_.remove(body);
  collider_of_[part] = kNoBody;
  touches_[part] = {};
  return body;
}

void ElasticMotion::take_shape(std::uint32_t part, BodyId body) {
  if (parts_of_body_.size() <= body) parts_of_body_.resize(body + 1);
  parts_of_body_[body] = {part};
}

/// The frame springs back where it is lighter.
void ElasticMotion::set_mass(std::uint32_t part, double mass) {
  wake();
  const double before = frame_energy();
  mass_left_[part] = mass;
  static_->set_plate_mass(part, mass);
  if (dynamic_) dynamic_->set_plate_mass(part, mass);
  solve_static();
  if (rings_ && dynamic_) stand_on();
  losses_.fracture += before - frame_energy();
}

FrameMotion::Leaving ElasticMotion::release(std::uint32_t part) {
  const std::uint32_t index = piece_of_[part];
  assert(index < pieces_.size() && pieces_[index].parts.size() == 1 && "its joints are broken");
  const BodyId body = pieces_[index].body;
  const Leaving leaving{world_.pose(body) * pose_of(solids_[part]), world_.centre(body),
                        world_.velocity(body), world_.angular_velocity(body)};
  parts_of_body_[body].clear();
  world_.remove(body);
  pieces_[index].body = kNoBody;
  pieces_[index].parts.clear();
  piece_of_[part] = kGone;
  touches_[part] = {};
  static_->remove_parts({&part, 1});
  hinges_ = standing_hinges();
  return leaving;
}

/// Free pieces grow heavier too.
void ElasticMotion::add_load(double more) {
  wake();
  const double before = world_.kinetic_energy() + frame_energy();
  live_ += more;
  for (const Piece& piece : pieces_) {
    double area = 0, mass = 0;
    for (const std::uint32_t part : piece.parts) {
      mass += mass_of(part);
      if (part >= frame_.slab_part(0) && part < frame_.wall_part(0))
        area += slab_area(frame_, part - frame_.slab_part(0));
    }
    if (area == 0) continue;
    baseline_ += more * area * world_.centre(piece.body).y;
    world_.set_mass(piece.body, mass);
  }
  const double plastic = losses_.plastic;
  if (rings_ && dynamic_) {
    stand_on();
    follow_hinges();
  }
  given_ += world_.kinetic_energy() + frame_energy() + losses_.plastic - plastic - before;
}

Pose ElasticMotion::pose(std::uint32_t part) const {
  const Pose standing = pose_of(solids_[part]);
  const std::uint32_t piece = piece_of_[part];
  return piece < pieces_.size() ? world_.pose(pieces_[piece].body) * standing : standing;
}

bool ElasticMotion::is_moving(std::uint32_t part) const {
  const std::uint32_t piece = piece_of_[part];
  return piece < pieces_.size() && world_.is_awake(pieces_[piece].body);
}

double ElasticMotion::sag(std::uint32_t member) const {
  const std::uint32_t node = frame_.members[member].to;
  if (piece_of_[member] != kStanding) {
    const Vec3 stood = frame_.nodes[node].position;
    return piece_of_[member] < pieces_.size()
               ? stood.y - (world_.pose(pieces_[piece_of_[member]].body) * stood).y
               : 0;
  }
  return -standing().displacement(node).y;
}

double ElasticMotion::unsupported() const {
  double mass = 0;
  for (std::uint32_t w = 0; w < frame_.walls.size(); ++w)
    if (frame_.walls[w].edges[0] == kNoPart) mass += solids_[frame_.wall_part(w)].mass;
  return mass * scene_.simulation.gravity;
}

std::uint64_t ElasticMotion::bodies() const {
  std::uint64_t count = 0;
  for (const Piece& piece : pieces_) count += piece.body != kNoBody;
  return count;
}

// ---- energy
// ----------------------------------------------------------------------------------------

double ElasticMotion::kinetic() const {
  if (!rings_ || !dynamic_) return 0;
  std::vector<double> momentum = momentum_;
  if (!is_momentum_known_) {
    momentum.resize(v_.size());
    dynamic_->mass_times(v_, momentum);
  }
  double twice = 0;
  for (std::size_t i = 0; i < v_.size(); ++i) twice += v_[i] * momentum[i];
  return twice / 2;
}

double ElasticMotion::strain() const {
  return ledger().strain_energy();
}

/// Of the weight on the frame's displacements.
double ElasticMotion::potential() const {
  FrameLoads own;
  own.gravity = {0, -scene_.simulation.gravity, 0};
  if (live_ > 0) own.live.assign(frame_.slabs.size(), live_);
  FrameSolver& solver = ledger();
  const double work = solver.work_of(own);
  const std::vector<double> u(solver.displacements().begin(), solver.displacements().end());
  solver.set_displacements(u, loads(&solver == static_.get()));  // its loads again
  return -work;
}

SolveCounts ElasticMotion::solves() const {
  SolveCounts counts;
  for (const FrameSolver* solver : {static_.get(), dynamic_.get()}) {
    if (solver == nullptr) continue;
    const FactorCounts own = solver->counts();
    counts.full += own.full;
    counts.update += own.partial + own.low_rank;
  }
  counts.skipped = skipped_;
  return counts;
}

}  // namespace

std::unique_ptr<FrameMotion> elastic_motion(const CollapseScene& scene, RigidWorld& world,
                                            const std::vector<PartSolid>& solids) {
  return std::make_unique<ElasticMotion>(scene, world, solids);
}

}  // namespace sunder
