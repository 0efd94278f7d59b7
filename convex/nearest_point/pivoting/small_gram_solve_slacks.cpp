#include <algorithm>
#include <cmath>
#include <utility>

#include "convex/nearest_point/pivoting/small_gram_solve.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// Rows touched that are looked at before it is known whether they are sums of rows held, where some must be,
/// for all are more than there are coordinates; `few_touched` otherwise.
constexpr Index few_where_sums = 8;

}  // namespace

/// Slacks of all rows and what is missing of the equations of motion, in doubles.
void SmallGramSolve::measure() {
  small_kernels().measure(tableau_);
  if (!looks_at_all()) measure_slacks_of_all();
}

void SmallGramSolve::measure_slacks_of_all() {
  SmallTableau& t = tableau_;
  dense_kernels().slacks(t.all, t.n, t.U, t.q, problem_.s.data(), slack_);
  for (Index p = 0; p < t.m; ++p)
    if (t.row[p] >= 0) t.slack[p] = slack_[t.row[p]];
}

/// Whether no row outside is close, of ||q||_A or that size if it is larger.
bool SmallGramSolve::is_clear(double size) {
  const Index close =
      close_rows(near_zero, near_zero * std::max(size, tableau_.magnitude) + known_.missing_slack(1));
  return std::all_of(close_, close_ + close, [&](Index a) { return holds(a); });
}

/// Lists those in close_ whose slack is not above `absolute` |s| + `by_length` times the length.
Index SmallGramSolve::close_rows(double absolute, double by_length) {
  const SmallTableau& t = tableau_;
  const double *const s = looks_at_all() ? t.level : problem_.s.data(), *const end =
                                                                            s + (looks_at_all() ? t.stride
                                                                                                : t.all);
  return small_kernels().close_rows(t.all, slack_, s, end, row_scale_, absolute, by_length, close_);
}

/// Whether q is 0, the point of the rows held, and keeps all others, without rounding.
bool SmallGramSolve::is_at_rest() const {
  const SmallTableau& t = tableau_;
  const auto is_zero = [](double x) { return x == 0; };
  const Vector& s = problem_.s;
  return std::all_of(t.q, t.q + t.n, is_zero) && !problem_.radii &&
         (dense_kernels().largest_size(t.all, s.data()) == 0 || s.maxCoeff() <= 0) &&
         std::all_of(t.rows, t.rows + t.size, [&](Index a) { return s[a] == 0; });
}

Slacks SmallGramSolve::measure_slacks() {
  measure();
  touched_violation_ = 0;
  if (known_.wrong == 0 && is_at_rest()) {
    for (Index a = 0; a < tableau_.all; ++a) slack_[a] = 0 - problem_.s[a];
    return Slacks::kept;
  }
  const double rounding = 2 * static_cast<double>(tableau_.n) * unit_roundoff,
               by_length = rounding * tableau_.magnitude + known_.missing_slack(1);
  const Index close = close_rows(rounding, by_length);
  const Index open = std::remove_if(close_, close_ + close, [&](Index a) { return holds(a); }) - close_;
  touched_count_ = std::partition(close_, close_ + open,
                                  [&](Index a) {
                                    return !(slack_[a] < -(rounding * std::abs(problem_.s[a]) +
                                                           by_length * row_scale_[a]));
                                  }) -
                   close_;
  if (touched_count_ < open) return look_at_violated({close_ + touched_count_, close_ + open});
  if (known_.wrong > 0) return Slacks::violated;
  return touched_count_ == 0 ? Slacks::kept : decide_degenerate_rows();
}

/// Rows violated beyond rounding are to come in with the next correction.
Slacks SmallGramSolve::look_at_violated(std::span<const Index> rows) {
  for (Index a : rows) known_.wrong = std::max(known_.wrong, -slack_[a] / row_scale_[a]);
  if (!std::isfinite(known_.wrong)) return Slacks::doubtful;  // 0 >= s > 0
  return look_at_fresh(rows, tableau_.all) ? Slacks::violated : Slacks::doubtful;
}

/// Looks at those of the rows that have not been looked at, if they are no more than so many. False when
/// there is no room for them.
bool SmallGramSolve::look_at_fresh(std::span<const Index> rows, Index most) {
  Index fresh[SmallTableau::most], count = 0;
  for (Index a : rows)
    if (place(a) < 0 && count++ < SmallTableau::most) fresh[count - 1] = a;
  return count == 0 || count > most ||
         (tableau_.stride + padded(count) <= SmallTableau::most && look_at(fresh, count));
}

