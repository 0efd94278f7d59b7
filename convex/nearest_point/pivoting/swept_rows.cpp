#include "convex/nearest_point/pivoting/swept_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "convex/nearest_point/pivoting/gram_pivoting.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// Sweeps add up their rounding: after so many a row, all is swept anew.
constexpr Index sweeps_kept = 16;

/// Where rows are many their lengths are known within a hundredth: so much longer they may be taken for.
constexpr double at_most_longer = 1.01;

}  // namespace

SweptRows::SweptRows(const NearestPointProblem& problem, SmallTableau& tableau)
    : problem_(problem), tableau_(tableau) {
  const DenseFactor factor = problem.A.dense_factor();
  tableau.m = tableau.stride = tableau.size = tableau.steps = 0;
  tableau.factor_condition = problem.A.factor_condition();
  tableau.dependent = -1;
  tableau.n = problem.dimension();
  tableau.all = problem.rows();
  tableau.ld = factor.ld;
  tableau.T = factor.T;
  tableau.inverse = factor.inverse;
  tableau.A = problem.A.dense_gram().data();
  tableau.U = problem.U.dense().data();
  small_kernels().take_diagonal(tableau, problem.A.diagonal().data());
  tableau.row_scale = tableau.scale_at;
  tableau.slack = tableau.slack_at;
  tableau.degenerate_slack = tableau.room.degenerate_slack;
  tableau.close = tableau.room.close;
  if (tableau.all <= SmallTableau::few_rows) return;
  const Index rows = padded(tableau.all);
  tableau.all_rows.start(6 * rows / 8);
  tableau.row_scale = tableau.all_rows.take<double>(rows);
  tableau.slack = tableau.all_rows.take<double>(rows);
  inverse_scale_ = tableau.all_rows.take<double>(rows);
  tableau.degenerate_slack = tableau.all_rows.take<double>(rows);
  tableau.close = tableau.all_rows.take<Index>(rows);
  place_ = tableau.all_rows.take<Index>(rows);
  fill_packs(8, 0, tableau.slack + rows - 8);
  squares_ = small_kernels().rough_lengths(tableau.all, tableau.n, tableau.U, tableau.inverse_diagonal,
                                           at_most_longer, tableau.row_scale, inverse_scale_);
}

void SweptRows::take_linear_term() {
  tableau_.linear = problem_.z.data();
  tableau_.s = problem_.s.data();
}

void SweptRows::begin(const std::vector<Index>& guess) {
  SmallTableau& t = tableau_;
  t.m = 0;
  t.steps = 0;
  if (looks_at_all()) {
    for (t.m = 0; t.m < t.all; ++t.m) {
      t.row[t.m] = t.m;
      t.held[t.m] = t.two_sided[t.m] = false;
    }
    for (Index a : guess) t.held[a] = true;
  } else {
    std::fill_n(place_, t.all, -1);
    const auto begin_with = [&](Index a) {
      if (place(a) >= 0 || t.m == SmallTableau::most_coordinates) return;
      t.held[t.m] = true;
      t.two_sided[t.m] = false;
      t.row[t.m] = a;
      place_[a] = t.m++;
    };
    for (Index a : problem_.two_sided) begin_with(a);
    for (Index a : guess) begin_with(a);
  }
  for (Index a : problem_.two_sided)
    if (place(a) >= 0) t.two_sided[place(a)] = true;
  t.stride = padded(t.m);
  for (Index p = t.m; p < t.stride; ++p) {
    t.row[p] = -1;
    t.held[p] = t.two_sided[p] = false;
  }
  take_linear_term();
}

bool SweptRows::settle(const std::vector<Index>& guess) {
  sweeps_ = 0;
  // Rows too long or many to be measured are left to others.
  if (!looks_at_all() &&
      (problem_.two_sided.size() > SmallTableau::most_coordinates || !std::isfinite(squares_)))
    return false;
  begin(guess);
  return small_kernels().begin(tableau_) && settle_all();
}

