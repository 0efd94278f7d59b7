#include "cli/report/symbolic_report.hpp"

#include <fmt/format.h>

#include "cli/json_writer.hpp"

namespace cli::inline reports {
namespace {

namespace symbolic = convex::symbolic;

std::string shown(const symbolic::Bound& value, bool latex) {
  return latex ? symbolic::latex(value) : symbolic::text(value);
}

/// "x <= 1", "0 < x < 1", "x = 3", "for all x".
std::string condition(const symbolic::Case& one, const std::string& v, bool latex) {
  const std::string less = latex ? " < " : " < ", at_most = latex ? " \\le " : " <= ";
  if (one.low && one.high && *one.low == *one.high) return v + " = " + shown(*one.low, latex);
  if (!one.low && !one.high) return latex ? v + " \\in \\mathbb{R}" : "for all " + v;
  if (!one.low) return v + (one.has_high ? at_most : less) + shown(*one.high, latex);
  if (!one.high)
    return v + (one.has_low ? (latex ? " \\ge " : " >= ") : (latex ? " > " : " > ")) + shown(*one.low, latex);
  return shown(*one.low, latex) + (one.has_low ? at_most : less) + v + (one.has_high ? at_most : less) +
         shown(*one.high, latex);
}

/// Whether the cases leave a part of the line out.
bool leaves_out(const NamedCases& named) {
  return !named.is_finite_everywhere && (named.cases.front().low || named.cases.back().high);
}

}  // namespace

std::string as_text(const NamedCases& named) {
  std::vector<std::pair<std::string, std::string>> lines;
  std::size_t wide = 0;
  for (const symbolic::Case& one : named.cases) {
    lines.emplace_back(symbolic::text(one.term), condition(one, named.variable, false));
    wide = std::max(wide, lines.back().first.size());
  }
  if (leaves_out(named)) {
    lines.emplace_back("+inf", "elsewhere");
    wide = std::max(wide, lines.back().first.size());
  }
  std::string text;
  for (const auto& [term, where] : lines)
    text +=
        fmt::format("{} {}  {:<{}}   {}\n", text.empty() ? named.left : std::string(named.left.size(), ' '),
                    text.empty() ? "=" : " ", term, wide, where);
  return text;
}

std::string as_latex(const NamedCases& named) {
  std::string text = "\\[\n" + named.left + " = \\begin{cases}\n";
  for (const symbolic::Case& one : named.cases)
    text += "  " + symbolic::latex(one.term) + " & " + condition(one, named.variable, true) + " \\\\\n";
  if (leaves_out(named)) text += "  +\\infty & \\text{otherwise} \\\\\n";
  return text + "\\end{cases}\n\\]\n";
}

std::string cases_text(const std::string& left, const std::string& variable, const symbolic::Cases& cases) {
  return as_text({left, variable, cases, left == "prox_f(z)"});
}

std::string cases_latex(const std::string& left, const std::string& variable, const symbolic::Cases& cases) {
  const bool is_prox = left == "prox_f(z)";
  return as_latex({is_prox ? "\\operatorname{prox}_f(z)" : left, variable, cases, is_prox});
}

void write_cases(JsonWriter& json, const symbolic::Cases& cases) {
  json.begin_array();
  const auto bound = [&](const char* key, const std::optional<symbolic::Bound>& value) {
    json.key(key);
    if (value)
      json.value(symbolic::text(*value));
    else
      json.null();
  };
  for (const symbolic::Case& one : cases) {
    json.begin_object();
    bound("low", one.low);
    bound("high", one.high);
    json.key("low_included")
        .value(one.low && one.has_low)
        .key("high_included")
        .value(one.high && one.has_high);
    json.key("formula").value(symbolic::text(one.term)).key("latex").value(symbolic::latex(one.term));
    json.end_object();
  }
  json.end_array();
}

}  // namespace cli::inline reports
