#include <cmath>

#include "mechanics/expression/number.hpp"

namespace mechanics::expression {

using convex::Ball;
using convex::BallFunction;

std::optional<double> Number::telling_precision() const {
  if (is_exact() || !algebraic_ || !algebraic_->number) return std::nullopt;
  // What is left of the digits after sums that cancel is told by the ball itself.
  constexpr double spare = 256;
  return algebraic_->number->separation() + algebraic_->number->u + spare;
}

std::optional<int> Number::sign() const {
  if (is_exact()) return convex::sign(fraction_);
  const int known = ball_->sign();
  if (known != 0) return known;
  const auto telling = telling_precision();
  if (!telling || !(*telling <= static_cast<double>(ball_->precision()))) return std::nullopt;
  const auto bits = static_cast<unsigned long>(std::ceil(algebraic_->number->separation())) + 1;
  const Ball least = Ball::of({1, convex::Integer::shifted(1, bits)}, ball_->precision());
  const bool below = Ball::apply(BallFunction::subtract, *ball_, least).sign() < 0;
  const bool above = Ball::apply(BallFunction::add, *ball_, least).sign() > 0;
  return below && above ? std::optional<int>(0) : std::nullopt;
}

}  // namespace mechanics::expression
