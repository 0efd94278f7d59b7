#pragma once

#include <string>

#include "cli/report/answer.hpp"
#include "convex/laws/check.hpp"

namespace cli {
class JsonWriter;
}

namespace cli::inline reports {

/// The keys `checks` and `no_evidence` of docs/problem-files.md, into the object that is open.
void write_checks(JsonWriter&, const convex::LawReport&);

/// One line a law, and below them how many held.
std::string checks_text(const convex::LawReport&);

/// 1 when a law failed; else the exit code that goes with the status of the solve.
Exit exit_code(const convex::LawReport&, convex::Status);

}  // namespace cli::inline reports
