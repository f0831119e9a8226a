// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "io/moment.hpp"
#include "io/strip_building.hpp"
#include "io/strip_camera.hpp"
#include "io/strip_order.hpp"
#include "io/strip_stress.hpp"
#include "io/wall_view.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

StripColour colour_of(const std::array<std::uint8_t, 3>& rgb) {
  return {static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])};
}

constexpr double kFaintest = 0.015;  // light that is drawn
constexpr int kMostDivisions = 5;    // of one part: into at most 2^5

struct Look {
  StripColour outer, inner;
  bool is_glass = false, is_cracked = false;  // cracked: something of the wall has broken
};

Look strip_look(const std::string& material) {
  const MaterialLook look = look_of(material);
  return {colour_of(look.outer), colour_of(look.inner), is_glass(material)};
}

// Light from a sun and, from above more than from below, from the sky.
StripColour shaded(const StripColour& base, Vec3 normal, Vec3 light) {
  const double sun = std::max(0.0, dot(normal, light));
  const double strength = 0.59 + 0.10 * normal.y + 0.56 * sun;
  constexpr StripColour kCool{0.92, 0.97, 1.08}, kWarm{1.02, 1.0, 0.96};
  const StripColour tint = mix_colours(kCool, kWarm, std::min(1.0, 1.5 * sun));
  StripColour result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = base[i] * strength * tint[i];
  return result;
}

// A solid, and what is needed to draw it.
struct Item {
  const StripPart* part = nullptr;  // null: a projectile
  std::vector<bool> open;           // per edge: nothing of the same body lies beyond it
  std::vector<Vec2> picture;        // of the corners
  int cap = 0;                      // +1: the front is seen, -1: the back
  double radius = 0;                // of a projectile's disc, picture units
};

class Picture {
 public:
  Picture(const StripScene& scene, std::uint32_t step, StripPaper& paper)
      : scene_(scene), step_(step), out_(paper) {}

  void draw() {
    for (const RecordedWall& wall : scene_.recording.walls) {
      std::vector<ChunkPlace>& places = places_.emplace_back();
      for (std::uint32_t c = 0; c < wall.track.size(); ++c) {
        places.push_back(place_of(scene_.recording, wall, c, step_));
      }
      looks_.push_back(strip_look(wall.asset.wall.material));
    }
    add_building();
    for (const BreakEvent& event : scene_.recording.events) {
      const bool has_happened = event.time <= scene_.recording.times[step_];
      if (has_happened && event.wall < scene_.recording.walls.size()) {
        looks_[event.wall].is_cracked = true;
      }
    }
    for (const StripPart& part : scene_.parts) add_part(part);
    for (const RecordedProjectile& projectile : scene_.recording.projectiles) add_ball(projectile);
    if (scene_.params.has_ground) draw_shadows();
    const std::vector<std::uint32_t> order = find_order();
    for (std::size_t i = 0; i < order.size();) {
      std::size_t end = i + 1;
      while (end < order.size() && continues(order[i], order[end])) ++end;
      draw_run(std::span(order).subspan(i, end - i));
      i = end;
    }
  }

 private:
  const ChunkPlace& place(const StripPart& part) const { return places_[part.wall][part.chunk]; }
  bool is_of_building(const StripPart& part) const {
    return part.wall == scene_.recording.walls.size();
  }
  bool is_of_standing_wall(const StripPart& part) const {
    return !is_of_building(part) && place(part).track == kNoTrack;
  }
  const Look& look(const StripPart& part) const {
    return looks_[is_of_building(part) ? part.wall + part.chunk : part.wall];
  }
  std::string_view closed(const StripPart& part) const;
  void add_building();
  std::uint32_t body_of(const StripPart& part);
  std::vector<std::uint32_t> find_order();
  void divide(std::vector<std::uint32_t> cut);
  void add_part(const StripPart& part);
  void add_ball(const RecordedProjectile& recorded);
  bool put_on_screen(StripSolid& solid, Item& item);
  bool faces_eye(const StripSolid& solid, std::size_t edge) const;
  bool continues(std::uint32_t a, std::uint32_t b) const;
  std::vector<Vec2> shadow_of(std::size_t i) const;
  void draw_shadows();
  void draw_run(std::span<const std::uint32_t> run);
  void draw_sides(const StripSolid& solid, const Item& item);
  void draw_edges(const StripPart& part, std::span<const Vec2, 4> quad);
  StripColour cap_colour(std::uint32_t i) const;
  std::string caps_of(std::span<const std::uint32_t> run) const;
  void draw_caps(std::span<const std::uint32_t> run);
  std::string lines_of(std::span<const std::uint32_t> run, bool are_open) const;
  void draw_glass_caps(std::span<const std::uint32_t> run);
  void draw_end(std::uint32_t i, int end);
  void draw_ends(std::uint32_t i) { draw_end(i, 0), draw_end(i, 1); }
  void draw_ball(const Item& item);
  std::vector<Vec2> cap_of(const Item& item) const;

