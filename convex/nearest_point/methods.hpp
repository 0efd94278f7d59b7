#pragma once

#include <span>
#include <string>
#include <string_view>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// What may be expected of a method: a direct one ends after finitely many steps, with all digits; an
/// iterative one comes as close as it is asked to; one for comparison is known to be wrong at times, and is
/// told so.
enum class MethodKind { direct, iterative, for_comparison };

/// "direct", "iterative" or "for comparison".
std::string_view name(MethodKind kind);

/// A method of solution of the nearest-point problem, as a problem file names it.
struct Method {
  std::string_view name;
  std::string_view summary;  ///< one line
  MethodKind kind;
  /// Empty, or the reason why the method cannot be used on this problem.
  std::string (*applies)(const NearestPointProblem&);
  /// Throws InvalidInput as `validate` does. To be called where the method applies.
  Solution (*solve)(const NearestPointProblem&, const Accuracy&);
};

/// The one table of methods; the first is the default.
std::span<const Method> methods();

/// The method of that name, or null.
const Method* find_method(std::string_view name);

}  // namespace convex
