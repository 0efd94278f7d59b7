#include "convex/nearest_point/sparse/tight_rows.hpp"

#include <algorithm>

#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/sparse/dependent_rows.hpp"
#include "convex/nearest_point/sparse/held_firmly.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline sparse {
namespace {

/// Of the word operations that fractions may take, what eliminations modulo a prime may: their numbers are in
/// lists.
constexpr double part_for_lists = 0.1;

bool contains(const std::vector<Index>& rows, Index a) {
  return std::binary_search(rows.begin(), rows.end(), a);
}

}  // namespace

std::string_view decide_tight_rows(const TightRows& rows, const SparsePoint& point, const Vector& weight,
                                   double limit, Vector& slack) {
  const auto& [problem, scaled, system, held, degenerate] = rows;
  const Vector& q = point.q.hi;
  std::vector<Index> tight = held;
  tight.insert(tight.end(), degenerate.begin(), degenerate.end());
  std::sort(tight.begin(), tight.end());
  // Rows that q keeps without rounding have no residual, however nearly they depend on each other.
  std::vector<Index> rounded, besides;
  for (Index a : tight)
    if (sign_of_slack(problem, a, q) != 0) rounded.push_back(a);
  // Whether the doubles q, where they are on the rows, are their point: of others the rounding may have made
  // a slack of 0.
  const auto is_exact = [&] {
    return static_cast<Index>(held.size()) == problem.dimension() || is_in_balance(problem, q, point.lambda);
  };
  if (rounded.empty()) {
    if (!is_exact()) return {};
    // What twice the precision left beside them is noise.
    const Vector magnitude = q.cwiseAbs();
    const std::vector<bool> is_tight = marked(problem.rows(), tight);
    for (Index a = 0; a < problem.rows(); ++a)
      if (!is_tight[at(a)] &&
          slack[a] <= near_zero * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, magnitude)))
        slack[a] = slack_at(problem, a, q);
    return {};
  }
  for (Index a : degenerate)
    if (contains(rounded, a)) besides.push_back(a);
  const double delta = 1 / std::max(1.0, largest_entry(weight));
  const auto hold = [&](const std::vector<Index>& chosen, Vector& with) {
    with = even_weights(problem.rows(), chosen, delta);
    return system.factor(with);
  };
  Vector own = weight;
  if (!degenerate.empty() && !hold(tight, own)) return open_question::conditioning;
  const Vector slowest = slowest_residual(scaled, system, rounded, own);
  if (problem.radii)
    return is_held_firmly(slowest) || is_zero_within(problem, scaled, slowest) ? std::string_view()
                                                                               : open_question::dependence;
  if (!is_held_firmly(slowest)) {
    const double most = std::max(1.0, limit) * part_for_lists * most_word_operations;
    const auto found = row_dependences(problem.U, problem.s, held, degenerate, most);
    if (!found) return open_question::dependence;
    if (!found->consistent) return open_question::contradiction;
    if (!found->off_edge.empty()) return open_question::degenerate_rows;
    std::erase_if(rounded, [&](Index a) { return !contains(found->independent, a); });
    if (found->independent.size() == tight.size() || !hold(found->independent, own) ||
        !is_held_firmly(slowest_residual(scaled, system, rounded, own)))
      return open_question::dependence;
    std::erase_if(besides, [&](Index a) { return contains(found->implied, a); });
  }
  if (besides.empty()) return {};
  const auto slacks = slacks_if_kept(problem, q, held, besides);
  if (!slacks) return open_question::degenerate_rows;
  slack(besides) = *slacks;
  if ((slacks->array() == 0).all() || is_exact()) return {};
  slack(besides).setZero();
  return open_question::zero_slacks;
}

}  // namespace convex::inline sparse
