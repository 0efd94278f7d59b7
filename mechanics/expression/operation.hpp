#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace mechanics::expression {

/// What a node of an expression is.
enum class Operation : std::uint8_t {
  literal,
  pi,
  parameter,  // constants; a parameter stands for the node that gives its value
  coordinate,
  velocity,
  time,  // variables
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
  abs,
  sign,  // the derivative of abs, undefined at 0; nobody writes it
};

/// Number of operands: 0, 1 or 2.
int arity(Operation operation);

/// "sin", "+", …
std::string_view symbol(Operation operation);

/// The function with this name, if there is one.
std::optional<Operation> function_named(std::string_view name);

/// Which operands vary; the partials with respect to the others are not computed and are 0.
struct Active {
  bool a = true, b = true;
};

/// First partial derivatives of an operation in its operands a and b.
struct Partials {
  double a = 0, b = 0;
};

/// Second partial derivatives.
struct SecondPartials {
  double aa = 0, ab = 0, bb = 0;
};

/// The value of an operation; a unary one ignores b. NaN or infinite where it is undefined.
double value(Operation operation, double a, double b);

/// Its derivatives at (a, b), where it has the value `f`; NaN or infinite where they do not exist.
Partials partials(Operation operation, double a, double b, double f, Active active);
SecondPartials second_partials(Operation operation, double a, double b, double f, Active active);

}  // namespace mechanics::expression
