// SPDX-License-Identifier: GPL-3.0-or-later
// The solver "hybrid": steps, breaks, removals, and what the run is told.
#include "sim/elastic_motion.hpp"

#include <algorithm>
#include <utility>

namespace sunder {
namespace {

std::vector<Bond> bonds_of(const Frame& frame) {
  std::vector<Bond> bonds;
  for (const FrameJoint& joint : frame.joints)
    bonds.push_back({joint.a, joint.b == kNoPart ? kWorld : joint.b, 1, {}, {}});
  return bonds;
}

}  // namespace

ElasticMotion::ElasticMotion(const CollapseScene& scene, RigidWorld& world,
                             const std::vector<PartSolid>& solids)
    : scene_(scene),
      frame_(scene.frame),
      world_(world),
      solids_(solids),
      graph_(scene.frame.part_count(), bonds_of(scene.frame)),
      links_(scene.frame),
      bodies_(scene, world, solids),
      touches_(scene.frame.part_count()),
      standing_(scene),
      inner_(scene, world, solids, bodies_, links_),
      places_(scene.frame.part_count()),
      offsets_(scene.frame.part_count()) {}

void ElasticMotion::settle(const Progress& progress) {
  standing_.settle(progress);
  supports_ = standing_.supports();
}

void ElasticMotion::follow(double now, double dt, bool ends_step) {
  standing_.set_time(now);
  now_ = now;
  since_step_ += dt;
  note_contacts(dt);
  standing_.forget_changes();
  inner_.forget_changes();
  if (!ends_step) return;
  const SimulationParams& simulation = scene_.simulation;
  const std::vector<std::uint32_t> changed =
      touches_.end_step(since_step_, scene_.rules.load_time, simulation.max_error);
  bool pressed = !scene_.scenario.ground_motion.times.empty();
  for (const std::uint32_t part : touches_.active())
    pressed |= !changed.empty() && bodies_.stands(part);
  if (pressed) standing_.wake();  // as it stood before this step
  press();
  inner_.follow(changed, touches_);
  if (standing_.rings()) {
    standing_.begin_step();
    limit_blows();
    standing_.end_step();
    standing_.follow_step();
    standing_.fall_quiet(since_step_);
  } else {
    ++skipped_;
  }
  move_colliders();
  since_step_ = 0;
}

// ---- joints
// --------------------------------------------------------------------------------------

JointLoad ElasticMotion::load(std::uint32_t j) const {
  return bodies_.is_loose(frame_.joints[j].a) ? inner_.load(j) : standing_.load(j);
}

bool ElasticMotion::is_live(std::uint32_t j) const {
  const std::uint32_t part = frame_.joints[j].a;
  return bodies_.is_loose(part) ? inner_.is_live(bodies_.piece_of(part))
                                : bodies_.stands(part) && standing_.is_live();
}

void ElasticMotion::break_joint(std::uint32_t j, bool bears_on) {
  const FrameJoint& joint = frame_.joints[j];
  links_.cut(j);
  broken_.push_back(j);
  if (!bears_on && joint.b != kNoPart) apart_.push_back({joint.a, joint.b});
}

FrameMotion::HingeState ElasticMotion::hinge(std::uint32_t j) const {
  const StandingFrame::Hinge* hinge = standing_.hinge(j);
  return hinge == nullptr ? HingeState{} : HingeState{hinge->flows, length(hinge->rotation)};
}

/// What has come loose bends no more.
bool ElasticMotion::yield(std::uint32_t j, Vec3 moment) {
  if (!bodies_.stands(frame_.joints[j].a) || !standing_.can_bend(j)) return false;
  yielding_.push_back({j, moment, {}, true});
  return true;
}

bool ElasticMotion::settle_hinges() {
  if (yielding_.empty()) return false;
  standing_.wake();
  standing_.set_hinges(yielding_);
  yielding_.clear();
  return true;
}

double ElasticMotion::energy() const {
  return standing_.kinetic() + standing_.strain() + potential() + world_.kinetic_energy();
}

/// With what went into plastic hinges.
double ElasticMotion::unspent() const {
  return energy() + standing_.losses().plastic;
}

double ElasticMotion::potential() const {
  double moment = 0;
  for (std::uint32_t part = 0; part < offsets_.size(); ++part)
    if (bodies_.stands(part)) moment += bodies_.mass_of(part) * offsets_[part].y;
  return standing_.potential() + scene_.simulation.gravity * moment;
}

/// What no longer hangs on the ground, of what has stood.
std::vector<SupportGraph::Island> ElasticMotion::loose_from_standing() {
  std::vector<SupportGraph::Island> islands = graph_.break_bonds(broken_).islands;
  for (SupportGraph::Island& island : islands)
    std::erase_if(island.chunks, [&](std::uint32_t part) { return !bodies_.stands(part); });
  std::erase_if(islands, [](const SupportGraph::Island& island) { return island.chunks.empty(); });
  return islands;
}

/// It moves, from where it was in the frame and as it did there. Returns its parts, and in
/// `lowered` their potential on the way that they had gone, J.
std::vector<std::uint32_t> ElasticMotion::release_loose(std::vector<SupportGraph::Island> islands,
                                                        double& lowered) {
  std::vector<std::uint32_t> released;
  for (SupportGraph::Island& island : islands) {
    BodyParams body = bodies_.body_of(island.chunks);
    take_frames_place(body, island.chunks);
    take_frames_motion(body, island.chunks);
    lowered +=
        body.mass * scene_.simulation.gravity * (body.pose * body.centroid - body.centroid).y;
    for (const std::uint32_t part : island.chunks) touches_.forget(part);
    released.insert(released.end(), island.chunks.begin(), island.chunks.end());
    bodies_.release(std::move(island.chunks), body);
  }
  return released;
}

/// The elastic state goes on with the joints gone: displacements are continuous, forces are not.
bool ElasticMotion::settle_breaks() {
  const bool bent = settle_hinges();
  if (broken_.empty()) return bent;
  std::ranges::sort(broken_);
  std::vector<std::uint32_t> of_standing, in_pieces;
  for (const std::uint32_t j : broken_) {
    const std::uint32_t part = frame_.joints[j].a;
    if (bodies_.stands(part)) of_standing.push_back(j);
    if (bodies_.is_loose(part)) in_pieces.push_back(bodies_.piece_of(part));
  }
  std::ranges::sort(in_pieces);
  in_pieces.erase(std::ranges::unique(in_pieces).begin(), in_pieces.end());
  for (const std::uint32_t piece : in_pieces) hold_back_forces(piece);
  const bool is_struck = !of_standing.empty();
  const double before = is_struck ? unspent() : world_.kinetic_energy();
  if (is_struck) standing_.wake();
  const std::size_t first_new = bodies_.pieces().size();
  std::vector<SupportGraph::Island> islands = loose_from_standing();
  const Ways ways = is_struck ? note_ways(of_standing, islands) : Ways{};
  double lowered = 0;
  const std::vector<std::uint32_t> released = release_loose(std::move(islands), lowered);
  for (const std::uint32_t piece : in_pieces) {
    auto groups = links_.components(bodies_.pieces()[piece].parts);
    if (groups.size() > 1) bodies_.split(piece, std::move(groups));
  }
  if (is_struck) {
    press();
    std::erase_if(of_standing, [&](std::uint32_t j) {
      const FrameJoint& joint = frame_.joints[j];
      return !bodies_.stands(joint.a) || (joint.b != kNoPart && !bodies_.stands(joint.b));
    });
    standing_.take_out(of_standing, released, ways.parts);
    keep_places(ways);
    standing_.carry_on();
  }
  part_bodies();
  inner_.start(first_new, in_pieces, broken_, touches_);
  fracture_ += before - (is_struck ? unspent() + lowered : world_.kinetic_energy());
  broken_.clear();
  return true;
}

/// What parted in a piece bore its strength, not more: the rest of the forces on the piece comes on
/// what is left of it as that gives way, not at once.
void ElasticMotion::hold_back_forces(std::uint32_t piece) {
  double most = 1;
  for (const std::uint32_t j : broken_)
    if (bodies_.is_loose(frame_.joints[j].a) && bodies_.piece_of(frame_.joints[j].a) == piece)
      most = std::max(most, utilisation(inner_.load(j), frame_.joints[j].strength).total);
  for (const std::uint32_t part : bodies_.pieces()[piece].parts)
    if (most > 1 && touches_[part].is_active) touches_.hold_back(part, 1 / most);
}

/// Parts that bear on each other no more.
void ElasticMotion::part_bodies() {
  for (const auto& [a, b] : apart_) {
    const BodyId of_a = bodies_.body(a), of_b = bodies_.body(b);
    if (of_a != kNoBody && of_b != kNoBody && of_a != of_b) world_.separate(of_a, of_b);
  }
  apart_.clear();
}

/// Joints of parts that what is left of their joints cannot hold, and of plates that are all that
/// is left between a part of the frame and the rest.
std::vector<std::uint32_t> ElasticMotion::unheld_joints() const {
  std::vector<std::uint32_t> joints;
  const auto add = [&](const std::vector<std::uint32_t>& parts) {
    for (const std::uint32_t part : parts)
      for (const std::uint32_t j : links_.joints_of(part))
        if (links_.intact(j)) joints.push_back(j);
  };
  add(standing_.loose_parts());
  add(inner_.unheld());
  const std::vector<std::uint32_t> bridging = standing_.bridging_joints();
  joints.insert(joints.end(), bridging.begin(), bridging.end());
  return joints;
}

/// What hangs on the ground without members that have turned too far goes on to stand, and with it
/// the plates on it; plates hold nothing.
std::vector<std::uint32_t> ElasticMotion::mechanism_joints() const {
  std::vector<std::uint32_t> joints, queue;
  const std::vector<std::uint32_t> turned = standing_.overturned();
  if (turned.empty()) return joints;
  std::vector<std::uint8_t> stays(frame_.part_count(), 0), turns(frame_.part_count(), 0);
  for (const std::uint32_t member : turned) turns[member] = 1;
  const auto reach = [&](std::uint32_t part) {
    if (turns[part] || !bodies_.stands(part)) return;
    if (!std::exchange(stays[part], 1) && part < frame_.members.size()) queue.push_back(part);
  };
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j)
    if (links_.intact(j) && frame_.joints[j].b == kNoPart) reach(frame_.joints[j].a);
  while (!queue.empty()) {
    const std::uint32_t part = queue.back();
    queue.pop_back();
    for (const std::uint32_t j : links_.joints_of(part)) {
      const FrameJoint& joint = frame_.joints[j];
      if (links_.intact(j) && joint.b != kNoPart) reach(joint.a == part ? joint.b : joint.a);
    }
  }
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    const FrameJoint& joint = frame_.joints[j];
    if (!links_.intact(j) || !bodies_.stands(joint.a)) continue;
    const bool carried = joint.b == kNoPart || stays[joint.b];
    if (carried != static_cast<bool>(stays[joint.a])) joints.push_back(j);
  }
  return joints;
}

