// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "io/error_front.hpp"
#include "io/error_fronts_text.hpp"
#include "io/json_place.hpp"
#include "io/strict_json.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

FrontPoint read_point(const Place& place) {
  constexpr Range kAboveZero{0, 1e9, true};
  FrontPoint point;
  point.error = number_at(Place(place, "error", *place.value.find("error")), kAboveZero);
  point.time_ms = number_at(Place(place, "time_ms", *place.value.find("time_ms")), kAboveZero);
  for (const JsonMember& member :
       object_at(Place(place, "settings", *place.value.find("settings")))) {
    const Place at(place, member);
    if (member.key == "simulation.step")
      point.step = number_at(at, kAboveZero);
    else if (member.key == "simulation.iterations")
      point.iterations = integer_at(at, {1, 10000});
    else if (member.key == "simulation.solver")
      point.solver = text_at(at);
    else
      at.fail("is no setting that max_error chooses");
  }
  return point;
}

// Of `jobs`, those that a simulation does: repair measures its own error.
std::vector<ErrorFront> read_fronts() {
  const std::string file = "data/error_fronts.json";
  const JsonValue root = parse_json(kErrorFrontsText, file);
  const Place place(file, root), jobs(place, "jobs", *root.find("jobs"));
  std::vector<ErrorFront> fronts;
  for (const JsonMember& member : object_at(jobs)) {
    if (member.key == "repair") continue;
    const Place job(jobs, member);
    const auto text = [&](const char* key) {
      return text_at(Place(job, key, *job.value.find(key)));
    };
    ErrorFront& front = fronts.emplace_back(
        ErrorFront{member.key, text("error"), text("time_ms"), text("not_in_it"), {}});
    const Place points(job, "points", *job.value.find("points"));
    for (std::size_t i = 0; i < list_at(points).size(); ++i)
      front.points.push_back(read_point(Place(points, i)));
    std::ranges::stable_sort(front.points, {}, &FrontPoint::time_ms);
  }
  return fronts;
}

}  // namespace

const ErrorFront& error_front(std::string_view job) {
  static const std::vector<ErrorFront> fronts = read_fronts();
  const auto found = std::ranges::find(fronts, job, &ErrorFront::job);
  if (found == fronts.end())
    throw Error(ErrorCode::usage, "no measured errors of \"" + std::string(job) + '"');
  return *found;
}

}  // namespace sunder
