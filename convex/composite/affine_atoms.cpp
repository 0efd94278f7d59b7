#include "convex/composite/affine_atoms.hpp"

#include "convex/functions/quadratic.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_algebra/cholesky.hpp"

namespace convex::inline composite {
namespace {

Call call_of(const char* name) { return {name, {}, std::nullopt}; }

Call call_of(const char* name, Argument argument) {
  return {name, {{"", std::move(argument), std::nullopt}}, std::nullopt};
}

Argument nested(Call call) { return std::make_shared<const Call>(std::move(call)); }

class LinearAtom final : public Atom {
 public:
  explicit LinearAtom(Vector slope) : slope_(std::move(slope)) {}
  Index dimension() const override { return slope_.size(); }
  Facts facts() const override {
    return {.support = true, .separable = true, .piecewise_quadratic = true, .smooth = true, .finite = true};
  }
  Call call() const override { return call_of("linear", slope_); }
  double value(const Vector& x) const override { return slope_.dot(x); }
  Value evaluate(const Vector& x) const override {
    return sum_of_terms(value(x), slope_.cwiseAbs().dot(x.cwiseAbs()));
  }
  Function conjugate() const override { return Function(point_atom(slope_)); }
  std::optional<Vector> subgradient(const Vector&) const override { return slope_; }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    return z - slope_.cwiseQuotient(d);
  }
  Jacobian prox_jacobian(const Vector& z, const Vector&) const override {
    return Jacobian::identity(z.size());
  }
  std::optional<QuadraticForm> quadratic_form(Index n) const override {
    return QuadraticForm{SparseMatrix(n, n), slope_, 0};
  }

 private:
  Vector slope_;
};

class FormAtom final : public Atom {
 public:
  explicit FormAtom(QuadraticForm form) : form_(std::move(form)) {}
  Index dimension() const override { return form_.c.size(); }
  Facts facts() const override { return {.piecewise_quadratic = true, .smooth = true, .finite = true}; }
  Call call() const override { return dense().node().call(); }
  double value(const Vector& x) const override {
    return x.dot(0.5 * (form_.Q * x) + form_.c) + form_.constant;
  }
  Value evaluate(const Vector& x) const override {
    const Vector size = x.cwiseAbs();
    const double squares = size.dot(Vector(form_.Q.cwiseAbs() * size));
    return sum_of_terms(value(x), 0.5 * squares + form_.c.cwiseAbs().dot(size) + std::abs(form_.constant));
  }
  Function conjugate() const override { return dense().conjugate(); }
  std::optional<Vector> subgradient(const Vector& x) const override { return Vector(form_.Q * x + form_.c); }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    return sum(d).solve(d.cwiseProduct(z) - form_.c);
  }
  Jacobian prox_jacobian(const Vector&, const Vector& d) const override {
    return sum(d).solve_columns(d.asDiagonal());
  }
  std::optional<QuadraticForm> quadratic_form(Index) const override { return form_; }

 private:
  Function dense() const { return quadratic(Matrix(form_.Q), form_.c, form_.constant); }
  linear_algebra::Cholesky sum(const Vector& d) const {
    Matrix Q(form_.Q);
    Q.diagonal() += d;
    return linear_algebra::Cholesky(Q);
  }
  QuadraticForm form_;
};

class HalfSquareAtom final : public Atom {
 public:
  Index dimension() const override { return 0; }
  Facts facts() const override {
    return {.separable = true, .piecewise_quadratic = true, .smooth = true, .finite = true};
  }
  Call call() const override { return call_of("squared_norm2"); }
  double value(const Vector& x) const override { return 0.5 * x.squaredNorm(); }
  Function conjugate() const override { return Function(half_square_atom()); }
  std::optional<Vector> subgradient(const Vector& x) const override { return x; }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    return (d.array() / (1 + d.array()) * z.array()).matrix();
  }
  Jacobian prox_jacobian(const Vector&, const Vector& d) const override {
    return (d.array() / (1 + d.array())).matrix().asDiagonal();
  }
  std::optional<QuadraticForm> quadratic_form(Index n) const override {
    SparseMatrix identity(n, n);
    identity.setIdentity();
    return QuadraticForm{identity, Vector::Zero(n), 0};
  }
};

class PointAtom final : public Atom {
 public:
  explicit PointAtom(Vector point) : point_(std::move(point)) {}
  Index dimension() const override { return point_.size(); }
  Facts facts() const override {
    return {.indicator = true, .cone = point_.isZero(0), .separable = true, .piecewise_quadratic = true};
  }
  Call call() const override { return call_of("indicator", nested(call_of("point", point_))); }
  double value(const Vector& x) const override { return evaluate(x).value; }
  Value evaluate(const Vector& x) const override {
    return indicated((x - point_).stableNorm(), std::max(x.stableNorm(), point_.stableNorm()));
  }
  Function conjugate() const override { return Function(linear_atom(point_)); }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (value(x) > 0) return std::nullopt;
    return Vector::Zero(x.size());
  }
  Vector prox_diagonal(const Vector&, const Vector&) const override { return point_; }
  Jacobian prox_jacobian(const Vector& z, const Vector&) const override {
    return Jacobian(Vector(Vector::Zero(z.size())));
  }

 private:
  Vector point_;
};

/// {u : sign u >= 0}.
class OrthantAtom final : public Atom {
 public:
  explicit OrthantAtom(double sign) : sign_(sign) {}
  Index dimension() const override { return 0; }
  Facts facts() const override {
    return {.indicator = true, .cone = true, .support = true, .separable = true, .piecewise_quadratic = true};
  }
  Call call() const override {
    const Call positive = call_of("indicator", nested(call_of("orthant")));
    if (sign_ > 0) return positive;
    Call reflected = call_of("dilate", nested(positive));
    reflected.arguments.push_back({"", -1.0, std::nullopt});
    return reflected;
  }
  double value(const Vector& x) const override { return evaluate(x).value; }
  Value evaluate(const Vector& x) const override {
    return indicated((-sign_ * x.array()).cwiseMax(0.0).matrix().stableNorm(), x.stableNorm());
  }
  Function conjugate() const override { return Function(std::make_shared<const OrthantAtom>(-sign_)); }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (value(x) > 0) return std::nullopt;
    return Vector::Zero(x.size());
  }
  Vector prox_diagonal(const Vector& z, const Vector&) const override {
    return (sign_ * (sign_ * z.array()).cwiseMax(0.0)).matrix();
  }
  Jacobian prox_jacobian(const Vector& z, const Vector&) const override {
    return (sign_ * z.array() > 0).cast<double>().matrix().asDiagonal();
  }

 private:
  double sign_;
};

}  // namespace

std::shared_ptr<const Atom> linear_atom(const Vector& a) { return std::make_shared<const LinearAtom>(a); }
std::shared_ptr<const Atom> quadratic_atom(QuadraticForm form) {
  return std::make_shared<const FormAtom>(std::move(form));
}
std::shared_ptr<const Atom> half_square_atom() { return std::make_shared<const HalfSquareAtom>(); }
std::shared_ptr<const Atom> point_atom(const Vector& p) { return std::make_shared<const PointAtom>(p); }
std::shared_ptr<const Atom> orthant_atom() { return std::make_shared<const OrthantAtom>(1.0); }

}  // namespace convex::inline composite
