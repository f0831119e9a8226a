// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_element.hpp"

#include "sim/spin.hpp"

namespace sunder {
namespace {

/// Where the twelve numbers of an edge stand among the corners' 24.
std::size_t place_of(std::size_t edge, std::size_t i) {
  return i < 6 ? 6 * edge + i : 6 * ((edge + 1) % 4) + i - 6;
}

/// Turns the vectors of three that stand `step` apart from `first` on.
template <class Numbers>
void turn(const Quaternion& q, Numbers& numbers, std::size_t first, std::size_t step) {
  const Vec3 v = rotate(q, {numbers[first], numbers[first + step], numbers[first + 2 * step]});
  numbers[first] = v.x;
  numbers[first + step] = v.y;
  numbers[first + 2 * step] = v.z;
}

}  // namespace

PanelElement element_of(ChunkNetwork& network, const std::array<std::uint32_t, 4>& nodes,
                        const Quaternion& to_world, bool loaded) {
  PanelElement element{.nodes = nodes, .edges = network.edge_stiffness()};
  if (loaded) element.load = network.edge_load();
  for (EdgeStiffness& edge : element.edges) {
    for (std::size_t row = 0; row < 12; ++row)
      for (std::size_t c = 0; c < 24; c += 3) turn(to_world, edge, 24 * row + c, 1);
    for (std::size_t row = 0; row < 12; row += 3)
      for (std::size_t c = 0; c < 24; ++c) turn(to_world, edge, 24 * row + c, 24);
  }
  for (Twelve& load : element.load)
    for (std::size_t i = 0; i < 12; i += 3) turn(to_world, load, i, 1);
  return element;
}

PanelMatrix stiffness_of(const PanelElement& element) {
  PanelMatrix sum{}, result{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t r = 0; r < 12; ++r)
      for (std::size_t c = 0; c < 24; ++c)
        sum[24 * place_of(k, r) + c] += element.edges[k][24 * r + c];
  for (std::size_t r = 0; r < 24; ++r)
    for (std::size_t c = 0; c < 24; ++c)
      result[24 * r + c] = (sum[24 * r + c] + sum[24 * c + r]) / 2;
  return result;
}

}  // namespace sunder
