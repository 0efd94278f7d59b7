#include "convex/decomposition.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/metric_difference.hpp"
#include "convex/composite/work_limit.hpp"
#include "convex/operations/metric_algebra.hpp"

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
  /// The bound of ||x - x*|| and ||y - y*|| that the right side is; below 0 it says that a value is too small
  /// by as much, and may be as large.
  double proved() const {
    const double most = 2 * std::abs(right) + error + rounding;
    return std::isfinite(most) ? std::sqrt(2 * most) : INFINITY;
  }
  /// Are f(x) + g(y) and (x|y) one, and known, to the tolerance?
  bool known(double tolerance) const {
    const double size =
        std::max({std::abs(split.f_x), std::abs(split.g_y), std::abs(split.inner), smallest_term});
    return std::abs(split.fenchel_gap) <= tolerance * size && error <= tolerance * std::max(size, squares);
  }
};

/// f, its conjugate g in the metric's product, and the plain one.
struct Pair {
  const Function &f, g, plain;
};

/// a·b in twice the precision.
double accurate_dot(const Vector& a, const Vector& b) {
  RunningSum sum;
  for (Index i = 0; i < a.size(); ++i) sum.add(two_product(a[i], b[i]));
  return sum.value();
}

Decomposition split_of(Prox x, Prox y, const Vector& z, const Metric& W) {
  Decomposition split;
  split.x = std::move(x);
  split.y = std::move(y);
  split.residual = W.norm(z - split.x.x - split.y.x);
  return split;
}

Candidate finished(Decomposition split, const Value& f_x, const Value& g_y, double size, double residual,
                   const Metric& W, const Vector& z) {
  Candidate made;
  split.f_x = f_x.value;
  split.g_y = g_y.value;
  split.fenchel_gap = split.f_x + split.g_y - split.inner;
  split.error_bound = std::max({split.x.error_bound, split.y.error_bound, split.residual / 2});
  made.right = split.fenchel_gap + 0.5 * residual * residual;
  made.error = f_x.error + g_y.error;
  const Vector &x = split.x.x, &y = split.y.x;
  made.squares = std::max({W.inner(z, z), W.inner(x, x), W.inner(y, y)});
  made.rounding = roundings_of_a_term * unit_roundoff * (std::abs(split.f_x) + std::abs(split.g_y) + size);
  // f and g are those at points that the bounds leave open, to first order, where these are rounding.
  const double X = W.norm(x), Y = W.norm(y), least = accuracy_of_prox * (W.norm(z) + X);
  made.rounding += std::min(split.x.error_bound, least) * Y + std::min(split.y.error_bound, least) * X;
  made.split = std::move(split);
  return made;
}

/// The right side at x and y themselves.
Candidate at_points(const Pair& of, Prox x_part, Prox y_part, const Vector& z, const Metric& W) {
  Decomposition split = split_of(std::move(x_part), std::move(y_part), z, W);
  const Vector &x = split.x.x, &y = split.y.x;
  split.inner = W.inner(x, y);
  const double size = size_of_inner(W, x, y), residual = split.residual;
  return finished(std::move(split), of.f.evaluate(x), of.g.evaluate(y), size, residual, W, z);
}

/// The right side at x and the covector v of its prox. No y of doubles has a g(y) near that of the exact one
/// where Wy cancels, as where |z| is far above |v|; W⁻¹v, of which y is a rounding, has: g(W⁻¹v) = f*(v). The
/// right side then proves the pair x and W⁻¹v, and the distance of y from there is added to its bound.
///
/// Where the domain of f or f* is thin, as a plane, x or v of doubles is outside it by rounding, and counts
/// as inside; x·v is then that of a point beside it. (x|y) is taken at x - W⁻¹r or at v - r, r = W(x - z) +
/// v, which make up z exactly, when this agrees better with the values.
Candidate at_covector(const Pair& of, Prox x_part, Prox y_part, const Vector& z, const Metric& W) {
  Decomposition split = split_of(std::move(x_part), std::move(y_part), z, W);
  const Vector &x = split.x.x, &y = split.y.x, &v = split.x.v;
  split.y.error_bound += W.dual_norm(metric_difference(W, y, Vector::Zero(y.size())) - v);
  const Vector r = metric_difference(W, x, z) + v;
  const double size = x.cwiseAbs().dot(v.cwiseAbs()), residual = W.dual_norm(r);
  const Value f_x = of.f.evaluate(x), g_y = of.plain.evaluate(v);
  const double product = accurate_dot(x, v);
  split.inner = product;
  for (const double moved : {product - accurate_dot(W.solve(r), v), product - accurate_dot(x, r)}) {
    const double values = f_x.value + g_y.value;
    if (std::abs(values - moved) < std::abs(values - split.inner)) split.inner = moved;
  }
  Candidate made = finished(std::move(split), f_x, g_y, size, residual, W, z);
  // x·v and f(x) + f*(v) are one number: where its terms cancel, x·v is the less accurate of the two.
  const double gap = std::abs(made.split.fenchel_gap);
  if (gap <= roundings_of_a_term * unit_roundoff * size) {
    made.split.inner = f_x.value + g_y.value;
    made.split.fenchel_gap = 0;
  } else if (gap <= made.error) {  // and where a program leaves a value open, the others say it
    if (f_x.error > g_y.error)
      made.split.f_x = made.split.inner - g_y.value;
    else
      made.split.g_y = made.split.inner - f_x.value;
    made.split.fenchel_gap = 0;
  }
  return made;
}

