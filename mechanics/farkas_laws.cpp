#include "mechanics/farkas_laws.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "convex/exact/exact_sum.hpp"
#include "convex/linear_algebra/complete_orthogonal.hpp"

namespace mechanics {
namespace {

using convex::check_that;
using convex::Index;
using convex::LawReport;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::unit_roundoff;
using convex::Vector;

/// Rows this near to dependent, each of length 1, count as that, as in the solve.
constexpr double counts_as_dependent = 64 * unit_roundoff;

/// Beyond so many numbers the point that meets the rows is not asked for.
constexpr Index most_numbers = 1'000'000;

/// The point that comes nearest to meeting the rows as equations, in the metric of A's diagonal; 0 where they
/// are too many.
Vector nearly_common_point(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  const Index n = problem.dimension(), k = static_cast<Index>(rows.size());
  if (k == 0 || n * k > most_numbers) return Vector::Zero(n);
  const Vector unit = problem.A.diagonal().cwiseSqrt().cwiseInverse();
  Matrix V(k, n);
  Vector s(k);
  for (Index r = 0; r < k; ++r) {
    const Index a = rows[static_cast<std::size_t>(r)];
    const Vector row = problem.U.row(a).cwiseProduct(unit);
    const double length = row.norm() > 0 ? row.norm() : 1;
    V.row(r) = row.transpose() / length;
    s[r] = problem.s[a] / length;
  }
  return convex::linear_algebra::CompleteOrthogonal(V, counts_as_dependent).solve(s).cwiseProduct(unit);
}

/// What the rounding of w, U and s may make of w.s - w.Uq at the point that nearly meets the rows with
/// weights.
double hidden_by_rounding(const NearestPointProblem& problem, const Vector& w) {
  std::vector<Index> rows;
  for (Index a = 0; a < w.size(); ++a)
    if (w[a] != 0) rows.push_back(a);
  const Vector size = nearly_common_point(problem, rows).cwiseAbs();
  double hidden = 0;
  for (Index a : rows) hidden += std::abs(w[a]) * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, size));
  return 2 * unit_roundoff * hidden;
}

}  // namespace

LawReport farkas_laws(const NearestPointProblem& problem, const Vector& w) {
  LawReport report;
  constexpr double tolerance = 1e-12;  // what the contract promises of the weights
  const std::vector<bool> two_sided = convex::marked(problem.rows(), problem.two_sided);
  double wrong_sign = 0;
  for (Index a = 0; a < problem.rows(); ++a)
    if (!two_sided[static_cast<std::size_t>(a)]) wrong_sign = std::max(wrong_sign, -w[a]);
  report.checks.push_back(check_that("the Farkas weights w are >= 0", wrong_sign, 0));
  Vector terms = Vector::Zero(problem.dimension());
  for (Index a = 0; a < problem.rows(); ++a)
    if (std::abs(w[a]) > 0) terms += std::abs(w[a]) * problem.U.row(a).cwiseAbs();
  report.checks.push_back(check_that("w.U = 0: the accelerations cancel",
                                     problem.U.transpose_times(w).cwiseAbs().maxCoeff(),
                                     tolerance * terms.maxCoeff()));
  convex::ExactSum left;
  for (Index a = 0; a < w.size(); ++a) left.add_product(w[a], problem.s[a]);
  const std::string name = "w.s > 0: what is left is a contradiction";
  // Numbers that are exact may be contradictory by less: then fractions decided it. Of rounded ones nobody
  // can.
  const double undecided = hidden_by_rounding(problem, w);
  if (problem.radii && !problem.radii->is_zero())
    report.checks.push_back(check_that(name, left.value() > undecided ? 0 : 1, 0));
  else if (undecided > 0 && std::abs(left.value()) <= undecided)
    report.no_evidence.emplace_back(name + " below the rounding of w and s to doubles");
  else
    report.checks.push_back(check_that(name, left.sign() > 0 ? 0 : 1, 0));
  return report;
}

}  // namespace mechanics
