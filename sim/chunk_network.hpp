// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fracture/asset.hpp"
#include "sim/bond_spring.hpp"
#include "sim/material.hpp"
#include "sim/panel_edges.hpp"

namespace sunder {

/// Symmetric 24 × 24, row by row, of PanelFreedoms.
using PanelMatrix = std::array<double, 576>;

/// A force on a chunk, N, at a point, m; wall frame.
struct ChunkForce {
  std::uint32_t chunk = 0;
  Vec3 point, force;
};

/// Balance of a panel whose corners are held somewhere.
struct PanelState {
  std::vector<Six> displacements;  ///< of the chunks' centres of mass; 0 of those not held
  std::vector<BondStress> bonds;   ///< by bond of the asset; 0 of those that bear nothing
  /// Largest force or moment (by the wall's size) left on a chunk, by the largest load or bond
  /// force: what rounding left.
  double residual = 0;
};

/// Force and moment about a point, N, N m.
struct Reaction {
  Vec3 force, moment;
};

/// A bond that the cascade broke.
struct BrokenBond {
  std::uint32_t bond = 0;
  double utilisation = 0;
  const char* mode = "";
};

/// A fractured wall or floor slab as a network of rigid chunks joined by their elastic faces
/// (BondSpring), held through its anchors by what it hangs in (PanelHold): an element of a frame
/// with 24 freedoms, or the 12 translations among them, condensed exactly. Chunks that no path of
/// bonds joins to an anchor are *loose*: they bear nothing and load nothing until the caller takes
/// them away. Small displacements. The same calls give the same bits. Not thread-safe.
class ChunkNetwork {
 public:
  /// Weight by the material's density. Bonds shorter than 1e-5 of the size of a chunk bear nothing.
  /// Throws Error{input} unless Young's modulus, both strengths and the density are above 0 and
  /// f_c >= f_t, Error{geometry} if two corners next to each other are in one place.
  ChunkNetwork(const WallAsset& asset, const Material& material, const PanelHold& hold);
  ~ChunkNetwork();
  ChunkNetwork(ChunkNetwork&&) noexcept;

  /// Acceleration, m/s², wall frame; 0 at the start.
  void set_gravity(Vec3 gravity);
  /// Replaces all contacts; those on chunks that are not held load nothing. This and what follows
  /// throws Error{input} for a chunk or bond that does not exist.
  void set_contacts(std::span<const ChunkForce> contacts);

  /// Force that corners which move by one unit must put on the panel. O(24 solves) after a change.
  const PanelMatrix& stiffness();
  /// What weight and contacts put on the corners while these stand still: forces and moments.
  /// After a change as stiffness(), else O(24 chunks).
  PanelFreedoms load();
  /// The panel in balance with its corners at `freedoms`. One solve.
  PanelState solve(const PanelFreedoms& freedoms) const;
  /// What the anchors of an edge put on the panel in that state, about a point.
  Reaction reaction(const PanelState& state, std::uint32_t edge, Vec3 about) const;

  /// Ids of the asset's bonds; those that are broken already may be among them.
  void break_bonds(std::span<const std::uint32_t> bonds);
  /// These chunks are no longer part of the panel, with all their bonds.
  void remove_chunks(std::span<const std::uint32_t> chunks);
  /// Chunks that are not removed and hang on nothing, ascending.
  std::vector<std::uint32_t> loose_chunks() const;
  /// Breaks the most utilised bond above 1, of those equal to 1e-9 the one of lowest id, puts the
  /// panel in balance again at the same corners, and so on; at most `most` bonds. In their order.
  std::vector<BrokenBond> cascade(const PanelFreedoms& freedoms, std::uint32_t most = 0xFFFFFFFFu);

  /// Largest utilisation of a bond, with the corners at `freedoms`. One solve.
  double highest(const PanelFreedoms& freedoms);
  double highest() const;  ///< when it was asked for last, or a cascade ended

  bool is_intact(std::uint32_t bond) const;  ///< and both its ends held
  double mass() const;                       ///< of the chunks that are held, kg
  std::vector<Vec2> sites() const;           ///< that the springs' lengths are taken from, m

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
