// SPDX-License-Identifier: GPL-3.0-or-later
// Loads of the static solver: fixed-end forces of every member, then nodal forces. Mass is line
// mass on members (their own, slabs', walls') and the point masses of walls that hang; of a
// section's own inertia only that about the member's axis counts, without which a straight rod has
// none there. Weight and the inertia of free pieces (d'Alembert) act on just that, so that a free
// piece is balanced to rounding and its pin carries nothing.
#include <algorithm>
#include <cmath>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed;
const double kGauss = std::sqrt(0.6);  // outer points of Gauss's rule of three, weight 5/9
const double kGaussTwo = std::sqrt(1 / 3.0);

Vec3 three(const Twelve& v, std::size_t first) {
  return {v[first], v[first + 1], v[first + 2]};
}

void add_to(Twelve& v, std::size_t first, Vec3 value) {
  v[first] += value.x;
  v[first + 1] += value.y;
  v[first + 2] += value.z;
}

/// J += p x xᵀ.
void add_polar(SymMat3& inertia, double polar, Vec3 x) {
  inertia.xx += polar * x.x * x.x;
  inertia.yy += polar * x.y * x.y;
  inertia.zz += polar * x.z * x.z;
  inertia.xy += polar * x.x * x.y;
  inertia.xz += polar * x.x * x.z;
  inertia.yz += polar * x.y * x.z;
}

}  // namespace

void add_moment(SymMat3& inertia, double mass, Vec3 r) {
  inertia.xx += mass * (r.y * r.y + r.z * r.z);
  inertia.yy += mass * (r.x * r.x + r.z * r.z);
  inertia.zz += mass * (r.x * r.x + r.y * r.y);
  inertia.xy -= mass * r.x * r.y;
  inertia.xz -= mass * r.x * r.z;
  inertia.yz -= mass * r.y * r.z;
}

std::uint32_t FrameSolver::Impl::piece_of(const Member& member) const {
  if (member.role == Role::hanging || member.tip) {
    const std::uint32_t node = member.node[static_cast<std::size_t>(member.held_end)];
    return node < kFixed ? piece_of_node[node] : kNone;
  }
  for (const std::uint32_t node : member.node)
    if (node >= kFixed) return kNone;
  return piece_of_node[member.node[0]];
}

/// What holds the nodes of a member under a load.
Twelve FrameSolver::Impl::held_under(std::uint32_t m, const BeamLoad& load) const {
  const Member& member = members[m];
  if (member.role == Role::elastic) return fixed_end_of(unbent(m), load);
  const double length = member.response.length;
  const Vec3 x = member.response.axes.x;
  const double held_at_x = member.held_end == 0 ? 0 : length;
  Vec3 force = length * load.uniform;
  Vec3 moment = cross((length / 2 - held_at_x) * x, force);
  for (const BeamLoad::Point& point : load.points) {
    force = force + point.force;
    moment = moment + cross((point.at - held_at_x) * x, point.force) + point.moment;
  }
  const std::size_t first = 6 * static_cast<std::size_t>(member.held_end);
  Twelve by_nodes{};
  add_to(by_nodes, first, -1 * force);
  add_to(by_nodes, first + 3, -1 * moment);
  return by_nodes;
}

/// Anywhere near a member: at the nearest point of its axis, with the moment of the arm.
BeamLoad::Point FrameSolver::Impl::point_on(std::uint32_t m, Vec3 point, Vec3 force,
                                            Vec3 moment) const {
  const Member& member = members[m];
  const double at =
      std::clamp(dot(point - member.start, member.response.axes.x), 0.0, member.response.length);
  return {at, force, moment + cross(point - member.at(at), force)};
}

Twelve FrameSolver::Impl::held_at(std::uint32_t m, Vec3 point, Vec3 force, Vec3 moment) const {
  return held_under(m, {.uniform = {}, .points = {point_on(m, point, force, moment)}});
}

void FrameSolver::Impl::add_load(std::uint32_t m, const BeamLoad& load) {
  const Twelve by_nodes = held_under(m, load);
  for (std::size_t i = 0; i < 12; ++i) fixed[m][i] += by_nodes[i];
}

/// What of a contact a slab or wall passes to its carriers, by joint; world.
std::vector<std::pair<std::uint32_t, JointLoad>> FrameSolver::Impl::shares_of(
    std::uint32_t p, const FrameLoads::OnPart& contact) const {
  const PlateSupport& plate = plates[p];
  if (plate.rest == PlateSupport::Rest::none) return {};
  std::vector<Vec3> places;
  std::vector<double> weights;
  std::vector<std::pair<std::uint32_t, JointLoad>> shares;
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    if (plate.carries[i] == 0) continue;
    const FrameJoint& joint = frame.joints[plate.joints[i]];
    places.push_back(joint.point);
    weights.push_back(joint.share);
    shares.push_back({plate.joints[i], {}});
  }
  const SharedForce shared = share_force(places, contact.point, contact.force, weights);
  for (std::size_t i = 0; i < shares.size(); ++i)
    shares[i].second = {shared.force[i], weights[i] * shared.torque};
  return shares;
}

