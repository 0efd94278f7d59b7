#include "convex/functions/quadratic.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "convex/composite/atom.hpp"
#include "convex/composite/closed_form.hpp"
#include "convex/composite/metric_difference.hpp"
#include "convex/counted.hpp"
#include "convex/functions/inverse_form.hpp"
#include "convex/functions/semidefinite.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_algebra/cholesky.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/operations.hpp"

namespace convex::inline named_functions {
namespace {

/// ½ x·Qx + c·x + constant.
struct QuadraticData {
  Matrix Q;
  Vector c;
  double constant;
  Spectrum of_Q;
};
using SharedData = std::shared_ptr<const QuadraticData>;

/// The recession function, c·d where Qd = 0, else +inf. An eigenvalue that is 0 or not for all that is known
/// counts as positive: what is told is never too small.
double recession_of(const QuadraticData& f, const Vector& d) {
  const Spectrum& of_Q = f.of_Q;
  if (d.isZero(0)) return 0;
  if (!of_Q.is_sure) return infinity;
  const double outside = (d - of_Q.null * (of_Q.null.transpose() * d)).norm();
  return outside <= membership_tolerance * d.norm() ? f.c.dot(d) : infinity;
}

LinearQuadratic form(const Matrix& Q, const Vector& c, double constant) {
  return linear_quadratic::raise(linear_quadratic::quadratic(Q, c), constant);
}

Function dual_quadratic(SharedData f);

class Quadratic : public Atom {
 public:
  explicit Quadratic(SharedData f) : f_(std::move(f)), Q_(f_->Q), c_(f_->c), constant_(f_->constant) {}
  Index dimension() const override { return c_.size(); }
  Facts facts() const override {
    return {.separable = Q_.isDiagonal(0), .piecewise_quadratic = true, .smooth = true, .finite = true};
  }
  Call call() const override {
    Call call{"quadratic", {argument("Q", Q_), argument("c", c_)}};
    if (constant_ != 0) call.arguments.push_back(argument("constant", constant_));
    return call;
  }
  double value(const Vector& x) const override { return evaluate(x).value; }
  /// Summed in twice the precision: where Q is singular x may be large along its null space.
  Value evaluate(const Vector& x) const override {
    RunningSum sum;
    DoubleDoubleVector image(c_);
    for (Index j = 0; j < x.size(); ++j)
      add_multiple(x.size(), Q_.col(j).data(), {0.5 * x[j], 0}, image.hi.data(), image.lo.data());
    for (Index i = 0; i < x.size(); ++i) {
      sum.add(two_product(image.hi[i], x[i]));
      sum.add(image.lo[i] * x[i]);
    }
    sum.add(constant_);
    return {sum.value(), 4 * unit_roundoff * std::abs(sum.value())};
  }
  Function conjugate() const override { return dual_quadratic(f_); }
  std::optional<LinearQuadratic> linear_quadratic(Index) const override { return form(Q_, c_, constant_); }
  std::optional<Vector> subgradient(const Vector& x) const override { return slope(x); }
  double recession(const Vector& d) const override { return recession_of(*f_, d); }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    return prox(z, Metric::diagonal(d), {}).x;
  }
  Jacobian prox_jacobian(const Vector&, const Vector& d) const override {
    const Matrix D = d.asDiagonal();
    return linear_algebra::Cholesky(Q_ + D).solve_columns(D);
  }
  std::optional<QuadraticForm> quadratic_form(Index) const override {
    return QuadraticForm{Q_.sparseView(), c_, constant_};
  }
  /// 0 = W(x - z) + Qx + c, refined once.
  Prox prox(const Vector& z, const Metric& W, const Look&) const override {
    const linear_algebra::Cholesky sum(gram(W) + Q_);
    Vector x = sum.solve(W.multiply(z) - c_);
    for (int pass = 0; pass < 2; ++pass) x -= sum.solve(stationarity(z, W, x, slope(x)));
    return closed_form(z, W, x, slope(x));
  }

