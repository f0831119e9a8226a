// SPDX-License-Identifier: GPL-3.0-or-later
// Slabs that are elastic: elements of 24 freedoms between the members along their edges.
#include <algorithm>

#include "meshing/error.hpp"
#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed;
/// Corners whose blocks stand in one change of the factor; the first two also hold the diagonal.
constexpr std::array<std::array<std::size_t, 2>, 6> kPairs{
    {{0, 1}, {2, 3}, {1, 2}, {3, 0}, {0, 2}, {1, 3}}};

Vec3 three(const Twelve& v, std::size_t first) {
  return {v[first], v[first + 1], v[first + 2]};
}

bool bears(const PanelElement& element, std::size_t edge) {
  const auto some = [](double value) { return value != 0; };
  return std::ranges::any_of(element.edges[edge], some) ||
         std::ranges::any_of(element.load[edge], some);
}

double product(std::span<const double> row, const PanelFreedoms& v) {
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += row[i] * v[i];
  return sum;
}

PanelFreedoms times(const PanelMatrix& matrix, const PanelFreedoms& v) {
  PanelFreedoms result{};
  for (std::size_t r = 0; r < 24; ++r) result[r] = product({&matrix[24 * r], 24}, v);
  return result;
}

/// Edges sum to the symmetric matrix, to rounding of the sum alone.
void make_symmetric(PanelElement& element, const PanelMatrix& matrix) {
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const std::size_t before = (corner + 3) % 4;
    const bool first = bears(element, corner);
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t c = 0; c < 24; ++c) {
        double& of_first = element.edges[corner][24 * i + c];
        double& of_second = element.edges[before][24 * (6 + i) + c];
        const double whole = matrix[24 * (6 * corner + i) + c];
        (first ? of_first : of_second) = whole - (first ? of_second : of_first);
      }
  }
}

/// The loads of the edges at the corners.
PanelFreedoms load_of(const PanelElement& element) {
  PanelFreedoms sum{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < 12; ++i)
      sum[i < 6 ? 6 * k + i : 6 * ((k + 1) % 4) + i - 6] += element.load[k][i];
  return sum;
}

/// What stands in the factor for a pair of corners.
BlockChange block_of(const PanelMatrix& matrix, const std::array<std::uint32_t, 4>& node,
                     std::size_t pair, double factor) {
  const auto [p, q] = kPairs[pair];
  const bool diagonal = pair < 2, first = node[p] < kFixed, second = node[q] < kFixed;
  const auto at = [&](std::size_t a, std::size_t b, int i, int j) {
    return factor *
           matrix[24 * (6 * a + static_cast<std::size_t>(i)) + 6 * b + static_cast<std::size_t>(j)];
  };
  BlockChange block{0xFFFFFFFFu, 0xFFFFFFFFu, {}};
  if (!(first && second) && !(diagonal && (first || second))) return block;
  block.a = node[first ? p : q];
  block.b = node[second ? q : p];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      if (diagonal) block.delta(i, j) = first ? at(p, p, i, j) : at(q, q, i, j);
      if (!first || !second) continue;
      if (diagonal) block.delta(6 + i, 6 + j) = at(q, q, i, j);
      block.delta(i, 6 + j) = at(p, q, i, j);
      block.delta(6 + i, j) = at(q, p, i, j);
    }
  return block;
}

}  // namespace

void FrameSolver::Impl::set_panel(std::uint32_t part, const PanelElement& element) {
  const std::uint32_t plate = part - frame.slab_part(0);
  if (!params.panels || part < frame.slab_part(0) || part >= frame.wall_part(0) ||
      frame.slabs[plate].pattern == kNoPart)
    throw Error(ErrorCode::input, frame.part_name(part) +
                                      ": cannot become elastic, only a slab with a pattern can, in "
                                      "a frame solver that has room for panels");
  if (!std::ranges::is_permutation(frame.slabs[plate].nodes, element.nodes))
    throw Error(ErrorCode::input,
                frame.part_name(part) + ": the nodes of its element are not those of its corners");
  auto panel = std::ranges::lower_bound(panels, plate, {}, &Panel::plate);
  if (panel == panels.end() || panel->plate != plate) {
    panel = panels.insert(panel, Panel{.plate = plate, .element = {}, .blocks = {}});
    panel->blocks.fill({kNone, kNone, {}});
  }
  panel->element = element;
  panel->stiffness = stiffness_of(element);
  make_symmetric(panel->element, panel->stiffness);
  place_edges(*panel);
  update({}, {});
}

