#include "cli/commands/symbols.hpp"

#include <fmt/format.h>

#include "cli/each_file.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/function_language/parse_metric.hpp"
#include "cli/json_writer.hpp"
#include "cli/report/symbolic_report.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/symbolic/function_of_call.hpp"

namespace cli::inline commands {
namespace {

namespace symbolic = convex::symbolic;
using convex::Fraction;
using convex::InvalidInput;

/// The weight w of a metric of one variable.
Fraction weight(const FunctionOptions& options, Source& source) {
  if (!options.metric) return {1, 1};
  source = {"--metric", *options.metric};
  const convex::Metric W = parse_metric(*options.metric);
  if (W.dimension() != 1) throw InvalidInput("metric: symbols have one variable; give one number, [[2]]");
  return symbolic::simplest_fraction(W.diagonal()[0]);
}

/// What is found without symbols alone is refused beside them, where it stands.
void require_applicable_to_symbols(const FunctionOptions& options, Source& source) {
  source = {"--at", options.at.value_or("")};
  if (options.at) throw InvalidInput("--symbolic tells the whole function; leave --at out");
  const std::pair<bool, const char*> of_points[] = {{options.certify, "--certify"},
                                                    {options.method.has_value(), "--method"},
                                                    {options.tolerance.has_value(), "--tolerance"},
                                                    {options.limit.has_value(), "--limit"}};
  for (const auto& [is_given, option] : of_points) {
    source = {option, ""};
    if (is_given)
      throw InvalidInput(std::string(option) +
                         " goes with a point; with --symbolic formulas are exact or by rules, leave it out");
  }
}

/// "prox_f(z)"; of a step "prox_(2 f)(z)".
std::string name_of_prox(const std::optional<Fraction>& step, bool latex) {
  const std::string of =
      step ? (latex ? symbolic::latex(symbolic::Bound(*step)) + " f" : convex::text(*step) + " f") : "f";
  if (latex) return "\\operatorname{prox}_{" + of + "}(z)";
  return step ? "prox_(" + of + ")(z)" : "prox_f(z)";
}

Exit tell(const FunctionOptions& options, bool is_prox, const std::optional<Fraction>& step) {
  Source source;
  return answered(options, source, [&] {
    require_applicable_to_symbols(options, source);
    const Fraction w = weight(options, source);
    source = {"f", options.expression};
    const convex::Call call = parse_known_call(options.expression, "f");
    // What the language refuses, symbols refuse with the same words.
    convex::make_function(call, {convex::Metric::identity(1).scaled(convex::nearest_double(w))});
    const symbolic::Function f = symbolic::function_of(call, w);
    std::vector<NamedCases> told;
    if (is_prox) {
      const symbolic::Cases itself = symbolic::formula(f);
      told.push_back({"f(x)", "x", itself, false});
      told.push_back({name_of_prox(step, options.latex), "z",
                      symbolic::prox_formula(f, step.value_or(Fraction{1, 1}) / w), true});
    } else {
      // In the product w x y:
      told.push_back({"f(x)", "x", symbolic::formula(f), false});
      // f*(w y) is the conjugate of f(x/w).
      told.push_back({"g(y)", "y", symbolic::conjugate_formula(symbolic::dilate(f, w)), false});
    }
    if (options.json) {
      JsonWriter json;
      json.begin_object().key("kind").value(is_prox ? "prox" : "conjugate").key("status").value("solved");
      json.key("f").value(to_text(call));
      if (step) json.key("step").value(convex::text(*step));
      json.key("symbolic").begin_object().key("f");
      write_cases(json, told[0].cases);
      json.key(is_prox ? "prox" : "g");
      write_cases(json, told[1].cases);
      fmt::print("{}\n", json.end_object().end_object().text());
    } else if (!options.quiet) {
      for (const NamedCases& named : told) fmt::print("{}", options.latex ? as_latex(named) : as_text(named));
    }
    return Exit::solved;
  });
}

}  // namespace

Exit tell_prox_in_symbols(const FunctionOptions& options, std::optional<double> step) {
  return tell(options, true, step ? std::optional(symbolic::simplest_fraction(*step)) : std::nullopt);
}
Exit tell_conjugate_in_symbols(const FunctionOptions& options) { return tell(options, false, std::nullopt); }

}  // namespace cli::inline commands
