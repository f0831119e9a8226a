// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_animation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "io/part_mesh.hpp"
#include "io/printable.hpp"
#include "io/wall_view.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr double kLargestFloat = 3e38;

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(ErrorCode::output, where + ": " + what);
}

class Planner {
 public:
  explicit Planner(const Recording& recording) : recording_(recording) {}

  GltfAnimation plan() {
    find_keys();
    for (std::uint32_t p = 0; p < recording_.projectiles.size(); ++p) plan_projectile(p);
    for (const RecordedWall& wall : recording_.walls) plan_wall(wall);
    for (std::uint32_t p = 0; p < recording_.parts.size(); ++p) plan_part(p);
    lay_out_poses();
    return std::move(result_);
  }

 private:
  void find_keys() {
    const std::vector<double>& times = recording_.times;
    for (std::uint32_t i = 0; i < times.size(); ++i) {
      const bool repeats =
          i + 1 < times.size() && static_cast<float>(times[i]) == static_cast<float>(times[i + 1]);
      if (!repeats) result_.steps.push_back(i);
    }
  }
  // The key of a step, or of the one after it that has its time.
  std::uint32_t key_of(std::uint32_t step) const {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(result_.steps, step) -
                                      result_.steps.begin());
  }
  std::uint32_t range_of(std::uint32_t first, std::uint32_t end) {
    const GltfAnimation::Keys keys{first, end - first};
    const auto [place, is_new] =
        range_ids_.try_emplace(keys, static_cast<std::uint32_t>(result_.key_ranges.size()));
    if (is_new) result_.key_ranges.push_back(keys);
    return place->second;
  }
  // `stood`: its node is where it stands before it moves, so a key holds it there.
  std::uint32_t add(std::uint32_t track, const Pose& standing, bool local, bool stood) {
    const TimeRange moving = moving_range(recording_, track);
    if (moving.first >= moving.end) return kNoHistory;
    std::uint32_t first = key_of(moving.first), end = key_of(moving.end - 1) + 1;
    if (stood && first > 0) --first;
    if (result_.histories.empty()) end = static_cast<std::uint32_t>(result_.steps.size());
    result_.histories.push_back({track, standing, local, range_of(first, end), 0});
    return static_cast<std::uint32_t>(result_.histories.size() - 1);
  }
  void plan_projectile(std::uint32_t p) {
    const auto& [projectile, track] = recording_.projectiles[p];
    if (track == kNoTrack) {
      result_.of_projectile.push_back(kNoHistory);
      if (projectile.time > recording_.times.back()) {
        result_.arrivals.push_back({p, range_of(0, 1), false});
      }
      return;
    }
    result_.of_projectile.push_back(add(track, {projectile.position, {}}, false, false));
    const TimeRange moving = moving_range(recording_, track);
    const std::uint32_t first = moving.first < moving.end ? key_of(moving.first) : 0;
    if (first > 0) result_.arrivals.push_back({p, range_of(first - 1, first + 1), true});
  }
  void plan_wall(const RecordedWall& wall) {
    const Pose standing{wall.asset.wall.position, wall.asset.wall.rotation};
    std::map<std::uint32_t, std::uint32_t> known;  // track → history
    std::vector<std::uint32_t>& ids = result_.of_chunk.emplace_back();
    for (const std::uint32_t track : wall.track) {
      if (track == kNoTrack) {
        ids.push_back(kNoHistory);
        continue;
      }
      const auto found = known.find(track);
      ids.push_back(found != known.end() ? found->second : add(track, standing, true, true));
      if (found == known.end()) known.emplace(track, ids.back());
    }
  }
  void plan_part(std::uint32_t p) {
    const RecordedPart& part = recording_.parts[p];
    result_.of_part.push_back(add(part.track, part.standing, false, true));
    if (part.removed > recording_.times.back() || part.wall != kNoTrack) return;
    const auto step = std::ranges::lower_bound(recording_.times, part.removed);
    const auto first = key_of(static_cast<std::uint32_t>(step - recording_.times.begin()));
    const std::uint32_t keys = first > 0 ? range_of(first - 1, first + 1) : range_of(0, 1);
    result_.departures.push_back({p, keys});
  }
  void lay_out_poses() {
    for (GltfAnimation::History& history : result_.histories) {
      history.begin = result_.pose_count;
      result_.pose_count += result_.key_count(history);
    }
  }

  const Recording& recording_;
  GltfAnimation result_;
  std::map<GltfAnimation::Keys, std::uint32_t> range_ids_;
};

bool is_writable(Vec3 v) {
  return std::abs(v.x) < kLargestFloat && std::abs(v.y) < kLargestFloat &&
         std::abs(v.z) < kLargestFloat;
}

bool is_sound(const Pose& pose) {
  const Quaternion q = pose.rotation;
  return is_writable(pose.position) &&
         std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) < 1e-6;
}

void check_times(const Recording& recording) {
  if (recording.times.empty()) refuse("recording", "it has no times");
  double last = -1;
  for (const double time : recording.times) {
    if (!(time > last) || !(time < kLargestFloat)) {
      refuse("recording", "its times do not ascend at " + std::to_string(time) + " s");
    }
    last = time;
  }
}

void check_tracks(const Recording& recording) {
  for (std::uint32_t t = 0; t < recording.tracks.size(); ++t) {
    const Track& track = recording.tracks[t];
    const std::string name = "track " + std::to_string(t);
    if (track.parent != kNoTrack && track.parent >= t) refuse(name, "comes before its parent");
    if (track.first > recording.times.size() ||
        track.poses.size() > recording.times.size() - track.first) {
      refuse(name, "does not lie within the recording's times");
    }
    if (!std::ranges::all_of(track.poses, is_sound)) {
      refuse(name, "a pose is not finite, or its rotation not of length 1");
    }
  }
}

