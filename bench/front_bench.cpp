// SPDX-License-Identifier: GPL-3.0-or-later
// What settings cost and how far off they are: the measured points by which `--max-error` chooses.
// Prints a table per job; beside the folder of results, data/error_fronts.json has them as JSON.
// Usage: bench_front
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>

#include "bench/closed_forms.hpp"
#include "bench/report.hpp"
#include "bench/ringing.hpp"
#include "bench/standing_precision.hpp"
#include "meshing/level_set.hpp"
#include "sim/impact.hpp"
#include "tests/meshing/sample_solids.hpp"
#include "tests/sim/impact_scenes.hpp"

namespace sunder {
namespace {

/// One choice of settings.
struct Point {
  std::string settings;  ///< members of a JSON object
  double error = 0, ms = 0;
  std::string worst;  ///< what is off by that much
  // How fine it is, for others of the same way: none finer is taken to be worse.
  std::string way;
  double step = 0;  ///< s, or a length
  int iterations = 0;
};

struct Job {
  const char *name, *block, *error, *time, *rest;
  std::vector<Point> points;
};

double least_ms(int runs, const std::function<void()>& work) {
  double least = 1e300;
  for (int i = 0; i < runs; ++i) least = std::min(least, cost_ms(work));
  return least;
}

Job impact_job() {
  Job job{"impact",
          "front impact",
          "largest relative error over rigid bodies with closed forms: head-on hits, free fall, "
          "bounces, sliding, sticking, rolling, Housner's rocking block, a toppling wall, and the "
          "lean of a tower of ten blocks by its block's edge",
          "per simulated second of a 514 kg ball at 10 m/s on 3 x 2 x 0.2 m of C30, processor "
          "time of one thread",
          "how a real wall breaks is not in it; see docs/accuracy.md for published tests",
          {}};
  const Engine engine = our_engine();
  for (const double step : {1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480, 1.0 / 1000, 1.0 / 2000})
    for (const int iterations : {5, 10, 20, 50}) {
      if (step < 1e-3 && iterations > 20) continue;  // cost most, and gain nothing
      const AccuracyRow off = worst(closed_forms(engine, {step, iterations}));
      Shot shot;
      shot.duration = 1;
      shot.step = step;
      shot.simulation = ", \"iterations\": " + std::to_string(iterations);
      const ImpactScene scene = impact_scene_of(shot);
      const double ms = least_ms(step > 1e-3 ? 2 : 1, [&] { simulate_impact(scene); });
      job.points.push_back(
          {text("\"simulation.step\": %.10g, \"simulation.iterations\": %d", step, iterations),
           off.error(), ms, off.name + ": " + off.quantity, "", step, iterations});
    }
  return job;
}

/// Of a frame at rest, rigid members; more than a picture of forces it is not.
Point rigid_point(const Frame& frame, const Truth& truth, int iterations, double step) {
  const Method method{.engine = Method::Engine::warm, .iterations = iterations, .step = step};
  const RigidStanding r = stand(frame, truth, method);
  const double sag = std::fabs(r.sag / truth.sag - 1), most = std::max({sag, r.foot, r.moment});
  return {text("\"simulation.solver\": \"bullet\", \"simulation.step\": %.10g, "
               "\"simulation.iterations\": %d",
               step, iterations),
          most,
          r.rest_ms / step,
          most == r.moment ? "moments of beams' ends"
          : most == r.foot ? "force of a foot"
                           : "sag of the roof",
          "rigid",
          step,
          iterations};
}

Job collapse_job() {
  Job job{"collapse",
          "front collapse",
          "largest relative error of deflection, period, and joints' largest loads (by the largest "
          "change) of a building of 4 x 5 posts and 6 storeys that loses a post and is not damped, "
          "against its modes; with rigid members (bullet) of sag, feet and beams' end moments at "
          "rest against the elastic frame",
          "processor time per simulated second in which the building rings (hybrid) or stands "
          "(bullet)",
          "what breaks near the edge of collapse, and where debris comes to lie, is not in it: "
          "there no step is fine enough (docs/accuracy.md)",
          {}};
  const Size size{4, 5, 6};
  const RingingCase ringing(size, "post_2_1_0");
  for (const double step :
       {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480, 1.0 / 1000, 1.0 / 2000, 1.0 / 4000}) {
    const Swinging swinging = ringing.stepped(step);
    const RingingCase::Error off = ringing.error(swinging);
    job.points.push_back(
        {text("\"simulation.solver\": \"hybrid\", \"simulation.step\": %.10g", step), off.worst(),
         swinging.ms.median,
         text("deflection %.1e, period %.1e, moments %.1e, feet %.1e", off.deflection, off.period,
              off.moments, off.feet),
         "elastic", step, 0});
  }
  const Frame frame = building_of(size);
  const Truth truth = truth_of(frame);
  job.points.push_back(rigid_point(frame, truth, 50, 1.0 / 60));
  job.points.push_back(rigid_point(frame, truth, 30, 1.0 / 240));
  return job;
}

double diagonal_of(const TriMesh& mesh) {
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& p : mesh.vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return length(high - low);
}

/// As repair does where a surface has to be made anew: voxels of 0.8 of what is allowed.
Point repair_point(const std::vector<TriMesh>& solids, double share) {
  Point point{text("\"max_error_by_diagonal\": %.10g", share), 0, 0, "", "", share, 0};
  double volume = 0;
  for (const TriMesh& given : solids) {
    const double diagonal = diagonal_of(given), voxel = 0.8 * share * diagonal;
    TriMesh made;
    point.ms = std::max(point.ms,
                        least_ms(2, [&] { made = smooth_surface(level_set(given, voxel, 1), 1); }));
    const double whole = mass_properties(given).volume;
    volume = std::max(volume, std::fabs(mass_properties(made).volume / whole - 1));
    const double off = std::max(farthest(made, TriangleTree(given), voxel / 4),
                                farthest(given, TriangleTree(made), voxel / 4));
    point.error = std::max(point.error, off / diagonal);
  }
  point.worst = text("volume off by %.1e at most", volume);
  return point;
}

Job repair_job() {
  Job job{
      "repair",
      "front repair",
      "Hausdorff distance by the diagonal of the bounding box, the largest of a sphere, a torus "
      "and a turned box, of surfaces made anew by a level set; corners set it",
      "of the level set and its surface, one thread, the slowest of the three solids",
      "the setting is the solid's max_error (m) by its diagonal; it does not matter where "
      "orientation, holes and cuts are enough, for those keep the surface",
      {}};
  TriMesh box = box_mesh({0, 0, 0}, {1.01, 0.77, 0.53});
  for (Vec3& p : box.vertices) p = {0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z};
  const std::vector<TriMesh> solids{sphere_mesh(0.5, 128), torus_mesh(0.5, 0.2, 384, 192), box};
  for (const double share : {0.08, 0.04, 0.02, 0.01, 0.005, 0.0025})
    job.points.push_back(repair_point(solids, share));
  return job;
}

/// Errors that count: of a point's own and all finer ones of its way the largest, so that a coarse
/// one is not chosen for its luck.
void take_no_luck(std::vector<Point>& points) {
  std::vector<double> errors;
  for (const Point& point : points) {
    errors.push_back(point.error);
    for (const Point& other : points)
      if (other.way == point.way && other.step <= point.step &&
          other.iterations >= point.iterations)
        errors.back() = std::max(errors.back(), other.error);
  }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].error = errors[i];
}

/// Points by time that are better by 2 % at least than any that costs less; the rest is left out.
std::vector<Point> front_of(std::vector<Point> points) {
  std::ranges::sort(points, {}, &Point::ms);
  std::vector<Point> front;
  for (const Point& point : points)
    if (front.empty() || point.error < 0.98 * front.back().error) front.push_back(point);
  return front;
}

void print(Job& job) {
  const std::vector<Point> measured = job.points;
  take_no_luck(job.points);
  const Block block(job.block);
  std::printf(
      "| settings | error | counted | ms | what is off | on the front "
      "|\n|---|---|---|---|---|---|\n");
  const std::vector<Point> front = front_of(job.points);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Point& point = job.points[i];
    const bool is_on = std::ranges::any_of(
        front, [&](const Point& other) { return other.settings == point.settings; });
    std::printf("| `%s` | %.2g | %.2g | %.3g | %s | %s |\n", point.settings.c_str(),
                measured[i].error, point.error, point.ms, point.worst.c_str(), is_on ? "yes" : "");
  }
}

