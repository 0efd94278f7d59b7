#pragma once

#include "convex/composite/graph_form.hpp"
#include "convex/gamma0/facts.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"

namespace convex::inline named_functions {

/// A piecewise linear-quadratic function of n entries without a formula of its own: its value, subgradient
/// and prox come from its program, exact in any metric, and so do those of its conjugate.
struct ProgramFunction {
  Call call;
  Call conjugate_call;
  Facts facts;  ///< piecewise_quadratic is understood
  Facts conjugate_facts;
  LinearQuadratic form;
  LinearQuadratic conjugate_form;
  GraphForm graph;
};

Function program_function(ProgramFunction parts);

}  // namespace convex::inline named_functions
