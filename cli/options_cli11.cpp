// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>

#include "cli/options.hpp"
#include "cli/wall_scene.hpp"
#include "fracture/wall.hpp"
#include "io/export.hpp"
#include "io/suggest.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

[[noreturn]] void usage(const std::string& message) {
  throw Error(ErrorCode::usage, message + " (see sunder --help)");
}

// CLI11 lets a list take every word up to the next option; here each word needs its own option.
CLI::Option* one_value_each(CLI::Option* option) {
  return option->allow_extra_args(false);
}

// One option per key of any generator, from the generators' own tables.
template <class Params>
void add_pattern_options(CLI::App& app, std::string_view type, WallOptions& wall,
                         std::map<std::string, std::string>& help) {
  for (const Field<Params>& field : fields<Params>()) {
    const std::string key(field.name);
    const bool points = std::holds_alternative<std::vector<Vec2> Params::*>(field.member);
    const bool known = wall.is_points.contains(key);
    wall.is_points[key] = points;
    if (known) {
      help[key] += "; " + std::string(type);
      app.get_option(option_name(key))->description(help[key]);
      continue;
    }
    help[key] = std::string(field.effect) +
                (field.unit.empty() ? "" : " [" + std::string(field.unit) + "]") +
                (points ? ", X,Y, repeatable" : "") + "; for " + std::string(type);
    one_value_each(app.add_option(option_name(key), wall.pattern[key], help[key]))
        ->group("Pattern");
  }
}

template <std::size_t i = 0>
void add_all_pattern_options(CLI::App& app, WallOptions& wall,
                             std::map<std::string, std::string>& help) {
  if constexpr (i < std::variant_size_v<PatternParams>) {
    add_pattern_options<std::variant_alternative_t<i, PatternParams>>(app, kPatternTypes[i], wall,
                                                                      help);
    add_all_pattern_options<i + 1>(app, wall, help);
  }
}

std::uint64_t parse_whole(const std::string& option, const std::string& text, std::uint64_t most) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || text.size() > 20 || (text.size() == 20 && text > "18446744073709551615") ||
      std::stoull(text) > most)
    usage(option + " " + text + ": expected a whole number from 0 to " + std::to_string(most));
  return std::stoull(text);
}

// The file a path leads to, whatever links and dots are on the way; it need not exist.
std::filesystem::path canonical_of(std::filesystem::path path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // as Linux
  std::error_code fault;
  for (int i = 0; i < kMostLinks && fs::is_symlink(path, fault); ++i) {
    // weakly_canonical does not follow a link whose file is not there yet.
    const fs::path target = fs::read_symlink(path, fault);
    if (fault) break;
    path = path.parent_path() / target;
  }
  const fs::path result = fs::weakly_canonical(fs::absolute(path, fault), fault);
  return fault ? path.lexically_normal() : result;
}

void check_outputs(const Options& options) {
  namespace fs = std::filesystem;
  for (const fs::path& path : options.outputs)
    if (const std::string suffix = path.extension(); suffix != ".json" && !is_export_suffix(suffix))
      usage("-o " + path.string() +
            ": the suffix says the format, one of .glb .gltf .obj .stl .ply "
            ".svg .json");
  std::vector<fs::path> all = options.outputs;
  if (!options.report.empty()) {
    if (options.report.extension() != ".json")
      usage("--report " + options.report.string() + ": a report is a .json file");
    all.push_back(options.report);
  }
  std::map<fs::path, fs::path> written;  // canonical → as given
  for (const fs::path& path : all) {
    const fs::path file = canonical_of(path);
    const auto [other, is_new] = written.emplace(file, path);
    if (!is_new) usage(path.string() + " is written twice, also as " + other->second.string());
    for (const fs::path& input : options.inputs) {
      std::error_code ignored;
      if (file == canonical_of(input) || fs::equivalent(path, input, ignored))
        usage(path.string() + " would overwrite the input");
    }
  }
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

void check_pattern_values(const WallOptions& wall) {
  for (const auto& [key, values] : wall.pattern)
    if (!wall.is_points.at(key) && values.size() > 1) usage(option_name(key) + " is given twice");
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
  for (const CLI::Option* option : verb->get_options())
    if (option->count() > 1 && option->nonpositional() && option->get_items_expected_max() == 1)
      usage(option->get_name() + " is given twice");
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
  usage(error.what());
}

void add_common(CLI::App& app, Options& options) {
  app.add_option("--report", options.report, "Write the numbers of the run to this JSON file");
  app.add_flag("--json", options.json, "Print the report to standard output, and nothing else");
  app.add_flag("-q,--quiet", options.quiet, "Print errors only");
  app.add_flag("-v,--verbose", options.verbose, "Print times and what was not used");
}

}  // namespace

