// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/beam_element.hpp"

#include <algorithm>
#include <cassert>

// Przemieniecki, "Theory of Matrix Structural Analysis", 1968: section 5.6 (stiffness with shear),
// chapters 11 (consistent mass) and 15 (geometric stiffness). In each principal plane the element
// is a simply supported beam whose end rotations against the chord strain it; springs at its ends
// add flexibility and are condensed there, on two by two numbers. What has springs or shear moves
// in the shapes that its stiffness gives it, so that mass and geometric stiffness see the same
// beam.
namespace sunder {
namespace {

/// How much of a spring in line with a stiffness is spring (`give`) and how much is not.
struct Fixity {
  double hold = 1, give = 0;  ///< sum is 1, both without cancellation
};
Fixity fixity_of(double spring, double stiffness) {
  assert(spring >= 0 && "a spring does not push");
  if (spring <= 0) return {0, 1};
  const double k = std::min(spring, BeamElement::kRigid), whole = k + stiffness;
  return {k / whole, stiffness / whole};
}

/// Bending in one plane: moments = EI/L × these numbers × end rotations against the chord.
struct Bending {
  double aa = 0, ab = 0, bb = 0;
  double sum_a = 0, sum_b = 0;  ///< aa + ab, bb + ab
  double phi = 0;               ///< 12 EI / (GA L²), shear against bending
};
Bending bending_of(double ei, double ga, double length, double spring_a, double spring_b) {
  Bending r;
  r.phi = ga > 0 ? 12 * ei / (ga * length * length) : 0;
  const double wide = 1 / (4 + r.phi), hinged = 12 * wide * ei / length;  // other end hinged
  const Fixity a = fixity_of(spring_a, hinged), b = fixity_of(spring_b, hinged);
  // 1 − (hold_a hold_b ((2 − Φ)/(4 + Φ))²), written so that nothing cancels.
  const double left = 12 * (1 + r.phi) * wide * wide * a.hold * b.hold + a.give + b.give * a.hold;
  const double scale = 12 * wide / left;
  r.aa = scale * a.hold;
  r.bb = scale * b.hold;
  r.ab = r.aa * b.hold * (2 - r.phi) * wide;
  r.sum_a = r.aa * (b.give + 6 * b.hold * wide);
  r.sum_b = r.bb * (a.give + 6 * a.hold * wide);
  return r;
}
Bending about_z(const BeamElement& e) {
  return bending_of(e.eiz, e.gay, e.length, e.spring_a.z, e.spring_b.z);
}
Bending about_y(const BeamElement& e) {
  return bending_of(e.eiy, e.gaz, e.length, e.spring_a.y, e.spring_b.y);
}

/// Shares of the twist between the nodes: of both springs and of the beam. Both springs free: the
/// beam goes with the mean of its nodes.
struct Twist {
  double spring_a = 0.5, spring_b = 0.5, beam = 0;
};
Twist twist_of(const BeamElement& e) {
  const double own = e.gj / e.length;
  const Fixity a = fixity_of(e.spring_a.x, own), b = fixity_of(e.spring_b.x, own);
  const double whole = b.hold + b.give * a.hold;
  if (whole <= 0) return {};
  return {a.give * b.hold / whole, b.give * a.hold / whole, a.hold * b.hold / whole};
}

/// A symmetric matrix of the ends of the elastic part in local axes. In the planes: displacement
/// and rotation of a, of b; the rotation in the plane of x and z is counted from x to z.
struct LocalMatrix {
  double axial[2][2]{}, twist[2][2]{}, xy[4][4]{}, xz[4][4]{};
};

/// Two by two numbers for end rotations against the chord, and one for the turn of the chord.
void fill_plane(double (&plane)[4][4], const Bending& k, double chord, double length) {
  const double inverse = 1 / length;
  const double a = k.sum_a * inverse, b = k.sum_b * inverse;
  const double across = (a + b + chord) * inverse;
  const double rows[4][4]{
      {across, a, -across, b}, {a, k.aa, -a, k.ab}, {-across, -a, across, -b}, {b, k.ab, -b, k.bb}};
  for (int i = 0; i < 4; ++i) std::copy_n(rows[i], 4, plane[i]);
}
Bending times(double factor, const Bending& k) {
  return {factor * k.aa, factor * k.ab, factor * k.bb, factor * k.sum_a, factor * k.sum_b, k.phi};
}
void fill_bar(double (&bar)[2][2], double stiffness) {
  bar[0][0] = bar[1][1] = stiffness;
  bar[0][1] = bar[1][0] = -stiffness;
}

using Mat3 = std::array<double, 9>;
Mat3 outer(Vec3 a, Vec3 b) {
  return {a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y,
          a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z};
}

Matrix12 in_world(const LocalMatrix& m, const Axes& axes) {
  const Mat3 xx = outer(axes.x, axes.x), yy = outer(axes.y, axes.y), zz = outer(axes.z, axes.z);
  const Mat3 yz = outer(axes.y, axes.z), zy = outer(axes.z, axes.y);
  Matrix12 out;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const auto &y = m.xy, &z = m.xz;
      Mat3 shift, turn, mixed;
      for (std::size_t k = 0; k < 9; ++k) {
        shift[k] = m.axial[i][j] * xx[k] + y[2 * i][2 * j] * yy[k] + z[2 * i][2 * j] * zz[k];
        turn[k] = m.twist[i][j] * xx[k] + z[2 * i + 1][2 * j + 1] * yy[k] +
                  y[2 * i + 1][2 * j + 1] * zz[k];
        mixed[k] = y[2 * i][2 * j + 1] * yz[k] - z[2 * i][2 * j + 1] * zy[k];
      }
      for (int k = 0; k < 9; ++k) {
        const int row = 6 * i + k / 3, column = 6 * j + k % 3;
        const auto at = static_cast<std::size_t>(k);
        out(row, column) = shift[at];
        out(row + 3, column + 3) = turn[at];
        out(row, column + 3) = mixed[at];
        out(6 * j + 3 + k % 3, row) = mixed[at];
      }
    }
  }
  return out;
}

