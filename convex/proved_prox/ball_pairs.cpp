#include <cstdlib>

#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox::pairs {
namespace {

bool is_inside(const Fraction& radius, const Fractions& centre, const Fractions& x) {
  return !(radius * radius < square_of(difference(x, centre)));
}

/// radius |v| + c·v.
std::optional<FractionInterval> support_of_ball(const Fraction& radius, const Fractions& centre,
                                                const Fractions& v) {
  const Fraction square = square_of(v), of_centre = dot(centre, v);
  if (sign(square) == 0) return only(of_centre);
  const auto length = interval(sqrt(ball(square)));
  if (!length) return std::nullopt;
  return times(radius, *length) + only(of_centre);
}

MaybePair judged(const Fraction& radius, const Fractions& centre, Fractions x, Fractions v) {
  if (!is_inside(radius, centre, x)) return std::nullopt;
  const auto f_v = support_of_ball(radius, centre, v);
  if (!f_v) return std::nullopt;
  return ProofPair{std::move(x), std::move(v), only(Fraction{}), *f_v, false};
}

/// d times a power of two, between 1/2 and 2 long, but for a bit: of an entropy it may be e^-3000.
Fractions of_ordinary_length(Fractions d) {
  const Fraction square = square_of(d);
  const long bits = static_cast<long>(square.numerator.bits()) - static_cast<long>(square.denominator.bits()),
             half = bits / 2;
  const auto power = Integer::shifted(1, static_cast<unsigned long>(std::abs(half)));
  return multiple_of(half > 0 ? Fraction{1, power} : Fraction{power, 1}, std::move(d));
}

/// centre + radius d/|d|, pulled inside by a little; d is not 0.
Fractions boundary_point(const Fraction& radius, const Fractions& centre, const Fractions& d) {
  if (sign(radius) == 0) return centre;
  const Fractions direction = of_ordinary_length(d);
  const Ball length = sqrt(ball(square_of(direction)));
  return sum_of(centre, multiple_of(a_little_below(ball(radius) / length), direction));
}

}  // namespace

Fraction square_of(const Fractions& x) { return dot(x, x); }

Fractions multiple_of(const Fraction& factor, Fractions x) {
  for (Fraction& entry : x) entry = factor * entry;
  return x;
}

Fractions sum_of(const Fractions& x, const Fractions& y) {
  Fractions made(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) made[i] = x[i] + y[i];
  return made;
}

MaybePair best_of(std::vector<MaybePair> candidates, const Fractions& x, const Fractions& v) {
  MaybePair best;
  double least = 0;
  for (MaybePair& one : candidates) {
    if (!one || sign(gap_above(*one)) < 0) continue;
    const double cost = root_above(gap_above(*one) * Fraction{2}) +
                        root_above(square_of(difference(one->x, x))) +
                        root_above(square_of(difference(one->v, v)));
    if (best && !(cost < least)) continue;
    least = cost;
    best = std::move(one);
  }
  return best;
}

ProofPair sum_at_one_point(const ProofPair& f, const ProofPair& g) {
  return {f.x, sum_of(f.v, g.v), f.f_x + g.f_x, f.f_v + g.f_v, f.is_rational && g.is_rational};
}

MaybePair ball_at_point(const Fraction& radius, const Fractions& centre, const Fractions& x) {
  return judged(radius, centre, x, Fractions(x.size()));
}

MaybePair ball_at_covector(const Fraction& radius, const Fractions& centre, const Fractions& v) {
  if (sign(square_of(v)) == 0) return std::nullopt;
  return judged(radius, centre, boundary_point(radius, centre, v), v);
}

MaybePair of_ball(const Fraction& radius, const Fractions& centre, const Fractions& x, const Fractions& v) {
  const Fractions d = difference(x, centre);
  std::vector<MaybePair> candidates = {ball_at_covector(radius, centre, v)};
  if (is_inside(radius, centre, x)) {
    candidates.push_back(ball_at_point(radius, centre, x));
  } else if (sign(square_of(d)) != 0) {
    const Fractions x_in = boundary_point(radius, centre, d);
    candidates.push_back(judged(radius, centre, x_in, Fractions(x.size())));
    // The covector along d, as long as v.
    const Fraction length = dot(v, d) / square_of(d);
    if (sign(length) > 0) candidates.push_back(judged(radius, centre, x_in, multiple_of(length, d)));
  }
  return best_of(std::move(candidates), x, v);
}

}  // namespace convex::inline proved_prox::pairs
