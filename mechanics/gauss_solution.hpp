#pragma once

#include <memory>
#include <optional>

#include "convex/nearest_point/methods.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "mechanics/hypothesis.hpp"
#include "mechanics/reaction_from_dual.hpp"

namespace mechanics {

/// How to solve Gauss' problem and how much to say about the answer.
struct GaussOptions {
  const convex::Method* method = &convex::methods().front();
  convex::Accuracy accuracy;
  bool always_ranges = false;  ///< give the ranges of the multipliers also beyond `most_ranges` contacts
};

/// What the reductions make of a problem that was solved without them, and how far the answers are apart:
/// ||q'' - q''_reduced||_A over max(||q''||_A, ||z||_(A⁻¹)).
struct Reduced {
  convex::Model model;
  double difference = 0;
};

/// The answer to Moreau's problem at a state: which contacts persist, with which acceleration and which
/// reactions, and what the classical rules would have said.
struct GaussSolution {
  convex::Solution primal;          ///< q'' and its multipliers, or a Farkas witness
  convex::Multipliers multipliers;  ///< all multipliers; `tight` are the contacts that persist
  std::vector<Index> touching;      ///< of these, the one-sided ones that neither press nor open
  convex::Residuals residuals;      ///< of q'' with the least-norm multipliers
  Vector reaction;                  ///< R = Σ lambda_a u_a = A q'' - z, on the system by its constraints: n
  double gauss = 0;                 ///< G = ½ q''·A q'' - z·q''
  Hypothesis hypothesis;
  std::optional<ReactionFromDual> from_dual;
  /// Σ |lambda_a| ||u_a||_(A⁻¹) of contacts whose multipliers were taken for 0 (`touch_within_error`).
  double taken_for_zero = 0;
  std::optional<Reduced> reduced;  ///< when accuracy.reduce is off
  /// The answer is that of the numbers as they were written, in fractions; their doubles did not decide it.
  bool as_written = false;
  /// They were asked for it so, from the rows that doubles tell, and it took more than their limit.
  bool was_too_long = false;
  /// Those numbers, each rounded once, where their doubles as evaluated are others; or null.
  std::shared_ptr<const convex::NearestPointProblem> data;
};

/// The ranges of multipliers that are not unique cost two linear programs each; beyond so many contacts they
/// are left out unless asked for.
inline constexpr Index most_ranges = 1000;

/// Throws InvalidInput when the method does not apply to the problem.
GaussSolution solve(const convex::NearestPointProblem&, const GaussOptions& = {});

}  // namespace mechanics
