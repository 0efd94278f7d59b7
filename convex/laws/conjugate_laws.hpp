#pragma once

#include "convex/laws/subject.hpp"

namespace convex::inline law_checks {

/// A function and what is claimed to be its conjugate, g(y) = sup_x (x|y) - f(x), in the metric of the trial.
struct ConjugatePair {
  Subject f, g;
  bool cone = false;  ///< f is the indicator of a cone
  /// y = prox_g z by other routes than g's own and f's own, such as there are, none of them by_conjugate.
  std::function<std::vector<Prox>(const Vector& z, const Metric& W)> other_routes = {};
};

/// What is tried of such a pair, with x = prox_f z and y = prox_g z (Moreau 1965 and 1966, section 4):
/// - z = x + y by two routes, with every y that was found without x: g's own, unless it or x came from the
///   other (`are_two_routes`), and those of `other_routes`. Where there is none the law fails, and
///   `no_evidence` says why;
/// - conjugacy, f(x) + g(y) = (x|y), and Fenchel's inequality f(u) + g(w) >= (u|w) elsewhere;
/// - uniqueness: z = (x + d) + (y - d) misses conjugacy by at least ||d||²;
/// - x is the gradient at z of the envelope of g, e(z) = g(y) + ½||z - y||²: (x|h) <= e(z + h) - e(z) <=
/// (x'|h)
///   with x' = prox_f(z + h), and e_f(z) + e_g(z) = ½||z||²;
/// - for a cone, (x|y) = 0 and prox_f(2z) = 2x.
std::vector<Check> conjugate_laws(const ConjugatePair& pair, const Trial& trial,
                                  const std::vector<Vector>& others, std::vector<std::string>& no_evidence);

/// The pair of f and f.conjugate(W). Other routes to y: the program of g; where f or g is the support
/// function of a bounded set in few dimensions, that set's support points alone (`nearest_by_support`); and
/// where there is neither, cutting planes of a finite f (`prox_by_cutting_planes`).
ConjugatePair conjugate_pair(const Function& f, const Metric& W);

/// What is tried of the function f alone: f** = f at prox points and in their proxes, unless f** is no other
/// object, which is said in `no_evidence`; a subgradient that f gives at x is one; W(z - x) counts as a
/// subgradient at x; and the metric identity z = prox^W_f z + W⁻¹ prox^(W⁻¹)_(f*)(W z) with the plain
/// conjugate. `subject`: f, as in its pair.
std::vector<Check> function_laws(const Function& f, const Subject& subject, const Trial& trial,
                                 const std::vector<Vector>& others, std::vector<std::string>& no_evidence);

}  // namespace convex::inline law_checks
