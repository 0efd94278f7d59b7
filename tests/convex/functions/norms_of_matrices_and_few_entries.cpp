#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "convex/functions/log_sum_exp.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/sparse_norms.hpp"
#include "convex/functions/spectral_norms.hpp"

using namespace convex;

/// Values and proxes of the functions of few entries and of matrices, by definitions and closed forms other
/// than those that the functions use.
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<Vector> random_points(Index n, int count) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  std::vector<Vector> points;
  for (int i = 0; i < count; ++i) {
    Vector x(n);
    for (double& entry : x) entry = i % 3 == 0 ? std::round(2 * normal(generator)) : normal(generator);
    points.push_back(x);
  }
  return points;
}

/// The largest Euclidean norm of k of the entries, over all sets of k.
double largest_part(const Vector& v, int k) {
  double most = 0;
  for (unsigned set = 0; set < 1U << static_cast<unsigned>(v.size()); ++set) {
    if (__builtin_popcount(set) != k) continue;
    double squares = 0;
    for (Index i = 0; i < v.size(); ++i)
      if ((set >> static_cast<unsigned>(i) & 1U) != 0) squares += v[i] * v[i];
    most = std::max(most, std::sqrt(squares));
  }
  return most;
}

Vector prox_at(const Function& f, const Vector& z) { return f.prox(z, Metric::identity(z.size())).x; }

}  // namespace

TEST_CASE("the k-support norm is the support function of the ball of the k largest entries") {
  for (int k = 1; k <= 5; ++k) {
    const Function f = k_support(k);
    for (const Vector& x : random_points(5, 30)) {
      const double norm = f(x);
      const Vector v = *f.subgradient(x);
      CHECK(largest_part(v, k) <= 1 + 1e-14);
      CHECK(v.dot(x) == doctest::Approx(norm).epsilon(1e-14));
      for (const Vector& w : random_points(5, 10))
        CHECK(x.dot(w) <= norm * largest_part(w, k) * (1 + 1e-14) + 1e-300);
      if (k == 1) CHECK(norm == doctest::Approx(x.lpNorm<1>()).epsilon(1e-14));
      if (k == 5) CHECK(norm == doctest::Approx(x.norm()).epsilon(1e-14));
      // What the prox takes away is the nearest point of the ball, and it goes to its boundary.
      const Vector y = x - prox_at(k_support(k, 0.5), x);
      CHECK(largest_part(y, k) == doctest::Approx(std::min(0.5, largest_part(x, k))).epsilon(1e-13));
    }
  }
}

TEST_CASE("the prox of the k-support norm is right to roundings of z just outside of the ball of its dual") {
  for (const double out : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    // With k = 1 it is the 1-norm, whose prox takes 1 away from every entry, as far as there is 1.
    const Vector z{{0, 1 + out, -1, 0.5}};
    const Vector soft{{0, z[1] - 1, 0, 0}};
    CHECK((prox_at(k_support(1), z) - soft).norm() <= 1e-15);
    // With k = n it is the norm itself.
    const Vector w = (1 + out) * Vector{{0.6, 0.8}};
    CHECK((prox_at(k_support(2), w) - (w.norm() - 1) / w.norm() * w).norm() <= 1e-15);
    // With k = 2 the ball is |z_1|² + |z_2|² <= 1 of the largest two: out along its normal.
    const Vector edge{{0.8, 0.6, 0.1}};
    CHECK((prox_at(k_support(2), edge + out * Vector{{0.8, 0.6, 0}}) - out * Vector{{0.8, 0.6, 0}}).norm() <=
          1e-15);
  }
}

TEST_CASE("a Schatten norm is the nuclear, the Frobenius and the largest singular value, and for 4 a trace") {
  for (const Vector& x : random_points(6, 20)) {
    const Matrix X = x.reshaped(2, 3);
    CHECK(schatten(1, 2)(x) == doctest::Approx(nuclear_norm(1, 2)(x)).epsilon(1e-14));
    CHECK(schatten(2, 2)(x) == doctest::Approx(x.norm()).epsilon(1e-14));
    const Matrix G = X * X.transpose();  // its eigenvalues are the squares
    const double half = (G(0, 0) - G(1, 1)) / 2, root = std::hypot(half, G(0, 1));
    CHECK(schatten(infinite, 2)(x) ==
          doctest::Approx(std::sqrt((G(0, 0) + G(1, 1)) / 2 + root)).epsilon(1e-13));
    CHECK(schatten(4, 2)(x) == doctest::Approx(std::sqrt(G.norm())).epsilon(1e-13));
    CHECK((prox_at(schatten(1, 2, 0.7), x) - prox_at(nuclear_norm(0.7, 2), x)).norm() <= 1e-14);
    CHECK((prox_at(schatten(2, 2, 0.7), x) - prox_at(norm2(0.7), x)).norm() <= 1e-14);
    // 0 = x - z + weight X(XᵀX)/|X|_4^3 at the prox x of |.|_4.
    const Vector p = prox_at(schatten(4, 2, 0.7), x);
    if (p.norm() == 0) continue;
    const Matrix P = p.reshaped(2, 3);
    const Matrix slope = P * (P.transpose() * P) / std::pow((P.transpose() * P).norm(), 1.5);
    CHECK((P - X + 0.7 * slope).norm() <= 1e-13 * (1 + X.norm()));
  }
}

