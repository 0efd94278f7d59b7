#include "convex/nearest_point/methods/every_method.hpp"

#include <cmath>
#include <utility>

#include "convex/nearest_point/methods/iteration.hpp"
#include "convex/nearest_point/sparse/regularised_kkt.hpp"

namespace convex::inline algorithms {
namespace {

constexpr double relaxation = 1.6;

/// Residuals further apart than this move rho, at every so many steps; the interval grows, so that rho
/// settles.
constexpr double imbalance = 5;
constexpr Index first_interval = 20;

constexpr Index most_steps = 200000;

}  // namespace

Solution admm(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "admm", accuracy)) return *found;
  const ScaledProblem scaled(problem);
  const NearestPointProblem& within = scaled.problem;
  const Index k = within.rows();
  RegularisedKkt kkt(within);
  const std::vector<Index> rows = indices_below(k);
  double rho = 1;
  kkt.factor(rows, Vector::Constant(k, 1 / rho));
  // U q = s + w, w >= 0; y are the multipliers. q and nu: the solution of the system.
  Vector w = Vector::Zero(k), y = w, before = y, q, nu;
  const Vector zero = Vector::Zero(within.dimension());
  Index interval = first_interval, since = 0;
  return iterate(
      problem, accuracy, affordable_steps(within, most_steps, 1e6),
      [&](Index) {
        // A q - Uᵀnu = z, U q + nu/rho = s + w + y/rho: nu = y + rho (s + w - U q).
        kkt.solve(within.z, within.s + w + y / rho, q, nu);
        const Vector product = w + (y - nu) / rho;  // U q - s
        const Vector relaxed = relaxation * product + (1 - relaxation) * w, old = w;
        w = relaxed - y / rho;
        for (Index a = 0; a < k; ++a)
          w[a] = scaled.two_sided[static_cast<std::size_t>(a)] ? 0 : std::max(0.0, w[a]);
        y += rho * (w - relaxed);
        if (++since < interval) return false;
        since = 0;
        interval += interval / 2;
        const double primal = (product - w).norm() / std::max({product.norm(), w.norm(), 1e-300});
        const double dual = rho * (w - old).norm() / std::max(y.norm(), 1e-300);
        const double ratio = std::sqrt(primal / std::max(dual, 1e-300));
        if (!(ratio > imbalance || ratio < 1 / imbalance) || !std::isfinite(ratio)) return false;
        rho = std::clamp(rho * ratio, 1e-8, 1e8);
        kkt.factor(rows, Vector::Constant(k, 1 / rho));
        return false;
      },
      [&](Index) { return unscaled("admm", scaled, scaled.motion(q), y, y - std::exchange(before, y)); });
}

}  // namespace convex::inline algorithms
