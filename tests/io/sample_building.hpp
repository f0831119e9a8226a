// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/sample_recording.hpp"
#include "meshing/random.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// A regular frame of posts, beams, floor slabs (with corners cut for the posts) and, if wanted,
/// walls around, 6 m bays and 3.5 m storeys, that comes down at the corner of the last post.
struct SampleBuilding {
  std::uint32_t posts_x = 4, posts_z = 5, storeys = 6;
  bool has_walls = false;
  double reach = 0;  ///< parts nearer than this to that corner fall, m; 0: none
  std::uint32_t steps = 200;
  double step = 0.02;  ///< s
};

/// Builds the recording. Not physics: known places, motions and loads.
class SampleBuilder {
 public:
  explicit SampleBuilder(const SampleBuilding& building) : building_(building) {
    for (std::uint32_t i = 0; i < building.steps; ++i)
      recording_.times.push_back(i * building.step);
    for (std::uint32_t s = 0; s < building.storeys; ++s) add_storey(s);
    if (building.reach > 0) collapse();
    for (int k = 0; k <= 10; ++k) add_sample(recording_.times.back() * k / 10);
  }
  Recording take() { return std::move(recording_); }

 private:
  static constexpr double kBay = 6, kHeight = 3.5, kPost = 0.15, kGap = 0.005;
  static constexpr double kBeamTop = 0.15, kSlabTop = 0.3;  // over the level of nodes

  Vec3 node(std::uint32_t x, std::uint32_t z, std::uint32_t level) const {
    return {kBay * x, kHeight * level, -kBay * z};
  }
  std::uint32_t add(std::string name, Loop outline, double half, Pose standing, bool has_ends) {
    RecordedPart part;
    part.name = std::move(name);
    part.outline.outline = std::move(outline);
    part.half_length = half;
    part.material = has_ends ? "steel" : part.name[0] == 's' ? "concrete-c30" : "brick";
    part.mass = 1000;
    part.standing = standing;
    part.has_ends = has_ends;
    recording_.parts.push_back(std::move(part));
    return static_cast<std::uint32_t>(recording_.parts.size()) - 1;
  }
  void add_joint(std::uint32_t a, std::uint8_t end_a, std::uint32_t b, std::uint8_t end_b,
                 Vec3 at) {
    RecordedJoint joint;
    joint.part_a = a, joint.end_a = end_a, joint.part_b = b, joint.end_b = end_b, joint.point = at;
    joint.name = "joint_" + std::to_string(recording_.joints.size());
    recording_.joints.push_back(std::move(joint));
  }
  static Loop rectangle_about(double x, double y) { return rectangle({2 * x, 2 * y}, {-x, -y}); }
  static std::string tag(std::uint32_t x, std::uint32_t z, std::uint32_t s) {
    return std::to_string(x) + "_" + std::to_string(z) + "_" + std::to_string(s);
  }
  std::uint32_t post(std::uint32_t x, std::uint32_t z, std::uint32_t s) const {
    return posts_[(s * building_.posts_z + z) * building_.posts_x + x];
  }

  void add_storey(std::uint32_t s) {
    const Quaternion upright = turned({1, 0, 0}, -0.25);  // z of the part goes up
    for (std::uint32_t z = 0; z < building_.posts_z; ++z) {
      for (std::uint32_t x = 0; x < building_.posts_x; ++x) {
        const Vec3 foot = node(x, z, s);
        posts_.push_back(add("post_" + tag(x, z, s), rectangle_about(kPost, kPost),
                             0.5 * kHeight - kGap, {foot + Vec3{0, 0.5 * kHeight, 0}, upright},
                             true));
        add_joint(posts_.back(), 0, s == 0 ? kNoTrack : post(x, z, s - 1), 1, foot);
      }
    }
    for (std::uint32_t z = 0; z < building_.posts_z; ++z) {
      for (std::uint32_t x = 0; x < building_.posts_x; ++x) {
        if (x + 1 < building_.posts_x) add_bay(x, z, x + 1, z, s);
        if (z + 1 < building_.posts_z) add_bay(x, z, x, z + 1, s);
        if (x + 1 < building_.posts_x && z + 1 < building_.posts_z) add_slab(x, z, s);
      }
    }
  }
  // A beam and, on the outside, a wall below it.
  void add_bay(std::uint32_t x, std::uint32_t z, std::uint32_t to_x, std::uint32_t to_z,
               std::uint32_t s) {
    const Vec3 a = node(x, z, s + 1), b = node(to_x, to_z, s + 1);
    const bool is_along_x = to_x > x;
    const Quaternion along = is_along_x ? turned({0, 1, 0}, 0.25) : turned({0, 1, 0}, 0.5);
    const std::uint32_t beam =
        add((is_along_x ? "beam_x_" : "beam_z_") + tag(x, z, s), rectangle_about(0.075, kBeamTop),
            0.5 * kBay - kPost - kGap, {0.5 * (a + b), along}, true);
    add_joint(beam, 0, post(x, z, s), 1, a);
    add_joint(beam, 1, post(to_x, to_z, s), 1, b);
    const bool is_outside =
        is_along_x ? z == 0 || z + 1 == building_.posts_z : x == 0 || x + 1 == building_.posts_x;
    if (!building_.has_walls || !is_outside) return;
    const double height = kHeight - kSlabTop - kBeamTop - 2 * kGap;
    const Vec3 middle = 0.5 * (a + b) - Vec3{0, kBeamTop + kGap + 0.5 * height, 0};
    add("wall_" + tag(x, z, s), rectangle_about(0.5 * kBay - kPost - kGap, 0.5 * height), 0.05,
        {middle, is_along_x ? Quaternion{} : turned({0, 1, 0}, 0.25)}, false);
  }
  void add_slab(std::uint32_t x, std::uint32_t z, std::uint32_t s) {
    const double e = 0.5 * kBay - kGap, n = e - kPost;
    const Loop outline = {{-n, -e}, {n, -e}, {n, -n}, {e, -n}, {e, n},   {n, n},
                          {n, e},   {-n, e}, {-n, n}, {-e, n}, {-e, -n}, {-n, -n}};
    const Vec3 middle = 0.5 * (node(x, z, s + 1) + node(x + 1, z + 1, s + 1));
    add("slab_" + tag(x, z, s), outline, 0.075,
        {middle + Vec3{0, 0.5 * (kBeamTop + kSlabTop), 0}, turned({1, 0, 0}, -0.25)}, false);
  }

