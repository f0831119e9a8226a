// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/explicit_frame.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>

namespace sunder {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

Vector3d eigen(Vec3 v) {
  return {v.x, v.y, v.z};
}
Vec3 plain(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

struct Rod {
  double length = 0, area = 0, iy = 0, iz = 0, it = 0, avy = 0, avz = 0, e = 0, g = 0, density = 0;
};

/// Of an element in its own axes: x along, deflections v (y) and w (z), dw/dx = -turn about y.
Matrix12d local_stiffness(const Rod& rod) {
  Matrix12d k = Matrix12d::Zero();
  const double l = rod.length;
  const auto pair = [&](int a, int b, double value) {
    k(a, a) += value, k(b, b) += value, k(a, b) -= value, k(b, a) -= value;
  };
  pair(0, 6, rod.e * rod.area / l);
  pair(3, 9, rod.g * rod.it / l);
  const auto bend = [&](double ei, double ga, int shift, int turn, double sign) {
    const double phi = 12 * ei / (ga * l * l), c = ei / (l * l * l * (1 + phi));
    const std::array<int, 4> at{shift, turn, shift + 6, turn + 6};
    const double m[4][4] = {{12, 6 * l, -12, 6 * l},
                            {6 * l, (4 + phi) * l * l, -6 * l, (2 - phi) * l * l},
                            {-12, -6 * l, 12, -6 * l},
                            {6 * l, (2 - phi) * l * l, -6 * l, (4 + phi) * l * l}};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        k(at[i], at[j]) += c * m[i][j] * (i % 2 ? sign : 1) * (j % 2 ? sign : 1);
  };
  bend(rod.e * rod.iz, rod.g * rod.avy, 1, 5, 1);
  bend(rod.e * rod.iy, rod.g * rod.avz, 2, 4, -1);
  return k;
}

}  // namespace

struct ExplicitFrame::Impl {
  struct Node {
    Vector6 u = Vector6::Zero(), v = Vector6::Zero(), a = Vector6::Zero();
    Vector6 load = Vector6::Zero(), force = Vector6::Zero();  ///< of the weight; with the springs
    double mass = 0;
    Matrix3d inertia = Matrix3d::Zero(), inverse = Matrix3d::Zero();
  };
  struct Member {
    Matrix12d stiffness;  ///< of each element, world
    std::uint32_t first = 0;
    bool present = true;
  };
  struct Group {
    std::vector<std::uint32_t> ends;  ///< 2 member + end
    bool fixed = false;
  };

  Impl(const Frame& f, const ExplicitParams& p) : frame(f), params(p) {
    for (std::uint32_t m = 0; m < frame.members.size(); ++m) add(m);
    intact.assign(frame.joints.size(), 1);
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (frame.joints[j].node == kNoPart) intact[j] = 0;
    judged.assign(frame.joints.size(), {});
    group();
  }

  std::uint32_t node_of(std::uint32_t end) const {
    return members[end / 2].first +
           (end % 2 == 0 ? 0 : static_cast<std::uint32_t>(params.elements));
  }

  void add(std::uint32_t m) {
    const FrameMember& given = frame.members[m];
    const Section& s = frame.sections[given.section];
    const SteelGrade& steel = frame.steels[given.steel];
    const Axes axes = axes_of(frame, given);
    Matrix3d to_world;
    to_world << eigen(axes.x), eigen(axes.y), eigen(axes.z);
    const double g = steel.youngs_modulus / (2 * (1 + steel.poisson_ratio));
    const Rod rod{frame.length(given) / params.elements,
                  s.area,
                  s.iy,
                  s.iz,
                  s.it,
                  s.avy,
                  s.avz,
                  steel.youngs_modulus,
                  g,
                  steel.density};
    Matrix12d turn = Matrix12d::Zero();
    for (int i = 0; i < 4; ++i) turn.block<3, 3>(3 * i, 3 * i) = to_world;
    Member member;
    member.stiffness = turn * local_stiffness(rod) * turn.transpose();
    member.first = static_cast<std::uint32_t>(nodes.size());
    nodes.resize(nodes.size() + static_cast<std::size_t>(params.elements) + 1);
    const double line = rod.density * rod.area, l = rod.length;
    const Vector3d weight(0, -params.gravity * line, 0);
    const Vector3d moment = l * l / 12 * eigen(axes.x).cross(weight);
    const double across = line * l * l * l / 105;
    const Vector3d turning(rod.density * (rod.iy + rod.iz) * l / 2,
                           rod.density * rod.iy * l / 2 + across,
                           rod.density * rod.iz * l / 2 + across);
    for (int e = 0; e < params.elements; ++e)
      for (const int end : {0, 1}) {
        Node& node = nodes[member.first + static_cast<std::uint32_t>(e + end)];
        node.mass += line * l / 2;
        node.inertia += to_world * turning.asDiagonal() * to_world.transpose();
        node.load.head<3>() += l / 2 * weight;
        node.load.tail<3>() += (end == 0 ? 1 : -1) * moment;
      }
    for (std::uint32_t n = member.first; n < nodes.size(); ++n)
      nodes[n].inverse = nodes[n].inertia.inverse();
    members.push_back(member);
  }

