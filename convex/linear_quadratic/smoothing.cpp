#include <cmath>

#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/placement.hpp"

namespace convex::linear_quadratic {
namespace {

/// factor/2 ||d||_W², d read from η by the entries given.
LinearQuadratic half_square(const Metric& W, double factor, Index n, Index columns, Entries entries) {
  LinearQuadratic square;
  square.n = W.dimension();
  square.H = factor * gram(W);
  square.c = Vector::Zero(W.dimension());
  square.G.resize(0, W.dimension());
  square.h.resize(0);
  return substitute(square, n, placement(square, columns, columns, std::move(entries)),
                    Vector::Zero(square.n));
}

Entries along(Index n, double on_x, double on_d) {
  Entries entries = identity_at(n, 0, on_x);
  append(entries, identity_at(n, n, on_d));
  return entries;
}

}  // namespace

LinearQuadratic envelope(const LinearQuadratic& f, double gamma, const Metric& W) {
  validate(f, "envelope");
  require(gamma > 0 && std::isfinite(gamma), "envelope", "gamma is not positive and finite; give gamma > 0");
  require(W.dimension() == f.n, "envelope", "the metric and the function differ in size; give one dimension");
  const Index n = f.n, columns = 2 * n + f.auxiliaries();
  return add_joint(placed(f, n, columns, 2 * n, along(n, 0, 1)),
                   half_square(W, 1 / gamma, n, columns, along(n, 1, -1)));
}

LinearQuadratic proximal_average(const LinearQuadratic& f, const LinearQuadratic& g, double t, double gamma,
                                 const Metric& W) {
  validate(f, "proximal_average");
  validate(g, "proximal_average");
  require(gamma > 0 && std::isfinite(gamma), "proximal_average",
          "gamma is not positive and finite; give gamma > 0");
  require(t >= 0 && t <= 1, "proximal_average", "the weight is not between 0 and 1; give the part of f");
  require(f.n == g.n && W.dimension() == f.n, "proximal_average",
          "the functions and the metric differ in size; give one dimension");
  if (t == 1) return f;
  if (t == 0) return g;
  const Index n = f.n, columns = 2 * n + f.auxiliaries() + g.auxiliaries();
  const LinearQuadratic mean =
      add_joint(scale(placed(f, n, columns, 2 * n, along(n, 1, 1 - t)), t),
                scale(placed(g, n, columns, 2 * n + f.auxiliaries(), along(n, 1, -t)), 1 - t));
  return add_joint(mean, half_square(W, t * (1 - t) / gamma, n, columns, along(n, 0, 1)));
}

}  // namespace convex::linear_quadratic
