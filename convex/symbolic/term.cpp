#include "convex/symbolic/term.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/invariant.hpp"

namespace convex::symbolic {
namespace {

using Kind = Term::Kind;

Term made(Kind kind, std::vector<Term> parts) { return {kind, {0, 1}, {}, std::move(parts), {}}; }

/// The parts of a sum or product, or the term as its only one.
std::vector<Term> parts_of(const Term& term, Kind kind) {
  return term.kind == kind ? term.parts : std::vector<Term>{term};
}

/// Its number factor and the rest.
std::pair<Fraction, Term> split_factor(const Term& term) {
  if (term.kind != Kind::product || term.parts.front().kind != Kind::number) return {{1, 1}, term};
  std::vector<Term> rest(term.parts.begin() + 1, term.parts.end());
  return {term.parts.front().number, rest.size() == 1 ? rest.front() : made(Kind::product, std::move(rest))};
}

/// W e^W = x for x >= 0 (Corless et al. 1996), by Newton's method on w + log w = log x where x is large.
double lambert(double x) {
  if (x == 0) return 0;
  if (std::isinf(x)) return x;
  double w = x < 1 ? x / (1 + x) : std::log(x) - (x > std::exp(1.0) ? std::log(std::log(x)) : 0);
  constexpr int most = 60;
  for (int k = 0; k < most; ++k) {
    const double step = w * (w + std::log(w) - std::log(x)) / (w + 1);
    const double next = w - step > 0 ? w - step : w / 2;
    if (std::abs(next - w) <= std::numeric_limits<double>::epsilon() * next) return next;
    w = next;
  }
  return w;
}

double value_of_function(const std::string& name, double x) {
  if (name == "exp") return std::exp(x);
  if (name == "log") return std::log(x);
  if (name == "sqrt") return std::sqrt(x);
  if (name == "abs") return std::abs(x);
  if (name == "sign") return x > 0 ? 1 : (x < 0 ? -1 : 0);
  invariant(name == "W", "a term has a known function");
  return lambert(x);
}

double root_value(const Term& term, double target) {
  const auto left = [&](double u) { return evaluate(term.parts[0], "u", u) - target; };
  double low = term.lowest ? nearest_double(*term.lowest) : -1, high = term.lowest ? low + 1 : 1;
  constexpr int most = 2200;  // halvings, through all exponents
  for (int k = 0; k < most && !term.lowest && left(low) > 0; ++k) low *= 2;
  for (int k = 0; k < most && left(high) < 0; ++k) high = high > 0 ? 2 * high : high / 2 + 1;
  for (int k = 0; k < most; ++k) {
    const double middle = (low + high) / 2;
    if (middle == low || middle == high) break;
    (left(middle) < 0 ? low : high) = middle;
  }
  return high;
}

}  // namespace

Term number(const Fraction& value) { return {Kind::number, lowest_terms(value), {}, {}, {}}; }
Term number(int value) { return number(Fraction{value, 1}); }
Term number(const Surd& value) {
  if (value.is_rational()) return number(value.rational_part());
  // (p + r sqrt(c))/d.
  const Fraction a = lowest_terms(value.rational_part()), b = lowest_terms(value.root_part());
  const Integer d = a.denominator * lowest_terms(Fraction{a.denominator, b.denominator}).denominator;
  const Term root = function("sqrt", number(Fraction{value.radicand()}));
  if (sign(a) == 0) return number(b) * root;
  Term top = made(Kind::sum, {number(a * Fraction{d}), number(b * Fraction{d}) * root});
  if (d == 1) return top;
  return made(Kind::product, {number(Fraction{1, d}), std::move(top)});
}
Term variable(const std::string& name) { return {Kind::variable, {0, 1}, name, {}, {}}; }
bool is_number(const Term& term, const Fraction& value) {
  return term.kind == Kind::number && term.number == value;
}

Term operator+(const Term& a, const Term& b) {
  Fraction constant{0, 1};
  std::vector<std::pair<Fraction, Term>> kept;  // like terms once
  for (const Term* side : {&a, &b})
    for (const Term& part : parts_of(*side, Kind::sum)) {
      if (part.kind == Kind::number) {
        constant = constant + part.number;
        continue;
      }
      const auto [factor, rest] = split_factor(part);
      const std::string shape = text(rest);
      const auto like = std::find_if(kept.begin(), kept.end(),
                                     [&shape](const auto& other) { return text(other.second) == shape; });
      if (like == kept.end())
        kept.emplace_back(factor, rest);
      else
        like->first = like->first + factor;
    }
  std::vector<Term> parts;
  for (const auto& [factor, rest] : kept)
    if (sign(factor) != 0) parts.push_back(factor * rest);
  if (sign(constant) != 0 || parts.empty()) parts.push_back(number(constant));
  return parts.size() == 1 ? parts.front() : made(Kind::sum, std::move(parts));
}

Term operator-(const Term& a, const Term& b) { return a + Fraction{-1, 1} * b; }

Term operator*(const Fraction& factor, const Term& b) { return number(factor) * b; }
Term operator*(const Surd& factor, const Term& b) { return number(factor) * b; }

namespace {

/// u and u^-1 among the factors are 1 together.
void cancel(std::vector<Term>& factors) {
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (factors[i].kind != Kind::power || !(factors[i].parts[1].number == Fraction{-1, 1})) continue;
    const std::string base = text(factors[i].parts[0]);
    const auto same =
        std::find_if(factors.begin(), factors.end(), [&](const Term& other) { return text(other) == base; });
    if (same == factors.end()) continue;
    factors.erase(factors.begin() + static_cast<std::ptrdiff_t>(i));
    factors.erase(
        std::find_if(factors.begin(), factors.end(), [&](const Term& other) { return text(other) == base; }));
    cancel(factors);
    return;
  }
}

}  // namespace

