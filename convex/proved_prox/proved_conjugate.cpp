#include "convex/proved_prox/proved_conjugate.hpp"

#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/composite/composite_prox.hpp"
#include "convex/exact_program/exact_minimum.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/infinity.hpp"
#include "convex/nearest_point/solution.hpp"
#include "convex/proved_prox/entry_formulas.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "convex/proved_prox/supremum_between.hpp"

namespace convex::inline proved_prox {

double ProvedValue::error_of(double value) const {
  if (std::isinf(interval.low) && interval.low == interval.high) return value == interval.low ? 0 : INFINITY;
  if (!std::isfinite(value)) return INFINITY;
  if (interval.low == value && interval.high == value) return 0;
  if (exact) {
    const Fraction miss = *exact - fraction(value);
    return root_above(miss * miss);
  }
  return std::nextafter(std::max(interval.high - value, value - interval.low), INFINITY);
}

namespace {

/// A pair with the covector v, near the point where doubles find the supremum.
PairSearch pair_by_subgradient(const SplitQuestion& question, const Fractions& v) {
  const PairSearch not_attained{
      {}, "doubles find no point of the supremum: a value that none attains, or that is +inf, is not proved"};
  const Function g = make_function(question.f, {rounded(question.W)}).conjugate(rounded(question.W));
  // ∂g(y) = W ∂f*(Wy): the maximisers x are W⁻¹ of a subgradient of g.
  const auto c = g.subgradient(nearest(question.z));
  if (!c || !c->allFinite()) return not_attained;
  const Vector x = rounded(question.W).solve(*c);
  if (!x.allFinite()) return not_attained;
  return pair_at_covector(question.f, question.W, fractions(x), v);
}

}  // namespace

ProvedValue proved_conjugate(const SplitQuestion& question) {
  ProvedValue made;
  const Fractions v = multiply(question.W, question.z);
  if (const auto program = exact_program(question.f, question.W)) {
    const ExactValue value = exact_value(exact_programs::conjugate(*program), v);
    made.level = ProofLevel::exact;
    if (value.end == ProgramEnd::minimum) {
      made.exact = value.value;
      made.interval = outwards(value.value, value.value);
    } else {
      made.interval = {INFINITY, INFINITY};
    }
    return made;
  }
  if (!Ball::why_none().empty()) {
    made.why_none = Ball::why_none();
    return made;
  }
  if (const auto entries = entry_formulas(question.f, v.size()); !entries.empty())
    if (const auto value = conjugate_of_entries(entries, v)) {
      made.level = ProofLevel::enclosure;
      made.interval = value->is_infinite ? ProvedInterval{INFINITY, INFINITY}
                                         : outwards(value->between.low, value->between.high);
      return made;
    }
  PairSearch found = pair_at_covector(question.f, question.W, v);
  if (!found.pair) found = pair_by_subgradient(question, v);
  if (!found.pair) {
    made.why_none = found.why_none;
    return made;
  }
  // Fenchel: f*(v) >= x·v - f(x).
  made.level = ProofLevel::enclosure;
  made.interval = outwards(dot(found.pair->x, v) - found.pair->f_x.high, found.pair->f_v.high);
  return made;
}

namespace {

/// The value of a program at x, rounded, +inf where it has none; nothing where fractions would take long. Its
/// error is that of a value beyond doubles, +inf, or 0.
std::optional<Value> quick_value(const ExactProgram& f, const Fractions& x) {
  if (!(pair_operations(f, identity_gram(x.size())) <= quick_part_of_operations * most_word_operations))
    return std::nullopt;
  const ExactValue found = exact_value(f, x);
  if (found.end != ProgramEnd::minimum) return Value{INFINITY, 0};
  const double nearest = nearest_double(found.value);
  return Value{nearest, std::isinf(nearest) ? INFINITY : 0};
}

/// Whether f has a bounded domain, or does not grow: no value of it is large because its point is far out.
bool is_near(const Atom& f, Index n) {
  for (Index i = 0; i < n; ++i)
    for (const double side : {-1.0, 1.0}) {
      const Vector d = side * Vector::Unit(n, i);
      if (!std::isfinite(f.domain_support(d)) && f.recession(d) != 0) return false;
    }
  return true;
}

/// What terms may round at xi: their numbers are made in doubles, that of a curved function that has one
/// point too. Of those that grow far out fractions know more than the doubles of a value.
double roundings_of_terms(const GraphForm& f, const Vector& xi) {
  double sum = 0;
  for (const GraphTerm& term : f.terms) {
    if (!is_near(*term.f, term.M.rows())) continue;
    if (const Value value = term.f->evaluate(term.M * xi + term.b); std::isfinite(value.error))
      sum += term.scale * value.error;
  }
  return sum;
}

/// The value that doubles found, or the bounds that fractions prove it to be outside of.
Value held_between(const Function& f, const Function& g, const Metric& W, const Vector& y, Value found) {
  const auto form = f.node().graph(y.size());
  const auto slope = std::isfinite(found.value) && form ? g.subgradient(y) : std::nullopt;
  if (!slope || !slope->allFinite()) return found;
  Vector xi(form->n + form->k);
  xi.head(form->n) = W.solve(*slope);
  if (form->k > 0) {
    const GraphValue at_x = evaluate(*form, xi.head(form->n));
    if (at_x.w.size() != form->k) return found;
    xi.tail(form->k) = at_x.w;
  }
  if (!xi.allFinite()) return found;
  const auto proved = supremum_between(*form, xi, multiply(exact_gram(W), fractions(y)));
  if (!proved) return found;
  const double low = nearest_double(proved->low),
               high = proved->high ? nearest_double(*proved->high) : INFINITY;
  const double rounding =
      unit_roundoff * (std::abs(low) + std::abs(found.value)) + roundings_of_terms(*form, xi);
  const bool is_inside = low - found.value <= rounding && found.value - high <= rounding;
  const double within = is_inside ? std::max(high - found.value, found.value - low) : infinity;
  if (within + rounding < found.error) return {found.value, within + rounding};
  const bool fits =
      low - found.value <= found.error + rounding && found.value - high <= found.error + rounding;
  return fits && !(high - low + rounding < found.error) ? found : Value{low, high - low + rounding};
}

}  // namespace

Value decided_value(const Function& f, const Metric& W, const Vector& x) {
  const Value found = f.evaluate(x);
  const auto form = f.node().graph(x.size());
  if (!form || form->k == 0) return found;
  const auto program = exact_program(f.call(), exact_gram(W));
  if (!program) return held_between(f.conjugate(), f, Metric::identity(x.size()), x, found);
  const auto value = quick_value(*program, fractions(x));
  // A rounding of x or of the numbers is as much outside as a mile.
  if (!value || (std::isinf(value->value) && std::isfinite(found.value))) return found;
  return {value->value, std::isinf(value->value) ? value->error : unit_roundoff * std::abs(value->value)};
}

Value decided_conjugate(const SplitQuestion& written, const Function& g, const Vector& y) {
  const Value found = g.evaluate(y);
  const auto program = exact_program(written.f, written.W);
  const auto of_roundings = exact_program(g.call(), identity_gram(written.z.size()));
  if (!program || !of_roundings) {
    const Metric W = rounded(written.W);
    return held_between(make_function(written.f, {W}), g, W, y, found);
  }
  const auto value = quick_value(exact_programs::conjugate(*program), multiply(written.W, written.z)),
             beside = quick_value(*of_roundings, fractions(y));
  if (!value || !beside) return found;
  const bool is_finite = std::isfinite(value->value), is_finite_beside = std::isfinite(beside->value);
  if (!is_finite && (!is_finite_beside || value->error > 0))
    return std::isfinite(found.value) ? found : *value;
  const double told = is_finite ? value->value : beside->value;
  const double other = is_finite && is_finite_beside ? beside->value : found.value;
  return {told, unit_roundoff * std::abs(told) + (std::isfinite(other) ? std::abs(told - other) : 0)};
}

}  // namespace convex::inline proved_prox
