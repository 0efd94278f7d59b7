#include <algorithm>
#include <cmath>

#include "convex/invalid_input.hpp"
#include "convex/symbolic/function.hpp"

namespace convex::symbolic {
namespace {

/// The formula of f inside of its domain, its derivative, and the ends of the domain.
struct SmoothRule {
  Term value, slope;
  std::optional<Bound> low, high;

  Term value_at(const Surd& b) const { return substituted(value, "x", number(b)); }
  /// None where it is infinite, at an end of the domain.
  std::optional<Term> slope_at(const Surd& b) const {
    Term there = substituted(slope, "x", number(b));
    return std::isfinite(evaluate(there, "", 0)) ? std::optional(std::move(there)) : std::nullopt;
  }
};

SmoothRule smooth_rule(const RuleFunction& f) {
  const Case* inside = nullptr;
  for (const Case& one : f.f) {
    if (one.low && one.high && *one.low == *one.high) continue;
    if (inside != nullptr)
      throw InvalidInput("sum: the part by rules has several formulas, and pieces are added to one alone");
    inside = &one;
  }
  if (inside == nullptr)
    throw InvalidInput("sum: the part by rules has no formula in elementary terms, and pieces need one");
  const auto slope = derivative(inside->term, "x");
  if (!slope)
    throw InvalidInput("sum: the derivative of " + text(inside->term) +
                       " has no formula in elementary terms, and pieces need one");
  return {inside->term, *slope, inside->low, inside->high};
}

/// A piece of p inside of the domain of f, with f added.
struct SummedPiece {
  ExactPiece p;
  RuleFunction whole;               ///< f and the quadratic
  std::optional<Term> left, right;  ///< slopes of the sum at the piece's ends; none: it goes on to infinity
};

/// A corner of the sum, or an end of its domain where its slope is finite.
struct SummedCorner {
  Surd at;
  std::optional<Term> before, after;  ///< slopes of the sum; none: infinite
  Term value;
};

struct SummedPieces {
  std::vector<SummedPiece> pieces;
  std::optional<SummedCorner> start;  ///< the left end of the domain
  std::vector<SummedCorner> ends;     ///< the right end of each piece, where it is not at infinity
};

Term slope_of(const ExactPiece& p, const Surd& b) { return number(p.c2 * b + p.c1); }
Term value_of(const ExactPiece& p, const Surd& b) {
  return number(Surd{Fraction{1, 2}} * p.c2 * b * b + p.c1 * b + p.c0);
}

SummedPieces summed(const RuleFunction& f, const ExactCurve& curve) {
  const SmoothRule rule = smooth_rule(f);
  SummedPieces made;
  for (const ExactPiece& p : pieces(curve)) {
    const bool is_left = rule.low && p.high && !(*rule.low < Bound(*p.high)),
               is_right = rule.high && p.low && !(Bound(*p.low) < *rule.high);
    if (is_left || is_right) continue;
    SummedPiece piece{p, with_quadratic(f, rational(p.c2), rational(p.c1), rational(p.c0)), {}, {}};
    const bool starts = p.low && !(rule.low && Bound(*p.low) < *rule.low),
               stops = p.high && !(rule.high && *rule.high < Bound(*p.high));
    if (starts)
      if (const auto slope = rule.slope_at(*p.low)) piece.left = *slope + slope_of(p, *p.low);
    if (stops)
      if (const auto slope = rule.slope_at(*p.high)) piece.right = *slope + slope_of(p, *p.high);
    if (made.pieces.empty() && piece.left)
      made.start = SummedCorner{*p.low, {}, piece.left, rule.value_at(*p.low) + value_of(p, *p.low)};
    if (!made.pieces.empty()) made.ends.back().after = piece.left;
    if (piece.right)
      made.ends.push_back({*p.high, piece.right, {}, rule.value_at(*p.high) + value_of(p, *p.high)});
    made.pieces.push_back(std::move(piece));
  }
  if (made.pieces.empty())
    throw InvalidInput("sum: the domains of its parts do not meet in an interval; give others");
  return made;
}

/// The cases of each piece between what its ends lead to, and those of the corners between them.
template <class OfPiece, class OfCorner, class Led>
Cases by_pieces(const SummedPieces& sum, const OfPiece& of_piece, const OfCorner& of_corner, const Led& led) {
  Cases all;
  const auto bound = [&](const Surd& at, const std::optional<Term>& slope) {
    return slope ? std::optional(Bound(led(at, *slope))) : std::nullopt;
  };
  const auto add_corner = [&](const SummedCorner& corner) {
    const auto low = bound(corner.at, corner.before), high = bound(corner.at, corner.after);
    if (low && high && *low == *high) return;  // it is smooth there
    all.push_back({low, high, true, true, of_corner(corner)});
  };
  if (sum.start) add_corner(*sum.start);
  for (std::size_t k = 0; k < sum.pieces.size(); ++k) {
    const SummedPiece& piece = sum.pieces[k];
    const auto low = piece.left ? bound(*piece.p.low, piece.left) : std::nullopt,
               high = piece.right ? bound(*piece.p.high, piece.right) : std::nullopt;
    const Cases cases = restricted(of_piece(piece), low, high);
    all.insert(all.end(), cases.begin(), cases.end());
    if (k < sum.ends.size()) add_corner(sum.ends[k]);
  }
  return all;
}

}  // namespace

RuleFunction sum_with_pieces(const RuleFunction& f, const ExactCurve& p) {
  const std::vector<ExactPiece> all = pieces(p);
  if (all.size() == 1 && all.front().low && all.front().high && *all.front().low == *all.front().high) {
    // The indicator of a point: f counts there alone.
    const Surd at = *all.front().low;
    const double near = evaluate(f.f, "x", nearest_double(at));
    if (!std::isfinite(near)) throw InvalidInput("sum: the domains of its parts do not meet; give others");
    const auto there = std::find_if(f.f.begin(), f.f.end(), [&](const Case& one) {
      return (!one.low || !(Bound(at) < *one.low)) && (!one.high || !(*one.high < Bound(at)));
    });
    const Term value = substituted(there->term, "x", number(at)) + value_of(all.front(), at);
    const Case everywhere{std::nullopt, std::nullopt, true, true, number(at) * variable("y") - value};
    return {{{at, at, true, true, value}},
            {everywhere},
            [at](const Fraction&) {
              return Cases{{std::nullopt, std::nullopt, true, true, number(at)}};
            },
            {}};
  }
  const auto sum = std::make_shared<const SummedPieces>(summed(f, p));
  RuleFunction made;
  for (const SummedPiece& piece : sum->pieces) {
    // An end that two pieces share is told by the first of them.
    Cases cases = restricted(piece.whole.f, piece.p.low, piece.p.high);
    made.f.insert(made.f.end(), cases.begin(), cases.end());
  }
  made.prox = [sum](const Fraction& gamma) {
    return by_pieces(
        *sum, [&](const SummedPiece& piece) { return piece.whole.prox(gamma); },
        [](const SummedCorner& corner) { return number(corner.at); },
        [&](const Surd& at, const Term& slope) { return number(at) + gamma * slope; });
  };
  const bool has_conjugates = std::none_of(sum->pieces.begin(), sum->pieces.end(),
                                           [](const auto& piece) { return piece.whole.conjugate.empty(); });
  if (has_conjugates)
    made.conjugate = by_pieces(
        *sum, [](const SummedPiece& piece) { return piece.whole.conjugate; },
        [](const SummedCorner& corner) { return number(corner.at) * variable("y") - corner.value; },
        [](const Surd&, const Term& slope) { return slope; });
  made.parts = std::make_shared<const RuleAndPieces>(RuleAndPieces{f, p});
  return made;
}

}  // namespace convex::symbolic
