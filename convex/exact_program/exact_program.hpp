#pragma once

#include <map>
#include <vector>

#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"

namespace convex::inline exact_programs {

using Fractions = std::vector<Fraction>;

/// Σ_j a_j ξ_j by its nonzero coefficients.
using ExactRow = std::map<std::size_t, Fraction>;

/// a += factor b; a sum that is 0 is taken out.
void add(ExactRow& a, std::size_t j, const Fraction& value);
void add(ExactRow& a, const ExactRow& b, const Fraction& factor);
/// Σ_j a_j ξ_j.
Fraction dot(const ExactRow& a, const Fractions& xi);
Fraction dot(const Fractions& a, const Fractions& b);

/// a·ξ >= limit, or = limit.
struct ExactBound {
  ExactRow row;
  Fraction limit;
  bool two_sided = false;
};

/// A convex piecewise linear-quadratic function (see LinearQuadratic) whose numbers are fractions:
///
///   f(x) = constant + min over w of { ½ ξ·Hξ + c·ξ : rows },  ξ = (x, w),  x the first n of them.
///
/// H: one row a variable, symmetric positive semidefinite.
struct ExactProgram {
  std::size_t n = 0;
  std::vector<ExactRow> H;
  Fractions c;
  Fraction constant;
  std::vector<ExactBound> rows;

  ExactProgram() = default;
  /// 0 on n variables and k auxiliary ones.
  ExactProgram(std::size_t entries, std::size_t k) : n(entries), H(entries + k), c(entries + k) {}

  std::size_t variables() const { return c.size(); }
  bool is_polyhedral() const;
  /// Adds value to H(i, j) and, off the diagonal, to H(j, i).
  void curve(std::size_t i, std::size_t j, const Fraction& value);
  void bound(ExactRow row, const Fraction& limit) { rows.push_back({std::move(row), limit, false}); }
  void equation(ExactRow row, const Fraction& limit) { rows.push_back({std::move(row), limit, true}); }
};

/// ½ ξ·Hξ.
Fraction half_square(const ExactProgram& f, const Fractions& xi);
/// ½ ξ·Hξ + c·ξ + constant.
Fraction objective(const ExactProgram& f, const Fractions& xi);

/// The program of doubles at their exact values.
ExactProgram exact(const LinearQuadratic& f);
/// The program with its numbers rounded.
LinearQuadratic rounded(const ExactProgram& f);

/// Σ_j row_j η_j + shift: what an old variable is of new ones.
struct ExactAffine {
  ExactRow row;
  Fraction shift;
};

/// F(Tη + s) for F the function of ξ: `maps` holds one row of T and entry of s for each ξ; n of the new
/// variables, of which there are `columns`, are x.
ExactProgram substitute(const ExactProgram& f, const std::vector<ExactAffine>& maps, std::size_t n,
                        std::size_t columns);

/// F + G of the same variables.
ExactProgram add_joint(ExactProgram f, const ExactProgram& g);

}  // namespace convex::inline exact_programs
