// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scene.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "io/json_place.hpp"
#include "io/printable.hpp"
#include "io/scene_corpus.hpp"
#include "io/strict_json.hpp"
#include "io/suggest.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

namespace fs = std::filesystem;

/// The message with which a scene is refused; fails when it is read.
std::string refusal(std::string_view text, const SceneParams& params = {},
                    ErrorCode code = ErrorCode::input) {
  try {
    parse_scene(text, "scene.json", params);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "was read: " << text.substr(0, 200);
  return {};
}

/// A folder of its own that is removed again.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "sunder_scene_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }
  fs::path write(const std::string& name, const std::string& content) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << content;
    return path_ / name;
  }

 private:
  fs::path path_;
};

std::string file_refusal(const fs::path& path, const SceneParams& params = {}) {
  try {
    read_scene(path, params);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "was read: " << path;
  return {};
}

// --- Corpus ----------------------------------------------------------------------------------

class RejectedScene : public testing::TestWithParam<CorpusRow> {};

TEST_P(RejectedScene, SaysWhereAndWhy) {
  const std::string message = refusal(GetParam().text);
  EXPECT_FALSE(GetParam().expected.empty());
  for (const std::string& words : GetParam().expected) {
    EXPECT_NE(message.find(words), std::string::npos)
        << "message:  " << message << "\nexpected: " << words;
  }
  EXPECT_EQ(message.find_first_of("\n\r\x1b"), std::string::npos) << "not one line: " << message;
  EXPECT_LT(message.size(), 600u) << message;
}

INSTANTIATE_TEST_SUITE_P(Corpus, RejectedScene, testing::ValuesIn(read_corpus("rejected.txt")),
                         [](const auto& row) { return row.param.name; });

class AcceptedScene : public testing::TestWithParam<CorpusRow> {};

TEST_P(AcceptedScene, IsRead) {
  EXPECT_NO_THROW(parse_scene(GetParam().text, "scene.json"));
}

INSTANTIATE_TEST_SUITE_P(Corpus, AcceptedScene, testing::ValuesIn(read_corpus("accepted.txt")),
                         [](const auto& row) { return row.param.name; });

TEST(SceneCorpus, IsThere) {
  EXPECT_GE(read_corpus("rejected.txt").size(), 80u);
  EXPECT_GE(read_corpus("accepted.txt").size(), 20u);
}

// --- Values ----------------------------------------------------------------------------------

TEST(Scene, EveryKeyArrivesWhereItBelongs) {
  const Scene scene = parse_scene(kFullScene, "scene.json");
  EXPECT_EQ(scene.seed, 7u);
  EXPECT_EQ(scene.keys, (std::vector<std::string>{"$schema", "sunder", "seed", "walls", "materials",
                                                  "projectiles", "building", "scenario",
                                                  "simulation"}));
  ASSERT_EQ(scene.walls.size(), 6u);
  const Wall& facade = scene.walls[0];
  EXPECT_EQ(facade.name, "facade");
  EXPECT_EQ(facade.region.outline, rectangle({6.5, 3.5}, {1.5, 2.5}));
  ASSERT_EQ(facade.region.openings.size(), 2u);
  EXPECT_EQ(facade.region.openings[0], rectangle({0.9, 2.1}, {2, 2.5}));
  EXPECT_EQ(facade.region.openings[1], (Loop{{4, 3}, {5, 3}, {5, 4}, {4, 4}}));
  EXPECT_EQ(facade.thickness, 0.25);
  EXPECT_EQ(facade.material, "granite");
  EXPECT_EQ(facade.min_cell, 0.01);
  EXPECT_EQ(facade.anchors, (std::vector<std::string>{"bottom", "left"}));
  EXPECT_EQ(facade.position, (Vec3{1, 2, 3}));
  EXPECT_EQ(facade.rotation, (Quaternion{0, std::sqrt(0.5), 0, std::sqrt(0.5)}));
  const auto& grid = std::get<VoronoiGridParams>(facade.pattern);
  EXPECT_EQ(grid.cell, 0.35);
  EXPECT_EQ(grid.jitter, 0.9);
  EXPECT_EQ(std::get<VoronoiSitesParams>(scene.walls[1].pattern).sites, (Loop{{1, 1}, {2, 2}}));
  EXPECT_EQ(std::get<VoronoiRandomParams>(scene.walls[2].pattern).count, 60);
  const auto& focus = std::get<VoronoiFocusParams>(scene.walls[3].pattern);
  EXPECT_EQ(focus.points, (Loop{{3, 1}}));
  EXPECT_EQ(focus.count, 90);
  EXPECT_EQ(focus.radius, 0.5);
  EXPECT_EQ(focus.share, 0.6);
  EXPECT_EQ(std::get<QuadGridParams>(scene.walls[4].pattern).cell, 0.4);
  const auto& web = std::get<SpiderwebParams>(scene.walls[5].pattern);
  EXPECT_EQ(web.impacts, (Loop{{3, 1.5}}));
  EXPECT_EQ(web.min_points, 6);
  EXPECT_EQ(web.max_points, 9);
  EXPECT_EQ(web.min_radius, 0.2);
  EXPECT_EQ(web.max_radius, 0.5);
  EXPECT_EQ(web.rings, 3);
  EXPECT_EQ(web.radial, 8);
  EXPECT_EQ(web.reach, 1.5);
  EXPECT_EQ(web.rest_cell, 0.7);
}

TEST(Scene, EveryKeyOfAProjectileArrives) {
  const Scene scene = parse_scene(kFullScene, "scene.json");
  ASSERT_EQ(scene.projectiles.size(), 2u);
  const Projectile& ball = scene.projectiles[0];
  EXPECT_EQ(ball.name, "ball");
  EXPECT_EQ(ball.radius, 0.2);
  EXPECT_EQ(ball.mass, 260.5);
  EXPECT_EQ(ball.position, (Vec3{3, 1.5, 5}));
  EXPECT_EQ(ball.velocity, (Vec3{0.5, -1.5, -10}));
  EXPECT_EQ(ball.time, 0.75);
  EXPECT_EQ(ball.youngs_modulus, 2e11);
  EXPECT_EQ(ball.poisson_ratio, 0.28);
  EXPECT_EQ(ball.friction, 0.4);
  EXPECT_EQ(ball.restitution, 0.6);
}

TEST(Scene, EveryKeyOfTheSimulationArrives) {
  const SimulationParams params = parse_scene(kFullScene, "scene.json").simulation;
  EXPECT_EQ(params.duration, 2.5);
  EXPECT_EQ(params.step, 0.005);
  EXPECT_EQ(params.iterations, 30);
  EXPECT_EQ(params.max_error, 0.02);
  EXPECT_EQ(params.gravity, 1.62);
  EXPECT_FALSE(params.ground);
  EXPECT_EQ(params.ground_height, -0.5);
  EXPECT_EQ(params.break_depth, 2);
  EXPECT_FALSE(params.sleep);
  EXPECT_EQ(params.solver, "bullet");
}

/// A scene of one wall "facade" and these projectiles.
std::string with_projectiles(const std::string& list) {
  return R"({"sunder": 1, "walls": [{"name": "facade"}], "projectiles": )" + list + "}";
}

TEST(Scene, WhatAProjectileDoesNotGiveIsTheDefault) {
  const std::string bare = R"({"position": [1, 2, 3], "velocity": [4, 5, 6]})";
  const Scene scene =
      parse_scene(with_projectiles('[' + bare + ", " + bare + ", " + bare + ']'), "s");
  ASSERT_EQ(scene.projectiles.size(), 3u);
  EXPECT_EQ(scene.projectiles[0].name, "projectile");
  EXPECT_EQ(scene.projectiles[1].name, "projectile_2");
  EXPECT_EQ(scene.projectiles[2].name, "projectile_3");
  const Projectile expected;
  for (const Projectile& each : scene.projectiles) {
    EXPECT_EQ(each.radius, expected.radius);
    EXPECT_EQ(each.mass, expected.mass);
    EXPECT_EQ(each.time, expected.time);
    EXPECT_EQ(each.youngs_modulus, expected.youngs_modulus);
    EXPECT_EQ(each.restitution, expected.restitution);
  }
}

TEST(Scene, WithoutRunKeysNothingFliesAndTheSimulationIsTheDefault) {
  const Scene scene = parse_scene(R"({"sunder": 1, "walls": [{}]})", "s");
  const SimulationParams expected;
  EXPECT_TRUE(scene.projectiles.empty());
  EXPECT_EQ(scene.simulation.duration, expected.duration);
  EXPECT_EQ(scene.simulation.step, expected.step);
  EXPECT_EQ(scene.simulation.solver, "hybrid");
  EXPECT_TRUE(scene.simulation.ground);
}

TEST(Scene, TheStepThatAMessageAsksForIsRead) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    const double duration = 11 + 3589 * random_unit(17, i);
    const std::string head = R"({"sunder": 1, "walls": [{}], "simulation": {"duration": )" +
                             number_text(duration) + R"(, "step": )";
    const std::string message = refusal(head + "1e-6}}");
    const std::string before = "take a step of at least ";
    const std::size_t begin = message.find(before) + before.size();
    const std::string step = message.substr(begin, message.find(" s", begin) - begin);
    EXPECT_EQ(parse_scene(head + step + "}}", "s").simulation.duration, duration) << message;
    refusal(head + number_text(std::stod(step) * 0.999999) + "}}");
  }
}

