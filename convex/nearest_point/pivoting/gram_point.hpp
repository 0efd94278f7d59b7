#pragma once

#include "convex/vector.hpp"

namespace convex::inline pivoting {

/// The rows that an engine on the Gram matrix holds, the point that they define, q + q_low with the
/// multipliers lambda + lambda_low, and what is known of it: one for all `GramWorkingSet`s, which own the
/// arrays. D: the diagonal of A, dense. Vectors of coordinates are padded with zeros to `ld`.
struct GramPoint {
  Index n = 0, all = 0, ld = 0;  ///< coordinates, rows of the problem
  const double *T = nullptr, *inverse = nullptr, *A = nullptr, *U = nullptr;
  double factor_condition = 1;
  double *diagonal, *inverse_diagonal, *unit;  ///< of D; unit: 1 over its root
  double *z, *w_free, *w, *q, *q_low, *dq, *r;

  /// Of all rows. row_scale: ||u_a||_(D⁻¹), where rows are many and coordinates few no less and hardly more;
  /// slack: u_a·q - s_a; close: room for a list.
  double *row_scale, *slack, *degenerate_slack;
  Index* close;

  /// Of the working set: which they are, their places, their multipliers, and what a correction added to
  /// these; length: |v_a|, pull: the same, 0 for a two-sided row.
  Index *rows, *place, size = 0;
  double *lambda, *lambda_low, *change, *length, *pull;
  double* held_slack;                 ///< set apart: their `slack` is infinite, they are not close
  double *lambda_at, *lambda_low_at;  ///< at places, 0 for rows not held
  double *pack, *coefficients;        ///< room for eight vectors, and for eight times the working set

  Index steps = 0;  ///< rows taken in or dropped
  double z_norm = 0, acceleration_norm = 0, inverse_norm = 0, stationarity = 0;
  double magnitude = 0;  ///< ||q||_D
  double gram_condition =
      0;                 ///< of the Gram matrix of the working set, each divided by its length; an estimate
  double growth = 0;     ///< what enlarges rounding in the inverse of that; 0 where there is a factor
  double step = 0;       ///< ||dq||_A of a correction, and what it took for 0 before
  bool is_fresh = true;  ///< the first correction of these rows

  double norm() const { return acceleration_norm > z_norm ? acceleration_norm : z_norm; }
};

}  // namespace convex::inline pivoting
