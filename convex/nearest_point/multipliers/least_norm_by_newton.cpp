#include "convex/nearest_point/multipliers/least_norm_by_newton.hpp"

#include <cmath>

#include "convex/linear_algebra/cholesky.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// Where the rows with a multiplier do not span the others, the model has no least point; this part of the
/// squared lengths of the columns, which are 1, gives it one.
constexpr double softness_of_columns = 0x1p-40;

/// Roundings of its terms, per entry of the gradient.
constexpr double gradient_roundings = 4;

/// Of the terms of the value, within which a step to the least point may seem to rise.
constexpr double value_roundings = 16;

constexpr double enough_decrease = 1e-4;
constexpr double shortest_step = 0x1p-40;
constexpr int most_steps = 200;

}  // namespace

bool least_norm_by_newton(const Matrix& T, const std::vector<bool>& is_free, Vector& start) {
  const Index k = T.rows(), d = T.cols();
  const Vector length = (T.rowwise().squaredNorm().array() + 1).sqrt();
  Matrix E(k + d, k);
  E.topRows(k).setIdentity();
  E.bottomRows(d) = T.transpose();
  E *= length.cwiseInverse().asDiagonal();
  const Vector r = E.transpose() * start;
  const auto positive = [&](Vector lambda) {
    for (Index j = 0; j < k + d; ++j)
      if (!is_free[at(j)]) lambda[j] = std::max(0.0, lambda[j]);
    return lambda;
  };
  const auto value = [&](const Vector& y, const Vector& lambda) {
    return 0.5 * lambda.squaredNorm() - r.dot(y);
  };
  Vector y = Vector::Zero(k), lambda = Vector::Zero(k + d);
  for (int step = 0; step < most_steps; ++step) {
    const Vector gradient = E.transpose() * lambda - r;
    const Vector terms = E.cwiseAbs().transpose() * lambda.cwiseAbs() + r.cwiseAbs();
    const double roundings = gradient_roundings * std::sqrt(static_cast<double>(k + d));
    if ((gradient.cwiseAbs().array() <= roundings * unit_roundoff * terms.array()).all()) {
      start = lambda;
      return true;
    }
    Matrix loaded = E;
    for (Index j = 0; j < k + d; ++j)
      if (step > 0 && !is_free[at(j)] && !(lambda[j] > 0)) loaded.row(j).setZero();
    Matrix H = loaded.transpose() * loaded;
    H.diagonal().array() += softness_of_columns;
    const linear_algebra::Cholesky factor(H);
    if (!factor.is_definite()) return false;
    const Vector direction = -factor.solve(gradient);
    const double slope = gradient.dot(direction);
    const double before = value(y, lambda) + value_roundings * unit_roundoff *
                                                 (lambda.squaredNorm() + r.cwiseAbs().dot(y.cwiseAbs()));
    double part = 1;
    Vector next = y + direction, of_next = positive(E * next);
    while (value(next, of_next) > before + enough_decrease * part * slope && part > shortest_step) {
      part /= 2;
      next = y + part * direction;
      of_next = positive(E * next);
    }
    y = next;
    lambda = of_next;
  }
  return false;
}

}  // namespace convex::inline multiplier_sets
