#pragma once

#include <string>
#include <vector>

namespace cli::inline sweeps {

/// `--over "a=0:0.1:1"` or "m=1,2,4": the values that a key of the file takes, as for `--set`.
struct SweepRange {
  std::string key;
  std::vector<double> values;  ///< in the order given
  bool is_range = false;       ///< first:step:last
  double step = 0;             ///< of a range
};

inline constexpr double most_values = 1e9;

/// Numbers are exact while they are counted: 0:0.1:0.3 ends with 0.3. Throws InvalidInput, also
/// for more values than `most`, and of a range for fewer than `least`.
SweepRange parse_sweep_range(const std::string& text, double most = most_values, double least = 1);

/// Ranges of two values at least, of one key each. Throws InvalidInput, also for a key that is there twice.
std::vector<SweepRange> parse_sweep_ranges(const std::vector<std::string>& texts);

}  // namespace cli::inline sweeps
