#include "convex/nearest_point/proof/enclosure.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>

#include "convex/nearest_point/proof/rounding_bounds.hpp"
#include "convex/nearest_point/proof/sparse_enclosure.hpp"

namespace convex {
namespace {

/// Dense matrices of X and of the active rows are made up to these sizes.
constexpr Index largest_dimension = 1500, most_active_entries = largest_dimension * largest_dimension;

/// A metric seen through X ≈ F⁻¹: A' = X A Xᵀ = I + Δ with |Δ|₂ <= delta < 1.
struct Preconditioned {
  bool is_diagonal = false;
  Matrix A, X;  // dense
  Vector a, x;  // the diagonals, when A is diagonal
  double delta = 1;

  Vector times_X(const Vector& c) const { return is_diagonal ? Vector(x.cwiseProduct(c)) : Vector(X * c); }
  Vector times_X_transposed(const Vector& p) const {
    return is_diagonal ? Vector(x.cwiseProduct(p)) : Vector(X.transpose() * p);
  }
  /// |X| c for c >= 0.
  Vector spread(const Vector& c) const {
    return is_diagonal ? Vector(x.cwiseAbs().cwiseProduct(c)) : Vector(X.cwiseAbs() * c);
  }
  Vector times_A(const Vector& q) const { return is_diagonal ? Vector(a.cwiseProduct(q)) : Vector(A * q); }
  Vector magnitude_times_A(const Vector& q) const {
    return is_diagonal ? Vector(a.cwiseProduct(q)) : Vector(A.cwiseAbs() * q);
  }
  Index dimension() const { return is_diagonal ? a.size() : A.rows(); }
};

std::optional<Preconditioned> preconditioned(const Metric& metric) {
  const Index n = metric.dimension();
  Preconditioned P;
  P.is_diagonal = metric.kind() == MetricKind::diagonal || metric.kind() == MetricKind::identity;
  if (P.is_diagonal) {
    P.a = metric.diagonal();
    if (!is_ordinary(P.a)) return std::nullopt;
    P.x = P.a.cwiseSqrt().cwiseInverse();
    P.delta = 0;
    for (Index i = 0; i < n; ++i)
      P.delta = std::max(P.delta, above(std::abs(P.x[i] * P.a[i] * P.x[i] - 1) + gamma(3)));
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
  const Vector rounding =
      gamma(n) * (size * (P.A.cwiseAbs() * outer) + Y.cwiseAbs() * outer) + 2 * unit_roundoff * ones;
  // Δ is symmetric: |Δ|₂ is at most its largest row sum.
  P.delta = above((S.cwiseAbs() * ones + rounding).maxCoeff());
  return P;
}

/// The active rows seen through X and T ≈ R⁻¹: Z = X U_Wᵀ T, ZᵀZ = I + Δ with |Δ|₂ <= delta < 1.
struct Active {
  Matrix U;  // the rows, k×n
  Matrix T, Z;
  double delta = 0;
};

/// |M|₂ <= sqrt(|M|₁ |M|_∞) for M >= 0 given by its row and column sums.
double matrix_norm(const Vector& row_sums, const Vector& column_sums) {
  return row_sums.size() == 0 || column_sums.size() == 0
             ? 0
             : above(std::sqrt(row_sums.maxCoeff() * column_sums.maxCoeff()));
}

/// VᵀV; the half that is computed stands for the other.
Matrix gram(const Matrix& V) {
  Matrix G = Matrix::Zero(V.cols(), V.cols());
  G.selfadjointView<Eigen::Lower>().rankUpdate(V.transpose());
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
  const Eigen::LLT<Matrix> normal(gram(V));
  if (normal.info() == Eigen::Success &&
      (normal.matrixLLT().diagonal().array() > well_conditioned * length.array()).all()) {
    normal.matrixU().solveInPlace(T);
    return true;
  }
  const Eigen::HouseholderQR<Matrix> factor(V);
  const Matrix R = factor.matrixQR().topRows(V.cols());
  if (!(R.diagonal().cwiseAbs().minCoeff() > 0)) return false;
  R.triangularView<Eigen::Upper>().solveInPlace(T);
  return true;
}

std::optional<Active> active_rows(const NearestPointProblem& problem, const Preconditioned& P,
                                  const std::vector<Index>& rows) {
  const Index n = P.dimension(), k = static_cast<Index>(rows.size());
  if (k > n) return std::nullopt;
  Active active;
  active.U.resize(k, n);
  for (Index r = 0; r < k; ++r) active.U.row(r) = problem.U.row(rows[static_cast<std::size_t>(r)]);
  if (k == 0) return active;
  if (!is_ordinary(active.U)) return std::nullopt;
  const Matrix V =
      P.is_diagonal ? Matrix(P.x.asDiagonal() * active.U.transpose()) : Matrix(P.X * active.U.transpose());
  if (!find_orthogonalizer(V, active.T)) return std::nullopt;
  keep_ordinary(active.T);
  if (!is_ordinary(active.T)) return std::nullopt;
  active.Z = V * active.T.triangularView<Eigen::Upper>();

  // Ẑ - Z <= gamma_n |X| |Uᵀ| |T| + gamma_k |V| |T|, entry by entry.
  const Matrix T = active.T.cwiseAbs(), U = active.U.cwiseAbs(), W = V.cwiseAbs();
  const Vector inner = T * Vector::Ones(k);
  const Vector rows_of_error = gamma(n) * P.spread(U.transpose() * inner) + gamma(k) * (W * inner);
  const Vector outer =
      P.is_diagonal ? Vector(P.x.cwiseAbs()) : Vector(P.X.cwiseAbs().transpose() * Vector::Ones(n));
  const Vector columns_of_error =
      T.transpose() * (gamma(n) * (U * outer) + gamma(k) * (W.transpose() * Vector::Ones(n)));
  const double error = matrix_norm(rows_of_error, columns_of_error);

  Matrix S = gram(active.Z);
  S.diagonal().array() -= 1;
  const Matrix size = active.Z.cwiseAbs();
  const Vector rounding =
      gamma(n) * (size.transpose() * (size * Vector::Ones(k))) + 2 * unit_roundoff * Vector::Ones(k);
  const double computed = above((S.cwiseAbs() * Vector::Ones(k) + rounding).maxCoeff());
  active.delta = above(computed + 2 * std::sqrt(1 + computed) * error + error * error);
  return active;
}

/// What is known of the point that the active rows define: q + dq within `radius` in the metric, its
/// multipliers lambda + dlambda within theirs.
struct HeldPoint {
  Vector q, dq, lambda, dlambda, multiplier_radius;
  double radius = 0;
};

/// r1 = z + U_Wᵀlambda - A q and r2 = s_W - U_W q at q + dq and lambda + dlambda, with bounds.
struct KktResidual {
  Vector r1, r1_radius, r2, r2_radius;
};

KktResidual kkt_residual(const NearestPointProblem& problem, const Preconditioned& P, const Active& active,
                         const std::vector<Index>& rows, const HeldPoint& point) {
  const Index n = P.dimension(), k = active.U.rows();
  KktResidual found;
  if (P.is_diagonal) {
    found.r1.resize(n);
    found.r1_radius.resize(n);
    for (Index i = 0; i < n; ++i) {
      CompensatedSum sum;
      sum.add(problem.z[i], 1);
      for (Index r = 0; r < k; ++r) {
        sum.add(active.U(r, i), point.lambda[r]);
        sum.add(active.U(r, i), point.dlambda[r]);
      }
      sum.add(-P.a[i], point.q[i]);
      sum.add(-P.a[i], point.dq[i]);
      found.r1[i] = sum.result().value;
      found.r1_radius[i] = sum.result().radius;
    }
  } else {
    CompensatedSums balance(n);
    balance.add(problem.z.data(), 1);
    Vector row(n);
    for (Index r = 0; r < k; ++r) {
      row = active.U.row(r);
      balance.add(row.data(), point.lambda[r]);
      balance.add(row.data(), point.dlambda[r]);
    }
    for (Index j = 0; j < n; ++j) {
      balance.add(P.A.col(j).data(), -point.q[j]);
      balance.add(P.A.col(j).data(), -point.dq[j]);
    }
    balance.result(found.r1, found.r1_radius);
  }
  found.r2.resize(k);
  found.r2_radius.resize(k);
  for (Index r = 0; r < k; ++r) {
    CompensatedSum sum;
    sum.add(problem.s[rows[static_cast<std::size_t>(r)]], 1);
    for (Index i = 0; i < n; ++i) {
      sum.add(-active.U(r, i), point.q[i]);
      sum.add(-active.U(r, i), point.dq[i]);
    }
    found.r2[r] = sum.result().value;
    found.r2_radius[r] = sum.result().radius;
  }
  return found;
}

/// One step of refinement, kept apart from q and lambda.
void correct(const Preconditioned& P, const Active& active, const KktResidual& residual, HeldPoint& point) {
  const Vector g = P.times_X(residual.r1);
  if (active.U.rows() == 0) {
    point.dq += P.times_X_transposed(g);
    return;
  }
  const Vector c = active.T.transpose() * residual.r2;
  const Vector y = c - active.Z.transpose() * g;
  point.dq += P.times_X_transposed(g + active.Z * y);
  point.dlambda += active.T * y;
}

/// Bounds on the error of the held point from its residual.
void enclose(const Preconditioned& P, const Active& active, const KktResidual& residual, HeldPoint& point) {
  const Index n = P.dimension(), k = active.U.rows();
  const double force = above(norm_above(P.times_X(residual.r1)) +
                             norm_above(P.spread(gamma(n) * residual.r1.cwiseAbs() + residual.r1_radius)));
  double gap = 0;
  if (k > 0) {
    const Matrix T = active.T.cwiseAbs();
    gap = above(norm_above(active.T.transpose() * residual.r2) +
                norm_above(T.transpose() * (gamma(k) * residual.r2.cwiseAbs() + residual.r2_radius)));
  }
  const double low_A = below(1 - P.delta), low_Z = below(1 - active.delta);
  point.radius = above(force / std::sqrt(low_A) + gap * std::sqrt((1 + P.delta) / low_Z));
  const double y = above((1 + P.delta) / low_Z * (gap + std::sqrt(1 + active.delta) / low_A * force));
  point.multiplier_radius.resize(k);
  for (Index r = 0; r < k; ++r) point.multiplier_radius[r] = above(norm_above(active.T.row(r)) * y);
}

bool multipliers_are_positive(const NearestPointProblem& problem, const std::vector<Index>& rows,
                              const HeldPoint& point) {
  std::vector<bool> two_sided(static_cast<std::size_t>(problem.rows()), false);
  for (Index a : problem.two_sided) two_sided[static_cast<std::size_t>(a)] = true;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (two_sided[static_cast<std::size_t>(rows[r])]) continue;
    const auto k = static_cast<Index>(r);
    if (!(below(point.lambda[k] + point.dlambda[k]) > above(point.multiplier_radius[k]))) return false;
  }
  return true;
}

bool slacks_are_positive(const NearestPointProblem& problem, const Preconditioned& P,
                         const std::vector<Index>& rows, const HeldPoint& point) {
  const Index n = P.dimension();
  std::vector<bool> held(static_cast<std::size_t>(problem.rows()), false);
  for (Index a : rows) held[static_cast<std::size_t>(a)] = true;
  for (Index a : problem.two_sided)
    if (!held[static_cast<std::size_t>(a)]) return false;  // it depends on the others: not for doubles to say
  // |q*_i - (q + dq)_i| <= radius sqrt((A⁻¹)_ii), and A⁻¹ = Xᵀ A'⁻¹ X.
  Vector reach(n);
  for (Index i = 0; i < n; ++i)
    reach[i] = (P.is_diagonal ? std::abs(P.x[i]) : norm_above(P.X.col(i))) * point.radius;
  reach *= above(1 / std::sqrt(below(1 - P.delta)));
  const Vector loose = gamma(n + 1) * point.q.cwiseAbs() + above(1) * point.dq.cwiseAbs() + reach;
  Vector row(n);
  for (Index a = 0; a < problem.rows(); ++a) {
    if (held[static_cast<std::size_t>(a)]) continue;
    problem.U.copy_row(a, row);
    const double s = problem.s[a];
    if (row.dot(point.q) - s > above(row.cwiseAbs().dot(loose) + gamma(n + 1) * std::abs(s))) continue;
    CompensatedSum sum;
    sum.add(-s, 1);
    for (Index i = 0; i < n; ++i) {
      sum.add(row[i], point.q[i]);
      sum.add(row[i], point.dq[i]);
    }
    const Enclosed slack = sum.result();
    if (!(below(slack.value) > above(slack.radius + row.cwiseAbs().dot(reach)))) return false;
  }
  return true;
}

/// The basis of a solution, or, where its method gives none, the rows with a multiplier.
std::vector<Index> held_rows(const Solution& solution) {
  if (!solution.basis.empty()) return solution.basis;
  std::vector<Index> rows;
  for (Index a = 0; a < solution.lambda.size(); ++a)
    if (solution.lambda[a] != 0) rows.push_back(a);
  return rows;
}

/// At least ||dq||_A.
double length_above(const Preconditioned& P, const Vector& dq) {
  const Index n = P.dimension();
  const double largest = dq.size() > 0 ? dq.cwiseAbs().maxCoeff() : 0;
  if (!(largest > 0)) return 0;
  const Vector unit = dq / largest, size = unit.cwiseAbs();
  const Vector product = P.times_A(unit);
  const double square = unit.dot(product) + gamma(n) * size.dot(product.cwiseAbs()) +
                        above(2 * gamma(n) * size.dot(P.magnitude_times_A(size)));
  return above(above(largest) * std::sqrt(above(std::max(0.0, square))));
}

}  // namespace

std::optional<double> enclosed_error(const NearestPointProblem& problem, const Solution& solution) {
  const std::vector<Index> held = held_rows(solution);
  const Index k = static_cast<Index>(held.size());
  if (solution.q.size() != problem.dimension() || !is_ordinary(problem.z) || !is_ordinary(problem.s) ||
      !is_ordinary(solution.q) || !is_ordinary(solution.lambda))
    return std::nullopt;
  if (problem.U.is_sparse() ? !is_ordinary(Eigen::Map<const Vector>(problem.U.sparse().valuePtr(),
                                                                    problem.U.sparse().nonZeros()))
                            : !is_ordinary(problem.U.dense()))
    return std::nullopt;
  const Index n = problem.dimension();
  const bool is_diagonal =
      problem.A.kind() == MetricKind::diagonal || problem.A.kind() == MetricKind::identity;
  if ((n > largest_dimension && !is_diagonal) || k * n > most_active_entries)
    return sparse_enclosed_error(problem, solution, held);
  const auto P = preconditioned(problem.A);
  if (!P || !(P->delta < 0.5)) return std::nullopt;
  const auto active = active_rows(problem, *P, held);
  if (!active || !(active->delta < 0.5)) return std::nullopt;
  HeldPoint point{solution.q, Vector::Zero(problem.dimension()), Vector(k), Vector::Zero(k), {}, 0};
  for (Index r = 0; r < k; ++r) point.lambda[r] = solution.lambda[held[static_cast<std::size_t>(r)]];
  correct(*P, *active, kkt_residual(problem, *P, *active, held, point), point);
  // What is too small to matter is left to the bound.
  point.dq = (point.dq.array().abs() >= smallest_ordinary).select(point.dq, 0.0);
  point.dlambda = (point.dlambda.array().abs() >= smallest_ordinary).select(point.dlambda, 0.0);
  enclose(*P, *active, kkt_residual(problem, *P, *active, held, point), point);
  if (!std::isfinite(point.radius) || !multipliers_are_positive(problem, held, point) ||
      !slacks_are_positive(problem, *P, held, point))
    return std::nullopt;
  return above(length_above(*P, point.dq) + point.radius);
}

}  // namespace convex
