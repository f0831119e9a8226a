// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/support_graph.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

// Decremental connectivity by searching from both ends at once, after Even and Shiloach, "An
// On-Line Edge-Deletion Problem", J. ACM 28 (1981), process A: when an edge goes, a search from
// each end, in turns, closes off the smaller side first. Here with any number of ends, and with the
// sizes and anchors of the components kept, so that what is left over is known without being
// searched.

namespace sunder {

SupportGraph::SupportGraph(std::uint32_t chunk_count, std::span<const Bond> bonds)
    : intact_(bonds.size(), 1),
      present_(chunk_count, 1),
      first_bond_(chunk_count + std::size_t{1}, 0),
      anchors_(chunk_count, 0),
      component_(chunk_count, kNone),
      present_count_(chunk_count),
      found_at_(chunk_count, 0),
      group_(chunk_count, 0),
      next_(chunk_count, kNone) {
  ends_.reserve(bonds.size());
  for (const Bond& bond : bonds) {
    assert(bond.a < chunk_count && (bond.b < chunk_count || bond.b == kWorld));
    ends_.push_back({bond.a, bond.b});
    ++first_bond_[bond.a + std::size_t{1}];
    if (bond.b != kWorld)
      ++first_bond_[bond.b + std::size_t{1}];
    else
      ++anchors_[bond.a], has_anchors_ = true;
  }
  for (std::size_t c = 0; c < chunk_count; ++c) first_bond_[c + 1] += first_bond_[c];
  bonds_.resize(first_bond_.back());
  others_.resize(first_bond_.back());
  std::vector<std::uint32_t> end(first_bond_.begin(), first_bond_.end() - 1);
  const auto add = [&](std::uint32_t chunk, std::uint32_t bond, std::uint32_t other) {
    bonds_[end[chunk]] = bond;
    others_[end[chunk]++] = other;
  };
  for (std::uint32_t i = 0; i < ends_.size(); ++i) {
    add(ends_[i].a, i, ends_[i].b);
    if (ends_[i].b != kWorld) add(ends_[i].b, i, ends_[i].a);
  }
  find_components();
  find_loose_components();
}

std::span<const std::uint32_t> SupportGraph::bonds_of(std::uint32_t chunk) const {
  return std::span(bonds_).subspan(first_bond_[chunk],
                                   first_bond_[chunk + std::size_t{1}] - first_bond_[chunk]);
}

SupportGraph::Change SupportGraph::break_bonds(std::span<const std::uint32_t> bonds,
                                               bool exhaustive) {
  Change change;
  for (const std::uint32_t bond : bonds) {
    if (!intact_[bond]) continue;
    intact_[bond] = 0;
    change.broken.push_back(bond);
    const Ends ends = ends_[bond];
    if (ends.b != kWorld || !present_[ends.a]) continue;
    --anchors_[ends.a];
    --components_[component_[ends.a]].anchors;
  }
  std::ranges::sort(change.broken);
  if (exhaustive)
    search_everything(change);
  else
    search_small_sides(change);
  loose_.clear();
  std::ranges::sort(change.islands, {}, [](const Island& island) { return island.chunks[0]; });
  return change;
}

// Numbers the components of what is present, in the order of their first chunks.
void SupportGraph::find_components() {
  components_.clear();
  std::ranges::fill(component_, kNone);
  std::vector<std::uint32_t> open;
  for (std::uint32_t start = 0; start < present_.size(); ++start) {
    if (!present_[start] || component_[start] != kNone) continue;
    const auto number = static_cast<std::uint32_t>(components_.size());
    components_.emplace_back();
    component_[start] = number;
    open.push_back(start);
    while (!open.empty()) {
      const std::uint32_t chunk = open.back();
      open.pop_back();
      ++components_[number].size;
      components_[number].anchors += anchors_[chunk];
      for (std::uint32_t k = first_bond_[chunk]; k < first_bond_[chunk + std::size_t{1}]; ++k) {
        const std::uint32_t other = others_[k];
        if (!intact_[bonds_[k]] || other == kWorld || component_[other] != kNone) continue;
        component_[other] = number;
        open.push_back(other);
      }
    }
  }
}

// Without anchors it is open which component will stay after the first break: all are candidates.
void SupportGraph::find_loose_components() {
  if (!has_anchors_ && components_.size() == 1) return;
  std::uint32_t numbered = 0;
  for (std::uint32_t chunk = 0; chunk < present_.size(); ++chunk) {
    if (component_[chunk] != numbered) continue;
    if (components_[numbered].anchors == 0) loose_.push_back(chunk);
    ++numbered;
  }
}

// --- the whole graph
// ------------------------------------------------------------------------------

std::vector<std::uint8_t> SupportGraph::components_that_stay() const {
  std::vector<std::uint8_t> stays(components_.size(), 0);
  if (has_anchors_) {
    for (std::size_t i = 0; i < stays.size(); ++i) stays[i] = components_[i].anchors > 0;
  } else if (!stays.empty()) {
    const auto largest = std::ranges::max_element(components_, {}, &Component::size);
    stays[static_cast<std::size_t>(largest - components_.begin())] = 1;  // the first of several
  }
  return stays;
}

void SupportGraph::search_everything(Change& change) {
  find_components();
  change.chunks_searched += present_count_;
  const std::vector<std::uint8_t> stays = components_that_stay();
  std::vector<std::vector<std::uint32_t>> islands(components_.size());
  for (std::uint32_t chunk = 0; chunk < present_.size(); ++chunk)
    if (present_[chunk] && !stays[component_[chunk]]) islands[component_[chunk]].push_back(chunk);
  for (auto& chunks : islands)
    if (!chunks.empty()) leave(std::move(chunks), change);
}

void SupportGraph::leave(std::vector<std::uint32_t> chunks, Change& change) {
  for (const std::uint32_t chunk : chunks) present_[chunk] = 0;
  present_count_ -= static_cast<std::uint32_t>(chunks.size());
  change.islands.push_back({std::move(chunks)});
}

// --- the small sides
// ------------------------------------------------------------------------------

void SupportGraph::search_small_sides(Change& change) {
  if (++stamp_ == 0) {
    std::ranges::fill(found_at_, 0);
    stamp_ = 1;
  }
  groups_.clear();
  turns_.clear();
  for (const std::uint32_t chunk : loose_) start_group(chunk);
  for (const std::uint32_t bond : change.broken) {
    start_group(ends_[bond].a);
    if (ends_[bond].b != kWorld) start_group(ends_[bond].b);
  }
  take_turns(change);
  if (has_anchors_)
    settle_hanging(change);
  else
    settle_without_anchors(change);
}

void SupportGraph::start_group(std::uint32_t chunk) {
  if (!present_[chunk] || found_at_[chunk] == stamp_) return;
  const auto group = static_cast<std::uint32_t>(groups_.size());
  groups_.emplace_back().component = component_[chunk];
  ++components_[component_[chunk]].open;
  find(chunk, group);
  queue_turn(group);
}

void SupportGraph::find(std::uint32_t chunk, std::uint32_t group) {
  found_at_[chunk] = stamp_;
  group_[chunk] = group;
  next_[chunk] = kNone;
  append(groups_[group].waiting, {chunk, chunk});
  ++groups_[group].size;
  groups_[group].anchors += anchors_[chunk];
}

void SupportGraph::append(List& list, List other) {
  if (other.first == kNone) return;
  if (list.first == kNone)
    list = other;
  else
    next_[list.last] = other.first, list.last = other.last;
}

void SupportGraph::queue_turn(std::uint32_t group) {
  turns_.push_back({groups_[group].size, group});
  std::ranges::push_heap(turns_, std::ranges::greater(),
                         [](const Turn& t) { return std::tuple(t.size, t.group); });
}

// The smallest group looks at one chunk, until each component has one group left that is not closed
// off: what no group found of that component is its.
void SupportGraph::take_turns(Change& change) {
  while (!turns_.empty()) {
    std::ranges::pop_heap(turns_, std::ranges::greater(),
                          [](const Turn& t) { return std::tuple(t.size, t.group); });
    const Turn turn = turns_.back();
    turns_.pop_back();
    const Group& group = groups_[turn.group];
    Component& component = components_[group.component];
    if (group.merged_into != kNone || component.open == 1) continue;
    look_at_next(turn.group, change);
    if (group.is_closed())
      --component.open;
    else
      queue_turn(turn.group);
  }
}

void SupportGraph::look_at_next(std::uint32_t group, Change& change) {
  ++change.chunks_searched;
  const std::uint32_t chunk = groups_[group].waiting.first;
  groups_[group].waiting.first = next_[chunk];
  next_[chunk] = kNone;
  append(groups_[group].done, {chunk, chunk});
  for (std::uint32_t k = first_bond_[chunk]; k < first_bond_[chunk + std::size_t{1}]; ++k) {
    const std::uint32_t other = others_[k];
    if (!intact_[bonds_[k]] || other == kWorld) continue;
    if (found_at_[other] != stamp_)
      find(other, group);
    else if (const std::uint32_t its = group_of(other); its != group)
      join(group, its);
  }
}

void SupportGraph::join(std::uint32_t group, std::uint32_t other) {
  Group& into = groups_[group];
  Group& from = groups_[other];
  append(into.done, from.done);
  append(into.waiting, from.waiting);
  into.size += from.size;
  into.anchors += from.anchors;
  from.merged_into = group;
  --components_[into.component].open;
}

std::uint32_t SupportGraph::group_of(std::uint32_t chunk) {
  std::uint32_t root = group_[chunk];
  while (groups_[root].merged_into != kNone) root = groups_[root].merged_into;
  for (std::uint32_t g = group_[chunk]; g != root;) {
    const std::uint32_t next = groups_[g].merged_into;
    groups_[g].merged_into = root;
    g = next;
  }
  group_[chunk] = root;
  return root;
}

// --- what the groups are
// --------------------------------------------------------------------------

void SupportGraph::settle_hanging(Change& change) {
  const auto group_count = static_cast<std::uint32_t>(groups_.size());
  for (std::uint32_t g = 0; g < group_count; ++g) {
    const Group& group = groups_[g];
    if (group.merged_into != kNone || !group.is_closed()) continue;
    components_[group.component].size -= group.size;
    components_[group.component].anchors -= group.anchors;
    if (group.anchors > 0)
      become_component(g);
    else
      leave(all_chunks(g, change), change);
  }
  // Closed off or not, a component's chunks are now those of its one group left.
  for (std::uint32_t g = 0; g < group_count; ++g) {
    if (groups_[g].merged_into != kNone || groups_[g].is_closed()) continue;
    components_[groups_[g].component].open = 0;
    if (components_[groups_[g].component].anchors == 0) leave(all_chunks(g, change), change);
  }
}

// A group that was closed off on its turn is not larger than the one left over. So where it stays
// they are equally large, and its component keeps the right number and size by itself.
void SupportGraph::settle_without_anchors(Change& change) {
  for (const Group& group : groups_)
    if (group.merged_into == kNone && group.is_closed())
      components_[group.component].size -= group.size;
  const std::uint32_t stays = largest_group(change);
  for (std::uint32_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].merged_into != kNone) continue;
    components_[groups_[g].component].open = 0;
    if (g != stays) leave(all_chunks(g, change), change);
  }
}

