// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/vec.hpp"
#include "sim/spin.hpp"

namespace sunder {

/// Axes in which a symmetric matrix is diagonal, right-handed, and the entries there.
struct PrincipalAxes {
  Axes axes;
  Vec3 moments;
};
/// Identity axes for a matrix that is diagonal already.
PrincipalAxes principal_axes(const SymMat3& matrix);

}  // namespace sunder
