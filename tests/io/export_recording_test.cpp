// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/export_recording.hpp"

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "io/export.hpp"
#include "io/glb.hpp"
#include "io/sample_asset.hpp"
#include "io/sample_recording.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

Glb written(const Recording& recording) {
  const TestFolder folder;
  export_recording(recording, folder / "a.glb");
  return Glb(content_of(folder / "a.glb"));
}

Recording random_recording(std::uint64_t seed) {
  std::vector<WallAsset> walls;
  walls.push_back(sample_wall("facade", 6, 4, seed));
  walls.push_back(sample_wall("side", 3, 2, seed + 1));
  walls[0].wall.position = {3 * random_unit(seed, 90), 0.5, -4 * random_unit(seed, 91)};
  walls[0].wall.rotation = rotation_from_degrees({5, 360 * random_unit(seed, 92), 20});
  walls[1].wall.position = {8, 0, 1};
  return sample_recording(walls, {.steps = 90, .hit = {1.5, 1}, .seed = seed});
}

Pose pose_in(const std::vector<float>& t, const std::vector<float>& r, std::size_t key) {
  const auto at = [](float value) { return static_cast<double>(value); };
  return {{at(t[3 * key]), at(t[3 * key + 1]), at(t[3 * key + 2])},
          {at(r[4 * key]), at(r[4 * key + 1]), at(r[4 * key + 2]), at(r[4 * key + 3])}};
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

TEST(ExportRecording, EveryKeyPutsEveryChunkWhereItWasRecorded) {
  double worst = 0;
  std::size_t keys = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Recording recording = random_recording(seed);
    const Glb glb = written(recording);
    std::map<float, std::uint32_t> step_at;
    for (std::uint32_t i = 0; i < recording.times.size(); ++i) {
      step_at[static_cast<float>(recording.times[i])] = i;
    }
    for (const RecordedWall& wall : recording.walls) {
      const Pose standing{wall.asset.wall.position, wall.asset.wall.rotation};
      const Pose above = pose_of_node(glb.json["nodes"][glb.node_of.at(wall.asset.wall.name)]);
      for (std::uint32_t c = 0; c < wall.track.size(); ++c) {
        const std::string name = wall.asset.chunk_name(c);
        const Json* moves = glb.sampler(name, "translation");
        const Json* turns = glb.sampler(name, "rotation");
        ASSERT_EQ(moves != nullptr, wall.track[c] != kNoTrack) << name;
        ASSERT_EQ(turns != nullptr, wall.track[c] != kNoTrack) << name;
        if (!moves) continue;
        ASSERT_EQ((*moves)["input"], (*turns)["input"]);
        const std::vector<float> times = glb.values((*moves)["input"]);
        const std::vector<float> t = glb.values((*moves)["output"]);
        const std::vector<float> r = glb.values((*turns)["output"]);
        ASSERT_EQ(t.size(), 3 * times.size());
        ASSERT_EQ(r.size(), 4 * times.size());
        for (std::size_t k = 0; k < times.size(); ++k, ++keys) {
          const Pose recorded = pose_at(recording, wall.track[c], step_at.at(times[k]), standing);
          for (const Vec3 v : {wall.asset.chunks[c].centroid, Vec3{}, Vec3{3, 2, 0.1}}) {
            const Vec3 p = recorded * v;
            worst = std::max(worst, length(above * (pose_in(t, r, k) * v) - p) / (10 + length(p)));
          }
        }
      }
    }
  }
  EXPECT_LT(worst, 4e-7);  // a few roundings to float32
  EXPECT_GT(keys, 5000u);
}

