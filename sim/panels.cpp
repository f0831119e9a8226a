// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fracture/recover.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "sim/divided_members.hpp"
#include "sim/part_pose.hpp"

namespace sunder {
namespace {

/// Keys of contacts of walls, above those of the building's parts.
constexpr std::uint64_t kWallOrder = std::uint64_t{1} << 58;
/// What the frame carries of a panel of which nothing is left, kg.
constexpr double kLeastMass = 1e-3;
/// Panels are alike whose measures differ by less, m.
constexpr double kAlike = 1e-9;
/// Patterns of panels that are alike otherwise.
constexpr std::uint64_t kVariants = 4;
/// Slower contacts break nothing, m/s.
constexpr double kLeastSpeed = 0.5;

/// What the network of its chunks needs of a material.
bool has_strengths(const Material& m) {
  return m.youngs_modulus > 0 && m.tensile_strength > 0 &&
         m.compressive_strength >= m.tensile_strength;
}

}  // namespace

Panels::Panels(const CollapseScene& scene, bool skip, Host host)
    : scene_(scene),
      host_(std::move(host)),
      impact_{scene.seed, {}, scene.projectiles, scene.simulation},
      params_{skip, {}},
      panels_(panels_of(scene.frame, host_.solids)),
      panel_of_part_(scene.frame.part_count(), kNoPart),
      walls_(impact_, params_, host_.world, host_.recorder, result_, wall_params()) {
  for (std::uint32_t w = 0; w < panels_.size(); ++w) {
    panel_of_part_[panels_[w].part] = w;
    check_size(panels_[w]);
    place_corners(panels_[w]);
  }
}

/// Of a file; null: it is made by its pattern.
const WallAsset* Panels::given_asset(const Panel& panel) const {
  if (panel.pattern >= scene_.assets.size() || !scene_.assets[panel.pattern]) return nullptr;
  return &*scene_.assets[panel.pattern];
}

/// A wall from a file fits into its place.
void Panels::check_size(const Panel& panel) const {
  const WallAsset* given = given_asset(panel);
  if (!given) return;
  const PartSolid& solid = host_.solids[panel.part];
  const Box box = bounding_box(solid.outline.outline);
  Box cells{{1e300, 1e300}, {-1e300, -1e300}};
  for (const Vec2 p : given->pattern.vertices) {
    cells.low = {std::min(cells.low.x, p.x), std::min(cells.low.y, p.y)};
    cells.high = {std::max(cells.high.x, p.x), std::max(cells.high.y, p.y)};
  }
  const Vec2 size = cells.high - cells.low, place = box.high - box.low;
  const double thickness = 2 * solid.half_length;
  const auto text = [](Vec2 v, double z) {
    return std::to_string(v.x) + " × " + std::to_string(v.y) + " × " + std::to_string(z) + " m";
  };
  if (length(size - place) <= kJointGap && std::abs(given->wall.thickness - thickness) <= kJointGap)
    return;
  throw Error(ErrorCode::input, scene_.frame.patterns[panel.pattern].asset + ": is " +
                                    text(size, given->wall.thickness) + ", \"" +
                                    scene_.frame.part_name(panel.part) + "\" is " +
                                    text(place, thickness) + "; fracture a wall of that size");
}

WallRun::Params Panels::wall_params() {
  return {.waiting = static_cast<std::uint32_t>(panels_.size()),
          .order = kWallOrder,
          .foreign = [this](BodyId body) { return foreign(body); },
          .on_collider = [this](std::uint32_t w,
                                BodyId body) { host_.motion.take_shape(panels_[w].part, body); }};
}

std::vector<Panels::Panel> Panels::panels_of(const Frame& frame,
                                             const std::vector<PartSolid>& solids) {
  std::vector<Panel> panels;
  const auto add = [&](std::uint32_t part, std::uint32_t pattern) {
    if (pattern == kNoPart) return;
    const Box box = bounding_box(solids[part].outline.outline);
    const Vec3 low{box.low.x, box.low.y, -solids[part].half_length};
    const Vec3 high{box.high.x, box.high.y, solids[part].half_length};
    const RigidWorld::Bounds bounds = bounds_of(pose_of(solids[part]), low, high);
    Panel panel{
        .part = part, .pattern = pattern, .number = part, .low = bounds.low, .high = bounds.high};
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (frame.joints[j].a == part) panel.joints.push_back(j);
    panels.push_back(std::move(panel));
  };
  for (std::uint32_t s = 0; s < frame.slabs.size(); ++s)
    add(frame.slab_part(s), frame.slabs[s].pattern);
  for (std::uint32_t w = 0; w < frame.walls.size(); ++w)
    add(frame.wall_part(w), frame.walls[w].pattern);
  return panels;
}

/// A building's own bodies, beside those that stand for walls.
WallRun::Foreign Panels::foreign(BodyId body) const {
  const std::uint32_t part = host_.motion.part_of(body, 0);
  if (part == kNoPart) return WallRun::Foreign::none;
  return host_.motion.stands(part) ? WallRun::Foreign::fixed : WallRun::Foreign::moving;
}

/// Of a part's frame: where the wall's frame begins.
Vec3 Panels::origin_of(const Panel& panel) const {
  const Box box = bounding_box(host_.solids[panel.part].outline.outline);
  return {box.low.x, box.low.y, 0};
}

const Material& Panels::material_of(const Panel& panel) const {
  const Frame& frame = scene_.frame;
  const bool is_slab = panel.part < frame.wall_part(0);
  return frame.materials[is_slab ? frame.slabs[panel.part - frame.slab_part(0)].material
                                 : frame.walls[panel.part - frame.wall_part(0)].material];
}

/// The wall's frame where the part stood.
Pose Panels::standing_of(const Panel& panel) const {
  const Pose pose = pose_of(host_.solids[panel.part]);
  return {pose * origin_of(panel), pose.rotation};
}

/// The nodes that it hangs in: lower left, lower right, upper right, upper left in its frame.
void Panels::place_corners(Panel& panel) const {
  const Frame& frame = scene_.frame;
  const bool is_slab = panel.part < frame.wall_part(0);
  const auto& nodes = is_slab ? frame.slabs[panel.part - frame.slab_part(0)].nodes
                              : frame.walls[panel.part - frame.wall_part(0)].nodes;
  const Pose to_wall = inverse(standing_of(panel));
  panel.to_wall = to_wall.rotation;
  const Box box = bounding_box(host_.solids[panel.part].outline.outline);
  const Vec2 middle = 0.5 * (box.high - box.low);
  for (const std::uint32_t node : nodes) {
    Vec3 p = to_wall * frame.nodes[node].position;
    p.z = 0;  // without the arm to the beams' axes: its forces would twist them
    const std::size_t corner = p.y < middle.y ? (p.x < middle.x ? 0 : 1) : (p.x < middle.x ? 3 : 2);
    panel.nodes[corner] = node;
    panel.hold.corners[corner] = p;
  }
  panel.hold.hinged = {true, true, true, true};
  panel.hold.is_straight = true;
}

/// From where they were at time 0.
PanelFreedoms Panels::corners_of(const Panel& panel) const {
  const Twelve moved = host_.motion.panel_motion(panel.part).value_or(Twelve{});
  PanelFreedoms result{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 u = rotate(panel.to_wall, {moved[3 * i], moved[3 * i + 1], moved[3 * i + 2]});
    std::ranges::copy(std::array{u.x, u.y, u.z}, result.begin() + 6 * i);
  }
  return result;
}

Vec3 Panels::gravity_in(const Pose& pose) const {
  return rotate(conjugate(pose.rotation), {0, -impact_.simulation.gravity, 0});
}

void Panels::make_room(std::uint32_t first, std::uint32_t count) {
  panel_of_part_.insert(panel_of_part_.begin() + first, count, kNoPart);
  for (Panel& panel : panels_) {
    panel.part = moved_up(panel.part, first, count);
    for (std::uint32_t j = 0; j < scene_.frame.joints.size(); ++j)
      if (scene_.frame.joints[j].a == panel.part && host_.is_intact(j) &&
          std::ranges::find(panel.joints, j) == panel.joints.end())
        panel.joints.push_back(j);
  }
}

void Panels::start() {
  // With `diaphragms` slabs have a stiffness in their plane already.
  const std::uint32_t first = scene_.simulation.diaphragms ? scene_.frame.wall_part(0) : 0;
  std::vector<PanelElement> elements;
  for (std::uint32_t w = 0; w < panels_.size(); ++w) {
    Panel& panel = panels_[w];
    if (!has_strengths(material_of(panel))) continue;
    Shape& shape = shape_of(w);
    panel.used = shape.at_rest;
    if (!shape.network || panel.part < first) continue;
    elements.push_back(
        {panel.part, panel.nodes, stiffness_of(*shape.network, standing_of(panel).rotation), {}});
  }
  host_.motion.set_panels(std::move(elements));
  for (std::uint32_t w = 0; w < panels_.size(); ++w) {
    if (params_.skip && panels_[w].used <= 1) continue;  // what its weight breaks does at once
    made(w);
    make_stress(w);
  }
}

/// So that a facade does not show one and the same pattern everywhere.
std::uint64_t Panels::variant_of(const Panel& panel) const {
  return random_bits(scene_.seed, panel.number, 0) % kVariants;
}

bool Panels::are_alike(const Panel& a, const Panel& b) const {
  const auto near = [](double x, double y) { return std::abs(x - y) < kAlike; };
  const PartSolid &p = host_.solids[a.part], &q = host_.solids[b.part];
  const auto& line = p.outline.outline;
  const auto& other = q.outline.outline;
  if (a.pattern != b.pattern || variant_of(a) != variant_of(b) || given_asset(a) != nullptr ||
      &material_of(a) != &material_of(b) || anchors_of(a) != anchors_of(b) ||
      line.size() != other.size() || !p.outline.openings.empty() || !q.outline.openings.empty() ||
      !near(p.half_length, q.half_length) || !near(p.mass / q.mass, 1))
    return false;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (!(length(line[i] - other[i]) < kAlike)) return false;
  for (std::size_t i = 0; i < 4; ++i)
    if (!(length(a.hold.corners[i] - b.hold.corners[i]) < kAlike)) return false;
  return length(gravity_in(standing_of(a)) - gravity_in(standing_of(b))) < kAlike;
}

Panels::Shape& Panels::shape_of(std::uint32_t w) {
  Panel& panel = panels_[w];
  if (panel.shape != kNoPart) return shapes_[panel.shape];
  for (panel.shape = 0; panel.shape < shapes_.size(); ++panel.shape)
    if (are_alike(panel, panels_[shapes_[panel.shape].first])) return shapes_[panel.shape];
  Shape shape{w, wall_of(panel)};
  const bool is_web = std::holds_alternative<SpiderwebParams>(shape.made.asset.wall.pattern);
  if (has_strengths(material_of(panel)) && !is_web) {
    shape.network.emplace(shape.made.asset, shape.made.material, panel.hold);
    shape.sense.emplace(*shape.network, panel.hold.corners);
    shape.network->set_gravity(gravity_in(standing_of(panel)));
    shape.at_rest = shape.network->highest({});
  }
  shapes_.push_back(std::move(shape));
  return shapes_.back();
}

/// Chunks of a panel; panels that are alike have one of a few patterns.
const ImpactWall& Panels::made(std::uint32_t w) {
  Panel& panel = panels_[w];
  if (panel.made) return *panel.made;
  panel.made = shape_of(w).made;
  if (shapes_[panel.shape].first == w) return *panel.made;
  Wall& wall = panel.made->asset.wall;
  const Pose pose = pose_of(host_.solids[panel.part]);
  const Wall& first = shapes_[panel.shape].made.asset.wall;
  const Pose of_first = pose_of(host_.solids[panels_[shapes_[panel.shape].first].part]);
  wall.name = scene_.frame.part_name(panel.part);
  wall.position = pose * (inverse(of_first) * first.position);
  wall.rotation = pose.rotation;
  return *panel.made;
}

/// Chunks weigh together what the part does.
ImpactWall Panels::wall_of(const Panel& panel) const {
  const Frame& frame = scene_.frame;
  const PartSolid& solid = host_.solids[panel.part];
  ImpactWall result;
  result.material = material_of(panel);
  const PanelPattern& pattern = frame.patterns[panel.pattern];
  Wall wall;
  wall.name = frame.part_name(panel.part);
  wall.region = solid.outline;
  wall.thickness = 2 * solid.half_length;
  wall.material = solid.material;
  wall.pattern = pattern.pattern;
  wall.min_cell = pattern.min_cell;
  wall.anchors = anchors_of(panel);
  const Pose pose = pose_of(solid);
  wall.position = pose.position;
  wall.rotation = pose.rotation;
  if (const WallAsset* given = given_asset(panel)) {
    result.asset = *given;
    result.asset.wall.name = wall.name;
    result.asset.wall.position = pose * origin_of(panel);
    result.asset.wall.rotation = pose.rotation;
  } else {
    const WallAsset made =
        fracture_wall(wall, result.material.density, {.seed = scene_.seed, .threads = 1});
    result.asset = at_file_precision(made);
  }
  double volume = 0;
  for (const MassProperties& chunk : result.asset.chunks) volume += chunk.volume;
  result.material.density = result.asset.density = solid.mass / volume;
  return result;
}

/// Sides with something to hang on; walls of the ground floor stand on it.
std::vector<std::string> Panels::anchors_of(const Panel& panel) const {
  const Frame& frame = scene_.frame;
  if (panel.part < frame.wall_part(0)) return {"bottom", "left", "right", "top"};
  constexpr const char* kSides[] = {"bottom", "right", "top", "left"};
  std::vector<std::string> anchors;
  const FrameWall& wall = frame.walls[panel.part - frame.wall_part(0)];
  for (std::size_t i = 0; i < 4; ++i)
    if (i == 0 || wall.edges[i] != kNoPart) anchors.emplace_back(kSides[i]);
  return anchors;
}

/// Panels that stand as one piece near a projectile become walls of chunks.
double Panels::prepare(double dt) {
  for (std::uint32_t s = 0; s < impact_.projectiles.size(); ++s) {
    const BodyId body = walls_.shot_body(s);
    if (body == kNoBody || !host_.world.is_awake(body)) continue;
    RigidWorld::Bounds bounds = host_.world.bounds(body);
    const double way = (length(host_.world.velocity(body)) + impact_.simulation.gravity * dt) * dt +
                       impact_.projectiles[s].radius;
    bounds.low = bounds.low - Vec3{way, way, way};
    bounds.high = bounds.high + Vec3{way, way, way};
    for (std::uint32_t w = 0; w < panels_.size(); ++w)
      if (walls_.is_waiting(w) && is_near(panels_[w], bounds) &&
          host_.motion.stands(panels_[w].part))
        stand_up(w);
  }
  return walls_.prepare(dt);
}

bool Panels::is_near(const Panel& panel, const RigidWorld::Bounds& bounds) const {
  return bounds.low.x <= panel.high.x && bounds.low.y <= panel.high.y &&
         bounds.low.z <= panel.high.z && bounds.high.x >= panel.low.x &&
         bounds.high.y >= panel.low.y && bounds.high.z >= panel.low.z;
}

void Panels::stand_up(std::uint32_t w) {
  Panel& panel = panels_[w];
  panel.stands = any_awake_ = true;
  const BodyId old = host_.motion.give_up_shape(panel.part);
  walls_.stand(w, made(w));
  walls_.stand_for(old, w);
  panel.present = present(w);
  // Of a file whose chunks do not all hang on the frame: the network has other bonds.
  if (walls_.standing(w).chunks.size() != made(w).asset.chunks.size()) panel.stress.reset();
  if (!panel.stress) make_stress(w);
}

/// Of a panel whose chunks all hang on the frame, of a material with strengths. Webs have no bonds
/// before they are hit.
void Panels::make_stress(std::uint32_t w) {
  Panel& panel = panels_[w];
  if (!has_strengths(material_of(panel))) return;
  const WallAsset& asset = made(w).asset;
  if (std::holds_alternative<SpiderwebParams>(asset.wall.pattern)) return;
  if (panel.stands && walls_.standing(w).chunks.size() != asset.chunks.size()) return;
  panel.stress.emplace(asset, panel.made->material, panel.hold, gravity_in(standing_of(panel)));
}

std::uint32_t Panels::present(std::uint32_t w) const {
  if (!walls_.stands(w)) return 0;
  const Island& island = walls_.standing(w);
  return island.graph ? island.graph->present_count() : 1;
}

/// A panel that has lost its hold: a body of the chunks that are left, as the part moves.
void Panels::come_loose(std::uint32_t w, BodyId struck, std::uint32_t prism) {
  Panel& panel = panels_[w];
  host_.break_off(panel.part);
  const double kinetic = host_.world.kinetic_energy(), potential = host_.world.potential_energy();
  const FrameMotion::Leaving leaves = host_.motion.release(panel.part);
  const Pose to_wall{origin_of(panel), {}};
  const WallRun::Motion motion{leaves.pose * to_wall, leaves.centre, leaves.velocity,
                               leaves.angular_velocity};
  const std::uint32_t track = host_.track_of(panel.part);
  if (panel.stands) {
    walls_.let_go(w, motion, track);
  } else {
    walls_.set_free(w, made(w), motion, track);
    if (struck != kNoBody) walls_.rename(struck, prism, w);
  }
  panel.stands = false;
  panel.stress.reset();
  // What is left of the panel is not where the middle of the whole was.
  shift_ += host_.world.potential_energy() - potential;
  result_.energy.contact -= host_.world.kinetic_energy() - kinetic;
}

/// Whether a contact had the energy to crack the panel across its thickness.
bool Panels::is_hard(const Contact& contact, const Panel& panel) const {
  if (contact.approach < kLeastSpeed) return false;
  const double thickness = 2 * host_.solids[panel.part].half_length;
  return 0.5 * contact.impulse * contact.approach >
         material_of(panel).fracture_energy * thickness * thickness;
}

/// Panels in one piece that something hit. Once one of a loose piece has left it, the world knows
/// the others by other bodies.
void Panels::meet_contacts() {
  struct Hit {
    std::uint32_t wall = 0, prism = 0;
    BodyId body = kNoBody;
  };
  std::vector<Hit> hits;
  for (const Contact& contact : host_.world.contacts()) {
    if (contact.approach < kLeastSpeed) continue;
    for (const auto& [body, prism] :
         {std::pair{contact.a, contact.part_a}, std::pair{contact.b, contact.part_b}}) {
      const std::uint32_t part = host_.motion.part_of(body, prism);
      if (part == kNoPart || panel_of_part_[part] == kNoPart) continue;
      const std::uint32_t w = panel_of_part_[part];
      if (walls_.is_waiting(w) && is_hard(contact, panels_[w])) hits.push_back({w, prism, body});
    }
  }
  for (const Hit& hit : hits) {
    if (!walls_.is_waiting(hit.wall)) continue;
    if (host_.motion.stands(panels_[hit.wall].part)) {
      stand_up(hit.wall);
    } else {
      come_loose(hit.wall, hit.body, hit.prism);
    }
  }
}

/// Impulses on standing chunks, in the frame of their wall.
void Panels::note_touches(double dt) {
  for (const Contact& contact : host_.world.contacts()) {
    const Vec3 on_a = contact.impulse * contact.normal + contact.tangential;
    for (const auto& [body, impulse] :
         {std::pair{contact.a, on_a}, std::pair{contact.b, -1.0 * on_a}}) {
      const auto at = walls_.standing_chunk(body);
      if (!at || !panels_[at->wall].stress) continue;
      const Pose back = inverse(walls_.wall(at->wall).standing);
      panels_[at->wall].stress->touch(at->chunk, back * contact.point,
                                      rotate(back.rotation, impulse));
    }
  }
  for (const RestingLoad& load : host_.world.resting()) {
    const auto at = walls_.standing_chunk(load.on);
    if (!at || !panels_[at->wall].stress) continue;
    const Pose back = inverse(walls_.wall(at->wall).standing);
    panels_[at->wall].stress->touch(at->chunk, back * load.point,
                                    rotate(back.rotation, dt * load.force));
  }
  for (Panel& panel : panels_)
    if (panel.stress && panel.stands)
      panel.stress->end_step(dt, scene_.rules.load_time, impact_.simulation.max_error);
}

/// Bound of what a motion of the corners adds to the utilisation of a panel in one piece.
double Panels::added_use(const Panel& panel, const PanelFreedoms& corners,
                         const PanelFreedoms& before) const {
  PanelFreedoms moved = corners;
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] -= before[i];
  return shapes_[panel.shape].sense->added(moved);
}

