// SPDX-License-Identifier: GPL-3.0-or-later
#include "models/sample_models.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>

#include "meshing/random.hpp"
#include "meshing/sample_solids.hpp"
#include "meshing/triangulate.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

template <class Value>
void put(std::string& bytes, Value value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void put(std::string& bytes, Vec3 p) {
  for (const double x : {p.x, p.y, p.z}) put(bytes, static_cast<float>(x));
}

Vec3 in_floats(Vec3 p) {
  return {double(float(p.x)), double(float(p.y)), double(float(p.z))};
}

// Half of the vase's section: out along its foot, up its outside, over the lip, down to its floor.
std::vector<Vec2> vase_profile() {
  constexpr int kRows = 22;
  constexpr double kHeight = 0.3, kWall = 0.004, kFloor = 0.008;
  const auto outside = [](double s) {
    return Vec2{0.06 + 0.03 * unit_at_turns(0.95 * s + 0.02).y, kHeight * s};
  };
  std::vector<Vec2> profile{{0, 0}, {0.04, 0}};
  for (int i = 0; i <= kRows; ++i) profile.push_back(outside(double(i) / kRows));
  for (int i = kRows; i >= 0; --i) {
    const double s = kFloor / kHeight + (1 - kFloor / kHeight) * i / kRows;
    const Vec2 along = outside(s + 1e-4) - outside(s - 1e-4);
    profile.push_back(outside(s) + (kWall / length(along)) * Vec2{-along.y, along.x});
  }
  profile.back().y = kFloor;
  profile.push_back({0, kFloor});
  return profile;
}

Vec2 profile_normal(const std::vector<Vec2>& profile, std::size_t row) {
  const Vec2 before = profile[row > 0 ? row - 1 : row];
  const Vec2 along = profile[row + 1 < profile.size() ? row + 1 : row] - before;
  return (1 / length(along)) * Vec2{along.y, -along.x};
}

}  // namespace

SampleModel vase_model() {
  constexpr std::uint32_t kSides = 36;
  const std::vector<Vec2> profile = vase_profile();
  const auto rows = static_cast<std::uint32_t>(profile.size());
  SampleModel model;
  std::string places = "# A vase of revolution, walls 4 mm thick. Metres.\no vase\n", uvs, normals;
  double total = 0, run = 0;
  for (std::uint32_t row = 1; row < rows; ++row) total += length(profile[row] - profile[row - 1]);
  for (std::uint32_t row = 0; row < rows; ++row) {
    if (row > 0) run += length(profile[row] - profile[row - 1]);
    const bool is_pole = row == 0 || row + 1 == rows;
    const Vec2 n = profile_normal(profile, row);
    for (std::uint32_t side = 0; side <= kSides; ++side) {
      const Vec2 at = unit_at_turns(double(side) / kSides);
      uvs += "vt " + number(double(side) / kSides) + " " + number(run / total) + "\n";
      if (side == kSides || (is_pole && side > 0)) continue;
      const std::string x = number(profile[row].x * at.x), y = number(profile[row].y);
      const std::string z = number(-profile[row].x * at.y);
      places += "v " + x + " " + y + " " + z + "\n";
      model.mesh.vertices.push_back({std::strtod(x.c_str(), nullptr),
                                     std::strtod(y.c_str(), nullptr),
                                     std::strtod(z.c_str(), nullptr)});
      normals += "vn " + number(n.x * at.x) + " " + number(n.y) + " " + number(-n.x * at.y) + "\n";
    }
  }
  std::string faces;
  const auto add = [&](std::array<std::array<std::uint32_t, 2>, 3> corners) {  // row, side
    auto& t = model.mesh.triangles.emplace_back();
    faces += "f";
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [row, side] = corners[k];
      t[k] = row == 0          ? 0
             : row + 1 == rows ? 1 + (rows - 2) * kSides
                               : 1 + (row - 1) * kSides + side % kSides;
      const std::string v = std::to_string(t[k] + 1);
      faces += " " + v + "/" + std::to_string(row * (kSides + 1) + side + 1) + "/" + v;
    }
    faces += "\n";
  };
  for (std::uint32_t row = 0; row + 1 < rows; ++row)
    for (std::uint32_t side = 0; side < kSides; ++side) {
      if (row + 2 < rows) add({{{row, side}, {row + 1, side + 1}, {row + 1, side}}});
      if (row > 0 && row + 2 < rows) add({{{row, side}, {row, side + 1}, {row + 1, side + 1}}});
      if (row + 2 == rows) add({{{row, side}, {row, side + 1}, {row + 1, side}}});
    }
  model.bytes = places + uvs + normals + faces;
  return model;
}

