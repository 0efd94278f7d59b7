#include "convex/other_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/metric_difference.hpp"
#include "convex/composite/work_limit.hpp"

namespace convex {
namespace {

/// So much of the scale squared weighs more than any function: the prox is then the nearest point of the
/// domain.
constexpr double nearest_point_weight = 1e12;

/// Moving x and v from one representation to another costs so many roundings of their sizes.
constexpr double roundings_of_a_move = 16;

}  // namespace

std::optional<Prox> moved_into_domain(const Function& f, const Prox& found, double scale, const Metric& W,
                                      const Look& look) {
  const double weight = f.facts().indicator ? 1 : nearest_point_weight / (scale * scale);
  if (!(weight > 0) || !std::isfinite(weight)) return std::nullopt;
  const Prox nearest = f.prox(found.x, W.scaled(weight), look);
  if (nearest.x.size() != found.x.size()) return std::nullopt;
  const double move = W.norm(nearest.x - found.x);
  if (!(move <= membership_tolerance * scale)) return std::nullopt;
  Prox moved = found;
  moved.x = nearest.x;
  moved.values.reset();
  moved.error_bound += move;
  return moved;
}

std::optional<Prox> moreau_partner(const Prox& of_f, const Vector& z, const Metric& W) {
  if (of_f.v.size() != z.size() || !of_f.v.allFinite()) return std::nullopt;
  Prox made = of_f;
  made.x = refined_solve(W, of_f.v);
  made.v = W.multiply(of_f.x);
  if (of_f.values) made.values = turned_round(*of_f.values);
  made.error_bound = of_f.error_bound + W.dual_norm(metric_difference(W, of_f.x, z) + of_f.v) +
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
  made.error_bound = dual->error_bound + W.dual_norm(metric_difference(W, made.x, z) + made.v) +
                     roundings_of_a_move * unit_roundoff * (W.norm(z) + W.norm(made.x));
  made.by_conjugate = true;
  if (!dual->method.starts_with("Moreau")) made.method = "Moreau's identity, " + dual->method;
  return made;
}

std::vector<Prox> balanced(const Function& f, const std::optional<Prox>& near, const Vector& z,
                           const Metric& W, const Look& look) {
  // Nearer to W the passes converge faster, and in V the result is the most accurate.
  constexpr double towards_W[] = {0x1p-24, 0x1p-18, 0x1p-12, 0x1p-6, 1};
  constexpr double slow = 0.5;
  constexpr int most_passes = 3;
  std::vector<Prox> found;
  if (!near || near->v.size() != z.size() || !near->v.allFinite()) return found;
  // What is 0 may be anything within the bound.
  const double X = std::max(W.norm(near->x), near->error_bound),
               V = std::max(W.dual_norm(near->v), near->error_bound);
  const double ratio = std::exp2(std::round(std::log2(V / X)));
  constexpr double farthest = 0x1p200;  // times and over weights it is a double still
  if (!(ratio > 1 / farthest && ratio < farthest)) return found;
  Vector x = near->x, v = near->v;
  double last = 0;
  for (const double part : towards_W) {
    const double s = ratio >= 1 ? std::max(1.0, part * ratio) : std::min(1.0, ratio / part);
    if (s == last) continue;
    last = s;
    double least = INFINITY;
    for (int pass = 0; pass < most_passes && !WorkLimit::passed(); ++pass) {
      if (ratio >= 1)
        v = metric_difference(W, z, x);
      else
        x = z - refined_solve(W, v);
      Prox made = f.prox(x + W.solve(v) / s, W.scaled(s), look);
      if (made.x.size() != z.size() || made.v.size() != z.size() || !made.v.allFinite()) return found;
      x = made.x;
      v = made.v;
      // The exact prox there is that of another point in W: of x + W⁻¹v, as far as x and v are right.
      made.error_bound = 2 * made.error_bound * (std::sqrt(s) + 1 / std::sqrt(s)) +
                         W.dual_norm(metric_difference(W, x, z) + v) +
                         roundings_of_a_move * unit_roundoff * (W.norm(z) + W.norm(x));
      const bool converging = made.error_bound < slow * least;
      least = std::min(least, made.error_bound);
      if (pass > 0 && made.error_bound < found.back().error_bound)
        found.back() = std::move(made);
      else if (pass == 0)
        found.push_back(std::move(made));
      if (!converging) break;
    }
  }
  std::reverse(found.begin(), found.end());
  return found;
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

}  // namespace convex
