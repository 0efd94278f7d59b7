#pragma once

namespace convex::inline ball_module {

/// What is computed with balls.
enum class BallFunction : int {
  negate,
  add,
  subtract,
  multiply,
  divide,
  power,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  sinh,
  cosh,
  tanh,
  exp,
  log,
  sqrt,
  pi
};

/// Arithmetic of balls as a table of functions, which a module of its own holds (convex/exact/ball.hpp).
struct BallOperations {
  void* (*make)();
  void (*release)(void* ball);
  /// p / q with p and q in decimal digits.
  void (*set_fraction)(void* ball, const char* p, const char* q, long precision);
  /// A function of one operand ignores b, pi ignores both.
  void (*apply)(void* result, int function, const void* a, const void* b, long precision);
  /// 1 or -1: all numbers of the ball are positive, negative; 0: neither is known.
  int (*sign)(const void* ball);
  /// 0 also where an exponent is beyond all use.
  int (*is_finite)(const void* ball);
  /// The midpoint as m 2^exponent, m in decimal digits, to be given to free(). Of a finite ball.
  char* (*midpoint)(const void* ball, long* exponent);
  /// The least double that is surely not below the radius, or a little more.
  double (*radius)(const void* ball);
};

}  // namespace convex::inline ball_module
