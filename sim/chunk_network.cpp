// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid-body-spring network: T. Kawai, New discrete models and their application to seismic
// response analysis of structures, Nuclear Engineering and Design 48 (1978); J. E. Bolander and S.
// Saito, Fracture analyses using spring networks with random geometry, Engineering Fracture
// Mechanics 61 (1998). Static condensation: R. J. Guyan, AIAA Journal 3 (1965).
#include "sim/chunk_network.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "meshing/error.hpp"
#include "sim/block_factor.hpp"
#include "sim/cell_sites.hpp"

namespace sunder {
namespace {

constexpr double kShortest = 1e-5;  // of a bond, by the size of the smaller chunk
constexpr double kTie = 1e-9;       // utilisations this near are equal

/// An anchor's end in the world: how its six numbers follow those of an edge's two corners, or the
/// translations of all four.
struct Anchor {
  std::uint32_t edge = 0;
  bool is_straight = false;
  EdgeMotion motion{};
  /// Where its 12 columns stand among the 24.
  std::size_t column(std::size_t i) const {
    if (is_straight) return 6 * (i / 3) + i % 3;
    return i < 6 ? 6 * edge + i : 6 * ((edge + 1) % 4) + i - 6;
  }
};

struct Link {
  std::uint32_t a = 0, b = 0;
  std::optional<BondSpring> spring;  ///< none: too short
  std::uint32_t anchor = 0;          ///< if b is kWorld
  Vec3 centroid;
  bool is_broken = false, is_active = false;
};

void expect_above_zero(double value, const char* what, const std::string& material) {
  if (value > 0 && std::isfinite(value)) return;
  char text[64];
  std::snprintf(text, sizeof text, " = %g, a network of chunks needs it above 0", value);
  throw Error(ErrorCode::input, "material " + material + ": " + what + text);
}

void expect_material(const Material& m) {
  expect_above_zero(m.density, "density", m.name);
  expect_above_zero(m.youngs_modulus, "youngs_modulus", m.name);
  expect_above_zero(m.tensile_strength, "tensile_strength", m.name);
  expect_above_zero(m.compressive_strength, "compressive_strength", m.name);
  if (m.compressive_strength < m.tensile_strength)
    throw Error(ErrorCode::input, "material " + m.name +
                                      ": compressive_strength is below tensile_strength, a Mohr "
                                      "envelope needs it above");
}

void expect_corners(const PanelCorners& corners) {
  for (std::size_t k = 0; k < 4; ++k)
    if (!(length(corners[(k + 1) % 4] - corners[k]) > 0))
      throw Error(ErrorCode::geometry, "panel: corners " + std::to_string(k) + " and " +
                                           std::to_string((k + 1) % 4) +
                                           " are in one place, an edge needs a length");
}

void expect_id(std::uint32_t id, std::size_t count, const char* what) {
  if (id >= count)
    throw Error(ErrorCode::input, std::string("panel: ") + what + " " + std::to_string(id) +
                                      " does not exist, there are " + std::to_string(count));
}

Matrix12 negative(Matrix12 m) {
  for (double& value : m.at) value = -value;
  return m;
}

}  // namespace

struct ChunkNetwork::Impl {
  Material material;
  PanelHold panel;
  double size = 0;  // of the panel, m
  std::vector<Vec3> centres;
  std::vector<Vec2> sites;
  std::vector<double> masses;
  std::vector<Link> links;
  std::vector<Anchor> anchors;
  std::vector<std::vector<std::uint32_t>> links_of;  // per chunk
  std::vector<char> is_removed, is_held;
  std::optional<BlockFactor> factor;
  Vec3 gravity;
  std::vector<ChunkForce> contacts;
  // Of the condensation: chunks' motion per unit of a freedom with the sign turned, 24 columns.
  bool is_condensed = false;
  std::vector<double> motion;
  PanelMatrix condensed{};
  double highest = 0;  // utilisation at the last balance

