// SPDX-License-Identifier: GPL-3.0-or-later
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>

#include "io/export_recording.hpp"
#include "io/glb.hpp"
#include "io/part_mesh.hpp"
#include "io/sample_asset.hpp"
#include "io/sample_portal.hpp"
#include "meshing/error.hpp"
#include "meshing/tri_mesh.hpp"

namespace sunder {
namespace {

using Floats = std::vector<float>;

Glb written(const Recording& recording, const RecordingParams& params = {}) {
  const TestFolder folder;
  export_recording(recording, folder / "a.glb", params);
  return Glb(content_of(folder / "a.glb"));
}

Vec3 vector_at(const Floats& values, std::size_t i) {
  return {static_cast<double>(values[3 * i]), static_cast<double>(values[3 * i + 1]),
          static_cast<double>(values[3 * i + 2])};
}

Pose pose_of_node(const Json& node) {
  Pose pose;
  if (node.contains("translation")) {
    const Json& t = node["translation"];
    pose.position = {t[0], t[1], t[2]};
  }
  if (node.contains("rotation")) {
    const Json& r = node["rotation"];
    pose.rotation = {r[0], r[1], r[2], r[3]};
  }
  return pose;
}

double distance(const Pose& a, const Pose& b) {
  double worst = 0;
  for (const Vec3 v : {Vec3{}, Vec3{1, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, 3}}) {
    worst = std::max(worst, length(a * v - b * v));
  }
  return worst;
}

std::string error_of(const std::function<void()>& work, ErrorCode code) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

RecordedPart part_of(const Region& outline, double half_length, bool has_ends) {
  RecordedPart part;
  part.name = "part", part.outline = outline, part.half_length = half_length;
  part.has_ends = has_ends;
  return part;
}

// Corners at one place become one vertex.
TriMesh welded(const PartMesh& mesh) {
  TriMesh result;
  std::map<std::array<float, 3>, std::uint32_t> ids;
  std::vector<std::uint32_t> id_of;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const float* p = &mesh.positions[3 * v];
    const auto [place, is_new] = ids.try_emplace({p[0], p[1], p[2]}, ids.size());
    if (is_new) result.vertices.push_back(vector_at(mesh.positions, v));
    id_of.push_back(place->second);
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    result.triangles.push_back(
        {id_of[mesh.indices[i]], id_of[mesh.indices[i + 1]], id_of[mesh.indices[i + 2]]});
  }
  return result;
}

std::vector<RecordedPart> sample_parts() {
  std::vector<RecordedPart> parts;
  for (const bool has_ends : {false, true}) {
    parts.push_back(part_of(sample_tube(0.15, 0.13), 1.5, has_ends));
    parts.push_back(part_of(sample_i(0.3, 0.15, 0.01, 0.02), 0.4, has_ends));
    parts.push_back(part_of({rectangle({4, 2}, {-2, -1}), {}}, 0.1, has_ends));
    Region clockwise = sample_i(0.3, 0.15, 0.01, 0.02);
    std::ranges::reverse(clockwise.outline);
    parts.push_back(part_of(clockwise, 3, has_ends));
  }
  return parts;
}

TEST(PartMesh, IsClosedAndHasTheVolumeOfThePrism) {
  for (const RecordedPart& part : sample_parts()) {
    const TriMesh mesh = welded(part_mesh(part));
    EXPECT_EQ(check(mesh), MeshDefects());
    const double volume = area(part.outline) * 2 * part.half_length;
    EXPECT_NEAR(mass_properties(mesh).volume, std::abs(volume), 1e-6 * std::abs(volume));
  }
}

// A texture is neither stretched nor mirrored on any face.
TEST(PartMesh, TextureCoordinatesAreMetres) {
  for (const RecordedPart& part : sample_parts()) {
    const PartMesh mesh = part_mesh(part);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      Vec3 p[3];
      Vec2 uv[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t v = mesh.indices[i + k];
        p[k] = vector_at(mesh.positions, v);
        uv[k] = {static_cast<double>(mesh.uvs[2 * v]), static_cast<double>(mesh.uvs[2 * v + 1])};
      }
      const double in_space = length(cross(p[1] - p[0], p[2] - p[0]));
      EXPECT_NEAR(cross(uv[1] - uv[0], uv[2] - uv[0]), in_space, 2e-6);
      EXPECT_NEAR(length(uv[1] - uv[0]), length(p[1] - p[0]), 2e-6);
    }
  }
}

