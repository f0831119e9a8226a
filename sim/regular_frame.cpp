// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "meshing/error.hpp"
#include "sim/frame.hpp"

namespace sunder {
namespace {

constexpr double kMostPlaces = 200000;  // posts' places: columns × rows × storeys
constexpr std::uint32_t kAll = 0xFFFFFFFFu;

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::input, "building: " + message);
}

/// Whether `text` is `pattern`, in which each '*' stands for any text. O(|pattern| |text|).
bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// The names that are left out. Each must match something.
class LeftOut {
 public:
  explicit LeftOut(const std::vector<std::string>& patterns) {
    for (const std::string& p : patterns) {
      if (p.find('*') == std::string::npos) {
        names_.emplace(p, false);
      } else {
        patterns_.emplace_back(p, false);
      }
    }
  }
  bool empty() const { return names_.empty() && patterns_.empty(); }
  bool holds(const std::string& name) {
    bool found = false;
    if (const auto at = names_.find(name); at != names_.end()) found = at->second = true;
    for (auto& [pattern, used] : patterns_) {
      if (!matches(pattern, name)) continue;
      found = used = true;
    }
    return found;
  }
  /// `patterns`: as given, so that the first one without a match is named.
  void check(const std::vector<std::string>& patterns) const {
    for (const std::string& p : patterns) {
      const auto name = names_.find(p);
      const bool used = name != names_.end()
                            ? name->second
                            : std::any_of(patterns_.begin(), patterns_.end(),
                                          [&](const auto& q) { return q.first == p && q.second; });
      if (!used) refuse("without = " + p + " matches none of its parts");
    }
  }

 private:
  std::unordered_map<std::string, bool> names_;
  std::vector<std::pair<std::string, bool>> patterns_;
};

/// Column along x, row along z, storey.
struct Place {
  std::uint32_t x = 0, z = 0, storey = 0;
};

enum Kind { kPost, kBeamX, kBeamZ, kSlab, kWallX, kWallZ, kKinds };
constexpr const char* kPrefix[kKinds] = {"post_", "beam_x_", "beam_z_",
                                         "slab_", "wall_x_", "wall_z_"};

std::string name_of(const char* prefix, Place p) {
  return prefix + std::to_string(p.x) + "_" + std::to_string(p.z) + "_" + std::to_string(p.storey);
}

struct StoreyNumbers {
  std::uint32_t post_section = 0, beam_section = 0, steel = 0, slab = 0, wall = 0;
  std::uint32_t slab_pattern = kNoPart, wall_pattern = kNoPart;
};

template <class Named>
std::uint32_t number_of(const std::vector<Named>& all, const std::string& name,
                        const std::string& what) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  if (found == all.end()) refuse("there is no " + what + " " + name);
  return static_cast<std::uint32_t>(found - all.begin());
}

std::vector<double> cumulated(double start, const std::vector<double>& steps) {
  std::vector<double> places{start};
  for (const double step : steps) places.push_back(places.back() + step);
  return places;
}

/// Lays the parts out on a grid of places, strikes out what is left out, then fills the frame.
class Layout {
 public:
  Layout(const RegularBuilding& building, Frame& frame);
  void leave_out();
  void fill();

 private:
  std::size_t index(Place p) const {
    return (std::size_t{p.storey} * rows_ + p.z) * columns_ + p.x;
  }
  char& has(Kind kind, Place p) { return has_[kind][index(p)]; }
  std::uint32_t number(Kind kind, Place p) const { return number_[kind][index(p)]; }
  template <class Act>
  void for_places(Act act) const;
  template <class Act>
  void for_storey(std::uint32_t storey, Act act) const;
  void check_ranges();
  void check_sizes() const;
  void lay_out(Place p);
  void lay_out_walls(Place p);
  bool has_post_at(std::uint32_t x, std::uint32_t z, std::uint32_t level);
  bool carries_beam(Place p, bool along_x);
  bool carries_wall(Place p, bool along_x);
  bool carries_slab(Place p);
  void take_along();
  std::uint32_t node(std::uint32_t x, std::uint32_t z, std::uint32_t level) const;
  void fill_nodes();
  void fill_member(Kind kind, Place p);
  void fill_slab(Place p);
  void fill_wall(Kind kind, Place p);
  StoreyNumbers numbers_of(const StoreyParams& storey);

