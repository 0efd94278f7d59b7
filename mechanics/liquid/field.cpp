#include "mechanics/liquid/field.hpp"

#include <cmath>
#include <cstdio>

#include "mechanics/expression/rounded_nodes.hpp"

namespace mechanics::liquid {

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
  if (is_constant_)
    constant_ = expression::rounded_nodes(tape)[node];
  else
    program_ = expression::Program(tape, coordinates_.size(), {{node}});
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
