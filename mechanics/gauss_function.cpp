#include "mechanics/gauss_function.hpp"

#include <cmath>

#include "convex/counted.hpp"
#include "convex/functions/quadratic.hpp"
#include "convex/functions/sets.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/operations/operations.hpp"

namespace mechanics {

using convex::Index;
using convex::Matrix;

convex::Function appell_function(const convex::NearestPointProblem& problem, double at_zero) {
  Matrix A(problem.dimension(), problem.dimension());
  for (Index j = 0; j < A.cols(); ++j) A.col(j) = problem.A.multiply(convex::Vector::Unit(A.rows(), j));
  return convex::quadratic(0.5 * (A + A.transpose()), -problem.z, at_zero);
}

convex::Function gauss_function(const convex::NearestPointProblem& problem) {
  return appell_function(problem, 0);
}

convex::Vector gauss_gradient(const convex::NearestPointProblem& problem, const convex::Vector& q) {
  if (q.size() != problem.dimension())
    throw convex::InvalidInput("gauss_gradient: " + convex::counted(q.size(), "entry", "entries") +
                               "; give " + std::to_string(problem.dimension()) + ", one per coordinate");
  return -convex::stationarity_residual(problem, convex::DoubleDoubleVector(q), {},
                                        convex::DoubleDoubleVector(0));
}

convex::Set allowed_accelerations(const convex::NearestPointProblem& problem) {
  const Index n = problem.dimension();
  Matrix one_sided(problem.rows(), n), two_sided(problem.rows(), n);
  convex::Vector b(problem.rows()), c(problem.rows());
  Index p = 0, e = 0, next = 0;
  for (Index a = 0; a < problem.rows(); ++a) {
    const bool is_two_sided = next < static_cast<Index>(problem.two_sided.size()) &&
                              problem.two_sided[static_cast<std::size_t>(next)] == a;
    if (is_two_sided) {
      ++next;
      two_sided.row(e) = problem.U.row(a);
      c[e++] = problem.s[a];
    } else {
      one_sided.row(p) = -problem.U.row(a);
      b[p++] = -problem.s[a];
    }
  }
  std::vector<convex::Set> sets;
  if (p > 0) sets.push_back(convex::polyhedron(one_sided.topRows(p), b.head(p)));
  if (e > 0) sets.push_back(convex::affine(two_sided.topRows(e), c.head(e)));
  if (sets.empty())
    return convex::box(convex::Vector::Constant(n, -INFINITY), convex::Vector::Constant(n, INFINITY));
  if (sets.size() == 1) return sets.front();
  convex::Call both{"intersection"};
  for (const convex::Set& one : sets) both.arguments.push_back(convex::argument(one.call));
  return {convex::intersection(sets, n), std::move(both)};
}

}  // namespace mechanics
