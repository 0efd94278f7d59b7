#include "convex/proved_prox/proof_in_doubles.hpp"

#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/double_double.hpp"
#include "convex/exact/rounding_bounds.hpp"
#include "convex/interval_arithmetic.hpp"
#include "convex/invalid_input.hpp"
#include "convex/proved_prox/doubles/metric_bounds.hpp"
#include "convex/proved_prox/doubles/near_graph.hpp"

namespace convex::inline proved_prox {
namespace {

using near_graphs::MetricBounds, near_graphs::near_graph, near_graphs::NearGraph;

/// Proofs of fewer digits are left to fractions and balls.
constexpr double least_accuracy = 1e-10;

/// Pairs nearer than this are not looked for again.
constexpr double near_rounding = 1e-12;

bool usable(const Vector& v, const Vector& z) { return v.size() == z.size() && v.allFinite(); }

/// A pair, and how far x* and y* are from its x' and W⁻¹v'.
struct Proof {
  NearGraph pair;
  double radius = INFINITY;
};

/// a - b for |a' - a| <= radius: the radius of the difference replaces it.
Vector difference_of(const Vector& a, const Vector& b, Vector& radius) {
  const Vector d = a - b;
  radius = (radius + unit_roundoff * d.cwiseAbs()) * (1 + 4 * unit_roundoff);
  return d;
}

/// ½||x' - x*||² + ½||y' - y*||² <= gap + ½||W(z - x') - v'||²_(W⁻¹) (docs/theory.md, C.9).
Proof judged(NearGraph pair, const RoundedQuestion& question, const MetricBounds& W) {
  Vector radius = question.z_radius + pair.x_radius;
  Vector covector = difference_of(question.z, pair.x, radius);
  W.multiply(covector, radius);
  radius += pair.v_radius;
  const Vector miss = difference_of(covector, pair.v, radius);
  const double off =
      W.dual_norm_above(miss, radius) + W.norm_above(pair.x_ball) + W.dual_norm_above(pair.v_ball);
  const double proved = above(std::hypot(above(off), std::sqrt(2 * above(pair.gap))));
  return {std::move(pair), proved};
}

/// The pair at x and v themselves, or, where it is not near enough, with one of them 0, or at their resolvent
/// in the plain product, p = x + v, (prox p, p - prox p): its formula tells which entries are at a corner.
std::optional<Proof> proof_near(const Vector& x, const Vector& v, const RoundedQuestion& question,
                                const MetricBounds& W, double enough) {
  std::optional<Proof> best;
  const auto consider = [&](const Vector& point, const Vector& covector) {
    if (auto pair = near_graph(question.f, question.W, point, covector)) {
      Proof made = judged(std::move(*pair), question, W);
      if (!best || made.radius < best->radius) best = std::move(made);
    }
  };
  consider(x, v);
  if (best && best->radius <= enough) return best;
  // Where all but roundings belongs to x, or to v, the other is 0.
  consider(x, Vector::Zero(x.size()));
  consider(Vector::Zero(x.size()), v);
  if (best && best->radius <= enough) return best;
  try {
    const Vector both = x + v;
    const Prox resolved = make_function(question.f, {question.W}).prox(both, Metric::identity(both.size()));
    if (resolved.x.size() == x.size() && resolved.x.allFinite())
      consider(resolved.x, resolved.v.size() == x.size() ? resolved.v : Vector(both - resolved.x));
  } catch (const InvalidInput&) {  // no such prox: the pair at x and v stands
  }
  return best;
}

/// f(x*) >= v'·x* - f*(v'), g(y*) >= x'·Wy* - f(x'), and both add up to (x*|y*).
void enclose_values(const MetricBounds& W, const Proof& proof, ProvedSplit& made) {
  const NearGraph& pair = proof.pair;
  const Interval product = inner_product(pair);
  const double X = above(W.norm_above(pair.x, pair.x_radius) + W.norm_above(pair.x_ball)),
               Y = above(W.dual_norm_above(pair.v, pair.v_radius) + W.dual_norm_above(pair.v_ball)),
               off = above(proof.radius * (X + Y + proof.radius));
  const Interval inner{moved_down(product.low - off), moved_up(product.high + off)};
  // f*(v') <= x'·v' - f(x') + gap.
  const double dual_high = moved_up(product.high - pair.f_x.low + pair.gap, 4);
  const double f_low = moved_down(product.low - above(Y * proof.radius) - dual_high, 4),
               g_low = moved_down(product.low - above(X * proof.radius) - pair.f_x.high, 4);
  made.inner = {inner.low, inner.high};
  made.f_x = {f_low, moved_up(inner.high - g_low)};
  made.g_y = {g_low, moved_up(inner.high - f_low)};
}

/// At least ||z - x - y||_W.
double sum_miss(const RoundedQuestion& question, const Vector& x, const Vector& y, const MetricBounds& W) {
  const Vector& z = question.z;
  Vector left(z.size());
  for (Index i = 0; i < z.size(); ++i) {
    const DoubleDouble first = two_sum(z[i], -x[i]), rest = two_sum(first.hi, -y[i]);
    const double missing = rest.hi + (rest.lo + first.lo);
    const bool is_exact = rest.hi == 0 && rest.lo == 0 && first.lo == 0;
    left[i] =
        is_exact ? 0 : moved_up(std::abs(missing), 4) + 4 * unit_roundoff * std::abs(rest.lo + first.lo);
  }
  return W.norm_above(Vector(left + question.z_radius));
}

}  // namespace

std::optional<ProvedSplit> proof_in_doubles(const RoundedQuestion& question, const Decomposition& split) {
  const Vector &x = split.x.x, &y = split.y.x, &z = question.z;
  if (!usable(x, z) || !usable(y, x) || !z.allFinite()) return std::nullopt;
  const double size = z.cwiseAbs().maxCoeff();
  if (size > largest_ordinary || (size > 0 && size < smallest_ordinary)) return std::nullopt;
  if (!is_ordinary(question.W.diagonal())) return std::nullopt;
  const MetricBounds W(question.W, question.W_error);
  if (!W.is_proved_definite()) return std::nullopt;
  const Vector of_x = usable(split.x.v, x) ? split.x.v : question.W.multiply(z - x),
               of_y = usable(split.y.v, y) ? split.y.v : question.W.multiply(z - y);
  const double scale = std::max(1.0, question.W.norm(z)), enough = near_rounding * scale;
  const auto of_first = proof_near(x, of_x, question, W, enough);
  if (!of_first) return std::nullopt;
  const auto of_second = proof_near(question.W.solve(of_y), question.W.multiply(y), question, W, enough);
  if (!of_second) return std::nullopt;
  const Proof &first = *of_first, &second = *of_second;
  ProvedSplit made;
  Vector radius = first.pair.x_radius;
  const Vector away = difference_of(x, first.pair.x, radius);
  made.x_bound = above(W.norm_above(away, radius) + W.norm_above(first.pair.x_ball) + first.radius);
  Vector covector = y, dual_radius = Vector::Zero(y.size());
  W.multiply(covector, dual_radius);
  dual_radius += second.pair.v_radius;
  const Vector dual_away = difference_of(covector, second.pair.v, dual_radius);
  made.y_bound = above(W.dual_norm_above(dual_away, dual_radius) + W.dual_norm_above(second.pair.v_ball) +
                       second.radius);
  made.sum_miss = sum_miss(question, x, y, W);
  const bool is_accurate = made.error_bound() <= least_accuracy * scale;
  if (!is_accurate || !(made.sum_miss <= above(made.x_bound + made.y_bound))) return std::nullopt;
  enclose_values(W, first.radius <= second.radius ? first : second, made);
  made.level = ProofLevel::enclosure;
  return made;
}

}  // namespace convex::inline proved_prox
