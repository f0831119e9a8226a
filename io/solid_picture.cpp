// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/solid_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "io/strip_paper.hpp"
#include "io/tint.hpp"
#include "io/wall_view.hpp"

namespace sunder {
namespace {

constexpr double kUnits = 10000;  // of the solid's largest extent on paper
constexpr double kSpread = 0.45;  // how far chunks move away from the middle, of their distance

Vec3 unit(Vec3 v) {
  return (1 / length(v)) * v;
}

// Axes of the paper: right, up, and to the eye.
struct View {
  Vec3 eye = unit({0.45, 0.4, 1});
  Vec3 right = unit(cross({0, 1, 0}, eye));
  Vec3 up = cross(eye, right);
  Vec3 light = unit(unit({-0.5, 0.9, 0.6}) + 0.6 * eye);
};

// A triangle on paper.
struct Drawn {
  double depth = 0;  // towards the eye
  std::uint32_t chunk = 0;
  std::array<Vec2, 3> at;
  StripColour colour{};
};

class Painter {
 public:
  explicit Painter(const SolidAsset& asset) : asset_(asset) {
    for (const Vec3 vertex : asset.partition.vertices)
      world_.push_back(rotate(asset.solid.rotation, vertex));
    for (const SurfaceMaterial& material : asset.surface.materials)
      outer_.push_back(colour_of(material));
    const MaterialLook look = look_of(asset.solid.material);
    for (std::size_t k = 0; k < 3; ++k) inner_[k] = static_cast<double>(look.inner[k]);
  }

  // The inside is only seen when chunks are apart.
  std::string draw(double spread, double unit, Vec2& size) const {
    std::vector<Drawn> triangles;
    const Vec3 middle = middle_of_all();
    for (std::uint32_t c = 0; c < asset_.partition.chunk_count(); ++c) {
      const Vec3 centroid = rotate(asset_.solid.rotation, asset_.chunks[c].centroid);
      add_chunk(c, spread * (centroid - middle), spread > 0, triangles);
    }
    const auto order = [](const Drawn& t) { return t.depth; };
    std::ranges::stable_sort(triangles, {}, order);
    return written(triangles, unit, size);
  }

  double extent() const {
    Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
    for (const Vec3 p : world_) {
      const Vec2 at{dot(p, view_.right), dot(p, view_.up)};
      low = {std::min(low.x, at.x), std::min(low.y, at.y)};
      high = {std::max(high.x, at.x), std::max(high.y, at.y)};
    }
    return std::max({high.x - low.x, high.y - low.y, 1e-12});
  }

 private:
  StripColour colour_of(const SurfaceMaterial& material) const {
    StripColour colour{};
    const MaterialLook look = look_of(asset_.solid.material);
    for (std::size_t k = 0; k < 3; ++k)
      colour[k] = material.name.empty()
                      ? static_cast<double>(look.outer[k])
                      : 255 * srgb_channel(static_cast<double>(material.base_colour[k]));
    return colour;
  }

  Vec3 middle_of_all() const {
    Vec3 sum;
    double volume = 0;
    for (const MassProperties& chunk : asset_.chunks) {
      sum = sum + chunk.volume * rotate(asset_.solid.rotation, chunk.centroid);
      volume += chunk.volume;
    }
    return volume > 0 ? (1 / volume) * sum : sum;
  }

  void add_chunk(std::uint32_t c, Vec3 shift, bool with_inner, std::vector<Drawn>& out) const {
    const SolidPartition& partition = asset_.partition;
    for (std::uint32_t t = partition.chunk_begin[c]; t < partition.chunk_begin[c + 1]; ++t) {
      const SolidPartition::Triangle& triangle = partition.triangles[t];
      if (triangle.is_inner() && !with_inner) continue;
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = world_[triangle.corners[k]] + shift;
      const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
      if (!(dot(n, view_.eye) > 0)) continue;
      Drawn drawn{dot(p[0] + p[1] + p[2], view_.eye) / 3, c, {}, {}};
      for (std::size_t k = 0; k < 3; ++k)
        drawn.at[k] = {dot(p[k], view_.right), dot(p[k], view_.up)};
      const StripColour base = triangle.is_inner()
                                   ? inner_
                                   : tinted(outer_[asset_.surface.material[triangle.source]], c);
      const double light = 0.45 + 0.55 * std::max(0.0, dot(n, view_.light) / length(n));
      drawn.colour = mix_colours({34, 31, 34}, base, light);
      out.push_back(drawn);
    }
  }

  static std::string written(const std::vector<Drawn>& triangles, double unit, Vec2& size) {
    Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
    for (const Drawn& t : triangles)
      for (const Vec2 p : t.at) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    if (triangles.empty()) return "";
    size = (1 / unit) * (high - low);
    StripPaper paper;
    paper.text("<g stroke-linejoin=\"round\" stroke-width=\"9\">\n");
    for (const Drawn& t : triangles) {
      std::array<Vec2, 3> at;
      for (std::size_t k = 0; k < 3; ++k)
        at[k] = {(t.at[k].x - low.x) / unit, -(t.at[k].y - low.y) / unit};
      // The stroke hides the seams between neighbours.
      paper.text("<path fill=\"").colour(t.colour).text("\" stroke=\"").colour(t.colour);
      paper.text("\" d=\"");
      paper.line(at, true);
      paper.text("\"/>\n");
    }
    paper.text("</g>\n");
    return paper.take();
  }

  const SolidAsset& asset_;
  View view_;
  std::vector<Vec3> world_;
  std::vector<StripColour> outer_;
  StripColour inner_{};
};

}  // namespace

SolidPicture draw_solid(const SolidAsset& asset) {
  const Painter painter(asset);
  SolidPicture picture;
  picture.unit = painter.extent() / kUnits;
  picture.whole = painter.draw(0, picture.unit, picture.whole_size);
  if (asset.partition.triangles.size() <= kMostDrawnTriangles)
    picture.exploded = painter.draw(kSpread, picture.unit, picture.exploded_size);
  return picture;
}

}  // namespace sunder
