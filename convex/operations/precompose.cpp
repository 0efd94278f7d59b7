#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/composite/graph_algebra.hpp"
#include "convex/counted.hpp"
#include "convex/double_double.hpp"
#include "convex/exact/exact_sum.hpp"
#include "convex/linear_algebra/householder.hpp"
#include "convex/linear_algebra/inverse.hpp"
#include "convex/linear_algebra/pivoted_qr.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/ball_section.hpp"
#include "convex/operations/image_prox.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/sum.hpp"
#include "convex/operations/two_function_max.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

/// x -> f(Ax + b).
class Precompose : public Operation {
 public:
  Precompose(Function f, Matrix A, Vector b) : f_(std::move(f)), A_(std::move(A)), b_(std::move(b)) {}
  const Function& part() const { return f_; }
  const Matrix& A() const { return A_; }
  const Vector& b() const { return b_; }

  Index dimension() const override { return A_.cols(); }
  Facts facts() const override {
    const Facts f = f_.facts();
    const bool linear = b_.isZero(0);
    return {.indicator = f.indicator,
            .cone = f.cone && linear,
            .support = f.support && linear,
            .piecewise_quadratic = f.piecewise_quadratic,
            .smooth = f.smooth,
            .finite = f.finite};
  }
  Call call() const override {
    Call made{"precompose", {argument(f_.call()), argument("A", A_)}, {}};
    made.arguments.push_back(argument("b", b_));
    return made;
  }
  Value evaluate(const Vector& x) const override {
    return value_near(f_, accurate_image(A_, DoubleDoubleVector(x), b_),
                      length_of(A_.cwiseAbs() * x.cwiseAbs() + b_.cwiseAbs()));
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    const std::optional<Vector> v = f_.subgradient(image_of(x));
    if (!v) return std::nullopt;
    return A_.transpose() * *v;
  }
  double error_of_slope(double x, double w) const override {
    constexpr double roundings = 64;
    if (A_.rows() != 1) {
      const auto p = f_.subgradient(image_of(Vector::Constant(1, x)));
      return p ? roundings * unit_roundoff * A_.col(0).cwiseAbs().dot(p->cwiseAbs()) : 0;
    }
    const DoubleDoubleVector y = accurate_image(A_, DoubleDoubleVector(Vector::Constant(1, x)), b_);
    const double a = std::abs(A_(0, 0)), w_of_y = w / (a * a);
    const double moved = unit_roundoff * (a * std::abs(x) + std::abs(b_[0]));
    return a * (f_.node().error_of_slope(y.hi[0], w_of_y) +
                error_of_moved_slope(f_.node(), y.hi[0], moved, w_of_y));
  }
  Function conjugate() const override;
  double recession(const Vector& d) const override { return f_.node().recession(A_ * d); }
  /// v = Aᵀp is p·(Ax + b) - p·b, with Ax + b in the domain of f.
  double domain_support(const Vector& v) const override {
    const auto of = [&](const Vector& p) { return f_.node().domain_support(p) - p.dot(b_); };
    const Vector p = linear_algebra::least_squares(A_.transpose(), v);
    const bool in_range = (A_.transpose() * p - v).stableNorm() <= membership_tolerance * v.stableNorm();
    double least = in_range ? of(p) : std::numeric_limits<double>::infinity();
    // An entry of Ax + b that is always b_i must be within the domain's own bounds.
    for (Index i = 0; i < A_.rows(); ++i)
      for (const double sign : {1.0, -1.0})
        if (A_.row(i).isZero(0) &&
            of(sign * Vector::Unit(A_.rows(), i)) < -membership_tolerance * (1 + std::abs(b_[i])))
          return -std::numeric_limits<double>::infinity();
    // Of one entry, each row alone bounds the domain.
    for (Index i = 0; A_.cols() == 1 && i < A_.rows(); ++i)
      if (A_(i, 0) != 0) least = std::min(least, of(v[0] / A_(i, 0) * Vector::Unit(A_.rows(), i)));
    return least;
  }
  std::vector<Function> maximum_of() const override {
    std::vector<Function> parts = parts_of_max(f_);
    for (Function& part : parts) part = Function(std::make_shared<Precompose>(part, A_, b_));
    return parts;
  }
  std::optional<LinearQuadratic> linear_quadratic(Index) const override {
    const auto form = f_.node().linear_quadratic(A_.rows());
    if (!form) return std::nullopt;
    return linear_quadratic::precompose(*form, A_.sparseView(), b_);
  }
  std::optional<GraphForm> graph(Index, double slope) const override {
    const auto form = f_.node().graph(A_.rows(), slope);
    if (!form) return std::nullopt;
    return convex::precompose(*form, A_.sparseView(), b_);
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    const auto image = image_metric(W, A_);
    if (!image) return std::nullopt;
    if (f_.facts().piecewise_quadratic && !is_diagonal_kind(image->metric)) return std::nullopt;
    Prox whole = image_prox(f_, A_, b_, *image, z, W, look);
    whole.method +=
        is_diagonal_kind(image->metric) ? " after a semi-orthogonal map" : " in the metric of an image";
    return whole;
  }

