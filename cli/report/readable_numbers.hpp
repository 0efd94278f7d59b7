#pragma once

#include "cli/report/solve_report.hpp"

namespace cli::inline reports {

/// The numbers of an answer as a person reads them: what is no larger than its rounding is 0. Each is
/// measured in the metric of its kind, so that no unit is chosen: an acceleration q''_i by ||q''||_A
/// sqrt((A⁻¹)_ii), a force by its dual, a rate u·q'' - s by ||u||_(A⁻¹) ||q''||_A + |s|, f and df/dt by their
/// largest summands.
struct ReadableNumbers {
  convex::Vector acceleration, reaction;       ///< the first `shown` coordinates
  convex::Vector f, df, second_rates, lambda;  ///< the first `shown` constraints; f, df of a system
  std::vector<std::optional<double>> forces;  ///< |lambda_a ∂f_a/∂q| where `force_per_multiplier` has one
  std::vector<convex::Interval>
      ranges;  ///< of the multipliers of all contacts, where they are not unique and known
};

/// Of an answer there is.
ReadableNumbers readable_numbers(const SolvedScene&, convex::Index shown);

/// x, or 0 when it is no more than rounding of numbers as large as `scale`.
double without_rounding(double x, double scale);
/// The first entries of an acceleration of the scene, without those of rounding.
convex::Vector without_rounding(const SolvedScene&, convex::Vector acceleration);

}  // namespace cli::inline reports
