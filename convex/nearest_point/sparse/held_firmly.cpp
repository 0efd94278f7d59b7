#include "convex/nearest_point/sparse/held_firmly.hpp"

#include <cmath>

namespace convex::inline sparse {
namespace {

/// So many powers at most. What is left of numbers of size 1, the least part among them allowed for, is then
/// the largest factor to that power: below 1/4.
constexpr int most_powers = 8;
constexpr double vanished = 1e-12;

/// A combination of doubles that is 0 but for so many roundings of its terms.
constexpr double roundings = 64;

}  // namespace

Vector slowest_residual(const BalancedProblem& scaled, const RowSystem& system,
                        const std::vector<Index>& rows, const Vector& weight) {
  Vector left = Vector::Zero(scaled.s.size());
  const Vector held = (weight.array() > 0).cast<double>();
  double k = 0;
  for (Index a : rows) {
    const double golden = 0.6180339887498949 * ++k;
    const double part = golden - std::floor(golden);
    left[a] = part < 0.5 ? part - 1 : part;  // of size 1/2 … 1
  }
  for (int power = 0; power < most_powers && !is_held_firmly(left); ++power) {
    const Vector push = scaled.U.transpose() * left.cwiseProduct(weight);
    left -= (scaled.U * system.solve(push)).cwiseProduct(held);
  }
  return left;
}

bool is_held_firmly(const Vector& slowest) {
  return slowest.size() == 0 || slowest.cwiseAbs().maxCoeff() <= vanished;
}

bool is_zero_within(const NearestPointProblem& problem, const BalancedProblem& scaled, const Vector& y) {
  const Vector sum = scaled.U.transpose() * y, terms = scaled.U.cwiseAbs().transpose() * y.cwiseAbs();
  double radius = 0;
  if (problem.radii)
    for (Index a = 0; a < y.size(); ++a)
      radius += std::abs(y[a]) * problem.radii->row[a] * std::sqrt(scaled.multiplier[a] / scaled.bound[a]);
  return sum.norm() <= radius + roundings * unit_roundoff * terms.norm();
}

}  // namespace convex::inline sparse
