#include "convex/operations/quadratic_term.hpp"

#include <cmath>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/linear_quadratic/stationarity.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/reduction.hpp"

namespace convex::inline operations {
std::optional<QuadraticTerm> quadratic_term(const Function& f, Index n) {
  if (n == 0) return std::nullopt;  // on no entries all functions are constants
  const Facts facts = f.facts();
  if (!facts.smooth || !facts.finite || !facts.piecewise_quadratic) return std::nullopt;
  const auto form = f.node().linear_quadratic(n);
  if (!form || form->auxiliaries() != 0 || form->rows() != 0) return std::nullopt;
  return QuadraticTerm{form->H, form->c, form->constant};
}

std::optional<double> multiple_of_identity(const SparseMatrix& Q) {
  const double mu = Q.rows() == 0 ? 0 : Q.coeff(0, 0);
  Index on_diagonal = 0;
  for (Index j = 0; j < Q.outerSize(); ++j)
    for (SparseMatrix::InnerIterator entry(Q, j); entry; ++entry) {
      if (entry.row() != j && entry.value() != 0) return std::nullopt;
      if (entry.row() != j) continue;
      if (entry.value() != mu) return std::nullopt;
      ++on_diagonal;
    }
  if (mu != 0 && on_diagonal != Q.rows()) return std::nullopt;
  return mu;
}

Vector slope_at(const QuadraticTerm& q, const Vector& x, const Vector& v) {
  DoubleDoubleVector sum(q.c);
  for (Index j = 0; j < x.size(); ++j)
    for (SparseMatrix::InnerIterator entry(q.Q, j); entry; ++entry)
      add_multiple(1, &entry.value(), {x[j], 0}, &sum.hi[entry.row()], &sum.lo[entry.row()]);
  sum.add(v);
  return sum.value();
}

Function function_of(const QuadraticTerm& q) {
  const Index n = q.c.size();
  const auto mu = multiple_of_identity(q.Q);
  const auto linear = [&] { return named("linear", {argument("c", q.c)}, n); };
  if (mu && *mu == 0) return raised(linear(), q.constant);
  if (mu && q.c.isZero(0)) return raised(named("squared_norm2", {argument("weight", *mu)}, n), q.constant);
  const Function f = named("quadratic", {argument("Q", Matrix(q.Q)), argument("c", q.c)}, n);
  return raised(f, q.constant);
}

std::optional<Kernel> kernel_of(const QuadraticTerm& q) {
  try {
    const bool full = q.Q.nonZeros() > q.Q.size() / dense_above;
    return Kernel{full && q.Q.rows() > 1 ? Metric::dense(Matrix(q.Q)) : Metric::sparse(q.Q), 1, q.c,
                  q.constant};
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

namespace {

/// covector - Mb/gamma - c, with M and gamma as they are.
Vector left_of_slope(const Kernel& q, const DoubleDoubleVector& covector, const Vector& b) {
  DoubleDoubleVector sum(b.size());
  for (Index i = 0; i < b.size(); ++i) {
    const DoubleDouble left = product(add({covector.hi[i], covector.lo[i]}, {-q.c[i], 0}), q.gamma);
    sum.hi[i] = left.hi, sum.lo[i] = left.lo;
  }
  linear_quadratic::add_product(q.M, DoubleDoubleVector(Vector(-b)), sum);
  return sum.value() / q.gamma;
}
Vector left_of_slope(const Kernel& q, const Vector& covector, const Vector& b) {
  return left_of_slope(q, DoubleDoubleVector(covector), b);
}

/// ½||b||_M²/gamma: the products of a nearly singular M cancel.
Value half_square(const Kernel& q, const Vector& b) {
  DoubleDoubleVector image(b.size());
  linear_quadratic::add_product(q.M, DoubleDoubleVector(b), image);
  RunningSum sum;
  for (Index i = 0; i < b.size(); ++i) {
    sum.add(two_product(image.hi[i], b[i]));
    sum.add(image.lo[i] * b[i]);
  }
  const double value = sum.value() / (2 * q.gamma);
  return {value, 4 * unit_roundoff * std::abs(value)};
}

}  // namespace

Smoothed smoothed(const Function& f, const Kernel& q, const Vector& x) {
  const Prox part = f.prox(q.c.isZero(0) ? x : Vector(x + q.Q.solve(q.c)), q.Q, Look{});
  if (part.x.size() != x.size() && part.status == Status::infeasible)
    throw InvalidInput(f.call().name + ": no point has it finite; give a proper function");
  if (part.x.size() != x.size()) return {Vector(0), Vector(0), {infinity, infinity}};
  const Vector b = x - part.x;
  const Value square = half_square(q, b);
  const double linear = q.c.dot(b);
  const double size = square.value + q.c.cwiseAbs().dot(b.cwiseAbs()) + std::abs(q.constant);
  // The prox's own covector is the slope too, and right where x - w is nothing beside x.
  const bool own = part.v.size() == x.size() && part.v.allFinite();
  const Vector slope = own ? part.v : Vector(q.Q.multiply(b) + q.c);
  // The value at w is above the minimum by no more than (s + the slope of q(x - w))·(w - w*), s in ∂f(w): a
  // product of two errors, but where f is steep or has a kink. What x - w rounds is not made good by f.
  const double off = part.error_bound + q.Q.dual_norm(left_of_slope(q, slope, b));
  const double of_difference = unit_roundoff * slope.cwiseAbs().dot(b.cwiseAbs());
  double above = off * off;
  if (const auto s = f.subgradient(part.x); s && s->allFinite())
    above = std::max(above, off * q.Q.dual_norm(left_of_slope(q, *s, b)));
  const Value rest{square.value + linear + q.constant, 8 * unit_roundoff * size + of_difference + above};
  constexpr double roundings_of_the_point = 4;
  const double of_point = roundings_of_the_point * unit_roundoff * (q.Q.norm(x) + q.Q.dual_norm(q.c));
  return {part.x, slope, sum_of(f.evaluate(part.x), rest), off + of_point, above};
}

std::optional<Vector> slope_of_smoothing(const Function& f, const Kernel& q, const Vector& x) {
  Smoothed split = smoothed(f, q, x);
  // Of a w that may be anywhere the slope there may be any.
  const bool known = split.v.size() == x.size() && std::isfinite(split.off);
  return known ? std::optional(std::move(split.v)) : std::nullopt;
}

Prox smoothed_prox(const Function& f, const Kernel& q, const Vector& z, const Metric& W, const Look& look) {
  const Metric P = parallel_sum(W, q.Q);
  const Metric V = plus(W, q.Q);
  // An error of a in the parallel sum is one of a + b in W at most as large: b follows a as its best answer.
  const auto from = [&](const Vector& point) {
    const Prox part = f.prox(point, P, look);
    if (part.x.size() == 0) return part;
    const Vector& a = part.x;
    Vector b = V.solve(metric_difference(W, z, a) - q.c);
    DoubleDoubleVector rest(z.size());  // W(z - a - b)
    add_metric_difference(W, z, a, rest);
    linear_quadratic::add_product(W, DoubleDoubleVector(Vector(-b)), rest);
    b += V.solve(left_of_slope(q, rest, b));
    // The kernel q takes its own slope Qb + c, where q*(Qb + c) = ½ b·Qb - q(0).
    const Value square = half_square(q, b);
    const double off = q.Q.dual_norm(left_of_slope(q, part.v, b));
    return with_values(moved(part, a + b, part.v, part.error_bound + off, z, W, P), part.values,
                       sum_of(sum_of(square, product(q.c, b)), {q.constant, 0}),
                       sum_of(square, {-q.constant, 0}));
  };
  const Vector point = q.c.isZero(0) ? z : Vector(z + q.Q.solve(q.c));
  Prox whole = reduced(point, z, W, from, [&](const Vector& r) { return P.solve(r); });
  if (whole.x.size() == 0) return whole;
  whole.method += " in the parallel sum of two metrics";
  return whole;
}

}  // namespace convex::inline operations
