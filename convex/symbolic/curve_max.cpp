#include <algorithm>

#include "convex/invalid_input.hpp"
#include "convex/symbolic/exact_curve.hpp"

namespace convex::symbolic {
namespace {

/// a/2 x² + b x + c.
struct Parabola {
  Surd a, b, c;
  Surd at(const Surd& x) const { return (Surd{Fraction{1, 2}} * a * x + b) * x + c; }
};

/// A number inside of an interval, which may be unbounded.
Surd inner_point(const std::optional<Surd>& low, const std::optional<Surd>& high) {
  if (low && high) return Surd{Fraction{1, 2}} * (*low + *high);
  if (low) return *low + Surd{Fraction{1}};
  return high ? *high - Surd{Fraction{1}} : Surd{};
}

/// The sign of d inside of an interval where it does not change: it may be 0 at one point, where two
/// parabolas touch, and then another one tells.
int sign_inside(const Parabola& d, const std::optional<Surd>& low, const std::optional<Surd>& high) {
  const Surd middle = inner_point(low, high);
  if (const int found = sign(d.at(middle)); found != 0) return found;
  return sign(d.at(inner_point(low, middle)));
}

bool is_inside(const Surd& x, const std::optional<Surd>& low, const std::optional<Surd>& high) {
  return (!low || *low < x) && (!high || x < *high);
}

/// Where the difference of two pieces changes its sign inside of an interval, increasing. Throws InvalidInput
/// when that is a root of what is no fraction.
std::vector<Surd> crossings(const Parabola& d, const std::optional<Surd>& low,
                            const std::optional<Surd>& high) {
  std::vector<Surd> found;
  if (sign(d.a) == 0) {
    if (sign(d.b) != 0) found.push_back(-(d.c / d.b));
  } else {
    const Surd square = d.b * d.b - Surd{Fraction{2, 1}} * d.a * d.c, vertex = -(d.b / d.a);
    if (sign(square) <= 0) return {};
    if (!square.is_rational()) {
      // Outside of its roots d has the sign of a.
      const auto beyond = [&](const std::optional<Surd>& end) { return sign(d.at(*end)) == sign(d.a); };
      const bool lower =
          (!low || (*low < vertex && beyond(low))) && (!high || vertex < *high || !beyond(high));
      const bool upper =
          (!high || (vertex < *high && beyond(high))) && (!low || *low < vertex || !beyond(low));
      if (lower || upper)
        throw InvalidInput(
            "pointwise_max: two pieces cross at a root under which another root stands; without --symbolic "
            "it is computed in numbers");
      return {};
    }
    const Surd away = Surd::root_of(square.rational_part()) / (sign(d.a) > 0 ? d.a : -d.a);
    found = {vertex - away, vertex + away};
  }
  std::erase_if(found, [&](const Surd& x) { return !is_inside(x, low, high); });
  return found;
}

}  // namespace

ExactCurve pointwise_max(const ExactCurve& f, const ExactCurve& g) {
  std::vector<ExactPiece> highest;
  const std::vector<ExactPiece> of_f = pieces(f), of_g = pieces(g);
  const auto& first_low = of_f.front().low;
  const auto& second_low = of_g.front().low;
  std::optional<Surd> left = first_low, right = of_f.back().high;
  if (second_low && (!left || *left < *second_low)) left = second_low;
  if (const auto& end = of_g.back().high; end && (!right || *end < *right)) right = end;
  const bool domain_is_point = left && right && *left == *right;
  for (const ExactPiece& p : of_f)
    for (const ExactPiece& q : of_g) {
      std::optional<Surd> low = p.low, high = p.high;
      if (q.low && (!low || *low < *q.low)) low = q.low;
      if (q.high && (!high || *q.high < *high)) high = q.high;
      if (low && high && *high < *low) continue;
      const bool is_point = low && high && *low == *high;
      if (is_point && !domain_is_point) continue;  // pieces that touch at their ends
      if (is_point && !highest.empty()) continue;
      const Parabola d{p.c2 - q.c2, p.c1 - q.c1, p.c0 - q.c0};
      std::vector<std::optional<Surd>> ends{low};
      if (!is_point)
        for (const Surd& x : crossings(d, low, high)) ends.emplace_back(x);
      ends.push_back(high);
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const bool first = sign_inside(d, ends[k], ends[k + 1]) >= 0;
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