// Names of nodes: those of walls, which are checked elsewhere, and what was added to them.
class Names {
 public:
  explicit Names(const Recording& recording) {
    for (const RecordedWall& wall : recording.walls) {
      names_.insert(wall.asset.wall.name);
      stems_.push_back(wall.asset.wall.name + "_chunk_");
    }
  }
  // `where` is how messages call it.
  void add(const std::string& name, const std::string& where) {
    if (!is_portable(name)) {
      refuse(where, "its name must have 1 to 56 characters of A-Z a-z 0-9 _ -");
    }
    if (!names_.insert(name).second) refuse(where, "its name is used twice");
    if (std::ranges::any_of(stems_, [&](const auto& stem) { return name.starts_with(stem); })) {
      refuse(where, "its name is like a chunk's");
    }
  }

 private:
  std::set<std::string> names_;
  std::vector<std::string> stems_;
};

bool exists(const Recording& recording, std::uint32_t track) {
  return track == kNoTrack || track < recording.tracks.size();
}

void check_walls(const Recording& recording) {
  for (const RecordedWall& wall : recording.walls) {
    if (wall.track.size() != wall.asset.chunks.size() ||
        !std::ranges::all_of(wall.track, [&](auto track) { return exists(recording, track); })) {
      refuse(wall.asset.wall.name, "its chunks have no tracks, or tracks that do not exist");
    }
  }
}

void check_projectiles(const Recording& recording, Names& names) {
  for (const RecordedProjectile& recorded : recording.projectiles) {
    const Projectile& p = recorded.projectile;
    const std::string where = "projectile \"" + p.name + "\"";
    names.add(p.name, where);
    if (!exists(recording, recorded.track) || !is_writable(p.position) ||
        !is_writable({p.radius, p.mass, 0}) || !(p.radius > 0)) {
      refuse(where, "its track does not exist, or a value is not finite");
    }
  }
}

void check_outline(const Region& outline, const std::string& where) {
  const auto is_small = [](const Loop& loop) {
    return std::ranges::all_of(loop, [](Vec2 at) { return is_writable({at.x, at.y, 0}); });
  };
  if (!is_small(outline.outline) || !std::ranges::all_of(outline.openings, is_small)) {
    refuse(where, "a corner of its outline is not finite");
  }
  try {
    lattice_outline(outline, where);
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with(where)) throw Error(ErrorCode::output, message);
    refuse(where, message);
  }
}

void check_parts(const Recording& recording, Names& names) {
  const Region* sound = nullptr;  // the outline before: parts of one kind follow each other
  for (const RecordedPart& part : recording.parts) {
    const std::string where = "part \"" + part.name + "\"";
    names.add(part.name, where);
    if (!exists(recording, part.track) || !is_sound(part.standing) ||
        !is_writable({part.mass, part.half_length, 0}) || !(part.half_length > 0) ||
        std::isnan(part.removed)) {
      refuse(where, "its track does not exist, or a value is not finite");
    }
    if (part.material.empty() || printable(part.material, 200) != part.material) {
      refuse(where, "its material's name is not 1 to 200 printable characters of UTF-8");
    }
    if (sound && sound->outline == part.outline.outline &&
        sound->openings == part.outline.openings) {
      continue;
    }
    check_outline(part.outline, where);
    sound = &part.outline;
  }
}

void check_joints(const Recording& recording) {
  const auto parts = static_cast<std::uint32_t>(recording.parts.size());
  for (const RecordedJoint& joint : recording.joints) {
    const std::string where = "joint \"" + printable(joint.name) + "\"";
    if (joint.name.empty() || printable(joint.name, 200) != joint.name) {
      refuse(where, "its name is not 1 to 200 printable characters of UTF-8");
    }
    if (joint.part_a >= parts || (joint.part_b >= parts && joint.part_b != kNoTrack) ||
        joint.end_a > 2 || joint.end_b > 2) {
      refuse(where, "it joins a part or an end that does not exist");
    }
    if (!is_writable(joint.point) || std::isnan(joint.broken)) {
      refuse(where, "its place or time is not finite");
    }
  }
}

void check_samples(const Recording& recording) {
  double last = -1;
  for (const double time : recording.sample_times) {
    if (!(time > last) || !(time < kLargestFloat)) {
      refuse("recording", "its sampling times do not ascend at " + std::to_string(time) + " s");
    }
    last = time;
  }
  if (recording.samples.size() != recording.sample_times.size() * recording.joints.size()) {
    refuse("recording", "it has not one load per joint and sampling time");
  }
  const auto is_finite = [](const JointSample& s) {
    return std::isfinite(s.force_utilisation) && std::isfinite(s.torque_utilisation);
  };
  if (!std::ranges::all_of(recording.samples, is_finite)) {
    refuse("recording", "a load of a joint is not finite");
  }
}

}  // namespace

GltfAnimation plan_animation(const Recording& recording) {
  return Planner(recording).plan();
}

Pose pose_of(const Recording& recording, const GltfAnimation& animation,
             const GltfAnimation::History& history, std::uint32_t key) {
  const std::uint32_t step = animation.steps[key];
  const Pose pose = pose_at(recording, history.track, step, history.standing);
  if (!history.local) return pose;
  // Exactly at rest, not by way of an inverse.
  if (pose == history.standing) return {};
  return inverse(history.standing) * pose;
}

void validate(const Recording& recording) {
  check_times(recording);
  check_tracks(recording);
  check_walls(recording);
  Names names(recording);
  check_projectiles(recording, names);
  check_parts(recording, names);
  check_joints(recording);
  check_samples(recording);
}

}  // namespace sunder