  /// Which ends move together.
  void group() {
    std::vector<std::uint32_t> label(2 * members.size());
    std::vector<std::uint8_t> fixed(label.size(), 0);
    for (std::uint32_t i = 0; i < label.size(); ++i) label[i] = i;
    const auto merge = [&](std::uint32_t a, std::uint32_t b) {
      const std::uint32_t from = label[a], to = label[b];
      std::ranges::replace(label, from, to);
      fixed[to] |= fixed[from];
    };
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
      if (!intact[j]) continue;
      const FrameJoint& joint = frame.joints[j];
      const std::uint32_t a = 2 * joint.a + joint.end_a;
      if (joint.b == kNoPart) {
        fixed[label[a]] = 1;
      } else {
        merge(a, 2 * joint.b + joint.end_b);
      }
    }
    groups.clear();
    std::vector<std::uint32_t> place(label.size(), kNone);
    for (std::uint32_t i = 0; i < label.size(); ++i) {
      if (!members[i / 2].present) continue;
      if (place[label[i]] == kNone) {
        place[label[i]] = static_cast<std::uint32_t>(groups.size());
        groups.push_back({{}, fixed[label[i]] != 0});
      }
      groups[place[label[i]]].ends.push_back(i);
    }
  }

  void sum_forces() {
    for (Node& node : nodes) node.force = node.load;
    Vector12 u, v;
    for (const Member& member : members) {
      if (!member.present) continue;
      for (std::uint32_t n = member.first; n < member.first + params.elements; ++n) {
        u << nodes[n].u, nodes[n + 1].u;
        v << nodes[n].v, nodes[n + 1].v;
        const Vector12 f = member.stiffness * (u + params.damping_stiffness * v);
        nodes[n].force -= f.head<6>();
        nodes[n + 1].force -= f.tail<6>();
      }
    }
  }

  void accelerate() {
    for (const Member& member : members) {
      if (!member.present) continue;
      for (int i = 1; i < params.elements; ++i) {
        Node& node = nodes[member.first + static_cast<std::uint32_t>(i)];
        node.a.head<3>() = node.force.head<3>() / node.mass;
        node.a.tail<3>() = node.inverse * node.force.tail<3>();
        node.a -= params.damping_mass * node.v;
      }
    }
    for (const Group& group : groups) {
      Vector6 a = Vector6::Zero();
      if (!group.fixed) {
        double mass = 0;
        Matrix3d inertia = Matrix3d::Zero();
        for (const std::uint32_t end : group.ends) {
          const Node& node = nodes[node_of(end)];
          a += node.force;
          mass += node.mass;
          inertia += node.inertia;
        }
        a.head<3>() /= mass;
        a.tail<3>() = Vector3d(inertia.inverse() * a.tail<3>());
        a -= params.damping_mass * nodes[node_of(group.ends.front())].v;
      }
      for (const std::uint32_t end : group.ends) nodes[node_of(end)].a = a;
    }
  }

  /// What the carrier does to the end.
  JointLoad load(std::uint32_t j) const {
    const FrameJoint& joint = frame.joints[j];
    const Node& node = nodes[node_of(2 * joint.a + joint.end_a)];
    const Vector6 a = node.a + params.damping_mass * node.v;
    const Vector3d force = node.mass * a.head<3>() - node.force.head<3>();
    const Vector3d torque = node.inertia * a.tail<3>() - node.force.tail<3>();
    const double side = joint.end_a == 1 ? 1 : -1;
    return {side * into(joint.axes, plain(force)), side * into(joint.axes, plain(torque))};
  }

