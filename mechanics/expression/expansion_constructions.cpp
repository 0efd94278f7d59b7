#include "mechanics/expression/construction.hpp"
#include "mechanics/expression/expansion.hpp"

namespace mechanics::expression {

void Expansion::construct(const Instruction& instruction) {
  const auto what = static_cast<Construction>(instruction.operand);
  const auto count = static_cast<std::size_t>(instruction.number);
  if (instruction.numeric) {
    const std::span<const double> arguments(numbers_.data() + numbers_.size() - count, count);
    if (what == Construction::table) {
      const std::size_t n = (count - 1) / 2;
      if (const auto fault = fault_of_table(arguments.subspan(1, n), arguments.subspan(1 + n)))
        fail(instruction, "table " + *fault);
    }
    if (what == Construction::component && !is_component(arguments[3]))
      fail(instruction, "the component " + count_text(arguments[3]) + " of a vector; it is 1, 2 or 3");
    const double result = constructed(what, arguments);
    numbers_.resize(numbers_.size() - count);
    return push_number(instruction, result);
  }
  const std::vector<NodeId> arguments(nodes_.end() - static_cast<std::ptrdiff_t>(count), nodes_.end());
  nodes_.resize(nodes_.size() - count);
  if (what == Construction::table) check_table(instruction, arguments);
  if (what == Construction::component || what == Construction::point) {
    const NodeId k = arguments.back();
    if (!tape_->is_constant(k))
      fail(instruction, "the number of a component is no constant; write it with numbers and indices");
    if (!is_component(tape_->constant(k)))
      fail(instruction, "the component " + count_text(tape_->constant(k)) + " of a vector; it is 1, 2 or 3");
  }
  nodes_.push_back(constructed(*tape_, what, arguments, origin(instruction)));
}

void Expansion::check_table(const Instruction& instruction, std::span<const NodeId> arguments) const {
  const std::size_t n = (arguments.size() - 1) / 2;
  std::vector<double> numbers;
  for (const NodeId node : arguments.subspan(1)) {
    if (!tape_->is_constant(node))
      fail(instruction, "a point or value of the table is no constant; write it with numbers and parameters");
    numbers.push_back(tape_->constant(node));
  }
  const std::span<const double> all(numbers);
  if (const auto fault = fault_of_table(all.first(n), all.subspan(n))) fail(instruction, "table " + *fault);
}

void Expansion::push_table(const Instruction& instruction) {
  const std::string_view text = frames_.back().code->source->text.text;
  const std::string file(text.substr(instruction.offset + 1, instruction.operand));
  if (!meanings_->table_file)
    fail(instruction, "a table in a file is read from a problem file only; write its numbers out");
  TablePoints points;
  try {
    points = meanings_->table_file(file);
  } catch (const convex::InvalidInput& error) {
    fail(instruction, error.what());
  }
  if (const auto fault = fault_of_table(points.x, points.y))
    fail(instruction, "the table in " + quoted(file) + " " + *fault);
  if (instruction.numeric)
    return push_number(instruction, natural_cubic_spline(points.x, points.y)(pop_number()));
  const auto nodes_of = [&](const std::vector<std::string>& texts, const std::vector<double>& numbers) {
    std::vector<NodeId> nodes;
    for (std::size_t i = 0; i < texts.size(); ++i)
      nodes.push_back(tape_->literal(texts[i], numbers[i], origin(instruction)));
    return nodes;
  };
  const std::vector<NodeId> knots = nodes_of(points.x_text, points.x),
                            values = nodes_of(points.y_text, points.y);
  const NodeId x = pop_node();
  nodes_.push_back(spline_node(*tape_, x, knots, values, origin(instruction)));
}

}  // namespace mechanics::expression
