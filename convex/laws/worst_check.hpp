#pragma once

#include <limits>

#include "convex/laws/check.hpp"

namespace convex::inline law_checks {

/// The worst of many checks of one law: the first that failed, else the one nearest to its bound.
class WorstCheck {
 public:
  explicit WorstCheck(std::string name) : worst_{check_that(std::move(name), 0, 0)} {}
  void take(double value, double bound) {
    if (!worst_.passed) return;
    Check check = check_that(worst_.name, value, bound);
    const bool nearer =
        none_yet_ || excess(check) > excess(worst_) || (!(worst_.value > 0) && check.bound < worst_.bound);
    if (!check.passed || nearer) worst_ = std::move(check);
    none_yet_ = false;
  }
  const Check& check() const { return worst_; }

 private:
  static double excess(const Check& c) {
    if (c.bound > 0) return c.value / c.bound;
    return c.value > 0 ? std::numeric_limits<double>::infinity() : 0;
  }
  Check worst_;
  bool none_yet_ = true;
};

}  // namespace convex::inline law_checks
