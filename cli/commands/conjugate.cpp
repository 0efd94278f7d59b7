#include <CLI/CLI.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/commands/command_line.hpp"
#include "cli/commands/symbols.hpp"
#include "cli/each_file.hpp"
#include "cli/function_language/domain_text.hpp"
#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/function_language/parse_metric.hpp"
#include "cli/json_writer.hpp"
#include "cli/report/answer.hpp"
#include "cli/report/conjugate_formula.hpp"
#include "cli/report/text_table.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/counted.hpp"
#include "convex/functions/decomposition.hpp"
#include "convex/proved_prox/proved_conjugate.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;
using convex::Metric;
using convex::Vector;

struct ConjugateQuestion {
  convex::Function f;
  convex::Call call;
  Metric W;
  std::optional<Vector> y;
};

bool in_fractions(const FunctionOptions& options) { return options.method == "exact"; }

void require_applicable_to_value(const FunctionOptions& options, Source& source) {
  source = {"--method", options.method.value_or("")};
  if (options.method && options.method != "auto" && !in_fractions(options))
    throw InvalidInput("method \"" + *options.method +
                       "\" does not apply to a conjugate; leave it out, or ask for exact");
  if ((options.certify || in_fractions(options)) && !options.at)
    throw InvalidInput("--certify and --method exact prove a value; give the point with --at");
}

/// The function, the metric and the point of the command line; `source` tells which is being read.
ConjugateQuestion read_question(const FunctionOptions& options, Source& source) {
  std::optional<Vector> y;
  std::optional<Metric> W;
  require_applicable_to_value(options, source);
  if (options.at) {
    source = {"--at", *options.at};
    y = parse_point(*options.at, "y");
  }
  if (options.metric) {
    source = {"--metric", *options.metric};
    W = parse_metric(*options.metric);
    if (y && W->dimension() != y->size())
      throw InvalidInput(fmt::format("metric: {}; give {}, one per entry of y",
                                     convex::counted(W->dimension(), "row", "rows"), y->size()));
  }
  source = {"f", options.expression};
  const convex::Call call = parse_known_call(options.expression, "f");
  if (!W) W = Metric::identity(y ? y->size() : number_of_entries(call));
  return {convex::make_function(call, {*W}), call, *W, y};
}

/// Is the value right to the tolerance, relative to itself and at least 1? An infinite one is right when it
/// is proved, with the error 0.
convex::Status status_of(const std::optional<convex::Value>& value, const FunctionOptions& options) {
  constexpr double default_tolerance = 1e-9;
  if (!value) return convex::Status::solved;
  const double size = std::isfinite(value->value) ? std::max(1.0, std::abs(value->value)) : 1;
  const bool right = value->error <= options.tolerance.value_or(default_tolerance) * size;
  return right ? convex::Status::solved : convex::Status::inaccurate;
}

/// What is known of g: where it is finite, and its value at the point of the question.
struct ConjugateAnswer {
  convex::Function g;
  std::string domain;
  std::optional<convex::Value> value;
  convex::Status status = convex::Status::solved;
  std::optional<convex::ProvedValue> proof = {};

  Exit exit() const {
    const bool unproved = proof && proof->level == convex::ProofLevel::none;
    return unproved ? std::max(exit_code(status), Exit::inaccurate) : exit_code(status);
  }
};

/// The same as written.
convex::SplitQuestion written_question(const ConjugateQuestion& question, const FunctionOptions& options) {
  return {question.call, written_numbers(*options.at),
          options.metric ? parse_exact_metric(*options.metric) : convex::exact_gram(question.W)};
}

/// The value proved; with method exact the printed one is the fraction's nearest double.
void prove_value(const ConjugateQuestion& question, const FunctionOptions& options, ConjugateAnswer& answer) {
  answer.proof = convex::proved_conjugate(written_question(question, options));
  const convex::ProvedValue& proof = *answer.proof;
  if (in_fractions(options)) {
    if (proof.level != convex::ProofLevel::exact)
      throw InvalidInput(
          "method \"exact\" is for piecewise linear-quadratic functions, and this is none; leave the method "
          "out, or ask for --certify");
    answer.value->value = proof.exact ? nearest_double(*proof.exact) : proof.interval.low;
  }
  if (proof.level == convex::ProofLevel::none) return;
  const double middle = proof.interval.low + 0.5 * (proof.interval.high - proof.interval.low);
  answer.value->error = proof.error_of(answer.value->value);
  // Where doubles did not find the value, or missed it, the proof's is told.
  if (std::isfinite(middle) && 2 * proof.error_of(middle) < answer.value->error)
    answer.value = {middle, proof.error_of(middle)};
}

void write_proof(JsonWriter& json, const ConjugateAnswer& answer) {
  const convex::ProvedValue& proof = *answer.proof;
  json.key("certificate").begin_object().key("level").value(name(proof.level));
  json.key("error_bound").value(answer.value->error);
  if (proof.level == convex::ProofLevel::none)
    json.key("why").value(proof.why_none);
  else
    json.key("value").begin_array().value(proof.interval.low).value(proof.interval.high).end_array();
  json.end_object();
  if (proof.exact)
    json.key("exact").begin_object().key("value").value(convex::text(*proof.exact)).end_object();
}

