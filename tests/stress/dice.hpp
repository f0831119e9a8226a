// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "meshing/random.hpp"

namespace sunder::stress {

/// Random numbers of one trial: the same seed gives the same scene.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}

  double unit() { return random_unit(seed_, 0, draw_++); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// As many between 1 and 10 as between 10 and 100.
  double log_between(double low, double high) { return low * std::pow(high / low, unit()); }
  /// `low` … `high`, both included.
  int whole(int low, int high) { return low + static_cast<int>(unit() * (high - low + 1)); }
  bool chance(double share) { return unit() < share; }
  template <class T>
  T pick(std::initializer_list<T> choices) {
    return choices.begin()[whole(0, static_cast<int>(choices.size()) - 1)];
  }

 private:
  std::uint64_t seed_, draw_ = 0;
};

}  // namespace sunder::stress
