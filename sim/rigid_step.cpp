// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the rigid world. Every body drifts freely to the moment its impulses act (the middle
// of the step; the moment of impact if something arrives in this step), takes them there, and
// drifts on: a leapfrog whose kick sits at the impact. So free flight is exact, angular momentum
// and energy are conserved to rounding in free collisions, and the work of every impulse is known.
#include "sim/rigid_step.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunder {
namespace {

constexpr double kTouch = 1e-3;     // m; solids nearer than this touch
constexpr double kSlack = 0.05;     // m, by which boxes in the tree of awake bodies are larger
constexpr double kCreep = 0.05;     // m/s; slower arrivals do not bounce
constexpr double kSlop = 1e-4;      // m of overlap that is left alone: contacts stay
constexpr double kPushShare = 0.2;  // of the rest that one step removes
constexpr double kPushSpeed = 1;    // m/s, at most
constexpr double kRecallDistance = 0.03;  // m, between a point and what it was a step ago
constexpr double kSleepSpeed = 0.05;      // m/s
constexpr double kSleepSpin = 0.1;        // rad/s
constexpr double kSleepAfter = 0.5;       // s
constexpr double kWakeShare = 0.4;        // of the sleeping speeds: a neighbour this fast wakes
constexpr double kMinRest = 0.05;         // of a step, at least, left after an impact for bounds

bool is_slow(const RigidBody& body, double share) {
  const double v = share * kSleepSpeed, w = share * kSleepSpin;
  return dot(body.velocity, body.velocity) < v * v && dot(body.spin, body.spin) < w * w;
}

Vec3 velocity_at_arm(const RigidBody& body, Vec3 arm) {
  return body.awake ? body.velocity_before + cross(body.spin_before, arm) : Vec3{};
}

/// How far a corner may go by rotation in a step.
double sweep_of(const RigidBody& body, double dt) {
  return body.awake ? std::min(length(body.spin) * dt, 2.0) * body.shape.reach : 0;
}

bool solved_before(const Meeting& m, const Meeting& n) {
  if (m.island != n.island) return m.island < n.island;
  if (m.a != n.a) return ranks_before(*m.a, *n.a);
  if (m.b != n.b) return ranks_before(*m.b, *n.b);
  return m.part_a != n.part_a ? m.part_a < n.part_a : m.part_b < n.part_b;
}

/// The one that keeps the memory of a pair, and the other.
RigidBody& keeper(const Meeting& m) {
  return m.b->moves ? *m.b : *m.a;
}
const RigidBody& partner(const Meeting& m) {
  return m.b->moves ? *m.a : *m.b;
}

Vec3 keepers_point(const Meeting& m) {
  const RigidBody& own = keeper(m);
  return into(own.axes, m.point + (m.origin - own.centre));
}

/// Spin that goes with an angular momentum.
Vec3 spin_at(const RigidBody& body, const Axes& axes, Vec3 angular_momentum) {
  return axes * (body.inverse_inertia * into(axes, angular_momentum));
}

}  // namespace

void RigidWorld::Impl::begin(RigidBody& body, double dt) {
  body.velocity_before = body.velocity;
  body.spin_before = body.spin;
  body.contact_time = dt / 2;
  body.arrives = false;
  body.slot = 0;
  for (Remembered& r : body.memory) r.used = false;
  const Vec3 path = dt * body.velocity + (dt * dt / 2) * gravity;
  Box3 box = grown(world_box(body.shape, body.place({})), kTouch + sweep_of(body, dt));
  box.low = box.low + Vec3{std::min(path.x, 0.0), std::min(path.y, 0.0), std::min(path.z, 0.0)};
  box.high = box.high + Vec3{std::max(path.x, 0.0), std::max(path.y, 0.0), std::max(path.z, 0.0)};
  body.swept = box;
  awake_tree.update(body.leaf, box, kSlack);
}

