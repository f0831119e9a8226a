// SPDX-License-Identifier: GPL-3.0-or-later
// The rigid world on Bullet: its shapes, broadphase tree, narrowphase (GJK, EPA, face clipping),
// manifolds and sequential-impulse solver. Time integration is our own. Every body drifts freely to
// the moment its impulses act (the middle of the step; the moment of impact if something arrives in
// this step), takes them there, and drifts on: a leapfrog whose kick sits at the impact. So free
// flight is exact, momentum, angular momentum and energy are conserved to rounding in free
// collisions, and the work of every impulse is known.
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "sim/common_motion.hpp"
#include "sim/impulse_solver.hpp"
#include "sim/principal_axes.hpp"
#include "sim/resting.hpp"
#include "sim/rigid_joint.hpp"
#include "sim/rigid_world.hpp"
#include "sim/solid.hpp"
#include "sim/spin.hpp"
#include "sim/world_body.hpp"

namespace sunder {

Body::Body(Solid of) : solid(std::move(of)) {}
Body::~Body() = default;

namespace {

constexpr double kTouch = 1e-3;           // m; solids nearer than this touch
constexpr double kNeighbour = 2e-3;       // m; removing a body wakes what is nearer
constexpr double kRecall = 0.03;          // m, between a point and what it was a step ago
constexpr double kSleepAfter = 0.5;       // s
constexpr std::uint32_t kCrowd = 64;      // bodies in contact that need not sleep together
constexpr double kEnergyRounding = 1e-9;  // of the work of an island's impulses
constexpr double kCompliance = 1e-9;   // m/s per N s: direct solvers need it, joints are redundant
constexpr double kJointedShare = 0.1;  // of the sleeping speeds: joined bodies creep
constexpr double kWakeShare = 0.4;     // of the sleeping speeds: a neighbour this fast wakes

btVector3 bullet(Vec3 v) {
  return {v.x, v.y, v.z};
}
Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Where Bullet's frame of a body is when its design frame has these axes.
btTransform place(const Body& body, const Axes& axes, Vec3 centre) {
  const Vec3 x = axes * body.principal.axes.x, y = axes * body.principal.axes.y,
             z = axes * body.principal.axes.z;
  return btTransform(btMatrix3x3(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z), bullet(centre));
}
const btTransform& place(const Body& body) {
  return body.in_bullet->getWorldTransform();
}

/// Two parts that are close, and their manifold: what the solver reads, and what stays of a contact
/// until the next step. Bullet's body 0 is `a`, which ranks before `b`.
struct Link {
  Body* a = nullptr;
  Body* b = nullptr;
  std::uint32_t part_a = 0, part_b = 0;
  btPersistentManifold* manifold = nullptr;
  std::uint32_t first = 0, count = 0;  ///< its meetings
  std::uint32_t island = 0;            ///< slot of the island's first body
};
bool comes_before(const Link& x, const Link& y) {
  if (x.a != y.a) return ranks_before(*x.a, *y.a);
  if (x.b != y.b) return ranks_before(*x.b, *y.b);
  return x.part_a != y.part_a ? x.part_a < y.part_a : x.part_b < y.part_b;
}
/// The body in whose frame contact points are remembered.
const Body& keeper(const Link& link) {
  return link.b->moves ? *link.b : *link.a;
}
Vec3 keepers_point(const Link& link, const Meeting& m) {
  const Body& own = keeper(link);
  return into(own.axes, m.point + (m.origin - own.centre));
}

/// What Bullet's world is made of; outlives it.
struct WorldParts {
  btDefaultCollisionConfiguration configuration;
  Toucher toucher;
  btNullPairCache no_pairs;
  btDbvtBroadphase broadphase{&no_pairs};
  SolverTask task;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver;
  explicit WorldParts(JointSolver method) : solver(impulse_solver(task, method)) {}
};

/// Bullet's step, with each part that loops over all objects replaced by one that loops over those
/// that are awake.
class World final : private WorldParts, public btDiscreteDynamicsWorld {
 public:
  explicit World(const WorldParams& world_params)
      : WorldParts(world_params.joint_solver),
        btDiscreteDynamicsWorld(&toucher.dispatcher(), &broadphase, solver.get(), &configuration),
        params(world_params),
        gravity{0, -world_params.gravity, 0} {
    broadphase.m_deferedcollide = true;  // pairs are looked for by us
    task.gravity = gravity;
    btContactSolverInfo& info = getSolverInfo();
    info.m_solverMode = SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
    info.m_numIterations = params.iterations;
    info.m_splitImpulse = 1;
    info.m_splitImpulsePenetrationThreshold = BT_LARGE_FLOAT;
    const bool is_direct =
        params.joint_solver == JointSolver::dantzig || params.joint_solver == JointSolver::lemke;
    info.m_globalCfm = is_direct ? kCompliance : 0;
    task.warm_joints = params.warm_start;
    add_ground();
  }
  /// Bullet's own destructors would look at bodies that are gone.
  ~World() override {
    for (const Link& link : links_) toucher.dispatcher().releaseManifold(link.manifold);
    for (int i = 0; i < m_collisionObjects.size(); ++i) {
      broadphase.destroyProxy(m_collisionObjects[i]->getBroadphaseHandle(), getDispatcher());
      m_collisionObjects[i]->setBroadphaseHandle(nullptr);
    }
    m_collisionObjects.clear();
    m_nonStaticRigidBodies.clear();
  }

  WorldParams params;
  Vec3 gravity;
  std::vector<std::unique_ptr<RigidJoint>> joints;  ///< by id; null: removed
  std::vector<std::unique_ptr<Body>> bodies;        ///< by id; null: removed
  std::vector<Body*> awake;                         ///< by rank
  std::uint32_t moving_count = 0, merged_count = 0;
  std::vector<Contact> contacts;
  Vec3 reaction, weight;
  double deepest = 0;  ///< overlap when the step began, m
  StepWork work;

  Body& body(BodyId id) const {
    assert(id < bodies.size() && bodies[id] && "the body exists");
    return *bodies[id];
  }
  BodyId insert(std::unique_ptr<Body> body);
  void remove(Body& body);
  /// With all that is joined to it.
  void wake(Body& body);
  void wake_and_rank(Body& body);
  RigidJoint& joint(JointId id) const {
    assert(id < joints.size() && joints[id] && "the joint exists");
    return *joints[id];
  }
  using WorldParts::task;
  const std::vector<RestingLoad>& resting();
  void set_mass(Body& body, double mass);
  void accept_overlaps(Body& body);
  void move_static(Body& body, const Pose& pose);
  JointId insert(std::unique_ptr<RigidJoint> joint);
  void remove(RigidJoint& joint);
  void step(double dt);

 protected:
  // The parts of a step that Bullet calls, in this order.
  void saveKinematicState(btScalar) override {}
  void applyGravity() override {}
  void predictUnconstraintMotion(btScalar dt) override;
  void createPredictiveContacts(btScalar) override {}
  void performDiscreteCollisionDetection() override;
  void calculateSimulationIslands() override;
  void solveConstraints(btContactSolverInfo& info) override;
  void integrateTransforms(btScalar dt) override;
  void updateActivationState(btScalar dt) override;
  void synchronizeMotionStates() override {}
  void clearForces() override {}

