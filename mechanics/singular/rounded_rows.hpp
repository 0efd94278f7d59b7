#pragma once

#include <cmath>

#include "mechanics/expression/time_series.hpp"
#include "mechanics/row_space.hpp"

namespace mechanics::inline singular_states {

inline bool is_finite(expression::Rounded x) { return std::isfinite(x.value) && std::isfinite(x.radius); }

/// Σ w_a d^k f_a/dt^k.
inline expression::Rounded combined(const std::vector<expression::Rounded>& weights,
                                    const std::vector<expression::TimeSeries>& f, int derivative) {
  expression::Rounded total;
  for (std::size_t a = 0; a < weights.size(); ++a)
    if (weights[a].value != 0 || weights[a].radius != 0) total += weights[a] * f[a].derivative(derivative);
  return total;
}

/// Rows and the lengths of their radii, in the units of the columns.
struct ScaledRows {
  RowMatrix rows;
  Vector radius;
  ScaledRows(const std::vector<std::vector<expression::Rounded>>& of, const Vector& unit)
      : rows(static_cast<Index>(of.size()), unit.size()), radius(static_cast<Index>(of.size())) {
    for (std::size_t a = 0; a < of.size(); ++a) {
      Vector radii(unit.size());
      for (Index i = 0; i < unit.size(); ++i) {
        rows(static_cast<Index>(a), i) = of[a][static_cast<std::size_t>(i)].value * unit[i];
        radii[i] = of[a][static_cast<std::size_t>(i)].radius * unit[i];
      }
      radius[static_cast<Index>(a)] = radii.norm();
    }
  }
};

}  // namespace mechanics::inline singular_states
