#include "convex/exact/ball.hpp"

#include <doctest/doctest.h>

#include "convex/exact/fraction_arithmetic.hpp"

using convex::Ball;
using convex::BallFunction;
using convex::Fraction;

namespace {

constexpr long bits = 128;

bool contains(const Ball& ball, const Fraction& x) {
  const Fraction distance = ball.midpoint() - x;
  const Fraction size = convex::sign(distance) < 0 ? -distance : distance;
  return !(convex::fraction(ball.radius()) < size);
}

}  // namespace

TEST_CASE("a ball contains the fraction it was made of and, however it is computed, what comes of it") {
  REQUIRE(Ball::why_none().empty());
  const Fraction third{1, 3}, x{-22, 7};
  const Ball a = Ball::of(third, bits), b = Ball::of(x, bits);
  CHECK(contains(a, third));
  CHECK(a.radius() > 0);
  CHECK(a.radius() < 1e-35);
  CHECK(contains(Ball::apply(BallFunction::add, a, b), third + x));
  CHECK(contains(Ball::apply(BallFunction::divide, a, b), third / x));
  // exp(log 1/3), sin²+cos², tan(atan x), sqrt² lead back.
  CHECK(contains(Ball::apply(BallFunction::exp, Ball::apply(BallFunction::log, a)), third));
  CHECK(contains(Ball::apply(BallFunction::tan, Ball::apply(BallFunction::atan, b)), x));
  const Ball s = Ball::apply(BallFunction::sin, b), c = Ball::apply(BallFunction::cos, b);
  const Ball one = Ball::apply(BallFunction::add, Ball::apply(BallFunction::multiply, s, s),
                               Ball::apply(BallFunction::multiply, c, c));
  CHECK(contains(one, {1, 1}));
  CHECK(one.sign() == 1);
}

TEST_CASE("dyadic numbers are balls of radius 0, and a ball about 0 has no sign") {
  const Ball half = Ball::of({3, 2}, bits);
  CHECK(half.radius() == 0);
  CHECK(half.midpoint() == Fraction{3, 2});
  const Ball third = Ball::of({1, 3}, bits);
  CHECK(Ball::apply(BallFunction::subtract, third, third).sign() == 0);
  CHECK(Ball::apply(BallFunction::negate, half).sign() == -1);
}

TEST_CASE("what is not defined is not finite") {
  const Ball zero = Ball::of({0, 1}, bits), two = Ball::of({2, 1}, bits);
  CHECK_FALSE(Ball::apply(BallFunction::log, zero).is_finite());
  CHECK_FALSE(Ball::apply(BallFunction::asin, two).is_finite());
  CHECK_FALSE(Ball::apply(BallFunction::divide, two, zero).is_finite());
  CHECK(Ball::apply(BallFunction::divide, zero, two).is_finite());
}

TEST_CASE("decimals are rounded to the digits asked for") {
  CHECK(convex::decimal_text({-1, 8}, 3) == "-1.25e-1");
  CHECK(convex::decimal_text({2, 3}, 4) == "6.667e-1");
  CHECK(convex::decimal_text({1999999, 1}, 3) == "2e6");
  CHECK(convex::decimal_text({7, 1}, 30) == "7");
}
