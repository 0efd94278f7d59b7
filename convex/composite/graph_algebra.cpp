#include "convex/composite/graph_algebra.hpp"

#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/graph_placement.hpp"
#include "convex/composite/metric_difference.hpp"
#include "convex/invariant.hpp"

namespace convex::inline composite {
namespace {

SparseMatrix identity(Index n) { return selection(0, n, n); }

/// ½ Mξ·Q Mξ as a term.
GraphTerm quadratic_term(const SparseMatrix& M, const SparseMatrix& Q, double scale) {
  const Vector zero = Vector::Zero(Q.rows());
  return {quadratic_atom({Q, zero, 0}), scale, M, zero};
}

SparseMatrix sparse_gram(const Metric& W) { return gram(W).sparseView(); }

}  // namespace

GraphForm graph_of(std::shared_ptr<const Atom> f, Index n) {
  return {n, 0, {{std::move(f), 1, identity(n), Vector::Zero(n)}}, 0};
}

GraphForm sum(std::span<const GraphForm> f) {
  invariant(!f.empty(), "a sum of graph forms has a term");
  GraphForm total{f[0].n, 0, {}, 0};
  for (const GraphForm& part : f) total.k += part.k;
  Index start = total.n;
  for (const GraphForm& part : f) {
    invariant(part.n == total.n, "the graph forms of a sum have one size");
    SparseMatrix x_part(total.n, total.n + total.k);
    x_part.leftCols(total.n) = identity(total.n);
    add_terms(total, part, placed(total.n + total.k, x_part, start, part.k), Vector::Zero(total.n));
    start += part.k;
  }
  return total;
}

GraphForm scale(GraphForm f, double alpha) {
  invariant(alpha > 0, "a graph form is multiplied by a positive number");
  for (GraphTerm& term : f.terms) term.scale *= alpha;
  f.constant *= alpha;
  return f;
}

GraphForm precompose(const GraphForm& f, const SparseMatrix& A, const Vector& b) {
  invariant(A.rows() == f.n && b.size() == f.n, "an affine map ends where the graph form begins");
  GraphForm composed{A.cols(), f.k, {}, 0};
  const SparseMatrix x_part = A * selection(0, A.cols(), A.cols() + f.k);
  add_terms(composed, f, placed(A.cols() + f.k, x_part, A.cols(), f.k), b);
  return composed;
}

GraphForm add_quadratic(GraphForm f, const Matrix& Q, const Vector& c, double constant) {
  const SparseMatrix x_part = selection(0, f.n, f.n + f.k);
  if (!Q.isZero(0)) f.terms.push_back(quadratic_term(x_part, Q.sparseView(), 1));
  if (!c.isZero(0)) f.terms.push_back(linear_term(x_part, c));
  f.constant += constant;
  return f;
}

GraphForm blocks(std::span<const GraphForm> f) {
  GraphForm all;
  for (const GraphForm& part : f) {
    all.n += part.n;
    all.k += part.k;
  }
  Index x_start = 0, w_start = all.n;
  for (const GraphForm& part : f) {
    const SparseMatrix x_part = selection(x_start, part.n, all.n + all.k);
    add_terms(all, part, placed(all.n + all.k, x_part, w_start, part.k), Vector::Zero(part.n));
    x_start += part.n;
    w_start += part.k;
  }
  return all;
}

GraphForm inf_convolution(const GraphForm& f, const GraphForm& g) {
  invariant(f.n == g.n, "the graph forms of an inf-convolution have one size");
  const Index n = f.n;
  GraphForm least{n, n + f.k + g.k, {}, 0};
  const Index columns = n + least.k;
  const SparseMatrix rest = selection(0, n, columns) - selection(n, n, columns);
  add_terms(least, f, placed(columns, rest, 2 * n, f.k), Vector::Zero(n));
  add_terms(least, g, placed(columns, selection(n, n, columns), 2 * n + f.k, g.k), Vector::Zero(n));
  return least;
}

GraphForm envelope(const GraphForm& f, const Metric& W, double gamma) {
  const GraphForm square{f.n, 0, {quadratic_term(identity(f.n), sparse_gram(W), 1 / gamma)}, 0};
  return inf_convolution(square, f);
}

GraphForm proximal_average(const GraphForm& f, const GraphForm& g, double lambda, double gamma,
                           const Metric& W) {
  invariant(lambda > 0 && lambda < 1, "a proximal average has two parts");
  const Index n = f.n;
  GraphForm average{n, n + f.k + g.k, {}, 0};
  const Index columns = n + average.k;
  const SparseMatrix x = selection(0, n, columns), w = selection(n, n, columns);
  // p = (x - (1 - lambda) w) / lambda, so that p - w = (x - w) / lambda.
  const SparseMatrix p = (x - (1 - lambda) * w) / lambda;
  add_terms(average, scale(f, lambda), placed(columns, p, 2 * n, f.k), Vector::Zero(n));
  add_terms(average, scale(g, 1 - lambda), placed(columns, w, 2 * n + f.k, g.k), Vector::Zero(n));
  average.terms.push_back(
      quadratic_term(SparseMatrix(x - w), sparse_gram(W), (1 - lambda) / (lambda * gamma)));
  return average;
}

}  // namespace convex::inline composite