TEST(PartMesh, NormalsAreFlatOnPlatesAndSmoothOnTubes) {
  for (const RecordedPart& part : sample_parts()) {
    const bool is_round = !part.outline.openings.empty();
    const PartMesh mesh = part_mesh(part);
    double worst = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const Vec3 a = vector_at(mesh.positions, mesh.indices[i]);
      const Vec3 face = cross(vector_at(mesh.positions, mesh.indices[i + 1]) - a,
                              vector_at(mesh.positions, mesh.indices[i + 2]) - a);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t v = mesh.indices[i + k];
        const Vec3 n = vector_at(mesh.normals, v), p = vector_at(mesh.positions, v);
        const Vec3 radial = (length({p.x, p.y, 0}) > 0.14 ? 1 : -1) * Vec3{p.x, p.y, 0};
        const bool is_side = n.z == 0;
        const Vec3 expected = is_round && is_side ? radial : face;
        worst = std::max(worst, length(n - 1 / length(expected) * expected));
      }
    }
    EXPECT_LT(worst, 1e-4) << is_round;
  }
}

TEST(PartMesh, ZonesAtTheEndsAreHalfAMetreOrAQuarterLong) {
  for (const auto& [half_length, zone] : {std::pair(1.5, 0.5), std::pair(0.4, 0.2)}) {
    const PartMesh mesh = part_mesh(part_of(sample_tube(0.1, 0.09), half_length, true));
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const double z = vector_at(mesh.positions, v).z;
      for (const std::size_t end : {0u, 1u}) {
        const double from_end = end == 0 ? z + half_length : half_length - z;
        EXPECT_NEAR(static_cast<double>(mesh.nearness[2 * v + end]),
                    std::max(0.0, 1 - from_end / zone), 1e-6);
      }
    }
  }
}

TEST(ExportParts, EveryPartIsANodeAndEqualPartsShareTheirMesh) {
  const Glb glb = written(sample_portal());
  EXPECT_EQ(glb.json["nodes"].size(), 4u);
  EXPECT_EQ(glb.json["scenes"][0]["nodes"].size(), 4u);
  EXPECT_EQ(glb.json["meshes"].size(), 3u);
  const auto node = [&](const char* name) -> const Json& {
    return glb.json["nodes"][glb.node_of.at(name)];
  };
  EXPECT_EQ(node("post_0")["mesh"], node("post_1")["mesh"]);
  EXPECT_NE(node("post_0")["mesh"], node("beam")["mesh"]);
  std::set<std::string> materials;
  for (const Json& material : glb.json["materials"]) materials.insert(material["name"]);
  EXPECT_EQ(materials, (std::set<std::string>{"steel", "concrete-c30_outer"}));
  const Json& beam = node("beam")["extras"]["sunder"];
  EXPECT_EQ(beam["mass"], 500);
  EXPECT_EQ(beam["ends"], Json::parse(R"([["beam@post_0"],["beam@post_1"]])"));
  EXPECT_EQ(node("post_1")["extras"]["sunder"]["ends"],
            Json::parse(R"([["post_1@ground"],["beam@post_1"]])"));
  EXPECT_FALSE(node("slab")["extras"]["sunder"].contains("ends"));
  const Json& scene = glb.json["scenes"][0]["extras"]["sunder"];
  EXPECT_EQ(scene["parts"], 4);
  EXPECT_EQ(scene["members"], 3);
  EXPECT_EQ(scene["joints"], 5);
  EXPECT_EQ(scene["broken_joints"],
            Json::parse(R"([{"joint":"beam@post_1","time":0.5,"parts":["beam","post_1"]}])"));
}

