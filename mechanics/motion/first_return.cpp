#include "mechanics/motion/first_return.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/contacts.hpp"
#include "mechanics/motion/period_map.hpp"

namespace mechanics::inline motions {
namespace {

/// Points of an arc that are looked at.
constexpr int looks_per_arc = 16;

/// A free period is searched for within so many steps.
constexpr long most_steps_to_return = 20'000;

/// The contacts that a state stands on and the motion from there leaves at once.
std::vector<Index> left_at_once(const LagrangianSystem& system, const State& guess,
                                const MotionOptions& options) {
  const auto m = static_cast<Index>(system.constraints().size());
  const ConstraintRates rates = system.constraint_rates(guess);
  std::vector<Index> left;
  for (Index a = 0; a < m; ++a) {
    const double tolerance =
        options.contact_tolerance.size() == 0 ? default_contact_tolerance : options.contact_tolerance[a];
    if (!system.constraints()[static_cast<std::size_t>(a)].two_sided &&
        std::abs(rates.f[a]) <= tolerance * rates.f_scale[a] &&
        std::abs(rates.df[a]) > tolerance * rates.df_scale[a])
      left.push_back(a);
  }
  return left;
}

}  // namespace

double return_time(const LagrangianSystem& system, const State& guess, const OrbitQuestion& question) {
  Motion motion(system, guess, question.motion);
  const State begun = motion.state();  // behind an impact that is due
  const Vector x = as_one(begun), direction = as_one({begun.t, begun.v, motion.acceleration()});
  const std::vector<Index> left = left_at_once(system, guess, question.motion);
  const auto from_start = [&](const State& at) {
    Vector away = as_one(at) - x;
    for (Index i = 0; i < question.modulo.size(); ++i)
      if (question.modulo[i] > 0) away[i] -= question.modulo[i] * std::round(away[i] / question.modulo[i]);
    return away;
  };
  double farthest = 0;
  bool was_behind = false;
  const auto is_near = [&](const Vector& away) { return away.norm() < 0.5 * farthest; };
  for (long step = 0; step < most_steps_to_return; ++step) {
    // Without an end in time a step goes as far as its series or an event; a motion without either has no
    // return.
    if (!motion.advance(guess.t + 1e9)) return 0;
    const Arc& arc = motion.arc();
    for (int k = 1; k <= looks_per_arc; ++k) {
      const double tau = arc.length * k / looks_per_arc;
      const Vector away = from_start(arc.state(tau));
      const double along = away.dot(direction);
      farthest = std::max(farthest, away.norm());
      if (was_behind && along >= 0 && is_near(away)) {
        // To the last digit: from a guess on an orbit Newton's method need not leave it, to whatever is near.
        double low = arc.length * (k - 1) / looks_per_arc, high = tau;
        for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high))
          (from_start(arc.state(middle)).dot(direction) < 0 ? low : high) = middle;
        return arc.t - guess.t + high;
      }
      was_behind = along < 0;
    }
    for (const MotionEvent& event : motion.events()) {
      const bool leads_there = std::any_of(event.constraints.begin(), event.constraints.end(), [&](Index a) {
        return std::find(left.begin(), left.end(), a) != left.end();
      });
      if (leads_there && is_near(from_start(motion.state()))) return event.t - guess.t;
    }
  }
  return 0;
}

}  // namespace mechanics::inline motions