 private:
  void add_ground();
  void put_into_bullet(Body& body);
  void set_box(Body& body);
  void wake_alone(Body& body);  ///< appends to `awake`
  void rank_last();
  void wake_around(Body& body);
  void forget_near(Body& body);
  bool passes(Body& a, const Body& b);
  void allow_overlaps(Body& one, const Body& other, bool is_a);
  void unite(const Body& a, const Body& b);
  void set_contact_times(const RigidJoint& joint);
  void put_to_sleep(Body& body);
  void pick_still(std::vector<char>& may_sleep);
  void note_bearings(std::span<const char> may_sleep);
  void merge_resting();
  void thaw_above(const Body& body);
  void leave_sleepers(Body& body);
  const Body* find_body(BodyId id) const { return bodies[id].get(); }
  void begin(Body& body);
  void find_near(const WorldBox& box);
  void meet(Body& one, Body& other);
  void add_links(Body& a, Body& b);
  RelativePath path_of(const Body& a, const Body& b) const;
  btManifoldPoint* remembered(const Link& link, const Meeting& meeting) const;
  void set_contact_times(const Link& link);
  void place_for_impulses(Body& body);
  void take_manifolds();
  void fill(const Link& link);
  void fill_point(Meeting& meeting, btManifoldPoint& point) const;
  void recall(const Link& link, Meeting& meeting, btManifoldPoint& point) const;
  void give(Meeting& meeting, btManifoldPoint& point) const;
  std::uint32_t find_root(std::uint32_t slot);
  void solve_island(std::span<const Link> links, std::span<RigidJoint* const> joints,
                    btContactSolverInfo& info);
  double keep_energy(std::span<const Link> links);
  void bound_pushes(std::span<const Link> links, double taken);
  void account();
  void account(const Link& link, const Meeting& meeting);
  void account(const RigidJoint& joint);
  Vec3 mean_velocity(const Body& body, Vec3 arm) const;

  double dt_ = 0, last_dt_ = 1;
  std::vector<Link> links_, old_links_;  ///< sorted by comes_before
  std::vector<Body*> in_contact_;        ///< by slot; [0] is null
  std::vector<std::uint32_t> root_;      ///< of the islands' union-find, by slot
  std::vector<btCollisionObject*> solved_bodies_;
  std::vector<Body*> pushed_;  ///< the same
  std::vector<btPersistentManifold*> solved_manifolds_;
  std::vector<RigidJoint*> awake_joints_;  ///< of bodies that are awake; by island, then age
  std::vector<btTypedConstraint*> solved_joints_;
  std::vector<PartTouch> touches_;
  std::vector<Body*> found_;
  std::vector<Body*> asleep_;         ///< by rank
  std::vector<RestingLoad> resting_;  ///< of those, unless resting_is_known_ is false
  bool resting_is_known_ = true;
  bool may_merge_ = false;          ///< bodies were added, or fell asleep
  std::uint64_t slept_before_ = 0;  ///< slept_ when the last step began
  std::uint64_t slept_ = 0;         ///< how often a body fell asleep
  std::vector<std::pair<Body*, Bearing>> bearings_;
  btNodeStack stack_;
};

std::uint32_t slot_of(const Body& body) {
  return body.awake ? body.slot : 0;
}
bool by_rank(const Body* a, const Body* b) {
  return ranks_before(*a, *b);
}

void World::add_ground() {
  auto ground = std::make_unique<Body>(Solid());
  ground->id = kGround;
  ground->surface = params.ground;
  ground->centre = {0, params.ground_height, 0};
  put_into_bullet(*ground);
  bodies.push_back(std::move(ground));
}

void World::put_into_bullet(Body& body) {
  body.in_bullet = std::make_unique<btRigidBody>(body.mass, nullptr, &body.solid.shape(),
                                                 bullet(body.principal.moments));
  body.in_bullet->setFlags(BT_DISABLE_WORLD_GRAVITY);
  body.in_bullet->setUserPointer(&body);
  body.in_bullet->setWorldTransform(place(body, body.axes, body.centre));
}

BodyId World::insert(std::unique_ptr<Body> body) {
  const auto id = static_cast<BodyId>(bodies.size());
  body->id = id;
  put_into_bullet(*body);
  addRigidBody(body->in_bullet.get(), btBroadphaseProxy::AllFilter, btBroadphaseProxy::AllFilter);
  broadphase.m_sets[0].optimizeIncremental(1);  // bodies come row by row: a deep tree without it
  body->swept = body->solid.rough_extent(place(*body));
  if (body->moves) {
    body->awake = true;
    awake.push_back(body.get());
    rank_last();
    ++moving_count;
    may_merge_ = true;
  }
  bodies.push_back(std::move(body));
  return id;
}

void World::remove(Body& body) {
  while (!body.joints.empty()) remove(*body.joints.back());
  for (const Body* other : body.passes) std::erase(bodies[other->id]->passes, &body);
  wake_around(body);
  removeRigidBody(body.in_bullet.get());
  if (body.awake) std::erase(awake, &body);
  if (!body.awake && body.moves) leave_sleepers(body);
  if (body.moves) --moving_count;
  resting_is_known_ = false;
  std::erase_if(links_, [&](const Link& link) {
    if (link.a != &body && link.b != &body) return false;
    getDispatcher()->releaseManifold(link.manifold);
    return true;
  });
  bodies[body.id].reset();
}

/// Moves the last of the awake bodies to where it ranks, so that sums do not depend on history.
void World::rank_last() {
  const auto at = std::upper_bound(awake.begin(), awake.end() - 1, awake.back(), by_rank);
  std::rotate(at, awake.end() - 1, awake.end());
}

void World::set_mass(Body& body, double mass) {
  wake_and_rank(body);
  const double ratio = mass / body.mass;
  body.mass = mass;
  for (double SymMat3::*each :
       {&SymMat3::xx, &SymMat3::yy, &SymMat3::zz, &SymMat3::xy, &SymMat3::xz, &SymMat3::yz}) {
    body.inertia.*each *= ratio;
    body.inverse_inertia.*each /= ratio;
  }
  body.principal.moments = ratio * body.principal.moments;
  body.in_bullet->setMassProps(mass, bullet(body.principal.moments));
}

void World::wake_alone(Body& body) {
  body.still_for = 0;
  if (body.awake) return;
  const bool was_merged = body.is_merged;
  leave_sleepers(body);
  body.awake = true;
  body.in_bullet->setMassProps(body.mass, bullet(body.principal.moments));
  awake.push_back(&body);
  if (was_merged) thaw_above(body);
}

void World::leave_sleepers(Body& body) {
  std::erase(asleep_, &body);
  if (body.is_merged) --merged_count;
  body.is_merged = false;
  body.supports.clear();
  resting_is_known_ = false;
}

/// Touching wakes merged bodies no more, so that what lies on one has to be told that it may go.
void World::thaw_above(const Body& body) {
  WorldBox box = body.solid.extent(place(body));
  box.grow(kNeighbour);
  find_near(box);
  for (Body* other : std::vector<Body*>(found_)) {
    const bool rests = std::any_of(other->supports.begin(), other->supports.end(),
                                   [&](const Support& support) { return support.on == body.id; });
    if (rests && other->is_merged) wake(*other);
  }
}

void World::wake_and_rank(Body& body) {
  const std::size_t count = awake.size();
  wake(body);
  if (awake.size() != count) std::sort(awake.begin(), awake.end(), by_rank);
}

void World::wake(Body& body) {
  if (!body.moves) return;
  if (body.awake || body.joints.empty()) return wake_alone(body);
  std::vector<Body*> reached{&body};
  wake_alone(body);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const RigidJoint* joint : reached[i]->joints) {
      Body& other = joint->a == reached[i] ? *joint->b : *joint->a;
      if (!other.moves || other.awake) continue;
      wake_alone(other);
      reached.push_back(&other);
    }
  }
}

