// SPDX-License-Identifier: GPL-3.0-or-later
// Snap rounding where needed only: J. D. Hobby, "Practical segment intersection with finite
// precision output", 1999, with vertices kept apart by far more than the rounding.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "fracture/local_web_detail.hpp"

namespace sunder {
namespace {

// How often a stretch may be led aside again before it is taken as it is.
constexpr int kDeepest = 8;
// A crack that meets a fixed edge is led along it at most so far, in lengths of the crack's part.
constexpr double kFarthestBend = 2;

double distance_to(Vec2 p, Vec2 a, Vec2 b) {
  return length(from_segment(p, a, b));
}

bool is_border(CrackGraph::Kind kind) {
  return kind == CrackGraph::Kind::fixed || kind == CrackGraph::Kind::border;
}

}  // namespace

std::uint32_t CrackDrawing::add_vertex(Vec2 place) {
  graph_.vertices.push_back(place);
  return static_cast<std::uint32_t>(graph_.vertices.size()) - 1;
}

void CrackDrawing::add_edge(CrackGraph::Edge edge) {
  if (linked_.insert({std::min(edge.from, edge.to), std::max(edge.from, edge.to)}).second)
    graph_.edges.push_back(edge);
}

std::uint32_t CrackDrawing::near_vertex(Vec2 place, double distance) const {
  std::uint32_t nearest = kNone;
  for (std::uint32_t v = 0; v < graph_.vertices.size(); ++v) {
    const Vec2 d = graph_.vertices[v] - place;
    if (std::abs(d.x) > distance || std::abs(d.y) > distance || length(d) > distance) continue;
    nearest = v;
    distance = length(d);
  }
  return nearest;
}

// By the number of border edges to its right.
bool CrackDrawing::is_inside(Vec2 p) const {
  bool inside = false;
  for (const auto& edge : graph_.edges) {
    if (!is_border(edge.kind)) continue;
    const Vec2 a = graph_.vertices[edge.from], b = graph_.vertices[edge.to];
    if ((a.y > p.y) != (b.y > p.y)) inside ^= (cross(b - a, p - a) > 0) == (b.y > a.y);
  }
  return inside;
}

std::uint32_t CrackDrawing::vertex_for(Vec2 given) {
  const Vec2 place = rounded_to_float(given);
  const auto [known, is_new] = ends_.try_emplace({place.x, place.y}, kNone);
  if (!is_new) return known->second;
  std::uint32_t& found = known->second;
  found = near_vertex(place, least_);
  if (found != kNone) return found;
  std::uint32_t nearest = kNone;
  double least = least_;
  for (std::uint32_t e = 0; e < graph_.edges.size(); ++e) {
    const auto& edge = graph_.edges[e];
    const Vec2 a = graph_.vertices[edge.from], b = graph_.vertices[edge.to];
    if (std::min(a.x, b.x) > place.x + least || std::max(a.x, b.x) < place.x - least ||
        std::min(a.y, b.y) > place.y + least || std::max(a.y, b.y) < place.y - least)
      continue;
    const double distance = distance_to(place, a, b);
    if (distance > least) continue;
    if (edge.kind == Kind::fixed) return kNone;
    nearest = e;
    least = distance;
  }
  if (nearest != kNone) return found = split(nearest, place);
  if (is_inside(place)) found = add_vertex(place);
  return found;
}

bool CrackDrawing::draw(Vec2 from, Vec2 to, Kind kind) {
  const std::uint32_t u = vertex_for(from), v = vertex_for(to);
  const Vec2 a = u == kNone ? rounded_to_float(from) : graph_.vertices[u];
  const Vec2 b = v == kNone ? rounded_to_float(to) : graph_.vertices[v];
  return run({u, v, a, b, kind, 0});
}

void CrackDrawing::draw_towards(std::uint32_t from, Vec2 to, Kind kind) {
  run({from, kNone, graph_.vertices[from], rounded_to_float(to), kind, 0});
}

bool CrackDrawing::run(const Stretch& first) {
  const bool stays = trace(first);
  while (!waiting_.empty()) {
    const Stretch next = waiting_.back();
    waiting_.pop_back();
    trace(next);
  }
  return stays;
}

// Draws one stretch; what has to be led aside waits.
bool CrackDrawing::trace(const Stretch& stretch) {
  if (stretch.a == stretch.b) return true;
  std::vector<Event> events;
  const bool stays = find_events(stretch, events);
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::tie(a.at, a.vertex, a.edge) < std::tie(b.at, b.vertex, b.edge);
  });
  resolve(stretch, events);
  for (std::size_t i = 1; i < events.size(); ++i) link(stretch, events[i - 1], events[i]);
  return stays;
}

