#include "convex/nearest_point/well_conditioned.hpp"

#include <cmath>

#include "convex/nearest_point/gram_pivoting.hpp"
#include "convex/nearest_point/kkt_residual.hpp"
#include "convex/nearest_point/residuals.hpp"

namespace convex {
namespace {

/// Beyond, the arrays by eights are no longer what the caches hold.
constexpr Index largest = 600;

/// The correction from doubles to the refined point, of the scale: the next one would be its square.
constexpr double largest_correction = 0x1p-38;

/// An entry that the correction takes to this part of it is 0 as far as that tells (`refine`).
constexpr double cancelled = 0x1p-24;

/// Rounding of a slack summed in twice the precision, relative to what it is the difference of.
constexpr double silence = 0x1p-95;

constexpr Index most_kept_lines = Index{1} << 17;  // 8 MB

/// What the correction and the answer need beside the pivoting.
class ShortWay {
 public:
  ShortWay(const NearestPointProblem& problem, Arena& arena)
      : problem_(problem),
        kernels_(dense_kernels()),
        A_(problem.A.dense_factor()),
        n_(problem.dimension()),
        m_(problem.rows()),
        ld_(A_.ld) {
    const Index k = std::min(n_, m_);
    arena.start((9 * ld_ + 2 * padded(m_) + 3 * padded(k) + 2 * (padded(m_) + 64)) / 8 +
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
    y_ = arena.take_filled(m_ + 64, 0.0);
    held_slack_ = arena.take<double>(m_ + 64);
  }

  std::optional<Solution> run(Arena& arena, const Accuracy& accuracy, const std::vector<Index>& guess) {
    for (Index i = 0; i < n_; ++i) z_[i] = problem_.z[i];
    copy_packs(ld_, z_, w_free_);
    kernels_.forward(n_, ld_, A_.T, A_.inverse, w_free_);
    const double* diagonal = problem_.A.diagonal().data();
    for (Index i = 0; i < n_; ++i) inverse_diagonal_[i] = 1 / diagonal[i];
    kernels_.squares(m_, n_, problem_.U.dense().data(), inverse_diagonal_, row_scale_);
    for (Index a = 0; a < m_; ++a) row_scale_[a] = std::sqrt(row_scale_[a]);
    force_norm_ = std::sqrt(kernels_.dot(ld_, w_free_, w_free_));
    GramPivoting set(problem_, arena, w_free_, row_scale_);
    if (!set.settle(guess) || !correct(set)) return std::nullopt;
    return answer(set, accuracy);
  }

 private:
  /// One correction of q and lambda with residuals in twice the working precision. False when it is not
  /// small.
  bool correct(const GramPivoting& set) {
    set.find_point(w_, q_);
    for (Index j = 0; j < set.size(); ++j) {
      rows_[j] = set.row(j);
      lambda_[j] = set.lambda()[set.place(j)];
    }
    residual(set);
    copy_packs(ld_, r_, dw_);
    kernels_.forward(n_, ld_, A_.T, A_.inverse, dw_);
    precise_slacks(set);
    for (Index j = 0; j < padded(set.size()); ++j) load_[j] = 0;
    Index last = -1;
    alignas(64) double dots[8];
    for (Index j = 0; j < set.size(); ++j) {
      if (set.place(j) / 8 != last) {
        last = set.place(j) / 8;
        kernels_.dots(n_, set.rows().whitened() + 8 * last * n_, dw_, dots);
      }
      load_[j] = -held_slack_[set.place(j)] - dots[set.place(j) % 8];
    }
    set.solve(load_);
    for (Index j = 0; j < set.size(); ++j) y_[set.place(j)] = load_[j];
    kernels_.combine(n_, set.rows().count() / 8, set.rows().whitened(), y_, dw_);
    for (Index i = 0; i < n_; ++i) w_[i] += dw_[i];
    first_ = std::sqrt(kernels_.dot(ld_, dw_, dw_));
    acceleration_norm_ = std::sqrt(kernels_.dot(ld_, w_, w_));
    scale_ = std::max(acceleration_norm_, force_norm_);
    if (!(first_ <= largest_correction * scale_)) return false;
    const double contraction = std::max(scale_ > 0 ? first_ / scale_ : 0, unit_roundoff);
    remaining_ = first_ * contraction / (1 - contraction);
    copy_packs(ld_, dw_, dq_);
    kernels_.backward(n_, ld_, A_.T, A_.inverse, dq_);
    return true;
  }

  void residual(const GramPivoting& set) {
    kernels_.stationarity(n_, problem_.A.dense_gram().data(), q_, m_, problem_.U.dense().data(), set.size(),
                          rows_, lambda_, z_, r_);
  }

  /// Slacks at q of the rows held, at their places.
  void precise_slacks(const GramPivoting& set) {
    Index last = -1;
    for (Index j = 0; j < set.size(); ++j)
      if (set.place(j) / 8 != last) {
        last = set.place(j) / 8;
        kernels_.precise_slacks(n_, set.rows().raw() + 8 * last * n_, q_, set.rows().s() + 8 * last,
                                held_slack_ + 8 * last);
      }
  }

  std::optional<Solution> answer(const GramPivoting& set, const Accuracy& accuracy) {
    const double missing = 4 * remaining_ * problem_.A.factor_condition();
    double rounded = 0;
    for (Index i = 0; i < n_; ++i) {
      const DoubleDouble sum = two_sum(q_[i], dq_[i]);
      const double noise = std::max(missing * std::sqrt(inverse_diagonal_[i]), cancelled * std::abs(dq_[i]));
      const bool is_zero = std::abs(sum.hi) <= noise;
      q_[i] = is_zero ? 0 : sum.hi;
      q_low_[i] = is_zero ? 0 : sum.lo;
      rounded += problem_.A.diagonal()[i] * q_low_[i] * q_low_[i];
    }
    const double inverse = set.inverse_norm();
    Solution solution;
    solution.lambda = Vector::Zero(m_);
    for (Index j = 0; j < set.size(); ++j) {
      const double step = y_[set.place(j)], sum = lambda_[j] + step;
      const bool is_zero = std::abs(sum) <= std::max(missing * inverse, cancelled * std::abs(step));
      lambda_[j] = is_zero ? 0 : sum;
      if (lambda_[j] < 0 && !set.is_two_sided(rows_[j])) return std::nullopt;
      solution.lambda[rows_[j]] = lambda_[j];
    }
    const bool clear = measure_slacks(set);
    if (in_doubt_) return std::nullopt;
    solution.method = "active-set";
    solution.steps = set.steps();
    solution.q = Eigen::Map<const Vector>(q_, n_);
    solution.slack = Eigen::Map<const Vector>(slack_, m_);
    solution.basis.assign(rows_, rows_ + set.size());
    solution.acceleration_norm = acceleration_norm_;
    solution.force_norm = force_norm_;
    solution.rounding = std::sqrt(static_cast<double>(n_) * rounded);
    solution.error_bound = 2 * remaining_ + solution.rounding;
    solution.residuals = clear ? residuals_of_held(set) : general_residuals(solution, set);
    const bool close = solution.error_bound <= accuracy.tolerance * std::max(1.0, acceleration_norm_);
    solution.status = close ? Status::solved : Status::inaccurate;
    return solution;
  }

  /// Slacks at the refined point. False when some row outside is so close that its slack matters to the
  /// residuals; in doubt when one may be violated.
  bool measure_slacks(const GramPivoting& set) {
    kernels_.slacks(m_, n_, problem_.U.dense().data(), q_, problem_.s.data(), slack_);
    constexpr double near = 1e-8;
    double magnitude = 0;
    for (Index i = 0; i < n_; ++i) magnitude += q_[i] * q_[i] / inverse_diagonal_[i];
    magnitude = std::sqrt(magnitude);
    const double rounding = 2 * static_cast<double>(n_) * unit_roundoff;
    bool clear = true;
    for (Index a = 0; a < m_; ++a) {
      if (set.holds(a)) {
        slack_[a] = 0;
        continue;
      }
      const double s = std::abs(problem_.s[a]), terms = s + row_scale_[a] * magnitude;
      if (slack_[a] > near * terms) continue;
      clear = false;
      if (std::abs(slack_[a]) <= rounding * terms) {
        DoubleDoubleVector q(n_);
        std::copy_n(q_, n_, q.hi.data());
        std::copy_n(q_low_, n_, q.lo.data());
        slack_[a] = slack(problem_, a, q).value();
        if (std::abs(slack_[a]) <= silence * (s + row_scale_[a] * scale_) + 2 * row_scale_[a] * remaining_)
          slack_[a] = 0;
      }
      in_doubt_ = in_doubt_ || !(slack_[a] >= 0);
    }
    return clear;
  }

  /// `residuals` where only the rows held matter.
  Residuals residuals_of_held(const GramPivoting& set) {
    residual(set);
    precise_slacks(set);
    kernels_.forward(n_, ld_, A_.T, A_.inverse, r_);
    const double stationarity = std::sqrt(kernels_.dot(ld_, r_, r_));
    double gap = 0.5 * stationarity * stationarity, most = 0;
    for (Index j = 0; j < set.size(); ++j) most = std::max(most, std::abs(lambda_[j]));
    Residuals found;
    for (Index j = 0; j < set.size(); ++j) {
      const double rest = held_slack_[set.place(j)], length = std::sqrt(set.rows().square(set.place(j)));
      const double row_scale = std::abs(problem_.s[rows_[j]]) + length * acceleration_norm_;
      const double over = row_scale > 0 ? row_scale : length * scale_;
      gap += lambda_[j] * rest;
      if (!(over > 0)) continue;
      const double off = set.is_two_sided(rows_[j]) ? std::abs(rest) : std::max(0.0, -rest);
      found.feasibility = std::max(found.feasibility, off / over);
      if (most > 0)
        found.complementarity = std::max(found.complementarity, std::abs(lambda_[j] / most * rest) / over);
    }
    if (scale_ > 0) {
      found.stationarity = stationarity / scale_;
      found.duality_gap = std::sqrt(std::max(0.0, gap)) / scale_;
    }
    return found;
  }

  Residuals general_residuals(const Solution& solution, const GramPivoting& set) const {
    Vector length = Vector::Zero(m_);
    for (Index j = 0; j < set.size(); ++j) length[rows_[j]] = std::sqrt(set.rows().square(set.place(j)));
    return residuals(problem_, solution.q, solution.lambda,
                     KnownParts{std::move(length), solution.slack, {}, acceleration_norm_, force_norm_});
  }

  const NearestPointProblem& problem_;
  const DenseKernels& kernels_;
  const DenseFactor A_;
  const Index n_, m_, ld_;
  double *z_, *w_free_, *w_, *q_, *q_low_, *r_, *dw_, *dq_, *inverse_diagonal_, *row_scale_, *slack_;
  double *load_, *lambda_, *y_, *held_slack_;  // y_, held_slack_: at places; lambda_: of the rows held, rows_
  Index* rows_;
  double force_norm_ = 0, acceleration_norm_ = 0, scale_ = 0, first_ = 0, remaining_ = 0;
  bool in_doubt_ = false;
};

}  // namespace

std::optional<Solution> well_conditioned(const NearestPointProblem& problem, const Accuracy& accuracy,
                                         const std::vector<Index>& guess) {
  const Index n = problem.dimension(), m = problem.rows();
  if (problem.A.kind() != MetricKind::dense || problem.U.is_sparse() || n == 0 || n > largest || m == 0 ||
      m > 4 * largest || accuracy.step_limit > 0)
    return std::nullopt;
  thread_local Arena arena;
  std::optional<Solution> found = ShortWay(problem, arena).run(arena, accuracy, guess);
  if (arena.lines() > most_kept_lines) arena.give_back();
  return found;
}

}  // namespace convex
