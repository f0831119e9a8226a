// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace sunder {

/// One row of tests/corpus/scenes/*.txt.
struct CorpusRow {
  std::string name;
  std::vector<std::string> expected;  ///< that the message must hold
  std::string text;
  friend std::ostream& operator<<(std::ostream& out, const CorpusRow& row) {
    return out << row.name;
  }
};

/// <FF> stands for the byte with that hexadecimal number.
inline std::string unescaped(const std::string& line) {
  std::string bytes;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_byte = line[i] == '<' && i + 3 < line.size() && line[i + 3] == '>';
    if (is_byte) {
      bytes += static_cast<char>(std::stoi(line.substr(i + 1, 2), nullptr, 16));
      i += 3;
    } else {
      bytes += line[i];
    }
  }
  return bytes;
}

/// The rows of a corpus file; what stands before the first one is its comment.
inline std::vector<CorpusRow> read_corpus(const std::string& file) {
  std::ifstream in(std::string(SUNDER_SOURCE_DIR) + "/tests/corpus/scenes/" + file);
  if (!in) throw std::runtime_error("the corpus " + file + " is missing");
  std::vector<CorpusRow> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("== ")) {
      rows.push_back({line.substr(3), {}, {}});
    } else if (rows.empty() || line.empty()) {
      continue;
    } else if (line.starts_with("! ")) {
      rows.back().expected.push_back(line.substr(2));
    } else {
      rows.back().text += (rows.back().text.empty() ? "" : "\n") + unescaped(line);
    }
  }
  return rows;
}

/// A scene that gives every key there is but those of kGivenScene; the base of mutations.
inline constexpr const char* kFullScene = R"json({
  "$schema": "scene.schema.json",
  "sunder": 1,
  "seed": 7,
  "walls": [
    {"name": "facade", "outline": {"rect": [6.5, 3.5], "at": [1.5, 2.5]},
     "openings": [{"rect": [0.9, 2.1], "at": [2, 2.5]},
                  {"polygon": [[4, 3], [5, 3], [5, 4], [4, 4]]}],
     "thickness": 0.25, "material": "granite", "min_cell": 0.01,
     "pattern": {"type": "voronoi-grid", "cell": 0.35, "jitter": 0.9},
     "anchors": ["bottom", "left"], "position": [1, 2, 3], "rotation_deg": [0, 90, 0]},
    {"name": "b", "outline": {"polygon": [[0, 0], [4, 0], [2, 3]]},
     "pattern": {"type": "voronoi-sites", "sites": [[1, 1], [2, 2]]}},
    {"name": "c", "pattern": {"type": "voronoi-random", "count": 60}},
    {"name": "d", "pattern": {"type": "voronoi-focus", "points": [[3, 1]], "count": 90,
                              "radius": 0.5, "share": 0.6}},
    {"name": "e", "pattern": {"type": "quad-grid", "cell": 0.4, "jitter": 0.5}},
    {"name": "f", "pattern": {"type": "spiderweb", "impacts": [[3, 1.5]], "min_points": 6,
                              "max_points": 9, "min_radius": 0.2, "max_radius": 0.5, "rings": 3,
                              "radial": 8, "reach": 1.5, "rest_cell": 0.7}}
  ],
  "materials": [{"name": "granite", "density": 2700, "youngs_modulus": 5e10,
                 "poisson_ratio": 0.25, "tensile_strength": 7e6, "fracture_energy": 100,
                 "source": "a quarry"}],
  "projectiles": [{"name": "ball", "radius": 0.2, "mass": 260.5, "position": [3, 1.5, 5],
                   "velocity": [0.5, -1.5, -10], "time": 0.75, "youngs_modulus": 2e11,
                   "poisson_ratio": 0.28, "friction": 0.4, "restitution": 0.6},
                  {"position": [1, 2, 4], "velocity": [0, 0, 0]}],
  "building": {"posts": [3, 2], "storeys": 2, "storey_height": 3.25, "bay": [6.5, 5.5],
               "post_section": "HEB300", "beam_section": "IPE300", "steel": "s235",
               "live_load": 2000, "position": [10, 0.5, 5],
               "slab": {"thickness": 0.2, "material": "granite"},
               "walls": {"thickness": 0.12, "material": "brick",
                         "pattern": {"type": "voronoi-grid", "cell": 0.6}},
               "overrides": [{"storeys": [1, 1], "height": 4.5, "post_section": "HEB300",
                              "beam_section": "IPE300", "steel": "s235", "live_load": 500,
                              "slab": {"thickness": 0.25, "material": "concrete-c30"},
                              "walls": {"thickness": 0.2, "material": "granite",
                                        "pattern": {"type": "quad-grid", "cell": 0.5}},
                              "bays_x": [0, 1], "bays_z": [0, 1]}],
               "without": ["wall_z_*", "slab_1_0_0"],
               "joints": {"post": {"strength": 1.5, "interaction": "box", "bearing": false,
                                   "friction": 0.5, "force": [3e6, 4e5, 5e5],
                                   "torque": [6e4, 7e5, 8e5]},
                          "slab": {"strength": 2.5, "rigid": true}},
               "post_rule": "euler", "breaking": false, "hit_breaks": false, "load_time": 0.05},
  "scenario": {"remove": ["post_1_0_0", "wall_x_0_0_0"], "load_rate": 250.5},
  "simulation": {"duration": 2.5, "step": 0.005, "iterations": 30, "max_error": 0.02,
                 "gravity": 1.62, "ground": false, "ground_height": -0.5, "break_depth": 2,
                 "sleep": false, "solver": "bullet"}
})json";

