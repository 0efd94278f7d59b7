#pragma once

#include <string>

#include "convex/symbolic/term.hpp"

namespace cli {
class JsonWriter;
}

namespace cli::inline reports {

/// A formula with a name: "f(x)", the cases in x.
struct NamedCases {
  std::string left, variable;
  convex::symbolic::Cases cases;
  bool is_finite_everywhere = false;  ///< a prox
};

std::string as_text(const NamedCases&);
std::string as_latex(const NamedCases&);

/// "f(x) = …" by cases, a line each, +inf elsewhere.
std::string cases_text(const std::string& left, const std::string& variable, const convex::symbolic::Cases&);
/// The same as a formula of amsmath.
std::string cases_latex(const std::string& left, const std::string& variable, const convex::symbolic::Cases&);
/// An array of them.
void write_cases(JsonWriter&, const convex::symbolic::Cases&);

}  // namespace cli::inline reports
