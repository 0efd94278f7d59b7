#include <algorithm>
#include <cmath>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/curve_builder.hpp"

namespace convex::inline piecewise_quadratics {
namespace {

/// The curve with a monotone map applied to its corners and one to its segments.
template <class MapCorner, class MapSegment>
PiecewiseQuadratic mapped(const PiecewiseQuadratic& f, const char* where, MapCorner map_corner,
                          MapSegment map_segment) {
  const std::size_t n = f.corners().size();
  CurveBuilder curve(n);
  for (std::size_t k = 0; k < n; ++k) {
    curve.segment(map_segment(f.segments()[k]));
    const Corner moved = map_corner(f.corners()[k]);
    curve.corner(moved.x, moved.y);
  }
  curve.segment(map_segment(f.segments()[n]));
  return curve.finish(where);
}

PiecewiseQuadratic reflected(const PiecewiseQuadratic& f) {
  std::vector<Segment> segments(f.segments().rbegin(), f.segments().rend());
  std::vector<Corner> corners(f.corners().rbegin(), f.corners().rend());
  for (Segment& line : segments) line.x = 0.0 - line.x, line.y = 0.0 - line.y;
  for (Corner& corner : corners) corner = {0.0 - corner.x, 0.0 - corner.y};
  return PiecewiseQuadratic(std::move(segments), std::move(corners), "dilate");
}

}  // namespace

PiecewiseQuadratic conjugate(PiecewiseQuadratic f) {
  std::vector<Segment> segments = std::move(f).take_segments();
  std::vector<Corner> corners = std::move(f).take_corners();
  for (Segment& line : segments) line = conjugate(line);
  for (Corner& corner : corners) std::swap(corner.x, corner.y);
  return PiecewiseQuadratic(std::move(segments), std::move(corners), "conjugate");
}

PiecewiseQuadratic envelope(const PiecewiseQuadratic& f, double gamma) {
  require(gamma > 0 && std::isfinite(gamma), "envelope: gamma must be positive and finite; give gamma > 0");
  return mapped(
      f, "envelope",
      [&](const Corner& c) {
        return Corner{std::fma(gamma, c.y, c.x), c.y};
      },
      [&](const Segment& line) {
        const double square = 0.5 * (gamma * line.y) * line.y;
        return Segment{std::fma(gamma, line.rise, line.run),
                       line.rise,
                       std::fma(gamma, line.y, line.x),
                       line.y,
                       line.f + square,
                       line.g + square};
      });
}

PiecewiseQuadratic add_square(const PiecewiseQuadratic& f, double c) {
  require(c >= 0 && std::isfinite(c), "add_square: the factor of x^2/2 must be finite and not negative");
  return c == 0 ? f : conjugate(envelope(conjugate(f), c));
}

PiecewiseQuadratic scale(const PiecewiseQuadratic& f, double alpha) {
  require(alpha > 0 && std::isfinite(alpha), "scale: alpha must be positive and finite; give alpha > 0");
  return mapped(
      f, "scale",
      [&](const Corner& c) {
        return Corner{c.x, alpha * c.y};
      },
      [&](const Segment& line) {
        return Segment{line.run, alpha * line.rise, line.x, alpha * line.y, alpha * line.f, alpha * line.g};
      });
}

PiecewiseQuadratic dilate(const PiecewiseQuadratic& f, double rho) {
  require(rho != 0 && std::isfinite(rho), "dilate: rho must be finite and not 0");
  const double size = std::abs(rho);
  const PiecewiseQuadratic dilated = mapped(
      f, "dilate",
      [&](const Corner& c) {
        return Corner{size * c.x, c.y / size};
      },
      [&](const Segment& line) {
        return Segment{size * line.run, line.rise / size, size * line.x, line.y / size, line.f, line.g};
      });
  return rho > 0 ? dilated : reflected(dilated);
}

PiecewiseQuadratic translate(const PiecewiseQuadratic& f, double by) {
  require(std::isfinite(by), "translate: the shift must be finite");
  return mapped(
      f, "translate",
      [&](const Corner& c) {
        return Corner{c.x + by, c.y};
      },
      [&](const Segment& line) {
        return Segment{line.run, line.rise, line.x + by, line.y, line.f, std::fma(by, line.y, line.g)};
      });
}

PiecewiseQuadratic tilt(const PiecewiseQuadratic& f, double c) {
  require(std::isfinite(c), "tilt: the slope must be finite");
  return conjugate(translate(conjugate(f), c));
}

PiecewiseQuadratic add_constant(const PiecewiseQuadratic& f, double c) {
  require(std::isfinite(c), "add_constant: the constant must be finite");
  return mapped(
      f, "add_constant", [](const Corner& corner) { return corner; },
      [&](const Segment& line) {
        return Segment{line.run, line.rise, line.x, line.y, line.f + c, line.g - c};
      });
}

}  // namespace convex::inline piecewise_quadratics