TEST(ExportRecording, KeysAreTheStepsOfTheMotionAndOneBefore) {
  const Recording recording = random_recording(3);
  const Glb glb = written(recording);
  const RecordedWall& wall = recording.walls[0];
  for (std::uint32_t c = 0; c < wall.track.size(); ++c) {
    const TimeRange moving = moving_range(recording, wall.track[c]);
    if (wall.track[c] == kNoTrack) continue;
    const Json& sampler = *glb.sampler(wall.asset.chunk_name(c), "translation");
    std::vector<float> expected;
    for (std::uint32_t i = moving.first - 1; i < moving.end; ++i) {
      expected.push_back(static_cast<float>(recording.times[i]));
    }
    EXPECT_EQ(glb.values(sampler["input"]), expected);
    // Before it moves it stands exactly where its mesh is.
    EXPECT_EQ(
        pose_in(glb.values(sampler["output"]),
                glb.values((*glb.sampler(wall.asset.chunk_name(c), "rotation"))["output"]), 0),
        Pose());
    EXPECT_EQ(sampler.value("interpolation", "LINEAR"), "LINEAR");
  }
}

TEST(ExportRecording, TheAnimationLastsAsLongAsTheRecording) {
  Recording recording = random_recording(4);
  recording.times.push_back(12.5);  // everything rests by then
  const Glb glb = written(recording);
  double end = 0;
  for (const Json& sampler : glb.json["animations"][0]["samplers"]) {
    const Json& input = glb.json["accessors"][sampler["input"].get<std::size_t>()];
    end = std::max(end, input["max"][0].get<double>());
  }
  EXPECT_EQ(end, 12.5);
  EXPECT_EQ(glb.json["animations"].size(), 1u);
  EXPECT_EQ(glb.json["animations"][0]["name"], "impact");
  const Json& extras = glb.json["scenes"][0]["extras"]["sunder"];
  EXPECT_EQ(extras["steps"], recording.times.size());
  EXPECT_EQ(extras["duration"], 12.5);
  EXPECT_EQ(extras["breaks"], recording.events.size());
}

TEST(ExportRecording, TimeAccessorsAreSharedRangesWithTheirBounds) {
  const Glb glb = written(random_recording(5));
  std::set<std::size_t> inputs;
  for (const Json& sampler : glb.json["animations"][0]["samplers"]) {
    inputs.insert(sampler["input"].get<std::size_t>());
  }
  std::set<std::pair<std::uint64_t, std::uint64_t>> ranges;
  std::set<std::size_t> views;
  for (const std::size_t input : inputs) {
    const Json& accessor = glb.json["accessors"][input];
    const std::vector<float> times = glb.values(input);
    EXPECT_EQ(accessor["min"][0].get<float>(), times.front());
    EXPECT_EQ(accessor["max"][0].get<float>(), times.back());
    EXPECT_TRUE(std::ranges::is_sorted(times, std::less_equal<>()));
    ranges.insert(
        {accessor["byteOffset"].get<std::uint64_t>(), accessor["count"].get<std::uint64_t>()});
    views.insert(accessor["bufferView"].get<std::size_t>());
  }
  EXPECT_EQ(ranges.size(), inputs.size());  // no range twice
  EXPECT_EQ(views.size(), 1u);
  EXPECT_LE(glb.json["bufferViews"].size(), 8u);
}

TEST(ExportRecording, ChunksOfOneBodyShareTheirPoses) {
  Recording recording = random_recording(6);
  RecordedWall& wall = recording.walls[0];
  std::uint32_t body = kNoTrack;
  for (std::uint32_t& track : wall.track) {
    if (track != kNoTrack && body == kNoTrack) body = track;
    if (track != kNoTrack) track = body;
  }
  const Glb glb = written(recording);
  std::set<std::pair<std::size_t, std::size_t>> outputs;
  for (std::uint32_t c = 0; c < wall.track.size(); ++c) {
    if (wall.track[c] == kNoTrack) continue;
    const std::string name = wall.asset.chunk_name(c);
    outputs.insert({(*glb.sampler(name, "translation"))["output"].get<std::size_t>(),
                    (*glb.sampler(name, "rotation"))["output"].get<std::size_t>()});
  }
  EXPECT_EQ(outputs.size(), 1u);
  EXPECT_EQ(glb.json["animations"][0]["samplers"].size(), 4u);  // the body's and the ball's
}

