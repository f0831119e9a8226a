// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "bench/peers.hpp"

namespace sunder {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Base = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Triangulation =
    CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Base>>;

// What is left of a polygon where normal · x <= offset.
void clip(std::vector<Vec2>& polygon, Vec2 normal, double offset) {
  std::vector<Vec2> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 p = polygon[k], q = polygon[(k + 1) % polygon.size()];
    const double a = dot(normal, p) - offset, b = dot(normal, q) - offset;
    if (a <= 0) kept.push_back(p);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) kept.push_back(p + (a / (a - b)) * (q - p));
  }
  polygon.swap(kept);
}

// A cell at the border: the box cut by the bisectors with the neighbours.
void border_cell(const Triangulation& triangulation, Triangulation::Vertex_handle vertex, Vec2 size,
                 std::vector<Vec2>& polygon) {
  polygon = {{0, 0}, {size.x, 0}, size, {0, size.y}};
  const Vec2 p{vertex->point().x(), vertex->point().y()};
  auto neighbour = triangulation.incident_vertices(vertex);
  const auto start = neighbour;
  do {
    if (triangulation.is_infinite(neighbour)) continue;
    const Vec2 q{neighbour->point().x(), neighbour->point().y()};
    clip(polygon, q - p, (dot(q, q) - dot(p, p)) / 2);
  } while (++neighbour != start);
}

// False when the cell reaches out of the box.
bool inner_cell(const Triangulation& triangulation, Triangulation::Vertex_handle vertex, Vec2 size,
                std::vector<Vec2>& polygon) {
  polygon.clear();
  auto face = triangulation.incident_faces(vertex);
  const auto start = face;
  do {
    if (triangulation.is_infinite(face)) return false;
    const auto centre = triangulation.dual(face);
    if (centre.x() < 0 || centre.y() < 0 || centre.x() > size.x || centre.y() > size.y)
      return false;
    polygon.push_back({centre.x(), centre.y()});
  } while (++face != start);
  return true;
}

}  // namespace

Polygons cgal_cells(const Sites& sites) {
  std::vector<std::pair<Kernel::Point_2, std::uint32_t>> points;
  for (std::uint32_t k = 0; k < sites.points.size(); ++k)
    points.push_back({Kernel::Point_2(sites.points[k].x, sites.points[k].y), k});
  const Triangulation triangulation(points.begin(), points.end());
  const Vec2 size{static_cast<double>(sites.lattice.width),
                  static_cast<double>(sites.lattice.height)};
  Polygons result;
  std::vector<Vec2> polygon;
  for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end();
       ++v) {
    if (!inner_cell(triangulation, v, size, polygon)) border_cell(triangulation, v, size, polygon);
    result.corners.insert(result.corners.end(), polygon.begin(), polygon.end());
    result.site.push_back(v->info());
    result.begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
  }
  return result;
}

}  // namespace sunder
