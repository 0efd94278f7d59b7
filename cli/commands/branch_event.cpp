#include "cli/commands/branch_event.hpp"

#include <complex>
#include <vector>

namespace cli {

std::string event_between(const mechanics::Orbit& before, const mechanics::Orbit& now) {
  if (before.impacts.size() != now.impacts.size() || !before.multipliers || !now.multipliers)
    return "grazing";
  const auto outside = [](const std::vector<std::complex<double>>& all, auto&& counts) {
    long number = 0;
    for (const auto& m : all)
      if (std::abs(m) > 1 && counts(m)) ++number;
    return number;
  };
  const auto changed = [&](auto&& counts) {
    return outside(*before.multipliers, counts) != outside(*now.multipliers, counts);
  };
  if (changed([](const auto& m) { return m.imag() != 0; })) return "torus";
  if (changed([](const auto& m) { return m.imag() == 0 && m.real() < 0; })) return "flip";
  if (changed([](const auto& m) { return m.imag() == 0 && m.real() > 0; })) return "fold";
  return "";
}

}  // namespace cli
