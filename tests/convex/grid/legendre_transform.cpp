#include "convex/grid/legendre_transform.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <random>

#include "convex/invalid_input.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/pieces.hpp"

using convex::GridFunction;
using convex::Index;
using convex::Vector;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Point {
  std::vector<double> x;
  Index index;
};

/// Every point of a grid, the first dimension fastest.
std::vector<Point> points_of(const std::vector<Vector>& axes) {
  Index count = 1;
  for (const Vector& axis : axes) count *= axis.size();
  std::vector<Point> points;
  for (Index i = 0; i < count; ++i) {
    Point point{{}, i};
    Index rest = i;
    for (const Vector& axis : axes) {
      point.x.push_back(axis[rest % axis.size()]);
      rest /= axis.size();
    }
    points.push_back(point);
  }
  return points;
}

/// Compares with the largest term(p, x) - f(x) of all grid points x in higher precision.
void check_against_all_points(const GridFunction& f, const GridFunction& result,
                              const std::function<long double(const Point& p, const Point& x)>& term) {
  const std::vector<Point> points = points_of(f.axes);
  for (const Point& p : points_of(result.axes)) {
    long double best = -infinity, size = 0;
    for (const Point& x : points) {
      if (f.values[x.index] == infinity) continue;
      const long double here = term(p, x) - static_cast<long double>(f.values[x.index]);
      if (here > best) {
        best = here;
        size = std::abs(term(p, x)) + std::abs(f.values[x.index]);
      }
    }
    CHECK(std::abs(static_cast<long double>(result.values[p.index]) - best) <=
          1e-15L * (size + std::abs(best)));
  }
}

Vector random_axis(std::mt19937& generator, Index n, double size, double offset = 0) {
  Vector axis(n);
  double x = offset - size / 2;
  for (Index i = 0; i < n; ++i) {
    axis[i] = x;
    x += size / static_cast<double>(n) * std::uniform_real_distribution<double>(0.1, 2)(generator);
  }
  return axis;
}

GridFunction random_function(std::mt19937& generator, std::size_t dimension, Index n, double infinite_part) {
  GridFunction f;
  Index count = 1;
  for (std::size_t k = 0; k < dimension; ++k) {
    f.axes.push_back(random_axis(generator, n + static_cast<Index>(k), 4));
    count *= f.axes.back().size();
  }
  f.values.resize(count);
  for (double& v : f.values) {
    const double number = std::normal_distribution<double>()(generator);
    v = std::uniform_real_distribution<double>()(generator) < infinite_part ? infinity : number;
  }
  f.values[count / 2] = 0.5;
  return f;
}

}  // namespace

TEST_CASE("the transform is the largest s.x - f(x) over all samples, in one to three dimensions") {
  std::mt19937 generator(31);
  for (int seed = 0; seed < 60; ++seed) {
    const std::size_t dimension = 1 + static_cast<std::size_t>(seed % 3);
    const GridFunction f = random_function(generator, dimension,
                                           dimension == 1   ? 60
                                           : dimension == 2 ? 9
                                                            : 4,
                                           seed % 2 ? 0.3 : 0);
    std::vector<Vector> slopes;
    for (std::size_t k = 0; k < dimension; ++k)
      slopes.push_back(random_axis(generator, dimension == 1 ? 80 : 6, 12));
    check_against_all_points(f, convex::conjugate(f, slopes), [](const Point& p, const Point& x) {
      long double sum = 0;
      for (std::size_t k = 0; k < p.x.size(); ++k) sum += static_cast<long double>(p.x[k]) * x.x[k];
      return sum;
    });
  }
}

TEST_CASE("the envelope is the least f(x) + |x - p|^2/(2 gamma) over all samples, far from 0 too") {
  std::mt19937 generator(32);
  for (int seed = 0; seed < 90; ++seed) {
    const std::size_t dimension = 1 + static_cast<std::size_t>(seed % 3);
    GridFunction f = random_function(generator, dimension,
                                     dimension == 1   ? 60
                                     : dimension == 2 ? 9
                                                      : 4,
                                     seed % 2 ? 0.3 : 0);
    const double offset = seed < 45 ? 0 : 1e6;
    for (Vector& axis : f.axes) axis.array() += offset;
    for (double gamma : {0.01, 1.0, 50.0}) {
      std::vector<Vector> points;
      for (std::size_t k = 0; k < dimension; ++k)
        points.push_back(random_axis(generator, dimension == 1 ? 80 : 6, 12, offset));
      GridFunction result = convex::envelope(f, gamma, points);
      result.values *= -1;
      check_against_all_points(f, result, [gamma](const Point& p, const Point& x) {
        long double sum = 0;
        for (std::size_t k = 0; k < p.x.size(); ++k) {
          const long double step = static_cast<long double>(x.x[k]) - p.x[k];
          sum -= step * step / (2 * static_cast<long double>(gamma));
        }
        return sum;
      });
    }
  }
}

