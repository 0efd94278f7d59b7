#include "convex/nearest_point/proof/held_point.hpp"

#include <cmath>
#include <limits>

#include "convex/linear_algebra/cholesky.hpp"
#include "convex/linear_algebra/householder.hpp"

namespace convex::inline proof {

Vector RadiiOf::rows_times(const std::vector<Index>& rows, const Vector& x) const {
  Vector found(static_cast<Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) found[static_cast<Index>(k)] = row_times(rows[k], x);
  return found;
}

Vector RadiiOf::rows_transposed_times(const std::vector<Index>& rows, const Vector& y, Index n) const {
  Vector found = Vector::Zero(n);
  if (any())
    for (std::size_t k = 0; k < rows.size(); ++k)
      found += radii_->U.row(rows[k]).transpose() * y[static_cast<Index>(k)];
  return found;
}

std::optional<Preconditioned> preconditioned(const Metric& metric, const RadiiOf& radii) {
  const Index n = metric.dimension();
  Preconditioned P;
  P.is_diagonal = is_diagonal(metric);
  if (P.is_diagonal) {
    P.a = metric.diagonal();
    if (!is_ordinary(P.a)) return std::nullopt;
    P.x = P.a.cwiseSqrt().cwiseInverse();
    P.delta = 0;
    for (Index i = 0; i < n; ++i)
      P.delta = std::max(P.delta, above(std::abs(P.x[i] * P.a[i] * P.x[i] - 1) + gamma(3)));
    // |X Â Xᵀ|, by its largest row sum.
    if (radii.any()) P.delta = above(P.delta + P.x.cwiseProduct(radii.A_times(P.x)).maxCoeff());
    return P;
  }
  P.A = metric.kind() == MetricKind::dense ? metric.dense_gram() : Matrix(metric.sparse_gram());
  P.X = Matrix::Identity(n, n);
  metric.whiten_in_place(P.X);
  keep_ordinary(P.X);
  if (!is_ordinary(P.A) || !is_ordinary(P.X)) return std::nullopt;
  // Sums in any order, with terms that are 0 left out, have the same bounds.
  Matrix Y, S;
  if (P.X.isLowerTriangular(0)) {
    Y = P.X.triangularView<Eigen::Lower>() * P.A;
    S = Y * P.X.transpose().triangularView<Eigen::Upper>();
  } else {
    Y = P.X * P.A;
    S = Y * P.X.transpose();
  }
  S.diagonal().array() -= 1;
  const Vector ones = Vector::Ones(n);
  const Matrix size = P.X.cwiseAbs();
  const Vector outer = size.transpose() * ones;
  Vector rounding =
      gamma(n) * (size * (P.A.cwiseAbs() * outer) + Y.cwiseAbs() * outer) + 2 * unit_roundoff * ones;
  if (radii.any()) rounding += size * radii.A_times(outer);
  // Δ is symmetric: |Δ|₂ is at most its largest row sum.
  P.delta = above((S.cwiseAbs() * ones + rounding).maxCoeff());
  return P;
}

namespace {

/// |M|₂ <= sqrt(|M|₁ |M|_∞) for M >= 0 given by its row and column sums.
double matrix_norm(const Vector& row_sums, const Vector& column_sums) {
  return row_sums.size() == 0 || column_sums.size() == 0
             ? 0
             : above(std::sqrt(row_sums.maxCoeff() * column_sums.maxCoeff()));
}

/// VᵀV; the half that is computed stands for the other.
Matrix gram(const Matrix& V) {
  Matrix G = Matrix::Zero(V.cols(), V.cols());
  if (V.cols() > 0) G.selfadjointView<Eigen::Lower>().rankUpdate(V.transpose());
  G.triangularView<Eigen::StrictlyUpper>() = G.transpose();
  return G;
}

/// T near R⁻¹ for V = QR: from VᵀV where that is well conditioned, which is the cheaper way, else by
/// reflections. False when V has dependent columns. Nothing is trusted of it.
bool find_orthogonalizer(const Matrix& V, Matrix& T) {
  T = Matrix::Identity(V.cols(), V.cols());
  constexpr double well_conditioned = 1e-4;  // of the diagonal of R: VᵀV then keeps half of the digits
  const Vector length = V.colwise().norm();
  if (!(length.minCoeff() > 0)) return false;
  const linear_algebra::Cholesky normal(gram(V));
  if (normal.is_definite() && (normal.diagonal().array() > well_conditioned * length.array()).all()) {
    normal.solve_upper_in_place(T);
    return true;
  }
  const linear_algebra::Householder factor(V);
  if (!(factor.R().diagonal().cwiseAbs().minCoeff() > 0)) return false;
  factor.solve_R_in_place(T);
  return true;
}

}  // namespace

KktResidual kkt_residual(const NearestPointProblem& problem, const RadiiOf& radii,
                         const std::vector<Index>& rows, const HeldPoint& point) {
  const Index n = problem.dimension(), k = static_cast<Index>(rows.size());
  KktResidual found{Vector(n), Vector(n), Vector(k), Vector(k)};
  const auto add = [](CompensatedSum& sum, double factor, double x, double dx) {
    sum.add(factor, x);
    sum.add(factor, dx);
  };
  if (problem.A.kind() == MetricKind::dense) {
    CompensatedSums balance(n);
    balance.add(problem.z.data(), 1);
    Vector row(n);
    for (Index r = 0; r < k; ++r) {
      problem.U.copy_row(rows[at(r)], row);
      balance.add(row.data(), point.lambda[r]);
      balance.add(row.data(), point.dlambda[r]);
    }
    for (Index j = 0; j < n; ++j) {
      const double* const column = problem.A.dense_gram().col(j).data();
      balance.add(column, -point.q[j]);
      balance.add(column, -point.dq[j]);
    }
    balance.result(found.r1, found.r1_radius);
  } else {
    std::vector<CompensatedSum> balance(at(n));
    for (Index i = 0; i < n; ++i) balance[at(i)].add(problem.z[i], 1);
    for (Index r = 0; r < k; ++r)
      problem.U.for_each_entry(
          rows[at(r)], [&](Index i, double u) { add(balance[at(i)], u, point.lambda[r], point.dlambda[r]); });
    for (Index j = 0; j < n; ++j) {
      if (problem.A.kind() != MetricKind::sparse) {
        add(balance[at(j)], -problem.A.diagonal()[j], point.q[j], point.dq[j]);
        continue;
      }
      for (SparseMatrix::InnerIterator it(problem.A.sparse_gram(), j); it; ++it)
        add(balance[at(it.row())], -it.value(), point.q[j], point.dq[j]);
    }
    for (Index i = 0; i < n; ++i) {
      const Enclosed sum = balance[at(i)].result();
      found.r1[i] = sum.value;
      found.r1_radius[i] = sum.radius;
    }
  }
  for (Index r = 0; r < k; ++r) {
    CompensatedSum gap;
    gap.add(problem.s[rows[at(r)]], 1);
    problem.U.for_each_entry(rows[at(r)], [&](Index i, double u) { add(gap, -u, point.q[i], point.dq[i]); });
    found.r2[r] = gap.result().value;
    found.r2_radius[r] = gap.result().radius;
  }
  if (!radii.any()) return found;
  const Vector size = above(1) * (point.q.cwiseAbs() + point.dq.cwiseAbs()),
               weights = above(1) * (point.lambda.cwiseAbs() + point.dlambda.cwiseAbs());
  found.r1_radius += radii.z(n) + radii.A_times(size) + radii.rows_transposed_times(rows, weights, n);
  for (Index r = 0; r < k; ++r) {
    const Index a = rows[at(r)];
    found.r2_radius[r] += radii.s(a) + radii.row_times(a, size);
  }
  return found;
}

namespace {

/// One step of refinement, kept apart from q and lambda.
void correct(HeldRows& held, const KktResidual& residual) {
  const Preconditioned& P = held.P;
  HeldPoint& point = held.point;
  const Vector g = P.times_X(residual.r1);
  if (held.U.rows() == 0) {
    point.dq += P.times_X_transposed(g);
    return;
  }
  const Vector c = held.T.transpose() * residual.r2;
  const Vector y = c - held.Z.transpose() * g;
  point.dq += P.times_X_transposed(g + held.Z * y);
  point.dlambda += held.T * y;
}

/// Bounds on the error of the held point from its residual.
void enclose(HeldRows& held, const KktResidual& residual) {
  const Preconditioned& P = held.P;
  HeldPoint& point = held.point;
  const Index n = P.dimension(), k = held.U.rows();
  const double imbalance =
      above(norm_above(P.times_X(residual.r1)) +
            norm_above(P.spread(gamma(n) * residual.r1.cwiseAbs() + residual.r1_radius)));
  double gap = 0;
  if (k > 0) {
    const Matrix T = held.T.cwiseAbs();
    gap = above(norm_above(held.T.transpose() * residual.r2) +
                norm_above(T.transpose() * (gamma(k) * residual.r2.cwiseAbs() + residual.r2_radius)));
  }
  const double low_A = below(1 - P.delta), low_Z = below(1 - held.delta);
  point.radius = above(imbalance / std::sqrt(low_A) + gap * std::sqrt((1 + P.delta) / low_Z));
  const double y = above((1 + P.delta) / low_Z * (gap + std::sqrt(1 + held.delta) / low_A * imbalance));
  point.multiplier_radius.resize(k);
  for (Index r = 0; r < k; ++r) point.multiplier_radius[r] = above(norm_above(held.T.row(r)) * y);
}

/// Fills in T, Z and delta of the rows; false when they are dependent, for all that doubles tell.
bool orthogonalise(HeldRows& held) {
  const Preconditioned& P = held.P;
  const Index n = P.dimension(), k = held.U.rows();
  if (k == 0) return true;
  if (k > n || !is_ordinary(held.U)) return false;
  const Matrix V =
      P.is_diagonal ? Matrix(P.x.asDiagonal() * held.U.transpose()) : Matrix(P.X * held.U.transpose());
  if (!find_orthogonalizer(V, held.T)) return false;
  keep_ordinary(held.T);
  if (!is_ordinary(held.T)) return false;
  held.Z = V * held.T.triangularView<Eigen::Upper>();

  // Ẑ - Z <= |X| (gamma_n |Uᵀ| + Ûᵀ) |T| + gamma_k |V| |T|, entry by entry.
  const Matrix T = held.T.cwiseAbs(), U = held.U.cwiseAbs(), W = V.cwiseAbs();
  const Vector inner = T * Vector::Ones(k);
  const Vector rows_of_error = gamma(n) * P.spread(U.transpose() * inner) + gamma(k) * (W * inner) +
                               P.spread(held.radii.rows_transposed_times(held.rows, inner, n));
  const Vector outer =
      P.is_diagonal ? Vector(P.x.cwiseAbs()) : Vector(P.X.cwiseAbs().transpose() * Vector::Ones(n));
  const Vector columns_of_error =
      T.transpose() * (gamma(n) * (U * outer) + gamma(k) * (W.transpose() * Vector::Ones(n)) +
                       held.radii.rows_times(held.rows, outer));
  const double error = matrix_norm(rows_of_error, columns_of_error);

  Matrix S = gram(held.Z);
  S.diagonal().array() -= 1;
  const Matrix size = held.Z.cwiseAbs();
  const Vector rounding =
      gamma(n) * (size.transpose() * (size * Vector::Ones(k))) + 2 * unit_roundoff * Vector::Ones(k);
  const double computed = above((S.cwiseAbs() * Vector::Ones(k) + rounding).maxCoeff());
  held.delta = above(computed + 2 * std::sqrt(1 + computed) * error + error * error);
  return held.delta < 0.5;
}

}  // namespace

std::optional<HeldRows> hold(const NearestPointProblem& problem, const RadiiOf& radii,
                             const Preconditioned& P, const std::vector<Index>& rows, const Vector& q,
                             const Vector& lambda) {
  const auto k = static_cast<Index>(rows.size());
  HeldRows held{problem, radii, P, rows, Matrix(k, P.dimension()), {}, {}};
  for (Index r = 0; r < k; ++r) held.U.row(r) = problem.U.row(rows[at(r)]);
  if (!orthogonalise(held)) return std::nullopt;
  HeldPoint& point = held.point;
  point = {q, Vector::Zero(problem.dimension()), lambda(rows), Vector::Zero(k), {}, 0};
  // Corrections until they no longer shrink the radius: where rows are open the bound takes its root.
  constexpr int most_corrections = 4;
  constexpr double still_shrinks = 0.25;
  KktResidual residual = kkt_residual(problem, radii, rows, point);
  HeldPoint best = point;
  best.radius = std::numeric_limits<double>::infinity();
  for (int step = 0; step < most_corrections; ++step) {
    correct(held, residual);
    // What is too small to matter is left to the bound.
    point.dq = (point.dq.array().abs() >= smallest_ordinary).select(point.dq, 0.0);
    point.dlambda = (point.dlambda.array().abs() >= smallest_ordinary).select(point.dlambda, 0.0);
    residual = kkt_residual(problem, radii, rows, point);
    enclose(held, residual);
    const bool shrinks = point.radius < still_shrinks * best.radius;
    if (point.radius < best.radius || step == 0) best = point;
    if (!shrinks) break;
  }
  point = std::move(best);
  return std::isfinite(point.radius) ? std::optional(std::move(held)) : std::nullopt;
}

double unbalanced_above(const HeldRows& held) {
  HeldPoint point = held.point;
  point.dq.setZero();
  const KktResidual residual = kkt_residual(held.problem, held.radii, held.rows, point);
  return dual_length_above(held.P, residual.r1, residual.r1_radius);
}

double length_above(const Preconditioned& P, const RadiiOf& radii, const Vector& dq) {
  const Index n = P.dimension();
  const double largest = dq.size() > 0 ? dq.cwiseAbs().maxCoeff() : 0;
  if (!(largest > 0)) return 0;
  const Vector unit = dq / largest, size = unit.cwiseAbs();
  const Vector product = P.times_A(unit);
  const double square = unit.dot(product) + gamma(n) * size.dot(product.cwiseAbs()) +
                        above(2 * gamma(n) * size.dot(P.magnitude_times_A(size)));
  // Two metrics within 1 ± δ of the same differ by this much.
  const double stretch = radii.any() ? (1 + P.delta) / below(1 - P.delta) : 1;
  return above(above(largest) * std::sqrt(above(std::max(0.0, square) * stretch)));
}

double dual_length_above(const Preconditioned& P, const Vector& c, const Vector& spread) {
  const Vector moved = gamma(P.dimension()) * c.cwiseAbs() + above(1) * spread;
  return above((norm_above(P.times_X(c)) + norm_above(P.spread(moved))) / std::sqrt(below(1 - P.delta)));
}

}  // namespace convex::inline proof
