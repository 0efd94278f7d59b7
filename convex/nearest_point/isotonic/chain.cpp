#include "convex/nearest_point/isotonic/chain.hpp"

#include <cmath>

#include "convex/nearest_point/isotonic/chain_answer.hpp"
#include "convex/nearest_point/optimality/sparse_residuals.hpp"

namespace convex {
namespace {

template <class Order>
Solution solve(const NearestPointProblem& problem, const Accuracy& accuracy, const Order& order) {
  const Chain<Order> chain(problem, order);
  const Index n = problem.dimension(), m = problem.rows();
  Solution found;
  found.q.resize(n);
  found.lambda.resize(m);
  found.slack.resize(m);
  if (!place_pools(chain, pool(chain), false, found)) place_pools(chain, pool_carefully(chain), true, found);
  const double scale = std::max(found.acceleration_norm, found.force_norm);
  // On level ground the coordinates of a pool are equal, and only the floor has anything left to round.
  const Index floor = order.row(0);
  const bool level = chain.offset.empty();
  found.residuals =
      sparse_residuals(problem, found.q, found.lambda, found.slack,
                       {found.acceleration_norm, found.force_norm, found.residuals.stationarity},
                       level ? std::max(floor, Index{0}) : 0, level ? floor + 1 : m);
  found.error_bound = found.rounding + rounding_of_pools(chain, scale);
  const bool close = found.error_bound <= accuracy.tolerance * std::max(1.0, found.acceleration_norm);
  found.status = close && found.undecided.empty() ? Status::solved : Status::inaccurate;
  found.method = "chain";
  found.basis.resize(static_cast<std::size_t>(m) + 1);
  std::size_t loaded = 0;
  for (Index a = 0; a < m; ++a) {
    found.basis[loaded] = a;
    loaded += found.lambda[a] > 0;
  }
  found.basis.resize(loaded);
  found.steps = static_cast<Index>(found.basis.size());
  found.model.islands = {{found.method, n, m, 0, 8 * static_cast<double>(n), 0}};
  return found;
}

}  // namespace

std::optional<Solution> solve_chain(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const std::optional<InOrder> order = in_order(problem)) return solve(problem, accuracy, *order);
  const Strings strings = find_strings(problem, 0);
  if (strings.count() != 1) return std::nullopt;
  return solve(problem, accuracy, Listed{strings, problem.U.sparse()});
}

}  // namespace convex