/// From the ends of the elastic part to the nodes: u_end = u + θ × arm.
void move_to_node(Matrix12& m, int end, Vec3 arm) {
  if (arm == Vec3{}) return;
  const int u = 6 * end, turn = u + 3;
  for (int row = 0; row < 12; ++row) {
    const Vec3 moment = cross(arm, {m(row, u), m(row, u + 1), m(row, u + 2)});
    m(row, turn) += moment.x;
    m(row, turn + 1) += moment.y;
    m(row, turn + 2) += moment.z;
  }
  for (int column = 0; column < 12; ++column) {
    const Vec3 moment = cross(arm, {m(u, column), m(u + 1, column), m(u + 2, column)});
    m(turn, column) += moment.x;
    m(turn + 1, column) += moment.y;
    m(turn + 2, column) += moment.z;
  }
}
Matrix12 at_nodes(const LocalMatrix& local, const BeamElement& element) {
  Matrix12 m = in_world(local, element.axes);
  move_to_node(m, 0, element.arm_a);
  move_to_node(m, 1, element.arm_b);
  for (int row = 1; row < 12; ++row) {
    for (int column = 0; column < row; ++column) m(row, column) = m(column, row);
  }
  return m;
}

/// End slopes against the chord per end rotation of the nodes against it.
struct Slopes {
  double a_a = 0, a_b = 0, b_a = 0, b_b = 0;
};
Slopes slopes_of(const Bending& k) {
  return {(2 * k.aa - k.ab) / 6, (2 * k.ab - k.bb) / 6, (2 * k.ab - k.aa) / 6,
          (2 * k.bb - k.ab) / 6};
}

