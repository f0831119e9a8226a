// SPDX-License-Identifier: GPL-3.0-or-later
#include <time.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "bench/hybrid_bench.hpp"
#include "meshing/random.hpp"
#include "tests/sim/stocked_frame.hpp"

namespace sunder {

std::string name_of(const Size& size) {
  return std::to_string(size.x) + " × " + std::to_string(size.z) + " × " +
         std::to_string(size.storeys);
}

Frame building_of(const Size& size) {
  return joined(regular(size.x, size.z, size.storeys));
}

double cost_ms(const std::function<void()>& work) {
  timespec begin{}, end{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin);
  work();
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
  return 1e3 * static_cast<double>(end.tv_sec - begin.tv_sec) +
         1e-6 * static_cast<double>(end.tv_nsec - begin.tv_nsec);
}

std::vector<std::uint32_t> beam_joints(const Frame& frame, std::size_t count, bool scattered) {
  std::vector<std::pair<double, std::uint32_t>> order;
  const Vec3 hit{0, 5, 9};
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const FrameJoint& joint = frame.joints[j];
    if (joint.kind == FrameJoint::Kind::beam_end && joint.end_a == 0)
      order.push_back({scattered ? random_unit(3, j) : length(joint.point - hit), j});
  }
  std::ranges::sort(order);
  std::vector<std::uint32_t> joints;
  for (std::size_t i = 0; i < std::min(count, order.size()); ++i) joints.push_back(order[i].second);
  std::ranges::sort(joints);
  return joints;
}

void wait_for_threads() {
  constexpr auto kWhile = std::chrono::milliseconds(20);
  while (cost_ms([&] { std::this_thread::sleep_for(kWhile); }) > 2) {
  }
}

Standing::Standing(const Frame& frame, double step, bool damped, bool ahead)
    : world_({}), intact_(frame.joints.size(), 1) {
  scene_.frame = frame;
  scene_.simulation.step = step;
  if (ahead) scene_.projectiles.emplace_back();
  if (!damped) scene_.simulation.damping_mass = scene_.simulation.damping_stiffness = 0;
  solids_ = solids_of(scene_.frame);
  motion_ = elastic_motion(scene_, world_, solids_);
  motion_->settle({});
}

void Standing::step() {
  world_.step(scene_.simulation.step);
  now_ += scene_.simulation.step;
  motion_->follow(now_, scene_.simulation.step, true);
}

void Standing::judge() {
  if (!motion_->any_live()) return;
  for (std::uint32_t j = 0; j < intact_.size(); ++j)
    if (intact_[j] != 0 && motion_->is_live(j))
      largest_ =
          std::max(largest_, utilisation(motion_->load(j), scene_.frame.joints[j].strength).total);
}

void Standing::break_joints(const std::vector<std::uint32_t>& joints) {
  std::vector<std::uint32_t> next = joints;
  do {
    for (const std::uint32_t j : next) {
      if (intact_[j] == 0) continue;
      intact_[j] = 0;
      motion_->break_joint(j, true);
    }
    if (!motion_->settle_breaks()) break;
    next = motion_->unheld_joints();
  } while (!next.empty());
}

void Standing::remove(std::uint32_t member) {
  motion_->rejoin(hand_over_joints(scene_.frame, member));
  std::vector<std::uint32_t> joints;
  for (std::uint32_t j = 0; j < intact_.size(); ++j)
    if (scene_.frame.joints[j].a == member || scene_.frame.joints[j].b == member)
      joints.push_back(j);
  break_joints(joints);
  motion_->remove_part(member);
}

}  // namespace sunder