TEST(Scene, SpeedIsLimitedInEveryDirection) {
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Vec3 along{random_unit(19, i, 0) - 0.5, random_unit(19, i, 1) - 0.5,
                     random_unit(19, i, 2) - 0.5};
    const auto scene = [&](double speed) {
      const Vec3 v = speed / length(along) * along;
      return with_projectiles(R"([{"position": [0, 9, 9], "velocity": [)" + number_text(v.x) +
                              ", " + number_text(v.y) + ", " + number_text(v.z) + "]}]");
    };
    EXPECT_NO_THROW(parse_scene(scene(99999.9), "s")) << "case " << i;
    EXPECT_NE(refusal(scene(100000.1)).find("/projectiles/0/velocity"), std::string::npos);
  }
}

TEST(Scene, TellsWhichOfSomeKeysAreGiven) {
  using Keys = std::vector<std::string>;
  const Scene full = parse_scene(kFullScene, "s");
  EXPECT_EQ(given_keys(full, {"projectiles", "building", "simulation"}),
            (Keys{"projectiles", "building", "simulation"}));
  EXPECT_EQ(given_keys(full, {"building"}), Keys{"building"});
  const Scene bare = parse_scene(R"({"sunder": 1, "walls": [{}]})", "s");
  EXPECT_EQ(given_keys(bare, {"projectiles", "building", "simulation"}), Keys());
  const Scene set =
      parse_scene(R"({"sunder": 1, "walls": [{}]})", "s", {.overrides = {"simulation.duration=2"}});
  EXPECT_EQ(given_keys(set, {"projectiles", "simulation"}), Keys{"simulation"});
}

