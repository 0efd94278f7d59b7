#include <algorithm>
#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_algebra/cholesky.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/prox_formulas/nuclear_norm.hpp"
#include "convex/prox_formulas/spectral.hpp"

namespace convex::inline named_functions {
namespace {

Matrix unstacked(const Vector& x, Index rows) { return x.reshaped(rows, x.size() / rows); }
Vector stacked(const Matrix& X) { return X.reshaped(); }

/// {largest singular value <= radius}, whose support function is the nuclear norm.
class SpectralBall : public ConvexSet {
 public:
  SpectralBall(double radius, Index rows) : radius_(radius), rows_(rows) {}
  Index dimension() const override { return 0; }
  void require_size(Index n, const std::string& name) const override {
    if (n % rows_ != 0)
      throw InvalidInput(name + "(rows): no matrix of " + counted(rows_, "row", "rows") + " has " +
                         counted(n, "entry", "entries") + "; give a divisor");
  }
  Call call() const override { return named("spectral_ball", "radius"); }
  Call support_call() const override { return named("nuclear_norm", "weight"); }
  Facts facts() const override { return {}; }
  bool bounded() const override { return true; }
  /// A row or a column has no directions that rounding would turn.
  Index decomposed_size(Index n) const override {
    const Index columns = n / rows_;
    return std::min(rows_, columns) > 1 ? rows_ + columns : 0;
  }
  double scale() const override { return radius_; }
  Vector project(const Vector& z, const Vector&) const override {
    return stacked(prox_formulas::proj_spectral_ball(unstacked(z, rows_), radius_));
  }
  Jacobian project_jacobian(const Vector& z, const Vector&) const override {
    return Matrix::Identity(z.size(), z.size()) -
           prox_formulas::nuclear_norm_prox(unstacked(z, rows_), radius_).jacobian();
  }
  double support(const Vector& v) const override {
    return radius_ * prox_formulas::nuclear_norm_prox(unstacked(v, rows_), 0).sigma.sum();
  }
  /// U Vᵀ over the positive singular values.
  std::optional<Vector> maximiser(const Vector& v) const override {
    const prox_formulas::NuclearNormProx parts = prox_formulas::nuclear_norm_prox(unstacked(v, rows_), 0);
    const double negligible = parts.sigma.maxCoeff() * static_cast<double>(v.size()) * unit_roundoff;
    const Index rank = (parts.sigma.array() > negligible).count();
    return stacked(radius_ * parts.U.leftCols(rank) * parts.V.leftCols(rank).transpose());
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return prox_formulas::prox_nuclear_norm(z, radius_ / d[0], rows_);
  }