/// Whether the frame has moved so that the panel is over its strength somewhere.
bool Panels::may_crack(std::uint32_t w) {
  Panel& panel = panels_[w];
  if (panel.shape == kNoPart) return false;
  Shape& shape = shapes_[panel.shape];
  if (!shape.network) return false;
  const PanelFreedoms corners = corners_of(panel);
  if (panel.used + added_use(panel, corners, panel.seen) <= 1) return false;
  panel.seen = corners;
  panel.used = shape.network->highest(corners);
  ++solves_;
  return panel.used > 1;
}

bool Panels::crack() {
  for (std::uint32_t w = 0; w < panels_.size(); ++w) {
    Panel& panel = panels_[w];
    if (!host_.motion.stands(panel.part)) continue;
    if (walls_.is_waiting(w) && !panel.stress && host_.motion.any_live() && may_crack(w))
      make_stress(w);
    if (!panel.stress) continue;
    if (panel.stands) panel.stress->follow(walls_.standing(w));
    settle(w);
    if (!panel.stress || !host_.motion.panel_motion(panel.part)) continue;
    if (const auto now = panel.stress->softened(standing_of(panel).rotation))
      softer_.push_back({panel.part, *now});
  }
  if (softer_.empty()) return false;
  host_.motion.change_panels(softer_);
  softer_.clear();
  return true;
}

