#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/curve_builder.hpp"

namespace convex::inline piecewise_quadratics {
namespace {

/// A point of the graph with the value of the function there.
struct GraphPoint {
  double x, y, f;
};

/// A curve walked by z = x + gamma y, which increases strictly along it.
class ResolventCursor {
 public:
  ResolventCursor(const PiecewiseQuadratic& f, double gamma) : f_(&f), gamma_(gamma) {}
  const Segment& piece() const { return f_->segments()[k_]; }
  double key(double x, double y) const { return std::fma(gamma_, y, x); }
  double end() const {
    if (k_ == f_->corners().size()) return infinity;
    const Corner& corner = f_->corners()[k_];
    return key(corner.x, corner.y);
  }
  void advance_to(double z) {
    while (end() <= z) ++k_;
  }
  /// The point with x + gamma y = z on the whole line of the piece.
  GraphPoint on_line(double z) const {
    const Segment& line = piece();
    const double step = (z - key(line.x, line.y)) / key(line.run, line.rise);
    const double x = line.x + line.run * step, y = line.y + line.rise * step;
    return {x, y, value_at(line, x, y)};
  }
  /// The same inside the piece.
  GraphPoint point(double z) const {
    GraphPoint p = on_line(z);
    if (k_ > 0) raise(p, f_->corners()[k_ - 1]);
    if (k_ < f_->corners().size()) {
      if (z == end()) raise(p, f_->corners()[k_]);
      lower(p, f_->corners()[k_]);
    }
    p.f = value_at(piece(), p.x, p.y);
    return p;
  }

 private:
  static void raise(GraphPoint& p, const Corner& c) { p.x = std::max(p.x, c.x), p.y = std::max(p.y, c.y); }
  static void lower(GraphPoint& p, const Corner& c) { p.x = std::min(p.x, c.x), p.y = std::min(p.y, c.y); }

  const PiecewiseQuadratic* f_;
  double gamma_;
  std::size_t k_ = 0;
};

struct Average {
  double weight, gamma;

  /// Exactly b where a = b.
  double of(double a, double b) const { return b + weight * (a - b); }

  GraphPoint of(const GraphPoint& a, const GraphPoint& b) const {
    const double gap = a.y - b.y;
    return {of(a.x, b.x), of(a.y, b.y), of(a.f, b.f) + 0.5 * gamma * (weight * (1 - weight)) * gap * gap};
  }

  Segment of(const ResolventCursor& f, const ResolventCursor& g, double from, double to) const {
    const Segment &a = f.piece(), &b = g.piece();
    const double z = anchor(f.key(a.x, a.y), g.key(b.x, b.y), from, to);
    const GraphPoint p = of(f.on_line(z), g.on_line(z));
    if (equal_products(a.run, b.rise, b.run, a.rise)) return anchored(a.run, a.rise, p.x, p.y, p.f);
    const double key_a = f.key(a.run, a.rise), key_b = g.key(b.run, b.rise);
    int exponent_a = 0, exponent_b = 0;
    std::frexp(key_a, &exponent_a);
    std::frexp(key_b, &exponent_b);
    const auto near_one_a = [&](double v) { return std::ldexp(v, -exponent_a); };
    const auto near_one_b = [&](double v) { return std::ldexp(v, -exponent_b); };
    return anchored(
        weight * near_one_a(a.run) * near_one_b(key_b) + (1 - weight) * near_one_b(b.run) * near_one_a(key_a),
        weight * near_one_a(a.rise) * near_one_b(key_b) +
            (1 - weight) * near_one_b(b.rise) * near_one_a(key_a),
        p.x, p.y, p.f);
  }

  /// Of two anchors the one nearer to the interval, then to 0.
  static double anchor(double a, double b, double from, double to) {
    const auto distance = [&](double z) { return std::max({from - z, z - to, 0.0}); };
    if (distance(a) != distance(b)) return distance(a) < distance(b) ? a : b;
    return std::abs(a) <= std::abs(b) ? a : b;
  }
};

}  // namespace

PiecewiseQuadratic proximal_average(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g, double weight,
                                    double gamma) {
  if (!(weight >= 0 && weight <= 1))
    throw InvalidInput("proximal_average: the weight must be between 0 and 1");
  if (!(gamma > 0 && std::isfinite(gamma)))
    throw InvalidInput("proximal_average: gamma must be positive and finite; give gamma > 0");
  if (weight == 1) return f;
  if (weight == 0) return g;
  const Average average{weight, gamma};
  ResolventCursor left(f, gamma), right(g, gamma);
  CurveBuilder curve(f.corners().size() + g.corners().size());
  for (double z = -infinity;;) {
    const double end = std::min(left.end(), right.end());
    curve.segment(average.of(left, right, z, end));
    if (end == infinity) break;
    const GraphPoint p = average.of(left.point(end), right.point(end));
    curve.corner(p.x, p.y);
    left.advance_to(end);
    right.advance_to(end);
    z = end;
  }
  return curve.finish("proximal_average");
}

}  // namespace convex::inline piecewise_quadratics