/// ∫ (v' − chord)² dx × 30/L as numbers for the end rotations against the chord.
Bending bow_of(const Bending& stiffness) {
  const Slopes s = slopes_of(stiffness);
  const auto product = [](double a, double b, double c, double d) {
    return 4 * (a * c + b * d) - a * d - b * c;
  };
  Bending r;
  r.aa = product(s.a_a, s.b_a, s.a_a, s.b_a);
  r.ab = product(s.a_a, s.b_a, s.a_b, s.b_b);
  r.bb = product(s.a_b, s.b_b, s.a_b, s.b_b);
  r.sum_a = r.aa + r.ab;
  r.sum_b = r.bb + r.ab;
  return r;
}

using Row4 = std::array<double, 4>;
Row4 combined(double a, const Row4& x, double b, const Row4& y) {
  return {a * x[0] + b * y[0], a * x[1] + b * y[1], a * x[2] + b * y[2], a * x[3] + b * y[3]};
}
/// plane += Σ form[i][j] rowsᵢᵀ rowsⱼ; form is symmetric.
template <std::size_t N>
void add_form(double (&plane)[4][4], const std::array<Row4, N>& rows, const double (&form)[N][N]) {
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      for (std::size_t r = 0; r < 4; ++r) {
        for (std::size_t c = 0; c < 4; ++c) plane[r][c] += form[i][j] * rows[i][r] * rows[j][c];
      }
    }
  }
}

/// Mass of one plane: of the moving line (`mass`, kg/m) and of the turning sections (`rotary`).
void fill_mass(double (&plane)[4][4], const Bending& k, double length, double mass, double rotary) {
  const double l = length, inverse = 1 / length;
  const Row4 chord{-inverse, 0, inverse, 0};
  const Row4 a{inverse, 1, -inverse, 0}, b{inverse, 0, -inverse, 1};  // rotations against it
  const Slopes s = slopes_of(k);
  const Row4 bend_a = combined(s.a_a, a, s.a_b, b), bend_b = combined(s.b_a, a, s.b_b, b);
  const Row4 slope_a = combined(1, chord, 1, bend_a), slope_b = combined(1, chord, 1, bend_b);
  const double f = mass * l / 420;
  const double line[4][4]{{156 * f, 22 * l * f, 54 * f, -13 * l * f},
                          {22 * l * f, 4 * l * l * f, 13 * l * f, -3 * l * l * f},
                          {54 * f, 13 * l * f, 156 * f, -22 * l * f},
                          {-13 * l * f, -3 * l * l * f, -22 * l * f, 4 * l * l * f}};
  add_form(plane, std::array<Row4, 4>{{{1, 0, 0, 0}, slope_a, {0, 0, 1, 0}, slope_b}}, line);
  // Sections lag behind the slope by the shear strain −Φ/12 (sum_a θ_a + sum_b θ_b).
  const Row4 mean = combined(1, chord, k.phi / 12, combined(k.sum_a, a, k.sum_b, b));
  const double j = rotary * l;
  const double turning[3][3]{{j, 0, 0}, {0, j * 4 / 30, -j / 30}, {0, -j / 30, j * 4 / 30}};
  add_form(plane, std::array<Row4, 3>{mean, bend_a, bend_b}, turning);
}

/// Forces of the nodes on the ends of the elastic part, local axes.
struct EndForces {
  Vec3 force_a, moment_a, force_b, moment_b;
};

/// Loads in a plane on the simply supported beam: EI × half the sum and half the difference of its
/// end rotations, and the forces of its supports.
struct PlaneLoad {
  double mean = 0, spread = 0, support_a = 0, support_b = 0;
  void add_uniform(double load, double length) {
    spread += load * length * length * length / 24;
    support_a -= load * length / 2;
    support_b -= load * length / 2;
  }
  void add_point(double force, double moment, double s, double length, double phi) {
    const double inside = s * (1 - s), skew = 1 - 2 * s;
    mean += length * (force * length * inside * skew + moment * (1 - 6 * inside + phi)) / 12;
    spread += length * (force * length * inside + moment * skew) / 4;
    support_a += moment / length - force * (1 - s);
    support_b -= moment / length + force * s;
  }
};
struct PlaneForces {
  double force_a = 0, moment_a = 0, force_b = 0, moment_b = 0;
};
PlaneForces held(const PlaneLoad& load, const Bending& k, double length) {
  const double a = -(k.sum_a * load.mean + (k.aa - k.ab) * load.spread) / length;
  const double b = -(k.sum_b * load.mean - (k.bb - k.ab) * load.spread) / length;
  const double shear = (a + b) / length;
  return {load.support_a + shear, a, load.support_b - shear, b};
}

