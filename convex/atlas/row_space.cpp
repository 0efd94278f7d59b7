#include "convex/atlas/row_space.hpp"

#include <algorithm>

#include "convex/exact/elimination.hpp"
#include "convex/invariant.hpp"

namespace convex::atlas {

bool RowSpace::is_feasible() const {
  return std::any_of(cone.generators.begin(), cone.generators.end(),
                     [](const IntegerVector& g) { return g.back().sign() > 0; });
}

namespace {

/// The rows over a basis of them: u_a = Σ e_ak u_k, so gram_kk e_a = gram_ka.
void take_basis(RowSpace& space, const std::vector<std::size_t>& basis) {
  for (const std::size_t k : basis) {
    space.inverse.emplace_back();
    for (const std::size_t l : basis) space.inverse.back().push_back(space.gram[k][l]);
    space.free_rows.push_back(space.directions[k]);
  }
  const auto small = positive_definite_inverse(space.inverse);
  invariant(small.has_value(), "independent rows have a definite Gram matrix");
  space.metric = small->adjugate;
  space.gauge = Fraction{1, small->determinant} / space.factor;
  for (std::size_t a = 0; a < space.s.size(); ++a) {
    IntegerVector products;
    for (const std::size_t k : basis) products.push_back(space.gram[k][a]);
    space.rows.push_back(times(products, small->adjugate));
    space.rows.back().resize(basis.size());
    space.rows.back().push_back(-small->determinant * space.s[a]);
  }
}

/// All coordinates as they are.
void take_coordinates(RowSpace& space, const ExactProblem& problem, IntegerRows adjugate) {
  space.metric = problem.A;
  space.gauge = {1, problem.unit};
  space.free_rows = adjugate;
  space.inverse = std::move(adjugate);
  for (std::size_t a = 0; a < space.s.size(); ++a) {
    space.rows.push_back(problem.U[a]);
    space.rows.back().push_back(-problem.s[a]);
  }
}

}  // namespace

RowSpace row_space(const ExactProblem& problem) {
  auto inverse = positive_definite_inverse(problem.A);
  invariant(inverse.has_value(), "the matrix of an exact problem is positive definite");
  const auto n = static_cast<std::size_t>(problem.dimension()), m = static_cast<std::size_t>(problem.rows());
  RowSpace space;
  space.n = problem.dimension();
  space.s = problem.s;
  space.factor = lowest_terms({problem.unit, inverse->determinant});
  space.two_sided.assign(m, false);
  for (const Index a : problem.two_sided) space.two_sided[at(a)] = true;
  Echelon span{n, {}, {}};
  std::vector<std::size_t> basis;
  for (std::size_t a = 0; a < m; ++a) {
    space.directions.push_back(times(problem.U[a], inverse->adjugate));
    if (extend(span, problem.U[a])) basis.push_back(a);
  }
  for (std::size_t a = 0; a < m; ++a) {
    space.gram.emplace_back();
    for (std::size_t b = 0; b < m; ++b) space.gram[a].push_back(dot(problem.U[a], space.directions[b]));
  }
  space.rank = basis.size();
  if (space.rank == n)
    take_coordinates(space, problem, std::move(inverse->adjugate));
  else
    take_basis(space, basis);
  for (IntegerVector& row : space.rows) {
    Integer common = 0;
    for (const Integer& entry : row) common = greatest_common_divisor(common, entry);
    space.row_scale.push_back(common.is_zero() ? Integer{1} : common);
    make_primitive(row);
  }
  return space;
}

void find_cone(RowSpace& space) {
  ExactRows halfspaces, equations;
  for (std::size_t a = 0; a < space.count(); ++a) {
    IntegerVector row = space.rows[a];
    for (Integer& entry : row) entry = -entry;
    (space.two_sided[a] ? equations : halfspaces).push_back({std::move(row), 1});
  }
  IntegerVector ahead(space.rank + 1, 0);
  ahead.back() = -1;
  halfspaces.push_back({std::move(ahead), 1});
  space.cone = halfspace_cone(halfspaces, equations, static_cast<Index>(space.rank + 1));
}

}  // namespace convex::atlas
