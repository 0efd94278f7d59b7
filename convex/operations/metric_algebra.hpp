#pragma once

#include <optional>
#include <vector>

#include "convex/composite/metric_difference.hpp"
#include "convex/metric.hpp"

/// Metrics made of metrics. Diagonal kinds stay diagonal wherever the result is diagonal, so that closed
/// forms survive. A sum keeps sparsity; an inverse does not. Each result carries a relative error of some
/// roundings times the condition number of its operands, as every metric does that is rounded to doubles.
namespace convex::inline operations {

/// A sum with more than one entry in so many is stored in full.
inline constexpr Index dense_above = 4;

/// Whether W is the identity or diagonal.
bool is_diagonal_kind(const Metric& W);

/// factor W; W itself when the factor is 1. Throws InvalidInput unless factor > 0 and finite.
Metric times(double factor, const Metric& W);

/// W + Q. Q: n×n symmetric positive semidefinite; diagonal when W and Q are, dense when W is.
Metric plus(const Metric& W, const SparseMatrix& Q);
Metric plus(const Metric& W, const Metric& V);

/// W⁻¹.
Metric inverse(const Metric& W);

/// The factor with V = factor W, when there is one to rounding.
std::optional<double> ratio(const Metric& V, const Metric& W);

/// (W⁻¹ + V⁻¹)⁻¹, the parallel sum: min over b of ½||y - b||_W² + ½||b||_V² = ½||y||² in it (Anderson and
/// Duffin 1969).
Metric parallel_sum(const Metric& W, const Metric& V);

/// M W⁻¹ M; W itself when M = W.
Metric congruence(const Metric& M, const Metric& W);

/// The principal block of W on the entries first, …, first + size - 1.
Metric block(const Metric& W, Index first, Index size);

/// Is some entry of W outside the diagonal blocks of these sizes not zero?
bool couples(const Metric& W, const std::vector<Index>& sizes);

/// The metric that W leaves on the values of A: ½||u||² in it is min ½||x||_W² over Ax = u; its Gram matrix
/// is (A W⁻¹ Aᵀ)⁻¹. A: m×n.
struct ImageMetric {
  Metric metric;
  Matrix lift;       ///< W⁻¹Aᵀ: n×m
  double condition;  ///< of F⁻¹Aᵀ, W = F Fᵀ; the Gram matrix has its square
};

/// None when the rows of A are dependent to working precision. When A W⁻¹ Aᵀ is diagonal to rounding
/// (semi-orthogonality in the metric: A W⁻¹ Aᵀ = nu I, and unequal entries too) the metric is diagonal.
std::optional<ImageMetric> image_metric(const Metric& W, const Matrix& A);

}  // namespace convex::inline operations
