// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_element.hpp"

#include "sim/spin.hpp"

namespace sunder {

Matrix12 stiffness_of(ChunkNetwork& network, const Quaternion& to_world) {
  const PanelMatrix& whole = network.stiffness();
  Matrix12 turned;
  for (std::size_t r = 0; r < 12; ++r)
    for (std::size_t c = 0; c < 12; ++c)
      turned.at[12 * r + c] = whole[24 * (6 * (r / 3) + r % 3) + 6 * (c / 3) + c % 3];
  const auto turn = [&](std::size_t first, std::size_t step) {
    double *x = &turned.at[first], *y = x + step, *z = y + step;
    const Vec3 v = rotate(to_world, {*x, *y, *z});
    *x = v.x, *y = v.y, *z = v.z;
  };
  for (std::size_t r = 0; r < 12; ++r)
    for (std::size_t c = 0; c < 12; c += 3) turn(12 * r + c, 1);
  for (std::size_t r = 0; r < 12; r += 3)
    for (std::size_t c = 0; c < 12; ++c) turn(12 * r + c, 12);
  Matrix12 result;
  for (std::size_t r = 0; r < 12; ++r)
    for (std::size_t c = 0; c < 12; ++c)
      result.at[12 * r + c] = (turned.at[12 * r + c] + turned.at[12 * c + r]) / 2;
  return result;
}

}  // namespace sunder
