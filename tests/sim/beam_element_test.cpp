// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/beam_element.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "meshing/random.hpp"
#include "sim/dense.hpp"

namespace sunder {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFree = 0, kStiff = BeamElement::kRigid;

/// Displacements (m) and rotations (rad), or forces and moments, of nodes one after the other.
struct Structure {
  explicit Structure(std::size_t nodes) : k(6 * nodes), f(6 * nodes), held(6 * nodes) {}
  void add(const Matrix12& m, std::size_t a, std::size_t b) {
    for (std::size_t r = 0; r < 12; ++r) {
      for (std::size_t c = 0; c < 12; ++c) {
        k(freedom(r, a, b), freedom(c, a, b)) += m.at[12 * r + c];
      }
    }
  }
  void add(const BeamElement& e, std::size_t a, std::size_t b, const BeamLoad& load = {}) {
    add(stiffness_of(e), a, b);
    const Twelve fixed = fixed_end_of(e, load);
    for (std::size_t r = 0; r < 12; ++r) f[freedom(r, a, b)] -= fixed[r];
  }
  static std::size_t freedom(std::size_t r, std::size_t a, std::size_t b) {
    return r < 6 ? 6 * a + r : 6 * b + r - 6;
  }
  void hold(std::size_t node, std::initializer_list<std::size_t> freedoms = {0, 1, 2, 3, 4, 5}) {
    for (std::size_t i : freedoms) held[6 * node + i] = true;
  }
  void push(std::size_t node, Vec3 force, Vec3 moment = {}) {
    const double all[6]{force.x, force.y, force.z, moment.x, moment.y, moment.z};
    for (std::size_t i = 0; i < 6; ++i) f[6 * node + i] += all[i];
  }
  /// Without what is held: rows of the identity (or of nothing) instead.
  Dense reduced(double diagonal = 1) const {
    Dense m = k;
    for (std::size_t r = 0; r < m.size; ++r) {
      for (std::size_t c = 0; c < m.size; ++c) {
        if (held[r] || held[c]) m(r, c) = r == c ? diagonal : 0;
      }
    }
    return m;
  }
  void solve() {
    Column rhs = f;
    for (std::size_t r = 0; r < rhs.size(); ++r) rhs[r] = held[r] ? 0 : rhs[r];
    u = solved(reduced(), rhs);
  }
  Vec3 vector(std::size_t first) const {
    return {double(u[first]), double(u[first + 1]), double(u[first + 2])};
  }
  Vec3 shift(std::size_t node) const { return vector(6 * node); }
  Vec3 turn(std::size_t node) const { return vector(6 * node + 3); }
  Twelve ends(std::size_t a, std::size_t b) const {
    Twelve all;
    for (std::size_t r = 0; r < 12; ++r) all[r] = double(u[freedom(r, a, b)]);
    return all;
  }
  Dense k;
  Column f, u;
  std::vector<bool> held;
};

double random_in(std::uint64_t seed, std::uint64_t draw, double low, double high) {
  return low + (high - low) * random_unit(seed, draw);
}
Vec3 random_vector(std::uint64_t seed, std::uint64_t draw, double size) {
  return {random_in(seed, 3 * draw, -size, size), random_in(seed, 3 * draw + 1, -size, size),
          random_in(seed, 3 * draw + 2, -size, size)};
}
Axes random_axes(std::uint64_t seed) {
  const Vec3 v = random_vector(seed, 100, 1);
  return axes_of(normalised({v.x, v.y, v.z, random_in(seed, 400, 0.1, 1)}));
}

/// About an IPE 300 of 5 m.
BeamElement beam(double length = 5) {
  return {.length = length,
          .axes = {},
          .ea = 1.13e9,
          .eiy = 1.755e7,
          .eiz = 1.27e6,
          .gj = 1.63e4,
          .gay = 2.2e8,
          .gaz = 1.9e8,
          .mass = 42.2,
          .polar = 0.7,
          .arm_a = {},
          .arm_b = {}};
}
BeamElement slender(double length = 5) {
  BeamElement e = beam(length);
  e.gay = e.gaz = 0;
  return e;
}
/// With everything an element can have.
BeamElement random_beam(std::uint64_t seed) {
  BeamElement e = beam(random_in(seed, 1, 2, 8));
  e.axes = random_axes(seed);
  e.arm_a = random_vector(seed, 20, 0.4);
  e.arm_b = random_vector(seed, 21, 0.4);
  const auto spring = [&](std::uint64_t draw) {
    const double kind = random_unit(seed, draw);
    if (kind < 0.2) return kFree;
    return kind < 0.4 ? kStiff : std::pow(10, random_in(seed, draw + 1, 4, 9));
  };
  e.spring_a = {spring(30), spring(32), spring(34)};
  e.spring_b = {spring(36), spring(38), spring(40)};
  return e;
}
BeamLoad random_load(std::uint64_t seed, double length) {
  BeamLoad load{.uniform = random_vector(seed, 50, 1e4), .points = {}};
  for (std::uint64_t i = 0; i < 3; ++i) {
    load.points.push_back({random_in(seed, 60 + i, 0, length), random_vector(seed, 70 + i, 1e4),
                           random_vector(seed, 80 + i, 1e4)});
  }
  return load;
}
constexpr std::uint64_t kSeeds = 40;

/// Geometric mean of the diagonal: what an entry is measured by.
double scale_of(const Matrix12& m, int r, int c) {
  return std::sqrt(std::abs(m(r, r) * m(c, c)));
}
void expect_same(const Matrix12& m, const Matrix12& expected, double tolerance) {
  for (int r = 0; r < 12; ++r) {
    for (int c = 0; c < 12; ++c) {
      ASSERT_NEAR(m(r, c), expected(r, c), tolerance * scale_of(expected, r, c))
          << "row " << r << ", column " << c;
    }
  }
}
void expect_same(const Twelve& f, const Twelve& expected, double tolerance) {
  double size = 0;
  for (double each : expected) size = std::max(size, std::abs(each));
  for (std::size_t i = 0; i < 12; ++i) ASSERT_NEAR(f[i], expected[i], tolerance * size) << i;
}
void expect_near(Vec3 v, Vec3 expected, double tolerance) {
  EXPECT_LE(length(v - expected), tolerance)
      << v.x << ' ' << v.y << ' ' << v.z << " is not " << expected.x << ' ' << expected.y << ' '
      << expected.z;
}
void expect_relative(double value, double expected, double tolerance = 1e-12) {
  EXPECT_NEAR(value, expected, tolerance * std::abs(expected));
}
Vec3 part(const Twelve& all, std::size_t first) {
  return {all[first], all[first + 1], all[first + 2]};
}
void put(Twelve& all, std::size_t first, Vec3 v) {
  all[first] = v.x;
  all[first + 1] = v.y;
  all[first + 2] = v.z;
}
Twelve times(const Matrix12& m, const Twelve& x) {
  Twelve y{};
  for (std::size_t i = 0; i < 144; ++i) y[i / 12] += m.at[i] * x[i % 12];
  return y;
}
/// Tᵀ M T.
Matrix12 congruent(const Matrix12& m, const Matrix12& t) {
  Matrix12 half, whole;
  for (int r = 0; r < 12; ++r) {
    for (int c = 0; c < 12; ++c) {
      for (int k = 0; k < 12; ++k) half(r, c) += m(r, k) * t(k, c);
    }
  }
  for (int r = 0; r < 12; ++r) {
    for (int c = 0; c < 12; ++c) {
      for (int k = 0; k < 12; ++k) whole(r, c) += t(k, r) * half(k, c);
    }
  }
  return whole;
}
/// A linear map of the twelve given by what it does.
template <typename Map>
Matrix12 matrix_of(const Map& map) {
  Matrix12 m;
  for (std::size_t c = 0; c < 12; ++c) {
    Twelve unit{};
    unit[c] = 1;
    const Twelve image = map(unit);
    for (std::size_t r = 0; r < 12; ++r) m.at[12 * r + c] = image[r];
  }
  return m;
}

/// A cantilever in any direction with this at its free end (local axes).
Structure cantilever(const BeamElement& e, Vec3 force, Vec3 moment, Vec3 uniform) {
  Structure s(2);
  s.add(e, 0, 1, {.uniform = e.axes * uniform, .points = {}});
  s.hold(0);
  s.push(1, e.axes * force, e.axes * moment);
  s.solve();
  return s;
}

TEST(BeamElement, CantileverWithATipLoadFollowsTimoshenko) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    BeamElement e = beam();
    if (seed > 0) e.axes = random_axes(seed);
    const double l = e.length, load = 1e4;
    const Structure y = cantilever(e, {0, load, 0}, {}, {});
    const Structure z = cantilever(e, {0, 0, load}, {}, {});
    const double v = load * l * l * l / (3 * e.eiz) + load * l / e.gay;
    const double w = load * l * l * l / (3 * e.eiy) + load * l / e.gaz;
    expect_near(into(e.axes, y.shift(1)), {0, v, 0}, 1e-12 * v);
    expect_near(into(e.axes, z.shift(1)), {0, 0, w}, 1e-12 * v);
    expect_near(into(e.axes, y.turn(1)), {0, 0, load * l * l / (2 * e.eiz)}, 1e-12 * v);
    expect_near(into(e.axes, z.turn(1)), {0, -load * l * l / (2 * e.eiy), 0}, 1e-12 * v);
  }
}

