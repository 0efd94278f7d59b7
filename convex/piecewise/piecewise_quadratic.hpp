#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convex/interval.hpp"
#include "convex/piecewise/segment.hpp"

namespace convex::inline piecewise_quadratics {

/// A point of the graph of a subdifferential where one segment ends and the next begins.
struct Corner {
  double x = 0, y = 0;
};

/// A convex, closed, proper, piecewise linear-quadratic function f : R -> (-inf, +inf], kept as the graph of
/// its subdifferential: a monotone curve of segments 0..n between corners 0..n-1, the first and the last
/// segment being rays (with no corner: one whole line). A vertical segment is a kink of f, a vertical ray an
/// end of its domain, a horizontal segment an affine piece; each segment carries the value. So a domain may
/// be a point, an interval, a half-line or the line, conjugation swaps rows, and a prox is a shear
/// (Gardiner and Lucet 2010, "Convex hull algorithms for piecewise linear-quadratic functions in
/// computational convex analysis"; Goebel 2008). Corners are increasing, x and y both, and never equal.
///
/// Made by `piecewise_quadratic(breaks, coefficients)` and the makers of elementary.hpp, combined by
/// algebra.hpp. Immutable.
class PiecewiseQuadratic {
 public:
  /// For code that knows the curve; `where` names the operation in messages. Throws InvalidInput when a
  /// number overflowed. Our own bug if the curve is not monotone.
  PiecewiseQuadratic(std::vector<Segment> segments, std::vector<Corner> corners, const char* where);

  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Corner>& corners() const { return corners_; }

  /// The rows themselves, of a function that is no longer wanted.
  std::vector<Segment> take_segments() && { return std::move(segments_); }
  std::vector<Corner> take_corners() && { return std::move(corners_); }

  /// f(x), +inf outside the domain, in O(log n).
  double operator()(double x) const;

 private:
  std::vector<Segment> segments_;
  std::vector<Corner> corners_;
};

/// {x : f(x) < inf}, closed.
Interval domain(const PiecewiseQuadratic&);
/// The slopes that f has somewhere, closed: the domain of the conjugate.
Interval slopes(const PiecewiseQuadratic&);
/// The subdifferential [f'_-(x), f'_+(x)]: -inf, +inf at the ends of the domain; none outside it.
std::optional<Interval> subdifferential(const PiecewiseQuadratic&, double x);
/// argmin f; none when f is not bounded below.
std::optional<Interval> minimizers(const PiecewiseQuadratic&);
/// inf f; -inf when f is not bounded below.
double infimum(const PiecewiseQuadratic&);

/// "[low, high]", for messages.
std::string text(const Interval&);

}  // namespace convex::inline piecewise_quadratics
