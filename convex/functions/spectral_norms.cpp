#include "convex/functions/spectral_norms.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_algebra/singular_values.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/prox_formulas/norm_p.hpp"
#include "convex/prox_formulas/simplex.hpp"
#include "convex/prox_formulas/spectral.hpp"
#include "convex/prox_formulas/spectral_map.hpp"

namespace convex::inline named_functions {
namespace {

using prox_formulas::dual_exponent;

/// The order of a square matrix of n entries; 0 where there is none.
Index square_order(Index n) {
  const auto order = static_cast<Index>(std::lround(std::sqrt(static_cast<double>(n))));
  return order * order == n ? order : 0;
}

/// {|sigma(X)|_q <= radius}; its support function is radius times the norm of the dual exponent.
class SchattenBall : public ConvexSet {
 public:
  SchattenBall(double q, Index rows, double radius) : q_(q), rows_(rows), radius_(radius) {}
  Index dimension() const override { return 0; }
  void require_size(Index n, const std::string& name) const override {
    if (rows_ == 0 && square_order(n) == 0)
      throw InvalidInput(name + "(rows): no square matrix has " + counted(n, "entry", "entries") +
                         "; give its rows");
    if (rows_ > 0 && n % rows_ != 0)
      throw InvalidInput(name + "(rows): no matrix of " + counted(rows_, "row", "rows") + " has " +
                         counted(n, "entry", "entries") + "; give a divisor");
  }
  Call call() const override { return named("schatten_ball", q_, "radius"); }
  Call support_call() const override { return named("schatten", dual_exponent(q_), "weight"); }
  Facts facts() const override { return {}; }
  bool bounded() const override { return true; }
  Index decomposed_size(Index n) const override {
    const Index rows = rows_ > 0 ? rows_ : square_order(n), columns = rows > 0 ? n / rows : 0;
    return std::min(rows, columns) > 1 ? rows + columns : 0;
  }
  double scale() const override { return radius_; }
  Vector project(const Vector& z, const Vector&) const override {
    const Matrix Z = matrix(z);
    if (prox_formulas::norm_p(linear_algebra::SingularValues(Z).sigma, q_) <= radius_) return z;
    return prox_formulas::map_of_singular_values(
               Z, [&](const Vector& s) { return prox_formulas::proj_ball_p(s, radius_, q_); })
        .reshaped();
  }
  Jacobian project_jacobian(const Vector& z, const Vector&) const override {
    const double p = dual_exponent(q_);
    return Matrix::Identity(z.size(), z.size()) -
           prox_formulas::jacobian_of_singular_values(
               matrix(z), [&](const Vector& s) { return prox_formulas::prox_norm_p(s, radius_, p); },
               [&](const Vector& s) { return prox_formulas::prox_norm_p_jacobian(s, radius_, p); });
  }
  double support(const Vector& v) const override {
    return radius_ *
           prox_formulas::norm_p(linear_algebra::SingularValues(matrix(v)).sigma, dual_exponent(q_));
  }
  /// U diag((sigma/|sigma|_p)^(p-1)) Vᵀ; at p = 1 over the singular values that are not rounding, at p = inf
  /// the largest alone.
  std::optional<Vector> maximiser(const Vector& v) const override {
    const double p = dual_exponent(q_);
    const auto slopes = [&](const Vector& s) {
      Vector slope = Vector::Zero(s.size());
      const double size = prox_formulas::norm_p(s, p), top = s.size() > 0 ? s[0] : 0;
      if (!(size > 0)) return slope;
      if (std::isinf(p))
        slope[0] = radius_;
      else if (p == 1)
        slope = (s.array() > top * static_cast<double>(v.size()) * unit_roundoff).cast<double>() * radius_;
      else
        slope = radius_ * (s / size).array().pow(p - 1);
      return slope;
    };
    return prox_formulas::map_of_singular_values(matrix(v), slopes).reshaped();
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return prox_formulas::map_of_singular_values(matrix(z),
                                                 [&](const Vector& s) {
                                                   return prox_formulas::prox_norm_p(s, radius_ / d[0],
                                                                                     dual_exponent(q_));
                                                 })
        .reshaped();
  }

