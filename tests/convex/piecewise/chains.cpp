#include <doctest/doctest.h>

#include <limits>

#include "convex/invalid_input.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/pieces.hpp"
#include "convex/piecewise/scalar_prox.hpp"
#include "tests/convex/piecewise/rational_pieces.hpp"

using convex::PiecewiseQuadratic;

namespace {

double number(std::mt19937& generator, double size) {
  return std::uniform_real_distribution<double>(-size, size)(generator);
}

/// Positive; when wild, over twelve orders of magnitude.
double factor(std::mt19937& generator, bool wild) { return std::exp(number(generator, wild ? 14 : 1)); }

PiecewiseQuadratic fresh(std::mt19937& generator) {
  const auto given = oracles::rounded_pieces(generator, 1 + static_cast<int>(generator() % 6),
                                             oracles::all_ends[generator() % 5]);
  return convex::piecewise_quadratic(given.breaks, given.coefficients);
}

PiecewiseQuadratic changed(const PiecewiseQuadratic& f, std::mt19937& generator, bool wild) {
  switch (generator() % 11) {
    case 0:
      return convex::conjugate(f);
    case 1:
      return convex::envelope(f, factor(generator, wild));
    case 2:
      return convex::scale(f, factor(generator, wild));
    case 3:
      return convex::dilate(f, generator() % 2 ? factor(generator, wild) : -factor(generator, wild));
    case 4:
      return convex::translate(f, number(generator, 3) * factor(generator, wild));
    case 5:
      return convex::tilt(f, number(generator, 3) * factor(generator, wild));
    case 6:
      return convex::sum(f, fresh(generator));
    case 7:
      return convex::pointwise_max(f, fresh(generator));
    case 8:
      return convex::inf_convolution(f, fresh(generator));
    case 9:
      return convex::proximal_average(f, fresh(generator), 0.3, factor(generator, wild));
    default:
      return convex::add_square(f, factor(generator, wild));
  }
}

}  // namespace

TEST_CASE("no chain of operations leaves the class: f and its conjugate stay conjugate") {
  std::mt19937 generator(41);
  int steps = 0, refused = 0;
  for (int chain = 0; chain < 1500; ++chain) {
    PiecewiseQuadratic f = fresh(generator);
    double scale = 0;  // the largest terms met on the way
    for (int step = 0; step < 12; ++step) {
      try {
        f = changed(f, generator, false);
        ++steps;
      } catch (const convex::InvalidInput&) {
        ++refused;  // domains or slopes apart
        continue;
      }
      const PiecewiseQuadratic g = convex::conjugate(f);
      for (const convex::Segment& line : f.segments())
        scale = std::max({scale, std::abs(line.f), std::abs(line.g), std::abs(line.x * line.y)});
      for (const convex::Corner& corner : f.corners()) scale = std::max(scale, std::abs(corner.x * corner.y));
      for (int i = 0; i < 4; ++i) {
        const double z = number(generator, std::exp(number(generator, 5))), d = factor(generator, false);
        const convex::ProxPoint point = convex::prox_point(f, z, d);
        const double value = f(point.x), dual = g(point.y), product = point.x * point.y;
        CAPTURE(chain);
        CAPTURE(step);
        const double terms = std::abs(value) + std::abs(dual) + std::abs(product) + d * z * z;
        CHECK(std::abs(value + dual - product) <= 1e-13 * std::max(scale, terms));
      }
    }
  }
  CHECK(steps > 5 * refused);
}

TEST_CASE("a chain over many orders of magnitude stays a monotone curve or is refused") {
  std::mt19937 generator(42);
  for (int chain = 0; chain < 1500; ++chain) {
    PiecewiseQuadratic f = fresh(generator);
    for (int step = 0; step < 30; ++step) {
      try {
        f = changed(f, generator, true);
      } catch (const convex::InvalidInput&) {
        continue;
      }
      const double z = number(generator, factor(generator, true)), d = factor(generator, true);
      const double x = convex::prox(f, z, d);
      CHECK(std::isfinite(x));
      CHECK(f(x) < std::numeric_limits<double>::infinity());
    }
  }
}
