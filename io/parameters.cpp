// SPDX-License-Identifier: GPL-3.0-or-later
// docs/parameters.md, made of the tables that the scene reader uses.
#include "io/building_keys.hpp"
#include "io/field_row.hpp"
#include "io/json_place.hpp"
#include "io/printable.hpp"
#include "io/scene.hpp"
#include "io/scene_keys.hpp"
#include "io/sections.hpp"

namespace sunder {
namespace {

/// `a|b` would end a table's cell.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return escaped;
}

std::string code(std::string_view text) {
  return text.empty() ? "" : '`' + cell(text) + '`';
}

struct DocRow {
  std::string_view name, type;
  std::string default_value, range;
  std::string_view unit, effect;
};

std::string table(std::span<const DocRow> rows) {
  std::string text =
      "| key | type | default | valid | unit | effect |\n|---|---|---|---|---|---|\n";
  for (const DocRow& row : rows) {
    text += "| " + code(row.name) + " | " + cell(row.type) + " | " + row.default_value + " | " +
            row.range + " | " + cell(row.unit) + " | " + cell(row.effect) + " |\n";
  }
  return text + '\n';
}

DocRow doc_row(const FieldRow& field) {
  DocRow row{field.name, "", "", range_text(field.range), field.unit, field.effect};
  const auto fill = [&](const auto& value) {
    using T = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<T, double>) {
      row.type = "number";
      row.default_value = number_text(value);
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
      row.type = "integer";
      row.default_value = std::to_string(value);
    } else if constexpr (std::is_same_v<T, bool>) {
      row.type = "truth value";
      row.default_value = value ? "true" : "false";
    } else if constexpr (std::is_same_v<T, std::string>) {
      row.type = "text";
      row.default_value = code(value);
    } else if constexpr (std::is_same_v<T, Vec3>) {
      row.type = "[x, y, z]";
      row.default_value = "`[" + number_text(value.x) + ", " + number_text(value.y) + ", " +
                          number_text(value.z) + "]`";
    } else {
      row.type = std::is_same_v<T, std::vector<Vec2>>   ? "list of [x, y]"
                 : std::is_same_v<T, std::vector<Vec3>> ? "list of [x, y, z]"
                                                        : "list of texts";
      row.default_value = "`[]`";
    }
  };
  std::visit(fill, field.default_value);
  if (!field.has_default()) row.default_value = field.required ? "required" : "";
  for (const std::string_view choice : field.choices) {
    row.range += (row.range.empty() ? "" : ", ") + code(choice);
  }
  return row;
}

void append_rows(std::vector<DocRow>& rows, std::span<const FieldRow> table) {
  for (const FieldRow& field : table) rows.push_back(doc_row(field));
}

void append_rows(std::vector<DocRow>& rows, std::span<const SceneKey> keys) {
  for (const SceneKey& key : keys) {
    const std::string shown(key.default_value);
    const bool is_value = shown.starts_with('{') || shown.starts_with('[');
    rows.push_back({key.name, key.type, is_value ? code(shown) : shown, range_text(key.range),
                    key.unit, key.effect});
  }
}

std::string pattern_tables(const std::string& heading,
                           std::span<const std::vector<FieldRow>> patterns,
                           std::span<const std::string_view> types,
                           std::span<const std::string_view> effects) {
  std::string text;
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    std::vector<DocRow> rows;
    append_rows(rows, patterns[i]);
    text += "### " + heading + ' ' + code(types[i]) + "\n\n" + std::string(effects[i]) + "\n\n" +
            table(rows);
  }
  return text;
}

std::string solid_tables() {
  std::vector<DocRow> rows;
  append_rows(rows, field_rows<SolidModel>());
  append_rows(rows, kSolidKeys);
  std::string text =
      "## Solid\n\nA closed mesh from a file, fractured as a whole.\n\n" + table(rows);
  rows.clear();
  append_rows(rows, kCraterKeys);
  append_rows(rows, field_rows<CarveParams>());
  text += "### Crater\n\n" + table(rows);
  return text + pattern_tables("Solid pattern", pattern_rows<SolidPatternParams>(),
                               kSolidPatternTypes, kSolidPatternEffects);
}

std::string materials_table() {
  std::string text =
      "| name | density kg/m³ | Young's modulus Pa | Poisson's ratio | tensile strength Pa | "
      "compressive strength Pa | fracture energy J/m² | stored energy J/m³ | friction | "
      "restitution | source |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Material& material : builtin_materials()) {
    text += "| " + code(material.name);
    for (const double value :
         {material.density, material.youngs_modulus, material.poisson_ratio,
          material.tensile_strength, material.compressive_strength, material.fracture_energy,
          material.stored_energy, material.friction, material.restitution}) {
      text += " | " + number_text(value);
    }
    text += " | " + cell(material.source) + " |\n";
  }
  return text;
}

/// The table of a struct, then of keys beside it.
template <class Params>
std::string table_of(std::span<const SceneKey> keys = {}) {
  std::vector<DocRow> rows;
  append_rows(rows, field_rows<Params>());
  append_rows(rows, keys);
  return table(rows);
}