 private:
  /// Qx + c, rounded once.
  Vector slope(const Vector& x) const {
    DoubleDoubleVector sum(c_);
    for (Index j = 0; j < x.size(); ++j)
      add_multiple(x.size(), Q_.col(j).data(), {x[j], 0}, sum.hi.data(), sum.lo.data());
    return sum.value();
  }
  const SharedData f_;
  const Matrix& Q_;
  const Vector& c_;
  const double constant_;
};

/// The conjugate, ½|t|² - constant at v = c + Lt, +inf off that range.
class DualQuadratic : public Atom {
 public:
  explicit DualQuadratic(SharedData f)
      : f_(std::move(f)), Q_(f_->Q), c_(f_->c), constant_(f_->constant), of_Q_(f_->of_Q), L_(of_Q_.factor()) {
    if (!of_Q_.is_sure) inverse_ = InverseForm::of(Q_);
  }
  Index dimension() const override { return c_.size(); }
  Facts facts() const override {
    const bool finite = is_finite();
    return {.separable = Q_.isDiagonal(0), .piecewise_quadratic = true, .smooth = finite, .finite = finite};
  }
  /// ½ (v - c)·Q⁺(v - c) - constant, with Nᵀv = Nᵀc.
  Call call() const override {
    const Matrix inverse = inverse_ ? inverse_->matrix() : of_Q_.pseudoinverse();
    const Vector slope = -(inverse * c_);
    const Call on_range{"quadratic",
                        {argument("Q", Matrix(0.5 * (inverse + inverse.transpose()))), argument("c", slope),
                         argument("constant", -0.5 * c_.dot(slope) - constant_)}};
    if (is_finite()) return on_range;
    const Call range{
        "affine",
        {argument("A", Matrix(of_Q_.null.transpose())), argument("b", Vector(of_Q_.null.transpose() * c_))}};
    return {"sum", {argument(on_range), argument(Call{"indicator", {argument(range)}})}};
  }
  double value(const Vector& v) const override { return evaluate(v).value; }
  Value evaluate(const Vector& v) const override {
    const Vector from = v - c_;
    const Value on_range =
        indicated((of_Q_.null.transpose() * from).stableNorm(), v.stableNorm() + c_.stableNorm());
    // Whether it is +inf there, or large, may rest on the rounding of Q.
    if (std::isinf(on_range.value)) return {infinity, of_Q_.is_sure ? 0 : infinity};
    // For any y it is at least y·(v - c) - ½ y·Qy - constant, and ½ r·Q⁺r more, r = v - c - Qy.
    Vector y = solve(from);
    y += solve(left_of(v, y, 1).value());
    const DoubleDoubleVector half = left_of(v, y, 0.5);
    RunningSum sum;
    for (Index i = 0; i < y.size(); ++i) {
      sum.add(two_product(half.hi[i], y[i]));
      sum.add(half.lo[i] * y[i]);
    }
    sum.add(-constant_);
    const Vector r = left_of(v, y, 1).value();
    const double found = sum.value();
    if (!std::isfinite(found)) return beyond_products(from);
    const Vector terms = v.cwiseAbs() + c_.cwiseAbs() + Q_.cwiseAbs() * y.cwiseAbs();
    const double of_pairs = roundings_of_pairs * static_cast<double>(y.size() + 1) * unit_roundoff *
                            unit_roundoff * (terms.dot(y.cwiseAbs()) + std::abs(constant_));
    const double of_rank =
        inverse_ && v.allFinite() ? std::abs(inverse_->value(v, c_, constant_) - found) : 0;
    return {found,
            sum_of_terms(found, std::abs(found)).error + of_pairs + left_by(r) + on_range.error + of_rank};
  }
  Function conjugate() const override { return Function(std::make_shared<Quadratic>(f_)); }
  std::optional<LinearQuadratic> linear_quadratic(Index) const override {
    return linear_quadratic::conjugate(form(Q_, c_, constant_));
  }
  std::optional<Vector> subgradient(const Vector& v) const override {
    if (std::isinf(value(v))) return std::nullopt;
    return solve(v - c_);
  }
  /// The recession function of the quadratic.
  double domain_support(const Vector& d) const override { return recession_of(*f_, d); }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    return prox(z, Metric::diagonal(d), {}).x;
  }
  Jacobian prox_jacobian(const Vector&, const Vector& d) const override {
    const Index r = L_.cols();
    const Matrix weighted = L_.transpose() * d.asDiagonal();
    return L_ * linear_algebra::Cholesky(weighted * L_ + Matrix::Identity(r, r)).solve_columns(weighted);
  }
  /// (LᵀWL + I) t = LᵀW(z - c); x = c + Lt, refined once.
  Prox prox(const Vector& z, const Metric& W, const Look&) const override {
    const Index r = L_.cols();
    const Matrix W_L = gram(W) * L_;
    const linear_algebra::Cholesky sum(L_.transpose() * W_L + Matrix::Identity(r, r));
    Vector t = sum.solve(W_L.transpose() * (z - c_));
    t -= sum.solve(L_.transpose() * metric_difference(W, c_ + L_ * t, z) + t);
    const Vector x = c_ + L_ * t;
    // u with Qu = x - c; along the null space any part will do, and the covector there is the normal's.
    const Vector covector = metric_difference(W, z, x);
    const Vector v = of_Q_.basis * (of_Q_.values.cwiseSqrt().cwiseInverse().asDiagonal() * t) +
                     of_Q_.null * (of_Q_.null.transpose() * covector);
    const Prox along_range = as_pair(z, W, x, v);
    if (of_Q_.null.cols() > 0) return along_range;
    // Where c and Lt cancel, the difference to z may not.
    const Prox from_z = as_pair(z, W, z - W.solve(v), v);
    return from_z.error_bound < along_range.error_bound ? from_z : along_range;
  }

