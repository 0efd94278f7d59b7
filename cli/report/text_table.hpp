#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace cli::inline reports {

/// Longer tables are cut on the screen; --json has everything.
inline constexpr std::ptrdiff_t most_rows = 40;

/// A number as a person reads it: six significant digits.
std::string number_text(double x);

/// An error in two digits, "2.2e-16"; 0 is "0".
std::string error_text(double x);

/// Columns with a heading each; the first is set to the left, the others to the right.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> heading) : rows_{std::move(heading)} {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace cli::inline reports
