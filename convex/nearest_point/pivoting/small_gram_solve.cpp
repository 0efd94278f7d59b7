#include "convex/nearest_point/pivoting/small_gram_solve.hpp"

#include <cmath>

#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/optimality/held_residuals.hpp"
#include "convex/nearest_point/pivoting/small_tableau_steps.hpp"
#include "convex/processor.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex {
namespace {

/// Sweeps add up their rounding: after so many a row, all is swept anew.
constexpr Index sweeps_kept = 16;

bool one_pack(const SmallTableau& t) { return t.ld == 8 && t.stride == 8; }

#define MOREAU_SMALL_TABLE(name, target, W, fused)                                                           \
  struct name {                                                                                              \
    using One = SmallTableauSteps<W, fused, 1>;                                                              \
    using Four = SmallTableauSteps<W, fused, 4>;                                                             \
    target static bool begin(SmallTableau& t) { return one_pack(t) ? One::begin(t) : Four::begin(t); }       \
    target static bool begin_again(SmallTableau& t) {                                                        \
      return one_pack(t) ? One::begin_again(t) : Four::begin_again(t);                                       \
    }                                                                                                        \
    target static bool settle(SmallTableau& t) { return one_pack(t) ? One::settle(t) : Four::settle(t); }    \
    target static bool correct(SmallTableau& t) { return one_pack(t) ? One::correct(t) : Four::correct(t); } \
    target static void measure_precisely(SmallTableau& t) {                                                  \
      return one_pack(t) ? One::measure_precisely(t) : Four::measure_precisely(t);                           \
    }                                                                                                        \
    target static void measure(SmallTableau& t) { return one_pack(t) ? One::measure(t) : Four::measure(t); } \
    static constexpr SmallKernels table{begin, begin_again, settle, correct, measure_precisely, measure};    \
  };

MOREAU_SMALL_TABLE(Portable, , 2, false)
#ifdef MOREAU_HAS_FAMILIES
MOREAU_SMALL_TABLE(Wide, [[gnu::target("avx2,fma")]], 4, true)
MOREAU_SMALL_TABLE(Widest, [[gnu::target("avx512f")]], 8, true)
constexpr const SmallKernels* tables[] = {&Portable::table, &Wide::table, &Widest::table};
#else
constexpr const SmallKernels* tables[] = {&Portable::table};
#endif

}  // namespace

std::span<const SmallKernels* const> all_small_kernels() { return {tables, all_dense_kernels().size()}; }

const SmallKernels& small_kernels() { return *all_small_kernels().back(); }

bool SmallGramSolve::fits(const NearestPointProblem& problem) {
  return problem.dimension() <= SmallTableau::most && problem.rows() <= SmallTableau::most;
}

SmallGramSolve::SmallGramSolve(const NearestPointProblem& problem, SmallTableau& tableau)
    : problem_(problem), tableau_(tableau) {
  const DenseFactor factor = problem.A.dense_factor();
  tableau.n = problem.dimension();
  tableau.m = problem.rows();
  tableau.ld = factor.ld;
  tableau.stride = padded(tableau.m);
  tableau.T = factor.T;
  tableau.inverse = factor.inverse;
  tableau.A = problem.A.dense_gram().data();
  tableau.U = problem.U.dense().data();
  const auto diagonal = problem.A.diagonal().array();
  Eigen::Map<Eigen::ArrayXd>(tableau.inverse_diagonal, tableau.n) = diagonal.inverse();
  Eigen::Map<Eigen::ArrayXd>(tableau.unit, tableau.n) = diagonal.sqrt().inverse();
}

void SmallGramSolve::take_force() {
  for (Index i = 0; i < tableau_.n; ++i) tableau_.z[i] = problem_.z[i];
  for (Index i = tableau_.n; i < tableau_.ld; ++i) tableau_.z[i] = 0;
  for (Index a = 0; a < tableau_.m; ++a) tableau_.level[a] = problem_.s[a];
  for (Index a = tableau_.m; a < tableau_.stride; ++a) tableau_.level[a] = 0;
}

void SmallGramSolve::begin(const std::vector<Index>& guess) {
  take_force();
  for (Index a = 0; a < tableau_.stride; ++a) tableau_.held[a] = tableau_.two_sided[a] = false;
  for (Index a : problem_.two_sided) tableau_.two_sided[a] = true;
  for (Index a : guess) tableau_.held[a] = true;
}

bool SmallGramSolve::solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution) {
  begin(guess);
  const SmallKernels& kernels = small_kernels();
  const bool settled = kernels.begin(tableau_) && kernels.settle(tableau_);
  sweeps_ = 0;
  return settled && answer(accuracy, solution);
}

