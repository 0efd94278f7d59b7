#pragma once

#include <functional>

#include "convex/nearest_point/proof/certificate.hpp"
#include "convex/nearest_point/proof/infeasibility_proof.hpp"
#include "mechanics/exact_gauss_solution.hpp"
#include "mechanics/text_proof.hpp"

namespace mechanics {

/// The data of a problem at their exact values, made when they are first needed.
struct ExactData {
  std::function<convex::ExactProblem()> make;
  bool are_doubles = true;  ///< the doubles of the problem are the exact values
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
/// `most_exact_entries`, or accuracy.limit times `convex::most_word_operations`, nothing is tried in
/// fractions but the rows that contradict each other; multipliers that take more stay those of doubles.
CertifiedSolution solve_certified(const convex::NearestPointProblem&, const ExactData&, const GaussOptions&);

/// The exact solution of the data, as the method "exact" gives it.
CertifiedSolution solve_by_fractions(const convex::NearestPointProblem&, const ExactData&,
                                     const GaussOptions&);

/// What is proved of an answer that came without a proof: fractions gave it, to the data themselves or, where
/// these are doubles, to all of one problem in doubles, with the method left to the program. Else nothing,
/// and the bound is the answer's own.
convex::Certificate plain_certificate(const GaussSolution&, const ExactData&, const GaussOptions&);

/// A bound on doubles cannot be expected to be better than this part of ||q||_A.
inline constexpr double few_ulps = 4 * 0x1p-52;

/// Whether there is an acceleration, to the accuracy asked for or less.
bool has_answer(const GaussSolution&);

/// Whether the caller left the method to the program, or asked for fractions: then the answer may be replaced
/// by the exact one, rounded.
bool is_default(const GaussOptions&);

/// Of the rows that count as tight the one-sided ones whose multipliers are all 0: some may open by less than
/// counts.
std::vector<Index> touching_in_fractions(const GaussSolution&, const ExactGaussSolution&);

/// The status that the certificate's bound gives.
void judge_by_certificate(CertifiedSolution&, const GaussOptions&);

/// n (n + m) up to which fractions are tried: some seconds of work.
inline constexpr Index most_exact_entries = 300 * 300;

}  // namespace mechanics