  Impl(const WallAsset& asset, const Material& of, const PanelHold& in);
  void make_links(const WallAsset& asset);
  Link make_link(const WallAsset& asset, const Bond& bond);
  void factor_anew();
  std::vector<char> held_chunks() const;
  void update();
  BlockChange hold(std::uint32_t chunk) const;
  BlockChange change_of(const Link& link, bool is_added) const;
  std::vector<double> loads() const;
  void condense();
  void couple(std::span<double> columns) const;
  PanelMatrix corner_stiffness() const;
  Six world_motion(const Link& link, const PanelFreedoms& freedoms) const;
  std::vector<double> driven(std::vector<double> f, const PanelFreedoms& freedoms) const;
  std::vector<BondStress> stresses(std::span<const double> x, const PanelFreedoms& freedoms) const;
  std::vector<BondStress> balance(const PanelFreedoms& freedoms);
  double residual(const std::vector<double>& f, const std::vector<BondStress>& bonds) const;
  Twelve ends(const Link& link, std::span<const double> x, const PanelFreedoms& freedoms) const;
  std::size_t chunk_count() const { return centres.size(); }
};

ChunkNetwork::Impl::Impl(const WallAsset& asset, const Material& of, const PanelHold& in)
    : material(of), panel(in) {
  expect_material(material);
  expect_corners(panel.corners);
  const PanelCorners& corners = panel.corners;
  size = std::max(length(corners[2] - corners[0]), length(corners[3] - corners[1]));
  std::vector<Vec2> places;
  for (const MassProperties& chunk : asset.chunks) {
    centres.push_back({chunk.centroid.x, chunk.centroid.y, 0});
    places.push_back({chunk.centroid.x, chunk.centroid.y});
    masses.push_back(material.density * chunk.volume);
  }
  sites = cell_sites(asset.pattern, places);
  is_removed.assign(chunk_count(), 0);
  make_links(asset);
  is_held = held_chunks();
  factor_anew();
}

Link ChunkNetwork::Impl::make_link(const WallAsset& asset, const Bond& bond) {
  const double thickness = asset.wall.thickness;
  Link link;
  link.a = bond.a;
  link.b = bond.b;
  link.centroid = bond.centroid;
  const bool is_anchor = bond.b == kWorld;
  double volume = asset.chunks[bond.a].volume;
  if (!is_anchor) volume = std::min(volume, asset.chunks[bond.b].volume);
  if (bond.area / thickness < kShortest * std::sqrt(volume / thickness)) return link;
  BondEnds ends{centres[bond.a], {}, sites[bond.a], {}, false};
  if (is_anchor) {
    const Vec2 n{bond.normal.x, bond.normal.y};
    const Vec2 face{bond.centroid.x, bond.centroid.y};
    ends.site_b = ends.site_a + dot(face - ends.site_a, n) * n;
    ends.at_b = {ends.site_b.x, ends.site_b.y, 0};
    link.anchor = static_cast<std::uint32_t>(anchors.size());
    const std::uint32_t edge = edge_of(panel.corners, bond.centroid, bond.normal);
    ends.is_hinged = panel.hinged[edge];
    anchors.push_back({edge, panel.is_straight,
                       panel.is_straight ? surface_motion(panel.corners, ends.at_b)
                                         : edge_motion(panel.corners, edge, ends.at_b)});
  } else {
    ends.at_b = centres[bond.b];
    ends.site_b = sites[bond.b];
  }
  link.spring.emplace(bond, ends, thickness, material.youngs_modulus);
  return link;
}

void ChunkNetwork::Impl::make_links(const WallAsset& asset) {
  links_of.resize(chunk_count());
  links.reserve(asset.bonds.size());
  for (const Bond& bond : asset.bonds) {
    const auto id = static_cast<std::uint32_t>(links.size());
    links.push_back(make_link(asset, bond));
    links.back().is_broken = !links.back().spring;
    links_of[bond.a].push_back(id);
    if (bond.b != kWorld) links_of[bond.b].push_back(id);
  }
}

std::vector<char> ChunkNetwork::Impl::held_chunks() const {
  std::vector<char> held(chunk_count(), 0);
  std::vector<std::uint32_t> found;
  const auto reach = [&](std::uint32_t chunk) {
    if (held[chunk] || is_removed[chunk]) return;
    held[chunk] = 1;
    found.push_back(chunk);
  };
  for (const Link& link : links)
    if (link.b == kWorld && !link.is_broken) reach(link.a);
  while (!found.empty()) {
    const std::uint32_t chunk = found.back();
    found.pop_back();
    for (const std::uint32_t id : links_of[chunk]) {
      const Link& link = links[id];
      if (link.b != kWorld && !link.is_broken) reach(link.a == chunk ? link.b : link.a);
    }
  }
  return held;
}

/// What keeps the rows of a chunk that is not held regular.
BlockChange ChunkNetwork::Impl::hold(std::uint32_t chunk) const {
  BlockChange change{chunk, chunk, {}};
  for (const std::uint32_t id : links_of[chunk]) {
    const Link& link = links[id];
    if (!link.spring) continue;
    const int from = link.a == chunk ? 0 : 6;
    for (int i = 0; i < 6; ++i) change.delta(i, i) += link.spring->stiffness()(from + i, from + i);
  }
  for (int i = 0; i < 6; ++i)
    if (!(change.delta(i, i) > 0)) change.delta(i, i) = material.youngs_modulus * size;
  return change;
}

BlockChange ChunkNetwork::Impl::change_of(const Link& link, bool is_added) const {
  const Matrix12& k = link.spring->stiffness();
  return {link.a, link.b == kWorld ? link.a : link.b, is_added ? k : negative(k)};
}

void ChunkNetwork::Impl::factor_anew() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Link& link : links)
    if (link.b != kWorld && link.spring) edges.emplace_back(link.a, link.b);
  factor.emplace(static_cast<std::uint32_t>(chunk_count()), edges);
  for (Link& link : links) {
    link.is_active = !link.is_broken && is_held[link.a] && (link.b == kWorld || is_held[link.b]);
    if (link.is_active) factor->add(change_of(link, true));
  }
  for (std::uint32_t c = 0; c < chunk_count(); ++c)
    if (!is_held[c]) factor->add(hold(c));
  const std::uint32_t weak = factor->factor();
  if (weak == BlockFactor::kNoNode) return;
  // Held by so little that rounding wipes it out: it is loose.
  for (const std::uint32_t id : links_of[weak]) links[id].is_broken = true;
  is_held = held_chunks();
  factor_anew();
}

