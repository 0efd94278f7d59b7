#include "convex/symbolic/surd.hpp"

#include <cmath>

#include "convex/invalid_input.hpp"

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

/// The root of a whole number where it is one.
std::optional<Integer> whole_root(const Integer& n) {
  const Integer root = integer_root(n);
  if (!(root * root - n).is_zero()) return std::nullopt;
  return root;
}

/// Squares of whole numbers up to this are taken out of roots.
constexpr std::int64_t most_tried = 1000;

/// The multiple of sqrt(c) that sqrt(d) is; none where it is none.
std::optional<Fraction> in_units_of(const Integer& c, const Integer& d) {
  if (c == d) return Fraction{1, 1};
  if (const auto root = whole_root(c * d)) return lowest_terms({*root, c});
  return std::nullopt;
}

/// sign(b) sqrt(b² c) as a fraction of its square, for comparisons.
Fraction square_of(const Fraction& a) { return a * a; }

/// "(p + r*sqrt(c))/d".
std::string shown(const Surd& x, bool latex) {
  const Fraction a = lowest_terms(x.rational_part()), b = lowest_terms(x.root_part());
  const Fraction over = lowest_terms(Fraction{a.denominator, b.denominator});
  const Integer d = a.denominator * over.denominator;  // the least common multiple
  const Integer p = truncated_quotient(a.numerator * d, a.denominator),
                r = truncated_quotient(b.numerator * d, b.denominator);
  const bool minus = r.sign() < 0;
  const Integer size = minus ? -r : r;
  std::string root = (latex ? "\\sqrt{" : "sqrt(") + x.radicand().text() + (latex ? "}" : ")");
  if (!(size == 1)) root = size.text() + (latex ? " " : "*") + root;
  const bool one_term = p.is_zero();
  std::string top = one_term ? (minus ? "-" : "") + root : p.text() + (minus ? " - " : " + ") + root;
  if (d == 1) return top;
  if (latex) return "\\frac{" + top + "}{" + d.text() + "}";
  return (one_term ? top : "(" + top + ")") + "/" + d.text();
}

}  // namespace

Surd::Surd(Fraction a, Fraction b, Integer c) : a_(std::move(a)), b_(std::move(b)), c_(std::move(c)) {
  if (convex::sign(b_) == 0) c_ = 0;
}

Surd Surd::root_of(const Fraction& a) {
  // sqrt(p/q) = sqrt(pq)/q.
  const Fraction lowest = lowest_terms(a);
  Integer under = lowest.numerator * lowest.denominator, outside = 1;
  if (const auto root = whole_root(under)) return Surd{lowest_terms({*root, lowest.denominator})};
  for (std::int64_t k = 2; k <= most_tried; ++k) {
    const Integer square = Integer{k} * Integer{k};
    for (;;) {
      const Integer quotient = truncated_quotient(under, square);
      if (!(quotient * square - under).is_zero()) break;
      under = quotient;
      outside = outside * Integer{k};
    }
  }
  return {Fraction{0, 1}, lowest_terms({outside, lowest.denominator}), under};
}

namespace {

/// The parts of x and y beside the same root.
struct Common {
  Fraction a, b, c, d;
  Integer under;
};

Common common(const Surd& x, const Surd& y) {
  Common made{x.rational_part(), x.root_part(), y.rational_part(), y.root_part(), x.radicand()};
  if (x.is_rational())
    made.under = y.radicand();
  else if (!y.is_rational()) {
    const auto multiple = in_units_of(x.radicand(), y.radicand());
    if (!multiple)
      throw InvalidInput("pieces meet at roots of two kinds, sqrt(" + x.radicand().text() + ") and sqrt(" +
                         y.radicand().text() +
                         "); symbols have one; without --symbolic it is computed in numbers");
    made.d = made.d * *multiple;
  }
  return made;
}

}  // namespace

Surd operator+(const Surd& x, const Surd& y) {
  const Common k = common(x, y);
  return {k.a + k.c, k.b + k.d, k.under};
}

Surd operator-(const Surd& x, const Surd& y) { return x + -y; }
Surd operator-(const Surd& x) { return {-x.a_, -x.b_, x.c_}; }

Surd operator*(const Surd& x, const Surd& y) {
  const Common k = common(x, y);
  return {k.a * k.c + k.b * k.d * Fraction{k.under}, k.a * k.d + k.b * k.c, k.under};
}

Surd operator/(const Surd& x, const Surd& y) {
  // 1/(c + d sqrt(u)) = (c - d sqrt(u))/(c² - d² u).
  const Fraction norm = square_of(y.a_) - square_of(y.b_) * Fraction{y.c_};
  return x * Surd(y.a_ / norm, -(y.b_ / norm), y.c_);
}

int sign(const Surd& x) {
  const int of_a = convex::sign(x.rational_part()), of_b = convex::sign(x.root_part());
  if (of_a == of_b || of_b == 0) return of_a;
  if (of_a == 0) return of_b;
  const int larger =
      convex::sign(square_of(x.rational_part()) - square_of(x.root_part()) * Fraction{x.radicand()});
  return larger > 0 ? of_a : of_b;
}

bool operator==(const Surd& x, const Surd& y) { return sign(x - y) == 0; }
bool operator<(const Surd& x, const Surd& y) { return sign(x - y) < 0; }

double nearest_double(const Surd& x) {
  if (x.is_rational()) return convex::nearest_double(x.rational_part());
  // The root to 120 bits beyond its whole part, so that cancellation leaves a double's digits.
  constexpr std::size_t bits = 240;
  const Integer scaled = integer_root(Integer::shifted(1, 2 * bits) * x.radicand());
  const Fraction root = lowest_terms({scaled, Integer::shifted(1, bits)});
  return convex::nearest_double(x.rational_part() + x.root_part() * root);
}

std::string text(const Surd& x) {
  return x.is_rational() ? convex::text(x.rational_part()) : shown(x, false);
}

std::string latex(const Surd& x) {
  if (!x.is_rational()) return shown(x, true);
  const Fraction a = lowest_terms(x.rational_part());
  if (a.denominator == 1) return convex::text(a);
  const bool minus = a.numerator.sign() < 0;
  const Integer top = minus ? -a.numerator : a.numerator;
  return std::string(minus ? "-" : "") + "\\frac{" + top.text() + "}{" + a.denominator.text() + "}";
}

Fraction rational(const Surd& x) {
  if (!x.is_rational())
    throw InvalidInput("a number is a root that is no fraction; rules take fractions alone");
  return x.rational_part();
}

std::optional<Fraction> rational(const std::optional<Surd>& x) {
  return x ? std::optional(rational(*x)) : std::nullopt;
}

}  // namespace convex::symbolic
