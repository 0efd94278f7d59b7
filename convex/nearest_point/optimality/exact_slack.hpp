#pragma once

#include <optional>
#include <span>
#include <vector>

#include "convex/double_double.hpp"
#include "convex/exact/exact_sum.hpp"
#include "convex/nearest_point/problem.hpp"

/// Signs of slacks without rounding, for rows whose slack twice the working precision cannot tell from zero.
namespace convex::inline optimality {

/// Slacks where rows S hold with equality, without rounding.
class SlackOnEdge {
 public:
  /// row_scale: ||u_a||_(D⁻¹), D the diagonal of A: m. Both are referred to.
  SlackOnEdge(const NearestPointProblem& problem, const double* row_scale);
  /// Looks at s, which may have changed, so that sums of it are quick.
  void begin();

  /// The double nearest to u_p·q - s_p, with its sign, at every q where the `count` rows `held` hold with
  /// equality. None unless u_p is the sum of c_k / c_0 u_k over them with whole numbers c up to
  /// `largest_denominator` that `coefficients` are close to: then not one bit is left over.
  std::optional<double> slack(Index p, const Index* held, Index count, const double* coefficients);
  /// The same for up to eight rows of a dense U, which are also side by side in X; coefficients: eight for
  /// each row of the working set.
  void slacks(std::span<const Index> rows, const double* X, const Index* held, Index count,
              const double* coefficients, std::optional<double>* into);

 private:
  bool shows_that_it_is_none(Index p, const Index* held, Index count, const double* coefficients) const;
  bool cancels(Index p, double whole) const;
  double slack_of_loads(Index p, double whole) const;

  const NearestPointProblem& problem_;
  const double* row_scale_;
  std::vector<Index> rows_;  // the first count_: of a sum, with their coefficients; all with sum_ added up
  std::vector<double> coefficients_, side_by_side_;
  std::size_t count_ = 0;
  double sum_ = 0;                                     ///< of the sizes of all factors
  bool rows_on_grid_ = false, loads_on_grid_ = false;  ///< sums of few U or s are exact in doubles
};

/// Doubles q, of which no copy is made.
using Point = Eigen::Ref<const Vector>;

/// Whether q is the point of the rows `held` and keeps those `degenerate`, all without rounding: the working
/// set and two-sided ones have a slack of 0, the others none below. Their slacks at q then, each the double
/// nearest to its own, one for each of the latter. With multipliers lambda >= 0 of the working set, ||q -
/// q*||_A
/// <=
/// ||Aq - z - Uᵀlambda||_(A⁻¹), q* the solution.
bool keeps_rows(const NearestPointProblem&, const Point& q, std::span<const Index> held,
                std::span<const Index> degenerate, double* slacks);
/// The slacks; none where q does not keep the rows.
std::optional<Vector> slacks_if_kept(const NearestPointProblem&, const Point& q, std::span<const Index> held,
                                     std::span<const Index> degenerate);

/// Aq = z + Uᵀlambda, without rounding. lambda: m.
bool is_in_balance(const NearestPointProblem&, const Point& q, const DoubleDoubleVector& lambda);

/// sum / divisor, rounded, and a double of its sign where that is 0 but the sum is not.
double quotient_with_sign(const ExactSum& sum, double divisor);

/// u_a·q - s_a at the doubles q, rounded once, with its sign.
double slack_at(const NearestPointProblem&, Index a, const Point& q);
/// The sign alone.
int sign_of_slack(const NearestPointProblem&, Index a, const Point& q);
}  // namespace convex::inline optimality
