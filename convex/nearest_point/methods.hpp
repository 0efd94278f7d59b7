#pragma once

#include <span>
#include <string_view>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// A method of solution of the nearest-point problem, as a problem file names it.
struct Method {
  std::string_view name;
  std::string_view summary;  ///< one line
  Solution (*solve)(const NearestPointProblem&, const Accuracy&);
};

/// The one table of methods; the first is the default.
std::span<const Method> methods();

/// The method of that name, or null.
const Method* find_method(std::string_view name);

}  // namespace convex