bool SmallGramSolve::solve_again(const Accuracy& accuracy, Solution& solution) {
  if (sweeps_ > sweeps_kept * tableau_.m) return solve(solution.basis, accuracy, solution);
  take_force();
  const SmallKernels& kernels = small_kernels();
  const bool settled = kernels.begin_again(tableau_) && kernels.settle(tableau_);
  sweeps_ += tableau_.steps;
  return settled && answer(accuracy, solution);
}

std::optional<Vector> SmallGramSolve::contradiction() const {
  const SmallTableau& t = tableau_;
  if (t.dependent < 0) return std::nullopt;
  const double* const coefficients = t.swept + t.dependent * t.stride;
  Vector weights = Vector::Zero(t.m);
  weights[t.dependent] = 1;
  for (Index a = 0; a < t.m; ++a) {
    const double part = coefficients[a] * t.row_scale[a] * t.inverse_scale[t.dependent];
    if (!t.held[a] || std::abs(part) <= zero_coefficient) continue;
    if (part > 0 && !t.two_sided[a]) return std::nullopt;
    weights[a] = -coefficients[a];
  }
  return weights;
}

std::vector<Index> SmallGramSolve::one_sided_rows_held() const {
  std::vector<Index> rows;
  for (Index a = 0; a < tableau_.m; ++a)
    if (tableau_.held[a] && !tableau_.two_sided[a]) rows.push_back(a);
  return rows;
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
    t.lambda[a] = 0;
  }
  for (Index k = 0; k < t.size; ++k) t.held_lambda[k] = t.lambda[t.rows[k]];
}

bool SmallGramSolve::correct(bool is_first, double small) {
  SmallTableau& t = tableau_;
  if (is_first) fill_packs(t.ld, 0, t.q_low);
  mark_weak(small);
  t.is_first = is_first;
  const Index steps = t.steps;
  if (!small_kernels().correct(t)) return false;
  for (Index k = 0; k < t.size; ++k) {
    t.length[k] = std::sqrt(t.square[t.rows[k]]);
    t.pull[k] = t.two_sided[t.rows[k]] ? 0 : t.length[k];
  }
  // An inverse loses as much again as a factor: where it is small, it is the difference of large entries.
  const double grown = std::max(t.gram_condition, t.growth), inverse_error = unit_roundoff * grown * grown;
  if (!known_.note(t.first + zeroed_, is_first || small > 0 || t.steps > steps, t.factor_condition,
                   t.gram_condition, inverse_error, std::max(t.acceleration_norm, t.force_norm)))
    return false;
  for (Index i = 0; i < t.n; ++i) {
    const DoubleDouble sum = two_sum(t.q[i], t.q_low[i] + t.dq[i]);
    t.q[i] = sum.hi;
    t.q_low[i] = sum.lo;
  }
  return true;
}

bool SmallGramSolve::take_noise_for_zero(bool more) {
  SmallTableau& t = tableau_;
  const bool told = known_.take_noise_for_zero({t.n, t.q, t.q_low, t.dq, problem_.A.diagonal().data(), t.unit,
                                                t.size, t.held_lambda, t.correction, t.length, t.pull},
                                               more);
  for (Index k = 0; k < t.size; ++k) t.lambda[t.rows[k]] = t.held_lambda[k];
  return told;
}

void SmallGramSolve::find_magnitude() {
  double square = 0;
  for (Index i = 0; i < tableau_.n; ++i) square += problem_.A.diagonal()[i] * tableau_.q[i] * tableau_.q[i];
  magnitude_ = std::sqrt(square);
}

/// Whether no row outside is close, of ||q||_A or that size if it is larger.
bool SmallGramSolve::is_clear(double size) {
  const SmallTableau& t = tableau_;
  find_magnitude();
  Index close = 0;
  for (Index a = 0; a < t.m; ++a)
    close += !t.held[a] &&
             !(t.slack[a] > near_zero * (std::abs(t.level[a]) + t.row_scale[a] * std::max(size, magnitude_)) +
                                known_.missing_slack(t.row_scale[a]));
  return close == 0;
}

