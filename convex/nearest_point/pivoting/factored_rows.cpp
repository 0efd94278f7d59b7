#include "convex/nearest_point/pivoting/factored_rows.hpp"

#include <algorithm>
#include <cmath>

#include "convex/double_double.hpp"
#include "convex/invariant.hpp"

namespace convex::inline pivoting {

FactoredRows::FactoredRows(const NearestPointProblem& problem, Arena& arena)
    : problem_(problem), kernels_(dense_kernels()), A_(problem.A.dense_factor()) {
  const Index n = problem.dimension(), m = problem.rows(), ld = A_.ld;
  const Index k = std::min(n, m), places = m + 136;  // no fewer than `set_` has
  p_.n = n;
  p_.all = m;
  p_.ld = ld;
  p_.T = A_.T;
  p_.inverse = A_.inverse;
  p_.A = problem.A.dense_gram().data();
  p_.U = problem.U.dense().data();
  p_.factor_condition = problem.A.factor_condition();
  arena.start((10 * ld + 5 * padded(m) + 8 * n + (n + 18) * padded(k) + 4 * padded(places)) / 8 +
              GramPivoting::lines(n, m));
  for (double** x : {&p_.z, &p_.w_free, &p_.w, &p_.q, &p_.q_low, &p_.r, &p_.dq, &p_.diagonal,
                     &p_.inverse_diagonal, &p_.unit})
    *x = arena.take_filled(n, 0.0);
  for (double** x : {&p_.row_scale, &p_.slack, &p_.degenerate_slack}) *x = arena.take<double>(m);
  for (double** x : {&p_.lambda, &p_.lambda_low, &p_.change, &p_.length, &p_.pull, &p_.held_slack, &load_})
    *x = arena.take<double>(k);
  for (double** x : {&p_.lambda_at, &p_.lambda_low_at, &y_, &rest_}) *x = arena.take_filled(places, 0.0);
  for (Index** x : {&p_.close, &fresh_}) *x = arena.take<Index>(m);
  for (Index** x : {&p_.rows, &p_.place, &dual_of_}) *x = arena.take<Index>(k);
  p_.pack = arena.take<double>(8 * n);
  p_.coefficients = arena.take<double>(8 * padded(k));
  dual_ = arena.take<double>(n * padded(k));
  const double* diagonal = problem_.A.diagonal().data();
  for (Index i = 0; i < n; ++i) {
    p_.diagonal[i] = diagonal[i];
    p_.inverse_diagonal[i] = 1 / diagonal[i];
    p_.unit[i] = std::sqrt(p_.inverse_diagonal[i]);
  }
  kernels_.squares(m, n, p_.U, p_.inverse_diagonal, p_.row_scale);
  for (Index a = 0; a < m; ++a) p_.row_scale[a] = std::sqrt(p_.row_scale[a]);
  set_.emplace(problem, arena, p_.w_free, p_.row_scale);
}

void FactoredRows::whiten_z() {
  for (Index i = 0; i < p_.n; ++i) p_.z[i] = problem_.z[i];
  copy_packs(p_.ld, p_.z, p_.w_free);
  kernels_.forward(p_.n, p_.ld, A_.T, A_.inverse, p_.w_free);
  p_.z_norm = std::sqrt(kernels_.dot(p_.ld, p_.w_free, p_.w_free));
}

bool FactoredRows::settle(const std::vector<Index>& guess) {
  whiten_z();
  const bool settled = set_->settle(guess);
  p_.steps = set_->steps();
  if (settled) take_point(true);
  return settled;
}

bool FactoredRows::settle_again() {
  whiten_z();
  const Index size = set_->size();
  const bool settled = set_->settle_again();
  p_.steps = set_->steps();
  if (settled) take_point(p_.steps > 0 || set_->size() != size);
  return settled;
}

bool FactoredRows::keep_working_set() {
  whiten_z();
  if (!set_->keep_working_set()) return false;
  p_.steps = 0;
  take_point(false);
  return true;
}

/// q and lambda of the working set, in doubles.
void FactoredRows::take_point(bool has_changed) {
  set_->point(p_.w, p_.q);
  fill_packs(p_.ld, 0, p_.q_low);
  copy_packs(set_->rows().count(), set_->lambda(), p_.lambda_at);
  fill_packs(set_->rows().count(), 0, p_.lambda_low_at);
  list_working_set(has_changed);
  p_.acceleration_norm = std::sqrt(kernels_.dot(p_.ld, p_.w, p_.w));
}

void FactoredRows::list_working_set(bool have_changed) {
  p_.size = set_->size();
  for (Index j = 0; j < p_.size; ++j) {
    const Index place = p_.place[j] = set_->place(j);
    p_.rows[j] = set_->row(j);
    p_.lambda[j] = p_.lambda_at[place];
    p_.lambda_low[j] = p_.lambda_low_at[place];
    p_.length[j] = std::sqrt(set_->rows().square(place));
    p_.pull[j] = set_->is_two_sided(p_.rows[j]) ? 0 : p_.length[j];
  }
  if (!have_changed) return;
  p_.inverse_norm = set_->inverse_norm();
  p_.gram_condition = set_->condition(load_);
}

bool FactoredRows::is_near(double) {
  std::copy_n(set_->slacks(), p_.all, p_.slack);
  return true;
}

bool FactoredRows::correct(bool is_first, double small) {
  const Index before = set_->rows().count();
  const double zeroed = small > 0 ? take_weak_for_zero(small) : 0;
  find_residual(is_first);
  copy_packs(p_.ld, p_.r, p_.dq);
  kernels_.forward(p_.n, p_.ld, A_.T, A_.inverse, p_.dq);
  rest_loads(is_first, small > 0);
  const Index steps = set_->steps();
  if (!set_->settle_rest(rest_, std::sqrt(kernels_.dot(p_.ld, p_.dq, p_.dq)))) return false;
  const bool has_changed = set_->steps() > steps || set_->size() != p_.size;
  invariant(before == set_->rows().count(), "no row is looked at by a correction");
  copy_packs(before, set_->lambda(), y_);
  kernels_.combine(p_.n, before / 8, set_->rows().whitened(), y_, p_.dq);
  kernels_.add_multiple(p_.ld, 1, p_.dq, p_.w);
  for (Index p = 0; p < before; ++p) {
    const DoubleDouble sum = two_sum(p_.lambda_at[p], p_.lambda_low_at[p] + y_[p]);
    p_.lambda_at[p] = sum.hi;
    p_.lambda_low_at[p] = sum.lo;
  }
  list_working_set(has_changed);
  for (Index j = 0; j < p_.size; ++j) p_.change[j] = y_[p_.place[j]];
  p_.acceleration_norm = std::sqrt(kernels_.dot(p_.ld, p_.w, p_.w));
  p_.step = std::sqrt(kernels_.dot(p_.ld, p_.dq, p_.dq)) + zeroed;
  p_.is_fresh = is_first || has_changed || small > 0;
  p_.steps = set_->steps();
  kernels_.backward(p_.n, p_.ld, A_.T, A_.inverse, p_.dq);
  for (Index i = 0; i < p_.n; ++i) {
    const DoubleDouble sum = two_sum(p_.q[i], p_.q_low[i] + p_.dq[i]);
    p_.q[i] = sum.hi;
    p_.q_low[i] = sum.lo;
  }
  return true;
}

/// The multipliers of weak rows, times their lengths; they count as 0 then.
double FactoredRows::take_weak_for_zero(double small) {
  set_->clear_rows(small, p_.lambda_at, p_.slack);
  double zeroed = 0;
  for (Index j = 0; j < p_.size; ++j)
    if (set_->is_weak(p_.rows[j])) {
      zeroed += std::abs(p_.lambda[j]) * p_.length[j];
      p_.lambda[j] = p_.lambda_at[p_.place[j]] = p_.lambda_low_at[p_.place[j]] = 0;
    }
  return zeroed;
}

void FactoredRows::find_residual(bool is_first) {
  kernels_.stationarity(p_.n, p_.A, p_.q, p_.all, p_.U, p_.size, p_.rows, p_.lambda, p_.z, p_.r);
  if (is_first) return;
  copy_packs(p_.ld, p_.r, p_.dq);
  kernels_.residual(p_.n, p_.A, p_.q_low, p_.all, p_.U, p_.size, p_.rows, p_.lambda_low, p_.dq, p_.r);
}

/// rest_ := s_a - u_a·q - v_a·dw of the working set, or of all that matter, at their places; dw is in dq.
void FactoredRows::rest_loads(bool is_first, bool with_outside) {
  alignas(64) double dots[8], low[8];
  const GramRows& rows = set_->rows();
  for (Index first = 0; first < rows.count(); first += 8) {
    bool any = false;
    for (Index p = first; p < first + 8; ++p)
      if (const Index a = rows.row(p); a >= 0)
        any = any || (with_outside ? set_->matters(a) : set_->holds(a));
    if (!any) {
      fill_packs(8, 0, rest_ + first);
      continue;
    }
    kernels_.precise_slacks(p_.n, rows.raw() + first * p_.n, p_.q, rows.s() + first, rest_ + first);
    kernels_.dots(p_.n, rows.whitened() + first * p_.n, p_.dq, dots);
    if (!is_first) kernels_.dots(p_.n, rows.raw() + first * p_.n, p_.q_low, low);
    for (Index k = 0; k < 8; ++k) rest_[first + k] = -rest_[first + k] - (is_first ? 0 : low[k]) - dots[k];
  }
}

void FactoredRows::measure() {
  kernels_.slacks(p_.all, p_.n, p_.U, p_.q, problem_.s.data(), p_.slack);
  p_.magnitude = 0;
  for (Index i = 0; i < p_.n; ++i) p_.magnitude += p_.q[i] * p_.q[i] * p_.diagonal[i];
  p_.magnitude = std::sqrt(p_.magnitude);
}

void FactoredRows::measure_balance() {
  kernels_.residual(p_.n, p_.A, p_.q, p_.all, p_.U, p_.size, p_.rows, p_.lambda, p_.z, p_.r);
  kernels_.forward(p_.n, p_.ld, A_.T, A_.inverse, p_.r);
  p_.stationarity = std::sqrt(kernels_.dot(p_.ld, p_.r, p_.r));
}

bool FactoredRows::look_at(std::span<const Index> rows) {
  Index fresh = 0;
  for (Index a : rows)
    if (set_->rows().place(a) < 0) fresh_[fresh++] = a;
  return fresh == 0 || set_->look_at(fresh_, fresh);
}

bool FactoredRows::are_independent(std::span<const Index> rows, double part) {
  double distance[8];
  for (; !rows.empty(); rows = rows.subspan(std::min<std::size_t>(8, rows.size()))) {
    const Index some = std::min<Index>(8, std::ssize(rows));
    set_->distances(rows.data(), some, p_.coefficients, distance);
    for (Index k = 0; k < some; ++k)
      if (!(distance[k] > part * set_->rows().square(set_->rows().place(rows[static_cast<std::size_t>(k)]))))
        return false;
  }
  return true;
}

/// dual_ := A⁻¹u_j of the rows of the working set, by eights side by side.
void FactoredRows::find_dual_rows() {
  const Index k = p_.size, n = p_.n;
  if (dual_count_ == k && std::equal(dual_of_, dual_of_ + k, p_.rows)) return;
  std::copy_n(p_.rows, dual_count_ = k, dual_of_);
  are_solved_ = false;
  for (Index first = 0; first < k; first += 8) {
    double* const into = dual_ + first * n;
    for (Index l = 0; l < 8; ++l) {
      const Index place = first + l < k ? p_.place[first + l] : 0;
      const double* const from = set_->rows().whitened() + place / 8 * 8 * n + place % 8;
      for (Index i = 0; i < n; ++i) into[8 * i + l] = first + l < k ? from[8 * i] : 0;
    }
    kernels_.backward_pack(n, p_.ld, A_.T, A_.inverse, into);
  }
}

/// dual_ := (VᵀV)⁻¹ of these: what gives the coefficients of a row by products alone.
void FactoredRows::solve_dual_rows() {
  const Index k = p_.size, n = p_.n;
  double* const X = p_.coefficients;  // of eight coordinates at a time
  const auto each = [&](Index first, auto work) {
    const Index columns = std::min<Index>(8, n - first);
    for (Index j = 0; j < k; j += 8)
      for (Index c = 0; c < columns; ++c)
        for (Index l = 0; l < 8; ++l) work(X[8 * (j + l) + c], dual_[j * n + 8 * (first + c) + l]);
  };
  for (Index first = 0; first < n; first += 8) {
    fill_packs(8 * padded(k), 0, X);
    each(first, [](double& x, const double& dual) { x = dual; });
    set_->solve_pack(X);
    each(first, [](const double& x, double& dual) { dual = x; });
  }
  are_solved_ = true;
}

void FactoredRows::combine(std::span<const Index>, Index in_all) {
  find_dual_rows();
  if (!are_solved_ && in_all > p_.n) solve_dual_rows();
  for (Index j = 0; j < p_.size; j += 8)
    kernels_.gram(p_.n, p_.pack, dual_ + j * p_.n, p_.coefficients + 8 * j, 8);
  if (!are_solved_) set_->solve_pack(p_.coefficients);
}

double FactoredRows::raise(std::span<const Index> rows) {
  double norm = 0;
  if (set_->hold_also(rows.data(), std::ssize(rows))) {
    const Index k = set_->size(), blocks = set_->rows().count() / 8;
    for (Index j = 0; j < padded(k); ++j)
      load_[j] = set_->firm() <= j && j < k ? std::sqrt(set_->rows().square(set_->place(j))) : 0;
    set_->solve(load_);
    fill_packs(8 * blocks, 0, y_);
    for (Index j = 0; j < k; ++j) y_[set_->place(j)] = load_[j];
    fill_packs(p_.ld, 0, p_.dq);
    kernels_.combine(p_.n, blocks, set_->rows().whitened(), y_, p_.dq);
    norm = std::sqrt(kernels_.dot(p_.ld, p_.dq, p_.dq));
    kernels_.backward(p_.n, p_.ld, A_.T, A_.inverse, p_.dq);
  }
  set_->hold_no_more();
  return norm;
}

}  // namespace convex::inline pivoting
