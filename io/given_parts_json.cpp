// SPDX-License-Identifier: GPL-3.0-or-later
// What a building names one by one: nodes, members, slabs, wall panels, connections.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

#include "io/building.hpp"
#include "io/materials.hpp"
#include "io/printable.hpp"
#include "io/suggest.hpp"

namespace sunder {
namespace {

constexpr std::string_view kGround = "ground";

/// Names of things and their numbers.
using Numbers = std::unordered_map<std::string, std::uint32_t>;

/// A pair of nodes in either order.
std::uint64_t span_key(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

/// The number of the thing that a text names; `what` is its word in messages.
std::uint32_t number_named(const Place& place, std::string_view what, const Numbers& numbers) {
  const std::string name = text_at(place);
  const auto found = numbers.find(name);
  if (found != numbers.end()) return found->second;
  std::vector<std::string_view> names(numbers.size());
  for (const auto& [each, number] : numbers) names[number] = each;
  place.fail("unknown " + std::string(what) + ' ' + describe(place.value) + hint_for(name, names));
}

template <class Named>
Numbers numbers_of(const std::vector<Named>& all) {
  Numbers numbers;
  for (const Named& each : all) {
    numbers.emplace(each.name, static_cast<std::uint32_t>(numbers.size()));
  }
  return numbers;
}

/// Adds what one building gives to its frame.
class GivenParts {
 public:
  GivenParts(Frame& frame, const Place& building, const StoreyParams& common);
  void add_nodes();
  void add_members();
  void add_slabs();
  void add_panels();
  std::vector<GivenJoint> connections() const;

 private:
  template <class Read>
  void each_of(std::string_view key, Read read) const;
  void check_count() const;
  void claim(const Place& place, const std::string& name);
  std::uint32_t node_at(const Place& object, std::string_view key) const;
  std::array<std::uint32_t, 4> corners_at(const Place& object, const SceneKey& key) const;
  FrameMember::Kind kind_of(const GivenMember& given, const FrameMember& member) const;
  std::uint32_t number_or(const Place& object, std::string_view key, const Numbers& numbers,
                          const std::string& common) const;
  void add_member(const Place& place);
  void add_slab(const Place& place);
  void add_panel(const Place& place);
  std::uint32_t end_at(const Place& place, std::string_view key, std::uint32_t node) const;
  GivenJoint connection_at(const Place& place) const;

  Frame& frame_;
  const Place& building_;
  const StoreyParams& common_;
  std::uint32_t slab_pattern_ = kNoPart, wall_pattern_ = kNoPart;
  Vec3 position_;
  Numbers nodes_, members_, sections_, steels_, materials_, classes_;
  std::unordered_set<std::string> parts_;
  std::unordered_map<std::uint64_t, std::uint32_t> spans_;  ///< members by their nodes
};

GivenParts::GivenParts(Frame& frame, const Place& building, const StoreyParams& common)
    : frame_(frame),
      building_(building),
      common_(common),
      nodes_(numbers_of(frame.nodes)),
      members_(numbers_of(frame.members)),
      sections_(numbers_of(frame.sections)),
      steels_(numbers_of(frame.steels)),
      materials_(numbers_of(frame.materials)),
      classes_(numbers_of(frame.classes)) {
  check_count();
  slab_pattern_ = add_pattern(frame, common.slab_pattern);
  wall_pattern_ = add_pattern(frame, common.wall_pattern);
  if (const JsonValue* value = building.value.find("position")) {
    position_ = triple_at(Place(building, "position", *value), kBuildingPlace, "m");
  }
  for (std::uint32_t i = 0; i < frame.members.size(); ++i) {
    spans_.emplace(span_key(frame.members[i].from, frame.members[i].to), i);
  }
  for (std::uint32_t i = 0; i < frame.part_count(); ++i) parts_.insert(frame.part_name(i));
}

void GivenParts::check_count() const {
  std::size_t count = frame_.part_count();
  for (const std::string_view key : {"members", "slabs", "wall_panels"}) {
    const JsonValue* list = building_.value.find(key);
    if (list && list->items()) count += list->items()->size();
  }
  if (count <= kMaxParts) return;
  building_.fail("has " + std::to_string(count) + " parts, the most is " +
                 std::to_string(kMaxParts));
}

/// Reads each entry of the list of that name.
template <class Read>
void GivenParts::each_of(std::string_view key, Read read) const {
  const JsonValue* value = building_.value.find(key);
  if (!value) return;
  const Place list(building_, key, *value);
  for (std::size_t i = 0; i < list_at(list).size(); ++i) read(Place(list, i));
}

/// Takes a part's name.
void GivenParts::claim(const Place& object, const std::string& name) {
  const Place place(object, "name", *object.value.find("name"));
  name_at(place);
  if (name == kGround) place.fail("\"ground\" is what supports stand on, take another name");
  if (!parts_.insert(name).second) {
    place.fail("a part named \"" + name + "\" exists already, names must differ");
  }
}

void GivenParts::add_nodes() {
  each_of("nodes", [&](const Place& place) {
    check_keys(place, keys_of<FrameNode>({kNodePlace.name}));
    FrameNode node;
    read_fields(node, place);
    const Place name(place, "name", *place.value.find("name"));
    name_at(name);
    require_key(place, kNodePlace.name, "\"at\": [0, 3.5, 0]");
    const Place at(place, kNodePlace.name, *place.value.find(kNodePlace.name));
    node.position = position_ + triple_at(at, kNodePlace.range, kNodePlace.unit);
    if (!nodes_.emplace(node.name, static_cast<std::uint32_t>(nodes_.size())).second) {
      name.fail("a node named \"" + node.name + "\" exists already, names must differ");
    }
    frame_.nodes.push_back(std::move(node));
  });
}

std::uint32_t GivenParts::node_at(const Place& object, std::string_view key) const {
  return number_named(Place(object, key, *object.value.find(key)), "node", nodes_);
}

/// What the member `key` names, or else what is usual.
std::uint32_t GivenParts::number_or(const Place& object, std::string_view key,
                                    const Numbers& numbers, const std::string& common) const {
  const JsonValue* value = object.value.find(key);
  return value ? number_named(Place(object, key, *value), key, numbers) : numbers.at(common);
}

FrameMember::Kind GivenParts::kind_of(const GivenMember& given, const FrameMember& member) const {
  using Kind = FrameMember::Kind;
  if (!given.kind.empty()) return given.kind == "post" ? Kind::post : Kind::beam;
  const Vec3 along = frame_.nodes[member.to].position - frame_.nodes[member.from].position;
  return std::abs(along.y) > std::hypot(along.x, along.z) ? Kind::post : Kind::beam;
}

void GivenParts::add_member(const Place& place) {
  check_keys(place, keys_of<GivenMember>());
  GivenMember given;
  read_fields(given, place);
  claim(place, given.name);
  FrameMember member{.name = given.name};
  member.from = node_at(place, "from");
  member.to = node_at(place, "to");
  member.kind = kind_of(given, member);
  member.roll = given.roll_deg * (std::numbers::pi / 180);
  const bool is_post = member.kind == FrameMember::Kind::post;
  const bool is_upside_down =
      frame_.nodes[member.from].position.y > frame_.nodes[member.to].position.y;
  if (is_post && is_upside_down) {
    std::swap(member.from, member.to);
    member.roll = -member.roll;  // the same turn about the axis reversed
  }
  const std::string& section = is_post ? common_.post_section : common_.beam_section;
  member.section = number_or(place, "section", sections_, section);
  member.steel = number_or(place, "steel", steels_, common_.steel);
  const auto number = static_cast<std::uint32_t>(frame_.members.size());
  members_.emplace(member.name, number);
  spans_.emplace(span_key(member.from, member.to), number);
  frame_.members.push_back(std::move(member));
}

void GivenParts::add_members() {
  each_of("members", [&](const Place& place) { add_member(place); });
}

/// Four different nodes.
std::array<std::uint32_t, 4> GivenParts::corners_at(const Place& object,
                                                    const SceneKey& key) const {
  require_key(object, key.name, "\"nodes\": [\"A\", \"B\", \"C\", \"D\"]");
  const Place list(object, key.name, *object.value.find(key.name));
  if (list_at(list).size() != 4) list.fail_kind("a list of 4 names of nodes");
  std::array<std::uint32_t, 4> nodes{};
  for (std::size_t i = 0; i < 4; ++i) {
    nodes[i] = number_named(Place(list, i), "node", nodes_);
    if (std::find(nodes.begin(), nodes.begin() + i, nodes[i]) != nodes.begin() + i) {
      Place(list, i).fail("the corner " + describe(Place(list, i).value) +
                          " occurs twice, give four different ones");
    }
  }
  return nodes;
}

void GivenParts::add_slab(const Place& place) {
  check_keys(place, keys_of<GivenSlab>({kSlabNodes.name}));
  GivenSlab given;
  read_fields(given, place);
  claim(place, given.name);
  FrameSlab slab{.name = given.name};
  slab.nodes = corners_at(place, kSlabNodes);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t a = slab.nodes[i], b = slab.nodes[(i + 1) % 4];
    const auto beam = spans_.find(span_key(a, b));
    if (beam == spans_.end() || frame_.members[beam->second].kind != FrameMember::Kind::beam) {
      Place(place, kSlabNodes.name, *place.value.find(kSlabNodes.name))
          .fail("no beam joins \"" + frame_.nodes[a].name + "\" and \"" + frame_.nodes[b].name +
                "\", a slab lies on four");
    }
    slab.beams[i] = beam->second;
  }
  const double usual = common_.slab_thickness > 0 ? common_.slab_thickness : SlabParams{}.thickness;
  slab.thickness = given.thickness > 0 ? given.thickness : usual;
  slab.material = number_or(place, "material", materials_, common_.slab_material);
  slab.live_load = given.live_load >= 0 ? given.live_load : common_.live_load;
  slab.pattern = slab_pattern_;
  frame_.slabs.push_back(std::move(slab));
}

void GivenParts::add_slabs() {
  each_of("slabs", [&](const Place& place) { add_slab(place); });
}

void GivenParts::add_panel(const Place& place) {
  check_keys(place, keys_of<GivenPanel>({kPanelNodes.name}));
  GivenPanel given;
  read_fields(given, place);
  claim(place, given.name);
  FrameWall wall{.name = given.name};
  wall.nodes = corners_at(place, kPanelNodes);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t a = wall.nodes[i], b = wall.nodes[(i + 1) % 4];
    const auto member = spans_.find(span_key(a, b));
    if (member != spans_.end()) {
      wall.edges[i] = member->second;
      continue;
    }
    const bool is_on_ground = frame_.nodes[a].support && frame_.nodes[b].support;
    if (i == 0 && is_on_ground) continue;
    Place(place, kPanelNodes.name, *place.value.find(kPanelNodes.name))
        .fail("no member joins \"" + frame_.nodes[a].name + "\" and \"" + frame_.nodes[b].name +
              "\", a wall panel fills the bay between four, or three and the ground");
  }
  const double usual =
      common_.wall_thickness > 0 ? common_.wall_thickness : PanelParams{}.thickness;
  wall.thickness = given.thickness > 0 ? given.thickness : usual;
  wall.material = number_or(place, "material", materials_, common_.wall_material);
  wall.pattern = wall_pattern_;
  frame_.walls.push_back(std::move(wall));
}

void GivenParts::add_panels() {
  each_of("wall_panels", [&](const Place& place) { add_panel(place); });
}

/// The member that ends at the node.
std::uint32_t GivenParts::end_at(const Place& place, std::string_view key,
                                 std::uint32_t node) const {
  const Place name(place, key, *place.value.find(key));
  const std::uint32_t number = number_named(name, "member", members_);
  const FrameMember& member = frame_.members[number];
  if (member.from != node && member.to != node) {
    name.fail("the member " + describe(name.value) + " does not end at the node \"" +
              frame_.nodes[node].name + '"');
  }
  return number;
}

GivenJoint GivenParts::connection_at(const Place& place) const {
  check_keys(place, keys_of<GivenJoint>());
  GivenJoint given;
  read_fields(given, place);
  const std::uint32_t node = node_at(place, "at");
  const std::uint32_t of = end_at(place, "of", node);
  if (given.to != kGround && end_at(place, "to", node) == of) {
    Place(place, "to", *place.value.find("to")).fail("a member cannot be joined to itself");
  }
  if (given.to == kGround && !frame_.nodes[node].support) {
    Place(place, "at", *place.value.find("at"))
        .fail("the node \"" + given.at + "\" is no support, give it \"support\": true");
  }
  if (!given.joint_class.empty()) {
    number_named(Place(place, "class", *place.value.find("class")), "joint class", classes_);
  }
  return given;
}

std::vector<GivenJoint> GivenParts::connections() const {
  std::vector<GivenJoint> connections;
  each_of("connections", [&](const Place& place) { connections.push_back(connection_at(place)); });
  return connections;
}

}  // namespace

std::vector<GivenJoint> add_given_parts(Frame& frame, const Place& building,
                                        const StoreyParams& common) {
  GivenParts parts(frame, building, common);
  parts.add_nodes();
  parts.add_members();
  parts.add_slabs();
  parts.add_panels();
  return parts.connections();
}

}  // namespace sunder
