#pragma once

#include "convex/nearest_point/proof/certificate.hpp"
#include "mechanics/exact_gauss_solution.hpp"
#include "mechanics/exact_text.hpp"

namespace mechanics {

/// What the text of a mechanism proves of an answer. K is the set of contacts that are present: two-sided
/// constraints by declaration, one-sided ones where f = 0 and df/dt = 0 as written.
struct TextProof {
  std::vector<ContactVerdict> contacts;  ///< by constraint
  bool contacts_hold = false;  ///< K as written is that of contact_tolerance, and nothing is left open
  std::vector<Index> refuted;  ///< one-sided constraints that the tolerance took into K, or left out, wrongly
  std::vector<Index> violated;  ///< one-sided constraints that do not hold as written
  std::vector<Index> open;      ///< one-sided constraints of which the text decides nothing
  /// Constraints whose gradients are combinations of others within what balls leave of them or, where nothing
  /// is proved, two-sided ones within what rounding does. The text does not tell whether they are; they count
  /// as that, and as consistent.
  std::vector<Index> dependent;
  /// One-sided constraints of K whose gradient is 0 there and that second derivatives do not open: of them
  /// these tell nothing, and nothing is proved.
  std::vector<Index> vanishing;
  std::vector<Index> K;  ///< the rows of the solution below: the one K, or that of the tolerance
  std::optional<ExactGaussSolution> exact;           ///< the solution for K, where it is rational
  std::optional<convex::EnclosedSolution> enclosed;  ///< or in balls
  std::optional<convex::Decimals> acceleration;      ///< when it is enclosed
  /// Of the acceleration printed, for every K that the text leaves open; none when nothing is proved.
  std::optional<double> error_bound;
};

}  // namespace mechanics
