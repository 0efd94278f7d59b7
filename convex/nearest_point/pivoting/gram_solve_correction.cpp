#include <algorithm>
#include <cmath>

#include "convex/invariant.hpp"
#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"

namespace convex {
namespace {

/// Slower corrections are left to an orthogonal factor.
constexpr double slowest_contraction = 0x1p-6;

}  // namespace

/// One correction of q and lambda with residuals in twice the working precision, in which rows change sides
/// whose multipliers (times lengths) and slacks (over them) are `small`. False when it does not settle or
/// does not shrink what is missing.
bool GramSolve::correct(bool is_first, double small) {
  const Index before = set_->rows().count();
  double zeroed = 0;
  if (small > 0) {
    set_->clear_rows(small, total_, slack_);
    for (Index j = 0; j < set_->size(); ++j)
      if (set_->is_weak(rows_[j])) {
        zeroed += std::abs(lambda_[j]) * std::sqrt(set_->rows().square(set_->place(j)));
        lambda_[j] = total_[set_->place(j)] = 0;
      }
  }
  residual(is_first);
  copy_packs(ld_, r_, dw_);
  kernels_.forward(n_, ld_, A_.T, A_.inverse, dw_);
  rest_loads(is_first, small > 0);
  const Index steps = set_->steps();
  if (!set_->settle_rest(rest_, std::sqrt(kernels_.dot(ld_, dw_, dw_)))) return false;
  const bool has_changed = set_->steps() > steps || small > 0;
  invariant(before == set_->rows().count(), "no row is looked at by a correction");
  copy_packs(before, set_->lambda(), y_);
  kernels_.combine(n_, before / 8, set_->rows().whitened(), y_, dw_);
  kernels_.add_multiple(ld_, 1, dw_, w_);
  kernels_.add_multiple(before, 1, y_, total_);
  list_rows_held();
  const double previous = first_;
  first_ = std::sqrt(kernels_.dot(ld_, dw_, dw_)) + zeroed;
  acceleration_norm_ = std::sqrt(kernels_.dot(ld_, w_, w_));
  scale_ = std::max(acceleration_norm_, force_norm_);
  is_fresh_ = is_first || has_changed;
  const double seen = is_fresh_                                       ? (scale_ > 0 ? first_ / scale_ : 0)
                      : first_ > at_rounding * scale_ && previous > 0 ? first_ / previous
                                                                      : 0;
  const double usual = std::max(seen, usual_contraction(problem_.A.factor_condition(), gram_condition_));
  // A residual is rounded once, and the factors of A and of the rows held enlarge that; a second correction
  // with the same rows shows by how much.
  const double contraction =
      is_fresh_ ? std::max(seen, expected_contraction(problem_.A.factor_condition(), gram_condition_, true))
                : usual;
  if (!(contraction <= slowest_contraction)) return false;
  remaining_ = first_ * contraction / (1 - contraction) + floor_of_residuals();
  likely_ = std::min(remaining_, first_ * usual);
  copy_packs(ld_, dw_, dq_);
  kernels_.backward(n_, ld_, A_.T, A_.inverse, dq_);
  for (Index i = 0; i < n_; ++i) {
    const DoubleDouble sum = two_sum(q_[i], q_low_[i] + dq_[i]);
    q_[i] = sum.hi;
    q_low_[i] = sum.lo;
  }
  return true;
}

void GramSolve::residual(bool is_first) {
  kernels_.stationarity(n_, problem_.A.dense_gram().data(), q_, m_, problem_.U.dense().data(), set_->size(),
                        rows_, lambda_, z_, r_);
  if (is_first) return;
  copy_packs(ld_, r_, dq_);
  kernels_.residual(n_, problem_.A.dense_gram().data(), q_low_, m_, problem_.U.dense().data(), 0, rows_,
                    lambda_, dq_, r_);
}

/// rest_ := s_a - u_a·q - v_a·dw of the rows held, or of all that matter, at their places.
void GramSolve::rest_loads(bool is_first, bool with_outside) {
  alignas(64) double dots[8], low[8];
  for (Index first = 0; first < set_->rows().count(); first += 8) {
    bool any = false;
    for (Index p = first; p < first + 8; ++p)
      if (const Index a = set_->rows().row(p); a >= 0)
        any = any || (with_outside ? set_->matters(a) : set_->holds(a));
    if (!any) {
      fill_packs(8, 0, rest_ + first);
      continue;
    }
    kernels_.precise_slacks(n_, set_->rows().raw() + first * n_, q_, set_->rows().s() + first, rest_ + first);
    kernels_.dots(n_, set_->rows().whitened() + first * n_, dw_, dots);
    if (!is_first) kernels_.dots(n_, set_->rows().raw() + first * n_, q_low_, low);
    for (Index k = 0; k < 8; ++k) rest_[first + k] = -rest_[first + k] - (is_first ? 0 : low[k]) - dots[k];
  }
}

/// What the rounding of residuals in twice the working precision leaves.
double GramSolve::floor_of_residuals() const {
  return 4 * unit_roundoff * unit_roundoff * condition_ * scale_;
}

/// Takes what cancels for 0; or false, if `more`, when another correction may tell some of it from 0.
/// `wrong_` becomes the size of a negative multiplier, if there is one.
bool GramSolve::take_noise_for_zero(bool more) {
  const double usual = usual_contraction(problem_.A.factor_condition(), gram_condition_);
  const double missing = 4 * likely_ * problem_.A.factor_condition();
  // The second correction of an entry is more than what is missing in it.
  const auto noise_of = [&](double unit, double floor, double step) {
    return is_fresh_ ? std::max(missing * unit, cancelled * std::abs(step))
                     : std::max(floor * unit, 2 * std::abs(step));
  };
  const double floor = at_rounding * scale_, floor_of_multipliers = floor_of_residuals();
  for (Index i = 0; i < n_ && more; ++i)
    if (std::abs(q_[i]) <= noise_of(std::sqrt(inverse_diagonal_[i]), floor, dq_[i]) &&
        !(std::abs(q_[i]) <=
          std::max(16 * usual * std::abs(dq_[i]), floor * std::sqrt(inverse_diagonal_[i]))))
      return false;
  double rounded = 0, silenced = 0, let_pull = 0;
  for (Index i = 0; i < n_; ++i) {
    if (std::abs(q_[i]) <= noise_of(std::sqrt(inverse_diagonal_[i]), floor, dq_[i])) {
      silenced += problem_.A.diagonal()[i] * q_[i] * q_[i];
      q_[i] = q_low_[i] = 0;
    }
    rounded += problem_.A.diagonal()[i] * q_low_[i] * q_low_[i];
  }
  for (Index j = 0; j < set_->size(); ++j) {
    const Index place = set_->place(j);
    // Rows may be told in units far apart: each multiplier is measured by the length of its own.
    const double unit = std::sqrt(gram_condition_ / set_->rows().square(place));
    const double pull = -lambda_[j] * std::sqrt(set_->rows().square(place));
    const bool may_be_wrong = pull > 0 && !set_->is_two_sided(rows_[j]);
    if (std::abs(lambda_[j]) <= noise_of(unit, floor_of_multipliers, y_[place])) {
      lambda_[j] = total_[place] = 0;
      if (may_be_wrong) let_pull += pull;
    } else if (may_be_wrong) {
      wrong_ = std::max(wrong_, pull);
    }
  }
  rounding_ = std::sqrt(static_cast<double>(n_) * rounded);
  silenced_ = std::sqrt(static_cast<double>(n_) * silenced);
  bound_ = 2 * remaining_ + silenced_ + rounding_ + let_pull;
  return true;
}

}  // namespace convex
