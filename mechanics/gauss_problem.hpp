#pragma once

#include "convex/nearest_point/problem.hpp"
#include "mechanics/contacts.hpp"

namespace mechanics {

/// Gauss' problem at a state (Moreau 1966, (10)): minimise G = ½ q''·A q'' - z·q'' over u_a·q'' >= s_a, a in
/// K. Row k of the problem is constraint contacts.present[k].
struct GaussProblem {
  convex::NearestPointProblem problem;
  Contacts contacts;
};

/// Throws InvalidInput as `contacts` does, and when T is not positive definite in q' (naming a coordinate).
/// What evaluation rounded of the rows is not known of a system in general: a guess stands for it.
GaussProblem gauss_problem(const System&, const State&, const Vector& contact_tolerance);

struct WrittenMechanism;
/// The same at the state as it is written. The radii of the rows are those of their evaluation and of the
/// state's numbers (`row_radii`); rows that are exact have none, and those of one-sided contacts are 0 where
/// the text proves it (cos(pi/2) is 6e-17 in doubles).
GaussProblem gauss_problem(const WrittenMechanism&, const Vector& contact_tolerance);

/// The metric of a sparse matrix A of inertia, stored in the way that suits it. Names the coordinate at
/// fault.
convex::Metric kinetic_metric(const convex::SparseMatrix& A, const std::vector<std::string>& coordinates);

}  // namespace mechanics