  void judge(double share) {
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
      if (!intact[j]) continue;
      const JointLoad now = load(j);
      JointLoad& mean = judged[j];
      mean.force = mean.force + share * (now.force - mean.force);
      mean.torque = mean.torque + share * (now.torque - mean.torque);
    }
  }

  bool break_joints() {
    bool any = false;
    for (std::uint32_t j = 0; params.breaking && j < frame.joints.size(); ++j) {
      if (!intact[j]) continue;
      const double use = utilisation(judged[j], frame.joints[j].strength).total;
      if (use < 1) continue;
      intact[j] = 0;
      any = true;
      breaks.push_back({time, j, use});
    }
    return any;
  }

  void step() {
    sum_forces();
    accelerate();
    judge(params.step / (params.step + params.lag));
    if (break_joints()) {
      group();
      accelerate();
    }
    // Velocities are those half a step earlier.
    for (Node& node : nodes) {
      node.v += (time == 0 ? 0.5 : 1.0) * params.step * node.a;
      node.u += params.step * node.v;
    }
    time += params.step;
  }

  void rest() {
    std::vector<std::uint32_t> number(nodes.size(), kNone);
    std::uint32_t count = 0;
    for (const Member& member : members)
      for (int i = 1; i < params.elements; ++i)
        number[member.first + static_cast<std::uint32_t>(i)] = count++;
    for (const Group& group : groups) {
      if (group.fixed) continue;
      for (const std::uint32_t end : group.ends) number[node_of(end)] = count;
      ++count;
    }
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd f = Eigen::VectorXd::Zero(6 * count);
    const auto at = [&](std::uint32_t node, int i) {
      return static_cast<int>(6 * number[node]) + i;
    };
    for (const Member& member : members)
      for (std::uint32_t n = member.first; n < member.first + params.elements; ++n)
        for (int i = 0; i < 12; ++i)
          for (int k = 0; k < 12; ++k) {
            const std::uint32_t a = n + (i >= 6 ? 1 : 0), b = n + (k >= 6 ? 1 : 0);
            if (number[a] == kNone || number[b] == kNone) continue;
            entries.emplace_back(at(a, i % 6), at(b, k % 6), member.stiffness(i, k));
          }
    for (std::uint32_t n = 0; n < nodes.size(); ++n)
      if (number[n] != kNone) f.segment<6>(at(n, 0)) += nodes[n].load;
    Eigen::SparseMatrix<double> k(f.size(), f.size());
    k.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(k);
    const Eigen::VectorXd u = factor.solve(f);
    for (std::uint32_t n = 0; n < nodes.size(); ++n)
      if (number[n] != kNone) nodes[n].u = u.segment<6>(at(n, 0));
    sum_forces();
    accelerate();
  }

  double kinetic() const {
    double twice = 0;
    for (const Member& member : members) {
      if (!member.present) continue;
      for (std::uint32_t n = member.first; n <= member.first + params.elements; ++n) {
        const Node& node = nodes[n];
        const Vector6 v = time == 0 ? node.v : Vector6(node.v - 0.5 * params.step * node.a);
        twice +=
            node.mass * v.head<3>().squaredNorm() + v.tail<3>().dot(node.inertia * v.tail<3>());
      }
    }
    return twice / 2;
  }

  double potential() const {
    double sum = 0;
    Vector12 u;
    for (const Member& member : members) {
      if (!member.present) continue;
      for (std::uint32_t n = member.first; n < member.first + params.elements; ++n) {
        u << nodes[n].u, nodes[n + 1].u;
        sum += u.dot(member.stiffness * u) / 2;
      }
      for (std::uint32_t n = member.first; n <= member.first + params.elements; ++n)
        sum -= nodes[n].load.dot(nodes[n].u);
    }
    return sum;
  }

  const Frame& frame;
  const ExplicitParams params;
  std::vector<Node> nodes;
  std::vector<Member> members;
  std::vector<Group> groups;
  std::vector<std::uint8_t> intact;
  std::vector<JointLoad> judged;
  std::vector<Break> breaks;
  double time = 0;
};

ExplicitFrame::ExplicitFrame(const Frame& frame, const ExplicitParams& params,
                             const std::vector<std::uint32_t>& removed)
    : impl_(std::make_unique<Impl>(frame, params)) {
  impl_->rest();
  impl_->judge(1);
  for (const std::uint32_t m : removed) impl_->members[m].present = false;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const FrameJoint& joint = frame.joints[j];
    const auto is_gone = [&](std::uint32_t part) {
      return std::ranges::find(removed, part) != removed.end();
    };
    if (is_gone(joint.a) || (joint.b != kNoPart && is_gone(joint.b))) impl_->intact[j] = 0;
  }
  impl_->group();
}
ExplicitFrame::~ExplicitFrame() = default;

void ExplicitFrame::run(double until) {
  while (impl_->time < until) impl_->step();
}

const std::vector<ExplicitFrame::Break>& ExplicitFrame::breaks() const {
  return impl_->breaks;
}
JointLoad ExplicitFrame::load(std::uint32_t joint) const {
  return impl_->judged[joint];
}
double ExplicitFrame::energy() const {
  return impl_->kinetic() + impl_->potential();
}
double ExplicitFrame::kinetic() const {
  return impl_->kinetic();
}
Vec3 ExplicitFrame::displacement(std::uint32_t m, int end) const {
  return plain(impl_->nodes[impl_->node_of(2 * m + static_cast<std::uint32_t>(end))].u.head<3>());
}

}  // namespace sunder
