#pragma once

#include "cli/report/equation_code.hpp"

namespace cli::inline reports {

/// A, z, U and s in formulas: an align* of amsmath, zeros left out, symmetric entries once.
std::string equations_in_latex(const mechanics::SymbolicEquations&, const EquationTitle&);

/// A name of a problem file as a symbol: "phi_1" is \phi_{1}, "x[3]" is x_{3}, "mesh" \mathit{mesh}.
std::string latex_symbol(const std::string& name);

}  // namespace cli::inline reports
