// SPDX-License-Identifier: GPL-3.0-or-later
// Members in time whose one end let go: the free end, the tip, moves on its own. Its six freedoms
// stand behind those of the nodes, and are condensed within the member out of what is factored, so
// that the factor never knows of them.
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed;

/// Of a symmetric positive definite one, by Cholesky's factor.
Matrix6 inverse_of(Matrix6 a) {
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t k = 0; k < c; ++k)
      for (std::size_t r = c; r < 6; ++r) a[6 * r + c] -= a[6 * r + k] * a[6 * c + k];
    const double root = std::sqrt(a[7 * c]);
    for (std::size_t r = c; r < 6; ++r) a[6 * r + c] /= root;
  }
  Matrix6 result{};
  for (std::size_t column = 0; column < 6; ++column) {
    Six x{};
    x[column] = 1;
    for (std::size_t r = 0; r < 6; ++r) {
      for (std::size_t k = 0; k < r; ++k) x[r] -= a[6 * r + k] * x[k];
      x[r] /= a[7 * r];
    }
    for (std::size_t r = 6; r-- > 0;) {
      for (std::size_t k = r + 1; k < 6; ++k) x[r] -= a[6 * k + r] * x[k];
      x[r] /= a[7 * r];
    }
    for (std::size_t r = 0; r < 6; ++r) result[6 * r + column] = x[r];
  }
  return result;
}

/// One of the four 6 × 6 blocks.
Matrix6 block_of(const Matrix12& matrix, std::size_t row, std::size_t column) {
  Matrix6 block;
  for (std::size_t i = 0; i < 36; ++i)
    block[i] = matrix.at[12 * (6 * row + i / 6) + 6 * column + i % 6];
  return block;
}

/// sum += factor a x.
void add_product(const Matrix6& a, const double* x, double factor, double* sum) {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k) sum[i] += factor * a[6 * i + k] * x[k];
}

Matrix6 product_of(const Matrix6& a, const Matrix6& b) {
  Matrix6 result{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t j = 0; j < 6; ++j) result[6 * i + j] += a[6 * i + k] * b[6 * k + j];
  return result;
}

Matrix6 turned_over(const Matrix6& a) {
  Matrix6 result;
  for (std::size_t i = 0; i < 36; ++i) result[i] = a[6 * (i % 6) + i / 6];
  return result;
}

}  // namespace

/// Keeps what the solves need and returns what the held end gets of the matrix.
Matrix12 FrameSolver::Impl::condense_tip(std::uint32_t m, const Matrix12& matrix,
                                         const Matrix12& mass) {
  const auto held_end = static_cast<std::size_t>(members[m].held_end), free_end = 1 - held_end;
  const auto found = std::ranges::lower_bound(tips, m, {}, &Tip::member);
  Tip& tip = found != tips.end() && found->member == m ? *found : *tips.insert(found, Tip{m});
  tip.node = members[m].node[held_end];
  tip.inverse = inverse_of(block_of(matrix, free_end, free_end));
  tip.coupling = block_of(matrix, held_end, free_end);
  tip.mass = block_of(mass, free_end, free_end);
  tip.mass_coupling = block_of(mass, held_end, free_end);
  const Matrix6 carried =
      product_of(product_of(tip.coupling, tip.inverse), turned_over(tip.coupling));
  Matrix12 condensed;
  for (std::size_t i = 0; i < 36; ++i) {
    const std::size_t at = 12 * (6 * held_end + i / 6) + 6 * held_end + i % 6;
    condensed.at[at] = matrix.at[at] - carried[i];
  }
  return condensed;
}

/// Where the end that let go was until now, for begun_tips().
void FrameSolver::Impl::begin_tip(std::uint32_t m, std::uint32_t from) {
  BegunTip tip;
  tip.tip = 6 * std::size_t{tip_of(m)};
  tip.from = kHeld;
  if (from < kFixed) tip.from = 6 * std::size_t{from};
  if (bent_of[m] != kNone) {
    const Bent& b = bent[bent_of[m]];
    const auto held_end = static_cast<std::size_t>(members[m].held_end);
    const Vec3 arm = (held_end == 0 ? 1 : -1) * members[m].response.length * b.response.axes.x;
    const Vec3 at_held = b.response.axes * b.rotation[held_end];
    tip.moved = cross(at_held, arm);
    tip.turned = at_held - b.response.axes * b.rotation[1 - held_end];
  }
  begun.push_back(tip);
}

