// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/recover.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "fracture/chunk_mesh.hpp"
#include "fracture/same_asset.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

/// A strictly convex cell cut into sectors around `point`, which is vertex `new_vertex`.
std::vector<NewCell> sectors(const Pattern& pattern, std::uint32_t cell, Vec2 point,
                             std::uint32_t new_vertex, std::uint32_t count) {
  if (!is_strictly_convex(pattern, cell)) return {};
  const std::uint32_t* corners = pattern.corners.data() + pattern.cell_begin[cell];
  const std::uint32_t size = pattern.cell_begin[cell + 1] - pattern.cell_begin[cell];
  std::vector<Vec2> places;
  for (std::uint32_t i = 0; i < size; ++i) places.push_back(pattern.vertices[corners[i]]);
  const std::vector<std::uint32_t> spokes = choose_spokes(places, point, count);
  std::vector<NewCell> result;
  for (std::size_t s = 0; s < spokes.size(); ++s) {
    std::vector<std::uint32_t> loop{new_vertex, corners[spokes[s]]};
    for (std::uint32_t i = spokes[s]; i != spokes[(s + 1) % spokes.size()];) {
      i = i + 1 == size ? 0 : i + 1;
      loop.push_back(corners[i]);
    }
    result.push_back({{std::move(loop)}});
  }
  return result;
}

using Ids = std::vector<std::uint32_t>;

WallAsset recovered(const WallAsset& asset) {
  const RenderMeshes meshes = render_meshes(asset);
  return recover_wall(soup_of(asset, meshes), asset.wall, asset.density);
}

std::vector<std::pair<std::string, Wall>> sample_walls() {
  const Loop gable{{0, 0}, {6, 0}, {6, 2}, {3.1, 3.7}, {0, 2}};
  const std::pair<std::string, Region> regions[] = {
      {"box", {rectangle({6, 3}), {}}},
      {"door and window",
       {rectangle({6, 3}), {rectangle({0.9, 2.1}, {1, 0}), rectangle({1.5, 1}, {3, 1})}}},
      {"gable", {gable, {rectangle({1, 1}, {2.5, 1.2})}}},
      {"openings touch",
       {rectangle({6, 3}), {rectangle({1, 1}, {1, 0.7}), rectangle({1, 1}, {2, 1.7})}}},
      {"two parts", {rectangle({6, 3}), {rectangle({0.6, 3}, {2, 0})}}}};
  const std::pair<std::string, PatternParams> patterns[] = {
      {"voronoi", VoronoiGridParams{0.35, 1}},
      {"squares", VoronoiGridParams{0.5, 0}},
      {"quads", QuadGridParams{0.4, 0.9}},
      {"web", SpiderwebParams{.impacts = {{3.3, 0.7}}}},
      {"focus", VoronoiFocusParams{{{4, 2}}, 150, 1, 0.8}}};
  std::vector<std::pair<std::string, Wall>> walls;
  for (const auto& [shape, region] : regions)
    for (const auto& [type, pattern] : patterns) {
      Wall& wall = walls.emplace_back(shape + ", " + type, Wall{}).second;
      wall.region = region;
      wall.pattern = pattern;
      wall.thickness = 0.15;
      wall.anchors = {"bottom", "left"};
    }
  return walls;
}

std::vector<std::array<float, 3>> positions_of(const RenderMeshes& meshes, std::uint32_t c) {
  std::vector<std::array<float, 3>> points;
  for (std::size_t v = meshes.vertex_begin[c]; v < meshes.vertex_begin[c + 1]; ++v)
    points.push_back(
        {meshes.positions[3 * v], meshes.positions[3 * v + 1], meshes.positions[3 * v + 2]});
  std::ranges::sort(points);
  return points;
}

