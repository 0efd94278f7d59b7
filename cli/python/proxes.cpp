#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/python/arrays.hpp"
#include "cli/python/batch.hpp"
#include "cli/python/bindings.hpp"
#include "cli/python/expression.hpp"
#include "cli/python/fractions.hpp"
#include "cli/python/options.hpp"
#include "cli/report/answer.hpp"
#include "cli/report/decomposition_report.hpp"
#include "convex/counted.hpp"
#include "convex/functions/decomposition.hpp"
#include "convex/invalid_input.hpp"
#include "convex/proved_prox/proved_split.hpp"
#include "convex/sets/subdifferential.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::Index;
using convex::InvalidInput;
using convex::RowMatrix;
using convex::Vector;

/// The rows of z as points.
RowMatrix points_of(const py::object& z) {
  const convex::Matrix given = matrix_of(z, "z");
  if (!given.allFinite()) throw InvalidInput("z: an entry is not finite; give finite numbers");
  return given;
}

/// x = prox_f z with its status and error bound: (x, status, error_bound, route).
py::tuple prox(const Expression& f, const py::object& z, const py::object& W) {
  const Vector point = vector_of(z, "z");
  if (!point.allFinite()) throw InvalidInput("z: an entry is not finite; give finite numbers");
  const convex::Metric metric = metric_of(W, point.size(), "W");
  if (metric.dimension() != point.size())
    throw InvalidInput("W: " + convex::counted(metric.dimension(), "row", "rows") + "; give " +
                       std::to_string(point.size()) + ", one per entry of z");
  const convex::Function made = f.in(metric);
  convex::Prox found;
  {
    const py::gil_scoped_release released;
    found = made.prox(point, metric);
  }
  return py::make_tuple(array_of(found.x), cli::name(found.status), found.error_bound, found.method);
}

/// The same of each row of z: (x, codes of status, error bounds).
py::tuple prox_batch(const Expression& f, const py::object& z, const py::object& W) {
  const RowMatrix points = points_of(z);
  const convex::Metric metric = metric_of(W, points.cols(), "W");
  if (metric.dimension() != points.cols())
    throw InvalidInput("W: " + convex::counted(metric.dimension(), "row", "rows") + "; give " +
                       std::to_string(points.cols()) + ", one per entry of a point");
  const convex::Function made = f.in(metric);
  py::array_t<double> x({points.rows(), points.cols()}), bound(points.rows());
  py::array_t<std::uint8_t> status(points.rows());
  Eigen::Map<RowMatrix> into(x.mutable_data(), points.rows(), points.cols());
  double* const bounds = bound.mutable_data();
  std::uint8_t* const codes = status.mutable_data();
  {
    const py::gil_scoped_release released;
    in_chunks(points.rows(), [&](Index first, Index last) {
      for (Index k = first; k < last; ++k) {
        const convex::Prox found = made.prox(points.row(k), metric);
        if (found.x.size() == points.cols())
          into.row(k) = found.x;
        else
          into.row(k).setConstant(std::numeric_limits<double>::quiet_NaN());
        bounds[k] = found.error_bound;
        codes[k] = static_cast<std::uint8_t>(found.status);
      }
    });
  }
  return py::make_tuple(x, status, bound);
}

/// A point split in two, what it was made of, and what is proved of it.
struct Split {
  std::string f;
  Vector z;
  convex::Decomposition parts;
  std::optional<convex::ProvedSplit> proof = {};
};

std::shared_ptr<Split> decompose(const Expression& f, const py::object& z, const py::object& W,
                                 const py::object& tolerance) {
  const double close = positive(tolerance, "tolerance");
  Vector point = vector_of(z, "z");
  const convex::Metric metric = metric_of(W, point.size(), "W");
  const convex::Function made = f.in(metric);
  const std::string text = to_text(f.call());
  const py::gil_scoped_release released;
  convex::Decomposition parts = convex::decompose(made, point, metric, close);
  return std::make_shared<Split>(Split{text, std::move(point), std::move(parts)});
}

/// What fractions are taken of: z and W as they are written, f of the language.
struct ExactQuestion {
  convex::SplitQuestion question;
  convex::Metric W;
};

ExactQuestion exact_question(const Expression& f, const py::object& z, const py::object& W,
                             const char* what) {
  if (has_user_function(f.call()))
    throw InvalidInput(std::string(what) +
                       ": the function is one of your own; give one of the language, docs/functions.md");
  convex::Fractions point = fractions_of(z, "z");
  const auto n = static_cast<Index>(point.size());
  convex::ExactGram gram = gram_of(W, n);
  if (gram.dimension() != point.size())
    throw InvalidInput("W: " + convex::counted(gram.dimension(), "row", "rows") + "; give " +
                       std::to_string(n) + ", one per entry of z");
  convex::Metric metric = rounded(gram);
  return {{f.call(), std::move(point), std::move(gram)}, std::move(metric)};
}

std::shared_ptr<Split> proved_decomposition(const Expression& f, const py::object& z, const py::object& W,
                                            const py::object& tolerance) {
  const double close = positive(tolerance, "tolerance");
  const ExactQuestion exact = exact_question(f, z, W, "certify");
  const convex::Function made = f.in(exact.W);
  Vector point = nearest(exact.question.z);
  const py::gil_scoped_release released;
  convex::Decomposition parts = convex::decompose(made, point, exact.W, close);
  convex::ProvedSplit proof = convex::prove(exact.question, parts);
  return std::make_shared<Split>(
      Split{to_text(f.call()), std::move(point), std::move(parts), std::move(proof)});
}

