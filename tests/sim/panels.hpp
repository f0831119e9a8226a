// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "meshing/random.hpp"
#include "sim/chunk_network.hpp"
#include "sim/dense.hpp"

namespace sunder {

inline const std::vector<std::string> kAllSides{"bottom", "right", "top", "left"};

inline Material panel_concrete() {
  Material m;
  m.name = "concrete";
  m.density = 2400;
  m.youngs_modulus = 33.6e9;
  m.tensile_strength = 2.9e6;
  m.compressive_strength = 38e6;
  return m;
}

struct PanelKind {
  Vec2 size{3, 2};
  double thickness = 0.1, cell = 0.4, jitter = 1;
  std::vector<std::string> anchors = kAllSides;
};

inline WallAsset panel_asset(const PanelKind& kind, std::uint64_t seed) {
  Wall wall;
  wall.region = {rectangle(kind.size), {}};
  wall.thickness = kind.thickness;
  wall.pattern = VoronoiGridParams{kind.cell, kind.jitter};
  wall.min_cell = 0;
  wall.anchors = kind.anchors;
  return fracture_wall(wall, 2400, {.seed = seed});
}

inline PanelHold panel_hold(Vec2 size, bool hinged = false) {
  return {{Vec3{0, 0, 0}, {size.x, 0, 0}, {size.x, size.y, 0}, {0, size.y, 0}},
          {hinged, hinged, hinged, hinged}};
}

/// As a panel of a building hangs: hinged, its edges straight.
inline PanelHold straight_hold(Vec2 size) {
  PanelHold hold = panel_hold(size, true);
  hold.is_straight = true;
  return hold;
}

/// Corners moved as a rigid body about the origin.
inline PanelFreedoms rigid_freedoms(const PanelHold& hold, Vec3 move, Vec3 turn) {
  PanelFreedoms g{};
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 u = move + cross(turn, hold.corners[c]);
    const double six[6] = {u.x, u.y, u.z, turn.x, turn.y, turn.z};
    std::copy_n(six, 6, g.begin() + static_cast<std::ptrdiff_t>(6 * c));
  }
  return g;
}

/// Up to `size` each, rotations too.
inline PanelFreedoms random_freedoms(std::uint64_t seed, double size) {
  PanelFreedoms g;
  for (std::size_t i = 0; i < 24; ++i) g[i] = size * (2 * random_unit(seed, 100 + i) - 1);
  return g;
}

/// Displacement of a chunk's material at a place.
inline Vec3 moved(const WallAsset& asset, const PanelState& state, std::uint32_t chunk, Vec3 at) {
  const Six& d = state.displacements[chunk];
  return Vec3{d[0], d[1], d[2]} + cross({d[3], d[4], d[5]}, at - asset.chunks[chunk].centroid);
}

inline double highest(const PanelState& state) {
  double most = 0;
  for (const BondStress& bond : state.bonds) most = std::max(most, bond.utilisation);
  return most;
}

/// A panel's chunks (six rows each) and corners (the last 24) in one dense matrix, put together
/// from the definition of the springs: an independent oracle in extended precision.
class DensePanel {
 public:
  DensePanel(const WallAsset& asset, const Material& material, const PanelHold& hold,
             const std::vector<Vec2>& sites)
      : k(6 * asset.chunks.size() + 24), chunks_(asset.chunks.size()) {
    for (const Bond& bond : asset.bonds) add(asset, material, hold, sites, bond);
  }
  Dense k;

 private:
  using Row = std::vector<std::pair<std::size_t, long double>>;  // column, share
  using Rows = std::vector<Row>;                                 // ux, uy, uz, θx, θy, θz

