#include "cli/measurement/contest.hpp"

#include <algorithm>
#include <array>

namespace cli::inline measurement {

std::string verdict_text(Verdict verdict) {
  constexpr std::array<const char*, 6> texts{"ok", "wrong", "gave-up", "too-slow", "refused", "crashed"};
  return texts[static_cast<std::size_t>(verdict)];
}

bool exceeds(double error, double bound) {
  constexpr double wrong_beyond = 10;
  return !(error <= wrong_beyond * std::max(bound, convex::unit_roundoff));
}

}  // namespace cli::inline measurement