TEST(ExportRecording, StepsWithTheSameFloatTimeBecomeOneKey) {
  Recording recording = random_recording(7);
  for (std::size_t i = 0; i < recording.times.size(); ++i) {
    recording.times[i] = i == 0 ? 0 : 4000 + 1e-4 * static_cast<double>(i);
  }
  const Glb glb = written(recording);
  std::set<float> distinct;
  for (const double time : recording.times) distinct.insert(static_cast<float>(time));
  ASSERT_LT(distinct.size(), recording.times.size() / 2);
  const std::vector<float> times = glb.values((*glb.sampler("ball", "translation"))["input"]);
  EXPECT_EQ(times, std::vector<float>(distinct.begin(), distinct.end()));
  // The last pose of the last of them is what remains.
  const std::vector<float> t = glb.values((*glb.sampler("ball", "translation"))["output"]);
  const Track& track = recording.tracks[recording.projectiles[0].track];
  EXPECT_EQ(t.back(), static_cast<float>(track.poses.back().position.z));
}

TEST(ExportRecording, QuaternionsTurnWithoutJumpsAndHaveLengthOne) {
  Recording recording = random_recording(8);
  // Three turns about an axis, with signs as they fall and lengths a little off.
  Track& track = recording.tracks[recording.projectiles[0].track];
  for (std::size_t i = 0; i < track.poses.size(); ++i) {
    Quaternion q = turned({1, 2, -1}, 3.0 * static_cast<double>(i) / 90);
    const double s = (random_bits(1, i) % 2 == 0 ? 1 : -1) * (1 + 1e-7);
    track.poses[i].rotation = {s * q.x, s * q.y, s * q.z, s * q.w};
  }
  const Glb glb = written(recording);
  const std::vector<float> r = glb.values((*glb.sampler("ball", "rotation"))["output"]);
  for (std::size_t k = 0; k + 4 <= r.size(); k += 4) {
    double size = 0, along = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      size += static_cast<double>(r[k + i]) * static_cast<double>(r[k + i]);
      if (k > 0) along += static_cast<double>(r[k + i]) * static_cast<double>(r[k - 4 + i]);
    }
    EXPECT_NEAR(size, 1, 3e-7);
    EXPECT_TRUE(k == 0 || along > 0.9) << k;
  }
}

