// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/tri_mesh.hpp"

#include <gtest/gtest.h>

namespace sunder {
namespace {

TriMesh box(Vec3 size, Vec3 at) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        {at.x + (i & 1 ? size.x : 0), at.y + (i & 2 ? size.y : 0), at.z + (i & 4 ? size.z : 0)});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(MassProperties, ABoxHasItsClosedForm) {
  const Vec3 size{2, 3, 5};
  const MassProperties m = mass_properties(box(size, {10, -20, 30}));
  EXPECT_NEAR(m.volume, 30, 1e-13);
  EXPECT_NEAR(m.centroid.x, 11, 1e-13);
  EXPECT_NEAR(m.centroid.y, -18.5, 1e-13);
  EXPECT_NEAR(m.centroid.z, 32.5, 1e-13);
  EXPECT_NEAR(m.inertia.xx, 30.0 * (9 + 25) / 12, 1e-11);
  EXPECT_NEAR(m.inertia.yy, 30.0 * (4 + 25) / 12, 1e-11);
  EXPECT_NEAR(m.inertia.zz, 30.0 * (4 + 9) / 12, 1e-11);
  EXPECT_NEAR(m.inertia.xy, 0, 1e-11);
}

TEST(MassProperties, ARightTetrahedronHasItsClosedForm) {
  const TriMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                     {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const MassProperties m = mass_properties(mesh);
  EXPECT_NEAR(m.volume, 1.0 / 6, 1e-16);
  EXPECT_NEAR(m.centroid.x, 0.25, 1e-16);
  // ∫x² = 1/60, ∫xy = 1/120 about the corner; moved to the centroid.
  EXPECT_NEAR(m.inertia.xx, 2 * (1.0 / 60 - 1.0 / 96), 1e-16);
  EXPECT_NEAR(m.inertia.xy, -(1.0 / 120 - 1.0 / 96), 1e-16);
}

TEST(MassProperties, AFarOriginCostsNoDigits) {
  const MassProperties near = mass_properties(box({1, 1, 1}, {0, 0, 0}));
  const MassProperties far = mass_properties(box({1, 1, 1}, {1 << 20, 1 << 20, 0}));
  EXPECT_EQ(near.volume, far.volume);
  EXPECT_EQ(near.inertia, far.inertia);
}

TEST(MeshCheck, FindsEveryKindOfFault) {
  const TriMesh good = box({1, 1, 1}, {});
  EXPECT_EQ(check(good), MeshDefects{});
  TriMesh open = good;
  open.triangles.pop_back();
  EXPECT_EQ(check(open).open_edges, 3u);
  TriMesh flipped = good;
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_GT(check(flipped).nonmanifold_edges, 0u);
  TriMesh inside_out = good;
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(check(inside_out).inside_out);
  TriMesh wild = good;
  wild.triangles[3][1] = 99;
  EXPECT_EQ(check(wild).bad_indices, 1u);
  TriMesh flat = good;
  flat.triangles.push_back({0, 1, 1});
  EXPECT_EQ(check(flat).degenerate_triangles, 1u);
}

}  // namespace
}  // namespace sunder