void expect_bonds_near(const WallAsset& asset, const WallAsset& back, const std::string& what) {
  ASSERT_EQ(asset.bonds.size(), back.bonds.size()) << what;
  // A length has the rounding of its two ends: 2^-24 of the wall's size for each coordinate.
  const double rounding = 4 * 0x1p-24 * 6 * asset.wall.thickness;
  std::multiset<std::uint32_t> anchored, anchored_back;
  double sum = 0, sum_back = 0;
  for (std::size_t i = 0; i < asset.bonds.size(); ++i) {
    const Bond &p = asset.bonds[i], &q = back.bonds[i];
    sum += p.area, sum_back += q.area;
    if (p.b == kWorld) anchored.insert(p.a);
    if (q.b == kWorld) anchored_back.insert(q.a);
    if (p.b == kWorld || q.b == kWorld) continue;
    ASSERT_EQ(std::pair(p.a, p.b), std::pair(q.a, q.b)) << what;
    EXPECT_NEAR(p.area, q.area, rounding * (1 + p.area)) << what;
    EXPECT_LT(length(p.centroid - q.centroid), 1e-4) << what;
    if (p.area < 1e-3) continue;
    EXPECT_GT(dot(p.normal, q.normal), 1 - 1e-6) << what;
  }
  EXPECT_EQ(anchored, anchored_back) << what;
  EXPECT_NEAR(sum_back, sum, 1e-6 * sum) << what;
}

// By how much of itself a cell's area can change when every corner moves by the rounding of its two
// coordinates, 2^-24 of at most 6 m each: an edge sweeps at most its length times that.
double rounding_share(const Pattern& pattern, std::uint32_t c) {
  double perimeter = 0;
  for (const LoopRange loop : loops_of(pattern, c))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k)
      perimeter += length(pattern.vertices[pattern.corners[loop.next(k)]] -
                          pattern.vertices[pattern.corners[k]]);
  return 1.5 * 0x1p-24 * 6 * perimeter / cell_area(pattern, c);
}

void expect_recovered(const WallAsset& asset, const std::string& what) {
  const RenderMeshes meshes = render_meshes(asset);
  const WallAsset back = recover_wall(soup_of(asset, meshes), asset.wall, asset.density);
  EXPECT_EQ(check(back.pattern), PatternDefects{}) << what;
  ASSERT_EQ(back.pattern.cell_count(), asset.pattern.cell_count()) << what;
  EXPECT_NEAR(back.volume_expected, asset.volume_expected, 1e-6 * asset.volume_expected) << what;
  EXPECT_NEAR(back.wall.thickness, asset.wall.thickness, 1e-7 * asset.wall.thickness) << what;
  EXPECT_NEAR(area(back.region), area(asset.region), 1e-6 * area(asset.region)) << what;
  EXPECT_NEAR(total_area(back.pattern), area(back.region), 1e-12 * area(back.region)) << what;
  for (std::uint32_t c = 0; c < back.pattern.cell_count(); ++c) {
    const double size = cell_area(asset.pattern, c);
    const double share = rounding_share(asset.pattern, c);
    const double limit = size > 1e-3 ? std::min(share, 1e-5) : share;
    EXPECT_NEAR(cell_area(back.pattern, c), size, limit * size) << what << " chunk " << c;
    double parts = 0;
    for (const Ids& part : convex_parts(back, c)) {
      Loop loop;
      for (const std::uint32_t v : part) loop.push_back(back.pattern.vertices[v]);
      parts += area(std::span<const Vec2>(loop));
    }
    EXPECT_NEAR(parts, cell_area(back.pattern, c), 1e-12 * size) << what << " chunk " << c;
    EXPECT_LT(length(back.chunks[c].centroid - asset.chunks[c].centroid), 1e-6) << what;
    const double inertia = asset.chunks[c].inertia.zz;
    EXPECT_NEAR(back.chunks[c].inertia.zz, inertia, 4 * share * inertia) << what << " chunk " << c;
  }
  expect_bonds_near(asset, back, what);
  const RenderMeshes again = render_meshes(back);
  for (std::uint32_t c = 0; c < back.pattern.cell_count(); ++c)
    ASSERT_EQ(positions_of(meshes, c), positions_of(again, c)) << what << " chunk " << c;
  EXPECT_TRUE(measure({soup_of(back, again)}).is_sound()) << what;
  expect_same(back, recover_wall(soup_of(back, again), back.wall, back.density), what);
}

