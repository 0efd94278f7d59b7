#pragma once

#include <string>
#include <vector>

namespace convex::inline law_checks {

/// One claim put to the test: it holds when value <= bound. The bound is what rounding and the proxes' own
/// error bounds allow, never a generous epsilon.
struct Check {
  std::string name;
  double value = 0, bound = 0;
  bool passed = true;
  std::string counterexample = {};  ///< the smallest one found, when it failed
};

/// Is value <= bound? Not when one of them is not a number.
inline Check check_that(std::string name, double value, double bound) {
  return {std::move(name), value, bound, value <= bound};
}

/// The laws that were tried on one function; each line is the worst over all points and metrics.
struct LawReport {
  std::vector<Check> checks;
  std::vector<std::string>
      no_evidence;  ///< laws whose two sides came by one route, and why they prove nothing
  bool all_passed() const {
    for (const Check& check : checks)
      if (!check.passed) return false;
    return !checks.empty();
  }
  /// One line a law: "passed" or "FAILED", name, value, bound, counterexample.
  std::string text() const;
};

}  // namespace convex::inline law_checks
