// SPDX-License-Identifier: GPL-3.0-or-later
// Direct stiffness method (Przemieniecki 1968) on a factor that is brought up to date as joints
// break; free pieces by inertia relief.
#include "sim/frame_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "meshing/error.hpp"
#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed;

Vec3 three(std::span<const double> v, std::size_t first) {
  return {v[first], v[first + 1], v[first + 2]};
}

Twelve times(const Matrix12& matrix, const Twelve& v) {
  Twelve result{};
  for (std::size_t i = 0; i < 12; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < 12; ++j) sum += matrix.at[12 * i + j] * v[j];
    result[i] = sum;
  }
  return result;
}

double largest(std::span<const double> v) {
  double result = 0;
  for (const double value : v) result = std::max(result, std::fabs(value));
  return result;
}

/// f += the block × u, six or twelve numbers.
void add_product(const BlockChange& block, std::span<const double> u, std::span<double> f) {
  const std::size_t count = block.a == block.b ? 6 : 12;
  const std::array<std::size_t, 2> start{6 * std::size_t{block.a}, 6 * std::size_t{block.b}};
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < count; ++j)
      sum += block.delta.at[12 * i + j] * u[start[j / 6] + j % 6];
    f[start[i / 6] + i % 6] += sum;
  }
}

}  // namespace

FrameSolver::Impl::Impl(const Frame& frame_to_hold, const FrameSolverParams& parameters,
                        const Impl* like)
    : frame(frame_to_hold), params(parameters), links(frame_to_hold) {
  check();
  plates = plates_of(frame, params.wall_mass);
  if (params.free)
    for (PlateSupport& plate : plates) plate.on_ground = false;
  plates_on.resize(frame.members.size());
  for (std::uint32_t p = 0; p < plates.size(); ++p)
    for (std::uint32_t i = 0; i < plates[p].joint_count; ++i)
      plates_on[frame.joints[plates[p].joints[i]].b].push_back(p);
  gone.assign(frame.part_count(), 0);
  any_hinge = std::ranges::any_of(frame.joints, [&](const FrameJoint& joint) {
    return joint.node != kNoPart && !frame.classes[joint.joint_class].rigid;
  });
  make_members();
  make_diaphragms();
  make_panels();
  to_restrain.assign(links.node_count(), 1);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges = links.edges();
  std::vector<std::uint32_t> all_members(members.size()), all_plates(plates.size());
  for (std::uint32_t m = 0; m < members.size(); ++m) all_members[m] = m;
  for (std::uint32_t p = 0; p < plates.size(); ++p) all_plates[p] = p;
  if (!diaphragms.empty()) {
    for (const FrameSlab& slab : frame.slabs) links.add_edges(slab.nodes[0], slab.nodes[2], edges);
    for (const FrameSlab& slab : frame.slabs) links.add_edges(slab.nodes[1], slab.nodes[3], edges);
  }
  add_panel_edges(edges);
  if (links.node_count() > 0 && like != nullptr && like->factor) {
    factor.emplace(links.node_count(), edges, *like->factor);
  } else if (links.node_count() > 0) {
    factor.emplace(links.node_count(), edges);
  }
  if (params.mass != 0) make_masses(edges);
  update(std::move(all_members), std::move(all_plates));
  f.assign(6 * (links.node_count() + (params.tips ? members.size() : 0)), 0);
  u = f;
  forces.assign(members.size(), {});
  plate_loads.assign(frame.joints.size(), {});
}

void FrameSolver::Impl::make_masses(const FrameLinks::Edges& edges) {
  std::vector<std::uint32_t> places(links.node_count());
  std::iota(places.begin(), places.end(), 0u);
  masses.emplace(places, edges);
  in_mass.assign(members.size(), {kNone, kNone, {}});
}

Twelve FrameSolver::Impl::displacements_of(const Member& member,
                                           std::span<const double> motion) const {
  Twelve result{};
  for (std::size_t end = 0; end < 2; ++end) {
    if (member.node[end] >= kFixed) continue;
    for (std::size_t i = 0; i < 6; ++i)
      result[6 * end + i] = motion[6 * std::size_t{member.node[end]} + i];
  }
  return result;
}