/// Whether nothing has changed that could crack it. What is whole is judged by the bound alone, as
/// what is not meshed yet.
bool Panels::is_settled(const Panel& panel, const PanelFreedoms& corners) const {
  const PanelStress& stress = *panel.stress;
  if (stress.is_whole())
    return stress.utilisation() + added_use(panel, corners, stress.settled()) <= 1;
  return !stress.is_stale(corners, impact_.simulation.max_error);
}

void Panels::settle(std::uint32_t w) {
  Panel& panel = panels_[w];
  const PanelFreedoms corners = corners_of(panel);
  if ((params_.skip || panel.stands) && is_settled(panel, corners)) {
    ++solves_skipped_;
    return;
  }
  ++solves_;
  const std::vector<BrokenBond> broken = panel.stress->settle(corners);
  if (!broken.empty() && !panel.stands) stand_up(w);
  if (!broken.empty() && panel.stress) break_bonds(w, broken);
}

void Panels::break_bonds(std::uint32_t w, std::span<const BrokenBond> broken) {
  std::vector<std::uint32_t> bonds;
  for (const BrokenBond& bond : broken) bonds.push_back(bond.bond);
  walls_.break_standing(w, bonds, broken.front().utilisation);
}

void Panels::after_step(double now, double dt) {
  meet_contacts();
  note_touches(dt);
  walls_.after_step(now);
}

