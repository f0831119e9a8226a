// SPDX-License-Identifier: GPL-3.0-or-later
#include "models/sample_models.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "meshing/repair.hpp"
#include "meshing/triangle_tree.hpp"

namespace {

using namespace sunder;

std::string file(const std::string& name) {
  std::ifstream in(std::string(SUNDER_SOURCE_DIR "/data/models/") + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

long euler(const TriMesh& mesh) {
  return static_cast<long>(mesh.vertices.size()) - static_cast<long>(mesh.triangles.size()) / 2;
}

TEST(SampleModels, FilesAreWhatTheGeneratorMakes) {
  for (const auto& [name, model] : {std::pair{"vase.obj", vase_model()},
                                    {"gear.stl", gear_model()},
                                    {"scan.ply", scan_model()}}) {
    EXPECT_TRUE(file(name) == model.bytes) << name;
    EXPECT_LT(model.bytes.size(), 300000u) << name;
  }
}

TEST(SampleModels, TheVaseIsASolidWithWallsOfFourMillimetres) {
  const TriMesh vase = vase_model().mesh;
  EXPECT_TRUE(diagnose(vase).is_solid()) << diagnose(vase).text();
  EXPECT_EQ(euler(vase), 2);
  EXPECT_NEAR(mass_properties(vase).volume, 0.00056048027, 1e-10);
}

TEST(SampleModels, TheGearIsASolidOfGenusSeven) {
  const TriMesh gear = gear_model().mesh;
  EXPECT_TRUE(diagnose(gear).is_solid()) << diagnose(gear).text();
  EXPECT_EQ(euler(gear), 2 - 2 * 7);
}

TEST(SampleModels, TheScanIsBrokenInManyWaysAndRepaired) {
  const TriMesh scan = scan_model().mesh;
  const Repair r = repair(flat_surface(scan), {.max_error = 0.02});
  using Kind = SurfaceDefect::Kind;
  for (const Kind kind :
       {Kind::open_edge, Kind::flipped_face, Kind::self_intersection, Kind::duplicate_face})
    EXPECT_GT(r.before.counts[static_cast<std::size_t>(kind)], 5u) << name_of(kind);
  EXPECT_TRUE(r.after.is_solid()) << r.after.text();
  EXPECT_TRUE(diagnose(r.surface).is_solid());
  EXPECT_EQ(euler(r.surface.mesh), 2);
  EXPECT_EQ(r.voxel, 0);  // its few folds are cut out: most of it stays as it is
  EXPECT_NE(r.steps.back().find("cut out with their neighbours"), std::string::npos);
  // Where the scan is whole, it stays: seen from the repaired surface but for the filled holes.
  EXPECT_LT(farthest(scan, TriangleTree(r.surface.mesh), 0.01), 0.1);
}

}  // namespace
