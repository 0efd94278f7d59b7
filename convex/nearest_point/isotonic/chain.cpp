#include "convex/nearest_point/isotonic/chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "convex/nearest_point/isotonic/chain_answer.hpp"
#include "convex/nearest_point/isotonic/chain_kernels.hpp"
#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/optimality/gathered_residuals.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"

namespace convex::inline isotonic {
namespace {

/// A thread keeps so much for the next chain, 8 MB, and gives back what is more.
constexpr Index most_kept_lines_of_chains = Index{1} << 17;

/// Adds the rows q_(k+1) - q_k >= s, which come after the first `floor` rows, to the residuals found.
/// largest: of all lambda.
void add_links(const NearestPointProblem& problem, Index floor, double scale, double largest,
               Solution& found) {
  using namespace chain_kernels;
  const Index links = problem.dimension() - 1;
  const double *const mass = problem.A.diagonal().data(), *const s = problem.s.data() + floor,
                      *const lambda = found.lambda.data() + floor;
  Residuals& all = found.residuals;
  double gap = all.duality_gap * scale * all.duality_gap * scale;
  Links block;
  for (Index k = 0; k < links; k += width) {
    const Index count = std::min(width, links - k);
    measure_links(count, mass + k, found.q.data() + k, s + k, lambda + k, largest > 0 ? largest : 1, block);
    divide_links(count, s + k, found.acceleration_norm, scale, block, all.feasibility, all.complementarity);
    gap += block.gap;
  }
  if (scale > 0) all.duality_gap = std::sqrt(std::max(0.0, gap)) / scale;
}

/// The rows that carry something, by blocks listed without a branch.
std::vector<Index> loaded_rows(const Vector& lambda) {
  std::vector<Index> rows;
  rows.reserve(static_cast<std::size_t>(lambda.size()));
  std::array<Index, chain_kernels::width + 1> block;
  for (Index first = 0; first < lambda.size(); first += chain_kernels::width) {
    const Index end = std::min(first + chain_kernels::width, lambda.size());
    std::size_t loaded = 0;
    for (Index a = first; a < end; ++a) {
      block[loaded] = a;
      loaded += lambda[a] > 0;
    }
    rows.insert(rows.end(), block.begin(), block.begin() + loaded);
  }
  return rows;
}

template <class Order>
Solution solve(const NearestPointProblem& problem, const Accuracy& accuracy, const Order& order) {
  const Index n = problem.dimension(), m = problem.rows();
  thread_local Arena arena;
  arena.start(Chain<Order>::lines(n));
  const Chain<Order> chain(problem, order, arena);
  Solution found;
  found.q.resize(n);
  found.lambda.resize(m);
  found.slack.resize(m);
  std::optional<double> largest = place_pools(chain, pool(chain, arena), false, found);
  if (!largest) {
    const auto load = [&](Index k) { return chain.lowered(k, {problem.z[order.coordinate(k)], 0}); };
    largest = place_pools(chain, pool_carefully(chain, 0, n, load), true, found);
  }
  const double scale = std::max(found.acceleration_norm, found.force_norm);
  // On level ground the coordinates of a pool are equal, and only the floor has anything left to round.
  const Index floor = order.row(0);
  const bool by_blocks = order.plain, few = chain.is_level() || by_blocks;
  if (few) {
    GatheredResiduals all(found.residuals.stationarity, found.acceleration_norm, scale, *largest);
    if (floor >= 0)
      all.add(chain.s[floor], order.factor(0) / std::sqrt(chain.mass[order.coordinate(0)]),
              found.lambda[floor], slack_at(problem, floor, found.q), false);
    found.residuals = all.all();
  } else {
    found.residuals = residuals(problem, found, {.stationarity = found.residuals.stationarity});
  }
  if (by_blocks && !chain.is_level()) add_links(problem, floor + 1, scale, *largest, found);
  found.error_bound = found.rounding + rounding_of_pools(chain, scale);
  found.status = found.is_within(accuracy) && found.undecided.empty() ? Status::solved : Status::inaccurate;
  found.method = "chain";
  found.basis = loaded_rows(found.lambda);
  found.steps = static_cast<Index>(found.basis.size());
  found.model.islands = {{found.method, n, m, 0, 8 * static_cast<double>(n), 0}};
  if (arena.lines() > most_kept_lines_of_chains) arena.give_back();
  return found;
}

}  // namespace

std::optional<Solution> solve_chain(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const std::optional<InOrder> order = in_order(problem)) return solve(problem, accuracy, *order);
  const Strings strings = find_strings(problem, 0);
  if (strings.count() != 1) return std::nullopt;
  return solve(problem, accuracy, Listed{strings, problem.U.sparse()});
}

}  // namespace convex::inline isotonic
