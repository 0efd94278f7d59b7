#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "convex/nearest_point/model.hpp"
#include "convex/status.hpp"
#include "convex/vector.hpp"

namespace convex {

/// What to ask of a method.
struct Accuracy {
  double tolerance =
      1e-9;  ///< loosen it to accept a coarser bound on ||q - q*||_A; direct methods ignore it otherwise
  Index step_limit = 0;  ///< steps before a method gives up; 0 means its own, generous limit
  bool reduce = true;  ///< false: `auto` solves the whole as it stands, without islands and special structure
  bool polish =
      true;  ///< false: an iteration's answer is its own, not that of the rows it shows to be active
  /// false: the active set's answer to a dense problem is left as doubles give it where what is missing of
  /// its equations, measured in doubles, bounds the error by the tolerance and no row is close to tipping
  /// over; some 1e-15 off instead of rounded right, and quicker.
  bool refine = true;
  /// What doubles cannot decide is decided in fractions where that takes at most so many times
  /// `most_word_operations`; 0: never, and then it is said.
  double limit = 1;
};

/// The word operations that fractions may take where doubles leave a decision open: some seconds. A count, so
/// that the same problem ends the same way everywhere.
inline constexpr double most_word_operations = 3e9;

/// The relative residuals of docs/problem-files.md, at the printed numbers.
/// feasibility: max_a (s_a - u_a·q)⁺ / (|s_a| + ||u_a||_(A⁻¹) ||q||_A) (|s_a - u_a·q| for a two-sided row);
/// complementarity: max_a |lambda_a (u_a·q - s_a)| over the same with lambda's largest;
/// stationarity: ||Aq - z - Uᵀlambda||_(A⁻¹), and duality_gap: the root of
/// lambda·(Uq - s) + ½||Aq - z - Uᵀlambda||²_(A⁻¹), both over max(||q||_A, ||z||_(A⁻¹)).
struct Residuals {
  double feasibility = 0, complementarity = 0, stationarity = 0, duality_gap = 0;
};

/// What a method found. q: n; lambda, slack = Uq - s: m. When infeasible, `farkas` (m) holds weights w with
/// wᵀU = 0, w·s > 0 and w_a >= 0 on one-sided rows, and the rest is empty.
struct Solution {
  Status status = Status::gave_up;
  std::string_view method;
  Vector q, lambda, slack;
  Residuals residuals;
  double error_bound = 0;        ///< an estimate of ||q - q*||_A that takes the conditioning in
  double rounding = 0;           ///< the part of error_bound that is the rounding of q to doubles
  double acceleration_norm = 0;  ///< ||q||_A
  double force_norm = 0;         ///< ||z||_(A⁻¹)
  std::vector<Index> basis;      ///< the independent active rows that the answer rests on
  Vector farkas;
  Index steps = 0;        ///< of the method: rows taken in or dropped, pivots, iterations
  bool polished = false;  ///< q solves the equations of the rows that an iteration showed to be active
  std::string_view undecided = {};  ///< what doubles left open, where fractions did not decide it; else empty
  Model model;                      ///< what was solved; filled in by `auto`

  /// Whether the error bound is what `solved` asks for.
  bool is_within(const Accuracy& accuracy) const {
    return std::isfinite(error_bound) && error_bound <= accuracy.tolerance * std::max(1.0, acceleration_norm);
  }
};

}  // namespace convex
