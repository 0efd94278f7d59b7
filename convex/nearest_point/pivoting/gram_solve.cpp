#include "convex/nearest_point/pivoting/gram_solve.hpp"

#include <algorithm>
#include <cmath>

#include "convex/invariant.hpp"
#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/optimality/held_residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
GramSolve::GramSolve(const NearestPointProblem& problem, Arena& arena)
    : problem_(problem),
      kernels_(dense_kernels()),
      A_(problem.A.dense_factor()),
      n_(problem.dimension()),
      m_(problem.rows()),
      ld_(A_.ld) {
  const Index k = std::min(n_, m_), places = m_ + 136;  // no fewer than `set_` has
  arena.start((10 * ld_ + 6 * padded(m_) + 8 * n_ + 8 + (n_ + 15) * padded(k) + 5 * padded(places)) / 8 +
              GramPivoting::lines(n_, m_));
  for (double** x : {&z_, &w_free_, &w_, &q_, &q_low_, &r_, &dw_, &dq_, &inverse_diagonal_, &unit_})
    *x = arena.take_filled(n_, 0.0);
  for (double** x : {&row_scale_, &slack_, &touched_slack_}) *x = arena.take<double>(m_);
  for (double** x : {&load_, &lambda_, &lambda_low_, &change_, &length_, &pull_}) *x = arena.take<double>(k);
  for (double** x : {&y_, &held_slack_, &total_, &total_low_, &rest_}) *x = arena.take_filled(places, 0.0);
  for (Index** x : {&touched_, &close_, &fresh_}) *x = arena.take<Index>(m_);
  rows_ = arena.take<Index>(k);
  pack_ = arena.take<double>(8 * n_ + 8);  // two vectors at least
  dual_ = arena.take<double>(n_ * padded(k));
  products_ = arena.take<double>(8 * padded(k));
  const double* diagonal = problem_.A.diagonal().data();
  for (Index i = 0; i < n_; ++i) {
    inverse_diagonal_[i] = 1 / diagonal[i];
    unit_[i] = std::sqrt(inverse_diagonal_[i]);
  }
  kernels_.squares(m_, n_, problem_.U.dense().data(), inverse_diagonal_, row_scale_);
  for (Index a = 0; a < m_; ++a) row_scale_[a] = std::sqrt(row_scale_[a]);
  set_.emplace(problem, arena, w_free_, row_scale_);
}

void GramSolve::whiten_z() {
  for (Index i = 0; i < n_; ++i) z_[i] = problem_.z[i];
  copy_packs(ld_, z_, w_free_);
  kernels_.forward(n_, ld_, A_.T, A_.inverse, w_free_);
  known_.scale = z_norm_ = std::sqrt(kernels_.dot(ld_, w_free_, w_free_));
}

bool GramSolve::solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution) {
  whiten_z();
  return set_->settle(guess) && finish_settled(true, accuracy, solution);
}

bool GramSolve::solve_again(const Accuracy& accuracy, Solution& solution) {
  whiten_z();
  const Index size = set_->size();
  return set_->settle_again() &&
         finish_settled(set_->steps() > 0 || set_->size() != size, accuracy, solution);
}

bool GramSolve::finish_settled(bool has_changed, const Accuracy& accuracy, Solution& solution) {
  take_point(has_changed);
  return (!accuracy.refine && answer_of_doubles(accuracy, solution)) || finish(*this, accuracy, solution);
}

bool GramSolve::write(const Accuracy& accuracy, Solution& solution) {
  if (std::all_of(q_, q_ + n_, [](double x) { return x == 0; })) acceleration_norm_ = 0;
  const double enough_for_all = accuracy.tolerance * std::max(1.0, acceleration_norm_);
  if (!(known_.bound <= enough_for_all) && is_exact_vertex()) known_.bound = 0;
  write_point(solution);
  solution.residuals = residuals_of_active();
  solution.error_bound = known_.bound + moved_;
  solution.status = solution.error_bound <= enough_for_all ? Status::solved : Status::inaccurate;
  return true;
}

/// Whether as many rows are held as there are coordinates, by the doubles q, without rounding: whatever the
/// multipliers are, so far as their signs are told, the point is that one.
bool GramSolve::is_exact_vertex() const {
  return set_->size() == n_ && !problem_.radii &&
         keeps_rows(problem_, Eigen::Map<const Vector>(q_, n_), {rows_, rows_ + n_}, {}, nullptr);
}