TEST(Scene, AWallWithoutKeysIsTheDefaultWall) {
  const Scene scene = parse_scene(R"({"sunder": 1, "walls": [{}, {}]})", "scene.json");
  const Wall expected;
  EXPECT_EQ(scene.seed, 1u);
  EXPECT_EQ(scene.walls[0].name, "wall");
  EXPECT_EQ(scene.walls[1].name, "wall_2");
  EXPECT_EQ(scene.walls[0].region.outline, expected.region.outline);
  EXPECT_EQ(scene.walls[0].thickness, expected.thickness);
  EXPECT_EQ(scene.walls[0].min_cell, expected.min_cell);
  EXPECT_EQ(scene.walls[0].rotation, expected.rotation);
  EXPECT_TRUE(std::holds_alternative<VoronoiGridParams>(scene.walls[0].pattern));
}

TEST(Scene, TheLargestSeedKeepsAllItsBits) {
  const Scene scene = parse_scene(R"({"sunder":1,"seed":18446744073709551615,"walls":[{}]})", "s");
  EXPECT_EQ(scene.seed, ~std::uint64_t{0});
}

TEST(Scene, MinusZeroBecomesZero) {
  const Scene scene =
      parse_scene(R"({"sunder": 1, "walls": [{"position": [-0.0, -0, -0e5]}]})", "s");
  const Vec3 position = scene.walls[0].position;
  EXPECT_FALSE(std::signbit(position.x) || std::signbit(position.y) || std::signbit(position.z));
}

