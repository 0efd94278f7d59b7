#include "convex/laws/map_laws.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "convex/counted.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/invalid_input.hpp"
#include "convex/laws/map_cycles.hpp"

namespace convex::inline law_checks {
namespace {

/// Points with their images, and both in doubles.
struct Sample {
  std::vector<ExactVector> points;
  std::vector<MapImage> images;
  std::vector<Vector> x, Tx;
};

class MapSearch {
 public:
  MapSearch(const Map& T, const ExactMetric& W, const MapSamples& samples)
      : T_(T), W_(W), gram_(rounded_gram(W)), samples_(samples), random_(samples.seed) {}

  MapVerdict run() {
    const auto broken_in = [&](const Sample& some) {
      verdict_.counterexample = worst_pair(some);
      if (!verdict_.counterexample) verdict_.counterexample = shortest_cycle(some);
      return verdict_.counterexample.has_value();
    };
    if (!samples_.given.empty()) {
      broken_in(sampled(samples_.given));
      return std::move(verdict_);
    }
    if (broken_in(sampled(scattered()))) return std::move(verdict_);
    if (broken_in(sampled(close_pairs()))) return std::move(verdict_);
    for (Index k = 0; k < polygon_centres && T_.n > 1; ++k)
      if (polygons_around(random_point())) break;
    return std::move(verdict_);
  }

 private:
  static constexpr Index polygon_centres = 8;
  static constexpr int point_unit = 8;  ///< points are multiples of 1/8

  Vector random_point() {
    std::uniform_real_distribution<double> within(samples_.low, samples_.high);
    Vector x(T_.n);
    for (double& entry : x) entry = std::round(within(random_) * point_unit) / point_unit;
    return x;
  }

  std::vector<ExactVector> scattered() {
    std::vector<ExactVector> points;
    if (T_.n == 1)
      for (Index k = 0; k < samples_.points; ++k) {
        const double part = static_cast<double>(k) / static_cast<double>(samples_.points - 1);
        const double x = samples_.low + part * (samples_.high - samples_.low);
        points.push_back(exact_vector(Vector::Constant(1, std::round(x * point_unit) / point_unit)));
      }
    else
      for (Index k = 0; k < samples_.points; ++k) points.push_back(exact_vector(random_point()));
    points.push_back(exact_vector(Vector::Zero(T_.n)));
    if (T_.n == 1 && T_.kinks) add_around(T_.kinks(samples_.low, samples_.high), points);
    return points;
  }

  /// Each kink, both sides of it at several distances, and the middle between two.
  static void add_around(const std::vector<Fraction>& kinks, std::vector<ExactVector>& points) {
    for (std::size_t k = 0; k < kinks.size(); ++k) {
      points.push_back(exact_vector(std::vector<Fraction>{kinks[k]}));
      for (const double away : {1.0, 0x1p-10, 0x1p-20, 0x1p-40})
        for (const double side : {-away, away})
          points.push_back(exact_vector(std::vector<Fraction>{kinks[k] + fraction(side)}));
      if (k > 0)
        points.push_back(exact_vector(std::vector<Fraction>{(kinks[k - 1] + kinks[k]) * Fraction{1, 2}}));
    }
  }

  bool is_within(const Vector& z) const {
    return z.minCoeff() >= samples_.low && z.maxCoeff() <= samples_.high;
  }

  /// Where the map stretches a little, or turns: steps of several lengths from some points.
  std::vector<ExactVector> close_pairs() {
    std::vector<ExactVector> points;
    std::uniform_int_distribution<int> entry(-2, 2);
    for (int k = 0; k < 20; ++k) {
      const Vector from = random_point();
      points.push_back(exact_vector(from));
      for (const double length : {0x1p-3, 0x1p-7, 0x1p-12}) {
        Vector step(T_.n);
        do
          for (double& part : step) part = entry(random_);
        while (step.isZero(0));
        if (is_within(from + length * step)) points.push_back(exact_vector(Vector(from + length * step)));
      }
    }
    return points;
  }

  Sample sampled(const std::vector<ExactVector>& points) {
    Sample some;
    for (const ExactVector& point : points) {
      const auto image = T_.at(point);
      if (!image) {
        ++verdict_.undefined;
        continue;
      }
      ++verdict_.points;
      some.points.push_back(point);
      some.images.push_back(*image);
      some.x.push_back(nearest(point));
      some.Tx.push_back(nearest(image->value));
    }
    return some;
  }

  /// The pairs that doubles find stretched the most, judged in fractions.
  std::optional<MapCounterexample> worst_pair(const Sample& some) const {
    std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> stretched;
    for (std::size_t i = 0; i < some.x.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vector here = some.x[i] - some.x[j], there = some.Tx[i] - some.Tx[j];
        const double length = here.dot(gram_ * here);
        if (length == 0) continue;
        const double stretch = there.dot(gram_ * there) / length;
        if (stretch > 1 - 0x1p-30) stretched.push_back({-stretch, {i, j}});
      }
    std::sort(stretched.begin(), stretched.end());
    constexpr std::size_t judged = 50;
    for (std::size_t k = 0; k < std::min(judged, stretched.size()); ++k) {
      const auto [i, j] = stretched[k].second;
      if (auto found = pair_broken(W_, {some.points[j], some.points[i]}, {some.images[j], some.images[i]}))
        return found;
    }
    return std::nullopt;
  }

