#include "convex/nearest_point/pivoting/small_gram_solve.hpp"

#include <cmath>

#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/optimality/held_residuals.hpp"
#include "convex/nearest_point/pivoting/gram_pivoting.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// Sweeps add up their rounding: after so many a row, all is swept anew.
constexpr Index sweeps_kept = 16;

/// Where rows are many their lengths are known within a hundredth: so much longer they may be taken for.
constexpr double at_most_longer = 1.01;

}  // namespace

SmallGramSolve::SmallGramSolve(const NearestPointProblem& problem, SmallTableau& tableau)
    : problem_(problem),
      tableau_(tableau),
      row_scale_(tableau.row_scale),
      slack_(tableau.slack),
      touched_slack_(tableau.touched_slack),
      close_(tableau.close) {
  const DenseFactor factor = problem.A.dense_factor();
  tableau.m = tableau.stride = tableau.size = tableau.steps = 0;
  tableau.dependent = -1;
  tableau.n = problem.dimension();
  tableau.all = problem.rows();
  tableau.ld = factor.ld;
  tableau.T = factor.T;
  tableau.inverse = factor.inverse;
  tableau.A = problem.A.dense_gram().data();
  tableau.U = problem.U.dense().data();
  fill_packs(tableau.ld, 0, tableau.diagonal);
  fill_packs(tableau.ld, 0, tableau.inverse_diagonal);
  const auto diagonal = problem.A.diagonal().array();
  Eigen::Map<Eigen::ArrayXd>(tableau.diagonal, tableau.n) = diagonal;
  Eigen::Map<Eigen::ArrayXd>(tableau.inverse_diagonal, tableau.n) = diagonal.inverse();
  Eigen::Map<Eigen::ArrayXd>(tableau.unit, tableau.n) = diagonal.sqrt().inverse();
  if (tableau.all <= SmallTableau::few_rows) return;
  const Index rows = padded(tableau.all);
  tableau.all_rows.start(6 * rows / 8);
  row_scale_ = tableau.all_rows.take<double>(rows);
  slack_ = tableau.all_rows.take<double>(rows);
  inverse_scale_ = tableau.all_rows.take<double>(rows);
  touched_slack_ = tableau.all_rows.take<double>(rows);
  close_ = tableau.all_rows.take<Index>(rows);
  place_ = tableau.all_rows.take<Index>(rows);
  fill_packs(8, 0, row_scale_ + rows - 8);
  fill_packs(8, 0, slack_ + rows - 8);
  dense_kernels().squares(tableau.all, tableau.n, tableau.U, tableau.inverse_diagonal, row_scale_);
  small_kernels().rough_inverse_roots(tableau.all, row_scale_, inverse_scale_);
  for (Index a = 0; a < rows; ++a) row_scale_[a] *= at_most_longer * inverse_scale_[a];
}

void SmallGramSolve::take_linear_term() {
  std::copy_n(problem_.z.data(), tableau_.n, tableau_.z);
  std::fill(tableau_.z + tableau_.n, tableau_.z + tableau_.ld, 0);
  if (looks_at_all()) {
    std::copy_n(problem_.s.data(), tableau_.m, tableau_.level);
    std::fill(tableau_.level + tableau_.m, tableau_.level + tableau_.stride, 0);
    return;
  }
  for (Index p = 0; p < tableau_.stride; ++p)
    tableau_.level[p] = tableau_.row[p] < 0 ? 0 : problem_.s[tableau_.row[p]];
}

void SmallGramSolve::begin(const std::vector<Index>& guess) {
  SmallTableau& t = tableau_;
  t.m = 0;
  t.steps = 0;
  for (bool& two_sided : t.two_sided) two_sided = false;
  if (looks_at_all()) {
    for (t.m = 0; t.m < t.all; ++t.m) {
      t.row[t.m] = t.m;
      t.held[t.m] = false;
    }
    for (Index a : guess) t.held[a] = true;
  } else {
    std::fill_n(place_, t.all, -1);
    const auto begin_with = [&](Index a) {
      if (place(a) >= 0 || t.m == SmallTableau::most_coordinates) return;
      t.held[t.m] = true;
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
    t.held[p] = false;
  }
  take_linear_term();
}

bool SmallGramSolve::solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution) {
  sweeps_ = 0;
  // Rows too long or many to be measured are left to others.
  if (!looks_at_all() && (problem_.two_sided.size() > SmallTableau::most_coordinates ||
                          !std::isfinite(dense_kernels().dot(padded(tableau_.all), row_scale_, row_scale_))))
    return false;
  begin(guess);
  return small_kernels().begin(tableau_) && settle() && answer(accuracy, solution);
}

bool SmallGramSolve::solve_again(const Accuracy& accuracy, Solution& solution) {
  if (sweeps_ > sweeps_kept * tableau_.m) return solve(solution.basis, accuracy, solution);
  take_linear_term();
  tableau_.steps = 0;
  if (!small_kernels().begin_again(tableau_) || !settle() || !answer(accuracy, solution)) return false;
  sweeps_ += tableau_.steps;
  follow_working_set();
  return true;
}

