#pragma once

#include <string>
#include <vector>

#include "mechanics/symbolic_equations.hpp"

namespace cli::inline reports {

/// What is said of a system in the code that is made of it.
struct EquationTitle {
  std::string function;               ///< the name of the function
  std::vector<std::string> contacts;  ///< the rows of U
};

/// The name of the function made of a file: its stem, other characters than letters, digits and _ as _.
std::string function_name(const std::string& file);

/// A C99 function void NAME(const double *q, const double *v, double t, double *A, double *z, double *U,
/// double *s); A and U row by row.
std::string equations_in_c(const mechanics::SymbolicEquations&, const EquationTitle&);

/// A function NAME(q, v, t) of Python with numpy; it returns A, z, U, s.
std::string equations_in_python(const mechanics::SymbolicEquations&, const EquationTitle&);

}  // namespace cli::inline reports