bool SweptRows::settle_again() {
  SmallTableau& t = tableau_;
  sweeps_ += t.steps;
  if (sweeps_ > sweeps_kept * t.m) return settle({t.rows, t.rows + t.size});
  take_linear_term();
  t.steps = 0;
  return small_kernels().begin_again(t) && settle_all();
}

bool SweptRows::keep_working_set() {
  SmallTableau& t = tableau_;
  take_linear_term();
  t.steps = 0;
  fill_packs(t.stride, 0, t.leave);
  fill_packs(t.stride, 0, t.enter);
  const bool is_known = small_kernels().begin_again(t) && small_kernels().settle(t);
  for (Index a = 0; a < t.stride; ++a) {
    t.leave[a] = t.held[a] && !t.two_sided[a] ? -t.scale_at[a] : 0;
    t.enter[a] = t.held[a] ? 0 : t.inverse_scale[a];
  }
  return is_known;
}

/// Pivots until no row is violated. False when something is in doubt.
bool SweptRows::settle_all() {
  for (Index round = 0; round <= tableau_.all && small_kernels().settle(tableau_); ++round) {
    if (looks_at_all()) return true;
    Index rows[8];
    const Index count = fresh_violated_rows(rows);
    if (count == 0) return true;
    if (!take_in(rows, count)) return false;
  }
  return false;
}

/// Up to eight rows, not looked at yet, that the point violates, those that lie deep below their edge.
Index SweptRows::fresh_violated_rows(Index* rows) {
  SmallTableau& t = tableau_;
  alignas(64) double depth[8], row[8];
  small_kernels().deepest(t.all, t.n, t.U, t.q, problem_.s.data(), inverse_scale_, t.slack, depth, row);
  const double least = GramPivoting::least_violation * (t.z_norm + t.acceleration_norm);
  Index count = 0;
  for (int k = 0; k < 8; ++k)
    if (const Index a = static_cast<Index>(row[k]); depth[k] < -least && place(a) < 0) rows[count++] = a;
  return count;
}

/// Looks at more rows. Where there is no room for them those outside are forgotten. False when there is none
/// then.
bool SweptRows::take_in(const Index* rows, Index count) {
  SmallTableau& t = tableau_;
  constexpr Index most = SmallTableau::most;
  if (t.stride + padded(count) > most) {
    const std::vector<Index> held(t.rows, t.rows + t.size);
    const Index steps = t.steps;
    begin(held);
    t.steps = steps;
    if (!small_kernels().begin(t)) return false;
    if (t.stride + padded(count) > most) return false;
  }
  for (Index first = 0; first < count; first += 8) {
    const Index at = t.stride;
    for (Index k = 0; k < 8; ++k) {
      const bool is_row = first + k < count;
      t.row[at + k] = is_row ? rows[first + k] : -1;
      t.held[at + k] = false;
      if (is_row) place_[rows[first + k]] = at + k;
    }
    t.m = at + std::min<Index>(8, count - first);
    small_kernels().append(t);
  }
  return true;
}

std::optional<Vector> SweptRows::contradiction() const {
  const SmallTableau& t = tableau_;
  if (t.dependent < 0) return std::nullopt;
  alignas(64) double coefficients[SmallTableau::most];
  small_kernels().find_column(t, t.dependent, coefficients);
  Vector weights = Vector::Zero(t.all);
  weights[t.row[t.dependent]] = 1;
  for (Index a = 0; a < t.m; ++a) {
    const double part = coefficients[a] * t.scale_at[a] * t.inverse_scale[t.dependent];
    if (!t.held[a] || std::abs(part) <= zero_coefficient) continue;
    if (part > 0 && !t.two_sided[a]) return std::nullopt;
    weights[t.row[a]] = -coefficients[a];
  }
  return weights;
}

std::vector<Index> SweptRows::one_sided_working_set() const {
  std::vector<Index> rows;
  for (Index a = 0; a < tableau_.m; ++a)
    if (tableau_.held[a] && !tableau_.two_sided[a]) rows.push_back(tableau_.row[a]);
  return rows;
}

