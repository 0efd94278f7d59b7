#include "convex/piecewise/piece_cursor.hpp"

#include <algorithm>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"

namespace convex::inline piecewise_quadratics {

PieceCursor::PieceCursor(const PiecewiseQuadratic& f) : f_(&f) {
  if (piece().run == 0) next();
}

double PieceCursor::start() const { return k_ == 0 ? -infinity : f_->corners()[k_ - 1].x; }

double PieceCursor::end() const { return k_ == f_->corners().size() ? infinity : f_->corners()[k_].x; }

double PieceCursor::slope(double x) const {
  const auto& corners = f_->corners();
  double y = slope_at(piece(), x);
  if (k_ > 0) y = x == corners[k_ - 1].x ? corners[k_ - 1].y : std::max(y, corners[k_ - 1].y);
  if (k_ < corners.size()) y = x == corners[k_].x ? corners[k_].y : std::min(y, corners[k_].y);
  return y;
}

bool PieceCursor::has_next() const { return k_ < f_->corners().size() && end() < domain(*f_).high; }

void PieceCursor::next() {
  const auto& corners = f_->corners();
  invariant(k_ < corners.size(), "a cursor stays in the domain");
  for (const double x = corners[k_].x; k_ < corners.size() && corners[k_].x == x;) ++k_;
}

std::optional<PairOfCursors> PairOfCursors::meet(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g,
                                                 const char* where, double& point) {
  const Interval first = domain(f), second = domain(g);
  const double low = std::max(first.low, second.low), high = std::min(first.high, second.high);
  if (low > high)
    throw InvalidInput(std::string(where) + ": the domains " + text(first) + " and " + text(second) +
                       " have no point in common, the result is +inf everywhere; shift one of them");
  if (low == high) {
    point = low;
    return std::nullopt;
  }
  PairOfCursors both{PieceCursor(f), PieceCursor(g), low, high};
  both.f.advance_to(low);
  both.g.advance_to(low);
  return both;
}

}  // namespace convex::inline piecewise_quadratics
