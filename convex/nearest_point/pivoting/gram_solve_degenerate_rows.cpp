#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "convex/dense/dense_kernels.hpp"
#include "convex/exact/exact_sum.hpp"
#include "convex/nearest_point/pivoting/gram_pivoting.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "convex/nearest_point/pivoting/small_tableau.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// A way up is one for a row that it raises by more than this part of the row's length.
constexpr double least_rise = 1e-3;

}  // namespace

/// Whether q is 0, the point of the working set, and keeps all others, without rounding.
bool GramSolve::is_at_rest() const {
  const Vector& s = problem_.s;
  return std::all_of(p_.q, p_.q + p_.n, [](double x) { return x == 0; }) && !problem_.radii &&
         (dense_kernels().largest_size(p_.all, s.data()) == 0 || s.maxCoeff() <= 0) &&
         std::all_of(p_.rows, p_.rows + p_.size, [&](Index a) { return s[a] == 0; });
}

bool GramSolve::touches_rows() const {
  for (Index a = 0; a < p_.all; ++a)
    if (!(p_.slack[a] > 0)) return true;
  return false;
}

/// Slacks at the refined point. Rows violated have been looked at then, for the next correction to take them
/// in.
GramSolve::Slacks GramSolve::measure_slacks() {
  moved_ = degenerate_violation_ = 0;
  if (known_.wrong == 0 && is_at_rest()) {
    for (Index a = 0; a < p_.all; ++a) p_.slack[a] = 0 - problem_.s[a];
    for (Index k = 0; k < p_.size; ++k) p_.held_slack[k] = 0;
    p_.magnitude = 0;
    return Slacks::kept;
  }
  set_.measure();
  set_held_slacks_apart(p_);
  const double rounding = 2 * static_cast<double>(p_.n) * unit_roundoff,
               by_length = rounding * p_.magnitude + known_.missing_slack(1);
  const Index open = close_rows(rounding, by_length, p_.all);
  const Index degenerate = std::partition(p_.close, p_.close + open,
                                          [&](Index a) {
                                            return !(p_.slack[a] < -(rounding * std::abs(problem_.s[a]) +
                                                                     by_length * p_.row_scale[a]));
                                          }) -
                           p_.close;
  if (degenerate < open) return look_at_violated(degenerate, open);
  if (known_.wrong > 0) return Slacks::violated;
  return degenerate == 0 ? Slacks::kept : decide_degenerate_rows(degenerate);
}

GramSolve::Slacks GramSolve::look_at_violated(Index first, Index end) {
  for (Index a : close(first, end)) known_.wrong = std::max(known_.wrong, -p_.slack[a] / p_.row_scale[a]);
  // Not finite where 0 >= s > 0.
  return std::isfinite(known_.wrong) && set_.look_at(close(first, end)) ? Slacks::violated : Slacks::doubtful;
}

/// Of the rows of the working set and the first `count` that are close (`keeps_rows`). Slacks as measured are
/// without rounding where all numbers lie on grids.
bool GramSolve::keeps_close(Index count) {
  const auto step = GridSum(Eigen::Map<const Vector>(p_.q, p_.n)).step_of_sums(rows_);
  const auto is_exact = [&](Index a) { return is_on_grid(problem_.s[a], *step); };
  if (step && std::all_of(p_.rows, p_.rows + p_.size, is_exact) &&
      std::all_of(p_.close, p_.close + count, is_exact)) {
    for (Index k = 0; k < count; ++k) p_.degenerate_slack[k] = p_.slack[p_.close[k]];
    return std::all_of(p_.held_slack, p_.held_slack + p_.size, [](double slack) { return slack == 0; }) &&
           std::all_of(p_.close, p_.close + count, [&](Index a) {
             const std::vector<Index>& equal = problem_.two_sided;
             return p_.slack[a] == 0 ||
                    (p_.slack[a] > 0 && !std::binary_search(equal.begin(), equal.end(), a));
           });
  }
  return keeps_rows(problem_, Eigen::Map<const Vector>(p_.q, p_.n), {p_.rows, p_.rows + p_.size},
                    close(0, count), p_.degenerate_slack);
}