 private:
  Matrix matrix(const Vector& x) const {
    const Index rows = rows_ > 0 ? rows_ : square_order(x.size());
    return x.reshaped(rows, rows > 0 ? x.size() / rows : 0);
  }
  Call named(const char* name, double exponent, const char* number) const {
    return {
        name,
        {argument("p", exponent), argument("rows", static_cast<double>(rows_)), argument(number, radius_)}};
  }
  double q_;
  Index rows_;
  double radius_;
};

/// {symmetric part positive semidefinite of trace `total`}.
class Spectraplex : public ConvexSet {
 public:
  explicit Spectraplex(double total) : total_(total) {}
  Index dimension() const override { return 0; }
  void require_size(Index n, const std::string& name) const override {
    if (n == 0 || square_order(n) == 0)
      throw InvalidInput(name + ": no square matrix has " + counted(n, "entry", "entries") + "; give n*n");
  }
  Call call() const override { return {"spectraplex", {argument("total", total_)}}; }
  Call support_call() const override { return {"max_eigenvalue", {argument("weight", total_)}}; }
  Facts facts() const override { return {}; }
  bool bounded() const override { return false; }
  Index decomposed_size(Index n) const override { return 2 * square_order(n); }
  bool recedes(const Vector& d) const override { return (matrix(d) + matrix(d).transpose()).isZero(0); }
  double scale() const override { return total_; }
  Vector project(const Vector& z, const Vector&) const override {
    const Matrix Z = matrix(z);
    return (0.5 * (Z - Z.transpose()) +
            prox_formulas::map_of_eigenvalues(
                Z, [&](const Vector& l) { return prox_formulas::proj_simplex(l, total_); }))
        .reshaped();
  }
  Jacobian project_jacobian(const Vector& z, const Vector&) const override {
    const auto phi = [&](const Vector& l) { return prox_formulas::prox_max(l, total_); };
    return Matrix::Identity(z.size(), z.size()) -
           prox_formulas::jacobian_of_eigenvalues(matrix(z), phi, [&](const Vector& l) {
             return prox_formulas::prox_max_jacobian(l, total_, Vector::Ones(l.size()));
           });
  }
  double support(const Vector& v) const override {
    const Matrix V = matrix(v);
    if (0.5 * (V - V.transpose()).stableNorm() > membership_tolerance * V.stableNorm()) return infinity;
    return total_ * linear_algebra::eigenvalues(0.5 * (V + V.transpose())).maxCoeff();
  }
  /// Eigenvalues are rounded as the largest of them is.
  Value support_value(const Vector& v) const override {
    return sum_of_terms(support(v), total_ * static_cast<double>(v.size()) * v.stableNorm());
  }
  std::optional<Vector> maximiser(const Vector& v) const override {
    if (std::isinf(support(v))) return std::nullopt;
    const Matrix V = matrix(v);
    const linear_algebra::SymmetricEigen eigen(0.5 * (V + V.transpose()));
    const Vector top = eigen.vectors.col(eigen.vectors.cols() - 1);
    return (total_ * top * top.transpose()).reshaped();
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return prox_formulas::map_of_eigenvalues(
               matrix(z), [&](const Vector& l) { return prox_formulas::prox_max(l, total_ / d[0]); })
        .reshaped();
  }

 private:
  static Matrix matrix(const Vector& x) {
    const Index n = prox_formulas::order_of_stacked(x);
    return x.reshaped(n, n);
  }
  double total_;
};

std::shared_ptr<const ConvexSet> checked_ball(const char* maker, double p, double q, Index rows,
                                              const char* parameter, double radius) {
  if (!(p >= 1))
    throw InvalidInput(std::string(maker) + "(p): less than 1; it would be no norm, give 1 or more, or inf");
  if (rows < 0) throw InvalidInput(std::string(maker) + "(rows): negative; give the rows of the matrix");
  require_nonnegative(maker, parameter, radius);
  return std::make_shared<SchattenBall>(q, rows, radius);
}

}  // namespace

Function schatten(double p, Index rows, double weight) {
  return support_of(checked_ball("schatten", p, dual_exponent(p), rows, "weight", weight));
}

Set schatten_ball(double p, Index rows, double radius) {
  return set_of(checked_ball("schatten_ball", p, p, rows, "radius", radius));
}

Function max_eigenvalue(double weight) {
  require_nonnegative("max_eigenvalue", "weight", weight);
  return support_of(std::make_shared<Spectraplex>(weight));
}

Set spectraplex(double total) {
  require_nonnegative("spectraplex", "total", total);
  return set_of(std::make_shared<Spectraplex>(total));
}

}  // namespace convex::inline named_functions