TEST(ExportParts, PartsStandAndMoveAsRecorded) {
  const Recording portal = sample_portal();
  const Glb glb = written(portal);
  EXPECT_EQ(glb.json["animations"].size(), 1u);
  EXPECT_EQ(glb.json["animations"][0]["name"], "collapse");
  for (const RecordedPart& part : portal.parts) {
    EXPECT_LT(distance(pose_of_node(glb.json["nodes"][glb.node_of.at(part.name)]), part.standing),
              1e-6);
    const Json* moves = glb.sampler(part.name, "translation");
    ASSERT_EQ(moves != nullptr, part.track != kNoTrack) << part.name;
    if (!moves) continue;
    const Floats times = glb.values((*moves)["input"]), t = glb.values((*moves)["output"]);
    const Floats r = glb.values((*glb.sampler(part.name, "rotation"))["output"]);
    ASSERT_EQ(times.size(), 33u);  // the step before, then all it moves in
    for (std::size_t k = 0; k < times.size(); ++k) {
      EXPECT_EQ(static_cast<double>(times[k]), static_cast<double>(k + 32) / 64);
      const auto at = [&r, k](std::size_t i) { return static_cast<double>(r[4 * k + i]); };
      const Pose pose{vector_at(t, k), {at(0), at(1), at(2), at(3)}};
      const auto step = static_cast<std::uint32_t>(k + 32);
      EXPECT_LT(distance(pose, pose_at(portal, part.track, step, part.standing)), 2e-6);
    }
  }
}

