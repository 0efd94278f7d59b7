#include "convex/sets/subgradients.hpp"

#include <algorithm>

#include "convex/catalogue/catalogue.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline sets::subgradients {
namespace {

/// sup of d·v over the set, as an expression.
Call support_expression(const Subdifferential& set) {
  if (set.support_function) return *set.support_function;
  if (set.is_single()) return {"linear", {argument("c", nearest(set.polyhedron->vertices.front()))}};
  return support_call(as_set(*set.polyhedron).call);
}

Matrix in_doubles(const std::vector<ExactRow>& A, std::size_t columns) {
  Matrix made = Matrix::Zero(static_cast<Index>(A.size()), static_cast<Index>(columns));
  for (std::size_t i = 0; i < A.size(); ++i)
    for (const auto& [j, value] : A[i])
      made(static_cast<Index>(i), static_cast<Index>(j)) = nearest_double(value);
  return made;
}

std::vector<ExactRow> transposed(const std::vector<ExactRow>& A, std::size_t columns) {
  std::vector<ExactRow> made(columns);
  for (std::size_t i = 0; i < A.size(); ++i)
    for (const auto& [j, value] : A[i]) add(made[j], i, value);
  return made;
}

bool is_polyhedral(const Subdifferential& set) { return set.polyhedron.has_value(); }

}  // namespace

Subdifferential of_polyhedron(ExactPolyhedron P, bool is_exact) {
  Subdifferential made;
  made.n = P.n;
  made.is_exact = is_exact;
  if (!P.is_empty()) made.set = as_set(P);
  made.polyhedron = std::move(P);
  return made;
}

Subdifferential none(std::size_t n) { return of_polyhedron(empty_polyhedron(n), true); }

Subdifferential single(const Fractions& v, bool is_exact) {
  ExactPolyhedron P = empty_polyhedron(v.size());
  P.vertices.push_back(v);
  for (std::size_t i = 0; i < v.size(); ++i) {
    IntegerVector unit(v.size());
    unit[i] = v[i].denominator;
    P.equations.push_back({std::move(unit), v[i].numerator});
  }
  return of_polyhedron(std::move(P), is_exact);
}

Subdifferential ray(const Fractions& direction, bool is_exact) {
  const ExactVector d = exact_vector(direction);
  return of_polyhedron(polyhedron_of(generated_cone({d}, {}, d.size())), is_exact);
}

Subdifferential of_support(Call support, std::size_t n, bool is_bounded) {
  const Function sigma = make_function(support, {Metric::identity(static_cast<Index>(n))});
  const Function indicator = sigma.conjugate();
  Call call = indicator.call();
  if (call.name == "indicator")
    call = Call(*std::get<std::shared_ptr<const Call>>(call.arguments.front().value));
  Subdifferential made;
  made.n = n;
  made.set = Set{indicator, std::move(call)};
  made.support_function = std::move(support);
  made.is_bounded_set = is_bounded;
  return made;
}

bool is_bounded(const Subdifferential& set) {
  return is_polyhedral(set) ? set.polyhedron->rays.empty() && set.polyhedron->lines.empty()
                            : set.is_bounded_set;
}

Subdifferential transposed_image(const Subdifferential& set, const std::vector<ExactRow>& A,
                                 std::size_t columns) {
  if (set.is_empty()) return none(columns);
  if (is_polyhedral(set)) return of_polyhedron(image(*set.polyhedron, transposed(A, columns)), set.is_exact);
  return of_support(
      {"precompose", {convex::argument(support_expression(set)), {"", in_doubles(A, columns), {}}}}, columns,
      set.is_bounded_set);
}

Subdifferential sum(const Subdifferential& a, const Subdifferential& b) {
  if (a.is_empty() || b.is_empty()) return none(a.n);
  if (is_polyhedral(a) && is_polyhedral(b))
    return of_polyhedron(sum(*a.polyhedron, *b.polyhedron), a.is_exact && b.is_exact);
  return of_support(
      {"sum", {convex::argument(support_expression(a)), convex::argument(support_expression(b))}}, a.n,
      is_bounded(a) && is_bounded(b));
}

Subdifferential product(const std::vector<Subdifferential>& parts) {
  std::size_t n = 0;
  bool all_exact = true, all_polyhedral = true, all_bounded = true, one_empty = false;
  for (const Subdifferential& part : parts) {
    n += part.n;
    one_empty = one_empty || part.is_empty();
    all_exact = all_exact && part.is_exact;
    all_polyhedral = all_polyhedral && is_polyhedral(part);
    all_bounded = all_bounded && is_bounded(part);
  }
  if (one_empty) return none(n);
  if (all_polyhedral) {
    ExactPolyhedron P = *parts.front().polyhedron;
    for (std::size_t k = 1; k < parts.size(); ++k) P = product(P, *parts[k].polyhedron);
    return of_polyhedron(std::move(P), all_exact);
  }
  Call blocks{"separable"};
  for (const Subdifferential& part : parts) {
    blocks.arguments.push_back(convex::argument(support_expression(part)));
    blocks.arguments.push_back({"", static_cast<double>(part.n), {}});
  }
  return of_support(std::move(blocks), n, all_bounded);
}

Subdifferential hull(const std::vector<Subdifferential>& parts) {
  std::vector<const Subdifferential*> some;
  for (const Subdifferential& part : parts)
    if (!part.is_empty()) some.push_back(&part);
  if (some.empty()) return none(parts.front().n);
  if (some.size() == 1) return *some.front();
  if (std::all_of(some.begin(), some.end(), [](const auto* part) { return is_polyhedral(*part); })) {
    ExactPolyhedron P = *some.front()->polyhedron;
    bool is_exact = some.front()->is_exact;
    for (std::size_t k = 1; k < some.size(); ++k) {
      P = hull(P, *some[k]->polyhedron);
      is_exact = is_exact && some[k]->is_exact;
    }
    return of_polyhedron(std::move(P), is_exact);
  }
  Call highest{"pointwise_max"};
  for (const Subdifferential* part : some)
    highest.arguments.push_back(convex::argument(support_expression(*part)));
  return of_support(
      std::move(highest), parts.front().n,
      std::all_of(some.begin(), some.end(), [](const auto* part) { return is_bounded(*part); }));
}

Subdifferential intersection(const Subdifferential& a, const Subdifferential& b) {
  if (a.is_empty() || b.is_empty()) return none(a.n);
  if (is_polyhedral(a) && is_polyhedral(b))
    return of_polyhedron(intersection(*a.polyhedron, *b.polyhedron), a.is_exact && b.is_exact);
  return of_support(
      {"inf_convolution", {convex::argument(support_expression(a)), convex::argument(support_expression(b))}},
      a.n, is_bounded(a) || is_bounded(b));
}

}  // namespace convex::inline sets::subgradients