  /// The shortest cycle of negative sum: walks of k steps from each point by Bellman's recursion (1958), the
  /// most negative one of each length judged in fractions.
  std::optional<MapCounterexample> shortest_cycle(const Sample& some) const {
    const std::size_t count = some.x.size();
    Matrix weight(static_cast<Index>(count), static_cast<Index>(count));
    double size = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vector covector = gram_ * some.Tx[i];
      for (std::size_t j = 0; j < count; ++j)
        weight(static_cast<Index>(i), static_cast<Index>(j)) = covector.dot(some.x[i] - some.x[j]);
      size = std::max(size, covector.norm() * some.x[i].norm());
    }
    const Index m = weight.rows();
    const auto longest = static_cast<std::size_t>(samples_.longest_cycle);
    std::vector<double> least(longest + 1, -size * 0x1p-40);
    std::vector<std::vector<Index>> best(longest + 1);
    for (Index start = 0; start < m; ++start) {
      std::vector<Vector> walk{weight.row(start)};
      std::vector<std::vector<Index>> from{std::vector<Index>(count, start)};
      for (std::size_t k = 2; k <= longest; ++k) {
        // Closing here makes a cycle of k points.
        Index last = -1;
        for (Index j = 0; j < m; ++j)
          if (j != start && walk.back()[j] + weight(j, start) < least[k]) {
            least[k] = walk.back()[j] + weight(j, start);
            last = j;
          }
        if (last >= 0) {
          best[k].assign(1, last);
          for (std::size_t s = from.size(); s-- > 1;)
            best[k].push_back(from[s][static_cast<std::size_t>(best[k].back())]);
          best[k].push_back(start);
          std::reverse(best[k].begin(), best[k].end());
        }
        Vector next = Vector::Constant(m, HUGE_VAL);
        std::vector<Index> origin(count, start);
        for (Index j = 0; j < m; ++j)
          for (Index i = 0; i < m; ++i)
            if (i != j && walk.back()[i] + weight(i, j) < next[j]) {
              next[j] = walk.back()[i] + weight(i, j);
              origin[static_cast<std::size_t>(j)] = i;
            }
        walk.push_back(std::move(next));
        from.push_back(std::move(origin));
      }
    }
    for (const std::vector<Index>& cycle : best) {
      if (cycle.empty()) continue;
      std::vector<ExactVector> points;
      std::vector<MapImage> images;
      for (const Index k : cycle) {
        points.push_back(some.points[static_cast<std::size_t>(k)]);
        images.push_back(some.images[static_cast<std::size_t>(k)]);
      }
      if (auto found = cycle_broken(W_, std::move(points), std::move(images))) return found;
    }
    return std::nullopt;
  }

  /// A map that turns goes down along a polygon of enough corners: the sum is minus the circulation, area
  /// times S_ij - S_ji, plus what falls with their number. How many, the derivative tells; a few regular
  /// polygons are for maps that have none.
  bool polygons_around(const Vector& centre) {
    if (turning_around(centre)) return true;
    for (const int corners : {3, 4, 6, 8, 12, 16, 24, 32})
      for (Index i = 0; i < T_.n; ++i)
        for (Index j = 0; j < T_.n; ++j)
          for (const double radius : {1.0, 1.0 / 64})
            if (i != j && refuted_on(regular_polygon(centre, i, j, radius, corners))) return true;
    return false;
  }

  bool turning_around(const Vector& centre) {
    const auto slope = slope_at(T_, W_, centre);
    if (!slope) return false;
    verdict_.asymmetry = std::max(verdict_.asymmetry, slope->asymmetry());
    if (slope->is_derivative && slope->is_symmetric()) ++verdict_.symmetric_at;
    const auto [i, j] = slope->most_turning_plane();
    if (i == j) return false;
    if (const auto parts = slope->parts_of_side(i, j))
      for (const double side : {1.0, 1.0 / 8, 1.0 / 64, 1.0 / 512})
        if (refuted_on(square(centre, i, j, side, *parts))) return true;
    verdict_.counterexample = asymmetric(T_, *slope, centre);
    return verdict_.counterexample.has_value();
  }

  /// Doubles look first: fractions and balls are for what may go down.
  bool refuted_on(const std::vector<Vector>& corners) {
    for (const Vector& corner : corners)
      if (!is_within(corner)) return false;
    ++verdict_.polygons;
    if (!may_go_down(T_, gram_, corners)) return false;
    std::vector<ExactVector> points;
    for (const Vector& corner : corners) points.push_back(exact_vector(corner));
    verdict_.counterexample = broken(T_, W_, MapLaw::cyclically_monotone, points);
    return verdict_.counterexample.has_value();
  }

  const Map& T_;
  const ExactMetric& W_;
  Matrix gram_;
  const MapSamples& samples_;
  std::mt19937 random_;
  MapVerdict verdict_;
};

}  // namespace

Map map_of(std::function<Vector(const Vector&)> T, Index n, double relative_error) {
  return {n,
          [T, relative_error](const ExactVector& z) -> std::optional<MapImage> {
            const Vector image = T(nearest(z));
            if (!image.allFinite()) return std::nullopt;
            return MapImage{exact_vector(image), relative_error * image.cwiseAbs().maxCoeff()};
          },
          T};
}

MapVerdict laws(const Map& T, const ExactMetric& W, const MapSamples& samples) {
  if (W.dimension() != T.n)
    throw InvalidInput("metric: " + counted(W.dimension(), "row", "rows") + "; give " + std::to_string(T.n) +
                       ", one per component of the map");
  if (!(samples.low < samples.high)) throw InvalidInput("box: its lower end is not below its upper one");
  return MapSearch(T, W, samples).run();
}

}  // namespace convex::inline law_checks
