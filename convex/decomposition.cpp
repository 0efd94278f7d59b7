#include "convex/decomposition.hpp"

#include <algorithm>
#include <cmath>

namespace convex {
namespace {

Status status_of(const Decomposition& split, double scale, double tolerance) {
  const double enough = tolerance * scale;  // each bound by itself: a maximum may hide a NaN
  const bool accurate =
      split.x.error_bound <= enough && split.y.error_bound <= enough && split.residual / 2 <= enough;
  if (accurate && std::isfinite(split.f_x) && std::isfinite(split.g_y)) return Status::solved;
  const bool gave_up = split.x.status == Status::gave_up || split.y.status == Status::gave_up;
  return gave_up ? Status::gave_up : Status::inaccurate;
}

}  // namespace

Decomposition decompose(const Function& f, const Vector& z, const Metric& W, double tolerance) {
  const Function g = f.conjugate(W);
  Decomposition split;
  split.x = f.prox(z, W);
  split.y = g.prox(z, W);
  const Vector &x = split.x.x, &y = split.y.x;
  split.f_x = f(x);
  split.g_y = g(y);
  split.inner = W.inner(x, y);
  split.fenchel_gap = split.f_x + split.g_y - split.inner;
  split.residual = W.norm(z - x - y);
  split.error_bound = std::max({split.x.error_bound, split.y.error_bound, split.residual / 2});
  split.status = status_of(split, std::max({1.0, W.norm(z), W.norm(x)}), tolerance);
  return split;
}

}  // namespace convex
