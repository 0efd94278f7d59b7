#include "cli/commands/branch_range.hpp"

#include <cstdlib>

#include "convex/invalid_input.hpp"

namespace cli::inline commands {

BranchRange branch_range(const std::string& text) {
  const std::size_t equals = text.find('='), one = text.find(':'), two = text.find(':', one + 1);
  const auto fail = [&]() -> convex::InvalidInput {
    return convex::InvalidInput("--over " + text +
                                ": no range; write --over \"w=1:0.01:3\", a parameter, first, step, last");
  };
  if (equals == std::string::npos || one == std::string::npos || two == std::string::npos || equals > one)
    throw fail();
  const auto number = [&](std::size_t from, std::size_t to) {
    const std::string part = text.substr(from, to - from);
    char* end = nullptr;
    const double x = std::strtod(part.c_str(), &end);
    if (part.empty() || *end != '\0' || !std::isfinite(x)) throw fail();
    return x;
  };
  const BranchRange range{text.substr(0, equals), number(equals + 1, one), number(one + 1, two),
                          number(two + 1, text.size())};
  constexpr long most = 1'000'000;
  if (range.step == 0 || (range.last - range.first) / range.step < 0 || range.count() > most) throw fail();
  return range;
}

}  // namespace cli::inline commands
