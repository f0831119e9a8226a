// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "io/moment.hpp"

namespace sunder {
namespace {

// Parts with equal keys have the same triangles and material.
using ShapeKey = std::tuple<std::string, bool, std::vector<double>>;

ShapeKey key_of(const RecordedPart& part) {
  std::vector<double> numbers{part.half_length};
  const auto add = [&numbers](const Loop& loop) {
    numbers.push_back(static_cast<double>(loop.size()));
    for (const Vec2 corner : loop) numbers.insert(numbers.end(), {corner.x, corner.y});
  };
  add(part.outline.outline);
  for (const Loop& opening : part.outline.openings) add(opening);
  return {part.material, part.has_ends, std::move(numbers)};
}

std::array<std::uint8_t, kLights> quantised(const Lights& lights) {
  std::array<std::uint8_t, kLights> result{};
  for (std::size_t k = 0; k < kLights; ++k) {
    result[k] = static_cast<std::uint8_t>(std::floor(kLightSteps * lights[k] + 0.5));
  }
  return result;
}

class PartPlanner {
 public:
  PartPlanner(const Recording& recording, std::optional<std::uint32_t> step)
      : recording_(recording), step_(step) {}

  GltfParts plan() {
    if (recording_.parts.empty()) return {};
    if (step_) {
      loads_ = end_loads(recording_, recording_.times[*step_]);
    } else {
      plan_glows();
    }
    for (std::uint32_t p = 0; p < recording_.parts.size(); ++p) plan_part(p);
    for (const GltfParts::Glow& glow : result_.glows) {
      result_.shapes[result_.meshes[result_.mesh_of[glow.part]].shape].glows = true;
    }
    lay_out_shapes();
    lay_out_meshes();
    lay_out_glows();
    return std::move(result_);
  }

 private:
  void plan_part(std::uint32_t p) {
    const RecordedPart& part = recording_.parts[p];
    if (part.wall != kNoTrack || (step_ && !is_there(recording_, part, *step_))) {
      return result_.mesh_of.push_back(kNoMesh);
    }
    const auto count = static_cast<std::uint32_t>(result_.shapes.size());
    const auto [place, is_new] = shape_ids_.try_emplace(key_of(part), count);
    if (is_new) {
      result_.shapes.push_back({.mesh = part_mesh(part), .part = p});
      plain_.push_back(kNoMesh);
    }
    const std::uint32_t shape = place->second;
    const Lights lights = step_ && part.has_ends ? lights_of(loads_[p]) : Lights{};
    if (is_lit(lights)) return result_.mesh_of.push_back(add_mesh(shape, lights));
    if (plain_[shape] == kNoMesh) plain_[shape] = add_mesh(shape, {});
    result_.mesh_of.push_back(plain_[shape]);
  }
  std::uint32_t add_mesh(std::uint32_t shape, const Lights& lights) {
    const bool has_colours = recording_.parts[result_.shapes[shape].part].has_ends;
    result_.meshes.push_back({.shape = shape, .has_colours = has_colours, .lights = lights});
    return static_cast<std::uint32_t>(result_.meshes.size() - 1);
  }

  // Of times that are the same float32 the last one stays.
  std::vector<double> find_grid() {
    const bool sampled = !recording_.sample_times.empty();
    const std::vector<double>& times = sampled ? recording_.sample_times : recording_.times;
    std::vector<double> exact;
    for (const double time : times) {
      const auto rounded = static_cast<float>(time);
      if (!result_.grid.empty() && result_.grid.back() == rounded) {
        exact.back() = time;
        continue;
      }
      result_.grid.push_back(rounded);
      exact.push_back(time);
    }
    return exact;
  }

  void plan_glows() {
    const std::vector<double> grid = find_grid();
    std::vector<GltfParts::Glow> glows(recording_.parts.size());
    std::vector<bool> shown(glows.size(), false);
    for (std::uint32_t i = 0; i < grid.size(); ++i) {
      const auto loads = end_loads(recording_, grid[i]);
      for (std::uint32_t p = 0; p < glows.size(); ++p) {
        if (!recording_.parts[p].has_ends) continue;
        const Lights lights = lights_of(loads[p]);
        if (is_lit(lights)) shown[p] = true;
        add_key(i, quantised(lights), glows[p]);
      }
    }
    for (std::uint32_t p = 0; p < glows.size(); ++p) {
      if (!shown[p]) continue;
      glows[p].part = p;
      result_.glows.push_back(std::move(glows[p]));
    }
  }
  static void add_key(std::uint32_t i, const std::array<std::uint8_t, kLights>& weights,
                      GltfParts::Glow& glow) {
    if (!glow.keys.empty()) {
      const std::array<std::uint8_t, kLights> last = glow.weights.back();
      if (weights == last) return;
      if (glow.keys.back() + 1 < i) {
        glow.keys.push_back(i - 1);
        glow.weights.push_back(last);
      }
    }
    glow.keys.push_back(i);
    glow.weights.push_back(weights);
  }

  void lay_out_shapes() {
    for (GltfParts::Shape& shape : result_.shapes) {
      const std::uint32_t count = shape.mesh.vertex_count();
      shape.first_vertex = result_.vertex_count;
      result_.vertex_count += count;
      shape.index_begin = result_.index_bytes;
      result_.index_bytes += (shape.mesh.indices.size() * shape.index_width() + 3) / 4 * 4;
      shape.first_accessor = result_.accessor_count;
      result_.accessor_count += shape.glows ? 5 + kLights : 4;
      if (shape.glows) result_.still_count = std::max(result_.still_count, count);
    }
  }
  void lay_out_meshes() {
    for (GltfParts::Mesh& mesh : result_.meshes) {
      if (!mesh.has_colours) continue;
      mesh.accessor = result_.accessor_count++;
      mesh.first_colour = result_.colour_count;
      result_.colour_count += result_.shapes[mesh.shape].mesh.vertex_count();
    }
    for (GltfParts::Shape& shape : result_.shapes) {
      shape.first_target = result_.colour_count;
      if (shape.glows) result_.colour_count += kLights * shape.mesh.vertex_count();
    }
  }
  void lay_out_glows() {
    for (GltfParts::Glow& glow : result_.glows) {
      glow.first_key = result_.key_count;
      result_.key_count += glow.keys.size();
      glow.accessor = result_.accessor_count;
      result_.accessor_count += 2;
    }
  }

  const Recording& recording_;
  std::optional<std::uint32_t> step_;
  GltfParts result_;
  std::vector<std::array<EndLoad, 2>> loads_;
  std::map<ShapeKey, std::uint32_t> shape_ids_;
  std::vector<std::uint32_t> plain_;  // per shape: its mesh without lights
};

}  // namespace

GltfParts plan_parts(const Recording& recording, std::optional<std::uint32_t> step) {
  return PartPlanner(recording, step).plan();
}

Colour own_colour(const RecordedPart& part) {
  const MemberLook look = member_look(part.material);
  return {linear(look.colour[0]), linear(look.colour[1]), linear(look.colour[2])};
}

}  // namespace sunder