py::dict proof_of(const convex::ProvedSplit& proof) {
  const auto ends = [](const convex::ProvedInterval& interval) {
    return py::make_tuple(interval.low, interval.high);
  };
  py::dict made;
  made["level"] = cli::name(proof.level);
  if (proof.level == convex::ProofLevel::none) {
    made["why"] = proof.why_none;
    return made;
  }
  made["error_bound"] = proof.error_bound();
  made["x"] = proof.x_bound;
  made["y"] = proof.y_bound;
  made["f_x"] = ends(proof.f_x);
  made["g_y"] = ends(proof.g_y);
  made["inner"] = ends(proof.inner);
  made["sum"] = proof.sum_miss;
  return made;
}

/// x and y in fractions, f(x), g(y), (x|y).
py::tuple exact_decomposition(const Expression& f, const py::object& z, const py::object& W) {
  const ExactQuestion exact = exact_question(f, z, W, "exact");
  (void)f.in(exact.W)(nearest(exact.question.z));  // checks the number of entries
  convex::ExactSplit split;
  {
    const py::gil_scoped_release released;
    split = convex::exact_split(exact.question);
  }
  return py::make_tuple(fraction_list(split.x), fraction_list(split.y),
                        fraction_list({split.f_x, split.g_y, split.inner}));
}

/// (prox_f(z + t d) - prox_f z)/t for t -> 0, t > 0.
py::object derivative(const Expression& f, const py::object& z, const py::object& d, const py::object& W) {
  const ExactQuestion exact = exact_question(f, z, W, "prox_derivative");
  const convex::Fractions direction = fractions_of(d, "d");
  if (direction.size() != exact.question.z.size())
    throw InvalidInput("d: " + convex::counted(direction.size(), "entry", "entries") + "; give " +
                       std::to_string(exact.question.z.size()) + ", as z has");
  (void)f.in(exact.W)(nearest(exact.question.z));
  convex::Fractions moved;
  {
    const py::gil_scoped_release released;
    moved = convex::prox_derivative(exact.question.f, exact.question.W, exact.question.z, direction);
  }
  return fraction_list(moved);
}

py::object jacobian(const Expression& f, const py::object& z, const py::object& W) {
  const Vector point = vector_of(z, "z");
  const convex::Metric metric = metric_of(W, point.size(), "W");
  const RowMatrix made = convex::prox_jacobian(f.in(metric), point, metric);
  py::array_t<double> into({made.rows(), made.cols()});
  std::copy(made.data(), made.data() + made.size(), into.mutable_data());
  return into;
}

const Split& split_of(const py::object& self) { return py::cast<const Split&>(self); }

}  // namespace

void add_proxes(py::module_& module) {
  py::class_<Split, std::shared_ptr<Split>>(module, "Decomposition",
                                            R"(z = x + y, x = prox_f z, y = prox_g z (Moreau 1965).

g(y) = sup over x of (x|y) - f(x) is the conjugate in the metric; y is computed as the prox of g, never as z - x.)")
      .def_property_readonly("z", [](const py::object& self) { return view_of(split_of(self).z, self); })
      .def_property_readonly(
          "x", [](const py::object& self) { return view_of(split_of(self).parts.x.x, self); }, "prox_f z")
      .def_property_readonly(
          "y", [](const py::object& self) { return view_of(split_of(self).parts.y.x, self); }, "prox_g z")
      .def_property_readonly(
          "f", [](const Split& split) { return split.f; }, "f, as text")
      .def_property_readonly(
          "f_x", [](const Split& split) { return split.parts.f_x; }, "f(x)")
      .def_property_readonly(
          "g_y", [](const Split& split) { return split.parts.g_y; }, "g(y)")
      .def_property_readonly(
          "inner", [](const Split& split) { return split.parts.inner; }, "(x|y)")
      .def_property_readonly(
          "fenchel_gap", [](const Split& split) { return split.parts.fenchel_gap; },
          "f(x) + g(y) - (x|y), 0 but for rounding")
      .def_property_readonly(
          "residual", [](const Split& split) { return split.parts.residual; }, "||z - x - y||")
      .def_property_readonly(
          "error_bound", [](const Split& split) { return split.parts.error_bound; },
          "of ||x - x*|| and ||y - y*||, in the metric")
      .def_property_readonly("status", [](const Split& split) { return cli::name(split.parts.status); })
      .def_property_readonly(
          "proof",
          [](const Split& split) -> py::object {
            if (!split.proof) return py::none();
            return proof_of(*split.proof);
          },
          "where certify=True: level, error_bound, bounds of x and y, enclosures of f_x, g_y, inner; None "
          "else")
      .def_property_readonly(
          "route",
          [](const Split& split) {
            py::dict made;
            made["x"] = split.parts.x.method;
            made["y"] = split.parts.y.method;
            return made;
          },
          "how x and y were found");
  module.def("proved_decomposition", proved_decomposition);
  module.def("exact_decomposition", exact_decomposition);
  module.def("prox_derivative", derivative);
  module.def("prox_jacobian", jacobian);
  module.def("prox", prox);
  module.def("prox_batch", prox_batch);
  module.def(
      "decompose", decompose, py::arg("f"), py::arg("z"), py::arg("W") = py::none(),
      py::arg("tolerance") = 1e-9,
      R"(The decomposition of z (Moreau 1965): x = prox_f z, y = prox_g z, g the conjugate in the metric W.

f: a Function; z: n numbers; W: a Metric, a symmetric positive definite matrix, its diagonal, or None (identity).
Raises InvalidInput when sizes do not fit, or f is not convex, closed and proper.)");
}

}  // namespace python
