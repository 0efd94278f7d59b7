#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "convex/constraint_rows.hpp"
#include "convex/metric.hpp"

namespace convex {

/// By how much the doubles of a problem may be off the numbers that they stand for: ||δu_a||_(A⁻¹) <= row_a
/// and |δs_a| <= s_a. Rows that some numbers within their radii make dependent, and
/// consistent, count as that. Both: m.
struct DataRadii {
  Vector row, s;
  bool is_zero() const { return row.isZero(0) && s.isZero(0); }
};

/// The radii of the rows chosen, in that order; none where there are none.
std::optional<DataRadii> select(const std::optional<DataRadii>&, const std::vector<Index>& rows);

/// By index below `count`, whether it is among those chosen.
std::vector<bool> marked(Index count, const std::vector<Index>& chosen);

/// 0 … count - 1.
std::vector<Index> indices_below(Index count);

struct NearestPointProblem;

/// Whether A couples no coordinates.
inline bool is_diagonal(const Metric& A) {
  return A.kind() == MetricKind::identity || A.kind() == MetricKind::diagonal;
}

/// ||e_i||_(A⁻¹) of each coordinate: n. Where A is full and has many, 1 / sqrt(A_ii), which is no more.
Vector unit_lengths(const Metric& A);
/// At most ||e||_(A⁻¹) of all e with |e_i| <= |u_ai|, of every row: m.
Vector longest_within(const ConstraintRows& U, const Metric& A);
/// Radii as if every number of U and s had been rounded so many times.
DataRadii rounding_radii(const NearestPointProblem&, double roundings);

/// The nearest-point problem (Moreau 1966, (10), (13)): find q (written q'' in mechanics) that minimises
/// ½ q·Aq - z·q over u_a·q >= s_a, with equality for the two-sided rows. With x = Aq and (x|y) = x·A⁻¹y
/// it reads x = proj_C z, C = {x : (u_a|x) >= s_a}.
/// A: n×n; z: n; U: m×n, row a is u_a; s: m; two_sided: increasing indices of rows.
struct NearestPointProblem {
  Metric A;
  Vector z;
  ConstraintRows U;
  Vector s;
  std::vector<Index> two_sided;
  std::optional<DataRadii> radii = {};  ///< none: the doubles are the numbers that are meant

  Index dimension() const { return A.dimension(); }
  Index rows() const { return U.count(); }
  bool is_two_sided(Index a) const { return std::binary_search(two_sided.begin(), two_sided.end(), a); }
};

/// Throws InvalidInput when sizes do not fit, an entry is not finite, or `two_sided` names no row.
void validate(const NearestPointProblem&);

/// Throws InvalidInput when a guess of active rows names a row that is not there. Their order, and rows named
/// twice, do not matter.
void validate_guess(const NearestPointProblem&, const std::vector<Index>& guess);

}  // namespace convex