TEST(Scene, EveryPrefixOfASceneIsRefused) {
  const std::string whole = kFullScene;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string message = refusal(whole.substr(0, size));
    ASSERT_TRUE(message.starts_with("scene.json:")) << "prefix of " << size << ": " << message;
  }
}

TEST(Scene, AnyDamagedByteGivesAMessageOrAScene) {
  const std::string whole = kFullScene;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    std::string damaged = whole;
    const std::size_t place = random_bits(11, i, 0) % whole.size();
    const char byte = static_cast<char>(random_bits(11, i, 1));
    if (i % 3 == 0) damaged.erase(place, 1 + random_bits(11, i, 2) % 8);
    if (i % 3 == 1) damaged[place] = byte;
    if (i % 3 == 2) damaged.insert(place, 1, byte);
    try {
      parse_scene(damaged, "scene.json");
    } catch (const Error& error) {
      const std::string message = error.what();
      ASSERT_EQ(error.code(), ErrorCode::input) << "damage " << i;
      ASSERT_TRUE(message.starts_with("scene.json:")) << "damage " << i << ": " << message;
      ASSERT_EQ(message.find_first_of("\n\r\x1b"), std::string::npos) << "damage " << i;
    }
  }
}

// --- Size ------------------------------------------------------------------------------------

TEST(Scene, DeepNestingIsRefusedWithoutRecursion) {
  for (const std::size_t depth : {65u, 1000u, 1000000u}) {
    const std::string message =
        refusal(R"({"sunder": 1, "building": {"a": )" + std::string(depth, '['));
    EXPECT_NE(message.find("nested deeper than 64 levels"), std::string::npos) << message;
  }
  const std::string deepest = std::string(62, '[') + std::string(62, ']');
  const std::string message = refusal(R"({"sunder": 1, "building": {"a": )" + deepest + "}}");
  EXPECT_NE(message.find("/building/a: unknown key"), std::string::npos) << message;
}

TEST(Scene, LongWordsAreCutInMessages) {
  const std::string digits(10000, '9');
  const std::string letters(5000, 'x');
  EXPECT_LT(refusal(R"({"sunder": 1, "seed": )" + digits + "}").size(), 200u);
  EXPECT_LT(refusal(R"({"sunder": 1, ")" + letters + R"(": 1})").size(), 300u);
  EXPECT_LT(refusal(R"({"sunder": 1, "walls": [{"name": ")" + letters + "\"}]}").size(), 200u);
  EXPECT_LT(refusal(R"({"sunder": 1, "walls": [{"asset": ")" + letters + "\"}]}").size(), 300u);
  EXPECT_LT(refusal(R"({"sunder": )" + letters + "}").size(), 200u);
}

TEST(Scene, TooManyValuesAreRefused) {
  std::string text = R"({"sunder": 1, "building": {"a": [)";
  text.reserve(2 * kMaxJsonValues + 100);
  for (std::size_t i = 0; i < kMaxJsonValues; ++i) text += "0,";
  const std::string message = refusal(text + "0]}}");
  EXPECT_NE(message.find("more than 8388608 values"), std::string::npos) << message;
}

// --- Overrides -------------------------------------------------------------------------------

constexpr const char* kOneWall = R"({"sunder": 1, "walls": [{"name": "a", "thickness": 0.2}]})";

TEST(Override, ReplacesAValueAndAddsAKey) {
  const Scene scene = parse_scene(
      kOneWall, "scene.json",
      {.overrides = {"walls.0.thickness=0.5", "walls.0.name=front", "seed=9",
                     R"(walls.0.pattern={"type": "quad-grid"})", "walls.0.pattern.jitter=0.25",
                     R"(walls.0.material="brick")", "walls.0.outline.rect=[4, 2]"}});
  EXPECT_EQ(scene.seed, 9u);
  EXPECT_EQ(scene.walls[0].thickness, 0.5);
  EXPECT_EQ(scene.walls[0].name, "front");
  EXPECT_EQ(scene.walls[0].material, "brick");
  EXPECT_EQ(scene.walls[0].region.outline, rectangle({4, 2}));
  EXPECT_EQ(std::get<QuadGridParams>(scene.walls[0].pattern).jitter, 0.25);
}

