#pragma once

#include <functional>

#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/solution.hpp"
#include "tests/oracles/nearest_point_error.hpp"

/// Methods known from the literature to fail on some problems, written the way that fails. One-sided rows
/// only.
namespace naive {

/// What such a method hands over, and what it says about it.
struct Answer {
  convex::Vector q, lambda;
  bool says_solved = false;
};

/// The rows given, held with equality: M lambda = s - U A⁻¹z with the explicit Delassus matrix M = U A⁻¹Uᵀ
/// and its Cholesky factor. Whatever comes out is called solved.
Answer delassus_matrix(const convex::NearestPointProblem&, const std::vector<convex::Index>& active);

/// When an iteration stops: told the residual (the largest |min(lambda_a, w_a)| of w = U q - s) and the
/// largest change of a multiplier in the last sweep.
using StopTest = std::function<bool(double residual, double change)>;

/// Projected Gauss-Seidel on the Delassus matrix (Jean and Moreau 1992) with a stop test and a limit.
Answer gauss_seidel(const convex::NearestPointProblem&, const StopTest&, int most_sweeps);

/// Principal pivoting where all rows of a wrong sign change sides at once, with no safeguard; solved when
/// none is left.
Answer all_at_once(const convex::NearestPointProblem&, int most_rounds);

/// Lemke (1965) on the Delassus matrix, the leaving row being the first of least ratio: no lexicographic
/// rule.
Answer lemke_by_first_row(const convex::NearestPointProblem&, int most_pivots);

/// A barrier method: needs a point strictly inside all rows and looks for one along the mean of the rows'
/// directions; says so when it finds none (q is empty).
Answer barrier(const convex::NearestPointProblem&, double weight);

/// What the judge of our own methods calls the answer, unpolished.
convex::Status judged(const convex::NearestPointProblem&, const Answer&);

}  // namespace naive

/// ||q - q*||_A over max(||q*||_A, ||z||_(A⁻¹)).
double true_error(const convex::GalleryInstance&, const convex::Vector& q);

/// The rows with a positive multiplier in the planted answer.
std::vector<convex::Index> loaded_rows(const convex::GalleryInstance&);

/// The instance of the family of that name.
convex::GalleryInstance instance_of(const char* family, convex::Index size, double difficulty);

/// What the default makes of it.
convex::Solution by_default(const convex::NearestPointProblem&);

using oracles::few_roundings;
