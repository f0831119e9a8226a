// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "bench/body_world.hpp"

namespace sunder {

/// One figure against what it should be.
struct AccuracyRow {
  std::string name;
  std::string quantity = "";
  std::string step = "–", iterations = "–";
  double measured = 0, expected = 0;
  std::string source = "exact";
  double scale = 1;      ///< what the error is divided by where 0 is expected
  double error() const;  ///< relative
};
using AccuracyRows = std::vector<AccuracyRow>;

/// "1/240 s"
std::string step_text(double step);

/// How finely a run is computed.
struct Fineness {
  double step = 1.0 / 240;  ///< s
  int iterations = 20;
};

// Rigid bodies whose motion has a closed form, by any engine.
AccuracyRows head_on(const Engine& engine, double speed, const Fineness& fineness);
AccuracyRows free_spin(const Engine& engine, const Fineness& fineness);
AccuracyRows tower(const Engine& engine, const Fineness& fineness);
/// Two cubes at rest, the upper one `ratio` times as heavy.
AccuracyRows heavy_on_light(const Engine& engine, double ratio, const Fineness& fineness);
/// Fall, bounces, blocks and a ball on slopes.
AccuracyRows plain_motion(const Engine& engine, const Fineness& fineness);
AccuracyRows rocking(const Engine& engine, const Fineness& fineness);   ///< Housner 1963
AccuracyRows toppling(const Engine& engine, const Fineness& fineness);  ///< a wall falls over

/// All of them but free spin, which meets nothing: what `worst` of the errors means in the front.
AccuracyRows closed_forms(const Engine& engine, const Fineness& fineness);
/// The row with the largest error; one that is no number counts as larger than any.
const AccuracyRow& worst(const AccuracyRows& rows);

}  // namespace sunder
