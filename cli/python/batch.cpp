#include "cli/python/batch.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <map>
#include <mutex>
#include <optional>

#include "cli/python/arrays.hpp"
#include "cli/python/options.hpp"
#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/repeated_problem.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::Index;
using convex::InvalidInput;
using convex::Matrix;
using convex::RowMatrix;
using convex::Vector;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// One argument: the same numbers for all problems, or one piece of them each.
struct Pieces {
  Numbers numbers;
  py::ssize_t axes = 0;  ///< of one problem
  bool many = false;
  Index size = 0;  ///< numbers of one problem

  const double* of(Index problem) const { return numbers.data() + (many ? problem * size : 0); }
};

Pieces pieces(const py::object& given, py::ssize_t axes, const char* name) {
  if (is_sparse(given)) throw InvalidInput(std::string(name) + ": sparse; a batch takes numpy arrays");
  Pieces made{Numbers::ensure(given), axes, false, 1};
  if (!made.numbers) {
    PyErr_Clear();
    throw InvalidInput(std::string(name) + ": not numbers; give an array of numbers");
  }
  const py::ssize_t found = made.numbers.ndim();
  if (found != axes && found != axes + 1)
    throw InvalidInput(std::string(name) + ": " + convex::counted(found, "axis", "axes") + "; give " +
                       std::to_string(axes) + ", or " + std::to_string(axes + 1) +
                       " with the problems along the first");
  made.many = found == axes + 1;
  for (py::ssize_t axis = made.many ? 1 : 0; axis < found; ++axis) made.size *= made.numbers.shape(axis);
  return made;
}

/// What all threads read.
struct Batch {
  std::optional<convex::Metric> metric;  ///< common to all
  Pieces A, z, U, s;                     ///< A is empty where `metric` is there
  Index count = -1, n = 0, m = 0;
  bool diagonal = false;
  std::vector<Index> two_sided;
  SolveChoice choice;

  convex::Metric metric_of_problem(Index k) const {
    if (metric) return *metric;
    if (diagonal) return convex::Metric::diagonal(Eigen::Map<const Vector>(A.of(k), n));
    return convex::Metric::dense(Eigen::Map<const Matrix>(A.of(k), n, n));
  }
  convex::NearestPointProblem problem(Index k) const {
    return {metric_of_problem(k), Eigen::Map<const Vector>(z.of(k), n),
            convex::ConstraintRows(RowMatrix(Eigen::Map<const RowMatrix>(U.of(k), m, n))),
            Eigen::Map<const Vector>(s.of(k), m), two_sided};
  }
  /// Is only z, or s, different from problem to problem, and the method the default?
  bool repeats() const { return metric && !U.many && choice.method == &convex::methods().front(); }
};

void count(Batch& batch, const Pieces& of, const char* name) {
  if (!of.many) return;
  const Index found = of.numbers.shape(0);
  if (batch.count >= 0 && batch.count != found)
    throw InvalidInput(std::string(name) + ": " + std::to_string(found) +
                       " problems along the first axis, others have " + std::to_string(batch.count) +
                       "; give as many");
  batch.count = found;
}

void require(bool fits, const char* name, const std::string& shape) {
  if (!fits) throw InvalidInput(std::string(name) + ": of another size; give " + shape + " for each problem");
}