/// Of the nodes on an elastic member that carries no load.
Twelve FrameSolver::Impl::end_force(std::uint32_t m, const Twelve& motion) const {
  Twelve result = end_forces(members[m].response, motion);
  if (axial_in_factor[m] != 0) {
    const Twelve more = times(geometric_stiffness_of(elements[m], axial_in_factor[m]), motion);
    for (std::size_t i = 0; i < 12; ++i) result[i] += more[i];
  }
  return result;
}

/// Shear of a diaphragm along its edges, from the stretch of its bars.
void FrameSolver::Impl::shear_diaphragm(std::uint32_t s) {
  const FrameSlab& slab = frame.slabs[s];
  Diaphragm& diaphragm = diaphragms[s];
  diaphragm.flow = 0;
  if (!diaphragm.active) return;
  std::array<double, 2> pull{};
  double diagonal = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint32_t a = slab.nodes[i], b = slab.nodes[i + 2];
    const Vec3 across = frame.nodes[b].position - frame.nodes[a].position;
    const double size = length(across);
    pull[i] = diaphragm.stiffness[i] * dot(displacement(b) - displacement(a), across) / size;
    diagonal += size / 2;
  }
  diaphragm.flow = (pull[0] - pull[1]) / diagonal;
}

/// What of it a slab's joint passes to its beam.
Vec3 FrameSolver::Impl::diaphragm_shear(std::uint32_t j) const {
  const std::uint32_t s = frame.joints[j].a - frame.slab_part(0);
  if (s >= diaphragms.size()) return {};
  const FrameSlab& slab = frame.slabs[s];
  const auto i =
      static_cast<std::size_t>(std::ranges::find(plates[s].joints, j) - plates[s].joints.begin());
  const Vec3 edge =
      frame.nodes[slab.nodes[(i + 1) % 4]].position - frame.nodes[slab.nodes[i]].position;
  return (i % 2 == 0 ? 1 : -1) * diaphragms[s].flow * edge;
}

/// result += what the bars of the diaphragms resist.
void FrameSolver::Impl::add_diaphragms(std::span<const double> motion,
                                       std::span<double> result) const {
  for (const Diaphragm& diaphragm : diaphragms)
    for (BlockChange bar : diaphragm.bars) {
      if (bar.a == kNone) continue;
      for (double& value : bar.delta.at) value /= params.stiffness;
      add_product(bar, motion, result);
    }
}

/// Forces of the members, and with them what resists the displacements.
void FrameSolver::Impl::recover() {
  stiff.assign(u.size(), 0);
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    const Member& member = members[m];
    forces[m] = fixed[m];
    if (member.role != Role::elastic) continue;
    const Twelve elastic = end_force(m, displacements_of(member, u));
    for (std::size_t i = 0; i < 12; ++i) {
      forces[m][i] += elastic[i];
      if (member.node[i / 6] < kFixed)
        stiff[6 * std::size_t{member.node[i / 6]} + i % 6] += elastic[i];
    }
  }
  add_diaphragms(u, stiff);
  add_panels(u, stiff);
  laid.carries = pieces.empty();
  turn_hinges();
  for (std::uint32_t s = 0; s < diaphragms.size(); ++s) shear_diaphragm(s);
}

Vec3 FrameSolver::Impl::displacement(std::uint32_t frame_node) const {
  const std::uint32_t node = links.moving_node(frame_node);
  return node < kFixed ? three(u, 6 * std::size_t{node}) : Vec3{};
}

/// Of an elastic member that of its stretch alone: loads between held ends pull as much as they
/// push.
double FrameSolver::Impl::axial(std::uint32_t m) const {
  const Vec3 x = members[m].response.axes.x;
  double sum = 0;
  for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
    Vec3 force = three(forces[m], 6 * end);
    if (members[m].role == Role::elastic) force = force - three(fixed[m], 6 * end);
    sum += (end == 0 ? -0.5 : 0.5) * dot(x, force);
  }
  return members[m].present() ? sum : 0;
}

/// f - K u, and its largest number.
double FrameSolver::Impl::rest_of(std::span<const double> motion) {
  rest.resize(f.size());
  factor->multiply(motion, rest);
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = f[i] - rest[i];
  return largest(rest);
}

