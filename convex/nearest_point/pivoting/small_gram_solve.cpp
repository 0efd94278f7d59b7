#include "convex/nearest_point/pivoting/small_gram_solve.hpp"

#include <cmath>

#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/optimality/held_residuals.hpp"
#include "convex/nearest_point/pivoting/small_tableau_steps.hpp"

namespace convex {
namespace {

/// A row outside with a smaller slack than this part of its terms is close enough to matter.
constexpr double near = 1e-8;

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
    target static void correct(SmallTableau& t) { return one_pack(t) ? One::correct(t) : Four::correct(t); } \
    target static void measure(SmallTableau& t) { return one_pack(t) ? One::measure(t) : Four::measure(t); } \
    static constexpr SmallKernels table{begin, begin_again, settle, correct, measure};                       \
  };

MOREAU_SMALL_TABLE(Portable, , 2, false)
#if defined(__x86_64__) && defined(__GNUC__)
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

SmallGramSolve::SmallGramSolve(const NearestPointProblem& problem, SmallTableau& scene)
    : problem_(problem), scene_(scene) {
  const DenseFactor factor = problem.A.dense_factor();
  scene.n = problem.dimension();
  scene.m = problem.rows();
  scene.ld = factor.ld;
  scene.stride = padded(scene.m);
  scene.T = factor.T;
  scene.inverse = factor.inverse;
  scene.A = problem.A.dense_gram().data();
  scene.U = problem.U.dense().data();
  const double* const diagonal = problem.A.diagonal().data();
  for (Index i = 0; i < scene.n; ++i) scene.inverse_diagonal[i] = 1 / diagonal[i];
}

void SmallGramSolve::take_force() {
  for (Index i = 0; i < scene_.n; ++i) scene_.z[i] = problem_.z[i];
  for (Index i = scene_.n; i < scene_.ld; ++i) scene_.z[i] = 0;
  for (Index a = 0; a < scene_.m; ++a) scene_.level[a] = problem_.s[a];
  for (Index a = scene_.m; a < scene_.stride; ++a) scene_.level[a] = 0;
}

void SmallGramSolve::begin(const std::vector<Index>& guess) {
  take_force();
  for (Index a = 0; a < scene_.stride; ++a) scene_.held[a] = scene_.two_sided[a] = false;
  for (Index a : problem_.two_sided) scene_.two_sided[a] = true;
  for (Index a : guess) scene_.held[a] = true;
}

bool SmallGramSolve::solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution) {
  begin(guess);
  const SmallKernels& kernels = small_kernels();
  const bool settled = kernels.begin(scene_) && kernels.settle(scene_);
  sweeps_ = 0;
  return settled && answer(accuracy, solution);
}

bool SmallGramSolve::solve_again(const Accuracy& accuracy, Solution& solution) {
  if (sweeps_ > sweeps_kept * scene_.m) return solve(solution.basis, accuracy, solution);
  take_force();
  const SmallKernels& kernels = small_kernels();
  const bool settled = kernels.begin_again(scene_) && kernels.settle(scene_);
  sweeps_ += scene_.steps;
  return settled && answer(accuracy, solution);
}

std::vector<Index> SmallGramSolve::one_sided_rows_held() const {
  std::vector<Index> rows;
  for (Index a = 0; a < scene_.m; ++a)
    if (scene_.held[a] && !scene_.two_sided[a]) rows.push_back(a);
  return rows;
}

/// False when one correction does not do.
bool SmallGramSolve::correct() {
  small_kernels().correct(scene_);
  contraction_ =
      std::max(scale_ > 0 ? scene_.first / scale_ : 0,
               expected_contraction(scene_.factor_condition,
                                    std::max(scene_.gram_condition, scene_.growth * scene_.growth), true));
  remaining_ = scene_.first * contraction_ / (1 - contraction_) +
               4 * unit_roundoff * unit_roundoff * condition_ * scale_;
  return contraction_ <= largest_contraction && remaining_ <= enough * scale_;
}

/// Takes the correction in, and what cancels for 0; false when an entry is so small that more corrections
/// would tell it, or a multiplier turns out negative.
bool SmallGramSolve::round() {
  SmallTableau& t = scene_;
  const double usual = usual_contraction(t.factor_condition, t.gram_condition);
  const double missing = 4 * std::min(remaining_, t.first * usual) * t.factor_condition;
  const double* const diagonal = problem_.A.diagonal().data();
  double rounded = 0, silenced = 0, let_pull = 0;
  Index small = 0;
  for (Index i = 0; i < t.n; ++i) {
    const DoubleDouble sum = two_sum(t.q[i], t.dq[i]);
    const double size = std::abs(sum.hi), step = std::abs(t.dq[i]);
    const bool is_zero = size <= 16 * usual * step;
    small += !is_zero && size <= std::max(cancelled * step, missing * std::sqrt(t.inverse_diagonal[i]));
    if (is_zero) silenced += diagonal[i] * sum.hi * sum.hi;
    t.q[i] = is_zero ? 0 : sum.hi;
    t.q_low[i] = is_zero ? 0 : sum.lo;
    rounded += diagonal[i] * t.q_low[i] * t.q_low[i];
  }
  if (small > 0) return false;
  for (Index k = 0; k < t.size; ++k) {
    const double step = t.correction[k], sum = t.held_lambda[k] + step;
    const double unit = std::sqrt(t.gram_condition / t.square[t.rows[k]]);
    const bool is_zero = std::abs(sum) <= std::max(missing * unit, cancelled * std::abs(step));
    t.held_lambda[k] = is_zero ? 0 : sum;
    if (is_zero && sum < 0 && !t.two_sided[t.rows[k]]) let_pull -= sum * std::sqrt(t.square[t.rows[k]]);
    if (t.held_lambda[k] < 0 && !t.two_sided[t.rows[k]]) return false;
  }
  rounding_ = std::sqrt(static_cast<double>(t.n) * rounded);
  silenced_ = std::sqrt(static_cast<double>(t.n) * silenced);
  bound_ = 2 * remaining_ + silenced_ + rounding_ + let_pull;
  return true;
}

