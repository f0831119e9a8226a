// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "fracture/asset.hpp"

namespace sunder {

inline bool same(const Bond& p, const Bond& q) {
  return p.a == q.a && p.b == q.b && p.area == q.area && p.centroid == q.centroid &&
         p.normal == q.normal;
}
inline bool same(const MassProperties& p, const MassProperties& q) {
  return p.volume == q.volume && p.centroid == q.centroid && p.inertia == q.inertia;
}
template <class T>
bool all_same(const std::vector<T>& p, const std::vector<T>& q) {
  return std::equal(p.begin(), p.end(), q.begin(), q.end(),
                    [](const T& a, const T& b) { return same(a, b); });
}

/// Every number of two walls is the same.
inline void expect_same(const WallAsset& p, const WallAsset& q, const std::string& what) {
  EXPECT_EQ(p.pattern.vertices, q.pattern.vertices) << what;
  EXPECT_EQ(p.pattern.cell_begin, q.pattern.cell_begin) << what;
  EXPECT_EQ(p.pattern.corners, q.pattern.corners) << what;
  EXPECT_EQ(p.pattern.across, q.pattern.across) << what;
  EXPECT_EQ(p.pattern.hole_begin, q.pattern.hole_begin) << what;
  EXPECT_EQ(p.pattern.origin, q.pattern.origin) << what;
  EXPECT_EQ(p.pattern.all_convex, q.pattern.all_convex) << what;
  EXPECT_EQ(p.region.places, q.region.places) << what;
  EXPECT_EQ(p.region.loop_begin, q.region.loop_begin) << what;
  EXPECT_EQ(p.wall.thickness, q.wall.thickness) << what;
  EXPECT_EQ(p.wall.region.outline, q.wall.region.outline) << what;
  EXPECT_EQ(p.wall.region.openings, q.wall.region.openings) << what;
  EXPECT_EQ(p.volume_expected, q.volume_expected) << what;
  EXPECT_TRUE(all_same(p.chunks, q.chunks)) << what;
  EXPECT_TRUE(all_same(p.bonds, q.bonds)) << what;
}

}  // namespace sunder
