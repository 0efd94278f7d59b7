#include "convex/symbolic/function_of_call.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "convex/catalogue/catalogue.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"

namespace convex::symbolic {
namespace {

const Fraction nought{0, 1}, single{1, 1};

[[noreturn]] void no_rule(const Call& call, const std::string& why) {
  throw InvalidInput(call.name + ": " + why + "; without --symbolic it is computed in numbers", call.place);
}

/// Arguments by position or by name, with the defaults of the catalogue.
class CallReader {
 public:
  CallReader(const Call& call, const Fraction& weight)
      : call_(call), entry_(find_entry(call.name)), weight_(weight) {
    if (entry_ == nullptr) no_rule(call, "there is no such name");
  }

  const Argument* find(std::string_view key) const {
    const std::size_t position = place(key);
    read_.push_back(position);
    for (std::size_t k = 0; k < call_.arguments.size(); ++k) {
      const NamedArgument& given = call_.arguments[k];
      if (given.key.empty() ? k == position : given.key == key) return &given.value;
    }
    return nullptr;
  }
  /// A number, or a vector or matrix of one entry; infinite: none.
  std::optional<Fraction> bound(std::string_view key) const {
    const Argument* found = find(key);
    double number = 0;
    if (found == nullptr)
      number = declared_default(key);
    else if (const auto* plain = std::get_if<double>(found))
      number = *plain;
    else if (const auto* vector = std::get_if<Vector>(found); vector != nullptr && vector->size() == 1)
      number = (*vector)[0];
    else if (const auto* matrix = std::get_if<Matrix>(found); matrix != nullptr && matrix->size() == 1)
      number = (*matrix)(0, 0);
    else
      no_rule(call_, std::string(key) + " is not one number, and symbols have one variable");
    if (std::isinf(number)) return std::nullopt;
    return simplest_fraction(number);
  }
  Fraction number(std::string_view key) const {
    const auto found = bound(key);
    if (!found) no_rule(call_, std::string(key) + " is not finite");
    return *found;
  }
  const Call& call(std::string_view key) const { return call_in(find(key)); }
  Function function(std::string_view key) const { return function_of(call(key), weight_); }
  const Fraction& weight() const { return weight_; }
  /// Of a list of functions.
  Function function_at(std::size_t position) const {
    read_.push_back(position);
    return function_of(call_in(&call_.arguments[position].value), weight_);
  }
  /// An argument that no rule has looked at would be left out in silence.
  void require_all_read() const {
    for (std::size_t k = 0; k < call_.arguments.size(); ++k) {
      const std::string& key = call_.arguments[k].key;
      const std::size_t position = key.empty() ? k : place(key);
      if (std::find(read_.begin(), read_.end(), position) == read_.end())
        no_rule(call_, "one of its arguments has no rule in symbols");
    }
  }
  std::size_t count() const { return call_.arguments.size(); }
  const Call& itself() const { return call_; }

