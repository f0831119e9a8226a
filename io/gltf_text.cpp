// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_text.hpp"

namespace sunder {

void GltfText::bounds(std::span<const float> positions) {
  float low[3] = {positions[0], positions[1], positions[2]};
  float high[3] = {positions[0], positions[1], positions[2]};
  for (std::size_t i = 3; i < positions.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float value = positions[i + k];
      low[k] = value < low[k] ? value : low[k];
      high[k] = value > high[k] ? value : high[k];
    }
  }
  const auto triple = [this](const float* values) {
    numbers({static_cast<double>(values[0]), static_cast<double>(values[1]),
             static_cast<double>(values[2])});
  };
  text(R"("min":)");
  triple(low);
  text(R"(,"max":)");
  triple(high);
}

}  // namespace sunder