TEST(Override, ReachesProjectilesAndSimulation) {
  const Scene scene =
      parse_scene(kFullScene, "s",
                  {.overrides = {"projectiles.0.velocity=[0, 0, -20]", "projectiles.0.mass=12",
                                 "projectiles.1.position.1=7", "simulation.step=0.001",
                                 "simulation.ground=true", "simulation.solver=hybrid"}});
  EXPECT_EQ(scene.projectiles[0].velocity, (Vec3{0, 0, -20}));
  EXPECT_EQ(scene.projectiles[0].mass, 12);
  EXPECT_EQ(scene.projectiles[1].position, (Vec3{1, 7, 4}));
  EXPECT_EQ(scene.simulation.step, 0.001);
  EXPECT_TRUE(scene.simulation.ground);
  EXPECT_EQ(scene.simulation.solver, "hybrid");
  EXPECT_EQ(refusal(kFullScene, {.overrides = {"projectiles.0.mass=0"}}),
            "scene.json: --set: /projectiles/0/mass: 0 is outside [1e-9, 1e9] kg");
}

TEST(Override, TheLastOneCounts) {
  const Scene scene = parse_scene(kOneWall, "s", {.overrides = {"seed=2", "seed=3"}});
  EXPECT_EQ(scene.seed, 3u);
}

TEST(Override, MayMendAScene) {
  EXPECT_NO_THROW(parse_scene(R"({"sunder": 1, "walls": [{"thickness": -1}]})", "s",
                              {.overrides = {"walls.0.thickness=1"}}));
}

TEST(Override, AValueThatIsWrongNamesTheOption) {
  const std::string message = refusal(
      kOneWall, {.overrides = {"walls.0.pattern.jitter=1.4", "walls.0.pattern.type=quad-grid"}});
  EXPECT_EQ(message, "scene.json: --set: /walls/0/pattern/jitter: 1.4 is outside [0, 1]");
  EXPECT_NE(refusal(kOneWall, {.overrides = {"walls.0.thicknes=1"}}).find("did you mean"),
            std::string::npos);
}

TEST(Override, APathThatLeadsNowhereIsAUsageError) {
  const std::pair<const char*, const char*> rows[] = {
      {"walls.1.thickness=1", "\"1\" is no entry of a list of 1"},
      {"walls.-1.thickness=1", "\"-1\" is no entry of a list of 1"},
      {"walls.first=1", "\"first\" is no entry of a list of 1"},
      {"walls.18446744073709551616=1", "is no entry of a list of 1"},
      {"walls.0.thickness.x=1", "0.2 has no entry \"x\", it is a number"},
      {"seed", "must be PATH=VALUE"},
      {"=1", "the path has an empty part"},
      {"walls..name=1", "the path has an empty part"},
      {"", "must be PATH=VALUE"},
  };
  for (const auto& [text, words] : rows) {
    const std::string message = refusal(kOneWall, {.overrides = {text}}, ErrorCode::usage);
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with("--set ")) << message;
  }
  std::string deep = "a";
  for (int i = 0; i < 100; ++i) deep += ".a";
  refusal(kOneWall, {.overrides = {deep + "=1"}}, ErrorCode::usage);
}

// --- Files -----------------------------------------------------------------------------------

TEST(SceneFile, IsReadAndNamedInMessages) {
  const Folder folder;
  EXPECT_EQ(read_scene(folder.write("good.json", kOneWall)).walls[0].name, "a");
  const fs::path bad = folder.write("bad.json", "{\"sunder\": 1,\n \"walls\": [{\"x\": 1}]}");
  EXPECT_TRUE(file_refusal(bad).starts_with(bad.string() + ":2: /walls/0/x: unknown key"));
}

TEST(SceneFile, WhatIsNoFileIsRefusedAtOnce) {
  const Folder folder;
  const fs::path pipe = folder.path() / "pipe", loop = folder.path() / "loop";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink(loop, loop);
  EXPECT_NE(file_refusal(folder.path()).find("is a folder"), std::string::npos);
  EXPECT_NE(file_refusal(pipe).find("is a pipe or a device"), std::string::npos);
  EXPECT_NE(file_refusal("/dev/zero").find("is a pipe or a device"), std::string::npos);
  EXPECT_NE(file_refusal(loop).find("cannot be opened"), std::string::npos);
  EXPECT_NE(file_refusal(folder.path() / "none").find("No such file"), std::string::npos);
  EXPECT_NE(file_refusal(std::string(5000, 'a')).find("cannot be opened"), std::string::npos);
  EXPECT_NE(file_refusal("a\nb\x1b[31m").find("a\\nb\\u001b[31m: cannot"), std::string::npos);
}