/// Every pair once: by the body that comes first in the list of awake ones. Bodies that are woken
/// on the way join its end.
void RigidWorld::Impl::find_meetings(double dt) {
  meetings.clear();
  for (RigidBody* one : awake) begin(*one, dt);
  for (std::uint32_t i = 0; i < awake.size(); ++i) awake[i]->slot = i + 1;
  for (std::size_t i = 0; i < awake.size(); ++i) {
    RigidBody& one = *awake[i];
    found.clear();
    awake_tree.find(one.swept, found);
    still_tree.find(one.swept, found);
    for (const std::uint32_t id : found) {
      RigidBody& other = *bodies[id];
      if (&other == &one || (other.awake && other.slot < one.slot)) continue;
      if (other.moves && !overlap(one.swept, other.swept)) continue;
      if ((one.exempt_for > 0 || other.exempt_for > 0) && !(one.shape.radius > 0) &&
          !(other.shape.radius > 0))
        continue;
      meet(one, other, dt);
    }
    if (world.has_ground && one.swept.low.y <= world.ground_height) meet(one, body(kGround), dt);
  }
  for (RigidBody* one : awake) one->slot = 0, one->exempt_for -= dt;
}

void RigidWorld::Impl::meet(RigidBody& one, RigidBody& other, double dt) {
  const bool first = ranks_before(one, other);
  RigidBody& a = first ? one : other;
  RigidBody& b = first ? other : one;
  const Vec3 origin = b.moves ? b.centre : a.centre;
  const Vec3 relative = (a.awake ? a.velocity : Vec3{}) - (b.awake ? b.velocity : Vec3{});
  const double margin =
      kTouch + dt * (length(relative) + dt * length(gravity)) + sweep_of(a, dt) + sweep_of(b, dt);
  touches.clear();
  touch_shapes(a.shape, a.place(origin), b.shape, b.place(origin), margin, scratch, touches);
  bool wakes = false;
  for (const PartTouch& t : touches) {
    Meeting m{.a = &a,
              .b = &b,
              .part_a = t.part_a,
              .part_b = t.part_b,
              .origin = origin,
              .point = t.touch.point,
              .normal = t.touch.normal,
              .owner = t.touch.owner,
              .gap = t.touch.gap};
    set_approach(m, dt);
    wakes |= m.arrives || (m.gap < kTouch && !is_slow(one, kWakeShare));
    meetings.push_back(m);
  }
  if (wakes && other.moves && !other.awake) {
    wake(other);
    begin(other, dt);
    other.slot = static_cast<std::uint32_t>(awake.size());
  }
}

void RigidWorld::Impl::set_approach(Meeting& m, double dt) const {
  const Vec3 arm_a = m.point + (m.origin - m.a->centre);
  const Vec3 arm_b = m.point + (m.origin - m.b->centre);
  m.closing = -dot(m.normal, velocity_at_arm(*m.a, arm_a) - velocity_at_arm(*m.b, arm_b));
  const double share = (m.a->awake ? 1.0 : 0.0) - (m.b->awake ? 1.0 : 0.0);
  m.pull = -share * dot(m.normal, gravity);
  m.arrives = false;
  double time = 0;
  if (m.gap > 0) {
    const double squared = m.closing * m.closing + 2 * m.pull * m.gap;
    const double sum = squared < 0 ? 0 : m.closing + std::sqrt(squared);
    if (!(sum > 0)) return;
    time = 2 * m.gap / sum;
  }
  const double speed = m.closing + m.pull * time;
  if (!(time < dt) || speed < kCreep + dt * length(gravity)) return;
  m.arrives = true;
  m.arrival_time = time;
  m.arrival_speed = speed;
}

void RigidWorld::Impl::set_contact_times(double dt) {
  for (Meeting& m : meetings) {
    set_approach(m, dt);
    for (RigidBody* body : {m.a, m.b}) {
      if (!body->awake) continue;
      body->slot = 1;
      if (!m.arrives || (body->arrives && body->contact_time <= m.arrival_time)) continue;
      body->arrives = true;
      body->contact_time = m.arrival_time;
    }
  }
}

