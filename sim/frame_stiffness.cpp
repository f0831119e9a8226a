// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of the static solver: one per member, two crossed bars per slab. A panel a × b × t under
// a shear strain γ stores ½ G t γ² a b; each of its diagonals, √(a² + b²) = L long, stretches by
// γ a b/L, so bars of stiffness k store k γ² a² b²/L² and k = G t L²/(2 a b).
#include <algorithm>
#include <cmath>
#include <sstream>

#include "meshing/error.hpp"
#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed, kFree = FrameLinks::kFree;

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::input, message);
}

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

/// A number that no section has by its own outline: most likely a slip of units.
void check_ratio(const Section& section, const char* what, double value, double outline,
                 double low) {
  if (value >= low * outline && value <= outline) return;
  refuse(text("section ", section.name, ": ", what, " = ", value, " does not fit its height ",
              section.height, " m and width ", section.width, " m; valid: ", low * outline, " to ",
              outline, ", SI units"));
}

void check_section(const Section& section) {
  const double h = section.height, b = section.shape == "chs" ? h : section.width;
  check_ratio(section, "area", section.area, 1.0001 * h * b, 1e-3);
  check_ratio(section, "iy", section.iy, section.area * h * h, 1e-4);
  check_ratio(section, "iz", section.iz, section.area * b * b, 1e-4);
  check_ratio(section, "it", section.it, section.area * (h * h + b * b), 1e-6);
}

void check_steel(const SteelGrade& steel) {
  if (!(steel.youngs_modulus >= 1e8 && steel.youngs_modulus <= 1e13)) {
    refuse(text("steel ", steel.name, ": youngs_modulus = ", steel.youngs_modulus,
                " Pa is outside [1e8, 1e13]"));
  }
}

double shear_modulus(double youngs_modulus, double poisson_ratio) {
  return youngs_modulus / (2 * (1 + poisson_ratio));
}

BeamElement element_of(const Frame& frame, const FrameMember& member, bool shear) {
  const Section& s = frame.sections[member.section];
  const SteelGrade& steel = frame.steels[member.steel];
  const double e = steel.youngs_modulus, g = shear_modulus(e, steel.poisson_ratio);
  BeamElement element;
  element.length = frame.length(member);
  element.axes = axes_of(frame, member);
  element.ea = e * s.area;
  element.eiy = e * s.iy;
  element.eiz = e * s.iz;
  element.gj = g * s.it;
  element.gay = shear ? g * s.avy : 0;
  element.gaz = shear ? g * s.avz : 0;
  element.mass = steel.density * s.area;
  element.polar = steel.density * (s.iy + s.iz);
  return element;
}

/// Displacements and rotations at the other end of a rigid member that its held end carries along.
Twelve carried(const Six& held, int held_end, Vec3 arm) {
  const Vec3 turn{held[3], held[4], held[5]}, shift = cross(turn, arm);
  const Six other{held[0] + shift.x, held[1] + shift.y, held[2] + shift.z,
                  held[3],           held[4],           held[5]};
  Twelve both;
  std::ranges::copy(held, both.begin() + 6 * held_end);
  std::ranges::copy(other, both.begin() + 6 * (1 - held_end));
  return both;
}

/// Rigid motion of a point of a member by that of its ends, mixed by the distance: linear, and
/// exact where both ends tell the same.
std::array<Twelve, 3> motion_at(const BeamElement& element, double along) {
  std::array<Twelve, 3> rows{};
  const double x = along / element.length;
  for (std::size_t end = 0; end < 2; ++end) {
    const double weight = end == 0 ? 1 - x : x;
    const Vec3 arm = (end == 0 ? along : along - element.length) * element.axes.x;
    const double cross_rows[3][3] = {{0, arm.z, -arm.y}, {-arm.z, 0, arm.x}, {arm.y, -arm.x, 0}};
    for (std::size_t i = 0; i < 3; ++i) {
      rows[i][6 * end + i] = weight;
      for (std::size_t j = 0; j < 3; ++j) rows[i][6 * end + 3 + j] = weight * cross_rows[i][j];
    }
  }
  return rows;
}

