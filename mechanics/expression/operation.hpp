#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  min,
  max,                 // at a tie, the first
  where_not_negative,  // b where a >= 0, else 0: what if(…), step and sign(x) are written out into
  where_negative,      // b where a < 0, else 0
};

/// Whether an operation takes one of two branches by the sign of a number.
inline bool is_branch(Operation operation) { return operation >= Operation::min; }
/// Whether it takes its second operand, or 0, by the sign of its first.
inline bool is_where(Operation operation) { return operation >= Operation::where_not_negative; }

/// Number of operands: 0, 1 or 2.
int arity(Operation operation);

/// "sin", "+", …
std::string_view symbol(Operation operation);

/// The function with this name, if there is one.
std::optional<Operation> function_named(std::string_view name);

/// The names of all functions.
std::vector<std::string> function_names();

/// Which operands vary; the partials with respect to the others are not computed and are 0.
struct Active {
  bool a = true, b = true;
};

/// First partial derivatives of an operation in its operands a and b.
template <class Real>
struct PartialsOf {
  Real a = 0, b = 0;
};

/// Second partial derivatives.
template <class Real>
struct SecondPartialsOf {
  Real aa = 0, ab = 0, bb = 0;
};

using Partials = PartialsOf<double>;
using SecondPartials = SecondPartialsOf<double>;

// For doubles, and for doubles with radii (`Rounded`).

/// The value of an operation; a unary one ignores b. NaN or infinite where it is undefined.
template <class Real>
Real value(Operation operation, Real a, Real b);

/// Its derivatives at (a, b), where it has the value `f`; NaN or infinite where they do not exist.
template <class Real>
PartialsOf<Real> partials(Operation operation, Real a, Real b, Real f, Active active);
template <class Real>
SecondPartialsOf<Real> second_partials(Operation operation, Real a, Real b, Real f, Active active);

}  // namespace mechanics::expression
