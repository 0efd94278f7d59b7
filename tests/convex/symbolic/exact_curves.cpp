#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "convex/invalid_input.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/pieces.hpp"
#include "convex/piecewise/scalar_prox.hpp"
#include "convex/symbolic/exact_curve.hpp"
#include "convex/symbolic/term.hpp"

using namespace convex;
using namespace convex::symbolic;

namespace {

Fraction q(std::int64_t p, std::int64_t r = 1) { return {p, r}; }

/// A kink, flat and curved pieces, an end of the domain, a point.
std::vector<ExactCurve> curves() {
  return {
      exact_curve({{std::nullopt, q(0), q(0), q(-1), q(0)}, {q(0), std::nullopt, q(0), q(1), q(0)}}),
      exact_curve({{q(-1, 3), q(1), q(2), q(0), q(0)}, {q(1), std::nullopt, q(0), q(5, 2), q(-3, 2)}}),
      exact_curve({{std::nullopt, q(-1), q(0), q(-1), q(-1, 2)},
                   {q(-1), q(1), q(1), q(0), q(0)},
                   {q(1), std::nullopt, q(0), q(1), q(-1, 2)}}),
      exact_curve({{q(2, 7), q(2, 7), q(0), q(0), q(3)}}),
      exact_curve({{q(-1), q(2), q(0), q(0), q(0)}}),
      exact_curve({{std::nullopt, std::nullopt, q(3), q(-1), q(1, 5)}}),
      exact_curve({{std::nullopt, std::nullopt, q(0), q(1, 2), q(1)}}),
  };
}

/// The same in doubles, by the other room.
PiecewiseQuadratic rounded(const ExactCurve& f) {
  const std::vector<ExactPiece> all = pieces(f);
  std::vector<double> breaks;
  std::vector<Eigen::RowVector3d> rows;
  const Eigen::RowVector3d beyond(std::numeric_limits<double>::infinity(), 0, 0);
  if (all.front().low) {
    rows.push_back(beyond);
    breaks.push_back(nearest_double(*all.front().low));
  }
  for (const ExactPiece& piece : all) {
    rows.emplace_back(nearest_double(piece.c2), nearest_double(piece.c1), nearest_double(piece.c0));
    if (piece.high) breaks.push_back(nearest_double(*piece.high));
  }
  if (all.back().high) rows.push_back(beyond);
  Matrix coefficients(static_cast<Index>(rows.size()), 3);
  for (std::size_t k = 0; k < rows.size(); ++k) coefficients.row(static_cast<Index>(k)) = rows[k];
  return piecewise_quadratic(Vector::Map(breaks.data(), static_cast<Index>(breaks.size())), coefficients);
}

void check_equal(const ExactCurve& exact, const PiecewiseQuadratic& number) {
  for (int k = -60; k <= 60; ++k) {
    const Fraction x = q(k, 12) + q(1, 97);
    const auto there = value(exact, x);
    const double expected = number(nearest_double(x));
    CHECK(there.has_value() == std::isfinite(expected));
    if (there) CHECK(nearest_double(*there) == doctest::Approx(expected).epsilon(1e-11));
  }
}

}  // namespace

TEST_CASE("in fractions a function is its own biconjugate, piece by piece") {
  for (const ExactCurve& f : curves()) {
    const auto once = pieces(f), twice = pieces(conjugate(conjugate(f)));
    REQUIRE(once.size() == twice.size());
    for (std::size_t k = 0; k < once.size(); ++k) {
      CHECK(once[k].c2 == twice[k].c2);
      CHECK(once[k].c1 == twice[k].c1);
      CHECK(once[k].c0 == twice[k].c0);
    }
  }
}

TEST_CASE("conjugates, envelopes, sums and inf-convolutions in fractions have the values that doubles give") {
  for (const ExactCurve& f : curves()) {
    check_equal(conjugate(f), conjugate(rounded(f)));
    check_equal(envelope(f, q(3, 4)), envelope(rounded(f), 0.75));
    check_equal(dilate(f, q(-2, 3)), dilate(rounded(f), -2.0 / 3));
    check_equal(tilt(scale(translate(f, q(1, 3)), q(5)), q(-1, 2)),
                tilt(scale(translate(rounded(f), 1.0 / 3), 5), -0.5));
    for (const ExactCurve& g : curves()) {
      std::optional<ExactCurve> total, least;
      std::optional<PiecewiseQuadratic> total_number, least_number;
      try {
        total = sum(f, g);
      } catch (const InvalidInput&) {
      }
      try {
        total_number = sum(rounded(f), rounded(g));
      } catch (const InvalidInput&) {
      }
      REQUIRE(total.has_value() == total_number.has_value());
      if (total) check_equal(*total, *total_number);
      try {
        least = inf_convolution(f, g);
      } catch (const InvalidInput&) {
      }
      try {
        least_number = inf_convolution(rounded(f), rounded(g));
      } catch (const InvalidInput&) {
      }
      REQUIRE(least.has_value() == least_number.has_value());
      if (least) check_equal(*least, *least_number);
    }
  }
}