TEST(BeamElement, CantileverUnderUniformLoadFollowsTimoshenko) {
  const BeamElement e = beam();
  const double l = e.length, q = -7e3;
  const Structure s = cantilever(e, {}, {}, {q, q, q});
  const double l4 = l * l * l * l;
  expect_relative(s.shift(1).x, q * l * l / (2 * e.ea));
  expect_relative(s.shift(1).y, q * l4 / (8 * e.eiz) + q * l * l / (2 * e.gay));
  expect_relative(s.shift(1).z, q * l4 / (8 * e.eiy) + q * l * l / (2 * e.gaz));
}

TEST(BeamElement, RodStretchesAndTwists) {
  const BeamElement e = beam();
  const Structure s = cantilever(e, {3e5, 0, 0}, {200, 0, 0}, {});
  expect_relative(s.shift(1).x, 3e5 * e.length / e.ea);
  expect_relative(s.turn(1).x, 200 * e.length / e.gj);
}

TEST(BeamElement, FixedBeamWithAMidLoadHasItsClosedForm) {
  const BeamElement half = beam(2.5);
  const double l = 5, load = -2e4;
  Structure s(3);
  s.add(half, 0, 1);
  s.add(half, 1, 2);
  s.hold(0);
  s.hold(2);
  s.push(1, {0, 0, load});
  s.solve();
  expect_relative(s.shift(1).z, load * l * l * l / (192 * half.eiy) + load * l / (4 * half.gaz));
  const SectionForces first = section_forces(half, s.ends(0, 1), {});
  expect_relative(first.moment_a.y, -load * l / 8);
  expect_relative(first.moment_b.y, load * l / 8);
  expect_relative(first.force_a.z, load / 2);
  expect_relative(first.force_b.z, load / 2);
}