/// u = K⁻¹ f, refined while that helps: pins and springs that hold mechanisms cost digits.
void FrameSolver::Impl::solve_refined() {
  constexpr int kMostRounds = 3;
  constexpr double kSmall = 1e-11;  // a sound building of 60 storeys is at 2e-12 at once
  if (!factor) return;
  factor->solve(f, u);
  const double small = std::max(kSmall * largest(f), factor->rounding_of(u));
  double left = rest_of(u);
  for (int round = 0; round < kMostRounds && left > small; ++round) {
    before = u;
    factor->correct(rest, u);
    const double now = rest_of(u);
    if (!(now < left)) {
      u.swap(before);
      return;
    }
    if (now > left / 2) return;
    left = now;
  }
}

/// Second order: the geometric stiffness follows the axial forces until they no longer change.
void FrameSolver::Impl::iterate_second_order() {
  constexpr int kMostRounds = 20;
  constexpr double kSettled = 1e-10;
  for (int round = 0; round < kMostRounds; ++round) {
    double largest_force = 0, largest_change = 0;
    for (std::uint32_t m = 0; m < members.size(); ++m) {
      if (members[m].role != Role::elastic) continue;
      const double now = axial(m);
      largest_force = std::max(largest_force, std::fabs(now));
      largest_change = std::max(largest_change, std::fabs(now - axial_in_factor[m]));
    }
    if (largest_change <= kSettled * largest_force || !factor) return;
    for (std::uint32_t m = 0; m < members.size(); ++m) {
      if (members[m].role != Role::elastic) continue;
      axial_in_factor[m] = axial(m);
      renew_in_factor(m);
    }
    const std::uint32_t failed = factor->change(changes);
    changes.clear();
    if (failed != BlockFactor::kNoNode) {
      std::ranges::fill(axial_in_factor, 0.0);
      for (std::uint32_t m = 0; m < members.size(); ++m) renew_in_factor(m);
      refactor();
      throw Error(ErrorCode::input, "the frame buckles under its loads, first at " + where(failed));
    }
    solve_refined();
    recover();
  }
  throw Error(ErrorCode::input,
              "the frame is so near buckling that its axial forces do not settle in 20 rounds");
}

FrameSolver::FrameSolver(const Frame& frame, const FrameSolverParams& params)
    : impl_(std::make_unique<Impl>(frame, params, nullptr)) {}
FrameSolver::FrameSolver(const Frame& frame, const FrameSolverParams& params,
                         const FrameSolver& like)
    : impl_(std::make_unique<Impl>(frame, params, like.impl_.get())) {}
FrameSolver::~FrameSolver() = default;

void FrameSolver::break_joints(std::span<const std::uint32_t> joints) {
  impl_->break_joints(joints);
}

void FrameSolver::Impl::break_joints(std::span<const std::uint32_t> joints) {
  std::vector<std::uint32_t> touched, touched_plates;
  for (const std::uint32_t j : joints) {
    if (!links.intact(j)) continue;
    const std::uint32_t node = frame.joints[j].node;
    const std::vector<FrameLinks::End> ends = ends_at(node);
    links.cut(j);
    if (node != kNoPart) {
      note_parted(node, ends);
      for (const std::uint32_t end : links.ends_at(node)) touched.push_back(end / 2);
    } else {
      touched_plates.push_back(frame.joints[j].a - frame.slab_part(0));
    }
  }
  update(std::move(touched), std::move(touched_plates));
}

void FrameSolver::remove_parts(std::span<const std::uint32_t> parts) {
  take_out({}, parts);
}

void FrameSolver::take_out(std::span<const std::uint32_t> also,
                           std::span<const std::uint32_t> parts) {
  std::vector<std::uint32_t> joints(also.begin(), also.end());
  for (const std::uint32_t part : parts) impl_->gone[part] = 1;
  for (std::uint32_t j = 0; j < impl_->frame.joints.size(); ++j) {
    const FrameJoint& joint = impl_->frame.joints[j];
    if (impl_->gone[joint.a] || (joint.b != kNoPart && impl_->gone[joint.b])) joints.push_back(j);
  }
  break_joints(joints);
}