BlockChange bar_between(std::uint32_t a, std::uint32_t b, Vec3 along, double stiffness) {
  BlockChange bar{a, b, {}};
  const double d[3] = {along.x, along.y, along.z};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double value = stiffness * d[i] * d[j];
      bar.delta(i, j) = bar.delta(6 + i, 6 + j) = value;
      bar.delta(i, 6 + j) = bar.delta(6 + i, j) = -value;
    }
  }
  return bar;
}

/// A beam that divided does not any more.
bool joins(const FrameMember& member, std::uint32_t a, std::uint32_t b) {
  return (member.from == a && member.to == b) || (member.from == b && member.to == a);
}

/// Without the rows of ends that are no solver nodes.
BlockChange between(std::array<std::uint32_t, 2> node, const Matrix12& matrix) {
  const bool first = node[0] < kFixed, second = node[1] < kFixed;
  if (first && second) return {node[0], node[1], matrix};
  BlockChange change{kFree, kFree, {}};
  if (!first && !second) return change;
  const int offset = first ? 0 : 6;
  change.a = change.b = first ? node[0] : node[1];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) change.delta(i, j) = matrix(offset + i, offset + j);
  return change;
}

}  // namespace

void FrameSolver::Impl::check() const {
  if (params.slabs != "load" && params.slabs != "diaphragm") {
    refuse("slabs = " + params.slabs + " is not known; there are load, diaphragm");
  }
  for (const FrameMember& member : frame.members) {
    const double length = frame.length(member);
    if (length > 0) continue;
    refuse(text("member ", member.name, ": its length ", length, " m must be above 0"));
  }
  std::vector<std::uint8_t> used(frame.sections.size(), 0), made_of(frame.steels.size(), 0);
  for (const FrameMember& member : frame.members) used[member.section] = made_of[member.steel] = 1;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) check_section(frame.sections[i]);
  for (std::size_t i = 0; i < made_of.size(); ++i)
    if (made_of[i]) check_steel(frame.steels[i]);
}

void FrameSolver::Impl::make_members() {
  const std::size_t count = frame.members.size();
  members.resize(count);
  elements.resize(count);
  point_masses.resize(count);
  in_factor.assign(count, {kNone, kNone, {}});
  bent_of.assign(count, kNone);
  height_rows.resize(count);
  height_known.assign(count, 0);
  axial_in_factor.assign(count, 0);
  double stretch = 0, bend = 0;
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    Member& member = members[m];
    BeamElement& element = elements[m] = element_of(frame, frame.members[m], params.shear);
    member.start = frame.nodes[frame.members[m].from].position;
    member.response.axes = element.axes;
    member.response.length = element.length;
    member.mass = element.mass;
    member.polar = element.polar;
    stretch += element.ea / element.length;
    bend += 4 * std::min(element.eiy, element.eiz) / element.length;
  }
  pin_stiffness = stretch / static_cast<double>(members.size());
  pin_turn = bend / static_cast<double>(members.size());
}

void FrameSolver::Impl::make_diaphragms() {
  if (params.slabs != "diaphragm") return;
  diaphragms.resize(frame.slabs.size());
  for (std::uint32_t s = 0; s < frame.slabs.size(); ++s) {
    const FrameSlab& slab = frame.slabs[s];
    const Material& material = frame.materials[slab.material];
    if (!(material.youngs_modulus > 0)) {
      refuse("slab " + slab.name + ": its material " + material.name +
             " needs a youngs_modulus above 0 to act as a diaphragm");
    }
    const double g = shear_modulus(material.youngs_modulus, material.poisson_ratio);
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 across =
          frame.nodes[slab.nodes[i + 2]].position - frame.nodes[slab.nodes[i]].position;
      diaphragms[s].stiffness[i] = g * slab.thickness * dot(across, across) / (2 * plates[s].area);
    }
  }
}

FrameSolver::Impl::Role FrameSolver::Impl::role_of(std::uint32_t m, int& held_end) const {
  if (gone[m]) return Role::removed;
  const FrameLinks::End &a = links.end(m, 0), &b = links.end(m, 1);
  if (!a.held && !b.held) return Role::loose;
  if (!a.held || !b.held) {
    held_end = a.held ? 0 : 1;
    if (links.end(m, held_end).hinged) return Role::loose;
    if (links.end(m, 1 - held_end).node == kFree) return Role::hanging;
  }
  return Role::elastic;
}

