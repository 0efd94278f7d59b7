#pragma once

#include <optional>
#include <string>

#include "cli/options.hpp"
#include "convex/symbolic/term.hpp"

namespace cli::inline commands {
struct FunctionOptions;
}

namespace cli::inline reports {
class JsonWriter;

/// "f(x) = …" by cases, a line each, +inf elsewhere.
std::string cases_text(const std::string& left, const std::string& variable, const convex::symbolic::Cases&);
/// The same as a formula of amsmath.
std::string cases_latex(const std::string& left, const std::string& variable, const convex::symbolic::Cases&);
/// An array of them.
void write_cases(JsonWriter&, const convex::symbolic::Cases&);

/// `--symbolic`: f of one variable with the prox of step f, or its conjugate, by cases; `--latex`: as
/// formulas of amsmath.
Exit tell_prox_in_symbols(const FunctionOptions&, std::optional<double> step);
Exit tell_conjugate_in_symbols(const FunctionOptions&);

}  // namespace cli::inline reports
