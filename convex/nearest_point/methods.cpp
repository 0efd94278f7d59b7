#include "convex/nearest_point/methods.hpp"

#include <array>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/common_size.hpp"
#include "convex/nearest_point/methods/crossover.hpp"
#include "convex/nearest_point/methods/every_method.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex {
namespace {

std::string always(const NearestPointProblem&) { return {}; }

/// Methods on dense whitened rows or a tableau of the rows.
std::string when_dense(const NearestPointProblem& problem) {
  if (is_dense_size(problem) && problem.rows() <= most_dense_rows) return {};
  return "works with dense factors, which " + std::to_string(problem.dimension()) + " coordinates and " +
         std::to_string(problem.rows()) + " rows are too many for; take a sparse method";
}

std::string when_ceres_is_there(const NearestPointProblem& problem) {
  const std::string reason = why_no_ceres();
  return reason.empty() ? when_dense(problem) : reason;
}

std::string when_few_rows(const NearestPointProblem& problem) {
  const Index rows = problem.rows() - static_cast<Index>(problem.two_sided.size());
  if (rows <= most_enumerated_rows) return when_dense(problem);
  return "tries all sets of rows, which " + std::to_string(rows) +
         " one-sided rows are too many for (at most " + std::to_string(most_enumerated_rows) +
         "); take another method";
}

Solution active_set_from_nothing(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return active_set(problem, accuracy);
}

Solution automatic_from_nothing(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return automatic(problem, accuracy);
}

template <Solution (*method)(const NearestPointProblem&, const Accuracy&)>
Solution of_any_size(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (problem.rows() > 0 || problem.U.dimension() == problem.dimension())
    return in_common_size(problem, accuracy, method);
  NearestPointProblem sized = problem;  // rows that are none may have any length
  sized.U = ConstraintRows(RowMatrix(0, problem.dimension()));
  return in_common_size(sized, accuracy, method);
}

using enum MethodKind;

constexpr std::array table{
    Method{"auto", "no more than the problem needs: islands, structure, dense or sparse (the default)",
           direct, always, automatic_from_nothing},
    Method{"active-set", "dual active set with an updated orthogonal factor, refined in twice the precision",
           direct, always, of_any_size<active_set_from_nothing>},
    Method{"nnls", "nonnegative least squares of Lawson and Hanson, on the cone or homogenised", direct,
           when_dense, of_any_size<nnls>},
    Method{"lemke", "complementary pivoting of Lemke, lexicographic", direct, when_dense, of_any_size<lemke>},
    Method{"block-pivoting", "principal pivoting by blocks, one row at a time where blocks fail", direct,
           when_dense, of_any_size<block_pivoting>},
    Method{"enumerate", "all sets of active rows, for up to 20 rows", direct, when_few_rows,
           of_any_size<enumerate>},
    Method{"semismooth-newton", "primal-dual active set on regularised equations, dense or sparse", iterative,
           always, of_any_size<semismooth_newton>},
    Method{"proximal-point", "augmented Lagrangians minimised by Newton steps, dense or sparse", iterative,
           always, of_any_size<proximal_point>},
    Method{"interior-point", "Mehrotra's predictor and corrector, regularised, dense or sparse", iterative,
           always, of_any_size<interior_point>},
    Method{"admm", "alternating directions with over-relaxation, dense or sparse", iterative, always,
           of_any_size<admm>},
    Method{"accelerated-gradient", "projected gradient of the dual, accelerated and restarted", iterative,
           always, of_any_size<accelerated_gradient>},
    Method{"projected-gauss-seidel", "one multiplier after the other, over-relaxed", iterative, when_dense,
           of_any_size<projected_gauss_seidel>},
    Method{"ceres", "proximal least squares by the trust-region method of Ceres", iterative,
           when_ceres_is_there, of_any_size<ceres_method>},
    Method{"drop-negative", "rejected rule, for comparison: holds all rows, drops negative multipliers once",
           for_comparison, when_dense, of_any_size<drop_negative>},
    Method{"exact", "the exact solution in fractions, by proof of the active set found in doubles", direct,
           exact_applies, exact_method},
};

}  // namespace

std::string_view name(MethodKind kind) {
  constexpr std::array<std::string_view, 3> names{"direct", "iterative", "for comparison"};
  return names[static_cast<std::size_t>(kind)];
}

std::span<const Method> methods() { return table; }

const Method* find_method(std::string_view name) {
  for (const Method& method : table)
    if (method.name == name) return &method;
  return nullptr;
}

}  // namespace convex