TEST(SceneFile, AboveTheSizeLimitIsRefused) {
  const Folder folder;
  const fs::path path = folder.write("large.json", "{}");
  fs::resize_file(path, kMaxJsonBytes + 1);  // sparse: takes no space
  EXPECT_NE(file_refusal(path).find("is larger than 67108864 bytes"), std::string::npos);
}

TEST(SceneFile, AnAssetIsFoundBesideTheScene) {
  const Folder folder;
  folder.write("scenes/parts/wall.glb", "glb");
  const fs::path scene =
      folder.write("scenes/s.json", R"({"sunder": 1, "walls": [{"asset": "parts/wall.glb"}]})");
  EXPECT_EQ(read_scene(scene).walls[0].asset, (folder.path() / "scenes/parts/wall.glb").string());
}

TEST(SceneFile, AnAssetKeepsItsMaterialUnlessOneIsGiven) {
  const Folder folder;
  folder.write("wall.glb", "glb");
  const auto material = [&](const std::string& keys) {
    const fs::path scene = folder.write("s.json", R"({"sunder": 1, "walls": [{)" + keys + "}]}");
    return read_scene(scene).walls[0].material;
  };
  EXPECT_EQ(material(R"("asset": "wall.glb")"), "");
  EXPECT_EQ(material(R"("asset": "wall.glb", "material": "brick")"), "brick");
  EXPECT_EQ(material(R"("asset": "wall.glb", "material": "concrete-c30")"), "concrete-c30");
  EXPECT_EQ(material(""), "concrete-c30");
  EXPECT_NE(file_refusal(folder.write("s.json", R"({"sunder": 1, "walls": [{"asset": "wall.glb",
                                                     "material": ""}]})"))
                .find("/walls/0/material: unknown material \"\""),
            std::string::npos);
}

TEST(SceneFile, AnAssetOutsideTheFolderNeedsLeave) {
  const Folder folder;
  const fs::path outside = folder.write("wall.glb", "glb");
  fs::create_directories(folder.path() / "scenes");
  fs::create_symlink(outside, folder.path() / "scenes/link.glb");
  fs::create_directory_symlink(folder.path(), folder.path() / "scenes/up");
  for (const std::string& asset :
       {std::string("../wall.glb"), outside.string(), std::string("link.glb"),
        std::string("up/wall.glb"), std::string("./../wall.glb")}) {
    const fs::path scene =
        folder.write("scenes/s.json", R"({"sunder": 1, "walls": [{"asset": ")" + asset + "\"}]}");
    EXPECT_NE(file_refusal(scene).find("is not in the scene's folder"), std::string::npos) << asset;
    EXPECT_NO_THROW(read_scene(scene, {.allow_outside = true})) << asset;
  }
}

TEST(SceneFile, ALinkInsideTheFolderIsFine) {
  const Folder folder;
  folder.write("wall.glb", "glb");
  fs::create_symlink("wall.glb", folder.path() / "link.glb");
  const fs::path scene =
      folder.write("s.json", R"({"sunder": 1, "walls": [{"asset": "link.glb"}]})");
  EXPECT_NO_THROW(read_scene(scene));
}

TEST(SceneFile, AFolderWithTheSameBeginningIsOutside) {
  const Folder folder;
  folder.write("scenes2/wall.glb", "glb");
  const fs::path scene = folder.write(
      "scenes/s.json", R"({"sunder": 1, "walls": [{"asset": "../scenes2/wall.glb"}]})");
  EXPECT_NE(file_refusal(scene).find("is not in the scene's folder"), std::string::npos);
}

// --- Materials -------------------------------------------------------------------------------

