#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/function_language/parse_metric.hpp"
#include "cli/report/subdifferential_report.hpp"
#include "cli/report/text_table.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/counted.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;

/// What `moreau subdifferential` is told.
struct SubdifferentialOptions : FunctionOptions {
  std::optional<std::string> covector, direction;
};

/// A vector of the command line with as many entries as n, 0 for any, as it is written.
convex::Fractions read_exact_point(const std::string& text, const char* option, std::size_t n,
                                   Source& source) {
  source = {option, text};
  parse_point(text, option + 2);
  convex::Fractions x = written_numbers(text);
  if (n != 0 && x.size() != n)
    throw InvalidInput(fmt::format("{}: {}; give {}, as --at has", option + 2,
                                   convex::counted(x.size(), "entry", "entries"), n));
  return x;
}

/// Where doubles let x into the domain and fractions do not, x is one that was rounded, as those of a prox
/// are.
std::string why_empty(const convex::Function& f, const convex::Vector& x) {
  const convex::Value value = f.evaluate(x);
  const bool is_set = f.facts().indicator;
  const double distance = is_set ? (x - f.prox(x, convex::Metric::identity(x.size())).x).norm() : 0;
  if (std::isinf(value.value))
    return "x is outside the domain" + (distance > 0 ? " by " + number_text(distance) : std::string());
  // In the domain of an indicator 0 is a subgradient.
  const bool is_rounded = is_set || std::isinf(value.error);
  const std::string vertical = is_rounded ? "" : "a slope is vertical at x, or ";
  return vertical + "x is outside the domain by a rounding" +
         (distance > 0 ? ", about " + error_text(distance) : std::string()) +
         "; give fractions, or a point inside";
}

ToldSubdifferential find_subdifferential(const SubdifferentialOptions& options, Source& source) {
  ToldSubdifferential told;
  told.x = read_exact_point(*options.at, "--at", 0, source);
  convex::Fractions v, d;
  if (options.covector) v = read_exact_point(*options.covector, "--covector", told.x.size(), source);
  if (options.direction) d = read_exact_point(*options.direction, "--direction", told.x.size(), source);
  convex::ExactGram W = convex::identity_gram(told.x.size());
  convex::Metric in_doubles = rounded(W);
  if (options.metric) {
    source = {"--metric", *options.metric};
    in_doubles = parse_metric(*options.metric);
    W = parse_exact_metric(*options.metric);
    if (W.dimension() != told.x.size())
      throw InvalidInput(fmt::format("metric: {}; give {}, one per entry of x",
                                     convex::counted(W.dimension(), "row", "rows"), told.x.size()));
  }
  source = {"f", options.expression};
  told.f = parse_known_call(options.expression, "f");
  const convex::Function f = convex::make_function(told.f, {in_doubles});
  f(nearest(told.x));  // checks the number of entries
  told.at = convex::subdifferential(told.f, W, told.x);
  if (options.covector) told.contains = told.at.contains(v);
  if (told.at.is_empty()) {
    told.why_empty = why_empty(f, nearest(told.x));
    return told;
  }
  const convex::Index n = in_doubles.dimension();
  convex::Matrix inverse(n, n);
  for (convex::Index i = 0; i < n; ++i) inverse.col(i) = in_doubles.solve(convex::Vector::Unit(n, i));
  const convex::Metric dual =
      options.metric ? convex::Metric::dense(0.5 * (inverse + inverse.transpose())) : in_doubles;
  told.least = told.at.projection(convex::Vector::Zero(n), dual);
  told.least_norm = dual.norm(*told.least);
  if (options.direction) told.along = told.at.support(d);
  if (f.facts().indicator && told.at.polyhedron) {
    told.tangent = convex::tangent_cone(told.at);
    if (told.contains && *told.contains) told.critical = convex::critical_cone(told.at, v);
  }
  return told;
}

Exit tell_subdifferential(const SubdifferentialOptions& options) {
  Source source;
  return answered(options, source, [&] {
    const ToldSubdifferential told = find_subdifferential(options, source);
    if (options.json)
      fmt::print("{}", subdifferential_json(told));
    else if (!options.quiet)
      fmt::print("{}", subdifferential_text(told));
    return Exit::solved;
  });
}

}  // namespace

void add_subdifferential(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<SubdifferentialOptions>();
  CLI::App& command = add_command(
      program, "subdifferential",
      "all subgradients of a function at a point; of a set its normal, tangent and critical cones", chosen,
      [options] { return tell_subdifferential(*options); });
  add_function(command, *options, true);
  command
      .add_option("--covector", options->covector,
                  "is it a subgradient? Of a set also the critical cone for it")
      ->type_name("VECTOR");
  command
      .add_option("--direction", options->direction,
                  "the directional derivative along it, the support function of the subdifferential")
      ->type_name("VECTOR");
  add_printing(command, *options);
}

}  // namespace cli::inline commands