// ---- what is taken away and added
// ----------------------------------------------------------------

/// Happens at time 0.
void ElasticMotion::rejoin(std::span<const std::uint32_t> joints) {
  if (joints.empty()) return;
  const double before = standing_.energy();
  link_again();
  standing_.rejoin();
  fracture_ += before - standing_.energy();
}

void ElasticMotion::link_again() {
  links_.list_again();
  graph_ = SupportGraph(frame_.part_count(), bonds_of(frame_));
  if (const std::vector<std::uint32_t> broken = links_.broken(); !broken.empty())
    graph_.break_bonds(broken);
}

void ElasticMotion::remove_part(std::uint32_t part) {
  const auto of_bodies = [&] {
    return world_.kinetic_energy() + world_.potential_energy() - bodies_.baseline();
  };
  const double before = of_bodies();
  bodies_.remove(part);
  given_ += of_bodies() - before;
}

BodyId ElasticMotion::give_up_shape(std::uint32_t part) {
  touches_.forget(part);
  return bodies_.give_up_shape(part);
}

/// The frame springs back where it is lighter.
void ElasticMotion::set_mass(std::uint32_t part, double mass) {
  standing_.wake();
  const double before = unspent();
  bodies_.set_mass(part, mass);
  standing_.set_plate_mass(part, mass);
  standing_.carry_on();
  fracture_ += before - unspent();
}

