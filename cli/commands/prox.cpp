#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <cstdio>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/function_language/parse_metric.hpp"
#include "cli/report/decomposition_report.hpp"
#include "cli/report/symbolic_report.hpp"

namespace cli {
namespace {

using convex::InvalidInput;

/// The point and the metric of the command line; `source` tells which is being read.
DecompositionProblem read_problem(const FunctionOptions& options, Source& source) {
  source = {"--method", options.method.value_or("")};
  require_applicable({}, options);
  source = {"--at", *options.at};
  convex::Vector z = parse_vector(*options.at, "z");
  if (z.size() == 0) throw InvalidInput("z: empty; give at least one number");
  if (!z.allFinite()) throw InvalidInput("z: an entry is not finite; give finite numbers");
  convex::Metric W = convex::Metric::identity(z.size());
  if (options.metric) {
    source = {"--metric", *options.metric};
    W = parse_metric(*options.metric);
    if (W.dimension() != z.size())
      throw InvalidInput(
          fmt::format("metric: {} rows; give {}, one per entry of z", W.dimension(), z.size()));
  }
  source = {"f", options.expression};
  convex::Call f = parse_call(options.expression, "f");
  auto exact = [f, options, W] {
    convex::Fractions point = written_numbers(*options.at);
    return convex::SplitQuestion{
        f, std::move(point), options.metric ? parse_exact_metric(*options.metric) : convex::exact_gram(W)};
  };
  return {std::move(z), std::move(W), std::move(f), std::move(exact)};
}

Exit split_at(const FunctionOptions& options) {
  Source source;
  return answered(options, source, [&] {
    const DecompositionProblem problem = read_problem(options, source);
    const SplitPoint split = split_point(problem, {}, options, options.certify);
    if (options.json)
      fmt::print("{}\n", split_json(split, ""));
    else if (!options.quiet)
      fmt::print("{}", split_text(split));
    return split.exit();
  });
}

}  // namespace

void add_prox(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<FunctionOptions>();
  CLI::App& command = add_command(
      program, "prox", "splits a point: z = x + y, x = prox_f z, y = prox_g z, g the conjugate of f", chosen,
      [options] { return options->symbolic ? tell_prox_in_symbols(*options) : split_at(*options); });
  add_function(command, *options, true);
  add_proof(command, options->certify);
  add_accuracy(command, *options);
  add_symbols(command, *options);
  add_printing(command, *options);
}

}  // namespace cli