/// Of the first `count` rows that are close, which the point touches: rounding alone may hide that the exact
/// point p of the working set violates a row outside by 2⁻⁹⁵ or so. Where the doubles q are p and keep all
/// rows without rounding, as at most vertices and at rest, nothing is left to tell; nor for a row that is a
/// sum of rows of the working set, not one bit left over, and asks for no more than they do. Where a motion e
/// along the working set raises all others that p touches, p + t e keeps all rows for a tiny t. Then ||q* -
/// p|| <= t ||e||, q* the solution, since f grows by the square of that: a bound (`moved_`), whatever the
/// angles are at which the rows meet.
GramSolve::Slacks GramSolve::decide_degenerate_rows(Index count) {
  // Of a point that is no vertex the rounding of q may have made a slack of 0: that is told with its last
  // bits.
  const auto is_told = [&](double slack) { return p_.size == p_.n || slack == 0; };
  if (keeps_close(count) && std::all_of(p_.degenerate_slack, p_.degenerate_slack + count, is_told)) {
    for (Index k = 0; k < count; ++k) p_.slack[p_.close[k]] = p_.degenerate_slack[k];
    return Slacks::kept;
  }
  find_violation_of_degenerate_rows(count);
  count = measure_precisely(leave_sums_of_working_set(count));
  if (count < 0) return look_at_violated(0, -count);
  bool asks_more = false;
  count = std::remove_if(p_.close, p_.close + count,
                         [&](Index a) {
                           const std::optional<double> on_edge = slack_by_parallel_row(a);
                           if (!on_edge) return false;
                           asks_more = asks_more || *on_edge < 0;
                           p_.slack[a] = *on_edge;
                           return true;
                         }) -
          p_.close;
  if (asks_more) return Slacks::doubtful;
  if (count == 0) return Slacks::kept;
  return set_.look_at(close(0, count)) &&
                 set_.are_independent(close(0, count), GramPivoting::near_dependence) && find_way_up(count)
             ? Slacks::kept
             : Slacks::doubtful;
}

/// Violated at q rounded, in doubles, by the rows that the point touches.
void GramSolve::find_violation_of_degenerate_rows(Index count) {
  // ||u||_(A⁻¹) is at least this part of ||u||_(D⁻¹).
  const double part = 1 / std::sqrt(static_cast<double>(p_.n));
  for (Index a : close(0, count)) {
    const double size = std::abs(problem_.s[a]) + part * p_.row_scale[a] * p_.acceleration_norm;
    if (p_.slack[a] < 0 && size > 0)
      degenerate_violation_ = std::max(degenerate_violation_, -p_.slack[a] / size);
  }
}

/// Slacks of the first `count` rows that are close, in twice the precision, 0 within their rounding. So many
/// of them as are 0 come first; or, where some are negative, minus their number, and these come first.
Index GramSolve::measure_precisely(Index count) {
  alignas(64) double s[8] = {}, rest[8], low[8];
  for (Index first = 0; first < count; first += 8) {
    const Index some = std::min<Index>(8, count - first);
    const Index* const rows = p_.close + first;
    for (Index k = 0; k < some; ++k) s[k] = problem_.s[rows[k]];
    dense_kernels().side_by_side(p_.n, p_.all, p_.U, rows, some, p_.pack);
    dense_kernels().precise_slacks(p_.n, p_.pack, p_.q, s, rest);
    dense_kernels().dots(p_.n, p_.pack, p_.q_low, low);
    for (Index k = 0; k < some; ++k) {
      const double sum = rest[k] + low[k];
      p_.slack[rows[k]] = std::abs(sum) <= slack_noise(rows[k]) ? 0 : sum;
    }
  }
  Index *const first = p_.close, *const end = first + count;
  const Index violated = std::partition(first, end, [&](Index a) { return !(p_.slack[a] >= 0); }) - first;
  return violated > 0 ? -violated
                      : std::partition(first, end, [&](Index a) { return !(p_.slack[a] > 0); }) - first;
}

double GramSolve::slack_noise(Index a) const {
  return zero_of_pairs * (std::abs(problem_.s[a]) + p_.row_scale[a] * known_.scale) +
         known_.missing_slack(p_.row_scale[a]);
}

