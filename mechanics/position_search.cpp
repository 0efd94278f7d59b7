#include "mechanics/position_search.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/automatic.hpp"
#include "mechanics/data_radii.hpp"
#include "mechanics/gauss_problem.hpp"

namespace mechanics {
namespace {

/// Above this many free coordinates the curvature of the constraints is left out of the steps.
constexpr Index most_with_curvature = 60;
constexpr int most_steps = 200;
constexpr double roundings_of_rows = 64;

bool is_chosen(const std::vector<Index>& chosen, Index a) {
  return std::find(chosen.begin(), chosen.end(), a) != chosen.end();
}

/// The metric of a matrix that is positive definite, else none.
std::optional<convex::Metric> metric_if_definite(const Matrix& M) {
  if (!M.allFinite()) return std::nullopt;
  try {
    return convex::Metric::dense(M);
  } catch (const convex::InvalidInput&) {
    return std::nullopt;
  }
}

std::optional<Vector> solved_definite(const Matrix& M, const Vector& right) {
  const auto metric = metric_if_definite(M);
  if (!metric) return std::nullopt;
  return metric->solve(right);
}

}  // namespace

PositionSearch::PositionSearch(const LagrangianSystem& system, const State& guess,
                               const AssemblyQuestion& question)
    : system_(system), guess_(guess) {
  const auto n = static_cast<Index>(system.coordinates().size());
  for (Index i = 0; i < n; ++i)
    if (!is_chosen(question.held, i)) free_.push_back(i);
  const auto m = static_cast<Index>(system.constraints().size());
  for (Index a = 0; a < m; ++a) {
    all_.push_back(a);
    is_equal_.push_back(system.constraints()[static_cast<std::size_t>(a)].two_sided ||
                        is_chosen(question.contacts, a));
  }
  is_left_out_.assign(all_.size(), false);
  const Matrix A = Matrix(system.inertia(guess).A);
  kinetic_metric(system.inertia(guess).A, system.coordinates());
  A_ = A(free_, free_);
  if (!free_.empty()) A_metric_ = convex::Metric::dense(A_);
}

double PositionSearch::violation(const TriedPosition& x, Index a) const {
  if (is_left_out_[static_cast<std::size_t>(a)]) return 0;
  return is_equal(a) ? x.f[a] : std::min(0.0, x.f[a]);
}

TriedPosition PositionSearch::at(const Vector& q) const {
  const State state{guess_.t, q, Vector::Zero(q.size())};
  const ConstraintRates rates = system_.constraint_rates(state);
  TriedPosition x{q, rates.f, rates.f_scale, {}, 1, 0};
  x.U = Matrix(system_.contact_rows(state, all_).U)(Eigen::all, free_);
  take_rounding_for_zero(x);
  for (const Index a : all_) x.missing += square(violation(x, a) / x.scale[a]);
  x.missing = std::sqrt(x.missing);
  if (!std::isfinite(x.missing)) throw convex::InvalidInput("not finite");
  return x;
}

/// Entries of gradients that are 0 but for rounding become 0: steps would be divided by them.
void PositionSearch::take_rounding_for_zero(TriedPosition& x) const {
  std::vector<Index> suspects;
  for (const Index a : all_) {
    bool is_suspect = false;
    for (Index k = 0; k < x.U.cols(); ++k) {
      const double size = std::abs(x.U(a, k)) * (1 + std::abs(x.q[free_[static_cast<std::size_t>(k)]]));
      is_suspect = is_suspect || (size > 0 && size <= suspicious_gradient * x.scale[a]);
    }
    if (is_suspect) suspects.push_back(a);
  }
  if (suspects.empty()) return;
  const Matrix beyond =
      Matrix(gradients_beyond_rounding(system_, {guess_.t, x.q, Vector::Zero(x.q.size())}, suspects));
  for (std::size_t j = 0; j < suspects.size(); ++j)
    for (std::size_t k = 0; k < free_.size(); ++k)
      if (beyond(static_cast<Index>(j), free_[k]) == 0) x.U(suspects[j], static_cast<Index>(k)) = 0;
}

double PositionSearch::moved(const TriedPosition& x) const {
  const Vector d = (x.q - guess_.q)(free_);
  return std::sqrt(std::max(0.0, d.dot(A_ * d)));
}

/// No coordinate moves by more than its size, or 1, at once: where a gradient is small its tangent leads far
/// away.
Vector PositionSearch::within_reach(const TriedPosition& x, Vector d) const {
  double most = 1;
  for (Index k = 0; k < d.size(); ++k)
    most = std::max(most, std::abs(d[k]) / std::max(1.0, std::abs(x.q[free_[static_cast<std::size_t>(k)]])));
  return d / most;
}

TriedPosition PositionSearch::nearest(TriedPosition x) const {
  Vector lambda = Vector::Zero(static_cast<Index>(all_.size()));
  double last = unlimited;
  int stalled = 0;
  for (int step = 0; step < most_steps; ++step) {
    auto [d, next_lambda] = direction(x, lambda);
    if (d.size() == 0) {
      const double before = x.missing;
      x = restored(x, most_restorations);
      if (!(x.missing < 0.9 * before) && ++stalled > 3) return x;
      continue;
    }
    d = within_reach(x, std::move(d));
    lambda = next_lambda;
    const double length = std::sqrt(std::max(0.0, d.dot(A_ * d)));
    const double size = std::sqrt(std::max(1.0, x.q(free_).dot(A_ * x.q(free_))));
    if (length <= 1e-16 * size) {
      x.step = 0;
      return x;
    }
    TriedPosition next = moved_along(x, d, lambda);
    next.step = length / size;
    // At the end rounding alone is left, and steps no longer shrink.
    const bool is_rounding = next.step <= rounding_part && length >= 0.5 * last;
    if (is_rounding && ++stalled > 2) return next;
    last = length;
    if (next.q == x.q) {  // the step is below the rounding of q, or brings nothing down
      x.step = next.step;
      return x;
    }
    x = std::move(next);
  }
  return x;
}

TriedPosition PositionSearch::restored(TriedPosition x, int steps) const {
  double damping = 1e-4;
  for (int k = 0; k < steps && x.missing > rounding_part * 1e-3; ++k) {
    std::vector<Index> rows;
    for (const Index a : all_)
      if (violation(x, a) != 0) rows.push_back(a);
    if (rows.empty()) return x;
    Matrix J(static_cast<Index>(rows.size()), static_cast<Index>(free_.size()));
    Vector r(J.rows());
    for (Index k2 = 0; k2 < J.rows(); ++k2) {
      const Index a = rows[static_cast<std::size_t>(k2)];
      J.row(k2) = x.U.row(a) / x.scale[a];
      r[k2] = violation(x, a) / x.scale[a];
    }
    const Matrix normal = J.transpose() * J;
    const Vector slope = J.transpose() * r;
    const double unit = std::max(1e-300, normal.diagonal().maxCoeff() / A_.diagonal().maxCoeff());
    bool better = false;
    for (int attempt = 0; attempt < 12 && !better; ++attempt) {
      const std::optional<Vector> step = solved_definite(normal + damping * unit * A_, slope);
      if (!step) {
        damping *= 10;
        continue;
      }
      const Vector d = within_reach(x, -*step);
      const std::optional<TriedPosition> next = tried(x, d, 1);
      if (next && next->missing < x.missing) {
        better = next->missing < (1 - 1e-10) * x.missing;
        x = *next;
        damping = std::max(1e-14, damping / 10);
        if (!better) return x;
      } else {
        damping *= 10;
      }
    }
    if (!better) return x;
  }
  return x;
}

std::optional<TriedPosition> PositionSearch::tried(const TriedPosition& x, const Vector& d,
                                                   double part) const {
  Vector q = x.q;
  q(free_) += part * d;
  try {
    return at(q);
  } catch (const convex::InvalidInput&) {
    return std::nullopt;
  }
}

Matrix PositionSearch::curvature(const TriedPosition& x, const Vector& lambda) const {
  std::vector<Index> rows;
  for (const Index a : all_)
    if (lambda[a] != 0) rows.push_back(a);
  const auto n = static_cast<Index>(free_.size());
  Matrix H = Matrix::Zero(n, n);
  if (rows.empty()) return H;
  const auto along = [&](const Vector& direction) {
    State state{guess_.t, x.q, Vector::Zero(x.q.size())};
    state.v(free_) = direction;
    const Vector s = system_.contact_rows(state, rows).s;
    double total = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) total -= lambda[rows[k]] * s[static_cast<Index>(k)];
    return total;
  };
  const double rest = along(Vector::Zero(n));
  const auto form = [&](const Vector& v) { return (along(v) + along(-v)) / 2 - rest; };
  for (Index i = 0; i < n; ++i) H(i, i) = form(Vector::Unit(n, i));
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < i; ++j)
      H(i, j) = H(j, i) = (form(Vector::Unit(n, i) + Vector::Unit(n, j)) - H(i, i) - H(j, j)) / 2;
  return H;
}