TEST(Materials, BuiltInOnesAreComplete) {
  std::vector<std::string> names;
  for (const Material& material : builtin_materials()) {
    names.push_back(material.name);
    EXPECT_GT(material.density, 500) << material.name;
    EXPECT_GT(material.youngs_modulus, 1e9) << material.name;
    EXPECT_GT(material.poisson_ratio, 0) << material.name;
    EXPECT_GT(material.tensile_strength, 1e5) << material.name;
    EXPECT_GT(material.compressive_strength, material.tensile_strength) << material.name;
    EXPECT_GT(material.fracture_energy, 1) << material.name;
    EXPECT_FALSE(material.source.empty()) << material.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"concrete-c20", "concrete-c30", "concrete-c30-reinforced", "concrete-c40",
                                             "concrete-c50", "brick", "float-glass",
                                             "toughened-glass", "gypsum", "pmma"}));
  EXPECT_EQ(find_material(builtin_materials(), Wall().material).density, 2400);
}

// Irwin's relation between toughness and energy, K_Ic = 0.75 MPa √m.
TEST(Materials, GlassTakesTheEnergyOfItsToughness) {
  const Material& glass = find_material(builtin_materials(), "float-glass");
  const double toughness = 0.75e6, ratio = glass.poisson_ratio;
  const double energy = toughness * toughness * (1 - ratio * ratio) / glass.youngs_modulus;
  EXPECT_NEAR(glass.fracture_energy, energy, 0.005);
}

TEST(Materials, ASceneChangesOnlyWhatItGives) {
  const Scene scene = parse_scene(
      R"({"sunder": 1, "walls": [{}], "materials": [{"name": "brick", "density": 1900}]})", "s");
  EXPECT_EQ(scene.materials.size(), builtin_materials().size());
  const Material& brick = find_material(scene.materials, "brick");
  const Material& before = find_material(builtin_materials(), "brick");
  EXPECT_EQ(brick.density, 1900);
  EXPECT_EQ(before.density, 1850);
  EXPECT_EQ(brick.youngs_modulus, before.youngs_modulus);
}

TEST(Materials, AMissingOneIsSuggested) {
  try {
    find_material(builtin_materials(), "float-glas");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    EXPECT_NE(std::string(error.what()).find("did you mean \"float-glass\"?"), std::string::npos);
  }
}

// --- Words and texts -------------------------------------------------------------------------

/// Definition of the optimal string alignment distance, without its table.
std::size_t distance_by_definition(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  std::size_t best = std::min({distance_by_definition(a.substr(1), b) + 1,
                               distance_by_definition(a, b.substr(1)) + 1,
                               distance_by_definition(a.substr(1), b.substr(1)) + (a[0] != b[0])});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
    best = std::min(best, distance_by_definition(a.substr(2), b.substr(2)) + 1);
  }
  return best;
}

TEST(Suggestion, DistanceFollowsItsDefinition) {
  for (std::uint64_t i = 0; i < 300; ++i) {
    std::string words[2];
    for (std::uint64_t k = 0; k < 2; ++k) {
      const std::size_t size = random_bits(5, i, k) % 6;
      for (std::size_t j = 0; j < size; ++j) {
        words[k] += static_cast<char>('a' + random_bits(5, i, 10 + 10 * k + j) % 3);
      }
    }
    const std::size_t expected = distance_by_definition(words[0], words[1]);
    EXPECT_EQ(edit_distance(words[0], words[1], 9), expected) << words[0] << ' ' << words[1];
    EXPECT_EQ(edit_distance(words[1], words[0], 9), expected) << words[0] << ' ' << words[1];
  }
}

TEST(Suggestion, IsTheNearestWordOrNone) {
  const std::string_view words[] = {"cell", "count", "at", "jitter"};
  EXPECT_EQ(nearest_word("CELL", words), "cell");
  EXPECT_EQ(nearest_word("jtiter", words), "jitter");
  EXPECT_EQ(nearest_word("coutn", words), "count");
  EXPECT_EQ(nearest_word("xyz", words), "");
  EXPECT_EQ(nearest_word("", words), "");
  EXPECT_EQ(nearest_word("x", words), "");  // two edits make "at" of anything this short
  EXPECT_EQ(nearest_word(std::string(1000000, 'c'), words), "");
}

