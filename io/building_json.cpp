// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <unordered_set>

#include "io/building.hpp"
#include "io/materials.hpp"
#include "io/printable.hpp"
#include "io/sections.hpp"
#include "io/suggest.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

std::vector<std::string_view> building_keys() {
  std::vector<std::string_view> keys = keys_of<StoreyParams>();
  append_keys(keys, kBuildingKeys);
  for (const Field<BreakingRules>& field : fields<BreakingRules>()) keys.push_back(field.name);
  return keys;
}

/// Threshold of a joint class, or what it was.
void read_thresholds(Vec3& thresholds, const Place& object, const SceneKey& key) {
  const JsonValue* value = object.value.find(key.name);
  if (value) thresholds = triple_at(Place(object, key.name, *value), key.range, key.unit);
}

void read_joint_class(JointClass& joint_class, const Place& place) {
  std::vector<std::string_view> keys;
  append_keys(keys, kJointKeys);
  for (const Field<JointClass>& field : joint_fields()) keys.push_back(field.name);
  check_keys(place, keys);
  const auto& [force, torque] = kJointKeys;
  const bool has_force = place.value.find(force.name), has_torque = place.value.find(torque.name);
  if (has_force != has_torque) {
    place.fail("\"force\" and \"torque\" go together, " +
               std::string(has_force ? "\"torque\"" : "\"force\"") + " is missing");
  }
  for (const Field<JointClass>& field : joint_fields()) {
    if (const JsonValue* value = place.value.find(field.name)) {
      read_field(joint_class, field, Place(place, field.name, *value));
    }
  }
  read_thresholds(joint_class.force, place, force);
  read_thresholds(joint_class.torque, place, torque);
}

/// The built-in classes as the scene changes them, then its own.
std::vector<JointClass> read_joint_classes(const Place& building) {
  std::vector<JointClass> classes = built_in_classes();
  const JsonValue* value = building.value.find("joints");
  if (!value) return classes;
  const std::size_t built_in = classes.size();
  const Place joints(building, "joints", *value);
  for (const JsonMember& member : object_at(joints)) {
    const Place place(joints, member);
    if (!is_name(member.key)) {
      place.fail("a joint class is named by 1 to " + std::to_string(kMaxNameLength) +
                 " letters A-Z a-z, digits, _ and -");
    }
    // Keys differ: only the built-in ones can be there already.
    const auto end = classes.begin() + static_cast<std::ptrdiff_t>(built_in);
    auto found = std::find_if(classes.begin(), end,
                              [&](const JointClass& each) { return each.name == member.key; });
    if (found == end) found = classes.insert(classes.end(), JointClass{.name = member.key});
    read_joint_class(*found, place);
  }
  return classes;
}

/// A class of the scene's own that no connection names is most likely a misspelt one.
void check_classes_used(const Place& building, const Frame& frame,
                        const std::vector<GivenJoint>& connections) {
  std::unordered_set<std::string_view> used;
  for (const GivenJoint& each : connections) used.insert(each.joint_class);
  std::vector<std::string_view> built_in;
  const std::vector<JointClass> classes = built_in_classes();
  for (const JointClass& each : classes) built_in.push_back(each.name);
  for (std::size_t i = built_in.size(); i < frame.classes.size(); ++i) {
    const std::string& name = frame.classes[i].name;
    if (used.contains(name)) continue;
    const Place joints(building, "joints", *building.value.find("joints"));
    Place(joints, name, *joints.value.find(name))
        .fail("no connection uses the joint class \"" + name + '"' + hint_for(name, built_in));
  }
}

/// Parts that stood before those given one by one.
struct RegularCount {
  std::size_t nodes = 0, members = 0, slabs = 0, walls = 0;
};

/// Fails if one of `parts` has that name: at its own place if it was given one by one.
template <class Part>
void fail_at(const Place& building, std::string_view key, const std::string& word,
             const std::vector<Part>& parts, std::size_t regular, const FrameDefect& defect) {
  const auto found = std::find_if(parts.begin(), parts.end(),
                                  [&](const Part& part) { return part.name == defect.part; });
  if (found == parts.end()) return;
  const std::string what = word + " \"" + defect.part + "\" " + defect.what;
  const auto index = static_cast<std::size_t>(found - parts.begin());
  if (index < regular) building.fail(what);
  const Place list(building, key, *building.value.find(key));
  Place(list, index - regular).fail(what);
}

void check_frame(const Place& building, const Frame& frame, const RegularCount& regular) {
  const std::vector<FrameDefect> defects = defects_of(frame);
  if (defects.empty()) return;
  // What is wrong with a part explains what is wrong with its joints.
  const auto of_part = std::find_if(defects.begin(), defects.end(), [](const FrameDefect& each) {
    return each.part.find('@') == std::string::npos;
  });
  const FrameDefect& defect = of_part == defects.end() ? defects.front() : *of_part;
  fail_at(building, "members", "member", frame.members, regular.members, defect);
  fail_at(building, "slabs", "slab", frame.slabs, regular.slabs, defect);
  fail_at(building, "wall_panels", "wall panel", frame.walls, regular.walls, defect);
  fail_at(building, "nodes", "node", frame.nodes, regular.nodes, defect);
  const bool is_frame = of_part != defects.end();
  building.fail((is_frame ? "the frame " : "joint \"" + defect.part + "\" ") + defect.what);
}

/// A frame without parts: what the keys of a building may name.
Frame read_frame_tables(const Place& building, const std::vector<Material>& materials) {
  Frame frame;
  frame.materials = materials;
  frame.sections = builtin_sections();
  frame.steels = builtin_steels();
  if (const JsonValue* sections = building.value.find("sections")) {
    const Place list(building, "sections", *sections);
    check_count(list);
    read_sections(list, frame.sections);
  }
  if (const JsonValue* steels = building.value.find("steels")) {
    const Place list(building, "steels", *steels);
    check_count(list);
    read_steels(list, frame.steels);
  }
  frame.classes = read_joint_classes(building);
  return frame;
}

/// Does what may refuse the building, which it calls "building", at the building's place.
template <class Step>
void at_building(const Place& building, Step step) {
  try {
    step();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::input) throw;
    constexpr std::string_view kSubject = "building: ";
    const std::string_view what = error.what();
    building.fail(std::string(what.substr(what.starts_with(kSubject) ? kSubject.size() : 0)));
  }
}

/// The regular part of the building, and how much it is.
RegularCount add_regular_part(Frame& frame, const Place& place, const StoreyParams& common,
                              const SceneFolder& folder) {
  if (const std::optional<RegularBuilding> regular = read_regular(place, frame, common, folder)) {
    at_building(place, [&] { add_regular(frame, *regular); });
  }
  return {frame.nodes.size(), frame.members.size(), frame.slabs.size(), frame.walls.size()};
}

}  // namespace

Frame read_building(const Place& place, const std::vector<Material>& materials,
                    const SceneFolder& folder) {
  check_keys(place, building_keys());
  Frame frame = read_frame_tables(place, materials);
  const StoreyParams common = read_common_storey(place, frame, folder);
  const RegularCount regular = add_regular_part(frame, place, common, folder);
  const std::vector<GivenJoint> connections = add_given_parts(frame, place, common);
  check_classes_used(place, frame, connections);
  at_building(place, [&] { join(frame, connections); });
  check_frame(place, frame, regular);
  return frame;
}

void check_count(const Place& list) {
  const std::size_t count = list_at(list).size();
  if (count <= kMaxBuildingList) return;
  list.fail("has " + std::to_string(count) + " entries, the most is " +
            std::to_string(kMaxBuildingList));
}

}  // namespace sunder
