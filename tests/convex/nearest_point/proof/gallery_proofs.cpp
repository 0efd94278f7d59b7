#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "tests/oracles/rational_text.hpp"

using convex::GalleryFamily;
using convex::GalleryInstance;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;

namespace {

constexpr convex::Index few_coordinates = 60;

/// ||q - q*||_A with q* as the gallery has it, to 2⁻¹⁰⁶ of its size.
double error(const GalleryInstance& instance, const convex::Vector& q) {
  return instance.problem.A.norm(q - instance.solution.hi - instance.solution.lo);
}

}  // namespace

TEST_CASE("every instance of the gallery up to sixty coordinates is proved, in doubles or in fractions") {
  int enclosed = 0, exact = 0;
  for (const GalleryFamily& family : convex::gallery())
    for (const double difficulty : family.ladder) {
      CAPTURE(std::string(family.name));
      CAPTURE(difficulty);
      const GalleryInstance instance =
          convex::gallery_instance(family, std::min<convex::Index>(family.size, 6), difficulty);
      const NearestPointProblem& problem = instance.problem;
      if (problem.dimension() > few_coordinates) continue;
      const Solution solution = convex::active_set(problem);
      if (const auto bound = convex::enclosed_error(problem, solution)) {
        ++enclosed;
        CHECK(instance.feasible);
        const double last_digits = 0x1p-100 * problem.A.norm(solution.q);
        CHECK(error(instance, solution.q) <= *bound * (1 + 0x1p-40) + last_digits);
        continue;
      }
      ++exact;
      const convex::ExactSolution found =
          convex::exact_active_set(convex::exact_problem(problem), convex::likely_active_rows(problem));
      if (found.status == Status::infeasible) {
        CHECK_FALSE(instance.feasible);
        continue;
      }
      CHECK(instance.feasible);
      CHECK(oracles::is_exact_solution(problem,
                                       {oracles::rationals(found.q), oracles::rationals(found.lambda)}));
    }
  MESSAGE("by enclosure " << enclosed << ", in fractions " << exact);
  CHECK(enclosed > 10);
  CHECK(exact > 10);
}
