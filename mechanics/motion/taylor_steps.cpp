#include "mechanics/motion/taylor_steps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"

namespace mechanics::inline motions {

using namespace expression;

namespace {

using Kind = TaylorStep::Kind;

/// Whole powers up to this one are products; others go by the recurrence a f' = e f a', which needs a ≠ 0.
constexpr double largest_product = 64;

class Translation {
 public:
  Translation(const Tape& tape, const Program& program, TaylorSteps& to)
      : tape_(tape), program_(program), to_(to), depends_(program.size()) {
    for (std::size_t i = 0; i < program.coordinates(); ++i) depends_[program.velocity(i)] = true;
    for (Slot slot = program.begin(); slot < program.size(); ++slot)
      if (const Operation operation = program[slot].operation; has_partner(operation))
        found_.emplace(std::pair(operation, program[slot].a), slot);
  }

  void translate(Slot slot) {
    if (is_written_.count(slot) > 0) return;
    const auto& [operation, active, a, b] = program_[slot];
    const std::size_t first = to_.steps.size();
    to_.uses_time = to_.uses_time || a == program_.time() || (arity(operation) == 2 && b == program_.time());
    const bool depends = depends_[a] || (arity(operation) == 2 && depends_[b]);
    write(operation, active, slot, a, b);
    depends_[slot] = depends;
    for (std::size_t k = first; depends && k < to_.steps.size(); ++k) {
      depends_[to_.steps[k].out] = true;
      to_.by_velocity.push_back(k);
    }
  }

 private:
  Slot extra() {
    depends_.push_back(false);
    return static_cast<Slot>(to_.series++);
  }
  Slot constant(double value) {
    const Slot slot = extra();
    to_.constants.emplace_back(slot, value);
    return slot;
  }
  void add(Kind kind, Slot out, Slot a, Slot b = 0, Slot partner = 0, double number = 0) {
    to_.steps.push_back({kind, out, a, b, partner, number});
  }
  Slot made(Kind kind, Slot a, Slot b = 0) {
    const Slot out = extra();
    add(kind, out, a, b);
    return out;
  }
  static bool has_partner(Operation operation) {
    return operation == Operation::sin || operation == Operation::cos || operation == Operation::sinh ||
           operation == Operation::cosh;
  }
  /// sin and cos of one argument are one step, wherever in the program the other is.
  void pair(Kind kind, Operation first, Operation second, Slot a) {
    const auto slot = [&](Operation operation) {
      const auto at = found_.find({operation, a});
      if (at == found_.end()) return extra();
      is_written_.insert(at->second);
      return at->second;
    };
    const Slot out = slot(first), partner = slot(second);
    add(kind, out, a, 0, partner);
  }
  double value(Slot slot) const { return tape_.constant(program_.node(slot)); }

  void add_switch(Kind kind, Slot out, Slot argument, Slot a, Slot b) {
    std::size_t k = 0;
    while (k < to_.switches.size() && to_.switches[k].argument != argument) ++k;
    if (k == to_.switches.size()) to_.switches.push_back({argument, program_.node(out)});
    add(kind, out, a, b, 0, static_cast<double>(k));
  }

  /// 1 + a² or (1 - a)(1 + a), which keeps its digits near 1.
  Slot one_and_square(Slot a, bool minus) {
    const Slot one = constant(1);
    if (!minus) return made(Kind::sum, one, made(Kind::square, a));
    return made(Kind::product, made(Kind::difference, one, a), made(Kind::sum, one, a));
  }

  void whole_power(Slot out, Slot a, double exponent) {
    Slot result = 0, square = a;
    bool is_first = true;
    for (auto left = static_cast<unsigned>(std::abs(exponent)); left > 0; left /= 2) {
      if (left % 2 == 1) {
        result = is_first ? square : made(Kind::product, result, square);
        is_first = false;
      }
      if (left > 1) square = made(Kind::square, square);
    }
    if (exponent < 0)
      add(Kind::quotient, out, constant(1), result);
    else
      add(Kind::sum, out, result, constant(0));
  }

  void power(Active active, Slot out, Slot a, Slot b) {
    if (active.b) {  // exp(b log a)
      Slot logarithm = 0;
      if (active.a)
        logarithm = made(Kind::logarithm, a);
      else
        logarithm = constant(std::log(value(a)));
      return add(Kind::exponential, out, made(Kind::product, b, logarithm));
    }
    const double exponent = value(b);
    if (exponent == 2) return add(Kind::square, out, a);
    if (exponent == 0.5) return add(Kind::root, out, a);
    if (exponent == 0) return add(Kind::sum, out, constant(1), constant(0));
    if (exponent == std::floor(exponent) && std::abs(exponent) <= largest_product)
      return whole_power(out, a, exponent);
    add(Kind::power, out, a, 0, 0, exponent);
  }

