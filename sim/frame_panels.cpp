// SPDX-License-Identifier: GPL-3.0-or-later
// Slabs and walls that are elastic: elements of 12 freedoms between the nodes at their corners.
#include <algorithm>

#include "meshing/error.hpp"
#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed;
/// Corners whose blocks stand in one change of the factor; the first two also hold the diagonal.
constexpr std::array<std::array<std::size_t, 2>, 6> kPairs{
    {{0, 1}, {2, 3}, {1, 2}, {3, 0}, {0, 2}, {1, 3}}};

Twelve times(const Matrix12& matrix, const Twelve& v) {
  Twelve result{};
  for (std::size_t r = 0; r < 12; ++r)
    for (std::size_t c = 0; c < 12; ++c) result[r] += matrix.at[12 * r + c] * v[c];
  return result;
}

double product(const Twelve& a, const Twelve& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 12; ++i) sum += a[i] * b[i];
  return sum;
}

const std::array<std::uint32_t, 4>& corners_of(const Frame& frame, std::uint32_t part) {
  return part < frame.wall_part(0) ? frame.slabs[part - frame.slab_part(0)].nodes
                                   : frame.walls[part - frame.wall_part(0)].nodes;
}

/// What stands in the factor for a pair of corners.
BlockChange block_of(const Matrix12& matrix, const std::array<std::uint32_t, 4>& node,
                     std::size_t pair, double factor) {
  const auto [p, q] = kPairs[pair];
  const bool diagonal = pair < 2, first = node[p] < kFixed, second = node[q] < kFixed;
  const auto at = [&](std::size_t a, std::size_t b, int i, int j) {
    return factor * matrix(static_cast<int>(3 * a) + i, static_cast<int>(3 * b) + j);
  };
  BlockChange block{0xFFFFFFFFu, 0xFFFFFFFFu, {}};
  if (!(first && second) && !(diagonal && (first || second))) return block;
  block.a = node[first ? p : q];
  block.b = node[second ? q : p];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (diagonal) block.delta(i, j) = first ? at(p, p, i, j) : at(q, q, i, j);
      if (!first || !second) continue;
      if (diagonal) block.delta(6 + i, 6 + j) = at(q, q, i, j);
      block.delta(i, 6 + j) = at(p, q, i, j);
      block.delta(6 + i, j) = at(q, p, i, j);
    }
  return block;
}

}  // namespace

/// Pairs of nodes that elements couple.
void FrameSolver::Impl::add_panel_edges(FrameLinks::Edges& edges) const {
  for (const PanelElement& panel : params.panels) {
    const auto& nodes = panel.nodes;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = i + 1; k < 4; ++k) links.add_edges(nodes[i], nodes[k], edges);
  }
}

void FrameSolver::Impl::make_panels() {
  for (const PanelElement& element : params.panels) {
    if (element.part < frame.slab_part(0) || element.part >= frame.part_count())
      throw Error(ErrorCode::input, "part " + std::to_string(element.part) +
                                        " cannot be elastic between four nodes, slabs and walls "
                                        "can");
    panels.push_back({.element = element, .blocks = {}});
    panels.back().blocks.fill({kNone, kNone, {}});
    take_element(panels.back(), element);
  }
  std::ranges::sort(panels, {}, [](const Panel& p) { return p.element.part; });
}

void FrameSolver::Impl::take_element(Panel& panel, const PanelElement& element) const {
  if (!std::ranges::is_permutation(corners_of(frame, element.part), element.nodes))
    throw Error(ErrorCode::input, frame.part_name(element.part) +
                                      ": the nodes of its element are not those of its corners");
  panel.element = element;
  panel.pull = times(element.stiffness, element.at_rest);
  panel.is_new = true;
  place_edges(panel);
}

void FrameSolver::Impl::set_panels(std::span<const PanelElement> wanted) {
  for (const PanelElement& element : wanted) {
    const auto panel = std::ranges::lower_bound(panels, element.part, {},
                                                [](const Panel& p) { return p.element.part; });
    if (panel == panels.end() || panel->element.part != element.part)
      throw Error(ErrorCode::input, "part " + std::to_string(element.part) +
                                        " is none of the elements that the frame solver was made "
                                        "with");
    take_element(*panel, element);
  }
  if (!wanted.empty()) update({}, {});
}