void ChunkNetwork::Impl::update() {
  const std::vector<char> held = held_chunks();
  std::vector<BlockChange> changes;
  for (std::uint32_t c = 0; c < chunk_count(); ++c)
    if (is_held[c] && !held[c]) changes.push_back(hold(c));
  for (Link& link : links) {
    if (!link.is_active) continue;
    if (!link.is_broken && held[link.a] && (link.b == kWorld || held[link.b])) continue;
    link.is_active = false;
    changes.push_back(change_of(link, false));
  }
  is_held = held;
  if (changes.empty()) return;
  is_condensed = false;
  if (factor->change(changes) != BlockFactor::kNoNode) factor_anew();
}

std::vector<double> ChunkNetwork::Impl::loads() const {
  std::vector<double> f(6 * chunk_count());
  const auto add = [&](std::uint32_t chunk, Vec3 force, Vec3 moment) {
    if (!is_held[chunk]) return;
    const double six[6] = {force.x, force.y, force.z, moment.x, moment.y, moment.z};
    for (std::size_t i = 0; i < 6; ++i) f[6 * chunk + i] += six[i];
  };
  for (std::uint32_t c = 0; c < chunk_count(); ++c) add(c, masses[c] * gravity, {});
  for (const ChunkForce& contact : contacts)
    add(contact.chunk, contact.force, cross(contact.point - centres[contact.chunk], contact.force));
  return f;
}

/// Columns of the stiffness between chunks and freedoms, one after another.
void ChunkNetwork::Impl::couple(std::span<double> columns) const {
  const std::size_t rows = 6 * chunk_count();
  for (const Link& link : links) {
    if (link.b != kWorld || !link.is_active) continue;
    const Anchor& anchor = anchors[link.anchor];
    const Matrix12& k = link.spring->stiffness();
    for (std::size_t c = 0; c < 12; ++c)
      for (int r = 0; r < 6; ++r) {
        double sum = 0;
        for (int i = 0; i < 6; ++i)
          sum += k(r, 6 + i) * anchor.motion[static_cast<std::size_t>(i)][c];
        columns[rows * anchor.column(c) + 6 * link.a + static_cast<std::size_t>(r)] += sum;
      }
  }
}

/// Of the anchors alone, with every chunk held.
PanelMatrix ChunkNetwork::Impl::corner_stiffness() const {
  PanelMatrix sum{};
  for (const Link& link : links) {
    if (link.b != kWorld || !link.is_active) continue;
    const Anchor& anchor = anchors[link.anchor];
    const Matrix12& k = link.spring->stiffness();
    std::array<std::array<double, 12>, 6> force{};  // on the world's end, per unit of the corners
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t c = 0; c < 12; ++c)
          force[r][c] += k(static_cast<int>(6 + r), static_cast<int>(6 + i)) * anchor.motion[i][c];
    for (std::size_t r = 0; r < 12; ++r)
      for (std::size_t c = 0; c < 12; ++c)
        for (std::size_t i = 0; i < 6; ++i)
          sum[24 * anchor.column(r) + anchor.column(c)] += anchor.motion[i][r] * force[i][c];
  }
  return sum;
}