TEST_CASE("the largest eigenvalue of two by two matrices, and the prox that lowers it alone") {
  for (const Vector& x : random_points(3, 20)) {
    const Vector stacked{{x[0], x[1], x[1], x[2]}};
    const double mean = (x[0] + x[2]) / 2, root = std::hypot((x[0] - x[2]) / 2, x[1]);
    const Function f = max_eigenvalue();
    CHECK(f(stacked) == doctest::Approx(mean + root).epsilon(1e-14));
    CHECK(f(Vector{{x[0], x[1], x[1] + 1, x[2]}}) == infinite);
    // The larger eigenvalue goes down by 1, and both together once they have met.
    const Vector p = prox_at(f, stacked);
    const double top = 2 * root >= 1 ? mean + root - 1 : mean - 0.5;
    CHECK(f(p) == doctest::Approx(top).epsilon(1e-13));
    CHECK(p[0] + p[3] == doctest::Approx(2 * mean - 1).epsilon(1e-13));
  }
}

TEST_CASE(
    "the prox of log sum exp solves x + softmax x = z, and its conjugate is the entropy of the simplex") {
  for (const Vector& z : random_points(5, 20)) {
    const Vector x = prox_at(log_sum_exp(), 30 * z);
    long double sum = 0;
    for (const double entry : x) sum += std::exp(static_cast<long double>(entry - x.maxCoeff()));
    for (Index i = 0; i < x.size(); ++i) {
      const long double share = std::exp(static_cast<long double>(x[i] - x.maxCoeff())) / sum;
      CHECK(std::abs(static_cast<double>(x[i] + share - 30 * static_cast<long double>(z[i]))) <= 1e-13);
    }
  }
  const Function g = log_sum_exp().conjugate();
  CHECK(g(Vector{{0.5, 0.25, 0.25}}) == doctest::Approx(-1.5 * std::log(2)).epsilon(1e-15));
  CHECK(g(Vector{{1, 0, 0}}) == 0);
  CHECK(g(Vector{{0.5, 0.25, 0.3}}) == infinite);
  CHECK(to_text(g.call()) == "sum(entropy(), indicator(simplex(total=1)))");
}

TEST_CASE("the pinball loss shrinks by its two slopes") {
  for (const double tau : {0.0, 0.1, 0.5, 0.9, 1.0})
    for (const double z : {-3.0, -0.5, 0.0, 0.05, 0.95, 4.0}) {
      const double expected = z > tau ? z - tau : z < tau - 1 ? z + 1 - tau : 0;
      CHECK(prox_at(pinball(tau), Vector{{z}})[0] == doctest::Approx(expected).epsilon(1e-15));
      CHECK(pinball(tau)(Vector{{z}}) == doctest::Approx(z > 0 ? tau * z : (tau - 1) * z).epsilon(1e-15));
    }
}

TEST_CASE("total variation in the plane is that of a line in one column, and of the transpose") {
  for (const Vector& x : random_points(6, 20)) {
    CHECK(total_variation_2d(0.4, 6, 6)(x) == doctest::Approx(total_variation(0.4)(x)).epsilon(1e-14));
    CHECK((prox_at(total_variation_2d(0.4, 6, 6), x) - prox_at(total_variation(0.4), x)).norm() <= 1e-13);
    const Matrix transposed = x.reshaped(2, 3).transpose();
    const Vector t = transposed.reshaped();
    CHECK(total_variation_2d(1, 2, 6)(x) == doctest::Approx(total_variation_2d(1, 3, 6)(t)).epsilon(1e-14));
    const Vector p = prox_at(total_variation_2d(0.3, 2, 6), x),
                 of_t = prox_at(total_variation_2d(0.3, 3, 6), t);
    const Matrix back = of_t.reshaped(3, 2).transpose();
    CHECK((p - back.reshaped()).norm() <= 1e-13);
    // By the definition.
    double sum = 0;
    const Matrix X = x.reshaped(2, 3);
    for (Index i = 0; i < 2; ++i)
      for (Index j = 0; j < 3; ++j) {
        if (i + 1 < 2) sum += std::abs(X(i + 1, j) - X(i, j));
        if (j + 1 < 3) sum += std::abs(X(i, j + 1) - X(i, j));
      }
    CHECK(total_variation_2d(1, 2, 6)(x) == doctest::Approx(sum).epsilon(1e-14));
  }
}
