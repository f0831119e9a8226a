// SPDX-License-Identifier: GPL-3.0-or-later
// What a recording's glTF tells of the run: extras of the document.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>

#include "io/export_recording.hpp"
#include "io/glb.hpp"
#include "io/import.hpp"
#include "io/sample_asset.hpp"
#include "io/sample_building.hpp"

namespace sunder {
namespace {

constexpr std::pair<const char*, double RunSample::*> kValues[] = {
    {"times", &RunSample::time},
    {"kinetic", &RunSample::kinetic},
    {"potential", &RunSample::potential},
    {"strain", &RunSample::strain},
    {"fracture", &RunSample::fracture},
    {"friction", &RunSample::friction},
    {"contact", &RunSample::contact},
    {"damping", &RunSample::damping},
    {"plastic", &RunSample::plastic},
    {"numerical", &RunSample::numerical},
    {"max_utilisation", &RunSample::max_utilisation}};

/// Values over many decades, of either sign, and 0.
std::vector<RunSample> random_series(std::size_t count) {
  std::vector<RunSample> series(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t k = 0; k < std::size(kValues); ++k) {
      const double scale = std::exp(60 * random_unit(9, i, 40 + k) - 30);
      series[i].*kValues[k].second = i == 1 ? 0 : scale * (random_unit(9, i, k) - 0.5);
    }
    series[i].time = i / 30.0;
    series[i].broken_joints = i, series[i].broken_bonds = 1000 * i, series[i].moving = 7 * i;
  }
  return series;
}

Recording sample_run() {
  Recording recording = sample_building({.posts_x = 2, .posts_z = 3, .storeys = 2, .reach = 9});
  recording.series = random_series(12);
  recording.seed = 18446744073709551615u;
  recording.parts[4].wall = 0;
  recording.walls.push_back({sample_wall("facade", 3, 2), std::vector<std::uint32_t>(6, kNoTrack)});
  recording.events = {{0.25, 0, {1, 2.5, -3}, 31.25, 1.5, 12, 3}};
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    const double most = i % 7 == 0 ? 80 : 1.2;  // above 65.535 too
    recording.samples[i].utilisation = static_cast<float>(most * random_unit(3, i));
  }
  return recording;
}

Glb written(const Recording& recording, std::optional<double> at = {}) {
  const TestFolder folder;
  export_recording(recording, folder / "a.glb", {.at = at});
  return Glb(content_of(folder / "a.glb"));
}

std::vector<std::uint16_t> shorts(const Glb& glb, std::size_t index) {
  const Json& view = glb.json["bufferViews"].at(index);
  std::vector<std::uint16_t> values(view["byteLength"].get<std::size_t>() / 2);
  std::memcpy(values.data(), glb.binary.data() + view["byteOffset"].get<std::size_t>(),
              2 * values.size());
  return values;
}

TEST(GltfSeries, RunHasEveryNumberAsFloat32) {
  const Recording recording = sample_run();
  const Glb glb = written(recording);
  const Json& run = glb.json["extras"]["sunder"]["run"];
  EXPECT_EQ(run["verb"], "collapse");
  EXPECT_EQ(run["seed"], recording.seed);
  for (const auto& [name, value] : kValues) {
    ASSERT_EQ(run[name].size(), recording.series.size()) << name;
    for (std::size_t i = 0; i < recording.series.size(); ++i)
      EXPECT_EQ(run[name][i].get<float>(), static_cast<float>(recording.series[i].*value)) << name;
  }
  for (std::size_t i = 0; i < recording.series.size(); ++i) {
    EXPECT_EQ(run["broken_joints"][i], i);
    EXPECT_EQ(run["broken_bonds"][i], 1000 * i);
    EXPECT_EQ(run["moving"][i], 7 * i);
  }
  EXPECT_EQ(run.size(), 2 + std::size(kValues) + 3);
}

