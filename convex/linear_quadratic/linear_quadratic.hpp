#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex::linear_quadratic {

/// A convex piecewise linear-quadratic function of n variables, with k auxiliary ones (Rockafellar and Wets
/// 1998, definition 10.20 and theorem 11.14; the form is that of an inf-projection, proposition 11.32):
///
///   f(x) = constant + min over w of { ½ ξ·Hξ + c·ξ : G ξ >= h },  ξ = (x, w),
///
/// with equality in the rows of `two_sided`. H: (n+k)×(n+k), symmetric positive semidefinite, often 0; c:
/// n+k; G: m×(n+k); h: m, finite; two_sided: increasing indices of rows. It is polyhedral when H = 0 and an
/// indicator when moreover c = 0. The value is +inf where no w fits; f is improper when that is everywhere,
/// or when the minimum is -inf (see properness.hpp).
struct LinearQuadratic {
  Index n = 0;
  SparseMatrix H;
  Vector c;
  double constant = 0;
  SparseRows G;
  Vector h;
  std::vector<Index> two_sided;

  Index variables() const { return c.size(); }
  Index auxiliaries() const { return c.size() - n; }
  Index rows() const { return h.size(); }
  bool polyhedral() const { return H.nonZeros() == 0; }
};

/// Throws InvalidInput when sizes do not fit, an entry is not finite, H is not symmetric or `two_sided` names
/// no row. That H is positive semidefinite is judged where it comes from (`quadratic`, `separable_pieces`).
void validate(const LinearQuadratic& f, const char* where);

/// ½ ξ·Hξ + c·ξ + constant, summed in twice the working precision.
double objective(const LinearQuadratic& f, const Vector& xi);

/// F ∘ (T η + s), F the function of ξ = Tη + s: H, c and rows are those of f in the new variables η, of which
/// the first n are x. T: variables(f) × columns; s: variables(f).
LinearQuadratic substitute(const LinearQuadratic& f, Index n, const SparseMatrix& T, const Vector& s);

/// F + G of two functions of the same variables ξ.
LinearQuadratic add_joint(const LinearQuadratic& f, const LinearQuadratic& g);

/// A function on n variables and k auxiliary ones, put together row by row.
class LinearQuadraticBuilder {
 public:
  LinearQuadraticBuilder(Index n, Index k);

  /// Adds `value` to H(i, j) and, off the diagonal, to H(j, i).
  void curve(Index i, Index j, double value);
  void cost(Index j, double value) { form_.c[j] += value; }
  void constant(double value) { form_.constant += value; }
  /// Starts the row G ξ >= bound; `entry` then fills it.
  void row(double bound);
  /// Starts the row G ξ = bound.
  void equation(double bound);
  void entry(Index j, double value);
  LinearQuadratic finish() const;

 private:
  LinearQuadratic form_;
  std::vector<Eigen::Triplet<double>> H_, G_;
  std::vector<double> h_;
};

}  // namespace convex::linear_quadratic

namespace convex {
using linear_quadratic::LinearQuadratic;
using linear_quadratic::LinearQuadraticBuilder;
}  // namespace convex
