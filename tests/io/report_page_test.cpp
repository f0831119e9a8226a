// SPDX-License-Identifier: GPL-3.0-or-later
// Reports as HTML pages.
#include "io/report_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "io/page_text.hpp"
#include "sim/frames.hpp"
#include "sim/impact_scenes.hpp"

namespace sunder {
namespace {

const PageSource kSource{"frame.json", "sunder collapse frame.json --report r.html"};

bool has(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

/// Elements that open and close, in order; text is free of stray markup.
void expect_well_formed(const std::string& page) {
  std::vector<std::string> open;
  const std::regex tag(R"(<(/?)([a-z0-9]+)([^<>]*)>)");
  const std::size_t style = page.find("</style>");
  ASSERT_NE(style, std::string::npos);
  for (std::sregex_iterator it(page.begin() + static_cast<std::ptrdiff_t>(style), page.end(), tag),
       end;
       it != end; ++it) {
    const std::string name = (*it)[2], rest = (*it)[3];
    if (rest.ends_with('/') || name == "meta") continue;
    if ((*it)[1].length() == 0) {
      open.push_back(name);
    } else if (name != "style" && name != "head" && name != "html") {
      ASSERT_FALSE(open.empty()) << name;
      ASSERT_EQ(open.back(), name);
      open.pop_back();
    }
  }
  EXPECT_TRUE(open.empty());
  const std::string body = page.substr(style);
  EXPECT_EQ(std::ranges::count(body, '<'), std::ranges::count(body, '>'));
}

void expect_self_contained(const std::string& page) {
  for (const char* text :
       {"<script", "http:", "https:", "<link", "<img", "url(", "@import", "nan", "src="})
    EXPECT_FALSE(has(page, text)) << text;
}

CollapseScene struck_frame(const std::string& solver = "hybrid") {
  CollapseScene scene = regular_scene(2, 2, 2);
  scene.simulation.solver = solver;
  scene.simulation.duration = 0.6;
  Projectile p;
  p.name = "ball";
  p.radius = 0.5;
  p.mass = 4000;
  p.position = {-3, 3.6, 0.2};
  p.velocity = {25, 0, 0};
  scene.projectiles = {p};
  return scene;
}

std::string page_of(const CollapseScene& scene, const CollapseResult& result) {
  return collapse_page({"1.2",
                        scene,
                        result,
                        3.5,
                        {{"simulate", 1.5}},
                        {scene.simulation, error_front("collapse"), {0.01, false, {}, {}}}},
                       kSource);
}

TEST(ReportPage, OfACollapseIsOneWholeFile) {
  for (const char* solver : {"hybrid", "bullet"}) {
    const CollapseScene scene = struck_frame(solver);
    const CollapseResult result = simulate_collapse(scene);
    const std::string page = page_of(scene, result);
    expect_well_formed(page);
    expect_self_contained(page);
    ASSERT_GT(result.broken_joints.size(), 12u);
    for (const std::string& text :
         {std::string("frame.json"), kSource.command, std::string("Broken joints"),
          std::string("Energy over time"), std::string("within 1\u00a0%"),
          scene.frame.joints[result.broken_joints[0].joint].name,
          "The other " + std::to_string(result.broken_joints.size() - 12) + " broken joints"})
      EXPECT_TRUE(has(page, text)) << text;
    EXPECT_EQ(has(page, "shocks in rigid joints"), solver == std::string("bullet"));
    CollapseResult again = simulate_collapse(scene);
    again.step_ms_median = result.step_ms_median, again.step_ms_p95 = result.step_ms_p95;
    again.step_ms_max = result.step_ms_max;
    EXPECT_EQ(page, page_of(scene, again));
  }
}

TEST(ReportPage, OfAnImpactSaysWhatBecameOfTheProjectile) {
  const ImpactScene scene = impact_scene_of({});
  const ImpactResult result = simulate_impact(scene);
  const std::string page =
      impact_page({"1.2",
                   7,
                   result,
                   3.5,
                   {},
                   {scene.simulation, error_front("impact"), {0.01, true, {"step"}, 0.004}}},
                  kSource);
  expect_well_formed(page);
  expect_self_contained(page);
  EXPECT_TRUE(has(page, "Broken bonds"));
  EXPECT_TRUE(has(page, result.projectiles[0].perforated ? "got through" : "did not get through"));
  EXPECT_TRUE(has(page, count_text(result.broken_bonds) + " bonds broke"));
}

TEST(ReportPage, JudgesEachErrorByTheOneAskedFor) {
  CollapseScene scene = struck_frame();
  CollapseResult result = simulate_collapse(scene);
  EXPECT_TRUE(has(page_of(scene, result), "All 4 relative errors of this run are within"));
  result.reaction_error = 0.02;
  result.residual = std::nan("");
  const std::string page = page_of(scene, result);
  EXPECT_TRUE(has(page, "2 of 4 relative errors of this run exceed the 1\u00a0%"));
  EXPECT_TRUE(has(page, "<span class=\"badge bad\">above 1\u00a0%</span>"));
  scene.simulation.max_error = 0.05;
  result.residual = 0.04;
  EXPECT_TRUE(has(page_of(scene, result), "within 5\u00a0%"));
}

TEST(ReportPage, NamesCannotBreakOutOfTheirPlace) {
  const CollapseScene scene = struck_frame();
  CollapseResult result = simulate_collapse(scene);
  const std::string evil = "<script>alert('x')</script>\"&";
  result.projectiles[0].name = result.sag_node = evil;
  result.broken_joints[0].rule = evil;
  result.warnings = {evil};
  const std::string page = collapse_page(
      {"1.2", scene, result, 3.5, {}, {scene.simulation, error_front("collapse"), {}}},
      {evil, evil});
  expect_well_formed(page);
  expect_self_contained(page);
  EXPECT_TRUE(has(page, "&lt;script&gt;"));
  EXPECT_TRUE(has(page, "<h2>Warning</h2>"));
}

TEST(ReportPage, AQuietRunSaysSo) {
  CollapseScene scene = struck_frame();
  scene.projectiles.clear();
  CollapseResult result = simulate_collapse(scene);
  std::string page = page_of(scene, result);
  expect_well_formed(page);
  EXPECT_TRUE(has(page, "The building stands"));
  EXPECT_FALSE(has(page, "What broke first"));
  EXPECT_FALSE(has(page, "Projectiles"));
  result.recording.series.clear();
  page = page_of(scene, result);
  expect_well_formed(page);
  EXPECT_FALSE(has(page, "<svg"));
  scene.scenario.remove = {"post_0_0_0"};
  scene.rules.breaking = false;
  page = page_of(scene, simulate_collapse(scene));
  EXPECT_TRUE(has(page, "joints broke but the "));
  EXPECT_TRUE(has(page, "joints were told to hold"));
  EXPECT_TRUE(has(page, "What broke first"));
}

TEST(ReportPage, OfAnAssetListsItsFaults) {
  Report report;
  report.version = "1.2";
  report.soundness.chunks = 3;
  report.soundness.volume = report.soundness.volume_expected = 2;
  report.soundness.min_chunk_volume = 0.25;
  std::string page = soundness_page(report, {"wall.glb", ""});
  expect_well_formed(page);
  expect_self_contained(page);
  EXPECT_TRUE(has(page, "Sound: every chunk is closed"));
  report.soundness.open_chunks = 2;
  page = soundness_page(report, {"wall.glb", ""});
  EXPECT_TRUE(has(page, "Not sound"));
  EXPECT_TRUE(has(page, "<span class=\"badge bad\">fault</span>"));
  EXPECT_FALSE(has(page, "<pre>"));
}

}  // namespace
}  // namespace sunder
