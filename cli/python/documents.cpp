#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/commands/solve.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/python/bindings.hpp"
#include "cli/python/document.hpp"
#include "cli/python/options.hpp"
#include "cli/python/solved_numbers.hpp"
#include "convex/invalid_input.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::InvalidInput;

/// The options of `moreau solve` by their names.
cli::SolveOptions options_of(const py::dict& given) {
  require_options(given, {"method", "tolerance", "limit", "certify", "ranges", "sensitivity", "null_space",
                          "verbose", "plane", "onset", "probes"});
  cli::SolveOptions options;
  take(options.method, given, "method");
  take_positive(options.tolerance, given, "tolerance");
  take(options.limit, given, "limit");
  take(options.certify, given, "certify");
  take(options.ranges, given, "ranges");
  take(options.sensitivity, given, "sensitivity");
  take(options.null_space, given, "null_space");
  take(options.verbose, given, "verbose");
  take(options.plane, given, "plane");
  take(options.liquid.onset, given, "onset");
  take(options.liquid.probes, given, "probes");
  return options;
}

py::tuple answer_of(const Document& document, const py::dict& given, bool json) {
  cli::SolveOptions options = options_of(given);
  options.json = json;
  cli::Answer answer;
  {
    const py::gil_scoped_release released;
    answer = told_by_keys(document.dict,
                          [&] { return cli::solve_problem(document.problem, document.name, options); });
  }
  return py::make_tuple(answer.text, answer.warnings);
}

void draw(const Document& document, const std::string& file, const py::dict& given) {
  cli::SolveOptions options = options_of(given);
  options.plot = file;
  const py::gil_scoped_release released;
  cli::require_drawable(file);
  told_by_keys(document.dict, [&] { cli::solve_problem(document.problem, document.name, options); });
}

/// A problem of numbers as the [projection] of a file.
Document document_of(const SolvedNumbers& solved) {
  cli::Problem problem;
  problem.content = cli::ProjectionProblem{solved.problem()};
  problem.solve.tolerance = solved.tolerance();
  return {std::move(problem), "numbers"};
}

/// A file that is not there has no place in a text, so it is named.
auto read_named(const std::string& file) {
  try {
    return cli::read_document(file);
  } catch (const InvalidInput& error) {
    if (error.place()) throw;
    throw InvalidInput(file + ": " + error.what());
  }
}

bool is_behind(convex::Place one, convex::Place other) {
  return std::pair(one.line, one.column) > std::pair(other.line, other.column);
}

/// The keys of what stands at a place, "state.position.x", "projection.A[1][0]"; "" of the whole.
std::string key_at(const cli::TomlValue& value, convex::Place at) {
  const cli::TomlEntry* entry = nullptr;
  for (const cli::TomlEntry& one : value.table)
    if (!is_behind(one.place, at)) entry = &one;
  if (entry != nullptr) {
    const std::string within = key_at(entry->value, at);
    return entry->key + (within.empty() || within[0] == '[' ? "" : ".") + within;
  }
  std::size_t behind = 0;
  while (behind < value.array.size() && !is_behind(value.array[behind].place, at)) ++behind;
  if (behind == 0) return "";
  const std::string within = key_at(value.array[behind - 1], at);
  return "[" + std::to_string(behind - 1) + "]" + (within.empty() || within[0] == '[' ? "" : ".") + within;
}

}  // namespace

InvalidDict::InvalidDict(const InvalidInput& error, const cli::TomlValue& dict) : InvalidInput(error) {
  const auto add = [&](const InvalidInput& one) {
    keys.push_back(one.place() ? key_at(dict, *one.place()) : "");
  };
  add(error);
  for (const InvalidInput& other : error.others()) add(other);
}

Document read_document(const std::string& source, bool is_text, const std::vector<std::string>& settings,
                       const std::string& name) {
  if (!is_text) return {cli::read_problem_document(read_named(source), source, {settings}), source};
  const auto dict = std::make_shared<const cli::TomlValue>(cli::parse_json(source));
  return {told_by_keys(dict, [&] { return cli::read_problem_document(*dict, name, {settings}); }), name,
          dict};
}

void add_documents(py::module_& module) {
  py::class_<Document, std::shared_ptr<Document>>(module, "Document")
      .def(py::init([](const std::string& source, bool is_text, const std::vector<std::string>& settings,
                       const std::string& name) {
        const py::gil_scoped_release released;
        return std::make_shared<Document>(read_document(source, is_text, settings, name));
      }))
      .def("json", [](const Document& document,
                      const py::dict& options) { return answer_of(document, options, true); })
      .def("text", [](const Document& document,
                      const py::dict& options) { return answer_of(document, options, false); })
      .def("draw", draw)
      .def_readonly("name", &Document::name);
  module.def("document_of",
             [](const SolvedNumbers& solved) { return std::make_shared<Document>(document_of(solved)); });
  module.def("can_draw", cli::has_gnuplot);
}

}  // namespace python