void FrameSolver::Impl::clear_panel(std::uint32_t part) {
  const auto panel = std::ranges::find(panels, part - frame.slab_part(0), &Panel::plate);
  if (panel == panels.end()) return;
  panel->element.edges = {};
  panel->element.load = {};
  panel->stiffness = {};
  update({}, {});
  panels.erase(panel);
}

/// The members along its edges, and where these are hinged.
void FrameSolver::Impl::place_edges(Panel& panel) const {
  const PlateSupport& plate = plates[panel.plate];
  panel.member.fill(kNone);
  panel.joint.fill(kNone);
  panel.hinge = {{{kNone, kNone}, {kNone, kNone}, {kNone, kNone}, {kNone, kNone}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t from = panel.element.nodes[k], to = panel.element.nodes[(k + 1) % 4];
    for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
      const std::uint32_t m = frame.joints[plate.joints[i]].b;
      const FrameMember& member = frame.members[m];
      if (!(member.from == from && member.to == to) && !(member.from == to && member.to == from))
        continue;
      panel.member[k] = m;
      panel.joint[k] = plate.joints[i];
    }
  }
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const FrameJoint& joint = frame.joints[j];
    if (joint.node == kNoPart || frame.classes[joint.joint_class].rigid) continue;
    for (std::size_t k = 0; k < 4; ++k)
      if (panel.member[k] == joint.a)
        panel.hinge[k][panel.element.nodes[k] == joint.node ? 0 : 1] = j;
  }
}

/// Solver nodes of its corners, as the members along its edges have them.
void FrameSolver::Impl::place_corners(Panel& panel) const {
  panel.node.fill(kNone);
  panel.active = !gone[plates[panel.plate].part];
  const auto take = [&](std::size_t corner, std::uint32_t node) {
    panel.active &= panel.node[corner] == kNone || panel.node[corner] == node;
    panel.node[corner] = node;
  };
  bool any = false;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!bears(panel.element, k)) continue;
    any = true;
    const std::size_t next = (k + 1) % 4;
    const std::uint32_t m = panel.member[k];
    if (m == kNone) {
      panel.active = false;
      continue;
    }
    panel.active &= links.intact(panel.joint[k]) && members[m].role == Role::elastic &&
                    links.end(m, 0).held && links.end(m, 1).held;
    const bool along = frame.members[m].from == panel.element.nodes[k];
    take(k, members[m].node[along ? 0 : 1]);
    take(next, members[m].node[along ? 1 : 0]);
  }
  panel.active &= any;
}

void FrameSolver::Impl::renew_panels() {
  for (Panel& panel : panels) {
    const std::array<std::uint32_t, 4> old = panel.node;
    place_corners(panel);
    for (std::size_t pair = 0; pair < kPairs.size(); ++pair) {
      BlockChange next{kNone, kNone, {}};
      if (panel.active) next = block_of(panel.stiffness, panel.node, pair, params.stiffness);
      set_in_factor(panel.blocks[pair], next);
    }
    for (const auto& nodes : {old, panel.node})
      for (const std::uint32_t node : nodes)
        if (node < kFixed) to_restrain[node] = 1;
  }
}

/// Motion of its corners from where it is at rest.
PanelFreedoms FrameSolver::Impl::strains_of(const Panel& panel,
                                            std::span<const double> motion) const {
  PanelFreedoms result{};
  for (std::size_t i = 0; i < 24; ++i) {
    const std::uint32_t node = panel.node[i / 6];
    if (node == kNone) continue;
    const double now = node < kFixed && !motion.empty() ? motion[6 * std::size_t{node} + i % 6] : 0;
    result[i] = now - panel.element.at_rest[i];
  }
  return result;
}

/// result += the panels' stiffness × motion.
void FrameSolver::Impl::add_panels(std::span<const double> motion, std::span<double> result) const {
  for (const Panel& panel : panels) {
    if (!panel.active) continue;
    PanelFreedoms moved{};
    for (std::size_t i = 0; i < 24; ++i)
      if (panel.node[i / 6] < kFixed) moved[i] = motion[6 * std::size_t{panel.node[i / 6]} + i % 6];
    const PanelFreedoms force = times(panel.stiffness, moved);
    for (std::size_t i = 0; i < 24; ++i)
      if (panel.node[i / 6] < kFixed)
        result[6 * std::size_t{panel.node[i / 6]} + i % 6] += force[i];
  }
}

/// result += what they put on nodes that stand where the frame was drawn.
void FrameSolver::Impl::add_panel_loads(std::span<double> result) const {
  for (const Panel& panel : panels) {
    if (!panel.active) continue;
    const PanelFreedoms force = times(panel.stiffness, strains_of(panel, {}));
    const PanelFreedoms load = load_of(panel.element);
    for (std::size_t i = 0; i < 24; ++i)
      if (panel.node[i / 6] < kFixed)
        result[6 * std::size_t{panel.node[i / 6]} + i % 6] -= force[i] + load[i];
  }
}

