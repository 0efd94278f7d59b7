#include "convex/piecewise/pieces.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/piecewise/algebra.hpp"
#include "tests/convex/piecewise/rational_pieces.hpp"
#include "tests/convex/piecewise/same_bytes.hpp"

using convex::infinity;
using convex::Matrix;
using convex::Pieces;
using convex::PiecewiseQuadratic;
using convex::Vector;
using oracles::Ends;

namespace {

bool same(const Pieces& a, const Pieces& b) {
  return a.breaks.size() == b.breaks.size() && a.breaks == b.breaks && a.coefficients == b.coefficients;
}

Vector breaks(std::initializer_list<double> numbers) {
  Vector made(static_cast<convex::Index>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), made.data());
  return made;
}

Matrix rows(std::initializer_list<std::array<double, 3>> given) {
  Matrix made(static_cast<convex::Index>(given.size()), 3);
  convex::Index i = 0;
  for (const auto& row : given) made.row(i++) << row[0], row[1], row[2];
  return made;
}

}  // namespace

TEST_CASE("pieces are read back as the bytes that were given") {
  std::mt19937 generator(1);
  for (int seed = 0; seed < 400; ++seed) {
    const Ends ends = oracles::all_ends[seed % 5];
    const Pieces given = oracles::rounded_pieces(generator, 1 + seed % 9, ends);
    const PiecewiseQuadratic f = convex::piecewise_quadratic(given.breaks, given.coefficients);
    CHECK(same(convex::pieces(f), given));
    CHECK(oracles::same_bytes(convex::piecewise_quadratic(given.breaks, given.coefficients), f));
  }
}

TEST_CASE("on dyadic data what is printed of a result is the result") {
  std::mt19937 generator(2);
  for (int seed = 0; seed < 300; ++seed) {
    const Pieces given = oracles::dyadic_pieces(generator, 1 + seed % 7, oracles::all_ends[seed % 5]);
    const PiecewiseQuadratic f = convex::piecewise_quadratic(given.breaks, given.coefficients);
    const Pieces conjugate = convex::pieces(convex::conjugate(f));
    const Pieces again = convex::pieces(
        convex::conjugate(convex::piecewise_quadratic(conjugate.breaks, conjugate.coefficients)));
    CHECK(same(again, given));
  }
}

TEST_CASE("values are those of the fractions, to the last digit where doubles are exact") {
  std::mt19937 generator(3);
  for (int seed = 0; seed < 300; ++seed) {
    const Pieces given = oracles::dyadic_pieces(generator, 1 + seed % 7, oracles::all_ends[seed % 5]);
    const PiecewiseQuadratic f = convex::piecewise_quadratic(given.breaks, given.coefficients);
    const oracles::RationalPieces exact(given);
    for (double x = -20; x <= 20; x += 0.125) {
      const auto value = exact.value(oracles::Rational(x));
      CHECK(f(x) == (value ? value->get_d() : infinity));
    }
  }
}

TEST_CASE("a break between two equal rows is no break, a kink of one unit in the last place is one") {
  const PiecewiseQuadratic f =
      convex::piecewise_quadratic(breaks({-1, 0, 1}), rows({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}));
  CHECK(f.corners().empty());
  const double next = std::nextafter(1.0, 2.0);
  const PiecewiseQuadratic g = convex::piecewise_quadratic(breaks({0}), rows({{0, 1, 0}, {0, next, 0}}));
  CHECK(g.corners().size() == 2);
  CHECK(convex::subdifferential(g, 0)->low == 1);
  CHECK(convex::subdifferential(g, 0)->high == next);
}

TEST_CASE("a joint that holds to rounding is accepted, and each piece keeps its coefficients") {
  const Matrix given = rows({{0, -1, -0.15}, {1 / 0.3, 0, 0}, {0, 1, -0.15}});
  const PiecewiseQuadratic f = convex::piecewise_quadratic(breaks({-0.3, 0.3}), given);
  CHECK(convex::pieces(f).coefficients == given);
  const Matrix twelve_digits = rows({{0, 1, 0}, {0, 1.33333333333, -0.111111111110}});
  CHECK_NOTHROW(convex::piecewise_quadratic(breaks({1.0 / 3}), twelve_digits));
}

TEST_CASE("the sign of a zero makes no difference") {
  const PiecewiseQuadratic f =
      convex::piecewise_quadratic(breaks({-0.0}), rows({{-0.0, -0.0, -0.0}, {1, -0.0, -0.0}}));
  CHECK(oracles::same_bytes(f, convex::piecewise_quadratic(breaks({0}), rows({{0, 0, 0}, {1, 0, 0}}))));
  CHECK(oracles::same_bytes(convex::dilate(convex::dilate(f, -2), -0.5), f));
}

TEST_CASE("what is not convex, closed and proper is refused, and the message names the piece") {
  struct Wrong {
    Vector breaks;
    Matrix rows;
    const char* message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Wrong> wrong{
      {breaks({}), rows({{-1, 0, 0}}), "piece 0 has c2 = -1"},
      {breaks({0}), rows({{0, 0, 0}, {0, 0, 1}}), "pieces 0 and 1 differ by 1"},
      {breaks({0}), rows({{0, 0, 0}, {0, 0, 1e-6}}), "differ by"},
      {breaks({1}), rows({{0, 1, 0}, {0, 1, 1e-6}}), "differ by"},
      {breaks({0}), rows({{0, 1, 0}, {0, -1, 0}}), "the slope falls by 2 from piece 0 to 1"},
      {breaks({1}), rows({{0, 1, 0}, {0, 1 - 1e-6, 1e-6}}), "the slope falls by"},
      {breaks({0, 1}), rows({{0, 0, 0}, {infinity, 0, 0}, {0, 0, 0}}), "piece 1 is +inf between"},
      {breaks({0}), rows({{infinity, 0, 0}, {infinity, 0, 0}}), "improper"},
      {breaks({0}), rows({{infinity, 1, 0}, {0, 0, 0}}), "piece 0 is +inf; write it"},
      {breaks({0}), rows({{0, 0, 0}, {0, 0, infinity}}), "piece 1 is not finite"},
      {breaks({0}), rows({{0, nan, 0}, {0, 0, 0}}), "piece 0 is not finite"},
      {breaks({0}), rows({{nan, 0, 0}, {0, 0, 0}}), "piece 0 is not finite"},
      {breaks({0}), rows({{-infinity, 0, 0}, {0, 0, 0}}), "piece 0 is not finite"},
      {breaks({0, 0}), rows({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}), "breaks must increase"},
      {breaks({1, 0}), rows({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}), "breaks must increase"},
      {breaks({nan}), rows({{0, 0, 0}, {0, 0, 0}}), "break 0 is not finite"},
      {breaks({infinity}), rows({{0, 0, 0}, {0, 0, 0}}), "break 0 is not finite"},
      {breaks({0}), rows({{0, 0, 0}}), "give a row"},
      {breaks({1e200}), rows({{1, 0, 0}, {1, 0, 0}}), "overflow"},
      {breaks({}), Matrix::Zero(1, 2), "1x2"}};
  for (const Wrong& input : wrong) {
    CAPTURE(input.message);
    try {
      convex::piecewise_quadratic(input.breaks, input.rows);
      FAIL("accepted");
    } catch (const convex::InvalidInput& error) {
      CHECK_MESSAGE(std::string(error.what()).find(input.message) != std::string::npos, error.what());
    }
  }
}
