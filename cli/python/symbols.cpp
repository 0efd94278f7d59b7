#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/python/arrays.hpp"
#include "cli/python/bindings.hpp"
#include "cli/python/expression.hpp"
#include "cli/python/fractions.hpp"
#include "cli/report/symbolic_report.hpp"
#include "convex/invalid_input.hpp"
#include "convex/symbolic/function_of_call.hpp"

namespace py = pybind11;

namespace python {
namespace {

namespace symbolic = convex::symbolic;
using convex::Fraction;
using convex::InvalidInput;

/// A function of one variable by cases, with its name.
struct Formula {
  std::string left, variable;
  symbolic::Cases cases;
};

/// A Fraction, or the nearest float of a root or a term.
py::object bound(const std::optional<symbolic::Bound>& value) {
  if (!value) return py::none();
  const auto& surd = value->surd();
  if (!surd || !surd->is_rational()) return py::float_(nearest_double(*value));
  return fraction_list({surd->rational_part()})[py::int_(0)];
}

py::list cases_of(const Formula& formula) {
  py::list made;
  for (const symbolic::Case& one : formula.cases) {
    py::dict each;
    each["low"] = bound(one.low);
    each["high"] = bound(one.high);
    each["low_included"] = one.low.has_value() && one.has_low;
    each["high_included"] = one.high.has_value() && one.has_high;
    each["formula"] = symbolic::text(one.term);
    each["latex"] = symbolic::latex(one.term);
    made.append(each);
  }
  return made;
}

std::string text_of(const Formula& formula) {
  return cli::cases_text(formula.left, formula.variable, formula.cases);
}

/// f with its product w x y, in symbols.
struct Symbols {
  symbolic::Function f;
  Fraction w;
};

Symbols symbols_of(const Expression& f, const py::object& W) {
  if (has_user_function(f.call()))
    throw InvalidInput(
        "symbolic: the function is one of your own; give one of the language, docs/functions.md");
  const convex::ExactGram gram = gram_of(W, 1);
  if (gram.dimension() != 1) throw InvalidInput("W: symbols have one variable; give one number, [[2]]");
  const Fraction w = gram.rows[0].at(0);
  (void)f.in(rounded(gram));  // what the language refuses, symbols refuse with the same words
  return {symbolic::function_of(f.call(), w), w};
}

Formula itself(const Expression& f, const py::object& W) {
  return {"f(x)", "x", symbolic::formula(symbols_of(f, W).f)};
}
Formula prox_formula(const Expression& f, const py::object& W) {
  const Symbols made = symbols_of(f, W);
  return {"prox_f(z)", "z", symbolic::prox_formula(made.f, Fraction{1, 1} / made.w)};
}
Formula conjugate_formula(const Expression& f, const py::object& W) {
  const Symbols made = symbols_of(f, W);
  // f*(w y) is the conjugate of f(x/w).
  return {"g(y)", "y", symbolic::conjugate_formula(symbolic::dilate(made.f, made.w))};
}

}  // namespace

void add_symbols(py::module_& module) {
  py::class_<Formula>(module, "Formula", R"(A function of one variable by cases, exactly or by rules.

Called with a number, or an array of them, it gives the values there, inf outside of all cases.)")
      .def("__call__", py::vectorize([](Formula& formula, double at) {
             return evaluate(formula.cases, formula.variable, at);
           }),
           py::arg("at"))
      .def_property_readonly("text", text_of, "the cases, a line each")
      .def_property_readonly(
          "latex",
          [](const Formula& formula) {
            return cli::cases_latex(formula.left, formula.variable, formula.cases);
          },
          "as a formula of amsmath")
      .def_property_readonly("cases", cases_of,
                             "a list of dicts: low, high, low_included, high_included, formula, latex")
      .def("_repr_latex_",
           [](const Formula& formula) {
             return cli::cases_latex(formula.left, formula.variable, formula.cases);
           })
      .def("__repr__", text_of);
  module.def("formula", itself);
  module.def("prox_formula", prox_formula);
  module.def("conjugate_formula", conjugate_formula);
}

}  // namespace python