/// What their cracked parts had stored is gone.
void ElasticMotion::change_panels(std::span<const PanelStiffness> changed) {
  standing_.wake();
  const double before = unspent();
  standing_.change_panels(changed);
  standing_.carry_on();
  fracture_ += before - unspent();
}

/// Free pieces grow heavier too.
void ElasticMotion::add_load(double more) {
  standing_.wake();
  const double before = unspent();
  bodies_.add_live(more);
  standing_.add_live(more);
  given_ += unspent() - before;
}

// ---- what is told
// --------------------------------------------------------------------------------

bool ElasticMotion::is_moving(std::uint32_t part) const {
  return bodies_.is_loose(part) && world_.is_awake(bodies_.body(part));
}

double ElasticMotion::sag(std::uint32_t member) const {
  const std::uint32_t node = frame_.members[member].to;
  if (bodies_.stands(member)) return -standing_.displacement(node).y;
  if (!bodies_.is_loose(member)) return 0;
  const Vec3 stood = frame_.nodes[node].position;
  return stood.y - (world_.pose(bodies_.body(member)) * stood).y;
}

double ElasticMotion::unsupported() const {
  double mass = 0;
  for (std::uint32_t w = 0; w < frame_.walls.size(); ++w)
    if (frame_.walls[w].edges[0] == kNoPart) mass += solids_[frame_.wall_part(w)].mass;
  return mass * scene_.simulation.gravity;
}

MotionLosses ElasticMotion::losses() const {
  MotionLosses losses = standing_.losses();
  losses.fracture += fracture_;
  return losses;
}

SolveCounts ElasticMotion::solves() const {
  const SolveCounts standing = standing_.solves(), inner = inner_.solves();
  return {standing.full + inner.full, standing.update + inner.update, skipped_ + inner_.skipped()};
}

double ElasticMotion::residual() const {
  return std::max(standing_.residual(), inner_.residual());
}

std::unique_ptr<FrameMotion> elastic_motion(const CollapseScene& scene, RigidWorld& world,
                                            const std::vector<PartSolid>& solids) {
  return std::make_unique<ElasticMotion>(scene, world, solids);
}

}  // namespace sunder
