#include "convex/invalid_input.hpp"
#include "convex/symbolic/function.hpp"

namespace convex::symbolic {
namespace {

const Fraction rule_zero{0, 1}, rule_one{1, 1};
const Term rule_x = variable("x"), rule_y = variable("y"), rule_z = variable("z"), rule_u = variable("u");

Case everywhere(Term term) { return {std::nullopt, std::nullopt, true, true, std::move(term)}; }
Case above(const Fraction& low, Term term) { return {low, std::nullopt, false, true, std::move(term)}; }
Case below(const Fraction& high, Term term) { return {std::nullopt, high, true, false, std::move(term)}; }
Case at(const Fraction& point, Term term) { return {point, point, true, true, std::move(term)}; }

/// The rule of a prox on the whole line.
std::function<Cases(const Fraction&)> by(Term (*rule)(const Fraction&)) {
  return [rule](const Fraction& gamma) { return Cases{everywhere(rule(gamma))}; };
}

Fraction inverse(const Fraction& a) { return Fraction{1, 1} / a; }

}  // namespace

RuleFunction exponential() {
  return {{everywhere(function("exp", rule_x))},
          {at(rule_zero, number(0)), above(rule_zero, rule_y * function("log", rule_y) - rule_y)},
          by([](const Fraction& gamma) { return rule_z - function("W", gamma * function("exp", rule_z)); })};
}

RuleFunction entropy() {
  // gamma (log x + 1) = z - x, so (x/gamma) e^(x/gamma) = e^(z/gamma - 1)/gamma.
  return {{at(rule_zero, number(0)), above(rule_zero, rule_x * function("log", rule_x))},
          {everywhere(function("exp", rule_y - number(1)))},
          by([](const Fraction& gamma) {
            return gamma *
                   function("W", inverse(gamma) * function("exp", inverse(gamma) * rule_z - number(1)));
          })};
}

RuleFunction log_barrier() {
  return {{above(rule_zero, Fraction{-1, 1} * function("log", rule_x))},
          {below(rule_zero, number(Fraction{-1, 1}) - function("log", Fraction{-1, 1} * rule_y))},
          by([](const Fraction& gamma) {
            return Fraction{1, 2} *
                   (rule_z + function("sqrt", power(rule_z, {2, 1}) + number(Fraction{4, 1} * gamma)));
          })};
}

RuleFunction logistic() {
  const Term rest = number(1) - rule_y;
  Case inside = above(rule_zero, rule_y * function("log", rule_y) + rest * function("log", rest));
  inside.high = rule_one;
  inside.has_high = false;
  return {{everywhere(function("log", number(1) + function("exp", rule_x)))},
          {at(rule_zero, number(0)), inside, at(rule_one, number(0))},
          by([](const Fraction& gamma) {
            const Term slope = power(number(1) + function("exp", Fraction{-1, 1} * rule_u), {-1, 1});
            return root(rule_u + gamma * slope, rule_z, std::nullopt);
          })};
}

RuleFunction power_of_absolute(const Fraction& p) {
  if (!(rule_one < p)) throw InvalidInput("power: p must be above 1 here; |x| itself is norm1()");
  const Fraction dual = p / (p - rule_one);
  const Term size = function("abs", rule_x);
  return {{everywhere(power(size, p))},
          {everywhere((p - rule_one) * power(function("abs", inverse(p) * rule_y), dual))},
          [p](const Fraction& gamma) {
            const Term distance = function("abs", rule_z), side = function("sign", rule_z);
            if (p == Fraction{3, 1})  // x + 3 gamma x² = |z|
              return Cases{everywhere(
                  inverse(Fraction{6, 1} * gamma) * side *
                  (function("sqrt", number(1) + (Fraction{12, 1} * gamma) * distance) - number(1)))};
            if (p == Fraction{3, 2}) {  // v² + 3/2 gamma v = |z|, x = v²
              const Fraction b = Fraction{3, 4} * gamma;
              return Cases{
                  everywhere(side * power(function("sqrt", distance + number(b * b)) - number(b), {2, 1}))};
            }
            const Term equation = rule_u + (p * gamma) * power(rule_u, p - rule_one);
            return Cases{everywhere(side * root(equation, distance, Fraction{0, 1}))};
          }};
}

RuleFunction inverse_power(const Fraction& q) {
  if (!(rule_zero < q)) throw InvalidInput("inverse_power: q must be above 0");
  const Fraction exponent = q / (q + rule_one);
  return {{above(rule_zero, power(rule_x, -q))},
          {below(rule_zero, (-(q + rule_one)) * power((-inverse(q)) * rule_y, exponent)),
           at(rule_zero, number(0))},
          [q](const Fraction& gamma) {
            return Cases{everywhere(
                root(rule_u - (gamma * q) * power(rule_u, -(q + rule_one)), rule_z, Fraction{0, 1}))};
          }};
}

RuleFunction kullback_leibler(const Fraction& r) {
  if (!(rule_zero < r)) throw InvalidInput("kullback_leibler: the reference must be above 0");
  return {{at(rule_zero, number(r)),
           above(rule_zero, rule_x * function("log", inverse(r) * rule_x) - rule_x + number(r))},
          {everywhere(r * function("exp", rule_y) - number(r))},
          [r](const Fraction& gamma) {
            return Cases{
                everywhere(gamma * function("W", (r / gamma) * function("exp", inverse(gamma) * rule_z)))};
          }};
}

}  // namespace convex::symbolic
