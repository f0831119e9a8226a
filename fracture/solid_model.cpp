// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_model.hpp"

#include "fracture/sites.hpp"

namespace sunder {
namespace {

constexpr Range kCells{1, kMaxCells};
constexpr Range kPlace{-1e6, 1e6};  // m
constexpr Range kSize{1e-6, 1e6};   // m
constexpr Range kLength{0, 1e6};    // m
constexpr Range kShare{0, 1};
constexpr Range kCuts{0, 1000};
constexpr Range kTilt{0, 45};  // degrees

constexpr Range kScale{1e-9, 1e9};

}  // namespace

template <>
std::span<const Field<SolidVoronoiParams>> fields() {
  using P = SolidVoronoiParams;
  static const Field<P> table[] = {
      {"chunks", &P::count, "", "Sites, one cell each; cells outside the solid become no chunk.",
       kCells},
      {"near", &P::points, "m", "Points around which sites lie denser; none: uniform.", kPlace},
      {"radius", &P::radius, "m", "How far around such a point its sites reach.", kSize},
      {"share", &P::share, "", "Part of the sites drawn around such points; the rest is uniform.",
       kShare},
      {"sites", &P::sites, "m", "The sites themselves; then no others are drawn.", kPlace},
  };
  return table;
}

template <>
std::span<const Field<SolidSlicesParams>> fields() {
  using P = SolidSlicesParams;
  static const Field<P> table[] = {
      {"slices", &P::slices, "", "Cuts across x, y and z; whole numbers.", kCuts},
      {"offset_variation", &P::offset_variation, "",
       "How far a cut may move, of the distance between cuts.", kShare},
      {"angle_variation_deg", &P::angle_variation, "degrees", "Most that a cut is tilted.", kTilt},
      {"amplitude", &P::amplitude, "m", "Height of the waves on a cut; 0: plane.", kLength},
      {"wavelength", &P::wavelength, "m", "Length of these waves.", kSize},
  };
  return table;
}

template <>
std::span<const Field<SolidRadialParams>> fields() {
  using P = SolidRadialParams;
  static const Field<P> table[] = {
      {"centre", &P::centre, "m", "Where the rays meet.", kPlace},
      {"axis", &P::axis, "",
       "Direction that rays and rings are perpendicular to; any length but 0.", kPlace},
      {"rays", &P::rays, "", "Cuts from the axis outwards.", {2, 1000}},
      {"rings", &P::rings, "", "Cuts around the axis.", {0, 1000}},
      {"radius", &P::radius, "m", "Of the outermost ring.", kSize},
      {"variability", &P::variability, "", "How far rays and rings may move, of their distance.",
       kShare},
  };
  return table;
}

template <>
std::span<const Field<SolidBrickParams>> fields() {
  using P = SolidBrickParams;
  static const Field<P> table[] = {
      {"brick", &P::brick, "m", "A brick's size along x, y (height) and z, without mortar.", kSize},
      {"offset", &P::offset, "",
       "How far a course is moved against the one below, of a brick's length with its mortar.",
       kShare},
      {"mortar", &P::mortar, "m", "Thickness of the joints, chunks of their own; 0: bricks touch.",
       kLength},
  };
  return table;
}

template <>
std::span<const Field<CarveParams>> fields() {
  using P = CarveParams;
  static const Field<P> table[] = {
      {"radius", &P::radius, "m", "Of the crater.", kSize},
      {"depth", &P::depth, "m", "How deep it goes; 0: a ball of its radius.", kLength},
      {"roughness", &P::roughness, "m", "How far its face strays.", kLength},
  };
  return table;
}

template <>
std::span<const Field<SolidModel>> fields() {
  using P = SolidModel;
  static const Field<P> table[] = {
      {"name", &P::name, "",
       "Begins the names of its chunks; letters, digits, _ and - only, at most 40, unlike every "
       "other solid's and wall's. Left out: solid, solid_2, solid_3 …"},
      {.name = "file",
       .member = &P::file,
       .unit = "",
       .effect = "The model, .obj .glb .gltf .stl or .ply, relative to the scene and inside its "
                 "folder.",
       .required = true},
      {"material", &P::material, "",
       "What it consists of: a built-in material or one of the scene's materials."},
      {"roughness", &P::roughness, "m", "How far inner faces stray from their planes.", kLength},
      {"roughness_size", &P::roughness_size, "m",
       "Size of the bumps; 0: a quarter of a chunk's size.", kLength},
      {"uv_scale", &P::uv_scale, "m", "Inner faces: length that one unit of texture covers.",
       kSize},
      {"scale", &P::scale, "", "Metres per unit of the model's coordinates.", kScale},
      {"repair", &P::repair, "",
       "Make the model a solid if it is not: orientation, holes, and if "
       "that is not enough a new surface by a level set."},
      {"max_error", &P::max_error, "m",
       "How far a repaired or carved surface may be from the model's; 0: a 200th of the bounding "
       "box's diagonal.",
       kLength},
  };
  return table;
}

}  // namespace sunder
