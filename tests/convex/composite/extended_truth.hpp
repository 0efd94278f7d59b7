#pragma once

#include <Eigen/LU>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <functional>
#include <random>

#include <doctest/doctest.h>

#include "convex/gamma0/prox.hpp"
#include "convex/metric.hpp"

/// Proxes from their optimality conditions, in 50 digits.
namespace samples {

using Extended =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
using ExtendedVector = Eigen::Matrix<Extended, Eigen::Dynamic, 1>;
using ExtendedMatrix = Eigen::Matrix<Extended, Eigen::Dynamic, Eigen::Dynamic>;

/// W(x - z) + gradient(x) + Aᵀ lambda = 0, Ax = b: what a prox satisfies where f is smooth on {Ax = b}.
struct Conditions {
  std::function<ExtendedVector(const ExtendedVector&)> gradient;
  std::function<ExtendedMatrix(const ExtendedVector&)> hessian;
  convex::Matrix A;
  convex::Vector b;
};

struct Truth {
  ExtendedVector x, lambda;
};

/// The solution of the conditions near `start`, by Newton's method in extended precision until it stands
/// still.
inline Truth truth(const convex::Matrix& W, const convex::Vector& z, const Conditions& conditions,
                   const convex::Vector& start) {
  const convex::Index n = z.size(), m = conditions.b.size();
  const ExtendedMatrix wide = W.cast<Extended>(), A = conditions.A.cast<Extended>();
  Truth at{start.cast<Extended>(), ExtendedVector::Zero(m)};
  const auto norm = [&](const ExtendedVector& x) { return Extended(sqrt(Extended(x.dot(wide * x)))); };
  Extended step = 1, size = 1;
  for (int i = 0; i < 40 && step > 1e-40 * size; ++i) {
    ExtendedMatrix K = ExtendedMatrix::Zero(n + m, n + m);
    K.topLeftCorner(n, n) = wide + conditions.hessian(at.x);
    ExtendedVector F = ExtendedVector::Zero(n + m);
    F.head(n) = wide * (at.x - z.cast<Extended>()) + conditions.gradient(at.x);
    if (m > 0) {
      K.topRightCorner(n, m) = A.transpose();
      K.bottomLeftCorner(m, n) = A;
      F.head(n) += A.transpose() * at.lambda;
      F.tail(m) = A * at.x - conditions.b.cast<Extended>();
    }
    const ExtendedVector d = K.fullPivLu().solve(-F);
    at.x += d.head(n);
    at.lambda += d.tail(m);
    step = norm(d.head(n));
    size = norm(at.x) + norm(z.cast<Extended>());
  }
  REQUIRE(step <= 1e-20 * size);
  return at;
}

inline double error(const convex::Matrix& W, const convex::Vector& x, const ExtendedVector& exact) {
  const ExtendedVector d = x.cast<Extended>() - exact;
  return static_cast<double>(Extended(sqrt(Extended(d.dot(W.cast<Extended>() * d)))));
}

/// What issue 3 asks of a prox by iteration: relative to ||z||_W + ||x||_W, and a bound that holds.
inline void check_accuracy(const convex::Prox& found, const ExtendedVector& exact, const convex::Metric& W,
                           const convex::Vector& z) {
  const double size = W.norm(z) + W.norm(found.x);
  const double true_error = error(W.dense_gram(), found.x, exact);
  CHECK(found.status == convex::Status::solved);
  CHECK(found.route == convex::ProxRoute::iterative);
  CHECK(true_error <= 1e-12 * size);
  CHECK(found.error_bound <= 1e-12 * size);
  CHECK(true_error <= found.error_bound);
}

/// A metric with eigenvalues spread evenly, in the logarithm, around `middle`, along random directions.
inline convex::Metric random_metric(std::mt19937& generator, convex::Index n, double condition,
                                    double middle = 1) {
  std::normal_distribution<double> normal;
  convex::Matrix W = convex::Matrix::Identity(n, n);
  for (convex::Index i = 0; i < n; ++i)
    W(i, i) =
        middle * std::pow(condition, n == 1 ? 0 : static_cast<double>(i) / static_cast<double>(n - 1) - 0.5);
  for (int reflection = 0; reflection < 4; ++reflection) {
    convex::Vector v(n);
    for (double& a : v) a = normal(generator);
    const convex::Matrix H = convex::Matrix::Identity(n, n) - 2 / v.squaredNorm() * v * v.transpose();
    W = H * W * H;
  }
  return convex::Metric::dense(0.5 * (W + W.transpose()));
}

inline convex::Vector random_vector(std::mt19937& generator, convex::Index n, double size = 1) {
  std::normal_distribution<double> normal(0, size);
  convex::Vector z(n);
  for (double& a : z) a = normal(generator);
  return z;
}

}  // namespace samples
