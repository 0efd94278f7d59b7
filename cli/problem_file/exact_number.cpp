#include "cli/problem_file/exact_number.hpp"

#include "convex/exact/fraction.hpp"

namespace cli::inline problem_files {

std::optional<double> nearest_double(const std::string& text) {
  const auto value = convex::read_fraction(text);
  if (!value) return std::nullopt;
  return convex::nearest_double(*value);
}

}  // namespace cli::inline problem_files
