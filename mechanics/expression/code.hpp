#pragma once

#include <cstdint>
#include <vector>

#include "mechanics/expression/operation.hpp"
#include "mechanics/expression/source.hpp"

namespace mechanics::expression {

/// One step of an expression in postfix order, on a stack of nodes or, if `numeric`, on a stack of numbers
/// (indices, bounds of ranges and values of a state are numbers when the expression is expanded).
struct Instruction {
  enum class Step : std::uint8_t {
    literal,  ///< push `number`; `operand` is the length of its text
    pi,
    time,           ///< push
    index,          ///< push the index in slot `operand`
    parameter,      ///< push the parameter `operand`
    coordinate,     ///< pop `count` indices, push the member of the family `operand`; `number` is 3 where
                    ///< it has to be a vector, and have the members 1, 2, 3
    definition,     ///< likewise
    apply,          ///< pop the operands, push the result of `operation`
    construct,      ///< pop `number` arguments, push what the Construction `operand` makes of them
    table_file,     ///< pop, push the spline through the points of the file that the text here names
    differentiate,  ///< pop, push the total time derivative
    repeat,  ///< pop the bounds, run up to the matching `repeat_end`, `number` steps on, once per value of
             ///< the index in slot `operand`; `count` is 1 if the bounds do not depend on an enclosing sum
    repeat_end,  ///< add up; back to after the `repeat`
  };
  Step step = Step::literal;
  Operation operation = Operation::literal;
  bool numeric = false;
  std::uint8_t count = 0;  ///< of `apply` and `construct`: 1 within a branch of an if
  std::uint32_t operand = 0;
  std::uint32_t offset = 0;  ///< in the source
  double number = 0;
};

/// A parsed expression: no names, no nesting left. Its indices live in `slots`, the first those of its key.
struct Code {
  const Source* source = nullptr;
  std::vector<Instruction> steps;
  std::uint32_t slots = 0;
};

}  // namespace mechanics::expression