void ChunkNetwork::Impl::condense() {
  if (is_condensed) return;
  const std::size_t rows = 6 * chunk_count();
  std::vector<double> coupling(24 * rows);
  couple(coupling);
  motion.assign(24 * rows, 0);
  condensed = corner_stiffness();
  for (std::size_t c = 0; c < 24; ++c) {
    const std::span<const double> column(&coupling[c * rows], rows);
    if (std::ranges::all_of(column, [](double v) { return v == 0; })) continue;
    factor->solve(column, std::span<double>(&motion[c * rows], rows));
  }
  for (std::size_t r = 0; r < 24; ++r)
    for (std::size_t c = 0; c < 24; ++c) {
      double sum = 0;
      for (std::size_t i = 0; i < rows; ++i) sum += coupling[r * rows + i] * motion[c * rows + i];
      condensed[24 * r + c] -= sum;
    }
  for (std::size_t r = 0; r < 24; ++r)
    for (std::size_t c = 0; c < r; ++c)
      condensed[24 * r + c] = condensed[24 * c + r] =
          (condensed[24 * r + c] + condensed[24 * c + r]) / 2;
  is_condensed = true;
}

Six ChunkNetwork::Impl::world_motion(const Link& link, const PanelFreedoms& freedoms) const {
  const Anchor& anchor = anchors[link.anchor];
  Six six{};
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = 0; c < 12; ++c) six[r] += anchor.motion[r][c] * freedoms[anchor.column(c)];
  return six;
}

Twelve ChunkNetwork::Impl::ends(const Link& link, std::span<const double> x,
                                const PanelFreedoms& freedoms) const {
  Twelve both;
  std::copy_n(&x[6 * link.a], 6, both.begin());
  if (link.b != kWorld) {
    std::copy_n(&x[6 * link.b], 6, both.begin() + 6);
  } else {
    const Six moved = world_motion(link, freedoms);
    std::ranges::copy(moved, both.begin() + 6);
  }
  return both;
}

/// Forces on the chunks with what the moved corners add.
std::vector<double> ChunkNetwork::Impl::driven(std::vector<double> f,
                                               const PanelFreedoms& freedoms) const {
  for (const Link& link : links) {
    if (link.b != kWorld || !link.is_active) continue;
    const Six moved = world_motion(link, freedoms);
    const Matrix12& k = link.spring->stiffness();
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t c = 0; c < 6; ++c)
        f[6 * link.a + r] -= k(static_cast<int>(r), static_cast<int>(6 + c)) * moved[c];
  }
  return f;
}

std::vector<BondStress> ChunkNetwork::Impl::stresses(std::span<const double> x,
                                                     const PanelFreedoms& freedoms) const {
  std::vector<BondStress> result(links.size());
  for (std::size_t id = 0; id < links.size(); ++id)
    if (links[id].is_active)
      result[id] = links[id].spring->stress(ends(links[id], x, freedoms), material);
  return result;
}

std::vector<BondStress> ChunkNetwork::Impl::balance(const PanelFreedoms& freedoms) {
  const std::vector<double> f = loads();
  std::vector<double> x(f.size());
  factor->solve(driven(f, freedoms), x);
  std::vector<BondStress> bonds = stresses(x, freedoms);
  highest = 0;
  for (const BondStress& bond : bonds) highest = std::max(highest, bond.utilisation);
  return bonds;
}

double ChunkNetwork::Impl::residual(const std::vector<double>& f,
                                    const std::vector<BondStress>& bonds) const {
  std::vector<double> left = f;
  double largest = 0, worst = 0;
  for (std::size_t id = 0; id < links.size(); ++id) {
    const Link& link = links[id];
    if (!link.is_active) continue;
    const BondStress& s = bonds[id];
    largest = std::max(largest, length(s.force) + length(s.moment) / size);
    for (const std::uint32_t chunk : {link.a, link.b}) {
      if (chunk == kWorld) continue;
      const double sign = chunk == link.a ? 1 : -1;
      const Vec3 turn = s.moment + cross(link.centroid - centres[chunk], s.force);
      const double six[6] = {s.force.x, s.force.y, s.force.z, turn.x, turn.y, turn.z};
      for (std::size_t i = 0; i < 6; ++i) left[6 * chunk + i] += sign * six[i];
    }
  }
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double scale = i % 6 < 3 ? 1 : 1 / size;
    largest = std::max(largest, std::abs(f[i]) * scale);
    worst = std::max(worst, std::abs(left[i]) * scale);
  }
  return largest > 0 ? worst / largest : 0;
}

ChunkNetwork::ChunkNetwork(const WallAsset& asset, const Material& material, const PanelHold& hold)
    : impl_(std::make_unique<Impl>(asset, material, hold)) {}
