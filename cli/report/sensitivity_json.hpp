#pragma once

#include "cli/json_writer.hpp"
#include "cli/report/solve_report.hpp"

namespace cli::inline reports {

/// "sensitivity": how acceleration and multipliers answer to one more unit of each force and of each bound
/// s_a, and the margin of each contact (docs/proof.md, section 7).
void write_sensitivity(JsonWriter&, const SolvedScene&);

}  // namespace cli::inline reports
