// SPDX-License-Identifier: GPL-3.0-or-later
// Nested dissection by METIS: G. Karypis, V. Kumar, "A fast and high quality multilevel scheme for
// partitioning irregular graphs", SIAM J. Sci. Comput. 20 (1998) 359-392.
#include <metis.h>

#include <algorithm>
#include <numeric>

#include "meshing/error.hpp"
#include "sim/node_order.hpp"

namespace sunder {
namespace {

constexpr idx_t kSeed = 1;

}  // namespace

std::vector<std::uint32_t> node_order(
    std::uint32_t nodes, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges) {
  std::vector<std::uint32_t> order(nodes);
  std::iota(order.begin(), order.end(), 0u);
  if (nodes < 3 || edges.empty()) return order;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> both;
  both.reserve(2 * edges.size());
  for (const auto& [a, b] : edges) {
    both.emplace_back(a, b);
    both.emplace_back(b, a);
  }
  std::sort(both.begin(), both.end());
  both.erase(std::unique(both.begin(), both.end()), both.end());
  std::vector<idx_t> start(nodes + 1, 0), neighbours(both.size());
  for (std::size_t i = 0; i < both.size(); ++i) {
    ++start[both[i].first + 1];
    neighbours[i] = static_cast<idx_t>(both[i].second);
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = kSeed;
  options[METIS_OPTION_NUMBERING] = 0;
  idx_t count = static_cast<idx_t>(nodes);
  std::vector<idx_t> node_at(nodes), place_of(nodes);
  if (METIS_NodeND(&count, start.data(), neighbours.data(), nullptr, options, node_at.data(),
                   place_of.data()) != METIS_OK) {
    throw Error(ErrorCode::input, "node order: METIS failed on " + std::to_string(nodes) +
                                      " nodes: too little memory?");
  }
  std::copy(node_at.begin(), node_at.end(), order.begin());
  return order;
}

}  // namespace sunder
