// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace sunder {

/// One figure against what it should be.
struct AccuracyRow {
  std::string name;
  std::string quantity = "";
  std::string step = "–", iterations = "–";
  double measured = 0, expected = 0;
  std::string source = "exact";
};

/// "1/240"
std::string step_text(double step);
void print_accuracy_header();
/// The error is relative; absolute where 0 is expected.
void print_accuracy_row(const AccuracyRow& row);

/// Bodies alone: collisions, spin, towers, bounces, slopes, rocking and toppling.
void measure_rigid_world();

}  // namespace sunder
