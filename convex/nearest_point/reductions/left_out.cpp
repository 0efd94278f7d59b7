#include "convex/nearest_point/reductions/left_out.hpp"

#include <algorithm>
#include <cmath>

#include "convex/dense/dense_kernels.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"

namespace convex::inline reductions {
namespace {

/// What rounding of norms and products may do to the test, relative to its terms, with room to spare.
constexpr double guard = 1e-6;

}  // namespace

std::vector<Index> rows_out_of_reach(const NearestPointProblem& problem) {
  std::vector<Index> rows;
  const bool is_zero = dense_kernels().largest_size(problem.rows(), problem.s.data()) == 0;
  if (is_zero || problem.s.maxCoeff() > 0 || !(problem.s.minCoeff() < 0)) return rows;
  for (Index a : problem.two_sided)
    if (problem.s[a] < 0) return rows;
  Vector free = problem.z;
  problem.A.whiten_in_place(free);
  const double radius = free.norm();
  problem.A.unwhiten_in_place(free);
  const Vector along = problem.U.times(free);
  std::vector<Index> candidates;
  for (Index a = 0; a < problem.rows(); ++a)
    if (problem.s[a] < 0 && along[a] - 2 * problem.s[a] > 0) candidates.push_back(a);
  if (candidates.empty()) return rows;
  // ||u||_(A⁻¹) is at least ||D⁻¹u||, D the diagonal of A, over sqrt(n): few rows pass this and are looked at
  // closely.
  const Vector shortest = problem.U.lengths(problem.A.diagonal().cwiseInverse()) /
                          std::sqrt(static_cast<double>(problem.dimension()));
  std::erase_if(candidates, [&](Index a) { return along[a] - 2 * problem.s[a] <= shortest[a] * radius; });
  for (Index a : problem.two_sided) std::erase(candidates, a);
  if (candidates.empty()) return rows;
  constexpr std::size_t few = 1000;  // with a sparse factor, the length of a row is a solve
  if (problem.A.kind() == MetricKind::sparse && candidates.size() > few) return rows;
  const Vector length = dual_lengths(problem, candidates);
  for (Index a : candidates)
    if (along[a] - 2 * problem.s[a] > length[a] * radius + guard * (length[a] * radius - problem.s[a]))
      rows.push_back(a);
  return rows;
}

NearestPointProblem with_rows(const NearestPointProblem& problem, const std::vector<Index>& kept) {
  NearestPointProblem part{problem.A,
                           problem.z,
                           problem.U.select(kept),
                           Vector(static_cast<Index>(kept.size())),
                           {},
                           select(problem.radii, kept)};
  for (std::size_t k = 0; k < kept.size(); ++k) {
    part.s[static_cast<Index>(k)] = problem.s[kept[k]];
    if (problem.is_two_sided(kept[k])) part.two_sided.push_back(static_cast<Index>(k));
  }
  return part;
}

}  // namespace convex::inline reductions
