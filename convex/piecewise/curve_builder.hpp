#pragma once

#include <vector>

#include "convex/piecewise/piecewise_quadratic.hpp"

namespace convex::inline piecewise_quadratics {

/// Makes a curve from left to right: segment, corner, segment, …, segment. It leaves out what is exactly
/// redundant, segments between equal corners and corners between segments of one line, and holds corners to
/// increasing order where rounding undid it.
class CurveBuilder {
 public:
  explicit CurveBuilder(std::size_t expected = 0);
  void segment(const Segment& line);
  void corner(double x, double y);
  /// A kink or a smooth joint at x with slopes from left to right and value f(x).
  void joint(double x, double left, double right, double f);
  PiecewiseQuadratic finish(const char* where);

 private:
  std::vector<Segment> segments_;
  std::vector<Corner> corners_;
};

/// Throws InvalidInput with this message unless it holds.
void require(bool holds, const char* message);

}  // namespace convex::inline piecewise_quadratics
