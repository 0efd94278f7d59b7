#include "mechanics/liquid/field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "convex/interval_arithmetic.hpp"
#include "mechanics/expression/rounded_nodes.hpp"

namespace mechanics::liquid {

namespace {

expression::Range around(expression::Rounded number) {
  if (number.is_exact()) return {number.value, number.value};
  return {convex::moved_down(number.value - number.radius), convex::moved_up(number.value + number.radius)};
}

/// An operation by which a derivative of what is continuous may jump.
bool is_choice(expression::Operation operation) {
  return expression::is_where(operation) || operation == expression::Operation::sign;
}

}  // namespace

Region region(const Ray& from, expression::Range r) {
  return {expression::value(expression::Operation::add, around(from[0]), r), around(from[1]),
          around(from[2])};
}

std::string point_text(const std::vector<std::string>& names, const Point& x) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%.6g", x[i]);
    text += (i == 0 ? "(" : ", ") + names[i] + " = " + number;
  }
  return text + ")";
}

Field::Field(const expression::Tape& tape, expression::NodeId node, std::vector<std::string> coordinates,
             std::string what, convex::Place place)
    : coordinates_(std::move(coordinates)),
      what_(std::move(what)),
      place_(place),
      is_constant_(tape.is_constant(node)) {
  if (coordinates_.size() > 1)
    form_ = std::make_shared<const CoordinateForm>(tape, node, coordinates_.size());
  for (expression::NodeId k = 0; k <= node && !is_constant_; ++k)
    may_jump_ = may_jump_ || expression::is_where(tape.operation(k));
  const std::vector<expression::Rounded> numbers = expression::rounded_nodes(tape);
  if (is_constant_) {
    constant_ = numbers[node];
    return;
  }
  program_ = expression::Program(tape, coordinates_.size(), {{node}});
  for (expression::Slot slot = program_.time() + 1; slot < program_.begin(); ++slot)
    constants_.push_back(numbers[program_.node(slot)]);
  for (expression::Slot slot = program_.begin(); slot < program_.end(0); ++slot)
    has_branches_ = has_branches_ || is_choice(program_[slot].operation);
}

std::uint64_t Field::branches(const Point& x) const {
  const auto n = static_cast<Index>(coordinates_.size());
  bool is_finite = true;
  const expression::Values values =
      program_.values({0, Vector::Map(x.data(), n), Vector::Zero(n)}, 0, is_finite);
  std::uint64_t mixed = 0;
  constexpr std::uint64_t factor = 0x9E3779B97F4A7C15;  // the golden ratio's bits
  for (expression::Slot slot = program_.begin(); slot < program_.end(0); ++slot)
    if (is_choice(program_[slot].operation))
      mixed = (mixed ^ (values[program_[slot].a] < 0 ? 1U : 2U)) * factor;
  return mixed;
}

expression::TimeSeries Field::along(const Ray& from, expression::Rounded r, int order) const {
  using expression::Operation, expression::Slot, expression::TimeSeries;
  if (is_constant_) return TimeSeries(constant_);
  std::vector<TimeSeries> x(program_.size());
  for (std::size_t i = 0; i < coordinates_.size(); ++i) x[i] = TimeSeries(i == 0 ? from[0] + r : from[i]);
  x[0].c[1] = 1;
  const Slot first = program_.time() + 1;
  for (Slot slot = first; slot < program_.begin(); ++slot) x[slot] = TimeSeries(constants_[slot - first]);
  for (Slot slot = program_.begin(); slot < program_.end(0); ++slot) {
    const expression::Program::Instruction& i = program_[slot];
    const bool is_kink =
        (i.operation == Operation::abs || i.operation == Operation::sign) && x[i.a].c[0].is_undecided();
    if (is_kink)
      x[slot].c.fill(std::numeric_limits<double>::quiet_NaN());
    else
      x[slot] = expression::applied(i.operation, x[i.a], x[i.b], !i.active.b, order);
  }
  return x[program_.roots(0).front()];
}

expression::Range Field::range(const Region& at) const {
  using expression::Range, expression::Slot;
  if (is_constant_) return around(constant_);
  std::vector<Range> x(program_.size());
  std::copy_n(at.begin(), coordinates_.size(), x.begin());
  const Slot first = program_.time() + 1;
  for (Slot slot = first; slot < program_.begin(); ++slot) x[slot] = around(constants_[slot - first]);
  for (Slot slot = program_.begin(); slot < program_.end(0); ++slot)
    x[slot] = expression::value(program_[slot].operation, x[program_[slot].a], x[program_[slot].b]);
  return x[program_.roots(0).front()];
}

double Field::raw(const Point& x) const {
  if (is_constant_) return constant_.value;
  const auto n = static_cast<Index>(coordinates_.size());
  State state{0, Vector::Map(x.data(), n), Vector::Zero(n)};
  bool is_finite = true;
  const expression::Values values = program_.values(state, 0, is_finite);
  return values[program_.roots(0).front()];
}

double Field::operator()(const Point& x) const {
  const double value = raw(x);
  if (!std::isfinite(value))
    throw convex::InvalidInput(what_ + ": not a finite number at " + point_text(coordinates_, x) +
                                   "; give an expression that is finite where the liquid is",
                               place_);
  return value;
}

}  // namespace mechanics::liquid