TEST(ExportRecording, AProjectileIsNotSeenBeforeItsTime) {
  Recording recording = random_recording(9);
  RecordedProjectile late = recording.projectiles[0], never = late;
  late.projectile.name = "late";
  late.projectile.time = recording.times[40];
  late.track = static_cast<std::uint32_t>(recording.tracks.size());
  const std::vector<Pose> poses(30, Pose{{1, 2, 3}, {}});
  recording.tracks.push_back({kNoTrack, 40, poses});
  never.projectile.name = "never";
  never.projectile.time = 1e6;
  never.track = kNoTrack;
  recording.projectiles.push_back(late);
  recording.projectiles.push_back(never);
  const Glb glb = written(recording);
  EXPECT_EQ(glb.sampler("ball", "scale"), nullptr);
  const Json& scale = *glb.sampler("late", "scale");
  EXPECT_EQ(scale["interpolation"], "STEP");
  EXPECT_EQ(glb.values(scale["input"]),
            (std::vector<float>{static_cast<float>(recording.times[39]),
                                static_cast<float>(recording.times[40])}));
  EXPECT_EQ(glb.values(scale["output"]), (std::vector<float>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(glb.values((*glb.sampler("late", "translation"))["input"]).front(),
            static_cast<float>(recording.times[40]));
  EXPECT_EQ(glb.values((*glb.sampler("never", "scale"))["output"]), (std::vector<float>{0, 0, 0}));
  // Spheres of one size are one mesh.
  const auto mesh = [&](const char* name) {
    return glb.json["nodes"][glb.node_of.at(name)]["mesh"];
  };
  EXPECT_EQ(mesh("late"), mesh("ball"));
}

// What stands as it stood is the file that export_asset writes, but for the scene's extras.
TEST(ExportRecording, WithoutMotionItIsTheAssetWithoutAnimation) {
  Recording recording;
  recording.times = {0, 0.01, 0.02};
  Asset asset;
  asset.walls = {sample_wall("facade", 6, 4), sample_wall("side", 3, 2)};
  for (const WallAsset& wall : asset.walls) {
    recording.walls.push_back({wall, std::vector<std::uint32_t>(wall.chunks.size(), kNoTrack)});
  }
  const TestFolder folder;
  export_asset(mesh_asset(asset), folder / "a.glb");
  const Glb expected(content_of(folder / "a.glb"));
  Glb glb = written(recording);
  EXPECT_FALSE(glb.json.contains("animations"));
  glb.json["scenes"][0].erase("extras");
  EXPECT_EQ(glb.json, expected.json);
  EXPECT_TRUE(glb.binary == expected.binary);
}

TEST(ExportRecording, SpheresAreClosedAndTurnedOutward) {
  const Recording recording = random_recording(10);
  const Glb glb = written(recording);
  const Json& node = glb.json["nodes"][glb.node_of.at("ball")];
  const Json& primitive = glb.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
  const std::vector<float> positions = glb.values(primitive["attributes"]["POSITION"]);
  const Json& list = glb.json["accessors"][primitive["indices"].get<std::size_t>()];
  const Json& view = glb.json["bufferViews"][list["bufferView"].get<std::size_t>()];
  std::vector<std::uint16_t> indices(list["count"].get<std::size_t>());
  std::memcpy(indices.data(),
              glb.binary.data() + view["byteOffset"].get<std::size_t>() +
                  list["byteOffset"].get<std::size_t>(),
              2 * indices.size());
  TriMesh mesh;
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    mesh.vertices.push_back({positions[i], positions[i + 1], positions[i + 2]});
  }
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  }
  EXPECT_EQ(check(mesh), MeshDefects());
  const double radius = recording.projectiles[0].projectile.radius;
  EXPECT_NEAR(mass_properties(mesh).volume / (4.0 / 3 * 3.14159265 * radius * radius * radius), 1,
              0.03);
}

TEST(ExportRecording, AssimpSeesOneAnimationOfTheRightDuration) {
  const Recording recording = random_recording(11);
  const TestFolder folder;
  for (const char* name : {"a.glb", "b.gltf"}) {
    export_recording(recording, folder / name);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile((folder / name).string(), 0);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    ASSERT_EQ(scene->mNumAnimations, 1u);
    const aiAnimation& animation = *scene->mAnimations[0];
    EXPECT_STREQ(animation.mName.C_Str(), "impact");
    const double seconds = animation.mDuration / animation.mTicksPerSecond;
    EXPECT_NEAR(seconds, recording.times.back(), 1e-6);
    std::size_t moving = 1;  // the ball
    for (const RecordedWall& wall : recording.walls) {
      for (const std::uint32_t track : wall.track) moving += track != kNoTrack;
    }
    EXPECT_EQ(animation.mNumChannels, moving);
  }
}

TEST(ExportRecording, TwiceGivesTheSameBytes) {
  const Recording recording = random_recording(12);
  const TestFolder folder;
  for (const std::string name : {"a.glb", "a.gltf", "a.bin", "a.svg"}) {
    if (name != "a.bin") export_recording(recording, folder / name);
    const std::string first = content_of(folder / name);
    if (name != "a.bin") export_recording(recording, folder / name, {.threads = 2});
    EXPECT_FALSE(first.empty()) << name;
    EXPECT_TRUE(first == content_of(folder / name)) << name;
  }
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.bin", "a.glb", "a.gltf", "a.svg"}));
}

