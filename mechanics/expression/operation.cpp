#include "mechanics/expression/operation.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "convex/invariant.hpp"

namespace mechanics::expression {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<std::pair<std::string_view, Operation>, 14> functions{{
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
}};

double raised(double base, double exponent) {
  if (exponent == 1) return base;
  if (exponent == 2) return base * base;  // exactly rounded and fast; pow is neither promised to be
  return std::pow(base, exponent);
}

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : undefined; }

/// 1 - tanh² without its cancellation.
double sech_squared(double x) {
  const double e = std::exp(-2 * std::abs(x));
  return 4 * e / ((1 + e) * (1 + e));
}

/// log(base) where base^exponent · log(base)^k, its limit 0 at base 0 included, is asked for.
double log_in_power(double base, double exponent) { return base == 0 && exponent > 0 ? 0 : std::log(base); }

Partials power_partials(double a, double b, double f, Active active) {
  Partials p;
  if (active.a) p.a = b == 0 ? 0 : b * raised(a, b - 1);
  if (active.b) p.b = f * log_in_power(a, b);
  return p;
}

SecondPartials power_second_partials(double a, double b, double f, Active active) {
  SecondPartials p;
  if (active.a) p.aa = b == 0 || b == 1 ? 0 : b * (b - 1) * raised(a, b - 2);
  const double l = active.b ? log_in_power(a, b) : 0;
  if (active.b) p.bb = f * l * l;
  if (active.a && active.b) p.ab = raised(a, b - 1) * (1 + b * std::log(a));
  return p;
}

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
    default:
      break;
  }
  for (const auto& [name, function] : functions)
    if (function == operation) return name;
  return "";
}

std::optional<Operation> function_named(std::string_view name) {
  for (const auto& [known, function] : functions)
    if (known == name) return function;
  return std::nullopt;
}

double value(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::parameter:
      return a;
    case Operation::negate:
      return -a;
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::power:
      return raised(a, b);
    case Operation::sin:
      return std::sin(a);
    case Operation::cos:
      return std::cos(a);
    case Operation::tan:
      return std::tan(a);
    case Operation::asin:
      return std::asin(a);
    case Operation::acos:
      return std::acos(a);
    case Operation::atan:
      return std::atan(a);
    case Operation::atan2:
      return std::atan2(a, b);
    case Operation::sinh:
      return std::sinh(a);
    case Operation::cosh:
      return std::cosh(a);
    case Operation::tanh:
      return std::tanh(a);
    case Operation::exp:
      return std::exp(a);
    case Operation::log:
      return std::log(a);
    case Operation::sqrt:
      return std::sqrt(a);
    case Operation::abs:
      return std::abs(a);
    case Operation::sign:
      return sign(a);
    default:
      break;
  }
  convex::invariant(false, "a constant or a variable is not computed from operands");
  return 0;
}

Partials partials(Operation operation, double a, double b, double f, Active active) {
  switch (operation) {
    case Operation::negate:
      return {-1, 0};
    case Operation::add:
      return {1, 1};
    case Operation::subtract:
      return {1, -1};
    case Operation::multiply:
      return {b, a};
    case Operation::divide:
      return {active.a ? 1 / b : 0, active.b ? -f / b : 0};
    case Operation::power:
      return power_partials(a, b, f, active);
    case Operation::sin:
      return {std::cos(a), 0};
    case Operation::cos:
      return {-std::sin(a), 0};
    case Operation::tan:
      return {1 + f * f, 0};
    case Operation::asin:
      return {1 / std::sqrt((1 - a) * (1 + a)), 0};
    case Operation::acos:
      return {-1 / std::sqrt((1 - a) * (1 + a)), 0};
    case Operation::atan:
      return {1 / (1 + a * a), 0};
    case Operation::atan2: {
      const double r = std::hypot(a, b);
      return {active.a ? b / r / r : 0, active.b ? -a / r / r : 0};
    }
    case Operation::sinh:
      return {std::cosh(a), 0};
    case Operation::cosh:
      return {std::sinh(a), 0};
    case Operation::tanh:
      return {sech_squared(a), 0};
    case Operation::exp:
      return {f, 0};
    case Operation::log:
      return {1 / a, 0};
    case Operation::sqrt:
      return {0.5 / f, 0};
    case Operation::abs:
      return {sign(a), 0};
    case Operation::sign:
      return {0, 0};
    default:
      break;
  }
  convex::invariant(false, "a constant or a variable has no operands");
  return {};
}

SecondPartials second_partials(Operation operation, double a, double b, double f, Active active) {
  switch (operation) {
    case Operation::multiply:
      return {0, 1, 0};
    case Operation::divide:
      return {0, active.a && active.b ? -1 / b / b : 0, active.b ? 2 * (f / b) / b : 0};
    case Operation::power:
      return power_second_partials(a, b, f, active);
    case Operation::sin:
    case Operation::cos:
      return {-f, 0, 0};
    case Operation::tan:
      return {2 * f * (1 + f * f), 0, 0};
    case Operation::asin:
    case Operation::acos: {
      const double square = (1 - a) * (1 + a), sense = operation == Operation::asin ? 1 : -1;
      return {sense * a / (square * std::sqrt(square)), 0, 0};
    }
    case Operation::atan: {
      const double p = 1 / (1 + a * a);
      return {-2 * a * p * p, 0, 0};
    }
    case Operation::atan2: {
      const double r = std::hypot(a, b), s = a / r, c = b / r;
      const double mixed = 2 * s * c / r / r;
      return {active.a ? -mixed : 0, active.a && active.b ? (s - c) * (s + c) / r / r : 0,
              active.b ? mixed : 0};
    }
    case Operation::sinh:
    case Operation::cosh:
      return {f, 0, 0};
    case Operation::tanh:
      return {-2 * f * sech_squared(a), 0, 0};
    case Operation::exp:
      return {f, 0, 0};
    case Operation::log:
      return {-1 / a / a, 0, 0};
    case Operation::sqrt:
      return {-0.25 / (a * f), 0, 0};
    case Operation::abs:
      return {0 * sign(a), 0, 0};
    default:
      return {};
  }
}

}  // namespace mechanics::expression