JointId World::insert(std::unique_ptr<RigidJoint> joint) {
  for (Body* body : {joint->a, joint->b}) {
    wake_and_rank(*body);
    body->joints.push_back(joint.get());
    forget_near(*body);
  }
  joint->id = static_cast<JointId>(joints.size());
  joint->corrects_apart = params.warm_start && getSolverInfo().m_globalCfm == 0;
  joints.push_back(std::move(joint));
  return joints.back()->id;
}

void World::remove(RigidJoint& joint) {
  for (Body* body : {joint.a, joint.b}) {
    wake_and_rank(*body);
    forget_near(*body);
  }
  for (Body* body : {joint.a, joint.b}) std::erase(body->joints, &joint);
  joints[joint.id].reset();
}

/// What is near the body and its neighbours has to be found anew.
void World::forget_near(Body& body) {
  if (!body.moves) return;
  body.near_is_known = false;
  for (const RigidJoint* joint : body.joints) {
    Body& other = joint->a == &body ? *joint->b : *joint->a;
    if (other.moves) other.near_is_known = false;
  }
}

void World::accept_overlaps(Body& body) {
  find_near(body.solid.extent(place(body)));
  std::sort(found_.begin(), found_.end(),
            [](const Body* x, const Body* y) { return ranks_before(*x, *y); });
  if (params.has_ground) found_.push_back(bodies[kGround].get());
  for (Body* other : std::vector<Body*>(found_)) {
    if (other == &body || passes(body, *other)) continue;
    touches_.clear();
    toucher.find(body.solid, place(body), other->solid, place(*other), 0, {}, touches_);
    for (const PartTouch& touch : touches_) {
      if (!(touch.point.gap < 0)) continue;
      const bool goes_on = !body.overlaps.empty() && body.overlaps.back().other == other->id &&
                           body.overlaps.back().part == touch.part_a &&
                           body.overlaps.back().part_of_other == touch.part_b;
      if (!goes_on) body.overlaps.push_back({other->id, touch.part_a, touch.part_b, 0});
      body.overlaps.back().depth = std::max(body.overlaps.back().depth, -touch.point.gap);
    }
  }
}

/// Of the touches found between the two; `one` is the first of each pair, or (not is_a) the second.
void World::allow_overlaps(Body& one, const Body& other, bool is_a) {
  for (Overlap& overlap : one.overlaps) {
    if (overlap.other != other.id) continue;
    double deepest_now = 0;
    for (PartTouch& touch : touches_) {
      if ((is_a ? touch.part_a : touch.part_b) != overlap.part ||
          (is_a ? touch.part_b : touch.part_a) != overlap.part_of_other)
        continue;
      deepest_now = std::max(deepest_now, -touch.point.gap);
      touch.point.gap += overlap.depth;
    }
    overlap.depth = std::min(overlap.depth, deepest_now);
  }
  std::erase_if(one.overlaps, [](const Overlap& overlap) { return overlap.depth <= 0; });
}

void World::move_static(Body& body, const Pose& pose) {
  assert(!body.moves && !body.is_ground() && "a collider that never moves by itself");
  wake_around(body);
  body.rotation = normalised(pose.rotation);
  body.axes = axes_of(body.rotation);
  body.centre = pose.position;
  body.in_bullet->setWorldTransform(place(body, body.axes, body.centre));
  body.swept = body.solid.rough_extent(place(body));
  set_box(body);
  wake_around(body);
}

/// Whether the two bodies never collide: joined, two joints apart by way of a moving body, or
/// separated for good.
bool World::passes(Body& a, const Body& b) {
  if (a.joints.empty() && a.passes.empty()) return false;
  if (std::find(a.passes.begin(), a.passes.end(), &b) != a.passes.end()) return true;
  if (!a.near_is_known) {
    a.near.clear();
    for (const RigidJoint* joint : a.joints) {
      const Body& other = joint->a == &a ? *joint->b : *joint->a;
      a.near.push_back(&other);
      if (!other.moves) continue;
      for (const RigidJoint* next : other.joints) {
        const Body* second = next->a == &other ? next->b : next->a;
        if (second->moves) a.near.push_back(second);
      }
    }
    std::sort(a.near.begin(), a.near.end());
    a.near_is_known = true;
  }
  return std::binary_search(a.near.begin(), a.near.end(), &b);
}

void World::wake_around(Body& body) {
  if (asleep_.empty()) return;
  WorldBox box = body.solid.extent(place(body));
  box.grow(kNeighbour);
  find_near(box);
  for (Body* other : std::vector<Body*>(found_)) {
    if (other == &body || !other->moves || other->awake) continue;
    touches_.clear();
    toucher.find(body.solid, place(body), other->solid, place(*other), kNeighbour, {}, touches_);
    if (touches_.empty()) continue;
    wake(*other);
  }
  std::sort(awake.begin(), awake.end(), by_rank);
}

/// What little it moved is lost to its support. The solver takes bodies without mass for fixed.
void World::put_to_sleep(Body& body) {
  work.contact += body.kinetic_energy();
  body.taken += body.kinetic_energy();
  reaction = reaction - body.mass * body.velocity;
  body.velocity = body.spin = {};
  body.awake = false;
  body.in_bullet->setMassProps(0, btVector3(0, 0, 0));
  body.swept = body.solid.rough_extent(place(body));
  set_box(body);
  body.slept = ++slept_;
  may_merge_ = true;
  asleep_.insert(std::upper_bound(asleep_.begin(), asleep_.end(), &body, by_rank), &body);
  resting_is_known_ = false;
}

/// What bodies that are about to fall asleep lie on. Those with joints hang on them as well: what
/// they press with is not known.
void World::note_bearings(std::span<const char> may_sleep) {
  bearings_.clear();
  const auto note = [&](Body& body, const Body& on, const Bearing& bearing) {
    if (!body.awake || may_sleep[body.slot] == 0 || !body.joints.empty()) return;
    bearings_.emplace_back(&body, bearing);
    bearings_.back().second.support.on = on.id;
  };
  for (const Link& link : links_) {
    if (may_sleep[slot_of(*link.a)] == 0 && may_sleep[slot_of(*link.b)] == 0) continue;
    for (std::uint32_t i = link.first; i < link.first + link.count; ++i) {
      const Meeting& m = task.meetings[i];
      if (!(m.gap < kTouch)) continue;
      const btManifoldPoint& p = *m.solved;
      const Vec3 force = (1 / dt_) * (p.m_appliedImpulse * m.normal +
                                      ours(p.m_lateralFrictionDir1 * p.m_appliedImpulseLateral1 +
                                           p.m_lateralFrictionDir2 * p.m_appliedImpulseLateral2));
      const Vec3 at = m.origin + m.point;
      note(*m.a, *m.b, {{kNoBody, link.part_b, at, {}}, -1.0 * force, m.normal});
      note(*m.b, *m.a, {{kNoBody, link.part_a, at, {}}, force, -1.0 * m.normal});
    }
  }
  std::stable_sort(bearings_.begin(), bearings_.end(),
                   [](const auto& x, const auto& y) { return x.first->slot < y.first->slot; });
  std::vector<Bearing> own;
  for (std::size_t begin = 0, end = 0; begin < bearings_.size(); begin = end) {
    own.clear();
    for (; end < bearings_.size() && bearings_[end].first == bearings_[begin].first; ++end)
      own.push_back(bearings_[end].second);
    bearings_[begin].first->supports = supports_of(own);
  }
}