TEST_CASE(
    "the pieces of a prox are its values, and the function can be had back from them up to a constant") {
  for (const ExactCurve& f : curves()) {
    const std::vector<AffinePiece> map = prox_pieces(f, q(2, 3));
    const PiecewiseQuadratic number = rounded(f);
    for (int k = -40; k <= 40; ++k) {
      const Fraction z = q(k, 7);
      for (const AffinePiece& piece : map)
        if ((!piece.low || !(z < *piece.low)) && (!piece.high || !(*piece.high < z)))
          CHECK(nearest_double(piece.slope * z + piece.offset) ==
                doctest::Approx(prox(number, nearest_double(z), 1.5)).epsilon(1e-12));
    }
    const std::optional<ExactCurve> back = function_of_prox(prox_pieces(f, q(1)));
    REQUIRE(back);
    const auto once = pieces(f), again = pieces(*back);
    REQUIRE(once.size() == again.size());
    for (std::size_t k = 0; k < once.size(); ++k) {
      CHECK(once[k].c2 == again[k].c2);
      CHECK(once[k].c1 == again[k].c1);
      CHECK(once[k].c0 - again[k].c0 == once[0].c0 - again[0].c0);
    }
  }
}

TEST_CASE(
    "the larger of two curves is that at every point, also where domains differ and pieces cross twice") {
  for (const ExactCurve& f : curves())
    for (const ExactCurve& g : curves()) {
      std::optional<ExactCurve> highest;
      try {
        highest = pointwise_max(f, g);
      } catch (const InvalidInput&) {  // apart, or a root that is none
        continue;
      }
      for (int k = -84; k <= 84; ++k) {
        const Fraction x = q(k, 21);
        const auto at_f = value(f, x), at_g = value(g, x), there = value(*highest, x);
        REQUIRE(there.has_value() == (at_f && at_g));
        if (there) CHECK(*there == (*at_f < *at_g ? *at_g : *at_f));
      }
    }
  const ExactCurve square = exact_curve({{std::nullopt, std::nullopt, q(2), q(0), q(0)}});
  const auto line = [](const Fraction& slope, const Fraction& at_zero) {
    return exact_curve({{std::nullopt, std::nullopt, q(0), slope, at_zero}});
  };
  CHECK(pieces(pointwise_max(square, line(q(1), q(6)))).size() == 3);  // x² = x + 6 at -2 and 3
  CHECK(pieces(pointwise_max(square, line(q(0), q(2)))).size() == 3);  // x² = 2
  const ExactCurve beyond = exact_curve({{q(3, 2), std::nullopt, q(2), q(0), q(0)}});
  CHECK(pieces(pointwise_max(beyond, line(q(0), q(2)))).size() == 1);  // both roots are outside
}

TEST_CASE("pieces that jump, bend down or leave a gap are refused") {
  CHECK_THROWS_AS(
      exact_curve({{std::nullopt, q(0), q(0), q(1), q(0)}, {q(0), std::nullopt, q(0), q(-1), q(0)}}),
      InvalidInput);
  CHECK_THROWS_AS(
      exact_curve({{std::nullopt, q(0), q(0), q(1), q(0)}, {q(0), std::nullopt, q(0), q(1), q(1)}}),
      InvalidInput);
  CHECK_THROWS_AS(
      exact_curve({{std::nullopt, q(0), q(0), q(1), q(0)}, {q(1), std::nullopt, q(0), q(1), q(0)}}),
      InvalidInput);
  CHECK_THROWS_AS(exact_curve({{std::nullopt, std::nullopt, q(-1), q(1), q(0)}}), InvalidInput);
}

TEST_CASE("a double counts as the fraction of least denominator that rounds to it") {
  CHECK(text(simplest_fraction(0.1)) == "1/10");
  CHECK(text(simplest_fraction(1.0 / 3)) == "1/3");
  CHECK(text(simplest_fraction(-2.0 / 7)) == "-2/7");
  CHECK(text(simplest_fraction(0)) == "0");
  CHECK(text(simplest_fraction(12345.678)) == "6172839/500");
  for (const double x : {std::sqrt(2.0), 1e-300, 3e17, -0.30000000000000004})
    CHECK(nearest_double(simplest_fraction(x)) == x);
}

