#pragma once

#include <cmath>

#include "convex/nearest_point/problem.hpp"
#include "mechanics/gauss_solution.hpp"

namespace mechanics {

/// Units of mass, acceleration and of a constraint's gradient, powers of four. A number of the problem is its
/// unit times the number in these units; z has the unit mass * acceleration, s gradient * acceleration,
/// lambda mass * acceleration / gradient. Squares of numbers such as 1e-160 are not doubles; in fit units
/// they are.
struct Units {
  double mass = 1, acceleration = 1, gradient = 1;
  bool ordinary() const { return mass == 1 && acceleration == 1 && gradient == 1; }
  /// The unit of ||q||_A.
  double norm() const { return std::sqrt(mass) * acceleration; }
  Units inverse() const { return {1 / mass, 1 / acceleration, 1 / gradient}; }
};

/// Units in which the largest numbers of the problem are near 1; all 1 when they are ordinary as they stand,
/// so that only extreme problems are changed.
Units fit_units(const convex::NearestPointProblem&);

/// The problem in those units, exact but where an entry leaves the range of doubles.
convex::NearestPointProblem in_units(const convex::NearestPointProblem&, const Units&);

/// Whether no entry of s and of a dense U left the range.
bool are_exact(const convex::NearestPointProblem&, const Units&, const convex::NearestPointProblem& scaled);

/// Brings the solution of the problem in those units back to its own; the status is judged anew.
void restore_units(GaussSolution&, const Units&, double tolerance);

/// A power of two by row, near its largest entry where that cannot be squared; else 1.
Vector row_units(const convex::NearestPointProblem&);

/// Each row, with its s and radii, divided by its unit, and the multipliers and slacks that fit.
convex::NearestPointProblem in_row_units(convex::NearestPointProblem, const Vector& units);
GaussSolution in_row_units(GaussSolution, const Vector& units);

}  // namespace mechanics
