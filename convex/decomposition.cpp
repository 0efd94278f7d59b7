#include "convex/decomposition.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/metric_difference.hpp"

namespace convex {
namespace {

/// The values, products and sums of the right side are each right to so many roundings of their terms.
constexpr double roundings_of_a_term = 16;

/// Values smaller than this count as this where the tolerance is relative to them.
constexpr double smallest_term = 1e-3;

/// So much of the scale squared weighs more than any function: the prox is then the nearest point of the
/// domain.
constexpr double nearest_point_weight = 1e12;

/// Where rounding left the point outside the domain, or on the far side of the membership tolerance, the
/// nearest point of the domain; the move is part of the bound.
std::optional<Prox> moved_into_domain(const Function& f, const Prox& found, double scale, const Metric& W) {
  const double weight = f.facts().indicator ? 1 : nearest_point_weight / (scale * scale);
  if (!(weight > 0) || !std::isfinite(weight)) return std::nullopt;
  const Prox nearest = f.prox(found.x, W.scaled(weight));
  if (nearest.x.size() != found.x.size()) return std::nullopt;
  const double move = W.norm(nearest.x - found.x);
  if (!(move <= membership_tolerance * scale)) return std::nullopt;
  Prox moved = found;
  moved.x = nearest.x;
  moved.error_bound += move;
  return moved;
}

/// sum over i, j of |a_i W_ij b_j|: what the rounding of (a|b) is relative to.
double size_of_inner(const Metric& W, const Vector& a, const Vector& b) {
  const Vector x = a.cwiseAbs(), y = b.cwiseAbs();
  switch (W.kind()) {
    case MetricKind::dense:
      return x.dot(W.dense_gram().cwiseAbs() * y);
    case MetricKind::sparse: {
      const SparseMatrix magnitude = W.sparse_gram().cwiseAbs();
      return x.dot(magnitude * y);
    }
    default:
      return x.dot(W.diagonal().cwiseProduct(y));
  }
}

/// What a rounding of x makes of f(x), to first order: |v|·|x| for a subgradient there.
double size_of_slope(const Function& f, const Vector& x) {
  const std::optional<Vector> v = f.subgradient(x);
  return v && v->allFinite() ? v->cwiseAbs().dot(x.cwiseAbs()) : 0;
}

/// x and y with what follows from them.
struct Candidate {
  Decomposition split;
  double right = 0;     ///< the right side
  double error = 0;     ///< of f(x) and g(y)
  double squares = 0;   ///< ||z||², ||x||², ||y||², the largest
  double rounding = 0;  ///< of the terms

