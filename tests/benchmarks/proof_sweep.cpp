#include <cstdio>
#include <cstring>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "tests/oracles/rational_text.hpp"

/// Every instance of the gallery at several sizes up to sixty coordinates and several seeds: how many are
/// proved in doubles, how many in fractions, and whether an independent checker in fractions accepts each
/// answer.
namespace {

using convex::Index;

struct Count {
  int enclosed = 0, exact = 0, infeasible = 0, refused = 0;
};

void prove(const convex::GalleryInstance& instance, Count& count) {
  const convex::NearestPointProblem& problem = instance.problem;
  const convex::Solution solution = convex::active_set(problem);
  const auto bound = convex::enclosed_error(problem, solution);
  const convex::ExactProblem exact = convex::exact_problem(problem);
  const convex::ExactSolution found = convex::exact_active_set(exact, convex::likely_active_rows(problem));
  if (found.status == convex::Status::infeasible) {
    ++count.infeasible;
    if (instance.feasible ||
        !oracles::is_exact_farkas_witness(problem, oracles::rationals({found.farkas, 1})))
      ++count.refused;
    return;
  }
  const oracles::RationalPoint point{oracles::rationals(found.q), oracles::rationals(found.lambda)};
  bool accepted = instance.feasible && oracles::is_exact_solution(problem, point);
  if (bound) accepted = accepted && oracles::relative_error(problem, solution.q, point, 1) <= *bound;
  ++(bound ? count.enclosed : count.exact);
  if (!accepted) ++count.refused;
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  constexpr Index most = 60;
  const std::vector<Index> sizes = smoke ? std::vector<Index>{4} : std::vector<Index>{5, 8, 16, 30, 60};
  const unsigned seeds = smoke ? 1 : 3;
  std::printf("%-18s %10s %10s %10s %10s\n", "family", "enclosed", "fractions", "infeasible", "refused");
  int refused = 0;
  for (const convex::GalleryFamily& family : convex::gallery()) {
    Count count;
    for (const Index size : sizes)
      for (unsigned seed = 1; seed <= seeds; ++seed)
        for (const double difficulty : family.ladder) {
          const auto instance = convex::gallery_instance(family, size, difficulty, seed);
          if (instance.problem.dimension() <= most) prove(instance, count);
        }
    std::printf("%-18s %10d %10d %10d %10d\n", std::string(family.name).c_str(), count.enclosed, count.exact,
                count.infeasible, count.refused);
    std::fflush(stdout);
    refused += count.refused;
  }
  return refused == 0 ? 0 : 1;
}
