#include "convex/nearest_point/optimality/residuals.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/nearest_point/optimality/gathered_residuals.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline optimality {

namespace {

/// The root of Σ u_i²/d_i, for entries of any size.
double length_at_any_scale(const ConstraintRows& U, Index a, const Vector& d) {
  std::vector<double> parts;
  U.for_each_entry(a, [&](Index i, double u) { parts.push_back(u / std::sqrt(d[i])); });
  return Eigen::Map<const Vector>(parts.data(), static_cast<Index>(parts.size())).stableNorm();
}

}  // namespace

Vector dual_lengths(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  Vector length = Vector::Zero(problem.rows());
  if (problem.U.is_sparse() && is_diagonal(problem.A)) {
    const Vector all = problem.U.lengths(problem.A.diagonal().cwiseInverse());
    for (Index a : rows)
      length[a] = has_squares(all[a]) ? all[a] : length_at_any_scale(problem.U, a, problem.A.diagonal());
    return length;
  }
  // With a sparse factor a length is a solve: beyond `many` a lower bound stands for it, (u·v)/||v||_A for v
  // = D⁻¹u, which makes residuals larger.
  constexpr std::size_t many = 2000;
  if (problem.U.is_sparse() && problem.A.kind() == MetricKind::sparse && rows.size() > many) {
    const Vector inverse = problem.A.diagonal().cwiseInverse();
    Vector v = Vector::Zero(problem.dimension());
    for (Index a : rows) {
      double along = 0, square = 0;
      for (SparseRows::InnerIterator it(problem.U.sparse(), a); it; ++it) {
        v[it.col()] = it.value() * inverse[it.col()];
        along += it.value() * v[it.col()];
      }
      for (SparseRows::InnerIterator it(problem.U.sparse(), a); it; ++it)
        for (SparseMatrix::InnerIterator entry(problem.A.sparse_gram(), it.col()); entry; ++entry)
          square += v[it.col()] * entry.value() * v[entry.row()];
      for (SparseRows::InnerIterator it(problem.U.sparse(), a); it; ++it) v[it.col()] = 0;
      length[a] = square > 0 ? along / std::sqrt(square) : 0;
    }
    return length;
  }
  constexpr std::size_t width = 64;  // rows whitened at once
  for (std::size_t first = 0; first < rows.size(); first += width) {
    const std::size_t count = std::min(width, rows.size() - first);
    Matrix block(problem.dimension(), static_cast<Index>(count));
    for (std::size_t k = 0; k < count; ++k)
      problem.U.copy_row(rows[first + k], block.col(static_cast<Index>(k)));
    problem.A.whiten_in_place(block);
    for (std::size_t k = 0; k < count; ++k) {
      const auto whitened = block.col(static_cast<Index>(k));
      const double plain = whitened.norm();
      length[rows[first + k]] = has_squares(plain) ? plain : whitened.stableNorm();
    }
  }
  return length;
}

bool violates_beyond_bound(const Solution& found) {
  constexpr double roundings = 1e-12;  // of residuals and norms, of whatever they are made of
  const double scale = std::max(found.acceleration_norm, found.force_norm);
  // A violation is at most the row's length times the error.
  return !(found.residuals.feasibility * found.acceleration_norm <=
           2 * found.error_bound + roundings * scale);
}

double bound_by_gap(const NearestPointProblem& problem, const Solution& answer) {
  if (answer.residuals.feasibility != 0 || answer.slack.size() != problem.rows()) return infinity;
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  const DoubleDoubleVector q(answer.q);
  const Vector magnitude = answer.q.cwiseAbs();
  for (Index a = 0; a < problem.rows(); ++a) {
    const bool is_equation = two_sided[at(a)];
    if (answer.lambda[a] < 0 && !is_equation) return infinity;
    // A relative residual may be 0 where its scale is no double.
    const double far = near_zero * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, magnitude));
    if (!is_equation && answer.slack[a] > far) continue;
    const double rest = slack(problem, a, q).value();
    if (is_equation ? rest != 0 : !(rest >= 0)) return infinity;
  }
  // ||e||² <= ||e|| r + g, g = lambda·(Uq - s): the gap squared is g + ½r².
  const double gap = answer.residuals.duality_gap, r = answer.residuals.stationarity,
               most = 0.5 * (r + std::sqrt(std::max(0.0, 4 * gap * gap - r * r)));
  return (most + unit_roundoff) * std::max(answer.acceleration_norm, answer.force_norm);
}