TEST(Printable, KeepsLettersAndEscapesTheRest) {
  EXPECT_EQ(printable("façade 壁 🧱"), "façade 壁 🧱");
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable("\x1b[31m"), "\\u001b[31m");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\u0000");
  EXPECT_EQ(printable("\xff\xc0\x80"), "\\xff\\xc0\\x80");
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");
  EXPECT_EQ(printable("\xc2\x9b"), "\\u009b");
  EXPECT_EQ(printable("abcdef", 3), "abc…");
  EXPECT_EQ(printable("abc", 3), "abc");
}

TEST(NumberText, IsShortAndReadsBack) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(1000000), "1000000");
  EXPECT_EQ(number_text(-0.25), "-0.25");
  EXPECT_EQ(number_text(1e-9), "1e-9");
  EXPECT_EQ(number_text(3.03e10), "3.03e10");
  EXPECT_EQ(number_text(1e300), "1e300");
  EXPECT_EQ(number_text(16777216), "16777216");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double value = std::ldexp(random_unit(3, i) - 0.5, static_cast<int>(i % 200) - 100);
    EXPECT_EQ(std::stod(number_text(value)), value) << "value " << i;
  }
}

TEST(RangeText, TellsOpenAndHalfOpenRanges) {
  EXPECT_EQ(range_text({0, 1}), "[0, 1]");
  EXPECT_EQ(range_text({0, 5, true}, "m"), "(0, 5] m");
  EXPECT_EQ(range_text({.low = 3}), "at least 3");
  EXPECT_EQ(range_text({.high = 3}), "at most 3");
  EXPECT_EQ(range_text({1, 1}), "1");
  EXPECT_EQ(range_text({}), "");
}

// --- Rotation --------------------------------------------------------------------------------

Vec3 turn_by_hand(const Quaternion& q, Vec3 v) {
  const Vec3 axis{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(axis, v);
  return v + q.w * t + cross(axis, t);
}

/// Turns about x, then y, then z by plain matrices.
Vec3 turned_in_steps(Vec3 degrees, Vec3 v) {
  const auto turn = [](double angle, double& a, double& b) {
    const double c = std::cos(angle * std::acos(-1.0) / 180);
    const double s = std::sin(angle * std::acos(-1.0) / 180);
    const double first = c * a - s * b;
    b = s * a + c * b;
    a = first;
  };
  turn(degrees.x, v.y, v.z);
  turn(degrees.y, v.z, v.x);
  turn(degrees.z, v.x, v.y);
  return v;
}

TEST(Rotation, TurnsAboutXThenYThenZ) {
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Vec3 degrees{720 * random_unit(8, i, 0) - 360, 720 * random_unit(8, i, 1) - 360,
                       720 * random_unit(8, i, 2) - 360};
    const Quaternion q = rotation_from_degrees(degrees);
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1, 1e-15);
    EXPECT_GE(q.w, 0);
    const Vec3 expected = turned_in_steps(degrees, {1, 2, 3});
    EXPECT_NEAR(length(turn_by_hand(q, {1, 2, 3}) - expected), 0, 1e-14) << "case " << i;
  }
}

TEST(Rotation, QuarterTurnsAreExact) {
  int count = 0;
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z, ++count) {
        const Quaternion q = rotation_from_degrees({90.0 * x, 90.0 * y, 90.0 * z});
        for (const double part : {q.x, q.y, q.z, q.w}) {
          const double size = std::abs(part);
          EXPECT_TRUE(size == 0 || size == 0.5 || size == std::sqrt(0.5) || size == 1) << part;
          EXPECT_FALSE(part == 0 && std::signbit(part));
        }
        const Vec3 degrees{90.0 * x, 90.0 * y, 90.0 * z};
        EXPECT_NEAR(length(turn_by_hand(q, {1, 2, 3}) - turned_in_steps(degrees, {1, 2, 3})), 0, 1e-13);
      }
    }
  }
  EXPECT_EQ(count, 729);
}

TEST(Rotation, AWholeTurnIsNone) {
  for (const double turn : {0.0, 360.0, -360.0, 720.0}) {
    EXPECT_EQ(rotation_from_degrees({turn, 0, 0}), Quaternion{});
    EXPECT_EQ(rotation_from_degrees({0, turn, turn}), Quaternion{});
  }
}

}  // namespace
}  // namespace sunder
