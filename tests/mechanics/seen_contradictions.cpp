#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/singular_answer.hpp"

using namespace mechanics;
using tests::answer;
using tests::particle;

namespace {

bool near(const Vector& x, const Vector& y) { return (x - y).norm() <= 1e-12 * (1 + y.norm()); }

}  // namespace

TEST_CASE("a contradiction that a solver sees in the rounding of a redundant rod is none") {
  const double l = std::sqrt(2.0);
  const auto rod = particle({{"rod", "sqrt(x^2 + y^2) = sqrt(2)"}, {"twin", "x^2 + y^2 = 2"}});
  const State state = tests::state({l * std::sin(1), -l * std::cos(1)}, {std::cos(1), std::sin(1)});
  const Vector tolerance = Vector::Constant(2, default_contact_tolerance);
  for (const auto seen : {convex::Status::infeasible, convex::Status::gave_up}) {
    int solves = 0;
    GaussSolution last;
    const Resolution found = resolve(*rod, state, guessed_radii(state), gauss_problem(*rod, state, tolerance),
                                     [&](const convex::NearestPointProblem& problem) -> const GaussSolution& {
                                       last = solve(problem);
                                       if (++solves == 1) last.primal.status = seen;
                                       return last;
                                     });
    CHECK(solves == 2);
    CHECK(near(last.primal.q, answer(*rod, state).q2()));
    CHECK(found.is_settled);
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.warnings[0].message.find("was left out") != std::string::npos);
  }
}
