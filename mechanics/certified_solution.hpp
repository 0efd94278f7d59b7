#pragma once

#include <functional>

#include "convex/nearest_point/proof/certificate.hpp"
#include "mechanics/exact_gauss_solution.hpp"
#include "mechanics/exact_text.hpp"

namespace mechanics {

/// The data of a problem at their exact values, made when they are first needed.
struct ExactData {
  std::function<convex::ExactProblem()> make;
  bool are_doubles = true;  ///< the doubles of the problem are the exact values
};

/// The exact solution of a mechanism as its text has it, and how far from it the answer lies.
struct TextProof {
  ExactGaussSolution exact;
  bool contacts_hold = true;  ///< K was proved: f_a = 0 and df_a/dt = 0 exactly
  double error_bound = 0;
};

/// An answer with its proof.
struct CertifiedSolution {
  GaussSolution solution;
  convex::Certificate certificate;
  std::optional<ExactGaussSolution> exact;  ///< when the proof needed it
  std::optional<TextProof> text;            ///< of a mechanism whose text is rational at its state
};

/// Solves Gauss' problem and proves a bound on the error of the acceleration, or that there is no solution:
/// first in doubles, then, where signs are not strict or the rows contradict each other, in fractions. Where
/// fractions are needed and the method is the default one, the answer is the exact one, rounded. Beyond
/// `most_exact_entries` nothing is tried in fractions.
CertifiedSolution solve_certified(const convex::NearestPointProblem&, const ExactData&, const GaussOptions&);

/// The exact solution of the data, as the method "exact" gives it.
CertifiedSolution solve_by_fractions(const convex::NearestPointProblem&, const ExactData&,
                                     const GaussOptions&);

/// Takes in what the text of the mechanism says: the bound covers the rounding of A, z, U, s as well, and an
/// answer that only this rounding made (in)feasible is replaced by the exact one.
void prove_from_text(CertifiedSolution&, const convex::NearestPointProblem&, const ExactTextProblem&,
                     const GaussOptions&);

/// n (n + m) up to which fractions are tried: some seconds of work.
inline constexpr Index most_exact_entries = 300 * 300;

}  // namespace mechanics
