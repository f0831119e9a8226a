// SPDX-License-Identifier: GPL-3.0-or-later
// What joints that break change in the model: the ends of members, who carries slabs and walls,
// what stands on the ground; and only that in the factor.
#include <algorithm>
#include <numeric>

#include "meshing/error.hpp"
#include "sim/frame_solver_impl.hpp"
#include "sim/principal_axes.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed;
constexpr double kNoResistance = 1e-9;  // least stiffness against rotation, by the largest

void sort_unique(std::vector<std::uint32_t>& numbers) {
  std::ranges::sort(numbers);
  const auto same = std::ranges::unique(numbers);
  numbers.erase(same.begin(), same.end());
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t node) {
  while (parent[node] != node) {
    parent[node] = parent[parent[node]];
    node = parent[node];
  }
  return node;
}

/// Diagonal block of a spring along x, y, z and about them.
BlockChange springs(std::uint32_t node, double along, double about) {
  BlockChange block{node, node, {}};
  for (int i = 0; i < 6; ++i) block.delta(i, i) = i < 3 ? along : about;
  return block;
}

}  // namespace

/// Weight of a plate on its carriers, added or (sign -1) taken off.
void FrameSolver::Impl::lay_plate(const PlateSupport& plate, double sign) {
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    if (plate.share[i] == 0) continue;
    const FrameJoint& joint = frame.joints[plate.joints[i]];
    Member& member = members[joint.b];
    const double mass = sign * plate.share[i] * plate.mass;
    if (plate.rest == PlateSupport::Rest::lines) {
      member.plate_mass += mass / member.response.length;
    } else if (sign > 0) {
      const double at = std::clamp(dot(joint.point - member.start, member.response.axes.x), 0.0,
                                   member.response.length);
      point_masses[joint.b].push_back({plate.joints[i], at, mass});
    } else {
      std::erase_if(point_masses[joint.b],
                    [&](const PointMass& p) { return p.joint == plate.joints[i]; });
    }
  }
}

void FrameSolver::Impl::renew_plate(std::uint32_t p) {
  PlateSupport& plate = plates[p];
  lay_plate(plate, -1);
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    const std::uint32_t j = plate.joints[i];
    const bool carries = !gone[plate.part] && links.intact(j);
    plate.carries[i] = carries && members[frame.joints[j].b].present() ? 1 : 0;
  }
  settle(frame, plate);
  lay_plate(plate, 1);
}

void FrameSolver::Impl::update(std::vector<std::uint32_t> touched,
                               std::vector<std::uint32_t> touched_plates) {
  unlay();
  sort_unique(touched);
  for (const std::uint32_t m : touched) {
    const bool was = members[m].present();
    renew(m);
    if (members[m].present() == was && diaphragms.empty()) continue;
    touched_plates.insert(touched_plates.end(), plates_on[m].begin(), plates_on[m].end());
  }
  sort_unique(touched_plates);
  for (const std::uint32_t p : touched_plates) {
    renew_plate(p);
    if (p < frame.slabs.size()) renew_diaphragm(p);
    if (params.mass == 0) continue;
    for (std::uint32_t i = 0; i < plates[p].joint_count; ++i)
      touched.push_back(frame.joints[plates[p].joints[i]].b);
  }
  sort_unique(touched);
  for (const std::uint32_t m : touched) renew_in_factor(m);
  renew_panels();
  find_pieces();
  for (const Restraint& restraint : held) {
    BlockChange block = restraint.block;
    set_in_factor(block, {kNone, kNone, {}});
  }
  held.clear();
  pin_pieces();
  if (any_hinge) restrain_rotations();
  refactor();
}

void FrameSolver::set_plate_mass(std::uint32_t part, double mass) {
  PlateSupport& plate = impl_->plates[part - impl_->frame.slab_part(0)];
  impl_->lay_plate(plate, -1);
  plate.mass = mass;
  impl_->lay_plate(plate, 1);
  impl_->unlay();
  if (impl_->params.mass == 0) return;
  std::vector<std::uint32_t> members;
  for (std::uint32_t i = 0; i < plate.joint_count; ++i)
    members.push_back(impl_->frame.joints[plate.joints[i]].b);
  impl_->update(std::move(members), {});
}

/// Joins solver nodes by elastic members; the ground is one past the last.
void FrameSolver::Impl::find_pieces() {
  const std::uint32_t ground = links.node_count();
  std::vector<std::uint32_t> parent(ground + 1);
  std::iota(parent.begin(), parent.end(), 0u);
  for (const Member& member : members) {
    if (member.role != Role::elastic || member.tip) continue;
    const std::uint32_t a = root_of(parent, std::min(member.node[0], ground));
    const std::uint32_t b = root_of(parent, std::min(member.node[1], ground));
    parent[std::min(a, b)] = std::max(a, b);
  }
  std::vector<std::uint8_t> in_use(ground, 0);
  for (const Member& member : members)
    for (const std::uint32_t node : member.node)
      if (member.present() && node < ground) in_use[node] = 1;
  std::vector<std::uint32_t> number(ground + 1, kNone);
  pieces.clear();
  idle.clear();
  piece_of_node.assign(ground, kNone);
  for (std::uint32_t n = 0; n < ground; ++n) {
    const std::uint32_t root = root_of(parent, n);
    if (root == root_of(parent, ground)) continue;
    if (!in_use[n]) {
      idle.push_back(n);
      continue;
    }
    if (number[root] == kNone) {
      number[root] = static_cast<std::uint32_t>(pieces.size());
      pieces.emplace_back().pin = n;
    }
    piece_of_node[n] = number[root];
  }
}

