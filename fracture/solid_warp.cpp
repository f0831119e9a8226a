// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_warp.hpp"

#include <algorithm>
#include <cmath>

#include "meshing/random.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr double kLipschitz = 0.9;
// Of value noise in three independent components of 1/√3 each, per amplitude and size: its steepest
// partial derivative is 2 · 15/8 / √3, the norm of nine such ones three times that.
constexpr double kNoiseSlope = 6.5;
// Of two sines of 1/2 in each of three components: √6 π.
constexpr double kWaveSlope = 7.7;

// Smooth step with two continuous derivatives.
double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

}  // namespace

SolidWarp::SolidWarp(const SolidModel& solid, double chunk, double share, std::uint64_t seed)
    : roughness_(solid.roughness),
      size_(solid.roughness_size > 0 ? solid.roughness_size : chunk / 2),
      seed_(seed) {
  double left = kLipschitz;  // of the Lipschitz constant
  if (const auto* slices = std::get_if<SolidSlicesParams>(&solid.pattern)) {
    amplitude_ = slices->amplitude;
    wavelength_ = slices->wavelength;
    waves_ = {slices->slices.x > 0 ? 1.0 : 0, slices->slices.y > 0 ? 1.0 : 0,
              slices->slices.z > 0 ? 1.0 : 0};
    const bool one = waves_.x + waves_.y + waves_.z <= 1;  // a shear: one to one at any slope
    if (amplitude_ > 0 && (!one || roughness_ > 0)) {
      if (roughness_ > 0) left /= 2;
      amplitude_ = std::min(amplitude_, left / kWaveSlope * wavelength_);
    }
  }
  for (std::uint64_t axis = 0; axis < 3; ++axis)
    for (std::uint64_t k = 0; k < 2; ++k) phases_[2 * axis + k] = random_unit(seed_, axis, k + 1);
  roughness_ = share * std::min(roughness_, left / kNoiseSlope * size_);
  amplitude_ *= share;
}

double SolidWarp::edge() const {
  double least = 1e300;
  if (roughness_ > 0) least = size_ / 2;
  if (amplitude_ > 0) least = std::min(least, wavelength_ / 8);
  return least;
}

Vec3 SolidWarp::noise(Vec3 place) const {
  const Vec3 p = (1 / size_) * place;
  const double x = std::floor(p.x), y = std::floor(p.y), z = std::floor(p.z);
  const double s[3] = {fade(p.x - x), fade(p.y - y), fade(p.z - z)};
  Vec3 sum;
  for (std::uint64_t corner = 0; corner < 8; ++corner) {
    const auto cell = [&](double v, int axis) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(v) +
                                        static_cast<std::int64_t>(corner >> axis & 1));
    };
    const std::uint64_t bits = random_bits(seed_, random_bits(cell(x, 0), cell(y, 1), cell(z, 2)));
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= corner >> axis & 1 ? s[axis] : 1 - s[axis];
    const auto part = [&](int shift) {
      return static_cast<double>(bits >> shift & 0x1FFFFF) * 0x1p-20 - 1;
    };
    sum = sum + weight * Vec3{part(0), part(21), part(42)};
  }
  return (1 / std::sqrt(3.0)) * sum;
}

Vec3 SolidWarp::displacement(Vec3 place) const {
  Vec3 sum;
  if (roughness_ > 0) sum = roughness_ * noise(place);
  if (amplitude_ > 0) {
    const double x = place.x / wavelength_, y = place.y / wavelength_, z = place.z / wavelength_;
    std::array<double, kSines> w{y + phases_[0], z + phases_[1], z + phases_[2],
                                 x + phases_[3], x + phases_[4], y + phases_[5]};
    sines_at_turns(w);
    const auto wave = [&](double a, double b) { return amplitude_ / 2 * (a + b); };
    sum = sum + Vec3{waves_.x > 0 ? wave(w[0], w[1]) : 0, waves_.y > 0 ? wave(w[2], w[3]) : 0,
                     waves_.z > 0 ? wave(w[4], w[5]) : 0};
  }
  return sum;
}

Vec3 SolidWarp::unwarped(Vec3 place) const {
  Vec3 x = place;
  for (int round = 0; round < 400; ++round) {
    const Vec3 next = place - displacement(x);
    const double moved = length(next - x);
    x = next;
    if (moved <= 0x1p-50 * (length(place) + roughness_ + amplitude_)) break;
  }
  return x;
}

}  // namespace sunder
