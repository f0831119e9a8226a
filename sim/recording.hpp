// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fracture/asset.hpp"
#include "meshing/region.hpp"
#include "sim/pose.hpp"
#include "sim/projectile.hpp"

namespace sunder {

constexpr std::uint32_t kNoTrack = 0xFFFFFFFFu;

/// Poses of a moving body at consecutive times of the recording, from `first` on; after the last
/// one it rests there. `parent` is the track whose body it came from: before `first` it moved along
/// that one (kNoTrack: it stood in its wall).
struct Track {
  std::uint32_t parent = kNoTrack;
  std::uint32_t first = 0;
  std::vector<Pose> poses;  ///< of the wall's frame as this body carries it; of a sphere's centre
};

/// Something broke.
struct BreakEvent {
  double time = 0;  ///< s
  std::uint32_t wall = 0;
  Vec3 point;              ///< of the contact, world
  double speed = 0;        ///< of approach, m/s
  double utilisation = 0;  ///< demand by capacity where it was largest
  std::uint32_t bonds_broken = 0, chunks_freed = 0;
};

/// A wall as it is after the last break: chunks that broke stand there as the parts they became,
/// from the start, so that one set of meshes serves the whole run.
struct RecordedWall {
  WallAsset asset;                   ///< asset.wall has position and rotation of the standing wall
  std::vector<std::uint32_t> track;  ///< per chunk: its last track; kNoTrack: it never moved
};

struct RecordedProjectile {
  Projectile projectile;
  std::uint32_t track =
      kNoTrack;  ///< its first pose is at projectile.time; before, it is not there
};

/// A member, slab or panel of a building: an outline in the XY plane of its own frame, extruded
/// over z = ±half_length.
struct RecordedPart {
  std::string name;
  Region outline;          ///< m
  double half_length = 0;  ///< m
  std::string material;    ///< "steel", "concrete-c30" …
  double mass = 0;         ///< kg
  Pose standing;           ///< of its frame before the track
  std::uint32_t track = kNoTrack;
  bool has_ends = false;  ///< a member: its ends show the stress of its joints
  double removed = std::numeric_limits<double>::infinity();  ///< s: taken away, not there any more
  /// Of the recording's walls: it broke and is shown by its chunks from the start.
  std::uint32_t wall = kNoTrack;
};

/// A joint between parts. `end`: 0 at z = -half_length of the part, 1 at the other end, 2 in
/// between.
struct RecordedJoint {
  std::string name;
  std::uint32_t part_a = 0, part_b = kNoTrack;  ///< kNoTrack: the ground
  std::uint8_t end_a = 2, end_b = 2;
  Vec3 point;                                               ///< where it stood, world
  double broken = std::numeric_limits<double>::infinity();  ///< s
};

/// Load of a joint at a sampling time: the one of largest utilisation since the time before. Axes
/// of the joint: x along the member, y and z those of its section (see FrameJoint).
struct JointSample {
  std::array<float, 3> force{}, torque{};  ///< N, N m
  float force_utilisation = 0, torque_utilisation = 0, utilisation = 0;
};

/// Numbers of a run at one time. Energies as in the report's ledger, J: from time 0 (for what moves:
/// from where it started), so that their sum is what has gone in.
struct RunSample {
  double time = 0;  ///< s
  double kinetic = 0, potential = 0, strain = 0, fracture = 0, friction = 0, contact = 0;
  double damping = 0, plastic = 0;  ///< of buildings
  double joint = 0;                 ///< of the solver "bullet": lost in rigid joints
  double numerical = 0;             ///< what remains: the error of the simulation
  std::uint64_t broken_joints = 0, broken_bonds = 0;
  std::uint64_t moving = 0;    ///< bodies that are not at rest
  double max_utilisation = 0;  ///< of any joint, post or bond since the sample before
};

/// Everything that moved, step by step.
struct Recording {
  std::uint64_t seed = 0;     ///< of the scene
  std::vector<double> times;  ///< of every step, s, ascending; times[0] = 0: everything stands
  std::vector<Track> tracks;
  std::vector<RecordedWall> walls;
  std::vector<RecordedProjectile> projectiles;
  std::vector<BreakEvent> events;
  std::vector<RecordedPart> parts;
  std::vector<RecordedJoint> joints;
  std::vector<double> sample_times;  ///< of joints' loads, s, ascending
  std::vector<JointSample> samples;  ///< [time][joint]; zero from the time after its break on
  std::vector<RunSample> series;     ///< every `history_step`, and at the end
};

/// Range of times in which something moves along its track and the tracks before it; for kNoTrack
/// empty.
struct TimeRange {
  std::uint32_t first = 0, end = 0;
};
TimeRange moving_range(const Recording& recording, std::uint32_t track);

/// Pose of the wall's frame (of the sphere's centre) that a track gives at times[i]; `standing` is
/// where it was before the first track.
Pose pose_at(const Recording& recording, std::uint32_t track, std::uint32_t i,
             const Pose& standing);

}  // namespace sunder
