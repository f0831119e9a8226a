// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/joint_history.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "io/sample_asset.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kColumns[] = {
    "N", "Vy", "Vz", "T", "My", "Mz", "force_utilisation", "torque_utilisation", "utilisation"};

std::array<float, 9> values_of(const JointSample& s) {
  return {s.force[0],  s.force[1],          s.force[2],           s.torque[0],  s.torque[1],
          s.torque[2], s.force_utilisation, s.torque_utilisation, s.utilisation};
}

/// Two posts and a beam: three joints at `times` times 1/30 s apart; the second joint breaks
/// between two of them, the third at one of them. Loads are random over many decades.
Recording sample_history(std::size_t times = 7) {
  Recording r;
  r.parts.resize(2);
  r.parts[0].name = "post_a", r.parts[1].name = "beam";
  r.joints.resize(3);
  r.joints[0].name = "post_a@ground";
  r.joints[1].name = "beam@post_a", r.joints[1].part_a = 1, r.joints[1].part_b = 0;
  r.joints[2].name = "beam@ground", r.joints[2].part_a = 1;
  for (std::size_t t = 0; t < times; ++t) r.sample_times.push_back(static_cast<double>(t) / 30);
  r.joints[1].broken = 3.5 / 30;
  r.joints[2].broken = r.sample_times[2];
  for (std::uint64_t i = 0; i < times * 3; ++i) {
    const auto value = [i](std::uint64_t k) {
      const int scale = static_cast<int>(random_bits(5, i, 20 + k) % 60) - 30;
      return static_cast<float>(std::ldexp(random_unit(5, i, k) - 0.5, scale));
    };
    r.samples.push_back({{value(0), value(1), value(2)},
                         {value(3), value(4), value(5)},
                         value(6),
                         value(7),
                         value(8)});
  }
  return r;
}

std::string written(const Recording& recording, const char* name) {
  const TestFolder folder;
  write_joint_history(recording, folder / name);
  EXPECT_EQ(folder.names(), std::vector<std::string>{name});
  return content_of(folder / name);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

TEST(JointHistory, CsvReadsBackAsTheSameNumbersByTimeThenJoint) {
  const Recording recording = sample_history();
  const std::vector<std::string> rows = split(written(recording, "h.csv"), '\n');
  EXPECT_EQ(rows.at(0),
            "time,joint,N,Vy,Vz,T,My,Mz,force_utilisation,torque_utilisation,utilisation");
  std::size_t row = 0;
  for (std::size_t t = 0; t < recording.sample_times.size(); ++t) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (j >= 1 && t >= (j == 1 ? 4 : 2)) continue;  // broken
      const std::vector<std::string> fields = split(rows.at(++row), ',');
      ASSERT_EQ(fields.size(), 11u) << rows[row];
      EXPECT_EQ(std::strtod(fields[0].c_str(), nullptr), recording.sample_times[t]);
      EXPECT_EQ(fields[1], recording.joints[j].name);
      const auto values = values_of(recording.samples[3 * t + j]);
      for (std::size_t k = 0; k < 9; ++k)
        EXPECT_EQ(std::strtof(fields[2 + k].c_str(), nullptr), values[k]) << fields[2 + k];
    }
  }
  EXPECT_EQ(rows.size(), row + 1);
  EXPECT_EQ(row, 7u + 4 + 2);
}

TEST(JointHistory, JsonHoldsTheSameNumbersUntilTheJointBreaks) {
  const Recording recording = sample_history();
  const Json json = Json::parse(written(recording, "h.json"));
  EXPECT_EQ(json["times"].get<std::vector<double>>(), recording.sample_times);
  ASSERT_EQ(json["joints"].size(), 3u);
  constexpr std::size_t kCounts[] = {7, 4, 2};
  for (std::size_t j = 0; j < 3; ++j) {
    const Json& joint = json["joints"][j];
    EXPECT_EQ(joint["name"], recording.joints[j].name);
    for (std::size_t k = 0; k < 9; ++k) {
      const auto column = joint.at(kColumns[k]).get<std::vector<float>>();
      ASSERT_EQ(column.size(), kCounts[j]) << kColumns[k];
      for (std::size_t t = 0; t < column.size(); ++t)
        EXPECT_EQ(column[t], values_of(recording.samples[3 * t + j])[k]) << kColumns[k];
    }
  }
  EXPECT_EQ(json["joints"][0]["a"], "post_a");
  EXPECT_EQ(json["joints"][0]["b"], "ground");
  EXPECT_EQ(json["joints"][1]["a"], "beam");
  EXPECT_EQ(json["joints"][1]["b"], "post_a");
  EXPECT_TRUE(json["joints"][0]["broken"].is_null());
  EXPECT_EQ(json["joints"][1]["broken"].get<double>(), recording.joints[1].broken);
}

TEST(JointHistory, WithoutJointsIsAHeaderOrEmptyLists) {
  EXPECT_EQ(split(written({}, "h.csv"), '\n').size(), 1u);
  EXPECT_EQ(Json::parse(written({}, "h.json")), Json::parse(R"({"times": [], "joints": []})"));
}

TEST(JointHistory, IsLongerThanAnyBuffer) {
  const Recording recording = sample_history(5000);
  EXPECT_EQ(split(written(recording, "h.csv"), '\n').size(), 1u + 5000 + 4 + 2);
  EXPECT_EQ(Json::parse(written(recording, "h.json"))["joints"][0]["Mz"].size(), 5000u);
}

TEST(JointHistory, WhatIsNotFiniteIsSaid) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Recording recording = sample_history(1);
  recording.samples[0].utilisation = kInfinity;
  recording.samples[0].force = {-kInfinity, std::numeric_limits<float>::quiet_NaN(), 0};
  const std::string row = split(written(recording, "h.csv"), '\n').at(1);
  EXPECT_TRUE(row.starts_with("0,post_a@ground,-inf,nan,0,")) << row;
  EXPECT_TRUE(row.ends_with(",inf")) << row;
  const Json joint = Json::parse(written(recording, "h.json"))["joints"][0];
  EXPECT_TRUE(joint["N"][0].is_null() && joint["Vy"][0].is_null());
  EXPECT_TRUE(joint["utilisation"][0].is_null());
  EXPECT_EQ(joint["Vz"][0], 0);
}

TEST(JointHistory, ANameWithACommaStaysOneField) {
  Recording recording = sample_history(1);
  recording.joints[0].name = "a,\"b\"";
  EXPECT_TRUE(split(written(recording, "h.csv"), '\n').at(1).starts_with("0,\"a,\"\"b\"\"\","));
}

TEST(JointHistory, AnotherSuffixIsAUsageErrorAndLeavesNoFile) {
  const TestFolder folder;
  for (const char* name : {"h.txt", "h", "h.csvx"}) {
    try {
      write_joint_history(sample_history(), folder / name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
    }
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

}  // namespace
}  // namespace sunder