/// Their edges' forces pass through the ends of the members along them.
void FrameSolver::Impl::hang_panels() {
  on_edges.clear();
  if (panels.empty()) return;
  on_edges.assign(members.size(), {});
  for (Panel& panel : panels) {
    if (!panel.active) continue;
    const PanelFreedoms strains = strains_of(panel, u);
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < 12; ++i)
        panel.force[k][i] =
            panel.element.load[k][i] + product({&panel.element.edges[k][24 * i], 24}, strains);
      const std::uint32_t m = panel.member[k];
      if (m == kNone || !bears(panel.element, k)) continue;
      const bool along = frame.members[m].from == panel.element.nodes[k];
      for (std::size_t i = 0; i < 12; ++i) {
        std::uint32_t to = m;
        std::size_t end = along ? i / 6 : 1 - i / 6;
        const std::uint32_t hinge = panel.hinge[k][i / 6];
        if (i % 6 >= 3 && hinge != kNone && links.intact(hinge)) {
          to = frame.joints[hinge].b;
          end = frame.joints[hinge].end_b;
        }
        if (to < members.size()) on_edges[to][6 * end + i % 6] += panel.force[k][i];
      }
    }
  }
  for (std::size_t m = 0; m < members.size(); ++m)
    for (std::size_t i = 0; i < 12; ++i) forces[m][i] += on_edges[m][i];
}

/// Adds the stiffness against rotations of a node.
void FrameSolver::Impl::stiffen(std::uint32_t node, double (&sum)[3][3]) const {
  for (const Panel& panel : panels)
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if (!panel.active || panel.node[corner] != node) continue;
      for (std::size_t i = 0; i < 9; ++i)
        sum[i / 3][i % 3] +=
            panel.stiffness[24 * (6 * corner + 3 + i / 3) + 6 * corner + 3 + i % 3];
    }
}

/// Force and torque about the joint's point on the carrier of an edge, world.
JointLoad FrameSolver::Impl::panel_load(std::uint32_t j) const {
  JointLoad load;
  const FrameJoint& joint = frame.joints[j];
  const auto panel =
      std::ranges::lower_bound(panels, joint.a - frame.slab_part(0), {}, &Panel::plate);
  if (panel == panels.end() || frame.slab_part(panel->plate) != joint.a || !panel->active)
    return load;
  const auto k =
      static_cast<std::size_t>(std::ranges::find(panel->joint, j) - panel->joint.begin());
  if (k == 4 || !bears(panel->element, k)) return load;
  for (std::size_t end = 0; end < 2; ++end) {
    const Vec3 at = frame.nodes[panel->element.nodes[(k + end) % 4]].position;
    const Vec3 force = -1 * three(panel->force[k], 6 * end);
    load.force = load.force + force;
    load.torque =
        load.torque - three(panel->force[k], 6 * end + 3) + cross(at - joint.point, force);
  }
  return load;
}

/// What panels store, less what their stiffness would if they were at rest where it was drawn.
double FrameSolver::Impl::strain_of_panels() const {
  double energy = 0;
  for (const Panel& panel : panels) {
    if (!panel.active) continue;
    const PanelFreedoms strains = strains_of(panel, u), load = load_of(panel.element);
    const PanelFreedoms force = times(panel.stiffness, strains);
    PanelFreedoms moved{};
    for (std::size_t i = 0; i < 24; ++i)
      if (panel.node[i / 6] < kFixed) moved[i] = u[6 * std::size_t{panel.node[i / 6]} + i % 6];
    const PanelFreedoms all = times(panel.stiffness, moved);
    for (std::size_t i = 0; i < 24; ++i)
      energy += (force[i] / 2 + load[i]) * strains[i] - all[i] * moved[i] / 2;
  }
  return energy;
}

void FrameSolver::set_panel(std::uint32_t part, const PanelElement& element) {
  impl_->set_panel(part, element);
}

void FrameSolver::clear_panel(std::uint32_t part) {
  impl_->clear_panel(part);
}

Vec3 FrameSolver::panel_moment(std::uint32_t j) const {
  const FrameJoint& joint = impl_->frame.joints[j];
  if (impl_->on_edges.empty() || joint.node == kNoPart) return {};
  const Vec3 moment = three(impl_->on_edges[joint.a], 6 * std::size_t{joint.end_a} + 3);
  return (joint.end_a == 1 ? 1.0 : -1.0) * into(joint.axes, moment);
}

}  // namespace sunder