template <class Named>
std::string names_of(const std::vector<Named>& all) {
  std::string text;
  for (const Named& each : all) text += (text.empty() ? "" : ", ") + code(each.name);
  return text + ".\n\n";
}

std::string joint_table() {
  std::vector<FieldRow> fields = field_rows<JointClass>();
  fields.erase(fields.begin());  // its name is the key
  std::vector<DocRow> rows;
  append_rows(rows, fields);
  append_rows(rows, kJointKeys);
  return "### Joint class\n\n"
         "Values of `joints`. Left out, what breaks the joint of a post or beam follows from its "
         "section and steel; posts have `bearing` true. Slabs and wall panels have 0.3 MN and "
         "0.1 MN m along and about each axis and the interaction `ellipsoid`.\n\n" +
         table(rows);
}

/// What a building names one by one.
std::string given_tables() {
  return "### Node\n\nOf `nodes`.\n\n" + table_of<FrameNode>({&kNodePlace, 1}) +
         "### Member\n\nOf `members`: a straight post or beam between two nodes.\n\n" +
         table_of<GivenMember>() + "### Slab given by itself\n\nOf `slabs`.\n\n" +
         table_of<GivenSlab>({&kSlabNodes, 1}) +
         "### Wall panel given by itself\n\nOf `wall_panels`.\n\n" +
         table_of<GivenPanel>({&kPanelNodes, 1}) + "### Connection\n\nOf `connections`.\n\n" +
         table_of<GivenJoint>();
}

std::string section_tables() {
  return "### Section\n\nOf `sections`. A new one must give its shape, height, web, for i and rhs "
         "its width, for i its flange; what else it leaves out is computed from these.\n\n" +
         table_of<Section>() + "Built-in: " + names_of(builtin_sections()) +
         "### Steel\n\nOf `steels`. A new one must give its strengths.\n\n" +
         table_of<SteelGrade>() + "Built-in: " + names_of(builtin_steels());
}

std::string building_tables() {
  std::vector<DocRow> rows;
  append_rows(rows, kBuildingKeys);
  append_rows(rows, field_rows<StoreyParams>());
  append_rows(rows, field_rows<BreakingRules>());
  std::string text =
      "## Building\n\nA frame of posts, beams, slabs and wall panels: regular, given one by one, "
      "or "
      "both. At most " +
      std::to_string(kMaxParts) +
      " parts. Those of the regular one are called `post_<x>_<z>_<storey>`, "
      "`beam_x_<x>_<z>_<storey>`, `beam_z_…`, `slab_…`, `wall_x_…`, `wall_z_…`, counted from "
      "0.\n\n" +
      table(rows);
  text += "### Slab\n\nOf `slab`.\n\n" + table_of<SlabParams>(kPanelKeys) +
          "### Wall panel\n\nOf `walls`.\n\n" + table_of<PanelParams>(kPanelKeys);
  rows.clear();
  append_rows(rows, kOverrideKeys);
  append_rows(rows, field_rows<StoreyParams>());
  for (DocRow& row : std::span(rows).subspan(std::size(kOverrideKeys))) {
    row.default_value = "as before";
  }
  text += "### Override\n\nOf `overrides`.\n\n" + table(rows);
  return text + joint_table() + given_tables() + section_tables();
}

/// What happens to walls and buildings.
std::string run_tables() {
  std::vector<DocRow> rows;
  append_rows(rows, field_rows<Projectile>());
  append_rows(rows, kProjectileKeys);
  std::string text = "## Projectile\n\nA solid sphere.\n\n" + table(rows) + building_tables();
  rows.clear();
  append_rows(rows, kScenarioKeys);
  text += "## Scenario\n\nWhat happens to a building besides projectiles.\n\n" + table(rows) +
          "## Simulation\n\n";
  rows.clear();
  append_rows(rows, field_rows<SimulationParams>());
  return text + table(rows) + "## Hulls\n\nConvex hulls of chunks, for engines.\n\n" +
         table_of<HullParams>();
}

}  // namespace

std::string parameters_markdown() {
  std::string text =
      "# Scene parameters\n\n"
      "Written by `./dev docs` from the tables that the reader uses; a test fails when it is out "
      "of date. Lengths are metres, angles in files are degrees. A key that is not listed is an "
      "error. `sunder schema scene` prints the same as a JSON schema for editors.\n\n"
      "## Scene\n\n";
  std::vector<DocRow> rows;
  append_rows(rows, kSceneKeys);
  text += table(rows) + "## Wall\n\n";
  rows.clear();
  append_rows(rows, field_rows<Wall>());
  append_rows(rows, kWallKeys);
  text +=
      table(rows) + std::string(kAssetMaterial) + "\n\n## Shape\n\nOf outlines and openings.\n\n";
  rows.clear();
  append_rows(rows, kShapeKeys);
  text += table(rows) + "## Pattern\n\nThe key `type` is required and chooses the others.\n\n";
  text += pattern_tables("Pattern", pattern_rows<PatternParams>(), kPatternTypes, kPatternEffects) +
          solid_tables() + run_tables() + "## Material\n\n";
  rows.clear();
  append_rows(rows, field_rows<Material>());
  return text + table(rows) + "## Built-in materials\n\n" + materials_table();
}

}  // namespace sunder