TEST_CASE("in one dimension it is the conjugate of the interpolant, as the piecewise algebra has it") {
  // A convex interpolant: slopes -2, -1, 0.5, 3 between the samples.
  const Vector x = (Vector(5) << -2, -1, 0, 2, 3).finished();
  const Vector f = (Vector(5) << 3, 1, 0, 1, 4).finished();
  const Vector breaks = x;
  convex::Matrix rows = convex::Matrix::Zero(6, 3);
  rows(0, 0) = rows(5, 0) = infinity;
  for (Index i = 0; i < 4; ++i) {
    const double slope = (f[i + 1] - f[i]) / (x[i + 1] - x[i]);
    rows.row(i + 1) << 0, slope, f[i] - slope * x[i];
  }
  const auto exact = convex::conjugate(convex::piecewise_quadratic(breaks, rows));
  const Vector slopes = Vector::LinSpaced(65, -4, 4);
  const GridFunction g = convex::conjugate(GridFunction{{x}, f}, {slopes});
  for (Index i = 0; i < slopes.size(); ++i) CHECK(g(i) == exact(slopes[i]));
}

TEST_CASE("samples that bend by less than the rounding of a slope keep their hull") {
  const double steep = 0x1p50;
  Vector x(8), f(8), slopes(8);
  for (Index i = 0; i < 8; ++i) {
    const double j = static_cast<double>(i);
    x[i] = j;
    f[i] = steep * j + j * j;
    slopes[i] = steep + 2 * j;
  }
  const GridFunction g = convex::conjugate(GridFunction{{x}, f}, {slopes});
  for (Index i = 0; i < 8; ++i) CHECK(g(i) == static_cast<double>(i * i));
}

TEST_CASE("known conjugates are met within the stated error, from below") {
  const Vector axis = Vector::LinSpaced(401, -4, 4), slopes = Vector::LinSpaced(21, -1, 1);
  const double step = 0.02;
  struct Known {
    std::function<double(double)> f, g;
    double lipschitz;
  };
  const std::vector<Known> table{
      {[](double x) { return 0.5 * x * x; }, [](double y) { return 0.5 * y * y; }, 1},
      {[](double x) { return std::cosh(x); },
       [](double y) { return y * std::asinh(y) - std::sqrt(1 + y * y); }, std::cosh(1)},
      {[](double x) { return std::sqrt(1 + x * x); },
       [](double y) { return std::abs(y) > 0.96 ? std::nan("") : -std::sqrt(1 - y * y); }, 1}};
  for (const Known& known : table) {
    const GridFunction one = convex::sample([&](const Vector& x) { return known.f(x[0]); }, {axis});
    const GridFunction g = convex::conjugate(one, {slopes});
    for (Index i = 0; i < slopes.size(); ++i) {
      const double exact = known.g(slopes[i]);
      if (std::isnan(exact)) continue;
      CHECK(g(i) <= exact + 1e-15 * 4);
      CHECK(g(i) >= exact - known.lipschitz * step * step / 8 - 1e-15 * 4);
    }
    // Of a sum over the coordinates the conjugate is the sum of conjugates.
    const GridFunction two =
        convex::sample([&](const Vector& x) { return known.f(x[0]) + known.f(x[1]); }, {axis, axis});
    const GridFunction h = convex::conjugate(two, {slopes, slopes});
    for (Index i = 0; i < slopes.size(); ++i)
      for (Index j = 0; j < slopes.size(); ++j) CHECK(std::abs(h(i, j) - g(i) - g(j)) <= 1e-14);
  }
}

TEST_CASE("the biconjugate is the convex hull: at most f, and f where f is convex") {
  const Vector axis = Vector::LinSpaced(201, -2, 2);
  // x^4 - 2x^2: its hull is -1 on [-1, 1].
  const auto well = [](const Vector& x) { return std::pow(x[0], 4) - 2 * x[0] * x[0]; };
  const GridFunction f = convex::sample(well, {axis});
  const Vector slopes = Vector::LinSpaced(4001, -30, 30);
  const GridFunction hull = convex::conjugate(convex::conjugate(f, {slopes}), {axis});
  for (Index i = 0; i < axis.size(); ++i) {
    CHECK(hull(i) <= f(i) + 1e-13);
    CHECK(std::abs(hull(i) - (std::abs(axis[i]) <= 1 ? -1 : f(i))) <= 2e-4);
  }
}

TEST_CASE("what is no grid function is refused") {
  const Vector axis = Vector::LinSpaced(3, 0, 1), values = Vector::Zero(3);
  const Vector falling = -axis;
  const auto refused = [&](const GridFunction& f, const std::vector<Vector>& slopes, const char* part) {
    try {
      convex::conjugate(f, slopes);
      FAIL("accepted");
    } catch (const convex::InvalidInput& error) {
      CHECK_MESSAGE(std::string(error.what()).find(part) != std::string::npos, error.what());
    }
  };
  refused({{}, values}, {axis}, "0 dimensions");
  refused({{axis, axis, axis, axis}, values}, {axis}, "4 dimensions");
  refused({{axis}, Vector::Zero(4)}, {axis}, "4 values on a grid of 3");
  refused({{falling}, values}, {axis}, "does not increase");
  refused({{axis}, values}, {falling}, "does not increase");
  refused({{axis}, values}, {Vector()}, "empty");
  refused({{axis}, values}, {axis, axis}, "as many axes");
  refused({{axis}, Vector::Constant(3, infinity)}, {axis}, "improper");
  refused({{axis}, Vector::Constant(3, -infinity)}, {axis}, "-inf");
  refused({{axis}, Vector::Constant(3, std::nan(""))}, {axis}, "NaN");
  CHECK_THROWS_AS(convex::envelope({{axis}, values}, 0, {axis}), convex::InvalidInput);
  CHECK_THROWS_AS(convex::envelope({{axis}, values}, -1, {axis}), convex::InvalidInput);
}
