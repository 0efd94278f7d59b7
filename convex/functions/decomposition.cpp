#include "convex/functions/decomposition.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/metric_difference.hpp"
#include "convex/composite/work_limit.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/other_pairs.hpp"

namespace convex {
namespace {

/// The values, products and sums of the right side are each right to so many roundings of their terms.
constexpr double roundings_of_a_term = 16;

/// Values smaller than this count as this where the tolerance is relative to them.
constexpr double smallest_term = 1e-3;

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

/// What each prox, and each value, may take of the work that a decomposition may; pairs are made of the rest.
constexpr double part_of_a_prox = 0.25, part_of_a_value = 0.05, part_of_a_move = 0.05;

Value value_of(const Function& f, const Vector& x) {
  const WorkLimit part(part_of_a_value);
  return f.evaluate(x);
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
  return finished(std::move(split), value_of(of.f, x), value_of(of.g, y), size, residual, W, z);
}

/// f(x) and f*(v).
struct ChosenValues {
  Value f_x, f_v;
  double of_prox = 0;  ///< the errors of those that came with the prox
};

/// The values that the prox came with are of a point and a covector that are feasible as far as their errors
/// say: at least f(x) and f*(v). Where they, or one of them and the other evaluated, come nearer to x·v than
/// what is evaluated, they are taken; where f(x) or f*(v) itself is +inf, only when x and v are roundings of
/// where it is not.
ChosenValues values_at(const Pair& of, const Prox& at, double product) {
  const ChosenValues found{value_of(of.f, at.x), value_of(of.plain, at.v)};
  const auto outside = [](const Value& value) { return std::isinf(value.value) && value.error == 0; };
  if (!at.values) return found;
  if ((outside(found.f_x) || outside(found.f_v)) && !(at.values->miss <= membership_tolerance)) return found;
  const auto miss = [&](const Value& f_x, const Value& f_v) {
    const double most = std::abs(f_x.value + f_v.value - product) + f_x.error + f_v.error;
    return std::isfinite(most) ? most : INFINITY;
  };
  ChosenValues best = found;
  const Value& f_x = at.values->f_x;
  const Value& f_v = at.values->f_v;
  for (const ChosenValues& other : {ChosenValues{found.f_x, f_v, f_v.error},
                                    {f_x, found.f_v, f_x.error},
                                    {f_x, f_v, f_x.error + f_v.error}})
    if (miss(other.f_x, other.f_v) < 0.5 * miss(best.f_x, best.f_v)) best = other;
  return best;
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
  const double product = accurate_dot(x, v);
  const auto [f_x, g_y, of_prox] = values_at(of, split.x, product);
  split.inner = product;
  for (const double moved : {product - accurate_dot(W.solve(r), v), product - accurate_dot(x, r)}) {
    const double values = f_x.value + g_y.value;
    if (std::abs(values - moved) < std::abs(values - split.inner)) split.inner = moved;
  }
  Candidate made = finished(std::move(split), f_x, g_y, size, residual, W, z);
  // x·v and f(x) + f*(v) are one number: where its terms cancel, x·v is the less accurate of the two.
  const double gap = std::abs(made.split.fenchel_gap);
  // Programs minimise: their values are no less than f(x) and f*(v), and these no less together than x·v.
  if (made.split.fenchel_gap >= -made.rounding && std::isfinite(gap))
    made.error = std::min(made.error, gap + made.rounding + of_prox);
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

/// `found`, or a point of which nothing is known.
Prox made_up(const std::optional<Prox>& found, const Vector& point) {
  if (found) return *found;
  Prox made;
  made.x = point;
  made.error_bound = INFINITY;
  made.status = Status::gave_up;
  return made;
}

/// What the two proxes gave, held against the values. Where these do not bear it out, other pairs are tried:
/// the points moved into their domains, one of the two by Moreau's identity from the other, the covectors in
/// place of y, and x and v balanced.
Decomposition guarded(const Pair& of, const Vector& z, const Metric& W, double tolerance) {
  const auto prox_of = [&](const Function& h, const Vector& point, const Metric& V) {
    const WorkLimit part(part_of_a_prox);
    return h.prox(point, V);
  };
  Prox x = prox_of(of.f, z, W), y = prox_of(of.g, z, W);
  // What gave up without a point is found from the other, or not at all.
  const auto none = [&](const Prox& part) { return part.x.size() != z.size(); };
  if (none(x)) x = made_up(none(y) ? std::nullopt : moreau_partner(y, z, W), z);
  if (none(y)) y = made_up(moreau_partner(x, z, W), Vector::Zero(z.size()));
  Candidate best = at_points(of, x, y, z, W);
  const double size = W.norm(z) + W.norm(x.x), enough = tolerance * std::max({1.0, W.norm(z), W.norm(x.x)});
  const auto is_borne_out = [&](const Candidate& made) {
    return made.excess() <= 0 && made.known(tolerance) && made.split.error_bound <= enough;
  };
  const auto is_found = [&] { return is_borne_out(best); };
  const auto ended = [&] { return is_found() || WorkLimit::passed(); };
  const auto near = [&](const std::optional<Prox>& found) { return found && found->error_bound <= enough; };
  const auto into = [&](const Function& h, const std::optional<Prox>& found) {
    const WorkLimit part(part_of_a_move);
    return near(found) ? moved_into_domain(h, *found, size + W.norm(y.x), W) : std::nullopt;
  };
  const auto consider = [&](const std::optional<Prox>& of_x, const std::optional<Prox>& of_y) {
    if (is_found() || !near(of_x) || !near(of_y)) return;
    Candidate other = at_points(of, *of_x, *of_y, z, W);
    if (is_borne_out(other)) best = std::move(other);
  };
  // x with its covector, beside y and beside the y that the covector gives.
  const auto consider_covector = [&](const std::optional<Prox>& of_x) {
    if (is_found() || !near(of_x) || of_x->v.size() != z.size() || !of_x->v.allFinite()) return;
    for (const std::optional<Prox>& of_y : {std::optional(y), moreau_partner(*of_x, z, W)}) {
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
  }
  // What costs little beside the proxes is tried however much work these took.
  if (!is_found()) {
    const std::optional<Prox> x_of_y = moreau_partner(y, z, W);
    consider(x, moreau_partner(x, z, W));
    consider_covector(x);
    consider(x_of_y, y);
    consider_covector(x_of_y);
  }
  if (!ended()) consider_all(x);
  if (!ended()) {
    const WorkLimit part(part_of_a_prox);
    consider_all(balanced(of.f, x, z, W));
  }
  if (!ended()) {
    if (const auto* made = dynamic_cast<const Operation*>(&of.f.node())) {
      const std::optional<Prox> other = made->other_prox(z, W);
      consider(other, y);
      consider_all(other);
    }
  }
  if (!ended()) {
    consider(into(of.f, moreau_partner(y, z, W)), y);
  }
  if (!ended()) {
    const Vector force = metric_difference(W, z, Vector::Zero(z.size()));
    const Metric V = inverse(W);
    const Prox dual = prox_of(of.plain, force, V);
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
  // Where squares overflow, an infinite bound would be within an infinite tolerance.
  const bool finite =
      std::isfinite(split.f_x) && std::isfinite(split.g_y) && std::isfinite(split.error_bound);
  if (accurate && finite && split.status == Status::solved) return split;
  const bool gave_up = split.x.status == Status::gave_up || split.y.status == Status::gave_up;
  split.status = gave_up ? Status::gave_up : Status::inaccurate;
  return split;
}

}  // namespace convex
