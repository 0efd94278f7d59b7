#include "convex/nearest_point/structure/chain.hpp"

#include "convex/nearest_point/structure/pooling.hpp"
#include "convex/nearest_point/structure/string_answer.hpp"

namespace convex {

std::optional<Solution> solve_chain(const NearestPointProblem& problem, const Accuracy& accuracy) {
  const Strings strings = find_strings(problem, 0);
  if (strings.count() != 1) return std::nullopt;
  Pooling pooling(problem, strings);
  pooling.pool(problem.z);
  pooling.refine(problem.z, Vector());
  Solution found = string_answer(problem, accuracy, pooling.q(), pooling.lambda(), 0);
  found.method = "chain";
  found.basis.reserve(static_cast<std::size_t>(problem.rows()));
  for (Index a = 0; a < problem.rows(); ++a)
    if (found.lambda[a] > 0) found.basis.push_back(a);
  found.steps = static_cast<Index>(found.basis.size());
  const double n = static_cast<double>(problem.dimension());
  found.model.islands = {{found.method, problem.dimension(), problem.rows(), 0, 8 * n, 0}};
  return found;
}

}  // namespace convex
