#include "cli/drawing/drawn_scene.hpp"

#include <map>

#include "convex/mistakes.hpp"
#include "mechanics/number_text.hpp"

namespace cli::inline drawings {
namespace {

using convex::Index;
using convex::InvalidInput;

constexpr std::string_view kind_names[] = {"points", "segments", "circles"};

std::string without_index(const std::string& name) { return name.substr(0, name.find('[')); }

std::string index_of(const std::string& name) {
  const std::size_t bracket = name.find('[');
  return bracket == std::string::npos ? "" : name.substr(bracket);
}

/// "draw_circles_ball_2": the name under which a number is a constraint; "draw.circles.ball" in messages.
std::string constraint_of(const DrawnShape& shape, std::size_t number) {
  return "draw_" + std::string(kind_names[static_cast<std::size_t>(shape.kind)]) + "_" +
         without_index(shape.name.text) + "_" + std::to_string(number);
}

std::string key_of(const DrawnShape& shape) {
  return "draw." + std::string(kind_names[static_cast<std::size_t>(shape.kind)]) + "." + shape.name.text;
}

/// An error in a constraint that stands for a number, as one of the shape.
InvalidInput of_shapes(const InvalidInput& error, const std::vector<DrawnShape>& shapes) {
  std::string message = error.what();
  for (const DrawnShape& shape : shapes)
    for (std::size_t k = 0; k < shape.numbers.size(); ++k)
      for (const std::string& prefix :
           {std::string("constraints."), std::string("constraint "), std::string()}) {
        const std::string name = prefix + constraint_of(shape, k) + index_of(shape.name.text);
        if (const std::size_t at = message.find(name); at != std::string::npos)
          message.replace(at, name.size(), key_of(shape));
      }
  return InvalidInput(message, error.place());
}

}  // namespace

DrawnScene::DrawnScene(const Problem& problem) {
  if (problem.draw.empty()) return;
  mechanics::LagrangianText text = std::get<SystemProblem>(problem.content).system;
  text.constraints.clear();
  for (const DrawnShape& shape : problem.draw)
    for (std::size_t k = 0; k < shape.numbers.size(); ++k) {
      mechanics::Text relation = shape.numbers[k];
      relation.text += " >= 0";
      text.constraints.push_back(
          {{constraint_of(shape, k) + index_of(shape.name.text), shape.name.begin}, std::move(relation)});
    }
  try {
    system_ = mechanics::lagrangian_system(text);
  } catch (const InvalidInput& error) {
    convex::Mistakes mistakes;
    mistakes.add(of_shapes(error, problem.draw));
    for (const InvalidInput& other : error.others()) mistakes.add(of_shapes(other, problem.draw));
    mistakes.tell();
  }
  std::map<std::string, std::vector<Index>> members;
  const std::vector<mechanics::Constraint>& constraints = system_->constraints();
  for (std::size_t a = 0; a < constraints.size(); ++a)
    members[without_index(constraints[a].name)].push_back(static_cast<Index>(a));
  for (const DrawnShape& shape : problem.draw) {
    const std::vector<Index>& first = members[constraint_of(shape, 0)];
    for (std::size_t member = 0; member < first.size(); ++member) {
      Shape drawn{shape.kind, without_index(shape.name.text), {}, {}};
      drawn.name += index_of(constraints[static_cast<std::size_t>(first[member])].name);
      for (std::size_t k = 0; k < shape.numbers.size(); ++k)
        drawn.numbers.push_back(members[constraint_of(shape, k)].at(member));
      for (const mechanics::Text& number : shape.numbers) drawn.places.push_back(number.begin);
      shapes_.push_back(std::move(drawn));
    }
  }
}

convex::Vector DrawnScene::values(const mechanics::State& state) const {
  if (!system_) return state.q;
  convex::Vector found = system_->constraint_rates(state).f;
  for (const Shape& shape : shapes_) {
    if (shape.kind != DrawnShape::Kind::circle) continue;
    const double radius = found[shape.numbers.back()];
    if (radius < 0)
      throw InvalidInput("draw.circles." + shape.name + ".radius: " + mechanics::number_text(radius) +
                             " at t = " + mechanics::number_text(state.t) + " is negative; give a length",
                         shape.places.back());
  }
  return found;
}

convex::SparseRows DrawnScene::derivatives(const mechanics::State& state,
                                           const std::vector<Index>& values) const {
  return system_->contact_rows(state, values).U;
}

}  // namespace cli::inline drawings
