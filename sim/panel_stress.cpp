// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_stress.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunder {
namespace {

constexpr double kNoForce = 1;  // N: contacts below it are over

}  // namespace

PanelStress::PanelStress(const WallAsset& asset, const Material& material, const PanelHold& hold,
                         Vec3 gravity)
    : network_(asset, material, hold),
      intact_(asset.bonds.size(), 1),
      present_(asset.chunks.size(), 1),
      give_(material.tensile_strength / material.youngs_modulus * asset.wall.thickness) {
  network_.set_gravity(gravity);
}

void PanelStress::touch(std::uint32_t chunk, Vec3 point, Vec3 impulse) {
  auto at = std::ranges::lower_bound(touches_, chunk, {}, &Touch::chunk);
  if (at == touches_.end() || at->chunk != chunk) at = touches_.insert(at, {.chunk = chunk});
  const double size = length(impulse);
  at->impulse = at->impulse + impulse;
  at->size += size;
  at->weighted = at->weighted + size * point;
}

void PanelStress::end_step(double dt, double load_time, double max_error) {
  const double share = dt / (dt + load_time);
  for (Touch& touch : touches_) {
    if (touch.size > 0) touch.point = (1 / touch.size) * touch.weighted;
    const Vec3 force = touch.force + share * ((1 / dt) * touch.impulse - touch.force);
    const double known = std::max(length(touch.settled), kNoForce);
    is_stale_ |= length(force - touch.settled) > max_error * known;
    touch.force = force;
    touch.impulse = touch.weighted = {};
    touch.size = 0;
  }
  std::erase_if(touches_, [&](const Touch& touch) {
    const bool is_over = length(touch.force) < kNoForce;
    is_stale_ |= is_over && length(touch.settled) >= kNoForce;
    return is_over;
  });
}

void PanelStress::follow(const Island& island) {
  if (!island.graph) return;
  std::vector<std::uint32_t> broken, gone;
  for (std::uint32_t b = 0; b < island.bonds.size(); ++b)
    if (intact_[b] != 0 && !island.graph->is_intact(b)) broken.push_back(b);
  for (std::uint32_t local = 0; local < island.chunks.size(); ++local)
    if (present_[island.chunks[local]] != 0 && !island.graph->is_present(local))
      gone.push_back(island.chunks[local]);
  for (const std::uint32_t b : broken) intact_[b] = 0;
  for (const std::uint32_t chunk : gone) present_[chunk] = 0;
  if (!broken.empty()) network_.break_bonds(broken);
  if (!gone.empty()) network_.remove_chunks(gone);
  std::erase_if(touches_, [&](const Touch& touch) { return present_[touch.chunk] == 0; });
  is_stale_ |= !broken.empty() || !gone.empty();
  if (!broken.empty() || !gone.empty()) note_broken();
}

void PanelStress::note_broken() {
  is_broken_ = is_softer_ = true;
}

std::optional<Matrix12> PanelStress::softened(const Quaternion& to_world) {
  if (!std::exchange(is_softer_, false)) return {};
  return stiffness_of(network_, to_world);
}

bool PanelStress::is_stale(const PanelFreedoms& corners, double max_error) const {
  if (is_stale_) return true;
  double most = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    most = std::max(most, std::abs(corners[i] - last_[i]));
  return most > max_error * give_;
}

std::vector<BrokenBond> PanelStress::settle(const PanelFreedoms& corners) {
  std::vector<ChunkForce> forces;
  for (Touch& touch : touches_) {
    touch.settled = touch.force;
    forces.push_back({touch.chunk, touch.point, touch.force});
  }
  network_.set_contacts(forces);
  const std::vector<BrokenBond> broken = network_.cascade(corners);
  for (const BrokenBond& bond : broken) intact_[bond.bond] = 0;
  if (!broken.empty()) note_broken();
  utilisation_ = network_.highest();
  last_ = corners;
  is_stale_ = false;
  return broken;
}

}  // namespace sunder
