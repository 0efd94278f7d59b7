#include "convex/nearest_point/sparse/sparse_refinement.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/optimality/kkt_residual.hpp"

namespace convex::inline sparse {
namespace {

/// As for dense problems: corrections end when less than this part of the scale is missing, or at the
/// rounding of the residuals; slower ones than `slowest` are not trusted.
constexpr double enough = 0x1p-64, at_rounding = 0x1p-84, slowest = 0.7;
constexpr int most_corrections = 60;

/// A small part that shrinks slowly hides behind a large one that does not: no correction is held to be
/// better.
constexpr double fastest = 0x1p-10;

/// So many corrections may be slow at the beginning: the multipliers of a start are far from the equations.
constexpr int first_corrections = 3;

constexpr double rounding = 0x1p-52;

/// A multiplier is plainly negative when this many times what corrections may still do to it.
constexpr double plainly = 100;

bool plainly_negative(const BalancedProblem& scaled, const std::vector<Index>& rows,
                      const DoubleDoubleVector& lambda, const SparsePoint& point) {
  double push = 0;
  for (Index k = 0; k < static_cast<Index>(rows.size()); ++k)
    push = std::max(push, std::abs(lambda.hi[k] / scaled.multiplier[rows[at(k)]]));
  for (Index k = 0; k < static_cast<Index>(rows.size()); ++k) {
    const Index a = rows[at(k)];
    if (scaled.two_sided[at(a)]) continue;
    if (lambda.hi[k] / scaled.multiplier[a] <
        -plainly * (point.last_lambda[a] + point.remaining() + rounding * push))
      return true;
  }
  return false;
}

/// The terms of z + U_Sᵀlambda, whose sums in twice the precision are rounded by u² of them: multipliers of
/// rows that are nearly opposite cancel there.
double size_of_terms(const BalancedProblem& scaled, const std::vector<Index>& rows,
                     const DoubleDoubleVector& lambda) {
  Vector pull = Vector::Zero(scaled.s.size());
  for (Index k = 0; k < static_cast<Index>(rows.size()); ++k) {
    const Index a = rows[at(k)];
    pull[a] = std::abs(lambda.hi[k]) / scaled.multiplier[a];
  }
  return (scaled.z.cwiseAbs() + scaled.U.cwiseAbs().transpose() * pull).norm();
}

/// Weights of `central_weights` reach from this part of the largest to it.
constexpr double least_part = 1e-2;

}  // namespace

void drop_noise(const BalancedProblem& scaled, SparsePoint& point) {
  Vector dropped = Vector::Zero(point.q.size());
  for (Index i = 0; i < point.q.size(); ++i)
    if (std::abs(point.q.hi[i]) <= 2 * point.remaining() * scaled.coordinate[i]) {
      dropped[i] = point.q.hi[i] / scaled.coordinate[i];
      point.q.hi[i] = point.q.lo[i] = 0;
    }
  point.dropped = std::sqrt(std::max(0.0, dropped.dot(scaled.A * dropped)));
}

Vector even_weights(Index row_count, const std::vector<Index>& rows, double delta) {
  Vector weight = Vector::Zero(row_count);
  for (Index a : rows) weight[a] = 1 / delta;
  return weight;
}

Vector central_weights(const BalancedProblem& scaled, const std::vector<Index>& rows, double delta,
                       const SparsePoint& point) {
  Vector weight = Vector::Zero(scaled.s.size());
  double mean = 0;
  for (Index a : rows) mean += std::abs(point.lambda.hi[a]) / scaled.multiplier[a];
  mean /= static_cast<double>(std::max<std::size_t>(1, rows.size()));
  for (Index a : rows) {
    const double part = mean > 0 ? point.lambda.hi[a] / scaled.multiplier[a] / mean : 0;
    weight[a] = std::clamp(part * part, least_part, 1.0) / (least_part * delta);
  }
  return weight;
}

bool refine_rows(const NearestPointProblem& problem, const BalancedProblem& scaled, RowSystem& system,
                 const std::vector<Index>& rows, const Vector& weight, double zero, SparsePoint& point) {
  if (!system.factor(weight)) return false;
  const Index count = static_cast<Index>(rows.size());
  DoubleDoubleVector lambda(count);
  Vector r2(count), push = Vector::Zero(problem.rows()), dlambda(count);
  const Vector scale_of_q = scaled.coordinate;
  for (Index k = 0; k < count; ++k) {
    const Index a = rows[at(k)];
    lambda.hi[k] = point.lambda.hi[a];
    lambda.lo[k] = point.lambda.lo[a];
  }
  double previous = 0;
  const double scale = std::max(1.0, point.q.hi.cwiseQuotient(scaled.coordinate).norm());
  point.converged = point.wrong_signs = false;
  point.contraction = fastest;
  point.floor = 0;
  point.last_lambda = Vector::Zero(problem.rows());
  for (int k = 0; k < most_corrections; ++k) {
    const Vector magnitude = zero > 0 ? Vector(point.q.hi.cwiseAbs()) : Vector();
    const Vector r1 = stationarity_residual(problem, point.q, rows, lambda).cwiseQuotient(scaled.linear);
    for (Index j = 0; j < count; ++j) {
      const Index a = rows[at(j)];
      r2[j] = -slack(problem, a, point.q).value() / scaled.bound[a];
      if (zero > 0) {
        const double terms = std::abs(problem.s[a]) + problem.U.absolute_dot(a, magnitude);
        if (std::abs(r2[j]) * scaled.bound[a] <= zero * terms) r2[j] = 0;
      }
      push[a] = r2[j] * weight[a];
    }
    const Vector dq = system.solve(r1 + scaled.U.transpose() * push);
    const Vector along = scaled.U * dq;
    for (Index j = 0; j < count; ++j) {
      const Index a = rows[at(j)];
      const double step = (r2[j] - along[a]) * weight[a];
      point.last_lambda[a] = std::abs(step);
      dlambda[j] = step * scaled.multiplier[a];
    }
    point.q.add(dq.cwiseProduct(scale_of_q));
    lambda.add(dlambda);
    point.last = std::sqrt(std::max(0.0, dq.dot(scaled.A * dq)));
    if (!std::isfinite(point.last)) return false;
    const double floor = at_rounding * scale;
    if (point.last <= floor || point.last <= enough * scale)
      point.floor = 4 * unit_roundoff * unit_roundoff * size_of_terms(scaled, rows, lambda);
    if (k >= first_corrections && point.last > floor)
      point.contraction = std::max(point.contraction, point.last / previous);
    else if (k > 0 && point.last > floor)
      point.contraction = std::max(fastest, point.last / previous);
    if (k >= first_corrections && !(point.contraction < slowest)) break;
    // Rows that contradict each other leave q alone and let their multipliers grow for ever.
    point.rest = count > 0 ? r2.cwiseAbs().maxCoeff() : 0;
    const bool held = point.rest <= held_to * scale;
    if (k > 0 && held &&
        (point.last <= floor || (!point.to_the_end && point.remaining() <= enough * scale))) {
      point.converged = true;
      break;
    }
    if (k > 0 && point.contraction < slowest && plainly_negative(scaled, rows, lambda, point)) {
      point.wrong_signs = true;
      break;
    }
    previous = point.last;
  }
  point.lambda = DoubleDoubleVector(problem.rows());
  for (Index k = 0; k < count; ++k) {
    const Index a = rows[at(k)];
    point.lambda.hi[a] = lambda.hi[k];
    point.lambda.lo[a] = lambda.lo[k];
  }
  return true;
}

}  // namespace convex::inline sparse
