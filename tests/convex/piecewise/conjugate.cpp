#include <doctest/doctest.h>

#include "convex/infinity.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/pieces.hpp"
#include "tests/convex/piecewise/rational_pieces.hpp"
#include "tests/convex/piecewise/same_bytes.hpp"

using convex::infinity;
using convex::PiecewiseQuadratic;
using oracles::Rational;
namespace piecewise = convex::piecewise;

namespace {

PiecewiseQuadratic made(const convex::Pieces& given) {
  return convex::piecewise_quadratic(given.breaks, given.coefficients);
}

}  // namespace

TEST_CASE("the conjugate has the supremum over all candidates, exactly on dyadic data") {
  std::mt19937 generator(4);
  for (int seed = 0; seed < 200; ++seed) {
    const convex::Pieces given = oracles::dyadic_pieces(generator, 1 + seed % 7, oracles::all_ends[seed % 5]);
    const oracles::RationalPieces exact(given);
    const PiecewiseQuadratic g = convex::conjugate(made(given));
    for (double y = -20; y <= 20; y += 0.25) {
      const auto value = oracles::conjugate_value(exact, Rational(y));
      CHECK(g(y) == (value ? value->get_d() : infinity));
    }
  }
}

TEST_CASE("the conjugate of rounded data has the supremum to a few roundings") {
  std::mt19937 generator(5);
  for (int seed = 0; seed < 200; ++seed) {
    const convex::Pieces given =
        oracles::rounded_pieces(generator, 1 + seed % 7, oracles::all_ends[seed % 4]);
    const oracles::RationalPieces exact(given);
    const PiecewiseQuadratic f = made(given), g = convex::conjugate(f);
    const convex::Interval slopes = convex::slopes(f);
    for (int i = 0; i < 40; ++i) {
      const double y = std::uniform_real_distribution<double>(-9, 9)(generator);
      const auto value = oracles::conjugate_value(exact, Rational(y));
      if (slopes.low < y && y < slopes.high) {
        REQUIRE(value);
        CHECK(std::abs(g(y) - value->get_d()) <= 1e-14 * (1 + std::abs(value->get_d())) * 20);
      } else {
        CHECK(g(y) == infinity);
      }
    }
  }
}

TEST_CASE("the biconjugate is the function, byte for byte") {
  std::mt19937 generator(6);
  for (int seed = 0; seed < 200; ++seed) {
    const PiecewiseQuadratic f =
        made(oracles::rounded_pieces(generator, 1 + seed % 9, oracles::all_ends[seed % 5]));
    CHECK(oracles::same_bytes(convex::conjugate(convex::conjugate(f)), f));
  }
}

TEST_CASE("f(x) + f*(y) = xy exactly when y is in the subdifferential") {
  std::mt19937 generator(7);
  for (int seed = 0; seed < 200; ++seed) {
    const PiecewiseQuadratic f =
        made(oracles::dyadic_pieces(generator, 1 + seed % 7, oracles::all_ends[seed % 5]));
    const PiecewiseQuadratic g = convex::conjugate(f);
    for (double x = -8; x <= 8; x += 0.5)
      for (double y = -8; y <= 8; y += 0.5) {
        const auto range = convex::subdifferential(f, x), inverse = convex::subdifferential(g, y);
        const bool is_subgradient = range && range->low <= y && y <= range->high;
        CHECK(is_subgradient == (inverse && inverse->low <= x && x <= inverse->high));
        CHECK((f(x) + g(y) == x * y) == is_subgradient);
        CHECK(f(x) + g(y) >= x * y);
      }
  }
}

TEST_CASE("a point and a linear function are conjugates, an interval and its support") {
  const PiecewiseQuadratic line = convex::conjugate(piecewise::point(3, 2));
  CHECK(line(5) == 13);
  CHECK(convex::pieces(line).coefficients.row(0) == Eigen::RowVector3d(0, 3, -2));
  CHECK(convex::conjugate(piecewise::linear(3))(3) == 0);
  CHECK(convex::conjugate(piecewise::linear(3))(std::nextafter(3.0, 4.0)) == infinity);
  const PiecewiseQuadratic half = convex::conjugate(piecewise::indicator(-1, infinity));
  CHECK(half(-2) == 2);
  CHECK(half(0) == 0);
  CHECK(half(1e-300) == infinity);
  CHECK(oracles::same_bytes(convex::conjugate(piecewise::absolute(0)), piecewise::point(0)));
  CHECK(oracles::same_bytes(piecewise::point(-0.0, -0.0), piecewise::point(0)));
}

TEST_CASE("conjugates in print come out as printed") {
  // ylucet/CCA, tests/plq_lft_test.m, in rows [c2, c1, c0].
  struct Known {
    convex::Pieces f, g;
  };
  const auto pieces = [](std::vector<double> breaks, std::vector<double> entries) {
    convex::Pieces result{
        Eigen::Map<convex::Vector>(breaks.data(), static_cast<convex::Index>(breaks.size())),
        convex::Matrix(static_cast<convex::Index>(breaks.size()) + 1, 3)};
    for (convex::Index i = 0; i < result.coefficients.rows(); ++i)
      for (convex::Index j = 0; j < 3; ++j)
        result.coefficients(i, j) = entries[static_cast<std::size_t>(3 * i + j)];
    return result;
  };
  const std::vector<Known> table{
      {pieces({-2}, {2, 1, 1, 2, 1, 1}), pieces({}, {0.5, -0.5, -0.75})},
      {pieces({}, {0, 1, 1}), pieces({1, 1}, {infinity, 0, 0, 0, 0, -1, infinity, 0, 0})},
      {pieces({}, {1, 0, 0}), pieces({}, {1, 0, 0})},
      {pieces({1, 3}, {2, 0, 0, 0, 2, -1, 6, -16, 26}),
       pieces({2}, {0.5, 0, 0, 1.0 / 6, 8.0 / 3, -14.0 / 3})},
      {pieces({-5}, {infinity, 0, 0, 2, 0, 5}), pieces({-10}, {0, -5, -30, 0.5, 0, -5})}};
  for (const Known& known : table) {
    const convex::Pieces found = convex::pieces(convex::conjugate(made(known.f)));
    CHECK(found.breaks == known.g.breaks);
    REQUIRE(found.coefficients.rows() == known.g.coefficients.rows());
    for (convex::Index i = 0; i < found.coefficients.size(); ++i) {
      const double a = found.coefficients(i), b = known.g.coefficients(i);
      CHECK((a == b || std::abs(a - b) <= 1e-15 * std::abs(b)));
    }
  }
}
