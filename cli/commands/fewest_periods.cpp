#include "cli/commands/fewest_periods.hpp"

#include <cmath>

#include "mechanics/motion/orbit_section.hpp"

namespace cli::inline commands {

long fewest_periods(const mechanics::LagrangianSystem& system, const mechanics::Orbit& orbit,
                    const mechanics::OrbitQuestion& question, long periods) {
  constexpr double one_orbit = 1e-8;
  const mechanics::State& start = orbit.start;
  for (long part = 1; 2 * part <= periods; ++part) {
    if (periods % part != 0) continue;
    const double t = start.t + orbit.period * static_cast<double>(part) / static_cast<double>(periods);
    const mechanics::State later = mechanics::orbit_from(system, orbit, question, t).start;
    double away = (later.v - start.v).norm();
    for (convex::Index i = 0; i < later.q.size(); ++i) {
      const double turn = question.modulo.size() > 0 ? question.modulo[i] : 0;
      double gone = later.q[i] - start.q[i];
      if (turn > 0) gone -= turn * std::round(gone / turn);
      away = std::hypot(away, gone);
    }
    if (away <= one_orbit * std::hypot(start.q.norm(), start.v.norm())) return part;
  }
  return periods;
}

}  // namespace cli::inline commands
