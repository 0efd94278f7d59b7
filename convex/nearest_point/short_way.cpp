#include "convex/nearest_point/short_way.hpp"

#include <algorithm>
#include <cmath>

#include "convex/invariant.hpp"
#include "convex/nearest_point/held_residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/refinement.hpp"

namespace convex {
namespace {

/// A row closer than this part of its terms to being taken in or left keeps an answer from being left in
/// doubles.
constexpr double near = 1e-8;

/// Multipliers and slacks up to so many times the largest wrong one may change.
constexpr double room_for_change = 256;

/// Corrections are cheap here: they are made until what is left lies so far below the scale.
constexpr double plenty = 0x1p-76;

/// Slower corrections are left to an orthogonal factor.
constexpr double slowest_contraction = 0x1p-6;

/// Corrections beyond what is enough, for entries that are close to 0.
constexpr int most_more = 3;

/// Corrections before pivoting has lost its way.
constexpr int most_passes = 12;

}  // namespace

ShortWay::ShortWay(const NearestPointProblem& problem, Arena& arena)
    : problem_(problem),
      kernels_(dense_kernels()),
      A_(problem.A.dense_factor()),
      n_(problem.dimension()),
      m_(problem.rows()),
      ld_(A_.ld) {
  const Index k = std::min(n_, m_), places = m_ + 136;  // no fewer than `set_` has
  arena.start((9 * ld_ + 6 * padded(m_) + 8 * n_ + 8 + (n_ + 11) * padded(k) + 4 * padded(places)) / 8 +
              GramPivoting::lines(n_, m_));
  z_ = arena.take_filled(n_, 0.0);
  w_free_ = arena.take<double>(n_);
  w_ = arena.take<double>(n_);
  q_ = arena.take<double>(n_);
  q_low_ = arena.take_filled(n_, 0.0);
  r_ = arena.take<double>(n_);
  dw_ = arena.take<double>(n_);
  dq_ = arena.take<double>(n_);
  inverse_diagonal_ = arena.take_filled(n_, 0.0);
  row_scale_ = arena.take<double>(m_);
  slack_ = arena.take<double>(m_);
  load_ = arena.take<double>(k);
  rows_ = arena.take<Index>(k);
  lambda_ = arena.take<double>(k);
  y_ = arena.take_filled(places, 0.0);
  held_slack_ = arena.take<double>(places);
  total_ = arena.take_filled(places, 0.0);
  rest_ = arena.take<double>(places);
  touched_ = arena.take<Index>(m_);
  close_ = arena.take<Index>(m_);
  fresh_ = arena.take<Index>(m_);
  touched_slack_ = arena.take<double>(m_);
  pack_ = arena.take<double>(8 * n_ + 8);  // two vectors at least
  dual_ = arena.take<double>(n_ * padded(k));
  products_ = arena.take<double>(8 * padded(k));
  const double* diagonal = problem_.A.diagonal().data();
  for (Index i = 0; i < n_; ++i) inverse_diagonal_[i] = 1 / diagonal[i];
  kernels_.squares(m_, n_, problem_.U.dense().data(), inverse_diagonal_, row_scale_);
  for (Index a = 0; a < m_; ++a) row_scale_[a] = std::sqrt(row_scale_[a]);
  edge_.emplace(problem, row_scale_);
  set_.emplace(problem, arena, w_free_, row_scale_);
}

void ShortWay::whiten_force() {
  for (Index i = 0; i < n_; ++i) z_[i] = problem_.z[i];
  copy_packs(ld_, z_, w_free_);
  kernels_.forward(n_, ld_, A_.T, A_.inverse, w_free_);
  scale_ = force_norm_ = std::sqrt(kernels_.dot(ld_, w_free_, w_free_));
}

bool ShortWay::solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution) {
  whiten_force();
  return set_->settle(guess) && finish(accuracy, solution);
}

bool ShortWay::solve_again(const Accuracy& accuracy, Solution& solution) {
  whiten_force();
  return set_->settle_again() && finish(accuracy, solution);
}

