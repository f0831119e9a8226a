// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <voro++/voro++.hh>

#include "bench/peers.hpp"

namespace sunder {

Polygons voropp_cells(const Sites& sites) {
  const double width = static_cast<double>(sites.lattice.width);
  const double height = static_cast<double>(sites.lattice.height);
  const double unit = std::sqrt(width * height / static_cast<double>(sites.points.size()));
  const auto blocks = [&](double length) {
    return std::max(1, static_cast<int>(std::lround(length / unit / 2)));
  };
  // Half a cell thick: the third dimension costs voro++ as little as it can.
  voro::container container(0, width / unit, 0, height / unit, -0.5, 0.5, blocks(width),
                            blocks(height), 1, false, false, false, 8);
  for (std::size_t k = 0; k < sites.points.size(); ++k)
    container.put(static_cast<int>(k), sites.points[k].x / unit, sites.points[k].y / unit, 0);
  Polygons result;
  voro::c_loop_all loop(container);
  voro::voronoicell cell;
  std::vector<int> faces;
  std::vector<double> places, normals;
  if (loop.start()) do {
      if (!container.compute_cell(cell, loop)) continue;
      double x, y, z;
      loop.pos(x, y, z);
      cell.vertices(x, y, z, places);
      cell.face_vertices(faces);
      cell.normals(normals);
      // The face that looks along +z is the cell.
      for (std::size_t at = 0, face = 0; at < faces.size();
           at += static_cast<std::size_t>(faces[at]) + 1, ++face) {
        if (normals[3 * face + 2] < 0.5) continue;
        for (int k = 1; k <= faces[at]; ++k) {
          const auto corner = 3 * static_cast<std::size_t>(faces[at + static_cast<std::size_t>(k)]);
          result.corners.push_back({places[corner] * unit, places[corner + 1] * unit});
        }
      }
      result.site.push_back(static_cast<std::uint32_t>(loop.pid()));
      result.begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
    } while (loop.inc());
  return result;
}

}  // namespace sunder
