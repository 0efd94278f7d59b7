#include <string>

#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/counted.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/program_function.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/sets.hpp"

namespace convex::inline named_functions {
namespace {

constexpr Facts set_facts{.indicator = true};
constexpr Facts cone_facts{.indicator = true, .cone = true, .support = true};
constexpr Facts support_facts{.support = true};

void require_rows(const char* maker, const Matrix& A, const Vector& b) {
  require_finite(maker, "A", A);
  if (A.rows() == 0 || A.cols() == 0)
    throw InvalidInput(std::string(maker) + "(A): no rows or columns; give at least one");
  if (b.size() != A.rows())
    throw InvalidInput(std::string(maker) + "(b): " + counted(b.size(), "entry", "entries") +
                       " where A has " + counted(A.rows(), "row", "rows") + "; give as many");
}

/// f(factor (Ax - b)).
GraphForm of_rows(std::shared_ptr<const Atom> f, const Matrix& A, const Vector& b, double factor) {
  return {A.cols(), 0, {{std::move(f), 1, (factor * A).sparseView(), -factor * b}}, 0};
}

/// {x : Gx <= 0} and {Gᵀw : w >= 0} are polar to each other.
ProgramFunction generated(const Matrix& G) {
  const Vector zeros = Vector::Zero(G.rows());
  const Index n = G.cols(), m = G.rows();
  SparseMatrix weights(m, n + m), point(n, n + m);
  for (Index a = 0; a < m; ++a) weights.insert(a, n + a) = 1;
  for (Index i = 0; i < n; ++i) {
    point.insert(i, i) = 1;
    for (Index a = 0; a < m; ++a)
      if (G(a, i) != 0) point.insert(i, n + a) = -G(a, i);
  }
  return {.call = indicator_call({"cone", {argument("generators", G)}}),
          .conjugate_call = indicator_call({"polyhedron", {argument("A", G), argument("b", zeros)}}),
          .facts = cone_facts,
          .conjugate_facts = cone_facts,
          .form = linear_quadratic::cone(G),
          .conjugate_form = linear_quadratic::polyhedron(G, zeros),
          .graph = {
              n,
              m,
              {{orthant_atom(), 1, weights, zeros}, {point_atom(Vector::Zero(n)), 1, point, Vector::Zero(n)}},
              0}};
}

Set named(Call set, ProgramFunction parts) {
  parts.call = indicator_call(set);
  return {program_function(std::move(parts)), std::move(set)};
}

}  // namespace

Set affine(const Matrix& A, const Vector& b) {
  require_rows("affine", A, b);
  require_finite("affine", "b", b);
  const Call call{"affine", {argument("A", A), argument("b", b)}};
  const LinearQuadratic form = linear_quadratic::affine(A, b);
  const bool through_zero = b.isZero(0);
  return named(call, {.call = {},
                      .conjugate_call = support_call(call),
                      .facts = through_zero ? cone_facts : set_facts,
                      .conjugate_facts = through_zero ? cone_facts : support_facts,
                      .form = form,
                      .conjugate_form = linear_quadratic::conjugate(form),
                      .graph = of_rows(point_atom(Vector::Zero(b.size())), A, b, 1)});
}

Set polyhedron(const Matrix& A, const Vector& b) {
  require_rows("polyhedron", A, b);
  const Call call{"polyhedron", {argument("A", A), argument("b", b)}};
  if (b.isZero(0)) {
    const ProgramFunction pair = generated(A);
    return {program_function(pair).conjugate(), call};
  }
  const LinearQuadratic form = linear_quadratic::polyhedron(A, b);
  std::vector<Index> bounded;
  for (Index a = 0; a < b.size(); ++a)
    if (std::isfinite(b[a])) bounded.push_back(a);
  return named(call, {.call = {},
                      .conjugate_call = support_call(call),
                      .facts = set_facts,
                      .conjugate_facts = support_facts,
                      .form = form,
                      .conjugate_form = linear_quadratic::conjugate(form),
                      .graph = of_rows(orthant_atom(), A(bounded, Eigen::all), b(bounded), -1)});
}

Set cone(const Matrix& generators) {
  require_finite("cone", "generators", generators);
  if (generators.rows() == 0 || generators.cols() == 0)
    throw InvalidInput("cone(generators): no rows or columns; give at least one");
  return named({"cone", {argument("generators", generators)}}, generated(generators));
}

Function max_affine(const Matrix& A, const Vector& b) {
  require_rows("max_affine", A, b);
  require_finite("max_affine", "b", b);
  const Call call{"max_affine", {argument("A", A), argument("b", b)}};
  const LinearQuadratic form = linear_quadratic::max_affine(A, b);
  const auto largest = std::dynamic_pointer_cast<const Atom>(max().shared());
  return program_function({.call = call,
                           .conjugate_call = {"conjugate", {argument(call)}},
                           .facts = {.support = b.isZero(0), .smooth = A.rows() == 1, .finite = true},
                           .conjugate_facts = {.indicator = b.isZero(0)},
                           .form = form,
                           .conjugate_form = linear_quadratic::conjugate(form),
                           .graph = of_rows(largest, A, -b, 1)});
}

}  // namespace convex::inline named_functions
