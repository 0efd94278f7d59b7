#include "convex/piecewise/scalar_prox.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "convex/infinity.hpp"
#include "convex/invariant.hpp"

namespace convex::inline piecewise_quadratics {
namespace {

/// Positive to the right of the corner, that is, where the prox of z lies beyond it. Monotone in z and along
/// the curve even as rounded.
double beyond(const Corner& corner, double z, double d) { return d * (z - corner.x) - corner.y; }

/// How many corners z has passed: a binary search without branches to mispredict.
std::size_t passed(const PiecewiseQuadratic& f, double z, double d) {
  const Corner* first = f.corners().data();
  std::size_t count = f.corners().size();
  if (count == 0) return 0;
  while (count > 1) {
    const std::size_t half = count / 2;
    first += half * static_cast<std::size_t>(beyond(first[half - 1], z, d) >= 0);
    count -= half;
  }
  return static_cast<std::size_t>(first - f.corners().data()) +
         static_cast<std::size_t>(beyond(*first, z, d) >= 0);
}

/// x where y = d (z - x) meets the line. Flat lines apart: z - y/d is z itself where y = 0.
double meet(const Segment& line, double z, double d) {
  if (line.rise == 0) return z - line.y / d;
  if (line.run == 0) return line.x;
  return (line.rise * line.x + line.run * (d * z - line.y)) / (line.rise + d * line.run);
}

/// y there, without the difference z - x.
double rising(const Segment& line, double z, double d) {
  if (line.run == 0) return d * (z - line.x);
  if (line.rise == 0) return line.y;
  return d * (line.rise * (z - line.x) + line.run * line.y) / (line.rise + d * line.run);
}

double inside(const PiecewiseQuadratic& f, std::size_t k, double x) {
  if (k > 0) x = std::max(x, f.corners()[k - 1].x);
  if (k < f.corners().size()) x = std::min(x, f.corners()[k].x);
  return x;
}

double derivative(const Segment& line, double d) { return d * line.run / (line.rise + d * line.run); }

/// The piece of the entry before often serves the next one.
std::size_t passed_from(const PiecewiseQuadratic& f, double z, double d, std::size_t hint) {
  const auto& corners = f.corners();
  if ((hint == 0 || beyond(corners[hint - 1], z, d) >= 0) &&
      (hint == corners.size() || beyond(corners[hint], z, d) < 0))
    return hint;
  return passed(f, z, d);
}

/// first where the condition holds, else second, in bits: a loop over it vectorises, while a conditional
/// expression may become a jump.
double select(bool condition, double first, double second) {
  const auto mask = -static_cast<std::uint64_t>(condition);
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(first) & mask) |
                               (std::bit_cast<std::uint64_t>(second) & ~mask));
}

/// Entries go through the pieces in blocks that stay in the first-level cache.
constexpr Index block = 512;
/// Up to this many corners every entry goes through every piece without a branch, which is faster than a
/// search.
constexpr std::size_t few_corners = 24;

template <class Weight>
void through_all_pieces(const PiecewiseQuadratic& f, Index n, const double* __restrict z, Weight d,
                        double* __restrict x) {
  const auto& corners = f.corners();
  for (std::size_t k = 0; k < f.segments().size(); ++k) {
    const Segment line = f.segments()[k];
    if (k > 0 && line.run == 0) continue;  // the piece before it ends there
    const Corner start = k > 0 ? corners[k - 1] : Corner{-infinity, -infinity};
    const double low = start.x, high = k < corners.size() ? corners[k].x : infinity;
    const auto each = [&](auto point) {
      if (k == 0)
        for (Index i = 0; i < n; ++i) x[i] = std::min(point(i), high);
      else
        for (Index i = 0; i < n; ++i) {
          const double here = std::min(std::max(point(i), low), high);
          x[i] = select(beyond(start, z[i], d(i)) >= 0, here, x[i]);
        }
    };
    if (line.rise == 0 && line.y == 0)
      each([&](Index i) { return z[i]; });
    else if (line.rise == 0)
      each([&](Index i) { return z[i] - line.y / d(i); });
    else if (line.run == 0)
      each([&](Index) { return line.x; });
    else
      each([&](Index i) {
        return (line.rise * line.x + line.run * (d(i) * z[i] - line.y)) / (line.rise + d(i) * line.run);
      });
  }
}

template <class WeightFrom>
void separable(const PiecewiseQuadratic& f, const Eigen::Ref<const Vector>& z, WeightFrom weight_from,
               Eigen::Ref<Vector>& x) {
  invariant(z.size() == x.size(), "a separable prox fills one entry for each of z");
  if (f.corners().size() <= few_corners) {
    double copy[block];  // x may be z
    for (Index first = 0; first < z.size(); first += block) {
      const Index n = std::min(block, z.size() - first);
      std::copy_n(z.data() + first, n, copy);
      through_all_pieces(f, n, copy, weight_from(first), x.data() + first);
    }
    return;
  }
  const auto d = weight_from(0);
  std::size_t k = 0;
  for (Index i = 0; i < z.size(); ++i) {
    k = passed_from(f, z[i], d(i), k);
    x[i] = inside(f, k, meet(f.segments()[k], z[i], d(i)));
  }
}

}  // namespace

double prox(const PiecewiseQuadratic& f, double z, double d) {
  const std::size_t k = passed(f, z, d);
  return inside(f, k, meet(f.segments()[k], z, d));
}

ProxPoint prox_point(const PiecewiseQuadratic& f, double z, double d) {
  const std::size_t k = passed(f, z, d);
  const Segment& line = f.segments()[k];
  const double x = inside(f, k, meet(line, z, d));
  double y = rising(line, z, d);
  if (k > 0) y = std::max(y, f.corners()[k - 1].y);
  if (k < f.corners().size()) y = std::min(y, f.corners()[k].y);
  return {x, y};
}

Interval prox_derivative(const PiecewiseQuadratic& f, double z, double d) {
  const std::size_t last = passed(f, z, d);
  std::size_t first = last;
  while (first > 0 && beyond(f.corners()[first - 1], z, d) <= 0) --first;
  Interval found{1, 0};
  for (std::size_t k = first; k <= last; ++k) {
    const double slope = derivative(f.segments()[k], d);
    found = {std::min(found.low, slope), std::max(found.high, slope)};
  }
  return found;
}

void prox(const PiecewiseQuadratic& f, Eigen::Ref<const Vector> z, Eigen::Ref<const Vector> d,
          Eigen::Ref<Vector> x) {
  invariant(z.size() == d.size(), "a separable prox takes one weight for each entry");
  const double* weights = d.data();
  separable(
      f, z, [&](Index first) { return [w = weights + first](Index i) { return w[i]; }; }, x);
}

void prox(const PiecewiseQuadratic& f, Eigen::Ref<const Vector> z, double d, Eigen::Ref<Vector> x) {
  separable(
      f, z, [d](Index) { return [d](Index) { return d; }; }, x);
}

}  // namespace convex::inline piecewise_quadratics
