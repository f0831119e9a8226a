// SPDX-License-Identifier: GPL-3.0-or-later
// Section loads by balance: S' = -q, M' = -x × S - m. With q linear S is quadratic, so the extremes of
// what is a sum of N, M_y and M_z between two point loads are roots of a quadratic equation.
#include "sim/member_span.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

/// A peak is higher than what is this share of the length beside it, by this much of itself.
constexpr double kBeside = 1e-3, kHigher = 1e-9;

Vec3 absolute(Vec3 v) {
  return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
}

Vec3 larger(Vec3 a, Vec3 b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// Of D0 + D1 t + D2 t² = 0; without terms that vanish, some are infinite or no numbers.
std::array<double, 2> roots_of(double d0, double d1, double d2) {
  const double q = -0.5 * (d1 + std::copysign(std::sqrt(d1 * d1 - 4 * d2 * d0), d1));
  return {q / d2, d0 / q};
}

class Search {
 public:
  Search(const MemberSpan& span, const JointStrength& strength, double margin)
      : span_(span), strength_(strength), margin_(margin) {}

  std::optional<WeakPlace> run() {
    double from = 0;
    for (const MemberSpan::Point& point : span_.points) {
      look_between(from, point.at);
      look_at(point.at);
      from = point.at;
    }
    look_between(from, span_.length);
    return best_;
  }

 private:
  Utilisation use_at(double at) const {
    const Utilisation before = utilisation(load_at(span_, at, false), strength_);
    const Utilisation after = utilisation(load_at(span_, at, true), strength_);
    return after.total > before.total ? after : before;
  }

  void look_at(double at) {
    if (!(at >= margin_ && at <= span_.length - margin_)) return;
    const Utilisation use = use_at(at);
    if (use.total < 1 || (best_ && use.total <= best_->utilisation)) return;
    const double beside = kBeside * span_.length, less = use.total * (1 - kHigher);
    if (use_at(std::max(at - beside, 0.0)).total >= less ||
        use_at(std::min(at + beside, span_.length)).total >= less)
      return;
    best_ = {at, use.total, use.component};
  }

  /// Where s_n N/N_R + s_y M_y/R_y + s_z M_z/R_z has an extreme.
  void look_between(double from, double to) {
    if (!(to > from)) return;
    const Vec3 slope = 1 / span_.length * (span_.load_b - span_.load_a);
    const Vec3 load = span_.load_a + from * slope;
    const Vec3 shear = load_at(span_, from, true).force;
    for (const double s_n : {0.0, 1.0, -1.0}) {
      for (const auto& [s_y, s_z] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
        const double n = s_n / strength_.force.x, y = s_y / strength_.torque.y,
                     z = s_z / strength_.torque.z;
        const double d0 =
            y * (shear.z - span_.turn.y) - z * (shear.y + span_.turn.z) - n * load.x;
        const double d1 = z * load.y - y * load.z - n * slope.x;
        const double d2 = 0.5 * (z * slope.y - y * slope.z);
        for (const double t : roots_of(d0, d1, d2))
          if (t > 0 && t < to - from) look_at(from + t);
      }
    }
  }

  const MemberSpan& span_;
  const JointStrength& strength_;
  double margin_ = 0;
  std::optional<WeakPlace> best_;
};

}  // namespace

JointLoad load_at(const MemberSpan& span, double at, bool beyond) {
  const Vec3 slope = 1 / span.length * (span.load_b - span.load_a);
  Vec3 sum = at * span.load_a + (at * at / 2) * slope;  // of the loads so far
  Vec3 turn = (at * at / 2) * span.load_a + (at * at * at / 6) * slope;  // by their distance
  Vec3 moment = at * span.turn;
  for (const MemberSpan::Point& point : span.points) {
    if (point.at > at || (point.at == at && !beyond)) break;
    sum = sum + point.force;
    turn = turn + (at - point.at) * point.force;
    moment = moment + point.moment;
  }
  const Vec3 lever = turn - at * span.start.force;
  return {span.start.force - sum,
          span.start.torque - moment + Vec3{0, -lever.z, lever.y}};
}

std::optional<WeakPlace> weakest_inside(const MemberSpan& span, const JointStrength& strength,
                                        double margin) {
  return Search(span, strength, margin).run();
}

bool may_fail_inside(const MemberSpan& span, const JointStrength& strength) {
  const JointLoad end = load_at(span, span.length, true);
  Vec3 force = span.length * larger(absolute(span.load_a), absolute(span.load_b)), moment;
  const double bow = span.length / 8;
  moment = span.length * absolute(span.turn) + Vec3{0, bow * force.z, bow * force.y};
  for (const MemberSpan::Point& point : span.points) {
    const Vec3 size = absolute(point.force);
    force = force + size;
    moment = moment + absolute(point.moment) + span.length / 4 * Vec3{0, size.z, size.y};
  }
  const Vec3 torque = larger(absolute(span.start.torque), absolute(end.torque)) + moment;
  const Vec3 shear = larger(absolute(span.start.force), absolute(end.force)) + force;
  const double most = std::max(span.start.force.x, end.force.x) + force.x;
  const double least = std::min(span.start.force.x, end.force.x) - force.x;
  return utilisation({{most, shear.y, shear.z}, torque}, strength).total >= 1 ||
         utilisation({{least, shear.y, shear.z}, torque}, strength).total >= 1;
}

}  // namespace sunder
