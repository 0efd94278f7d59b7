#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/motion/time_stepping.hpp"

namespace mechanics::inline motions {
namespace {

/// Fewer coordinates are solved with dense rows.
constexpr Index fewest_for_sparse_rows = 64;

/// f and df/dt are 0 below so many roundings of their terms.
constexpr double rounding_of_rate = 16 * std::numeric_limits<double>::epsilon();

constexpr int most_position_corrections = 12;

/// Where very many rows change: a rough correction that leaves more than the first part is followed by an
/// exact one, and what is less than the second part of the first penetration is left to the next step.
constexpr double slow_correction = 0.1, left_to_next_step = 1e-2;

/// Contacts this many times as far away as the deepest penetration may be reached by its correction.
constexpr double reach_of_correction = 4;

}  // namespace

convex::ConstraintRows rows_to_solve(convex::SparseRows U) {
  if (U.cols() >= fewest_for_sparse_rows) {
    U.makeCompressed();
    return convex::ConstraintRows(std::move(U));
  }
  return convex::ConstraintRows(convex::RowMatrix(U));
}

void Motion::TimeStepping::note_pushing() {
  pushes_.assign(rests_.size(), false);
  for (std::size_t k = 0; k < now_.constraints.size(); ++k)
    pushes_[static_cast<std::size_t>(now_.constraints[k])] = impulse_[static_cast<Index>(k)] > 0;
}

/// The constraints that a correction of the position has to do with: those of the step and those penetrated.
/// Contacts that push and stay are brought to f = 0 also from above, as those that are two-sided.
Motion::TimeStepping::Correction Motion::TimeStepping::correction(const Vector& f,
                                                                  const std::vector<bool>& counts,
                                                                  bool held) const {
  Correction found;
  for (Index a = 0; a < f.size(); ++a) {
    const auto i = static_cast<std::size_t>(a);
    if (!counts[i]) continue;
    if (is_two_sided(a) || (held && pushes(a)))
      found.two_sided.push_back(static_cast<Index>(found.constraints.size()));
    found.constraints.push_back(a);
  }
  found.U = rows_to_solve(system.contact_rows(state, found.constraints).U);
  found.s.resize(static_cast<Index>(found.constraints.size()));
  for (std::size_t k = 0; k < found.constraints.size(); ++k)
    found.s[static_cast<Index>(k)] = -f[found.constraints[k]];
  return found;
}

/// The contacts that a correction of the deepest penetration may bring into play.
void Motion::TimeStepping::take_near(const ConstraintRates& rates, std::vector<bool>& counts) const {
  const double deepest = -rates.f.cwiseQuotient(rates.f_scale).minCoeff();
  for (Index a = 0; a < rates.f.size(); ++a)
    if (rates.f[a] <= reach_of_correction * deepest * rates.f_scale[a])
      counts[static_cast<std::size_t>(a)] = true;
}

void Motion::TimeStepping::correct_position() {
  const Vector uncorrected = state.q;
  std::vector<bool> counts(system.constraints().size());
  for (const Index a : now_.constraints) counts[static_cast<std::size_t>(a)] = true;

  bool is_told = false, held = !is_crowded_;
  double first = 0, last = std::numeric_limits<double>::infinity();
  for (int i = 0;; ++i) {
    const ConstraintRates rates = system.constraint_rates(state);
    bool is_wrong = false;
    double worst = 0;
    for (Index a = 0; a < rates.f.size(); ++a) {
      const auto k = static_cast<std::size_t>(a);
      const double f = is_two_sided(a) || (held && pushes(a)) ? -std::abs(rates.f[a]) : rates.f[a];
      if (i == 0)
        record.corrected_penetration = std::max(record.corrected_penetration, -f / rates.f_scale[a]);
      // A contact within its tolerance is closed; f = 0 that is meant holds to rounding.
      const double least = i == 0 && is_two_sided(a) ? rounding_of_rate : options.contact_tolerance[a];
      if (f >= -least * rates.f_scale[a]) continue;
      is_wrong = true;
      counts[k] = true;
      worst = std::max(worst, -f / rates.f_scale[a]);
    }
    if (i == 0) first = worst;
    if (is_crowded_ && i > 0 && worst <= left_to_next_step * first) is_wrong = false;
    const Effort effort = is_crowded_ && worst <= slow_correction * last ? Effort::rough : Effort::exact;
    last = worst;
    if (!is_wrong || is_told || i == most_position_corrections) {
      for (Index a = 0; a < rates.f.size(); ++a)
        note_penetration(a, is_two_sided(a) ? -std::abs(rates.f[a]) : rates.f[a], rates.f_scale[a]);
      break;
    }
    if (i == 0) positions_.pushing = velocities_.pushing;
    if (is_crowded_) take_near(rates, counts);
    const auto move = [&] {
      const Correction near = correction(rates.f, counts, held);
      const convex::Solution& found = solve(positions_, near.constraints, near.two_sided, near.U,
                                            Vector::Zero(state.q.size()), near.s, effort);
      const bool is_found = found.q.size() == state.q.size() && found.status != convex::Status::infeasible;
      if (is_found) state.q += found.q;
      return is_found;
    };
    if (held && move()) continue;
    is_told = !held && !move();
    held = false;
    if (is_told)
      remark(RemarkKind::correction, "no small change of position brings all contacts back to f >= 0");
  }
  const Vector moved = state.q - uncorrected;
  const double length = A_->norm(moved);
  if (length > 0) {
    const State there{state.t, uncorrected, state.v};
    const double energy = system.energy(there), added = system.energy(state) - energy;
    const double along = A_->inner(state.v, moved) / length;
    if (added > 0) {
      const double left = std::sqrt(std::max(0.0, along * along - 2 * added));
      state.v += (std::copysign(left, along) - along) / length * moved;
      // The rest, where there is too little along the change, from the velocity as it is.
      const double rest = system.energy(state) - energy, kinetic = system.kinetic_energy(state);
      if (rest > 0 && kinetic > 0) state.v *= std::sqrt(std::max(0.0, 1 - rest / kinetic));
    }
    record.correction_energy += system.energy(state) - energy;
  }
  correct_velocity();
}

/// df/dt = 0 of the contacts that stay, where the step has left them.
void Motion::TimeStepping::correct_velocity() {
  std::vector<Index> held, all;
  for (Index a = 0; a < static_cast<Index>(rests_.size()); ++a)
    if (is_two_sided(a) || (pushes(a) && !is_crowded_)) {
      all.push_back(static_cast<Index>(held.size()));
      held.push_back(a);
    }
  if (held.empty()) return;
  const ConstraintRates rates = system.constraint_rates(state);
  Vector s(static_cast<Index>(held.size()));
  bool is_wrong = false;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const Index a = held[k];
    s[static_cast<Index>(k)] = -rates.df[a];
    is_wrong = is_wrong || std::abs(rates.df[a]) > rounding_of_rate * rates.df_scale[a];
  }
  if (!is_wrong) return;
  const convex::Solution& found =
      solve(tangents_, held, all, rows_to_solve(system.contact_rows(state, held).U),
            Vector::Zero(state.q.size()), s, Effort::exact);
  if (found.q.size() == state.v.size() && found.status != convex::Status::infeasible) state.v += found.q;
}

}  // namespace mechanics::inline motions