  const RegularBuilding& building_;
  Frame& frame_;
  std::uint32_t columns_, rows_, storeys_;
  std::vector<std::array<std::uint32_t, 2>> range_x_, range_z_;  // of bays, per storey
  std::vector<StoreyNumbers> numbers_;
  std::vector<char> has_[kKinds];
  std::vector<std::uint32_t> number_[kKinds];
  std::vector<std::uint32_t> nodes_;  // per column, row and level
};

Layout::Layout(const RegularBuilding& building, Frame& frame)
    : building_(building),
      frame_(frame),
      columns_(static_cast<std::uint32_t>(building.bays_x.size()) + 1),
      rows_(static_cast<std::uint32_t>(building.bays_z.size()) + 1),
      storeys_(static_cast<std::uint32_t>(building.storeys.size())) {
  check_sizes();
  check_ranges();
  for (const StoreyParams& storey : building.storeys) numbers_.push_back(numbers_of(storey));
  const std::size_t places = std::size_t{columns_} * rows_ * storeys_;
  for (int kind = 0; kind < kKinds; ++kind) {
    has_[kind].assign(places, 0);
    number_[kind].assign(places, kNoPart);
  }
  for_places([&](Place p) { lay_out(p); });
}

template <class Act>
void Layout::for_storey(std::uint32_t storey, Act act) const {
  for (std::uint32_t z = 0; z < rows_; ++z) {
    for (std::uint32_t x = 0; x < columns_; ++x) act(Place{x, z, storey});
  }
}

template <class Act>
void Layout::for_places(Act act) const {
  for (std::uint32_t storey = 0; storey < storeys_; ++storey) for_storey(storey, act);
}

void Layout::check_sizes() const {
  if (building_.bays_x.empty() || building_.bays_z.empty()) refuse("it needs a bay along x and z");
  if (storeys_ == 0) refuse("it needs a storey");
  if (double{1} * columns_ * rows_ * storeys_ > kMostPlaces) {
    refuse("it has more than 200000 posts");
  }
  const auto sound = [](double size) { return size > 0 && std::isfinite(size); };
  if (!std::all_of(building_.bays_x.begin(), building_.bays_x.end(), sound) ||
      !std::all_of(building_.bays_z.begin(), building_.bays_z.end(), sound)) {
    refuse("each bay must be wider than 0");
  }
  for (const StoreyParams& s : building_.storeys) {
    if (!sound(s.height)) refuse("each storey must be higher than 0");
  }
}

void Layout::check_ranges() {
  const auto checked = [&](std::array<std::uint32_t, 2> range, std::size_t bays, std::size_t storey,
                           const char* key) {
    if (range[1] == kAll) range[1] = static_cast<std::uint32_t>(bays);
    if (range[0] < range[1] && range[1] <= bays) return range;
    refuse("storey " + std::to_string(storey) + ": " + key + " = [" + std::to_string(range[0]) +
           ", " + std::to_string(range[1]) + ") is empty or beyond the " + std::to_string(bays) +
           " bays");
  };
  for (std::size_t s = 0; s < storeys_; ++s) {
    const StoreyParams& storey = building_.storeys[s];
    range_x_.push_back(checked(storey.bays_x, building_.bays_x.size(), s, "bays_x"));
    range_z_.push_back(checked(storey.bays_z, building_.bays_z.size(), s, "bays_z"));
  }
}

StoreyNumbers Layout::numbers_of(const StoreyParams& s) {
  StoreyNumbers result;
  result.post_section = number_of(frame_.sections, s.post_section, "section");
  result.beam_section = number_of(frame_.sections, s.beam_section, "section");
  result.steel = number_of(frame_.steels, s.steel, "steel grade");
  if (s.slab_thickness != 0) {
    result.slab = number_of(frame_.materials, s.slab_material, "material");
  }
  if (s.wall_thickness != 0) {
    result.wall = number_of(frame_.materials, s.wall_material, "material");
  }
  result.slab_pattern = add_pattern(frame_, s.slab_pattern);
  result.wall_pattern = add_pattern(frame_, s.wall_pattern);
  return result;
}

