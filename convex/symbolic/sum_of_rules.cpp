#include <algorithm>

#include "convex/invalid_input.hpp"
#include "convex/symbolic/function.hpp"

namespace convex::symbolic {
namespace {

const Term summed_u = variable("u");

/// Where both are finite.
Cases added(const Cases& f, const Cases& g) {
  Cases sum;
  for (const Case& a : f)
    for (const Case& b : g) {
      Case both = a;
      if (b.low && (!both.low || *both.low < *b.low || (*both.low == *b.low && !b.has_low))) {
        both.low = b.low;
        both.has_low = b.has_low;
      }
      if (b.high && (!both.high || *b.high < *both.high || (*both.high == *b.high && !b.has_high))) {
        both.high = b.high;
        both.has_high = b.has_high;
      }
      const bool is_empty =
          both.low && both.high &&
          (*both.high < *both.low || (*both.high == *both.low && !(both.has_low && both.has_high)));
      if (is_empty) continue;
      // At a point its own case tells, once.
      const bool is_point = both.low && both.high && *both.low == *both.high;
      both.term =
          is_point ? substituted(a.term, "x", both.low->term()) + substituted(b.term, "x", both.low->term())
                   : a.term + b.term;
      const bool is_told =
          is_point && std::any_of(sum.begin(), sum.end(), [&](const Case& other) {
            return other.low && other.high && *other.low == *both.low && *other.high == *both.low;
          });
      if (!is_told) sum.push_back(std::move(both));
    }
  std::sort(sum.begin(), sum.end(), [](const Case& a, const Case& b) {
    if (!a.low || !b.low) return !a.low && b.low;
    if (!(*a.low == *b.low)) return *a.low < *b.low;
    return a.high && (!b.high || *a.high < *b.high);
  });
  return sum;
}

/// The one formula inside of the domain; none where there are several, or none.
const Case* inside(const Cases& cases) {
  const Case* found = nullptr;
  for (const Case& one : cases) {
    if (one.low && one.high && *one.low == *one.high) continue;
    if (found != nullptr) return nullptr;
    found = &one;
  }
  return found;
}

bool is_everywhere(const Cases& cases) { return !cases.empty() && !cases.front().low && !cases.back().high; }

}  // namespace

RuleFunction sum_of_rules(const RuleFunction& f, const RuleFunction& g) {
  RuleFunction made;
  made.f = added(f.f, g.f);
  const Case* const one = inside(made.f);
  const auto slope = one == nullptr ? std::nullopt : derivative(one->term, "x");
  if (!slope)
    throw InvalidInput(
        "sum: these two functions have no formula whose derivative is known in symbols; without --symbolic "
        "it is "
        "computed in numbers");
  if (one->high)
    throw InvalidInput(
        "sum: the domain is bounded above, and roots are told from below alone; dilate it by -1, or leave "
        "--symbolic out");
  const Term rising = substituted(*slope, "x", summed_u);
  made.prox = [rising, low = rational(one->low)](const Fraction& gamma) {
    return Cases{
        {std::nullopt, std::nullopt, true, true, root(summed_u + gamma * rising, variable("z"), low)}};
  };
  if (is_everywhere(f.conjugate) || is_everywhere(g.conjugate)) {
    const Term y = variable("y"), at = root(rising, y, rational(one->low));
    made.conjugate = {{std::nullopt, std::nullopt, true, true, y * at - substituted(one->term, "x", at)}};
  }
  return made;
}

}  // namespace convex::symbolic