  void write(Operation operation, Active active, Slot out, Slot a, Slot b) {
    switch (operation) {
      case Operation::negate:
        return add(Kind::negative, out, a);
      case Operation::add:
        return add(Kind::sum, out, a, b);
      case Operation::subtract:
        return add(Kind::difference, out, a, b);
      case Operation::multiply:
        if (!active.a) return add(Kind::multiple, out, a, b, 0, value(a));
        if (!active.b) return add(Kind::multiple, out, b, a, 0, value(b));
        return a == b ? add(Kind::square, out, a) : add(Kind::product, out, a, b);
      case Operation::divide:
        if (!active.b) return add(Kind::share, out, a, 0, 0, value(b));
        return add(Kind::quotient, out, a, b);
      case Operation::power:
        return power(active, out, a, b);
      case Operation::sin:
      case Operation::cos:
        return pair(Kind::sine, Operation::sin, Operation::cos, a);
      case Operation::tan:
        return add(Kind::tangent, out, a, 0, extra());
      case Operation::asin:
        return add(Kind::arc, out, a, static_cast<Slot>(operation), made(Kind::root, one_and_square(a, true)),
                   1);
      case Operation::acos:
        return add(Kind::arc, out, a, static_cast<Slot>(operation), made(Kind::root, one_and_square(a, true)),
                   -1);
      case Operation::atan:
        return add(Kind::arc, out, a, static_cast<Slot>(operation), one_and_square(a, false), 1);
      case Operation::atan2:
        return add(Kind::angle, out, a, b, made(Kind::sum, made(Kind::square, a), made(Kind::square, b)));
      case Operation::sinh:
      case Operation::cosh:
        return pair(Kind::sinh, Operation::sinh, Operation::cosh, a);
      case Operation::tanh:
        return add(Kind::tanh, out, a, 0, extra());
      case Operation::exp:
        return add(Kind::exponential, out, a);
      case Operation::log:
        return add(Kind::logarithm, out, a);
      case Operation::sqrt:
        return add(Kind::root, out, a);
      case Operation::abs:
        return add_switch(Kind::absolute, out, a, a, 0);
      case Operation::sign:
        return add_switch(Kind::sign, out, a, a, 0);
      case Operation::where_not_negative:
        return add_switch(Kind::where_not_negative, out, a, 0, b);
      case Operation::where_negative:
        return add_switch(Kind::where_negative, out, a, 0, b);
      case Operation::max:
        return add_switch(Kind::either, out, made(Kind::difference, a, b), a, b);
      case Operation::min:
        return add_switch(Kind::either, out, made(Kind::difference, b, a), a, b);
      default:
        throw convex::InvalidInput(
            "\"" + std::string(symbol(operation)) +
            "\" has no Taylor series here, so that its motion cannot be followed; write the "
            "expressions without it");
    }
  }

  const Tape& tape_;
  const Program& program_;
  TaylorSteps& to_;
  std::vector<bool> depends_;                         // on velocities, by series
  std::map<std::pair<Operation, Slot>, Slot> found_;  // sin a, cos a, … in the program
  std::set<Slot> is_written_;                         // as the partner of another
};

bool is_function(Kind kind) {
  return kind == Kind::exponential || kind == Kind::sine || kind == Kind::sinh || kind == Kind::tangent ||
         kind == Kind::tanh;
}

/// Whether the highest coefficient of the result is linear in those of what depends on velocities, given the
/// lower ones. The text of T is checked for degree 2, so that p and df/dt have degree 1.
bool is_affine(Kind kind) {
  return kind == Kind::sum || kind == Kind::difference || kind == Kind::negative || kind == Kind::product ||
         kind == Kind::multiple || kind == Kind::square || kind == Kind::quotient || kind == Kind::share ||
         kind == Kind::where_not_negative || kind == Kind::where_negative;
}

}  // namespace

TaylorSteps::TaylorSteps(const Tape& tape, const Program& program)
    : series(program.size()), variables(program.time() + std::size_t{1}) {
  for (Slot slot = program.time() + 1; slot < program.begin(); ++slot)
    constants.emplace_back(slot, tape.constant(program.node(slot)));
  Translation translation(tape, program, *this);
  Slot slot = program.begin();
  for (std::size_t group = 0; group < program.groups(); ++group) {
    for (; slot < program.end(group); ++slot) translation.translate(slot);
    for (const Slot root : program.roots(group)) uses_time = uses_time || root == program.time();
    ends.push_back(steps.size());
    if (group > 0) continue;
    for (const std::size_t k : by_velocity)
      convex::invariant(is_affine(steps[k].kind), "momenta are of degree 1 in the velocities");
  }
  while (!by_velocity.empty() && by_velocity.back() >= ends[0]) by_velocity.pop_back();
  for (std::size_t k = 0; k < (ends.size() > 1 ? ends[1] : ends[0]); ++k) {
    const FunctionArgument one{steps[k].kind, steps[k].a};
    const auto is_same = [&](const FunctionArgument& other) {
      return other.of == one.of && other.argument == one.argument;
    };
    if (is_function(one.of) && std::none_of(arguments.begin(), arguments.end(), is_same))
      arguments.push_back(one);
  }
}

}  // namespace mechanics::inline motions
