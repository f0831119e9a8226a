// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "cli/command_line.hpp"
#include "cli/command_table.hpp"
#include "cli/options.hpp"
#include "cli/outputs.hpp"
#include "cli/solid_scene.hpp"
#include "cli/usage.hpp"
#include "cli/wall_scene.hpp"
#include "fracture/hulls.hpp"
#include "fracture/solid_model.hpp"
#include "fracture/wall.hpp"
#include "io/export_files.hpp"
#include "io/import.hpp"
#include "io/png.hpp"
#include "io/scene.hpp"
#include "io/suggest.hpp"

namespace sunder {
namespace {

constexpr const char* kWallGroup = "Wall";
constexpr const char* kSolidGroup = "Model";
constexpr const char* kPatternGroup = "Pattern";
constexpr const char* kHullGroup = "Hulls";

// CLI11 lets a list take every word up to the next option; here each word needs its own option.
CLI::Option* one_value_each(CLI::Option* option) {
  return option->allow_extra_args(false);
}

// What CLI11 fills in that becomes an option only when all is read.
struct Given {
  WallOptions wall;
  SolidOptions solid;
  PatternOptions pattern;
  std::string name, material, seed, threads, at, width, max_error;
  std::map<std::string, std::string> hulls;  // by key
  bool physics = false;
  std::map<std::string, std::set<std::string>> choices;  // words that options take, by name
};

void add_choices(Given& given, const std::string& option, std::span<const std::string_view> words) {
  given.choices[option].insert(words.begin(), words.end());
}

template <class Params>
KeyForm form_of(const Field<Params>& field) {
  if (std::holds_alternative<std::vector<Vec2> Params::*>(field.member)) return KeyForm::pairs;
  if (std::holds_alternative<Vec3 Params::*>(field.member)) return KeyForm::triple;
  if (std::holds_alternative<std::vector<Vec3> Params::*>(field.member)) return KeyForm::triples;
  return KeyForm::value;
}

std::string help_of(KeyForm form) {
  switch (form) {
    case KeyForm::value: return "";
    case KeyForm::pairs: return ", X,Y, repeatable";
    case KeyForm::triple: return ", X,Y,Z or XxYxZ";
    case KeyForm::triples: return ", X,Y,Z, repeatable";
  }
  return "";
}

// One option per key of any generator, from the generators' own tables.
template <class Params>
void add_pattern_options(CLI::App& app, const std::string& type, PatternOptions& pattern,
                         KeyForms& forms, std::map<std::string, std::string>& help) {
  for (const Field<Params>& field : fields<Params>()) {
    const std::string key(field.name);
    const KeyForm form = form_of(field);
    forms[key] = form;
    std::string& text = help[key];
    if (!text.empty()) {
      text += "; " + type + (form == KeyForm::triples ? " (X,Y,Z)" : "");
      app.get_option(option_name(key))->description(text);
      continue;
    }
    text = std::string(field.effect) +
           (field.unit.empty() ? "" : " [" + std::string(field.unit) + "]") + help_of(form) +
           "; for " + type;
    one_value_each(app.add_option(option_name(key), pattern.values[key], text))
        ->group(kPatternGroup);
  }
}

template <class Patterns, std::size_t i = 0>
void add_all_pattern_options(CLI::App& app, std::span<const std::string_view> types, const char* of,
                             PatternOptions& pattern, KeyForms& forms,
                             std::map<std::string, std::string>& help) {
  if constexpr (i < std::variant_size_v<Patterns>) {
    add_pattern_options<std::variant_alternative_t<i, Patterns>>(app, std::string(types[i]) + of,
                                                                 pattern, forms, help);
    add_all_pattern_options<Patterns, i + 1>(app, types, of, pattern, forms, help);
  }
}

std::uint64_t parse_whole(const std::string& option, const std::string& text, std::uint64_t most,
                          std::uint64_t least = 0) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || text.size() > 20 || (text.size() == 20 && text > "18446744073709551615") ||
      std::stoull(text) > most || std::stoull(text) < least)
    usage(option + " " + text + ": expected a whole number from " + std::to_string(least) + " to " +
          std::to_string(most));
  return std::stoull(text);
}

double parse_seconds(const std::string& option, const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const std::from_chars_result read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || !(value >= 0 && std::isfinite(value)))
    usage(option + " " + text + ": expected seconds from the start, 0 or more");
  return value;
}

