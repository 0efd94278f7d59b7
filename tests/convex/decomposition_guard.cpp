#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "convex/functions/decomposition.hpp"
#include "convex/functions/log_sum_exp.hpp"
#include "convex/gamma0/node.hpp"

using namespace convex;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How a pair of conjugates is spoiled.
struct Slip {
  double in_x = 0;       ///< the prox of f is off by this
  double in_value = 0;   ///< f's value is too large by this
  double outside = 0;    ///< the prox of g is outside the ball by this part
  double elsewhere = 0;  ///< the prox of f is that of another point, so far away in its first entry
};

/// f = |x| and g = the indicator of [-1, 1], entry by entry, both with errors in them; g strictly +inf
/// outside.
class Side final : public FunctionNode {
 public:
  Side(Slip slip, bool ball) : slip_(slip), ball_(ball) {}
  Index dimension() const override { return 0; }
  Facts facts() const override {
    return {.indicator = ball_, .support = !ball_, .separable = true, .finite = !ball_};
  }
  Call call() const override { return {ball_ ? "strict_ball" : "absolute_value"}; }
  double value(const Vector& x) const override {
    if (ball_) return x.cwiseAbs().maxCoeff() <= 1 ? 0 : infinity;
    return x.cwiseAbs().sum() + slip_.in_value;
  }
  Prox prox(const Vector& z, const Metric& W, const Look&) const override {
    const Vector reach = W.diagonal().cwiseInverse();
    Prox found;
    if (ball_) {
      found.x = z.cwiseMin(1.0).cwiseMax(-1.0);
      // Once moved to the edge by a projection the point stays there.
      if ((z - found.x).norm() > 1e-6) found.x *= 1 + slip_.outside;
    } else {
      found.x = (z.array().sign() * (z.array().abs() - reach.array()).max(0.0)).matrix();
      found.x.array() += slip_.in_x;
      found.x[0] += slip_.elsewhere;
    }
    found.v = W.multiply(z - found.x);
    // Each side's covector repeats the other's slip, so that Moreau's identity does not mend it.
    found.v.array() += ball_ ? slip_.in_x : 0;
    found.v[0] += ball_ ? 0 : slip_.elsewhere;
    if (!ball_ && slip_.outside > 1e-6) found.v *= 1 + slip_.outside;
    found.error_bound = 1e-15 * W.norm(z);
    return found;
  }
  Function conjugate() const override { return Function(std::make_shared<Side>(slip_, !ball_)); }
  std::optional<Vector> subgradient(const Vector& x) const override {
    return Vector(x.array().sign().matrix());
  }

 private:
  Slip slip_;
  bool ball_;
};

Decomposition split(Slip slip, const Vector& z) {
  return decompose(Function(std::make_shared<Side>(slip, false)), z, Metric::identity(z.size()));
}

const Vector z = Eigen::Vector3d(3, -0.5, 1.5), x = Eigen::Vector3d(2, 0, 0.5),
             y = Eigen::Vector3d(1, -0.5, 1);

}  // namespace

TEST_CASE("an answer that the values bear out is solved") {
  const Decomposition found = split({}, z);
  CHECK(found.status == Status::solved);
  CHECK(found.x.x == x);
  CHECK(found.y.x == y);
  CHECK(found.fenchel_gap == 0);
}

TEST_CASE(
    "a prox that is wrong though its bound says rounding is not solved, and the bound covers its error") {
  for (const double error : {1e-3, 1e-6, -0.25, 3.0}) {
    CAPTURE(error);
    const Decomposition found = split({.in_x = error}, z);
    CHECK(found.status == Status::inaccurate);
    CHECK(found.error_bound >= (found.x.x - x).norm());
  }
}

TEST_CASE("a value that is wrong, too large or too small, is not solved") {
  for (const double error : {1e-4, 1.0, -1e-4, -1.0}) {
    CAPTURE(error);
    CHECK(split({.in_value = error}, z).status == Status::inaccurate);
  }
}

TEST_CASE("a point that rounding left outside the domain is moved into it, and the move is in the bound") {
  for (const double outside : {2e-16, 1e-12}) {
    CAPTURE(outside);
    const Decomposition found = split({.outside = outside}, z);
    CHECK(found.status == Status::solved);
    CHECK(found.g_y == 0);
    CHECK((found.y.x - y).norm() <= found.error_bound);
    CHECK(found.error_bound >= 0.5 * outside);
  }
}

TEST_CASE(
    "a point outside the domain by more than rounding is not taken: another is found, or it is not solved") {
  const Decomposition found = split({.outside = 1e-3}, z);
  const double error = (found.y.x - y).norm();
  CHECK(found.error_bound >= error);
  CHECK((found.status == Status::inaccurate || error <= 1e-12));
}

TEST_CASE(
    "a point and a covector that belong together, but to another point than z, are not taken for its split") {
  for (const double elsewhere : {1e-3, 1e-6, 0.25}) {
    CAPTURE(elsewhere);
    const Decomposition found = split({.elsewhere = elsewhere}, z);
    CHECK((found.x.x - x).norm() <= found.error_bound);
    CHECK((found.y.x - y).norm() <= found.error_bound);
  }
}

TEST_CASE("the bound covers a y whose own bound does not explain the residual") {
  // x = z - W^-1 v with v = (p, 1 - p) the weights of log(exp(x_1) + exp(x_2)): one equation for p.
  const Vector at{{-0.03337866437251618, 0}};
  const Matrix W{{0.2303962687201943, -0.2209100507598984}, {-0.2209100507598984, 0.21181443293000907}};
  const long double a = W(0, 0), b = W(0, 1), d = W(1, 1), determinant = a * d - b * b;
  const auto first = [&](long double p) { return (d * p - b * (1 - p)) / determinant; };
  const auto second = [&](long double p) { return (a * (1 - p) - b * p) / determinant; };
  long double low = 0, high = 1;
  for (int k = 0; k < 100; ++k) {
    const long double p = low + (high - low) / 2;
    const bool is_below = std::log(p) - std::log1p(-p) < at[0] - first(p) - (at[1] - second(p));
    (is_below ? low : high) = p;
  }
  const Decomposition found = decompose(log_sum_exp(), at, Metric::dense(W));
  const long double e = found.y.x[0] - first(low), g = found.y.x[1] - second(low);
  CHECK(std::sqrt(a * e * e + 2 * b * e * g + d * g * g) <= found.error_bound);
}