/// As in `GramSolve`, but for the way up, which is left to it.
Slacks SmallGramSolve::decide_degenerate_rows() {
  SmallTableau& t = tableau_;
  if (problem_.radii) return Slacks::doubtful;
  if (keeps_touched_rows()) {
    for (Index k = 0; k < touched_count_; ++k) slack_[close_[k]] = touched_slack_[k];
    return Slacks::kept;
  }
  // ||u||_(A⁻¹) is at least this part of ||u||_(D⁻¹).
  const double part = 1 / std::sqrt(static_cast<double>(t.n));
  for (Index a : touched()) {
    const double size = std::abs(problem_.s[a]) + part * row_scale_[a] * t.acceleration_norm;
    if (slack_[a] < 0 && size > 0) touched_violation_ = std::max(touched_violation_, -slack_[a] / size);
  }
  // Few are looked at, so that their columns tell what they depend on; of many the sums are taken out first.
  const Index few = t.size + touched_count_ > t.n ? few_where_sums : few_touched;
  if (!look_at_fresh(touched(), few) || !leave_sums_of_rows_held()) return Slacks::doubtful;
  if (touched_count_ == 0) return Slacks::kept;
  if (!look_at_fresh(touched(), t.all)) return Slacks::doubtful;
  alignas(64) double known[SmallTableau::most], precise[SmallTableau::most];
  copy_packs(t.stride, t.slack, known);
  small_kernels().measure_precisely(t);
  copy_packs(t.stride, t.slack, precise);
  copy_packs(t.stride, known, t.slack);
  Index violated = 0;
  for (Index a : touched()) {
    const Index p = place(a);
    slack_[a] = t.slack[p] = precise[p];
    const double noise = zero_of_pairs * (std::abs(t.level[p]) + t.row_scale[p] * known_.scale) +
                         known_.missing_slack(t.row_scale[p]);
    if (slack_[a] < -noise)
      close_[violated++] = a;  // those before have been seen
    else if (!(slack_[a] > noise))
      return Slacks::doubtful;
  }
  return violated == 0 ? Slacks::kept : look_at_violated({close_, close_ + violated});
}

/// Takes out of the rows touched those that are sums of rows held with short fractions as coefficients, not
/// one bit left over, and ask for no more than they do. False when one asks for more.
bool SmallGramSolve::leave_sums_of_rows_held() {
  const SmallTableau& t = tableau_;
  if (t.size == 0) return true;
  alignas(64) double dual[SmallTableau::most_coordinates * SmallTableau::most_coordinates];
  double coefficients[SmallTableau::most];
  bool has_dual = false, asks_more = false;
  if (!edge_) edge_.emplace(problem_, row_scale_);
  edge_->begin();
  touched_count_ =
      std::remove_if(close_, close_ + touched_count_,
                     [&](Index a) {
                       if (const Index p = place(a); p >= 0) {  // swept, its column has its coefficients
                         if (t.swept[p * (t.stride + 1)] > zero_coefficient * t.square[p]) return false;
                         for (Index k = 0; k < t.size; ++k)
                           coefficients[k] = t.swept[p * t.stride + t.place[k]];
                       } else {
                         if (!std::exchange(has_dual, true)) small_kernels().dual_rows(t, dual);
                         dense_kernels().combine_runs(t.n, padded(t.size), dual, t.U + a * t.n, coefficients);
                       }
                       // Most rows that are no sum show it in their first entry.
                       double first = t.U[a * t.n];
                       for (Index k = 0; k < t.size; ++k) first -= coefficients[k] * t.U[t.rows[k] * t.n];
                       if (std::abs(first) * t.unit[0] > zero_coefficient * row_scale_[a]) return false;
                       const std::optional<double> on_edge = edge_->slack(a, t.rows, t.size, coefficients);
                       if (!on_edge) return false;
                       asks_more = asks_more || *on_edge < 0;
                       slack_[a] = *on_edge;
                       return true;
                     }) -
      close_;
  return !asks_more;
}

bool SmallGramSolve::keeps_touched_rows() const {
  const SmallTableau& t = tableau_;
  return keeps_rows(problem_, Eigen::Map<const Vector>(t.q, t.n), {t.rows, t.rows + t.size}, touched(),
                    touched_slack_);
}

}  // namespace convex::inline pivoting
