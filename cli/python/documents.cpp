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
    answer = cli::solve_problem(document.problem, document.name, options);
  }
  return py::make_tuple(answer.text, answer.warnings);
}

void draw(const Document& document, const std::string& file, const py::dict& given) {
  cli::SolveOptions options = options_of(given);
  options.plot = file;
  const py::gil_scoped_release released;
  cli::require_drawable(file);
  cli::solve_problem(document.problem, document.name, options);
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

}  // namespace

Document read_document(const std::string& source, bool is_text, const std::vector<std::string>& settings,
                       const std::string& name) {
  const std::string file = is_text ? name : source;
  return {
      cli::read_problem_document(is_text ? cli::parse_json(source) : read_named(source), file, {settings}),
      file};
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
