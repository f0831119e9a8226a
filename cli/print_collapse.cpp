// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/print_collapse.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "cli/print_run.hpp"
#include "io/collapse_report.hpp"

namespace sunder {
namespace {

void print_building(const Frame& frame, const CollapseResult& r) {
  std::fprintf(
      stderr,
      "building: %zu members, %zu joints, %zu slabs, %zu walls, %.4g kN\n"
      "at rest: sag %.3g mm mean, %.3g mm at %s; reactions off by %.1e; utilisation up to %.3g\n",
      frame.members.size(), frame.joints.size(), frame.slabs.size(), frame.walls.size(),
      1e-3 * r.weight, 1e3 * r.sag_mean, 1e3 * r.sag_max,
      r.sag_node.empty() ? "no node" : r.sag_node.c_str(), r.reaction_error, r.utilisation_at_rest);
}

void print_projectile(const ProjectileOutcome& p) {
  if (p.hit) {
    std::fprintf(stderr, "%s: hit at %.4g m/s\n", p.name.c_str(), p.speed_before);
  } else {
    std::fprintf(stderr, "%s: met no part of the building\n", p.name.c_str());
  }
}

void print_break(const Frame& frame, const CollapseResult& r, const JointBreak& b) {
  std::fprintf(stderr, "  %8.4f s  %s: %.*s", b.time, joint_name(frame, r, b.joint).c_str(),
               static_cast<int>(b.mode.size()), b.mode.data());
  if (!b.rule.empty()) std::fprintf(stderr, " (%s)", b.rule.c_str());
  if (!b.component.empty()) std::fprintf(stderr, ", mostly %s", b.component.c_str());
  if (b.utilisation > 0) std::fprintf(stderr, ", utilisation %.4g", b.utilisation);
  std::fprintf(stderr, "\n");
}

void print_damage(const Frame& frame, const CollapseResult& r) {
  constexpr std::size_t kShown = 5;
  std::string modes;
  const auto counts = count_by_mode(r);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    modes += (modes.empty() ? " (" : ", ") + std::to_string(counts[i]) + ' ';
    modes += kBreakModes[i];
  }
  std::fprintf(
      stderr, "%zu of %zu joints broken%s, %llu of %u parts freed, utilisation up to %.4g\n",
      r.broken_joints.size(), std::max(frame.joints.size(), r.recording.joints.size()),
      modes.empty() ? "" : (modes + ")").c_str(), as_count(r.parts_freed),
      frame.part_count() + static_cast<std::uint32_t>(r.members_divided), r.max_utilisation);
  for (std::size_t i = 0; i < std::min(kShown, r.broken_joints.size()); ++i)
    print_break(frame, r, r.broken_joints[i]);
  if (r.broken_joints.size() > kShown)
    std::fprintf(stderr, "  … and %zu more\n", r.broken_joints.size() - kShown);
  if (r.members_divided > 0)
    std::fprintf(stderr, "%llu members divided between their ends\n", as_count(r.members_divided));
  if (!r.yielded_joints.empty())
    std::fprintf(stderr, "%zu joints bent, by %.3g rad at most\n", r.yielded_joints.size(),
                 std::ranges::max_element(r.yielded_joints, {}, &JointYield::rotation)->rotation);
  if (r.first_failure_load > 0)
    std::fprintf(stderr, "first failure at a live load of %.4g kN/m²\n",
                 1e-3 * r.first_failure_load);
}

void print_panels(const CollapseResult& r) {
  if (r.panels == 0) return;
  std::fprintf(stderr,
               "%llu of %llu breakable slabs and walls broken, %llu of %llu chunks freed, %llu "
               "split; %llu bonds broken, %.4g m² of cracks\n",
               as_count(r.panels_broken), as_count(r.panels), as_count(r.chunks_freed),
               as_count(r.chunks), as_count(r.chunks_split), as_count(r.broken_bonds),
               r.crack_area);
}

}  // namespace

void print_collapse(const CollapseScene& scene, const CollapseResult& result) {
  print_building(scene.frame, result);
  for (const ProjectileOutcome& p : result.projectiles) print_projectile(p);
  print_damage(scene.frame, result);
  print_panels(result);
  print_ledger(result.energy_in, result.energy, result.joint_work);
  print_steps(result, scene.seed);
  if (result.solver_fallbacks > 0)
    std::fprintf(stderr, "the solver \"%s\" failed in %llu steps, which were iterated instead\n",
                 scene.simulation.joint_solver.c_str(), as_count(result.solver_fallbacks));
}

}  // namespace sunder
