#include "convex/nearest_point/multipliers/largest_move.hpp"

#include <array>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/sparse/regularised_kkt.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// Rows that depend on others are held as softly as this part of their length squared: errors along them that
/// no motion can follow do not count.
constexpr double softness = 1e-12;

constexpr int most_climbs = 5;

/// Where all push the same way, and where neighbours push against each other.
std::array<Vector, 2> starts(const Vector& size) {
  Vector alternating = size;
  for (Index i = 1; i < size.size(); i += 2) alternating[i] = -size[i];
  return {size, alternating};
}

Vector with_signs(const Vector& size, const Vector& of) {
  return size.binaryExpr(of, [](double r, double x) { return x < 0 ? -r : r; });
}

}  // namespace

double largest_move(const NearestPointProblem& problem, const std::vector<Index>& held, const Vector& balance,
                    const Vector& rows) {
  if (!balance.allFinite() || !rows.allFinite()) return infinity;
  if (balance.isZero(0) && rows.isZero(0)) return 0;
  const Vector length = dual_lengths(problem, held);
  Vector theta(rows.size());
  for (Index k = 0; k < rows.size(); ++k) {
    const double of_row = length[held[static_cast<std::size_t>(k)]];
    theta[k] = of_row > 0 ? softness * of_row * of_row : 1;
  }
  RegularisedKkt kkt(problem);
  if (!kkt.factor(held, theta)) return infinity;
  const auto pushes = starts(balance), gaps = starts(rows);
  double largest = 0;
  for (std::size_t start = 0; start < pushes.size(); ++start) {
    Vector r1 = pushes[start], r2 = gaps[start], dq, dlambda;
    double reached = -1;
    for (int climb = 0; climb < most_climbs; ++climb) {
      kkt.solve(r1, r2, dq, dlambda);
      const double move = problem.A.norm(dq);
      if (!std::isfinite(move)) return infinity;
      if (!(move > reached)) break;
      reached = move;
      kkt.solve(problem.A.multiply(dq), Vector::Zero(rows.size()), dq, dlambda);
      r1 = with_signs(balance, dq);
      r2 = with_signs(rows, -dlambda);
    }
    largest = std::max(largest, reached);
  }
  return largest;
}

double largest_move(const Metric& A, const Vector& balance) {
  if (!balance.allFinite()) return infinity;
  if (A.kind() == MetricKind::diagonal || A.kind() == MetricKind::identity) return A.dual_norm(balance);
  double largest = 0;
  for (Vector push : starts(balance)) {
    double reached = -1;
    for (int climb = 0; climb < most_climbs; ++climb) {
      const Vector dq = A.solve(push);
      const double move = std::sqrt(std::max(0.0, push.dot(dq)));
      if (!std::isfinite(move)) return infinity;
      if (!(move > reached)) break;
      reached = move;
      push = with_signs(balance, dq);
    }
    largest = std::max(largest, reached);
  }
  return largest;
}

}  // namespace convex::inline multiplier_sets