/// A building that is given part by part: a table of four posts with a panel under one side.
inline constexpr const char* kGivenScene = R"json({
  "sunder": 1,
  "building": {
    "nodes": [{"name": "A", "at": [0, 0, 0], "support": true},
              {"name": "B", "at": [6, 0, 0], "support": true},
              {"name": "C", "at": [6, 0, 5], "support": true},
              {"name": "D", "at": [0, 0, 5], "support": true},
              {"name": "a", "at": [0, 3, 0], "support": false}, {"name": "b", "at": [6, 3, 0]},
              {"name": "c", "at": [6, 3, 5]}, {"name": "d", "at": [0, 3, 5]}],
    "members": [{"name": "P1", "from": "A", "to": "a", "section": "own-1.5", "steel": "tough",
                 "kind": "post", "roll_deg": 90},
                {"name": "P2", "from": "b", "to": "B", "roll_deg": 30},
                {"name": "P3", "from": "C", "to": "c"}, {"name": "P4", "from": "D", "to": "d"},
                {"name": "ab", "from": "a", "to": "b", "section": "IPE300", "steel": "s235"},
                {"name": "bc", "from": "b", "to": "c", "kind": "beam"},
                {"name": "cd", "from": "c", "to": "d"}, {"name": "da", "from": "d", "to": "a"}],
    "slabs": [{"name": "top", "nodes": ["a", "b", "c", "d"], "thickness": 0.22,
               "material": "brick", "live_load": 1500}],
    "wall_panels": [{"name": "back", "nodes": ["A", "B", "b", "a"], "thickness": 0.17,
                     "material": "concrete-c30"}],
    "connections": [{"of": "P1", "to": "ground", "at": "A", "class": "hinge"},
                    {"of": "P2", "to": "ground", "at": "B"},
                    {"of": "P3", "to": "ground", "at": "C"},
                    {"of": "P4", "to": "ground", "at": "D"},
                    {"of": "ab", "to": "P1", "at": "a", "class": "beam"},
                    {"of": "ab", "to": "P2", "at": "b"}, {"of": "bc", "to": "P2", "at": "b"},
                    {"of": "bc", "to": "P3", "at": "c"}, {"of": "cd", "to": "P3", "at": "c"},
                    {"of": "cd", "to": "P4", "at": "d"}, {"of": "da", "to": "P4", "at": "d"},
                    {"of": "da", "to": "P1", "at": "a"}],
    "joints": {"hinge": {"force": [1e6, 2e5, 3e5], "torque": [1, 2, 3]}},
    "sections": [{"name": "own-1.5", "shape": "i", "height": 0.3, "width": 0.2, "web": 0.01,
                  "flange": 0.02, "radius": 0.015, "curve_y": "a", "source": "a sketch"}],
    "steels": [{"name": "tough", "density": 7800, "youngs_modulus": 2e11, "poisson_ratio": 0.29,
                "yield_strength": 5e8, "ultimate_strength": 6e8, "source": "a mill"}]
  }
})json";

}  // namespace sunder
