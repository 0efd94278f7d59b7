#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/nearest_point/solution.hpp"

namespace convex::inline optimality {

/// `Residuals`, gathered from the rows that matter: those with a multiplier, and those violated.
class GatheredResiduals {
 public:
  /// stationarity: ||Aq - z - Uᵀlambda||_(A⁻¹); acceleration_norm: ||q||_A; scale: max(||q||_A, ||z||_(A⁻¹));
  /// largest: the largest |lambda_a|.
  GatheredResiduals(double stationarity, double acceleration_norm, double scale, double largest)
      : stationarity_(stationarity),
        acceleration_norm_(acceleration_norm),
        scale_(scale),
        part_(largest > 0 ? 1 / std::max(largest, std::numeric_limits<double>::min()) : 0),
        gap_(0.5 * stationarity * stationarity) {}

  /// A row of that length ||u_a||_(A⁻¹), with its multiplier and slack u_a·q - s_a. A violation on a row of
  /// scale 0 (at rest, s = 0) is relative to what z could do to it instead.
  void add(double s, double length, double lambda, double slack, bool is_two_sided) {
    const double row_scale = std::abs(s) + length * acceleration_norm_;
    const double over = row_scale > 0 ? row_scale : length * scale_;
    gap_ += lambda * slack;
    if (!(over > 0)) return;
    const double off = slack / over;
    found_.feasibility = std::max(found_.feasibility, is_two_sided ? std::abs(off) : -off);
    found_.complementarity = std::max(found_.complementarity, std::abs(lambda * part_ * off));
  }

  Residuals all() const {
    Residuals found = found_;
    if (scale_ > 0) {
      found.stationarity = stationarity_ / scale_;
      found.duality_gap = std::sqrt(std::max(0.0, gap_)) / scale_;
    }
    return found;
  }

 private:
  double stationarity_, acceleration_norm_, scale_, part_, gap_;
  Residuals found_;
};

}  // namespace convex::inline optimality
