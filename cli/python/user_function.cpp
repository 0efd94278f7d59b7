#include "cli/python/user_function.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "cli/python/arrays.hpp"
#include "cli/python/options.hpp"
#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/laws/trial.hpp"
#include "convex/operations/operations.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::Function;
using convex::Index;
using convex::InvalidInput;
using convex::Metric;
using convex::Prox;
using convex::Vector;

/// Something of Python that may be let go of by any thread.
std::shared_ptr<const py::object> kept(py::object object) {
  return {new py::object(std::move(object)), [](const py::object* held) {
            const py::gil_scoped_acquire lock;
            delete held;
          }};
}

class UserFunction : public convex::FunctionNode {
 public:
  UserFunction(py::object value, py::object prox, Index n, std::string name)
      : value_(kept(std::move(value))), prox_(kept(std::move(prox))), n_(n), name_(std::move(name)) {}

  Index dimension() const override { return n_; }
  convex::Facts facts() const override { return {}; }
  convex::Call call() const override { return {name_, {}, {}, shared_from_this()}; }
  double value(const Vector& x) const override {
    const py::gil_scoped_acquire lock;
    return option<double>((*value_)(array_of(x)), name_ + ": its value");
  }
  Prox prox(const Vector& z, const Metric& W, const convex::Look&) const override {
    Vector x;
    {
      const py::gil_scoped_acquire lock;
      x = vector_of((*prox_)(array_of(z), W), "prox");
    }
    if (x.size() != z.size())
      throw InvalidInput(name_ + ": its prox has " + convex::counted(x.size(), "entry", "entries") +
                         " at a point of " + std::to_string(z.size()) + "; return as many");
    Vector v = W.multiply(z - x);
    const double bound = convex::rounding_bound(W, z, x);
    return {std::move(x), std::move(v),          bound, 0, convex::ProxRoute::closed_form,
            "given",      convex::Status::solved};
  }
  Function conjugate() const override { return convex::computed_conjugate(Function(shared_from_this())); }
  std::optional<Vector> subgradient(const Vector&) const override { return std::nullopt; }

 private:
  std::shared_ptr<const py::object> value_, prox_;
  Index n_;
  std::string name_;
};

}  // namespace

std::shared_ptr<const convex::FunctionNode> user_function(py::object value, py::object prox, Index n,
                                                          std::string name) {
  if (n < 0) throw InvalidInput("n: negative; give the number of entries, or 0 for any");
  return std::make_shared<UserFunction>(std::move(value), std::move(prox), n, std::move(name));
}

}  // namespace python