/// Those that fell asleep in the last step had contacts in it.
const std::vector<RestingLoad>& World::resting() {
  if (std::exchange(resting_is_known_, true)) return resting_;
  std::vector<Body*> sleepers;
  for (Body* body : asleep_)
    if (body->slept <= slept_before_) sleepers.push_back(body);
  resting_ = resting_loads(sleepers, params.gravity, [&](BodyId id) { return find_body(id); });
  return resting_;
}

/// Keeps the bodies that may move within bounds.
void World::merge_resting() {
  const std::uint32_t live = moving_count - merged_count;
  if (params.max_bodies == 0 || live <= params.max_bodies) return;
  merged_count += static_cast<std::uint32_t>(
      merge(asleep_, live - params.max_bodies, [&](BodyId id) { return find_body(id); }));
}

void World::begin(Body& body) {
  body.velocity_before = body.velocity;
  body.spin_before = body.spin;
  body.contact_time = dt_ / 2;
  body.arrives = false;
  body.slot = 0;
  const Vec3 path = dt_ * body.velocity + (dt_ * dt_ / 2) * gravity;
  body.swept = body.solid.rough_extent(place(body));
  body.swept.grow(kTouch + sweep(body, dt_));
  const WorldBox here = body.swept;
  body.swept.add(here.low + path);
  body.swept.add(here.high + path);
  set_box(body);
}

void World::set_box(Body& body) {
  broadphase.setAabb(body.in_bullet->getBroadphaseHandle(), bullet(body.swept.low),
                     bullet(body.swept.high), getDispatcher());
}

void World::predictUnconstraintMotion(btScalar) {
  for (Body* one : awake) begin(*one);
}

/// Fills found_, in no order that matters.
void World::find_near(const WorldBox& box) {
  struct Collect final : btDbvt::ICollide {
    std::vector<Body*>* found = nullptr;
    void Process(const btDbvtNode* leaf) override {
      const auto* proxy = static_cast<const btDbvtProxy*>(leaf->data);
      const auto* object = static_cast<btCollisionObject*>(proxy->m_clientObject);
      found->push_back(static_cast<Body*>(object->getUserPointer()));
    }
  } collect;
  collect.found = &found_;
  found_.clear();
  const btDbvtVolume volume = btDbvtVolume::FromMM(bullet(box.low), bullet(box.high));
  for (const btDbvt& tree : broadphase.m_sets) {
    tree.collideTVNoStackAlloc(tree.m_root, volume, stack_, collect);
  }
}

bool are_exempt(const Body& a, const Body& b) {
  return (a.exempt_for > 0 || b.exempt_for > 0) && !(a.solid.radius() > 0) &&
         !(b.solid.radius() > 0);
}

/// Every pair once: by the body that comes first in the list of awake ones. Bodies that are woken
/// on the way join its end.
void World::performDiscreteCollisionDetection() {
  task.meetings.clear();
  old_links_.swap(links_);
  links_.clear();
  for (std::uint32_t i = 0; i < awake.size(); ++i) awake[i]->slot = i + 1;
  for (std::size_t i = 0; i < awake.size(); ++i) {
    Body& one = *awake[i];
    find_near(one.swept);
    for (Body* other : found_) {
      if (other == &one || (other->awake && other->slot < one.slot)) continue;
      if (are_exempt(one, *other) || passes(one, *other)) continue;
      if (overlap(one.swept, other->swept)) meet(one, *other);
    }
    Body& ground = *bodies[kGround];
    if (params.has_ground && one.swept.low.y <= params.ground_height && !passes(one, ground))
      meet(one, ground);
  }
  for (Body* one : awake) {
    one->slot = 0;
    one->exempt_for -= dt_;
  }
  std::sort(awake.begin(), awake.end(), by_rank);
  broadphase.m_sets[0].optimizeIncremental(1 + static_cast<int>(awake.size()) / 100);
}

void World::meet(Body& one, Body& other) {
  const bool first = ranks_before(one, other);
  Body& a = first ? one : other;
  Body& b = first ? other : one;
  const Vec3 relative = (a.awake ? a.velocity : Vec3{}) - (b.awake ? b.velocity : Vec3{});
  const double margin =
      kTouch + dt_ * (length(relative) + dt_ * length(gravity)) + sweep(a, dt_) + sweep(b, dt_);
  const std::size_t from = task.meetings.size();
  touches_.clear();
  toucher.find(a.solid, place(a), b.solid, place(b), margin, path_of(a, b), touches_);
  allow_overlaps(a, b, true);
  allow_overlaps(b, a, false);
  add_links(a, b);
  if (other.awake || !other.moves || other.is_merged) return;
  const bool wakes = std::any_of(task.meetings.begin() + from, task.meetings.end(), [&](auto& m) {
    return m.arrives || (m.gap < kTouch && !is_slow(one, kWakeShare));
  });
  if (!wakes) return;
  const std::size_t first_woken = awake.size();
  wake(other);
  for (std::size_t i = first_woken; i < awake.size(); ++i) {
    begin(*awake[i]);
    awake[i]->slot = static_cast<std::uint32_t>(i + 1);
  }
}

/// Not known if what is not a ball turns.
RelativePath World::path_of(const Body& a, const Body& b) const {
  const double turn =
      (a.solid.radius() > 0 ? 0 : sweep(a, dt_)) + (b.solid.radius() > 0 ? 0 : sweep(b, dt_));
  if (turn > kTouch) return {};
  const double share = (a.awake ? 1.0 : 0.0) - (b.awake ? 1.0 : 0.0);
  const Vec3 relative = (a.awake ? a.velocity : Vec3{}) - (b.awake ? b.velocity : Vec3{});
  return {relative, share * gravity, dt_};
}

/// A meeting for each of touches_, a link for each pair of parts.
void World::add_links(Body& a, Body& b) {
  const Vec3 origin = b.moves ? b.centre : a.centre;
  const PartTouch* last = nullptr;
  for (const PartTouch& touch : touches_) {
    if (last == nullptr || last->part_a != touch.part_a || last->part_b != touch.part_b) {
      Link link;
      link.a = &a;
      link.b = &b;
      link.part_a = touch.part_a;
      link.part_b = touch.part_b;
      link.first = static_cast<std::uint32_t>(task.meetings.size());
      links_.push_back(link);
    }
    ++links_.back().count;
    last = &touch;
    Meeting m;
    m.a = &a;
    m.b = &b;
    m.origin = origin;
    m.point = touch.point.at - origin;
    m.normal = touch.point.normal;
    m.gap = touch.point.gap;
    set_approach(m, gravity, dt_);
    deepest = std::max(deepest, -m.gap);
    task.meetings.push_back(m);
  }
}

