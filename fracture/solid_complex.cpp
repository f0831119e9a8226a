// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_complex.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {

SolidFrame make_solid_frame(Vec3 low, Vec3 high) {
  const Vec3 size = high - low;
  const double half = std::max({size.x, size.y, size.z}) / 2;
  SolidFrame frame;
  frame.step = std::exp2(std::ceil(std::log2(half * (1 + 0x1p-20) / SolidFrame::kHalf)));
  const auto on_lattice = [&](double v) { return std::round(v / frame.step) * frame.step; };
  const Vec3 middle = low + 0.5 * size;
  frame.centre = {on_lattice(middle.x), on_lattice(middle.y), on_lattice(middle.z)};
  return frame;
}

void link_cells(SolidComplex& complex) {
  complex.cell_begin.assign(complex.cell_count + 1, 0);
  for (const auto& facet : complex.facets) {
    ++complex.cell_begin[facet.a + 1];
    ++complex.cell_begin[facet.b + 1];
  }
  for (std::uint32_t c = 0; c < complex.cell_count; ++c)
    complex.cell_begin[c + 1] += complex.cell_begin[c];
  std::vector<std::uint32_t> at(complex.cell_begin.begin(), complex.cell_begin.end() - 1);
  complex.cell_facets.resize(complex.cell_begin.back());
  for (std::uint32_t f = 0; f < complex.facets.size(); ++f) {
    complex.cell_facets[at[complex.facets[f].a]++] = f;
    complex.cell_facets[at[complex.facets[f].b]++] = f;
  }
}

}  // namespace sunder