  const StripScene& scene_;
  std::uint32_t step_;
  StripPaper& out_;
  std::vector<std::vector<ChunkPlace>> places_;
  std::vector<Look> looks_;  // of the walls, then of the building's parts
  std::vector<std::array<EndLoad, 2>> loads_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> bodies_;
  std::deque<StripPart> divided_;  // solids and items refer to them
  std::vector<StripSolid> solids_;
  std::vector<Item> items_;
};

// A stroke in a face's own colour, so that nothing shines through where it meets the next one.
std::string_view Picture::closed(const StripPart& part) const {
  return is_of_standing_wall(part) ? R"(" stroke-opacity="1" stroke-width="22)"
                                   : R"(" stroke-opacity="1)";
}

void Picture::add_building() {
  const Recording& recording = scene_.recording;
  std::vector<ChunkPlace>& places = places_.emplace_back();
  for (const RecordedPart& part : recording.parts) {
    places.push_back({pose_of(recording, part, step_), part.track});
    looks_.push_back(strip_look(part.material));
  }
  loads_ = end_loads(recording, recording.times[step_]);
}

std::uint32_t Picture::body_of(const StripPart& part) {
  const std::pair key(part.wall, is_of_building(part) ? part.chunk : place(part).track);
  return bodies_.try_emplace(key, static_cast<std::uint32_t>(bodies_.size())).first->second;
}

// Projects the corners; false if the solid is too near or outside the picture.
bool Picture::put_on_screen(StripSolid& solid, Item& item) {
  Box& box = solid.screen;
  box = {{1e300, 1e300}, {-1e300, -1e300}};
  for (const Vec3 corner : solid.corners) {
    const Vec3 seen = scene_.camera.see(corner);
    if (!(seen.z > scene_.camera.nearest + item.radius)) return false;
    const Vec2 p = scene_.camera.project(seen);
    item.picture.push_back(p);
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    solid.distance +=
        length(corner - scene_.camera.eye) / static_cast<double>(solid.corners.size());
  }
  return true;
}

bool is_in_picture(const Box& box) {
  return box.high.x > 0 && box.low.x < kStripWidth && box.high.y > 0 && box.low.y < kStripHeight;
}

void Picture::add_part(const StripPart& part) {
  const Recording& recording = scene_.recording;
  if (is_of_building(part) && recording.parts[part.chunk].removed <= recording.times[step_]) return;
  StripSolid solid;
  Item item;
  item.part = &part;
  solid.outline = part.outline;
  solid.half = part.half;
  solid.pose = place(part).pose * Pose{{0, 0, part.middle}, {}};
  solid.eye = inverse(solid.pose) * scene_.camera.eye;
  solid.body = body_of(part);
  for (const double z : {-solid.half, solid.half}) {
    for (const Vec2 p : part.outline) solid.corners.push_back(solid.pose * Vec3{p.x, p.y, z});
  }
  if (!put_on_screen(solid, item)) return;
  solid.silhouette = convex_hull(item.picture);
  const bool sees_front = part.has_front && solid.eye.z > solid.half;
  const bool sees_back = part.has_back && solid.eye.z < -solid.half;
  item.cap = sees_front ? 1 : sees_back ? -1 : 0;
  bool has_side = false;
  for (std::size_t i = 0; i < part.across.size(); ++i) {
    const std::uint32_t beyond = part.across[i];
    const bool open =
        beyond == StripPart::kBorder ||
        (beyond != StripPart::kInside && places_[part.wall][beyond].track != place(part).track);
    item.open.push_back(open);
    has_side = has_side || (open && faces_eye(solid, i));
  }
  solid.is_flat = !has_side;
  solids_.push_back(std::move(solid));
  items_.push_back(std::move(item));
}

