// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/contact_solver.hpp"
#include "sim/rigid_body.hpp"

// Internal to the rigid world: its state and one step of it.
namespace sunder {

/// A contact point of the step in progress, and how its bodies come to it. `a` ranks before `b`;
/// positions are relative to `origin`, the centre of one that moves.
struct Meeting {
  RigidBody* a = nullptr;
  RigidBody* b = nullptr;
  std::uint32_t part_a = 0, part_b = 0;
  Vec3 origin;
  Vec3 point, normal;  ///< at the start of the step; the normal leads from b to a
  Touch::Owner owner = Touch::Owner::both;
  double gap = 0;
  double gap_then = 0;       ///< when the bodies are where their impulses act
  double closing = 0;        ///< normal speed towards each other at the start, m/s
  double pull = 0;           ///< by how much gravity adds to it, m/s²
  bool arrives = false;      ///< the gap closes within the step, at more than a creeping speed
  double arrival_time = 0;   ///< since the start of the step
  double arrival_speed = 0;  ///< m/s
  std::uint32_t island = 0;  ///< slot of the island's first body
};

struct RigidWorld::Impl {
  explicit Impl(const WorldParams& params);

  WorldParams world;
  Vec3 gravity;
  std::vector<std::unique_ptr<RigidBody>> bodies;  ///< by id; null: removed
  std::vector<RigidBody*> awake;                   ///< by rank
  BoxTree still_tree, awake_tree;
  std::uint32_t moving_count = 0;
  std::uint64_t hulls_built = 0;
  double last_dt = 0;

  std::vector<Contact> contacts;
  Vec3 reaction;
  StepWork work;

  // Of the step in progress.
  std::vector<Meeting> meetings;
  std::vector<SolverBody> table;
  std::vector<RigidBody*> in_table;  ///< by slot; [0] is null
  std::vector<std::uint32_t> root;   ///< of the islands' union-find, by slot
  std::vector<ContactPoint> points;  ///< one per meeting
  std::vector<PartTouch> touches;
  std::vector<std::uint32_t> found;
  TouchScratch scratch;

  RigidBody& body(BodyId id) const;
  BodyId insert(std::unique_ptr<RigidBody> body);
  void rank_last();
  void wake(RigidBody& body);  ///< appends to `awake`
  void wake_around(const RigidBody& body);
  void put_to_sleep(RigidBody& body);  ///< leaves it in `awake`
  void step(double dt);

 private:
  void begin(RigidBody& body, double dt);
  void find_meetings(double dt);
  void meet(RigidBody& one, RigidBody& other, double dt);
  void set_approach(Meeting& meeting, double dt) const;
  void set_contact_times(double dt);
  void build_table(double dt);
  void find_islands();
  std::uint32_t find_root(std::uint32_t slot);
  void build_point(Meeting& meeting, double dt);
  void recall(const Meeting& meeting, ContactPoint& point, double dt) const;
  void solve(double dt);
  void bounce(std::span<const Meeting> group, std::span<ContactPoint> of, double dt);
  void remove_overlaps(std::span<const Meeting> group, std::span<ContactPoint> of, double dt);
  void account(double dt);
  void remember();
  void advance(double dt);
  void settle(double dt);
};

}  // namespace sunder
