#pragma once

namespace convex::inline operations {

/// x(t) = prox of (1 - t) f + t g in a metric W at z, as found: the prox at a point whose distance to z is at
/// most `error`, ||W(x - z) + v||_(W⁻¹) with v in the subdifferential at x, for a weight within `rounding`
/// of t; and g - f at this x, within `noise`.
struct ProxOfMean {
  double t = 0, rounding = 0;
  double error = 0;
  double difference = 0, noise = 0;
};

/// Where the weight t* is, of the mean whose prox x* is that of max(f, g): where (g - f)(x*) = 0, at t* = 0
/// if it is negative, at t* = 1 if it is positive.
///
/// The two inequalities of subgradients, of the means with t at x and with t* at x*, add up to
///   ||x - x*||² <= (t - t*) ((g - f)(x*) - (g - f)(x)) + error ||x - x*||,
/// where (t - t*) (g - f)(x*) <= 0. If (g - f)(x) = d > 0 and t* < t, the first term on the right is at most
/// -(t - t*) d, so that t - t* <= error² / (4 d); likewise on the other side. What x(t) misses counts in t*
/// by its square, with no slope of f or g. And with d times what is left of t* beyond t,
///   ||x - x*|| <= error / 2 + sqrt(error² / 4 + d |t* - t|).
class WeightRange {
 public:
  /// Leaves out what this prox excludes.
  void learn(const ProxOfMean& found);
  /// Of x, in ||·||_W.
  double error_of(const ProxOfMean& found) const;
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_ = 0, high_ = 1;
};

}  // namespace convex::inline operations
