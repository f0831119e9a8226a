// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/simulation_params.hpp"

namespace sunder {
namespace {

constexpr std::string_view kSolvers[] = {"hybrid", "bullet"};
constexpr std::string_view kJointSolvers[] = {"sequential-impulse", "nncg", "dantzig", "lemke"};

}  // namespace

template <>
std::span<const Field<SimulationParams>> fields() {
  using P = SimulationParams;
  static const Field<P> table[] = {
      {"duration", &P::duration, "s", "Time to simulate.", {0, 3600, true}},
      {"step",
       &P::step,
       "s",
       "Between recorded poses; divided further where something moves fast. At most 10 million "
       "steps make the duration.",
       {1e-6, 0.1}},
      {"iterations", &P::iterations, "", "Of the contact solver, per step.", {1, 10000}},
      {"max_error",
       &P::max_error,
       "",
       "Relative error asked for: given, it chooses step, iterations and solver where they are left "
       "out, by what was measured; it decides how far steps are divided.",
       {0, 1, true}},
      {"gravity", &P::gravity, "m/s²", "Downwards, along -y.", {0, 1000}},
      {"ground", &P::ground, "", "Whether there is a floor to fall on."},
      {"ground_height", &P::ground_height, "m", "The floor's y.", {-1e6, 1e6}},
      {"break_depth",
       &P::break_depth,
       "",
       "How often a chunk that came free may break again; 0: never.",
       {0, 4}},
      {"sleep", &P::sleep, "",
       "Whether bodies at rest leave the solver until something wakes them."},
      {"max_bodies",
       &P::max_bodies,
       "",
       "With more bodies than that, those at rest longest are fixed until what they lie on goes; 0: "
       "never.",
       {0, 1e6}},
      {.name = "solver",
       .member = &P::solver,
       .unit = "",
       .effect =
           "For buildings: hybrid carries intact parts by a static solver, bullet moves every "
           "member as a rigid body.",
       .choices = kSolvers},
      {.name = "joint_solver",
       .member = &P::joint_solver,
       .unit = "",
       .effect =
           "Bullet's way to solve joints: sequential impulses, nonlinear conjugate gradients, "
           "or a direct solver (Dantzig, Lemke: small buildings only).",
       .choices = kJointSolvers},
      {"warm_start", &P::warm_start, "",
       "Whether joints start from the impulses of the last step; Bullet itself starts from none."},
      {"settle",
       &P::settle,
       "s",
       "Before time 0, with joints that hold whatever happens: the building takes up its weight.",
       {0, 600}},
      {"quasi_static", &P::quasi_static, "",
       "For hybrid: the standing frame is in balance at any time instead of ringing."},
      {"p_delta", &P::p_delta, "",
       "For hybrid: axial forces bend what leans, while nothing rings."},
      {"diaphragms", &P::diaphragms, "", "For hybrid: slabs are stiff in their own plane."},
      {"damping_mass",
       &P::damping_mass,
       "1/s",
       "For hybrid: Rayleigh damping, its share of the mass; the defaults give 2 % at 1 and 10 Hz.",
       {0, 1000}},
      {"damping_stiffness",
       &P::damping_stiffness,
       "s",
       "For hybrid: Rayleigh damping, its share of the stiffness.",
       {0, 1}},
      {"history_step", &P::history_step, "s", "Between samples of the joints' loads and of the energies.", {1e-4, 10}},
  };
  return table;
}

}  // namespace sunder
