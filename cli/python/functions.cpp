#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/python/arrays.hpp"
#include "cli/python/bindings.hpp"
#include "cli/python/expression.hpp"
#include "cli/python/user_function.hpp"
#include "convex/invalid_input.hpp"
#include "convex/proved_prox/proved_conjugate.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::Call;
using convex::CatalogueEntry;
using convex::Index;
using convex::InvalidInput;
using convex::NamedArgument;

std::shared_ptr<const Expression> expression_of(const Call& call) {
  const CatalogueEntry* const entry = call.made ? nullptr : convex::find_entry(call.name);
  if (entry != nullptr && entry->kind == convex::EntryKind::set) return std::make_shared<SetExpression>(call);
  return std::make_shared<Expression>(call);
}

convex::Argument argument_value(const py::handle& given, const std::string& name) {
  if (py::isinstance<Expression>(given))
    return std::make_shared<const Call>(py::cast<const Expression&>(given).call());
  const py::array_t<double> numbers = py::array_t<double>::ensure(given);
  if (!numbers) {
    PyErr_Clear();
    throw InvalidInput(name +
                       ": an argument is neither a number, a vector, a matrix with rows of one length, a set "
                       "nor a function; see its docstring");
  }
  if (numbers.ndim() == 0) return *numbers.data();
  if (numbers.ndim() == 1) return vector_of(given, name.c_str());
  return matrix_of(given, name.c_str());
}

/// Throws InvalidInput for names that there are not, here and inside. That shows without the space; the rest
/// does where the space is known.
void require_known(const Call& call) {
  if (call.made) return;
  const CatalogueEntry* const entry = convex::find_entry(call.name);
  if (entry == nullptr) throw InvalidInput(convex::unknown_entry(call.name), call.place);
  (void)convex::Arguments(*entry, call, {convex::Metric::identity(1)});
  for (const NamedArgument& argument : call.arguments)
    if (const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value))
      require_known(**nested);
}

/// The same for data that no number of entries makes possible, here and inside.
void require_possible(const Call& call) {
  expression_of(call)->require_possible();
  for (const NamedArgument& argument : call.arguments)
    if (const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value))
      require_possible(**nested);
}

/// name(arguments) as a call, its arguments matched to the entry's parameters.
Call call_of(const std::string& name, const py::args& positional, const py::kwargs& named) {
  Call call{name};
  for (const py::handle& given : positional) call.arguments.push_back({"", argument_value(given, name), {}});
  for (const auto& [key, given] : named)
    call.arguments.push_back({py::cast<std::string>(key), argument_value(given, name), {}});
  require_known(call);
  return call;
}

py::dict described(const CatalogueEntry& entry) {
  constexpr std::array<const char*, 3> kinds{"set", "function", "operation"};
  constexpr std::array<const char*, 6> parameter_kinds{"number", "vector",   "matrix",
                                                       "set",    "function", "functions"};
  const auto text = [](std::string_view view) { return py::str(std::string(view)); };
  py::dict made;
  made["name"] = text(entry.name);
  made["kind"] = kinds[static_cast<std::size_t>(entry.kind)];
  py::list parameters;
  for (const convex::Parameter& parameter : entry.parameters)
    parameters.append(py::make_tuple(text(parameter.name),
                                     parameter_kinds[static_cast<std::size_t>(parameter.kind)],
                                     text(parameter.fallback)));
  made["parameters"] = parameters;
  made["formula"] = text(entry.formula);
  made["source"] = text(entry.source);
  made["domain"] = text(entry.domain);
  made["prox"] = py::make_tuple(text(entry.in_identity), text(entry.in_diagonal), text(entry.in_general));
  py::list examples;
  for (const std::string_view example : entry.examples) examples.append(text(example));
  made["examples"] = examples;
  return made;
}

convex::Value known_value(const Expression& f, const py::object& x, const py::object& W) {
  const convex::Vector point = vector_of(x, "x");
  const convex::Metric metric = metric_of(W, point.size(), "W");
  const convex::Function made = f.in(metric);
  const py::gil_scoped_release released;
  return convex::decided_value(made, metric, point);
}

/// f(x), with a warning where the error may be more than the accuracy that a value is expected to have.
double value(const Expression& f, const py::object& x, const py::object& W) {
  constexpr double expected = 1e-9;
  const convex::Value found = known_value(f, x, W);
  const double size = std::isfinite(found.value) ? std::max(1.0, std::abs(found.value)) : 1;
  if (!(found.error <= expected * size)) {
    const std::string text = "f(x) = " + convex::to_text(found.value) + " is not known to 1e-9: " +
                             (std::isfinite(found.error) ? "its error may be " + convex::to_text(found.error)
                                                         : std::string("nothing is known of its error")) +
                             "; f.evaluate(x) gives both";
    if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), 1) < 0) throw py::error_already_set();
  }
  return found.value;
}

std::shared_ptr<const Expression> conjugate(const Expression& f, const py::object& W) {
  const Index n = W.is_none() ? cli::number_of_entries(f.call()) : 0;
  const convex::Metric metric = metric_of(W, n, "W");
  const convex::Function made = f.in(metric);
  const py::gil_scoped_release released;
  return expression_of(made.conjugate(metric).call());
}

using Shared = std::shared_ptr<Expression>;

/// In C++ an expression does not change; pybind11 holds pointers to what might.
Shared shared(const Call& call) { return std::const_pointer_cast<Expression>(expression_of(call)); }