void Picture::add_ball(const RecordedProjectile& recorded) {
  const Projectile& projectile = recorded.projectile;
  if (scene_.recording.times[step_] < projectile.time) return;
  StripSolid solid;
  Item item;
  solid.half = projectile.radius;
  solid.pose = pose_at(scene_.recording, recorded.track, step_, {projectile.position, {}});
  solid.eye = inverse(solid.pose) * scene_.camera.eye;
  solid.corners = {solid.pose.position};
  solid.body = UINT32_MAX;
  if (!put_on_screen(solid, item)) return;
  const double distance = solid.distance, r = projectile.radius;
  if (distance < 1.5 * r + scene_.camera.nearest) return;
  item.radius = scene_.camera.focal * r / std::sqrt(distance * distance - r * r);
  const Vec2 centre = item.picture[0], reach{item.radius, item.radius};
  solid.screen = {centre - reach, centre + reach};
  solid.silhouette = rectangle(solid.screen.high - solid.screen.low, solid.screen.low);
  solids_.push_back(std::move(solid));
  items_.push_back(std::move(item));
}

bool Picture::faces_eye(const StripSolid& solid, std::size_t edge) const {
  const std::size_t next = edge + 1 == solid.outline.size() ? 0 : edge + 1;
  const Vec2 a = solid.outline[edge], b = solid.outline[next];
  return cross(b - a, Vec2{solid.eye.x, solid.eye.y} - a) < 0;
}

bool Picture::continues(std::uint32_t a, std::uint32_t b) const {
  return solids_[a].is_flat && solids_[b].is_flat && solids_[a].body == solids_[b].body;
}

// --- order

// Where a building's parts lie in a ring, each hiding the next, they are divided until they do not.
std::vector<std::uint32_t> Picture::find_order() {
  if (scene_.recording.parts.empty()) return painters_order(solids_);
  for (int round = 0;; ++round) {
    std::vector<std::uint32_t> cut;
    std::vector<std::uint32_t> order = painters_order(solids_, &cut);
    std::erase_if(cut, [this](std::uint32_t i) {
      const StripPart* part = items_[i].part;
      return !part || !is_of_building(*part);
    });
    if (cut.empty() || round == kMostDivisions) return order;
    divide(std::move(cut));
  }
}

void Picture::divide(std::vector<std::uint32_t> cut) {
  std::ranges::sort(cut);
  std::vector<const StripPart*> halves;
  for (const std::uint32_t i : cut) {
    for (StripPart& half : halves_of(*items_[i].part)) {
      halves.push_back(&divided_.emplace_back(std::move(half)));
    }
  }
  for (const std::uint32_t i : cut | std::views::reverse) {
    solids_.erase(solids_.begin() + i);
    items_.erase(items_.begin() + i);
  }
  for (const StripPart* half : halves) add_part(*half);
}

// --- shadows

// Points around a sphere's outline as the light sees it.
std::vector<Vec3> outline_of_sphere(Vec3 centre, double radius, Vec3 light) {
  const Vec3 side = cross(light, {0, 0, 1});
  const Vec3 a = (radius / std::max(length(side), 1e-9)) * side, b = cross(light, a);
  std::vector<Vec3> points;
  for (int k = 0; k < 24; ++k) {
    const Vec2 turn = unit_at_turns(k / 24.0);
    points.push_back(centre + turn.x * a + turn.y * b);
  }
  return points;
}

