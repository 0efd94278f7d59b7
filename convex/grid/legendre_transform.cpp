#include "convex/grid/legendre_transform.hpp"

#include <algorithm>
#include <cmath>

#include "convex/double_double.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"

namespace convex::inline grids {
namespace {

DoubleDouble product(DoubleDouble a, DoubleDouble b) {
  DoubleDouble p = two_product(a.hi, b.hi);
  p.lo += a.hi * b.lo + a.lo * b.hi;
  return two_sum(p.hi, p.lo);
}

struct Sample {
  double x, f;
};

/// Which family of curves the maximum or minimum is over, and what to do with a point x of value f at p:
/// lines p x - f, or parabolas f + curvature/2 (x - p)². Minimising a parabola is maximising the line
/// curvature p x - (f + curvature/2 x²); both are treated as that, the squares never formed.
struct Family {
  double curvature;  // 0 for lines

  /// The objective, to be maximised.
  double at(const Sample& sample, double p) const {
    if (curvature == 0) return p * sample.x - sample.f;
    const double step = sample.x - p;
    return -(sample.f + 0.5 * curvature * step * step);
  }
  /// The p from which b is better than a, a.x < b.x.
  double turn(const Sample& a, const Sample& b) const {
    const double slope = (b.f - a.f) / (b.x - a.x);
    return curvature == 0 ? slope : slope / curvature + 0.5 * (a.x + b.x);
  }

  /// Whether b, between a and c, is best nowhere: on or above the chord of f + curvature/2 x². Filtered: only
  /// what rounding could decide is computed in pairs.
  bool is_idle(const Sample& a, const Sample& b, const Sample& c) const {
    const double left = b.x - a.x, right = c.x - b.x;
    const double rise = (c.f - b.f) * left, fall = (b.f - a.f) * right;
    const double bend = 0.5 * curvature * left * right * (c.x - a.x);
    const double sum = rise - fall + bend;
    constexpr double filter = 16 * unit_roundoff;
    if (std::abs(sum) > filter * (std::abs(rise) + std::abs(fall) + bend) && std::isfinite(sum))
      return sum < 0;
    const DoubleDouble x_left = two_sum(b.x, -a.x), x_right = two_sum(c.x, -b.x);
    DoubleDouble exact = add(product(two_sum(c.f, -b.f), x_left), product(two_sum(a.f, -b.f), x_right));
    const DoubleDouble area = product(product(x_left, x_right), two_sum(c.x, -a.x));
    exact = add(exact, product({0.5 * curvature, 0}, area));
    return !(exact.hi > 0);
  }
};

/// One line of the grid: the hull of its samples, then a merge of the turns of the hull with the points p.
class LineTransform {
 public:
  explicit LineTransform(Family family) : family_(family) {}

  /// best_i = max over samples at p_i; -inf when every sample is +inf. sign: of the samples' values.
  template <class Value>
  void run(const Vector& x, const Vector& p, Value value, Vector& best) {
    hull_.clear();
    for (Index i = 0; i < x.size(); ++i) {
      const Sample next{x[i], value(i)};
      if (next.f == infinity) continue;
      while (hull_.size() >= 2 && family_.is_idle(hull_[hull_.size() - 2], hull_.back(), next))
        hull_.pop_back();
      hull_.push_back(next);
    }
    if (hull_.empty()) {
      best.setConstant(-infinity);
      return;
    }
    std::size_t k = 0;
    for (Index i = 0; i < p.size(); ++i) {
      while (k + 1 < hull_.size() && family_.turn(hull_[k], hull_[k + 1]) <= p[i]) ++k;
      // A turn is rounded: the neighbours may be better by a rounding.
      double found = family_.at(hull_[k], p[i]);
      if (k > 0) found = std::max(found, family_.at(hull_[k - 1], p[i]));
      if (k + 1 < hull_.size()) found = std::max(found, family_.at(hull_[k + 1], p[i]));
      best[i] = found;
    }
  }

 private:
  Family family_;
  std::vector<Sample> hull_;
};

/// Replaces dimension k of the grid by `points`, maximising along it.
void transform(GridFunction& f, std::size_t k, const Vector& points, Family family) {
  const Vector axis = f.axes[k];
  Index stride = 1, lines = 1;
  for (std::size_t j = 0; j < k; ++j) stride *= f.axes[j].size();
  for (std::size_t j = k + 1; j < f.axes.size(); ++j) lines *= f.axes[j].size();
  Vector result(stride * points.size() * lines), best(points.size());
  LineTransform line(family);
  for (Index outer = 0; outer < lines; ++outer)
    for (Index inner = 0; inner < stride; ++inner) {
      const double* from = f.values.data() + inner + outer * stride * axis.size();
      line.run(
          axis, points, [&](Index i) { return from[i * stride]; }, best);
      double* to = result.data() + inner + outer * stride * points.size();
      // The next dimension minimises again: its samples are the negative of this maximum.
      for (Index i = 0; i < points.size(); ++i) to[i * stride] = 0 - best[i];
    }
  f.axes[k] = points;
  f.values = std::move(result);
}

GridFunction transformed(const GridFunction& f, const std::vector<Vector>& points, Family family,
                         const char* where) {
  validate(f, where);
  validate_axes(points, where);
  if (points.size() != f.axes.size())
    throw InvalidInput(std::string(where) + ": the function has " + std::to_string(f.axes.size()) +
                       " dimensions and the result " + std::to_string(points.size()) + "; give as many axes");
  GridFunction result = f;
  for (std::size_t k = 0; k < points.size(); ++k) transform(result, k, points[k], family);
  return result;
}

}  // namespace

GridFunction conjugate(const GridFunction& f, const std::vector<Vector>& slopes) {
  GridFunction result = transformed(f, slopes, Family{0}, "conjugate");
  for (double& value : result.values) value = 0 - value;
  return result;
}

GridFunction envelope(const GridFunction& f, double gamma, const std::vector<Vector>& points) {
  if (!(gamma > 0 && std::isfinite(gamma) && std::isfinite(1 / gamma)))
    throw InvalidInput("envelope: gamma must be positive and finite; give gamma > 0");
  return transformed(f, points, Family{1 / gamma}, "envelope");
}

}  // namespace convex::inline grids