void RigidWorld::Impl::build_table(double dt) {
  table.assign(1, {});
  in_table.assign(1, nullptr);
  for (RigidBody* body : awake) {
    if (body->slot == 0) continue;
    body->slot = static_cast<std::uint32_t>(table.size());
    in_table.push_back(body);
    const double t = body->contact_time;
    body->shift = t * body->velocity_before + (t * t / 2) * gravity;
    const Vec3 l = body->angular_momentum(body->axes, body->spin_before);
    body->rotation_then = spun(body->rotation, body->inverse_inertia, l, t);
    body->axes_then = axes_of(body->rotation_then);
    body->spin_then = spin_at(*body, body->axes_then, l);
    table.push_back({.velocity = body->velocity_before + dt * gravity,
                     .spin = body->spin_then,
                     .push = {},
                     .turn = {},
                     .inverse_mass = body->inverse_mass,
                     .inverse_inertia = rotated(body->axes_then, body->inverse_inertia)});
  }
}

std::uint32_t RigidWorld::Impl::find_root(std::uint32_t slot) {
  while (root[slot] != slot) slot = root[slot] = root[root[slot]];
  return slot;
}

void RigidWorld::Impl::find_islands() {
  root.resize(table.size());
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto slot_of = [](const RigidBody& body) { return body.awake ? body.slot : 0; };
  for (const Meeting& m : meetings) {
    const std::uint32_t a = slot_of(*m.a), b = slot_of(*m.b);
    if (a == 0 || b == 0) continue;
    const std::uint32_t p = find_root(a), q = find_root(b);
    root[std::max(p, q)] = std::min(p, q);
  }
  for (Meeting& m : meetings) m.island = find_root(std::max(slot_of(*m.a), slot_of(*m.b)));
  std::stable_sort(meetings.begin(), meetings.end(), solved_before);
}

void RigidWorld::Impl::build_point(Meeting& m, double dt) {
  // Both bodies' copies of the point, carried to where the impulses act, relative to m.origin.
  const auto carried = [&](const RigidBody& body) {
    if (!body.awake) return m.point;
    if (body.shape.radius > 0) return m.point + body.shift;  // a ball rolls over its contact
    const Vec3 from = body.centre - m.origin;
    return from + body.shift + body.axes_then * into(body.axes, m.point - from);
  };
  const auto centre_then = [&](const RigidBody& body) {
    return body.centre - m.origin + (body.awake ? body.shift : Vec3{});
  };
  const Vec3 on_a = carried(*m.a), on_b = carried(*m.b);
  m.gap_then = m.gap + dot(m.normal, on_a - on_b);
  Vec3 middle = 0.5 * (on_a + on_b);
  if (m.owner == Touch::Owner::a) middle = on_a;
  if (m.owner == Touch::Owner::b) middle = on_b;
  ContactPoint p;
  p.a = m.a->awake ? m.a->slot : 0;
  p.b = m.b->awake ? m.b->slot : 0;
  prepare(p, table, m.normal, middle - centre_then(*m.a), middle - centre_then(*m.b));
  p.friction = std::sqrt(m.a->surface.friction * m.b->surface.friction);
  if (m.gap > 0) {
    double rest = kMinRest * dt;
    if (p.a != 0) rest = std::max(rest, dt - m.a->contact_time);
    if (p.b != 0) rest = std::max(rest, dt - m.b->contact_time);
    p.bound = std::min(0.0, std::max(-m.gap_then / rest, -m.gap / dt));
  }
  if (!m.arrives) recall(m, p, dt);
  points.push_back(p);
}

/// Starts from the impulses of the last step.
void RigidWorld::Impl::recall(const Meeting& m, ContactPoint& p, double dt) const {
  const BodyId other = partner(m).id;
  const bool b_keeps = &keeper(m) == m.b;
  const Vec3 at = keepers_point(m);
  double least = keeper(m).shape.radius > 0 ? 1e300 : kRecallDistance * kRecallDistance;
  Remembered* nearest = nullptr;
  for (Remembered& r : keeper(m).memory) {
    if (r.other != other || r.used) continue;
    if (r.part_own != (b_keeps ? m.part_b : m.part_a)) continue;
    if (r.part_other != (b_keeps ? m.part_a : m.part_b)) continue;
    const Vec3 d = r.point - at;
    if (dot(d, d) < least) least = dot(d, d), nearest = &r;
  }
  if (nearest == nullptr) return;
  nearest->used = true;
  const double ratio = dt / last_dt;
  p.impulse = ratio * nearest->impulse;
  p.impulse_along = ratio * dot(nearest->friction, p.along.direction);
  p.impulse_across = ratio * dot(nearest->friction, p.across.direction);
  // What rests on something while something else arrives is carried until then as it was before.
  double time = dt;
  if (m.a->awake && m.a->arrives) time = std::min(time, m.a->contact_time);
  if (m.b->awake && m.b->arrives) time = std::min(time, m.b->contact_time);
  if (time == dt) return;
  p.given = time / dt * std::exchange(p.impulse, 0.0);
  p.given_along = time / dt * std::exchange(p.impulse_along, 0.0);
  p.given_across = time / dt * std::exchange(p.impulse_across, 0.0);
}