/// The rows held are right as far as doubles tell. Their point is corrected in twice the working precision.
/// What multipliers and slacks are wrong then, by rounding, is the scale of a problem of the same kind, for
/// those that are that small: pivoting goes on there, on the same Gram matrix, until nothing is wrong.
bool ShortWay::finish(const Accuracy& accuracy, Solution& solution) {
  take_point();
  if (!accuracy.refine && answer_of_doubles(accuracy, solution)) return true;
  double small = 0;
  int more = most_more;
  for (int pass = 0; pass < most_passes; ++pass) {
    if (!correct(pass == 0, small)) return false;
    small = 0;
    if (!(remaining_ <= plenty * scale_)) continue;
    wrong_ = 0;
    if (!take_noise_for_zero(more > 0)) {
      more -= 1;
      continue;
    }
    const Slacks slacks = measure_slacks();
    if (slacks == Slacks::doubtful) return false;
    if (wrong_ > 0) {
      small = room_for_change * wrong_;
      continue;
    }
    write(solution);
    solution.residuals = residuals_of_active();
    solution.error_bound = bound_ + moved_;
    const bool close = solution.error_bound <= accuracy.tolerance * std::max(1.0, acceleration_norm_);
    solution.status = close ? Status::solved : Status::inaccurate;
    return true;
  }
  return false;
}

/// q and lambda of the rows held, in doubles.
void ShortWay::take_point() {
  set_->point(w_, q_);
  fill_packs(ld_, 0, q_low_);
  copy_packs(set_->rows().count(), set_->lambda(), total_);
  list_rows_held();
  acceleration_norm_ = std::sqrt(kernels_.dot(ld_, w_, w_));
  scale_ = std::max(acceleration_norm_, force_norm_);
}

void ShortWay::list_rows_held() {
  for (Index j = 0; j < set_->size(); ++j) {
    rows_[j] = set_->row(j);
    lambda_[j] = total_[set_->place(j)];
  }
  inverse_norm_ = set_->inverse_norm();
  gram_condition_ = set_->condition(load_);
  condition_ = problem_.A.factor_condition() * (1 + std::sqrt(gram_condition_));
}

/// One correction of q and lambda with residuals in twice the working precision, in which rows change sides
/// whose multipliers (times lengths) and slacks (over them) are `small`. False when it does not settle or
/// does not shrink what is missing.
bool ShortWay::correct(bool is_first, double small) {
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
  const double seen = is_fresh_ ? (scale_ > 0 ? first_ / scale_ : 0)
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

void ShortWay::residual(bool is_first) {
  kernels_.stationarity(n_, problem_.A.dense_gram().data(), q_, m_, problem_.U.dense().data(), set_->size(),
                        rows_, lambda_, z_, r_);
  if (is_first) return;
  copy_packs(ld_, r_, dq_);
  kernels_.residual(n_, problem_.A.dense_gram().data(), q_low_, m_, problem_.U.dense().data(), 0, rows_,
                    lambda_, dq_, r_);
}

/// rest_ := s_a - u_a·q - v_a·dw of the rows held, or of all that matter, at their places.
void ShortWay::rest_loads(bool is_first, bool with_outside) {
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
    for (Index k = 0; k < 8; ++k)
      rest_[first + k] = -rest_[first + k] - (is_first ? 0 : low[k]) - dots[k];
  }
}

/// What the rounding of residuals in twice the working precision leaves.
double ShortWay::floor_of_residuals() const {
  return 4 * unit_roundoff * unit_roundoff * condition_ * scale_;
}

/// Takes what cancels for 0; or false, if `more`, when another correction may tell some of it from 0.
/// `wrong_` becomes the size of a negative multiplier, if there is one.
bool ShortWay::take_noise_for_zero(bool more) {
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
        !(std::abs(q_[i]) <= std::max(16 * usual * std::abs(dq_[i]),
                                      floor * std::sqrt(inverse_diagonal_[i]))))
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

/// The answer as doubles give it. False when a row is close to tipping over, or the bound by what is missing
/// of the equations does not do.
bool ShortWay::answer_of_doubles(const Accuracy& accuracy, Solution& solution) {
  fill_packs(ld_, 0, q_low_);
  remaining_ = rounding_ = silenced_ = 0;
  for (Index j = 0; j < set_->size(); ++j)
    if (!set_->is_two_sided(rows_[j]) &&
        !(lambda_[j] * std::sqrt(set_->rows().square(set_->place(j))) > near * scale_))
      return false;
  if (measure_slacks() != Slacks::kept || touched_count_ > 0) return false;
  for (Index a = 0; a < m_; ++a)
    if (!set_->holds(a) && !(slack_[a] > near * (std::abs(problem_.s[a]) + row_scale_[a] * magnitude_)))
      return false;
  double missing = 0;
  for (Index j = 0; j < set_->size(); ++j)
    missing += held_slack_[set_->place(j)] * held_slack_[set_->place(j)];
  solution.residuals = residuals_of_active();
  bound_ = bound_of_doubles(n_, set_->size(), solution.residuals.stationarity * scale_,
                            inverse_norm_ * std::sqrt(missing), condition_ * (scale_ + magnitude_));
  write(solution);
  solution.status = Status::solved;
  return bound_ <= accuracy.tolerance * std::max(1.0, acceleration_norm_);
}

