#include "mechanics/expression/zero_bound.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace mechanics::expression {
namespace {

using convex::Fraction;
using convex::Integer;

/// Fields beyond this ask for more digits than anybody waits for.
constexpr double most_degree = 4096;
constexpr std::int64_t most_order = 10000, most_times = 16;

/// φ(n), the degree of the field of the n-th roots of unity.
double totient(std::int64_t n) {
  std::int64_t found = n;
  for (std::int64_t p = 2; p * p <= n; ++p) {
    if (n % p != 0) continue;
    while (n % p == 0) n /= p;
    found -= found / p;
  }
  if (n > 1) found -= found / n;
  return static_cast<double>(found);
}

std::optional<AlgebraicNumber> usable(AlgebraicNumber x) {
  if (x.order > most_order || !(x.degree() <= most_degree)) return std::nullopt;
  return x;
}

KnownAlgebraic known(std::optional<AlgebraicNumber> number, std::optional<AlgebraicAngle> angle = {}) {
  if (!number && !angle) return nullptr;
  return std::make_shared<const Algebraic>(Algebraic{std::move(number), std::move(angle)});
}

AlgebraicNumber whole(std::int64_t n) {
  return {std::log2(static_cast<double>(std::max<std::int64_t>(1, std::abs(n)))) + 0x1p-20, 0, {}, 1};
}

/// The field that both lie in.
AlgebraicNumber in_common_field(const AlgebraicNumber& a, const AlgebraicNumber& b) {
  AlgebraicNumber c = a;
  c.radicals.insert(b.radicals.begin(), b.radicals.end());
  c.order = std::lcm(a.order, b.order);
  return c;
}

AlgebraicNumber sum(const AlgebraicNumber& a, const AlgebraicNumber& b) {
  AlgebraicNumber c = in_common_field(a, b);
  c.u = std::max(a.u + b.l, b.u + a.l) + 1;
  c.l = a.l + b.l;
  return c;
}

AlgebraicNumber product(const AlgebraicNumber& a, const AlgebraicNumber& b) {
  AlgebraicNumber c = in_common_field(a, b);
  c.u = a.u + b.u;
  c.l = a.l + b.l;
  return c;
}

AlgebraicNumber inverse(AlgebraicNumber a) {
  std::swap(a.u, a.l);
  return a;
}

/// sqrt(U/L) = sqrt(U L)/L = U/sqrt(U L). A root without a name is one of its own.
AlgebraicNumber root(AlgebraicNumber a, const std::string& name) {
  static std::atomic<long> unnamed{0};
  a.radicals.insert(name.empty() ? "#" + std::to_string(++unnamed) : name);
  const double mean = (a.u + a.l) / 2;
  (a.u < a.l ? a.l : a.u) = mean;
  return a;
}

std::string around(const char* before, const std::string& name, const char* after) {
  return name.empty() ? name : before + name + after;
}

/// The cosine and the sine of the same angle.
struct Unit {
  AlgebraicNumber cosine, sine;
};

Unit turned(const Unit& a, const Unit& b) {
  return {sum(product(a.cosine, b.cosine), product(a.sine, b.sine)),
          sum(product(a.sine, b.cosine), product(a.cosine, b.sine))};
}

/// 2 cos(pi p/q) and 2 sin(pi p/q) are sums of two roots of unity, of order 2q, and with i of order lcm(2q,
/// 4).
std::optional<Unit> unit_of(const AlgebraicAngle& angle) {
  Unit found{whole(1), whole(1)};
  const Fraction turns = convex::lowest_terms(angle.turns);
  if (convex::sign(turns) != 0) {
    if (!turns.denominator.fits_word() || turns.denominator.word() > most_order) return std::nullopt;
    const std::int64_t order = 2 * turns.denominator.word();
    found = {{1, 1, {}, order}, {1, 1, {}, std::lcm<std::int64_t>(order, 4)}};
  }
  for (const AlgebraicAngle::Part& part : angle.parts) {
    if (std::abs(part.times) > most_times) return std::nullopt;
    for (std::int64_t k = 0; k < std::abs(part.times); ++k) found = turned(found, {part.cosine, part.sine});
  }
  if (!usable(found.cosine) || !usable(found.sine)) return std::nullopt;
  return found;
}

std::optional<AlgebraicAngle> scaled(const AlgebraicAngle& angle, const Fraction& factor) {
  AlgebraicAngle found{angle.turns * factor, angle.parts};
  for (AlgebraicAngle::Part& part : found.parts) {
    const Fraction times = convex::lowest_terms(Fraction{part.times, 1} * factor);
    if (!(times.denominator == 1) || !times.numerator.fits_word()) return std::nullopt;
    part.times = times.numerator.word();
  }
  return found;
}

AlgebraicAngle sum(const AlgebraicAngle& a, const AlgebraicAngle& b) {
  AlgebraicAngle c = a;
  c.turns = c.turns + b.turns;
  c.parts.insert(c.parts.end(), b.parts.begin(), b.parts.end());
  return c;
}

KnownAlgebraic angle_of(const AlgebraicNumber& cosine, const AlgebraicNumber& sine) {
  if (!usable(cosine) || !usable(sine)) return nullptr;
  return known(std::nullopt, AlgebraicAngle{{}, {{cosine, sine, 1}}});
}

}  // namespace

