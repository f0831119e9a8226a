// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/ringing.hpp"

#include <algorithm>
#include <cmath>

#include "sim/step_times.hpp"
#include "tests/sim/stocked_frame.hpp"

namespace sunder {
namespace {

constexpr double kTime = 1.5, kFine = 0.00025, kNear = 8;  // s, s, m
constexpr int kCrossings = 4;

/// Follows a deflection from step to step.
class Follower {
 public:
  Follower(double rest, double start, Swinging& found) : rest_(rest), last_(start), found_(found) {}
  void note(double time, double dt, double deflection) {
    found_.deflection = std::max(found_.deflection, deflection);
    if ((last_ < rest_) != (deflection < rest_) && ++crossings_ == kCrossings)
      found_.crossing = time - dt * (deflection - rest_) / (deflection - last_);
    last_ = deflection;
  }

 private:
  double rest_, last_;
  int crossings_ = 0;
  Swinging& found_;
};

}  // namespace

double RingingCase::Error::worst() const {
  return std::max({deflection, period, moments, feet});
}

double RingingCase::value(const Watch& watch, const JointLoad& load) const {
  return watch.is_beam ? std::fabs(load.torque.y) : -load.force.x;
}

void RingingCase::find_watched(const Frame& after, const FrameSolver& stood) {
  const Vec3 top = frame_.nodes[top_].position;
  for (std::uint32_t j = 0; j < after.joints.size(); ++j) {
    const FrameJoint& joint = after.joints[j];
    const bool is_beam = joint.kind == FrameJoint::Kind::beam_end;
    if (joint.a == post_ || joint.b == post_ || (!is_beam && joint.b != kNoPart)) continue;
    if (length(joint.point - top) > kNear) continue;
    if (is_beam && std::fabs(joint.point.y - top.y) > 1) continue;
    watched_.push_back({j, is_beam, 0});
    watched_.back().before = value(watched_.back(), stood.joint_load(j));
  }
}

RingingCase::RingingCase(const Size& size, const char* post) : frame_(building_of(size)) {
  post_ = find_part(frame_, post);
  top_ = frame_.members[post_].to;
  Frame after = frame_;
  hand_over_joints(after, post_);
  FrameSolver solver(after);
  solver.solve({});
  find_watched(after, solver);
  const std::span<const double> u = solver.displacements();
  const std::vector<double> start(u.begin(), u.end());
  const double stood = -solver.displacement(top_).y;
  solver.remove_parts({&post_, 1});
  solver.solve({});
  rest_ = -solver.displacement(top_).y;
  const ModalMotion motion(solver, start, solver.displacements());
  for (const Watch& watch : watched_) exact_.peaks.push_back(watch.before);
  Follower follower(rest_, stood, exact_);
  for (double time = kFine; time <= kTime; time += kFine) {
    solver.set_displacements(motion.at(time), {});
    follower.note(time, kFine, -solver.displacement(top_).y);
    for (std::size_t i = 0; i < watched_.size(); ++i)
      exact_.peaks[i] =
          std::max(exact_.peaks[i], value(watched_[i], solver.joint_load(watched_[i].joint)));
  }
}

Swinging RingingCase::stepped(double step) const {
  Standing standing(frame_, step, false);
  standing.step();
  const double stood = -standing.motion().displacement(top_).y;
  standing.remove(post_);
  Swinging found;
  for (const Watch& watch : watched_) found.peaks.push_back(watch.before);
  Follower follower(rest_, stood, found);
  std::vector<double> ms;
  for (int i = 1; i * step <= kTime; ++i) {
    ms.push_back(cost_ms([&] {
      standing.step();
      standing.judge();
    }));
    follower.note(i * step, step, -standing.motion().displacement(top_).y);
    for (std::size_t k = 0; k < watched_.size(); ++k)
      found.peaks[k] =
          std::max(found.peaks[k], value(watched_[k], standing.motion().load(watched_[k].joint)));
  }
  found.ms = {percentile(ms, 0.5) / step, percentile(ms, 0.05) / step, percentile(ms, 0.95) / step};
  return found;
}

RingingCase::Error RingingCase::error(const Swinging& swinging) const {
  Error error{std::fabs(swinging.deflection / exact_.deflection - 1),
              std::fabs(swinging.crossing / exact_.crossing - 1), 0, 0};
  double change[2] = {};
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    double& most = change[watched_[i].is_beam];
    most = std::max(most, exact_.peaks[i] - watched_[i].before);
  }
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const bool is_beam = watched_[i].is_beam;
    double& most = is_beam ? error.moments : error.feet;
    most = std::max(most, std::fabs(swinging.peaks[i] - exact_.peaks[i]) / change[is_beam]);
  }
  return error;
}

}  // namespace sunder
