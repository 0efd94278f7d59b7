#include <algorithm>
#include <cmath>

#include "convex/invalid_input.hpp"
#include "convex/operations/one_at_a_time.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/supremum.hpp"

namespace convex::inline operations {
namespace {

/// The nearest point of the domain, and next to it in the domain; empty where the prox does not come out.
Vector point_of_domain(const Function& f, const Vector& x) {
  constexpr double stiff = 1e12;  // at the size of 1
  const double weight = stiff / std::max(x.squaredNorm(), unit_roundoff);
  try {
    return f.prox(x, Metric::diagonal(Vector::Constant(x.size(), weight))).x;
  } catch (const InvalidInput&) {
    return {};
  }
}

}  // namespace

Value between_points(const Value& by_program, const Value& above, const std::optional<Vector>& x,
                     const Function& f, const Vector& v) {
  if (!std::isfinite(by_program.value) || !std::isfinite(above.value)) return by_program;
  const OneAtATime question(OneAtATime::Kind::lower_bound);
  if (!question.first() || !x || x->size() != v.size() || !x->allFinite()) return by_program;
  Vector inside = *x;
  Value at = f.evaluate(inside);
  // A slope that misses the domain by what the program left is as good there, to the square of the miss.
  if (!std::isfinite(at.value) || !std::isfinite(at.error)) {
    inside = point_of_domain(f, inside);
    if (inside.size() != v.size() || !inside.allFinite()) return by_program;
    at = f.evaluate(inside);
  }
  const Value along = product(v, inside);
  const double below = along.value - at.value, error = above.error + at.error + along.error;
  const double apart = std::abs(above.value - below);
  // What the program says of its error is an estimate: bounds that are not much farther apart are better.
  return apart + error < 2 * by_program.error ? Value{above.value, apart + error} : by_program;
}

}  // namespace convex::inline operations