TEST(GltfSeries, JointsSayWhatTheyJoinAndWhenTheyBreak) {
  const Recording recording = sample_run();
  const Glb glb = written(recording);
  const Json& joints = glb.json["extras"]["sunder"]["joints"];
  std::size_t of_chunks = 0, of_ground = 0, broken = 0;
  for (std::size_t j = 0; j < recording.joints.size(); ++j) {
    const RecordedJoint& joint = recording.joints[j];
    EXPECT_EQ(joints["names"][j], joint.name);
    EXPECT_EQ(joints["ends"][j], Json::array({joint.end_a, joint.end_b}));
    EXPECT_EQ(joints["points"][j][1].get<float>(), static_cast<float>(joint.point.y));
    const Json& at = joints["broken"][j];
    EXPECT_EQ(at.is_null(), std::isinf(joint.broken));
    broken += !at.is_null();
    EXPECT_TRUE(at.is_null() || at.get<float>() == static_cast<float>(joint.broken));
    const std::uint32_t parts[] = {joint.part_a, joint.part_b};
    for (std::size_t k = 0; k < 2; ++k) {
      const long node = joints["parts"][j][k];
      const bool has_node = parts[k] != kNoTrack && parts[k] != 4;
      of_ground += parts[k] == kNoTrack, of_chunks += parts[k] == 4;
      EXPECT_EQ(node >= 0, has_node);
      if (!has_node) continue;
      EXPECT_EQ(glb.json["nodes"][static_cast<std::size_t>(node)]["name"],
                recording.parts[parts[k]].name);
    }
  }
  EXPECT_GT(of_chunks, 0u);
  EXPECT_GT(of_ground, 0u);
  EXPECT_GT(broken, 0u);
}

TEST(GltfSeries, UtilisationsAreThousandthsUntilTheBreak) {
  const Recording recording = sample_run();
  const Glb glb = written(recording);
  const Json& joints = glb.json["extras"]["sunder"]["joints"];
  EXPECT_EQ(joints["utilisation"]["componentType"], 5123);
  EXPECT_EQ(joints["utilisation"]["scale"], 0.001);
  EXPECT_EQ(joints["times"].size(), recording.sample_times.size());
  const std::vector<std::uint16_t> values =
      shorts(glb, joints["utilisation"]["bufferView"].get<std::size_t>());
  const std::size_t count = recording.joints.size();
  ASSERT_EQ(values.size(), (recording.samples.size() + 1) / 2 * 2);
  std::size_t capped = 0, ended = 0;
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    const double used = static_cast<double>(recording.samples[i].utilisation);
    if (recording.sample_times[i / count] >= recording.joints[i % count].broken) {
      EXPECT_EQ(values[i], 0), ++ended;
    } else if (used > 65.6) {
      EXPECT_EQ(values[i], 65535), ++capped;
    } else {
      EXPECT_NEAR(0.001 * values[i], std::min(used, 65.535), 0.0005001);
    }
  }
  EXPECT_GT(capped, 0u);
  EXPECT_GT(ended, 0u);
}

TEST(GltfSeries, EventsNameTheirWall) {
  const Glb glb = written(sample_run());
  const Json expected = Json::parse(R"([{"time": 0.25, "wall": "facade", "point": [1, 2.5, -3],
      "speed": 31.25, "utilisation": 1.5, "bonds_broken": 12, "chunks_freed": 3}])");
  EXPECT_EQ(glb.json["extras"]["sunder"]["events"], expected);
}

TEST(GltfSeries, AnImpactHasNoJoints) {
  Recording recording = sample_recording({sample_wall("facade", 6, 4)});
  recording.series = random_series(3);
  const Glb glb = written(recording);
  const Json& extras = glb.json["extras"]["sunder"];
  EXPECT_EQ(extras["run"]["verb"], "impact");
  EXPECT_FALSE(extras.contains("joints"));
  EXPECT_EQ(extras["events"].size(), recording.events.size());
}

TEST(GltfSeries, OneMomentHasNone) {
  const Recording recording = sample_run();
  EXPECT_TRUE(written(recording).json.contains("extras"));
  EXPECT_FALSE(written(recording, 0.5).json.contains("extras"));
  Recording without = recording;
  without.series.clear();
  EXPECT_FALSE(written(without).json.contains("extras"));
}

TEST(GltfSeries, WhatIsNotFiniteIsNull) {
  Recording recording = sample_run();
  recording.series[2].max_utilisation = std::numeric_limits<double>::infinity();
  recording.series[3].kinetic = std::nan("");
  const Glb glb = written(recording);
  const Json& run = glb.json["extras"]["sunder"]["run"];
  EXPECT_TRUE(run["max_utilisation"][2].is_null());
  EXPECT_TRUE(run["kinetic"][3].is_null());
}

TEST(GltfSeries, WallsAreReadBackAsBefore) {
  Recording recording = sample_recording({sample_wall("facade", 6, 4)});
  const TestFolder folder;
  export_recording(recording, folder / "without.glb");
  recording.series = random_series(30);
  for (const char* name : {"with.glb", "with.gltf"}) {
    export_recording(recording, folder / name);
    const ImportedAsset with = import_asset(folder / name);
    const ImportedAsset without = import_asset(folder / "without.glb");
    ASSERT_EQ(with.walls.size(), without.walls.size());
    EXPECT_EQ(with.walls[0].chunks.size(), without.walls[0].chunks.size());
    EXPECT_EQ(with.walls[0].chunks.size(), 24u);
  }
}

}  // namespace
}  // namespace sunder
