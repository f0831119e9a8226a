// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/bonds.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

// Edges of one cell towards one neighbour, summed.
struct Contact {
  std::uint32_t other = 0;
  double length = 0;
  Vec2 moment, vector, longest;  // ∫ position, Σ edge, longest single edge
};

Contact edge_contact(std::uint32_t other, Vec2 from, Vec2 to) {
  const Vec2 edge = to - from;
  const double size = length(edge);
  return {other, size, (size / 2) * (from + to), edge, edge};
}

void add(Contact& sum, const Contact& edge) {
  sum.length += edge.length;
  sum.moment = sum.moment + edge.moment;
  sum.vector = sum.vector + edge.vector;
  if (dot(edge.longest, edge.longest) > dot(sum.longest, sum.longest)) sum.longest = edge.longest;
}

Bond make_bond(std::uint32_t a, std::uint32_t b, const Contact& contact, double thickness) {
  // A neighbour that fills a hole has edges that sum to nothing: then the longest decides.
  const bool closed = length(contact.vector) < 1e-9 * contact.length;
  const Vec2 along = closed ? contact.longest : contact.vector;
  const double size = length(along);
  const Vec2 centre = (1 / contact.length) * contact.moment;
  return {a,
          b,
          contact.length * thickness,
          {centre.x, centre.y, 0},
          {along.y / size, -along.x / size, 0}};
}

}  // namespace

std::vector<Bond> find_bonds(const Pattern& pattern, double thickness,
                             std::span<const std::uint8_t> anchored) {
  std::vector<Bond> bonds, anchors;
  bonds.reserve(pattern.corners.size() / 2);
  std::vector<Contact> contacts;
  const auto collect = [&](std::vector<Contact>& into, const Contact& edge) {
    const auto it = std::ranges::find(into, edge.other, &Contact::other);
    if (it == into.end())
      into.push_back(edge);
    else
      add(*it, edge);
  };
  std::vector<Contact> sides;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    contacts.clear();
    sides.clear();
    const auto visit = [&](LoopRange loop) {
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        const Across a = pattern.across[k];
        if (!a.is_border() && a.cell() < cell) continue;
        const Vec2 from = pattern.vertices[pattern.corners[k]];
        const Vec2 to = pattern.vertices[pattern.corners[loop.next(k)]];
        if (!a.is_border())
          collect(contacts, edge_contact(a.cell(), from, to));
        else if (a.border() < anchored.size() && anchored[a.border()])
          collect(sides, edge_contact(a.border(), from, to));
      }
    };
    if (pattern.hole_begin.empty()) {
      visit({pattern.cell_begin[cell], pattern.cell_begin[cell + 1]});
    } else {
      for (const LoopRange loop : loops_of(pattern, cell)) visit(loop);
    }
    std::ranges::sort(contacts, {}, &Contact::other);
    for (const Contact& c : contacts) bonds.push_back(make_bond(cell, c.other, c, thickness));
    std::ranges::sort(sides, {}, &Contact::other);
    for (const Contact& c : sides) anchors.push_back(make_bond(cell, kWorld, c, thickness));
  }
  bonds.insert(bonds.end(), anchors.begin(), anchors.end());
  return bonds;
}

}  // namespace sunder