TEST(ExportRecording, AnUnsoundRecordingIsRefusedBeforeAnythingIsWritten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Row {
    const char* what;
    std::function<void(Recording&)> spoil;
  };
  const Row rows[] = {
      {"no times", [](Recording& r) { r.times.clear(); }},
      {"times not ascending", [](Recording& r) { r.times[5] = r.times[4]; }},
      {"time NaN", [&](Recording& r) { r.times[5] = nan; }},
      {"track outlasts", [](Recording& r) { r.times.resize(r.times.size() - 5); }},
      {"pose NaN", [&](Recording& r) { r.tracks[0].poses[1].position.y = nan; }},
      {"pose too far", [](Recording& r) { r.tracks[0].poses[1].position.y = 1e39; }},
      {"rotation not unit",
       [](Recording& r) {
         r.tracks[0].poses[1].rotation = {1, 1, 0, 0};
       }},
      {"own parent", [](Recording& r) { r.tracks[2].parent = 2; }},
      {"track missing", [](Recording& r) { r.walls[0].track[0] = 9999; }},
      {"tracks too few", [](Recording& r) { r.walls[0].track.pop_back(); }},
      {"ball without size", [](Recording& r) { r.projectiles[0].projectile.radius = 0; }},
      {"ball nowhere", [&](Recording& r) { r.projectiles[0].projectile.position.x = nan; }},
      {"ball's track missing", [](Recording& r) { r.projectiles[0].track = 9999; }},
      {"ball's name", [](Recording& r) { r.projectiles[0].projectile.name = "a b"; }},
      {"name of a wall", [](Recording& r) { r.projectiles[0].projectile.name = "side"; }},
      {"name of a chunk",
       [](Recording& r) { r.projectiles[0].projectile.name = "side_chunk_0001"; }},
      {"ball twice", [](Recording& r) { r.projectiles.push_back(r.projectiles[0]); }}};
  const TestFolder folder;
  for (const Row& row : rows) {
    Recording recording = random_recording(13);
    row.spoil(recording);
    for (const char* name : {"a.glb", "a.gltf", "a.svg"}) {
      try {
        export_recording(recording, folder / name);
        ADD_FAILURE() << row.what << " in " << name;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::output) << row.what;
        EXPECT_EQ(std::string(error.what()).find((folder / name).string()), 0u) << error.what();
      }
    }
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(ExportRecording, AnotherSuffixOrNoFramesIsAUsageError) {
  const Recording recording = random_recording(14);
  const TestFolder folder;
  for (const char* name : {"a.obj", "a.stl", "a"}) {
    EXPECT_FALSE(is_recording_suffix(std::filesystem::path(name).extension()));
    try {
      export_recording(recording, folder / name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
    }
  }
  for (const int frames : {0, -1, 61}) {
    try {
      export_recording(recording, folder / "a.svg", {.frames = frames});
      FAIL() << frames;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
    }
  }
  EXPECT_TRUE(folder.names().empty());
}

// Set up with: npm install --prefix tests/validate_gltf
TEST(ExportRecording, KhronosValidatorFindsNoErrorsAndNoWarnings) {
  const std::string tool = SUNDER_SOURCE_DIR "/tests/validate_gltf";
  if (!std::filesystem::exists(tool + "/node_modules/gltf-validator")) {
    GTEST_SKIP() << "gltf-validator is not installed";
  }
  Recording recording = random_recording(15);
  RecordedProjectile never = recording.projectiles[0];
  never.projectile.name = "never";
  never.projectile.time = 1e6;
  never.projectile.radius = 0.1;
  never.track = kNoTrack;
  recording.projectiles.push_back(never);
  const TestFolder folder;
  export_recording(recording, folder / "a.glb");
  export_recording(recording, folder / "b c.gltf");
  const std::string command = "node '" + tool + "/validate.js' '" + (folder / "a.glb").string() +
                              "' '" + (folder / "b c.gltf").string() + "' > '" +
                              (folder / "log").string() + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << content_of(folder / "log");
}

}  // namespace
}  // namespace sunder
