#pragma once

#include <string>

#include "cli/json_writer.hpp"
#include "cli/report/solve_report.hpp"

namespace cli::inline reports {

/// What was solved: `{"islands": [{"method", "first_coordinate", "coordinates", "contacts", "flops",
/// "factor_nonzeros"}], "left_out": [{"constraint", "why"}], "flops"}`, and under --model full
/// `"reduced": {"islands", "left_out", "flops", "difference"}`, what the reductions would have made of it.
void write_model(JsonWriter&, const SolvedScene&);

/// The same in a few lines.
std::string model_text(const SolvedScene&);

/// What the rounding of A, z, U, s leaves open of rows, where the text does not decide it either; else
/// nothing.
std::string left_open_text(const SolvedScene&);

/// "active-set", or what solved the islands: "closed-form and active-set"; "no method, no contact presses"
/// where nothing had to run.
std::string methods_that_ran(const SolvedScene&);

}  // namespace cli::inline reports
