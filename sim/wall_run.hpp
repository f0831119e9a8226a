// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sim/blow.hpp"
#include "sim/contact_order.hpp"
#include "sim/impact.hpp"
#include "sim/recorder.hpp"
#include "sim/rigid_world.hpp"
#include "sim/wall_state.hpp"

namespace sunder {

struct SpeedProfile;

/// Distance of a point from a cell, 0 inside, m.
double distance_to_cell(const Pattern& pattern, std::uint32_t cell, Vec2 point);

/// Walls in a world: they stand, projectiles and debris meet them, they break, what comes loose
/// moves and breaks again. The state of the world is in RigidWorld (poses, velocities), what hangs
/// together in `islands_`. Time is someone else's: an impact test's, or a building's, whose panels
/// are walls that wait until something comes near them.
class WallRun {
 public:
  /// First contact of a projectile with the ground or a wall's face within a substep.
  struct Arrival {
    double time = 0;  ///< from now, s
    std::uint32_t shot = 0;
    std::uint32_t island = kNoIsland;  ///< kNoIsland: the ground
    Vec3 point, normal;                ///< world; normal points to the projectile
  };
  /// Rigid motion of a wall's frame.
  struct Motion {
    Pose pose;
    Vec3 centre, velocity, angular_velocity;  ///< velocity of the point `centre`
  };

  /// Moving or fixed bodies of the world that are nobody's here: what a building is made of.
  enum class Foreign : std::uint8_t { none, fixed, moving };
  struct Params {
    std::uint32_t waiting = 0;  ///< walls besides the scene's, numbered after them
    std::uint64_t order = 0;    ///< added to the keys of contacts
    std::function<Foreign(BodyId)> foreign = {};
    /// Told of every collider that a standing wall gets.
    std::function<void(std::uint32_t wall, BodyId body)> on_collider = {};
  };
  /// All that is given outlives it. The scene's walls stand; those that wait are nowhere until they
  /// are told to be.
  WallRun(const ImpactScene& scene, const ImpactParams& impact, RigidWorld& world,
          Recorder& recorder, ImpactResult& result, Params params);

  void stand(std::uint32_t wall, const ImpactWall& what);
  /// As one body that moves; `track` is what it moved along before.
  void set_free(std::uint32_t wall, const ImpactWall& what, const Motion& motion,
                std::uint32_t track);
  /// What still stands of it is one body, or more, from now on; `track` as above.
  void let_go(std::uint32_t wall, const Motion& motion, std::uint32_t track);
  bool is_waiting(std::uint32_t wall) const { return walls_[wall].is_waiting; }
  const WallState& wall(std::uint32_t wall) const { return walls_[wall]; }
  /// What stands of a wall: its chunks and bonds.
  const Island& standing(std::uint32_t wall) const { return islands_[wall]; }
  bool stands(std::uint32_t wall) const;
  /// The standing chunk that a collider is of.
  struct ChunkPlace {
    std::uint32_t wall = 0, chunk = 0;
  };
  std::optional<ChunkPlace> standing_chunk(BodyId body) const;
  /// Breaks bonds of what stands of a wall; the energy is that of its strain, which nobody counts.
  void break_standing(std::uint32_t wall, std::span<const std::uint32_t> bonds, double utilisation);

  // Projectiles, by the scene's number.
  void launch_due(double until);
  /// One that is in the world already.
  void follow_shot(std::uint32_t shot, BodyId body, std::uint32_t track);
  BodyId shot_body(std::uint32_t shot) const { return shots_[shot].body; }
  std::uint32_t shot_track(std::uint32_t shot) const { return shots_[shot].track; }

  /// Makes the colliders around a body that comes in.
  void raise_colliders_around(BodyId body);
  // A substep: prepare, next_arrival, the world's step, after_step, arrive.
  /// Makes the colliders that it needs; the longest substep in which nothing passes through.
  double prepare(double dt);
  std::optional<Arrival> next_arrival(double dt) const;
  void after_step(double now);
  void arrive(const Arrival& arrival);
  /// Contacts of this body in the last step are those of a wall that stands since.
  void stand_for(BodyId body, std::uint32_t wall) { own(body, {Owner::Kind::collider, wall, 0}); }

