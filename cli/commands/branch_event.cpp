#include "cli/commands/branch_event.hpp"

#include <algorithm>
#include <complex>

namespace cli::inline commands {

std::string event_between(const mechanics::Orbit& before, const mechanics::Orbit& now, bool is_free) {
  if (before.impacts.size() != now.impacts.size() || !before.multipliers || !now.multipliers)
    return "grazing";
  const auto outside = [&](const mechanics::Orbit& orbit, auto&& counts) {
    const auto all = mechanics::multipliers_across(orbit, is_free);
    return std::count_if(all.begin(), all.end(), [&](const std::complex<double>& m) {
      return std::abs(m) > 1 + orbit.circle_width && counts(m);
    });
  };
  const auto changed = [&](auto&& counts) { return outside(before, counts) != outside(now, counts); };
  if (!changed([](const auto&) { return true; })) return "";
  if (changed([](const auto& m) { return m.imag() != 0; })) return "torus";
  if (changed([](const auto& m) { return m.imag() == 0 && m.real() < 0; })) return "flip";
  if (changed([](const auto& m) { return m.imag() == 0 && m.real() > 0; })) return "fold";
  return "";
}

}  // namespace cli::inline commands