 private:
  Vector image_of(const Vector& x) const { return accurate_image(A_, DoubleDoubleVector(x), b_).hi; }

  Function f_;
  Matrix A_;
  Vector b_;
};

/// The programs of f*, by those of f: an inverse of a matrix, which is rounded, has no part in them.
std::optional<LinearQuadratic> conjugate_program(const Function& f, Index n) {
  const auto form = f.node().linear_quadratic(n);
  return form ? std::optional(linear_quadratic::conjugate(*form)) : std::nullopt;
}
std::optional<GraphForm> conjugate_graph(const Function& f, Index n) {
  const auto form = f.node().graph(n);
  return form ? std::optional(convex::conjugate(*form)) : std::nullopt;
}

/// The conjugate of a function that has it as a sum, and is its conjugate in turn: taken by rule once more,
/// the rounding of both maps would remain between the two.
class ConjugateSum : public Sum {
 public:
  ConjugateSum(std::vector<Function> parts, Function primal)
      : Sum(std::move(parts)), primal_(std::move(primal)) {}
  Function conjugate() const override { return primal_; }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    return conjugate_program(primal_, n);
  }
  std::optional<GraphForm> graph(Index n, double) const override { return conjugate_graph(primal_, n); }

 private:
  Function primal_;
};

/// v -> g(w) where Aᵀw = v, `made` with the inverse of Aᵀ, or a left one. What that is rounded by is taken
/// back where it acts.
class InverseMap : public Precompose {
 public:
  InverseMap(const Precompose& made, Matrix A) : Precompose(made), A_(std::move(A)) {
    // Row by row, of what rounding is relative to (Skeel 1979).
    condition_ = (this->A().cwiseAbs() * A_.transpose().cwiseAbs()).rowwise().sum().maxCoeff();
  }
  Value evaluate(const Vector& v) const override {
    DoubleDoubleVector w(Vector(A() * v));
    for (int pass = 0; pass < 2; ++pass) w.add(A() * left_of(v, w));
    if (!w.hi.allFinite()) return Precompose::evaluate(v);
    const Vector terms = A().cwiseAbs() * (v.cwiseAbs() + A_.transpose().cwiseAbs() * w.hi.cwiseAbs());
    Value found = value_near(part(), w, length_of(terms));
    constexpr double roundings = 8;
    if (const auto slope = part().subgradient(w.hi); slope && std::isfinite(found.value))
      found.error += roundings * unit_roundoff * unit_roundoff * slope->cwiseAbs().dot(terms);
    return found;
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    auto found = Precompose::reduced_prox(z, W, look);
    if (found && found->x.size() == z.size() && found->v.size() == z.size())
      found->error_bound += 4 * unit_roundoff * condition_ * (W.norm(found->x) + W.dual_norm(found->v));
    return found;
  }

 private:
  /// v - Aᵀw, rounded once.
  Vector left_of(const Vector& v, const DoubleDoubleVector& w) const {
    DoubleDoubleVector sum(v);
    const Matrix back = A_.transpose();
    for (Index j = 0; j < w.size(); ++j)
      add_multiple(v.size(), back.col(j).data(), {-w.hi[j], -w.lo[j]}, sum.hi.data(), sum.lo.data());
    return sum.value();
  }

  Matrix A_;
  double condition_ = 1;
};

/// The same for a square map: its inverse inverted is another matrix than A.
class ConjugateMap : public InverseMap {
 public:
  ConjugateMap(const Precompose& made, Matrix A, Function primal)
      : InverseMap(made, std::move(A)), primal_(std::move(primal)) {}
  Function conjugate() const override { return primal_; }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    return conjugate_program(primal_, n);
  }
  std::optional<GraphForm> graph(Index n, double) const override { return conjugate_graph(primal_, n); }

 private:
  Function primal_;
};