/// A free piece is held at one node, as is a node where nothing is left. With mass in the matrix
/// only what has none needs that.
void FrameSolver::Impl::pin_pieces() {
  std::vector<std::uint8_t> massive(links.node_count(), 0);
  if (params.mass != 0) {
    for (const BlockChange& block : in_factor)
      for (const std::uint32_t node : {block.a, block.b})
        if (node < kFixed) massive[node] = 1;
  }
  std::vector<std::uint32_t> wanted;
  for (const Piece& piece : pieces)
    if (!massive[piece.pin]) wanted.push_back(piece.pin);
  for (const std::uint32_t node : idle)
    if (!massive[node]) wanted.push_back(node);
  std::ranges::sort(wanted);
  // A spare node of a chain that parts may come to the ground: then its pin goes.
  const auto pin = [&](const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b,
                       double sign) {
    std::vector<std::uint32_t> only;
    std::ranges::set_difference(a, b, std::back_inserter(only));
    for (const std::uint32_t n : only) put(springs(n, sign * pin_stiffness, sign * pin_turn));
  };
  pin(pinned, wanted, -1);
  pin(wanted, pinned, 1);
  pinned = std::move(wanted);
}

/// Where only members that turn freely about the node are left, or the carrier is free to turn
/// about its own axis: nothing resists that rotation, and nothing drives it, so any spring does.
void FrameSolver::Impl::restrain_rotations() {
  const BlockChange none{kNone, kNone, {}};
  std::erase_if(rotations, [&](Restraint& restraint) {
    if (!to_restrain[restraint.node]) return false;
    set_in_factor(restraint.block, none);
    return true;
  });
  for (std::uint32_t n = 0; n < to_restrain.size(); ++n) {
    if (!to_restrain[n] || std::ranges::binary_search(pinned, n)) continue;
    double sum[3][3] = {};
    for (const std::uint32_t end : links.ends_at(links.frame_node(n))) {
      const Member& member = members[end / 2];
      if (member.role != Role::elastic || member.tip || member.node[end % 2] != n) continue;
      const int offset = 6 * static_cast<int>(end % 2) + 3;
      const Matrix12 stiffness = stiffness_of(elements[end / 2]);
      for (int i = 0; i < 9; ++i) sum[i / 3][i % 3] += stiffness(offset + i / 3, offset + i % 3);
    }
    const PrincipalAxes main =
        principal_axes({sum[0][0], sum[1][1], sum[2][2], sum[0][1], sum[0][2], sum[1][2]});
    BlockChange block = springs(n, 0, 0);
    bool loose = false;
    const std::pair<Vec3, double> axes[] = {{main.axes.x, main.moments.x},
                                            {main.axes.y, main.moments.y},
                                            {main.axes.z, main.moments.z}};
    for (const auto& [axis, stiffness] : axes) {
      if (stiffness > kNoResistance * pin_turn) continue;
      loose = true;
      const double part[3] = {axis.x, axis.y, axis.z};
      for (int i = 0; i < 9; ++i)
        block.delta(3 + i / 3, 3 + i % 3) += pin_turn * part[i / 3] * part[i % 3];
    }
    if (!loose) continue;
    Restraint& restraint = rotations.emplace_back(n, BlockChange{kNone, kNone, {}});
    set_in_factor(restraint.block, block);
  }
  std::ranges::fill(to_restrain, std::uint8_t{0});
}

/// Brings the factor up to date. What cannot carry is an error in the frame as given; later, of
/// what is left of it, it is held and told of.
void FrameSolver::Impl::refactor() {
  if (!factor) return;
  std::uint32_t failed = BlockFactor::kNoNode;
  if (!built) {
    failed = factor->factor(params.progress);
  } else if (!changes.empty()) {
    failed = factor->change(changes);
  }
  changes.clear();
  while (failed != BlockFactor::kNoNode) {
    const bool again =
        std::ranges::any_of(held, [&](const Restraint& r) { return r.node == failed; });
    if (again || (!built && !params.free)) {
      throw Error(ErrorCode::input,
                  "the frame is a mechanism: it moves without resistance at " + where(failed));
    }
    held.push_back({failed, springs(failed, pin_stiffness, pin_turn)});
    failed = factor->change({&held.back().block, 1});
  }
  built = true;
}

}  // namespace sunder