/// Is (x|y) that of the points x and y, as far as the tolerance and their rounding leave it?
bool is_inner_of_points(const Decomposition& split, double tolerance, const Metric& W) {
  const Vector &x = split.x.x, &y = split.y.x;
  const double size =
      std::max({std::abs(split.f_x), std::abs(split.g_y), std::abs(split.inner), smallest_term});
  const double rounding = roundings_of_a_term * unit_roundoff * size_of_inner(W, x, y);
  return std::abs(W.inner(x, y) - split.inner) <= tolerance * size + rounding;
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

/// The prox of f from that of f* at Wz in W⁻¹, with that point as its covector: as the conjugate found it,
/// not as a y of doubles rounds it.
std::optional<Prox> turned(const std::optional<Prox>& dual, const Vector& z, const Metric& W) {
  if (!dual || dual->x.size() != z.size() || dual->v.size() != z.size() || !dual->v.allFinite())
    return std::nullopt;
  Prox made = *dual;
  made.x = dual->v;
  made.v = dual->x;
  made.error_bound = dual->error_bound + W.dual_norm(metric_difference(W, made.x, z) + made.v) +
                     roundings_of_a_term * unit_roundoff * (W.norm(z) + W.norm(made.x));
  made.by_conjugate = true;
  if (!dual->method.starts_with("Moreau")) made.method = "Moreau's identity, " + dual->method;
  return made;
}

/// x and v again, each right to roundings of itself and not of z. x = prox_f (x + V⁻¹v) in every metric V; in
/// V = s W, s = ||v||_(W⁻¹) / ||x||_W, the two are of one size, so that neither drowns the other. The smaller
/// of the two is kept from pass to pass, the larger follows from z.
std::optional<Prox> balanced(const Function& f, const std::optional<Prox>& near, const Vector& z,
                             const Metric& W) {
  // Nearer to W the passes converge faster, and in V the result is the most accurate.
  constexpr double towards_W[] = {0x1p-12, 0x1p-6, 1, 1, 1};
  constexpr double slow = 0.5;
  if (!near || near->v.size() != z.size() || !near->v.allFinite()) return std::nullopt;
  // What is 0 may be anything within the bound.
  const double X = std::max(W.norm(near->x), near->error_bound),
               V = std::max(W.dual_norm(near->v), near->error_bound);
  const double ratio = std::exp2(std::round(std::log2(V / X)));
  if (!(ratio > 0) || !std::isfinite(ratio) || !std::isfinite(1 / ratio)) return std::nullopt;
  std::optional<Prox> best;
  Vector x = near->x, v = near->v;
  for (const double part : towards_W) {
    const double s = ratio >= 1 ? std::max(1.0, part * ratio) : std::min(1.0, ratio / part);
    if (ratio >= 1)
      v = metric_difference(W, z, x);
    else
      x = z - refined_solve(W, v);
    Prox made = f.prox(x + W.solve(v) / s, W.scaled(s));
    if (made.x.size() != z.size() || made.v.size() != z.size() || !made.v.allFinite()) break;
    x = made.x;
    v = made.v;
    // The exact prox there is that of another point in W: of x + W⁻¹v, as far as x and v are right.
    made.error_bound = made.error_bound * (std::sqrt(s) + 1 / std::sqrt(s)) +
                       W.dual_norm(metric_difference(W, x, z) + v) +
                       roundings_of_a_term * unit_roundoff * (W.norm(z) + W.norm(x));
    const bool better = !best || made.error_bound < best->error_bound;
    const bool done = best && part == 1 && !(made.error_bound < slow * best->error_bound);
    if (better) best = std::move(made);
    if (done) break;
  }
  return best;
}

/// The same point with the covector that the function itself has there, where it has only one.
std::optional<Prox> with_slope(const Function& f, const std::optional<Prox>& at, const Vector& z,
                               const Metric& W) {
  if (!at || !f.facts().smooth) return std::nullopt;
  const std::optional<Vector> v = f.subgradient(at->x);
  if (!v || !v->allFinite()) return std::nullopt;
  Prox made = *at;
  made.v = *v;
  made.error_bound += W.dual_norm(metric_difference(W, at->x, z) + *v);
  return made;
}

/// What the two proxes gave, held against the values. Where these do not bear it out, other pairs are tried:
/// the points moved into their domains, one of the two by Moreau's identity from the other, the covectors in
/// place of y, and x and v balanced.
Decomposition guarded(const Pair& of, const Vector& z, const Metric& W, double tolerance) {
  const Prox x = of.f.prox(z, W), y = of.g.prox(z, W);
  Candidate best = at_points(of, x, y, z, W);
  const double size = W.norm(z) + W.norm(x.x), enough = tolerance * std::max({1.0, W.norm(z), W.norm(x.x)});
  const auto is_borne_out = [&](const Candidate& made) {
    return made.excess() <= 0 && made.known(tolerance) && made.split.error_bound <= enough;
  };
  const auto ended = [&] { return is_borne_out(best) || WorkLimit::passed(); };
  const auto near = [&](const std::optional<Prox>& found) { return found && found->error_bound <= enough; };
  const auto into = [&](const Function& h, const std::optional<Prox>& found) {
    return near(found) ? moved_into_domain(h, *found, size + W.norm(y.x), W) : std::nullopt;
  };
  const auto consider = [&](const std::optional<Prox>& of_x, const std::optional<Prox>& of_y) {
    if (ended() || !near(of_x) || !near(of_y)) return;
    Candidate other = at_points(of, *of_x, *of_y, z, W);
    if (is_borne_out(other)) best = std::move(other);
  };
  // x with its covector, beside y and beside the y that the covector gives.
  const auto consider_covector = [&](const std::optional<Prox>& of_x) {
    if (ended() || !near(of_x) || of_x->v.size() != z.size() || !of_x->v.allFinite()) return;
    for (const std::optional<Prox>& of_y : {std::optional(y), by_moreau(*of_x, z, W)}) {
      if (!near(of_y)) continue;
      Candidate other = at_covector(of, *of_x, *of_y, z, W);
      if (!is_borne_out(other) || !is_inner_of_points(other.split, tolerance, W)) continue;
      best = std::move(other);
      return;
    }
  };
  const auto consider_all = [&](const std::optional<Prox>& of_x) {
    consider_covector(of_x);
    if (!ended()) consider_covector(with_slope(of.f, of_x, z, W));
    if (!ended()) consider_covector(into(of.f, of_x));
  };
  if (!ended()) {
    const auto x_inside = into(of.f, x), y_inside = into(of.g, y);
    consider(x, y_inside);
    consider(x_inside, y);
    consider(x_inside, y_inside);
    consider(x, by_moreau(x, z, W));
    consider_all(x);
  }
  if (!ended()) consider_all(balanced(of.f, x, z, W));
  if (!ended()) {
    const auto x_of_y = by_moreau(y, z, W);
    consider(x_of_y, y);
    consider(into(of.f, x_of_y), y);
  }
  if (!ended()) {
    const Vector force = metric_difference(W, z, Vector::Zero(z.size()));
    const Metric V = inverse(W);
    const Prox dual = of.plain.prox(force, V);
    consider_all(turned(dual, z, W));
    if (!ended()) consider_all(turned(balanced(of.plain, dual, force, V), z, W));
  }
  Decomposition& split = best.split;
  if (best.excess() > 0 && std::isfinite(best.excess()))
    best.rounding += roundings_of_a_term * unit_roundoff *
                     (size_of_slope(of.f, split.x.x) + size_of_slope(of.g, split.y.x));
  if (best.excess() > 0) split.error_bound = std::max(split.error_bound, best.proved());
  // The values alone may prove more than the proxes know of themselves.
  const double proved = best.proved();
  if (proved < split.error_bound) {
    split.x.error_bound = std::min(split.x.error_bound, proved);
    split.y.error_bound = std::min(split.y.error_bound, proved + split.residual);
    split.error_bound = std::max({split.x.error_bound, split.y.error_bound, split.residual / 2});
  }
  split.status = best.known(tolerance) ? Status::solved : Status::inaccurate;
  return std::move(best.split);
}

}  // namespace

Decomposition decompose(const Function& f, const Vector& z, const Metric& W, double tolerance) {
  const WorkLimit question;
  Decomposition split = guarded({f, f.conjugate(W), f.conjugate()}, z, W, tolerance);
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