ChunkNetwork::~ChunkNetwork() = default;
ChunkNetwork::ChunkNetwork(ChunkNetwork&&) noexcept = default;

void ChunkNetwork::set_gravity(Vec3 gravity) {
  impl_->gravity = gravity;
}

void ChunkNetwork::set_contacts(std::span<const ChunkForce> contacts) {
  for (const ChunkForce& contact : contacts)
    expect_id(contact.chunk, impl_->chunk_count(), "chunk");
  impl_->contacts.assign(contacts.begin(), contacts.end());
}

const PanelMatrix& ChunkNetwork::stiffness() {
  impl_->condense();
  return impl_->condensed;
}

PanelFreedoms ChunkNetwork::load() {
  impl_->condense();
  const std::vector<double> f = impl_->loads();
  PanelFreedoms load{};
  for (std::size_t c = 0; c < 24; ++c)
    for (std::size_t i = 0; i < f.size(); ++i) load[c] -= impl_->motion[c * f.size() + i] * f[i];
  return load;
}

PanelState ChunkNetwork::solve(const PanelFreedoms& freedoms) const {
  const Impl& net = *impl_;
  const std::vector<double> f = net.loads();
  std::vector<double> x(f.size());
  net.factor->solve(net.driven(f, freedoms), x);
  PanelState state;
  state.bonds = net.stresses(x, freedoms);
  state.residual = net.residual(f, state.bonds);
  state.displacements.resize(net.chunk_count());
  for (std::uint32_t c = 0; c < net.chunk_count(); ++c)
    if (net.is_held[c]) std::copy_n(&x[6 * c], 6, state.displacements[c].begin());
  return state;
}

Reaction ChunkNetwork::reaction(const PanelState& state, std::uint32_t edge, Vec3 about) const {
  Reaction sum;
  for (std::size_t id = 0; id < impl_->links.size(); ++id) {
    const Link& link = impl_->links[id];
    if (link.b != kWorld || !link.is_active || impl_->anchors[link.anchor].edge != edge) continue;
    const BondStress& s = state.bonds[id];
    sum.force = sum.force + s.force;
    sum.moment = sum.moment + s.moment + cross(link.centroid - about, s.force);
  }
  return sum;
}

void ChunkNetwork::break_bonds(std::span<const std::uint32_t> bonds) {
  for (const std::uint32_t id : bonds) expect_id(id, impl_->links.size(), "bond");
  for (const std::uint32_t id : bonds) impl_->links[id].is_broken = true;
  impl_->update();
}

void ChunkNetwork::remove_chunks(std::span<const std::uint32_t> chunks) {
  for (const std::uint32_t chunk : chunks) expect_id(chunk, impl_->chunk_count(), "chunk");
  for (const std::uint32_t chunk : chunks) {
    impl_->is_removed[chunk] = 1;
    for (const std::uint32_t id : impl_->links_of[chunk]) impl_->links[id].is_broken = true;
  }
  impl_->update();
}

std::vector<std::uint32_t> ChunkNetwork::loose_chunks() const {
  std::vector<std::uint32_t> loose;
  for (std::uint32_t c = 0; c < impl_->chunk_count(); ++c)
    if (!impl_->is_held[c] && !impl_->is_removed[c]) loose.push_back(c);
  return loose;
}

std::vector<BrokenBond> ChunkNetwork::cascade(const PanelFreedoms& freedoms, std::uint32_t most) {
  std::vector<BrokenBond> broken;
  while (broken.size() < most) {
    const std::vector<BondStress> bonds = impl_->balance(freedoms);
    const double highest = impl_->highest;
    if (!(highest > 1)) break;
    const auto worst = std::ranges::find_if(
        bonds, [&](const BondStress& bond) { return bond.utilisation >= (1 - kTie) * highest; });
    const auto id = static_cast<std::uint32_t>(worst - bonds.begin());
    broken.push_back({id, worst->utilisation, worst->mode});
    break_bonds(std::span(&id, 1));
  }
  return broken;
}

double ChunkNetwork::highest(const PanelFreedoms& freedoms) {
  impl_->balance(freedoms);
  return impl_->highest;
}
double ChunkNetwork::highest() const {
  return impl_->highest;
}

bool ChunkNetwork::is_intact(std::uint32_t bond) const {
  return impl_->links[bond].is_active;
}

double ChunkNetwork::mass() const {
  double sum = 0;
  for (std::size_t c = 0; c < impl_->chunk_count(); ++c)
    if (impl_->is_held[c]) sum += impl_->masses[c];
  return sum;
}

std::vector<Vec2> ChunkNetwork::sites() const {
  return impl_->sites;
}

}  // namespace sunder
