#pragma once

#include <optional>

#include "mechanics/motion/motion.hpp"

namespace mechanics::inline motions {

/// What errors of one rounding in each number of a state have become; of a number that is 0, one rounding of
/// the largest that it is on the way.
struct RoundingGrowth {
  Index coordinate = 0;
  bool of_velocity = false;
  double change = 0;  ///< |Δq_i| or |Δv_i| at the end, of that number, the worst of the errors tried
  /// The same over the largest |q_i| or |v_i| of the motion, the largest such part; 0: none grew.
  double part = 0;
  /// To first order, no error of one rounding in each number grows to more than so many times `change`; 0
  /// where too few were tried to tell.
  double bound_over_change = 0;
};

/// By other motions, from states that are so far away in each of the N numbers that do not stay 0, with signs
/// from the rows of a Hadamard matrix of order K >= N (Sylvester 1867). With changes Σ_i ±a_i and
/// orthogonal columns, Σ_k (Σ_i H_ki a_i)² = K ‖a‖², so that the worst is at least ‖a‖₂ >= ‖a‖₁/√N, and ‖a‖₁
/// is what all signs can make of them. Of K rows the first `most` are tried. Where digits are lost
/// exponentially, as near an unstable orbit, none of those printed may be left. Nothing, where none of those
/// motions has the same end.
std::optional<RoundingGrowth> rounding_growth(const LagrangianSystem& system, const State& start,
                                              const MotionOptions& options, const Motion& ended, Index most);

}  // namespace mechanics::inline motions