/// The last step's point that a meeting continues, if any.
btManifoldPoint* World::remembered(const Link& link, const Meeting& m) const {
  const Vec3 at = keepers_point(link, m);
  const bool is_ball = link.a->solid.radius() > 0 || link.b->solid.radius() > 0;
  double least = is_ball ? BT_LARGE_FLOAT : kRecall * kRecall;
  btManifoldPoint* nearest = nullptr;
  for (int i = 0; i < link.manifold->getNumContacts(); ++i) {
    btManifoldPoint& old = link.manifold->getContactPoint(i);
    const double d = (old.m_localPointA - bullet(at)).length2();
    if (old.m_lifeTime > 0 && d < least) least = d, nearest = &old;
  }
  return nearest;
}

/// A contact that carried in the last step and overlaps does not arrive if its speed is what the
/// solver has not yet taken away.
void World::set_contact_times(const Link& link) {
  for (std::uint32_t i = link.first; i < link.first + link.count; ++i) {
    Meeting& m = task.meetings[i];
    set_approach(m, gravity, dt_);
    const btManifoldPoint* old = m.arrives && m.gap <= 0 ? remembered(link, m) : nullptr;
    const double news = old == nullptr ? m.closing : m.closing - old->m_prevRHS;
    m.arrives = m.arrives && news > kCreep;
    for (Body* body : {m.a, m.b}) {
      if (!body->awake) continue;
      body->slot = 1;
      if (!m.arrives || (body->arrives && body->contact_time <= m.arrival_time)) continue;
      body->arrives = true;
      body->contact_time = m.arrival_time;
    }
  }
}

/// Puts Bullet's copy where the impulses act, with the velocity it would have without them.
void World::place_for_impulses(Body& body) {
  drift_to_impulses(body, gravity);
  btRigidBody& rigid = *body.in_bullet;
  rigid.setWorldTransform(place(body, body.axes_then, body.centre + body.shift));
  rigid.updateInertiaTensor();
  rigid.setLinearVelocity(bullet(body.velocity_before + dt_ * gravity));
  rigid.setAngularVelocity(bullet(body.spin_then));
}

std::uint32_t World::find_root(std::uint32_t slot) {
  while (root_[slot] != slot) slot = root_[slot] = root_[root_[slot]];
  return slot;
}

void World::unite(const Body& a, const Body& b) {
  if (slot_of(a) == 0 || slot_of(b) == 0) return;
  const std::uint32_t p = find_root(a.slot), q = find_root(b.slot);
  root_[std::max(p, q)] = std::min(p, q);
}

/// Joined bodies take their impulses together, in the middle of the step.
void World::set_contact_times(const RigidJoint& joint) {
  for (Body* body : {joint.a, joint.b}) {
    if (!body->awake) continue;
    body->slot = 1;
    body->arrives = false;
    body->contact_time = dt_ / 2;
  }
}

/// Islands by union-find over the bodies in contact, then links in the order of solving.
void World::calculateSimulationIslands() {
  std::sort(links_.begin(), links_.end(), comes_before);
  take_manifolds();
  for (const Link& link : links_) set_contact_times(link);
  awake_joints_.clear();
  for (const auto& joint : joints) {
    if (!joint || !(joint->a->awake || joint->b->awake)) continue;
    set_contact_times(*joint);
    awake_joints_.push_back(joint.get());
  }
  in_contact_.assign(1, nullptr);
  for (Body* body : awake) {
    if (body->slot == 0) continue;
    body->slot = static_cast<std::uint32_t>(in_contact_.size());
    in_contact_.push_back(body);
    place_for_impulses(*body);
  }
  root_.resize(in_contact_.size());
  for (std::uint32_t i = 0; i < root_.size(); ++i) root_[i] = i;
  for (const Link& link : links_) unite(*link.a, *link.b);
  for (const RigidJoint* joint : awake_joints_) unite(*joint->a, *joint->b);
  const auto island_of = [&](const Body& a, const Body& b) {
    return find_root(std::max(slot_of(a), slot_of(b)));
  };
  for (Link& link : links_) link.island = island_of(*link.a, *link.b);
  for (RigidJoint* joint : awake_joints_) joint->island = island_of(*joint->a, *joint->b);
  std::stable_sort(links_.begin(), links_.end(),
                   [](const Link& x, const Link& y) { return x.island < y.island; });
  std::stable_sort(awake_joints_.begin(), awake_joints_.end(),
                   [](const auto* x, const auto* y) { return x->island < y->island; });
}

/// Hands the manifolds of the last step to the links that are still there; the others are freed.
void World::take_manifolds() {
  std::sort(old_links_.begin(), old_links_.end(), comes_before);
  auto old = old_links_.begin();
  for (Link& link : links_) {
    while (old != old_links_.end() && comes_before(*old, link)) {
      getDispatcher()->releaseManifold((old++)->manifold);
    }
    if (old != old_links_.end() && !comes_before(link, *old)) {
      link.manifold = (old++)->manifold;
    } else {
      link.manifold =
          getDispatcher()->getNewManifold(link.a->in_bullet.get(), link.b->in_bullet.get());
    }
  }
  while (old != old_links_.end()) getDispatcher()->releaseManifold((old++)->manifold);
  old_links_.clear();
}

void World::fill(const Link& link) {
  std::array<btManifoldPoint, MANIFOLD_CACHE_SIZE> points;
  for (std::uint32_t i = 0; i < link.count; ++i) {
    Meeting& m = task.meetings[link.first + i];
    btManifoldPoint& point = points[i];
    const btVector3 local = bullet(keepers_point(link, m));
    point = btManifoldPoint(local, local, bullet(m.normal), 0);  // the default leaves much unset
    point.m_index0 = static_cast<int>(link.first + i);
    fill_point(m, point);
    if (!m.arrives) recall(link, m, point);
  }
  link.manifold->clearManifold();
  for (std::uint32_t i = 0; i < link.count; ++i) {
    const int at = link.manifold->addManifoldPoint(points[i]);
    task.meetings[link.first + i].solved = &link.manifold->getContactPoint(at);
  }
}

void World::fill_point(Meeting& m, btManifoldPoint& point) const {
  place_point(m, dt_);
  point.m_positionWorldOnA = point.m_positionWorldOnB =
      bullet(m.a->centre + (m.a->awake ? m.a->shift : Vec3{}) + m.arm_a);
  point.setDistance(-m.bound * dt_);
  point.m_combinedFriction = std::sqrt(m.a->surface.friction * m.b->surface.friction);
  const Vec3 other = std::fabs(m.normal.y) < 0.7 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  const Vec3 along = cross(other, m.normal);
  point.m_lateralFrictionDir1 = bullet((1 / length(along)) * along);
  point.m_lateralFrictionDir2 = bullet(m.normal).cross(point.m_lateralFrictionDir1);
  point.m_contactPointFlags = BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
}