void Layout::lay_out(Place p) {
  const auto [first_x, end_x] = range_x_[p.storey];
  const auto [first_z, end_z] = range_z_[p.storey];
  if (p.x < first_x || p.x > end_x || p.z < first_z || p.z > end_z) return;
  has(kPost, p) = 1;
  has(kBeamX, p) = p.x < end_x;
  has(kBeamZ, p) = p.z < end_z;
  has(kSlab, p) = p.x < end_x && p.z < end_z && building_.storeys[p.storey].slab_thickness != 0;
  if (building_.storeys[p.storey].wall_thickness == 0) return;
  has(kWallX, p) = p.x < end_x && (p.z == first_z || p.z == end_z);
  has(kWallZ, p) = p.z < end_z && (p.x == first_x || p.x == end_x);
}

void Layout::leave_out() {
  LeftOut left_out(building_.without);
  if (!left_out.empty()) {
    for_places([&](Place p) {
      for (int kind = 0; kind < kKinds; ++kind) {
        char& built = has_[kind][index(p)];
        if (built && left_out.holds(name_of(kPrefix[kind], p))) built = 0;
      }
    });
    left_out.check(building_.without);
  }
  take_along();
}

bool Layout::has_post_at(std::uint32_t x, std::uint32_t z, std::uint32_t level) {
  return (level > 0 && has(kPost, {x, z, level - 1})) ||
         (level < storeys_ && has(kPost, {x, z, level}));
}

bool Layout::carries_beam(Place p, bool along_x) {
  return has_post_at(p.x, p.z, p.storey + 1) &&
         has_post_at(p.x + along_x, p.z + !along_x, p.storey + 1);
}

bool Layout::carries_slab(Place p) {
  return has(kBeamX, p) && has(kBeamX, {p.x, p.z + 1, p.storey}) && has(kBeamZ, p) &&
         has(kBeamZ, {p.x + 1, p.z, p.storey});
}

bool Layout::carries_wall(Place p, bool along_x) {
  const Kind beam = along_x ? kBeamX : kBeamZ;
  return has(kPost, p) && has(kPost, {p.x + along_x, p.z + !along_x, p.storey}) && has(beam, p) &&
         (p.storey == 0 || has(beam, {p.x, p.z, p.storey - 1}));
}

/// What rests on something that is not there goes too: beams first, then what lies on beams.
void Layout::take_along() {
  for_places([&](Place p) {
    if (has(kBeamX, p)) has(kBeamX, p) = carries_beam(p, true);
    if (has(kBeamZ, p)) has(kBeamZ, p) = carries_beam(p, false);
  });
  for_places([&](Place p) {
    if (has(kSlab, p)) has(kSlab, p) = carries_slab(p);
    if (has(kWallX, p)) has(kWallX, p) = carries_wall(p, true);
    if (has(kWallZ, p)) has(kWallZ, p) = carries_wall(p, false);
  });
}

std::uint32_t Layout::node(std::uint32_t x, std::uint32_t z, std::uint32_t level) const {
  return nodes_[(std::size_t{level} * rows_ + z) * columns_ + x];
}

void Layout::fill_nodes() {
  const std::vector<double> xs = cumulated(building_.position.x, building_.bays_x);
  const std::vector<double> zs = cumulated(building_.position.z, building_.bays_z);
  double y = building_.position.y;
  for (std::uint32_t level = 0; level <= storeys_; ++level) {
    for_storey(level, [&](Place p) {
      nodes_.push_back(kNoPart);
      if (!has_post_at(p.x, p.z, level)) return;
      nodes_.back() = static_cast<std::uint32_t>(frame_.nodes.size());
      frame_.nodes.push_back({name_of("node_", p), {xs[p.x], y, zs[p.z]}, level == 0});
    });
    if (level < storeys_) y += building_.storeys[level].height;
  }
}