  /// By how much the right side leaves what the bound, the values' errors and rounding allow; +inf where a
  /// value is not finite.
  double excess() const {
    const double square = split.error_bound * split.error_bound;
    const double most = std::max(right - square, -right) - error - rounding;
    return std::isfinite(most) ? most : INFINITY;
  }
  /// Are f(x) + g(y) and (x|y) one, and known, to the tolerance?
  bool known(double tolerance) const {
    const double size =
        std::max({std::abs(split.f_x), std::abs(split.g_y), std::abs(split.inner), smallest_term});
    return std::abs(split.fenchel_gap) <= tolerance * size && error <= tolerance * std::max(size, squares);
  }
};

Candidate candidate(const Function& f, const Function& g, Prox x_part, Prox y_part, const Vector& z,
                    const Metric& W) {
  Candidate made;
  Decomposition& split = made.split;
  split.x = std::move(x_part);
  split.y = std::move(y_part);
  const Vector &x = split.x.x, &y = split.y.x;
  const Value f_x = f.evaluate(x), g_y = g.evaluate(y);
  split.f_x = f_x.value;
  split.g_y = g_y.value;
  split.inner = W.inner(x, y);
  split.fenchel_gap = split.f_x + split.g_y - split.inner;
  split.residual = W.norm(z - x - y);
  split.error_bound = std::max({split.x.error_bound, split.y.error_bound, split.residual / 2});
  made.right = split.fenchel_gap + 0.5 * split.residual * split.residual;
  made.error = f_x.error + g_y.error;
  made.squares = std::max({W.inner(z, z), W.inner(x, x), W.inner(y, y)});
  made.rounding = roundings_of_a_term * unit_roundoff *
                  (std::abs(split.f_x) + std::abs(split.g_y) + size_of_inner(W, x, y));
  return made;
}

/// The prox of the conjugate from a prox x of f and its covector v: W⁻¹v is that at x + W⁻¹v, and the proxes
/// of two points are no farther apart than the points.
std::optional<Prox> by_moreau(const Prox& of_f, const Vector& z, const Metric& W) {
  if (of_f.v.size() != z.size() || !of_f.v.allFinite()) return std::nullopt;
  Prox made = of_f;
  made.x = refined_solve(W, of_f.v);
  made.v = W.multiply(of_f.x);
  made.error_bound = of_f.error_bound + W.dual_norm(metric_difference(W, of_f.x, z) + of_f.v) +
                     roundings_of_a_term * unit_roundoff * (W.norm(z) + W.norm(of_f.x));
  if (!of_f.method.starts_with("Moreau")) made.method = "Moreau's identity, " + of_f.method;
  return made;
}

/// What the two proxes gave, held against the values. Where these do not bear it out, the points moved into
/// their domains, and one of the two by Moreau's identity from the other, are tried.
Decomposition guarded(const Function& f, const Function& g, const Vector& z, const Metric& W,
                      double tolerance) {
  const Prox x = f.prox(z, W), y = g.prox(z, W);
  Candidate best = candidate(f, g, x, y, z, W);
  const double size = W.norm(z) + W.norm(x.x), enough = tolerance * std::max({1.0, W.norm(z), W.norm(x.x)});
  const auto borne_out = [&](const Candidate& made) {
    return made.excess() <= 0 && made.known(tolerance) && made.split.error_bound <= enough;
  };
  const auto consider = [&](const std::optional<Prox>& of_x, const std::optional<Prox>& of_y) {
    if (borne_out(best) || !of_x || !of_y) return;
    if (!(std::max(of_x->error_bound, of_y->error_bound) <= enough)) return;
    Candidate other = candidate(f, g, *of_x, *of_y, z, W);
    if (borne_out(other)) best = std::move(other);
  };
  if (!borne_out(best)) {
    const auto into = [&](const Function& h, const std::optional<Prox>& found) {
      const bool near = found && found->error_bound <= enough;
      return near ? moved_into_domain(h, *found, size + W.norm(y.x), W) : std::nullopt;
    };
    const auto x_inside = into(f, x), y_inside = into(g, y);
    consider(x, y_inside);
    consider(x_inside, y);
    consider(x_inside, y_inside);
    const auto y_of_x = by_moreau(x, z, W), x_of_y = by_moreau(y, z, W);
    consider(x, y_of_x);
    consider(x, into(g, y_of_x));
    consider(x_of_y, y);
    consider(into(f, x_of_y), y);
  }
  Decomposition& split = best.split;
  if (best.excess() > 0 && std::isfinite(best.excess()))
    best.rounding +=
        roundings_of_a_term * unit_roundoff * (size_of_slope(f, split.x.x) + size_of_slope(g, split.y.x));
  split.status = best.excess() <= 0 && best.known(tolerance) ? Status::solved : Status::inaccurate;
  if (best.excess() > 0) {
    const double most = std::abs(best.right) + best.error;
    split.error_bound = std::max(split.error_bound, std::isfinite(most) ? std::sqrt(2 * most) : INFINITY);
  }
  return std::move(best.split);
}

}  // namespace

Decomposition decompose(const Function& f, const Vector& z, const Metric& W, double tolerance) {
  Decomposition split = guarded(f, f.conjugate(W), z, W, tolerance);
  const double enough = tolerance * std::max({1.0, W.norm(z), W.norm(split.x.x)});
  const bool accurate = split.x.error_bound <= enough && split.y.error_bound <= enough &&
                        split.error_bound <= enough;  // each by itself: a maximum may hide a NaN
  const bool finite = std::isfinite(split.f_x) && std::isfinite(split.g_y);
  if (accurate && finite && split.status == Status::solved) return split;
  const bool gave_up = split.x.status == Status::gave_up || split.y.status == Status::gave_up;
  split.status = gave_up ? Status::gave_up : Status::inaccurate;
  return split;
}

}  // namespace convex
