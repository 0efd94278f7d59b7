#pragma once

#include <memory>
#include <optional>
#include <string>

#include "convex/exact/ball.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "mechanics/expression/operation.hpp"
#include "mechanics/expression/symbolic_form.hpp"
#include "mechanics/expression/zero_bound.hpp"

namespace mechanics::expression {

using convex::Ball;
using convex::Fraction;

/// A number of a text: a fraction where it is one, else a ball that contains it, with the name of what it is.
/// What is computed from fractions alone is a fraction wherever the result is known to be one.
class Number {
 public:
  Number() = default;
  Number(Fraction value) : fraction_(std::move(value)) {}  // NOLINT: a fraction is one
  Number(std::int64_t value) : fraction_{value, 1} {}      // NOLINT
  /// The number of this ball, which `form` names where it is known: a fraction when the form is one.
  /// `algebraic`: what is known of it as an algebraic number, or null.
  Number(Ball ball, const std::optional<SymbolicForm>& form, KnownAlgebraic algebraic);

  bool is_exact() const { return !ball_; }
  /// Known to be 0; a ball about 0 is not.
  bool is_zero() const { return is_exact() && convex::sign(fraction_) == 0; }
  bool is_finite() const { return is_exact() || ball_->is_finite(); }
  /// The sign where it is known, else none. An algebraic number is 0 when its ball is nearer to 0 than any
  /// other such number can be.
  std::optional<int> sign() const;
  /// Balls of so many bits tell the sign, where the number is algebraic.
  std::optional<double> telling_precision() const;

  /// The fraction itself, or the midpoint of the ball.
  Fraction middle() const { return is_exact() ? fraction_ : ball_->midpoint(); }
  /// What the number is, where that is known and short.
  std::optional<SymbolicForm> form() const;
  std::optional<std::string> name() const;
  KnownAlgebraic algebraic() const;
  /// The same number without its form and what is algebraic of it, whose arithmetic is quicker.
  Number unnamed() const;

  /// At least the distance of the number from its middle.
  double radius() const { return is_exact() ? 0 : ball_->radius(); }

  const Fraction& fraction() const { return fraction_; }
  /// As a ball, of this precision when it is a fraction.
  Ball ball(long precision) const { return ball_ ? *ball_ : Ball::of(fraction_, precision); }

  friend Number operator-(const Number& a);
  friend Number operator+(const Number& a, const Number& b);
  friend Number operator-(const Number& a, const Number& b);
  friend Number operator*(const Number& a, const Number& b);
  /// Not finite when b may be 0; b is not known to be.
  friend Number operator/(const Number& a, const Number& b);

 private:
  Fraction fraction_;
  std::optional<Ball> ball_;
  std::shared_ptr<const SymbolicForm> form_;  ///< of a ball, or null
  KnownAlgebraic algebraic_;                  ///< of a ball, or null
};

/// A function at (a, b) with its partial derivatives.
struct NumberPartials {
  Number f, a, b, aa, ab, bb;
  bool is_finite() const;
};

/// `precision`: of balls made from fractions, in bits; 0: fractions alone. A unary operation ignores b. None
/// where the value or a derivative does not exist, may not exist for all that the balls tell, or is no
/// fraction although it should.
std::optional<NumberPartials> number_partials(Operation operation, const Number& a, const Number& b,
                                              bool b_is_constant, long precision);

}  // namespace mechanics::expression
