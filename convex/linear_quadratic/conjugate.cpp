#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/placement.hpp"

namespace convex::linear_quadratic {

LinearQuadratic conjugate(const LinearQuadratic& f) {
  validate(f, "conjugate");
  // Only the variables in which H is not 0 need an entry of eta.
  std::vector<Index> place(static_cast<std::size_t>(f.variables()), -1);
  Index curved = 0;
  for (Index j = 0; j < f.H.outerSize(); ++j)
    if (SparseMatrix::InnerIterator(f.H, j)) place[static_cast<std::size_t>(j)] = curved++;
  const Index n = f.n, m = f.rows();
  LinearQuadraticBuilder dual(n, m + curved);
  dual.constant(-f.constant);
  std::vector<bool> free(static_cast<std::size_t>(m), false);
  for (Index a : f.two_sided) free[static_cast<std::size_t>(a)] = true;
  for (Index a = 0; a < m; ++a) dual.cost(n + a, -f.h[a]);

  const SparseMatrix G = f.G;
  for (Index i = 0; i < f.variables(); ++i) {  // v_i + (Gᵀlambda)_i - (H eta)_i = c_i
    dual.equation(f.c[i]);
    if (i < n) dual.entry(i, 1);
    for (SparseMatrix::InnerIterator it(G, i); it; ++it) dual.entry(n + it.row(), it.value());
    for (SparseMatrix::InnerIterator it(f.H, i); it; ++it) {
      const Index row = place[static_cast<std::size_t>(it.row())];
      dual.entry(n + m + row, -it.value());
      if (it.row() <= i) dual.curve(n + m + row, n + m + place[static_cast<std::size_t>(i)], it.value());
    }
  }
  for (Index a = 0; a < m; ++a)
    if (!free[static_cast<std::size_t>(a)]) {
      dual.row(0);
      dual.entry(n + a, 1);
    }
  return dual.finish();
}

LinearQuadratic conjugate(const LinearQuadratic& f, const Metric& W) {
  require(W.dimension() == f.n, "conjugate",
          "the metric and the function differ in size; give one dimension");
  return precompose(conjugate(f), gram(W), Vector::Zero(f.n));
}

}  // namespace convex::linear_quadratic