TEST(BeamElement, HingedBeamSagsAsTheClosedForm) {
  BeamElement left = beam(2.5), right = beam(2.5);
  left.spring_a.y = left.spring_a.z = right.spring_b.y = right.spring_b.z = kFree;
  const double l = 5, q = 9e3;
  const BeamLoad load{.uniform = {0, q, -q}, .points = {}};
  Structure s(3);
  s.add(left, 0, 1, load);
  s.add(right, 1, 2, load);
  s.hold(0);
  s.hold(2);
  s.solve();
  const double l4 = l * l * l * l;
  expect_relative(s.shift(1).y, 5 * q * l4 / (384 * left.eiz) + q * l * l / (8 * left.gay));
  expect_relative(s.shift(1).z, -5 * q * l4 / (384 * left.eiy) - q * l * l / (8 * left.gaz));
  const SectionForces mid = section_forces(left, s.ends(0, 1), load);
  expect_relative(mid.moment_b.y, -q * l * l / 8);
  expect_relative(std::abs(mid.moment_b.z), q * l * l / 8);
  expect_near(mid.moment_a, {}, 1e-12 * q * l * l);
}

TEST(BeamElement, SemiRigidEndsHoldWhatTheirSpringsLet) {
  const double q = 9e3;
  for (int power = -30; power <= 300; power += 3) {
    BeamElement e = beam();
    const double k = std::pow(10, power), l = e.length;
    e.spring_a.y = e.spring_b.y = k;
    const Twelve f = fixed_end_of(e, {.uniform = {0, 0, -q}, .points = {}});
    const double moment = q * l * l * l / 24 / (l / 2 + e.eiy / k);
    expect_relative(f[4], -moment, 1e-13);
    expect_relative(f[10], moment, 1e-13);
  }
}

/// End moments per end rotations from the flexibility: (aa, ab, bb).
std::array<long double, 3> from_flexibility(double ei, double ga, double length, double spring_a,
                                            double spring_b) {
  const long double l = length, bend = l / (6.0L * ei), slip = ga > 0 ? 1 / (ga * l) : 0;
  const long double a = 2 * bend + slip + 1 / static_cast<long double>(spring_a);
  const long double b = 2 * bend + slip + 1 / static_cast<long double>(spring_b);
  const long double both = slip - bend, det = a * b - both * both;
  return {b / det, -both / det, a / det};
}

TEST(BeamElement, SpringsOfAnyStiffnessCondenseExactly) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    BeamElement e = beam(random_in(seed, 0, 0.1, 10));
    e.gaz = seed % 3 == 0 ? 0 : std::pow(10, random_in(seed, 1, 5, 12));
    e.spring_a.y = std::pow(10, random_in(seed, 2, -20, 30));
    e.spring_b.y = std::pow(10, random_in(seed, 3, -20, 30));
    const auto k = from_flexibility(e.eiy, e.gaz, e.length, e.spring_a.y, e.spring_b.y);
    const Matrix12 m = stiffness_of(e);
    const double l = e.length;
    expect_relative(m(4, 4), double(k[0]), 1e-13);
    expect_relative(m(10, 10), double(k[2]), 1e-13);
    EXPECT_NEAR(m(4, 10), double(k[1]), 1e-13 * std::sqrt(m(4, 4) * m(10, 10))) << seed;
    expect_relative(m(2, 2), double((k[0] + 2 * k[1] + k[2]) / (l * l)), 1e-13);
    expect_relative(m(2, 4), -double((k[0] + k[1]) / l), 1e-13);
    expect_relative(m(2, 10), -double((k[2] + k[1]) / l), 1e-13);
  }
}

TEST(BeamElement, EndsOfTheSpringsRangeAreRigidAndFree) {
  const double infinity = std::numeric_limits<double>::infinity();
  BeamElement e = slender();
  const Matrix12 rigid = stiffness_of(e);
  e.spring_a = {infinity, infinity, infinity};
  EXPECT_EQ(stiffness_of(e).at, rigid.at);
  e.spring_a = {kFree, kFree, kFree};
  const Matrix12 hinged = stiffness_of(e);
  expect_relative(hinged(10, 10), 3 * e.eiy / e.length);
  expect_relative(hinged(11, 11), 3 * e.eiz / e.length);
  for (int c = 0; c < 12; ++c) {
    for (int r : {3, 4, 5, 9}) EXPECT_EQ(hinged(r, c), 0) << r << ' ' << c;
  }
  e.spring_b = e.spring_a;
  const Matrix12 bar = stiffness_of(e);
  for (int i = 0; i < 144; ++i) {
    const bool along = (i / 12) % 6 == 0 && (i % 12) % 6 == 0;
    EXPECT_EQ(bar.at[static_cast<std::size_t>(i)] != 0, along) << i;
  }
}