std::string conjugate_json(const ConjugateQuestion& question, const ConjugateAnswer& answer) {
  const convex::Function& g = answer.g;
  const std::string& domain = answer.domain;
  JsonWriter json;
  json.begin_object().key("kind").value("conjugate").key("status").value(name(answer.status));
  json.key("f").value(to_text(question.f.call())).key("g").value(to_text(g.call()));
  json.key("entries").value(question.W.dimension()).key("domain");
  if (domain.empty())
    json.null();
  else
    json.value(domain);
  if (question.y) json.key("at").numbers(*question.y).key("value").value(answer.value->value);
  if (question.y) json.key("error_bound").value(answer.value->error);
  if (answer.proof) write_proof(json, answer);
  json.end_object();
  return json.text();
}

/// What is wrong with a value that is not known to the accuracy asked for.
std::string missing_accuracy(const convex::Function& g, const convex::Value& value) {
  if (std::isfinite(value.error)) return fmt::format("its error may be {:.1e}", value.error);
  if (std::isfinite(value.value)) return "nothing is known of its error";
  return std::string(g.facts().finite ? "g is finite here, but its value" : "whether it is infinite") +
         " was not found within the work of a question, or a number on the way is beyond the largest double, "
         "1.8e308; ask for --certify, or scale f or y";
}

std::string conjugate_text(const ConjugateQuestion& question, const ConjugateAnswer& answer) {
  const convex::Function& g = answer.g;
  const std::string& domain = answer.domain;
  const bool plain = question.W.kind() == convex::MetricKind::identity;
  std::string text = fmt::format("f = {}\ng = {}\n", to_text(question.f.call()), to_text(g.call()));
  text += fmt::format(
      "where g(y) = sup over x of {} - f(x){}\n", plain ? "x·y" : "x·Wy",
      question.f.dimension() == 0 && plain
          ? ""
          : fmt::format(", with {}", convex::counted(question.W.dimension(), "entry", "entries")));
  if (const std::string formula = plain ? conjugate_formula(question.f.call(), question.W.dimension()) : "";
      !formula.empty())
    text += "that is, g(y) = " + formula + "\n";
  text += fmt::format("domain of g: {}\n", domain.empty() ? "where the supremum is finite" : domain);
  if (question.y) {
    // All digits of the point: six of them may be those of one on the other side of the domain's edge.
    const bool is_told_below = answer.proof || answer.status != convex::Status::solved ||
                               (std::isinf(answer.value->value) && answer.value->error == 0);
    text += fmt::format("g([{}]) = {}{}\n", fmt::join(*question.y, ", "), number_text(answer.value->value),
                        is_told_below ? "" : ", error at most " + error_text(answer.value->error));
    if (answer.proof && answer.proof->exact) text += "exactly " + convex::text(*answer.proof->exact) + "\n";
    if (answer.proof)
      text += answer.proof->level == convex::ProofLevel::none
                  ? "NOT proved: " + answer.proof->why_none + ".\n"
              : std::isinf(answer.value->error)
                  ? "Proved: it is finite.\n"
                  : fmt::format("Proved: its error is at most {}.\n", error_text(answer.value->error));
    if (answer.status != convex::Status::solved)
      text += "NOT known to the accuracy that was asked for: " + missing_accuracy(g, *answer.value) + ".\n";
  }
  return text;
}

Exit tell_conjugate(const FunctionOptions& options) {
  Source source;
  return answered(options, source, [&] {
    const ConjugateQuestion question = read_question(options, source);
    const convex::Function g = question.f.conjugate(question.W);
    ConjugateAnswer answer{g, domain_text(g, question.W.dimension()), std::nullopt};
    if (question.y)
      answer.value = convex::decided_conjugate(written_question(question, options), g, *question.y);
    if (options.certify || in_fractions(options)) prove_value(question, options, answer);
    answer.status = status_of(answer.value, options);
    if (options.json)
      fmt::print("{}\n", conjugate_json(question, answer));
    else if (!options.quiet)
      fmt::print("{}", conjugate_text(question, answer));
    return answer.exit();
  });
}

}  // namespace

void add_conjugate(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<FunctionOptions>();
  CLI::App& command =
      add_command(program, "conjugate",
                  "the conjugate g of a function, as an expression; where it is finite; its value at a point",
                  chosen, [options] {
                    return options->symbolic ? tell_conjugate_in_symbols(*options) : tell_conjugate(*options);
                  });
  add_function(command, *options, false);
  add_accuracy(command, *options, "accept an error of the value of X * max(1, |g(y)|), default 1e-9",
               method_of_functions);
  add_proof(command, options->certify);
  add_symbols(command, *options);
  add_printing(command, *options);
}

}  // namespace cli::inline commands
