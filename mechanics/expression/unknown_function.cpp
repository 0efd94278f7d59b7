#include "mechanics/expression/unknown_function.hpp"

#include "convex/nearest_name.hpp"
#include "mechanics/expression/operation.hpp"

namespace mechanics::expression {
namespace {

/// What other languages have, and how it is said here.
struct Saying {
  std::string_view unknown, here;
};
constexpr std::string_view two_constraints =
    "write max(a, b) or min(a, b); smoother, in a constraint, are two: max(a, b) <= c is a <= c and b <= c, "
    "min(a, b) >= c is a >= c and b >= c";
constexpr Saying sayings[] = {
    {"fmax", two_constraints},
    {"fmin", two_constraints},
    {"pow", "write x^p for pow(x, p)"},
    {"power", "write x^p"},
    {"sqr", "write x^2"},
    {"square", "write x^2"},
    {"cbrt", "write x^(1/3)"},
    {"log10", "write log(x)/log(10)"},
    {"log2", "write log(x)/log(2)"},
    {"fabs", "write abs(x)"},
    {"sec", "write 1/cos(x)"},
    {"csc", "write 1/sin(x)"},
    {"cot", "write 1/tan(x)"},
    {"coth", "write 1/tanh(x)"},
    {"arcsin", "write asin(x)"},
    {"arccos", "write acos(x)"},
    {"arctan", "write atan(x)"},
    {"arctan2", "write atan2(y, x)"},
    {"radians", "write x*pi/180"},
    {"degrees", "write x*180/pi"},
    {"diff", "the time derivative is x'"},
    {"der", "the time derivative is x'"},
    {"ddt", "the time derivative is x'"},
    {"Sum", "write sum(i in 1..N, ...)"},
    {"sgn", "write sign(x)"},
    {"heaviside", "write step(x)"},
    {"floor", "it jumps, and motions need derivatives"},
    {"ceil", "it jumps, and motions need derivatives"},
    {"round", "it jumps, and motions need derivatives"},
    {"mod", "it jumps, and motions need derivatives; an angle may grow beyond 2*pi"},
};

constexpr Saying characters[] = {
    {"≥", ">="},
    {"≤", "<="},
    {"≠", instead_of_unequal},
    {"·", "*"},
    {"×", "*"},
    {"−", "-"},
    {"–", "-"},
    {"÷", "/"},
    {"²", "^2"},
    {"³", "^3"},
    {"½", "1/2"},
    {"′", "'"},
    {"’", "'"},
    {"|", "abs(x) for |x|"},
    {"√", "sqrt(x)"},
    {"π", "pi"},
    {"∞", "no bound at all"},
    {"&", "one constraint each"},
    {"ẋ", "x'"},
    {"ẏ", "y'"},
    {"ż", "z'"},
    {"\u0307", "x' for the velocity"},
    {"α", "alpha"},
    {"β", "beta"},
    {"γ", "gamma"},
    {"θ", "theta"},
    {"φ", "phi"},
    {"ω", "omega"},
    {"λ", "lambda"},
    {"μ", "mu"},
    {"ρ", "rho"},
    {"!", "no factorial"},
    {";", "one expression alone"},
};

}  // namespace

std::string instead_of_character(std::string_view character) {
  for (const Saying& saying : characters)
    if (saying.unknown == character) return std::string(saying.here);
  return "it with names of a to z, A to Z, digits and _, numbers and + - * / ^ '";
}

std::vector<std::string> names_behind_velocity(std::string_view unknown) {
  std::vector<std::string> names;
  for (const std::string_view before : {"d", "d_", "v", "v_", "dot", "dot_"})
    if (unknown.starts_with(before)) names.emplace_back(unknown.substr(before.size()));
  for (const std::string_view behind : {"dot", "_dot", "_d", "d", "p", "_t"})
    if (unknown.ends_with(behind)) names.emplace_back(unknown.substr(0, unknown.size() - behind.size()));
  return names;
}

std::string instead_of_function(std::string_view unknown) {
  for (const Saying& saying : sayings)
    if (saying.unknown == unknown) return std::string(saying.here);
  std::vector<std::string> known = function_names();
  for (const char* other : {"sign", "hypot", "step", "if", "table", "sum", "dot", "cross", "norm", "point"})
    known.emplace_back(other);
  const std::string nearest = convex::nearest_name(unknown, known);
  if (!nearest.empty()) return "did you mean \"" + nearest + "\"?";
  std::string list = "the functions are ";
  for (std::size_t i = 0; i < known.size(); ++i) list += (i == 0 ? "" : ", ") + known[i];
  return list + "; for a product write *";
}

}  // namespace mechanics::expression
