#pragma once

#include <string>
#include <vector>

namespace cli::inline commands {

/// The values of a parameter that a branch is followed over, "w=1:0.01:3".
struct BranchRange {
  std::string parameter;
  double first = 0, step = 0, last = 0;
  std::vector<double> values;  ///< each the double nearest to the decimal number
  long count() const { return static_cast<long>(values.size()); }
  double value(long k) const { return values[static_cast<std::size_t>(k)]; }
};

/// Throws InvalidInput with the form that it should have.
BranchRange branch_range(const std::string& text);

}  // namespace cli::inline commands
