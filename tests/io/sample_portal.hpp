// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "io/sample_recording.hpp"
#include "meshing/region.hpp"
#include "meshing/trig.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// A round tube about the origin with corners on its circles.
inline Region sample_tube(double outer, double inner, std::uint32_t corners = 24) {
  Region tube;
  tube.openings.emplace_back();
  for (std::uint32_t k = 0; k < corners; ++k) {
    const Vec2 unit = unit_at_turns(static_cast<double>(k) / corners);
    tube.outline.push_back(outer * unit);
    tube.openings[0].push_back(inner * unit);
  }
  return tube;
}

/// An I-section about the origin, web along y.
inline Region sample_i(double height, double width, double web, double flange) {
  const double x = 0.5 * width, w = 0.5 * web, y = 0.5 * height, f = y - flange;
  return {{{-x, -y},
           {x, -y},
           {x, -f},
           {w, -f},
           {w, f},
           {x, f},
           {x, y},
           {-x, y},
           {-x, f},
           {-w, f},
           {-w, -f},
           {-x, -f}},
          {}};
}

/// Two posts, a beam on them and a slab on the beam. One second in steps of 1/64 s, loads every
/// 1/32 s:
/// - post_0@ground: force grows from 0 to 1;          post_1@ground: next to nothing
/// - beam@post_0: torque 1/4 before 0.5 s, then 1;    beam@post_1: force and torque 1
/// At 0.5 s beam@post_1 breaks and beam and slab fall; at 0.75 s post_1 is taken away.
inline Recording sample_portal() {
  Recording portal;
  for (int i = 0; i <= 64; ++i) portal.times.push_back(i / 64.0);
  const Quaternion upright = turned({1, 0, 0}, -0.25), across = turned({0, 1, 0}, 0.25);
  const auto add_part = [&](const std::string& name, const Region& outline, double half,
                            const Pose& standing, bool has_ends) {
    RecordedPart part;
    part.name = name, part.outline = outline, part.half_length = half, part.standing = standing;
    part.material = has_ends ? "steel" : "concrete-c30", part.mass = 500, part.has_ends = has_ends;
    portal.parts.push_back(part);
  };
  const Region tube = sample_tube(0.15, 0.13);
  add_part("post_0", tube, 1.5, {{0, 1.5, 0}, upright}, true);
  add_part("post_1", tube, 1.5, {{4, 1.5, 0}, upright}, true);
  add_part("beam", sample_i(0.3, 0.15, 0.01, 0.02), 2, {{2, 3.15, 0}, across}, true);
  add_part("slab", {rectangle({4, 2}, {-2, -1}), {}}, 0.1, {{2, 3.4, 0}, upright}, false);
  const auto add_joint = [&](const std::string& name, std::uint32_t a, std::uint8_t end_a,
                             std::uint32_t b, std::uint8_t end_b) {
    RecordedJoint joint;
    joint.name = name, joint.part_a = a, joint.end_a = end_a, joint.part_b = b;
    joint.end_b = end_b;
    portal.joints.push_back(joint);
  };
  add_joint("post_0@ground", 0, 0, kNoTrack, 2);
  add_joint("post_1@ground", 1, 0, kNoTrack, 2);
  add_joint("beam@post_0", 2, 0, 0, 1);
  add_joint("beam@post_1", 2, 1, 1, 1);
  add_joint("slab@beam", 3, 2, 2, 2);
  portal.joints[3].broken = 0.5;
  for (int i = 0; i <= 32; ++i) {
    const float t = static_cast<float>(i) / 32;
    portal.sample_times.push_back(i / 32.0);
    portal.samples.resize(portal.samples.size() + 5);
    JointSample* at = &portal.samples[portal.samples.size() - 5];
    at[0].force_utilisation = t;
    at[1].force_utilisation = 0.005f;
    at[2].torque_utilisation = t < 0.5f ? 0.25f : 1;
    at[3].force_utilisation = at[3].torque_utilisation = t < 0.5f ? 1 : 0.0f;
    at[4].force_utilisation = 0.8f;
  }
  for (const std::uint32_t p : {2u, 3u}) {
    Track fall{kNoTrack, 33, {}};
    for (int i = 33; i <= 64; ++i) {
      const double t = (i - 32) / 64.0;
      const Pose& from = portal.parts[p].standing;
      fall.poses.push_back({from.position - Vec3{0, 4.905 * t * t, 0},
                            turned({0, 0, 1}, -0.05 * t) * from.rotation});
    }
    portal.parts[p].track = static_cast<std::uint32_t>(portal.tracks.size());
    portal.tracks.push_back(fall);
  }
  portal.parts[1].removed = 0.75;
  return portal;
}

}  // namespace sunder
