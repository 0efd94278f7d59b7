#include "convex/sets/known_value.hpp"

#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/exact_minimum.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/invalid_input.hpp"
#include "convex/proved_prox/ball_numbers.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline sets::subgradients {
namespace {

using symbolic::Surd;

const Fraction value_zero{0, 1}, value_one{1, 1};
const KnownValue infinite_value{true, {}, {}};

/// What holds a + b sqrt(c).
std::optional<FractionInterval> around(const Surd& value) {
  if (value.is_rational()) return only(value.rational_part());
  if (!Ball::why_none().empty()) return std::nullopt;
  return interval(ball(value.rational_part()) +
                  ball(value.root_part()) * sqrt(ball(Fraction{value.radicand(), 1})));
}

KnownValue exactly(const Surd& value) { return {false, value, around(value)}; }

/// The sum of finite ones; roots of two kinds are held between fractions alone.
KnownValue added(const KnownValue& a, const KnownValue& b) {
  if (a.is_infinite || b.is_infinite) return infinite_value;
  KnownValue sum;
  if (a.between && b.between) sum.between = *a.between + *b.between;
  if (a.exact && b.exact) try {
      sum.exact = *a.exact + *b.exact;
    } catch (const InvalidInput&) {
    }
  return sum;
}

/// factor > 0.
KnownValue multiplied(const Fraction& factor, KnownValue a) {
  if (a.exact) a.exact = Surd{factor} * *a.exact;
  if (a.between) a.between = times(factor, *a.between);
  return a;
}

Fraction dot_of(const Fractions& x, const Fractions& y) {
  Fraction sum = value_zero;
  for (std::size_t i = 0; i < x.size(); ++i) sum = sum + x[i] * y[i];
  return sum;
}

/// x^k for a small whole number k; x is not 0 where k is negative.
std::optional<Fraction> whole_power(const Fraction& x, const Fraction& k) {
  constexpr double most = 64;
  const double times_itself = nearest_double(k);
  if (!(k.denominator == 1) || std::abs(times_itself) > most) return std::nullopt;
  Fraction product = value_one;
  for (int i = 0; i < std::abs(times_itself); ++i) product = product * x;
  return times_itself < 0 ? value_one / product : product;
}

/// Of one entry, where the value is a fraction for a reason that the formula shows.
std::optional<Fraction> entry_value(const Call& f, const ExactArguments& a, const Fraction& x,
                                    std::size_t i) {
  const bool is_zero = sign(x) == 0;
  if (f.name == "exponential" && is_zero) return value_one;
  if (f.name == "entropy" && (is_zero || x == value_one)) return value_zero;
  if (f.name == "log_barrier" && x == value_one) return a.number("offset");
  if (f.name == "kullback_leibler" && x == a.vector("reference")[i]) return value_zero;
  if (f.name == "power") return whole_power(sign(x) < 0 ? -x : x, lowest_terms(a.number("p")));
  if (f.name == "inverse_power" && sign(x) > 0) return whole_power(x, lowest_terms(-a.number("q")));
  return std::nullopt;
}

std::optional<Surd> own_formula(const Call& f, const Fractions& x) {
  const ExactArguments a(f, x.size());
  if (f.name == "norm2") return Surd{a.number("weight")} * Surd::root_of(dot_of(x, x));
  constexpr const char* of_entries[] = {"exponential",      "entropy", "log_barrier",
                                        "kullback_leibler", "power",   "inverse_power"};
  for (const char* const name : of_entries) {
    if (f.name != name) continue;
    Fraction sum = value_zero;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto entry = entry_value(f, a, x[i], i);
      if (!entry) return std::nullopt;
      sum = sum + *entry;
    }
    return Surd{sum};
  }
  return std::nullopt;
}

/// Balls where the function has formulas in them, else doubles with the error that they tell.
KnownValue held(const Call& f, const ExactGram& W, const Fractions& x) {
  const Vector doubles = nearest(x);
  const Value found = make_function(f, {rounded(W)}).evaluate(doubles);
  if (found.value == INFINITY && found.error == 0) return infinite_value;
  if (Ball::why_none().empty())
    if (const PairSearch at = pair_at_point(f, W, x); at.pair) return {false, {}, at.pair->f_x};
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!(fraction(doubles[static_cast<Index>(i)]) == x[i])) return {};
  if (!std::isfinite(found.value) || !std::isfinite(found.error)) return {};
  const Fraction error = fraction(found.error), value = fraction(found.value);
  if (found.error == 0) return exactly(Surd{value});
  return {false, {}, FractionInterval{value - error, value + error}};
}

std::optional<KnownValue> of_operation(const Call& f, const ExactGram& W, const Fractions& x) {
  const ExactArguments a(f, x.size());
  const std::string& name = f.name;
  if (name == "sum") {
    KnownValue sum = exactly(Surd{});
    for (const Call* part : a.calls()) sum = added(sum, known_value(*part, W, x));
    return sum;
  }
  if (name == "scale") return multiplied(a.number("alpha"), known_value(a.call("f"), W, x));
  if (name == "tilt") return added(known_value(a.call("f"), W, x), exactly(Surd{dot_of(a.vector("c"), x)}));
  if (name == "translate") return known_value(a.call("f"), W, difference(x, a.vector("by")));
  if (name == "dilate") {
    Fractions smaller = x;
    for (Fraction& entry : smaller) entry = entry / a.number("rho");
    return known_value(a.call("f"), W, smaller);
  }
  if (name == "precompose") {
    const std::vector<ExactRow> A = a.rows("A");
    Fractions at = a.is_vector("b") ? a.vector("b") : Fractions(A.size(), a.number("b"));
    for (std::size_t i = 0; i < A.size(); ++i) at[i] = at[i] + dot(A[i], x);
    return known_value(a.call("f"), identity_gram(A.size()), at);
  }
  if (name == "indicator") return known_value(a.call("set"), W, x);
  if (name == "distance" || name == "squared_distance") {
    const KnownValue in_set = known_value(a.call("set"), W, x);
    return in_set.exact ? std::optional(exactly(Surd{})) : std::nullopt;
  }
  if (name == "pointwise_max") {
    std::optional<KnownValue> largest;
    for (const Call* part : a.calls()) {
      KnownValue value = known_value(*part, W, x);
      if (value.is_infinite) return infinite_value;
      const auto above = largest ? order(value, *largest) : std::optional(1);
      if (!above) return std::nullopt;
      if (*above > 0) largest = std::move(value);
    }
    return largest;
  }
  return std::nullopt;
}

}  // namespace

KnownValue known_value(const Call& f, const ExactGram& W, const Fractions& x) {
  if (const auto program = exact_program(f, W)) {
    const ExactValue found = exact_value(*program, x);
    return found.end == ProgramEnd::minimum ? exactly(Surd{found.value}) : infinite_value;
  }
  if (const auto own = own_formula(f, x)) return exactly(*own);
  if (const auto made = of_operation(f, W, x); made && (made->is_infinite || made->exact || made->between))
    return *made;
  return held(f, W, x);
}

std::optional<int> order(const KnownValue& a, const KnownValue& b) {
  if (a.exact && b.exact) try {
      return sign(*a.exact - *b.exact);
    } catch (const InvalidInput&) {  // roots of two kinds: they differ, and balls tell in which order
    }
  if (!a.between || !b.between) return std::nullopt;
  if (a.between->high < b.between->low) return -1;
  if (b.between->high < a.between->low) return 1;
  return std::nullopt;
}

}  // namespace convex::inline sets::subgradients