 private:
  Call named(const char* name, const char* number) const {
    return {name, {argument(number, radius_), argument("rows", static_cast<double>(rows_))}};
  }
  double radius_;
  Index rows_;
};

/// What -log det and its conjugate -n - log det(-S), S the symmetric part, share.
class LogDeterminant : public Atom {
 public:
  Index dimension() const override { return 0; }
  void require_size(Index n) const override { require_square("neg_log_det", n); }
  Facts facts() const override { return {.smooth = true}; }
  Index decomposed_size(Index n) const override {
    return 2 * static_cast<Index>(std::lround(std::sqrt(static_cast<double>(n))));
  }
};

struct Parts {
  Matrix symmetric;
  double skew;  ///< the norm of the rest
};

Parts parts_of(const Vector& x) {
  const Index n = prox_formulas::order_of_stacked(x);
  const Matrix X = unstacked(x, n);
  return {0.5 * (X + X.transpose()), 0.5 * (X - X.transpose()).norm()};
}

/// log det of a positive definite matrix; none of another.
std::optional<double> log_det(const Matrix& S) {
  const linear_algebra::Cholesky factor(S);
  if (!factor.is_definite()) return std::nullopt;
  return 2 * factor.diagonal().array().log().sum();
}

/// What X and its multiplier V leave of V = -sign X⁻¹, X the symmetric part of sign x positive definite, as
/// an error of X in the metric d: moved by E, X changes d X + X⁻¹ by d E + X⁻¹ E X⁻¹, entry by entry (d +
/// 1/(lambda_i lambda_j)) E_ij in the basis of its eigenvectors.
double inverse_miss(const Matrix& X, const Matrix& V, double d) {
  const linear_algebra::SymmetricEigen eigen(X);
  const Vector& lambda = eigen.values;
  if (!(lambda.minCoeff() > 0)) return infinity;
  Matrix rest = eigen.vectors.transpose() * V * eigen.vectors;
  rest.diagonal() += lambda.cwiseInverse();
  double squares = 0;
  for (Index j = 0; j < rest.cols(); ++j)
    for (Index i = 0; i < rest.rows(); ++i) {
      const double error = rest(i, j) / (d + 1 / lambda[i] / lambda[j]);
      squares += error * error;
    }
  return std::sqrt(d * squares);
}

class NegLogDet : public LogDeterminant {
 public:
  Call call() const override { return {"neg_log_det"}; }
  Function conjugate() const override;
  double value(const Vector& x) const override {
    const auto [S, skew] = parts_of(x);
    const auto log = log_det(S);
    return log && skew <= membership_tolerance * x.norm() ? -*log : infinity;
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (std::isinf(value(x))) return std::nullopt;
    const Matrix S = parts_of(x).symmetric;
    return stacked(-linear_algebra::Cholesky(S).inverse());
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    return prox_formulas::prox_log_det(z, 1 / d[0]);
  }
  /// -x⁻¹ and the skew part of Dz, which is free, where D(z - x) keeps fewer digits than an inverse does.
  std::optional<Vector> prox_covector(const Vector& x, const Vector& z, const Vector& d) const override {
    const std::optional<Vector> slope = subgradient(x);
    if (!slope || !(slope->norm() * slope->norm() * x.norm() < d[0] * z.norm())) return std::nullopt;
    const Matrix Z = unstacked(z, prox_formulas::order_of_stacked(z));
    return *slope + d[0] * stacked(0.5 * (Z - Z.transpose()));
  }
  /// The multiplier is D(z - x), whose skew part is free.
  double subgradient_miss(const Vector& x, const Vector& v, const Vector& d) const override {
    return inverse_miss(parts_of(x).symmetric, parts_of(v).symmetric, d[0]);
  }
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    return prox_formulas::log_det_prox(unstacked(z, prox_formulas::order_of_stacked(z)), 1 / d[0]).jacobian();
  }
};

class NegLogDetConjugate : public LogDeterminant {
 public:
  Call call() const override { return {"conjugate", {argument(Call{"neg_log_det"})}}; }
  Function conjugate() const override { return neg_log_det(); }
  double value(const Vector& v) const override {
    const Matrix S = parts_of(v).symmetric;
    const auto log = log_det(-S);
    return log ? -static_cast<double>(S.rows()) - *log : infinity;
  }
  /// -S⁻¹, the matrix that attains the supremum.
  std::optional<Vector> subgradient(const Vector& v) const override {
    if (std::isinf(value(v))) return std::nullopt;
    const Matrix S = parts_of(v).symmetric;
    return stacked(linear_algebra::Cholesky(-S).inverse());
  }
  /// Eigenvalues ½(lambda - sqrt(lambda² + 4/d)), by the mirror image of the prox of -log det; the skew part
  /// is free.
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    const Index n = prox_formulas::order_of_stacked(z);
    const Matrix Z = unstacked(z, n);
    return stacked(0.5 * (Z - Z.transpose())) - prox_formulas::prox_log_det(-z, 1 / d[0]);
  }
  double subgradient_miss(const Vector& x, const Vector& v, const Vector& d) const override {
    const auto [V, skew] = parts_of(v);
    return inverse_miss(-parts_of(x).symmetric, -V, d[0]) + skew / std::sqrt(d[0]);
  }
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    const Vector inverse = d.cwiseInverse();
    const Index n = prox_formulas::order_of_stacked(z);
    return Matrix::Identity(z.size(), z.size()) -
           prox_formulas::log_det_prox(unstacked(d.cwiseProduct(z), n), 1 / inverse[0]).jacobian();
  }
};

Function NegLogDet::conjugate() const { return Function(std::make_shared<NegLogDetConjugate>()); }

void require_rows(const char* maker, Index rows) {
  if (rows < 1) throw InvalidInput(std::string(maker) + "(rows): less than 1; give the rows of the matrix");
}

}  // namespace

Set spectral_ball(double radius, Index rows) {
  require_nonnegative("spectral_ball", "radius", radius);
  require_rows("spectral_ball", rows);
  return set_of(std::make_shared<SpectralBall>(radius, rows));
}

Function nuclear_norm(double weight, Index rows) {
  require_nonnegative("nuclear_norm", "weight", weight);
  require_rows("nuclear_norm", rows);
  return support_of(std::make_shared<SpectralBall>(weight, rows));
}

Function neg_log_det() { return Function(std::make_shared<NegLogDet>()); }

}  // namespace convex::inline named_functions
