#include "convex/symbolic/function.hpp"

#include <algorithm>

#include "convex/invalid_input.hpp"

namespace convex::symbolic {
namespace {

const Fraction part_half{1, 2}, whole_one{1, 1};
const Term x_of = variable("x"), y_of = variable("y"), z_of = variable("z");

/// Every term changed, the domains kept.
Cases changed(Cases cases, const std::function<Term(const Term&)>& change) {
  for (Case& each : cases) each.term = change(each.term);
  return cases;
}

/// The cases at slope v + offset for the variable v, slope not 0.
Cases moved(Cases cases, const std::string& name, const Fraction& slope, const Fraction& offset) {
  const Term by = slope * variable(name) + number(offset);
  const auto back = [&](std::optional<Bound>& bound) {
    if (bound) bound = (*bound - offset) / slope;
  };
  for (Case& each : cases) {
    each.term = substituted(each.term, name, by);
    back(each.low);
    back(each.high);
    if (sign(slope) > 0) continue;
    std::swap(each.low, each.high);
    std::swap(each.has_low, each.has_high);
  }
  if (sign(slope) < 0) return Cases(cases.rbegin(), cases.rend());
  return cases;
}

Cases renamed(Cases cases, const std::string& from, const std::string& to) {
  return changed(std::move(cases), [&](const Term& t) { return substituted(t, from, variable(to)); });
}

Cases curve_formula(const ExactCurve& curve, const std::string& name) {
  const Term v = variable(name);
  Cases cases;
  for (const ExactPiece& piece : pieces(curve))
    cases.push_back({piece.low, piece.high, true, true,
                     Surd{part_half} * piece.c2 * power(v, {2, 1}) + piece.c1 * v + number(piece.c0)});
  return cases;
}

/// f + c/2 x², c > 0, by rules.
RuleFunction with_square(const RuleFunction& f, const Fraction& c) {
  return {changed(f.f,
                  [&](const Term& t) {
                    return t + part_half * c * power(x_of, {2, 1});
                  }),
          {},
          [f, c](const Fraction& gamma) {
            const Fraction rest = whole_one / (whole_one + gamma * c);
            return moved(f.prox(gamma * rest), "z", rest, {0, 1});
          }};
}

}  // namespace

Cases formula(const Function& f) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return curve_formula(*curve, "x");
  const Cases& cases = std::get<RuleFunction>(f).f;
  if (cases.empty()) throw InvalidInput("there is no rule for this function itself in elementary terms");
  return cases;
}

Cases conjugate_formula(const Function& f) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return curve_formula(conjugate(*curve), "y");
  const Cases& cases = std::get<RuleFunction>(f).conjugate;
  if (cases.empty())
    throw InvalidInput("there is no rule for this conjugate in elementary terms; its prox has one");
  return cases;
}

Cases prox_formula(const Function& f, const Fraction& gamma) {
  if (const auto* rule = std::get_if<RuleFunction>(&f)) return rule->prox(gamma);
  Cases cases;
  for (const AffinePiece& piece : prox_pieces(std::get<ExactCurve>(f), gamma))
    cases.push_back({piece.low, piece.high, true, true, piece.slope * z_of + number(piece.offset)});
  return cases;
}

Function conjugate(const Function& f) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return conjugate(*curve);
  const RuleFunction rule = std::get<RuleFunction>(f);
  return RuleFunction{renamed(rule.conjugate, "y", "x"), renamed(rule.f, "x", "y"),
                      [rule](const Fraction& gamma) {  // Moreau 1965: z - gamma prox_{f/gamma}(z/gamma)
                        return changed(moved(rule.prox(whole_one / gamma), "z", whole_one / gamma, {0, 1}),
                                       [&](const Term& t) { return z_of - gamma * t; });
                      }};
}

Function envelope(const Function& f, const Fraction& gamma) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return envelope(*curve, gamma);
  const RuleFunction rule = std::get<RuleFunction>(f);
  const Cases prox = rule.prox(gamma);
  RuleFunction made;
  // f(p) + (x - p)²/(2 gamma); p lies inside of the domain, where f by rules has one formula.
  const auto inside = std::find_if(rule.f.begin(), rule.f.end(), [](const Case& each) {
    return !each.low || !each.high || *each.low < *each.high;
  });
  if (prox.size() == 1 && inside != rule.f.end()) {
    const Term p = substituted(prox.front().term, "z", x_of);
    made.f = {{std::nullopt, std::nullopt, true, true,
               substituted(inside->term, "x", p) + (part_half / gamma) * power(x_of - p, {2, 1})}};
  }
  made.conjugate = changed(rule.conjugate, [&](const Term& t) {
    return t + part_half * gamma * power(y_of, {2, 1});
  });
  made.prox = [rule, gamma](const Fraction& delta) {
    const Fraction part = delta / (gamma + delta);
    return changed(rule.prox(gamma + delta),
                   [&](const Term& t) { return (whole_one - part) * z_of + part * t; });
  };
  return made;
}