/// q and lambda of the rows held, in doubles.
void GramSolve::take_point(bool has_changed) {
  set_->point(w_, q_);
  fill_packs(ld_, 0, q_low_);
  copy_packs(set_->rows().count(), set_->lambda(), total_);
  fill_packs(set_->rows().count(), 0, total_low_);
  list_rows_held(has_changed);
  acceleration_norm_ = std::sqrt(kernels_.dot(ld_, w_, w_));
  known_.scale = std::max(acceleration_norm_, z_norm_);
}

void GramSolve::list_rows_held(bool have_changed) {
  for (Index j = 0; j < set_->size(); ++j) {
    rows_[j] = set_->row(j);
    lambda_[j] = total_[set_->place(j)];
    lambda_low_[j] = total_low_[set_->place(j)];
    length_[j] = std::sqrt(set_->rows().square(set_->place(j)));
    pull_[j] = set_->is_two_sided(rows_[j]) ? 0 : length_[j];
  }
  if (!have_changed) return;
  inverse_norm_ = set_->inverse_norm();
  gram_condition_ = set_->condition(load_);
}

/// The answer as doubles give it. False when a row is close to tipping over, or the bound by what is missing
/// of the equations does not do.
bool GramSolve::answer_of_doubles(const Accuracy& accuracy, Solution& solution) {
  fill_packs(ld_, 0, q_low_);
  known_.remaining = known_.rounding = known_.silenced = 0;
  for (Index j = 0; j < set_->size(); ++j)
    if (!set_->is_two_sided(rows_[j]) &&
        !(lambda_[j] * std::sqrt(set_->rows().square(set_->place(j))) > near_zero * known_.scale))
      return false;
  if (measure_slacks() != Slacks::kept || touched_count_ > 0) return false;
  for (Index a = 0; a < m_; ++a)
    if (!set_->holds(a) && !(slack_[a] > near_zero * (std::abs(problem_.s[a]) +
                                                      row_scale_[a] * std::max(magnitude_, known_.scale))))
      return false;
  const double condition = problem_.A.factor_condition() * (1 + std::sqrt(gram_condition_));
  double missing = 0;
  for (Index j = 0; j < set_->size(); ++j)
    missing += held_slack_[set_->place(j)] * held_slack_[set_->place(j)];
  solution.residuals = residuals_of_active();
  known_.bound =
      bound_of_doubles(n_, set_->size(), solution.residuals.stationarity * known_.scale,
                       inverse_norm_ * std::sqrt(missing), condition * (known_.scale + magnitude_));
  write_point(solution);
  solution.status = Status::solved;
  return known_.bound <= accuracy.tolerance * std::max(1.0, acceleration_norm_);
}

bool GramSolve::touches_rows() const {
  return std::any_of(touched_, touched_ + touched_count_, [&](Index a) { return !(slack_[a] > 0); });
}

void GramSolve::write_point(Solution& solution) const {
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
  solution.force_norm = z_norm_;
  solution.rounding = known_.rounding;
  solution.error_bound = known_.bound;
}

/// `residuals`, to which only the rows held and touched matter; measured in doubles.
Residuals GramSolve::residuals_of_active() {
  kernels_.residual(n_, problem_.A.dense_gram().data(), q_, m_, problem_.U.dense().data(), set_->size(),
                    rows_, lambda_, z_, r_);
  kernels_.forward(n_, ld_, A_.T, A_.inverse, r_);
  const double stationarity = std::sqrt(kernels_.dot(ld_, r_, r_));
  double most = 0;
  for (Index j = 0; j < set_->size(); ++j) most = std::max(most, std::abs(lambda_[j]));
  HeldResiduals held(stationarity, acceleration_norm_, known_.scale, most);
  for (Index j = 0; j < set_->size(); ++j)
    held.add(problem_.s[rows_[j]], std::sqrt(set_->rows().square(set_->place(j))), lambda_[j],
             held_slack_[set_->place(j)], set_->is_two_sided(rows_[j]));
  Residuals found = held.all();
  found.feasibility = violation_of_touched_rows(found.feasibility);
  return found;
}

}  // namespace convex::inline pivoting