/// Starts from the impulses of the last step.
void World::recall(const Link& link, Meeting& m, btManifoldPoint& point) const {
  btManifoldPoint* nearest = remembered(link, m);
  if (nearest == nullptr) return;
  const double ratio = std::min(1.0, dt_ / last_dt_);
  const btVector3 friction = nearest->m_lateralFrictionDir1 * nearest->m_appliedImpulseLateral1 +
                             nearest->m_lateralFrictionDir2 * nearest->m_appliedImpulseLateral2;
  point.m_appliedImpulse = ratio * nearest->m_appliedImpulse;
  point.m_appliedImpulseLateral1 = ratio * friction.dot(point.m_lateralFrictionDir1);
  point.m_appliedImpulseLateral2 = ratio * friction.dot(point.m_lateralFrictionDir2);
  nearest->m_lifeTime = 0;  // used
  give(m, point);
}

/// If one of the bodies is hit in this step, the impulses of a lasting contact until then are those
/// of the last step; what they are from then on, the blow decides.
void World::give(Meeting& m, btManifoldPoint& point) const {
  double time = dt_;
  for (const Body* body : {m.a, m.b}) {
    if (body->awake && body->arrives) time = std::min(time, body->contact_time);
  }
  if (time == dt_) return;
  m.given = time / dt_ * std::exchange(point.m_appliedImpulse, 0);
  m.given_along = time / dt_ * std::exchange(point.m_appliedImpulseLateral1, 0);
  m.given_across = time / dt_ * std::exchange(point.m_appliedImpulseLateral2, 0);
}

void World::solveConstraints(btContactSolverInfo& info) {
  task.dt = dt_;
  std::size_t link = 0, joint = 0;
  while (link < links_.size() || joint < awake_joints_.size()) {
    const std::size_t first_link = link, first_joint = joint;
    std::uint32_t island = UINT32_MAX;
    if (link < links_.size()) island = links_[link].island;
    if (joint < awake_joints_.size()) island = std::min(island, awake_joints_[joint]->island);
    while (link < links_.size() && links_[link].island == island) ++link;
    while (joint < awake_joints_.size() && awake_joints_[joint]->island == island) ++joint;
    solve_island({links_.begin() + first_link, link - first_link},
                 {awake_joints_.begin() + first_joint, joint - first_joint}, info);
  }
  account();
}

void World::solve_island(std::span<const Link> links, std::span<RigidJoint* const> joined,
                         btContactSolverInfo& info) {
  solved_bodies_.clear();
  solved_manifolds_.clear();
  solved_joints_.clear();
  for (RigidJoint* joint : joined) {
    solved_joints_.push_back(joint->in_bullet.get());
    for (const Body* body : {joint->a, joint->b})
      if (body->awake) solved_bodies_.push_back(body->in_bullet.get());
  }
  for (const Link& link : links) {
    fill(link);
    solved_manifolds_.push_back(link.manifold);
    for (const Body* body : {link.a, link.b}) {
      if (body->awake) solved_bodies_.push_back(body->in_bullet.get());
    }
  }
  const auto slot = [](const btCollisionObject* object) {
    return static_cast<const Body*>(object->getUserPointer())->slot;
  };
  const auto by_slot = [&](auto* x, auto* y) { return slot(x) < slot(y); };
  std::sort(solved_bodies_.begin(), solved_bodies_.end(), by_slot);
  solved_bodies_.erase(std::unique(solved_bodies_.begin(), solved_bodies_.end()),
                       solved_bodies_.end());
  solver->solveGroup(solved_bodies_.data(), static_cast<int>(solved_bodies_.size()),
                     solved_manifolds_.data(), static_cast<int>(solved_manifolds_.size()),
                     solved_joints_.data(), static_cast<int>(solved_joints_.size()), info, nullptr,
                     getDispatcher());
  // What carries a building must not be scaled.
  if (joined.empty()) bound_pushes(links, keep_energy(links));
}

/// Nor do pushes give more than contacts took.
void World::bound_pushes(std::span<const Link> links, double taken) {
  for (const Link& link : links)
    for (std::uint32_t i = link.first; i < link.first + link.count; ++i)
      grant_overlap(task.meetings[i], gravity);
  pushed_.clear();
  for (const btCollisionObject* object : solved_bodies_)
    pushed_.push_back(static_cast<Body*>(object->getUserPointer()));
  sunder::bound_pushes(pushed_, taken, gravity);
}

/// Contacts only take energy: returns what. What a solver that was cut short adds nevertheless is
/// taken back by scaling all impulses of the island alike, which keeps momentum.
double World::keep_energy(std::span<const Link> links) {
  double linear = 0, square = 0;  // work of the impulses, scaled by s: linear s + square s²
  for (const btCollisionObject* object : solved_bodies_) {
    const Body& body = *static_cast<const Body*>(object->getUserPointer());
    const Vec3 before = body.velocity_before + body.contact_time * gravity;
    const Vec3 kick = body.velocity_after - (dt_ - body.contact_time) * gravity - before;
    const Vec3 turn = body.spin_after - body.spin_then;
    const Vec3 turning = body.angular_momentum(body.axes_then, turn);
    linear += body.mass * dot(kick, before) + dot(turning, body.spin_then);
    square += 0.5 * (body.mass * dot(kick, kick) + dot(turning, turn));
  }
  if (linear + square <= kEnergyRounding * (square - linear))
    return std::max(0.0, -(linear + square));
  const double share = linear < 0 ? -linear / square : 0;
  for (const btCollisionObject* object : solved_bodies_) {
    Body& body = *static_cast<Body*>(object->getUserPointer());
    const Vec3 none = body.velocity_before + dt_ * gravity;
    body.velocity_after = none + share * (body.velocity_after - none);
    body.spin_after = body.spin_then + share * (body.spin_after - body.spin_then);
  }
  for (const Link& link : links)
    for (std::uint32_t i = link.first; i < link.first + link.count; ++i) {
      Meeting& m = task.meetings[i];
      btManifoldPoint& p = *m.solved;
      p.m_appliedImpulse = share * (p.m_appliedImpulse + m.given) - m.given;
      p.m_appliedImpulseLateral1 =
          share * (p.m_appliedImpulseLateral1 + m.given_along) - m.given_along;
      p.m_appliedImpulseLateral2 =
          share * (p.m_appliedImpulseLateral2 + m.given_across) - m.given_across;
    }
  return 0;
}

/// Lists contacts and books the work of every impulse.
void World::account() {
  contacts.clear();
  for (const Link& link : links_) {
    for (std::uint32_t i = link.first; i < link.first + link.count; ++i)
      account(link, task.meetings[i]);
  }
  for (const RigidJoint* joint : awake_joints_) account(*joint);
  std::stable_sort(contacts.begin(), contacts.end(), [&](const Contact& x, const Contact& y) {
    if (x.a != y.a) return ranks_before(*bodies[x.a], *bodies[y.a]);
    return x.b != y.b && ranks_before(*bodies[x.b], *bodies[y.b]);
  });
}

/// Of a body's point just before and just after the impulses.
Vec3 World::mean_velocity(const Body& body, Vec3 arm) const {
  if (!body.awake) return {};
  const Vec3 v =
      body.velocity_before + body.velocity_after + (2 * body.contact_time - dt_) * gravity;
  return 0.5 * (v + cross(body.spin_then + body.spin_after, arm));
}