void RigidWorld::Impl::solve(double dt) {
  warm_start(points, table);
  for (std::size_t from = 0, to = 0; from < meetings.size(); from = to) {
    while (to < meetings.size() && meetings[to].island == meetings[from].island) ++to;
    const std::span group(meetings.begin() + from, to - from);
    const std::span of(points.begin() + from, to - from);
    solve_velocities(of, table, world.iterations);
    bounce(group, of, dt);
    remove_overlaps(group, of, dt);
  }
}

/// Restitution, after the solve without it: what arrived and got an impulse shall leave with e
/// times its arrival speed, less what gravity takes away until the end of the step.
void RigidWorld::Impl::bounce(std::span<const Meeting> group, std::span<ContactPoint> of,
                              double dt) {
  bool any = false;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const Meeting& m = group[i];
    if (!m.arrives || !(of[i].impulse > 0)) continue;
    const double e = std::sqrt(m.a->surface.restitution * m.b->surface.restitution);
    const double speed = e * m.arrival_speed - m.pull * (dt - m.arrival_time);
    if (speed <= of[i].bound) continue;
    of[i].bound = speed;
    any = true;
  }
  if (any) solve_velocities(of, table, world.iterations);
}

void RigidWorld::Impl::remove_overlaps(std::span<const Meeting> group, std::span<ContactPoint> of,
                                       double dt) {
  bool any = false;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const Meeting& m = group[i];
    const ContactRow& row = of[i].normal;
    double gap = m.gap_then;
    const auto drift = [&](const RigidBody& body, std::uint32_t slot, Vec3 arm) {
      const double rest = dt - body.contact_time;
      const Vec3 v = rest * table[slot].velocity - (rest * rest / 2) * gravity;
      return dot(row.direction, v) + rest * dot(arm, table[slot].spin);
    };
    if (of[i].a != 0) gap += drift(*m.a, of[i].a, row.arm_a);
    if (of[i].b != 0) gap -= drift(*m.b, of[i].b, row.arm_b);
    of[i].push_out = std::min(kPushShare * std::max(0.0, -gap - kSlop), kPushSpeed * dt);
    any |= of[i].push_out > 0;
  }
  if (any) solve_overlaps(of, table, std::max(4, world.iterations / 2));
}

/// Lists contacts and books the work of every impulse with the mean of the velocities just before
/// and just after it.
void RigidWorld::Impl::account(double dt) {
  contacts.clear();
  const auto mean_speed = [&](const RigidBody* body, Vec3 direction, Vec3 arm) {
    if (body == nullptr) return 0.0;
    const double t = body->contact_time;
    const SolverBody& after = table[body->slot];
    const Vec3 v = body->velocity_before + after.velocity + (2 * t - dt) * gravity;
    return (dot(direction, v) + dot(arm, body->spin_then + after.spin)) / 2;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactPoint& p = points[i];
    const Meeting& m = meetings[i];
    const auto speed = [&](const ContactRow& r) {
      return mean_speed(in_table[p.a], r.direction, r.arm_a) -
             mean_speed(in_table[p.b], r.direction, r.arm_b);
    };
    const double impulse = p.given + p.impulse;
    if (!(impulse > 0)) continue;
    const double along = p.given_along + p.impulse_along;
    const double across = p.given_across + p.impulse_across;
    work.contact -= impulse * speed(p.normal);
    work.friction -= along * speed(p.along) + across * speed(p.across);
    const Vec3 friction = along * p.along.direction + across * p.across.direction;
    const Vec3 on_a = impulse * m.normal + friction;
    if (p.a == 0) reaction = reaction - on_a;
    if (p.b == 0) reaction = reaction + on_a;
    const double approach = m.arrives ? m.arrival_speed : std::max(0.0, m.closing + m.pull * dt);
    contacts.push_back(
        {m.a->id, m.b->id, m.origin + m.point, m.normal, impulse, length(friction), approach});
  }
  std::stable_sort(contacts.begin(), contacts.end(), [&](const Contact& x, const Contact& y) {
    if (x.a != y.a) return ranks_before(*bodies[x.a], *bodies[y.a]);
    return x.b != y.b && ranks_before(*bodies[x.b], *bodies[y.b]);
  });
}