TEST(BeamElement, BarIsABeamWithoutBendingStiffness) {
  BeamElement hinged = beam(), bar = beam();
  hinged.spring_a = hinged.spring_b = {kFree, kFree, kFree};
  bar.eiy = bar.eiz = bar.gj = 0;
  EXPECT_EQ(stiffness_of(bar).at, stiffness_of(hinged).at);
  const SectionForces s = section_forces(bar, {0, 0, 0, 1, 2, 3, 1e-3, 1, 2, 4, 5, 6}, {});
  expect_relative(s.force_b.x, bar.ea * 1e-3 / bar.length);
  EXPECT_EQ(length(s.moment_a) + length(s.moment_b), 0);
}

TEST(BeamElement, TwistSharesItsTorqueBySprings) {
  BeamElement e = beam();
  e.spring_a.x = 2e4;
  e.spring_b.x = 5e3;
  const double whole = 1 / (e.length / e.gj + 1 / 2e4 + 1 / 5e3);
  expect_relative(stiffness_of(e)(3, 3), whole);
  const BeamLoad load{.uniform = {}, .points = {{1.5, {}, {100, 0, 0}}}};
  const Twelve f = fixed_end_of(e, load);
  expect_relative(f[3], -100 * whole * (3.5 / e.gj + 1 / 5e3));
  expect_relative(f[9], -100 * whole * (1.5 / e.gj + 1 / 2e4));
  e.spring_a.x = e.spring_b.x = kFree;  // nothing holds it: both nodes get a half
  EXPECT_EQ(stiffness_of(e)(3, 3), 0);
  EXPECT_EQ(fixed_end_of(e, load)[3], -50);
  EXPECT_EQ(fixed_end_of(e, load)[9], -50);
}

TEST(BeamElement, PointLoadsOnAFixedBeamHaveTheirClosedForms) {
  const BeamElement e = slender();
  const double l = e.length, load = 1e4;
  for (double a : {0.0, 0.003, 1.0, 2.5, 4.1, 5.0}) {
    const double b = l - a;
    const Twelve force = fixed_end_of(e, {.uniform = {}, .points = {{a, {0, -load, 0}, {}}}});
    EXPECT_NEAR(force[1], load * b * b * (3 * a + b) / (l * l * l), 1e-12 * load);
    EXPECT_NEAR(force[5], load * a * b * b / (l * l), 1e-12 * load);
    EXPECT_NEAR(force[11], -load * a * a * b / (l * l), 1e-12 * load);
    const Twelve moment = fixed_end_of(e, {.uniform = {}, .points = {{a, {}, {0, 0, load}}}});
    EXPECT_NEAR(moment[5], -load * b * (b - 2 * a) / (l * l), 1e-12 * load);
    EXPECT_NEAR(moment[11], -load * a * (a - 2 * b) / (l * l), 1e-12 * load);
    EXPECT_NEAR(moment[1], 6 * load * a * b / (l * l * l), 1e-12 * load);
  }
}

TEST(BeamElement, PortalFrameHasItsClosedForm) {
  const double h = 3.5, l = 6, push = 1e5;
  BeamElement post = beam(h), girder = beam(l);
  post.axes = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
  Structure s(4);
  s.add(post, 0, 1);
  s.add(girder, 1, 2);
  s.add(post, 3, 2);
  s.hold(0);
  s.hold(3);
  s.push(1, {push / 2, 0, 0});
  s.push(2, {push / 2, 0, 0});
  s.solve();
  // Force method: the shear in the girder's middle, where an antisymmetric frame has no moment.
  const double ei = post.eiz;
  const double shear =
      push * h * h * l / (8 * ei) /
      (l * l * l / (24 * ei) + l * l * h / (4 * ei) + h / post.ea + l / (2 * girder.gay));
  const SectionForces left = section_forces(post, s.ends(0, 1), {});
  expect_relative(left.force_a.x, shear, 1e-11);
  expect_relative(std::abs(left.moment_a.z), push * h / 2 - shear * l / 2, 1e-11);
  expect_relative(std::abs(left.moment_b.z), shear * l / 2, 1e-11);
  const double k = h / l;  // the handbooks': long members, no strain along them
  expect_relative(std::abs(left.moment_b.z), push * h / 2 * 3 * k / (6 * k + 1), 0.02);
}

TEST(BeamElement, ArmsAreRigidLinksToShiftedNodes) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const BeamElement e = random_beam(seed);
    BeamElement bare = e;
    bare.arm_a = bare.arm_b = {};
    const Matrix12 link = matrix_of([&](Twelve u) {
      put(u, 0, part(u, 0) + cross(part(u, 3), e.arm_a));
      put(u, 6, part(u, 6) + cross(part(u, 9), e.arm_b));
      return u;
    });
    expect_same(stiffness_of(e), congruent(stiffness_of(bare), link), 1e-12);
    expect_same(mass_of(e), congruent(mass_of(bare), link), 1e-12);
    const BeamLoad load = random_load(seed, e.length);
    Twelve moved{};
    const Twelve fixed = fixed_end_of(bare, load);
    for (std::size_t i = 0; i < 144; ++i) moved[i % 12] += link.at[i] * fixed[i / 12];
    expect_same(fixed_end_of(e, load), moved, 1e-12);
  }
}

