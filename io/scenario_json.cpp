// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <charconv>
#include <cmath>
#include <unordered_set>

#include "io/building.hpp"
#include "io/printable.hpp"
#include "io/scenario.hpp"
#include "io/strict_json.hpp"
#include "io/suggest.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::size_t kMaxRows = 1000000;
constexpr std::size_t kMostColumns = 4;
constexpr Range kTime{0, 1e9};             // s
constexpr Range kAcceleration{-1e3, 1e3};  // m/s²

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) + 1 - begin);
}

/// A line of a file, for messages.
struct Line {
  const std::filesystem::path& file;
  std::size_t number = 0;
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::input, printable(file.string(), std::string::npos) + ':' +
                                      std::to_string(number) + ": " + what);
  }
};

double number_of(std::string_view field, const Line& line) {
  std::string_view text = field;
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const std::from_chars_result read =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value)) {
    line.fail("must be a number, got \"" + printable(field, 40) + '"');
  }
  return value;
}

void check_range(double value, const char* what, const Range& range, std::string_view unit,
                 const Line& line) {
  if (range.contains(value)) return;
  line.fail(std::string(what) + " = " + number_text(value) + " is outside " +
            range_text(range, unit));
}

/// The fields of one line; how many there are.
std::size_t split(std::string_view text, std::array<std::string_view, kMostColumns>& fields,
                  const Line& line) {
  std::size_t count = 0;
  while (true) {
    const std::size_t comma = text.find(',');
    if (count < kMostColumns) fields[count] = trimmed(text.substr(0, comma));
    ++count;
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  if (count != 2 && count != 4) {
    line.fail("a row is time, a or time, ax, ay, az, got " + std::to_string(count) +
              (count == 1 ? " value" : " values"));
  }
  return count;
}

/// True for a line of headings: its first field begins with a letter or a quote.
bool is_heading(std::string_view field) {
  constexpr std::string_view kBegins = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ\"";
  return !field.empty() && kBegins.find(field.front()) != std::string_view::npos &&
         field != "nan" && field != "inf";
}

/// Reads the lines of a file one by one.
class MotionReader {
 public:
  void read(std::string_view text, const Line& line);
  GroundMotion take() { return std::move(motion_); }

 private:
  GroundMotion motion_;
  std::size_t columns_ = 0;  ///< 0: nothing but comments so far
};

void MotionReader::read(std::string_view text, const Line& line) {
  text = trimmed(text);
  if (text.empty() || text.front() == '#') return;
  std::array<std::string_view, kMostColumns> fields;
  const std::size_t columns = split(text, fields, line);
  if (columns_ && columns != columns_) {
    line.fail(std::to_string(columns) + " values, the rows before have " +
              std::to_string(columns_));
  }
  const bool is_first = columns_ == 0;
  columns_ = columns;
  if (is_first && is_heading(fields[0])) return;
  if (motion_.times.size() == kMaxRows) {
    line.fail("more than " + std::to_string(kMaxRows) + " rows, which is the limit");
  }
  const double time = number_of(fields[0], line);
  check_range(time, "time", kTime, "s", line);
  if (!motion_.times.empty() && time <= motion_.times.back()) {
    line.fail("time = " + number_text(time) + " s is not after the " +
              number_text(motion_.times.back()) + " s of the row before");
  }
  double a[3] = {};
  for (std::size_t i = 1; i < columns; ++i) {
    a[i - 1] = number_of(fields[i], line);
    check_range(a[i - 1], "acceleration", kAcceleration, "m/s²", line);
  }
  motion_.times.push_back(time);
  motion_.accelerations.push_back({a[0], a[1], a[2]});
}

std::vector<std::string> read_removed(const Place& list, const Frame& building) {
  std::unordered_set<std::string_view> parts, seen;
  for (std::uint32_t i = 0; i < building.part_count(); ++i) parts.insert(building.part_name(i));
  check_count(list);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.value.items()->size(); ++i) {
    const Place place(list, i);
    names.push_back(text_at(place));
    if (!parts.contains(names.back())) {
      std::vector<std::string_view> valid;
      for (std::uint32_t j = 0; j < building.part_count(); ++j) {
        valid.push_back(building.part_name(j));
      }
      place.fail("the building has no part " + describe(place.value) +
                 hint_for(names.back(), valid));
    }
    if (!seen.insert(*place.value.text()).second) {
      place.fail(describe(place.value) + " occurs twice, give it once");
    }
  }
  return names;
}

}  // namespace

GroundMotion read_ground_motion(const std::filesystem::path& path) {
  const std::string content = read_text_file(path);
  std::string_view rest = content;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  MotionReader reader;
  Line line{path};
  while (!rest.empty()) {
    ++line.number;
    const std::size_t end = rest.find('\n');
    reader.read(rest.substr(0, end), line);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  GroundMotion motion = reader.take();
  if (motion.times.empty()) {
    throw Error(ErrorCode::input,
                printable(path.string(), std::string::npos) +
                    ": no row of time and acceleration, for example \"0.01, 0.3\"");
  }
  return motion;
}

Scenario read_scenario(const Place& place, const Frame& building, const SceneFolder& folder) {
  std::vector<std::string_view> keys;
  append_keys(keys, kScenarioKeys);
  check_keys(place, keys);
  Scenario scenario;
  if (const JsonValue* remove = place.value.find("remove")) {
    scenario.remove = read_removed(Place(place, "remove", *remove), building);
  }
  if (const JsonValue* rate = place.value.find("load_rate")) {
    scenario.load_rate = number_at(Place(place, "load_rate", *rate), kLoadRate, "N/m² per s");
  }
  if (const JsonValue* motion = place.value.find("ground_motion")) {
    scenario.ground_motion = read_ground_motion(
        path_at(Place(place, "ground_motion", *motion), "ground motion", folder));
  }
  return scenario;
}

}  // namespace sunder