// Outline of a solid's shadow on the ground: the hull of its corners' shadows.
std::vector<Vec2> Picture::shadow_of(std::size_t i) const {
  const StripCamera& camera = scene_.camera;
  const double ground = scene_.params.ground_height;
  std::vector<Vec3> corners = solids_[i].corners;
  if (!items_[i].part) corners = outline_of_sphere(corners[0], solids_[i].half, camera.light);
  std::vector<Vec2> points;
  for (Vec3 p : corners) {
    p.y = std::max(p.y, ground);
    const Vec3 seen = camera.see(p - ((p.y - ground) / camera.light.y) * camera.light);
    if (!(seen.z > camera.nearest)) return {};
    points.push_back(camera.project(seen));
  }
  points = convex_hull(std::move(points));
  Box box{{1e300, 1e300}, {-1e300, -1e300}};
  for (const Vec2 p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return is_in_picture(box) ? points : std::vector<Vec2>();
}

// One path for all shadows of a darkness, so that they do not add up; glass takes little light.
void Picture::draw_shadows() {
  for (const bool of_glass : {true, false}) {
    bool any = false;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      const StripPart* part = items_[i].part;
      if ((part && look(*part).is_glass) != of_glass) continue;
      const std::vector<Vec2> outline = shadow_of(i);
      if (outline.empty()) continue;
      if (!any) {
        out_.text(R"x(<path fill="#1c2430" stroke="none" filter="url(#soft)" fill-opacity=")x");
        out_.text(of_glass ? ".13\" d=\"" : ".36\" d=\"");
      }
      any = true;
      out_.line(outline, true);
    }
    if (any) out_.text("\"/>\n");
  }
}

// --- solids

std::vector<Vec2> Picture::cap_of(const Item& item) const {
  const std::size_t count = item.picture.size() / 2;
  std::vector<Vec2> cap;
  for (std::size_t i = 0; i < count; ++i) {
    cap.push_back(item.picture[item.cap > 0 ? count + i : i]);
  }
  return cap;
}

void Picture::draw_sides(const StripSolid& solid, const Item& item) {
  const Look& look = this->look(*item.part);
  const std::size_t count = solid.outline.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!item.open[i] || !faces_eye(solid, i)) continue;
    const std::size_t next = i + 1 == count ? 0 : i + 1;
    const Vec2 along = solid.outline[next] - solid.outline[i];
    const double size = length(along);
    const Vec3 normal = rotate(solid.pose.rotation, {along.y / size, -along.x / size, 0});
    const bool is_border = item.part->across[i] == StripPart::kBorder;
    const StripColour colour =
        shaded(is_border ? look.outer : look.inner, normal, scene_.camera.light);
    const bool is_divided = !item.part->has_back || !item.part->has_front;
    out_.text("<path fill=\"").colour(colour);
    // No lines across the narrow sides of a standing wall.
    if (is_divided || (is_border && is_of_standing_wall(*item.part))) {
      out_.text("\" stroke=\"").colour(colour).text(closed(*item.part));
    }
    out_.text(look.is_glass ? R"(" fill-opacity=".7" d=")" : R"(" d=")");
    const Vec2 quad[] = {item.picture[i], item.picture[next], item.picture[count + next],
                         item.picture[count + i]};
    out_.line(quad, true);
    out_.text("\"/>");
    if (is_divided) draw_edges(*item.part, quad);
  }
}

// Edges of a side of a part that was divided across its length: not those where it was.
void Picture::draw_edges(const StripPart& part, std::span<const Vec2, 4> quad) {
  std::vector<Vec2> line{quad[2], quad[1], quad[0], quad[3]};
  if (part.has_front) std::ranges::rotate(line, line.begin() + 2);
  out_.text("<path fill=\"none\" d=\"");
  if (part.has_back || part.has_front) {
    out_.line(line, false);
  } else {
    out_.line(std::span(line).first(2), false);
    out_.line(std::span(line).last(2), false);
  }
  out_.text("\"/>");
}

StripColour Picture::cap_colour(std::uint32_t i) const {
  const Vec3 normal = rotate(solids_[i].pose.rotation, {0, 0, items_[i].cap > 0 ? 1.0 : -1.0});
  return shaded(look(*items_[i].part).outer, normal, scene_.camera.light);
}

std::string Picture::caps_of(std::span<const std::uint32_t> run) const {
  StripPaper paper;
  for (const std::uint32_t i : run) {
    if (items_[i].cap != 0) paper.line(cap_of(items_[i]), true);
  }
  return paper.take();
}

// Edges of the caps: open ones (cracks, borders), or those between chunks of one body. Chunks that
// share an edge both draw it: the later one has painted over half of it.
std::string Picture::lines_of(std::span<const std::uint32_t> run, bool are_open) const {
  StripPaper paper;
  std::vector<Vec2> line;
  const auto end_line = [&] {
    if (!line.empty()) paper.line(line, false);
    line.clear();
  };
  for (const std::uint32_t i : run) {
    const Item& item = items_[i];
    if (item.cap == 0) continue;
    const std::vector<Vec2> cap = cap_of(item);
    for (std::size_t e = 0; e < cap.size(); ++e) {
      if (item.part->across[e] == StripPart::kInside || item.open[e] != are_open) {
        end_line();
        continue;
      }
      if (line.empty()) line.push_back(cap[e]);
      line.push_back(cap[e + 1 == cap.size() ? 0 : e + 1]);
    }
    end_line();
  }
  return paper.take();
}

