// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshing/vec.hpp"
#include "sim/spin.hpp"

namespace sunder {

/// A convex prism made ready for contact. Coordinates relative to the body's centre of mass, axes
/// of its design frame; the outline is strictly convex and counter-clockwise.
struct Hull {
  struct Side {
    Vec2 corner;        ///< where the side starts
    Vec2 along;         ///< unit, counter-clockwise
    Vec2 normal;        ///< unit, outwards
    double offset = 0;  ///< normal · x on the side
    double length = 0;
  };
  std::vector<Side> sides;
  double middle = 0, half = 0;  ///< z is within middle ± half
  Vec3 centre;                  ///< of the bounding sphere
  double reach = 0;             ///< its radius
};
/// Throws Error{geometry} unless the outline has three corners and positive area and thickness.
Hull hull_of(std::span<const Vec2> outline, double half_thickness, Vec3 centroid);

/// Where a body's frame is: centre of mass relative to a common origin near by, and axes.
struct Place {
  Axes axes;
  Vec3 centre;
};

/// A pair of nearest points. `normal` points from b to a, |normal| = 1; `point` lies between the
/// surfaces, relative to the common origin; gap < 0: they overlap.
struct Touch {
  Vec3 point;
  Vec3 normal;
  double gap = 0;
  /// Whose corner it is, so with whom it moves; both: neither's, or of two edges.
  enum class Owner : std::uint8_t { both, a, b } owner = Owner::both;
};

/// Buffers of the functions below; reuse one.
struct TouchScratch {
  std::vector<Vec3> corners_a, corners_b, polygon, clipped;
  std::vector<Touch> touches;
};

/// Appends the contacts of two solids that are nearer than `margin`, at most five of a pair.
/// Prisms: separating axes (faces, then pairs of edges), the incident face clipped against the
/// reference face (Gottschalk 1996; Gregorius, "Robust Contact Creation", GDC 2015).
void touch_hulls(const Hull& a, const Place& at_a, const Hull& b, const Place& at_b, double margin,
                 TouchScratch& scratch, std::vector<Touch>& found);
/// a: hull, b: sphere.
void touch_sphere(const Hull& a, const Place& at_a, Vec3 centre, double radius, double margin,
                  std::vector<Touch>& found);
void touch_spheres(Vec3 centre_a, double radius_a, Vec3 centre_b, double radius_b, double margin,
                   std::vector<Touch>& found);
/// a: the half-space y <= height, b: hull.
void touch_ground(double height, const Hull& b, const Place& at_b, double margin,
                  TouchScratch& scratch, std::vector<Touch>& found);

}  // namespace sunder
