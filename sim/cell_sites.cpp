// SPDX-License-Identifier: GPL-3.0-or-later
// Of a Voronoi edge with direction t, normal n and midpoint m between the sites p and q it is known
// that (q - p) . t = 0 and (p + q) . n = 2 m . n: linear equations, two per edge for two unknowns
// per cell.
#include "sim/cell_sites.hpp"

#include <cmath>

namespace sunder {
namespace {

constexpr double kTolerance = 1e-14;  // of the residual at the start
constexpr int kMostSteps = 2000;
constexpr double kFurthest = 3;  // of a site from its cell's centroid, in sizes of the cell

struct SharedEdge {
  std::uint32_t a = 0, b = 0;
  double weight = 0;
  Vec2 along, across, middle;
};

std::vector<SharedEdge> shared_edges(const Pattern& pattern) {
  std::vector<SharedEdge> edges;
  edges.reserve(pattern.corners.size() / 2);
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    for (const LoopRange loop : loops_of(pattern, cell))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        const Across other = pattern.across[k];
        if (other.is_border() || other.cell() <= cell) continue;
        const Vec2 from = pattern.vertices[pattern.corners[k]];
        const Vec2 to = pattern.vertices[pattern.corners[loop.next(k)]];
        const double size = length(to - from);
        if (size == 0) continue;
        const Vec2 along = (1 / size) * (to - from);
        edges.push_back({cell, other.cell(), size, along, {along.y, -along.x}, 0.5 * (from + to)});
      }
  return edges;
}

/// Normal equations of the edges: result = A x, A symmetric positive semidefinite.
std::vector<Vec2> product(const std::vector<SharedEdge>& edges, const std::vector<Vec2>& x) {
  std::vector<Vec2> result(x.size());
  for (const SharedEdge& e : edges) {
    const double slide = e.weight * dot(x[e.b] - x[e.a], e.along);
    const double middle = e.weight * dot(x[e.a] + x[e.b], e.across);
    result[e.a] = result[e.a] + middle * e.across - slide * e.along;
    result[e.b] = result[e.b] + middle * e.across + slide * e.along;
  }
  return result;
}

/// Inverse of the diagonal: along and across together are the identity, so every 2 x 2 block is a
/// multiple of it.
std::vector<double> inverse_diagonal(const std::vector<SharedEdge>& edges, std::size_t cells) {
  std::vector<double> diagonal(cells);
  for (const SharedEdge& e : edges) {
    diagonal[e.a] += e.weight;
    diagonal[e.b] += e.weight;
  }
  for (double& d : diagonal) d = d > 0 ? 1 / d : 0;
  return diagonal;
}

double dot_all(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

std::vector<Vec2> fitted(const std::vector<SharedEdge>& edges, std::vector<Vec2> x) {
  const std::vector<double> inverse = inverse_diagonal(edges, x.size());
  std::vector<Vec2> residual(x.size());
  for (const SharedEdge& e : edges) {
    const Vec2 pull = (2 * e.weight * dot(e.middle, e.across)) * e.across;
    residual[e.a] = residual[e.a] + pull;
    residual[e.b] = residual[e.b] + pull;
  }
  const std::vector<Vec2> at_start = product(edges, x);
  std::vector<Vec2> z(x.size()), direction(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    residual[i] = residual[i] - at_start[i];
    direction[i] = inverse[i] * residual[i];
  }
  double size = dot_all(residual, direction);
  const double enough = kTolerance * kTolerance * size;
  for (int step = 0; step < kMostSteps && size > enough; ++step) {
    const std::vector<Vec2> image = product(edges, direction);
    const double share = size / dot_all(direction, image);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = x[i] + share * direction[i];
      residual[i] = residual[i] - share * image[i];
      z[i] = inverse[i] * residual[i];
    }
    const double next = dot_all(residual, z);
    for (std::size_t i = 0; i < x.size(); ++i) direction[i] = z[i] + (next / size) * direction[i];
    size = next;
  }
  return x;
}

}  // namespace

std::vector<Vec2> cell_sites(const Pattern& pattern, const std::vector<Vec2>& centroids) {
  std::vector<Vec2> sites = fitted(shared_edges(pattern), centroids);
  for (std::uint32_t c = 0; c < sites.size(); ++c) {
    const double furthest = kFurthest * std::sqrt(cell_area(pattern, c));
    if (!(length(sites[c] - centroids[c]) <= furthest)) sites[c] = centroids[c];
  }
  return sites;
}

}  // namespace sunder