std::optional<Options> parse_options(int argc, char** argv) {
  Options options;
  WallOptions wall;
  std::string seed, threads;
  std::map<std::string, std::string> help;

  CLI::App app("Breaks walls into closed, textured chunks with bonds, as glTF or OBJ.", "sunder");
  app.set_version_flag("--version", "sunder " SUNDER_VERSION);
  app.require_subcommand(0, 1);

  CLI::App& fracture = *app.add_subcommand("fracture", "Pre-fracture the walls of a scene");
  fracture.add_option("scene", options.inputs, "Scene file (JSON)")->expected(0, 1);
  one_value_each(
      fracture.add_option("-o,--output", options.outputs,
                          "File to write, repeatable: .glb .gltf .obj .stl .ply .svg .json"));
  fracture.add_option("--seed", seed, "Seed of the random numbers, instead of the scene's");
  one_value_each(fracture.add_option("--set", options.overrides,
                                     "Override a value, repeatable: walls.0.pattern.jitter=0.5"));
  fracture.add_option("--threads", threads, "Threads; the result does not depend on them");
  fracture.add_flag("--allow-outside", options.allow_outside,
                    "Let a scene's paths leave its folder");
  add_common(fracture, options);
  fracture
      .add_option("--wall", wall.size, "A wall without a scene file: WIDTHxHEIGHTxTHICKNESS [m]")
      ->group("Wall");
  fracture
      .add_option("--pattern", wall.type,
                  "Generator: voronoi-grid, voronoi-sites, "
                  "voronoi-random, voronoi-focus, quad-grid, spiderweb")
      ->group("Wall");
  one_value_each(fracture.add_option("--opening", wall.openings, "Opening WxH@X,Y [m], repeatable"))
      ->group("Wall");
  fracture.add_option("--anchors", wall.anchors, "Sides held by the world: bottom,left,right,top")
      ->group("Wall");
  fracture.add_option("--name", wall.keys["name"], "Name of the wall")->group("Wall");
  fracture.add_option("--material", wall.keys["material"], "Material")->group("Wall");
  fracture
      .add_option("--min-cell", wall.keys["min_cell"],
                  "Merge cells smaller than this into a neighbour [m]")
      ->group("Wall");
  add_all_pattern_options(fracture, wall, help);

  CLI::App& check = *app.add_subcommand("check", "Measure assets; exit 1 if one is not sound");
  check.add_option("files", options.inputs, ".glb .gltf .obj .stl .ply")->required();
  add_common(check, options);

  CLI::App& schema = *app.add_subcommand("schema", "Print a JSON schema, for editors");
  schema.add_option("which", options.schema,
                    "scene, material or report; parameters: the parameter tables as Markdown");

  if (argc <= 1) {
    std::fputs(app.help().c_str(), stderr);
    usage("a verb is needed");
  }
  check_words(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& call) {
    app.exit(call);
    return {};
  } catch (const CLI::CallForVersion& call) {
    app.exit(call);
    return {};
  } catch (const CLI::ParseError& error) {
    explain(app, error, argc, argv);
  }

  options.verb = check.parsed() ? Verb::check : schema.parsed() ? Verb::schema : Verb::fracture;
  for (const CLI::App* verb : app.get_subcommands()) check_values(*verb);
  check_pattern_values(wall);
  if (!seed.empty()) options.seed = parse_whole("--seed", seed, ~std::uint64_t{0});
  if (!threads.empty()) options.threads = static_cast<int>(parse_whole("--threads", threads, 1024));
  if (check.parsed() && options.json && options.inputs.size() > 1)
    usage("--json prints one report, so check takes one file with it");
  if (check.parsed() && !options.report.empty() && options.inputs.size() > 1)
    usage("--report writes one report, so check takes one file with it");
  if (options.verb != Verb::fracture) {
    check_outputs(options);
    return options;
  }

  if (wall.size.empty() == options.inputs.empty())
    usage(wall.size.empty() ? "fracture needs a scene file or --wall"
                            : "fracture takes a scene file or --wall, not both; \"" +
                                  options.inputs.front().string() + "\" belongs to no option");
  if (!wall.size.empty()) options.wall_scene = scene_text(wall);
  if (wall.size.empty())
    for (const CLI::Option* option : fracture.get_options())
      if (option->count() > 0 &&
          (option->get_group() == "Wall" || option->get_group() == "Pattern"))
        usage(option->get_name() + " goes with --wall; for a scene file use --set");
  if (options.outputs.empty() && options.report.empty() && !options.json)
    usage("fracture has nothing to write: give -o FILE, --report FILE or --json");
  check_outputs(options);
  return options;
}

}  // namespace sunder
