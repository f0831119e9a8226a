// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>

#include "cli/options.hpp"
#include "fracture/wall.hpp"
#include "io/export.hpp"
#include "io/suggest.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

[[noreturn]] void usage(const std::string& message) {
  throw Error(ErrorCode::usage, message + " (see sunder --help)");
}

// What a wall on the command line is made of; becomes the text of a scene, so that one reader
// checks everything.
struct WallOptions {
  std::string size;
  std::string type = "voronoi-grid";
  std::vector<std::string> openings;
  std::string anchors;
  std::map<std::string, std::string> keys;              // name, material, min_cell
  std::map<std::string, std::vector<std::string>> pattern;  // key of a generator → values
};

bool is_number(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !text.empty() && end == text.c_str() + text.size() &&
         text.find_first_of("xXnN") == std::string::npos;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20) continue;
    result += c;
  }
  return result + '"';
}

std::string value_text(const std::string& text) { return is_number(text) ? text : quoted(text); }

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

std::vector<std::string> numbers(const std::string& option, const std::string& text, char separator,
                                 std::size_t count, const char* form) {
  const std::vector<std::string> parts = split(text, separator);
  if (parts.size() != count || !std::ranges::all_of(parts, is_number))
    usage(option + " " + text + ": expected " + form);
  return parts;
}

std::string opening_text(const std::string& text) {
  const std::vector<std::string> parts = split(text, '@');
  if (parts.size() != 2) usage("--opening " + text + ": expected WxH@X,Y in metres");
  const auto size = numbers("--opening", parts[0], 'x', 2, "WxH@X,Y in metres");
  const auto at = numbers("--opening", parts[1], ',', 2, "WxH@X,Y in metres");
  return "{\"rect\": [" + size[0] + ", " + size[1] + "], \"at\": [" + at[0] + ", " + at[1] + "]}";
}

std::string pattern_value(const std::string& key, const std::vector<std::string>& values,
                          bool points) {
  if (!points) return value_text(values.back());
  std::string list;
  for (const std::string& value : values) {
    const auto xy = numbers("--" + key, value, ',', 2, "X,Y in metres");
    list += (list.empty() ? "[" : ", [") + xy[0] + ", " + xy[1] + "]";
  }
  return "[" + list + "]";
}

std::string scene_text(const WallOptions& wall, const std::map<std::string, bool>& is_points) {
  const auto size = numbers("--wall", wall.size, 'x', 3, "WIDTHxHEIGHTxTHICKNESS in metres");
  std::string text = "{\"sunder\": 1, \"walls\": [{\"outline\": {\"rect\": [" + size[0] + ", " +
                     size[1] + "]}, \"thickness\": " + size[2];
  for (const auto& [key, value] : wall.keys)
    if (!value.empty())
      text += ", \"" + key + "\": " + (key == "min_cell" ? value_text(value) : quoted(value));
  if (!wall.openings.empty()) {
    text += ", \"openings\": [";
    for (std::size_t i = 0; i < wall.openings.size(); ++i)
      text += (i > 0 ? ", " : "") + opening_text(wall.openings[i]);
    text += "]";
  }
  if (!wall.anchors.empty()) {
    text += ", \"anchors\": [";
    const auto sides = split(wall.anchors, ',');
    for (std::size_t i = 0; i < sides.size(); ++i) text += (i > 0 ? ", " : "") + quoted(sides[i]);
    text += "]";
  }
  text += ", \"pattern\": {\"type\": " + quoted(wall.type);
  for (const auto& [key, values] : wall.pattern)
    if (!values.empty()) text += ", \"" + key + "\": " + pattern_value(key, values, is_points.at(key));
  return text + "}}]}";
}

std::string option_name(std::string_view key) {
  std::string name(key);
  std::ranges::replace(name, '_', '-');
  return name;
}

// One option per key of any generator, from the generators' own tables.
template <class Params>
void add_pattern_options(CLI::App& app, std::string_view type, WallOptions& wall,
                         std::map<std::string, bool>& is_points,
                         std::map<std::string, std::string>& help) {
  for (const Field<Params>& field : fields<Params>()) {
    const std::string key(field.name);
    const bool points = std::holds_alternative<std::vector<Vec2> Params::*>(field.member);
    const bool known = is_points.contains(key);
    is_points[key] = points;
    if (known) {
      help[key] += "; " + std::string(type);
      app.get_option("--" + option_name(key))->description(help[key]);
      continue;
    }
    help[key] = std::string(field.effect) +
                (field.unit.empty() ? "" : " [" + std::string(field.unit) + "]") +
                (points ? ", X,Y, repeatable" : "") + "; for " + std::string(type);
    app.add_option("--" + option_name(key), wall.pattern[key], help[key])->group("Pattern");
  }
}

