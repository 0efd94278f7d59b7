#pragma once

#include <optional>
#include <string>

#include "cli/sweep/sweep_range.hpp"
#include "mechanics/liquid/liquid_text.hpp"

namespace cli::inline commands {

/// The page of `--animate F.html --over NAME=first:step:last`: a liquid solved at each value of a parameter.
class LiquidFrames {
 public:
  /// Throws InvalidInput where one of the two is missing, the range is none, its key is no parameter of the
  /// liquid, or there are too many values for one page.
  LiquidFrames(const mechanics::liquid::LiquidText&, const std::optional<std::string>& file,
               const std::optional<std::string>& over);
  /// Solves and writes. Ctrl-C ends it with an error and without a file.
  void write(const std::string& title) const;

 private:
  const mechanics::liquid::LiquidText& text_;
  std::string file_;
  SweepRange range_;
};

}  // namespace cli::inline commands
