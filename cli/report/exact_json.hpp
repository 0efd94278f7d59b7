#pragma once

#include "cli/json_writer.hpp"
#include "cli/report/solve_report.hpp"

namespace cli::inline reports {

/// "certificate": the level of proof and the error bound, or the estimate when no proof was asked for.
void write_certificate(JsonWriter&, const SolvedScene&);

/// "exact": the answer as fractions in strings, where it was found in fractions; "from_text": that of the
/// mechanism as its text has it, where that was proved; else nothing.
void write_exact(JsonWriter&, const SolvedScene&);

/// "farkas": weights by constraint; integers that no double holds are strings.
void write_farkas(JsonWriter&, const SolvedScene&);

}  // namespace cli::inline reports
