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
  const double scale = std::max(answer.acceleration_norm, answer.force_norm);
  return (std::sqrt(2.0) * answer.residuals.duality_gap + unit_roundoff) * scale;
}

namespace {

/// A row as it is stored.
struct StoredRow {
  Index count;
  const int* place;
  const double* value;
};

StoredRow stored_row(const SparseRows& U, Index a) {
  const Index begin = U.outerIndexPtr()[a];
  return {U.outerIndexPtr()[a + 1] - begin, U.innerIndexPtr() + begin, U.valuePtr() + begin};
}

/// The product as a pair; entries of incidence are 1 and -1, and then it is exact.
DoubleDouble exact_product(double value, double x) {
  if (std::abs(value) == 1) return {value * x, 0};
  return two_product(value, x);
}

/// u_a·q - s_a in twice the working precision.
double precise_slack(const StoredRow& row, const Vector& q, double s) {
  RunningSum sum;
  for (Index k = 0; k < row.count; ++k) sum.add(exact_product(row.value[k], q[row.place[k]]));
  sum.add(-s);
  return sum.value();
}

double terms(const StoredRow& row, const Vector& q) {
  double sum = 0;
  for (Index k = 0; k < row.count; ++k) sum += std::abs(row.value[k] * q[row.place[k]]);
  return sum;
}

}  // namespace

Residuals sparse_residuals(const NearestPointProblem& problem, const Solution& answer) {
  return sparse_residuals(
      problem, answer,
      problem.A.dual_norm(stationarity_residual(problem, DoubleDoubleVector(answer.q), answer.lambda)), 0,
      problem.rows());
}

Residuals sparse_residuals(const NearestPointProblem& problem, const Solution& answer, double stationarity,
                           Index first, Index end) {
  const SparseRows& U = problem.U.sparse();
  const Vector &d = problem.A.diagonal(), &q = answer.q, &lambda = answer.lambda, &slack = answer.slack;
  GatheredResiduals found(stationarity, answer.acceleration_norm,
                          std::max(answer.acceleration_norm, answer.force_norm),
                          end > first ? lambda.cwiseAbs().maxCoeff() : 0);
  auto next_two_sided = std::lower_bound(problem.two_sided.begin(), problem.two_sided.end(), first);
  for (Index a = first; a < end; ++a) {
    const bool two_sided = next_two_sided != problem.two_sided.end() && *next_two_sided == a;
    next_two_sided += two_sided;
    const bool loaded = std::abs(lambda[a]) > 0;
    const StoredRow row = stored_row(U, a);
    const double size = std::abs(problem.s[a]);
    double rest = slack[a];
    if (rest > 0 && !two_sided && !loaded && rest > near_zero * (size + terms(row, q))) continue;
    rest = precise_slack(row, q, problem.s[a]);
    if ((!loaded && rest >= 0 && !two_sided) || !(std::abs(rest) > 0)) continue;
    double square = 0;
    for (Index k = 0; k < row.count; ++k) square += row.value[k] * row.value[k] / d[row.place[k]];
    found.add(problem.s[a], std::sqrt(square), lambda[a], rest, two_sided);
  }
  return found.all();
}

Residuals residuals(const NearestPointProblem& problem, const Vector& q, const Vector& lambda) {
  Solution found;
  found.q = q;
  found.lambda = lambda;
  found.slack = problem.U.times(q) - problem.s;
  found.acceleration_norm = problem.A.norm(q);
  found.force_norm = problem.A.dual_norm(problem.z);
  return residuals(problem, found);
}

Residuals residuals(const NearestPointProblem& problem, const Solution& answer, KnownParts known) {
  if (is_diagonal(problem.A) && problem.U.is_sparse()) return sparse_residuals(problem, answer);
  const Vector &q = answer.q, &lambda = answer.lambda;
  Vector& length = known.length;
  if (length.size() == 0) length = Vector::Zero(problem.rows());
  Vector rest = answer.slack;
  const Index m = problem.rows();
  const std::vector<bool> two_sided = marked(m, problem.two_sided);

  const DoubleDoubleVector point(q);
  // A slack far from zero is known well enough; one near zero is computed again in twice the precision.
  const Vector magnitude = q.cwiseAbs();
  std::vector<Index> matter, unknown;
  for (Index a = 0; a < m; ++a) {
    const bool is_two_sided = two_sided[at(a)];
    if (rest[a] > 0 && !is_two_sided && lambda[a] == 0) {
      const double s = std::abs(problem.s[a]);
      if (known.magnitude.size() > 0 && rest[a] > near_zero * (s + known.magnitude[a])) continue;
      if (rest[a] > near_zero * (s + problem.U.absolute_dot(a, magnitude))) continue;
    }
    rest[a] = slack(problem, a, point).value();
    if (lambda[a] == 0 && rest[a] >= 0 && !is_two_sided) continue;
    matter.push_back(a);
    if (length[a] <= 0) unknown.push_back(a);
  }
  if (!unknown.empty()) length += dual_lengths(problem, unknown);

  const double stationarity = known.stationarity
                                  ? *known.stationarity
                                  : problem.A.dual_norm(stationarity_residual(problem, point, lambda));
  GatheredResiduals found(stationarity, answer.acceleration_norm,
                          std::max(answer.acceleration_norm, answer.force_norm),
                          m > 0 ? lambda.cwiseAbs().maxCoeff() : 0);
  for (Index a : matter) found.add(problem.s[a], length[a], lambda[a], rest[a], two_sided[at(a)]);
  return found.all();
}

}  // namespace convex::inline optimality