void Panels::follow_frame() {
  const std::size_t broken = host_.broken_joints();
  const bool any_broken = std::exchange(joints_followed_, broken) != broken;
  for (std::uint32_t w = 0; w < panels_.size(); ++w) {
    Panel& panel = panels_[w];
    if (any_broken && walls_.is_waiting(w) && has_lost_joint(panel) &&
        host_.motion.stands(panel.part))
      stand_up(w);  // its chunks there hang on nothing
    if (!panel.stands) continue;
    if (host_.motion.stands(panel.part)) {
      cut_anchors(w);
      if (const std::uint32_t now = present(w); now != panel.present) {
        panel.present = now;
        host_.motion.set_mass(panel.part, std::max(standing_mass(w), kLeastMass));
      }
    }
    if (!host_.motion.stands(panel.part) || panel.present == 0) come_loose(w, kNoBody);
  }
}

bool Panels::has_lost_joint(const Panel& panel) const {
  return !std::ranges::all_of(panel.joints, host_.is_intact);
}

/// Of the panel's bounding box: 0 bottom, 1 right, 2 top, 3 left.
std::size_t Panels::side_near(const Panel& panel, Vec2 p) const {
  const Box box = bounding_box(host_.solids[panel.part].outline.outline);
  const Vec2 size = box.high - box.low;
  const std::array<double, 4> away{p.y, size.x - p.x, size.y - p.y, p.x};
  return static_cast<std::size_t>(std::ranges::min_element(away) - away.begin());
}

