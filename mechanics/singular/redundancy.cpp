#include "mechanics/singular/redundancy.hpp"

#include <algorithm>
#include <cmath>
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

/// A point near the state, moved by up to `reach` of the coordinates' size and then onto the others.
struct Trial {
  double value = 0;  ///< |f_main|, 0 where rounding may be all of it
  double felt = 0;   ///< what rounding may be of it
};

/// Trials at shrinking reaches.
class Neighbourhood {
 public:
  Neighbourhood(const ConstraintSeries& series, const State& state, const std::vector<Index>& columns,
                Index main, const std::vector<Index>& others)
      : series_(series), state_(state), columns_(columns), main_(main), others_(others) {
    for (const Index i : columns) largest_ = std::max(largest_, std::abs(state.q[i]));
  }

  /// None where Newton's method does not end near the point, or f has no number there.
  std::optional<Trial> trial(double reach) {
    std::uniform_real_distribution<double> part(-1, 1);
    Point at{std::vector<TimeSeries>(static_cast<std::size_t>(state_.q.size())), TimeSeries(state_.t)};
    const double distance = reach * (largest_ > 0 ? largest_ : 1);
    double moved = 0;
    for (const Index i : columns_) {
      const double move = distance * part(random_);
      moved = std::hypot(moved, move);
      at.q[static_cast<std::size_t>(i)] = TimeSeries(state_.q[i] + move);
    }
    at.t.c[0] = state_.t + reach * std::max(1.0, std::abs(state_.t)) * part(random_);
    if (!others_.empty() && !move_onto(series_, at, columns_, others_, moved)) return std::nullopt;
    const std::vector<TimeSeries> f = series_.along(at.q, at.t, 0);
    const Rounded value = f[static_cast<std::size_t>(main_)].c[0];
    double missed = 0;
    for (const Index a : others_) {
      const Rounded other = f[static_cast<std::size_t>(a)].c[0];
      missed = std::max(missed, std::abs(other.value) + other.radius);
    }
    if (!is_finite(value) || !std::isfinite(missed)) return std::nullopt;
    // Newton leaves rounding in the others, which main may feel many times over.
    constexpr double felt_times = 1024;
    const double felt = felt_times * (value.radius + missed), size = std::abs(value.value);
    return Trial{size > felt ? size : 0, felt};
  }

 private:
  const ConstraintSeries& series_;
  const State& state_;
  const std::vector<Index>& columns_;
  Index main_;
  const std::vector<Index>& others_;
  double largest_ = 0;
  std::mt19937_64 random_{1966};
};

}  // namespace

std::optional<bool> is_redundant(const ConstraintSeries& series, const State& state,
                                 const std::vector<Index>& columns, Index main,
                                 const std::vector<Index>& others) {
  // From a tenth of the coordinates' size down to where squares of the distance are rounding.
  constexpr double first = 0.1, last = 1e-7, shrink = 0.25;
  constexpr int enough = 3;
  // What is not 0 on the branch of the state shrinks by a power of the distance, hardly of a higher order.
  constexpr double highest_order = 8;
  Neighbourhood near(series, state, columns, main, others);
  int zeros = 0;
  double seen = 0, seen_at = 0;  // of what was not 0
  for (double reach = first; reach >= last && zeros < enough; reach *= shrink) {
    for (int k = 0; k < enough && zeros < enough; ++k) {
      const std::optional<Trial> trial = near.trial(reach);
      if (!trial) continue;
      if (trial->value > 0) {
        // It may be on another branch of the others: sin(f) = 0 has f = pi.
        seen = trial->value;
        seen_at = reach;
        zeros = 0;
        break;
      }
      if (seen > 0 && !(seen * std::pow(reach / seen_at, highest_order) > trial->felt)) return false;
      ++zeros;
    }
  }
  if (seen > 0) return zeros >= enough;
  if (zeros == 0) return std::nullopt;
  return true;
}

}  // namespace mechanics::inline singular_states