convex::Metric PositionSearch::hessian(const TriedPosition& x, const Vector& lambda, Vector& z) const {
  const auto n = static_cast<Index>(free_.size());
  if (n > most_with_curvature || lambda.isZero(0)) return A_metric_;
  const Matrix whole = A_ - curvature(x, lambda);
  Matrix holding = Matrix::Zero(n, n);
  Vector pull = Vector::Zero(n);
  for (const Index a : all_) {
    if (lambda[a] == 0) continue;
    const Vector u = x.U.row(a).transpose() / x.scale[a];
    holding += u * u.transpose();
    pull += u * (x.f[a] / x.scale[a]);
  }
  const double unit = A_.diagonal().maxCoeff() / std::max(1e-300, holding.diagonal().maxCoeff());
  for (const double weight : {0.0, 1.0, 10.0, 100.0, 1000.0}) {
    const Matrix tried_H = whole + weight * unit * holding;
    const auto metric = metric_if_definite((tried_H + tried_H.transpose()) / 2);
    if (!metric || metric->factor_condition() > 1e4 * A_metric_.factor_condition()) continue;
    z -= weight * unit * pull;
    return *metric;
  }
  return A_metric_;
}

PositionSearch::Direction PositionSearch::direction(const TriedPosition& x, const Vector& lambda) const {
  std::vector<Index> rows, two_sided;
  for (const Index a : all_) {
    if (is_left_out_[static_cast<std::size_t>(a)]) continue;
    if (is_equal(a)) two_sided.push_back(static_cast<Index>(rows.size()));
    rows.push_back(a);
  }
  convex::RowMatrix U = x.U(rows, Eigen::all);
  const Vector s = -x.f(rows);
  Vector z = -(A_ * (x.q - guess_.q)(free_));
  const convex::Metric H = hessian(x, lambda, z);
  convex::NearestPointProblem program{H, z, convex::ConstraintRows(std::move(U)), s, two_sided};
  program.radii = convex::rounding_radii(program, roundings_of_rows);
  for (Index k = 0; k < s.size(); ++k)
    program.radii->s[k] = std::max(program.radii->s[k], 1e-15 * x.scale[rows[static_cast<std::size_t>(k)]]);
  const convex::Solution solution = convex::automatic(program);
  if (solution.q.size() == 0 || !solution.q.allFinite()) return {};
  Vector all = Vector::Zero(static_cast<Index>(all_.size()));
  all(rows) = solution.lambda;
  return {solution.q, all};
}

TriedPosition PositionSearch::moved_along(const TriedPosition& x, const Vector& d,
                                          const Vector& lambda) const {
  const double weight = 2 * lambda.cwiseProduct(x.scale).cwiseAbs().maxCoeff() + 1e-300;
  const auto merit = [&](const TriedPosition& place) {
    double total = square(moved(place)) / 2;
    for (const Index a : all_) total += weight * std::abs(violation(place, a)) / place.scale[a];
    return total;
  };
  const double before = merit(x);
  std::optional<TriedPosition> kept;
  for (double part = 1; part > 1e-6; part /= 2) {
    std::optional<TriedPosition> next = tried(x, d, part);
    if (!next) continue;
    if (!kept) kept = next;
    if (merit(*next) <= before * (1 + 1e-12) || next->missing <= 0.5 * x.missing) return *next;
    if (part == 1) {  // the curvature of the constraints: a second step towards them (Maratos 1978)
      const TriedPosition corrected = restored(*next, 2);
      if (merit(corrected) <= before) return corrected;
    }
  }
  return kept && kept->missing <= x.missing ? *kept : x;
}

}  // namespace mechanics