void FrameSolver::Impl::share_contact(std::uint32_t p, const FrameLoads::OnPart& contact) {
  for (const auto& [j, load] : shares_of(p, contact)) {
    const std::uint32_t m = frame.joints[j].b;
    if (members[m].present())
      contact_loads.members.emplace_back(
          m, held_at(m, frame.joints[j].point, load.force, load.torque));
    contact_loads.plates.emplace_back(j, load);
  }
}

/// Valid until the next call.
const FrameSolver::Impl::ContactLoads& FrameSolver::Impl::contacts_of(const FrameLoads& loads) {
  const std::uint32_t first_plate = frame.slab_part(0);
  contact_loads.members.clear();
  contact_loads.plates.clear();
  for (const FrameLoads::OnPart& contact : loads.contacts) {
    if (contact.part >= first_plate) {
      share_contact(contact.part - first_plate, contact);
    } else if (members[contact.part].present()) {
      contact_loads.members.emplace_back(contact.part,
                                         held_at(contact.part, contact.point, contact.force, {}));
    }
  }
  return contact_loads;
}

/// What varies along the member: exact fixed-end forces by Gauss's rules, of the linear load at two
/// of three points (the middle one has none), of the polar moments, constant, at two.
void FrameSolver::Impl::add_turning(std::uint32_t m, double line, const MassField& field) {
  const Member& member = members[m];
  const double half = member.response.length / 2;
  const Vec3 x = member.response.axes.x;
  const Vec3 slope =
      0.5 * (field.at(member.at(half + half * kGauss)) - field.at(member.at(half - half * kGauss)));
  const Vec3 end = line * half * 5 / 9 * slope;
  const Vec3 turn = -member.polar * half *
                    (dot(x, field.acceleration) * x + dot(x, field.spin) * cross(field.spin, x));
  add_load(m, {.uniform = {},
               .points = {{half * (1 - kGauss), -1 * end, {}},
                          {half * (1 + kGauss), end, {}},
                          {half * (1 - kGaussTwo), {}, turn},
                          {half * (1 + kGaussTwo), {}, turn}}});
}

double FrameSolver::Impl::line_mass(std::uint32_t m) const {
  return members[m].mass + members[m].plate_mass + (live_line.empty() ? 0 : live_line[m]);
}

/// All masses of a member in a field of acceleration.
void FrameSolver::Impl::add_field(std::uint32_t m, const MassField& field) {
  const Member& member = members[m];
  const double line = line_mass(m);
  const Vec3 load = line * field.at(member.at(member.response.length / 2));
  if (member.role == Role::elastic) {
    add_uniform(bent_of[m] == kNone ? member.response : bent[bent_of[m]].response, load, fixed[m]);
  } else {
    add_load(m, {.uniform = load, .points = {}});
  }
  if (field.turns()) add_turning(m, line, field);
  for (const PointMass& point : point_masses[m]) {
    const Vec3 at = frame.joints[point.joint].point;
    const Twelve by_nodes = held_at(m, at, point.mass * field.at(at), {});
    for (std::size_t i = 0; i < 12; ++i) fixed[m][i] += by_nodes[i];
  }
}

/// Mass, centre and inertia of the free pieces, from the masses as they load the members.
void FrameSolver::Impl::weigh_pieces() {
  const auto each_mass = [&](const auto& visit) {
    for (std::uint32_t m = 0; m < members.size(); ++m) {
      const Member& member = members[m];
      if (!member.present()) continue;
      const std::uint32_t piece = piece_of(member);
      if (piece == kNone) continue;
      const double length = member.response.length;
      const double line = line_mass(m);
      // Simpson's rule is exact for first and second moments.
      for (const int i : {0, 1, 2})
        visit(pieces[piece], line * length * (i == 1 ? 4 : 1) / 6, member.at(i * length / 2));
      for (const PointMass& p : point_masses[m])
        visit(pieces[piece], p.mass, frame.joints[p.joint].point);
      add_polar(pieces[piece].inertia, member.polar * length, member.response.axes.x);
    }
  };
  for (Piece& piece : pieces) piece = {.pin = piece.pin, .mass = 0, .centre = {}, .inertia = {}};
  each_mass([](Piece& piece, double mass, Vec3 at) {
    piece.mass += mass;
    piece.centre = piece.centre + mass * at;
  });
  for (Piece& piece : pieces) {
    if (piece.mass > 0) piece.centre = 1 / piece.mass * piece.centre;
    piece.inertia = {};
  }
  each_mass([](Piece& piece, double mass, Vec3 at) {
    add_moment(piece.inertia, mass, at - piece.centre);
  });
}