TEST(Recover, AWallComesBackAsFarAsFloatsCanTell) {
  for (const auto& [what, wall] : sample_walls())
    expect_recovered(fracture_wall(wall, 2400, {.seed = 5}), what);
}

TEST(Recover, AWallComesBackOverSeeds) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Wall wall;
    wall.pattern = VoronoiGridParams{0.4, 1};
    wall.anchors = {"top", "right"};
    if (seed % 2)
      wall.region.openings = {rectangle({1.1, 0.7}, {2, 0.3 + 2 * random_unit(seed, 1)})};
    expect_recovered(fracture_wall(wall, 2400, {.seed = seed}), "seed " + std::to_string(seed));
  }
}

// The same chunk as another program may write it: triangles in another order, each from another
// corner on, no vertex shared.
SoupChunk shuffled(const SoupChunk& chunk, std::uint64_t seed) {
  std::vector<std::uint32_t> order(chunk.triangles.size() / 3);
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::uint32_t i = static_cast<std::uint32_t>(order.size()); i > 1; --i)
    std::swap(order[i - 1], order[random_bits(seed, i) % i]);
  SoupChunk result;
  for (const std::uint32_t t : order)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = chunk.triangles[3 * t + (i + random_bits(seed, 1000 + t) % 3) % 3];
      result.triangles.push_back(static_cast<std::uint32_t>(result.positions.size() / 3));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float value = chunk.positions[std::size_t{3} * v + axis];
        result.positions.push_back(value == 0 && t % 2 ? -value : value);
      }
    }
  return result;
}

TEST(Recover, TheOrderOfTrianglesAndVerticesDoesNotMatter) {
  for (const auto& [what, wall] : sample_walls()) {
    const WallAsset asset = fracture_wall(wall, 2400, {.seed = 2});
    const RenderMeshes meshes = render_meshes(asset);
    const SoupWall soup = soup_of(asset, meshes);
    SoupWall other = soup;
    other.chunk = [&](std::uint32_t c) { return shuffled(soup.chunk(c), c); };
    expect_same(recover_wall(soup, asset.wall, 2400), recover_wall(other, asset.wall, 2400), what);
  }
}

// --- by hand

// A convex prism as a soup.
SoupChunk prism(const Loop& loop, float half) {
  SoupChunk chunk;
  const auto size = static_cast<std::uint32_t>(loop.size());
  for (const float z : {-half, half})
    for (const Vec2& p : loop)
      for (const float v : {static_cast<float>(p.x), static_cast<float>(p.y), z})
        chunk.positions.push_back(v);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t v : {a, b, c}) chunk.triangles.push_back(v);
  };
  for (std::uint32_t i = 2; i < size; ++i) {
    add(size, size + i - 1, size + i);
    add(0, i, i - 1);
  }
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t j = (i + 1) % size;
    add(i, j, size + j);
    add(i, size + j, size + i);
  }
  return chunk;
}

WallAsset recovered(const std::vector<SoupChunk>& chunks, const Wall& wall = {}) {
  SoupWall soup;
  soup.chunk_count = static_cast<std::uint32_t>(chunks.size());
  soup.chunk = [&](std::uint32_t c) { return chunks[c]; };
  return recover_wall(soup, wall, 2000);
}

