// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fracture/pattern.hpp"

namespace sunder {

/// Length of all edges between cells, each counted from both sides, m.
inline double inner_length(const Pattern& pattern) {
  double sum = 0;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    for (const LoopRange loop : loops_of(pattern, cell))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k)
        if (!pattern.across[k].is_border())
          sum += length(pattern.vertices[pattern.corners[loop.next(k)]] -
                        pattern.vertices[pattern.corners[k]]);
  return sum;
}

}  // namespace sunder
