#include "convex/symbolic/function_of_call.hpp"

#include <cmath>
#include <map>

#include "convex/invalid_input.hpp"

namespace convex::symbolic {
namespace {

const Fraction nought{0, 1}, single{1, 1};

[[noreturn]] void no_rule(const Call& call, const std::string& why) {
  throw InvalidInput(call.name + ": " + why + "; without --symbolic it is computed in numbers", call.place);
}

/// Arguments by position or by name.
class CallReader {
 public:
  explicit CallReader(const Call& call) : call_(call) {}

  const Argument* find(std::size_t position, const std::string& key) const {
    for (std::size_t k = 0; k < call_.arguments.size(); ++k) {
      const NamedArgument& one = call_.arguments[k];
      if (one.key.empty() ? k == position : one.key == key) return &one.value;
    }
    return nullptr;
  }
  /// A number, or a vector or matrix of one entry; infinite: none.
  std::optional<Fraction> bound(std::size_t position, const std::string& key, double fallback) const {
    const Argument* found = find(position, key);
    double number = fallback;
    if (found != nullptr) {
      if (const auto* plain = std::get_if<double>(found))
        number = *plain;
      else if (const auto* vector = std::get_if<Vector>(found); vector != nullptr && vector->size() == 1)
        number = (*vector)[0];
      else if (const auto* matrix = std::get_if<Matrix>(found); matrix != nullptr && matrix->size() == 1)
        number = (*matrix)(0, 0);
      else
        no_rule(call_, key + " is not one number, and symbols have one variable");
    }
    if (std::isinf(number)) return std::nullopt;
    return simplest_fraction(number);
  }
  Fraction number(std::size_t position, const std::string& key, double fallback = std::nan("")) const {
    const auto found = bound(position, key, std::isnan(fallback) ? 0 : fallback);
    if (!found) no_rule(call_, key + " is not finite");
    if (std::isnan(fallback) && find(position, key) == nullptr) no_rule(call_, key + " is missing");
    return *found;
  }
  const Call& call(std::size_t position, const std::string& key) const {
    const Argument* found = find(position, key);
    const auto* inner = found != nullptr ? std::get_if<std::shared_ptr<const Call>>(found) : nullptr;
    if (inner == nullptr) no_rule(call_, key + " is no function");
    return **inner;
  }
  Function function(std::size_t position, const std::string& key) const {
    return function_of(call(position, key));
  }
  std::size_t count() const { return call_.arguments.size(); }
  const Call& itself() const { return call_; }

