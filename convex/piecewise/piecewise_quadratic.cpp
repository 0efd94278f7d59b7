#include "convex/piecewise/piecewise_quadratic.hpp"

#include <algorithm>
#include <sstream>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"
#include "convex/piecewise/algebra.hpp"

namespace convex::inline piecewise_quadratics {
namespace {

/// The first corner with corner.x >= x; segment k then holds x, and its slope at x is f'_-(x).
std::size_t first_corner_from(const PiecewiseQuadratic& f, double x) {
  const auto& corners = f.corners();
  const auto found = std::lower_bound(corners.begin(), corners.end(), x,
                                      [](const Corner& corner, double point) { return corner.x < point; });
  return static_cast<std::size_t>(found - corners.begin());
}

bool is_finite(const Segment& line) {
  return std::isfinite(line.run) && std::isfinite(line.rise) && std::isfinite(line.x) &&
         std::isfinite(line.y) && std::isfinite(line.f) && std::isfinite(line.g);
}

double slope_between_corners(const PiecewiseQuadratic& f, std::size_t k, double x) {
  double y = slope_at(f.segments()[k], x);
  if (k > 0) y = std::max(y, f.corners()[k - 1].y);
  if (k < f.corners().size()) y = std::min(y, f.corners()[k].y);
  return y;
}

}  // namespace

PiecewiseQuadratic::PiecewiseQuadratic(std::vector<Segment> segments, std::vector<Corner> corners,
                                       const char* where)
    : segments_(std::move(segments)), corners_(std::move(corners)) {
  bool finite = true, directed = true, monotone = true;
  for (const Segment& line : segments_) {
    finite = finite && is_finite(line);
    directed = directed && line.run >= 0 && line.rise >= 0 && line.run + line.rise > 0;
  }
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    finite = finite && std::isfinite(corners_[k].x) && std::isfinite(corners_[k].y);
    if (k == 0) continue;
    const Corner &last = corners_[k - 1], &next = corners_[k];
    monotone = monotone && last.x <= next.x && last.y <= next.y && (last.x < next.x || last.y < next.y);
  }
  if (!finite || !directed)
    throw InvalidInput(std::string(where) +
                       ": a coefficient of the result leaves the range of doubles; rescale the data");
  invariant(segments_.size() == corners_.size() + 1, "a curve has one segment more than corners");
  invariant(monotone, "the graph of a subdifferential is monotone");
}

double PiecewiseQuadratic::operator()(double x) const {
  if (std::isnan(x)) return x;
  if (std::isinf(x)) return infinity;
  const std::size_t k = first_corner_from(*this, x);
  const Segment& line = segments_[k];
  if (line.run == 0) return x == line.x ? line.f : infinity;
  return value_at(line, x, slope_between_corners(*this, k, x));
}

Interval domain(const PiecewiseQuadratic& f) {
  const Segment &first = f.segments().front(), &last = f.segments().back();
  return {first.run == 0 ? first.x : -infinity, last.run == 0 ? last.x : infinity};
}

Interval slopes(const PiecewiseQuadratic& f) {
  const Segment &first = f.segments().front(), &last = f.segments().back();
  return {first.rise == 0 ? first.y : -infinity, last.rise == 0 ? last.y : infinity};
}

std::optional<Interval> subdifferential(const PiecewiseQuadratic& f, double x) {
  const auto& corners = f.corners();
  const std::size_t k = first_corner_from(f, x);
  std::size_t end = k;
  while (end < corners.size() && corners[end].x == x) ++end;
  const Segment &before = f.segments()[k], &after = f.segments()[end];
  if (k == end) {
    if (before.run == 0) {
      if (x == before.x) return Interval{-infinity, infinity};
      return std::nullopt;
    }
    if (!std::isfinite(x)) return std::nullopt;
    const double y = slope_between_corners(f, k, x);
    return Interval{y, y};
  }
  return Interval{before.run == 0 ? -infinity : corners[k].y, after.run == 0 ? infinity : corners[end - 1].y};
}

std::optional<Interval> minimizers(const PiecewiseQuadratic& f) { return subdifferential(conjugate(f), 0); }

double infimum(const PiecewiseQuadratic& f) { return 0.0 - conjugate(f)(0); }

std::string text(const Interval& interval) {
  std::ostringstream out;
  out.precision(17);
  out << '[' << interval.low << ", " << interval.high << ']';
  return out.str();
}

}  // namespace convex::inline piecewise_quadratics
