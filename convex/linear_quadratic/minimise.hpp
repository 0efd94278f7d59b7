#pragma once

#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/metric.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::linear_quadratic {

/// Why there is no minimum.
enum class Defect { none, empty_domain, unbounded_below };

/// The ξ that minimises ½||x - z||_W² + ½ ξ·Hξ + c·ξ over Gξ >= h.
struct ProgramPoint {
  Status status = Status::gave_up;
  Defect defect = Defect::none;
  Vector xi;                ///< n + k; its auxiliary part need not be unique
  Vector lambda;            ///< multipliers of the rows, >= 0 on one-sided ones: m
  Vector v;                 ///< (Hξ + c - Gᵀlambda)_x, a subgradient of f at x: n
  Vector ray;               ///< when unbounded below: Gd >= 0, Hd = 0, c·d < 0, d zero on x
  double error_bound = 0;   ///< an estimate of ||x - x*||_W
  double defect_ratio = 0;  ///< stationarity in the auxiliary variables, relative to its terms
  Index rounds = 0;         ///< nearest-point problems solved
};

/// Convex quadratic programming by the proximal-point method (Rockafellar 1976) on the variables in which the
/// objective is not strictly convex: each round is a nearest-point problem with a definite matrix, solved by
/// the active-set method and warm-started by the rows of the last. Where H = 0 on these variables it ends
/// after finitely many rounds (Rockafellar 1976, proposition 8; Ferris 1991), else linearly, with a part of
/// the remaining error that is made as small as needed. The linear terms of a round are formed in twice the
/// working precision with the data as they are, so that a fixed point solves the program itself and not a
/// nearby one. W: n×n; z: n. Gives up where H and W, as rounded, add up to no definite matrix.
ProgramPoint minimise(const LinearQuadratic& f, const Metric& W, const Vector& z);

/// A direction in which f is linear, decreasing and never leaves the rows: Gd >= 0, Hd = 0, c·d < 0, d = 0 on
/// the first n entries. Empty when there is none.
Vector descent_ray(const LinearQuadratic& f);

}  // namespace convex::linear_quadratic
