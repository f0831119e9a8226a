// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_series.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace sunder {
namespace {

/// A float32; what is none is null.
void put_value(double value, GltfText& out) {
  const auto narrow = static_cast<float>(value);
  std::isfinite(narrow) ? out.shortest(narrow) : out.text("null");
}

/// `[…]` of write(item) for every item.
template <class Items, class Write>
void write_list(const Items& items, GltfText& out, const Write& write) {
  bool first = true;
  out.text("[");
  for (const auto& item : items) {
    out.separate(first);
    write(item);
  }
  out.text("]");
}

void write_point(Vec3 point, GltfText& out) {
  write_list(std::array{point.x, point.y, point.z}, out, [&](double v) { put_value(v, out); });
}

void write_run(const Recording& recording, GltfText& out) {
  constexpr std::pair<std::string_view, double RunSample::*> kValues[] = {
      {R"(,"times":)", &RunSample::time},
      {R"(,"kinetic":)", &RunSample::kinetic},
      {R"(,"potential":)", &RunSample::potential},
      {R"(,"strain":)", &RunSample::strain},
      {R"(,"fracture":)", &RunSample::fracture},
      {R"(,"friction":)", &RunSample::friction},
      {R"(,"contact":)", &RunSample::contact},
      {R"(,"damping":)", &RunSample::damping},
      {R"(,"plastic":)", &RunSample::plastic},
      {R"(,"numerical":)", &RunSample::numerical},
      {R"(,"max_utilisation":)", &RunSample::max_utilisation}};
  constexpr std::pair<std::string_view, std::uint64_t RunSample::*> kCounts[] = {
      {R"(,"broken_joints":)", &RunSample::broken_joints},
      {R"(,"broken_bonds":)", &RunSample::broken_bonds},
      {R"(,"moving":)", &RunSample::moving}};
  out.text(recording.parts.empty() ? R"("run":{"verb":"impact")" : R"("run":{"verb":"collapse")");
  out.key_integer(R"(,"seed":)", recording.seed);
  for (const auto& [name, value] : kValues) {
    out.text(name);
    write_list(recording.series, out, [&](const RunSample& s) { put_value(s.*value, out); });
  }
  for (const auto& [name, count] : kCounts) {
    out.text(name);
    write_list(recording.series, out, [&](const RunSample& s) { out.integer(s.*count); });
  }
  out.text("}");
}

/// Node of a part; -1: the ground, or a part that is shown by its chunks.
void write_part_node(const Recording& recording, std::uint32_t part, std::uint64_t first_part,
                     GltfText& out) {
  if (part == kNoTrack || recording.parts[part].wall != kNoTrack) return out.text("-1");
  out.integer(first_part + part);
}

void write_joints(const GltfLayout& layout, std::uint64_t first_part, GltfText& out) {
  const Recording& recording = *layout.recording;
  const std::vector<RecordedJoint>& joints = recording.joints;
  out.text(R"(,"joints":{"names":)");
  write_list(joints, out, [&](const RecordedJoint& joint) { out.quoted(joint.name); });
  out.text(R"(,"parts":)");
  write_list(joints, out, [&](const RecordedJoint& joint) {
    out.text("[");
    write_part_node(recording, joint.part_a, first_part, out);
    out.text(",");
    write_part_node(recording, joint.part_b, first_part, out);
    out.text("]");
  });
  out.text(R"(,"ends":)");
  write_list(joints, out, [&](const RecordedJoint& joint) {
    write_list(std::array{joint.end_a, joint.end_b}, out, [&](auto end) { out.integer(end); });
  });
  out.text(R"(,"points":)");
  write_list(joints, out, [&](const RecordedJoint& joint) { write_point(joint.point, out); });
  out.text(R"(,"broken":)");
  write_list(joints, out, [&](const RecordedJoint& joint) { put_value(joint.broken, out); });
  if (series_bytes(layout) > 0) {
    out.text(R"(,"times":)");
    write_list(recording.sample_times, out, [&](double time) { put_value(time, out); });
    out.key_integer(R"(,"utilisation":{"bufferView":)", layout[GltfBlock::utilisations].view);
    out.text(R"(,"componentType":5123,"scale":0.001})");
  }
  out.text("}");
}

void write_events(const Recording& recording, GltfText& out) {
  out.text(R"(,"events":)");
  write_list(recording.events, out, [&](const BreakEvent& event) {
    assert(event.wall < recording.walls.size());
    out.text(R"({"time":)");
    put_value(event.time, out);
    out.text(R"(,"wall":)");
    out.quoted(recording.walls[event.wall].asset.wall.name);
    out.text(R"(,"point":)");
    write_point(event.point, out);
    out.text(R"(,"speed":)");
    put_value(event.speed, out);
    out.text(R"(,"utilisation":)");
    put_value(event.utilisation, out);
    out.key_integer(R"(,"bonds_broken":)", event.bonds_broken);
    out.key_integer(R"(,"chunks_freed":)", event.chunks_freed);
    out.text("}");
  });
}

}  // namespace

bool has_series(const GltfLayout& layout) {
  return layout.recording && !layout.step && !layout.recording->series.empty();
}

void write_series(const GltfLayout& layout, std::uint64_t first_part, GltfText& out) {
  if (!has_series(layout)) return;
  out.text(R"(,"extras":{"sunder":{)");
  write_run(*layout.recording, out);
  if (!layout.recording->joints.empty()) write_joints(layout, first_part, out);
  write_events(*layout.recording, out);
  out.text("}}");
}

std::uint64_t series_bytes(const GltfLayout& layout) {
  if (!has_series(layout)) return 0;
  const Recording& recording = *layout.recording;
  if (recording.samples.empty()) return 0;
  return (2 * recording.samples.size() + 3) / 4 * 4;
}

std::uint16_t utilisation_at(const Recording& recording, std::size_t time, std::size_t joint) {
  if (recording.sample_times[time] >= recording.joints[joint].broken) return 0;
  const float used = recording.samples[time * recording.joints.size() + joint].utilisation;
  return static_cast<std::uint16_t>(
      std::lround(std::clamp(1e3 * static_cast<double>(used), 0.0, 65535.0)));
}

}  // namespace sunder
