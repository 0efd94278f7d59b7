#include "convex/linear_quadratic/operations.hpp"

namespace convex::linear_quadratic {

LinearQuadratic recession(const LinearQuadratic& f) {
  validate(f, "recession");
  std::vector<bool> equation(static_cast<std::size_t>(f.rows()), false);
  for (Index a : f.two_sided) equation[static_cast<std::size_t>(a)] = true;
  LinearQuadraticBuilder cone(f.n, f.auxiliaries());
  for (Index j = 0; j < f.variables(); ++j) cone.cost(j, f.c[j]);
  for (Index a = 0; a < f.rows(); ++a) {
    equation[static_cast<std::size_t>(a)] ? cone.equation(0) : cone.row(0);
    for (SparseRows::InnerIterator entry(f.G, a); entry; ++entry) cone.entry(entry.col(), entry.value());
  }
  const SparseRows H = f.H;
  for (Index i = 0; i < f.variables(); ++i) {
    if (!SparseRows::InnerIterator(H, i)) continue;
    cone.equation(0);
    for (SparseRows::InnerIterator entry(H, i); entry; ++entry) cone.entry(entry.col(), entry.value());
  }
  return cone.finish();
}

}  // namespace convex::linear_quadratic
