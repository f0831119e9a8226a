// SPDX-License-Identifier: GPL-3.0-or-later
// Velocities after joints broke. Let w be the velocities of the masses until then, and v' those of
// the nodes that carry them now, by shapes N'. Mass that is carried in another way joins its new
// carriers without bouncing back: M' v' = ∫ N'ᵀ w dm, the projection of w in the metric of mass. It
// keeps the momentum of every motion that the frame can have, and takes energy, never gives any.
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed;
constexpr double kSame = 1e-9;    // of momentum
constexpr double kLittle = 1e-9;  // of a line's inertia: it has none about itself

double product(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double reach_of(const FrameSolver::MassWay& way) {
  return std::sqrt((way.inertia.xx + way.inertia.yy + way.inertia.zz) / way.mass);
}

bool moves_alike(const FrameSolver::MassWay& a, const FrameSolver::MassWay& b) {
  const double scale = length(a.moved) + length(b.moved) +
                       (length(a.turned) + length(b.turned)) / std::max(reach_of(a), kSame);
  return length(a.moved - b.moved) <= kSame * scale &&
         length(a.turned - b.turned) <= kSame * scale * reach_of(a);
}

}  // namespace

std::vector<FrameLinks::End> FrameSolver::Impl::ends_at(std::uint32_t frame_node) const {
  std::vector<FrameLinks::End> ends;
  if (frame_node == kNoPart) return ends;
  for (const std::uint32_t end : links.ends_at(frame_node))
    ends.push_back(links.end(end / 2, static_cast<int>(end % 2)));
  return ends;
}

void FrameSolver::Impl::note_parted(std::uint32_t frame_node,
                                    const std::vector<FrameLinks::End>& were) {
  const std::vector<FrameLinks::End> now = ends_at(frame_node);
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i].node == were[i].node || now[i].node >= kFixed || were[i].node >= kFixed) continue;
    const std::array<std::uint32_t, 2> pair{were[i].node, now[i].node};
    if (std::ranges::find(parted, pair) == parted.end()) parted.push_back(pair);
  }
}

/// missing += mass × (the field's motion of the member's nodes, less theirs).
void FrameSolver::Impl::add_missing(std::uint32_t m, const Matrix12& mass, const RigidField& field,
                                    std::span<const double> v, std::span<double> missing) const {
  const Member& member = members[m];
  Twelve more = displacements_of(member, v);
  for (std::size_t end = 0; end < 2; ++end) {
    const Vec3 at = member.at(end == 0 ? 0 : member.response.length);
    const Vec3 moves = field.velocity + cross(field.spin, at - field.centre);
    const std::array<double, 6> rigid{moves.x,      moves.y,      moves.z,
                                      field.spin.x, field.spin.y, field.spin.z};
    for (std::size_t i = 0; i < 6; ++i) more[6 * end + i] = rigid[i] - more[6 * end + i];
  }
  for (std::size_t i = 0; i < 12; ++i) {
    if (member.node[i / 6] >= kFixed) continue;
    double sum = 0;
    for (std::size_t k = 0; k < 12; ++k) sum += mass.at[12 * i + k] * more[k];
    missing[6 * std::size_t{member.node[i / 6]} + i % 6] += sum;
  }
}

/// Of all that carries a part.
void FrameSolver::Impl::add_missing(std::uint32_t part, const RigidField& field,
                                    std::span<const double> v, std::span<double> missing) const {
  if (part < members.size()) {
    add_missing(part, mass_matrix(part, unbent(part), {}), field, v, missing);
    return;
  }
  const PlateSupport& plate = plates[part - frame.slab_part(0)];
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    const FrameJoint& joint = frame.joints[plate.joints[i]];
    if (plate.share[i] == 0 || !members[joint.b].present()) continue;
    const double mass = plate.share[i] * plate.mass;
    BeamElement line = unbent(joint.b);
    line.mass = line.polar = 0;
    if (plate.rest == PlateSupport::Rest::lines) {
      line.mass = mass / members[joint.b].response.length;
      add_missing(joint.b, mass_matrix(joint.b, line, {}), field, v, missing);
      continue;
    }
    const double at = dot(joint.point - members[joint.b].start, members[joint.b].response.axes.x);
    const PointMass point{plate.joints[i], std::clamp(at, 0.0, line.length), mass};
    add_missing(joint.b, mass_matrix(joint.b, line, {&point, 1}), field, v, missing);
  }
}

/// x += M⁻¹ left by conjugate gradients, scaled by the diagonal; what has no mass stays.
void FrameSolver::Impl::add_velocities(std::vector<double>& left, std::span<double> x) const {
  constexpr double kSmall = 1e-12;
  std::vector<double> diagonal(x.size(), 0), scaled(x.size()), way, image(x.size());
  for (std::size_t i = 0; i < 6 * std::size_t{links.node_count()}; ++i)
    diagonal[i] = masses->diagonal(static_cast<std::uint32_t>(i / 6))[7 * (i % 6)];
  for (const Tip& tip : tips)
    for (std::size_t i = 0; i < 6; ++i)
      diagonal[6 * std::size_t{tip_of(tip.member)} + i] = tip.mass[7 * i];
  const auto scale = [&] {
    for (std::size_t i = 0; i < x.size(); ++i)
      scaled[i] = diagonal[i] > 0 ? left[i] / diagonal[i] : 0;
    return product(left, scaled);
  };
  double size = scale();
  const double enough = kSmall * kSmall * size;
  way = scaled;
  for (std::size_t round = 0; round < x.size() && size > enough; ++round) {
    mass_times(way, image);
    const double step = size / product(way, image);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] += step * way[i];
      left[i] -= step * image[i];
    }
    const double next = scale();
    for (std::size_t i = 0; i < x.size(); ++i) way[i] = scaled[i] + next / size * way[i];
    size = next;
  }
}

void FrameSolver::Impl::keep_momentum(std::span<const std::uint32_t> parts,
                                      std::span<const MassWay> until, std::span<double> v) const {
  const std::vector<MassWay> now = mass_ways(v, {}, false, parts);
  std::vector<double> missing(v.size(), 0);
  for (std::size_t k = 0; k < now.size(); ++k) {
    const MassWay &was = until[k], &is = now[k];
    if (!(was.mass > 0 && is.mass > 0) || moves_alike(was, is)) continue;
    SymMat3 inertia = was.inertia;
    const double little = kLittle * (inertia.xx + inertia.yy + inertia.zz);
    inertia.xx += little, inertia.yy += little, inertia.zz += little;
    RigidField field{is.centre, (1 / was.mass) * was.moved, inverse(inertia) * was.turned};
    // Spread farther than before, its mass would turn with more energy.
    const double had = dot(field.spin, was.inertia * field.spin),
                 has = dot(field.spin, is.inertia * field.spin);
    if (has > had) field.spin = std::sqrt(had / has) * field.spin;
    add_missing(parts[k], field, v, missing);
  }
  add_velocities(missing, v);
}

void FrameSolver::keep_momentum(std::span<const std::uint32_t> parts,
                                std::span<const MassWay> before, std::span<double> v) const {
  impl_->keep_momentum(parts, before, v);
}

FrameSolver::Parted FrameSolver::take_parted() {
  part_motion(impl_->parted, impl_->u);
  return std::exchange(impl_->parted, {});
}

void FrameSolver::part_motion(const Parted& parted, std::span<double> motion) {
  for (const auto& [from, to] : parted)
    std::ranges::copy(motion.subspan(6 * std::size_t{from}, 6),
                      motion.begin() + 6 * static_cast<std::ptrdiff_t>(to));
}

}  // namespace sunder
