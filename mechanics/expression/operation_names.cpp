#include <array>
#include <utility>

#include "mechanics/expression/operation.hpp"

namespace mechanics::expression {
namespace {

constexpr std::array<std::pair<std::string_view, Operation>, 17> functions{{
    {"sin", Operation::sin},
    {"cos", Operation::cos},
    {"tan", Operation::tan},
    {"asin", Operation::asin},
    {"acos", Operation::acos},
    {"atan", Operation::atan},
    {"atan2", Operation::atan2},
    {"sinh", Operation::sinh},
    {"cosh", Operation::cosh},
    {"tanh", Operation::tanh},
    {"exp", Operation::exp},
    {"log", Operation::log},
    {"sqrt", Operation::sqrt},
    {"abs", Operation::abs},
    {"min", Operation::min},
    {"max", Operation::max},
    {"ln", Operation::log},  // after log, which stands for it in messages
}};

}  // namespace

int arity(Operation operation) {
  using enum Operation;
  switch (operation) {
    case literal:
    case pi:
    case coordinate:
    case velocity:
    case time:
      return 0;
    case add:
    case subtract:
    case multiply:
    case divide:
    case power:
    case atan2:
    case min:
    case max:
    case where_not_negative:
    case where_negative:
      return 2;
    default:
      return 1;
  }
}

std::string_view symbol(Operation operation) {
  using enum Operation;
  switch (operation) {
    case negate:
    case subtract:
      return "-";
    case add:
      return "+";
    case multiply:
      return "*";
    case divide:
      return "/";
    case power:
      return "^";
    case pi:
      return "pi";
    case time:
      return "t";
    case sign:
      return "sign";
    case where_not_negative:
    case where_negative:
      return "if";
    default:
      break;
  }
  for (const auto& [name, function] : functions)
    if (function == operation) return name;
  return "";
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const auto& [name, operation] : functions) names.emplace_back(name);
  return names;
}

std::optional<Operation> function_named(std::string_view name) {
  for (const auto& [known, function] : functions)
    if (known == name) return function;
  return std::nullopt;
}

}  // namespace mechanics::expression