  /// Contacts of this body in the last step are those of a free wall's: it has taken its place.
  void rename(BodyId body, std::uint32_t prism, std::uint32_t wall) {
    renamed_.push_back({body, prism, islands_[wall].body});
  }

  /// Poses of what came loose, then of the projectiles that were launched here, at the end of a
  /// step.
  void record_islands();
  void record_shots();
  /// Counts what came of the walls; they as they are in the end (those that wait: empty).
  std::vector<RecordedWall> finish();
  double baseline() const { return baseline_; }
  Vec3 impulse() const { return impulse_; }

 private:
  /// What a body of the world is.
  struct Owner {
    enum class Kind : std::uint8_t { none, ground, collider, island, projectile, foreign, gone };
    Kind kind = Kind::none;
    std::uint32_t index = 0;  ///< wall (collider), island, projectile
    std::uint32_t chunk = 0;  ///< of a collider
  };
  struct Shot {
    Projectile projectile;
    BodyId body = kNoBody;
    std::uint32_t track = kNoTrack;
    std::uint32_t wall = kNoIsland;  ///< that it hit first
    double side = 0;                 ///< of that wall where it came from, ±1
  };
  /// A wall of which something stands; beside each other in memory, for what flies and falls.
  struct StandingWall {
    Vec3 low, high;
    double thickness = 0;
    std::uint32_t wall = 0;
  };
  struct NearWall {
    double gap = std::numeric_limits<double>::infinity(), thickness = 0;
  };
  /// Two things came together.
  struct Meeting {
    BodyId striker = kNoBody;
    std::uint32_t island = kNoIsland;  ///< what is struck
    Vec3 point, normal;                ///< world; normal points to the striker
    double speed = 0;                  ///< of approach
    bool solved = false;               ///< the contact solver has answered it already
    double impulse = 0;                ///< that the solver gave the striker along the normal, N s
  };
  /// How an island answers: out of its plane (a plate bends) or in it (an edge is hit).
  struct Answer {
    Blow blow;
    bool in_plane = false;
    Vec2 centre;       ///< contact in the wall's frame
    double front = 1;  ///< side of the contact, ±1 along the wall's z
    Striker striker;
  };
  struct Crack {
    std::uint32_t bond = 0;  ///< of the island
    double utilisation = 0;
  };
  /// What breaking bonds did.
  struct Freed {
    std::vector<std::uint32_t> islands;
    std::uint32_t bonds = 0, chunks = 0;
    double driven_area = 0;  ///< of the cracks that the blow drove, m²
  };

  // wall_run.cpp: set-up, outcome.
  std::vector<std::vector<std::uint32_t>> add_wall(std::uint32_t wall, bool is_free);
  void move_main(std::uint32_t wall, const Motion& motion, std::uint32_t track);
  void move_loose(std::uint32_t wall, const std::vector<std::vector<std::uint32_t>>& loose,
                  const Motion& motion, std::uint32_t track);
  void record_pose(BodyId body, std::uint32_t track, bool force);
  void watch_projectiles();
  void count_freed();
  Owner owner(BodyId body) const;
  void own(BodyId body, Owner owner);
  Pose pose_of(const Island& island) const;

  // flight.cpp: projectiles until something is in their way.
  void launch(std::uint32_t shot);
  void refuse_overlap(const Shot& shot) const;
  double distance_limit(double dt) const;
  NearWall nearest_wall(const RigidWorld::Bounds& bounds) const;
  double nearest_gap(const Shot& shot) const;
  void list_standing();
  void raise_colliders(double dt);
  void raise_colliders_near(std::uint32_t wall, Vec3 low, Vec3 high);
  void raise_collider(std::uint32_t wall, std::uint32_t chunk);
  std::optional<Arrival> arrival_at_ground(std::uint32_t shot, double dt) const;
  std::optional<Arrival> arrival_at_wall(std::uint32_t shot, std::uint32_t wall, double dt) const;
  bool is_there(const Arrival& arrival) const;
  /// A projectile bounces off something solid (kNoBody) or off a body; cracks that the blow made
  /// cost it `spent` J at least.
  void bounce(const Meeting& meeting, BodyId other, const Surface& surface, double spent = 0);
  Surface ground_surface() const;
  double least_arrival_speed() const;

