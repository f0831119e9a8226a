// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bench/closed_forms.hpp"

namespace sunder {

void print_accuracy_header();
/// The error is relative; absolute where 0 is expected.
void print_accuracy_row(const AccuracyRow& row);

/// Bodies alone: collisions, spin, towers, bounces, slopes, rocking and toppling.
void measure_rigid_world();
/// The same closed forms by several engines, over steps and iterations: work against precision.
void measure_engines();

}  // namespace sunder
