#pragma once

#include <functional>

#include "convex/nearest_point/proof/certificate.hpp"
#include "convex/nearest_point/proof/infeasibility_proof.hpp"
#include "mechanics/exact_gauss_solution.hpp"
#include "mechanics/exact_text.hpp"

namespace mechanics {

/// The data of a problem at their exact values, made when they are first needed.
struct ExactData {
  std::function<convex::ExactProblem()> make;
  bool are_doubles = true;  ///< the doubles of the problem are the exact values
};

/// What the text of a mechanism proves: its solution in fractions where the text is rational, else enclosed,
/// if that succeeds.
struct TextProof {
  std::vector<ContactVerdict> contacts;  ///< by constraint
  bool contacts_hold = false;            ///< every contact of K touches, and no other constraint does
  std::optional<ExactGaussSolution> exact;
  std::optional<convex::EnclosedSolution> enclosed;
  std::optional<convex::Decimals> acceleration;  ///< when it is enclosed
  std::optional<double> error_bound;             ///< of the acceleration given; none when nothing is proved
};

/// An answer with its proof.
struct CertifiedSolution {
  GaussSolution solution;
  convex::Certificate certificate;
  std::optional<ExactGaussSolution> exact;  ///< when the proof needed it
  convex::IntegerVector farkas;             ///< exact weights, where these alone were proved
  std::optional<TextProof> text;            ///< of a mechanism
};

/// Solves Gauss' problem and proves a bound on the error of the acceleration, or that there is no solution:
/// first in doubles, then, where signs are not strict or the rows contradict each other, in fractions. Where
/// fractions are needed and the method is the default one, the answer is the exact one, rounded. Beyond
/// `most_exact_entries` nothing is tried in fractions but the rows that contradict each other.
CertifiedSolution solve_certified(const convex::NearestPointProblem&, const ExactData&, const GaussOptions&);

/// The exact solution of the data, as the method "exact" gives it.
CertifiedSolution solve_by_fractions(const convex::NearestPointProblem&, const ExactData&,
                                     const GaussOptions&);

/// Takes in what the text of the mechanism says: the bound covers the rounding of A, z, U, s as well, and an
/// answer that only this rounding made (in)feasible is replaced by that of the text. `contacts`: the
/// constraints of K.
void prove_from_text(CertifiedSolution&, const convex::NearestPointProblem&, const TextProblem&,
                     const std::vector<Index>& contacts, const GaussOptions&);

/// n (n + m) up to which fractions are tried: some seconds of work.
inline constexpr Index most_exact_entries = 300 * 300;

}  // namespace mechanics