std::vector<std::uint32_t> FrameSolver::loose_parts() const {
  std::vector<std::uint32_t> parts;
  for (std::uint32_t m = 0; m < impl_->members.size(); ++m)
    if (impl_->members[m].role == Impl::Role::loose) parts.push_back(m);
  for (const PlateSupport& plate : impl_->plates)
    if (plate.rest == PlateSupport::Rest::none && !impl_->gone[plate.part])
      parts.push_back(plate.part);
  return parts;
}

std::vector<std::uint32_t> FrameSolver::bridging_joints() const {
  std::vector<std::uint32_t> joints;
  if (impl_->pieces.empty()) return joints;
  const auto piece_at = [&](std::uint32_t j) {
    return impl_->piece_of(impl_->members[impl_->frame.joints[j].b]);
  };
  for (const PlateSupport& plate : impl_->plates) {
    std::vector<std::uint32_t> own;
    for (std::uint32_t i = 0; i < plate.joint_count; ++i)
      if (plate.carries[i]) own.push_back(plate.joints[i]);
    const bool is_on_one = std::ranges::all_of(
        own, [&](std::uint32_t j) { return piece_at(j) == piece_at(own.front()); });
    if (is_on_one && !plate.on_ground) continue;
    std::ranges::copy_if(own, std::back_inserter(joints),
                         [&](std::uint32_t j) { return piece_at(j) != Impl::kNone; });
  }
  std::ranges::sort(joints);
  return joints;
}

/// force += what it holds of the displacements.
void FrameSolver::Impl::add_spring(const Restraint& spring, std::span<double> force) const {
  add_product(spring.block, u, force);
}

std::vector<Mechanism> FrameSolver::mechanisms() const {
  std::vector<Mechanism> result;
  for (const Impl::Restraint& held : impl_->held)
    result.push_back({impl_->links.frame_node(held.node), impl_->where(held.node)});
  const double scale = largest(impl_->f);
  for (const Impl::Restraint& held : impl_->rotations) {
    std::vector<double> moment(impl_->f.size(), 0);
    add_product(held.block, impl_->u, moment);
    if (largest(moment) > 1e-6 * scale)
      result.push_back({impl_->links.frame_node(held.node), impl_->where(held.node)});
  }
  return result;
}

void FrameSolver::solve(const FrameLoads& loads) {
  impl_->collect(loads, impl_->f);
  impl_->add_panel_loads(impl_->f);
  impl_->solve_refined();
  impl_->recover();
  if (impl_->params.p_delta) impl_->iterate_second_order();
}

JointLoad FrameSolver::joint_load(std::uint32_t j) const {
  const FrameJoint& joint = impl_->frame.joints[j];
  if (!impl_->links.intact(j)) return {};
  if (joint.node == kNoPart) {
    const JointLoad& load = impl_->plate_loads[j];
    return {into(joint.axes, load.force + impl_->diaphragm_shear(j)),
            into(joint.axes, load.torque)};
  }
  const double side = joint.end_a == 1 ? 1 : -1;
  const JointLoad sum = impl_->through(j);
  return {side * into(joint.axes, sum.force), side * into(joint.axes, sum.torque)};
}

JointLoad FrameSolver::Impl::through(std::uint32_t j) {
  links.ends_beyond(j, ends_through);
  JointLoad sum;
  for (const std::uint32_t end : ends_through) {
    if (!members[end / 2].present()) continue;
    sum.force = sum.force + three(forces[end / 2], 6 * (end % 2));
    sum.torque = sum.torque + three(forces[end / 2], 6 * (end % 2) + 3);
  }
  return sum;
}

Vec3 FrameSolver::displacement(std::uint32_t node) const {
  return impl_->displacement(node);
}

Vec3 FrameSolver::rotation(std::uint32_t frame_node) const {
  const std::uint32_t node = impl_->links.moving_node(frame_node);
  return node < kFixed ? three(impl_->u, 6 * std::size_t{node} + 3) : Vec3{};
}

Vec3 FrameSolver::reaction(std::uint32_t joint) const {
  return impl_->through(joint).force;
}

Vec3 FrameSolver::reaction_moment(std::uint32_t joint) const {
  return impl_->through(joint).torque;
}

double FrameSolver::axial(std::uint32_t member) const {
  return impl_->axial(member);
}

