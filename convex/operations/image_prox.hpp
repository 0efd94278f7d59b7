#pragma once

#include "convex/gamma0/function.hpp"
#include "convex/operations/metric_algebra.hpp"

namespace convex::inline operations {

/// prox^W z of x -> f(Ax + b) by the prox of f in the metric S = (A W⁻¹Aᵀ)⁻¹ of the image, A with independent
/// rows. A: m×n; b: m.
///
/// ½||x - z||_W² is least over Ax + b = u at x = z + W⁻¹Aᵀ S (u - Az - b), where it is ½||u - Az - b||_S². So
/// u = prox^S_f y at y = Az + b; p = S(y - u) is the covector of f there, and x = z - W⁻¹Aᵀp. S is rounded,
/// and where A is ill-conditioned p is large beside x and cancels in Aᵀp, so that p, x and
///   e = Ax + b - u
/// are formed in twice the working precision; the prox is asked again at y + e. For the exact prox (u, p) of
/// the stored y and S the point is wrong by ||e||_S at most: a point with Ax + b = u is W⁻¹Aᵀ S e away, and
/// there ||W(x - z) + Aᵀp||_(W⁻¹) = ||e||_S.
Prox image_prox(const Function& f, const Matrix& A, const Vector& b, const ImageMetric& image,
                const Vector& z, const Metric& W, const Look& look);

/// Ax + b in twice the precision: its terms may cancel where f is steep.
DoubleDoubleVector accurate_image(const Matrix& A, const DoubleDoubleVector& x, const Vector& b);

}  // namespace convex::inline operations
