// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "fracture/asset.hpp"
#include "meshing/random.hpp"
#include "meshing/trig.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// What a sample recording plays.
struct SamplePlay {
  std::uint32_t steps = 240;
  double step = 1.0 / 120;  ///< s
  Vec2 hit{3, 1.5};         ///< on the first wall
  double radius = 1.1;      ///< chunks nearer than this fly off, m
  double speed = 10;        ///< of the ball, along the wall's -z, m/s
  double start = 2;         ///< its distance at time 0, m
  std::uint64_t seed = 1;
};

inline Quaternion turned(Vec3 axis, double turns) {
  const Vec2 half = unit_at_turns(0.5 * turns);
  const double size = std::max(length(axis), 1e-9);
  return {half.y * axis.x / size, half.y * axis.y / size, half.y * axis.z / size, half.x};
}

/// A chunk's flight: a parabola with spin until its centroid is low, then rest.
class SampleFlight {
 public:
  SampleFlight(const WallAsset& wall, std::uint32_t chunk, const SamplePlay& play) {
    const Pose standing{wall.wall.position, wall.wall.rotation};
    centroid_ = wall.chunks[chunk].centroid;
    start_ = standing * centroid_;
    rotation_ = standing.rotation;
    const Vec2 out = Vec2{centroid_.x, centroid_.y} - play.hit;
    const double near = std::max(0.0, 1 - length(out) / play.radius);
    const auto noise = [&](std::uint32_t k) { return random_unit(play.seed, chunk, k) - 0.5; };
    velocity_ = rotate(rotation_, {1.6 * out.x + noise(0), 1.2 * out.y + 1.5 * near + noise(1),
                                   -play.speed * (0.06 + 0.5 * near) * (1 + noise(2))});
    axis_ = {noise(3), noise(4), noise(5)};
    spin_ = 2.4 * near * noise(6) + 0.7 * noise(7);
    rest_ = 0.5 * wall.wall.thickness;
  }
  Pose at(double t) const {
    Vec3 centre = position(std::min(t, landing()));
    const Quaternion q = turned(axis_, spin_ * std::min(t, landing())) * rotation_;
    return {centre - rotate(q, centroid_), q};
  }
  double landing() const {
    const double drop = start_.y - rest_, up = velocity_.y;
    return drop <= 0 ? 0.02 : (up + std::sqrt(up * up + 2 * 9.81 * drop)) / 9.81;
  }

 private:
  Vec3 position(double t) const { return start_ + t * velocity_ + Vec3{0, -4.905 * t * t, 0}; }
  Vec3 centroid_, start_, velocity_, axis_;
  Quaternion rotation_;
  double spin_ = 0, rest_ = 0;
};

/// A ball goes through the first wall and chunks around the hit fly off: the inner ones each on
/// its own, the outer ones for a while in pairs. Not physics: a recording of known motion.
inline Recording sample_recording(std::vector<WallAsset> walls, const SamplePlay& play = {}) {
  Recording result;
  for (std::uint32_t i = 0; i < play.steps; ++i) result.times.push_back(i * play.step);
  const auto last = static_cast<std::uint32_t>(result.times.size()) - 1;
  const auto poses = [&](const SampleFlight& flight, std::uint32_t first, std::uint32_t end,
                         double begin) {
    std::vector<Pose> list;
    for (std::uint32_t i = first; i < end; ++i) list.push_back(flight.at(result.times[i] - begin));
    return list;
  };
  const WallAsset& wall = walls[0];
  const double radius = 0.25;
  const double hit = (play.start - radius - 0.5 * wall.wall.thickness) / play.speed;
  const auto begin = std::min(last, static_cast<std::uint32_t>(hit / play.step) + 1);
  std::vector<std::uint32_t> track(wall.chunks.size(), kNoTrack);
  std::uint32_t pair = kNoTrack, leader = 0;
  for (std::uint32_t c = 0; c < wall.chunks.size(); ++c) {
    const Vec3 at = wall.chunks[c].centroid;
    const double distance = length(Vec2{at.x, at.y} - play.hit);
    if (distance >= play.radius) continue;
    const double delay = 0.15 * distance / play.radius;
    const std::uint32_t first =
        std::min(last, begin + static_cast<std::uint32_t>(delay / play.step));
    if (distance < 0.6 * play.radius) {
      const SampleFlight flight(wall, c, play);
      const double time = result.times[first] - play.step;
      const auto end =
          std::min(last, first + static_cast<std::uint32_t>(flight.landing() / play.step));
      track[c] = static_cast<std::uint32_t>(result.tracks.size());
      result.tracks.push_back({kNoTrack, first, poses(flight, first, end + 1, time)});
      continue;
    }
    if (pair == kNoTrack) {
      leader = c;
      const SampleFlight flight(wall, c, play);
      pair = static_cast<std::uint32_t>(result.tracks.size());
      const std::uint32_t end = std::min(last + 1, first + 24);
      result.tracks.push_back(
          {kNoTrack, first, poses(flight, first, end, result.times[first] - play.step)});
      track[c] = pair;
      continue;
    }
    // The second of the pair goes on alone where the two part; so does the first.
    const Track parent = result.tracks[pair];
    const std::uint32_t parting = parent.first + static_cast<std::uint32_t>(parent.poses.size());
    for (const std::uint32_t chunk : {leader, c}) {
      if (parting > last) {
        track[chunk] = pair;
        continue;
      }
      const SampleFlight flight(wall, leader, play);
      Track child{pair, parting,
                  poses(flight, parting, last + 1, result.times[parent.first] - play.step)};
      if (chunk == c) {
        for (std::size_t i = 0; i < child.poses.size(); ++i) {
          child.poses[i].position.x += 0.004 * static_cast<double>(i + 1);
        }
      }
      track[chunk] = static_cast<std::uint32_t>(result.tracks.size());
      result.tracks.push_back(std::move(child));
    }
    pair = kNoTrack;
  }
  Projectile ball;
  ball.name = "ball";
  ball.radius = radius;
  const Pose standing{wall.wall.position, wall.wall.rotation};
  ball.position = standing * Vec3{play.hit.x, play.hit.y, play.start};
  ball.velocity = rotate(standing.rotation, {0, 0, -play.speed});
  Track flight{kNoTrack, 0, {}};
  for (const double t : result.times) {
    const double slow = t < hit ? t : hit + 0.55 * (t - hit);
    Vec3 at = ball.position + slow * ball.velocity;
    const double fall = std::max(0.0, t - hit);
    at.y = std::max(ball.radius, at.y - 4.905 * fall * fall);
    flight.poses.push_back({at, turned({1, 0, 0}, -0.3 * fall)});
  }
  result.projectiles.push_back({ball, static_cast<std::uint32_t>(result.tracks.size())});
  result.tracks.push_back(std::move(flight));
  result.events.push_back(
      {result.times[begin], 0, standing * Vec3{play.hit.x, play.hit.y, 0}, play.speed, 3, 10, 5});
  result.walls.push_back({walls[0], track});
  for (std::size_t w = 1; w < walls.size(); ++w) {
    result.walls.push_back(
        {walls[w], std::vector<std::uint32_t>(walls[w].chunks.size(), kNoTrack)});
  }
  return result;
}

}  // namespace sunder