// `--seed ""` and `--seed=` are mistakes (an unset variable), not values. CLI11 would take the next
// word for `--seed=`.
void check_words(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("--") && word.find('=') == word.size() - 1)
      usage(word.substr(0, word.size() - 1) + " needs a value, got an empty one");
  }
}

void check_values(const CLI::App& verb) {
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& value : option->results())
      if (value.empty()) usage(option->get_name() + " needs a value, got an empty one");
}

// CLI11 says only that a word was not expected; this says what was meant.
[[noreturn]] void explain(const CLI::App& app, const CLI::ParseError& error, int argc,
                          char** argv) {
  std::vector<std::string> names;
  const CLI::App* verb = &app;
  for (const CLI::App* sub : app.get_subcommands()) verb = sub;
  for (const CLI::Option* option : verb->get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    if (verb == &app) names.push_back(sub->get_name());
  const std::vector<std::string_view> views(names.begin(), names.end());
  for (int i = 1; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    if (std::ranges::find(names, word) != names.end() || word.empty()) continue;
    const bool is_verb = verb == &app && i == 1 && word[0] != '-';
    if (!is_verb && word.rfind("--", 0) != 0) continue;
    if (verb != &app || is_verb) {
      const std::string_view near = nearest_word(word, views);
      usage((is_verb ? "there is no verb \"" : "there is no option \"") + word + "\"" +
            (near.empty() ? "" : ", did you mean \"" + std::string(near) + "\"?"));
    }
  }
  for (const CLI::Option* option : verb->get_options())
    if (option->count() > 1 && option->get_items_expected_max() == 1)
      usage(option->nonpositional() ? option->get_name() + " is given twice"
                                    : '"' + option->results()[1] + "\" belongs to no option");
  usage(error.what());
}

void add_report_options(CLI::App& verb, Options& options) {
  one_value_each(verb.add_option("--report", options.reports,
                                 "Write the numbers of the run to this file, repeatable: .json, or "
                                 ".html to read and print"))
      ->type_name("FILE");
  verb.add_flag("--json", options.json, "Print the report to standard output, and nothing else")
      ->disable_flag_override();
  verb.add_flag("-q,--quiet", options.quiet, "Print errors only")->disable_flag_override();
  verb.add_flag("-v,--verbose", options.verbose, "Print times and what was not used")
      ->disable_flag_override();
}

// What the verbs that run a scene have in common.
void add_scene_options(CLI::App& verb, Options& options, Given& given, const char* suffixes) {
  verb.add_option("scene", options.inputs, "Scene file: .json")->type_name("FILE")->expected(0, 1);
  one_value_each(verb.add_option("-o,--output", options.outputs,
                                 std::string("File to write, repeatable: ") + suffixes)
                     ->type_name("FILE"));
  verb.add_option("--width", given.width,
                  "Pixels of a .png's width, " + std::to_string(kLeastPictureWidth) + " … " +
                      std::to_string(kMostPictureWidth) + "; " + std::to_string(kPictureWidth) +
                      " when not given");
  verb.add_option("--seed", given.seed, "Seed of the random numbers, instead of the scene's");
  one_value_each(verb.add_option("--set", options.overrides,
                                 "Override a value, repeatable: walls.0.pattern.jitter=0.5"));
  verb.add_option("--threads", given.threads, "Threads; the result does not depend on them");
  verb.add_flag("--allow-outside", options.allow_outside, "Let a scene's paths leave its folder")
      ->disable_flag_override();
  add_report_options(verb, options);
}

void add_wall_options(CLI::App& verb, Given& given) {
  WallOptions& wall = given.wall;
  const auto add = [&](const char* name, auto& value, const char* description) {
    return verb.add_option(name, value, description)->group(kWallGroup);
  };
  add("--wall", wall.size, "A wall without a scene file: WIDTHxHEIGHTxTHICKNESS [m]");
  one_value_each(add("--opening", wall.openings, "Opening WxH@X,Y [m], repeatable"));
  add("--anchors", wall.anchors, "Sides held by the world: bottom,left,right,top");
  for (const Field<Wall>& field : fields<Wall>())
    if (field.name == "anchors") add_choices(given, "--anchors", field.choices);
  add("--min-cell", wall.keys["min_cell"], "Merge cells smaller than this into a neighbour [m]");
}

// One option per plain key of a solid, from its table.
void add_solid_options(CLI::App& verb, SolidOptions& solid) {
  for (const Field<SolidModel>& field : fields<SolidModel>()) {
    const std::string key(field.name);
    if (key == "name" || key == "file" || key == "material") continue;
    const std::string text = std::string(field.effect) +
                             (field.unit.empty() ? "" : " [" + std::string(field.unit) + "]");
    if (key == "repair") {
      verb.add_flag(option_name(key), solid.repair, text)
          ->disable_flag_override()
          ->group(kSolidGroup);
    } else {
      verb.add_option(option_name(key), solid.keys[key], text)->group(kSolidGroup);
    }
  }
  one_value_each(verb.add_option("--carve", solid.craters,
                                 "Take a crater away first: X,Y,Z:RADIUS[:DEPTH] [m], repeatable"))
      ->group(kSolidGroup);
}

// What walls and models have in common.
void add_pattern_options(CLI::App& verb, Given& given) {
  std::string types = "Generator: of a wall ";
  const auto append = [&](std::span<const std::string_view> names) {
    for (std::size_t i = 0; i < names.size(); ++i)
      types += (i > 0 ? ", " : "") + std::string(names[i]);
  };
  append(kPatternTypes);
  types += "; of a model ";
  append(kSolidPatternTypes);
  verb.add_option("--pattern", given.pattern.type, types)->group(kPatternGroup);
  add_choices(given, "--pattern", kPatternTypes);
  add_choices(given, "--pattern", kSolidPatternTypes);
  verb.add_option("--name", given.name, "Name of the wall or solid")->group(kPatternGroup);
  verb.add_option("--material", given.material, "Material")->group(kPatternGroup);
  std::map<std::string, std::string> help;
  add_all_pattern_options<PatternParams>(verb, kPatternTypes, "", given.pattern, given.wall.forms,
                                         help);
  add_all_pattern_options<SolidPatternParams>(verb, kSolidPatternTypes, " of a model",
                                              given.pattern, given.solid.forms, help);
}

// Keys of a scene's "hulls" as options.
constexpr std::pair<const char*, const char*> kHullOptions[] = {{"nodes", "--hulls"},
                                                                {"error", "--hull-error"},
                                                                {"max_hulls", "--max-hulls"},
                                                                {"max_vertices", "--hull-vertices"},
                                                                {"physics", "--physics"}};

void add_hull_options(CLI::App& verb, Given& given) {
  for (const Field<HullParams>& field : fields<HullParams>()) {
    const std::string key(field.name);
    const auto option =
        std::ranges::find(kHullOptions, key, &std::pair<const char*, const char*>::first);
    if (std::holds_alternative<bool HullParams::*>(field.member)) {
      verb.add_flag(option->second, given.physics, std::string(field.effect))
          ->disable_flag_override()
          ->group(kHullGroup);
    } else {
      verb.add_option(option->second, given.hulls[key], std::string(field.effect))
          ->group(kHullGroup);
      add_choices(given, option->second, field.choices);
    }
  }
}

// They count as --set, of a scene file too.
void set_hulls(Options& options, const Given& given) {
  for (const auto& [key, value] : given.hulls)
    if (!value.empty()) options.overrides.push_back("hulls." + key + "=" + value);
  if (given.physics) options.overrides.emplace_back("hulls.physics=true");
}

CLI::App& add_fracture(CLI::App& app, Options& options, Given& given) {
  CLI::App& verb =
      *app.add_subcommand("fracture", "Pre-fracture the walls and solids of a scene, or a model");
  add_scene_options(verb, options, given, ".glb .gltf .obj .stl .ply .svg .png .html .json");
  verb.get_option("scene")->description("Scene file: .json, or a model: .obj .glb .gltf .stl .ply");
  add_wall_options(verb, given);
  add_solid_options(verb, given.solid);
  add_pattern_options(verb, given);
  add_hull_options(verb, given);
  return verb;
}

void add_run_options(CLI::App& verb, Options& options, Given& given, const char* suffixes) {
  add_scene_options(verb, options, given, suffixes);
  verb.add_option("--max-error", given.max_error,
                  "Relative error asked for: chooses step, iterations and solver where the scene "
                  "leaves them open, the cheapest that were measured to meet it");
  verb.add_option("--at", given.at,
                  "Show how everything stands at this time: no animation in .glb, .gltf, .html and "
                  ".obj, one picture instead of six in .svg and .png [s]");
  verb.add_flag("--no-skip", options.no_skip,
                "Do the work that the scene does not need too; the result is the same")
      ->disable_flag_override();
}

CLI::App& add_impact(CLI::App& app, Options& options, Given& given) {
  CLI::App& verb =
      *app.add_subcommand("impact", "Simulate what a scene's projectiles do to its walls");
  add_run_options(verb, options, given, ".glb .gltf .svg .png .html .json, with --at .obj");
  return verb;
}

CLI::App& add_collapse(CLI::App& app, Options& options, Given& given) {
  CLI::App& verb = *app.add_subcommand("collapse", "Bring a scene's frame building down");
  add_run_options(verb, options, given, ".glb .gltf .svg .png .html .json, with --at .obj");
  verb.add_option("--history", options.history,
                  "Write the loads of every joint over time to this file: .csv .json")
      ->type_name("FILE");
  return verb;
}

CLI::App& add_check(CLI::App& app, Options& options) {
  CLI::App& verb = *app.add_subcommand("check", "Measure assets; exit 1 if one is not sound");
  verb.add_option("files", options.inputs, ".glb .gltf .obj .stl .ply")
      ->type_name("FILE")
      ->required();
  add_report_options(verb, options);
  return verb;
}

CLI::App& add_schema(CLI::App& app, Options& options, Given& given) {
  CLI::App& verb = *app.add_subcommand("schema", "Print a JSON schema, for editors");
  verb.add_option("which", options.schema,
                  "scene, material, report (of fracture and check), impact-report or "
                  "collapse-report; parameters: the parameter tables as Markdown; man: the manual "
                  "page");
  add_choices(given, "which", kSchemas);
  given.choices["which"].insert({"parameters", "man"});
  return verb;
}

CLI::App& add_completion(CLI::App& app, Options& options, Given& given) {
  CLI::App& verb =
      *app.add_subcommand("completion", "Print a script that completes sunder's command line");
  verb.add_option("shell", options.shell, "bash, zsh or fish")->required();
  given.choices["shell"].insert(kShells.begin(), kShells.end());
  return verb;
}

CLI::App& add_view(CLI::App& app, Options& options) {
  CLI::App& verb =
      *app.add_subcommand("view", "Make a 3D page of assets and runs, in one file without links");
  verb.add_option("files", options.inputs,
                  "What to show: .glb .gltf .obj .stl .ply; a report (.json) belongs to the file "
                  "before it")
      ->type_name("FILE")
      ->required();
  one_value_each(verb.add_option("-o,--output", options.outputs, "Page to write: .html"))
      ->required();
  verb.add_flag("-q,--quiet", options.quiet, "Print errors only")->disable_flag_override();
  return verb;
}

void check_something_to_write(const Options& options, const std::string& verb) {
  if (options.outputs.empty() && options.reports.empty() && !options.json)
    usage(verb + " has nothing to write: give -o FILE, --report FILE or --json");
}

// Options of a wall go with --wall, of a model with a model, those of both with neither alone.
void check_groups(const CLI::App& verb, bool is_wall, bool is_model) {
  for (const CLI::Option* option : verb.get_options()) {
    if (option->count() == 0) continue;
    const std::string group = option->get_group();
    const char* with = group == kWallGroup && !is_wall                   ? "--wall"
                       : group == kSolidGroup && !is_model               ? "a model"
                       : group == kPatternGroup && !is_wall && !is_model ? "--wall or a model"
                                                                         : nullptr;
    if (with)
      usage(option->get_name() + " goes with " + with +
            (is_wall || is_model ? "" : "; for a scene file use --set"));
  }
}

void finish_fracture(const CLI::App& verb, Options& options, Given& given) {
  const bool is_wall = !given.wall.size.empty();
  if (is_wall != options.inputs.empty())
    usage(is_wall ? "fracture takes a scene file, a model or --wall, not two of them; \"" +
                        options.inputs.front().string() + "\" belongs to no option"
                  : "fracture needs a scene file, a model or --wall");
  options.is_model = !is_wall && is_import_suffix(suffix_of(options.inputs.front()));
  check_groups(verb, is_wall, options.is_model);
  for (auto* keys : {&given.wall.keys, &given.solid.keys}) {
    (*keys)["name"] = given.name;
    (*keys)["material"] = given.material;
  }
  if (is_wall) options.made_scene = scene_text(given.wall, given.pattern);
  if (options.is_model)
    options.made_scene = scene_text(options.inputs.front().string(), given.solid, given.pattern);
  set_hulls(options, given);
  check_something_to_write(options, "fracture");
}

// --at and --width want a file that they change.
void check_pictures(const Options& options) {
  const auto shows = [](const std::filesystem::path& path) { return path.extension() != ".json"; };
  if (options.at && std::ranges::none_of(options.outputs, shows))
    usage(
        "--at says which moment -o FILE.glb, .gltf, .obj, .svg, .png or .html shows, and there is "
        "none");
  const auto is_png = [](const std::filesystem::path& path) { return path.extension() == ".png"; };
  if (options.picture_width && std::ranges::none_of(options.outputs, is_png))
    usage("--width is of -o FILE.png, and there is none");
}

void finish_impact(const Options& options) {
  if (options.inputs.empty()) usage("impact needs a scene file");
  check_something_to_write(options, "impact");
}

void finish_collapse(const Options& options) {
  if (options.inputs.empty()) usage("collapse needs a scene file");
  if (options.history.empty()) check_something_to_write(options, "collapse");
}

void finish_check(const Options& options) {
  if (options.inputs.size() < 2) return;
  if (options.json) usage("--json prints one report, so check takes one file with it");
  if (!options.reports.empty())
    usage("--report writes one report, so check takes one file with it");
}

void read_numbers(Options& options, const Given& given) {
  if (!given.seed.empty()) options.seed = parse_whole("--seed", given.seed, ~std::uint64_t{0});
  if (!given.threads.empty())
    options.threads = static_cast<int>(parse_whole("--threads", given.threads, 1024));
  if (!given.at.empty()) options.at = parse_seconds("--at", given.at);
  options.asks_error = !given.max_error.empty();
  if (options.asks_error) options.overrides.push_back("simulation.max_error=" + given.max_error);
  if (given.width.empty()) return;
  options.picture_width =
      static_cast<int>(parse_whole("--width", given.width, kMostPictureWidth, kLeastPictureWidth));
}

// False when help or the version was asked for and is printed.
bool parse(CLI::App& app, int argc, char** argv) {
  if (argc <= 1) {
    std::fputs(app.help().c_str(), stderr);
    usage("a verb is needed");
  }
  check_words(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& call) {
    app.exit(call);
    return false;
  } catch (const CLI::ParseError& error) {
    explain(app, error, argc, argv);
  }
  if (app.get_subcommands().empty()) usage("a verb is needed");
  return true;
}

// The parser with what it fills in.
struct CommandLine {
  Options options;
  Given given;
  CLI::App app{
      "Breaks walls and solid models into closed, textured chunks with bonds, as glTF or OBJ, "
      "simulates what hits walls, and brings frame buildings down.",
      "sunder"};
  std::vector<std::pair<CLI::App*, Verb>> verbs;

  CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
};

CommandLine::CommandLine() {
  app.set_version_flag("--version", "sunder " SUNDER_VERSION);
  app.require_subcommand(0, 1);
  verbs = {
      {&add_fracture(app, options, given), Verb::fracture},
      {&add_impact(app, options, given), Verb::impact},
      {&add_collapse(app, options, given), Verb::collapse},
      {&add_check(app, options), Verb::check},
      {&add_schema(app, options, given), Verb::schema},
      {&add_view(app, options), Verb::view},
      {&add_completion(app, options, given), Verb::completion},
  };
}

}  // namespace

