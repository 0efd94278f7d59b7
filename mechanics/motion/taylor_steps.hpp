#pragma once

#include <vector>

#include "mechanics/expression/program.hpp"

namespace mechanics::inline motions {

/// One recurrence of Taylor arithmetic: coefficient k of series `out` (and `partner`) from coefficients up
/// to k of `a` and `b` and up to k - 1 of its own.
struct TaylorStep {
  enum class Kind : std::uint8_t {
    sum,
    difference,
    negative,
    product,
    multiple,  ///< number * b
    square,
    quotient,  ///< a / b
    share,     ///< a / number
    root,      ///< sqrt a
    exponential,
    logarithm,
    sine,     ///< out = sin a, partner = cos a
    sinh,     ///< out = sinh a, partner = cosh a
    tangent,  ///< out = tan a, partner = 1 + tan² a
    tanh,     ///< out = tanh a, partner = 1 - tanh² a
    arc,      ///< out' partner = number * a', with the value of the function that `b` names: asin, acos, atan
    angle,    ///< out = atan2(a, b), partner = a² + b²
    power,    ///< a^number, a not 0
    absolute,  ///< |a|, the sign of a known
    sign,
    where_not_negative,  ///< b on the branch 1 of a switch, else 0
    where_negative,      ///< b on the branch -1, else 0
    either,              ///< a on the branch 1, b on the other
  };
  Kind kind;
  expression::Slot out, a, b, partner;
  double number = 0;  ///< of what has branches: which switch
};

/// Whether it is a root or a power of something, whose derivatives are not finite where that is 0.
inline bool takes_base(const TaylorStep& step) {
  return step.kind == TaylorStep::Kind::root || step.kind == TaylorStep::Kind::power;
}

/// Whether the partner is a result, too.
inline bool has_partner(const TaylorStep& step) {
  using enum TaylorStep::Kind;
  return step.kind == sine || step.kind == sinh || step.kind == tangent || step.kind == tanh;
}

/// An argument whose sign chooses a branch of an expression, such as x in |x| or x - y in max(x, y).
struct Switch {
  expression::Slot argument;
  expression::NodeId node;  ///< the |x|, max(x, y), …, for messages
};

/// What exp, sin, cos, sinh, cosh, tan or tanh is taken of.
struct FunctionArgument {
  TaylorStep::Kind of;
  expression::Slot argument;
};

/// A program translated into recurrences. Its slots are series 0, 1, …; what the recurrences need in
/// addition comes after them.
struct TaylorSteps {
  TaylorSteps(const expression::Tape& tape, const expression::Program& program);

  std::vector<TaylorStep> steps;
  std::vector<std::size_t> ends;  ///< by group of the program, in `steps`
  std::vector<Switch> switches;
  std::vector<FunctionArgument> arguments;  ///< in the groups 0 and 1, each once
  std::size_t series = 0, variables = 0;    ///< the variables come first: q, v, t
  bool uses_time = false;
  std::vector<std::pair<expression::Slot, double>> constants;  ///< series that do not vary
  /// The steps of group 0 whose result depends on velocities: they are linear in those of highest order.
  std::vector<std::size_t> by_velocity;
};

}  // namespace mechanics::inline motions