/// (f(A· + b))*(v) = min {f*(w) - b·w : Aᵀw = v} (Rockafellar 1970, Theorem 16.3); with independent rows w =
/// (A Aᵀ)⁻¹Av alone can do, for the v in the range of Aᵀ.
Function Precompose::conjugate() const {
  const Index m = A_.rows(), n = A_.cols();
  const auto image = image_metric(Metric::identity(n), A_);
  if (!image) return computed_conjugate(self());
  Function g = f_.conjugate();
  if (!b_.isZero(0)) g = tilt(g, -b_);
  Matrix back(m, n);
  if (m == n) {
    back = linear_algebra::inverse(A_.transpose());
    const Function made = precompose(g, back, Vector::Zero(m));
    const auto* map = dynamic_cast<const Precompose*>(&made.node());
    if (!map) return made;
    return Function(std::make_shared<ConjugateMap>(*map, A_, self()));
  }
  const linear_algebra::Householder factor(A_.transpose());
  if (is_diagonal_kind(image->metric))
    back = image->metric.diagonal().asDiagonal() * A_;
  else
    back = factor.least_squares(Matrix::Identity(n, n));
  const Matrix outside = factor.Q(n).rightCols(n - m).transpose();
  const Function in_range =
      named("affine", {argument("A", outside), argument("b", Vector::Zero(n - m).eval())}, n);
  Function on_range = precompose(g, back, Vector::Zero(m));
  if (const auto* map = dynamic_cast<const Precompose*>(&on_range.node()))
    on_range = Function(std::make_shared<InverseMap>(*map, A_));
  std::vector<Function> terms{on_range, in_range};
  return Function(std::make_shared<ConjugateSum>(std::move(terms), self()));
}

/// A = c aᵀ, where its rows are multiples of one of them, exactly in doubles.
struct RankOne {
  Vector c, a;
};
std::optional<RankOne> rank_one(const Matrix& A) {
  if (A.rows() < 2 || A.cols() < 2) return std::nullopt;
  Index first = 0, column = 0;
  if (!(A.cwiseAbs().maxCoeff(&first, &column) > 0)) return std::nullopt;
  RankOne made{A.col(column) / A(first, column), A.row(first)};
  for (Index i = 0; i < A.rows(); ++i)
    for (Index j = 0; j < A.cols(); ++j)
      if (std::fma(made.c[i], made.a[j], -A(i, j)) != 0) return std::nullopt;
  return made;
}

/// f(A (Bx + b) + a): each number rounded once, whatever cancels in it.
Function merged(const Function& f, const Matrix& A, const Vector& a, const Matrix& B, const Vector& b) {
  Matrix product(A.rows(), B.cols());
  Vector shift(A.rows());
  for (Index i = 0; i < A.rows(); ++i) {
    ExactSum of_shift;
    of_shift.add(a[i]);
    for (Index k = 0; k < A.cols(); ++k) of_shift.add_product(A(i, k), b[k]);
    shift[i] = of_shift.value();
    for (Index j = 0; j < B.cols(); ++j) {
      ExactSum sum;
      for (Index k = 0; k < A.cols(); ++k) sum.add_product(A(i, k), B(k, j));
      product(i, j) = sum.value();
    }
  }
  return precompose(f, product, shift);
}

}  // namespace

Function precompose(const Function& f, const Matrix& A, const Vector& b) {
  const auto refuse = [](const std::string& what) { throw InvalidInput("precompose" + what); };
  if (A.rows() == 0 || A.cols() == 0) refuse("(A): no entries; give at least one row and column");
  if (!A.allFinite()) refuse("(A): an entry is not finite; give finite numbers");
  if (f.dimension() != 0 && A.rows() != f.dimension())
    refuse("(A): " + counted(A.rows(), "row", "rows") + ", the function takes " +
           counted(f.dimension(), "entry", "entries") + "; give as many");
  f.node().require_size(A.rows());
  if (b.size() != A.rows())
    refuse("(b): " + counted(b.size(), "entry", "entries") + ", A has " + counted(A.rows(), "row", "rows") +
           "; give as many");
  if (!b.allFinite()) refuse("(b): an entry is not finite; give finite numbers");
  if (const auto* inner = dynamic_cast<const Precompose*>(&f.node()))
    return merged(inner->part(), inner->A(), inner->b(), A, b);
  const Index n = A.cols();
  if (A.rows() == n && A.isIdentity(0) && f.dimension() != 0) return b.isZero(0) ? f : translate(f, -b);
  if (A.isZero(0) && std::isinf(f(b)))
    refuse(": no point has it finite, A is 0 and f(b) is infinite; give a b in the domain");
  // A function of a·x alone has its prox along one line, however many rows are multiples of a.
  if (const auto one = rank_one(A))
    return Function(
        std::make_shared<Precompose>(precompose(f, Matrix(one->c), b), one->a.transpose(), Vector::Zero(1)));
  const Function made(std::make_shared<Precompose>(f, A, b));
  if (f.facts().finite || image_metric(Metric::identity(n), A)) return made;
  if (const auto section = ball_section(f, A, b)) return *section;
  require_proper(made, n, "precompose");
  return made;
}

}  // namespace convex::inline operations
