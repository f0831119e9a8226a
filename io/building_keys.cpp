// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/building_keys.hpp"

namespace sunder {
namespace {

constexpr Range kThickness{1e-3, 10};  // m
constexpr Range kLiveLoad{0, 1e7};     // N/m²
constexpr std::string_view kKinds[] = {"post", "beam"};
constexpr std::string_view kThicknessText = "Of the slab or panel.";
constexpr std::string_view kMaterialText = "A built-in material or one of the scene's materials.";
constexpr std::string_view kLiveText = "What lies on the slabs, as mass that moves with them.";
constexpr std::string_view kNameText =
    "Letters, digits, _ and - only, at most 40, unlike every other part's; not `ground`.";

}  // namespace

template <>
std::span<const Field<StoreyParams>> fields() {
  using P = StoreyParams;
  static const Field<P> table[] = {
      {"post_section", &P::post_section, "",
       "Cross-section of posts: a built-in one or one of `sections`."},
      {"beam_section", &P::beam_section, "",
       "Cross-section of beams: a built-in one or one of `sections`."},
      {"steel", &P::steel, "", "Steel grade: a built-in one or one of `steels`."},
      {"live_load", &P::live_load, "N/m²", kLiveText, kLiveLoad},
  };
  return table;
}

template <>
std::span<const Field<SlabParams>> fields() {
  using P = SlabParams;
  static const Field<P> table[] = {
      {"thickness", &P::thickness, "m", kThicknessText, kThickness},
      {"material", &P::material, "", kMaterialText},
  };
  return table;
}

template <>
std::span<const Field<PanelParams>> fields() {
  using P = PanelParams;
  static const Field<P> table[] = {
      {"thickness", &P::thickness, "m", kThicknessText, kThickness},
      {"material", &P::material, "", kMaterialText},
  };
  return table;
}

template <>
std::span<const Field<FrameNode>> fields() {
  using P = FrameNode;
  static const Field<P> table[] = {
      {.name = "name",
       .member = &P::name,
       .unit = "",
       .effect = "Letters, digits, _ and - only, at most 40, unlike every other node's. Those of "
                 "the regular building are `node_<x>_<z>_<level>`, from 0.",
       .required = true},
      {"support", &P::support, "", "Whether the ground holds it, against turning too."},
  };
  return table;
}

template <>
std::span<const Field<GivenMember>> fields() {
  using P = GivenMember;
  const auto required = [](std::string_view name, std::string P::*member, std::string_view effect) {
    return Field<P>{.name = name, .member = member, .unit = "", .effect = effect, .required = true};
  };
  static const Field<P> table[] = {
      required("name", &P::name, kNameText),
      required("from", &P::from, "Name of a node."),
      required("to", &P::to, "Name of another node."),
      {"section", &P::section, "", "Left out: the building's post_section or beam_section."},
      {"steel", &P::steel, "", "Left out: the building's."},
      {.name = "kind",
       .member = &P::kind,
       .unit = "",
       .effect = "Left out: a post when steeper than 45°.",
       .choices = kKinds},
      {"roll_deg", &P::roll_deg, "degrees",
       "Turns the section about the member, right-handed from `from` to `to`. At 0 the web of a "
       "beam is upright, that of a post along z.",
       kTurn},
  };
  return table;
}

template <>
std::span<const Field<GivenSlab>> fields() {
  using P = GivenSlab;
  static const Field<P> table[] = {
      {.name = "name", .member = &P::name, .unit = "", .effect = kNameText, .required = true},
      {"thickness", &P::thickness, "m", "Left out: that of the building's slabs.", kThickness},
      {"material", &P::material, "", "Left out: that of the building's slabs."},
      {"live_load", &P::live_load, "N/m²", "Left out: the building's.", kLiveLoad},
  };
  return table;
}

template <>
std::span<const Field<GivenPanel>> fields() {
  using P = GivenPanel;
  static const Field<P> table[] = {
      {.name = "name", .member = &P::name, .unit = "", .effect = kNameText, .required = true},
      {"thickness", &P::thickness, "m", "Left out: that of the building's walls.", kThickness},
      {"material", &P::material, "", "Left out: that of the building's walls."},
  };
  return table;
}

template <>
std::span<const Field<GivenJoint>> fields() {
  using P = GivenJoint;
  const auto required = [](std::string_view name, std::string P::*member, std::string_view effect) {
    return Field<P>{.name = name, .member = member, .unit = "", .effect = effect, .required = true};
  };
  static const Field<P> table[] = {
      required("of", &P::of, "Name of the member that ends here."),
      required("to", &P::to, "Name of the member that carries it, or `ground`."),
      required("at", &P::at, "Name of the node."),
      {"class", &P::joint_class, "",
       "Name of a joint class; left out: `post` or `beam`, as the member is."},
  };
  return table;
}

}  // namespace sunder
