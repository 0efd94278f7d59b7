#include "convex/decompositions/split_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/composite/closed_form.hpp"
#include "convex/composite/metric_difference.hpp"
#include "convex/functions/interior.hpp"
#include "convex/functions/other_pairs.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/operations/tied_parts.hpp"

namespace convex::inline decompositions {
namespace {

/// Values smaller than this count as this where the tolerance is relative to them.
constexpr double smallest_term = 1e-3;

/// A value whose error is more than this part of what is told is not told.
constexpr double largest_open_part = 1e-3;

/// A value that sums cancelling terms may be off by so many roundings of itself, where its own error says so.
constexpr double roundings_of_a_value = 64;

/// What each value may take of the work that a decomposition may.
constexpr double part_of_a_value = 0.1;

/// |W||b|, entry by entry: what the rounding of Wb is relative to.
Vector size_of_product(const Metric& W, const Vector& b) {
  const Vector y = b.cwiseAbs();
  switch (W.kind()) {
    case MetricKind::dense:
      return W.dense_gram().cwiseAbs() * y;
    case MetricKind::sparse: {
      const SparseMatrix magnitude = W.sparse_gram().cwiseAbs();
      return magnitude * y;
    }
    default:
      return W.diagonal().cwiseProduct(y);
  }
}

/// sum over i, j of |a_i W_ij b_j|: what the rounding of (a|b) is relative to.
double size_of_inner(const Metric& W, const Vector& a, const Vector& b) {
  return a.cwiseAbs().dot(size_of_product(W, b));
}

Value split_value_of(const Function& f, const Vector& x) {
  const WorkLimit part(part_of_a_value);
  return f.evaluate(x);
}

/// The largest of f(x), g(y) and (x|y).
double largest_value(const Decomposition& split) {
  return std::max({std::abs(split.f_x), std::abs(split.g_y), std::abs(split.inner)});
}

/// What they are to be right relative to.
double size_of_values(const Decomposition& split) { return std::max(largest_value(split), smallest_term); }

/// a·b in twice the precision.
double accurate_dot(const Vector& a, const Vector& b) {
  RunningSum sum;
  for (Index i = 0; i < a.size(); ++i) sum.add(two_product(a[i], b[i]));
  return sum.value();
}

Decomposition split_of(const SplitFunctions& of, Prox x, Prox y, const Vector& z, const Metric& W) {
  Decomposition split;
  split.x = std::move(x);
  split.y = std::move(y);
  // Whatever the way that the pair was found.
  const double doubt = doubt_of_ties(of.f, split.x.x, W);
  split.x.error_bound = std::max(split.x.error_bound, doubt);
  split.y.error_bound = std::max(split.y.error_bound, doubt);
  split.residual = W.norm(z - split.x.x - split.y.x);
  return split;
}

SplitCandidate finished(Decomposition split, const Value& f_x, const Value& g_y, double size, double residual,
                        const Metric& W, const Vector& z) {
  SplitCandidate made;
  split.f_x = f_x.value;
  split.g_y = g_y.value;
  split.fenchel_gap = split.f_x + split.g_y - split.inner;
  split.error_bound = bound_with_residual(split);
  made.right = split.fenchel_gap + 0.5 * residual * residual;
  made.error = f_x.error + g_y.error;
  const Vector &x = split.x.x, &y = split.y.x;
  made.squares = std::max({W.inner(z, z), W.inner(x, x), W.inner(y, y)});
  const double values = std::abs(split.f_x) + std::abs(split.g_y);
  made.rounding = roundings_of_a_term * unit_roundoff * (values + size) +
                  std::min(made.error, roundings_of_a_value * unit_roundoff * values);
  // f and g are those at points that the bounds leave open, to first order, where these are rounding.
  const double X = W.norm(x), Y = W.norm(y), least = roundings_of_a_term * unit_roundoff * (W.norm(z) + X);
  made.rounding += std::min(split.x.error_bound, least) * Y + std::min(split.y.error_bound, least) * X;
  const auto is_open = [&](const Value& value) {
    const double told = std::max(std::abs(value.value), smallest_term);
    return value.error > std::max(largest_open_part * told, made.rounding);
  };
  made.open = is_open(f_x) || is_open(g_y);
  made.split = std::move(split);
  return made;
}

/// f(x) and f*(v).
struct ChosenValues {
  Value f_x, f_v;
  Value at_x;  ///< f(x) of the point itself
};

/// The values that the prox came with are of a point and a covector that are feasible as far as their errors
/// say: at least f(x) and f*(v). Where they, or one of them and the other evaluated, come nearer to x·v than
/// what is evaluated, they are taken; where f(x) or f*(v) itself is +inf, only when x and v are roundings of
/// where it is not.
ChosenValues values_at(const SplitFunctions& of, const Prox& at, double product) {
  const Value at_x = split_value_of(of.f, at.x);
  const ChosenValues found{at_x, split_value_of(of.plain, at.v), at_x};
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
  for (const ChosenValues& other : {ChosenValues{at_x, f_v, at_x}, {f_x, found.f_v, at_x}, {f_x, f_v, at_x}})
    if (miss(other.f_x, other.f_v) < 0.5 * miss(best.f_x, best.f_v)) best = other;
  return best;
}

}  // namespace

double bound_with_residual(const Decomposition& split) {
  const double x = split.x.error_bound, y = split.y.error_bound;
  const double residual = split.residual;
  return residual <= x + y ? std::max({x, y, residual}) : residual + std::max(x, y);
}

double SplitCandidate::excess() const {
  const double square = split.error_bound * split.error_bound;
  const double most = std::max(right - square, -right) - rounding;
  return std::isfinite(most) ? most : INFINITY;
}

double SplitCandidate::proved() const {
  const double most = 2 * std::abs(right) + error + rounding;
  return std::isfinite(most) ? std::sqrt(2 * most) : INFINITY;
}

bool SplitCandidate::known(double tolerance) const {
  const double size = size_of_values(split);
  return !open && std::abs(split.fenchel_gap) <= tolerance * size &&
         error <= tolerance * std::max(size, squares);
}

bool SplitCandidate::knows_g() const {
  return error <= largest_open_part * std::max(std::abs(split.g_y), smallest_term);
}

SplitCandidate at_points(const SplitFunctions& of, Prox x_part, Prox y_part, const Vector& z,
                         const Metric& W) {
  Decomposition split = split_of(of, std::move(x_part), std::move(y_part), z, W);
  const Vector &x = split.x.x, &y = split.y.x;
  split.inner = W.inner(x, y);
  const double size = size_of_inner(W, x, y), residual = split.residual;
  return finished(std::move(split), split_value_of(of.f, x), split_value_of(of.g, y), size, residual, W, z);
}

SplitCandidate at_covector(const SplitFunctions& of, Prox x_part, Prox y_part, const Vector& z,
                           const Metric& W, double tolerance) {
  Decomposition split = split_of(of, std::move(x_part), std::move(y_part), z, W);
  const Vector &x = split.x.x, &y = split.y.x, &v = split.x.v;
  split.y.error_bound += W.dual_norm(metric_difference(W, y, Vector::Zero(y.size())) - v);
  const Vector r = metric_difference(W, x, z) + v;
  const double size = x.cwiseAbs().dot(v.cwiseAbs()), residual = W.dual_norm(r);
  const double product = accurate_dot(x, v);
  const auto [f_x, g_y, at_x] = values_at(of, split.x, product);
  split.inner = product;
  const Vector of_r = size_of_product(W, x) + size_of_product(W, z) + v.cwiseAbs();
  if ((r.cwiseAbs().array() <= roundings_of_a_term * unit_roundoff * of_r.array()).all())
    for (const double moved : {product - accurate_dot(W.solve(r), v), product - accurate_dot(x, r)}) {
      const double values = f_x.value + g_y.value;
      if (std::abs(values - moved) < std::abs(values - split.inner)) split.inner = moved;
    }
  SplitCandidate made = finished(std::move(split), f_x, g_y, size, residual, W, z);
  const double gap = std::abs(made.split.fenchel_gap);
  // An indicator's value is 0 or +inf, and so is that of a support function's conjugate.
  const Facts facts = of.f.facts();
  const bool is_of_f = f_x.error > g_y.error, is_zero = is_of_f ? facts.indicator : facts.support;
  const bool is_left_open =
      !is_zero && gap <= made.error && made.error <= largest_open_part * largest_value(made.split);
  if (is_left_open && gap > roundings_of_a_term * unit_roundoff * size) {
    // Where a program leaves a value open, by a small part of it, the others say it.
    if (is_of_f)
      made.split.f_x = made.split.inner - g_y.value;
    else
      made.split.g_y = made.split.inner - f_x.value;
    made.split.fenchel_gap = 0;
  } else if (gap <= std::max(roundings_of_a_term * unit_roundoff * size, made.rounding)) {
    // x·v and f(x) + f*(v) are one number: where its terms cancel, or x and v are roundings beside a far z,
    // x·v is the less accurate of the two.
    made.split.inner = f_x.value + g_y.value;
    made.split.fenchel_gap = 0;
  }
  // Where f is steep its value is that of the x told, and (x|y), of larger terms, goes with it.
  // So it is where x is outside by the rounding of a far z, which leaves a doubt about x and not about f.
  const double agreement = std::max(f_x.error, tolerance * size_of_values(made.split));
  const bool agrees = std::abs(at_x.value - made.split.f_x) <= agreement;
  made.x_is_outside = !std::isfinite(at_x.value) || !std::isfinite(at_x.error);
  const bool in_doubt = std::isinf(at_x.error) && agrees;
  made.open = made.open || (std::isfinite(at_x.value) && std::isinf(at_x.error) && !agrees);
  if (std::isfinite(at_x.value) && (in_doubt || at_x.error <= tolerance * std::abs(at_x.value))) {
    made.split.inner += at_x.value - made.split.f_x;
    made.split.f_x = at_x.value;
  }
  return made;
}

namespace {

/// The least and the largest eigenvalue of W; none of sparse ones, which would be made dense.
std::optional<std::pair<double, double>> spectrum(const Metric& W) {
  if (W.kind() == MetricKind::sparse) return std::nullopt;
  const Vector values =
      W.kind() == MetricKind::dense ? linear_algebra::eigenvalues(W.dense_gram()) : W.diagonal();
  return std::pair(values.minCoeff(), values.maxCoeff());
}

bool is_inside(const Function& f, const Vector& x) {
  const WorkLimit part(part_of_a_value);
  return is_well_inside(f, x, x.norm());
}

}  // namespace

std::optional<SplitCandidate> at_zero(const SplitFunctions& of, const Vector& x, const Vector& z,
                                      const Metric& W, double enough) {
  const Value first = split_value_of(x.isZero(0) ? of.f : of.g, Vector::Zero(z.size()));
  const double least = first.error + roundings_of_a_term * unit_roundoff * std::abs(first.value);
  if (!(std::sqrt(2 * least) <= enough)) return std::nullopt;
  const auto point = [](const Vector& p, const Vector& other) {
    return Prox{.x = p, .v = other, .route = ProxRoute::iterative, .method = "values at 0"};
  };
  const Vector y = z - x;
  const Vector slope = W.multiply(y);
  SplitCandidate made = at_points(of, point(x, slope), point(y, W.multiply(x)), z, W);
  // The other part may be outside its domain by `membership_tolerance` of its plain length.
  double slack = 0;
  if (x.isZero(0) ? !is_inside(of.plain, slope) : !is_inside(of.f, z)) {
    const auto of_W = spectrum(W);
    if (!of_W) return std::nullopt;
    slack = membership_tolerance *
            (x.isZero(0) ? slope.norm() / std::sqrt(of_W->first) : z.norm() * std::sqrt(of_W->second));
  }
  // z itself was rounded when it was read.
  const double of_z = unit_roundoff * W.norm(z);
  made.rounding += (slack * slack + of_z * of_z) / 2;
  made.split.x.error_bound = made.split.y.error_bound = made.split.error_bound = made.proved();
  return made;
}

Value told_value(const Function& f, const Vector& x) {
  try {
    return split_value_of(f, x);
  } catch (const InvalidInput&) {
    return {std::numeric_limits<double>::infinity(), 0};
  }
}

bool holds_nearer_point(const SplitFunctions& of, const Decomposition& split, const Vector& z,
                        const Metric& W) {
  constexpr double far_beyond = 8, far_more = 512 * accuracy_of_prox;
  const auto holds = [&](const Function& set, const Prox& told) {
    const Vector way = z - told.x;
    if (!(W.norm(way) > far_beyond * told.error_bound)) return false;
    if (!(way.norm() > far_more * (z.norm() + told.x.norm()))) return false;
    const Value in_the_middle = told_value(set, told.x + 0.5 * way);
    return in_the_middle.value == 0 && in_the_middle.error == 0;
  };
  const Facts facts = of.f.facts();
  return (facts.indicator && holds(of.f, split.x)) || (facts.support && holds(of.g, split.y));
}

double size_of_slope(const Function& f, const Vector& x) {
  const std::optional<Vector> v = f.subgradient(x);
  return v && v->allFinite() ? v->cwiseAbs().dot(x.cwiseAbs()) : 0;
}

bool is_inner_of_points(const Decomposition& split, double tolerance, const Metric& W) {
  const Vector &x = split.x.x, &y = split.y.x;
  const double size = size_of_values(split);
  const double rounding = roundings_of_a_term * unit_roundoff * size_of_inner(W, x, y);
  return std::abs(W.inner(x, y) - split.inner) <= tolerance * size + rounding;
}

}  // namespace convex::inline decompositions