template <std::size_t i = 0>
void add_all_pattern_options(CLI::App& app, WallOptions& wall, std::map<std::string, bool>& is_points,
                             std::map<std::string, std::string>& help) {
  if constexpr (i < std::variant_size_v<PatternParams>) {
    add_pattern_options<std::variant_alternative_t<i, PatternParams>>(app, kPatternTypes[i], wall,
                                                                     is_points, help);
    add_all_pattern_options<i + 1>(app, wall, is_points, help);
  }
}

std::uint64_t parse_whole(const std::string& option, const std::string& text, std::uint64_t most) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || text.size() > 20 || (text.size() == 20 && text > "18446744073709551615") ||
      std::stoull(text) > most)
    usage(option + " " + text + ": expected a whole number from 0 to " + std::to_string(most));
  return std::stoull(text);
}

void check_outputs(const Options& options) {
  std::vector<std::filesystem::path> all = options.outputs;
  if (!options.report.empty()) all.push_back(options.report);
  for (const auto& path : options.outputs)
    if (const std::string suffix = path.extension(); suffix != ".json" && !is_export_suffix(suffix))
      usage("-o " + path.string() + ": the suffix says the format, one of .glb .gltf .obj .stl .ply "
            ".svg .json");
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (all[i].lexically_normal() == all[j].lexically_normal())
        usage(all[i].string() + " is written twice");
    for (const auto& input : options.inputs) {
      std::error_code ignored;
      if (std::filesystem::equivalent(all[i], input, ignored))
        usage(all[i].string() + " would overwrite the input");
    }
  }
}

// CLI11 says only that a word was not expected; this says what was meant.
[[noreturn]] void explain(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
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
  std::map<std::string, bool> is_points;
  std::map<std::string, std::string> help;

  CLI::App app("Breaks walls into closed, textured chunks with bonds, as glTF or OBJ.", "sunder");
  app.set_version_flag("--version", "sunder " SUNDER_VERSION);
  app.require_subcommand(0, 1);

  CLI::App& fracture = *app.add_subcommand("fracture", "Pre-fracture the walls of a scene");
  fracture.add_option("scene", options.inputs, "Scene file (JSON)")->expected(0, 1);
  fracture.add_option("-o,--output", options.outputs,
                      "File to write, repeatable: .glb .gltf .obj .stl .ply .svg .json");
  fracture.add_option("--seed", seed, "Seed of the random numbers, instead of the scene's");
  fracture.add_option("--set", options.overrides, "Override a value: walls.0.pattern.jitter=0.5");
  fracture.add_option("--threads", threads, "Threads; the result does not depend on them");
  fracture.add_flag("--allow-outside", options.allow_outside,
                    "Let a scene's paths leave its folder");
  add_common(fracture, options);
  fracture.add_option("--wall", wall.size, "A wall without a scene file: WIDTHxHEIGHTxTHICKNESS [m]")
      ->group("Wall");
  fracture.add_option("--pattern", wall.type, "Generator: voronoi-grid, voronoi-sites, "
                      "voronoi-random, voronoi-focus, quad-grid, spiderweb")->group("Wall");
  fracture.add_option("--opening", wall.openings, "Opening WxH@X,Y [m], repeatable")->group("Wall");
  fracture.add_option("--anchors", wall.anchors, "Sides held by the world: bottom,left,right,top")
      ->group("Wall");
  fracture.add_option("--name", wall.keys["name"], "Name of the wall")->group("Wall");
  fracture.add_option("--material", wall.keys["material"], "Material")->group("Wall");
  fracture.add_option("--min-cell", wall.keys["min_cell"],
                      "Merge cells smaller than this into a neighbour [m]")->group("Wall");
  add_all_pattern_options(fracture, wall, is_points, help);

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
  if (!seed.empty()) options.seed = parse_whole("--seed", seed, ~std::uint64_t{0});
  if (!threads.empty()) options.threads = static_cast<int>(parse_whole("--threads", threads, 1024));
  if (check.parsed() && options.json && options.inputs.size() > 1)
    usage("--json prints one report, so check takes one file with it");
  if (check.parsed() && !options.report.empty() && options.inputs.size() > 1)
    usage("--report writes one report, so check takes one file with it");
  if (options.verb != Verb::fracture) return options;

  if (wall.size.empty() == options.inputs.empty())
    usage(wall.size.empty() ? "fracture needs a scene file or --wall"
                            : "fracture takes a scene file or --wall, not both");
  if (!wall.size.empty()) options.wall_scene = scene_text(wall, is_points);
  if (wall.size.empty())
    for (const CLI::Option* option : fracture.get_options())
      if (option->count() > 0 && (option->get_group() == "Wall" || option->get_group() == "Pattern"))
        usage(option->get_name() + " goes with --wall; for a scene file use --set");
  if (options.outputs.empty() && options.report.empty() && !options.json)
    usage("fracture has nothing to write: give -o FILE, --report FILE or --json");
  check_outputs(options);
  return options;
}

}  // namespace sunder
