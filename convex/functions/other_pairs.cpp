#include "convex/functions/other_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/closed_form.hpp"
#include "convex/composite/metric_difference.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/linear_algebra/pivoted_qr.hpp"

namespace convex::inline named_functions {
namespace {

/// So much of the scale squared weighs more than any function: the prox is then the nearest point of the
/// domain.
constexpr double nearest_point_weight = 1e12;

/// Moving x and v from one representation to another costs so many roundings of their sizes.
constexpr double roundings_of_a_move = 16;

}  // namespace

std::optional<Prox> moved_into_domain(const Function& f, const Prox& found, double scale, const Metric& W,
                                      const Look& look) {
  // In units of what is far from the point f may outweigh it.
  for (const double unit : {scale, 1.0}) {
    const double weight = f.facts().indicator ? 1 : nearest_point_weight / (unit * unit);
    if (!(weight > 0) || !std::isfinite(weight)) return std::nullopt;
    const Prox nearest = f.prox(found.x, W.scaled(weight), look);
    if (nearest.x.size() != found.x.size()) return std::nullopt;
    const double move = W.norm(nearest.x - found.x);
    if (move <= membership_tolerance * scale) {
      Prox moved = found;
      moved.x = nearest.x;
      moved.values.reset();
      moved.error_bound += move;
      return moved;
    }
    if (scale <= 1 || f.facts().indicator) break;
  }
  return std::nullopt;
}

std::optional<Prox> moreau_partner(const Prox& of_f, const Vector& z, const Metric& W) {
  if (of_f.v.size() != z.size() || !of_f.v.allFinite()) return std::nullopt;
  Prox made = of_f;
  made.x = refined_solve(W, of_f.v);
  made.v = metric_difference(W, of_f.x, Vector::Zero(z.size()));
  if (of_f.values) made.values = turned_round(*of_f.values);
  made.error_bound = of_f.error_bound + W.dual_norm(stationarity(z, W, of_f.x, of_f.v)) +
                     miss_of_solve(W, made.x, of_f.v) +
                     roundings_of_a_move * unit_roundoff * (W.norm(z) + W.norm(of_f.x));
  if (!of_f.method.starts_with("Moreau")) made.method = "Moreau's identity, " + of_f.method;
  return made;
}

std::optional<Prox> turned(const std::optional<Prox>& dual, const Vector& z, const Metric& W) {
  if (!dual || dual->x.size() != z.size() || dual->v.size() != z.size() || !dual->v.allFinite())
    return std::nullopt;
  Prox made = *dual;
  made.x = dual->v;
  made.v = dual->x;
  if (dual->values) made.values = turned_round(*dual->values);
  made.error_bound = dual->error_bound + W.dual_norm(stationarity(z, W, made.x, made.v)) +
                     roundings_of_a_move * unit_roundoff * (W.norm(z) + W.norm(made.x));
  made.by_conjugate = true;
  if (!dual->method.starts_with("Moreau")) made.method = "Moreau's identity, " + dual->method;
  return made;
}

namespace {

/// A metric of some size beside W, and the entries of x (the others: of v) that are kept from pass to pass.
struct Balance {
  Metric V;
  double distance = 1;       ///< of V from W: at least their ratio and its inverse, in each direction
  std::vector<bool> keep_x;  ///< n
};

/// Passes in one metric from x and v, which they move.
std::optional<Prox> passes(const Function& f, const Balance& balance, Vector& x, Vector& v, const Vector& z,
                           const Metric& W, const Look& look) {
  constexpr double slow = 0.5;
  constexpr int most_passes = 3;
  std::optional<Prox> best;
  double least = INFINITY;
  for (int pass = 0; pass < most_passes && !WorkLimit::passed(); ++pass) {
    const Vector of_x = metric_difference(W, z, x), of_v = z - refined_solve(W, v);
    for (Index i = 0; i < z.size(); ++i) {
      const bool kept = balance.keep_x[static_cast<std::size_t>(i)];
      (kept ? v : x)[i] = (kept ? of_x : of_v)[i];
    }
    Prox made = f.prox(x + balance.V.solve(v), balance.V, look);
    if (made.x.size() != z.size() || made.v.size() != z.size() || !made.v.allFinite()) break;
    x = made.x;
    v = made.v;
    // The exact prox there is that of another point in W: of x + W⁻¹v, as far as x and v are right.
    const double root = std::sqrt(balance.distance);
    made.error_bound = 2 * made.error_bound * (root + 1 / root) +
                       W.dual_norm(metric_difference(W, x, z) + v) +
                       roundings_of_a_move * unit_roundoff * (W.norm(z) + W.norm(x));
    const bool converging = made.error_bound < slow * least;
    least = std::min(least, made.error_bound);
    if (!best || made.error_bound < best->error_bound) best = std::move(made);
    if (!converging) break;
  }
  return best;
}

/// The power of 2 next to |v| over |x|, each at least `least`; none where it is out of range.
std::optional<double> power_of_ratio(double x, double v, double least) {
  constexpr double farthest = 0x1p200;  // times and over weights it is a double still
  const double ratio = std::exp2(std::round(std::log2(std::max(v, least) / std::max(x, least))));
  return ratio > 1 / farthest && ratio < farthest ? std::optional(ratio) : std::nullopt;
}

/// Entry by entry, where W couples none.
std::optional<Balance> balance_of_entries(const Prox& at, const Metric& W) {
  if (at.x.size() < 2 || (W.kind() != MetricKind::identity && W.kind() != MetricKind::diagonal))
    return std::nullopt;
  constexpr double farthest = 0x1p40;  // from W: what is smaller beside the other is 0
  Balance made{W, 1, {}};
  Vector weights = W.diagonal();
  for (Index i = 0; i < at.x.size(); ++i) {
    const double root = std::sqrt(weights[i]);
    const auto ratio = power_of_ratio(std::abs(at.x[i]) * root, std::abs(at.v[i]) / root, at.error_bound);
    if (!ratio) return std::nullopt;
    const double s = std::clamp(*ratio, 1 / farthest, farthest);
    weights[i] *= s;
    made.distance = std::max({made.distance, s, 1 / s});
    made.keep_x.push_back(s >= 1);
  }
  made.V = Metric::diagonal(weights);
  return made;
}

}  // namespace

std::vector<Prox> balanced(const Function& f, const std::optional<Prox>& near, const Vector& z,
                           const Metric& W, const Look& look) {
  // Nearer to W the passes converge faster, and in V the result is the most accurate.
  constexpr double towards_W[] = {0x1p-24, 0x1p-18, 0x1p-12, 0x1p-6, 1};
  std::vector<Prox> found;
  if (!near || near->v.size() != z.size() || !near->v.allFinite()) return found;
  // What is 0 may be anything within the bound.
  const auto in_range = power_of_ratio(W.norm(near->x), W.dual_norm(near->v), near->error_bound);
  if (!in_range) return found;
  const double ratio = *in_range;
  Vector x = near->x, v = near->v;
  double last = 0;
  for (const double part : towards_W) {
    const double s = ratio >= 1 ? std::max(1.0, part * ratio) : std::min(1.0, ratio / part);
    if (s == last) continue;
    last = s;
    const std::vector<bool> keep_x(static_cast<std::size_t>(z.size()), ratio >= 1);
    auto made = passes(f, {W.scaled(s), std::max(s, 1 / s), keep_x}, x, v, z, W, look);
    if (!made) break;
    found.push_back(*std::move(made));
  }
  if (const auto by_entries = balance_of_entries(*near, W)) {
    x = near->x;
    v = near->v;
    if (auto made = passes(f, *by_entries, x, v, z, W, look)) found.push_back(*std::move(made));
  }
  std::reverse(found.begin(), found.end());
  return found;
}

std::optional<Prox> without_small_entries(const Prox& found, const Metric& W) {
  const Vector small =
      (found.x.cwiseAbs().cwiseProduct(W.diagonal().cwiseSqrt()).array() <= found.error_bound)
          .select(found.x, Vector::Zero(found.x.size()));
  if (small.isZero(0) || !std::isfinite(found.error_bound)) return std::nullopt;
  Prox moved = found;
  moved.x -= small;
  moved.error_bound += W.norm(small);
  moved.values.reset();
  return moved;
}

std::optional<Prox> with_slope(const Function& f, const std::optional<Prox>& at, const Vector& z,
                               const Metric& W) {
  if (!at || !f.facts().smooth) return std::nullopt;
  const std::optional<Vector> v = f.subgradient(at->x);
  if (!v || !v->allFinite()) return std::nullopt;
  Prox made = *at;
  made.v = *v;
  made.values.reset();
  made.error_bound += W.dual_norm(metric_difference(W, at->x, z) + *v);
  return made;
}

namespace {

/// A point with the slope there and W(x - z) + v, of which `size` is the norm.
struct Slope {
  Vector x, v, residual;
  double size = 0;
};

std::optional<Slope> slope_at(const Function& f, const Vector& x, const Vector& z, const Metric& W) {
  std::optional<Vector> v = f.subgradient(x);
  if (!v || v->size() != x.size() || !v->allFinite()) return std::nullopt;
  Slope made{x, *std::move(v), {}, 0};
  made.residual = metric_difference(W, x, z) + made.v;
  made.size = W.dual_norm(made.residual);
  if (!std::isfinite(made.size)) return std::nullopt;
  return made;
}

/// The Newton step from the differences of the slopes beside x, each entry in units of its own stiffness;
/// none where the slope jumps or f ends beside x.
std::optional<Vector> newton_step(const Function& f, const Slope& at, const Vector& z, const Metric& W) {
  constexpr double part = 0x1p-20;  // of an entry: half of the digits go into the difference
  const Index n = z.size();
  Matrix J = gram(W);
  for (Index i = 0; i < n; ++i) {
    Vector beside = at.x;
    beside[i] += part * (at.x[i] != 0 ? at.x[i] : at.x.norm());
    const double step = beside[i] - at.x[i];
    const std::optional<Slope> there = step != 0 ? slope_at(f, beside, z, W) : std::nullopt;
    if (!there) return std::nullopt;
    J.col(i) += (there->v - at.v) / step;
  }
  const Vector unit = J.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  if (!unit.allFinite()) return std::nullopt;
  const Vector step = linear_algebra::least_squares(unit.asDiagonal() * J * unit.asDiagonal(),
                                                    Vector(unit.cwiseProduct(-at.residual)));
  if (!step.allFinite()) return std::nullopt;
  return Vector(unit.cwiseProduct(step));
}

}  // namespace

std::optional<Prox> along_slopes(const Function& f, const std::optional<Prox>& near, const Vector& z,
                                 const Metric& W) {
  constexpr Index most_entries = 16;  // each costs a subgradient a step
  constexpr int most_steps = 40, most_halvings = 6;
  constexpr double flat = 0.1, slow = 0.9;  // steep powers of x take steps by a factor
  if (!near || near->x.size() != z.size() || z.size() > most_entries) return std::nullopt;
  std::optional<Slope> best = slope_at(f, near->x, z, W);
  bool is_flat = true;  // beside W
  const auto rounding = [&] { return roundings_of_a_move * unit_roundoff * (W.norm(z) + W.norm(best->x)); };
  for (int count = 0; best && count < most_steps && !WorkLimit::passed(); ++count) {
    if (best->size <= rounding()) break;
    if (is_flat) {
      std::optional<Slope> next = slope_at(f, best->x - W.solve(best->residual), z, W);
      is_flat = next && next->size < flat * best->size;
      if (is_flat) best = std::move(next);
      if (is_flat || WorkLimit::passed()) continue;
    }
    const std::optional<Vector> step = newton_step(f, *best, z, W);
    if (!step) break;
    std::optional<Slope> next;
    double length = 1;
    for (int halving = 0; halving < most_halvings; ++halving, length /= 2) {
      next = slope_at(f, best->x + length * *step, z, W);
      if (next && next->size < best->size) break;
      next.reset();
    }
    if (!next) break;
    const bool is_slow = length == 1 && next->size > slow * best->size;
    best = std::move(next);
    if (is_slow) break;
  }
  if (!best) return std::nullopt;
  // A slope that a program found is one but for what f(x) + f*(v) exceeds x·v by.
  const Vector &x = best->x, &v = best->v;
  const Value f_x = f.evaluate(x), f_v = f.conjugate().evaluate(v);
  const double of_terms = x.cwiseAbs().dot(v.cwiseAbs()) + std::abs(f_x.value) + std::abs(f_v.value);
  const double open = std::abs(f_x.value + f_v.value - x.dot(v)) + f_x.error + f_v.error +
                      roundings_of_a_move * unit_roundoff * of_terms;
  if (!std::isfinite(open)) return std::nullopt;
  Prox made = *near;
  made.x = x;
  made.v = v;
  made.values = {f_x, f_v, 0};
  made.error_bound = best->size + rounding() + std::sqrt(open);
  return made;
}

}  // namespace convex::inline named_functions