/// The slack of row a, with its sign, where a row of the working set that is parallel to it, not one bit off,
/// holds with equality; none where there is no such row.
std::optional<double> GramSolve::slack_by_parallel_row(Index a) const {
  const double *const U = p_.U, *const u = U + a * p_.n;
  const double part = std::abs(u[0]) / p_.row_scale[a];
  for (Index j = 0; j < p_.size; ++j) {
    const double* const v = U + p_.rows[j] * p_.n;
    if (std::abs(std::abs(v[0]) - part * p_.row_scale[p_.rows[j]]) > zero_coefficient * std::abs(v[0]))
      continue;
    const Index p = std::find_if(v, v + p_.n, [](double x) { return x != 0; }) - v;
    Index i = 0;
    while (i < p_.n && u[i] * v[p] == u[p] * v[i]) ++i;
    if (i < p_.n || u[p] == 0) continue;
    const auto cross = [&](double x, double y) {  // v[p] x - u[p] y
      ExactSum sum;
      sum.add_product(v[p], x);
      sum.add_product(-u[p], y);
      return sum;
    };
    for (i = 0; i < p_.n && cross(u[i], v[i]).sign() == 0; ++i) continue;
    // u = (u_p / v_p) v, so that v_p (u·q - s_a) = u_p s_v - v_p s_a.
    if (i == p_.n) return quotient_with_sign(cross(problem_.s[a], problem_.s[p_.rows[j]]), -v[p]);
  }
  return std::nullopt;
}

/// Takes out of the first `count` rows that are close those that are sums of rows of the working set with
/// short fractions as coefficients, not one bit left over, and ask for no more than they do. The number of
/// those left.
Index GramSolve::leave_sums_of_working_set(Index count) {
  if (count == 0 || p_.size == 0) return count;
  if (!edge_) edge_.emplace(problem_, p_.row_scale);
  edge_->begin();
  Index left = 0;
  for (Index first = 0; first < count; first += 8) {
    const Index some = std::min<Index>(8, count - first);
    const std::span<const Index> rows = close(first, first + some);
    dense_kernels().side_by_side(p_.n, p_.all, p_.U, rows.data(), some, p_.pack);
    set_.combine(rows, count);
    std::optional<double> on_edge[8];
    edge_->slacks(rows, p_.pack, p_.rows, p_.size, p_.coefficients, on_edge);
    for (Index l = 0; l < some; ++l) {
      const Index a = p_.close[first + l];
      if (on_edge[l] && *on_edge[l] >= 0)
        p_.slack[a] = *on_edge[l];
      else
        p_.close[left++] = a;
    }
  }
  return left;
}

/// Looks for the motion e that raises the first `count` rows that are close, as far as independent held as
/// well. False when there is none such.
bool GramSolve::find_way_up(Index count) {
  const double norm = set_.raise(close(0, count));
  if (!(norm > 0)) return false;
  constexpr double zero = 0;
  double t = 0, up = 0, length = 0;  // ||e||_D, D the diagonal of A
  // Rounding lets e leave the working set; the motion that brings it back is to leave what it raises raised.
  // A row that depends on those held has no other rise than that.
  double missed = 0;
  for (Index k = 0; k < p_.size; ++k) {
    dense_kernels().slacks(1, p_.n, p_.U + p_.rows[k] * p_.n, p_.dq, &zero, &up);
    missed += up * up;
  }
  const double back = 2 * p_.factor_condition * p_.inverse_norm * std::sqrt(missed);
  for (Index a : close(0, count)) {
    dense_kernels().slacks(1, p_.n, p_.U + a * p_.n, p_.dq, &zero, &up);
    if (!(up > (least_rise + back) * p_.row_scale[a])) return false;
    t = std::max(t, slack_noise(a) / up);
  }
  for (Index i = 0; i < p_.n; ++i) length += p_.dq[i] * p_.dq[i] * p_.diagonal[i];
  length = std::sqrt(length);
  moved_ = t * norm;
  for (Index a = 0; a < p_.all; ++a)
    if (p_.slack[a] > 0 && p_.slack[a] < t * p_.row_scale[a] * length) return false;
  return true;
}

}  // namespace convex::inline pivoting
