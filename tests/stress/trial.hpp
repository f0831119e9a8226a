// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tests/stress/scenes.hpp"

namespace sunder::stress {

/// A number that a trial must keep below its limit.
struct Measure {
  std::string name;
  double value = 0, limit = 0;
  bool failed() const { return !(value <= limit); }  // also when it is not a number
};

/// What is tried: a way to make scenes and what is run on them.
struct Kind {
  const char* name;
  const char* verb;
  Scene (*make)(Dice&);
};
std::span<const Kind> kinds();

struct Trial {
  bool refused = false;   ///< a clear error: exit code 3 and a message
  bool too_long = false;  ///< stopped at Bench::seconds: not judged to the end
  double seconds = 0;
  std::vector<Measure> measures;
  std::vector<std::string> failures;  ///< in words; empty: sound
};

/// Most that a program may take for one scene, s: more is a failure.
inline constexpr double kMostSeconds = 120;

/// Where the program is and where its files may go.
struct Bench {
  std::filesystem::path program, folder;
  double seconds = kMostSeconds;  ///< for a trial; less than kMostSeconds: what takes longer is
                                  ///< given up
};

/// Makes the scene of a seed and judges what the program does with it. A scene that failed stays in
/// the folder as `<kind>-<seed>.json` (and .obj); all else is removed.
Trial try_seed(const Kind& kind, std::uint64_t seed, const Bench& bench);

}  // namespace sunder::stress