TEST(BeamElement, MatricesAreSymmetricToTheBit) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BeamElement e = random_beam(seed);
    for (const Matrix12& m : {stiffness_of(e), mass_of(e), geometric_stiffness_of(e, 1e5)}) {
      for (int r = 0; r < 12; ++r) {
        for (int c = 0; c < r; ++c) ASSERT_EQ(m(r, c), m(c, r)) << seed;
      }
    }
  }
}

/// The matrices of an element after a change of frame are those before, seen through `map`.
template <typename Map>
void expect_through(const BeamElement& e, const BeamElement& changed, const Map& back) {
  const Matrix12 t = matrix_of(back);
  expect_same(stiffness_of(changed), congruent(stiffness_of(e), t), 1e-11);
  expect_same(mass_of(changed), congruent(mass_of(e), t), 1e-11);
  const Matrix12 bow = geometric_stiffness_of(changed, 1e5);
  const Matrix12 expected = congruent(geometric_stiffness_of(e, 1e5), t);
  for (int i = 0; i < 144; ++i) {
    ASSERT_NEAR(bow.at[static_cast<std::size_t>(i)], expected.at[static_cast<std::size_t>(i)],
                1e-12 * 1e5);
  }
}

TEST(BeamElement, TurnsWithTheWorld) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const BeamElement e = random_beam(seed);
    const Axes r = random_axes(seed + 1000);
    BeamElement turned = e;
    turned.axes = {r * e.axes.x, r * e.axes.y, r * e.axes.z};
    turned.arm_a = r * e.arm_a;
    turned.arm_b = r * e.arm_b;
    expect_through(e, turned, [&](Twelve u) {
      for (std::size_t i = 0; i < 12; i += 3) put(u, i, into(r, part(u, i)));
      return u;
    });
  }
}

TEST(BeamElement, MirrorsWithTheWorld) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const BeamElement e = random_beam(seed);
    const auto mirror = [](Vec3 v) { return Vec3{-v.x, v.y, v.z}; };
    BeamElement mirrored = e;
    mirrored.axes = {mirror(e.axes.x), -1 * mirror(e.axes.y), mirror(e.axes.z)};
    mirrored.arm_a = mirror(e.arm_a);
    mirrored.arm_b = mirror(e.arm_b);
    expect_through(e, mirrored, [&](Twelve u) {
      for (std::size_t i : {0, 6}) put(u, i, mirror(part(u, i)));
      for (std::size_t i : {3, 9}) put(u, i, -1 * mirror(part(u, i)));
      return u;
    });
  }
}

TEST(BeamElement, PrincipalPlanesAreAlike) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const BeamElement e = random_beam(seed);
    BeamElement rolled = e;
    rolled.axes = {e.axes.x, e.axes.z, -1 * e.axes.y};
    std::swap(rolled.eiy, rolled.eiz);
    std::swap(rolled.gay, rolled.gaz);
    std::swap(rolled.spring_a.y, rolled.spring_a.z);
    std::swap(rolled.spring_b.y, rolled.spring_b.z);
    expect_through(e, rolled, [](const Twelve& u) { return u; });
    const BeamLoad load = random_load(seed, e.length);
    expect_same(fixed_end_of(rolled, load), fixed_end_of(e, load), 1e-12);
  }
}

BeamElement reversed(const BeamElement& e) {
  BeamElement r = e;
  r.axes = {-1 * e.axes.x, e.axes.y, -1 * e.axes.z};
  std::swap(r.arm_a, r.arm_b);
  std::swap(r.spring_a, r.spring_b);
  return r;
}
Twelve swapped(const Twelve& u) {
  Twelve r;
  for (std::size_t i = 0; i < 12; ++i) r[i] = u[(i + 6) % 12];
  return r;
}

TEST(BeamElement, ReadsTheSameFromItsOtherEnd) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const BeamElement e = random_beam(seed), back = reversed(e);
    expect_through(e, back, swapped);
    const BeamLoad load = random_load(seed, e.length);
    BeamLoad other = load;
    for (BeamLoad::Point& point : other.points) point.at = e.length - point.at;
    expect_same(swapped(fixed_end_of(back, other)), fixed_end_of(e, load), 1e-12);
    Twelve u;
    for (std::size_t i = 0; i < 12; ++i) u[i] = random_in(seed, 500 + i, -1e-3, 1e-3);
    const SectionForces there = section_forces(e, u, load);
    const SectionForces again = section_forces(back, swapped(u), other);
    const double size = 1e-12 * (length(there.force_a) + length(there.moment_a) + 1e5);
    expect_near(back.axes * again.force_a, -1 * (e.axes * there.force_b), size);
    expect_near(back.axes * again.moment_b, -1 * (e.axes * there.moment_a), size);
  }
}