  /// The motion of a rigid body at `to` from that at `from`.
  static Rows carried(const Rows& at, Vec3 from, Vec3 to) {
    Rows result = at;
    const Vec3 r = to - from;
    const auto add = [&](std::size_t row, std::size_t turn, double by) {
      for (const auto& [column, share] : at[turn]) result[row].emplace_back(column, by * share);
    };
    add(0, 4, r.z), add(0, 5, -r.y);
    add(1, 5, r.x), add(1, 3, -r.z);
    add(2, 3, r.y), add(2, 4, -r.x);
    return result;
  }
  Rows chunk_rows(std::size_t chunk) const {
    Rows rows(6);
    for (std::size_t i = 0; i < 6; ++i) rows[i] = {{6 * chunk + i, 1}};
    return rows;
  }
  /// On an edge along x or y of a rectangle, as a beam's cubic by its end values and slopes.
  Rows edge_rows(const PanelHold& hold, std::size_t edge, Vec3 at) const {
    const Vec3 a = hold.corners[edge], b = hold.corners[(edge + 1) % 4];
    const bool is_x = std::abs(b.x - a.x) > std::abs(b.y - a.y);
    const double length = is_x ? b.x - a.x : b.y - a.y;  // with its sign
    const double x = is_x ? at.x - a.x : at.y - a.y, s = x / length;
    const double v0 = 1 - 3 * s * s + 2 * s * s * s, v1 = 1 - v0;
    const double t0 = x * (1 - 2 * s + s * s), t1 = x * (s * s - s);
    const double dv = (-6 * s + 6 * s * s) / length;
    const double dt0 = 1 - 4 * s + 3 * s * s, dt1 = 3 * s * s - 2 * s;
    const std::size_t p = 6 * chunks_ + 6 * edge, q = 6 * chunks_ + 6 * ((edge + 1) % 4);
    Rows r(6);
    const std::size_t u = is_x ? 0 : 1, v = is_x ? 1 : 0;  // along, across in the plane
    const double in = is_x ? 1 : -1, out = -in;  // dv/dx = θz, du/dy = -θz; dw/dx = -θy, dw/dy = θx
    const std::size_t bend = is_x ? 4 : 3, twist = is_x ? 3 : 4;
    r[u] = {{p + u, 1 - s}, {q + u, s}};
    r[v] = {{p + v, v0}, {q + v, v1}, {p + 5, in * t0}, {q + 5, in * t1}};
    r[2] = {{p + 2, v0}, {q + 2, v1}, {p + bend, out * t0}, {q + bend, out * t1}};
    r[twist] = {{p + twist, 1 - s}, {q + twist, s}};
    r[bend] = {{p + 2, out * dv}, {q + 2, -out * dv}, {p + bend, dt0}, {q + bend, dt1}};
    r[5] = {{p + v, in * dv}, {q + v, -in * dv}, {p + 5, dt0}, {q + 5, dt1}};
    return r;
  }
  /// Of a rectangle that follows the translations of its corners, bilinear; turned by the mean.
  Rows surface_rows(const PanelHold& hold, Vec3 at) const {
    const Vec3 low = hold.corners[0], size = hold.corners[2] - low;
    const double x = (at.x - low.x) / size.x, y = (at.y - low.y) / size.y;
    const double value[4] = {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
    const double dx[4] = {(y - 1) / size.x, (1 - y) / size.x, y / size.x, -y / size.x};
    const double dy[4] = {(x - 1) / size.y, -x / size.y, x / size.y, (1 - x) / size.y};
    Rows r(6);
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t first = 6 * chunks_ + 6 * c;
      for (std::size_t i = 0; i < 3; ++i) r[i].emplace_back(first + i, value[c]);
      r[3].emplace_back(first + 2, dy[c]);
      r[4].emplace_back(first + 2, -dx[c]);
      r[5].emplace_back(first + 1, dx[c] / 2);
      r[5].emplace_back(first, -dy[c] / 2);
    }
    return r;
  }
  void add_spring(const Rows& a, const Rows& b, bool is_turn, Vec3 direction, double stiffness) {
    Row stretch;
    const double d[3] = {direction.x, direction.y, direction.z};
    for (std::size_t i = 0; i < 3; ++i) {
      for (const auto& [column, share] : b[is_turn ? i + 3 : i])
        stretch.emplace_back(column, d[i] * share);
      for (const auto& [column, share] : a[is_turn ? i + 3 : i])
        stretch.emplace_back(column, -d[i] * share);
    }
    for (const auto& [row, x] : stretch)
      for (const auto& [column, y] : stretch) k(row, column) += stiffness * x * y;
  }
  void add(const WallAsset& asset, const Material& material, const PanelHold& hold,
           const std::vector<Vec2>& sites, const Bond& bond) {
    const Vec3 n = bond.normal, along{-n.y, n.x, 0}, c = bond.centroid, up{0, 0, 1};
    const Vec3 site_a{sites[bond.a].x, sites[bond.a].y, 0};
    const Vec3 centre_a = asset.chunks[bond.a].centroid;
    const bool is_anchor = bond.b == kWorld;
    Vec3 site_b = site_a + dot(c - site_a, n) * n, centre_b = site_b;
    std::size_t edge = n.y < -0.5 ? 0 : n.x > 0.5 ? 1 : n.y > 0.5 ? 2 : 3;
    if (!is_anchor) {
      site_b = {sites[bond.b].x, sites[bond.b].y, 0};
      centre_b = asset.chunks[bond.b].centroid;
    }
    const bool hinge = is_anchor && hold.hinged[edge];
    const double t = asset.wall.thickness, length = bond.area / t, e = material.youngs_modulus;
    const double h = dot(site_b - site_a, n);
    const double plate = e * length * t * t * t / 12;  // E I of the slice
    const double shear =
        1 / (h / (5.0 / 12 * e * bond.area) + h * h * h / ((hinge ? 3 : 12) * plate));
    const Vec3 m = hinge ? site_b : 0.5 * (site_a + site_b);
    const Rows a = chunk_rows(bond.a);
    const Rows b = !is_anchor         ? chunk_rows(bond.b)
                   : hold.is_straight ? surface_rows(hold, site_b)
                                      : edge_rows(hold, edge, site_b);
    const Rows a_c = carried(a, centre_a, c), b_c = carried(b, centre_b, c);
    add_spring(a_c, b_c, false, n, e * bond.area / h);
    add_spring(a_c, b_c, false, along, e * bond.area / h);
    add_spring(a_c, b_c, true, up, e * t * length * length * length / 12 / h);
    const Rows a_m = carried(a, centre_a, m), b_m = carried(b, centre_b, m);
    add_spring(a_m, b_m, false, up, shear);
    add_spring(a_m, b_m, true, n, plate / h);
    add_spring(a_m, b_m, true, along, (hinge ? 1e-6 : 1) * plate / h);
  }
  std::size_t chunks_;
};

}  // namespace sunder
