#include "mechanics/liquid/field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "convex/infinity.hpp"
#include "convex/interval_arithmetic.hpp"
#include "mechanics/expression/rounded_nodes.hpp"

namespace mechanics::liquid {

expression::Range range_of(expression::Rounded number) {
  if (number.is_exact()) return {number.value, number.value};
  return {convex::moved_down(number.value - number.radius), convex::moved_up(number.value + number.radius)};
}

namespace {

/// An operation by which a derivative of what is continuous may jump.
bool is_choice(expression::Operation operation) {
  return expression::is_where(operation) || operation == expression::Operation::sign;
}

/// Of the constants of a tape all that they may be. (Balls follow the branches of their centres.)
std::vector<expression::Range> constant_ranges(const expression::Tape& tape,
                                               const std::vector<expression::Rounded>& numbers) {
  using expression::Operation;
  std::vector<expression::Range> ranges(tape.size());
  for (expression::NodeId node = 0; node < tape.size(); ++node) {
    if (!tape.is_constant(node)) continue;
    const Operation operation = tape.operation(node);
    if (operation == Operation::literal || operation == Operation::pi)
      ranges[node] = range_of(numbers[node]);
    else if (operation == Operation::parameter)
      ranges[node] = ranges[tape.a(node)];
    else
      ranges[node] = expression::value(operation, ranges[tape.a(node)], ranges[tape.b(node)]);
  }
  return ranges;
}

}  // namespace

double end_of(expression::Range range, Bound bound) {
  if (range.is_empty()) return std::numeric_limits<double>::quiet_NaN();
  return bound == Bound::lower ? range.low : range.high;
}

Field Field::bounded(Bound bound) const {
  Field made = *this;
  made.bound_ = bound;
  return made;
}

Region region(const Ray& from, expression::Range r) {
  return {expression::value(expression::Operation::add, range_of(from[0]), r), range_of(from[1]),
          range_of(from[2])};
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
  const std::vector<expression::Range> ranges = constant_ranges(tape, numbers);
  if (is_constant_) {
    constant_ = numbers[node];
    constant_range_ = ranges[node];
    return;
  }
  program_ = expression::Program(tape, coordinates_.size(), {{node}});
  for (expression::Slot slot = program_.time() + 1; slot < program_.begin(); ++slot) {
    constants_.push_back(numbers[program_.node(slot)]);
    ranges_.push_back(ranges[program_.node(slot)]);
  }
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

double Field::departure(const Ray& from, double low, double high) const {
  if (is_constant_) return 0;
  constexpr int order = 12;
  const double half = 0.5 * (high - low);
  const expression::Rounded last = along(from, {0.5 * (low + high), half}, order).c[order];
  const double remainder = (std::abs(last.value) + last.radius) * std::pow(half, order);
  const expression::Range values = range(region(from, {low, high}));
  const double width = values.is_empty() ? convex::infinity : 0.5 * (values.high - values.low);
  return std::isfinite(remainder) ? std::min(remainder, width) : width;
}

expression::Range Field::range(const Region& at) const {
  using expression::Range, expression::Slot;
  if (is_constant_) return constant_range_;
  std::vector<Range> x(program_.size());
  std::copy_n(at.begin(), coordinates_.size(), x.begin());
  const Slot first = program_.time() + 1;
  for (Slot slot = first; slot < program_.begin(); ++slot) x[slot] = ranges_[slot - first];
  for (Slot slot = program_.begin(); slot < program_.end(0); ++slot)
    x[slot] = expression::value(program_[slot].operation, x[program_[slot].a], x[program_[slot].b]);
  return x[program_.roots(0).front()];
}

double Field::raw(const Point& x) const {
  if (is_bound()) return bound_in({{{x[0], x[0]}, {x[1], x[1]}, {x[2], x[2]}}});
  if (is_constant_) return constant_.value;
  const auto n = static_cast<Index>(coordinates_.size());
  State state{0, Vector::Map(x.data(), n), Vector::Zero(n)};
  bool is_finite = true;
  const expression::Values values = program_.values(state, 0, is_finite);
  const double value = values[program_.roots(0).front()];
  return std::isnan(value) && has_branches_ ? beside_kinks(x) : value;
}

double Field::beside_kinks(const Point& at) const {
  using expression::Operation, expression::Slot;
  expression::Values x(program_.size());
  std::copy_n(at.begin(), coordinates_.size(), x.begin());
  const Slot first = program_.time() + 1;
  for (Slot slot = first; slot < program_.begin(); ++slot) x[slot] = constants_[slot - first].value;
  for (Slot slot = program_.begin(); slot < program_.end(0); ++slot) {
    const expression::Program::Instruction& i = program_[slot];
    x[slot] =
        i.operation == Operation::sign && x[i.a] == 0 ? 1 : expression::value(i.operation, x[i.a], x[i.b]);
  }
  return x[program_.roots(0).front()];
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