/// The members along its edges, and what joins it to them.
void FrameSolver::Impl::place_edges(Panel& panel) const {
  const PlateSupport& plate = plates[panel.element.part - frame.slab_part(0)];
  panel.member.fill(kNone);
  panel.joint.fill(kNone);
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
}

/// Solver nodes of its corners, as the members along its edges have them.
void FrameSolver::Impl::place_corners(Panel& panel) const {
  panel.node.fill(kNone);
  bool holds = !gone[panel.element.part];
  const auto take = [&](std::size_t corner, std::uint32_t node) {
    holds &= panel.node[corner] == kNone || panel.node[corner] == node;
    panel.node[corner] = node;
  };
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t m = panel.member[k];
    if (m == kNone) continue;
    holds &= links.intact(panel.joint[k]) && members[m].role == Role::elastic &&
             links.end(m, 0).held && links.end(m, 1).held;
    const bool along = frame.members[m].from == panel.element.nodes[k];
    take(k, members[m].node[along ? 0 : 1]);
    take((k + 1) % 4, members[m].node[along ? 1 : 0]);
  }
  for (const std::uint32_t node : panel.node)
    holds &= node < links.node_count() || node == kFixed;
  panel.is_lost |= !holds;
}

void FrameSolver::Impl::renew_panels() {
  for (Panel& panel : panels) {
    if (panel.is_lost) continue;
    const std::array<std::uint32_t, 4> old = panel.node;
    place_corners(panel);
    if (!panel.is_lost && !panel.is_new && panel.node == old) continue;
    panel.is_new = false;
    for (std::size_t pair = 0; pair < kPairs.size(); ++pair) {
      BlockChange next{kNone, kNone, {}};
      if (!panel.is_lost)
        next = block_of(panel.element.stiffness, panel.node, pair, params.stiffness);
      set_in_factor(panel.blocks[pair], next);
    }
  }
}

/// Of its nodes, from where it is at rest if `from_rest`.
Twelve FrameSolver::Impl::motion_of(const Panel& panel, std::span<const double> motion,
                                    bool from_rest) const {
  Twelve result{};
  for (std::size_t i = 0; i < 12; ++i) {
    const std::uint32_t node = panel.node[i / 3];
    if (node < kFixed && !motion.empty()) result[i] = motion[6 * std::size_t{node} + i % 3];
    if (from_rest) result[i] -= panel.element.at_rest[i];
  }
  return result;
}

void FrameSolver::Impl::add_at_corners(const Panel& panel, const Twelve& force,
                                       std::span<double> result) {
  for (std::size_t i = 0; i < 12; ++i)
    if (panel.node[i / 3] < kFixed) result[6 * std::size_t{panel.node[i / 3]} + i % 3] += force[i];
}

/// result += the panels' stiffness × motion.
void FrameSolver::Impl::add_panels(std::span<const double> motion, std::span<double> result) const {
  for (const Panel& panel : panels)
    if (!panel.is_lost)
      add_at_corners(panel, times(panel.element.stiffness, motion_of(panel, motion, false)),
                     result);
}

/// result += what they put on nodes that stand where the frame was drawn.
void FrameSolver::Impl::add_panel_loads(std::span<double> result) const {
  for (const Panel& panel : panels)
    if (!panel.is_lost) add_at_corners(panel, panel.pull, result);
}

/// What panels store, less what their stiffness would if they were at rest where it was drawn.
double FrameSolver::Impl::strain_of_panels() const {
  double twice = 0;
  for (const Panel& panel : panels) {
    if (panel.is_lost) continue;
    const Twelve q = motion_of(panel, u, true), all = motion_of(panel, u, false);
    twice += product(q, times(panel.element.stiffness, q)) -
             product(all, times(panel.element.stiffness, all));
  }
  return twice / 2;
}

void FrameSolver::set_panels(std::span<const PanelElement> elements) {
  impl_->set_panels(elements);
}

std::optional<Twelve> FrameSolver::panel_motion(std::uint32_t part) const {
  const auto panel = std::ranges::lower_bound(impl_->panels, part, {},
                                              [](const Impl::Panel& p) { return p.element.part; });
  if (panel == impl_->panels.end() || panel->element.part != part || panel->is_lost) return {};
  return impl_->motion_of(*panel, impl_->u, true);
}

}  // namespace sunder