// Of several that are largest the one with the smallest chunk.
std::uint32_t SupportGraph::largest_group(Change& change) {
  const auto size = [&](std::uint32_t g) {
    return groups_[g].is_closed() ? groups_[g].size : components_[groups_[g].component].size;
  };
  std::uint32_t best = kNone;
  for (std::uint32_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].merged_into != kNone) continue;
    if (best == kNone || size(g) > size(best) ||
        (size(g) == size(best) && all_chunks(g, change)[0] < all_chunks(best, change)[0]))
      best = g;
  }
  return best;
}

std::vector<std::uint32_t> SupportGraph::all_chunks(std::uint32_t group, Change& change) {
  while (!groups_[group].is_closed()) look_at_next(group, change);
  std::vector<std::uint32_t> chunks;
  chunks.reserve(groups_[group].size);
  for (std::uint32_t c = groups_[group].done.first; c != kNone; c = next_[c]) chunks.push_back(c);
  std::ranges::sort(chunks);
  return chunks;
}

void SupportGraph::become_component(std::uint32_t group) {
  const auto number = static_cast<std::uint32_t>(components_.size());
  components_.push_back({groups_[group].size, groups_[group].anchors, 0});
  for (std::uint32_t c = groups_[group].done.first; c != kNone; c = next_[c])
    component_[c] = number;
}

}  // namespace sunder