/// Where the panel's joint with what carried it is broken, its chunks hang on nothing.
void Panels::cut_anchors(std::uint32_t w) {
  Panel& panel = panels_[w];
  const Pose to_wall = inverse(walls_.wall(w).standing);
  std::array<bool, 4> lost{};
  bool any = false;
  for (const std::uint32_t j : panel.joints) {
    if (host_.is_intact(j)) continue;
    const Vec3 at = to_wall * scene_.frame.joints[j].point;
    any = lost[side_near(panel, {at.x, at.y})] = true;
  }
  if (!any) return;
  std::erase_if(panel.joints, [&](std::uint32_t j) { return !host_.is_intact(j); });
  const Island& island = walls_.standing(w);
  std::vector<std::uint32_t> anchors;
  for (std::uint32_t b = 0; island.graph && b < island.bonds.size(); ++b) {
    const Bond& bond = island.bonds[b];
    if (bond.b == kWorld && island.graph->is_intact(b) &&
        lost[side_near(panel, {bond.centroid.x, bond.centroid.y})])
      anchors.push_back(b);
  }
  if (!anchors.empty()) walls_.break_standing(w, anchors, 1);
}

double Panels::standing_mass(std::uint32_t w) const {
  const Island& island = walls_.standing(w);
  double mass = 0;
  for (std::uint32_t local = 0; local < island.chunks.size(); ++local)
    if (!island.graph || island.graph->is_present(local))
      mass += walls_.wall(w).chunks[island.chunks[local]].mass.volume;
  return mass * walls_.wall(w).material.density;
}

ImpactResult Panels::finish(Recording& recording) {
  std::vector<RecordedWall> walls = walls_.finish();
  std::vector<std::uint32_t> place(panels_.size(), kNoTrack);
  for (std::uint32_t w = 0; w < panels_.size(); ++w) {
    const Panel& panel = panels_[w];
    if (walls_.is_waiting(w)) continue;
    RecordedPart& part = recording.parts[panel.part];
    part.wall = place[w] = static_cast<std::uint32_t>(recording.walls.size());
    part.name += "_whole";
    part.removed = 0;
    recording.walls.push_back(std::move(walls[w]));
    if (part.track == kNoTrack) continue;
    // From the part's frame to the wall's.
    for (Pose& pose : recording.tracks[part.track].poses) pose = pose * Pose{origin_of(panel), {}};
  }
  for (BreakEvent& event : recording.events) event.wall = place[event.wall];
  return std::move(result_);
}

}  // namespace sunder
