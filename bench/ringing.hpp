// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "bench/hybrid_bench.hpp"
#include "bench/modal_eigen.hpp"
#include "bench/work_precision.hpp"

namespace sunder {

/// What a building does in its first seconds after a post is taken away.
struct Swinging {
  double deflection = 0;      ///< largest, of the node above the post, m
  double crossing = 0;        ///< when that node passes its place at rest for the fourth time, s
  std::vector<double> peaks;  ///< largest load of watched joints (N m, N), by watch
  Spread ms;                  ///< processor time of all threads per simulated second
};

/// A post of a building is taken away at once, nothing damps: hybrid's steps against the modes.
class RingingCase {
 public:
  RingingCase(const Size& size, const char* post);
  Swinging exact() const { return exact_; }
  /// By steps of `step` s.
  Swinging stepped(double step) const;
  /// Largest of: deflection and crossing, relative; loads, by the largest change of its kind.
  struct Error {
    double deflection = 0, period = 0, moments = 0, feet = 0;
    double worst() const;
  };
  Error error(const Swinging& swinging) const;

 private:
  struct Watch {
    std::uint32_t joint = 0;
    bool is_beam = false;  ///< the moment of its end; else a foot's compression
    double before = 0;
  };
  double value(const Watch& watch, const JointLoad& load) const;
  void find_watched(const Frame& after, const FrameSolver& stood);

  Frame frame_;
  std::uint32_t post_ = 0, top_ = 0;
  double rest_ = 0;  ///< deflection of the node at rest without the post, m
  std::vector<Watch> watched_;
  Swinging exact_;
};

}  // namespace sunder
