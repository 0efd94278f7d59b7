#include "convex/nearest_point/multipliers/multiplier_tableau.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/infinity.hpp"
#include "convex/invariant.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// Entries of the tableau below this part of the largest are rounding about zero.
constexpr double entry_noise = 1e-11;

/// So do values, below this part of the largest.
constexpr double relative_value_noise = 1e-14;

/// After so many pivots the next range is found from the tableau at the start: rounding does not add up.
constexpr Index most_pivots_since_start = 64;

}  // namespace

MultiplierTableau::MultiplierTableau(std::vector<Index> basic, Vector value, std::vector<Index> nonbasic,
                                     Matrix T, const std::vector<bool>& is_free)
    : basic_(std::move(basic)),
      nonbasic_(std::move(nonbasic)),
      value_(std::move(value)),
      T_(std::move(T)),
      free_(is_free),
      unbounded_(is_free.size(), false),
      fixed_(nonbasic_.size(), false),
      noise_(entry_noise * std::max(1.0, T_.size() > 0 ? T_.cwiseAbs().maxCoeff() : 0.0)),
      value_noise_(relative_value_noise * (value_.size() > 0 ? value_.cwiseAbs().maxCoeff() : 0.0)) {
  settle_free_columns();
  start_ = {basic_, nonbasic_, value_, T_};
}

void MultiplierTableau::settle_free_columns() {
  for (Index column = 0; column < T_.cols(); ++column) {
    if (!is_free(nonbasic_[static_cast<std::size_t>(column)])) continue;
    double up = infinity, down = infinity;
    const Index above = blocking_row(column, 1, up), below = blocking_row(column, -1, down);
    const Index row = above >= 0 && (below < 0 || up <= down) ? above : below;
    if (row >= 0) {
      pivot(row, column);
      // What left the basis is one-sided and at zero; the free one is basic and stays.
      continue;
    }
    // No sign restricts it: a line in the polyhedron.
    fixed_[static_cast<std::size_t>(column)] = true;
    unbounded_[static_cast<std::size_t>(nonbasic_[static_cast<std::size_t>(column)])] = true;
    for (Index k = 0; k < T_.rows(); ++k)
      if (std::abs(T_(k, column)) > noise_)
        unbounded_[static_cast<std::size_t>(basic_[static_cast<std::size_t>(k)])] = true;
  }
}

Index MultiplierTableau::blocking_row(Index column, double sign, double& step) const {
  Index blocking = -1;
  step = infinity;
  for (Index k = 0; k < T_.rows(); ++k) {
    const Index name = basic_[static_cast<std::size_t>(k)];
    const double rate = sign * T_(k, column);
    if (is_free(name) || rate <= noise_) continue;
    const double ratio = value_[k] > value_noise_ ? value_[k] / rate : 0;
    if (ratio < step || (ratio <= step && name < basic_[static_cast<std::size_t>(blocking)])) {
      step = ratio;
      blocking = k;
    }
  }
  return blocking;
}

void MultiplierTableau::pivot(Index row, Index column) {
  ++pivots_;
  const double element = T_(row, column);
  const double entering = value_[row] / element;
  const Eigen::RowVectorXd pivot_row = T_.row(row) / element;
  const Vector pivot_column = T_.col(column);
  value_ -= pivot_column * entering;
  for (Index j = 0; j < T_.cols(); ++j)
    if (pivot_row[j] != 0) T_.col(j) -= pivot_column * pivot_row[j];
  T_.row(row) = pivot_row;
  T_.col(column) = -pivot_column / element;
  T_(row, column) = 1 / element;
  value_[row] = entering;
  std::swap(basic_[static_cast<std::size_t>(row)], nonbasic_[static_cast<std::size_t>(column)]);
}

Index MultiplierTableau::entering_column(Index row, double direction, bool by_name) const {
  Index entering = -1;
  for (Index j = 0; j < T_.cols(); ++j) {
    const double slope = -direction * T_(row, j);
    if (fixed_[static_cast<std::size_t>(j)] || slope <= noise_) continue;
    const bool better = entering < 0 || (by_name ? nonbasic_[static_cast<std::size_t>(j)] <
                                                       nonbasic_[static_cast<std::size_t>(entering)]
                                                 : slope > -direction * T_(row, entering));
    if (better) entering = j;
  }
  return entering;
}

double MultiplierTableau::extreme(Index a, double direction) {
  // The steepest column enters; after a step of length 0 the rule of Bland (1977) holds until there is a
  // longer one: the entering multiplier of least name that improves, the leaving one of least name. So
  // nothing comes back, but for rounding: then the rule holds to the end, and there is one.
  bool by_name = false;
  const Index usual = T_.rows() + T_.cols(), most = 20 * usual;
  for (Index step_count = 0; step_count <= most; ++step_count) {
    const auto position = std::find(basic_.begin(), basic_.end(), a);
    Index entering = -1;
    if (position == basic_.end()) {
      if (direction < 0) return 0;  // nonbasic and one-sided: at its least value
      entering = std::find(nonbasic_.begin(), nonbasic_.end(), a) - nonbasic_.begin();
      invariant(entering < T_.cols(), "a tight row is basic or nonbasic");
    } else {
      const Index row = position - basic_.begin();
      entering = entering_column(row, direction, by_name);
      if (entering < 0) return is_free(a) ? value_[row] : std::max(0.0, value_[row]);
    }
    double step = infinity;
    const Index row = blocking_row(entering, 1, step);
    if (row < 0) return direction * infinity;
    by_name = step <= 0 || step_count >= usual;
    pivot(row, entering);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Interval MultiplierTableau::range(Index a) {
  if (unbounded_[static_cast<std::size_t>(a)]) return {-infinity, infinity};
  if (pivots_ > most_pivots_since_start) {
    basic_ = start_.basic;
    nonbasic_ = start_.nonbasic;
    value_ = start_.value;
    T_ = start_.T;
    pivots_ = 0;
  }
  const double noise = value_noise_;
  const auto silenced = [noise](double end) { return std::abs(end) <= noise ? 0 : end; };
  return {silenced(extreme(a, -1)), silenced(extreme(a, 1))};
}

}  // namespace convex::inline multiplier_sets