namespace {

template <class Visit>
void for_each_stored(const SparseRows& U, Index a, Visit visit) {
  const Index end = U.outerIndexPtr()[a + 1];
  for (Index k = U.outerIndexPtr()[a]; k < end; ++k) visit(U.innerIndexPtr()[k], U.valuePtr()[k]);
}

/// The product as a pair; entries of incidence are 1 and -1, and then it is exact.
DoubleDouble exact_product(double value, double x) {
  if (std::abs(value) == 1) return {value * x, 0};
  return two_product(value, x);
}

}  // namespace

Solution measured(const NearestPointProblem& problem, const Vector& q, const Vector& lambda,
                  const KnownParts& known) {
  Solution found;
  found.q = q;
  found.lambda = lambda;
  found.slack = problem.U.times(q) - problem.s;
  found.acceleration_norm = problem.A.norm(q);
  found.force_norm = problem.A.dual_norm(problem.z);
  found.residuals = residuals(problem, found, known);
  return found;
}

Residuals residuals(const NearestPointProblem& problem, const Vector& q, const Vector& lambda) {
  return measured(problem, q, lambda).residuals;
}

Residuals residuals(const NearestPointProblem& problem, const Solution& answer, const KnownParts& known) {
  const Vector &q = answer.q, &lambda = answer.lambda, &s = problem.s, &d = problem.A.diagonal();
  const ConstraintRows& U = problem.U;
  const Index m = problem.rows();
  const bool is_sparse = U.is_sparse(), are_lengths_at_hand = is_sparse && is_diagonal(problem.A);
  const DoubleDoubleVector point(is_sparse && known.stationarity ? Vector() : q);
  const double stationarity = known.stationarity
                                  ? *known.stationarity
                                  : problem.A.dual_norm(stationarity_residual(problem, point, lambda));
  const Vector magnitude = is_sparse ? Vector() : Vector(q.cwiseAbs());
  GatheredResiduals found(stationarity, answer.acceleration_norm,
                          std::max(answer.acceleration_norm, answer.force_norm),
                          m > 0 ? lambda.cwiseAbs().maxCoeff() : 0);
  const auto terms = [&](Index a) {
    if (!is_sparse) return U.absolute_dot(a, magnitude);
    double sum = 0;
    for_each_stored(U.sparse(), a, [&](Index i, double u) { sum += std::abs(u * q[i]); });
    return sum;
  };
  const auto precise_slack = [&](Index a) {
    if (!is_sparse) return slack(problem, a, point).value();
    RunningSum sum;
    for_each_stored(U.sparse(), a, [&](Index i, double u) { sum.add(exact_product(u, q[i])); });
    sum.add(-s[a]);
    return sum.value();
  };
  const auto length_at_hand = [&](Index a) {
    double square = 0;
    for_each_stored(U.sparse(), a, [&](Index i, double u) { square += u * u / d[i]; });
    return std::sqrt(square);
  };
  const std::vector<bool> two_sided = marked(m, problem.two_sided);
  std::vector<Index> unknown;
  std::vector<double> slacks;  // of these
  for (Index a = 0; a < m; ++a) {
    const bool is_two_sided = two_sided[at(a)], is_loaded = lambda[a] != 0;
    double rest = answer.slack[a];
    // A slack far from zero is known well enough; one near zero is computed again in twice the precision.
    if (rest > 0 && !is_two_sided && !is_loaded) {
      const double size = std::abs(s[a]);
      if (known.magnitude.size() > 0 && rest > near_zero * (size + known.magnitude[a])) continue;
      if (rest > near_zero * (size + terms(a))) continue;
    }
    rest = precise_slack(a);
    if ((!is_loaded && rest >= 0 && !is_two_sided) || rest == 0) continue;
    double length = known.length.size() > 0 ? known.length[a] : 0;
    if (are_lengths_at_hand) length = length_at_hand(a);
    if (has_squares(length)) {
      found.add(s[a], length, lambda[a], rest, is_two_sided);
    } else {
      unknown.push_back(a);
      slacks.push_back(rest);
    }
  }
  if (unknown.empty()) return found.all();
  const Vector length = dual_lengths(problem, unknown);
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const Index a = unknown[k];
    found.add(s[a], length[a], lambda[a], slacks[k], two_sided[at(a)]);
  }
  return found.all();
}

}  // namespace convex::inline optimality
