#pragma once

#include <string>
#include <vector>

namespace cli::inline sweeps {

/// `--over "a=0:0.1:1"` or "m=1,2,4": the values that a key of the file takes, as for `--set`.
struct SweepRange {
  std::string key;
  std::vector<double> values;  ///< in the order given
  bool is_range = false;       ///< first:step:last
};

/// Numbers are exact while they are counted: 0:0.1:0.3 ends with 0.3. Throws InvalidInput, also
/// for more values than `most`.
SweepRange parse_sweep_range(const std::string& text, double most = 1e9);

}  // namespace cli::inline sweeps