TEST(Recover, TwoBoxesHaveTheirClosedForm) {
  Wall wall;
  wall.anchors = {"bottom"};
  const WallAsset asset =
      recovered({prism(rectangle({1, 2}), 0.25f), prism(rectangle({2, 2}, {1, 0}), 0.25f)}, wall);
  EXPECT_EQ(asset.wall.thickness, 0.5);
  EXPECT_EQ(asset.density, 2000);
  EXPECT_TRUE(asset.pattern.all_convex);
  EXPECT_EQ(asset.wall.region.outline, rectangle({3, 2}));
  EXPECT_TRUE(asset.wall.region.openings.empty());
  EXPECT_DOUBLE_EQ(asset.volume_expected, 3);
  EXPECT_DOUBLE_EQ(asset.chunks[1].volume, 2);
  EXPECT_LT(length(asset.chunks[1].centroid - Vec3{2, 1, 0}), 1e-15);
  EXPECT_EQ(asset.chunks[1].centroid.z, 0);
  EXPECT_NEAR(asset.chunks[1].inertia.zz, 2.0 / 12 * (4 + 4), 1e-15);
  EXPECT_NEAR(asset.chunks[1].inertia.xx, 2.0 / 12 * (4 + 0.25), 1e-15);
  const std::vector<Bond> expected{{0, 1, 1, {1, 1, 0}, {1, 0, 0}},
                                   {0, kWorld, 0.5, {0.5, 0, 0}, {0, -1, 0}},
                                   {1, kWorld, 1, {2, 0, 0}, {0, -1, 0}}};
  EXPECT_TRUE(all_same(asset.bonds, expected));
}

std::string message_of(const std::vector<SoupChunk>& chunks) {
  try {
    recovered(chunks);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::geometry);
    return error.what();
  }
  return "";
}

TEST(Recover, WhatIsNotAPrismIsAnErrorThatNamesTheChunk) {
  const SoupChunk good = prism(rectangle({1, 1}), 0.5f);
  ASSERT_EQ(message_of({good}), "");
  const auto expect_error = [&](const SoupChunk& bad, const std::string& reason) {
    const std::string message = message_of({good, bad});
    EXPECT_NE(message.find("wall_chunk_0001"), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  };
  const SoupChunk next = prism(rectangle({1, 1}, {1, 0}), 0.5f);
  SoupChunk bad = next;
  bad.positions[2] = -0.4f;
  expect_error(bad, "planes");
  bad = next;
  bad.positions[0] = 1.25f;  // a corner of the back only
  expect_error(bad, "neither in front");
  bad = next;
  bad.triangles.resize(bad.triangles.size() - 3);
  expect_error(bad, "not closed");
  bad = next;
  for (std::size_t t = 0; t < bad.triangles.size(); t += 3)
    std::swap(bad.triangles[t], bad.triangles[t + 1]);
  expect_error(bad, "inside out");
  bad = next;
  bad.positions[4] = std::numeric_limits<float>::quiet_NaN();
  expect_error(bad, "finite");
  bad = next;
  const SoupChunk far = prism(rectangle({1, 1}, {5, 0}), 0.5f);
  for (const std::uint32_t v : far.triangles) bad.triangles.push_back(v + 8);
  bad.positions.insert(bad.positions.end(), far.positions.begin(), far.positions.end());
  expect_error(bad, "not one solid");
  expect_error(prism(rectangle({1, 1}, {1, 0}), 0.25f), "planes");
  expect_error(SoupChunk{}, "no triangles");
  SoupChunk wedge;  // closed, all corners in the planes, its back an edge
  wedge.positions = {1, 0, 0.5f, 2, 0, 0.5f, 2, 1, 0.5f, 1, 1, 0.5f, 1, 0, -0.5f, 2, 0, -0.5f};
  wedge.triangles = {0, 1, 2, 0, 2, 3, 0, 4, 5, 0, 5, 1, 3, 2, 5, 3, 5, 4, 0, 3, 4, 1, 5, 2};
  expect_error(wedge, "neither in front");
}

TEST(Recover, ASolidThatIsNotOnePrismIsAnError) {
  SoupChunk pinched = prism(rectangle({1, 1}), 0.5f);  // two boxes that touch in a corner
  const SoupChunk other = prism(rectangle({1, 1}, {1, 1}), 0.5f);
  for (const std::uint32_t v : other.triangles) pinched.triangles.push_back(v + 8);
  pinched.positions.insert(pinched.positions.end(), other.positions.begin(), other.positions.end());
  EXPECT_NE(message_of({pinched}).find("in the same direction"), std::string::npos);
  SoupChunk flap = prism(rectangle({1, 1}), 0.5f);  // a box, and a sheet without thickness
  for (const float x : {5.f, 6.f})
    for (const float z : {-0.5f, 0.5f})
      for (const float v : {x, 0.f, z}) flap.positions.push_back(v);
  const std::uint32_t a = 8, a_front = 9, b = 10, b_front = 11;
  for (const std::uint32_t v :
       {a, b, b_front, a, b_front, a_front, b, a, a_front, b, a_front, b_front})
    flap.triangles.push_back(v);
  EXPECT_NE(message_of({flap}).find("mirror"), std::string::npos);
}

TEST(Recover, ACellThatStandsOnBothSidesOfADoorHasOneAnchor) {
  Wall wall;
  wall.anchors = {"bottom"};
  wall.region.openings = {rectangle({1, 2}, {2, 0})};
  wall.pattern = VoronoiSitesParams{{{3, 2.5}}};
  const WallAsset asset = fracture_wall(wall, 2400, {});
  const WallAsset back = recovered(asset);
  ASSERT_EQ(asset.bonds.size(), 1u);
  ASSERT_EQ(back.bonds.size(), 1u);
  EXPECT_NEAR(back.bonds[0].area, 5 * 0.2, 1e-6);
  EXPECT_EQ(back.region.loop_count(), 1u);
  EXPECT_EQ(back.region.edge_count(), 8u);
}

TEST(Recover, TheOutlineIsTheRegionsFirstLoopWhicheverCellComesFirst) {
  Wall wall;
  wall.region.openings = {rectangle({0.5, 0.5}, {2.75, 1.25})};
  wall.pattern = VoronoiSitesParams{{{3, 1}, {3, 0.25}, {1, 1}, {5, 1}, {3, 2.5}}};
  const WallAsset asset = fracture_wall(wall, 2400, {});
  for (const LoopRange loop : loops_of(asset.pattern, 0))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k)
      ASSERT_FALSE(asset.pattern.across[k].is_border() && asset.pattern.across[k].border() < 4)
          << "cell 0 must touch the opening only";
  const WallAsset back = recovered(asset);
  ASSERT_EQ(back.region.loop_count(), 2u);
  EXPECT_EQ(back.region.loop_begin[1], 4u);
  EXPECT_EQ(area(back.wall.region.outline), 18);
  ASSERT_EQ(back.wall.region.openings.size(), 1u);
  EXPECT_EQ(area(back.wall.region.openings[0]), -0.25);
}