bool CrackDrawing::find_events(const Stretch& stretch, std::vector<Event>& events) const {
  const Vec2 a = stretch.a, b = stretch.b, d = b - a;
  const Vec2 low{std::min(a.x, b.x) - least_, std::min(a.y, b.y) - least_};
  const Vec2 high{std::max(a.x, b.x) + least_, std::max(a.y, b.y) + least_};
  events.push_back({0, stretch.from, kNone, false, 0});
  events.push_back({1, stretch.to, kNone, false, 0});
  const double square = dot(d, d), limit = least_ * std::sqrt(square);
  for (std::uint32_t v = 0; v < graph_.vertices.size(); ++v) {
    const Vec2 p = graph_.vertices[v];
    if (p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) continue;
    if (v == stretch.from || v == stretch.to || std::abs(cross(d, p - a)) > limit) continue;
    const double at = dot(p - a, d) / square;
    if (at > 0 && at < 1) events.push_back({at, v, kNone, true, 0});
  }
  bool stays = stretch.from != kNone && stretch.to != kNone;
  for (std::uint32_t e = 0; e < graph_.edges.size(); ++e) {
    const auto& edge = graph_.edges[e];
    const Vec2 p = graph_.vertices[edge.from], q = graph_.vertices[edge.to];
    if (std::max(p.x, q.x) < low.x || std::min(p.x, q.x) > high.x || std::max(p.y, q.y) < low.y ||
        std::min(p.y, q.y) > high.y || edge.from == edge.to)
      continue;
    auto event = crossing(stretch, e);
    if (!event) event = fixed_end(stretch, e);
    if (!event) continue;
    stays &= !is_border(edge.kind);
    events.push_back(*event);
  }
  return stays;
}

std::optional<CrackDrawing::Event> CrackDrawing::crossing(const Stretch& stretch,
                                                          std::uint32_t e) const {
  const auto& edge = graph_.edges[e];
  for (const std::uint32_t v : {edge.from, edge.to})
    if (v == stretch.from || v == stretch.to) return {};
  const Vec2 p = graph_.vertices[edge.from], q = graph_.vertices[edge.to];
  const Vec2 d = stretch.b - stretch.a;
  const double of_p = cross(d, p - stretch.a), of_q = cross(d, q - stretch.a);
  const double of_a = cross(q - p, stretch.a - p), of_b = cross(q - p, stretch.b - p);
  if (!(of_p * of_q < 0 && of_a * of_b < 0)) return {};
  const double at = of_a / (of_a - of_b);
  const Vec2 place = stretch.a + at * d;
  const double to_p = length(place - p), to_q = length(place - q);
  const std::uint32_t near = to_p <= to_q ? edge.from : edge.to;
  const double bend = std::min(to_p, to_q);
  if (bend <= least_) return Event{at, near, kNone, true, 0};
  if (edge.kind == Kind::fixed) return Event{at, near, kNone, true, bend};
  return Event{at, kNone, e, false, 0};
}

