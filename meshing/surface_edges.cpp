// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/surface_edges.hpp"

#include <algorithm>
#include <numeric>

namespace sunder {

std::vector<EdgeUse> edge_uses(std::span<const Corners> triangles, const std::vector<bool>& keep) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (!keep[t]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::sort(uses.begin(), uses.end());
  return uses;
}

ParitySets::ParitySets(std::size_t count) : parent_(count), odd_(count) {
  std::iota(parent_.begin(), parent_.end(), 0u);
}

ParitySets::Place ParitySets::find(std::uint32_t element) {
  std::uint32_t root = element;
  bool odd = false;
  while (parent_[root] != root) {
    odd = odd != odd_[root];
    root = parent_[root];
  }
  const Place place{root, odd};
  while (parent_[element] != root) {  // the path becomes direct
    const std::uint32_t next = parent_[element];
    const bool next_odd = odd != odd_[element];
    parent_[element] = root;
    odd_[element] = odd;
    odd = next_odd;
    element = next;
  }
  return place;
}

bool ParitySets::join(std::uint32_t a, std::uint32_t b, bool odd) {
  const Place at_a = find(a), at_b = find(b);
  const bool between = (at_a.odd != at_b.odd) != odd;
  if (at_a.root == at_b.root) return !between;
  const auto [low, high] = std::minmax(at_a.root, at_b.root);
  parent_[high] = low;
  odd_[high] = between;
  return true;
}

Orientation orient(std::span<const Corners> triangles, std::span<const EdgeUse> uses) {
  ParitySets sets(triangles.size());
  Orientation result;
  std::vector<std::uint32_t> contradicting;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2 || edge[0].triangle == edge[1].triangle) return;
    if (!sets.join(edge[0].triangle, edge[1].triangle, edge[0].forward == edge[1].forward))
      contradicting.push_back(edge[0].triangle);
  });
  std::vector<std::uint32_t> odd_count(triangles.size()), count(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto place = sets.find(t);
    result.shell.push_back(place.root);
    result.flipped.push_back(place.odd);
    ++count[place.root];
    odd_count[place.root] += place.odd;
  }
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t root = result.shell[t];
    if (2 * odd_count[root] > count[root]) result.flipped[t] = !result.flipped[t];
  }
  result.one_sided.assign(triangles.size(), false);
  for (const std::uint32_t t : contradicting) result.one_sided[result.shell[t]] = true;
  return result;
}

std::vector<std::uint32_t> find_fans(std::span<const Corners> triangles,
                                     std::span<const EdgeUse> uses) {
  ParitySets sets(3 * triangles.size());
  const auto corner_at = [&](std::uint32_t t, std::uint32_t vertex) {
    std::uint32_t k = 0;
    while (triangles[t][k] != vertex) ++k;
    return 3 * t + k;
  };
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    for (std::size_t i = 1; i < edge.size(); ++i)
      for (const std::uint32_t vertex : {edge[0].low, edge[0].high})
        sets.join(corner_at(edge[0].triangle, vertex), corner_at(edge[i].triangle, vertex));
  });
  std::vector<std::uint32_t> fans(3 * triangles.size());
  for (std::uint32_t corner = 0; corner < fans.size(); ++corner)
    fans[corner] = sets.find(corner).root;
  return fans;
}

}  // namespace sunder