TEST(Recover, ThreeChunksAtAnEdgeAreAnError) {
  const SoupChunk a = prism(rectangle({1, 1}), 0.5f), b = prism(rectangle({1, 1}, {1, 0}), 0.5f),
                  c = prism(rectangle({2, 1}, {1, 0}), 0.5f);
  EXPECT_EQ(message_of({a, b}), "");
  const std::string three = message_of({a, b, c});
  EXPECT_NE(three.find("more than two"), std::string::npos) << three;
  EXPECT_NE(three.find("wall_chunk_0001"), std::string::npos) << three;
  const std::string two = message_of({b, c});
  EXPECT_NE(two.find("same side"), std::string::npos) << two;
}

TEST(Recover, AFormatThatKeepsNoChunksApartIsAnError) {
  SoupWall soup;
  soup.chunk_count = 1;
  soup.has_chunks = false;
  soup.chunk = [](std::uint32_t) { return prism(rectangle({1, 1}), 0.5f); };
  EXPECT_THROW(recover_wall(soup, {}, 1), Error);
}

// --- replacing cells

std::vector<std::uint8_t> bottom_edges(const LatticeRegion& region) {
  std::vector<std::uint8_t> anchored;
  const double low = bounding_box(region.places).low.y;
  for (std::uint32_t f = 0; f < region.edge_count(); ++f)
    anchored.push_back(region.places[f].y == low && region.places[region.next(f)].y == low);
  return anchored;
}

// Corners of a cell, a loop's length before each loop.
Ids loops_text(const Pattern& pattern, std::uint32_t c) {
  Ids text;
  for (const LoopRange loop : loops_of(pattern, c)) {
    text.push_back(loop.size());
    text.insert(text.end(), pattern.corners.begin() + loop.begin,
                pattern.corners.begin() + loop.end);
  }
  return text;
}