std::string json_of(const std::vector<Job>& jobs) {
  std::string out = text(
      "{\n  \"commit\": \"%s\",\n  \"machine\": \"%s\",\n  \"date\": \"%s\",\n  \"made_by\": "
      "\"./dev bench front\",\n  \"errors\": \"of each setting the largest of its own and of all "
      "finer ones that were measured\",\n  \"jobs\": {\n",
      commit().c_str(), processor().c_str(), today().c_str());
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    const Job& job = jobs[j];
    out += text(
        "    \"%s\": {\n      \"error\": \"%s\",\n      \"time_ms\": \"%s\",\n      \"not_in_it\": "
        "\"%s\",\n      \"points\": [\n",
        job.name, job.error, job.time, job.rest);
    const std::vector<Point> front = front_of(job.points);
    for (std::size_t i = 0; i < front.size(); ++i)
      out += text("        {\"settings\": {%s}, \"error\": %.3g, \"time_ms\": %.4g}%s\n",
                  front[i].settings.c_str(), front[i].error, front[i].ms,
                  i + 1 < front.size() ? "," : "");
    out += text("      ]\n    }%s\n", j + 1 < jobs.size() ? "," : "");
  }
  return out + "  }\n}\n";
}

}  // namespace
}  // namespace sunder

int main() {
  using namespace sunder;
  std::vector<Job> jobs;
  for (const auto& measure : {impact_job, collapse_job, repair_job}) {
    jobs.push_back(measure());
    print(jobs.back());
  }
  if (!results_folder().empty())
    std::ofstream(results_folder() + "/../data/error_fronts.json") << json_of(jobs);
}
