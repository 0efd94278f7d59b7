#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "cli/commands/command_line.hpp"
#include "cli/commands/symbols.hpp"
#include "cli/each_file.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/function_language/parse_metric.hpp"
#include "cli/json_writer.hpp"
#include "cli/report/decomposition_report.hpp"
#include "convex/counted.hpp"
#include "convex/operations/takes_product.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;

/// What `moreau prox` is told.
struct ProxOptions : FunctionOptions {
  std::optional<std::string> step;  ///< gamma of prox_(gamma f), a number
};

/// A point and the line of the file that it stands on; 0 on the command line.
struct AskedPoint {
  convex::Vector z;
  std::string text;
  int line = 0;
};

/// A point a line, numbers separated by commas; lines that are empty or begin with # are left out.
std::vector<AskedPoint> points_of_file(const std::string& file) {
  std::vector<AskedPoint> points;
  std::istringstream lines(read_file(file));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos || line[first] == '#') continue;
    try {
      const std::string text = "[" + line + "]";
      points.push_back({parse_point(text, "z"), text, number});
      const AskedPoint &made = points.back(), &start = points.front();
      if (made.z.size() != start.z.size())
        throw InvalidInput(
            fmt::format("a point of size {}, but of size {} in line {}; give every point as many entries",
                        made.z.size(), start.z.size(), start.line),
            convex::Place{1, 2});
    } catch (const InvalidInput& error) {
      const int column = error.place() ? std::max(1, error.place()->column - 1) : 1;
      throw InvalidInput(error.what(), convex::Place{number, column});
    }
  }
  if (points.empty()) throw InvalidInput("no point in it; give one a line, such as 3, -1, 1/2");
  return points;
}

/// The points of the command line; `source` tells what is being read.
std::vector<AskedPoint> read_points(const ProxOptions& options, Source& source) {
  source = {"--method", options.method.value_or("")};
  require_applicable({}, options);
  if (options.at->rfind('@', 0) == 0) {
    source = {options.at->substr(1), ""};
    return points_of_file(source.name);
  }
  source = {"--at", *options.at};
  return {{parse_point(*options.at, "z"), *options.at, 0}};
}

/// The same as written.
convex::ExactGram exact_metric(const ProxOptions& options, bool is_divided, std::size_t n) {
  convex::ExactGram W = options.metric ? parse_exact_metric(*options.metric) : convex::identity_gram(n);
  if (is_divided) {
    const convex::Fraction step = written_numbers("[" + *options.step + "]").at(0);
    for (convex::ExactRow& row : W.rows)
      for (auto& [column, entry] : row) entry = entry / step;
  }
  return W;
}

/// Above 0: a number, or a fraction of two.
std::string positive_fraction(const std::string& text) {
  const std::optional<convex::Fraction> value = convex::read_fraction(text);
  const double rounded = value ? convex::nearest_double(*value) : 0;
  if (rounded > 0 && std::isfinite(rounded)) return "";
  return text + " is not a positive number; give one above 0, such as 0.5 or 1/2";
}

double step_of(const ProxOptions& options) {
  return convex::nearest_double(convex::read_fraction(*options.step).value());
}

/// With a step, the metric of the command line over it: the prox of gamma f in W is that of f in W/gamma. A
/// function that takes the product of W would be another one there: gamma f itself is then split, in W.
DecompositionProblem read_problem(const AskedPoint& point, const ProxOptions& options, Source& source) {
  convex::Metric W = convex::Metric::identity(point.z.size());
  if (options.metric) {
    source = {"--metric", *options.metric};
    W = parse_metric(*options.metric);
    if (W.dimension() != point.z.size())
      throw InvalidInput(
          fmt::format("metric: {}; give {}, one per entry of z",
                      convex::counted(W.dimension(), "row", "rows"), point.z.size()));
  }
  source = {"f", options.expression};
  convex::Call f = parse_known_call(options.expression, "f");
  const bool is_divided = options.step && !convex::takes_product(f);
  if (is_divided)
    W = W.scaled(1 / step_of(options));
  else if (options.step)
    f = parse_call("scale(" + options.expression + ", " + *options.step + ")", "f");
  auto exact = [f, options, is_divided, text = point.text] {
    convex::Fractions z = written_numbers(text);
    const std::size_t n = z.size();
    return convex::SplitQuestion{f, std::move(z), exact_metric(options, is_divided, n)};
  };
  return {point.z, std::move(W), std::move(f), std::move(exact)};
}

/// One point; of several, the line of the file tells which.
Exit split_at(const AskedPoint& point, const ProxOptions& options, Source& source) {
  const DecompositionProblem problem = read_problem(point, options, source);
  const SplitPoint split = split_point(problem, {}, options, options.certify);
  if (options.json) {
    JsonWriter json;
    json.begin_object();
    if (point.line > 0) json.key("line").value(point.line);
    write_split(json, split, "");
    fmt::print("{}\n", json.end_object().text());
  } else if (!options.quiet) {
    fmt::print("{}{}", point.line > 0 ? fmt::format("line {}\n", point.line) : "", split_text(split));
  }
  return split.exit();
}

Exit split_points(const ProxOptions& options) {
  Source source;
  return answered(options, source, [&] {
    const std::vector<AskedPoint> points = read_points(options, source);
    Exit worst = Exit::solved;
    for (const AskedPoint& point : points) {
      if (point.line > points.front().line && !options.json && !options.quiet) fmt::print("\n");
      worst = std::max(worst, split_at(point, options, source));
    }
    return worst;
  });
}

}  // namespace

void add_prox(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<ProxOptions>();
  CLI::App& command = add_command(
      program, "prox", "splits a point: z = x + y, x = prox_f z, y = prox_g z, g the conjugate of f", chosen,
      [options] {
        if (!options->symbolic) return split_points(*options);
        return tell_prox_in_symbols(*options,
                                    options->step ? std::optional(step_of(*options)) : std::nullopt);
      });
  add_function(command, *options, true);
  add_proof(command, options->certify);
  command.add_option("--step", options->step, "gamma: the prox of gamma f, that of f in the metric W/gamma")
      ->type_name("X")
      ->check(positive_fraction);
  add_accuracy(command, *options,
               "accept an error of x and of y of X * max(1, ||z||_W, ||x||_W), default 1e-9",
               method_of_functions);
  add_symbols(command, *options);
  add_printing(command, *options);
}

}  // namespace cli::inline commands
