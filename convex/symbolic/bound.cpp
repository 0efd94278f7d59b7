#include <cmath>

#include "convex/invalid_input.hpp"
#include "convex/symbolic/term.hpp"

namespace convex::symbolic {

Bound::Bound(Term value) : term_(std::move(value)) {
  if (term_.kind == Term::Kind::number) surd_ = term_.number;
}

Bound Bound::less(const Fraction& b) const { return surd_ ? Bound(*surd_ - b) : Bound(term_ - number(b)); }

Bound Bound::over(const Fraction& b) const {
  return surd_ ? Bound(*surd_ / b) : Bound((Fraction{1, 1} / b) * term_);
}

bool Bound::equals(const Bound& other) const {
  if (surd_ && other.surd_) return *surd_ == *other.surd_;
  return text(*this) == text(other);
}

bool Bound::is_below(const Bound& other) const {
  if (surd_ && other.surd_) return *surd_ < *other.surd_;
  if (equals(other)) return false;
  const double x = nearest_double(*this), y = nearest_double(other);
  // A thousand roundings of the formulas.
  constexpr double told_apart = 0x1p-42;
  if (!(std::abs(x - y) > told_apart * (1 + std::abs(x) + std::abs(y))))
    throw InvalidInput("the ends " + text(*this) + " and " + text(other) +
                       " of two cases are not told apart in symbols; leave --symbolic out");
  return x < y;
}

double nearest_double(const Bound& a) {
  return a.surd() ? nearest_double(*a.surd()) : evaluate(a.term(), "", 0);
}

std::string text(const Bound& a) { return a.surd() ? text(*a.surd()) : text(a.term()); }
std::string latex(const Bound& a) { return a.surd() ? latex(*a.surd()) : latex(a.term()); }

Fraction rational(const Bound& a) {
  if (!a.surd()) throw InvalidInput("the number " + text(a) + " is no fraction, and a rule wants one here");
  return rational(*a.surd());
}
std::optional<Fraction> rational(const std::optional<Bound>& a) {
  return a ? std::optional(rational(*a)) : std::nullopt;
}

Cases restricted(const Cases& cases, const std::optional<Bound>& low, const std::optional<Bound>& high) {
  Cases kept;
  for (Case one : cases) {
    if (low && (!one.low || *one.low < *low)) {
      one.low = low;
      one.has_low = true;
    }
    if (high && (!one.high || *high < *one.high)) {
      one.high = high;
      one.has_high = true;
    }
    if (one.low && one.high) {
      if (*one.high < *one.low) continue;
      if (*one.high == *one.low && !(one.has_low && one.has_high)) continue;
    }
    kept.push_back(std::move(one));
  }
  return kept;
}

}  // namespace convex::symbolic