/// Pivots until no row is violated. False when something is in doubt.
bool SmallGramSolve::settle() {
  for (Index round = 0; round <= tableau_.all && small_kernels().settle(tableau_); ++round) {
    if (looks_at_all()) return true;
    Index rows[8];
    const Index count = fresh_violated_rows(rows);
    if (count == 0) return true;
    if (!look_at(rows, count)) return false;
  }
  return false;
}

/// Up to eight rows, not looked at yet, that the point violates, those that lie deep below their edge.
Index SmallGramSolve::fresh_violated_rows(Index* rows) {
  SmallTableau& t = tableau_;
  dense_kernels().slacks(t.all, t.n, t.U, t.q, problem_.s.data(), slack_);
  alignas(64) double depth[8], row[8];
  small_kernels().deepest(t.all, slack_, inverse_scale_, depth, row);
  const double least = GramPivoting::least_violation * (t.z_norm + t.acceleration_norm);
  Index count = 0;
  for (int k = 0; k < 8; ++k)
    if (const Index a = static_cast<Index>(row[k]); depth[k] < -least && place(a) < 0) rows[count++] = a;
  return count;
}

/// Looks at more rows. Where there is no room for them those outside are forgotten. False when there is none
/// then.
bool SmallGramSolve::look_at(const Index* rows, Index count) {
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
      t.level[at + k] = is_row ? problem_.s[rows[first + k]] : 0;
      t.slack[at + k] = is_row ? slack_[rows[first + k]] : 0;
      t.held[at + k] = false;
      if (is_row) place_[rows[first + k]] = at + k;
    }
    t.m = at + std::min<Index>(8, count - first);
    small_kernels().append(t);
  }
  return true;
}

std::optional<Vector> SmallGramSolve::contradiction() const {
  const SmallTableau& t = tableau_;
  if (t.dependent < 0) return std::nullopt;
  const double* const coefficients = t.swept + t.dependent * t.stride;
  Vector weights = Vector::Zero(t.all);
  weights[t.row[t.dependent]] = 1;
  for (Index a = 0; a < t.m; ++a) {
    const double part = coefficients[a] * t.row_scale[a] * t.inverse_scale[t.dependent];
    if (!t.held[a] || std::abs(part) <= zero_coefficient) continue;
    if (part > 0 && !t.two_sided[a]) return std::nullopt;
    weights[t.row[a]] = -coefficients[a];
  }
  return weights;
}

std::vector<Index> SmallGramSolve::one_sided_rows_held() const {
  std::vector<Index> rows;
  for (Index a = 0; a < tableau_.m; ++a)
    if (tableau_.held[a] && !tableau_.two_sided[a]) rows.push_back(tableau_.row[a]);
  return rows;
}

double SmallGramSolve::near_scale(double part) {
  SmallTableau& t = tableau_;
  const double small = part * std::max(t.acceleration_norm, t.z_norm);
  if (t.size == t.n) return 0;
  if (!looks_at_all()) {
    Index count = 0;
    for (Index a = 0; a < t.all && count <= few_touched; ++a)
      if (slack_[a] <= row_scale_[a] * small && place(a) < 0) close_[count++] = a;
    if (count > few_touched || !look_at_fresh({close_, close_ + count}, count)) return 0;
  }
  if (small_kernels().margin(t) > small) return 0;
  bool any = false;
  for (Index a = 0; a < t.m; ++a) {
    if (!t.held[a]) t.slack[a] = -t.b[a];
    const double size = t.held[a] ? t.lambda[a] * t.row_scale[a] : t.slack[a] * t.inverse_scale[a];
    if (t.two_sided[a] || t.row[a] < 0 || size > small) continue;
    if (!t.held[a] && !(t.swept[a * (t.stride + 1)] > least_independent * t.square[a])) return 0;
    any = true;
  }
  return any ? small : 0;
}

/// Weak are multipliers (times lengths) and slacks (over them) that are `small`.
void SmallGramSolve::mark_weak(double small) {
  SmallTableau& t = tableau_;
  t.any_weak = false;
  zeroed_ = 0;
  if (!(small > 0)) return;
  t.any_weak = true;
  for (Index a = 0; a < t.m; ++a) {
    const double length = std::sqrt(t.square[a]);
    t.is_weak[a] =
        !t.two_sided[a] && !(t.held[a] ? t.lambda[a] * length > small : t.slack[a] > t.row_scale[a] * small);
    if (!t.is_weak[a] || !t.held[a]) continue;
    zeroed_ += std::abs(t.lambda[a]) * length;
    t.lambda[a] = t.lambda_low[a] = 0;
  }
  for (Index k = 0; k < t.size; ++k) {
    t.held_lambda[k] = t.lambda[t.place[k]];
    t.held_low[k] = t.lambda_low[t.place[k]];
  }
}