Function scale(const Function& f, const Fraction& alpha) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return scale(*curve, alpha);
  const RuleFunction rule = std::get<RuleFunction>(f);
  const auto times_alpha = [&](const Term& t) { return alpha * t; };
  return RuleFunction{changed(rule.f, times_alpha),
                      changed(moved(rule.conjugate, "y", whole_one / alpha, {0, 1}), times_alpha),
                      [rule, alpha](const Fraction& gamma) { return rule.prox(alpha * gamma); }};
}

Function dilate(const Function& f, const Fraction& rho) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return dilate(*curve, rho);
  const RuleFunction rule = std::get<RuleFunction>(f);
  return RuleFunction{moved(rule.f, "x", whole_one / rho, {0, 1}), moved(rule.conjugate, "y", rho, {0, 1}),
                      [rule, rho](const Fraction& gamma) {
                        return changed(moved(rule.prox(gamma / (rho * rho)), "z", whole_one / rho, {0, 1}),
                                       [&](const Term& t) { return rho * t; });
                      }};
}

Function translate(const Function& f, const Fraction& by) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return translate(*curve, by);
  const RuleFunction rule = std::get<RuleFunction>(f);
  return RuleFunction{moved(rule.f, "x", whole_one, -by),
                      changed(rule.conjugate, [&](const Term& t) { return t + by * y_of; }),
                      [rule, by](const Fraction& gamma) {
                        return changed(moved(rule.prox(gamma), "z", whole_one, -by),
                                       [&](const Term& t) { return t + number(by); });
                      }};
}

Function tilt(const Function& f, const Fraction& c) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return tilt(*curve, c);
  const RuleFunction rule = std::get<RuleFunction>(f);
  return RuleFunction{
      changed(rule.f, [&](const Term& t) { return t + c * x_of; }), moved(rule.conjugate, "y", whole_one, -c),
      [rule, c](const Fraction& gamma) { return moved(rule.prox(gamma), "z", whole_one, -(gamma * c)); }};
}

Function add_constant(const Function& f, const Fraction& c) {
  if (const auto* curve = std::get_if<ExactCurve>(&f)) return add_constant(*curve, c);
  RuleFunction rule = std::get<RuleFunction>(f);
  rule.f = changed(std::move(rule.f), [&](const Term& t) { return t + number(c); });
  rule.conjugate = changed(std::move(rule.conjugate), [&](const Term& t) { return t - number(c); });
  return rule;
}

RuleFunction with_quadratic(const RuleFunction& f, const Fraction& c2, const Fraction& c1,
                            const Fraction& c0) {
  const auto tilted = std::get<RuleFunction>(add_constant(tilt(f, c1), c0));
  if (sign(c2) == 0) return tilted;
  // (f + c/2 x²)* is the envelope of f* with gamma = c.
  RuleFunction made = with_square(tilted, c2);
  const Function dual = envelope(conjugate(tilted), c2);
  made.conjugate = renamed(std::get<RuleFunction>(dual).f, "x", "y");
  return made;
}

Function sum(const Function& f, const Function& g) {
  const auto *first = std::get_if<ExactCurve>(&f), *second = std::get_if<ExactCurve>(&g);
  if (first != nullptr && second != nullptr) return sum(*first, *second);
  if (first != nullptr) return sum(g, f);
  const auto& rule = std::get<RuleFunction>(f);
  if (rule.parts) {
    // Rules with rules, and pieces with pieces.
    if (second != nullptr) return sum_with_pieces(rule.parts->rule, sum(rule.parts->pieces, *second));
    return sum(sum(Function{rule.parts->rule}, g), Function{rule.parts->pieces});
  }
  if (second == nullptr) {
    const auto& other = std::get<RuleFunction>(g);
    return other.parts ? sum(g, f) : Function{sum_of_rules(rule, other)};
  }
  const std::vector<ExactPiece> quadratic = pieces(*second);
  if (quadratic.size() != 1 || quadratic.front().low || quadratic.front().high)
    return sum_with_pieces(rule, *second);
  const ExactPiece& q = quadratic.front();
  return with_quadratic(rule, rational(q.c2), rational(q.c1), rational(q.c0));
}

Function inf_convolution(const Function& f, const Function& g) {
  const auto *first = std::get_if<ExactCurve>(&f), *second = std::get_if<ExactCurve>(&g);
  if (first != nullptr && second != nullptr) return inf_convolution(*first, *second);
  return conjugate(sum(conjugate(f), conjugate(g)));
}

Function pointwise_max(const Function& f, const Function& g) {
  const auto *first = std::get_if<ExactCurve>(&f), *second = std::get_if<ExactCurve>(&g);
  if (first != nullptr && second != nullptr) return pointwise_max(*first, *second);
  throw InvalidInput(
      "pointwise_max: a function by rules has no maximum in symbols; its pieces must be quadratic");
}

}  // namespace convex::symbolic
