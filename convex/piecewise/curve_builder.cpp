#include "convex/piecewise/curve_builder.hpp"

#include <algorithm>

#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"

namespace convex::inline piecewise_quadratics {
namespace {

/// -0 becomes 0, so that equal functions have equal bytes.
Segment without_negative_zero(const Segment& line) {
  return {line.run + 0.0, line.rise + 0.0, line.x + 0.0, line.y + 0.0, line.f + 0.0, line.g + 0.0};
}

}  // namespace

CurveBuilder::CurveBuilder(std::size_t expected) {
  segments_.reserve(expected + 1);
  corners_.reserve(expected);
}

void CurveBuilder::segment(const Segment& line) {
  invariant(segments_.size() == corners_.size(), "a segment follows a corner");
  if (!corners_.empty() && same_line(segments_.back(), line)) {
    corners_.pop_back();
    return;
  }
  segments_.push_back(without_negative_zero(line));
}

void CurveBuilder::corner(double x, double y) {
  invariant(segments_.size() == corners_.size() + 1, "a corner ends a segment");
  if (!corners_.empty()) {
    const Corner& last = corners_.back();
    x = std::max(x, last.x);
    y = std::max(y, last.y);
    if (x == last.x && y == last.y) {
      segments_.pop_back();
      return;
    }
  }
  corners_.push_back({x + 0.0, y + 0.0});
}

void CurveBuilder::joint(double x, double left, double right, double f) {
  corner(x, left);
  if (right > left) {
    segment(vertical(x, f));
    corner(x, right);
  }
}

PiecewiseQuadratic CurveBuilder::finish(const char* where) {
  return PiecewiseQuadratic(std::move(segments_), std::move(corners_), where);
}

void require(bool holds, const char* message) {
  if (!holds) throw InvalidInput(message);
}

}  // namespace convex::inline piecewise_quadratics