TEST(BeamElement, SectionForcesAreThoseOfTheNodes) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const BeamElement e = random_beam(seed);
    const BeamLoad load = random_load(seed, e.length);
    Twelve u;
    for (std::size_t i = 0; i < 12; ++i) u[i] = random_in(seed, 500 + i, -1e-3, 1e-3);
    Twelve nodes = times(stiffness_of(e), u);
    const Twelve fixed = fixed_end_of(e, load);
    for (std::size_t i = 0; i < 12; ++i) nodes[i] += fixed[i];
    const SectionForces s = section_forces(e, u, load);
    Twelve expected{};
    put(expected, 0, -1 * (e.axes * s.force_a));
    put(expected, 3, cross(e.arm_a, part(expected, 0)) - e.axes * s.moment_a);
    put(expected, 6, e.axes * s.force_b);
    put(expected, 9, cross(e.arm_b, part(expected, 6)) + e.axes * s.moment_b);
    expect_same(nodes, expected, 1e-12);
  }
}

TEST(BeamElement, SectionForcesAreTensionAndTheFaceBeyondPositive) {
  const BeamElement e = beam();
  const Structure s = cantilever(e, {1e5, 2e3, 3e3}, {40, 500, 600}, {});
  const SectionForces f = section_forces(e, s.ends(0, 1), {});
  expect_near(f.force_b, {1e5, 2e3, 3e3}, 1e-7);
  expect_near(f.moment_b, {40, 500, 600}, 1e-7);
  expect_near(f.force_a, {1e5, 2e3, 3e3}, 1e-7);
  expect_near(f.moment_a, {40, 500 - 5 * 3e3, 600 + 5 * 2e3}, 1e-7);
}

/// The loads of a stretch of an element.
BeamLoad between(const BeamLoad& load, double first, double last) {
  BeamLoad r{.uniform = load.uniform, .points = {}};
  for (BeamLoad::Point point : load.points) {
    if (point.at < first || point.at >= last) continue;
    point.at -= first;
    r.points.push_back(point);
  }
  return r;
}

TEST(BeamElement, TwoPiecesAreOne) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    BeamElement e = random_beam(seed);
    if (e.spring_a.x == 0) e.spring_b.x = kStiff;  // else the middle turns freely
    BeamLoad load = random_load(seed, e.length);
    const double cut = e.length * random_in(seed, 600, 0.2, 0.8);
    BeamElement first = e, second = e;
    first.length = cut;
    second.length = e.length - cut;
    first.arm_b = second.arm_a = {};
    first.spring_b = second.spring_a = {kStiff, kStiff, kStiff};
    Structure s(3);
    s.add(first, 0, 2, between(load, 0, cut));
    s.add(second, 2, 1, between(load, cut, e.length));
    const Vec3 force = random_vector(seed, 90, 1e4), moment = random_vector(seed, 91, 1e4);
    s.push(2, force, moment);
    condense(s.k, s.f, 12);
    Matrix12 k;
    Twelve fixed;
    for (std::size_t i = 0; i < 144; ++i) k.at[i] = double(s.k(i / 12, i % 12));
    for (std::size_t i = 0; i < 12; ++i) fixed[i] = double(-s.f[i]);
    load.points.push_back({cut, force, moment});
    expect_same(fixed_end_of(e, load), fixed, 1e-11);
    const Matrix12 whole = stiffness_of(e);
    for (int i = 0; i < 144; ++i) {
      const double size = scale_of(whole, i / 12, i / 12) + scale_of(whole, i % 12, i % 12);
      ASSERT_NEAR(k(i / 12, i % 12), whole(i / 12, i % 12), 1e-12 * size);
    }
  }
}

/// Nodes as a rigid body that shifts by v and turns by w about the origin; node a is at `origin`.
Twelve rigid_motion(const BeamElement& e, Vec3 origin, Vec3 v, Vec3 w) {
  const Vec3 b = origin + e.arm_a + e.length * e.axes.x - e.arm_b;
  Twelve u;
  put(u, 0, v + cross(w, origin));
  put(u, 3, w);
  put(u, 6, v + cross(w, b));
  put(u, 9, w);
  return u;
}

TEST(BeamElement, RigidMotionsStrainNothing) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BeamElement e = random_beam(seed);
    const Twelve u = rigid_motion(e, random_vector(seed, 700, 3), random_vector(seed, 701, 1),
                                  random_vector(seed, 702, 1));
    for (double force : times(stiffness_of(e), u)) EXPECT_NEAR(force, 0, 1e-14 * e.ea) << seed;
    const SectionForces s = section_forces(e, u, {});
    for (Vec3 each : {s.force_a, s.moment_a, s.force_b, s.moment_b}) {
      EXPECT_LE(length(each), 1e-14 * e.ea) << seed;
    }
  }
}

TEST(BeamElement, RigidTurnsUnderTensionOnlyMoveTheNodesApart) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BeamElement e = random_beam(seed);
    const Vec3 w = random_vector(seed, 702, 1), x = e.axes.x;
    const Twelve u = rigid_motion(e, random_vector(seed, 700, 3), random_vector(seed, 701, 1), w);
    const Twelve f = times(geometric_stiffness_of(e, 1e5), u);
    double twice_energy = 0;
    for (std::size_t i = 0; i < 12; ++i) twice_energy += u[i] * f[i];
    // Nodes go along tangents, not arcs: ½ w × (w × d) too far, and the element strains by that.
    const Vec3 d = e.arm_a + e.length * x - e.arm_b;
    EXPECT_NEAR(twice_energy, -1e5 * dot(x, cross(w, cross(w, d))), 1e-7) << seed;
  }
}