CommandTable command_table() {
  CommandLine line;
  std::set<std::string>& materials = line.given.choices["--material"];
  for (const Material& material : builtin_materials()) materials.insert(material.name);
  CommandTable table = table_of(line.app);
  for (CommandVerb& verb : table.verbs)
    for (CommandOption& option : verb.options)
      for (const std::string& word : line.given.choices[option.names.back()])
        option.choices.push_back(word);
  return table;
}

std::optional<Options> parse_options(int argc, char** argv) {
  CommandLine line;
  auto& [options, given, app, verbs] = line;
  if (!parse(app, argc, argv)) return {};
  options.command = command_line(argc, argv);

  const CLI::App* const verb = app.get_subcommands().front();
  check_values(*verb);
  read_numbers(options, given);
  options.verb = std::ranges::find(verbs, verb, &std::pair<CLI::App*, Verb>::first)->second;
  switch (options.verb) {
    case Verb::fracture: finish_fracture(*verb, options, given); break;
    case Verb::impact: finish_impact(options); break;
    case Verb::collapse: finish_collapse(options); break;
    case Verb::check: finish_check(options); break;
    case Verb::schema:
    case Verb::view: break;
    case Verb::completion: break;
  }
  check_pictures(options);
  check_outputs(options);
  return options;
}

}  // namespace sunder
