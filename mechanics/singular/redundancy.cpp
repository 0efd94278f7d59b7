#include "mechanics/singular/redundancy.hpp"

#include <random>

#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "mechanics/singular/rounded_rows.hpp"

namespace mechanics::inline singular_states {
namespace {

using convex::Matrix;
using expression::ConstraintSeries;
using expression::Rounded;
using expression::TimeSeries;

/// A point in q and t.
struct Point {
  std::vector<TimeSeries> q;
  TimeSeries t;
};

/// f of chosen constraints at a point, with their gradients when wanted; false where they are not finite.
bool evaluate(const ConstraintSeries& series, Point& at, const std::vector<Index>& columns,
              const std::vector<Index>& chosen, Vector& f, Matrix& gradients) {
  f.resize(static_cast<Index>(chosen.size()));
  gradients.resize(f.size(), static_cast<Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Rounded& rate = at.q[static_cast<std::size_t>(columns[i])].c[1];
    rate = 1;
    const std::vector<TimeSeries> values = series.along(at.q, at.t, 1);
    rate = 0;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const TimeSeries& value = values[static_cast<std::size_t>(chosen[k])];
      f[static_cast<Index>(k)] = value.c[0].value;
      gradients(static_cast<Index>(k), static_cast<Index>(i)) = value.c[1].value;
    }
  }
  return f.allFinite() && gradients.allFinite();
}

/// Newton's method, each step the shortest; whether it ended near where it began.
bool move_onto(const ConstraintSeries& series, Point& at, const std::vector<Index>& columns,
               const std::vector<Index>& others, double reach) {
  constexpr int most_steps = 8;
  double moved = 0;
  for (int step = 0; step < most_steps; ++step) {
    Vector f;
    Matrix U;
    if (!evaluate(series, at, columns, others, f, U)) return false;
    const Vector change = convex::linear_algebra::CompleteOrthogonal(U).solve(-f);
    moved += change.norm();
    if (!(moved <= reach)) return false;
    for (std::size_t i = 0; i < columns.size(); ++i)
      at.q[static_cast<std::size_t>(columns[i])].c[0].value += change[static_cast<Index>(i)];
    constexpr double settled = 0x1p-50;
    if (change.norm() <= settled * reach) return true;
  }
  return true;
}

}  // namespace

std::optional<bool> is_redundant(const ConstraintSeries& series, const State& state,
                                 const std::vector<Index>& columns, Index main,
                                 const std::vector<Index>& others) {
  std::mt19937_64 random(1966);
  std::uniform_real_distribution<double> part(-1, 1);
  double largest = 0;
  for (const Index i : columns) largest = std::max(largest, std::abs(state.q[i]));
  // From a tenth of the coordinates' size down to where squares of the distance are rounding.
  constexpr double first = 0.1, last = 1e-7, shrink = 0.25;
  constexpr int enough = 3;
  int reached = 0;
  for (double reach = first; reach >= last && reached < enough; reach *= shrink) {
    for (int trial = 0; trial < enough && reached < enough; ++trial) {
      Point at{std::vector<TimeSeries>(static_cast<std::size_t>(state.q.size())), TimeSeries(state.t)};
      const double distance = reach * (largest > 0 ? largest : 1);
      double moved = 0;
      for (const Index i : columns) {
        const double move = distance * part(random);
        moved = std::hypot(moved, move);
        at.q[static_cast<std::size_t>(i)] = TimeSeries(state.q[i] + move);
      }
      at.t.c[0] = state.t + reach * std::max(1.0, std::abs(state.t)) * part(random);
      if (!others.empty() && !move_onto(series, at, columns, others, moved)) continue;
      const std::vector<TimeSeries> f = series.along(at.q, at.t, 0);
      const Rounded value = f[static_cast<std::size_t>(main)].c[0];
      double missed = 0;
      for (const Index a : others) {
        const Rounded other = f[static_cast<std::size_t>(a)].c[0];
        missed = std::max(missed, std::abs(other.value) + other.radius);
      }
      if (!is_finite(value) || !std::isfinite(missed)) continue;
      ++reached;
      // Newton leaves rounding in the others, which main may feel many times over.
      constexpr double felt = 1024;
      if (std::abs(value.value) > felt * (value.radius + missed)) return false;
    }
  }
  if (reached == 0) return std::nullopt;
  return true;
}

}  // namespace mechanics::inline singular_states