TEST(BeamElement, LoadsAreBalancedByTheNodes) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const BeamElement e = random_beam(seed);
    const BeamLoad load = random_load(seed, e.length);
    const Twelve f = fixed_end_of(e, load);
    Vec3 force = part(f, 0) + part(f, 6) + e.length * load.uniform;
    const Vec3 b = e.arm_a + e.length * e.axes.x - e.arm_b;
    Vec3 moment = part(f, 3) + part(f, 9) + cross(b, part(f, 6)) +
                  cross(e.arm_a + (e.length / 2) * e.axes.x, e.length * load.uniform);
    for (const BeamLoad::Point& point : load.points) {
      force = force + point.force;
      moment = moment + point.moment + cross(e.arm_a + point.at * e.axes.x, point.force);
    }
    EXPECT_LE(length(force), 1e-9) << seed;
    EXPECT_LE(length(moment), 1e-8) << seed;
  }
}

TEST(BeamElement, RigidMotionHasTheMomentaOfTheRod) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const BeamElement e = random_beam(seed);
    const Vec3 origin = random_vector(seed, 700, 3), v = random_vector(seed, 701, 1),
               w = random_vector(seed, 702, 1);
    const Vec3 centre = origin + e.arm_a + (e.length / 2) * e.axes.x;
    const double l = e.length, line = e.mass * l * l * l / 12;
    const double y = e.polar * e.eiy / (e.eiy + e.eiz);
    const Vec3 local = into(e.axes, w);
    const Vec3 spin = e.axes * Vec3{e.polar * l * local.x, (line + y * l) * local.y,
                                    (line + (e.polar - y) * l) * local.z};
    const Vec3 momentum = e.mass * l * (v + cross(w, centre));
    const Vec3 about_origin = cross(centre, momentum) + spin;
    const Twelve u = rigid_motion(e, origin, v, w), p = times(mass_of(e), u);
    const Vec3 b = origin + e.arm_a + l * e.axes.x - e.arm_b;
    const double size = 1e-13 * e.mass * l * 10;
    expect_near(part(p, 0) + part(p, 6), momentum, size);
    expect_near(part(p, 3) + part(p, 9) + cross(origin, part(p, 0)) + cross(b, part(p, 6)),
                about_origin, 10 * size);
    double twice_energy = 0;
    for (std::size_t i = 0; i < 12; ++i) twice_energy += u[i] * p[i];
    expect_relative(twice_energy, dot(momentum, v) + dot(about_origin, w));
  }
}

/// A straight row of equal elements along x.
struct Row {
  Structure stiffness, mass, bow;  ///< bow: geometric stiffness under tension 1
  Row(BeamElement e, double length, std::size_t count)
      : stiffness(count + 1), mass(count + 1), bow(count + 1) {
    e.length = length / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
      stiffness.add(e, i, i + 1);
      mass.add(mass_of(e), i, i + 1);
      bow.add(geometric_stiffness_of(e, 1), i, i + 1);
    }
  }
  void hold(std::size_t node, std::initializer_list<std::size_t> freedoms) {
    for (Structure* each : {&stiffness, &mass, &bow}) each->hold(node, freedoms);
  }
  /// Square of a frequency, rad²/s².
  double frequency(int number, double bound) const {
    return eigenvalue(stiffness.reduced(), mass.reduced(0), number, bound);
  }
  double buckling_load(double bound) const {
    return eigenvalue(stiffness.reduced(), bow.reduced(0), 1, bound);
  }
};

/// Bends about z only, at the loads and frequencies asked for.
BeamElement flat(double ei, double ga) {
  BeamElement e = beam(1);
  e.eiz = ei;
  e.eiy = 1e4 * ei;
  e.gay = ga;
  e.gaz = 0;
  e.gj = 1e4 * ei;
  e.ea = 1e4 * ei;
  e.polar = 0;
  return e;
}

TEST(BeamElement, CantileverOfEightSwingsAsTheContinuum) {
  const double l = 4, ei = 1e6;
  const BeamElement e = flat(ei, 0);
  Row row(e, l, 8);
  row.hold(0, {0, 1, 2, 3, 4, 5});
  const double roots[]{1.875104068711961, 4.694091132974175, 7.854757438237613};
  for (int i = 0; i < 3; ++i) {
    const double beta = roots[i] / l, exact = ei / e.mass * std::pow(beta, 4);
    const double ratio = row.frequency(i + 1, 2 * exact) / exact;
    const double known = std::pow(beta * l / 8, 4) / 720;  // of cubic shapes, leading term
    EXPECT_NEAR((ratio - 1) / known, 1, 0.15) << "mode " << i + 1 << ": " << ratio;
  }
}