double AlgebraicNumber::degree() const {
  return std::ldexp(totient(order), static_cast<int>(std::min<std::size_t>(radicals.size(), 100)));
}

KnownAlgebraic algebraic_fraction(const Fraction& x) {
  const Fraction lowest = convex::lowest_terms(x);
  AlgebraicNumber number{
      static_cast<double>(lowest.numerator.bits()), static_cast<double>(lowest.denominator.bits()), {}, 1};
  return convex::sign(x) == 0 ? known(number, AlgebraicAngle{}) : known(number);
}

KnownAlgebraic algebraic_pi() { return known(std::nullopt, AlgebraicAngle{{1, 1}, {}}); }

KnownAlgebraic algebraic_negative(const KnownAlgebraic& a) {
  if (!a) return a;
  return known(a->number, a->angle ? scaled(*a->angle, {-1, 1}) : std::nullopt);
}

KnownAlgebraic algebraic_sum(const KnownAlgebraic& a, const KnownAlgebraic& b) {
  if (!a || !b) return nullptr;
  std::optional<AlgebraicNumber> number;
  std::optional<AlgebraicAngle> angle;
  if (a->number && b->number) number = usable(sum(*a->number, *b->number));
  if (a->angle && b->angle) angle = sum(*a->angle, *b->angle);
  return known(std::move(number), std::move(angle));
}

KnownAlgebraic algebraic_product(const KnownAlgebraic& a, const KnownAlgebraic& b, const Fraction* left,
                                 const Fraction* right) {
  if (!a || !b) return nullptr;
  if (a->number && b->number) return known(usable(product(*a->number, *b->number)));
  if (a->angle && right != nullptr) return known(std::nullopt, scaled(*a->angle, *right));
  if (b->angle && left != nullptr) return known(std::nullopt, scaled(*b->angle, *left));
  return nullptr;
}

KnownAlgebraic algebraic_quotient(const KnownAlgebraic& a, const KnownAlgebraic& b, const Fraction* right) {
  if (!a || !b) return nullptr;
  if (a->number && b->number) return known(usable(product(*a->number, inverse(*b->number))));
  if (a->angle && right != nullptr) return known(std::nullopt, scaled(*a->angle, Fraction{1, 1} / *right));
  return nullptr;
}

KnownAlgebraic algebraic_function(const std::string& name, const KnownAlgebraic& a, const KnownAlgebraic& b,
                                  const std::string& radical) {
  if (!a) return nullptr;
  if (a->angle && (name == "sin" || name == "cos" || name == "tan")) {
    const auto unit = unit_of(*a->angle);
    if (!unit) return nullptr;
    if (name == "tan") return known(usable(product(unit->sine, inverse(unit->cosine))));
    return known(name == "sin" ? unit->sine : unit->cosine);
  }
  if (!a->number) return nullptr;
  const AlgebraicNumber& x = *a->number;
  if (name == "sqrt") return known(usable(root(x, radical)));
  if (name == "asin" || name == "acos") {
    const AlgebraicNumber other = root(sum(whole(1), product(x, x)), around("1-(", radical, ")^2"));
    return name == "asin" ? angle_of(other, x) : angle_of(x, other);
  }
  if (name == "atan") {
    const AlgebraicNumber length = root(sum(whole(1), product(x, x)), around("1+(", radical, ")^2"));
    return angle_of(inverse(length), product(x, inverse(length)));
  }
  if (name == "atan2" && b && b->number) {
    const AlgebraicNumber& y = *b->number;
    const AlgebraicNumber length = root(sum(product(x, x), product(y, y)), "");
    return angle_of(product(y, inverse(length)), product(x, inverse(length)));
  }
  return nullptr;
}

}  // namespace mechanics::expression
