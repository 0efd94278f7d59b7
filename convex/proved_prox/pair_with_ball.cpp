#include <cmath>

#include "convex/exact_program/program_operations.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox::pairs {
namespace {

/// The prox of P at s with a spring lambda ½|x - c|²: P's point x and covector s - x - lambda (x - c).
std::optional<GraphPoint> with_spring(const ExactProgram& P, const Fractions& s, const Fractions& centre,
                                      const Fraction& lambda) {
  const Fraction weight = Fraction{1} + lambda;
  ExactGram V = identity_gram(s.size());
  for (std::size_t i = 0; i < s.size(); ++i) V.rows[i] = {{i, weight}};
  return exact_prox(P, V, multiple_of(Fraction{1} / weight, sum_of(s, multiple_of(lambda, centre)))).at;
}

/// t in [0, 1] with |a + t b|² = square, a little towards 0 from it: |a|² <= square <= |a + b|².
std::optional<Fraction> part_of_way(const Fractions& a, const Fractions& b, const Fraction& square) {
  const Fraction A = square_of(b), B = dot(a, b), C = square - square_of(a);
  if (sign(C) <= 0) return Fraction{};
  // C / (B + sqrt(B² + A C)), without cancellation where B >= 0.
  const Ball root = sqrt(ball(B * B + A * C));
  const auto found = near(ball(C) / (ball(B) + root));
  if (!found || sign(*found) <= 0) return std::nullopt;
  return a_little_below(ball(*found));
}

}  // namespace

std::optional<ProgramAndBallPairs> of_program_beside_ball(const ExactProgram& P, const Fraction& radius,
                                                          const Fractions& centre, const Fractions& x,
                                                          const Fractions& v) {
  const Fraction square = radius * radius;
  const Fractions s = fractions(nearest(sum_of(x, v)));
  const auto is_inside = [&](const GraphPoint& at) {
    return !(square < square_of(difference(at.x, centre)));
  };
  // |x - c| falls as lambda grows: the two doubles between which it passes the radius.
  double low = 0, high = 1;
  std::optional<GraphPoint> outside = with_spring(P, s, centre, fraction(low)), inside;
  if (!outside || is_inside(*outside)) return std::nullopt;
  constexpr double most_spring = 0x1p60, least_gap = 0x1p-50;
  for (; high < most_spring; high *= 16) {
    auto at = with_spring(P, s, centre, fraction(high));
    if (!at) return std::nullopt;
    const bool found = is_inside(*at);
    (found ? inside : outside) = std::move(at);
    if (found) break;
    low = high;
  }
  if (!inside) return std::nullopt;
  while (high - low > least_gap * high) {
    const double between = 0.5 * (low + high);
    auto at = with_spring(P, s, centre, fraction(between));
    if (!at) return std::nullopt;
    const bool found = is_inside(*at);
    (found ? inside : outside) = std::move(at);
    (found ? high : low) = between;
  }
  // Between them the graph of ∂P is a segment, but for kinks, which the values tell.
  const Fractions step = difference(outside->x, inside->x);
  const auto t = part_of_way(difference(inside->x, centre), step, square);
  if (!t) return std::nullopt;
  const Fractions point = sum_of(inside->x, multiple_of(*t, step)),
                  of_P = sum_of(inside->v, multiple_of(*t, difference(outside->v, inside->v))),
                  arm = difference(point, centre), of_ball = multiple_of(fraction(high), arm);
  const Fraction arm_square = square_of(arm);
  if (square < arm_square) return std::nullopt;
  const ExactValue value = exact_value(P, point), dual = exact_value(exact_programs::conjugate(P), of_P);
  const auto length = interval(sqrt(ball(arm_square)));
  if (value.end != ProgramEnd::minimum || dual.end != ProgramEnd::minimum || !length) return std::nullopt;
  const FractionInterval support = only(dot(centre, of_ball)) + times(radius * fraction(high), *length);
  return ProgramAndBallPairs{{point, of_P, only(value.value), only(dual.value), false},
                             {point, of_ball, only(Fraction{}), support, false}};
}

}  // namespace convex::inline proved_prox::pairs
