// SPDX-License-Identifier: GPL-3.0-or-later
// What a step of a building costs whose slabs and walls break, before, at and after a hit; beside
// the same with every chunk active from the start, and plain Bullet with all chunks as bodies.
//   bench_building [seconds after the hit; 0: the heap of rubble alone]
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "bench/peers_bullet.hpp"
#include "bench/report.hpp"
#include "sim/collapse.hpp"
#include "sim/part_pose.hpp"
#include "sim/rigid_world.hpp"
#include "sim/step_times.hpp"
#include "tests/sim/bodies.hpp"
#include "tests/sim/stocked_frame.hpp"

namespace sunder {
namespace {

constexpr double kHit = 0.25;  // s; the ball appears

/// The materials of data/materials.json.
std::vector<Material> materials() {
  return {{.name = "concrete-c30-reinforced",
           .density = 2500,
           .youngs_modulus = 11.8e9,
           .tensile_strength = 6.9e6,
           .compressive_strength = 38e6,
           .fracture_energy = 20e3,
           .restitution = 0.2,
           .source = ""},
          {.name = "brick",
           .density = 1850,
           .youngs_modulus = 3.5e9,
           .poisson_ratio = 0.15,
           .tensile_strength = 0.25e6,
           .compressive_strength = 8e6,
           .fracture_energy = 12,
           .friction = 0.75,
           .restitution = 0.2,
           .source = ""}};
}

const PanelPattern kHundred{VoronoiRandomParams{100}, -1, {}};

CollapseScene building(double duration) {
  CollapseScene scene;
  scene.seed = 3;
  scene.frame = stocked_frame();
  scene.frame.materials = materials();
  RegularBuilding building = regular(4, 5, 6, 0.1);
  for (StoreyParams& storey : building.storeys) {
    storey.slab_material = "concrete-c30-reinforced";
    storey.slab_pattern = storey.wall_pattern = kHundred;
  }
  add_regular(scene.frame, building);
  join(scene.frame);
  scene.projectiles.push_back({.name = "ball",
                               .radius = 0.3,
                               .mass = 888,
                               .position = {3, 5.2, 36},
                               .velocity = {0, 0, -40},
                               .time = kHit});
  scene.simulation.duration = duration;
  return scene;
}

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Processor time of every step: what other programs do at the same time does not count.
struct Run {
  CollapseResult result;
  std::vector<double> ms;
};

Run run(double duration, bool skip) {
  const CollapseScene scene = building(duration);
  Run run;
  double last = -1;
  const auto note = [&](double) {
    const double now = processor_ms();
    if (last >= 0) run.ms.push_back(now - last);
    last = now;
  };
  run.result = simulate_collapse(scene, {.skip = skip, .keep_history = false, .progress = note});
  const auto steps = static_cast<std::ptrdiff_t>(run.result.steps);
  const std::ptrdiff_t extra = static_cast<std::ptrdiff_t>(run.ms.size()) - steps;
  if (extra > 0) run.ms.erase(run.ms.begin(), run.ms.begin() + extra);  // of settling
  return run;
}

void print(const std::string& what, const std::vector<double>& ms, const std::string& bodies) {
  if (ms.empty()) return;
  std::printf("| %s | %zu | %.3g | %.3g | %.3g | %s |\n", what.c_str(), ms.size(),
              percentile(ms, 0.5), percentile(ms, 0.95), percentile(ms, 1), bodies.c_str());
  std::fflush(stdout);
}

/// Bodies that are there after a time, and those that still move later.
std::string bodies_at(const Recording& recording, double time) {
  const auto at = static_cast<std::size_t>(std::ranges::upper_bound(recording.times, time) -
                                           recording.times.begin());
  std::vector<char> is_parent(recording.tracks.size(), 0);
  for (const Track& track : recording.tracks)
    if (track.parent != kNoTrack && track.first <= at) is_parent[track.parent] = 1;
  std::size_t live = 0, move = 0;
  for (std::size_t t = 0; t < recording.tracks.size(); ++t) {
    const Track& track = recording.tracks[t];
    if (is_parent[t] != 0 || track.poses.empty() || track.first > at) continue;
    ++live;
    move += track.first + track.poses.size() > at;
  }
  return std::to_string(live) + ", " + std::to_string(move) + " still to move";
}

void print(const std::string& name, const Run& run, double after) {
  const Recording& recording = run.result.recording;
  const double step = recording.times.back() / static_cast<double>(run.ms.size());
  std::vector<char> breaks(run.ms.size(), 0);
  for (const BreakEvent& event : recording.events)
    breaks[std::min(breaks.size() - 1, static_cast<std::size_t>(event.time / step))] = 1;
  const double hit =
      recording.events.empty() ? recording.times.back() : recording.events.front().time;
  const auto steps = [&](double from, double to, bool only_breaks) {
    std::vector<double> ms;
    for (std::size_t i = 0; i < run.ms.size(); ++i) {
      const double time = static_cast<double>(i) * step;
      if (time >= from && time < to && (!only_breaks || breaks[i] != 0)) ms.push_back(run.ms[i]);
    }
    return ms;
  };
  const double ball = kHit + step;
  print(name + ", intact", steps(step, kHit - step, false), "0");
  print(name + ", the ball flies", steps(ball, hit - 1.5 * step, false), "1");
  print(name + ", first step of the hit", steps(hit - step, hit, false), "");
  print(name + ", steps that break things", steps(0, 1e9, true), bodies_at(recording, hit + 0.5));
  for (double from = hit; from < recording.times.back() - step; from += after / 5)
    print(name + ", " + std::to_string(from - hit).substr(0, 4) + " s after the hit",
          steps(from, from + after / 5, false), bodies_at(recording, from + after / 10));
}

void measure_bullet() {
  const CollapseScene scene = building(0);
  const std::vector<PartSolid> solids = solids_of(scene.frame);
  std::vector<WallAsset> walls;
  std::size_t chunks = 0;
  for (std::uint32_t part = scene.frame.slab_part(0); part < scene.frame.part_count(); ++part) {
    Wall wall;
    wall.region = solids[part].outline;
    wall.thickness = 2 * solids[part].half_length;
    wall.pattern = kHundred.pattern;
    const Pose pose = pose_of(solids[part]);
    wall.position = pose.position;
    wall.rotation = pose.rotation;
    walls.push_back(fracture_wall(wall, 2400, {.seed = scene.seed}));
    chunks += walls.back().chunks.size();
  }
  print("plain Bullet, every chunk a body, no joints", step_chunks(walls, 1.0 / 240, 20, 10, 30),
        std::to_string(chunks));
}

/// A heap of chunks falls on the ground, and then a ball into it: who still moves, and what it
/// costs.
void measure_heap(std::uint32_t max_bodies) {
  constexpr int kChunks = 400;
  RigidWorld world({.max_bodies = max_bodies});
  for (int i = 0; i < kChunks; ++i) {
    const auto at = [&](std::uint64_t k) { return random_unit(1, 10 * i + k) - 0.5; };
    const Prism prism = chunk(0.25, 0.075, static_cast<std::uint64_t>(i));
    const Vec3 place{4 * at(1), 0.5 + 0.12 * (i / 30), 4 * at(2)};
    world.add_body(block_params(40, {0.25, 0.25, 0.075}, place, 10 + i), {&prism, 1});
  }
  for (int second = 1; second <= 12; ++second) {
    if (second == 9) {
      BodyParams ball = ball_params(888, 0.3, {0, 1, -12}, 1);
      ball.velocity = {0, 0, 20};
      world.add_sphere(ball, 0.3);
    }
    std::vector<double> ms;
    for (int i = 0; i < 240; ++i) {
      const double before = processor_ms();
      world.step(1.0 / 240);
      ms.push_back(processor_ms() - before);
    }
    print("heap, at most " + std::to_string(max_bodies) + " that may move, second " +
              std::to_string(second) + (second == 9 ? ", hit" : ""),
          ms,
          std::to_string(world.awake().size()) + " awake, " + std::to_string(world.merged_count()) +
              " merged");
  }
}

/// In a process of its own, so that its peak of memory is its own too.
void alone(const std::string& name, const std::function<void()>& work) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    work();
    std::fflush(stdout);
    _exit(0);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  std::printf("| %s: peak of memory, MB | | | | %.0f%s | |\n", name.c_str(),
              static_cast<double>(usage.ru_maxrss) / 1024, status == 0 ? "" : ", FAILED");
}

}  // namespace
}  // namespace sunder

int main(int argc, char** argv) {
  using namespace sunder;
  const double after = argc > 1 ? std::atof(argv[1]) : 2.1;
  const char* header =
      "| | steps | median ms | p95 ms | longest ms | bodies |\n|---|---|---|---|---|---|\n";
  if (after > 0) {
    const Block block("building steps");
    std::printf("%s", header);
    alone("as needed", [&] { print("as needed", run(0.6 + after, true), after); });
    alone("everything active", [&] { print("everything active", run(0.6 + 0.5, false), 0.5); });
    alone("plain Bullet", [] { measure_bullet(); });
  }
  const Block block("building heap");
  std::printf("%s", header);
  for (const std::uint32_t most : {0u, 100u})
    alone("heap, at most " + std::to_string(most) + " that may move", [&] { measure_heap(most); });
}