void expect_replaced(const WallAsset& before, const Ids& removed, const ReplacedCells& after,
                     std::span<const NewCell> added, const std::string& what) {
  const Pattern& pattern = after.asset.pattern;
  EXPECT_EQ(check(pattern), PatternDefects{}) << what;
  const double expected = total_area(before.pattern);
  EXPECT_NEAR(total_area(pattern), expected, 1e-13 * expected) << what;
  const std::uint32_t kept =
      before.pattern.cell_count() - static_cast<std::uint32_t>(removed.size());
  ASSERT_EQ(pattern.cell_count(), kept + added.size()) << what;
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c) {
    const std::uint32_t old = after.old_cell[c];
    if (c >= kept) {
      EXPECT_EQ(old, 0xFFFFFFFFu - (c - kept)) << what;
      EXPECT_EQ(pattern.corners[pattern.cell_begin[c]], added[c - kept].loops[0][0]) << what;
      const double volume = cell_area(pattern, c) * before.wall.thickness;
      EXPECT_NEAR(after.asset.chunks[c].volume, volume, 1e-12 * volume) << what;
      continue;
    }
    EXPECT_EQ(std::ranges::count(removed, old), 0) << what;
    EXPECT_TRUE(c == 0 || after.old_cell[c - 1] < old) << what;
    EXPECT_EQ(loops_text(pattern, c), loops_text(before.pattern, old)) << what;
    EXPECT_EQ(pattern.origin_of(c), before.pattern.origin_of(old)) << what;
    EXPECT_TRUE(same(after.asset.chunks[c], before.chunks[old])) << what;
  }
  EXPECT_TRUE(std::equal(before.pattern.vertices.begin(), before.pattern.vertices.end(),
                         pattern.vertices.begin()))
      << what;
  const std::vector<Bond> bonds =
      find_bonds(pattern, after.asset.wall.thickness, bottom_edges(after.asset.region));
  EXPECT_TRUE(all_same(after.asset.bonds, bonds)) << what;
  bool convex = true;
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c) convex &= is_strictly_convex(pattern, c);
  EXPECT_EQ(pattern.all_convex, convex) << what;
  const RenderMeshes meshes = render_meshes(after.asset);
  EXPECT_TRUE(measure({soup_of(after.asset, meshes)}).is_sound()) << what;
}

// A float32 point inside a convex cell: a random mean of its corners.
Vec2 point_in(const Pattern& pattern, std::uint32_t c, std::uint64_t seed) {
  Vec2 sum;
  double weights = 0;
  for (std::uint32_t k = pattern.cell_begin[c]; k < pattern.cell_begin[c + 1]; ++k) {
    const double weight = 0.05 + random_unit(seed, k);
    sum = sum + weight * pattern.vertices[pattern.corners[k]];
    weights += weight;
  }
  return {static_cast<float>(sum.x / weights), static_cast<float>(sum.y / weights)};
}

WallAsset wall_to_split(std::uint64_t seed) {
  Wall wall;
  wall.anchors = {"bottom"};
  wall.pattern = VoronoiGridParams{0.5, 1};
  if (seed % 2) wall.region.openings = {rectangle({0.9, 2.1}, {1, 0}), rectangle({1.5, 1}, {3, 1})};
  return recovered(fracture_wall(wall, 2400, {.seed = seed}));
}