EndForces held_ends(const BeamElement& e, const BeamLoad& load, const Bending& z, const Bending& y,
                    const Twist& twist) {
  const Vec3 uniform = into(e.axes, load.uniform);
  PlaneLoad xy, xz;
  xy.add_uniform(uniform.y, e.length);
  xz.add_uniform(uniform.z, e.length);
  double along_a = -uniform.x * e.length / 2, along_b = along_a, twist_a = 0, twist_b = 0;
  for (const BeamLoad::Point& point : load.points) {
    const Vec3 force = into(e.axes, point.force), moment = into(e.axes, point.moment);
    const double s = point.at / e.length;
    xy.add_point(force.y, moment.z, s, e.length, z.phi);
    xz.add_point(force.z, -moment.y, s, e.length, y.phi);
    along_a -= force.x * (1 - s);
    along_b -= force.x * s;
    twist_a -= moment.x * ((1 - s) * twist.beam + twist.spring_b);
    twist_b -= moment.x * (s * twist.beam + twist.spring_a);
  }
  const PlaneForces v = held(xy, z, e.length), w = held(xz, y, e.length);
  return {{along_a, v.force_a, w.force_a},
          {twist_a, -w.moment_a, v.moment_a},
          {along_b, v.force_b, w.force_b},
          {twist_b, -w.moment_b, v.moment_b}};
}

Vec3 three(const Twelve& all, std::size_t first) {
  return {all[first], all[first + 1], all[first + 2]};
}

/// Of one plane: end rotations against the chord bend, shear balances them.
PlaneForces bent(const Bending& k, double ei, double length, double turn_a, double turn_b) {
  const double a = ei / length * (k.aa * turn_a + k.ab * turn_b);
  const double b = ei / length * (k.ab * turn_a + k.bb * turn_b);
  const double shear = (a + b) / length;
  return {shear, a, -shear, b};
}

EndForces strained_ends(const BeamElement& e, const Twelve& displacements, const Bending& z,
                        const Bending& y, const Twist& twist) {
  const Vec3 world_a = three(displacements, 3), world_b = three(displacements, 9);
  const Vec3 end_a = three(displacements, 0) + cross(world_a, e.arm_a);
  const Vec3 end_b = three(displacements, 6) + cross(world_b, e.arm_b);
  const Vec3 stretch = (1 / e.length) * into(e.axes, end_b - end_a);
  const Vec3 turn_a = into(e.axes, world_a), turn_b = into(e.axes, world_b);
  const PlaneForces v = bent(z, e.eiz, e.length, turn_a.z - stretch.y, turn_b.z - stretch.y);
  const PlaneForces w = bent(y, e.eiy, e.length, -turn_a.y - stretch.z, -turn_b.y - stretch.z);
  const double pull = e.ea * stretch.x;
  const double torque = e.gj / e.length * twist.beam * (turn_b.x - turn_a.x);
  return {{-pull, v.force_a, w.force_a},
          {-torque, -w.moment_a, v.moment_a},
          {pull, v.force_b, w.force_b},
          {torque, -w.moment_b, v.moment_b}};
}

}  // namespace

Matrix12 stiffness_of(const BeamElement& e) {
  assert(e.length > 0 && "an element has a length");
  LocalMatrix local;
  fill_bar(local.axial, e.ea / e.length);
  fill_bar(local.twist, e.gj / e.length * twist_of(e).beam);
  fill_plane(local.xy, times(e.eiz / e.length, about_z(e)), 0, e.length);
  fill_plane(local.xz, times(e.eiy / e.length, about_y(e)), 0, e.length);
  return at_nodes(local, e);
}

