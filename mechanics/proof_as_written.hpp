#pragma once

#include "mechanics/certified_solution.hpp"
#include "mechanics/written_mechanism.hpp"

namespace mechanics {

/// Replaces the certificate, which speaks of A, z, U, s as evaluated, by one for the mechanism as written: K
/// and the numbers are those of the text. `contacts`: the constraints of K by contact_tolerance, the rows of
/// the problem.
///
/// Every K that the text leaves open is solved (each undecided one-sided constraint in it, and not in it),
/// and the bound is the largest distance of the answer printed from any of these solutions; the level is
/// `none` when one of them is beyond the tolerance or not proved, and when a one-sided constraint does not
/// hold as written. Solutions are proved in fractions or balls up to `most_exact_coordinates`, else in
/// doubles with the radii of A, z, U, s. Two-sided constraints, and contacts that the state declares, hold by
/// declaration: where f or df/dt is not 0 as written, the bound covers the states about the one written at
/// which it is. An answer that rounding alone made feasible, or infeasible, is replaced by that of the text;
/// so is one that is off, where the method was left to the program. Where nothing is proved, the answer stays
/// what it was.
void prove_as_written(CertifiedSolution&, const convex::NearestPointProblem&, const WrittenMechanism&,
                      const std::vector<Index>& contacts, const GaussOptions&);

/// Up to so many undecided constraints, all 2^k sets K are tried.
inline constexpr std::size_t most_open_contacts = 6;

}  // namespace mechanics