bool SweptRows::is_near(double size) {
  SmallTableau& t = tableau_;
  if (!looks_at_all()) return true;  // their slacks have just been found
  if (small_kernels().margin(t) > size) return false;
  for (Index a = 0; a < t.m; ++a) t.slack[a] = -t.b[a];
  return true;
}

/// Weak are multipliers (times lengths) and slacks (over them) that are `small`.
void SweptRows::mark_weak(double small) {
  SmallTableau& t = tableau_;
  t.any_weak = false;
  zeroed_ = 0;
  if (!(small > 0)) return;
  t.any_weak = true;
  for (Index p = 0; p < t.m; ++p) {
    const double length = std::sqrt(t.square[p]);
    t.is_weak[p] = t.row[p] >= 0 && !t.two_sided[p] &&
                   !(t.held[p] ? t.lambda_at[p] * length > small : t.slack[t.row[p]] > t.scale_at[p] * small);
    if (!t.is_weak[p] || !t.held[p]) continue;
    zeroed_ += std::abs(t.lambda_at[p]) * length;
    t.lambda_at[p] = t.lambda_low_at[p] = 0;
  }
  for (Index k = 0; k < t.size; ++k) {
    t.lambda[k] = t.lambda_at[t.place[k]];
    t.lambda_low[k] = t.lambda_low_at[t.place[k]];
  }
}

bool SweptRows::correct(bool is_first, double small) {
  SmallTableau& t = tableau_;
  mark_weak(small);
  t.is_first = is_first;
  const Index steps = t.steps;
  if (!small_kernels().correct(t)) return false;
  t.step += zeroed_;
  t.is_fresh = is_first || small > 0 || t.steps > steps;
  // An inverse loses as much again as a factor: where it is small, it is the difference of large entries.
  t.growth = std::max(t.gram_condition, t.sweep_growth);
  return true;
}

void SweptRows::measure() {
  small_kernels().measure(tableau_);
  if (!looks_at_all()) measure_slacks_of_all();
}

void SweptRows::measure_slacks_of_all() {
  const SmallTableau& t = tableau_;
  dense_kernels().slacks(t.all, t.n, t.U, t.q, problem_.s.data(), t.slack);
}

void SweptRows::measure_balance() { small_kernels().measure_balance(tableau_); }

bool SweptRows::look_at(std::span<const Index> rows) {
  Index fresh[SmallTableau::most], count = 0;
  for (Index a : rows)
    if (place(a) < 0 && count++ < SmallTableau::most) fresh[count - 1] = a;
  return count == 0 || (tableau_.stride + padded(count) <= SmallTableau::most && take_in(fresh, count));
}

bool SweptRows::are_independent(std::span<const Index> rows, double part) {
  const SmallTableau& t = tableau_;
  return std::all_of(rows.begin(), rows.end(),
                     [&](Index a) { return t.swept_diagonal[place(a)] > part * t.square[place(a)]; });
}

/// Swept, the column of a row looked at has its coefficients.
void SweptRows::combine(std::span<const Index> rows, Index) {
  const SmallTableau& t = tableau_;
  if (std::any_of(rows.begin(), rows.end(), [&](Index a) { return place(a) < 0; })) {
    find_dual_rows();
    for (Index k = 0; k < t.size; k += 8)
      dense_kernels().gram(t.n, t.pack, dual_ + k * t.n, t.coefficients + 8 * k, 8);
    return;
  }
  for (std::size_t l = 0; l < rows.size(); ++l) {
    alignas(64) double column[SmallTableau::most];
    small_kernels().find_column(t, place(rows[l]), column);
    for (Index k = 0; k < t.size; ++k) t.coefficients[8 * k + static_cast<Index>(l)] = column[t.place[k]];
  }
}

void SweptRows::find_dual_rows() {
  const SmallTableau& t = tableau_;
  if (dual_count_ == t.size && std::equal(t.rows, t.rows + t.size, dual_of_)) return;
  std::copy_n(t.rows, dual_count_ = t.size, dual_of_);
  small_kernels().dual_rows(t, dual_);
}

}  // namespace convex::inline pivoting
