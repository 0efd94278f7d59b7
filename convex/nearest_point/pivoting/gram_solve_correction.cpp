#include <algorithm>
#include <cmath>

#include "convex/invariant.hpp"
#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"

namespace convex::inline pivoting {

/// As `SmallGramSolve::near_scale`; rows that have not been looked at are then, a few of them first.
double GramSolve::near_scale(double part) {
  constexpr Index few = 8;
  const double small = part * known_.scale;
  Index near = 0;
  bool any = false;
  for (Index j = 0; j < set_->size(); ++j)
    any = any || (!set_->is_two_sided(rows_[j]) && lambda_[j] * length_[j] <= small);
  for (Index a = 0; a < m_; ++a) {
    slack_[a] = set_->slacks()[a];
    if (!set_->holds(a) && slack_[a] <= row_scale_[a] * small) close_[near++] = a;
  }
  if (near > 0 && set_->size() == n_) return 0;
  for (Index first = 0, end = std::min(few, near); first < near; first = end, end = near) {
    Index fresh = 0;
    for (Index k = first; k < end; ++k)
      if (set_->rows().place(close_[k]) < 0) fresh_[fresh++] = close_[k];
    if (fresh > 0 && !set_->look_at(fresh_, fresh)) return 0;
    if (!are_independent(close_ + first, end - first, least_independent)) return 0;
  }
  return any || near > 0 ? small : 0;
}

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
        lambda_[j] = total_[set_->place(j)] = total_low_[set_->place(j)] = 0;
      }
  }
  residual(is_first);
  copy_packs(ld_, r_, dw_);
  kernels_.forward(n_, ld_, A_.T, A_.inverse, dw_);
  rest_loads(is_first, small > 0);
  const Index steps = set_->steps(), size = set_->size();
  if (!set_->settle_rest(rest_, std::sqrt(kernels_.dot(ld_, dw_, dw_)))) return false;
  const bool has_changed = set_->steps() > steps || set_->size() != size;
  invariant(before == set_->rows().count(), "no row is looked at by a correction");
  copy_packs(before, set_->lambda(), y_);
  kernels_.combine(n_, before / 8, set_->rows().whitened(), y_, dw_);
  kernels_.add_multiple(ld_, 1, dw_, w_);
  for (Index p = 0; p < before; ++p) {
    const DoubleDouble sum = two_sum(total_[p], total_low_[p] + y_[p]);
    total_[p] = sum.hi;
    total_low_[p] = sum.lo;
  }
  list_rows_held(has_changed);
  double pull = 0;
  for (Index j = 0; j < set_->size(); ++j) {
    change_[j] = y_[set_->place(j)];
    pull += std::abs(change_[j]) * length_[j];
  }
  acceleration_norm_ = std::sqrt(kernels_.dot(ld_, w_, w_));
  if (!known_.note({.step = std::sqrt(kernels_.dot(ld_, dw_, dw_)) + zeroed,
                    .pull = pull,
                    .is_fresh = is_first || has_changed || small > 0,
                    .factor_condition = problem_.A.factor_condition(),
                    .gram_condition = gram_condition_,
                    .growth = 0,
                    .scale = std::max(acceleration_norm_, z_norm_)}))
    return false;
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
  kernels_.residual(n_, problem_.A.dense_gram().data(), q_low_, m_, problem_.U.dense().data(), set_->size(),
                    rows_, lambda_low_, dq_, r_);
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

bool GramSolve::take_noise_for_zero(bool more) {
  const bool told = known_.take_noise_for_zero({n_, q_, q_low_, dq_, problem_.A.diagonal().data(), unit_,
                                                set_->size(), lambda_, change_, length_, pull_},
                                               more);
  for (Index j = 0; j < set_->size(); ++j) {
    total_[set_->place(j)] = lambda_[j];
    if (lambda_[j] == 0) total_low_[set_->place(j)] = lambda_low_[j] = 0;
  }
  return told;
}

}  // namespace convex::inline pivoting