TEST_CASE("of parabolas that touch the higher one is the maximum, on both sides") {
  for (const Fraction& at : {q(0), q(2), q(-1, 3)}) {
    const auto touching = [&](const Fraction& c) {
      return translate(exact_curve({{std::nullopt, std::nullopt, c, q(0), q(0)}}), at);
    };
    for (const ExactCurve& highest : {pointwise_max(touching(q(1, 3)), touching(q(3))),
                                      pointwise_max(touching(q(3)), touching(q(1, 3)))}) {
      const auto all = pieces(highest);
      REQUIRE(all.size() == 1);
      CHECK(all.front().c2 == q(3));
    }
  }
}

TEST_CASE("a number of the field of a root is ordered and written as its digits are") {
  const Surd golden = (Surd{q(1)} + Surd::root_of(q(5))) / Surd{q(2)};
  CHECK(golden * golden == golden + Surd{q(1)});
  CHECK(text(golden) == "(1 + sqrt(5))/2");
  CHECK(text(number(golden)) == "(1 + sqrt(5))/2");
  CHECK(latex(golden) == "\\frac{1 + \\sqrt{5}}{2}");
  CHECK(text(Surd::root_of(q(8, 9))) == "2*sqrt(2)/3");
  CHECK(Surd::root_of(q(49, 4)).is_rational());
  CHECK(Surd::root_of(q(2)) * Surd::root_of(q(8)) == Surd{q(4)});
  CHECK_THROWS_AS(Surd::root_of(q(2)) + Surd::root_of(q(3)), InvalidInput);
  // Neighbours of sqrt(2) among the fractions p/q, p² - 2 q² = ±1.
  std::int64_t p = 1, d = 1;
  for (int k = 0; k < 40; ++k) {
    CHECK((q(p, d) < Surd::root_of(q(2))) == (k % 2 == 0));
    const std::int64_t next = p + 2 * d;
    d = p + d;
    p = next;
  }
  CHECK(nearest_double(Surd::root_of(q(2))) == std::sqrt(2.0));
}

TEST_CASE("pieces that cross at a root are exact there: the maximum, its conjugate and its prox") {
  // x² above 2 beyond ±sqrt(2); x²/2 above 1 + x beyond 1 ± sqrt(3); x² and 1 + x cross at the golden ratio.
  const ExactCurve square = exact_curve({{std::nullopt, std::nullopt, q(2), q(0), q(0)}});
  const ExactCurve two = exact_curve({{std::nullopt, std::nullopt, q(0), q(0), q(2)}});
  const ExactCurve line = exact_curve({{std::nullopt, std::nullopt, q(0), q(1), q(1)}});
  const auto at_two = pieces(pointwise_max(square, two));
  REQUIRE(at_two.size() == 3);
  CHECK(*at_two[0].high == -Surd::root_of(q(2)));
  CHECK(*at_two[2].low == Surd::root_of(q(2)));
  for (const auto& [f, g] : {std::pair{square, two}, std::pair{square, line}}) {
    const ExactCurve highest = pointwise_max(f, g), back = conjugate(conjugate(highest));
    const auto once = pieces(highest), twice = pieces(back);
    REQUIRE(once.size() == twice.size());
    for (std::size_t k = 0; k < once.size(); ++k) {
      CHECK(once[k].c2 == twice[k].c2);
      CHECK(once[k].c1 == twice[k].c1);
      CHECK(once[k].c0 == twice[k].c0);
    }
    check_equal(conjugate(highest), conjugate(rounded(highest)));
    check_equal(highest, rounded(highest));
    // The prox by its definition: u + gamma s = z for a slope s of f at u, tried through the envelope.
    for (const AffinePiece& piece : prox_pieces(highest, q(1, 3))) {
      const Surd z = piece.low ? *piece.low : piece.high ? *piece.high : Surd{q(0)};
      const Surd u = piece.slope * z + piece.offset;
      const double at = nearest_double(u), target = nearest_double(z);
      const auto cost = [&](double x) {
        return nearest_double(*value(highest, Surd{fraction(x)})) + 1.5 * (x - target) * (x - target);
      };
      for (const double step : {-1e-3, 1e-3}) CHECK(cost(at) <= cost(at + step));
    }
  }
}