double FrameSolver::residual() const {
  const double scale = largest(impl_->f);
  if (scale == 0 || !impl_->factor) return 0;
  std::vector<double> rest(impl_->f.size());
  impl_->factor->multiply(impl_->u, rest);
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= impl_->f[i];
  return largest(rest) / scale;
}

double FrameSolver::pin_force() const {
  double result = 0;
  for (const std::uint32_t node : impl_->pinned) {
    for (std::size_t i = 0; i < 6; ++i) {
      const double stiffness = i < 3 ? impl_->pin_stiffness : impl_->pin_turn;
      result = std::max(result, stiffness * std::fabs(impl_->u[6 * std::size_t{node} + i]));
    }
  }
  return result;
}

double FrameSolver::strain_energy() const {
  const std::vector<double>& u = impl_->u;
  std::vector<double> force(impl_->u.size());
  stiffness_times(u, force);
  double sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i) sum += force[i] * u[i];
  return sum / 2 + impl_->strain_of_hinges() + impl_->strain_of_panels();
}

FactorCounts FrameSolver::counts() const {
  return impl_->factor ? impl_->factor->counts() : FactorCounts{};
}

std::size_t FrameSolver::freedom(std::uint32_t frame_node) const {
  const std::uint32_t node = impl_->links.moving_node(frame_node);
  return node < kFixed ? 6 * std::size_t{node} : kHeld;
}

std::size_t FrameSolver::freedoms() const {
  return impl_->u.size();
}

std::span<const double> FrameSolver::displacements() const {
  return impl_->u;
}

void FrameSolver::set_displacements(std::span<const double> u, const FrameLoads& loads) {
  if (impl_->carries(u, loads)) return;
  impl_->collect(loads, impl_->f);
  impl_->add_panel_loads(impl_->f);
  std::ranges::copy(u, impl_->u.begin());
  impl_->recover();
}

void FrameSolver::load_vector(const FrameLoads& loads, std::span<double> f) const {
  if (impl_->pieces.empty()) {
    impl_->nodal_load(loads, f);
  } else {
    impl_->collect(loads, f);
  }
  impl_->add_panel_loads(f);
}

/// f = Σ of what `apply` makes of each member's displacements.
template <class Apply>
void FrameSolver::Impl::sum_members(std::span<const double> motion, std::span<double> result,
                                    const Apply& apply) const {
  std::ranges::fill(result, 0.0);
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    const Member& member = members[m];
    if (!member.present()) continue;
    const Twelve force = apply(m, displacements_of(member, motion));
    for (std::size_t i = 0; i < 12; ++i) {
      const std::uint32_t node = member.node[i / 6];
      if (node < kFixed) result[6 * std::size_t{node} + i % 6] += force[i];
    }
  }
}

void FrameSolver::stiffness_times(std::span<const double> u, std::span<double> f) const {
  if (impl_->laid.carries && std::ranges::equal(u, impl_->u)) {
    std::ranges::copy(impl_->stiff, f.begin());
    return;
  }
  impl_->sum_members(u, f, [&](std::uint32_t m, const Twelve& motion) {
    const bool elastic = impl_->members[m].role == Impl::Role::elastic;
    return elastic ? impl_->end_force(m, motion) : Twelve{};
  });
  impl_->add_diaphragms(u, f);
  impl_->add_panels(u, f);
}

void FrameSolver::mass_times(std::span<const double> a, std::span<double> f) const {
  impl_->mass_times(a, f);
}

void FrameSolver::Impl::mass_times(std::span<const double> a, std::span<double> force) const {
  if (masses) {
    const std::size_t count = 6 * std::size_t{links.node_count()};
    std::ranges::fill(force.subspan(count), 0.0);
    masses->multiply(a.first(count), force.first(count));
    add_mass_of_tips(a, force);
    return;
  }
  sum_members(a, force, [&](std::uint32_t m, const Twelve& motion) {
    return times(mass_matrix(m), motion);
  });
}

void FrameSolver::solve_system(std::span<const double> f, std::span<double> u) const {
  if (impl_->params.tips) return impl_->solve_with_tips(f, u);
  if (impl_->factor) impl_->factor->solve(f, u);
}

}  // namespace sunder