void RigidWorld::Impl::remember() {
  for (RigidBody* body : awake) body->memory.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactPoint& p = points[i];
    const Meeting& m = meetings[i];
    RigidBody& own = keeper(m);
    if (!own.awake || m.arrives || !(p.impulse > 0)) continue;
    const bool b_keeps = &own == m.b;
    own.memory.push_back({.other = partner(m).id,
                          .part_own = b_keeps ? m.part_b : m.part_a,
                          .part_other = b_keeps ? m.part_a : m.part_b,
                          .point = keepers_point(m),
                          .impulse = p.given + p.impulse,
                          .friction = (p.given_along + p.impulse_along) * p.along.direction +
                                      (p.given_across + p.impulse_across) * p.across.direction});
  }
}

void RigidWorld::Impl::advance(double dt) {
  for (RigidBody* body : awake) {
    const SolverBody& after = table[body->slot];
    const bool met = body->slot != 0;
    const double rest = met ? dt - body->contact_time : dt;
    const Axes& axes = met ? body->axes_then : body->axes;
    const Quaternion& rotation = met ? body->rotation_then : body->rotation;
    body->velocity = met ? after.velocity : body->velocity_before + dt * gravity;
    const Vec3 l = body->angular_momentum(axes, met ? after.spin : body->spin_before);
    const Vec3 before = met ? body->shift : Vec3{};
    body->centre = body->centre + before + rest * body->velocity - (rest * rest / 2) * gravity;
    body->rotation = spun(rotation, body->inverse_inertia, l, rest);
    body->axes = axes_of(body->rotation);
    body->spin = spin_at(*body, body->axes, l);
    if (!met || (after.push == Vec3{} && after.turn == Vec3{})) continue;
    body->centre = body->centre + after.push;
    const Vec3 spin = into(body->axes, body->spin);
    body->rotation = turned(body->rotation, after.turn);
    body->axes = axes_of(body->rotation);
    body->spin = body->axes * spin;  // turned along: pushing out adds no energy
  }
}

/// Puts islands to sleep that lie on something and have been still for a while.
void RigidWorld::Impl::settle(double dt) {
  for (RigidBody* body : awake) {
    body->still_for = is_slow(*body, 1) ? body->still_for + dt : 0;
  }
  if (!world.sleep) return;
  std::vector<char> may_sleep(table.size(), 0);
  for (const Meeting& m : meetings) {
    const bool lies = (!m.a->awake || !m.b->awake) && m.gap < kTouch;
    if (lies) may_sleep[m.island] = 1;
  }
  for (std::uint32_t slot = 1; slot < table.size(); ++slot) {
    if (in_table[slot]->still_for < kSleepAfter) may_sleep[find_root(slot)] = 0;
  }
  for (std::uint32_t slot = 1; slot < table.size(); ++slot) {
    if (may_sleep[find_root(slot)] != 0) put_to_sleep(*in_table[slot]);
  }
  std::erase_if(awake, [](const RigidBody* body) { return !body->awake; });
}

void RigidWorld::Impl::step(double dt) {
  contacts.clear();
  reaction = {};
  work = {};
  const auto by_rank = [](const RigidBody* a, const RigidBody* b) { return ranks_before(*a, *b); };
  std::sort(awake.begin(), awake.end(), by_rank);
  find_meetings(dt);
  std::sort(awake.begin(), awake.end(), by_rank);
  set_contact_times(dt);
  build_table(dt);
  find_islands();
  points.clear();
  for (Meeting& m : meetings) build_point(m, dt);
  solve(dt);
  account(dt);
  remember();
  advance(dt);
  settle(dt);
  last_dt = dt;
}

}  // namespace sunder