TEST(ReplaceCells, SplitAgainAndAgainTheWallStaysSound) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    WallAsset asset = wall_to_split(seed);
    for (std::uint64_t step = 0; step < 6; ++step) {
      const std::string what = "seed " + std::to_string(seed) + " step " + std::to_string(step);
      const Pattern& pattern = asset.pattern;
      Ids removed;
      std::vector<Vec2> points;
      std::vector<NewCell> added;
      for (std::uint64_t i = 0; i < 1 + step % 3; ++i) {
        // Later steps split neighbours and parts of earlier splits.
        const std::uint32_t from_end = static_cast<std::uint32_t>(random_bits(seed, step, i) % 20);
        const std::uint32_t c = pattern.cell_count() - 1 - from_end;
        if (!is_strictly_convex(pattern, c) || std::ranges::count(removed, c)) continue;
        const Vec2 point = point_in(pattern, c, seed + step);
        const auto index = static_cast<std::uint32_t>(pattern.vertices.size() + points.size());
        const auto parts = sectors(pattern, c, point, index, 3 + (seed + i) % 4);
        if (parts.empty()) continue;
        removed.push_back(c);
        points.push_back(point);
        added.insert(added.end(), parts.begin(), parts.end());
      }
      ReplacedCells after = replace_cells(asset, removed, points, added);
      expect_replaced(asset, removed, after, added, what);
      if (HasFailure()) return;
      asset = std::move(after.asset);
    }
  }
}

// Inserts vertex v between a and b, in that order, where the loop has this edge.
NewCell with_vertex(const Pattern& pattern, std::uint32_t c, std::uint32_t a, std::uint32_t b,
                    std::uint32_t v) {
  NewCell cell;
  for (const LoopRange loop : loops_of(pattern, c)) {
    std::vector<std::uint32_t>& corners = cell.loops.emplace_back();
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      corners.push_back(pattern.corners[k]);
      if (pattern.corners[k] == a && pattern.corners[loop.next(k)] == b) corners.push_back(v);
    }
  }
  return cell;
}

TEST(ReplaceCells, ANewVertexMayStandOnAnEdgeThatTwoNewCellsShare) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const WallAsset asset = wall_to_split(seed);
    const Pattern& pattern = asset.pattern;
    const Bond& bond = asset.bonds[random_bits(seed, 1) % (asset.bonds.size() / 2)];
    for (const LoopRange loop : loops_of(pattern, bond.a))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        if (pattern.across[k] != Across::cell(bond.b)) continue;
        const std::uint32_t a = pattern.corners[k], b = pattern.corners[loop.next(k)];
        const Vec2 middle = 0.5 * (pattern.vertices[a] + pattern.vertices[b]);
        const std::vector<Vec2> point{{static_cast<float>(middle.x), static_cast<float>(middle.y)}};
        const auto v = static_cast<std::uint32_t>(pattern.vertices.size());
        const std::vector<NewCell> added{with_vertex(pattern, bond.a, a, b, v),
                                         with_vertex(pattern, bond.b, b, a, v)};
        const Ids removed{bond.a, bond.b};
        expect_replaced(asset, removed, replace_cells(asset, removed, point, added), added,
                        "seed " + std::to_string(seed));
        // On an edge shared with a cell that stays the neighbour would have to change.
        EXPECT_THROW(replace_cells(asset, Ids{bond.a}, point, std::span(added).first(1)), Error);
        EXPECT_THROW(replace_cells(asset, removed, point, std::span(added).first(1)), Error);
      }
  }
}

TEST(ReplaceCells, ACellReplacedByItselfChangesNumbersOnly) {
  const WallAsset asset = wall_to_split(2);
  std::vector<NewCell> added(1);
  const Ids text = loops_text(asset.pattern, 7);
  added[0].loops = {Ids(text.begin() + 1, text.end())};
  const ReplacedCells after = replace_cells(asset, Ids{7}, {}, added);
  expect_replaced(asset, {7}, after, added, "itself");
  EXPECT_TRUE(same(after.asset.chunks.back(), asset.chunks[7]));
  EXPECT_EQ(after.asset.bonds.size(), asset.bonds.size());
}

TEST(ReplaceCells, ANewCellThatMeetsItselfAlongAnEdgeIsAnError) {
  const WallAsset asset = wall_to_split(2);
  std::vector<NewCell> added(1);
  const Ids text = loops_text(asset.pattern, 7);
  added[0].loops = {Ids(text.begin() + 1, text.end())};
  added[0].loops[0].push_back(static_cast<std::uint32_t>(asset.pattern.vertices.size()));
  added[0].loops[0].push_back(text.back());  // to the new vertex and back
  const Vec3 centre = asset.chunks[7].centroid;
  EXPECT_THROW(replace_cells(asset, Ids{7}, std::vector<Vec2>{{centre.x, centre.y}}, added), Error);
  added[0].loops[0].back() = 1 << 30;
  EXPECT_THROW(replace_cells(asset, Ids{7}, {}, added), Error);
}

