#include "tests/fuzz/call_arguments.hpp"

namespace fuzz {

/// By how much x misses a set of the language, relative to what is compared; none when it is not known here.
std::optional<CallValue> set_value(const Call& set, const Point& x) {
  const std::size_t n = x.size();
  const auto within = [](Real a, Real b, Real size) { return allowed(a - b <= slack_of_sets * size); };
  const Real scale = norm(x);
  if (set.name == "box" || set.name == "orthant" || set.name == "ball_inf") {
    const bool ball = set.name == "ball_inf", orthant = set.name == "orthant";
    const Point low = orthant ? Point(n, 0) : vector(set, 0, n, ball ? 1 : -infinity);
    const Point high = orthant ? Point(n, infinity) : ball ? low : vector(set, 1, n, infinity);
    for (std::size_t i = 0; i < n; ++i) {
      const Real down = ball ? -low[i] : low[i];
      const auto size = [&](Real end) { return scale + (std::isfinite(end) ? std::abs(end) : 0); };
      if (x[i] < down - slack_of_sets * size(down) || x[i] > high[i] + slack_of_sets * size(high[i]))
        return allowed(false);
    }
    return allowed(true);
  }
  if (set.name == "ball2") {
    const Real radius = number(set, 0, 1);
    const Point centre = vector(set, 1, n, 0);
    Point off = x;
    for (std::size_t i = 0; i < n; ++i) off[i] -= centre[i];
    return within(norm(off), radius, scale + radius + norm(centre));
  }
  if (set.name == "ball1") {
    Real sum = 0;
    for (const Real v : x) sum += std::abs(v);
    return within(sum, number(set, 0, 1), sum);
  }
  if (set.name == "simplex") {
    const Real total = number(set, 0, 1);
    Real sum = 0;
    for (const Real v : x) {
      if (v < -slack_of_sets * (scale + total)) return allowed(false);
      sum += v;
    }
    return within(std::abs(sum - total), 0, scale + total);
  }
  if (set.name == "halfspace" || set.name == "hyperplane") {
    const Point a = vector(set, 0, n, 0);
    const Real b = number(set, 1, 0);
    Real product = 0, size = std::abs(b);
    for (std::size_t i = 0; i < n; ++i) {
      product += a[i] * x[i];
      size += std::abs(a[i] * x[i]);
    }
    return within(set.name == "halfspace" ? product : std::abs(product - b), set.name == "halfspace" ? b : 0,
                  size);
  }
  if (set.name == "polyhedron" || set.name == "affine") {
    const convex::Matrix* A = matrix(set, 0);
    if (!A) return std::nullopt;
    Real size = 0;
    const Point b = vector(set, 1, static_cast<std::size_t>(A->rows()), 0), image = affine(*A, x, {}, size);
    for (std::size_t i = 0; i < image.size(); ++i) {
      const Real off = image[i] - b[i];
      if ((set.name == "affine" ? std::abs(off) : off) > slack_of_sets * (size + std::abs(b[i])))
        return allowed(false);
    }
    return allowed(true);
  }
  if (set.name == "second_order_cone") return within(norm(Point(x.begin(), x.end() - 1)), x.back(), scale);
  if (set.name == "point") {
    const Point p = vector(set, 0, n, 0);
    for (std::size_t i = 0; i < n; ++i)
      if (std::abs(x[i] - p[i]) > slack_of_sets * (scale + std::abs(p[i]))) return allowed(false);
    return allowed(true);
  }
  if (set.name == "intersection") {
    for (std::size_t k = 0; k < set.arguments.size(); ++k) {
      const auto part = set_value(nested(set, k), x);
      if (!part || part->value > 0) return part;
    }
    return allowed(true);
  }
  if (set.name == "epigraph") {
    const auto height = value_of_call(nested(set, 0), Point(x.begin(), x.end() - 1));
    if (!height) return std::nullopt;
    if (!std::isfinite(height->value)) return allowed(false);
    CallValue found = within(height->value, x.back(), height->size + std::abs(x.back()));
    found.exact =
        height->exact && std::abs(height->value - x.back()) > 1e-6L * (height->size + std::abs(x.back()));
    return found;
  }
  return std::nullopt;
}

}  // namespace fuzz
