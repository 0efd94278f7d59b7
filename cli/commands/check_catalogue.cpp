#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <limits>
#include <thread>

#include "cli/commands/command_line.hpp"
#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/json_writer.hpp"
#include "cli/report/checks_report.hpp"
#include "cli/report/text_table.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/laws/call_laws.hpp"

namespace cli::inline commands {
namespace {

/// An example of the catalogue with what became of its laws.
struct Tried {
  std::string text;
  convex::Index n = 0;
  convex::LawReport report;
};

std::vector<Tried> examples() {
  std::vector<Tried> all;
  for (const convex::CatalogueEntry& entry : convex::catalogue())
    for (const std::string_view example : entry.examples) all.push_back({std::string(example), 0, {}});
  return all;
}

void try_laws(Tried& tried) {
  const convex::Call call = parse_call(tried.text, "f");
  tried.n = number_of_entries(call);
  tried.report = convex::laws(call, tried.n);
}

/// The examples are independent of each other: one thread a core takes the next that is left.
void try_all(std::vector<Tried>& all) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < all.size(); k = next++) try_laws(all[k]);
  };
  std::vector<std::jthread> threads;
  for (unsigned k = 1; k < std::max(1U, std::thread::hardware_concurrency()); ++k) threads.emplace_back(work);
  work();
}

double ratio(const convex::Check& check) {
  if (check.bound > 0) return check.value / check.bound;
  return check.value > 0 ? std::numeric_limits<double>::infinity() : 0;
}

const convex::Check& worst(const convex::LawReport& report) {
  return *std::max_element(report.checks.begin(), report.checks.end(), [](const auto& a, const auto& b) {
    return a.passed != b.passed ? b.passed < a.passed : ratio(a) < ratio(b);
  });
}

std::size_t failures(const std::vector<Tried>& all) {
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](const Tried& t) { return !t.report.all_passed(); }));
}

/// One line for each law that has no evidence: the metrics differ in nothing that matters here.
std::vector<std::string> no_evidence(const convex::LawReport& report) {
  const auto law = [](const std::string& line) { return line.substr(0, line.find(" (")); };
  std::vector<std::string> lines;
  const auto end = report.no_evidence.end();
  for (auto first = report.no_evidence.begin(); first != end;) {
    const auto next = std::find_if(first, end, [&](const auto& line) { return law(line) != law(*first); });
    lines.push_back(*first + (next - first > 1 ? fmt::format("; so in {} metrics", next - first) : ""));
    first = next;
  }
  return lines;
}

std::string text_of(const std::vector<Tried>& all, double seconds) {
  TextTable table({"", "value/bound", "of the law"});
  std::string failed, silent;
  for (const Tried& tried : all) {
    const convex::Check& check = worst(tried.report);
    table.add(
        {tried.text, tried.report.all_passed() ? fmt::format("{:.1e}", ratio(check)) : "FAILED", check.name});
    for (const convex::Check& c : tried.report.checks)
      if (!c.passed)
        failed += fmt::format("FAILED  {}: {} ({:.2g}, bound {:.2g}) at {}\n", tried.text, c.name, c.value,
                              c.bound, c.counterexample);
    for (const std::string& line : no_evidence(tried.report))
      silent += fmt::format("no evidence  {}: {}\n", tried.text, line);
  }
  const std::size_t wrong = failures(all);
  return table.text() + (silent.empty() ? "" : "\n" + silent) + (failed.empty() ? "" : "\n" + failed) +
         fmt::format("\n{} ({:.1f} s).\n",
                     wrong > 0
                         ? fmt::format("{} of {} examples FAILED a law", wrong, all.size())
                         : fmt::format("All laws hold for all {} examples of the catalogue, in four metrics",
                                       all.size()),
                     seconds);
}

std::string json_of(const std::vector<Tried>& all, double seconds) {
  convex::LawReport whole;
  JsonWriter json;
  json.begin_object()
      .key("kind")
      .value("catalogue")
      .key("status")
      .value(failures(all) > 0 ? "failed" : "passed");
  json.key("functions").begin_array();
  for (const Tried& tried : all) {
    const convex::Check& check = worst(tried.report);
    json.begin_object().key("call").value(tried.text).key("dimension").value(tried.n);
    json.key("passed").value(tried.report.all_passed());
    json.key("ratio").value(ratio(check)).key("law").value(check.name).end_object();
    for (convex::Check c : tried.report.checks) {
      c.name = tried.text + ": " + c.name;
      whole.checks.push_back(std::move(c));
    }
    for (const std::string& line : tried.report.no_evidence)
      whole.no_evidence.push_back(tried.text + ": " + line);
  }
  json.end_array();
  write_checks(json, whole);
  return json.key("seconds").value(seconds).end_object().text() + "\n";
}

}  // namespace

Exit check_catalogue(const Printing& options) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Tried> all = examples();
  try_all(all);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.json)
    fmt::print("{}", json_of(all, seconds));
  else if (!options.quiet)
    fmt::print("{}", text_of(all, seconds));
  return failures(all) > 0 ? Exit::no_solution : Exit::solved;
}

}  // namespace cli::inline commands