// --- sectors

Pattern one_cell(const Loop& loop) {
  Pattern pattern;
  for (const Vec2& p : loop) {
    pattern.corners.push_back(static_cast<std::uint32_t>(pattern.vertices.size()));
    pattern.vertices.push_back(p);
    pattern.across.push_back(Across::border(0));
  }
  pattern.cell_begin.push_back(static_cast<std::uint32_t>(loop.size()));
  return pattern;
}

const Loop kOctagon{{2, -1}, {2, 1}, {1, 2}, {-1, 2}, {-2, 1}, {-2, -1}, {-1, -2}, {1, -2}};

TEST(Sectors, SpokesOfAnOctagonAreSpreadEvenly) {
  const Pattern pattern = one_cell(kOctagon);
  const std::vector<NewCell> four = sectors(pattern, 0, {0, 0}, 8, 4);
  ASSERT_EQ(four.size(), 4u);
  for (const NewCell& cell : four) {
    ASSERT_EQ(cell.loops.size(), 1u);
    EXPECT_EQ(cell.loops[0].size(), 4u);
    EXPECT_EQ(cell.loops[0][0], 8u);
  }
  EXPECT_EQ(sectors(pattern, 0, {0, 0}, 8, 100).size(), 8u);
  EXPECT_EQ(sectors(pattern, 0, {0.25, 0.5}, 8, 0).size(), 3u);
}

TEST(Sectors, WhereDiagonalsCrossThreeSpokesAreTooFew) {
  const Pattern square = one_cell(rectangle({2, 2}));
  EXPECT_EQ(sectors(square, 0, {1, 1}, 4, 3).size(), 4u);
  EXPECT_EQ(sectors(square, 0, {1, 0.5}, 4, 3).size(), 3u);
}

TEST(Sectors, ThereAreNoneAroundAPointThatIsNotInside) {
  const Pattern square = one_cell(rectangle({2, 2}));
  EXPECT_TRUE(sectors(square, 0, {3, 1}, 4, 3).empty());
  EXPECT_TRUE(sectors(square, 0, {2, 1}, 4, 3).empty());
  EXPECT_TRUE(sectors(one_cell({{0, 0}, {2, 0}, {1, 0.5}, {0, 2}}), 0, {0.5, 0.5}, 4, 3).empty());
}

TEST(Sectors, AreConvexAndFillTheCellWhereverThePointIs) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const WallAsset asset = wall_to_split(seed);
    const Pattern& pattern = asset.pattern;
    for (std::uint32_t c = 0; c < pattern.cell_count(); c += 3) {
      if (!is_strictly_convex(pattern, c)) continue;
      const Vec2 point = point_in(pattern, c, seed);
      const auto count = static_cast<std::uint32_t>(3 + (seed + c) % 5);
      const std::vector<NewCell> parts = sectors(pattern, c, point, 0, count);
      const std::uint32_t size = pattern.cell_begin[c + 1] - pattern.cell_begin[c];
      const std::uint32_t expected = std::min(count, size);
      ASSERT_TRUE(parts.size() == expected || parts.size() == expected + 1) << parts.size();
      double sum = 0;
      for (const NewCell& part : parts) {
        Loop loop{point};
        for (std::size_t i = 1; i < part.loops[0].size(); ++i)
          loop.push_back(pattern.vertices[part.loops[0][i]]);
        EXPECT_TRUE(is_strictly_convex(one_cell(loop), 0)) << "seed " << seed << " cell " << c;
        sum += area(std::span<const Vec2>(loop));
      }
      EXPECT_NEAR(sum, cell_area(pattern, c), 1e-12 * sum);
    }
  }
}

}  // namespace
}  // namespace sunder
