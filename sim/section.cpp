// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "meshing/trig.hpp"

// Shapes are sums and differences of rectangles and of the pieces between a
// right angle and a quarter circle that touches its sides: they fill the roots
// of an I and are cut off the corners of a tube. A disk is a square whose
// corners are cut that far.
namespace sunder {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInnerByOuterRadius = 2.0 / 3;  // EN 10210-2: 1.0 t and 1.5 t
constexpr int kLeastRoundCorners = 6;            // of a quarter of a round tube's outline
constexpr std::array<std::string_view, 3> kShapes{"i", "rhs", "chs"};
constexpr std::array<std::string_view, 5> kCurves{"a0", "a", "b", "c", "d"};

double square(double x) {
  return x * x;
}
double cube(double x) {
  return x * x * x;
}

/// Of a shape with two axes of symmetry: second moments about y and z; the
/// plastic moduli are the integrals of |z| and |y|.
struct Moments {
  double area = 0, iy = 0, iz = 0, wpl_y = 0, wpl_z = 0;
};
Moments operator+(const Moments& a, const Moments& b) {
  return {a.area + b.area, a.iy + b.iy, a.iz + b.iz, a.wpl_y + b.wpl_y, a.wpl_z + b.wpl_z};
}
Moments operator-(const Moments& a, const Moments& b) {
  return {a.area - b.area, a.iy - b.iy, a.iz - b.iz, a.wpl_y - b.wpl_y, a.wpl_z - b.wpl_z};
}

Moments box_moments(double width, double height) {
  return {width * height, width * cube(height) / 12, height * cube(width) / 12,
          width * square(height) / 4, height * square(width) / 4};
}

// Of the piece between a right angle and a circle of radius 1, integrals over
// the unit square less those over the quarter disk; first and second moment
// about a side.
constexpr double kPieceArea = 1 - kPi / 4;
constexpr double kPieceFirst = 5.0 / 6 - kPi / 4;
constexpr double kPieceSecond = 1 - 5 * kPi / 16;
constexpr double kPieceCentre = kPieceFirst / kPieceArea;  // from either side

/// Four such pieces with their centres at (±y, ±z).
Moments piece_moments(double radius, double y, double z) {
  const double area = kPieceArea * square(radius);
  const double own = (kPieceSecond - kPieceFirst * kPieceCentre) * square(square(radius));
  return {4 * area, 4 * (own + area * square(z)), 4 * (own + area * square(y)), 4 * area * z,
          4 * area * y};
}

Moments rounded_box_moments(double width, double height, double radius) {
  const double inset = kPieceCentre * radius;
  return box_moments(width, height) - piece_moments(radius, width / 2 - inset, height / 2 - inset);
}

Moments i_moments(const Section& s) {
  const double clear = s.height - 2 * s.flange, inset = kPieceCentre * s.radius;
  return box_moments(s.width, s.height) - box_moments(s.width, clear) + box_moments(s.web, clear) +
         piece_moments(s.radius, s.web / 2 + inset, clear / 2 - inset);
}

/// Both kinds of tube: `radius` of the outer corners, `inner` of those of the
/// hole.
Moments tube_moments(const Section& s, double radius, double inner) {
  return rounded_box_moments(s.width, s.height, radius) -
         rounded_box_moments(s.width - 2 * s.web, s.height - 2 * s.web, inner);
}

void set_moments(Section& s, const Moments& m) {
  s.area = m.area;
  s.iy = m.iy;
  s.iz = m.iz;
  s.wel_y = 2 * m.iy / s.height;
  s.wel_z = 2 * m.iz / s.width;
  s.wpl_y = m.wpl_y;
  s.wpl_z = m.wpl_z;
}

void set_i(Section& s) {
  set_moments(s, i_moments(s));
  const double clear = s.height - 2 * s.flange;
  // Diameter of the circle inscribed where web and flange meet; alpha of El
  // Darwish and Johnston.
  const double circle =
      (square(s.radius + s.web / 2) + square(s.radius + s.flange) - square(s.radius)) /
      (2 * s.radius + s.flange);
  const double alpha = s.web / s.flange * (0.145 + 0.1 * s.radius / s.flange);
  s.it = 2.0 / 3 * (s.width - 0.63 * s.flange) * cube(s.flange) + clear * cube(s.web) / 3 +
         2 * alpha * square(square(circle));
  s.wt = s.it / std::max(s.web, s.flange);
  s.avy = s.area - clear * s.web;
  s.avz =
      std::max(s.area - 2 * s.width * s.flange + (s.web + 2 * s.radius) * s.flange, clear * s.web);
  const bool is_slender = s.height > 1.2 * s.width, is_thin = s.flange <= 0.04;
  const std::string_view curves = is_slender && is_thin ? "ab" : s.flange <= 0.1 ? "bc" : "dd";
  s.curve_y = curves[0];
  s.curve_z = curves[1];
}

void set_rhs(Section& s) {
  const double inner = kInnerByOuterRadius * s.radius, middle = (s.radius + inner) / 2;
  set_moments(s, tube_moments(s, s.radius, inner));
  const double width = s.width - s.web,
               height = s.height - s.web;  // of the wall's middle
  const double around = 2 * (width + height) - 2 * middle * (4 - kPi);
  const double enclosed = width * height - square(middle) * (4 - kPi);
  const double k = 2 * enclosed * s.web / around;
  s.it = cube(s.web) * around / 3 + 2 * k * enclosed;
  s.wt = s.it / (s.web + k / s.web);
  s.avy = s.area * s.width / (s.width + s.height);
  s.avz = s.area * s.height / (s.width + s.height);
  s.curve_y = s.curve_z = 'a';
}

void set_chs(Section& s) {
  set_moments(s, tube_moments(s, s.height / 2, s.height / 2 - s.web));
  s.it = 2 * s.iy;
  s.wt = 2 * s.wel_y;
  s.avy = s.avz = 2 * s.area / kPi;
  s.curve_y = s.curve_z = 'a';
}

/// Appends a quarter of a circle that starts at `turns`, counter-clockwise or
/// clockwise.
void append_arc(Loop& loop, Vec2 centre, double radius, double turns, int corners, bool clockwise) {
  for (int i = 0; i < corners; ++i) {
    const double part = 0.25 * i / (corners - 1);
    const Vec2 corner = centre + radius * unit_at_turns(turns + (clockwise ? -part : part));
    if (loop.empty() || !(loop.back() == corner)) loop.push_back(corner);
  }
}

Loop rounded_box(double width, double height, double radius, int corners) {
  const double y = width / 2, z = height / 2;
  if (corners < 2 || radius == 0) return rectangle({width, height}, {-y, -z});
  Loop loop;
  append_arc(loop, {radius - y, radius - z}, radius, 0.5, corners, false);
  append_arc(loop, {y - radius, radius - z}, radius, 0.75, corners, false);
  append_arc(loop, {y - radius, z - radius}, radius, 0, corners, false);
  append_arc(loop, {radius - y, z - radius}, radius, 0.25, corners, false);
  if (loop.back() == loop.front()) loop.pop_back();
  return loop;
}

Loop circle(double radius, int corners) {
  Loop loop;
  const int count = 4 * std::max(corners, kLeastRoundCorners);
  for (int i = 0; i < count; ++i) {
    loop.push_back(radius * unit_at_turns(static_cast<double>(i) / count));
  }
  return loop;
}

/// One root of an I whose web and flange meet at `root`, passed clockwise.
void append_root(Loop& loop, Vec2 root, double radius, double turns, int corners) {
  if (corners < 2 || radius == 0) {
    loop.push_back(root);
  } else {
    const Vec2 side{std::copysign(radius, root.x), -std::copysign(radius, root.y)};
    append_arc(loop, root + side, radius, turns, corners, true);
  }
}

Loop i_outline(const Section& s, int corners) {
  const double y = s.width / 2, z = s.height / 2, web = s.web / 2, clear = z - s.flange;
  Loop loop{{-y, -z}, {y, -z}, {y, -clear}};
  append_root(loop, {web, -clear}, s.radius, 0.75, corners);
  append_root(loop, {web, clear}, s.radius, 0.5, corners);
  loop.insert(loop.end(), {{y, clear}, {y, z}, {-y, z}, {-y, clear}});
  append_root(loop, {-web, clear}, s.radius, 0.25, corners);
  append_root(loop, {-web, -clear}, s.radius, 0, corners);
  loop.push_back({-y, -clear});
  return loop;
}

std::string metres(const char* name, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return std::string(name) + " = " + text + " m";
}

std::string i_fault(const Section& s) {
  if (!(s.flange > 0)) return metres("flange", s.flange) + " is not above 0";
  if (!(2 * s.flange < s.height)) {
    return metres("2 flange", 2 * s.flange) + " is not below the " + metres("height", s.height);
  }
  if (!(s.web < s.width)) {
    return metres("web", s.web) + " is not below the " + metres("width", s.width);
  }
  const double room = std::min(s.height / 2 - s.flange, (s.width - s.web) / 2);
  if (!(s.radius <= room)) {
    return metres("radius", s.radius) + " is above the " + metres("room beside the web", room);
  }
  return {};
}

std::string tube_fault(const Section& s) {
  const double side = std::min(s.height, s.width);
  if (s.shape == "chs" && s.height != s.width) {
    return metres("width", s.width) + " of a round tube is not its " + metres("height", s.height);
  }
  if (!(2 * s.web < side)) {
    return metres("2 web", 2 * s.web) + " is not below the " + metres("side", side);
  }
  const double inner = kInnerByOuterRadius * s.radius;
  if (s.shape == "rhs" && !(s.radius <= side / 2 && inner <= side / 2 - s.web)) {
    return metres("radius", s.radius) + " leaves no hole with straight sides";
  }
  return {};
}

}  // namespace