TEST(ExportParts, WhatIsTakenAwayVanishesAtItsTime) {
  Recording portal = sample_portal();
  portal.parts[3].removed = 0;
  portal.parts[2].removed = 2;  // after the end
  const Glb glb = written(portal);
  const Json& scale = *glb.sampler("post_1", "scale");
  EXPECT_EQ(scale["interpolation"], "STEP");
  EXPECT_EQ(glb.values(scale["input"]), (Floats{47.0f / 64, 0.75f}));
  EXPECT_EQ(glb.values(scale["output"]), (Floats{1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(glb.values((*glb.sampler("slab", "scale"))["output"]), (Floats{0, 0, 0}));
  EXPECT_EQ(glb.sampler("beam", "scale"), nullptr);
}

TEST(ExportParts, WeightsAreTheUtilisationsAtTheEndsWithKeysWhereTheyChange) {
  const Glb glb = written(sample_portal());
  const auto keys = [&](const char* name) {
    const Json* sampler = glb.sampler(name, "weights");
    EXPECT_NE(sampler, nullptr) << name;
    EXPECT_EQ(sampler->value("interpolation", "LINEAR"), "LINEAR");
    return std::pair(glb.values((*sampler)["input"]), glb.values((*sampler)["output"]));
  };
  const Floats changes = {0, 15.0f / 32, 0.5f};
  EXPECT_EQ(keys("beam"), std::pair(changes, Floats{0, 0.25f, 0, 1, 1, 0,  //
                                                    0, 0.25f, 0, 1, 1, 0,  //
                                                    0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(keys("post_1"), std::pair(changes, Floats{0, 0, 0, 1, 1, 0,  //
                                                      0, 0, 0, 1, 1, 0,  //
                                                      0, 0, 0, 0, 0, 1}));
  const auto [times, weights] = keys("post_0");
  ASSERT_EQ(times.size(), 33u);
  for (std::size_t k = 0; k <= 32; ++k) {
    const float t = static_cast<float>(k) / 32;
    EXPECT_EQ(times[k], t);
    EXPECT_EQ(Floats(weights.begin() + 6 * static_cast<std::ptrdiff_t>(k),
                     weights.begin() + 6 * static_cast<std::ptrdiff_t>(k + 1)),
              (Floats{t, 0, 0, 0, t < 0.5f ? 0.25f : 1, 0}));
  }
  EXPECT_EQ(glb.sampler("slab", "weights"), nullptr);
}

// What a player shows: base + weights × targets, cut off at 0 and 1.
std::array<double, 3> shown(const Glb& glb, const Json& primitive, std::size_t v,
                            const Floats& weights) {
  const Floats base = glb.values(primitive["attributes"]["COLOR_0"]);
  std::array<double, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k) colour[k] = static_cast<double>(base[3 * v + k]);
  for (std::size_t w = 0; w < weights.size(); ++w) {
    const Floats target = glb.values(primitive["targets"][w]["COLOR_0"]);
    for (std::size_t k = 0; k < 3; ++k) {
      colour[k] += static_cast<double>(weights[w]) * static_cast<double>(target[3 * v + k]);
    }
  }
  for (double& channel : colour) channel = std::clamp(channel, 0.0, 1.0);
  return colour;
}

TEST(ExportParts, LightsOnMembersEndsArePureRedGreenYellowAndBlue) {
  const Glb glb = written(sample_portal());
  const Json& primitive = glb.primitive("beam");
  ASSERT_EQ(primitive["targets"].size(), 6u);
  const Floats positions = glb.values(primitive["attributes"]["POSITION"]);
  const Floats base = glb.values(primitive["attributes"]["COLOR_0"]);
  const std::pair<Floats, std::array<double, 3>> rows[] = {{{1, 0, 0, 0, 0, 0}, {1, 0, 0}},
                                                           {{0, 1, 0, 0, 0, 0}, {0, 1, 0}},
                                                           {{1, 1, 0, 0, 0, 0}, {1, 1, 0}},
                                                           {{0, 0, 1, 0, 0, 0}, {0, 0, 1}}};
  for (std::size_t v = 0; v < positions.size() / 3; v += 7) {
    const double z = vector_at(positions, v).z;
    const Vec3 own = vector_at(base, v);
    for (const auto& [weights, colour] : rows) {
      const std::array<double, 3> expected =
          z == -2 ? colour : std::array<double, 3>{own.x, own.y, own.z};
      EXPECT_EQ(shown(glb, primitive, v, weights), expected) << z;
    }
    // Without weights a plain grey, the same everywhere, that a white material does not change.
    EXPECT_EQ(own, vector_at(base, 0));
    EXPECT_NEAR(own.x, own.y, 0.03);
    EXPECT_LT(own.z, 0.2);
  }
  for (const Json& target : primitive["targets"]) {
    for (const float move : glb.values(target["POSITION"])) EXPECT_EQ(move, 0.0f);
  }
}

// Colours of a node's vertices at an end of the part (z), each once.
std::set<std::array<float, 3>> colours_at(const Glb& glb, const std::string& node, double z) {
  const Json& attributes = glb.primitive(node)["attributes"];
  const Floats positions = glb.values(attributes["POSITION"]);
  const Floats colours = glb.values(attributes["COLOR_0"]);
  std::set<std::array<float, 3>> result;
  for (std::size_t v = 0; v < positions.size() / 3; ++v) {
    if (std::abs(vector_at(positions, v).z - z) > 1e-6) continue;
    result.insert({colours[3 * v], colours[3 * v + 1], colours[3 * v + 2]});
  }
  return result;
}

TEST(ExportParts, AMomentHasItsColoursInTheVerticesAndNoAnimation) {
  using Colours = std::set<std::array<float, 3>>;
  const Colours red{{1, 0, 0}}, green{{0, 1, 0}}, yellow{{1, 1, 0}}, blue{{0, 0, 1}};
  const Glb before = written(sample_portal(), {.at = 30.0 / 64});
  const Glb after = written(sample_portal(), {.at = 1.0});
  for (const Glb* glb : {&before, &after}) {
    EXPECT_FALSE(glb->json.contains("animations"));
    for (const Json& mesh : glb->json["meshes"]) {
      EXPECT_FALSE(mesh["primitives"][0].contains("targets"));
    }
  }
  EXPECT_EQ(before.json["scenes"][0]["extras"]["sunder"]["at"], 30.0 / 64);
  EXPECT_TRUE(before.json["scenes"][0]["extras"]["sunder"]["broken_joints"].empty());
  EXPECT_EQ(colours_at(before, "beam", 2), yellow);
  EXPECT_EQ(colours_at(before, "post_1", 1.5), yellow);
  EXPECT_EQ(colours_at(after, "post_0", -1.5), red);
  EXPECT_EQ(colours_at(after, "post_0", 1.5), green);
  EXPECT_EQ(colours_at(after, "beam", -2), green);
  EXPECT_EQ(colours_at(after, "beam", 2), blue);
  // Its own colour between the zones, and half of the light half-way down a load.
  const std::array<float, 3> own = *colours_at(after, "beam", 1.5).begin();
  EXPECT_EQ(colours_at(after, "beam", -1.5), (Colours{own}));
  const Glb half = written(sample_portal(), {.at = 0.5});
  const std::array<float, 3> lit = *colours_at(half, "post_0", -1.5).begin();
  EXPECT_NEAR(lit[0], own[0] + 0.5f, 1e-6f);
  EXPECT_NEAR(lit[1], 0.5f * own[1], 1e-6f);
}

TEST(ExportParts, AMomentPutsPartsWhereTheyAreAndLeavesOutWhatIsGone) {
  const Recording portal = sample_portal();
  for (const auto& [at, step] : {std::pair(0.0, 0u), {0.6, 38u}, {0.7501, 48u}, {1.0, 64u}}) {
    const Glb glb = written(portal, {.at = at});
    for (const RecordedPart& part : portal.parts) {
      const Json& node = glb.json["nodes"][glb.node_of.at(part.name)];
      EXPECT_LT(distance(pose_of_node(node), pose_at(portal, part.track, step, part.standing)),
                1e-6);
      EXPECT_EQ(node.contains("mesh"), !(part.removed <= portal.times[step])) << part.name;
    }
  }
}

TEST(ExportParts, MembersWithoutLoadsShareOneMeshInAMoment) {
  Recording portal = sample_portal();
  for (JointSample& sample : portal.samples) sample = {};
  const Glb glb = written(portal, {.at = 0.25});
  EXPECT_EQ(glb.json["meshes"].size(), 3u);
  const auto mesh = [&](const char* name) {
    return glb.json["nodes"][glb.node_of.at(name)]["mesh"];
  };
  EXPECT_EQ(mesh("post_0"), mesh("post_1"));
  EXPECT_EQ(colours_at(glb, "post_0", -1.5), colours_at(glb, "post_0", 0.5 * 2));
  // With loads each has its own, of the same corners.
  const Glb lit = written(sample_portal(), {.at = 0.25});
  EXPECT_EQ(lit.json["meshes"].size(), 4u);
  EXPECT_EQ(lit.primitive("post_0")["attributes"]["POSITION"],
            lit.primitive("post_1")["attributes"]["POSITION"]);
}

TEST(ExportParts, WithoutSamplesOnlyFailuresShow) {
  Recording portal = sample_portal();
  portal.samples.clear();
  portal.sample_times.clear();
  const Glb glb = written(portal);
  EXPECT_EQ(glb.sampler("post_0", "weights"), nullptr);
  const Json& sampler = *glb.sampler("beam", "weights");
  EXPECT_EQ(glb.values(sampler["input"]), (Floats{0, 31.0f / 64, 0.5f}));
  EXPECT_EQ(glb.values(sampler["output"]).back(), 1.0f);
}

// Walls and projectiles beside a building, as animation and as a moment.
Recording portal_with_wall() {
  Recording recording = sample_portal();
  const SamplePlay play{.steps = 65, .step = 1.0 / 64, .hit = {1.5, 1}};
  Recording wall = sample_recording({sample_wall("facade", 6, 4)}, play);
  const auto shift = static_cast<std::uint32_t>(recording.tracks.size());
  for (Track& track : wall.tracks) {
    if (track.parent != kNoTrack) track.parent += shift;
    recording.tracks.push_back(track);
  }
  for (std::uint32_t& track : wall.walls[0].track) track += track == kNoTrack ? 0 : shift;
  wall.projectiles[0].track += shift;
  recording.walls = wall.walls;
  recording.projectiles = wall.projectiles;
  return recording;
}

TEST(ExportParts, AMomentPutsChunksAndProjectilesWhereTheyAre) {
  const Recording recording = portal_with_wall();
  const Glb glb = written(recording, {.at = 0.75});
  const RecordedWall& wall = recording.walls[0];
  std::size_t moved = 0;
  for (std::uint32_t c = 0; c < wall.track.size(); ++c) {
    const Json& node = glb.json["nodes"][glb.node_of.at(wall.asset.chunk_name(c))];
    EXPECT_LT(distance(pose_of_node(node), pose_at(recording, wall.track[c], 48, {})), 1e-6);
    moved += node.contains("translation");
  }
  EXPECT_GT(moved, 5u);
  const Pose ball = pose_at(recording, recording.projectiles[0].track, 48, {});
  EXPECT_LT(distance(pose_of_node(glb.json["nodes"][glb.node_of.at("ball")]), ball), 1e-6);
}

TEST(ExportParts, SameBytesTwiceAndOnAnyNumberOfThreads) {
  const Recording recording = portal_with_wall();
  const TestFolder folder;
  for (const std::string name : {"a.glb", "a.gltf", "a.obj"}) {
    std::optional<double> at;
    if (name == "a.obj") at = 0.6;
    const std::filesystem::path companion = name == "a.obj" ? "a.mtl" : "a.bin";
    export_recording(recording, folder / name, {.at = at, .threads = 1});
    const std::string first = content_of(folder / name);
    const std::string beside = content_of(folder / companion.string());
    export_recording(recording, folder / name, {.at = at, .threads = 2});
    EXPECT_FALSE(first.empty());
    EXPECT_TRUE(first == content_of(folder / name)) << name;
    EXPECT_TRUE(beside == content_of(folder / companion.string())) << name;
  }
}

TEST(ExportParts, AssimpReadsTheMomentAndTheAnimation) {
  const TestFolder folder;
  export_recording(portal_with_wall(), folder / "run.glb");
  export_recording(portal_with_wall(), folder / "at.glb", {.at = 1.0});
  export_recording(portal_with_wall(), folder / "at.obj", {.at = 1.0});
  for (const char* name : {"run.glb", "at.glb", "at.obj"}) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile((folder / name).string(), 0);
    ASSERT_NE(scene, nullptr) << name << importer.GetErrorString();
    EXPECT_EQ(scene->mNumAnimations, name == std::string("run.glb") ? 1u : 0u);
    unsigned tinted = 0;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
      const aiMesh& mesh = *scene->mMeshes[m];
      if (!mesh.HasVertexColors(0)) continue;
      const std::span colours(mesh.mColors[0], mesh.mNumVertices);
      tinted += std::ranges::any_of(colours, [](const aiColor4D& c) { return c.b < 0.9f; }) ? 1 : 0;
    }
    EXPECT_EQ(tinted, 2u) << name;  // of the posts, or the one that is left, and of the beam
    EXPECT_NE(scene->mRootNode->FindNode("beam"), nullptr) << name;
  }
}

struct ObjObject {
  std::vector<Vec3> points;
  std::vector<std::array<double, 3>> colours;
  std::string material;
  std::size_t faces = 0;
};

std::map<std::string, ObjObject> read_obj(const std::string& text) {
  std::map<std::string, ObjObject> objects;
  ObjObject* object = nullptr;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "o") {
      words >> word;
      object = &objects[word];
    } else if (word == "v") {
      Vec3& p = object->points.emplace_back();
      words >> p.x >> p.y >> p.z;
      std::array<double, 3> c{};
      if (words >> c[0] >> c[1] >> c[2]) object->colours.push_back(c);
    } else if (word == "usemtl") {
      words >> object->material;
    } else if (word == "f") {
      ++object->faces;
    }
  }
  return objects;
}

TEST(ExportParts, AnObjHoldsOneMomentWithColours) {
  const Recording recording = portal_with_wall();
  const TestFolder folder;
  export_recording(recording, folder / "a.obj", {.at = 1.0});
  const auto objects = read_obj(content_of(folder / "a.obj"));
  EXPECT_EQ(objects.size(), 3u + 1 + recording.walls[0].asset.chunks.size());
  EXPECT_FALSE(objects.contains("post_1"));
  const ObjObject& post = objects.at("post_0");
  EXPECT_EQ(post.material, "steel");
  ASSERT_EQ(post.colours.size(), post.points.size());
  EXPECT_EQ(post.points.size(), 4u * 48);  // four rings of two circles: the object is closed
  for (std::size_t v = 0; v < post.points.size(); ++v) {
    if (std::abs(post.points[v].y) < 1e-6) {
      EXPECT_EQ(post.colours[v], (std::array<double, 3>{1, 0, 0}));
    } else if (std::abs(post.points[v].y - 3) < 1e-6) {
      EXPECT_EQ(post.colours[v], (std::array<double, 3>{0, 1, 0}));
    }
  }
  EXPECT_EQ(objects.at("slab").material, "concrete-c30_outer");
  EXPECT_EQ(std::set(objects.at("slab").colours.begin(), objects.at("slab").colours.end()),
            (std::set<std::array<double, 3>>{{1, 1, 1}}));
  EXPECT_EQ(objects.at("slab").faces, 12u);
  const Pose slab = pose_at(recording, recording.parts[3].track, 64, {});
  for (const double x : {-2.0, 2.0}) {
    const Vec3 corner = slab * Vec3{x, 1, 0.1};
    EXPECT_TRUE(std::ranges::any_of(objects.at("slab").points,
                                    [&](Vec3 p) { return length(p - corner) < 1e-6; }));
  }
  const std::string materials = content_of(folder / "a.mtl");
  for (const char* name : {"steel", "steel_outer", "concrete-c30_outer", "concrete-c30_inner"}) {
    EXPECT_NE(materials.find("newmtl " + std::string(name) + "\n"), std::string::npos) << name;
  }
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.mtl", "a.obj"}));
}

TEST(ExportParts, AMomentOutsideOrInAnotherFormatIsAUsageError) {
  const Recording portal = sample_portal();
  const TestFolder folder;
  const auto message = [&](const char* name, std::optional<double> at) {
    return error_of([&] { export_recording(portal, folder / name, {.at = at}); }, ErrorCode::usage);
  };
  EXPECT_NE(message("a.obj", {}).find("one moment"), std::string::npos);
  EXPECT_NE(message("a.stl", 0.5).find(".obj"), std::string::npos);
  for (const double at : {-0.001, 1.001, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_NE(message("a.glb", at).find("outside the recording"), std::string::npos);
  }
  EXPECT_TRUE(is_recording_suffix(".obj", true));
  EXPECT_FALSE(is_recording_suffix(".obj"));
  EXPECT_TRUE(is_recording_suffix(".svg", true));
  EXPECT_FALSE(is_recording_suffix(".stl", true));
  EXPECT_TRUE(folder.names().empty());
}

TEST(ExportParts, AnUnsoundBuildingIsRefusedBeforeAnythingIsWritten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Row {
    const char* message;
    std::function<void(Recording&)> spoil;
  };
  const Row rows[] = {
      {"\"post 1\": its name", [](Recording& r) { r.parts[1].name = "post 1"; }},
      {"\"post_0\": its name is used twice", [](Recording& r) { r.parts[1].name = "post_0"; }},
      {"\"ball\": its name is used twice", [](Recording& r) { r.parts[1].name = "ball"; }},
      {"like a chunk's", [](Recording& r) { r.parts[1].name = "facade_chunk_0003"; }},
      {"its track does not exist", [](Recording& r) { r.parts[0].track = 9999; }},
      {"not finite", [&](Recording& r) { r.parts[0].standing.position.x = nan; }},
      {"not finite",
       [](Recording& r) {
         r.parts[0].standing.rotation = {1, 1, 0, 0};
       }},
      {"not finite", [](Recording& r) { r.parts[0].half_length = 0; }},
      {"not finite", [&](Recording& r) { r.parts[0].mass = nan; }},
      {"not finite", [&](Recording& r) { r.parts[0].removed = nan; }},
      {"material", [](Recording& r) { r.parts[0].material = ""; }},
      {"corner of its outline", [&](Recording& r) { r.parts[3].outline.outline[1].y = nan; }},
      {"part \"slab\"",
       [](Recording& r) {
         r.parts[3].outline.outline.pop_back(), r.parts[3].outline.outline.pop_back();
       }},
      {"part \"slab\"",
       [](Recording& r) {
         std::swap(r.parts[3].outline.outline[0], r.parts[3].outline.outline[1]);
       }},
      {"part \"post_0\"",
       [](Recording& r) {
         r.parts[0].outline.openings[0][2] = {3, 3};
       }},
      {"joint \"beam@post_0\"", [](Recording& r) { r.joints[2].part_a = 4; }},
      {"joint \"beam@post_0\"", [](Recording& r) { r.joints[2].part_b = 4; }},
      {"joint \"beam@post_0\"", [](Recording& r) { r.joints[2].end_a = 3; }},
      {"joint \"beam@post_0\"", [](Recording& r) { r.joints[2].end_b = 3; }},
      {"joint \"beam@post_0\"", [&](Recording& r) { r.joints[2].broken = nan; }},
      {"joint \"\": its name", [](Recording& r) { r.joints[2].name = ""; }},
      {"one load per joint", [](Recording& r) { r.samples.pop_back(); }},
      {"sampling times", [](Recording& r) { r.sample_times[3] = r.sample_times[2]; }},
      {"load of a joint", [](Recording& r) { r.samples[7].force_utilisation = NAN; }}};
  const TestFolder folder;
  for (const Row& row : rows) {
    Recording recording = portal_with_wall();
    row.spoil(recording);
    const std::string message =
        error_of([&] { export_recording(recording, folder / "a.glb"); }, ErrorCode::output);
    EXPECT_NE(message.find(row.message), std::string::npos) << row.message << " in " << message;
  }
  EXPECT_TRUE(folder.names().empty());
}

// Set up with: npm install --prefix tests/validate_gltf
TEST(ExportParts, KhronosValidatorFindsNoErrorsAndNoWarnings) {
  const std::string tool = SUNDER_SOURCE_DIR "/tests/validate_gltf";
  if (!std::filesystem::exists(tool + "/node_modules/gltf-validator")) {
    GTEST_SKIP() << "gltf-validator is not installed";
  }
  const TestFolder folder;
  export_recording(portal_with_wall(), folder / "a.glb");
  export_recording(sample_portal(), folder / "b.gltf");
  export_recording(portal_with_wall(), folder / "c.glb", {.at = 1.0});
  const std::string command = "cd '" + folder.path().string() + "' && node '" + tool +
                              "/validate.js' a.glb b.gltf c.glb > log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << content_of(folder / "log");
}

}  // namespace
}  // namespace sunder
