#pragma once

#include "mechanics/singular/resolution.hpp"
#include "tests/mechanics/system_text.hpp"

namespace tests {

using namespace mechanics;

struct Answer {
  Resolution resolution;
  GaussSolution solution;
  const Vector& q2() const { return solution.primal.q; }
};

inline Answer answer(const LagrangianSystem& system, const State& state) {
  const Vector tolerance =
      Vector::Constant(static_cast<Index>(system.constraints().size()), default_contact_tolerance);
  GaussSolution last;
  Resolution resolution =
      resolve(system, state, guessed_radii(state), gauss_problem(system, state, tolerance),
              [&](const convex::NearestPointProblem& problem) -> const GaussSolution& {
                return last = solve(problem);
              });
  return {std::move(resolution), std::move(last)};
}

/// A particle of mass 1 in the plane under gravity.
inline std::unique_ptr<const LagrangianSystem> particle(const Lines& constraints, const Lines& forces = {},
                                                        const std::string& potential = "9.81*y") {
  return system({{"x", "y"}, "(x'^2 + y'^2)/2", potential, {}, {}, forces, constraints});
}

}  // namespace tests