Batch batch_of(const py::object& A, const py::object& z, const py::object& U, const py::object& s,
               const py::object& two_sided, const SolveChoice& choice) {
  Batch batch;
  batch.choice = choice;
  batch.z = pieces(z, 1, "z");
  batch.n = batch.z.size;
  batch.U = pieces(U, 2, "U");
  batch.m = batch.U.numbers.shape(batch.U.many ? 1 : 0);
  require(batch.U.size == batch.m * batch.n, "U", "m by n, n the size of z,");
  batch.s = s.is_none()
                ? pieces(py::array(py::cast(std::vector<double>(static_cast<std::size_t>(batch.m)))), 1, "s")
                : pieces(s, 1, "s");
  require(batch.s.size == batch.m, "s", "m, the rows of U,");
  // (B, n) is taken for n by n where B = n: a common matrix; diagonals are then to be given as matrices.
  const bool is_array = !A.is_none() && !py::isinstance<convex::Metric>(A) && !is_sparse(A);
  const Numbers as_array = is_array ? Numbers::ensure(A) : Numbers();
  const bool square = is_array && as_array && as_array.ndim() == 2 && as_array.shape(0) == batch.n &&
                      as_array.shape(1) == batch.n;
  if (is_array && as_array && ((as_array.ndim() == 2 && !square) || as_array.ndim() == 3)) {
    batch.diagonal = as_array.ndim() == 2;
    batch.A = pieces(A, batch.diagonal ? 1 : 2, "A");
    require(batch.A.size == (batch.diagonal ? batch.n : batch.n * batch.n), "A",
            "n by n, or n of a diagonal,");
  } else {
    PyErr_Clear();
    batch.metric = metric_of(A, batch.n, "A");
    require(batch.metric->dimension() == batch.n, "A", "n by n, n the size of z,");
  }
  count(batch, batch.A, "A");
  count(batch, batch.z, "z");
  count(batch, batch.U, "U");
  count(batch, batch.s, "s");
  if (!two_sided.is_none()) batch.two_sided = row_numbers(two_sided, "two_sided");
  return batch;
}

/// What was found, written by all threads, each in its own place.
struct Found {
  double *q, *lambda, *error_bound;
  std::uint8_t* status;
  std::mutex lock;
  std::map<Index, Vector> farkas;

  void take(const Batch& batch, Index k, const convex::Solution& solution) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const bool is_there = solution.q.size() == batch.n;
    if (is_there) {
      std::copy_n(solution.q.data(), batch.n, q + k * batch.n);
      std::copy_n(solution.lambda.data(), batch.m, lambda + k * batch.m);
    } else {
      std::fill_n(q + k * batch.n, batch.n, none);
      std::fill_n(lambda + k * batch.m, batch.m, none);
    }
    error_bound[k] = is_there ? solution.error_bound : std::numeric_limits<double>::infinity();
    status[k] = static_cast<std::uint8_t>(solution.status);
    if (solution.farkas.size() == 0) return;
    const std::lock_guard guard(lock);
    farkas[k] = solution.farkas;
  }
};

convex::Solution solved(const Batch& batch, Index k) {
  const convex::NearestPointProblem problem = batch.problem(k);
  if (const std::string why = batch.choice.method->applies(problem); !why.empty())
    throw InvalidInput("method \"" + std::string(batch.choice.method->name) + "\": " + why);
  return batch.choice.method->solve(problem, batch.choice.accuracy);
}

void solve_chunk(const Batch& batch, Index first, Index last, Found& found) {
  Index k = first;
  try {
    if (batch.repeats()) {
      convex::RepeatedProblem repeated(batch.problem(k), batch.choice.accuracy);
      Vector z, s;
      for (; k < last; ++k) {
        z = Eigen::Map<const Vector>(batch.z.of(k), batch.n);
        s = Eigen::Map<const Vector>(batch.s.of(k), batch.m);
        found.take(batch, k, repeated.solve(z, s));
      }
    }
    for (; k < last; ++k) found.take(batch, k, solved(batch, k));
  } catch (const InvalidInput& error) {
    throw InvalidInput("problem " + std::to_string(k) + ": " + error.what());
  }
}

}  // namespace

py::tuple solve_batch(const py::object& A, const py::object& z, const py::object& U, const py::object& s,
                      const py::object& two_sided, const SolveChoice& choice) {
  const Batch batch = batch_of(A, z, U, s, two_sided, choice);
  py::array_t<double> q({batch.count, batch.n}), lambda({batch.count, batch.m}), bound(batch.count);
  py::array_t<std::uint8_t> status(batch.count);
  Found found{q.mutable_data(), lambda.mutable_data(), bound.mutable_data(), status.mutable_data(), {}, {}};
  {
    const py::gil_scoped_release released;
    in_chunks(batch.count, [&](Index first, Index last) { solve_chunk(batch, first, last, found); });
  }
  py::dict farkas;
  for (const auto& [k, weights] : found.farkas) farkas[py::int_(k)] = array_of(weights);
  return py::make_tuple(q, lambda, bound, status, farkas);
}

}  // namespace python
