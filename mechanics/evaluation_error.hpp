#pragma once

#include "mechanics/added_row.hpp"
#include "mechanics/gauss_solution.hpp"
#include "mechanics/written_mechanism.hpp"

namespace mechanics {

/// An estimate of ||q'' - q''*||_A for the acceleration q''* of the mechanism as written and the exact
/// solution q'' of the problem of A, z, U, s as evaluated: what their rounding, and that of the state's
/// numbers, amounts to while the same contacts are held. What is left of the equations as written at the
/// answer, and no less than twice their radii, for two evaluations, through the conditioning of the rows held
/// (`convex::largest_move`). `added`: the rows
/// of the problem behind those of the contacts, as are added at a singular state, with their own radii.
double evaluation_error(const WrittenMechanism&, const std::vector<Index>& contacts,
                        const std::vector<AddedRow>& added, const convex::NearestPointProblem&,
                        const convex::Solution&, const convex::Accuracy&);

/// Adds it to the error bound, which then speaks of the mechanism as written, and judges the status by that.
void count_evaluation_error(convex::Solution&, double error, const convex::Accuracy&);

/// Of the contacts that touch, those stay whose multipliers are no more than their own errors, as A, z, U and
/// s were evaluated (`leave_out_pressing`).
void leave_out_pressing(GaussSolution&, const WrittenMechanism&, const std::vector<Index>& contacts,
                        const convex::NearestPointProblem&);

/// What rounding of A, z and U leaves unknown of the forces at the answer, z + Σ lambda_a u_a - A q'', in
/// ||·||_(A⁻¹).
double force_error(const WrittenMechanism&, const std::vector<Index>& contacts,
                   const convex::NearestPointProblem&, const GaussSolution&);

/// What the error bound and the radii of row a leave unknown of its slack; length: ||u_a||_(A⁻¹).
double hidden_slack(const convex::NearestPointProblem&, const convex::Solution&, Index a, double length);

/// Of the contacts that touch, those stay whose slack may be 0 for all that the error bound, the radii of
/// rows and `tolerance`, relative to the terms of the row alone, tell. The others open, whatever is pushed
/// elsewhere.
void leave_out_opening(GaussSolution&, const convex::NearestPointProblem&, double tolerance);

/// One-sided contacts that open by no more than what the error bound makes of it, or press by no more than
/// `of_forces`, what is not known of the forces in ||·||_(A⁻¹), count as touching without a multiplier: all
/// that is known is that they may.
void touch_within_error(GaussSolution&, const convex::NearestPointProblem&, double of_forces);

/// Where all contacts are tight, the answer is the motion with every contact held, too, and the hypothesis is
/// accepted, whatever rounding made of its own equations.
void accept_where_all_hold(GaussSolution&, const convex::NearestPointProblem&);

}  // namespace mechanics
