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

}  // namespace

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