void World::account(const RigidJoint& joint) {
  const Body &a = *joint.a, &b = *joint.b;
  const Vec3 force = joint.axes * joint.force, torque = joint.axes * joint.torque;
  const Vec3 speed = mean_velocity(a, joint.arm_a) - mean_velocity(b, joint.arm_b);
  const auto spin = [](const Body& body) {
    return body.awake ? 0.5 * (body.spin_then + body.spin_after) : Vec3{};
  };
  work.joint -= dot(force, speed) + dot(torque, spin(a) - spin(b));
  if (!a.awake) reaction = reaction - force;
  if (!b.awake) reaction = reaction + force;
}

/// Work is impulse times the mean of the velocities just before and just after it.
void World::account(const Link& link, const Meeting& m) {
  btManifoldPoint& p = *m.solved;
  p.m_appliedImpulse += m.given;
  p.m_appliedImpulseLateral1 += m.given_along;
  p.m_appliedImpulseLateral2 += m.given_across;
  const Vec3 speed = mean_velocity(*m.a, m.arm_a) - mean_velocity(*m.b, m.arm_b);
  const Vec3 friction = ours(p.m_lateralFrictionDir1 * p.m_appliedImpulseLateral1 +
                             p.m_lateralFrictionDir2 * p.m_appliedImpulseLateral2);
  if (!(p.m_appliedImpulse > 0) && friction == Vec3{}) return;
  work.contact -= p.m_appliedImpulse * dot(m.normal, speed);
  work.friction -= dot(friction, speed);
  const Vec3 on_a = p.m_appliedImpulse * m.normal + friction;
  if (!m.a->awake) reaction = reaction - on_a;
  if (!m.b->awake) reaction = reaction + on_a;
  const double approach = m.arrives ? m.arrival_speed : std::max(0.0, m.closing + m.pull * dt_);
  contacts.push_back({m.a->id, m.b->id, m.origin + m.point, m.normal, p.m_appliedImpulse,
                      length(friction), approach, link.part_a, link.part_b, friction});
  p.m_lifeTime = 1;
  const auto after = [&](const Body& body, Vec3 arm) {
    return body.awake ? body.velocity_after + cross(body.spin_after, arm) : Vec3{};
  };
  p.m_prevRHS = -dot(m.normal, after(*m.a, m.arm_a) - after(*m.b, m.arm_b));  // still closing, m/s
  if (m.arrives) {  // says nothing about the next step
    p.m_appliedImpulse = p.m_appliedImpulseLateral1 = p.m_appliedImpulseLateral2 = 0;
  }
}

void World::integrateTransforms(btScalar) {
  for (Body* body : awake) {
    weight = weight + (dt_ * body->mass) * gravity;
    const Vec3 before = body->centre;
    const double lifted = advance(*body, gravity, dt_);
    (body->joints.empty() ? work.contact : work.joint) -= lifted;
    work.driven += body->mass * dot(gravity - Vec3{0, -params.gravity, 0}, body->centre - before);
    body->in_bullet->setWorldTransform(place(*body, body->axes, body->centre));
    body->is_new = false;
  }
}

/// A heap of many hardly ever lies still as a whole. There whoever has been still for twice as long
/// sleeps alone, from what is fixed upwards, if all that it touches is still too.
void World::pick_still(std::vector<char>& may_sleep) {
  std::vector<std::uint32_t> size(in_contact_.size(), 0);
  for (std::uint32_t slot = 1; slot < size.size(); ++slot) ++size[find_root(slot)];
  if (*std::max_element(size.begin(), size.end()) < kCrowd) return;
  std::vector<char> lies(size.size(), 0), is_restless(size.size(), 0);
  for (const Link& link : links_) {
    const std::uint32_t a = slot_of(*link.a), b = slot_of(*link.b);
    if (a != 0 && b != 0) {
      if (link.a->still_for < kSleepAfter) is_restless[b] = 1;
      if (link.b->still_for < kSleepAfter) is_restless[a] = 1;
      continue;
    }
    for (std::uint32_t i = link.first; i < link.first + link.count; ++i)
      if (task.meetings[i].gap < kTouch) lies[std::max(a, b)] = 1;
  }
  for (std::uint32_t slot = 1; slot < size.size(); ++slot) {
    const Body& body = *in_contact_[slot];
    if (size[find_root(slot)] >= kCrowd && lies[slot] != 0 && is_restless[slot] == 0 &&
        body.joints.empty() && body.still_for >= 2 * kSleepAfter)
      may_sleep[slot] = 1;
  }
}

/// Puts islands to sleep that lie on something and have been still for a while.
void World::updateActivationState(btScalar) {
  for (Body* body : awake) {
    const double share = body->joints.empty() ? 1 : kJointedShare;
    body->still_for = is_slow(*body, share) ? body->still_for + dt_ : 0;
  }
  if (!params.sleep) return;
  std::vector<char> may_sleep(in_contact_.size(), 0);
  for (const Link& link : links_) {
    if (link.a->awake && link.b->awake) continue;
    for (std::uint32_t i = link.first; i < link.first + link.count; ++i) {
      if (task.meetings[i].gap < kTouch) may_sleep[link.island] = 1;
    }
  }
  for (const RigidJoint* joint : awake_joints_) {
    if (!joint->a->awake || !joint->b->awake) may_sleep[joint->island] = 1;
  }
  for (std::uint32_t slot = 1; slot < in_contact_.size(); ++slot) {
    if (in_contact_[slot]->still_for < kSleepAfter) may_sleep[find_root(slot)] = 0;
  }
  for (std::uint32_t slot = 1; slot < in_contact_.size(); ++slot) {
    may_sleep[slot] = may_sleep[find_root(slot)];
  }
  pick_still(may_sleep);
  if (std::any_of(may_sleep.begin(), may_sleep.end(), [](char may) { return may != 0; })) {
    note_bearings(may_sleep);
    for (std::uint32_t slot = 1; slot < in_contact_.size(); ++slot) {
      if (may_sleep[slot] != 0) put_to_sleep(*in_contact_[slot]);
    }
    std::erase_if(awake, [](const Body* body) { return !body->awake; });
  }
  if (std::exchange(may_merge_, false)) merge_resting();
}

void World::step(double dt) {
  dt_ = dt;
  contacts.clear();
  reaction = weight = {};
  deepest = 0;
  work = {};
  if (slept_ != slept_before_) resting_is_known_ = false;
  slept_before_ = slept_;
  stepSimulation(dt, 0);
  last_dt_ = dt;
}

}  // namespace

struct RigidWorld::Impl {
  explicit Impl(const WorldParams& params) : world(params) {}
  World world;
};

RigidWorld::RigidWorld(const WorldParams& params) : impl_(std::make_unique<Impl>(params)) {}
RigidWorld::~RigidWorld() = default;

BodyId RigidWorld::add_body(const BodyParams& params, std::span<const Prism> parts) {
  const PrincipalAxes principal = principal_axes(params.inertia);
  Solid solid(parts, principal.axes, params.centroid);
  return impl_->world.insert(moving_body(params, principal, std::move(solid)));
}

