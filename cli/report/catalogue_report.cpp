#include "cli/report/catalogue_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/json_writer.hpp"
#include "convex/catalogue/references.hpp"

namespace cli::inline reports {
namespace {

using convex::CatalogueEntry;
using convex::EntryKind;
using convex::ParameterKind;

std::string joined(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// The three ways to a prox, or one when they are the same.
std::string prox_text(const CatalogueEntry& entry) {
  if (entry.in_identity == entry.in_diagonal && entry.in_diagonal == entry.in_general)
    return std::string(entry.in_identity);
  return fmt::format("identity: {}; diagonal: {}; general: {}", entry.in_identity, entry.in_diagonal,
                     entry.in_general);
}

convex::Facts shared_facts(const convex::Facts& f, const convex::Facts& g) {
  return {f.indicator && g.indicator,
          f.cone && g.cone,
          f.support && g.support,
          f.separable && g.separable,
          f.piecewise_quadratic && g.piecewise_quadratic,
          f.smooth && g.smooth,
          f.finite && g.finite};
}

}  // namespace

const char* name(EntryKind kind) {
  switch (kind) {
    case EntryKind::set:
      return "set";
    case EntryKind::function:
      return "function";
    case EntryKind::operation:
      return "operation";
  }
  return "";
}

const char* name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::number:
      return "number";
    case ParameterKind::vector:
      return "vector";
    case ParameterKind::matrix:
      return "matrix";
    case ParameterKind::set:
      return "set";
    case ParameterKind::function:
      return "function";
    case ParameterKind::functions:
      return "functions";
  }
  return "";
}

std::string arguments_text(const CatalogueEntry& entry) {
  std::vector<std::string> parts;
  for (const convex::Parameter& parameter : entry.parameters) {
    std::string part(parameter.name);
    if (parameter.kind == ParameterKind::functions) part += ", …";
    if (!parameter.fallback.empty()) part += "=" + std::string(parameter.fallback);
    parts.push_back(std::move(part));
  }
  return joined(parts, ", ");
}

std::vector<std::string> fact_words(const convex::Facts& facts) {
  std::vector<std::string> words;
  if (facts.cone)
    words.emplace_back("cone");
  else if (facts.indicator)
    words.emplace_back("indicator");
  if (facts.support) words.emplace_back("support function");
  if (facts.separable) words.emplace_back("separable");
  if (facts.piecewise_quadratic) words.emplace_back("piecewise linear-quadratic");
  if (facts.smooth) words.emplace_back("smooth");
  if (facts.finite) words.emplace_back("finite");
  return words;
}

CatalogueLine catalogue_line(const CatalogueEntry& entry) {
  convex::Facts shared{true, true, true, true, true, true, true};
  for (const std::string_view example : entry.examples) {
    const convex::Call call = parse_call(example, entry.name);
    const convex::Metric product = convex::Metric::identity(number_of_entries(call));
    shared = shared_facts(shared, convex::make_function(call, {product}).facts());
  }
  return {&entry, shared};
}

std::vector<CatalogueLine> catalogue_lines() {
  std::vector<CatalogueLine> lines;
  for (const CatalogueEntry& entry : convex::catalogue()) lines.push_back(catalogue_line(entry));
  return lines;
}

std::string catalogue_text(const std::vector<CatalogueLine>& lines) {
  std::vector<std::vector<std::string>> rows;
  for (const CatalogueLine& line : lines) {
    const CatalogueEntry& entry = *line.entry;
    rows.push_back({std::string(entry.name), arguments_text(entry), std::string(entry.formula),
                    joined(fact_words(line.facts), ", "), prox_text(entry)});
  }
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) line += fmt::format("{:<{}}  ", row[c], widths[c]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string catalogue_details(const CatalogueLine& line) {
  const CatalogueEntry& entry = *line.entry;
  std::string text =
      fmt::format("{}({}), a{} {}\n\n  {}\n\n", entry.name, arguments_text(entry),
                  entry.kind == EntryKind::operation ? "n" : "", name(entry.kind), entry.formula);
  for (const convex::Parameter& parameter : entry.parameters)
    text += fmt::format("{:<12}{}{}\n", parameter.name, name(parameter.kind),
                        parameter.fallback.empty() ? "" : fmt::format(", default {}", parameter.fallback));
  if (!entry.domain.empty()) text += fmt::format("{:<12}{}\n", "domain", entry.domain);
  if (const std::vector<std::string> words = fact_words(line.facts); !words.empty())
    text += fmt::format("{:<12}{}\n", "facts", joined(words, ", "));
  text += fmt::format("{:<12}{}\n{:<12}{}\n", "prox", prox_text(entry), "source", entry.source);
  for (const convex::Reference& work : convex::references_of(entry.source))
    text += fmt::format("{:<12}{}: {}\n", "", work.name, work.text);
  for (const std::string_view example : entry.examples) text += fmt::format("{:<12}{}\n", "example", example);
  return text;
}

std::string catalogue_json(const std::vector<CatalogueLine>& lines) {
  JsonWriter json;
  json.begin_object().key("functions").begin_array();
  for (const auto& [entry, facts] : lines) {
    json.begin_object().key("name").value(entry->name).key("kind").value(name(entry->kind));
    json.key("arguments").begin_array();
    for (const convex::Parameter& parameter : entry->parameters) {
      json.begin_object().key("name").value(parameter.name).key("kind").value(name(parameter.kind));
      json.key("default");
      if (parameter.fallback.empty())
        json.null();
      else
        json.value(parameter.fallback);
      json.end_object();
    }
    json.end_array().key("formula").value(entry->formula).key("facts").begin_array();
    for (const std::string& word : fact_words(facts)) json.value(word);
    json.end_array().key("prox").begin_object().key("identity").value(entry->in_identity);
    json.key("diagonal").value(entry->in_diagonal).key("general").value(entry->in_general).end_object();
    json.key("source").value(entry->source).key("examples").begin_array();
    for (const std::string_view example : entry->examples) json.value(example);
    json.end_array().end_object();
  }
  json.end_array().end_object();
  return json.text();
}

}  // namespace cli::inline reports
