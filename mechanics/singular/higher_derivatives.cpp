#include <cmath>

#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "mechanics/singular/rounded_rows.hpp"
#include "mechanics/singular/singular_group.hpp"

namespace mechanics::inline singular_states {

using expression::Rounded;
using expression::TimeSeries;

namespace {

/// Motions near q_0 as Taylor coefficients of the coordinates of a group, on which some of its constraints
/// vanish order by order.
class Lift {
 public:
  /// gradients: of the constraints `independent`, in units of the coordinates.
  Lift(const expression::ConstraintSeries& series, std::vector<TimeSeries> q, TimeSeries t,
       const std::vector<Index>& columns, const Vector& unit, const std::vector<Index>& independent,
       const Matrix& gradients)
      : series_(series),
        q_(std::move(q)),
        t_(t),
        columns_(columns),
        unit_(unit),
        independent_(independent),
        gradients_(gradients) {}

  /// Adds a move, in units, to the coefficients of order k.
  void move(const Vector& by, int k) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const double step = by[static_cast<Index>(i)] * unit_[static_cast<Index>(i)];
      coefficient(i, k) += Rounded(step, rounding * std::abs(step));
    }
  }
  /// The shortest coefficients of orders `first` to `last` on which the independent constraints vanish; false
  /// where these are not finite.
  bool lift(int first, int last) {
    if (independent_.empty()) return true;
    const convex::linear_algebra::CompleteOrthogonal factor(gradients_);
    for (int k = first; k <= last; ++k) {
      const std::vector<TimeSeries> f = series_.along(q_, t_, k);
      Vector rest(gradients_.rows()), radius(gradients_.rows());
      for (std::size_t j = 0; j < independent_.size(); ++j) {
        const Rounded at = f[static_cast<std::size_t>(independent_[j])].c[static_cast<std::size_t>(k)];
        rest[static_cast<Index>(j)] = at.value;
        radius[static_cast<Index>(j)] = at.radius;
      }
      if (!rest.allFinite() || !radius.allFinite()) return false;
      const Vector step = factor.solve(-rest);
      const double spread = factor.solve(radius).norm() + factor.solve(-radius).norm();
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        const double at = step[static_cast<Index>(i)], unit = unit_[static_cast<Index>(i)];
        coefficient(i, k) += Rounded(at * unit, (rounding * std::abs(at) + spread) * unit);
      }
    }
    return true;
  }
  std::vector<TimeSeries> constraints(int order) const { return series_.along(q_, t_, order); }

 private:
  static constexpr double rounding = 0x1p-48;

  Rounded& coefficient(std::size_t i, int k) {
    return q_[static_cast<std::size_t>(columns_[i])].c[static_cast<std::size_t>(k)];
  }

  const expression::ConstraintSeries& series_;
  std::vector<TimeSeries> q_;
  TimeSeries t_;
  const std::vector<Index>& columns_;
  const Vector& unit_;
  const std::vector<Index>& independent_;
  const Matrix& gradients_;
};

/// An orthonormal basis of what is off the span of the rows kept, by columns.
Matrix free_directions(const RowSpace& held) {
  const Index n = held.columns();
  Matrix basis(n, n - held.size());
  Index count = 0;
  for (Index i = 0; i < n && count < basis.cols(); ++i) {
    Vector x = held.off_span(Vector::Unit(n, i));
    for (int pass = 0; pass < 2; ++pass) x -= basis.leftCols(count) * (basis.leftCols(count).transpose() * x);
    constexpr double long_enough = 1e-3;
    if (x.norm() > long_enough / std::sqrt(static_cast<double>(n))) basis.col(count++) = x.normalized();
  }
  return basis.leftCols(count);
}

}  // namespace