/// y = the masses × x, of the tips' rows and columns.
void FrameSolver::Impl::add_mass_of_tips(std::span<const double> x, std::span<double> y) const {
  for (const Tip& tip : tips) {
    const std::size_t at = 6 * std::size_t{tip_of(tip.member)};
    add_product(tip.mass, &x[at], 1, &y[at]);
    if (tip.node >= kFixed) continue;
    const std::size_t held_at = 6 * std::size_t{tip.node};
    add_product(tip.mass_coupling, &x[at], 1, &y[held_at]);
    add_product(turned_over(tip.mass_coupling), &x[held_at], 1, &y[at]);
  }
}

void FrameSolver::Impl::solve_with_tips(std::span<const double> b, std::span<double> x) const {
  const std::size_t count = 6 * std::size_t{links.node_count()};
  std::vector<double> right(b.begin(), b.begin() + static_cast<long>(count));
  for (const Tip& tip : tips) {
    if (tip.node >= kFixed) continue;
    Six moved{};
    add_product(tip.inverse, &b[6 * std::size_t{tip_of(tip.member)}], 1, moved.data());
    add_product(tip.coupling, moved.data(), -1, &right[6 * std::size_t{tip.node}]);
  }
  std::ranges::fill(x, 0.0);
  if (factor) factor->solve(right, x.first(count));
  for (const Tip& tip : tips) {
    const std::size_t at = 6 * std::size_t{tip_of(tip.member)};
    Six left;
    std::copy_n(&b[at], 6, left.begin());
    if (tip.node < kFixed)
      add_product(turned_over(tip.coupling), &x[6 * std::size_t{tip.node}], -1, left.data());
    add_product(tip.inverse, left.data(), 1, &x[at]);
  }
}

void FrameSolver::rest_tips(std::span<double> u, const FrameLoads& loads) const {
  std::vector<double> f(u.size());
  load_vector(loads, f);
  for (const Impl::Tip& tip : impl_->tips) {
    const Impl::Member& member = impl_->members[tip.member];
    const auto held_end = static_cast<std::size_t>(member.held_end), free_end = 1 - held_end;
    const Matrix12 stiffness = stiffness_of(impl_->elements[tip.member]);
    const std::size_t at = 6 * std::size_t{impl_->tip_of(tip.member)};
    Six rest;
    std::copy_n(&f[at], 6, rest.begin());
    if (tip.node < kFixed)
      add_product(block_of(stiffness, free_end, held_end), &u[6 * std::size_t{tip.node}], -1,
                  rest.data());
    std::fill_n(&u[at], 6, 0.0);
    add_product(inverse_of(block_of(stiffness, free_end, free_end)), rest.data(), 1, &u[at]);
  }
}

std::vector<FrameSolver::BegunTip> FrameSolver::begun_tips() {
  begin_tips(impl_->begun, impl_->u, true);
  return std::exchange(impl_->begun, {});
}

void FrameSolver::begin_tips(std::span<const BegunTip> begun, std::span<double> motion, bool bent) {
  for (const BegunTip& each : begun) {
    const std::span<double, 6> tip = motion.subspan(each.tip).first<6>();
    std::ranges::fill(tip, 0.0);
    if (each.from != kHeld) std::ranges::copy(motion.subspan(each.from, 6), tip.begin());
    if (!bent) continue;
    const double more[6] = {each.moved.x,  each.moved.y,  each.moved.z,
                            each.turned.x, each.turned.y, each.turned.z};
    for (std::size_t i = 0; i < 6; ++i) tip[i] += more[i];
  }
}

std::size_t FrameSolver::freedom_of_tip(std::uint32_t member) const {
  return impl_->members[member].tip ? 6 * std::size_t{impl_->tip_of(member)} : kHeld;
}

}  // namespace sunder