 private:
  std::size_t place(std::string_view key) const {
    const auto& parameters = entry_->parameters;
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [key](const Parameter& parameter) { return parameter.name == key; });
    invariant(found != parameters.end(), "a rule names the arguments of the catalogue");
    return static_cast<std::size_t>(found - parameters.begin());
  }
  double declared_default(std::string_view key) const {
    const std::string text(entry_->parameters[place(key)].fallback);
    if (text.empty()) no_rule(call_, std::string(key) + " is missing");
    return std::strtod(text.c_str(), nullptr);
  }
  const Call& call_in(const Argument* argument) const {
    const auto* inner = argument != nullptr ? std::get_if<std::shared_ptr<const Call>>(argument) : nullptr;
    if (inner == nullptr) no_rule(call_, "an argument is no function");
    return **inner;
  }
  const Call& call_;
  const CatalogueEntry* entry_;
  Fraction weight_;
  mutable std::vector<std::size_t> read_;  ///< places of the arguments that were asked for
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

ExactCurve pinball(const Fraction& tau) {
  return exact_curve({piece(std::nullopt, nought, nought, tau - single, nought),
                      piece(nought, std::nullopt, nought, tau, nought)});
}

ExactCurve huber(const Fraction& mu) {
  const Fraction shift = -(Fraction{1, 2} * mu);
  return exact_curve({piece(std::nullopt, -mu, nought, -single, shift),
                      piece(-mu, mu, single / mu, nought, nought),
                      piece(mu, std::nullopt, nought, single, shift)});
}

ExactCurve plq(const CallReader& in) {
  const Argument *breaks = in.find("breaks"), *coefficients = in.find("coefficients");
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
ExactCurve set_in(const CallReader& in) {
  const std::string& name = in.itself().name;
  if (name == "box") return interval(in.bound("lower"), in.bound("upper"));
  if (name == "orthant") return interval(nought, std::nullopt);
  if (name == "point") return interval(in.number("p"), in.number("p"));
  if (name == "ball1" || name == "ball_inf" || name == "ball2") {
    const Fraction radius = in.number("radius"), centre = name == "ball2" ? in.number("center") : nought;
    return interval(centre - radius, centre + radius);
  }
  if (name == "halfspace" || name == "hyperplane") {
    const Fraction a = in.number("a"), b = in.number("b");
    if (sign(a) == 0) no_rule(in.itself(), "a is 0");
    if (name == "hyperplane") return interval(b / a, b / a);
    return sign(a) > 0 ? interval(std::nullopt, b / a) : interval(b / a, std::nullopt);
  }
  if (name == "simplex" || name == "spectraplex") return interval(in.number("total"), in.number("total"));
  if (name == "second_order_cone" || name == "psd_cone") return interval(nought, std::nullopt);
  if (name == "monotone_cone") return interval(std::nullopt, std::nullopt);
  no_rule(in.itself(), "it has no rule in symbols");
}

ExactCurve set_of(const Call& call) {
  const CallReader in(call, single);
  ExactCurve set = set_in(in);
  in.require_all_read();
  return set;
}

/// g(w y): the conjugate in the product w x y.
Function in_product(const Function& g, const Fraction& weight) { return dilate(g, single / weight); }

ExactCurve with_curvature(const ExactCurve& f, const Fraction& c2) {
  std::vector<ExactPiece> all = pieces(f);
  for (ExactPiece& one : all) one.c2 = one.c2 + c2;
  return exact_curve(all);
}

const ExactCurve& curve_of(const CallReader& in, const Function& f) {
  const auto* curve = std::get_if<ExactCurve>(&f);
  if (curve == nullptr) no_rule(in.itself(), "its parts are not quadratic by pieces");
  return *curve;
}

/// With j = x²/(2 gamma) in the product: the inf-convolution of weight (f + j)(x/weight) and rest (g +
/// j)(x/rest), less j (Bauschke, Goebel, Lucet and Wang 2008).
Function proximal_average(const CallReader& in) {
  const Function f = in.function("f"), g = in.function("g");
  const Fraction weight = in.number("weight"), rest = single - weight, c = in.weight() / in.number("gamma");
  if (sign(rest) == 0) return f;
  if (sign(weight) == 0) return g;
  const auto part = [&](const Function& h, const Fraction& share) {
    return scale(dilate(with_curvature(curve_of(in, h), c), share), share);
  };
  return with_curvature(inf_convolution(part(f, weight), part(g, rest)), -c);
}

/// max_i a_i x + b_i.
Function max_affine(const CallReader& in) {
  const Argument *slopes = in.find("A"), *offsets = in.find("b");
  const auto* A = slopes != nullptr ? std::get_if<Matrix>(slopes) : nullptr;
  if (A == nullptr || A->cols() != 1)
    no_rule(in.itself(), "A has not one column, and symbols have one variable");
  const auto* b = offsets != nullptr ? std::get_if<Vector>(offsets) : nullptr;
  std::optional<ExactCurve> highest;
  for (Index i = 0; i < A->rows(); ++i) {
    const Fraction offset = b != nullptr ? simplest_fraction((*b)[i]) : in.number("b");
    const ExactCurve line = quadratic(nought, simplest_fraction((*A)(i, 0)), offset);
    highest = highest ? pointwise_max(*highest, line) : line;
  }
  return *highest;
}

/// Of all functions of a list, two by two.
Function folded(const CallReader& in, Function (*join)(const Function&, const Function&)) {
  Function all = in.function_at(0);
  for (std::size_t k = 1; k < in.count(); ++k) all = join(all, in.function_at(k));
  return all;
}

Function absolute_of(const CallReader& in, std::string_view weight) {
  return absolute(in.number(weight), nought);
}
Function itself(const CallReader&) { return quadratic(nought, single, nought); }

using Maker = Function (*)(const CallReader&);

const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> all{
      {"zero", [](const CallReader&) -> Function { return quadratic(nought, nought, nought); }},
      {"constant",
       [](const CallReader& in) -> Function { return quadratic(nought, nought, in.number("c")); }},
      {"linear", [](const CallReader& in) -> Function { return quadratic(nought, in.number("c"), nought); }},
      {"quadratic",
       [](const CallReader& in) -> Function {
         return quadratic(in.number("Q"), in.number("c"), in.number("constant"));
       }},
      {"squared_norm2",
       [](const CallReader& in) -> Function { return quadratic(in.number("weight"), nought, nought); }},
      {"norm1", [](const CallReader& in) -> Function { return absolute(in.number("weight"), nought); }},
      {"norm2", [](const CallReader& in) -> Function { return absolute(in.number("weight"), nought); }},
      {"norm_inf", [](const CallReader& in) -> Function { return absolute(in.number("weight"), nought); }},
      {"max", itself},
      {"log_sum_exp", itself},
      {"sum_largest",
       [](const CallReader& in) {
         if (!(in.number("k") == single)) no_rule(in.itself(), "symbols have one variable, and k is more");
         return itself(in);
       }},
      {"max_affine", max_affine},
      {"sorted_norm1", [](const CallReader& in) { return absolute_of(in, "weights"); }},
      {"max_eigenvalue",
       [](const CallReader& in) -> Function { return quadratic(nought, in.number("weight"), nought); }},
      {"neg_log_det", [](const CallReader&) -> Function { return log_barrier(); }},
      {"squared_hinge",
       [](const CallReader&) -> Function {
         return exact_curve({piece(std::nullopt, single, {2, 1}, {-2, 1}, single),
                             piece(single, std::nullopt, nought, nought, nought)});
       }},
      {"distance",
       [](const CallReader& in) -> Function {
         return inf_convolution(set_of(in.call("set")), absolute(in.number("weight"), nought));
       }},
      {"squared_distance",
       [](const CallReader& in) -> Function {
         return envelope(set_of(in.call("set")), single / in.number("weight"));
       }},
      {"intersection", [](const CallReader& in) { return folded(in, sum); }},
      {"pointwise_max", [](const CallReader& in) { return folded(in, pointwise_max); }},
      {"proximal_average", proximal_average},
      {"elastic_net",
       [](const CallReader& in) -> Function { return absolute(in.number("l1"), in.number("l2")); }},
      {"huber", [](const CallReader& in) -> Function { return huber(in.number("mu")); }},
      {"hinge",
       [](const CallReader&) -> Function {
         return exact_curve({piece(std::nullopt, single, nought, -single, single),
                             piece(single, std::nullopt, nought, nought, nought)});
       }},
      {"pinball", [](const CallReader& in) -> Function { return pinball(in.number("tau")); }},
      {"plq", [](const CallReader& in) -> Function { return plq(in); }},
      {"indicator", [](const CallReader& in) -> Function { return set_of(in.call("set")); }},
      {"support",
       [](const CallReader& in) -> Function {
         return in_product(conjugate(set_of(in.call("set"))), in.weight());
       }},
      {"exponential", [](const CallReader&) -> Function { return exponential(); }},
      {"entropy", [](const CallReader&) -> Function { return entropy(); }},
      {"log_barrier", [](const CallReader&) -> Function { return log_barrier(); }},
      {"logistic", [](const CallReader&) -> Function { return logistic(); }},
      {"power",
       [](const CallReader& in) -> Function {
         const Fraction p = in.number("p");
         if (p == single) return absolute(single, nought);
         if (p == Fraction{2, 1}) return quadratic({2, 1}, nought, nought);
         return power_of_absolute(p);
       }},
      {"inverse_power", [](const CallReader& in) -> Function { return inverse_power(in.number("q")); }},
      {"kullback_leibler",
       [](const CallReader& in) -> Function { return kullback_leibler(in.number("reference")); }},
      {"conjugate",
       [](const CallReader& in) { return in_product(conjugate(in.function("f")), in.weight()); }},
      {"envelope",
       [](const CallReader& in) { return envelope(in.function("f"), in.number("gamma") / in.weight()); }},
      {"translate", [](const CallReader& in) { return translate(in.function("f"), in.number("by")); }},
      {"tilt", [](const CallReader& in) { return tilt(in.function("f"), in.number("c")); }},
      {"scale", [](const CallReader& in) { return scale(in.function("f"), in.number("alpha")); }},
      {"dilate", [](const CallReader& in) { return dilate(in.function("f"), in.number("rho")); }},
      {"sum", [](const CallReader& in) { return folded(in, sum); }},
      {"inf_convolution",
       [](const CallReader& in) { return inf_convolution(in.function("f"), in.function("g")); }},
      {"precompose",
       [](const CallReader& in) -> Function {  // f(a x + b) is f((x + b/a)/(1/a))
         const Fraction a = in.number("A"), b = in.number("b");
         if (sign(a) == 0) no_rule(in.itself(), "A is 0");
         return translate(dilate(function_of(in.call("f")), single / a), -(b / a));
       }},
  };
  return all;
}

}  // namespace

Function function_of(const Call& call, const Fraction& weight) {
  const auto found = makers().find(call.name);
  if (found == makers().end()) return set_of(call);
  const CallReader in(call, weight);
  Function made = found->second(in);
  in.require_all_read();
  return made;
}

}  // namespace convex::symbolic