bool ShortWay::touches_rows() const {
  return std::any_of(touched_, touched_ + touched_count_, [&](Index a) { return !(slack_[a] > 0); });
}

void ShortWay::write(Solution& solution) const {
  solution.method = "active-set";
  solution.undecided = problem_.radii && touches_rows() ? open_question::touched : std::string_view();
  solution.model.islands.clear();
  solution.steps = set_->steps();
  solution.q = Eigen::Map<const Vector>(q_, n_);
  solution.lambda.setZero(m_);
  for (Index j = 0; j < set_->size(); ++j) solution.lambda[rows_[j]] = lambda_[j];
  solution.slack = Eigen::Map<const Vector>(slack_, m_);
  solution.basis.assign(rows_, rows_ + set_->size());
  solution.acceleration_norm = acceleration_norm_;
  solution.force_norm = force_norm_;
  solution.rounding = rounding_;
  solution.error_bound = bound_;
}

/// Slacks at q in doubles; those of rows held count as 0 and go to `held_slack_`.
void ShortWay::set_slacks_of_doubles() {
  kernels_.slacks(m_, n_, problem_.U.dense().data(), q_, problem_.s.data(), slack_);
  magnitude_ = 0;
  for (Index i = 0; i < n_; ++i) magnitude_ += q_[i] * q_[i] / inverse_diagonal_[i];
  magnitude_ = std::sqrt(magnitude_);
  Index held = 0;
  for (Index a = 0; a < m_; ++a) {
    if (!set_->holds(a)) continue;
    held += 1;
    held_slack_[set_->rows().place(a)] = slack_[a];
    slack_[a] = 0;
  }
  invariant(held == set_->size(), "a row that counts as held is among the rows held");
}

/// Slacks at the refined point. Rows violated have been looked at then.
ShortWay::Slacks ShortWay::measure_slacks() {
  set_slacks_of_doubles();
  const double rounding = 2 * static_cast<double>(n_) * unit_roundoff;
  const double unsure_point = margin * (remaining_ + silenced_);
  Index violated = 0;
  touched_count_ = 0;
  for (Index a = 0; a < m_; ++a) {
    if (set_->holds(a)) continue;
    const double unsure =
        rounding * (std::abs(problem_.s[a]) + row_scale_[a] * magnitude_) + row_scale_[a] * unsure_point;
    if (slack_[a] > unsure) continue;
    if (slack_[a] < -unsure) {
      close_[violated++] = a;
      wrong_ = std::max(wrong_, -slack_[a] / row_scale_[a]);
    } else {
      touched_[touched_count_++] = a;
    }
  }
  moved_ = 0;
  if (violated > 0) return look_at_violated(violated);
  if (wrong_ > 0) return Slacks::kept;
  return touched_count_ == 0 ? Slacks::kept : judge_touched_rows();
}

/// Looks at the first `count` rows of close_, for the next correction to take them in.
ShortWay::Slacks ShortWay::look_at_violated(Index count) {
  Index fresh = 0;
  for (Index k = 0; k < count; ++k)
    if (set_->rows().place(close_[k]) < 0) fresh_[fresh++] = close_[k];
  return fresh == 0 || set_->look_at(fresh_, fresh) ? Slacks::violated : Slacks::doubtful;
}

/// `residuals`, to which only the rows held and touched matter; measured in doubles.
Residuals ShortWay::residuals_of_active() {
  kernels_.residual(n_, problem_.A.dense_gram().data(), q_, m_, problem_.U.dense().data(), set_->size(),
                    rows_, lambda_, z_, r_);
  kernels_.forward(n_, ld_, A_.T, A_.inverse, r_);
  const double stationarity = std::sqrt(kernels_.dot(ld_, r_, r_));
  double most = 0;
  for (Index j = 0; j < set_->size(); ++j) most = std::max(most, std::abs(lambda_[j]));
  HeldResiduals held(stationarity, acceleration_norm_, scale_, most);
  for (Index j = 0; j < set_->size(); ++j)
    held.add(problem_.s[rows_[j]], std::sqrt(set_->rows().square(set_->place(j))), lambda_[j],
             held_slack_[set_->place(j)], set_->is_two_sided(rows_[j]));
  Residuals found = held.all();
  found.feasibility = violation_of_touched_rows(found.feasibility);
  return found;
}

}  // namespace convex