/// Whether no row outside is close, of ||q||_A or that size if it is larger.
bool SmallGramSolve::is_clear(double size) {
  const SmallTableau& t = scene_;
  magnitude_ = 0;
  for (Index i = 0; i < t.n; ++i) magnitude_ += problem_.A.diagonal()[i] * t.q[i] * t.q[i];
  magnitude_ = std::sqrt(magnitude_);
  Index close = 0;
  const double unsure = 16 * (remaining_ + silenced_);
  for (Index a = 0; a < t.m; ++a)
    close += !t.held[a] &&
             !(t.slack[a] > near * (std::abs(t.level[a]) + t.row_scale[a] * std::max(size, magnitude_)) +
                                t.row_scale[a] * unsure);
  return close == 0;
}

/// Whether rows outside are clear of their edge by more than rounding, or the doubles q are, without
/// rounding, the point of the rows held and keep those that they touch.
bool SmallGramSolve::keeps_rows_outside() {
  if (is_clear(0)) return true;
  SmallTableau& t = scene_;
  const double rounding = 2 * static_cast<double>(t.n) * unit_roundoff;
  const double unsure_point = 16 * (remaining_ + silenced_);
  std::vector<Index> touched;
  for (Index a = 0; a < t.m; ++a) {
    if (t.held[a]) continue;
    const double unsure =
        rounding * (std::abs(t.level[a]) + t.row_scale[a] * magnitude_) + t.row_scale[a] * unsure_point;
    if (t.slack[a] > unsure) continue;
    if (t.slack[a] < -unsure) return false;
    touched.push_back(a);
  }
  if (touched.empty()) return true;
  if (problem_.radii) return false;
  const std::optional<Vector> slacks = slacks_if_kept(problem_, Eigen::Map<const Vector>(t.q, t.n),
                                                      std::vector<Index>(t.rows, t.rows + t.size), touched);
  if (!slacks) return false;
  for (std::size_t k = 0; k < touched.size(); ++k) t.slack[touched[k]] = (*slacks)[static_cast<Index>(k)];
  return true;
}

/// Whether the answer in doubles is within so much, no row close to tipping over.
bool SmallGramSolve::doubles_do(double close) {
  const SmallTableau& t = scene_;
  small_kernels().measure(scene_);
  remaining_ = silenced_ = 0;
  Index weak = 0;
  double missing = 0;
  for (Index k = 0; k < t.size; ++k) {
    const Index a = t.rows[k];
    weak += !t.two_sided[a] && !(t.held_lambda[k] * std::sqrt(t.square[a]) > near * scale_);
    missing += t.slack[a] * t.slack[a];
  }
  if (weak > 0 || !is_clear(scale_)) return false;
  rounding_ = 0;
  bound_ = bound_of_doubles(t.n, t.size, t.stationarity, t.inverse_norm * std::sqrt(missing),
                            condition_ * (scale_ + magnitude_));
  return bound_ <= close;
}

bool SmallGramSolve::answer(const Accuracy& accuracy, Solution& solution) {
  SmallTableau& t = scene_;
  t.factor_condition = problem_.A.factor_condition();
  condition_ = t.factor_condition * (1 + std::sqrt(t.gram_condition));
  scale_ = std::max(t.acceleration_norm, t.force_norm);
  double close = accuracy.tolerance * std::max(1.0, t.acceleration_norm);
  if (accuracy.refine || !doubles_do(close)) {
    if (!correct() || !round()) return false;
    small_kernels().measure(t);
    if (!keeps_rows_outside()) return false;
    if (std::all_of(t.q, t.q + t.n, [](double x) { return x == 0; })) {
      t.acceleration_norm = 0;
      close = accuracy.tolerance;
    }
  }
  solution.residuals = residuals();
  solution.method = "active-set";
  solution.undecided = {};
  solution.model.islands.clear();
  solution.steps = t.steps;
  solution.q = Eigen::Map<const Vector>(t.q, t.n);
  solution.lambda.setZero(t.m);
  solution.slack = Eigen::Map<const Vector>(t.slack, t.m);
  for (Index k = 0; k < t.size; ++k) {
    solution.lambda[t.rows[k]] = t.held_lambda[k];
    solution.slack[t.rows[k]] = 0;
  }
  solution.basis.assign(t.rows, t.rows + t.size);
  solution.acceleration_norm = t.acceleration_norm;
  solution.force_norm = t.force_norm;
  solution.rounding = rounding_;
  solution.error_bound = bound_;
  solution.status = bound_ <= close ? Status::solved : Status::inaccurate;
  return true;
}

/// `convex::residuals` where only the rows held matter, measured in doubles.
Residuals SmallGramSolve::residuals() const {
  const SmallTableau& t = scene_;
  double most = 0;
  for (Index k = 0; k < t.size; ++k) most = std::max(most, std::abs(t.held_lambda[k]));
  HeldResiduals held(t.stationarity, t.acceleration_norm, scale_, most);
  for (Index k = 0; k < t.size; ++k) {
    const Index a = t.rows[k];
    held.add(t.level[a], std::sqrt(t.square[a]), t.held_lambda[k], t.slack[a], t.two_sided[a]);
  }
  return held.all();
}

}  // namespace convex