Slacks SmallGramSolve::measure_slacks() {
  SmallTableau& t = tableau_;
  small_kernels().measure(t);
  find_magnitude();
  const double rounding = 2 * static_cast<double>(t.n) * unit_roundoff;
  touched_.clear();
  for (Index a = 0; a < t.m; ++a) {
    if (t.held[a]) continue;
    const double unsure = rounding * (std::abs(t.level[a]) + t.row_scale[a] * magnitude_) +
                          known_.missing_slack(t.row_scale[a]);
    if (t.slack[a] > unsure) continue;
    if (t.slack[a] < -unsure)
      known_.wrong = std::max(known_.wrong, -t.slack[a] / t.row_scale[a]);
    else
      touched_.push_back(a);
  }
  if (!std::isfinite(known_.wrong)) return Slacks::doubtful;  // 0 >= s > 0
  if (known_.wrong > 0) return Slacks::violated;
  return touched_.empty() ? Slacks::kept : decide_degenerate_rows();
}

/// As in `GramSolve`, but for the way up, which is left to it.
Slacks SmallGramSolve::decide_degenerate_rows() {
  SmallTableau& t = tableau_;
  if (problem_.radii) return Slacks::doubtful;
  if (const std::optional<Vector> slacks = slacks_of_touched_rows_if_kept()) {
    for (std::size_t k = 0; k < touched_.size(); ++k) t.slack[touched_[k]] = (*slacks)[static_cast<Index>(k)];
    return Slacks::kept;
  }
  alignas(64) double in_doubles[SmallTableau::most];
  copy_packs(t.stride, t.slack, in_doubles);
  small_kernels().measure_precisely(t);
  for (Index a = 0; a < t.m; ++a)
    if (t.held[a]) t.slack[a] = in_doubles[a];
  for (Index a : touched_) {
    const double noise = zero_of_pairs * (std::abs(t.level[a]) + t.row_scale[a] * known_.scale) +
                         known_.missing_slack(t.row_scale[a]);
    if (t.slack[a] > noise) continue;
    if (t.slack[a] < -noise) {
      known_.wrong = std::max(known_.wrong, -t.slack[a] / t.row_scale[a]);
      continue;
    }
    // Swept, the column of a row outside has its coefficients over the rows held.
    double coefficients[SmallTableau::most];
    for (Index k = 0; k < t.size; ++k) coefficients[k] = t.swept[a * t.stride + t.rows[k]];
    if (!edge_) edge_.emplace(problem_, t.row_scale);
    const std::optional<double> on_edge = edge_->slack(a, t.rows, t.size, coefficients);
    if (!on_edge || *on_edge < 0) return Slacks::doubtful;
    t.slack[a] = *on_edge;
  }
  return known_.wrong > 0 ? Slacks::violated : Slacks::kept;
}

std::optional<Vector> SmallGramSolve::slacks_of_touched_rows_if_kept() const {
  const SmallTableau& t = tableau_;
  return slacks_if_kept(problem_, Eigen::Map<const Vector>(t.q, t.n),
                        std::vector<Index>(t.rows, t.rows + t.size), touched_);
}

/// Whether the answer in doubles is within so much, no row close to tipping over.
bool SmallGramSolve::doubles_do(double close) {
  const SmallTableau& t = tableau_;
  small_kernels().measure(tableau_);
  known_ = Corrections();
  known_.scale = std::max(t.acceleration_norm, t.force_norm);
  Index weak = 0;
  double missing = 0;
  for (Index k = 0; k < t.size; ++k) {
    const Index a = t.rows[k];
    weak += !t.two_sided[a] && !(t.held_lambda[k] * std::sqrt(t.square[a]) > near_zero * known_.scale);
    missing += t.slack[a] * t.slack[a];
  }
  if (weak > 0 || !is_clear(known_.scale)) return false;
  const double condition = t.factor_condition * (1 + std::sqrt(t.gram_condition));
  known_.bound = bound_of_doubles(t.n, t.size, t.stationarity, t.inverse_norm * std::sqrt(missing),
                                  condition * (known_.scale + magnitude_));
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
    touched_.clear();
    if (slacks_of_touched_rows_if_kept()) known_.bound = 0;
  }
  solution.residuals = residuals();
  solution.method = "active-set";
  solution.undecided = {};
  solution.model.islands.clear();
  solution.steps = t.steps;
  solution.q = Eigen::Map<const Vector>(t.q, t.n);
  solution.lambda = Eigen::Map<const Vector>(t.lambda, t.m);
  solution.slack = Eigen::Map<const Vector>(t.slack, t.m);
  for (Index k = 0; k < t.size; ++k) solution.slack[t.rows[k]] = 0;
  solution.basis.assign(t.rows, t.rows + t.size);
  solution.acceleration_norm = t.acceleration_norm;
  solution.force_norm = t.force_norm;
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
    const Index a = t.rows[k];
    held.add(t.level[a], std::sqrt(t.square[a]), t.held_lambda[k], t.slack[a], t.two_sided[a]);
  }
  return held.all();
}

}  // namespace convex
