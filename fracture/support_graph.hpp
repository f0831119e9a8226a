// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fracture/bonds.hpp"

namespace sunder {

/// Chunks, their intact bonds, and the anchors: which chunks hang together, kept up to date while
/// bonds break. Memory: O(chunks + bonds).
class SupportGraph {
 public:
  /// `bonds` as find_bonds gives them.
  SupportGraph(std::uint32_t chunk_count, std::span<const Bond> bonds);

  /// Connected chunks that no longer hang on an anchor (or on the rest of a wall that has none).
  struct Island {
    std::vector<std::uint32_t> chunks;  ///< ascending
  };
  struct Change {
    std::vector<std::uint32_t> broken;  ///< bonds that were intact, ascending
    /// Islands that came loose now, in the order of their first chunk; their chunks leave the
    /// graph, the bonds inside them stay as they are. Of a graph without anchors the largest
    /// component (most chunks; the one with the smallest chunk on a tie) stays, the others are
    /// islands. What hung on nothing from the start comes loose in the first call.
    std::vector<Island> islands;
    std::uint64_t chunks_searched = 0;  ///< whose bonds were looked at
  };
  /// Breaks bonds and finds what came loose. Searches from the ends of the broken bonds in turns,
  /// smallest first, and stops when one group is left that is not yet closed off: the cost is that
  /// of the small sides, not of the wall. `exhaustive` searches the whole graph instead; same
  /// result.
  Change break_bonds(std::span<const std::uint32_t> bonds, bool exhaustive = false);

  bool is_intact(std::uint32_t bond) const { return intact_[bond] != 0; }
  bool is_present(std::uint32_t chunk) const { return present_[chunk] != 0; }  ///< not left yet
  std::span<const std::uint32_t> bonds_of(std::uint32_t chunk) const;  ///< intact or not, ascending
  std::uint32_t present_count() const { return present_count_; }
  bool has_anchors() const { return has_anchors_; }  ///< at the start

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  // Chunks that hang together; each chunk carries the number of its component. A component that
  // falls apart leaves its number to the part that is not closed off: nobody has to walk that part.
  struct Component {
    std::uint32_t size = 0, anchors = 0;  // chunks; their intact anchors
    std::uint32_t open = 0;               // groups of a search in it that are not closed off
  };
  // Chunks found from one or several ends of broken bonds, as two linked lists over next_: those
  // whose bonds were looked at, and those that wait for it.
  struct List {
    std::uint32_t first = kNone, last = kNone;
  };
  struct Group {
    std::uint32_t component = 0;
    std::uint32_t size = 0, anchors = 0;  // found so far
    List done, waiting;
    std::uint32_t merged_into = kNone;
    bool is_closed() const { return waiting.first == kNone; }
  };
  struct Turn {
    std::uint32_t size, group;  // as it was when the turn was queued
  };
  struct Ends {
    std::uint32_t a, b;
  };

  void find_components();
  void find_loose_components();
  std::vector<std::uint8_t> components_that_stay() const;
  void search_everything(Change& change);

  void search_small_sides(Change& change);
  void start_group(std::uint32_t chunk);
  void take_turns(Change& change);
  void look_at_next(std::uint32_t group, Change& change);
  void find(std::uint32_t chunk, std::uint32_t group);
  void join(std::uint32_t group, std::uint32_t other);
  std::uint32_t group_of(std::uint32_t chunk);
  void queue_turn(std::uint32_t group);
  void append(List& list, List other);
  void settle_hanging(Change& change);
  void settle_without_anchors(Change& change);
  std::uint32_t largest_group(Change& change);
  std::vector<std::uint32_t> all_chunks(std::uint32_t group, Change& change);
  void become_component(std::uint32_t group);
  void leave(std::vector<std::uint32_t> chunks, Change& change);

  std::vector<Ends> ends_;  // per bond
  std::vector<std::uint8_t> intact_, present_;
  std::vector<std::uint32_t> first_bond_, bonds_;  // bonds of chunk c: first_bond_[c] … [c + 1]
  std::vector<std::uint32_t> others_;              // per entry of bonds_: the other end
  std::vector<std::uint32_t> anchors_;             // per chunk: intact anchors
  std::vector<std::uint32_t> component_;           // per chunk, of those present
  std::vector<Component> components_;
  std::vector<std::uint32_t> loose_;  // first chunks of what hangs on nothing from the start
  std::uint32_t present_count_ = 0;
  bool has_anchors_ = false;

  // Of a search; a stamp tells what earlier ones found, so that nothing is cleared.
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> found_at_, group_, next_;  // per chunk
  std::vector<Group> groups_;
  std::vector<Turn> turns_;  // a heap, smallest first
};

}  // namespace sunder
