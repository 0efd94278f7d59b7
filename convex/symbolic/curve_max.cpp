#include <algorithm>

#include "convex/invalid_input.hpp"
#include "convex/symbolic/exact_curve.hpp"

namespace convex::symbolic {
namespace {

/// The integer part of the root of n >= 0 (Newton from above).
Integer integer_root(const Integer& n) {
  if (n.is_zero()) return 0;
  Integer x = Integer::shifted(1, n.bits() / 2 + 1);
  for (;;) {
    const Integer next = truncated_quotient(x + truncated_quotient(n, x), 2);
    if ((x - next).sign() <= 0) return x;
    x = next;
  }
}

/// The root of a fraction >= 0 where it is one.
std::optional<Fraction> exact_root(const Fraction& a) {
  const Fraction lowest = lowest_terms(a);
  const Integer p = integer_root(lowest.numerator), q = integer_root(lowest.denominator);
  if (!(p * p - lowest.numerator).is_zero() || !(q * q - lowest.denominator).is_zero()) return std::nullopt;
  return Fraction{p, q};
}

/// a/2 x² + b x + c.
struct Parabola {
  Fraction a, b, c;
  Fraction at(const Fraction& x) const { return (Fraction{1, 2} * a * x + b) * x + c; }
};

/// A number inside of an interval, which may be unbounded.
Fraction inner_point(const std::optional<Fraction>& low, const std::optional<Fraction>& high) {
  if (low && high) return Fraction{1, 2} * (*low + *high);
  if (low) return *low + Fraction{1};
  return high ? *high - Fraction{1} : Fraction{};
}

bool is_inside(const Fraction& x, const std::optional<Fraction>& low, const std::optional<Fraction>& high) {
  return (!low || *low < x) && (!high || x < *high);
}

/// Where the difference of two pieces changes its sign inside of an interval, increasing. Throws InvalidInput
/// when that is no fraction.
std::vector<Fraction> crossings(const Parabola& d, const std::optional<Fraction>& low,
                                const std::optional<Fraction>& high) {
  std::vector<Fraction> found;
  if (sign(d.a) == 0) {
    if (sign(d.b) != 0) found.push_back(-(d.c / d.b));
  } else {
    const Fraction square = d.b * d.b - Fraction{2} * d.a * d.c, vertex = -(d.b / d.a);
    if (sign(square) <= 0) return {};
    if (const auto root = exact_root(square)) {
      const Fraction away = *root / (sign(d.a) > 0 ? d.a : -d.a);
      found = {vertex - away, vertex + away};
    } else {
      // Outside of its roots d has the sign of a.
      const auto beyond = [&](const std::optional<Fraction>& end) { return sign(d.at(*end)) == sign(d.a); };
      const bool lower =
          (!low || (*low < vertex && beyond(low))) && (!high || vertex < *high || !beyond(high));
      const bool upper =
          (!high || (vertex < *high && beyond(high))) && (!low || *low < vertex || !beyond(low));
      if (lower || upper)
        throw InvalidInput(
            "pointwise_max: two pieces cross at a root that is no fraction; without --symbolic it is "
            "computed in "
            "numbers");
      return {};
    }
  }
  std::erase_if(found, [&](const Fraction& x) { return !is_inside(x, low, high); });
  return found;
}

}  // namespace

ExactCurve pointwise_max(const ExactCurve& f, const ExactCurve& g) {
  std::vector<ExactPiece> highest;
  const std::vector<ExactPiece> of_f = pieces(f), of_g = pieces(g);
  const auto& first_low = of_f.front().low;
  const auto& second_low = of_g.front().low;
  std::optional<Fraction> left = first_low, right = of_f.back().high;
  if (second_low && (!left || *left < *second_low)) left = second_low;
  if (const auto& end = of_g.back().high; end && (!right || *end < *right)) right = end;
  const bool domain_is_point = left && right && *left == *right;
  for (const ExactPiece& p : of_f)
    for (const ExactPiece& q : of_g) {
      std::optional<Fraction> low = p.low, high = p.high;
      if (q.low && (!low || *low < *q.low)) low = q.low;
      if (q.high && (!high || *q.high < *high)) high = q.high;
      if (low && high && *high < *low) continue;
      const bool is_point = low && high && *low == *high;
      if (is_point && !domain_is_point) continue;  // pieces that touch at their ends
      if (is_point && !highest.empty()) continue;
      const Parabola d{p.c2 - q.c2, p.c1 - q.c1, p.c0 - q.c0};
      std::vector<std::optional<Fraction>> ends{low};
      if (!is_point)
        for (const Fraction& x : crossings(d, low, high)) ends.emplace_back(x);
      ends.push_back(high);
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const bool first = sign(d.at(inner_point(ends[k], ends[k + 1]))) >= 0;
        highest.push_back(first ? p : q);
        highest.back().low = ends[k];
        highest.back().high = ends[k + 1];
      }
    }
  if (highest.empty())
    throw InvalidInput("pointwise_max: the domains do not meet; the maximum is +inf everywhere");
  return exact_curve(highest);
}

}  // namespace convex::symbolic