 private:
  static constexpr double roundings_of_pairs = 16;

  /// x with the covector v, of which c + Qv is the point: how far x is from there counts where it is more
  /// than the rounding counted, as where W is nearly singular.
  Prox as_pair(const Vector& z, const Metric& W, const Vector& x, const Vector& v) const {
    Prox found = closed_form(z, W, x, v);
    const double counted = roundings_of_a_formula * unit_roundoff * (W.norm(z) + W.norm(x));
    found.error_bound += std::max(0.0, 2 * W.norm(left_of(x, v, 1).value()) - counted);
    return found;
  }

  bool is_finite() const { return of_Q_.null.cols() == 0 || inverse_; }

  /// Where products are beyond doubles: ½ from·Q⁺from - constant as it comes.
  Value beyond_products(const Vector& from) const {
    const double found = 0.5 * from.dot(solve(from)) - constant_;
    if (!std::isfinite(found)) return {infinity, infinity};
    constexpr double roundings = 64;
    const double condition = of_Q_.values.size() > 0 ? of_Q_.values.maxCoeff() / of_Q_.values.minCoeff() : 1;
    return {found, roundings * unit_roundoff * condition * (std::abs(found) + 2 * std::abs(constant_))};
  }
  /// ½ r·Q⁺r, with eigenvalues as small as rounding may have made them.
  double left_by(const Vector& r) const {
    if (of_Q_.values.size() == 0) return 0;
    constexpr double least_part = 0.125;
    const double off =
        Q_.isDiagonal(0) ? 0 : rank_tolerance * static_cast<double>(r.size()) * of_Q_.values.maxCoeff();
    const Vector least = (of_Q_.values.array() - off).max(least_part * of_Q_.values.array());
    return (of_Q_.basis.transpose() * r).cwiseAbs2().cwiseQuotient(least).sum();
  }

  /// v - c - part Qy, to twice the precision.
  DoubleDoubleVector left_of(const Vector& v, const Vector& y, double part) const {
    DoubleDoubleVector sum(v);
    sum.add(-c_);
    for (Index j = 0; j < y.size(); ++j)
      add_multiple(y.size(), Q_.col(j).data(), {-part * y[j], 0}, sum.hi.data(), sum.lo.data());
    return sum;
  }
  /// Q⁺ b.
  Vector solve(const Vector& b) const {
    return of_Q_.basis * (of_Q_.values.cwiseInverse().asDiagonal() * (of_Q_.basis.transpose() * b));
  }
  const SharedData f_;
  const Matrix& Q_;
  const Vector& c_;
  const double constant_;
  const Spectrum& of_Q_;
  std::optional<InverseForm> inverse_;  // where the rank is not sure, and n for Q as it stands
  Matrix L_;
};

Function dual_quadratic(SharedData f) { return Function(std::make_shared<DualQuadratic>(std::move(f))); }

}  // namespace

Function quadratic(const Matrix& Q, const Vector& c, double constant) {
  require_finite("quadratic", "Q", Q);
  require_finite("quadratic", "c", c);
  require_finite("quadratic", "constant", constant);
  if (Q.rows() != Q.cols() || Q.rows() == 0)
    throw InvalidInput("quadratic(Q): " + counted(Q.rows(), "row", "rows") + " and " +
                       counted(Q.cols(), "column", "columns") + "; give a square matrix");
  if (c.size() != Q.rows())
    throw InvalidInput("quadratic(c): " + counted(c.size(), "entry", "entries") + " where Q has " +
                       counted(Q.rows(), "row", "rows") + "; give as many");
  for (Index j = 0; j < Q.cols(); ++j) {
    if (Q(j, j) < 0)
      throw InvalidInput("quadratic(Q): a diagonal entry is negative; the function would not be convex");
    for (Index i = 0; i < j; ++i)
      if (std::abs(Q(i, j) - Q(j, i)) > 8 * unit_roundoff * std::max(std::abs(Q(i, j)), std::abs(Q(j, i))))
        throw InvalidInput("quadratic(Q): not symmetric, entries (" + std::to_string(i) + ", " +
                           std::to_string(j) + ") and back differ; give (Q + Q')/2");
  }
  const Matrix symmetric = 0.5 * (Q + Q.transpose());
  return Function(std::make_shared<Quadratic>(
      std::make_shared<const QuadraticData>(QuadraticData{symmetric, c, constant, spectrum_of(symmetric)})));
}

}  // namespace convex::inline named_functions