void Layout::fill_member(Kind kind, Place p) {
  if (!has(kind, p)) return;
  number_[kind][index(p)] = static_cast<std::uint32_t>(frame_.members.size());
  const bool post = kind == kPost;
  const StoreyNumbers& numbers = numbers_[p.storey];
  frame_.members.push_back(
      {.name = name_of(kPrefix[kind], p),
       .kind = post ? FrameMember::Kind::post : FrameMember::Kind::beam,
       .from = node(p.x, p.z, p.storey + !post),
       .to = node(p.x + (kind == kBeamX), p.z + (kind == kBeamZ), p.storey + 1),
       .section = post ? numbers.post_section : numbers.beam_section,
       .steel = numbers.steel});
}

void Layout::fill_slab(Place p) {
  if (!has(kSlab, p)) return;
  const std::uint32_t level = p.storey + 1;
  const StoreyParams& storey = building_.storeys[p.storey];
  frame_.slabs.push_back({.name = name_of(kPrefix[kSlab], p),
                          .nodes = {node(p.x, p.z, level), node(p.x + 1, p.z, level),
                                    node(p.x + 1, p.z + 1, level), node(p.x, p.z + 1, level)},
                          .beams = {number(kBeamX, p), number(kBeamZ, {p.x + 1, p.z, p.storey}),
                                    number(kBeamX, {p.x, p.z + 1, p.storey}), number(kBeamZ, p)},
                          .thickness = storey.slab_thickness,
                          .material = numbers_[p.storey].slab,
                          .live_load = storey.live_load,
                          .pattern = numbers_[p.storey].slab_pattern});
}

/// Left and right as seen from outside.
void Layout::fill_wall(Kind kind, Place p) {
  if (!has(kind, p)) return;
  const bool along_x = kind == kWallX;
  const Kind beam = along_x ? kBeamX : kBeamZ;
  Place left = p, right{p.x + along_x, p.z + !along_x, p.storey};
  const bool at_start = along_x ? p.z == range_z_[p.storey][0] : p.x == range_x_[p.storey][0];
  if (at_start == along_x) std::swap(left, right);
  const std::uint32_t below = p.storey == 0 ? kNoPart : number(beam, {p.x, p.z, p.storey - 1});
  frame_.walls.push_back(
      {.name = name_of(kPrefix[kind], p),
       .nodes = {node(left.x, left.z, p.storey), node(right.x, right.z, p.storey),
                 node(right.x, right.z, p.storey + 1), node(left.x, left.z, p.storey + 1)},
       .edges = {below, number(kPost, right), number(beam, p), number(kPost, left)},
       .thickness = building_.storeys[p.storey].wall_thickness,
       .material = numbers_[p.storey].wall,
       .pattern = numbers_[p.storey].wall_pattern});
}

void Layout::fill() {
  fill_nodes();
  for (std::uint32_t storey = 0; storey < storeys_; ++storey) {
    for (const Kind kind : {kPost, kBeamX, kBeamZ}) {
      for_storey(storey, [&](Place p) { fill_member(kind, p); });
    }
  }
  for_places([&](Place p) { fill_slab(p); });
  for (std::uint32_t storey = 0; storey < storeys_; ++storey) {
    for (const Kind kind : {kWallX, kWallZ}) {
      for_storey(storey, [&](Place p) { fill_wall(kind, p); });
    }
  }
}

}  // namespace

std::uint32_t add_pattern(Frame& frame, const std::optional<PanelPattern>& pattern) {
  if (!pattern) return kNoPart;
  for (std::uint32_t i = 0; i < frame.patterns.size(); ++i)
    if (!pattern->asset.empty() && frame.patterns[i].asset == pattern->asset) return i;
  frame.patterns.push_back(*pattern);
  return static_cast<std::uint32_t>(frame.patterns.size() - 1);
}

void add_regular(Frame& frame, const RegularBuilding& building) {
  Layout layout(building, frame);
  layout.leave_out();
  layout.fill();
}

}  // namespace sunder
