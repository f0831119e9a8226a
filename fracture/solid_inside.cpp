// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fracture/solid_pattern.hpp"

namespace sunder {

InsideTest::InsideTest(const TriMesh& mesh) : mesh_(mesh) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  low_ = {kFar, kFar, kFar};
  high_ = {-kFar, -kFar, -kFar};
  for (const Vec3& v : mesh.vertices) {
    low_ = {std::min(low_.x, v.x), std::min(low_.y, v.y), std::min(low_.z, v.z)};
    high_ = {std::max(high_.x, v.x), std::max(high_.y, v.y), std::max(high_.z, v.z)};
  }
  columns_ = static_cast<std::uint32_t>(
      std::clamp(std::sqrt(static_cast<double>(mesh.triangles.size()) / 4), 1.0, 1024.0));
  begin_.assign(std::size_t{columns_} * columns_ + 1, 0);
  const auto visit_columns = [&](auto visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3 a = mesh.vertices[mesh.triangles[t][0]], b = mesh.vertices[mesh.triangles[t][1]],
                 c = mesh.vertices[mesh.triangles[t][2]];
      const Vec3 size = high_ - low_;
      const auto x = std::minmax({a.x, b.x, c.x}), y = std::minmax({a.y, b.y, c.y});
      const std::uint32_t right = column((x.second - low_.x) / size.x, columns_),
                          top = column((y.second - low_.y) / size.y, columns_);
      for (std::uint32_t j = column((y.first - low_.y) / size.y, columns_); j <= top; ++j)
        for (std::uint32_t i = column((x.first - low_.x) / size.x, columns_); i <= right; ++i)
          visit(std::size_t{j} * columns_ + i, t);
    }
  };
  visit_columns([&](std::size_t cell, std::uint32_t) { ++begin_[cell + 1]; });
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
  triangles_.resize(begin_.back());
  visit_columns([&](std::size_t cell, std::uint32_t t) { triangles_[at[cell]++] = t; });
}

std::uint32_t InsideTest::column(double share, std::uint32_t limit) const {
  return static_cast<std::uint32_t>(std::clamp(share * limit, 0.0, limit - 1.0));
}

bool InsideTest::contains(Vec3 p) const {
  const Vec3 size = high_ - low_;
  const std::size_t cell = std::size_t{column((p.y - low_.y) / size.y, columns_)} * columns_ +
                           column((p.x - low_.x) / size.x, columns_);
  bool inside = false;
  for (std::uint32_t k = begin_[cell]; k < begin_[cell + 1]; ++k) {
    const auto& t = mesh_.triangles[triangles_[k]];
    const Vec3 d[3] = {mesh_.vertices[t[0]] - p, mesh_.vertices[t[1]] - p,
                       mesh_.vertices[t[2]] - p};
    double weight[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 u = d[(i + 1) % 3], v = d[(i + 2) % 3];
      weight[i] = u.x * v.y - u.y * v.x;
    }
    const bool above = weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0;
    const bool below = weight[0] <= 0 && weight[1] <= 0 && weight[2] <= 0;
    const double sum = weight[0] + weight[1] + weight[2];
    if ((above || below) && sum != 0)
      inside ^= (weight[0] * d[0].z + weight[1] * d[1].z + weight[2] * d[2].z) / sum > 0;
  }
  return inside;
}

}  // namespace sunder