/// Along q(t) = q_0 + q' t + ½ q'' t² + Σ r_k t^k the combination f = Σ w_a f_a begins with a form in r_k,
/// k = 3, 4, …, that t^(2k) multiplies: like that of the fourth derivatives in its second degree, hence
/// definite where this is. At its extremum all coefficients in between vanish, and its value there decides:
/// of the sign of the form, f keeps that sign near q'' t²/2 and vanishes on no motion with this q''; of the
/// other, there are such motions. Where it is 0 the next k does.
std::optional<SingularGroup::Motion> SingularGroup::motion_with(const Dependence& dependence,
                                                                const std::vector<Rounded>& q2,
                                                                double sign) const {
  constexpr Index most_free = 10;
  constexpr int first = 3, last = expression::most_derivatives / 2;
  const Matrix free = free_directions(held_);
  const Index d = free.cols();
  if (d == 0 || d > most_free || held_.size() != static_cast<Index>(independent_.size())) return std::nullopt;
  Matrix gradients(static_cast<Index>(independent_.size()), unit_.size());
  for (std::size_t i = 0; i < columns_.size() && !independent_.empty(); ++i) {
    const std::vector<TimeSeries> f = along_column(i, 1, false);
    for (std::size_t j = 0; j < independent_.size(); ++j)
      gradients(static_cast<Index>(j), static_cast<Index>(i)) =
          f[static_cast<std::size_t>(independent_[j])].c[1].value * unit_[static_cast<Index>(i)];
  }
  Lift motion(series_, coordinates_along(q2), time_along(), columns_, unit_, independent_, gradients);
  double size = 1;
  for (std::size_t i = 0; i < q2.size(); ++i)
    size = std::max(size, std::abs(q2[i].value) / unit_[static_cast<Index>(i)]);
  const auto coefficient = [&](const Lift& at, int order) {
    const std::vector<TimeSeries> f = at.constraints(order);
    Rounded total;
    for (std::size_t a = 0; a < dependence.weights.size(); ++a)
      total += dependence.weights[a] * f[a].c[static_cast<std::size_t>(order)];
    return total;
  };
  for (int k = first; k <= last; ++k) {
    if (!motion.lift(k, k)) return std::nullopt;
    // Σ w_a f_a in t^order when r_k moves.
    const auto value = [&](const Vector& move, int order) -> Rounded {
      Lift moved = motion;
      moved.move(free * move, k);
      if (!moved.lift(k + 1, order)) return {0, INFINITY};
      return coefficient(moved, order);
    };
    const auto decided = [&](Rounded at, int order) -> std::optional<Motion> {
      if (!is_finite(at) || at.may_be_zero()) return std::nullopt;
      return Motion{sign * at.value < 0, order};
    };
    const Vector nowhere = Vector::Zero(d);
    const Rounded odd = value(nowhere, 2 * k - 1), even = value(nowhere, 2 * k);
    if (!is_finite(odd) || !is_finite(even)) return std::nullopt;
    if (const auto found = decided(odd, 2 * k - 1)) return found;
    Vector gradient(d);
    Matrix hessian(d, d);
    std::vector<Rounded> ahead, behind;
    for (Index i = 0; i < d; ++i) {
      ahead.push_back(value(size * Vector::Unit(d, i), 2 * k));
      behind.push_back(value(-size * Vector::Unit(d, i), 2 * k));
      gradient[i] = (ahead.back().value - behind.back().value) / (2 * size);
      hessian(i, i) = (ahead.back().value - even.value + (behind.back().value - even.value)) / (size * size);
      for (Index j = 0; j < i; ++j) {
        const Rounded both = value(size * (Vector::Unit(d, i) + Vector::Unit(d, j)), 2 * k);
        hessian(i, j) = hessian(j, i) = (both.value - ahead[static_cast<std::size_t>(i)].value -
                                         ahead[static_cast<std::size_t>(j)].value + even.value) /
                                        (size * size);
      }
    }
    if (!gradient.allFinite() || !hessian.allFinite()) return std::nullopt;
    const convex::linear_algebra::SymmetricEigen eigen(sign * hessian);
    constexpr double nothing = 1e-9;
    Vector move = nowhere;
    for (Index i = 0; i < d; ++i) {
      const double curvature = eigen.values[i];
      const double slope = eigen.vectors.col(i).dot(gradient);
      if (curvature > nothing * eigen.values.cwiseAbs().maxCoeff())
        move -= eigen.vectors.col(i) * (sign * slope / curvature);
      else if (std::abs(slope) > nothing * (gradient.norm() + std::abs(even.value) / size))
        return Motion{true, 2 * k};  // linear, it takes both signs
    }
    if (const auto found = decided(value(move, 2 * k), 2 * k)) return found;
    motion.move(free * move, k);
  }
  return std::nullopt;
}

}  // namespace mechanics::inline singular_states
