#pragma once

#include <optional>

#include "mechanics/motion/motion.hpp"

namespace mechanics::inline motions {

/// What an error of one rounding in each number of a state has become.
struct RoundingGrowth {
  Index coordinate = 0;
  bool of_velocity = false;
  double change = 0;  ///< |Δq_i| or |Δv_i| at the end, of that number
  double part =
      0;  ///< the same over the largest |q_i| or |v_i| of the motion, the largest such part; 0: none grew
};

/// By a second motion, from the state that is one rounding away in each number that is not 0. Where digits
/// are lost exponentially, as near an unstable orbit, none of those printed may be left. Nothing, where that
/// motion has another end than `until`.
std::optional<RoundingGrowth> rounding_growth(const LagrangianSystem& system, const State& start,
                                              const MotionOptions& options, const Motion& ended);

}  // namespace mechanics::inline motions