Call scaled(const Expression& f, double alpha) {
  return {"scale", {convex::argument(f.call()), {"", alpha, {}}}};
}

/// f + g, the sums among them opened: sum(f, g, h).
Call sum_of(const Call& f, const Call& g) {
  Call made{"sum"};
  for (const Call* part : {&f, &g}) {
    if (part->name == "sum" && !part->made)
      made.arguments.insert(made.arguments.end(), part->arguments.begin(), part->arguments.end());
    else
      made.arguments.push_back(convex::argument(*part));
  }
  return made;
}

Call raised(const Expression& f, double c) {
  return c == 0 ? f.call() : sum_of(f.call(), Call{"constant", {{"", c, {}}}});
}

/// The operators of Python: 2*f + g, f @ A for f(Ax), C & D for an intersection.
void add_operators(py::class_<Expression, Shared>& type) {
  const auto not_positive = [](double alpha) {
    if (!(alpha > 0))
      throw InvalidInput("a function times " + convex::to_text(alpha) +
                         (alpha == 0 ? ": 0 on its domain or everywhere, which this does not tell; write the "
                                       "indicator of the domain, or zero()"
                                     : " is not convex; give a positive number"));
  };
  const auto times = [not_positive](const Expression& f, double alpha) {
    not_positive(alpha);
    return shared(scaled(f, alpha));
  };
  type.def(
          "__add__",
          [](const Expression& f, const Expression& g) { return shared(sum_of(f.call(), g.call())); },
          py::is_operator())
      .def(
          "__add__", [](const Expression& f, double c) { return shared(raised(f, c)); }, py::is_operator())
      .def(
          "__radd__", [](const Expression& f, double c) { return shared(raised(f, c)); }, py::is_operator())
      .def(
          "__sub__", [](const Expression& f, double c) { return shared(raised(f, -c)); }, py::is_operator())
      .def(
          "__sub__",
          [](const Expression&, const Expression&) -> double {
            throw py::type_error(
                "f - g: a difference of convex functions is not convex in general; f + g is");
          },
          py::is_operator())
      .def("__mul__", times, py::is_operator())
      .def("__rmul__", times, py::is_operator())
      .def(
          "__truediv__", [times](const Expression& f, double alpha) { return times(f, 1 / alpha); },
          py::is_operator())
      .def(
          "__matmul__",
          [](const Expression& f, const py::object& A) {
            return shared({"precompose", {convex::argument(f.call()), {"", matrix_of(A, "A"), {}}}});
          },
          py::is_operator());
}

}  // namespace

void add_functions(py::module_& module) {
  py::class_<Expression, Shared> type(
      module, "Function", R"(A convex, closed, proper function, as an expression of docs/functions.md.

It is made by the functions of this module, such as norm1(weight=2), and by operators: 2*f, f + g, f + 1, f @ A
for x -> f(Ax). Envelopes, supports and proximal averages take the product of the metric that they meet.)");
  add_operators(type);
  type.def("__call__", value, py::arg("x"), py::arg("W") = py::none(),
           "f(x), inf outside the domain; a RuntimeWarning where it is not known to 1e-9.")
      .def(
          "evaluate",
          [](const Expression& f, const py::object& x, const py::object& W) {
            const convex::Value found = known_value(f, x, W);
            return py::make_tuple(found.value, found.error);
          },
          py::arg("x"), py::arg("W") = py::none(),
          "f(x) and a bound of its error, inf where nothing is known.")
      .def(
          "conjugate",
          [](const Expression& f, const py::object& W) {
            return std::const_pointer_cast<Expression>(conjugate(f, W));
          },
          py::arg("W") = py::none(),
          "g(y) = sup over x of x.Wy - f(x), as an expression; W: the identity unless given.")
      .def_property_readonly(
          "text", [](const Expression& f) { return to_text(f.call()); },
          "The expression in the language of docs/functions.md.")
      .def_property_readonly("name", [](const Expression& f) { return f.call().name; })
      .def_property_readonly("is_user", [](const Expression& f) { return f.call().made != nullptr; })
      .def("__repr__", [](const Expression& f) { return to_text(f.call()); });
  py::class_<SetExpression, Expression, std::shared_ptr<SetExpression>>(
      module, "Set", "A closed convex set. Where a function is wanted it stands for its indicator.")
      .def(
          "__contains__",
          [](const SetExpression& set, const py::object& x) {
            return known_value(set, x, py::none()).value == 0;
          },
          py::arg("x"), "Is x in the set, up to the membership tolerance?")
      .def(
          "__and__",
          [](const SetExpression& a, const SetExpression& b) {
            return shared({"intersection", {convex::argument(a.call()), convex::argument(b.call())}});
          },
          py::is_operator());
  module.def("call", [](const std::string& name, const py::args& positional, const py::kwargs& named) {
    const Shared made = shared(call_of(name, positional, named));
    made->require_possible();
    return made;
  });
  module.def("parse", [](const std::string& text) {
    const Call call = cli::parse_known_call(text, "f");
    require_known(call);
    require_possible(call);
    return shared(call);
  });
  module.def("user", [](py::object user_value, py::object prox, Index n, const std::string& name) {
    return shared(user_function(std::move(user_value), std::move(prox), n, name)->call());
  });
  module.def("catalogue", [] {
    py::list made;
    for (const CatalogueEntry& entry : convex::catalogue()) made.append(described(entry));
    return made;
  });
}

}  // namespace python
