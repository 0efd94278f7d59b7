#pragma once

#include <functional>
#include <vector>

#include "convex/gamma0/function.hpp"
#include "convex/piecewise/piecewise_quadratic.hpp"

namespace convex::linear_quadratic {
struct LinearQuadratic;
}
namespace convex {
using linear_quadratic::LinearQuadratic;
}

namespace convex::inline named_functions {

/// Σ_i f_i(x_i) + offset with piecewise linear-quadratic f_i of one variable: the one node behind boxes,
/// points, norm1, huber, hinge, elastic_net, linear, plq, …, and behind their conjugates, which are of the
/// same kind.
struct PiecewiseSum {
  Call call;
  Call conjugate_call;
  std::vector<PiecewiseQuadratic> pieces;  ///< one each, or a single one for every entry
  Index dimension = 0;                     ///< 0: any number of entries
  double offset = 0;

  /// The prox in a diagonal metric by loops without branches; the curves' own when empty.
  std::function<Vector(const Vector& z, const Vector& d)> prox = {};
  /// A program with fewer auxiliary variables than the one made from the pieces; of the conjugate too.
  std::function<LinearQuadratic(Index n)> form = {}, conjugate_form = {};
};

Function piecewise_sum(PiecewiseSum parts);

/// plq(breaks, coefficients) of the pieces of f.
Call plq_call(const PiecewiseQuadratic& f);

}  // namespace convex::inline named_functions