/// Inertia relief: the acceleration that the loads give each free piece, taken from its field.
void FrameSolver::Impl::relieve_pieces() {
  std::vector<Vec3> force(pieces.size()), moment(pieces.size());
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    if (!members[m].present()) continue;
    const std::uint32_t piece = piece_of(members[m]);
    if (piece == kNone) continue;
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
      const Vec3 at = members[m].at(end == 0 ? 0 : members[m].response.length);
      const Vec3 load = -1 * three(fixed[m], 6 * end);
      force[piece] = force[piece] + load;
      moment[piece] =
          moment[piece] - three(fixed[m], 6 * end + 3) + cross(at - pieces[piece].centre, load);
    }
  }
  std::vector<MassField> relief(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (!(pieces[p].mass > 0)) continue;
    relief[p].origin = pieces[p].centre;
    relief[p].value = -1 / pieces[p].mass * force[p];
    relief[p].acceleration = inverse(pieces[p].inertia) * moment[p];
    fields[p].value = fields[p].value + relief[p].value;
    fields[p].acceleration = relief[p].acceleration;
  }
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    if (!members[m].present()) continue;
    const std::uint32_t piece = piece_of(members[m]);
    if (piece != kNone && pieces[piece].mass > 0) add_field(m, relief[piece]);
  }
}

/// Of the weight that a joint of a slab or wall passes to its carrier.
Vec3 FrameSolver::Impl::plate_weight(const PlateSupport& plate, std::uint32_t i,
                                     const FrameLoads& loads) const {
  const std::size_t p = plate.part - frame.slab_part(0);
  const double live = p < loads.live.size() ? loads.live[p] : 0;
  const double mass = plate.mass + live * plate.area / kLoadGravity;
  const FrameJoint& joint = frame.joints[plate.joints[i]];
  const std::uint32_t piece = pieces.empty() ? kNone : piece_of(members[joint.b]);
  return plate.share[i] * mass * (piece == kNone ? loads.gravity : fields[piece].at(joint.point));
}

void FrameSolver::Impl::weigh_plates(const FrameLoads& loads) {
  plate_loads.assign(frame.joints.size(), {});
  for (const PlateSupport& plate : plates)
    for (std::uint32_t i = 0; i < plate.joint_count; ++i)
      if (plate.share[i] != 0) plate_loads[plate.joints[i]].force = plate_weight(plate, i, loads);
}

/// Added loads as mass on the carriers.
void FrameSolver::Impl::lay_live(const std::vector<double>& live) {
  live_line.clear();
  if (live.empty()) return;
  live_line.resize(members.size());
  for (std::size_t p = 0; p < frame.slabs.size() && p < live.size(); ++p)
    for (std::uint32_t i = 0; i < plates[p].joint_count; ++i) {
      const std::uint32_t m = frame.joints[plates[p].joints[i]].b;
      live_line[m] += plates[p].share[i] * live[p] * plates[p].area /
                      (kLoadGravity * members[m].response.length);
    }
}

/// -fixed, by nodes.
void FrameSolver::Impl::sum_at_nodes(std::span<double> result) const {
  std::ranges::fill(result, 0.0);
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    if (!members[m].present()) continue;
    for (std::size_t end = 0; end < 2; ++end) {
      const std::uint32_t node = members[m].node[end];
      if (node >= kFixed) continue;
      for (std::size_t i = 0; i < 6; ++i)
        result[6 * std::size_t{node} + i] -= fixed[m][6 * end + i];
    }
  }
}

/// `fixed`, `plate_loads` and the nodal forces of these loads.
void FrameSolver::Impl::collect(const FrameLoads& loads, std::span<double> result) {
  if (pieces.empty()) {
    lay(loads);
    nodal_load(loads, result);
    return;
  }
  unlay();
  laid.loads = loads;
  points_known = false;
  fixed.assign(members.size(), {});
  lay_live(loads.live);
  weigh_pieces();
  fields.assign(pieces.size() + 1, {{}, loads.gravity, {}, {}});
  for (std::size_t p = 0; p < pieces.size(); ++p) fields[p].origin = pieces[p].centre;
  for (const FrameLoads::Spin& spin : loads.spins) {
    if (spin.part >= members.size() || !members[spin.part].present()) continue;
    const std::uint32_t piece = piece_of(members[spin.part]);
    if (piece != kNone) fields[piece].spin = spin.angular_velocity;
  }
  const ContactLoads& contacts = contacts_of(loads);
  for (const auto& [m, held_nodes] : contacts.members)
    for (std::size_t i = 0; i < 12; ++i) fixed[m][i] += held_nodes[i];
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    if (!members[m].present()) continue;
    const std::uint32_t piece = piece_of(members[m]);
    add_field(m, piece == kNone ? fields.back() : fields[piece]);
  }
  relieve_pieces();
  weigh_plates(loads);
  for (const auto& [j, load] : contacts.plates) {
    plate_loads[j].force = plate_loads[j].force + load.force;
    plate_loads[j].torque = plate_loads[j].torque + load.torque;
  }
  load_hinges();
  sum_at_nodes(result);
}

}  // namespace sunder
