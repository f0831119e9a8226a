// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace sunder {

/// exp, log and power with the same bits on every processor, unlike the C library's, whose bits
/// change with its FMA paths: only + - * / and bits. Relative error below 1e-15 wherever the
/// result is a normal number. Special values are the C library's: overflow gives infinity,
/// underflow 0 (with denormals before it), log_of(0) = -infinity, log_of(x < 0) = NaN,
/// power_of(x, 0) = power_of(1, y) = 1, power_of(0, y > 0) = 0, power_of(0, y < 0) = infinity –
/// except that power_of(x < 0, y) is NaN for whole y too (but y = 0). NaN in, NaN out.
double exp_of(double x);
double log_of(double x);
double power_of(double x, double y);

}  // namespace sunder