 private:
  const Call& call_;
};

ExactPiece piece(std::optional<Fraction> low, std::optional<Fraction> high, const Fraction& c2,
                 const Fraction& c1, const Fraction& c0) {
  return {std::move(low), std::move(high), c2, c1, c0};
}

ExactCurve quadratic(const Fraction& c2, const Fraction& c1, const Fraction& c0) {
  return exact_curve({piece(std::nullopt, std::nullopt, c2, c1, c0)});
}

/// l1 |x| + l2/2 x².
ExactCurve absolute(const Fraction& l1, const Fraction& l2) {
  return exact_curve(
      {piece(std::nullopt, nought, l2, -l1, nought), piece(nought, std::nullopt, l2, l1, nought)});
}

ExactCurve interval(std::optional<Fraction> low, std::optional<Fraction> high) {
  return exact_curve({piece(std::move(low), std::move(high), nought, nought, nought)});
}

ExactCurve huber(const Fraction& mu) {
  const Fraction shift = -(Fraction{1, 2} * mu);
  return exact_curve({piece(std::nullopt, -mu, nought, -single, shift),
                      piece(-mu, mu, single / mu, nought, nought),
                      piece(mu, std::nullopt, nought, single, shift)});
}

ExactCurve plq(const CallReader& in) {
  const Argument *breaks = in.find(0, "breaks"), *coefficients = in.find(1, "coefficients");
  const auto* b = breaks != nullptr ? std::get_if<Vector>(breaks) : nullptr;
  const auto* c = coefficients != nullptr ? std::get_if<Matrix>(coefficients) : nullptr;
  if (b == nullptr || c == nullptr || c->rows() != b->size() + 1 || c->cols() != 3)
    no_rule(in.itself(), "breaks and coefficients do not fit");
  std::vector<ExactPiece> made;
  for (Index k = 0; k < c->rows(); ++k) {
    if (std::isinf((*c)(k, 0))) continue;
    const auto end = [&](Index at) {
      return at >= 0 && at < b->size() ? std::optional(simplest_fraction((*b)[at])) : std::nullopt;
    };
    made.push_back(piece(end(k - 1), end(k), simplest_fraction((*c)(k, 0)), simplest_fraction((*c)(k, 1)),
                         simplest_fraction((*c)(k, 2))));
  }
  return exact_curve(made);
}

/// The interval of a set.
ExactCurve set_of(const Call& call) {
  const CallReader in(call);
  const double infinity = HUGE_VAL;
  if (call.name == "box") return interval(in.bound(0, "lower", -infinity), in.bound(1, "upper", infinity));
  if (call.name == "orthant") return interval(nought, std::nullopt);
  if (call.name == "point") return interval(in.number(0, "p"), in.number(0, "p"));
  if (call.name == "ball1" || call.name == "ball_inf" || call.name == "ball2") {
    const Fraction radius = in.number(0, "radius", 1),
                   centre = call.name == "ball2" ? in.number(1, "center", 0) : nought;
    return interval(centre - radius, centre + radius);
  }
  no_rule(call, "no set of one variable that is known in symbols");
}

using Maker = Function (*)(const CallReader&);

const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> all{
      {"zero", [](const CallReader&) -> Function { return quadratic(nought, nought, nought); }},
      {"constant",
       [](const CallReader& in) -> Function { return quadratic(nought, nought, in.number(0, "c")); }},
      {"linear",
       [](const CallReader& in) -> Function { return quadratic(nought, in.number(0, "c"), nought); }},
      {"quadratic",
       [](const CallReader& in) -> Function {
         return quadratic(in.number(0, "Q"), in.number(1, "c", 0), nought);
       }},
      {"squared_norm2",
       [](const CallReader& in) -> Function { return quadratic(in.number(0, "weight", 1), nought, nought); }},
      {"norm1", [](const CallReader& in) -> Function { return absolute(in.number(0, "weight", 1), nought); }},
      {"norm2", [](const CallReader& in) -> Function { return absolute(in.number(0, "weight", 1), nought); }},
      {"norm_inf",
       [](const CallReader& in) -> Function { return absolute(in.number(0, "weight", 1), nought); }},
      {"elastic_net",
       [](const CallReader& in) -> Function { return absolute(in.number(0, "l1"), in.number(1, "l2")); }},
      {"huber", [](const CallReader& in) -> Function { return huber(in.number(0, "mu")); }},
      {"hinge",
       [](const CallReader&) -> Function {
         return exact_curve({piece(std::nullopt, single, nought, -single, single),
                             piece(single, std::nullopt, nought, nought, nought)});
       }},
      {"plq", [](const CallReader& in) -> Function { return plq(in); }},
      {"indicator", [](const CallReader& in) -> Function { return set_of(in.call(0, "set")); }},
      {"support", [](const CallReader& in) -> Function { return conjugate(set_of(in.call(0, "set"))); }},
      {"exponential", [](const CallReader&) -> Function { return exponential(); }},
      {"entropy", [](const CallReader&) -> Function { return entropy(); }},
      {"log_barrier", [](const CallReader&) -> Function { return log_barrier(); }},
      {"logistic", [](const CallReader&) -> Function { return logistic(); }},
      {"power",
       [](const CallReader& in) -> Function {
         const Fraction p = in.number(0, "p");
         if (p == single) return absolute(single, nought);
         if (p == Fraction{2, 1}) return quadratic({2, 1}, nought, nought);
         return power_of_absolute(p);
       }},
      {"inverse_power", [](const CallReader& in) -> Function { return inverse_power(in.number(0, "q")); }},
      {"kullback_leibler",
       [](const CallReader& in) -> Function { return kullback_leibler(in.number(0, "reference")); }},
      {"conjugate", [](const CallReader& in) { return conjugate(in.function(0, "f")); }},
      {"envelope", [](const CallReader& in) { return envelope(in.function(0, "f"), in.number(1, "gamma")); }},
      {"translate", [](const CallReader& in) { return translate(in.function(0, "f"), in.number(1, "by")); }},
      {"tilt", [](const CallReader& in) { return tilt(in.function(0, "f"), in.number(1, "c")); }},
      {"scale", [](const CallReader& in) { return scale(in.function(0, "f"), in.number(1, "alpha")); }},
      {"dilate", [](const CallReader& in) { return dilate(in.function(0, "f"), in.number(1, "rho")); }},
      {"sum",
       [](const CallReader& in) {
         Function total = in.function(0, "f");
         for (std::size_t k = 1; k < in.count(); ++k) total = sum(total, in.function(k, ""));
         return total;
       }},
      {"inf_convolution",
       [](const CallReader& in) { return inf_convolution(in.function(0, "f"), in.function(1, "g")); }},
      {"precompose",
       [](const CallReader& in) -> Function {  // f(a x + b) is f((x + b/a)/(1/a))
         const Fraction a = in.number(1, "A"), b = in.number(2, "b", 0);
         if (sign(a) == 0) no_rule(in.itself(), "A is 0");
         return translate(dilate(in.function(0, "f"), single / a), -(b / a));
       }},
  };
  return all;
}

}  // namespace

Function function_of(const Call& call) {
  const auto found = makers().find(call.name);
  if (found != makers().end()) return found->second(CallReader(call));
  return set_of(call);
}

}  // namespace convex::symbolic
