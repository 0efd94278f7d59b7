#pragma once

#include <cmath>
#include <string>

namespace cli::inline commands {

/// The values of a parameter that a branch is followed over, "w=1:0.01:3".
struct BranchRange {
  std::string parameter;
  double first = 0, step = 0, last = 0;
  long count() const { return static_cast<long>(std::floor((last - first) / step * (1 + 1e-12) + 1e-9)) + 1; }
  double value(long k) const { return first + static_cast<double>(k) * step; }
};

/// Throws InvalidInput with the form that it should have.
BranchRange branch_range(const std::string& text);

}  // namespace cli::inline commands