// Chunks of one body show no lines between them, unless they are of glass.
void Picture::draw_caps(std::span<const std::uint32_t> run) {
  const Item& first = items_[run[0]];
  const StripColour colour = cap_colour(run[0]);
  out_.text("<path fill=\"").colour(colour);
  const bool is_whole = run.size() == 1 && std::ranges::all_of(first.open, std::identity());
  if (!is_whole) out_.text("\" stroke=\"").colour(colour).text(closed(*first.part));
  out_.text("\" d=\"").text(caps_of(run)).text("\"/>");
  if (is_whole) return;
  const std::string open = lines_of(run, true);
  if (!open.empty()) out_.text("<path fill=\"none\" d=\"").text(open).text("\"/>");
}

// Without antialiasing: neighbours that are seen through would show a line where they meet.
void Picture::draw_glass_caps(std::span<const std::uint32_t> run) {
  const StripPart& part = *items_[run[0]].part;
  if (is_of_standing_wall(part)) {
    out_.text("<path class=\"pane\" fill=\"url(#glass").integer(part.wall).text(")");
  } else {
    out_.text("<path class=\"shard\" fill=\"").colour(cap_colour(run[0]));
  }
  out_.text("\" d=\"").text(caps_of(run)).text("\"/>");
  const auto draw = [this](std::string_view shape, const std::string& lines) {
    if (lines.empty()) return;
    out_.text("<path class=\"").text(shape).text("\" d=\"").text(lines).text("\"/>");
    out_.text("<path class=\"glint\" d=\"").text(lines).text("\"/>");
  };
  if (look(part).is_cracked) draw("crack", lines_of(run, false));
  draw("edge", lines_of(run, true));
}

// Light over the seen faces of a member's end: its joints' utilisation.
void Picture::draw_end(std::uint32_t i, int end) {
  const StripSolid& solid = solids_[i];
  const StripPart& part = *items_[i].part;
  const StressLight light = light_of(loads_[part.chunk][static_cast<std::size_t>(end)]);
  if (light.strength < kFaintest) return;
  const double tip = scene_.recording.parts[part.chunk].half_length;
  const double from = std::max(-solid.half, (end == 0 ? -tip : tip - part.end) - part.middle);
  const double to = std::min(solid.half, (end == 0 ? part.end - tip : tip) - part.middle);
  if (from >= to) return;
  out_.text("<path fill=\"").colour(light.colour).text("\" fill-opacity=\"");
  // Not the opacity of both, which makes a renderer draw each on a sheet of its own.
  out_.number(std::floor(100 * light.strength + 0.5) / 100).text("\" stroke-opacity=\"");
  out_.number(std::floor(42 * light.strength + 0.5) / 100).text("\" d=\"");
  const auto project = [&](Vec2 p, double z) {
    return scene_.camera.project(scene_.camera.see(solid.pose * Vec3{p.x, p.y, z}));
  };
  const std::size_t count = solid.outline.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (!faces_eye(solid, k)) continue;
    const Vec2 a = solid.outline[k], b = solid.outline[k + 1 == count ? 0 : k + 1];
    const Vec2 quad[] = {project(a, from), project(b, from), project(b, to), project(a, to)};
    out_.line(quad, true);
  }
  if (items_[i].cap == (end == 0 ? -1 : 1)) out_.line(cap_of(items_[i]), true);
  out_.text("\"/>");
}

void Picture::draw_ball(const Item& item) {
  const Vec2 at = item.picture[0];
  out_.text(R"x(<circle fill="url(#ball)" stroke-opacity=".5" cx=")x").number(at.x);
  out_.text("\" cy=\"").number(at.y).text("\" r=\"").number(item.radius).text("\"/>\n");
}

void Picture::draw_run(std::span<const std::uint32_t> run) {
  const Item& first = items_[run[0]];
  if (!first.part) return draw_ball(first);
  bool is_seen = false;
  for (const std::uint32_t i : run) is_seen = is_seen || is_in_picture(solids_[i].screen);
  if (!is_seen) return;
  if (run.size() == 1) draw_sides(solids_[run[0]], first);
  if (first.cap != 0) {
    if (look(*first.part).is_glass) {
      draw_glass_caps(run);
    } else {
      draw_caps(run);
    }
  }
  if (first.part->end > 0) draw_ends(run[0]);
  out_.text("\n");
}

}  // namespace

void draw_strip_picture(const StripScene& scene, std::uint32_t step, StripPaper& paper) {
  Picture(scene, step, paper).draw();
}

}  // namespace sunder
