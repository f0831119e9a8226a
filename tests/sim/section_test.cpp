// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "io/sections.hpp"

namespace sunder {
namespace {

const Section& section_named(const std::string& name) {
  static const Section none;
  for (const Section& each : builtin_sections()) {
    if (each.name == name) return each;
  }
  ADD_FAILURE() << "no section " << name;
  return none;
}

/// Half a unit of the fourth digit.
double half_digit(double printed) {
  return 0.5 * std::pow(10, std::floor(std::log10(printed)) - 3);
}

/// What an outline tells by itself: integrals over polygons by Green's theorem.
struct Integrals {
  double area = 0, iy = 0, iz = 0, wpl_y = 0, wpl_z = 0;
};

/// Integral of |v| dA along one edge from (u0, v0) to (u1, v1), −∮ v|v|/2 du, split where v is 0.
double absolute_first(double u0, double v0, double u1, double v1) {
  if (v0 * v1 < 0) {
    const double u = u0 + (u1 - u0) * v0 / (v0 - v1);
    return absolute_first(u0, v0, u, 0) + absolute_first(u, 0, u1, v1);
  }
  const double sign = v0 + v1 < 0 ? -1 : 1;
  return -sign * (u1 - u0) * (v0 * v0 + v0 * v1 + v1 * v1) / 6;
}

Integrals integrate(const Loop& loop) {
  Integrals sum;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
    const double twice = cross(a, b);
    sum.area += twice / 2;
    sum.iy += twice * (a.y * a.y + a.y * b.y + b.y * b.y) / 12;
    sum.iz += twice * (a.x * a.x + a.x * b.x + b.x * b.x) / 12;
    sum.wpl_y += absolute_first(a.x, a.y, b.x, b.y);
    sum.wpl_z -= absolute_first(a.y, a.x, b.y, b.x);  // the axes swapped: the other way around
  }
  return sum;
}

Integrals integrate(const Region& region) {
  Integrals sum = integrate(region.outline);
  for (const Loop& opening : region.openings) {
    const Integrals hole = integrate(opening);
    sum.area -= hole.area;
    sum.iy -= hole.iy;
    sum.iz -= hole.iz;
    sum.wpl_y -= hole.wpl_y;
    sum.wpl_z -= hole.wpl_z;
  }
  return sum;
}

TEST(Sections, PrintedPropertiesAreThoseOfTheOutline) {
  constexpr double kArc = 1e-5;  // what 512 corners leave of an arc, relative, with room
  ASSERT_GE(builtin_sections().size(), 66u + 20u + 12u);
  for (const Section& s : builtin_sections()) {
    const Integrals found = integrate(outline_of(s, 512));
    const auto check = [&](const char* what, double printed, double value) {
      EXPECT_NEAR(printed, value, half_digit(printed) + kArc * value) << s.name << ' ' << what;
    };
    check("area", s.area, found.area);
    check("iy", s.iy, found.iy);
    check("iz", s.iz, found.iz);
    check("wel_y", s.wel_y, found.iy / (s.height / 2));
    check("wel_z", s.wel_z, found.iz / (s.width / 2));
    check("wpl_y", s.wpl_y, found.wpl_y);
    check("wpl_z", s.wpl_z, found.wpl_z);
  }
}

TEST(Sections, PrintedPropertiesAreThoseComputedFromTheDimensions) {
  for (const Section& s : builtin_sections()) {
    EXPECT_EQ(dimension_fault(s), "") << s.name;
    const Section computed = with_properties(s);
    for (const auto member : {&Section::area, &Section::iy, &Section::iz, &Section::it,
                              &Section::wel_y, &Section::wel_z, &Section::wpl_y, &Section::wpl_z,
                              &Section::avy, &Section::avz, &Section::wt}) {
      const double printed = s.*member, value = computed.*member;
      EXPECT_NEAR(printed, value, half_digit(printed) * (1 + 1e-9)) << s.name << ' ' << value;
    }
    EXPECT_EQ(s.curve_y, computed.curve_y) << s.name;
    EXPECT_EQ(s.curve_z, computed.curve_z) << s.name;
    EXPECT_NE(s.source, "") << s.name;
  }
}

// Mills' tables, cm: area, iy, iz, it, wpl_y, wpl_z; 0: not at hand.
struct Published {
  const char* name;
  double area, iy, iz, it, wpl_y, wpl_z;
};
constexpr Published kPublished[] = {
    {"HEB200", 78.08, 5696, 2003, 59.28, 642.5, 305.8},
    {"HEB300", 149.1, 25166, 8563, 185.0, 1868.7, 870.1},
    {"HEB400", 197.8, 57681, 0, 0, 3231.7, 0},
    {"HEA200", 53.83, 3692, 1336, 20.98, 429.5, 203.8},
    {"IPE200", 28.48, 1943, 142.4, 0, 220.6, 0},
    {"IPE300", 53.81, 8356, 603.8, 20.12, 628.4, 0},
    {"IPE400", 84.46, 23128, 1318, 51.08, 1307.1, 0},
    {"SHS100x5", 18.73, 279.4, 279.4, 439.4, 66.36, 66.36},
    {"RHS200x100x8", 44.75, 2234, 739.0, 1804, 282.0, 171.8},
    {"CHS168.3x8", 40.29, 1297, 1297, 2595, 205.7, 205.7},
};

TEST(Sections, AreThoseOfTheMillsTables) {
  for (const Published& row : kPublished) {
    const Section& s = section_named(row.name);
    const auto check = [&](const char* what, double value, double published) {
      if (published > 0) {
        EXPECT_NEAR(value, published, 2 * half_digit(published)) << row.name << ' ' << what;
      }
    };
    check("area", s.area * 1e4, row.area);
    check("iy", s.iy * 1e8, row.iy);
    check("iz", s.iz * 1e8, row.iz);
    check("it", s.it * 1e8, row.it);
    check("wpl_y", s.wpl_y * 1e6, row.wpl_y);
    check("wpl_z", s.wpl_z * 1e6, row.wpl_z);
  }
}

template <std::size_t kCount>
void expect_masses(const std::string& series, const std::array<double, kCount>& masses) {
  std::size_t row = 0;
  for (const Section& each : builtin_sections()) {
    if (!each.name.starts_with(series)) continue;
    ASSERT_LT(row, kCount) << each.name;
    const double digit = masses[row] < 100 ? 0.1 : 1;
    EXPECT_NEAR(each.area * 7850, masses[row], 0.6 * digit) << each.name;  // HEB260: 92.94
    ++row;
  }
  EXPECT_EQ(row, kCount) << series;
}

TEST(Sections, OfWholeSeriesWeighWhatTheMillsPrint) {
  expect_masses<24>("HEA", {16.7, 19.9, 24.7, 30.4, 35.5, 42.3, 50.5, 60.3, 68.2, 76.4, 88.3, 97.6,
                            105,  112,  125,  140,  155,  166,  178,  190,  204,  224,  252,  272});
  expect_masses<24>("HEB", {20.4, 26.7, 33.7, 42.6, 51.2, 61.3, 71.5, 83.2, 93.0, 103, 117, 127,
                            134,  142,  155,  171,  187,  199,  212,  225,  241,  262, 291, 314});
  expect_masses<18>("IPE", {6.0, 8.1, 10.4, 12.9, 15.8, 18.8, 22.4, 26.2, 30.7, 36.1, 42.2, 49.1,
                            57.1, 66.3, 77.6, 90.7, 106, 122});
}

TEST(Sections, HavePlasticResistancesOfTheReferenceColumns) {
  const double yield = 235e6;
  const Section &post = section_named("HEB300"), &beam = section_named("IPE300");
  EXPECT_NEAR(post.area * yield / 1e3, 3503, 1);
  EXPECT_NEAR(post.wpl_y * yield / 1e3, 439.1, 0.2);
  EXPECT_NEAR(post.wpl_z * yield / 1e3, 204.5, 0.1);
  EXPECT_NEAR(beam.area * yield / 1e3, 1265, 1);
  EXPECT_NEAR(beam.wpl_y * yield / 1e3, 147.7, 0.1);
  EXPECT_NEAR(beam.wpl_z * yield / 1e3, 29.4, 0.1);
  EXPECT_NEAR(beam.avz * yield / std::sqrt(3) / 1e3, 348, 0.5);
}

TEST(Sections, WithoutFilletsAreSumsOfRectangles) {
  const Section s =
      with_properties({.shape = "i", .height = 0.4, .width = 0.2, .web = 0.01, .flange = 0.02});
  EXPECT_NEAR(s.area, 2 * 0.2 * 0.02 + 0.36 * 0.01, 1e-16);
  EXPECT_NEAR(s.iy, (0.2 * 0.064 - 0.19 * 0.046656) / 12, 1e-17);
  EXPECT_NEAR(s.iz, 2 * 0.02 * 0.008 / 12 + 0.36 * 1e-6 / 12, 1e-18);
  EXPECT_NEAR(s.wpl_y, 0.2 * 0.02 * 0.38 + 0.01 * 0.1296 / 4, 1e-16);
  EXPECT_NEAR(s.wpl_z, 0.02 * 0.04 / 2 + 0.36 * 1e-4 / 4, 1e-17);
  EXPECT_NEAR(s.avz, 0.36 * 0.01 + 0.01 * 0.02, 1e-16);
  EXPECT_NEAR(s.avy, 2 * 0.2 * 0.02, 1e-16);
  const Section tube = with_properties({.shape = "rhs", .height = 0.2, .width = 0.1, .web = 0.01});
  EXPECT_NEAR(tube.area, 0.1 * 0.2 - 0.08 * 0.18, 1e-17);
  EXPECT_NEAR(tube.iy, (0.1 * 0.008 - 0.08 * 0.005832) / 12, 1e-18);
  EXPECT_NEAR(tube.wpl_z, (0.2 * 0.01 - 0.18 * 0.0064) / 4, 1e-18);
}

TEST(Sections, OfRoundTubesAreThoseOfRings) {
  constexpr double kPi = std::numbers::pi;
  const Section s = with_properties({.shape = "chs", .height = 0.2, .width = 0.2, .web = 0.02});
  EXPECT_NEAR(s.area, kPi * (0.01 - 0.0064), 1e-16);
  EXPECT_NEAR(s.iy, kPi / 4 * (1e-4 - 0.4096e-4), 1e-18);
  EXPECT_NEAR(s.it, kPi / 2 * (1e-4 - 0.4096e-4), 1e-18);
  EXPECT_NEAR(s.wpl_y, (0.008 - 0.004096) / 6, 1e-17);
  EXPECT_NEAR(s.wt, s.it / 0.1, 1e-16);
  EXPECT_NEAR(s.avy, 2 * s.area / kPi, 1e-17);
}

/// Bredt: a thin closed tube has it = 4 A_m² t/u and wt = 2 A_m t.
TEST(Sections, OfThinTubesTwistAsBredtSays) {
  const double t = 1e-5, width = 0.1 - t, height = 0.2 - t, around = 2 * (width + height);
  const Section s = with_properties({.shape = "rhs", .height = 0.2, .width = 0.1, .web = t});
  const double enclosed = width * height;
  EXPECT_NEAR(s.it / (4 * enclosed * enclosed * t / around), 1, 1e-6);
  EXPECT_NEAR(s.wt / (2 * enclosed * t), 1, 1e-3);
}

/// A thin plate: it = Σ b t³/3, and the whole twist is in the flanges and the web.
TEST(Sections, OfThinPlatesTwistAsPlatesSay) {
  const Section s =
      with_properties({.shape = "i", .height = 1.002, .width = 1, .web = 0.002, .flange = 0.002});
  EXPECT_NEAR(s.it / (8e-9 / 3 * (1 + 1 + 0.998)), 1, 2e-3);
  EXPECT_NEAR(s.wt, s.it / 0.002, 1e-18);
}

TEST(Sections, GrowWithTheirSize) {
  for (const std::string name : {"HEB300", "RHS200x100x8", "CHS168.3x8"}) {
    const Section small = with_properties(section_named(name));
    Section doubled = small;
    for (const auto member :
         {&Section::height, &Section::width, &Section::web, &Section::flange, &Section::radius}) {
      doubled.*member *= 2;
    }
    doubled = with_properties(doubled);
    const auto expect_power = [&](double Section::*member, double times) {
      EXPECT_NEAR(doubled.*member / (small.*member * times), 1, 1e-13) << name;
    };
    for (const auto member : {&Section::area, &Section::avy, &Section::avz}) {
      expect_power(member, 4);
    }
    for (const auto member : {&Section::wel_y, &Section::wpl_z, &Section::wt}) {
      expect_power(member, 8);
    }
    for (const auto member : {&Section::iy, &Section::iz, &Section::it}) expect_power(member, 16);
  }
}

TEST(Sections, HaveTheCurvesOfTheirProportions) {
  const auto curves = [](double height, double flange) {
    const Section s = with_properties(
        {.shape = "i", .height = height, .width = 0.3, .web = 0.01, .flange = flange});
    return s.curve_y + s.curve_z;
  };
  EXPECT_EQ(curves(0.6, 0.04), "ab");
  EXPECT_EQ(curves(0.6, 0.041), "bc");
  EXPECT_EQ(curves(0.36, 0.02), "bc");
  EXPECT_EQ(curves(0.3, 0.1), "bc");
  EXPECT_EQ(curves(0.3, 0.101), "dd");
  EXPECT_EQ(section_named("SHS100x5").curve_z, "a");
}

TEST(Sections, HaveOutlinesThatTurnOnceAndHaveTheirSize) {
  for (const int corners : {0, 2, 3, 8}) {
    for (const std::string name : {"IPE300", "HEB300", "SHS200x10", "CHS168.3x8"}) {
      const Section& s = section_named(name);
      const Region region = outline_of(s, corners);
      EXPECT_GT(area(region.outline), 0) << "counter-clockwise: " << name;
      EXPECT_EQ(region.openings.size(), s.shape == "i" ? 0u : 1u);
      const Box box = bounding_box(region.outline);
      EXPECT_NEAR(box.high.x - box.low.x, s.width, 1e-15);
      EXPECT_NEAR(box.high.y - box.low.y, s.height, 1e-15);
      for (std::size_t i = 0; i < region.outline.size(); ++i) {
        const Vec2 next = region.outline[(i + 1) % region.outline.size()];
        EXPECT_GT(length(next - region.outline[i]), 1e-5) << name << " corner " << i;
      }
      // Exact predicates find no fault in it either.
      EXPECT_NO_THROW(make_lattice_region(region, make_lattice(box.low, box.high - box.low), name));
    }
  }
  EXPECT_EQ(outline_of(section_named("HEB300")).outline.size(), 12u);
  EXPECT_EQ(outline_of(section_named("HEB300"), 4).outline.size(), 8u + 16u);
  EXPECT_EQ(outline_of(section_named("SHS200x10"), 4).outline.size(), 16u);
  EXPECT_EQ(outline_of(section_named("CHS168.3x8")).outline.size(), 24u);
}

TEST(Sections, WithImpossibleDimensionsSayWhy) {
  const Section sound{
      .shape = "i", .height = 0.3, .width = 0.2, .web = 0.01, .flange = 0.02, .radius = 0.02};
  EXPECT_EQ(dimension_fault(sound), "");
  const auto fault = [&](double Section::*member, double value, const char* shape = "i") {
    Section s = sound;
    s.shape = shape;
    s.*member = value;
    return dimension_fault(s);
  };
  EXPECT_EQ(fault(&Section::flange, 0.15), "2 flange = 0.3 m is not below the height = 0.3 m");
  EXPECT_NE(fault(&Section::flange, 0), "");
  EXPECT_NE(fault(&Section::web, 0), "");
  EXPECT_NE(fault(&Section::web, 0.2), "");
  EXPECT_NE(fault(&Section::radius, 0.1), "");
  EXPECT_EQ(fault(&Section::radius, 0.095), "");
  EXPECT_NE(fault(&Section::web, 0.1, "rhs"), "");
  EXPECT_NE(fault(&Section::radius, 0.11, "rhs"), "");
  EXPECT_EQ(fault(&Section::width, 0.3, "chs"), "");
  EXPECT_NE(fault(&Section::width, 0.2, "chs"), "");
}

}  // namespace
}  // namespace sunder