bool SmallGramSolve::correct(bool is_first, double small) {
  SmallTableau& t = tableau_;
  mark_weak(small);
  t.is_first = is_first;
  const Index steps = t.steps;
  if (!small_kernels().correct(t)) return false;
  // An inverse loses as much again as a factor: where it is small, it is the difference of large entries.
  double pull = 0;
  for (Index k = 0; k < t.size; ++k) pull += std::abs(t.correction[k]) * t.length[k];
  return known_.note({.step = t.first + zeroed_,
                      .pull = pull,
                      .is_fresh = is_first || small > 0 || t.steps > steps,
                      .factor_condition = t.factor_condition,
                      .gram_condition = t.gram_condition,
                      .growth = std::max(t.gram_condition, t.growth),
                      .scale = std::max(t.acceleration_norm, t.z_norm)});
}

bool SmallGramSolve::take_noise_for_zero(bool more) {
  SmallTableau& t = tableau_;
  const bool told = known_.take_noise_for_zero(
      {t.n, t.q, t.q_low, t.dq, t.diagonal, t.unit, t.size, t.held_lambda, t.correction, t.length, t.pull},
      more);
  for (Index k = 0; k < t.size; ++k) {
    t.lambda[t.place[k]] = t.held_lambda[k];
    if (t.held_lambda[k] == 0) t.lambda_low[t.place[k]] = t.held_low[k] = 0;
  }
  return told;
}

/// Whether the answer in doubles is within so much, no row close to tipping over.
bool SmallGramSolve::doubles_do(double close) {
  const SmallTableau& t = tableau_;
  known_ = Corrections();
  touched_violation_ = 0;
  measure();
  known_.scale = std::max(t.acceleration_norm, t.z_norm);
  Index weak = 0;
  double missing = 0;
  for (Index k = 0; k < t.size; ++k) {
    const Index a = t.place[k];
    weak += !t.two_sided[a] && !(t.held_lambda[k] * t.length[k] > near_zero * known_.scale);
    missing += t.slack[a] * t.slack[a];
  }
  if (weak > 0 || !is_clear(known_.scale)) return false;
  const double condition = t.factor_condition * (1 + std::sqrt(t.gram_condition));
  known_.bound = bound_of_doubles(t.n, t.size, t.stationarity, t.inverse_norm * std::sqrt(missing),
                                  condition * (known_.scale + t.magnitude));
  return known_.bound <= close;
}

bool SmallGramSolve::answer(const Accuracy& accuracy, Solution& solution) {
  SmallTableau& t = tableau_;
  t.factor_condition = problem_.A.factor_condition();
  const double close = accuracy.tolerance * std::max(1.0, t.acceleration_norm);
  return !accuracy.refine && doubles_do(close) ? write(accuracy, solution)
                                               : finish(*this, accuracy, solution);
}

bool SmallGramSolve::write(const Accuracy& accuracy, Solution& solution) {
  SmallTableau& t = tableau_;
  if (std::all_of(t.q, t.q + t.n, [](double x) { return x == 0; })) t.acceleration_norm = 0;
  const double close = accuracy.tolerance * std::max(1.0, t.acceleration_norm);
  if (!(known_.bound <= close) && t.size == t.n && !problem_.radii) {
    touched_count_ = 0;
    if (keeps_touched_rows()) known_.bound = 0;
  }
  solution.residuals = residuals();
  solution.method = "active-set";
  solution.undecided = {};
  solution.model.islands.clear();
  solution.steps = t.steps;
  solution.q = Eigen::Map<const Vector>(t.q, t.n);
  solution.lambda.setZero(t.all);
  solution.slack = Eigen::Map<const Vector>(slack_, t.all);
  for (Index k = 0; k < t.size; ++k) {
    solution.lambda[t.rows[k]] = t.held_lambda[k];
    solution.slack[t.rows[k]] = 0;
  }
  solution.basis.assign(t.rows, t.rows + t.size);
  solution.acceleration_norm = t.acceleration_norm;
  solution.force_norm = t.z_norm;
  solution.rounding = known_.rounding;
  solution.error_bound = known_.bound;
  solution.status = known_.bound <= close ? Status::solved : Status::inaccurate;
  return true;
}

/// `convex::residuals` where only the rows held matter, measured in doubles.
Residuals SmallGramSolve::residuals() const {
  const SmallTableau& t = tableau_;
  double most = 0;
  for (Index k = 0; k < t.size; ++k) most = std::max(most, std::abs(t.held_lambda[k]));
  HeldResiduals held(t.stationarity, t.acceleration_norm, known_.scale, most);
  for (Index k = 0; k < t.size; ++k) {
    const Index a = t.place[k];
    held.add(t.level[a], t.length[k], t.held_lambda[k], t.slack[a], t.two_sided[a]);
  }
  Residuals found = held.all();
  found.feasibility = std::max(found.feasibility, touched_violation_);
  return found;
}

}  // namespace convex::inline pivoting