SampleModel gear_model() {
  constexpr int kTeeth = 12;
  std::vector<Vec2> points;
  IndexLoops loops(1);
  const auto add = [&](std::vector<std::uint32_t>& loop, Vec2 p) {
    loop.push_back(static_cast<std::uint32_t>(points.size()));
    points.push_back({double(float(p.x)), double(float(p.y))});
  };
  for (int tooth = 0; tooth < kTeeth; ++tooth)
    for (const auto& [turn, radius] :
         {std::pair{0.0, 0.1}, {0.3, 0.1}, {0.4, 0.125}, {0.6, 0.125}, {0.7, 0.1}})
      add(loops[0], radius * unit_at_turns((tooth + turn) / kTeeth));
  const auto hole = [&](Vec2 centre, double radius, int sides) {
    auto& loop = loops.emplace_back();
    for (int i = 0; i < sides; ++i) add(loop, centre + radius * unit_at_turns(-double(i) / sides));
  };
  hole({}, 0.02, 24);
  for (int i = 0; i < 6; ++i) hole(0.06 * unit_at_turns((i + 0.5) / 6), 0.018, 16);

  SampleModel model;
  const auto count = static_cast<std::uint32_t>(points.size());
  for (const double z : {0.0, double(0.03f)})
    for (const Vec2 p : points) model.mesh.vertices.push_back({p.x, p.y, z});
  for (const auto& t : triangulate(points, loops)) {
    model.mesh.triangles.push_back({t[0], t[2], t[1]});
    model.mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  for (const auto& loop : loops)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const std::uint32_t a = loop[k], b = loop[(k + 1) % loop.size()];
      model.mesh.triangles.push_back({a, b, b + count});
      model.mesh.triangles.push_back({a, b + count, a + count});
    }
  model.bytes = "sunder: a spur gear with holes, metres";
  model.bytes.resize(80, ' ');
  put(model.bytes, static_cast<std::uint32_t>(model.mesh.triangles.size()));
  for (const auto& t : model.mesh.triangles) {
    const Vec3 a = model.mesh.vertices[t[0]], b = model.mesh.vertices[t[1]];
    const Vec3 c = model.mesh.vertices[t[2]], n = cross(b - a, c - a);
    put(model.bytes, (1 / length(n)) * n);
    for (const Vec3 p : {a, b, c}) put(model.bytes, p);
    put(model.bytes, std::uint16_t{0});
  }
  return model;
}

namespace {

// A sphere with bumps: a stone.
TriMesh stone() {
  TriMesh mesh = sphere_mesh(1, 28);
  for (Vec3& p : mesh.vertices) {
    double swell = 1;
    for (std::uint64_t bump = 0; bump < 12; ++bump) {
      const Vec3 at{2 * random_unit(3, bump, 0) - 1, 2 * random_unit(3, bump, 1) - 1,
                    2 * random_unit(3, bump, 2) - 1};
      const double near = std::max(0.0, 1 - dot(p - at, p - at));
      swell += (bump % 2 == 0 ? 0.18 : -0.1) * near * near;
    }
    p = in_floats(0.5 * swell * Vec3{1.2 * p.x, 0.8 * p.y, p.z});
  }
  return mesh;
}

// Breaks it as a scanner and careless tools do.
void damage(TriMesh& mesh) {
  const auto middle = [&](const std::array<std::uint32_t, 3>& t) {
    return (1.0 / 3) * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
  };
  const auto nearest_vertex = [&](Vec3 p) {
    return *std::ranges::min_element(mesh.vertices, {}, [&](Vec3 v) { return length(v - p); });
  };
  const Vec3 hole = nearest_vertex({0.6, 0.2, 0.3}), patch = nearest_vertex({-0.3, 0.3, 0.35});
  const auto is_near = [](Vec3 a, Vec3 b, double distance) { return length(a - b) < distance; };
  std::vector<std::array<std::uint32_t, 3>> kept, twice;
  for (auto t : mesh.triangles) {
    const Vec3 m = middle(t);
    if (m.y < -0.36 || is_near(m, hole, 0.1)) continue;
    if (is_near(m, patch, 0.12)) std::swap(t[0], t[1]);
    kept.push_back(t);
    if (kept.size() % 211 == 7) twice.push_back(t);
  }
  mesh.triangles = kept;
  mesh.triangles.insert(mesh.triangles.end(), twice.begin(), twice.end());
  // The two sides of x = 0 have corners of their own, one step of rounding apart.
  std::map<std::uint32_t, std::uint32_t> copies;
  for (auto& t : mesh.triangles) {
    if (middle(t).x < 0) continue;
    for (auto& v : t) {
      if (mesh.vertices[v].x != 0) continue;
      const auto [it, is_new] = copies.emplace(v, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) {
        Vec3 p = mesh.vertices[v];
        p.y = double(std::nextafter(float(p.y), 2.0f));
        mesh.vertices.push_back(p);
      }
      v = it->second;
    }
  }
  // Folds: corners that slid over their neighbours.
  for (const std::uint32_t t : {800u, 1700u}) {
    const Vec3 far = mesh.vertices[mesh.triangles[t + 2][1]];
    Vec3& p = mesh.vertices[mesh.triangles[t][0]];
    p = in_floats(p + 2.5 * (far - p));
  }
}

}  // namespace

SampleModel scan_model() {
  SampleModel model{stone(), {}};
  TriMesh& mesh = model.mesh;
  damage(mesh);
  model.bytes =
      "ply\nformat binary_little_endian 1.0\ncomment sunder: a broken scan, metres\n"
      "element vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nelement face " +
      std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3 p : mesh.vertices) {
    put(model.bytes, p);
    const auto shade = [&](double from, double by) {
      return static_cast<std::uint8_t>(std::clamp(from + by * p.y, 0.0, 255.0));
    };
    for (const std::uint8_t c : {shade(150, 100), shade(120, 160), shade(100, -60)})
      put(model.bytes, c);
  }
  for (const auto& t : mesh.triangles) {
    put(model.bytes, std::uint8_t{3});
    for (const std::uint32_t v : t) put(model.bytes, static_cast<std::int32_t>(v));
  }
  return model;
}

}  // namespace sunder
