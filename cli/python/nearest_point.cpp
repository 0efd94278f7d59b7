#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/python/arrays.hpp"
#include "cli/python/batch.hpp"
#include "cli/python/bindings.hpp"
#include "cli/python/options.hpp"
#include "cli/python/solved_numbers.hpp"
#include "cli/report/answer.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::Index;
using convex::InvalidInput;
using Solved = SolvedNumbers;

SolveChoice choice_of(const py::object& method, const py::object& tolerance) {
  SolveChoice choice{&convex::methods().front(), {}};
  choice.accuracy.tolerance = positive(tolerance, "tolerance");
  if (method.is_none()) return choice;
  const auto name = option<std::string>(method, "method");
  choice.method = convex::find_method(name);
  if (choice.method != nullptr) return choice;
  std::vector<std::string> known;
  for (const convex::Method& one : convex::methods()) known.emplace_back(one.name);
  throw InvalidInput("unknown method \"" + name + "\"; " +
                     convex::suggestion(name, known, "moreau.methods() lists them"));
}

std::shared_ptr<Solved> solve_numbers(const py::object& A, const py::object& z, const py::object& U,
                                      const py::object& s, const py::object& two_sided,
                                      const py::object& method, const py::object& tolerance) {
  convex::Vector force = vector_of(z, "z");
  const Index n = force.size();
  convex::NearestPointProblem problem{
      metric_of(A, n, "A"),
      std::move(force),
      U.is_none() ? convex::ConstraintRows(convex::RowMatrix(0, n)) : rows_of(U, "U"),
      {},
      {}};
  problem.s = s.is_none() ? convex::Vector::Zero(problem.rows()) : vector_of(s, "s");
  if (!two_sided.is_none()) problem.two_sided = row_numbers(two_sided, "two_sided");
  const SolveChoice choice = choice_of(method, tolerance);
  const py::gil_scoped_release released;
  return std::make_shared<Solved>(std::move(problem), choice);
}

/// `solved` where there is an answer, else an error that says why there is none.
const Solved& answered(const Solved& solved) {
  if (!solved.has_answer())
    throw InvalidInput(std::string("there is no answer: the problem is ") +
                       cli::name(solved.solution().status) + "; look at status and farkas");
  return solved;
}

py::dict residuals(const Solved& solved) {
  const convex::Residuals& found = solved.solution().residuals;
  py::dict made;
  made["feasibility"] = found.feasibility;
  made["complementarity"] = found.complementarity;
  made["stationarity"] = found.stationarity;
  made["duality_gap"] = found.duality_gap;
  return made;
}

py::object ranges(const Solved& solved) {
  const auto& all = answered(solved).multipliers().ranges;
  if (!all) return py::none();
  py::array_t<double> made({static_cast<py::ssize_t>(all->size()), py::ssize_t{2}});
  auto entries = made.mutable_unchecked<2>();
  for (std::size_t a = 0; a < all->size(); ++a) {
    entries(static_cast<py::ssize_t>(a), 0) = (*all)[a].low;
    entries(static_cast<py::ssize_t>(a), 1) = (*all)[a].high;
  }
  return made;
}

double gauss(const Solved& solved) {
  const convex::Vector& q = answered(solved).solution().q;
  return 0.5 * solved.problem().A.inner(q, q) - solved.problem().z.dot(q);
}

const Solved& solved_of(const py::object& self) { return py::cast<const Solved&>(self); }

}  // namespace

void add_nearest_point(py::module_& module) {
  py::class_<Solved, std::shared_ptr<Solved>>(module, "Solution",
                                              R"(The answer to a problem given by A, z, U and s.

Find q'' that minimises 1/2 q''.A q'' - z.q'' over U q'' >= s (Moreau 1966, (10)). Arrays are views, not copies.)")
      .def_property_readonly(
          "status", [](const Solved& solved) { return cli::name(solved.solution().status); },
          "'solved', 'inaccurate', 'infeasible' or 'gave-up'")
      .def_property_readonly(
          "acceleration",
          [](const py::object& self) { return view_of(answered(solved_of(self)).solution().q, self); },
          "q'', n numbers")
      .def_property_readonly(
          "multipliers",
          [](const py::object& self) {
            return view_of(answered(solved_of(self)).multipliers().least_norm, self);
          },
          "lambda, one a row; of least norm where they are not unique")
      .def_property_readonly(
          "multipliers_unique", [](const Solved& solved) { return answered(solved).multipliers().unique; },
          "whether the dual optimum is one point")
      .def_property_readonly(
          "multiplier_ranges", ranges,
          "the interval of each multiplier over all dual optima, m by 2; None beyond 1000 rows")
      .def_property_readonly(
          "reaction",
          [](const py::object& self) { return view_of(answered(solved_of(self)).reaction(), self); },
          "R = sum lambda_a u_a = A q'' - z")
      .def_property_readonly(
          "slack",
          [](const py::object& self) { return view_of(answered(solved_of(self)).solution().slack, self); },
          "U q'' - s")
      .def_property_readonly(
          "active", [](const Solved& solved) { return answered(solved).multipliers().tight; },
          "the rows with u_a.q'' = s_a")
      .def_property_readonly("gauss", gauss, "G = 1/2 q''.A q'' - z.q''")
      .def_property_readonly("residuals", residuals, "relative residuals, by name")
      .def_property_readonly(
          "error_bound", [](const Solved& solved) { return solved.solution().error_bound; },
          "an estimate of ||q'' - q''_exact||_A that takes the conditioning in")
      .def_property_readonly("method",
                             [](const Solved& solved) { return std::string(solved.solution().method); })
      .def_property_readonly("steps", [](const Solved& solved) { return solved.solution().steps; })
      .def_property_readonly(
          "farkas",
          [](const py::object& self) -> py::object {
            const convex::Vector& weights = solved_of(self).solution().farkas;
            return weights.size() == 0 ? py::none() : view_of(weights, self);
          },
          "of an infeasible problem: w >= 0 on one-sided rows, w.U = 0, w.s > 0; else None");
  module.def("solve_numbers", solve_numbers, py::arg("A"), py::arg("z"), py::arg("U"), py::arg("s"),
             py::arg("two_sided"), py::arg("method"), py::arg("tolerance"));
  module.def("solve_batch",
             [](const py::object& A, const py::object& z, const py::object& U, const py::object& s,
                const py::object& two_sided, const py::object& method, const py::object& tolerance) {
               return solve_batch(A, z, U, s, two_sided, choice_of(method, tolerance));
             });
  module.def(
      "methods",
      [] {
        py::dict made;
        for (const convex::Method& method : convex::methods())
          made[py::str(std::string(method.name))] = py::str(std::string(method.summary));
        return made;
      },
      "The methods of solution, each with a line about it.");
}

}  // namespace python
