#pragma once

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/solution.hpp"

namespace convex::inline optimality {

/// `residuals` where only rows held with equality matter, gathered row by row.
class HeldResiduals {
 public:
  /// stationarity: ||Aq - z - Uᵀlambda||_(A⁻¹); acceleration_norm: ||q||_A; scale: max(||q||_A, ||z||_(A⁻¹));
  /// largest: the largest |lambda_a|.
  HeldResiduals(double stationarity, double acceleration_norm, double scale, double largest)
      : stationarity_(stationarity),
        acceleration_norm_(acceleration_norm),
        scale_(scale),
        largest_(largest),
        gap_(0.5 * stationarity * stationarity) {}

  /// A row of that length ||u_a||_(A⁻¹), with its multiplier and slack u_a·q - s_a.
  void add(double s, double length, double lambda, double slack, bool is_two_sided) {
    const double row_scale = std::abs(s) + length * acceleration_norm_;
    const double over = row_scale > 0 ? row_scale : length * scale_;
    gap_ += lambda * slack;
    if (!(over > 0)) return;
    const double off = slack / over;
    found_.feasibility = std::max(found_.feasibility, is_two_sided ? std::abs(off) : -off);
    pushed_ = std::max(pushed_, std::abs(lambda * off));
  }

  Residuals all() const {
    Residuals found = found_;
    if (largest_ > 0) found.complementarity = pushed_ / largest_;
    if (scale_ > 0) {
      found.stationarity = stationarity_ / scale_;
      found.duality_gap = std::sqrt(std::max(0.0, gap_)) / scale_;
    }
    return found;
  }

 private:
  double stationarity_, acceleration_norm_, scale_, largest_, gap_, pushed_ = 0;
  Residuals found_;
};

}  // namespace convex::inline optimality
