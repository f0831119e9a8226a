// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_animation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

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
  std::uint32_t add(std::uint32_t track, const Pose& standing, bool local) {
    const TimeRange moving = moving_range(recording_, track);
    if (moving.first >= moving.end) return kNoHistory;
    std::uint32_t first = key_of(moving.first), end = key_of(moving.end - 1) + 1;
    if (local && first > 0) --first;
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
    result_.of_projectile.push_back(add(track, {projectile.position, {}}, false));
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
      ids.push_back(found != known.end() ? found->second : add(track, standing, true));
      if (found == known.end()) known.emplace(track, ids.back());
    }
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

void check_users(const Recording& recording) {
  const auto exists = [&recording](std::uint32_t track) {
    return track == kNoTrack || track < recording.tracks.size();
  };
  std::set<std::string> names;
  std::vector<std::string> stems;
  for (const RecordedWall& wall : recording.walls) {
    names.insert(wall.asset.wall.name);
    stems.push_back(wall.asset.wall.name + "_chunk_");
    if (wall.track.size() != wall.asset.chunks.size() || !std::ranges::all_of(wall.track, exists)) {
      refuse(wall.asset.wall.name, "its chunks have no tracks, or tracks that do not exist");
    }
  }
  for (const RecordedProjectile& recorded : recording.projectiles) {
    const Projectile& p = recorded.projectile;
    const std::string name = "projectile \"" + p.name + "\"";
    if (!is_portable(p.name)) {
      refuse(name, "its name must have 1 to 56 characters of A-Z a-z 0-9 _ -");
    }
    if (!names.insert(p.name).second) refuse(name, "its name is used twice");
    if (std::ranges::any_of(stems, [&](const auto& stem) { return p.name.starts_with(stem); })) {
      refuse(name, "its name is like a chunk's");
    }
    if (!exists(recorded.track) || !is_writable(p.position) ||
        !is_writable({p.radius, p.mass, 0}) || !(p.radius > 0)) {
      refuse(name, "its track does not exist, or a value is not finite");
    }
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
  check_users(recording);
}

}  // namespace sunder
