#include "convex/prox_formulas/capped_simplex.hpp"

#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/water_level.hpp"

namespace convex::prox_formulas {

namespace {

void require_metric(const Vector& z, const Vector& d) {
  if (d.size() != z.size())
    throw InvalidInput("metric: " + std::to_string(d.size()) + " weights for a point of " +
                       std::to_string(z.size()) + "; give one an entry");
  if (d.size() > 0 && !(d.minCoeff() > 0 && d.maxCoeff() < infinity))
    throw InvalidInput("metric: a weight is not positive and finite; give positive weights");
}

void require_capped(Index n, double cap, double total) {
  if (!(cap >= 0 && cap < infinity && total >= 0 && total <= static_cast<double>(n) * cap))
    throw InvalidInput("capped simplex: a total of " + std::to_string(total) + " of " +
                       counted(n, "entry", "entries") + " between 0 and " + std::to_string(cap) +
                       " is impossible; the set is empty");
}

void require_largest(Index n, double k, double weight) {
  if (!(k >= 0 && k <= static_cast<double>(n)))
    throw InvalidInput("sum_largest: k is " + std::to_string(k) + " for " + counted(n, "entry", "entries") +
                       "; give 0 <= k <= n");
  if (!(weight >= 0 && weight < infinity))
    throw InvalidInput("sum_largest: the weight is " + std::to_string(weight) +
                       "; give a finite number that is not negative");
}

/// The largest power of two that is at most the largest weight.
double unit_of(const Vector& d) { return d.size() > 0 ? std::ldexp(1, std::ilogb(d.maxCoeff())) : 1; }

/// Entries held together at one level: Σ_M d_j (z_j - level) is constant, so x_i follows the mean.
Matrix pooled(const std::vector<bool>& at_level, const Vector& d) {
  const Index n = d.size();
  Vector share = Vector::Zero(n), held = Vector::Zero(n);
  for (Index i = 0; i < n; ++i)
    if (at_level[static_cast<std::size_t>(i)]) {
      share[i] = d[i];
      held[i] = 1;
    }
  const double sum = share.sum();
  Matrix J = Matrix::Zero(n, n);
  if (sum > 0) J = held * (share / sum).transpose();
  return J;
}

}  // namespace

Vector proj_capped_simplex(const Vector& z, double cap, double total) {
  return proj_capped_simplex(z, cap, total, Vector::Ones(z.size()));
}

Vector proj_capped_simplex(const Vector& z, double cap, double total, const Vector& d) {
  require_metric(z, d);
  require_capped(z.size(), cap, total);
  return clamped_to_total(z, d / unit_of(d), cap, total);
}

Vector prox_sum_largest(const Vector& z, double k, double weight) {
  return prox_sum_largest(z, k, weight, Vector::Ones(z.size()));
}

Vector prox_sum_largest(const Vector& z, double k, double weight, const Vector& d) {
  require_metric(z, d);
  require_largest(z.size(), k, weight);
  if (!(weight > 0 && k > 0)) return z;
  const double unit = unit_of(d), scaled = weight / unit;
  const Vector metric = d / unit;
  const double level = exact_water_level(z, metric, scaled, scaled * k);
  return z.array().min(level).max(z.array() - scaled / metric.array());
}

Matrix proj_capped_simplex_jacobian(const Vector& z, double cap, double total, const Vector& d) {
  const Vector x = proj_capped_simplex(z, cap, total, d);
  const Index n = z.size();
  std::vector<bool> open(static_cast<std::size_t>(n));
  Vector inside = Vector::Zero(n);
  for (Index i = 0; i < n; ++i)
    if (x[i] > 0 && x[i] < cap) {
      open[static_cast<std::size_t>(i)] = true;
      inside[i] = 1;
    }
  const Matrix J = inside.asDiagonal();
  return J - pooled(open, d.cwiseInverse()).transpose();
}

}  // namespace convex::prox_formulas
