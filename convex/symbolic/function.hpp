#pragma once

#include <functional>
#include <memory>
#include <variant>

#include "convex/symbolic/exact_curve.hpp"
#include "convex/symbolic/term.hpp"

namespace convex::symbolic {

/// A function of one variable by rules: f in x, its conjugate in y, and the prox of gamma f in z by gamma.
struct RuleFunction {
  Cases f, conjugate;
  std::function<Cases(const Fraction& gamma)> prox;
  /// What a sum of a rule and pieces was made of, so that more pieces can be added.
  std::shared_ptr<const struct RuleAndPieces> parts = {};
};
struct RuleAndPieces {
  RuleFunction rule;
  ExactCurve pieces;
};

/// Piecewise linear-quadratic in fractions, or by rules.
using Function = std::variant<ExactCurve, RuleFunction>;

/// Formulas of f in x, of its conjugate in y, of the prox of gamma f in z.
Cases formula(const Function&);
Cases conjugate_formula(const Function&);
Cases prox_formula(const Function&, const Fraction& gamma);

/// As those of exact_curve.hpp. Of two functions by rules the prox is the root of u + gamma (f + g)'(u) = z,
/// and so is the conjugate, where one of theirs is finite everywhere. Maxima of functions by rules, and
/// envelopes of such with a prox by cases, have no rule: InvalidInput.
Function conjugate(const Function&);
Function envelope(const Function&, const Fraction& gamma);
Function scale(const Function&, const Fraction& alpha);
Function dilate(const Function&, const Fraction& rho);
Function translate(const Function&, const Fraction& by);
Function tilt(const Function&, const Fraction& c);
Function add_constant(const Function&, const Fraction& c);
Function sum(const Function&, const Function&);
Function inf_convolution(const Function&, const Function&);
Function pointwise_max(const Function&, const Function&);
/// The sum of two by rules; see `sum`.
RuleFunction sum_of_rules(const RuleFunction&, const RuleFunction&);
/// Of a rule and c2/2 x² + c1 x + c0 on the whole line.
RuleFunction with_quadratic(const RuleFunction&, const Fraction& c2, const Fraction& c1, const Fraction& c0);
/// Of a rule f and pieces p: where p is quadratic, f with that quadratic has a prox and a conjugate; they
/// hold for the z and y that lead there, between b + gamma (f'(b) + p'(b)) and f'(b) + p'(b) of its ends b.
/// At a corner b the prox stays, and the conjugate is b y - f(b) - p(b). InvalidInput where f has several
/// formulas or a derivative without one.
RuleFunction sum_with_pieces(const RuleFunction& f, const ExactCurve& p);

/// e^x; x log x; -log x; log(1 + e^x); |x|^p, p > 1; x^-q for x > 0; x log(x/r) - x + r.
/// Conjugates: Rockafellar 1970, section 12; Bauschke and Combettes 2017, chapter 13. Proxes: Chaux,
/// Combettes, Pesquet and Wajs 2007; where an equation has no elementary solution its root is the formula.
RuleFunction exponential();
RuleFunction entropy();
RuleFunction log_barrier();
RuleFunction logistic();
RuleFunction power_of_absolute(const Fraction& p);
RuleFunction inverse_power(const Fraction& q);
RuleFunction kullback_leibler(const Fraction& reference);

}  // namespace convex::symbolic