  Vec3 corner() const { return node(building_.posts_x - 1, 0, building_.storeys); }
  // Falls from its place, turning, and rests in a heap.
  void fall(std::uint32_t p, double begin) {
    RecordedPart& part = recording_.parts[p];
    const auto noise = [p](std::uint32_t k) { return random_unit(7, p, k) - 0.5; };
    const Pose from = part.standing;
    const double rest = 0.3 + 2.5 * random_unit(7, p, 9);
    const double landing = std::sqrt(std::max(0.0, from.position.y - rest) / 4.905);
    const Vec3 drift{2 * noise(1) + 0.6, 0, 2 * noise(2) + 0.6}, axis{noise(3), noise(4), noise(5)};
    Track track;
    track.first = static_cast<std::uint32_t>(begin / building_.step) + 1;
    for (std::uint32_t i = track.first; i < building_.steps; ++i) {
      const double t = recording_.times[i] - begin, now = std::min(t, landing);
      track.poses.push_back({from.position + now * drift + Vec3{0, -4.905 * now * now, 0},
                             turned(axis, 0.12 * now) * from.rotation});
      if (t >= landing) break;
    }
    if (track.poses.empty()) return;
    part.track = static_cast<std::uint32_t>(recording_.tracks.size());
    recording_.tracks.push_back(std::move(track));
  }
  void collapse() {
    std::vector<double> begins(recording_.parts.size(), recording_.times.back() + 1);
    const Vec3 end = corner();
    for (std::uint32_t p = 0; p < recording_.parts.size(); ++p) {
      const Vec3 d = recording_.parts[p].standing.position - end;
      const double distance = std::hypot(d.x, d.z);
      if (distance > building_.reach || (d.y < -8 && distance > 0.5 * building_.reach)) continue;
      begins[p] = 0.5 + 0.06 * distance + 0.05 * random_unit(3, p, 1);
      fall(p, begins[p]);
    }
    for (RecordedJoint& joint : recording_.joints) {
      const double b = joint.part_b == kNoTrack ? 1e9 : begins[joint.part_b];
      const double first = std::min(begins[joint.part_a], b);
      if (first < recording_.times.back()) joint.broken = first;
    }
    Projectile ball;
    ball.name = "ball", ball.radius = 1, ball.mass = 5000;
    ball.position = end + Vec3{10, -6, 8};
    ball.velocity = {-18, 0, -14};
    Track flight;
    for (const double t : recording_.times) {
      const double now = std::min(t, 0.5 + 0.3 * std::max(0.0, std::min(t, 1.2) - 0.5));
      const double drop = std::max(0.0, t - 0.5);
      Vec3 at = ball.position + now * ball.velocity;
      at.y = std::max(1.0, at.y - 4.905 * drop * drop);
      flight.poses.push_back({at, {}});
    }
    recording_.projectiles.push_back({ball, static_cast<std::uint32_t>(recording_.tracks.size())});
    recording_.tracks.push_back(std::move(flight));
  }
  void add_sample(double time) {
    recording_.sample_times.push_back(time);
    for (std::uint32_t j = 0; j < recording_.joints.size(); ++j) {
      const RecordedJoint& joint = recording_.joints[j];
      JointSample sample;
      if (joint.broken > time) {
        const Vec3 d = joint.point - corner();
        const double near = std::max(0.0, 1 - std::hypot(d.x, d.z) / 20);
        sample.force_utilisation = static_cast<float>(0.1 + near * random_unit(5, j, 1));
        sample.torque_utilisation = static_cast<float>(0.1 + near * random_unit(5, j, 2));
      }
      recording_.samples.push_back(sample);
    }
  }

  SampleBuilding building_;
  Recording recording_;
  std::vector<std::uint32_t> posts_;
};

inline Recording sample_building(const SampleBuilding& building = {}) {
  return SampleBuilder(building).take();
}

}  // namespace sunder
