#include "convex/proved_prox/proved_conjugate.hpp"

#include <cmath>

#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/proved_prox/pair_of_call.hpp"

namespace convex::inline proved_prox {

double ProvedValue::error_of(double value) const {
  if (std::isinf(interval.low) && interval.low == interval.high) return value == interval.low ? 0 : INFINITY;
  if (!std::isfinite(value)) return INFINITY;
  if (exact) {
    const Fraction miss = *exact - fraction(value);
    return root_above(miss * miss);
  }
  return std::nextafter(std::max(interval.high - value, value - interval.low), INFINITY);
}

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
  const PairSearch found = pair_at_covector(question.f, question.W, v);
  if (!found.pair) {
    made.why_none = found.why_none;
    return made;
  }
  // Fenchel: f*(v) >= x·v - f(x).
  made.level = ProofLevel::enclosure;
  made.interval = outwards(dot(found.pair->x, v) - found.pair->f_x.high, found.pair->f_v.high);
  return made;
}

}  // namespace convex::inline proved_prox
