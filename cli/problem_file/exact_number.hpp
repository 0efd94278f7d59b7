#pragma once

#include <optional>
#include <string>

namespace cli::inline problem_files {

/// The double nearest to an exact value written as "p/q", an integer or a decimal ("1/3", "-2", "0.1",
/// "1e-3"); infinite when it
/// is beyond all doubles; none when the text is not a number or the denominator is 0.
std::optional<double> nearest_double(const std::string& text);

}  // namespace cli::inline problem_files