TEST(BeamElement, ThickHingedBeamSwingsAsTimoshenko) {
  const double l = 4, ei = 1e6, ga = 2e6, rotary = 4;
  BeamElement e = flat(ei, ga);
  e.polar = rotary * 10001;  // its share about z is `rotary`
  const double k2 = kPi * kPi / (l * l);
  const double a = e.mass * rotary / ga, b = e.mass + rotary * k2 + e.mass * ei * k2 / ga;
  const double exact = (b - std::sqrt(b * b - 4 * a * ei * k2 * k2)) / (2 * a);
  const auto excess = [&](std::size_t count) {
    Row row(e, l, count);
    row.hold(0, {0, 1, 2, 3, 4});
    row.hold(count, {1, 2, 3, 4});
    return row.frequency(1, 2 * exact) / exact - 1;
  };
  // Shear that is constant along an element: second order, from above.
  const double eight = excess(8), sixteen = excess(16);
  EXPECT_GT(sixteen, 0);
  EXPECT_LT(sixteen, 1e-3);
  EXPECT_NEAR((4 * sixteen - eight) / 3, 0, 1e-5);
}

TEST(BeamElement, ColumnsOfEightBuckleAtEulersLoads) {
  using Freedoms = std::initializer_list<std::size_t>;
  struct Case {
    const char* name;
    Freedoms foot, head;
    double factor, kl, printed;  ///< of π²EI/L²; √(P/EI) L; the factor with eight elements
  };
  const Freedoms fixed{0, 1, 2, 3, 4, 5}, guided{1, 2, 3, 4, 5}, pinned{1, 2, 3, 4};
  const Freedoms foot_pin{0, 1, 2, 3, 4};
  const double ei = 1e6, l = 3.5, tan_root = 4.493409457909064;
  for (const Case& c :
       {Case{"fixed-free", fixed, {}, 0.25, kPi / 2, 0.2500},
        Case{"pinned", foot_pin, pinned, 1, kPi, 1.0000},
        Case{"fixed-fixed", fixed, guided, 4, 2 * kPi, 4.002},
        Case{"fixed-pinned", fixed, pinned, tan_root * tan_root / kPi / kPi, tan_root, 2.0460}}) {
    Row row(flat(ei, 0), l, 8);
    row.hold(0, c.foot);
    row.hold(8, c.head);
    const double euler = kPi * kPi * ei / (l * l);
    const double factor = row.buckling_load(6 * euler) / euler;
    const double known = std::pow(c.kl / 8, 4) / 720;
    EXPECT_NEAR((factor / c.factor - 1) / known, 1, 0.1) << c.name << ": " << factor;
    EXPECT_NEAR(factor, c.printed, c.printed < 3 ? 5e-5 : 5e-4) << c.name;
  }
}

TEST(BeamElement, ShearLowersTheBucklingLoad) {
  const double ei = 1e6, l = 3.5, ga = 1e6;
  const double euler = kPi * kPi * ei / (4 * l * l), engesser = euler / (1 + euler / ga);
  const auto excess = [&](std::size_t count) {
    Row row(flat(ei, ga), l, count);
    row.hold(0, {0, 1, 2, 3, 4, 5});
    return row.buckling_load(2 * euler) / engesser - 1;
  };
  const double eight = excess(8), sixteen = excess(16);  // second order, as in vibration
  EXPECT_GT(sixteen, 0);
  EXPECT_LT(sixteen, 2e-4);
  EXPECT_NEAR((4 * sixteen - eight) / 3, 0, 1e-6);
}

TEST(BeamElement, RigidTopOfAColumnTakesPartInBuckling) {
  const double ei = 1e6, elastic = 3, rigid = 0.8;
  Structure k(5), bow(5);
  for (std::size_t i = 0; i < 4; ++i) {
    BeamElement e = flat(ei, 0);
    e.length = elastic / 4;
    if (i == 3) e.arm_b = {-rigid, 0, 0};
    k.add(e, i, i + 1);
    bow.add(geometric_stiffness_of(e, 1), i, i + 1);
  }
  k.hold(0);
  bow.hold(0);
  double low = 0.01, high = kPi / 2 / elastic;  // root of c k tan(k L) = 1
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    (rigid * middle * std::tan(middle * elastic) < 1 ? low : high) = middle;
  }
  const double exact = ei * low * low;
  const double ratio = eigenvalue(k.reduced(), bow.reduced(0), 1, 3 * exact) / exact;
  EXPECT_GT(ratio, 1);
  EXPECT_LT(ratio, 1 + 1e-4);
}

TEST(BeamElement, HingedEndsBuckleInTheShapeOfTheirStiffness) {
  const double ei = 1e6, l = 3.5;
  BeamElement foot = flat(ei, 0), head = foot;
  foot.length = head.length = l / 2;
  foot.spring_a.z = head.spring_b.z = kFree;
  Structure k(3), bow(3);
  k.add(foot, 0, 1);
  k.add(head, 1, 2);
  bow.add(geometric_stiffness_of(foot, 1), 0, 1);
  bow.add(geometric_stiffness_of(head, 1), 1, 2);
  for (Structure* each : {&k, &bow}) {
    each->hold(0);
    each->hold(2, {1, 2, 3, 4, 5});
  }
  // Rayleigh's quotient of the shape of a mid load, (3 s − s³)/2 in both halves: 10 EI/L².
  const double critical = 10 * ei / (l * l);
  expect_relative(eigenvalue(k.reduced(), bow.reduced(0), 1, 3 * critical), critical);
}

}  // namespace
}  // namespace sunder