template <>
std::span<const Field<Section>> fields() {
  using P = Section;
  constexpr Range kLength{0, 10, true}, kThickness{0, 1}, kArea{0, 100, true};
  constexpr Range kSecond{0, 1000, true}, kModulus{0, 1000, true};
  static const Field<P> table[] = {
      {.name = "name",
       .member = &P::name,
       .unit = "",
       .effect = "Letters, digits, _, - and . only, at most 40.",
       .required = true},
      {"shape",
       &P::shape,
       "",
       "i: two flanges and a web; rhs: rectangular or square tube; chs: round "
       "tube.",
       {},
       kShapes},
      {"height", &P::height, "m", "Along the web; of a round tube the diameter.", kLength},
      {"width", &P::width, "m", "Across the web; of a round tube left out.", kLength},
      {"web", &P::web, "m", "Thickness of the web or of a tube's wall.", {0, 1, true}},
      {"flange", &P::flange, "m", "Thickness of the flanges; of i only.", kThickness},
      {"radius", &P::radius, "m",
       "Of the fillets between web and flanges; of rhs: of the outer corners.", kThickness},
      {"area", &P::area, "m²", "Of the cross-section; this and what follows may be left out.",
       kArea},
      {"iy", &P::iy, "m⁴", "Second moment of area about the strong axis.", kSecond},
      {"iz", &P::iz, "m⁴", "Second moment of area about the weak axis.", kSecond},
      {"it", &P::it, "m⁴", "St. Venant torsion constant.", kSecond},
      {"wel_y", &P::wel_y, "m³", "Elastic section modulus about the strong axis.", kModulus},
      {"wel_z", &P::wel_z, "m³", "Elastic section modulus about the weak axis.", kModulus},
      {"wpl_y", &P::wpl_y, "m³", "Plastic section modulus about the strong axis.", kModulus},
      {"wpl_z", &P::wpl_z, "m³", "Plastic section modulus about the weak axis.", kModulus},
      {"avy", &P::avy, "m²", "Shear area across the web.", kArea},
      {"avz", &P::avz, "m²", "Shear area along the web.", kArea},
      {"wt", &P::wt, "m³", "Torque by the largest shear stress it causes.", kModulus},
      {"curve_y", &P::curve_y, "", "Buckling curve about the strong axis.", {}, kCurves},
      {"curve_z", &P::curve_z, "", "Buckling curve about the weak axis.", {}, kCurves},
      {"source", &P::source, "", "Where the numbers are from."},
  };
  return table;
}

