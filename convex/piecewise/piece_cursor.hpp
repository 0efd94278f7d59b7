#pragma once

#include "convex/piecewise/piecewise_quadratic.hpp"

namespace convex::inline piecewise_quadratics {

/// Walks over the pieces of f that have an interior, from left to right. The domain must be more than a
/// point.
class PieceCursor {
 public:
  explicit PieceCursor(const PiecewiseQuadratic& f);
  /// The ends of the current piece, infinite where there is none.
  double start() const;
  double end() const;
  const Segment& piece() const { return f_->segments()[k_]; }
  /// f' at x inside the piece, one-sided at its ends.
  double slope(double x) const;
  double value(double x) const { return value_at(piece(), x, slope(x)); }
  /// Whether there is a piece after this one.
  bool has_next() const;
  void next();
  /// Up to the piece that holds the points just right of x, which lie in the domain.
  void advance_to(double x) {
    while (end() <= x) next();
  }

 private:
  const PiecewiseQuadratic* f_;
  std::size_t k_ = 0;
};

/// Two functions of one domain [low, high] with an interior, walked together: every break of either, once.
struct PairOfCursors {
  PieceCursor f, g;
  double low, high;

  /// Throws InvalidInput "where: …" when the domains do not meet; none when they meet in one point.
  static std::optional<PairOfCursors> meet(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g,
                                           const char* where, double& point);
  double end() const { return f.end() < g.end() ? f.end() : g.end(); }
};

}  // namespace convex::inline piecewise_quadratics
