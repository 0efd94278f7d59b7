#include <algorithm>
#include <cmath>

#include "convex/exact/exact_sum.hpp"
#include "convex/invariant.hpp"
#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A way up is one for a row that it raises by more than this part of the row's length.
constexpr double least_rise = 1e-3;

}  // namespace

/// Slacks at q in doubles; those of rows held count as 0 and go to `held_slack_`.
void GramSolve::set_slacks_of_doubles() {
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
Slacks GramSolve::measure_slacks() {
  set_slacks_of_doubles();
  const double rounding = 2 * static_cast<double>(n_) * unit_roundoff;
  Index violated = 0;
  touched_count_ = 0;
  for (Index a = 0; a < m_; ++a) {
    if (set_->holds(a)) continue;
    const double unsure = rounding * (std::abs(problem_.s[a]) + row_scale_[a] * magnitude_) +
                          known_.missing_slack(row_scale_[a]);
    if (slack_[a] > unsure) continue;
    if (slack_[a] < -unsure) {
      close_[violated++] = a;
      known_.wrong = std::max(known_.wrong, -slack_[a] / row_scale_[a]);
    } else {
      touched_[touched_count_++] = a;
    }
  }
  moved_ = 0;
  if (violated > 0) return look_at_violated(violated);
  if (known_.wrong > 0) return Slacks::kept;
  return touched_count_ == 0 ? Slacks::kept : decide_degenerate_rows();
}

/// Looks at the first `count` rows of close_, for the next correction to take them in.
Slacks GramSolve::look_at_violated(Index count) {
  Index fresh = 0;
  for (Index k = 0; k < count; ++k)
    if (set_->rows().place(close_[k]) < 0) fresh_[fresh++] = close_[k];
  return fresh == 0 || set_->look_at(fresh_, fresh) ? Slacks::violated : Slacks::doubtful;
}

/// Rounding alone may hide that the exact point p of the rows held violates a row outside by 2⁻⁹⁵ or so.
/// Where the doubles q are p and keep all rows without rounding, as at most vertices and at rest, nothing is
/// left to tell; nor for a row that is a sum of rows held, not one bit left over, and asks for no more than
/// they do. Where a motion e along the rows held raises all others that p touches, p + t e keeps all rows for
/// a tiny t. Then ||q* - p|| <= t ||e||, q* the solution, since f grows by the square of that: a bound
/// (`moved_`), whatever the angles are at which the rows meet. False when there is doubt.
Slacks GramSolve::decide_degenerate_rows() {
  if (keeps_rows(problem_, Eigen::Map<const Vector>(q_, n_), {rows_, rows_ + set_->size()},
                 {touched_, touched_ + touched_count_}, touched_slack_)) {
    for (Index k = 0; k < touched_count_; ++k) slack_[touched_[k]] = touched_slack_[k];
    return Slacks::kept;
  }
  if (const Index violated = measure_touched_slacks(); violated > 0) return look_at_violated(violated);
  Index open = 0;  // close_ has so many rows that no exact sum has told of
  for (Index k = 0; k < touched_count_; ++k)
    if (!(slack_[touched_[k]] > 0)) close_[open++] = touched_[k];
  open = leave_sums_of_rows_held(open);
  if (open < 0) return Slacks::doubtful;
  Index count = 0, fresh = 0;
  for (Index k = 0; k < open; ++k) {
    const Index a = close_[k];
    if (const std::optional<double> on_edge = slack_by_parallel_row(a)) {
      if (*on_edge < 0) return Slacks::doubtful;
      slack_[a] = *on_edge;
      continue;
    }
    close_[count++] = a;
    if (set_->rows().place(a) < 0) fresh_[fresh++] = a;
  }
  if (count == 0) return Slacks::kept;
  if (fresh > 0 && !set_->look_at(fresh_, fresh)) return Slacks::doubtful;
  if (!are_independent(close_, count, GramPivoting::near_dependence)) return Slacks::doubtful;
  const bool rises = set_->hold_also(close_, count) && find_way_up(count);
  set_->hold_no_more();
  return rises ? Slacks::kept : Slacks::doubtful;
}

/// Slacks of the rows touched in twice the precision. The number of those that are negative beyond rounding,
/// listed in close_.
Index GramSolve::measure_touched_slacks() {
  alignas(64) double s[8] = {}, rest[8], low[8];
  Index violated = 0;
  for (Index first = 0; first < touched_count_; first += 8) {
    const Index count = std::min<Index>(8, touched_count_ - first);
    for (Index k = 0; k < count; ++k) s[k] = problem_.s[touched_[first + k]];
    set_->rows().copy_rows(touched_ + first, count, pack_);
    kernels_.precise_slacks(n_, pack_, q_, s, rest);
    kernels_.dots(n_, pack_, q_low_, low);
    for (Index k = 0; k < count; ++k) {
      const Index a = touched_[first + k];
      const double sum = rest[k] + low[k], rounding = slack_noise(a);
      if (!(sum >= -rounding)) {
        close_[violated++] = a;
        known_.wrong = std::max(known_.wrong, -sum / row_scale_[a]);
      }
      touched_slack_[first + k] = rest[k];
      slack_[a] = std::abs(sum) <= rounding ? 0 : sum;
    }
  }
  return violated;
}

double GramSolve::slack_noise(Index a) const {
  return zero_of_pairs * (std::abs(problem_.s[a]) + row_scale_[a] * known_.scale) +
         known_.missing_slack(row_scale_[a]);
}

/// The slack of row a, with its sign, where a row held that is parallel to it, not one bit off, holds with
/// equality; none where there is no such row.
std::optional<double> GramSolve::slack_by_parallel_row(Index a) const {
  const double *const U = problem_.U.dense().data(), *const u = U + a * n_;
  const double part = std::abs(u[0]) / row_scale_[a];
  for (Index j = 0; j < set_->size(); ++j) {
    const double* const v = U + rows_[j] * n_;
    if (std::abs(std::abs(v[0]) - part * row_scale_[rows_[j]]) > zero_coefficient * std::abs(v[0])) continue;
    const Index p = std::find_if(v, v + n_, [](double x) { return x != 0; }) - v;
    Index i = 0;
    while (i < n_ && u[i] * v[p] == u[p] * v[i]) ++i;
    if (i < n_ || u[p] == 0) continue;
    const auto cross = [&](double x, double y) {  // v[p] x - u[p] y
      ExactSum sum;
      sum.add_product(v[p], x);
      sum.add_product(-u[p], y);
      return sum;
    };
    for (i = 0; i < n_ && cross(u[i], v[i]).sign() == 0; ++i) continue;
    // u = (u_p / v_p) v, so that v_p (u·q - s_a) = u_p s_v - v_p s_a.
    if (i == n_) return quotient_with_sign(cross(problem_.s[a], problem_.s[rows_[j]]), -v[p]);
  }
  return std::nullopt;
}

/// Whether rows that have been looked at each have more than this part, squared, outside the span of those
/// held.
bool GramSolve::are_independent(const Index* rows, Index count, double part) {
  double distance[8];
  for (Index first = 0; first < count; first += 8) {
    const Index some = std::min<Index>(8, count - first);
    set_->distances(rows + first, some, products_, distance);
    for (Index k = 0; k < some; ++k)
      if (!(distance[k] > part * set_->rows().square(set_->rows().place(rows[first + k])))) return false;
  }
  return true;
}

/// dual_ := A⁻¹u_j of the rows held, by eights side by side.
void GramSolve::find_dual_rows() {
  const Index k = set_->size();
  for (Index first = 0; first < k; first += 8) {
    double* const into = dual_ + first * n_;
    for (Index l = 0; l < 8; ++l) {
      const Index place = first + l < k ? set_->place(first + l) : 0;
      const double* const from = set_->rows().whitened() + place / 8 * 8 * n_ + place % 8;
      for (Index i = 0; i < n_; ++i) into[8 * i + l] = first + l < k ? from[8 * i] : 0;
    }
    kernels_.backward_pack(n_, ld_, A_.T, A_.inverse, into);
  }
}

/// Takes out of the first `count` rows of close_ those that are sums of rows held with short fractions as
/// coefficients, not one bit left over, and ask for no more than they do. The number of those left; -1 when
/// one asks for more.
Index GramSolve::leave_sums_of_rows_held(Index count) {
  const Index k = set_->size();
  if (count == 0 || k == 0) return count;
  find_dual_rows();
  if (!edge_) edge_.emplace(problem_, row_scale_);
  edge_->begin();
  Index left = 0;
  for (Index first = 0; first < count; first += 8) {
    const Index rows = std::min<Index>(8, count - first);
    set_->rows().copy_rows(close_ + first, rows, pack_);
    for (Index j = 0; j < k; j += 8) kernels_.gram(n_, pack_, dual_ + j * n_, products_ + 8 * j, 8);
    set_->solve_pack(products_);
    for (Index l = 0; l < rows; ++l) {
      for (Index j = 0; j < k; ++j) load_[j] = products_[8 * j + l];
      const std::optional<double> on_edge = edge_->slack(close_[first + l], rows_, k, load_);
      if (on_edge && *on_edge < 0) return -1;
      if (on_edge)
        slack_[close_[first + l]] = *on_edge;
      else
        close_[left++] = close_[first + l];
    }
  }
  return left;
}

/// Looks for the motion e that raises the first `count` rows of close_, as far as independent held as well.
/// False when there is none such.
bool GramSolve::find_way_up(Index count) {
  const Index k = set_->size(), blocks = set_->rows().count() / 8;
  for (Index j = 0; j < padded(k); ++j)
    load_[j] = set_->firm() <= j && j < k ? std::sqrt(set_->rows().square(set_->place(j))) : 0;
  set_->solve(load_);
  fill_packs(8 * blocks, 0, y_);
  for (Index j = 0; j < k; ++j) y_[set_->place(j)] = load_[j];
  fill_packs(ld_, 0, dw_);
  kernels_.combine(n_, blocks, set_->rows().whitened(), y_, dw_);
  copy_packs(ld_, dw_, dq_);
  kernels_.backward(n_, ld_, A_.T, A_.inverse, dq_);
  constexpr double zero = 0;
  double t = 0, up = 0, length = 0;  // ||e||_D, D the diagonal of A
  for (Index l = 0; l < count; ++l) {
    kernels_.slacks(1, n_, problem_.U.dense().data() + close_[l] * n_, dq_, &zero, &up);
    if (!(up > least_rise * row_scale_[close_[l]])) return false;
    t = std::max(t, slack_noise(close_[l]) / up);
  }
  for (Index i = 0; i < n_; ++i) length += dq_[i] * dq_[i] / inverse_diagonal_[i];
  length = std::sqrt(length);
  moved_ = t * std::sqrt(kernels_.dot(ld_, dw_, dw_));
  for (Index a = 0; a < m_; ++a)
    if (slack_[a] > 0 && slack_[a] < t * row_scale_[a] * length) return false;
  return true;
}

/// The largest relative violation of the rows touched at q rounded, as in `residuals`, as far as it exceeds
/// what is known; or more, for ||u||_(A⁻¹) is at least the length that is taken here.
double GramSolve::violation_of_touched_rows(double known) const {
  const double part = 1 / std::sqrt(static_cast<double>(n_));
  for (Index k = 0; k < touched_count_; ++k) {
    const Index a = touched_[k];
    const double size = std::abs(problem_.s[a]) + part * row_scale_[a] * acceleration_norm_;
    if (!(-touched_slack_[k] > known * size)) continue;
    known = -touched_slack_[k] / (size > 0 ? size : part * row_scale_[a] * known_.scale);
  }
  return known;
}

}  // namespace convex::inline pivoting