Twelve fixed_end_of(const BeamElement& e, const BeamLoad& load) {
  Twelve result{};
  fixed_ends_of(e, {&load, 1}, {&result, 1});
  return result;
}

void fixed_ends_of(const BeamElement& e, std::span<const BeamLoad> loads,
                   std::span<Twelve> results) {
  const Bending z = about_z(e), y = about_y(e);
  const Twist twist = twist_of(e);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const EndForces local = held_ends(e, loads[i], z, y, twist);
    const Vec3 force_a = e.axes * local.force_a, force_b = e.axes * local.force_b;
    const Vec3 moment_a = e.axes * local.moment_a + cross(e.arm_a, force_a);
    const Vec3 moment_b = e.axes * local.moment_b + cross(e.arm_b, force_b);
    results[i] = {force_a.x, force_a.y, force_a.z, moment_a.x, moment_a.y, moment_a.z,
                  force_b.x, force_b.y, force_b.z, moment_b.x, moment_b.y, moment_b.z};
  }
}

Matrix12 geometric_stiffness_of(const BeamElement& e, double axial) {
  LocalMatrix local;
  const double bow = axial * e.length / 30;
  fill_plane(local.xy, times(bow, bow_of(about_z(e))), axial, e.length);
  fill_plane(local.xz, times(bow, bow_of(about_y(e))), axial, e.length);
  Matrix12 m = at_nodes(local, e);
  // An arm r that turns by θ moves its end by ½ θ × (θ × r) besides, against or along the force.
  for (const int end : {0, 1}) {
    const Vec3 arm = end == 0 ? e.arm_a : e.arm_b;
    const double force = end == 0 ? -axial : axial;
    const Mat3 across = outer(e.axes.x, arm);
    for (int k = 0; k < 9; ++k) {
      const int row = k / 3, column = k % 3;
      const auto at = static_cast<std::size_t>(k),
                 mirrored = static_cast<std::size_t>(3 * column + row);
      const double along = row == column ? dot(e.axes.x, arm) : 0;
      m(6 * end + 3 + row, 6 * end + 3 + column) +=
          force * ((across[at] + across[mirrored]) / 2 - along);
    }
  }
  return m;
}

Matrix12 mass_of(const BeamElement& e) {
  const double third = e.mass * e.length / 3, both = e.eiy + e.eiz;
  const double rotary_y = both > 0 ? e.polar * (e.eiy / both) : e.polar / 2;
  LocalMatrix local;
  local.axial[0][0] = local.axial[1][1] = third;
  local.axial[0][1] = local.axial[1][0] = third / 2;
  const Twist t = twist_of(e);  // ends of the beam turn as these mixtures of the nodes
  const double mix[2][2]{{1 - t.spring_a, t.spring_a}, {t.spring_b, 1 - t.spring_b}};
  const double j = e.polar * e.length / 3;
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 2; ++k) {
      local.twist[i][k] = j * (mix[0][i] * mix[0][k] + mix[1][i] * mix[1][k]) +
                          j / 2 * (mix[0][i] * mix[1][k] + mix[1][i] * mix[0][k]);
    }
  }
  fill_mass(local.xy, about_z(e), e.length, e.mass, e.polar - rotary_y);
  fill_mass(local.xz, about_y(e), e.length, e.mass, rotary_y);
  return at_nodes(local, e);
}

SectionForces section_forces(const BeamElement& e, const Twelve& displacements,
                             const BeamLoad& load) {
  const Bending z = about_z(e), y = about_y(e);
  const Twist twist = twist_of(e);
  const EndForces strained = strained_ends(e, displacements, z, y, twist);
  const EndForces held = held_ends(e, load, z, y, twist);
  return {-1 * (strained.force_a + held.force_a), -1 * (strained.moment_a + held.moment_a),
          strained.force_b + held.force_b, strained.moment_b + held.moment_b};
}

}  // namespace sunder