// An end without vertex on a fixed edge counts as a crossing of it.
std::optional<CrackDrawing::Event> CrackDrawing::fixed_end(const Stretch& stretch,
                                                           std::uint32_t e) const {
  const auto& edge = graph_.edges[e];
  if (edge.kind != Kind::fixed) return {};
  const Vec2 p = graph_.vertices[edge.from], q = graph_.vertices[edge.to];
  for (const bool start : {true, false}) {
    const Vec2 end = start ? stretch.a : stretch.b;
    if ((start ? stretch.from : stretch.to) != kNone || distance_to(end, p, q) > least_) continue;
    const double to_p = length(end - p), to_q = length(end - q);
    return Event{start ? 0.0 : 1.0, to_p <= to_q ? edge.from : edge.to, kNone, true,
                 std::min(to_p, to_q)};
  }
  return {};
}

// Puts vertices where the stretch crosses edges; those on the border, which cannot move, first.
void CrackDrawing::resolve(const Stretch& stretch, std::vector<Event>& events) {
  for (const bool border : {true, false})
    for (Event& event : events) {
      if (event.edge == kNone || is_border(graph_.edges[event.edge].kind) != border) continue;
      const Vec2 place = stretch.a + event.at * (stretch.b - stretch.a);
      event.vertex = border ? kNone : near_vertex(place, least_);
      if (event.vertex == kNone) {
        event.vertex = split(event.edge, place);
      } else {
        event.moved = true;
        lead_through(event.edge, event.vertex);
      }
      event.edge = kNone;
    }
}

void CrackDrawing::link(const Stretch& stretch, const Event& a, const Event& b) {
  if (a.vertex == kNone || b.vertex == kNone || a.vertex == b.vertex) return;
  const Vec2 d = stretch.b - stretch.a;
  if (stretch.kind != Kind::hull &&
      std::max(a.bend, b.bend) > kFarthestBend * (b.at - a.at) * length(d))
    return;
  if (!is_inside(stretch.a + (0.5 * (a.at + b.at)) * d)) return;
  if ((a.moved || b.moved) && stretch.depth < kDeepest) {
    waiting_.push_back({a.vertex, b.vertex, graph_.vertices[a.vertex], graph_.vertices[b.vertex],
                        stretch.kind, stretch.depth + 1});
  } else {
    add_edge({a.vertex, b.vertex, kNone, stretch.kind});
  }
}

std::uint32_t CrackDrawing::split(std::uint32_t e, Vec2 place) {
  const CrackGraph::Edge edge = graph_.edges[e];
  const Vec2 a = graph_.vertices[edge.from], b = graph_.vertices[edge.to];
  Vec2 at = rounded_to_float(a + nearest_share(place, a, b) * (b - a));
  if (edge.kind == Kind::border) (a.x == b.x ? at.x : at.y) = a.x == b.x ? a.x : a.y;
  if (length(at - a) < 0.5 * least_) return edge.from;
  if (length(at - b) < 0.5 * least_) return edge.to;
  const std::uint32_t vertex = add_vertex(at);
  remove_edge(e);
  add_edge({edge.from, vertex, edge.border, edge.kind});
  add_edge({vertex, edge.to, edge.border, edge.kind});
  return vertex;
}

void CrackDrawing::lead_through(std::uint32_t e, std::uint32_t vertex) {
  const CrackGraph::Edge edge = graph_.edges[e];
  remove_edge(e);
  for (const auto& [from, to] : {std::pair{edge.from, vertex}, std::pair{vertex, edge.to}})
    if (from != to)
      waiting_.push_back({from, to, graph_.vertices[from], graph_.vertices[to], edge.kind, 1});
}

// Leaves a gap in the list, so that other edges keep their index.
void CrackDrawing::remove_edge(std::uint32_t e) {
  CrackGraph::Edge& edge = graph_.edges[e];
  linked_.erase({std::min(edge.from, edge.to), std::max(edge.from, edge.to)});
  edge.to = edge.from;
}

}  // namespace sunder