  // strike.cpp: what breaks.
  void strike(const Meeting& meeting);
  Answer answer_to(const Meeting& meeting) const;
  Striker striker_of(const Meeting& meeting) const;
  double utilisation(const Answer& answer, double distance, const WallState& wall) const;
  void note_hit(const Meeting& meeting, const Answer& answer);
  std::vector<Crack> cracks(const Island& island, const Answer& answer, double footprint,
                            double budget) const;
  std::vector<std::uint32_t> chunks_near(const Island& island, Vec2 centre, double reach) const;
  bool is_in_footprint(const WallState& wall, const ChunkState& chunk, const Answer& answer,
                       double footprint) const;
  std::vector<Crack> affordable(const Island& island, std::vector<Crack> found,
                                double budget) const;
  SpiderwebParams web_of(const WallState& wall, const Answer& answer, double footprint,
                         double speed, double budget, std::uint64_t seed) const;
  void weave_web(std::uint32_t island, const Answer& answer, double footprint, double speed,
                 double budget);
  double usable_speed(const Meeting& meeting) const;
  void take_from_rebound(const Meeting& meeting, double energy);
  void go_through(Meeting meeting, const Answer& answer);
  double stick_together(const Meeting& m, const Freed& freed, double energy);
  bool hand_over(const Meeting& meeting, const Answer& answer, const Freed& freed, double mass,
                 double footprint);
  void push_island(std::uint32_t island, const SpeedProfile& profile, double speed, Vec3 along);
  void add_all_bonds(std::uint32_t island, std::vector<Crack>& broken) const;
  void meet_contacts();
  void meet(BodyId struck, BodyId striker, Vec3 normal, Meeting meeting);
  bool is_gentle(const Meeting& meeting) const;
  double restitution_of(BodyId body) const;
  void break_in_contact(const Meeting& meeting, double loss);
  void split_chunk(const Meeting& meeting, double loss);

  // islands.cpp: what hangs together, and the bodies it moves as.
  Freed break_bonds(std::uint32_t island, std::span<const Crack> cracks, std::size_t driven);
  void note_broken(std::uint32_t island, Bond bond);
  void join_again(std::uint32_t island);
  Motion motion_of(const Island& island) const;
  std::uint32_t detach(std::uint32_t from, std::span<const std::uint32_t> locals,
                       const Motion& motion);
  std::vector<Bond> intact_bonds(const Island& island, std::span<const std::uint32_t> locals) const;
  void keep_rest(std::uint32_t island, const Motion& motion);
  std::uint32_t free_island(std::uint32_t wall, std::vector<std::uint32_t> members,
                            std::span<const Bond> bonds);
  void add_body_of(std::uint32_t island, const Motion& motion);
  void lower_collider(std::uint32_t wall, std::uint32_t chunk);

  const ImpactScene& scene_;
  const ImpactParams& params_;
  const Params host_;
  RigidWorld& world_;
  Recorder& recorder_;
  ImpactResult& result_;
  std::vector<WallState> walls_;
  std::vector<Island> islands_;  ///< the first ones are the walls'
  std::vector<Shot> shots_;
  std::vector<Owner> owners_;           ///< by BodyId
  std::vector<std::uint32_t> live_;     ///< islands with a body
  std::vector<StandingWall> standing_;  ///< when the substep began
  double now_ = 0;
  double least_thickness_;    ///< of all walls, m
  std::uint64_t serial_ = 0;  ///< of bodies, for their order
  double baseline_ = 0;       ///< potential energy of all bodies where they started, J
  Vec3 impulse_;              ///< that walls gave beside the world's contacts, N s
  double unspent_ = 0;        ///< energy that contacts took in the last substep, J, less cracks'
  struct Renamed {
    BodyId old = kNoBody;
    std::uint32_t prism = 0;
    BodyId now = kNoBody;
  };
  std::vector<Renamed> renamed_;      ///< since the last step
  std::vector<std::uint32_t> woven_;  ///< chunks inside the damage polygon of the hit at hand
};

}  // namespace sunder
