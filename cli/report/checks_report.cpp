#include "cli/report/checks_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/json_writer.hpp"

namespace cli::inline reports {

void write_checks(JsonWriter& json, const convex::LawReport& report) {
  json.key("checks").begin_array();
  for (const convex::Check& check : report.checks) {
    json.begin_object().key("name").value(check.name).key("value").value(check.value);
    json.key("bound").value(check.bound).key("passed").value(check.passed);
    if (!check.counterexample.empty()) json.key("counterexample").value(check.counterexample);
    json.end_object();
  }
  json.end_array().key("no_evidence").begin_array();
  for (const std::string& line : report.no_evidence) json.value(line);
  json.end_array();
}

std::string checks_text(const convex::LawReport& report) {
  const auto failed = std::count_if(report.checks.begin(), report.checks.end(),
                                    [](const convex::Check& check) { return !check.passed; });
  if (report.checks.empty()) return report.text() + "\nNo law was put to the test.\n";
  return report.text() +
         (failed > 0 ? fmt::format("\n{} of {} laws FAILED.\n", failed, report.checks.size())
                     : fmt::format("\nAll {} laws hold within their bounds.\n", report.checks.size()));
}

Exit exit_code(const convex::LawReport& report, convex::Status status) {
  // What is not solved may leave nothing to put to a law.
  const bool nothing_failed = report.checks.empty() && status != convex::Status::solved;
  return report.all_passed() || nothing_failed ? exit_code(status) : Exit::no_solution;
}

}  // namespace cli::inline reports
