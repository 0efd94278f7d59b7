#pragma once

#include <string>

#include "cli/report/solve_report.hpp"

namespace cli::inline reports {

/// What more or less of a force or a bound changes, and how far the contacts are from opening or closing, as
/// tables; "" unless it was asked for.
std::string sensitivity_text(const SolvedScene&);

}  // namespace cli::inline reports