template <>
std::span<const Field<SteelGrade>> fields() {
  using P = SteelGrade;
  static const Field<P> table[] = {
      {.name = "name",
       .member = &P::name,
       .unit = "",
       .effect = "Letters, digits, _, - and . only, at most 40.",
       .required = true},
      {"density", &P::density, "kg/m³", "Mass per volume.", {0, 1e5, true}},
      {"youngs_modulus", &P::youngs_modulus, "Pa", "Stiffness.", {0, 1e13, true}},
      {"poisson_ratio",
       &P::poisson_ratio,
       "",
       "Sideways strain by lengthwise strain.",
       {-1, 0.5, true}},
      {"yield_strength", &P::yield_strength, "Pa", "Stress at which it yields.", {0, 1e11, true}},
      {"ultimate_strength",
       &P::ultimate_strength,
       "Pa",
       "Stress at which it tears.",
       {0, 1e11, true}},
      {"source", &P::source, "", "Where the numbers are from."},
  };
  return table;
}

Region outline_of(const Section& section, int corners) {
  if (section.shape == "i") return {i_outline(section, corners), {}};
  const double hole = section.height / 2 - section.web;
  if (section.shape == "chs") {
    return {circle(section.height / 2, corners), {circle(hole, corners)}};
  }
  return {rounded_box(section.width, section.height, section.radius, corners),
          {rounded_box(section.width - 2 * section.web, section.height - 2 * section.web,
                       kInnerByOuterRadius * section.radius, corners)}};
}

Section with_properties(Section dimensions) {
  if (dimensions.shape == "i") {
    set_i(dimensions);
  } else if (dimensions.shape == "rhs") {
    set_rhs(dimensions);
  } else {
    set_chs(dimensions);
  }
  return dimensions;
}

std::string dimension_fault(const Section& section) {
  if (!(section.web > 0)) return metres("web", section.web) + " is not above 0";
  return section.shape == "i" ? i_fault(section) : tube_fault(section);
}

}  // namespace sunder