void FrameSolver::Impl::renew(std::uint32_t m) {
  Member& member = members[m];
  height_known[m] = 0;
  const std::array<std::uint32_t, 2> was = member.node;
  const bool had_tip = member.tip;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint32_t node = links.end(m, static_cast<int>(i)).node;
    for (const std::uint32_t n : {member.node[i], node})
      if (n < links.node_count()) to_restrain[n] = 1;
    member.node[i] = node;
  }
  member.role = role_of(m, member.held_end);
  member.tip = params.tips && member.role == Role::hanging;
  if (member.tip) {
    const std::size_t free_end = 1 - static_cast<std::size_t>(member.held_end);
    member.role = Role::elastic;
    member.node[free_end] = tip_of(m);
    if (!had_tip) begin_tip(m, was[free_end]);
  } else if (had_tip) {
    std::erase_if(tips, [m](const Tip& tip) { return tip.member == m; });
  }
  if (member.role != Role::elastic) {
    bend(m);
    return;
  }
  BeamElement& element = elements[m];
  const Vec3 rigid{BeamElement::kRigid, BeamElement::kRigid, BeamElement::kRigid};
  element.spring_a = links.end(m, 0).hinged ? Vec3{} : rigid;
  element.spring_b = links.end(m, 1).hinged ? Vec3{} : rigid;
  member.response = response_of(element);
  bend(m);
}

Matrix12 FrameSolver::Impl::mass_matrix(std::uint32_t m) const {
  BeamElement element = unbent(m);
  element.mass += members[m].plate_mass;
  return mass_matrix(m, element, point_masses[m]);
}

/// Of what a member carries: the element's own mass and these points.
Matrix12 FrameSolver::Impl::mass_matrix(std::uint32_t m, const BeamElement& element,
                                        std::span<const PointMass> heavy) const {
  const Member& member = members[m];
  Matrix12 mass = mass_of(element);
  for (const PointMass& point : heavy) {
    const std::array<Twelve, 3> rows = motion_at(element, point.at);
    for (std::size_t i = 0; i < 144; ++i)
      for (const Twelve& row : rows) mass.at[i] += point.mass * row[i / 12] * row[i % 12];
  }
  if (member.role == Role::elastic) return mass;
  Matrix12 rigid;  // 6 × 6 of the held end, in its place
  const Vec3 arm = (member.held_end == 0 ? 1 : -1) * element.length * element.axes.x;
  std::array<Twelve, 6> modes;
  for (std::size_t i = 0; i < 6; ++i) {
    Six unit{};
    unit[i] = 1;
    modes[i] = carried(unit, member.held_end, arm);
  }
  for (int i = 0; i < 36; ++i) {
    const Twelve &a = modes[static_cast<std::size_t>(i / 6)],
                 &b = modes[static_cast<std::size_t>(i % 6)];
    double sum = 0;
    for (std::size_t k = 0; k < 144; ++k) sum += mass.at[k] * a[k / 12] * b[k % 12];
    rigid(6 * member.held_end + i / 6, 6 * member.held_end + i % 6) = sum;
  }
  return rigid;
}

/// To the factor at once while it is first filled, later with the other changes.
void FrameSolver::Impl::put(const BlockChange& change) {
  if (!factor) return;
  if (built) {
    changes.push_back(change);
  } else {
    factor->add(change);
  }
}

void FrameSolver::Impl::set_in_factor(BlockChange& now, const BlockChange& next) {
  if (now.a == next.a && now.b == next.b && now.delta.at == next.delta.at) return;
  BlockChange change = now;
  const bool same = now.a == next.a && now.b == next.b;
  for (std::size_t i = 0; i < 144; ++i)
    change.delta.at[i] = (same ? next.delta.at[i] : 0) - now.delta.at[i];
  if (now.a != kNone) put(change);
  if (next.a != kNone && !same) put(next);
  now = next;
}