BodyId RigidWorld::add_sphere(const BodyParams& params, double radius) {
  return impl_->world.insert(moving_body(params, principal_axes(params.inertia), Solid(radius)));
}

BodyId RigidWorld::add_static(const Pose& pose, std::span<const Prism> parts,
                              const Surface& surface, std::uint64_t order) {
  auto body = std::make_unique<Body>(Solid(parts, {}, {}));
  body->order = order;
  body->surface = surface;
  body->rotation = normalised(pose.rotation);
  body->axes = axes_of(body->rotation);
  body->centre = pose.position;
  return impl_->world.insert(std::move(body));
}

void RigidWorld::remove(BodyId id) {
  assert(id != kGround && "the ground stays");
  impl_->world.remove(impl_->world.body(id));
}

Pose RigidWorld::pose(BodyId id) const {
  const Body& body = impl_->world.body(id);
  return {body.centre - body.axes * body.centroid, body.rotation};
}

Vec3 RigidWorld::centre(BodyId id) const {
  return impl_->world.body(id).centre;
}
Vec3 RigidWorld::velocity(BodyId id) const {
  return impl_->world.body(id).velocity;
}
Vec3 RigidWorld::angular_velocity(BodyId id) const {
  return impl_->world.body(id).spin;
}

Vec3 RigidWorld::velocity_at(BodyId id, Vec3 point) const {
  const Body& body = impl_->world.body(id);
  return body.velocity + cross(body.spin, point - body.centre);
}

void RigidWorld::set_velocity(BodyId id, Vec3 linear, Vec3 angular) {
  Body& body = impl_->world.body(id);
  assert(body.moves && "only bodies have a velocity");
  wake(id);
  body.velocity = linear;
  body.spin = angular;
}

void RigidWorld::apply_impulse(BodyId id, Vec3 impulse, Vec3 point) {
  const Body& body = impl_->world.body(id);
  assert(body.moves && "only bodies take impulses");
  const Vec3 change = body.spin_at(body.axes, cross(point - body.centre, impulse));
  set_velocity(id, body.velocity + (1 / body.mass) * impulse, body.spin + change);
}

double RigidWorld::inverse_mass_at(BodyId id, Vec3 point, Vec3 direction) const {
  const Body& body = impl_->world.body(id);
  if (!body.moves) return 0;
  const Vec3 turn = into(body.axes, cross(point - body.centre, direction));
  return 1 / body.mass + dot(turn, body.inverse_inertia * turn);
}

bool RigidWorld::is_awake(BodyId id) const {
  return impl_->world.body(id).awake;
}
void RigidWorld::wake(BodyId id) {
  Body& body = impl_->world.body(id);
  impl_->world.wake_and_rank(body);
}

JointId RigidWorld::add_joint(const JointParams& params) {
  World& world = impl_->world;
  assert(params.a != kGround && params.a != params.b && "a body is joined to another or the world");
  return world.insert(
      std::make_unique<RigidJoint>(world.body(params.a), world.body(params.b), params));
}

void RigidWorld::remove_joint(JointId id) {
  impl_->world.remove(impl_->world.joint(id));
}

JointReaction RigidWorld::joint_reaction(JointId id) const {
  const RigidJoint& joint = impl_->world.joint(id);
  const double rate = joint.dt > 0 ? 1 / joint.dt : 0;
  return {rate * joint.force, rate * joint.torque, joint.gap()};
}

void RigidWorld::separate(BodyId first, BodyId second) {
  Body& a = impl_->world.body(first);
  Body& b = impl_->world.body(second);
  a.passes.push_back(&b);
  b.passes.push_back(&a);
}

void RigidWorld::accept_overlaps(BodyId id) {
  impl_->world.accept_overlaps(impl_->world.body(id));
}

void RigidWorld::move_static(BodyId id, const Pose& pose) {
  impl_->world.move_static(impl_->world.body(id), pose);
}

void RigidWorld::set_mass(BodyId id, double mass) {
  impl_->world.set_mass(impl_->world.body(id), mass);
}

void RigidWorld::set_gravity(Vec3 gravity) {
  impl_->world.gravity = impl_->world.task.gravity = gravity;
}

void RigidWorld::set_iterations(int iterations) {
  impl_->world.getSolverInfo().m_numIterations = iterations;
}

std::uint64_t RigidWorld::solver_fallbacks() const {
  return impl_->world.task.fallbacks;
}

double RigidWorld::slow_together(std::span<const BodyId> ids, double energy) {
  std::vector<Body*> bodies;
  for (const BodyId id : ids)
    if (Body* body = impl_->world.bodies[id].get(); body && body->awake) bodies.push_back(body);
  return approach_common_motion(bodies, energy);
}

void RigidWorld::spend(BodyId id, double energy) {
  if (Body* body = impl_->world.bodies[id].get(); body && body->moves) body->taken -= energy;
}

void RigidWorld::exempt(BodyId id, double seconds) {
  impl_->world.body(id).exempt_for = seconds;
}

RigidWorld::Bounds RigidWorld::bounds(BodyId id) const {
  assert(id != kGround && "the ground has no bounds");
  const Body& body = impl_->world.body(id);
  const WorldBox extent = body.solid.extent(place(body));
  return {extent.low, extent.high};
}

std::vector<BodyId> RigidWorld::awake() const {
  std::vector<BodyId> ids;
  ids.reserve(impl_->world.awake.size());
  for (const Body* body : impl_->world.awake) ids.push_back(body->id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

void RigidWorld::step(double dt) {
  assert(dt > 0 && "time goes forward");
  impl_->world.step(dt);
}

std::span<const Contact> RigidWorld::contacts() const {
  return impl_->world.contacts;
}
std::span<const RestingLoad> RigidWorld::resting() const {
  return impl_->world.resting();
}
std::uint32_t RigidWorld::merged_count() const {
  return impl_->world.merged_count;
}
Vec3 RigidWorld::reaction() const {
  return impl_->world.reaction;
}
Vec3 RigidWorld::weight() const {
  return impl_->world.weight;
}
double RigidWorld::overlap() const {
  return impl_->world.deepest;
}
StepWork RigidWorld::work() const {
  return impl_->world.work;
}

double RigidWorld::kinetic_energy() const {
  double sum = 0;
  for (const Body* body : impl_->world.awake) sum += body->kinetic_energy();
  return sum;
}

double RigidWorld::potential_energy() const {
  double sum = 0;
  for (const auto& body : impl_->world.bodies) {
    if (body && body->moves) sum += body->mass * impl_->world.params.gravity * body->centre.y;
  }
  return sum;
}

Vec3 RigidWorld::momentum() const {
  Vec3 sum;
  for (const Body* body : impl_->world.awake) sum = sum + body->mass * body->velocity;
  return sum;
}

Vec3 RigidWorld::angular_momentum(Vec3 about) const {
  Vec3 sum;
  for (const Body* b : impl_->world.awake) {
    sum = sum + b->angular_momentum(b->axes, b->spin) +
          b->mass * cross(b->centre - about, b->velocity);
  }
  return sum;
}

std::uint32_t RigidWorld::awake_count() const {
  return static_cast<std::uint32_t>(impl_->world.awake.size());
}

std::uint32_t RigidWorld::body_count() const {
  return impl_->world.moving_count;
}

}  // namespace sunder
