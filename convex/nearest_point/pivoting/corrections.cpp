#include "convex/nearest_point/pivoting/corrections.hpp"

#include <algorithm>
#include <cmath>

namespace convex::inline pivoting {
namespace {

/// Slower corrections are left to an orthogonal factor.
constexpr double slowest_contraction = 0x1p-6;

}  // namespace

bool Corrections::note(const GramPoint& made) {
  const double previous = step_, step = made.step;
  double pull = 0;
  for (Index k = 0; k < made.size; ++k) pull += std::abs(made.change[k]) * made.length[k];
  step_ = step;
  scale = made.norm();
  is_fresh_ = made.is_fresh;
  count_ += 1;
  factor_condition_ = made.factor_condition;
  gram_condition_ = made.gram_condition;
  const double seen = is_fresh_                                    ? (scale > 0 ? step / scale : 0)
                      : step > at_rounding * scale && previous > 0 ? step / previous
                                                                   : 0;
  const double usual = std::max(seen, usual_contraction(factor_condition_, gram_condition_));
  // A residual is rounded once, and the factors of A and of the rows of the working set enlarge that; a
  // second correction with the same rows shows by how much. An inverse is off by the square of its growth
  // where it is small.
  const double contraction = std::max(
      unit_roundoff * made.growth * made.growth,
      is_fresh_ ? std::max(seen, expected_contraction(factor_condition_, gram_condition_, true)) : usual);
  if (!(contraction <= slowest_contraction)) return false;
  const double growth = std::max(std::sqrt(gram_condition_), made.growth);
  const double floor = floor_of_residuals() + pull * pull_rounding(factor_condition_, growth);
  remaining = step * contraction / (1 - contraction) + floor;
  likely_ = std::min(remaining, step * usual + floor);
  return true;
}

/// What the rounding of residuals in twice the working precision leaves.
double Corrections::floor_of_residuals() const {
  return 4 * unit_roundoff * unit_roundoff * factor_condition_ * (1 + std::sqrt(gram_condition_)) * scale;
}

bool Corrections::take_noise_for_zero(GramPoint& point, bool more) {
  const double usual = usual_contraction(factor_condition_, gram_condition_);
  const double missing = 4 * likely_ * factor_condition_;
  // An entry is noise up to the larger of `of_unit` units and this part of its step; the second correction of
  // an entry is more than what is missing in it, and what is far below the scale then is rounding of
  // residuals.
  const double floor = at_rounding * scale,
               of_unit = is_fresh_ ? std::max(missing, count_ > 1 ? floor : 0) : floor,
               of_multiplier = is_fresh_ ? missing : floor_of_residuals(),
               of_step = is_fresh_ ? cancelled : 2;
  const auto is_noise = [&](Index i) {
    return std::abs(point.q[i]) <= std::max(of_unit * point.unit[i], of_step * std::abs(point.dq[i]));
  };
  Index noisy = 0, unclear = 0;
  double rounded = 0, zeroed = 0, let_pull = 0;
  for (Index i = 0; i < point.n; ++i) noisy += is_noise(i);  // apart, so that it goes by pairs
  for (Index i = 0; i < point.n; ++i) rounded += point.diagonal[i] * point.q_low[i] * point.q_low[i];
  if (noisy > 0) {
    for (Index i = 0; i < point.n && more; ++i)
      unclear += is_noise(i) && !(std::abs(point.q[i]) <=
                                  std::max(16 * usual * std::abs(point.dq[i]), floor * point.unit[i]));
    if (unclear > 0) return false;
    rounded = 0;
    for (Index i = 0; i < point.n; ++i) {
      const bool is_zero = is_noise(i);
      (is_zero ? zeroed : rounded) +=
          point.diagonal[i] * (is_zero ? point.q[i] * point.q[i] : point.q_low[i] * point.q_low[i]);
      if (is_zero) point.q[i] = point.q_low[i] = 0;
    }
  }
  const double rows = std::sqrt(gram_condition_);
  for (Index j = 0; j < point.size; ++j) {
    // Rows may be told in units far apart: each multiplier is measured by the length of its own.
    const double size = std::abs(point.lambda[j]), pull = -point.lambda[j] * point.pull[j];
    if (size * point.length[j] <= of_multiplier * rows || size <= of_step * std::abs(point.change[j])) {
      point.lambda[j] = point.lambda_low[j] = point.lambda_low_at[point.place[j]] = 0;
      let_pull += std::max(0.0, pull);
    } else {
      wrong = std::max(wrong, pull);
    }
    point.lambda_at[point.place[j]] = point.lambda[j];
  }
  rounding = std::sqrt(static_cast<double>(point.n) * rounded);
  dropped = std::sqrt(static_cast<double>(point.n) * zeroed);
  bound = 2 * remaining + dropped + rounding + let_pull;
  return true;
}

}  // namespace convex::inline pivoting