void FrameSolver::Impl::set_mass(std::uint32_t m, const BlockChange& next) {
  BlockChange& now = in_mass[m];
  if (now.a == next.a && now.b == next.b && now.delta.at == next.delta.at) return;
  for (double& value : now.delta.at) value = -value;
  if (now.a < kFixed) masses->add(now);
  if (next.a < kFixed) masses->add(next);
  now = next;
}

void FrameSolver::Impl::renew_in_factor(std::uint32_t m) {
  Member& member = members[m];
  Matrix12 matrix;
  std::array<std::uint32_t, 2> node = member.node;
  if (member.role == Role::elastic) {
    matrix = stiffness_of(elements[m]);
    if (axial_in_factor[m] != 0) {
      const Matrix12 more = geometric_stiffness_of(elements[m], axial_in_factor[m]);
      for (std::size_t i = 0; i < 144; ++i) matrix.at[i] += more.at[i];
    }
    for (double& value : matrix.at) value *= params.stiffness;
  } else {
    axial_in_factor[m] = 0;
  }
  if (member.role != Role::elastic || member.tip)
    node[1 - static_cast<std::size_t>(member.held_end)] = kFree;
  const bool massive = params.mass != 0 && member.present();
  BlockChange own{kNone, kNone, {}};
  if (massive) {
    const Matrix12 its_mass = mass_matrix(m);
    for (std::size_t i = 0; i < 144; ++i) matrix.at[i] += params.mass * its_mass.at[i];
    own = between(node, its_mass);
    if (member.tip) matrix = condense_tip(m, matrix, its_mass);
  }
  if (masses) set_mass(m, own);
  const bool takes_part = member.role == Role::elastic || massive;
  set_in_factor(in_factor[m], takes_part ? between(node, matrix) : BlockChange{kNone, kNone, {}});
}

void FrameSolver::Impl::renew_diaphragm(std::uint32_t slab) {
  if (diaphragms.empty()) return;
  Diaphragm& diaphragm = diaphragms[slab];
  const FrameSlab& corners = frame.slabs[slab];
  std::array<std::uint32_t, 4> node{};
  diaphragm.active = true;
  for (std::size_t i = 0; i < 4; ++i) {
    if (plates[slab].joint_count < 4 || corners.beams[i] == kNoPart) {
      diaphragm.active = false;
      break;
    }
    const FrameMember& beam = frame.members[corners.beams[i]];
    const Member& member = members[corners.beams[i]];
    diaphragm.active &= plates[slab].carries[i] != 0 && member.role == Role::elastic &&
                        joins(beam, corners.nodes[i], corners.nodes[(i + 1) % 4]) &&
                        links.end(corners.beams[i], 0).held && links.end(corners.beams[i], 1).held;
    node[i] = member.node[beam.from == corners.nodes[i] ? 0 : 1];
  }
  for (std::size_t i = 0; i < 2; ++i) {
    BlockChange bar{kNone, kNone, {}};
    if (diaphragm.active) {
      const Vec3 across =
          frame.nodes[corners.nodes[i + 2]].position - frame.nodes[corners.nodes[i]].position;
      const double stiffness = params.stiffness * diaphragm.stiffness[i];
      const Matrix12 matrix = bar_between(0, 1, 1 / length(across) * across, stiffness).delta;
      bar = between({node[i], node[i + 2]}, matrix);
    }
    set_in_factor(diaphragm.bars[i], bar);
  }
}

std::string FrameSolver::Impl::where(std::uint32_t node) const {
  const std::uint32_t at = links.frame_node(node);
  std::vector<double> levels;
  for (const FrameNode& other : frame.nodes)
    if (other.position.y < frame.nodes[at].position.y - 1e-6) levels.push_back(other.position.y);
  std::ranges::sort(levels);
  const auto same = std::ranges::unique(levels, [](double a, double b) { return b - a < 1e-6; });
  levels.erase(same.begin(), same.end());
  std::string result = text("node ", frame.nodes[at].name, " (level ", levels.size(), ", ",
                            frame.nodes[at].position.y, " m high), where these meet:");
  for (const std::uint32_t end : links.ends_at(at)) result += " " + frame.members[end / 2].name;
  return result;
}

}  // namespace sunder
