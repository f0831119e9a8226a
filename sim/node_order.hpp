// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace sunder {

/// Order in which to eliminate the nodes of a graph so that a Cholesky factor stays sparse: the
/// node eliminated first comes first. Edges may repeat in either direction; a != b. The same graph
/// gives the same order, but METIS draws from the C library's rand(), which is seeded anew here:
/// another thread that draws at the same time disturbs it.
std::vector<std::uint32_t> node_order(
    std::uint32_t nodes, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges);

}  // namespace sunder