Term operator*(const Term& a, const Term& b) {
  Fraction factor{1, 1};
  std::vector<Term> kept;
  for (const Term* side : {&a, &b})
    for (const Term& part : parts_of(*side, Kind::product)) {
      if (part.kind == Kind::number)
        factor = factor * part.number;
      else
        kept.push_back(part);
    }
  cancel(kept);
  if (sign(factor) == 0 || kept.empty()) return number(factor);
  if (kept.size() == 1 && kept.front().kind == Kind::sum && !(factor == Fraction{1, 1})) {
    Term sum = number(0);
    for (const Term& part : kept.front().parts) sum = sum + number(factor) * part;
    return sum;
  }
  if (!(factor == Fraction{1, 1})) kept.insert(kept.begin(), number(factor));
  return kept.size() == 1 ? kept.front() : made(Kind::product, std::move(kept));
}

namespace {

/// Of a small whole exponent; none for a negative one of 0.
std::optional<Fraction> whole_power(const Fraction& base, const Fraction& exponent) {
  constexpr double largest = 16;
  const double times = nearest_double(exponent);
  if (std::abs(times) > largest || (times < 0 && sign(base) == 0)) return std::nullopt;
  Fraction product{1, 1};
  for (int k = 0; k < std::abs(times); ++k) product = product * base;
  return times < 0 ? Fraction{1, 1} / product : product;
}

/// A function of a number that is a fraction.
std::optional<Fraction> known_value(const std::string& name, const Fraction& x) {
  if (name == "abs") return sign(x) < 0 ? -x : x;
  if (name == "sign") return Fraction{sign(x), 1};
  if (name == "sqrt" && sign(x) >= 0)
    if (const Surd root = Surd::root_of(x); root.is_rational()) return root.rational_part();
  if (name == "W" && sign(x) == 0) return x;
  return std::nullopt;
}

}  // namespace

Term power(const Term& base, const Fraction& exponent) {
  if (exponent == Fraction{1, 1}) return base;
  if (is_number(base, {1, 1})) return base;
  if (base.kind == Kind::number && exponent.denominator == 1)
    if (const auto value = whole_power(base.number, exponent)) return number(*value);
  return made(Kind::power, {base, number(exponent)});
}

Term function(const std::string& name, const Term& argument) {
  if (name == "log" && is_number(argument, {1, 1})) return number(0);
  if (name == "exp" && is_number(argument, {0, 1})) return number(1);
  if (argument.kind == Kind::number)
    if (const auto value = known_value(name, argument.number)) return number(*value);
  return {Kind::function, {0, 1}, name, {argument}, {}};
}

Term root(const Term& increasing, const Term& target, std::optional<Fraction> lowest) {
  return {Kind::root, {0, 1}, {}, {increasing, target}, std::move(lowest)};
}

Term substituted(const Term& term, const std::string& name, const Term& by) {
  switch (term.kind) {
    case Kind::number:
      return term;
    case Kind::variable:
      return term.name == name ? by : term;
    case Kind::sum: {
      Term sum = number(0);
      for (const Term& part : term.parts) sum = sum + substituted(part, name, by);
      return sum;
    }
    case Kind::product: {
      Term product = number(1);
      for (const Term& part : term.parts) product = product * substituted(part, name, by);
      return product;
    }
    case Kind::power:
      return power(substituted(term.parts[0], name, by), term.parts[1].number);
    case Kind::function:
      return function(term.name, substituted(term.parts[0], name, by));
    case Kind::root:
      return root(term.parts[0], substituted(term.parts[1], name, by), term.lowest);
  }
  return term;
}

double evaluate(const Term& term, const std::string& name, double at) {
  switch (term.kind) {
    case Kind::number:
      return nearest_double(term.number);
    case Kind::variable:
      invariant(term.name == name, "a term has the variable that it is evaluated in");
      return at;
    case Kind::sum: {
      double sum = 0;
      for (const Term& part : term.parts) sum += evaluate(part, name, at);
      return sum;
    }
    case Kind::product: {
      double product = 1;
      for (const Term& part : term.parts) product *= evaluate(part, name, at);
      return product;
    }
    case Kind::power:
      return std::pow(evaluate(term.parts[0], name, at), nearest_double(term.parts[1].number));
    case Kind::function:
      return value_of_function(term.name, evaluate(term.parts[0], name, at));
    case Kind::root:
      return root_value(term, evaluate(term.parts[1], name, at));
  }
  return 0;
}

double evaluate(const Cases& cases, const std::string& name, double at) {
  for (const Case& one : cases) {
    if (one.low) {
      const double low = nearest_double(*one.low);
      if (at < low || (at == low && !one.has_low)) continue;
    }
    if (one.high) {
      const double high = nearest_double(*one.high);
      if (at > high || (at == high && !one.has_high)) continue;
    }
    return evaluate(one.term, name, at);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace convex::symbolic
