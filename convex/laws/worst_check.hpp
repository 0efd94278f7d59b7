#pragma once

#include <limits>

#include "convex/laws/check.hpp"

namespace convex {

/// The worst of many checks of one law: the first that failed, else the one nearest to its bound.
class WorstCheck {
 public:
  explicit WorstCheck(std::string name) : worst_{check_that(std::move(name), 0, 0)} {}
  void take(double value, double bound) {
    if (!worst_.passed) return;
    const Check check = check_that(worst_.name, value, bound);
    if (!check.passed || excess(check) > excess(worst_)) worst_ = check;
  }
  const Check& check() const { return worst_; }

 private:
  static double excess(const Check& c) {
    if (c.bound > 0) return c.value / c.bound;
    return c.value > 0 ? std::numeric_limits<double>::infinity() : 0;
  }
  Check worst_;
};

}  // namespace convex
