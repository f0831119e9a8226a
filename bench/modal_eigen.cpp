// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/modal_eigen.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace sunder {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Column by column; `times` is the solver's product with a vector.
template <class Product>
Matrix dense(std::size_t size, const Product& times) {
  Matrix matrix(size, size);
  std::vector<double> unit(size, 0), column(size);
  for (std::size_t i = 0; i < size; ++i) {
    unit[i] = 1;
    times(unit, column);
    for (std::size_t k = 0; k < size; ++k) matrix(k, i) = column[k];
    unit[i] = 0;
  }
  return 0.5 * (matrix + matrix.transpose());
}

Vector as_vector(std::span<const double> values) {
  return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

struct ModalMotion::Impl {
  Vector rest, share, frequency;  // ω, rad/s; without mass: no share
  Matrix modes;
  std::vector<Eigen::Index> freedoms;  // that have stiffness: others are spare
};

// M φ = µ K φ, since K is definite and M may have nodes without mass; ω² = 1/µ.
ModalMotion::ModalMotion(const FrameSolver& solver, std::span<const double> start,
                         std::span<const double> rest)
    : impl_(std::make_unique<Impl>()) {
  const std::size_t size = solver.freedoms();
  const Matrix stiffness =
      dense(size, [&](const auto& u, auto& f) { solver.stiffness_times(u, f); });
  const Matrix mass = dense(size, [&](const auto& a, auto& f) { solver.mass_times(a, f); });
  for (Eigen::Index i = 0; i < stiffness.rows(); ++i)
    if (stiffness(i, i) > 0) impl_->freedoms.push_back(i);
  const auto& kept = impl_->freedoms;
  const Matrix stiff = stiffness(kept, kept);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> pairs(mass(kept, kept), stiff);
  impl_->rest = as_vector(rest);
  impl_->modes = pairs.eigenvectors();
  const Vector off = (as_vector(start) - impl_->rest)(kept);
  impl_->share = impl_->modes.transpose() * stiff * off;
  impl_->frequency = Vector::Zero(impl_->share.size());
  const double least = 1e-13 * pairs.eigenvalues().maxCoeff();
  for (Eigen::Index i = 0; i < impl_->share.size(); ++i) {
    if (pairs.eigenvalues()[i] > least)
      impl_->frequency[i] = 1 / std::sqrt(pairs.eigenvalues()[i]);
    else
      impl_->share[i] = 0;
  }
}

ModalMotion::~ModalMotion() = default;

std::vector<double> ModalMotion::at(double time) const {
  const Vector now = (impl_->frequency.array() * time).cos() * impl_->share.array();
  Vector u = impl_->rest;
  u(impl_->freedoms) += impl_->modes * now;
  return {u.data(), u.data() + u.size()};
}

}  // namespace sunder
