// SPDX-License-Identifier: GPL-3.0-or-later
// Elimination tree: J. W. H. Liu, "The role of elimination trees in sparse factorization", SIAM J.
// Matrix Anal. Appl. 11 (1990) 134-172. Fronts that take in zeros to become wider: C. Ashcraft,
// R. Grimes, "The influence of relaxed supernode partitions on the multifrontal method", ACM Trans.
// Math. Softw. 15 (1989) 291-309.
#include "sim/front_tree.hpp"

#include <algorithm>
#include <numeric>

#include "sim/node_order.hpp"

namespace sunder {
namespace {

using Graph = std::vector<std::vector<std::uint32_t>>;
constexpr std::uint32_t kNone = Front::kNone;

/// Per place its neighbours' places.
Graph graph_of(const std::vector<std::uint32_t>& place_of,
               std::span<const std::pair<std::uint32_t, std::uint32_t>> edges) {
  Graph graph(place_of.size());
  for (const auto& [a, b] : edges) {
    graph[place_of[a]].push_back(place_of[b]);
    graph[place_of[b]].push_back(place_of[a]);
  }
  return graph;
}

std::vector<std::uint32_t> inverse_of(const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> inverse(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) inverse[order[i]] = i;
  return inverse;
}

/// Per place the first later place that its column of the factor reaches.
std::vector<std::uint32_t> parents_of(const Graph& graph) {
  std::vector<std::uint32_t> parent(graph.size(), kNone), ancestor(graph.size(), kNone);
  for (std::uint32_t j = 0; j < graph.size(); ++j) {
    for (std::uint32_t i : graph[j]) {
      while (i < j) {  // from i up to its root, which becomes a child of j
        const std::uint32_t next = ancestor[i];
        ancestor[i] = j;
        if (next == kNone) parent[i] = j;
        i = next == kNone ? j : next;
      }
    }
  }
  return parent;
}

/// The places in an order in which each subtree is contiguous and its root last. The child with the
/// tallest subtree comes last, next to its parent, where a front can take both.
std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent) {
  const std::uint32_t count = static_cast<std::uint32_t>(parent.size());
  std::vector<std::uint32_t> height(count, 0);
  Graph children(count + 1);
  for (std::uint32_t j = 0; j < count; ++j) {
    const std::uint32_t p = parent[j] == kNone ? count : parent[j];
    children[p].push_back(j);
    if (p < count) height[p] = std::max(height[p], height[j] + 1);
  }
  for (auto& list : children) {
    std::stable_sort(list.begin(), list.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return height[a] < height[b]; });
  }
  std::vector<std::uint32_t> order, stack{count};
  while (!stack.empty()) {  // parents first, last child first: the reverse of what is wanted
    const std::uint32_t j = stack.back();
    stack.pop_back();
    if (j < count) order.push_back(j);
    stack.insert(stack.end(), children[j].begin(), children[j].end());
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// Later places that each column of the factor reaches, ascending.
Graph columns_of(const Graph& graph, const std::vector<std::uint32_t>& parent) {
  Graph columns(graph.size());
  std::vector<std::uint32_t> marked(graph.size(), kNone);
  for (std::uint32_t j = 0; j < graph.size(); ++j) {
    marked[j] = j;
    std::vector<std::uint32_t> mine;
    const auto take = [&](const std::vector<std::uint32_t>& places) {
      for (std::uint32_t i : places) {
        if (i < j || marked[i] == j) continue;
        marked[i] = j;
        mine.push_back(i);
      }
    };
    take(graph[j]);
    take(columns[j]);  // where the children left theirs
    std::sort(mine.begin(), mine.end());
    if (parent[j] != kNone)
      columns[parent[j]].insert(columns[parent[j]].end(), mine.begin(), mine.end());
    columns[j] = std::move(mine);
  }
  return columns;
}

std::size_t blocks_of(std::size_t count, std::size_t rows) {
  return count * rows - count * (count - 1) / 2;
}

/// Whether a front of so many columns may hold this share of zeros.
bool is_worth(std::size_t count, double zeros) {
  return zeros <= (count <= 4 ? 0.5 : count <= 10 ? 0.15 : 0.05);
}

/// Takes the columns in turn; each takes in the fronts just before it while that pays.
std::vector<Front> fronts_of(Graph columns, const std::vector<std::uint32_t>& parent) {
  std::vector<Front> fronts;
  std::vector<std::size_t> filled;  // blocks of the factor that are not zero
  for (std::uint32_t j = 0; j < columns.size(); ++j) {
    Front front;
    front.first = j;
    front.count = 1;
    front.below = std::move(columns[j]);
    std::size_t blocks = front.rows();
    while (!fronts.empty()) {
      const Front& child = fronts.back();
      if (parent[front.first - 1] > j) break;
      const std::size_t count = front.count + child.count, rows = count + front.below.size();
      const double all = static_cast<double>(blocks_of(count, rows));
      const double zeros = all - static_cast<double>(blocks + filled.back());
      if (!is_worth(count, zeros / all)) break;
      front.first = child.first;
      front.count += child.count;
      blocks += filled.back();
      fronts.pop_back();
      filled.pop_back();
    }
    fronts.push_back(std::move(front));
    filled.push_back(blocks);
  }
  return fronts;
}

void link(FrontTree& tree) {
  for (std::uint32_t f = 0; f < tree.fronts.size(); ++f)
    for (std::uint32_t i = 0; i < tree.fronts[f].count; ++i) tree.front_of.push_back(f);
  for (std::uint32_t f = 0; f < tree.fronts.size(); ++f) {
    Front& front = tree.fronts[f];
    if (front.below.empty()) continue;
    front.parent = tree.front_of[front.below.front()];
    Front& parent = tree.fronts[front.parent];
    parent.children.push_back(f);
    std::uint32_t row = 0;
    for (std::uint32_t place : front.below) {
      if (place < parent.first + parent.count) {
        front.row_in_parent.push_back(place - parent.first);
        continue;
      }
      while (parent.below[row] < place) ++row;
      front.row_in_parent.push_back(parent.count + row);
    }
  }
}

}  // namespace

FrontTree front_tree(std::uint32_t nodes,
                     std::span<const std::pair<std::uint32_t, std::uint32_t>> edges) {
  FrontTree tree;
  const std::vector<std::uint32_t> dissected = node_order(nodes, edges);
  for (std::uint32_t place : postorder(parents_of(graph_of(inverse_of(dissected), edges))))
    tree.node_at.push_back(dissected[place]);
  tree.place_of = inverse_of(tree.node_at);
  const Graph graph = graph_of(tree.place_of, edges);
  const std::vector<std::uint32_t> parent = parents_of(graph);
  tree.fronts = fronts_of(columns_of(graph, parent), parent);
  link(tree);
  return tree;
}

}  // namespace sunder
