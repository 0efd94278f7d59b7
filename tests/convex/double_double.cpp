#include "convex/double_double.hpp"

#include <doctest/doctest.h>
#include <gmpxx.h>

#include <random>

#include "convex/linear_algebra/orthogonal_factor.hpp"

using convex::DoubleDouble;
using convex::Index;
using convex::Matrix;
using convex::Vector;

TEST_CASE("a dot product of terms that cancel has twice the digits, as fractions show") {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (Index n : {1, 3, 8, 21, 100}) {
    Vector x(2 * n + 1), y(2 * n + 1);
    for (Index i = 0; i < n; ++i) {
      x[i] = normal(generator);
      y[i] = normal(generator) * 1e8;
      x[n + i] = -x[i];
      y[n + i] = y[i] * (1 + 0x1p-40 * normal(generator));
    }
    x[2 * n] = y[2 * n] = 1e-3;
    mpq_class exact = 0, size = 0;
    for (Index i = 0; i < x.size(); ++i) {
      exact += mpq_class(x[i]) * mpq_class(y[i]);
      size += abs(mpq_class(mpq_class(x[i]) * mpq_class(y[i])));
    }
    const Vector zero = Vector::Zero(x.size());
    const DoubleDouble sum = convex::dot(x.size(), x.data(), y.data(), zero.data());
    const mpq_class error = abs(mpq_class(mpq_class(sum.hi) + mpq_class(sum.lo) - exact));
    // Ogita, Rump and Oishi 2005: n² u² times the sum of the absolute terms.
    CHECK(error.get_d() <= std::pow(static_cast<double>(x.size()) * convex::unit_roundoff, 2) * size.get_d());
    Vector hi = Vector::Zero(1), lo = Vector::Zero(1);
    for (Index i = 0; i < x.size(); ++i) convex::add_multiple(1, &x[i], {y[i], 0}, hi.data(), lo.data());
    const mpq_class other = abs(mpq_class(mpq_class(hi[0]) + mpq_class(lo[0]) - exact));
    CHECK(other.get_d() <= std::pow(static_cast<double>(x.size()) * convex::unit_roundoff, 2) * size.get_d());
  }
}

TEST_CASE("the factor of rows that come and go stays orthogonal and keeps their product") {
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  const Index n = 40;
  convex::linear_algebra::OrthogonalFactor factor(n, n);
  std::vector<Vector> rows;
  for (int step = 0; step < 400; ++step) {
    if (!rows.empty() && (static_cast<Index>(rows.size()) == n || generator() % 3 == 0)) {
      const std::size_t k = generator() % rows.size();
      factor.remove(static_cast<Index>(k));
      rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(k));
    } else {
      Vector v(n), c(n);
      for (Index i = 0; i < n; ++i)
        v[i] = normal(generator) * (step % 7 == 0 ? 1e-8 : 1) + (step % 5 == 0 ? 1 : 0);
      Vector d = v;
      const double rho = factor.split(d, c);
      factor.append(c, d, rho);
      rows.push_back(v);
    }
  }
  const Index k = factor.size();
  REQUIRE(k == static_cast<Index>(rows.size()));
  CHECK((factor.Q().transpose() * factor.Q() - Matrix::Identity(k, k)).norm() <= 1e-13);
  for (Index j = 0; j < k; ++j) {
    const Vector& v = rows[static_cast<std::size_t>(j)];
    Vector r = factor.Q().transpose() * v, x = r;
    factor.solve_upper(x);  // R x = Qᵀv_j has the solution e_j
    CHECK((x - Vector::Unit(k, j)).norm() <= 1e-5);
    CHECK(std::abs(factor.length(j) - v.norm()) <= 1e-13 * v.norm());
  }
}
