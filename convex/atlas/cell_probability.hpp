#pragma once

#include "convex/atlas/orthant_probability.hpp"
#include "convex/atlas/simplicial_pieces.hpp"

namespace convex::atlas {

/// A normal distribution of z. No covariance means A: z then has no preferred direction in the metric A⁻¹,
/// and for the mean 0 the probability of a cone is its solid angle there.
struct NormalLinearTerm {
  ExactVector mean;                          ///< n
  std::optional<ExactRows> covariance = {};  ///< n×n, symmetric positive definite
};

/// The probabilities of polyhedra under a distribution of z, each found for itself: nothing is normalised, so
/// that the sum over the cells of an atlas is a check.
class CellProbability {
 public:
  /// Throws InvalidInput when sizes do not fit or the covariance is not positive definite.
  CellProbability(const RowSpace&, const NormalLinearTerm&);

  /// To the tolerance where the quadrature gets there; its error tells. Where the covariance is A, the cell
  /// is a product at right angles, and so is its probability. What comes out negative, within its error, is
  /// 0. At most six dimensions.
  Probability of(const Cell&, double tolerance) const;

  /// Of {z : the free point c satisfies (a, b)·(c, 1) >= 0 for every row}.
  Probability of(const IntegerRows& halfspaces, double tolerance) const;

 private:
  Probability product_or_sum(const Cell&, double tolerance) const;
  Probability of(const std::vector<SignedCone>&, const IntegerRows& others, const IntegerRows& lines,
                 double tolerance) const;
  /// Of apex + {Σ mu_k d_k + Σ nu_l b_l : mu >= 0}.
  Probability of_cone(const SignedCone&, const IntegerRows& others, const IntegerRows& lines,
                      double tolerance) const;
  std::vector<IntegerRows> normal_pieces(const Cell&) const;

  const RowSpace& space_;
  std::vector<std::vector<ConeFace>> levels_;
  bool has_metric_covariance_ = true;
  IntegerRows precision_;  ///< of c: precision_scale_ times this
  Fraction precision_scale_;
  ExactVector mean_;   ///< of c
  IntegerRows lines_;  ///< of every cell: from rows that hold with equality everywhere
};

}  // namespace convex::atlas
