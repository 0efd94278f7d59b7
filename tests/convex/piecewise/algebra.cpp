#include "convex/piecewise/algebra.hpp"

#include <doctest/doctest.h>

#include <functional>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/pieces.hpp"
#include "tests/convex/piecewise/rational_pieces.hpp"
#include "tests/convex/piecewise/same_bytes.hpp"

using convex::infinity;
using convex::Pieces;
using convex::PiecewiseQuadratic;
using oracles::Rational;
using oracles::RationalPieces;
namespace piecewise = convex::piecewise;

namespace {

struct Sample {
  RationalPieces exact;
  PiecewiseQuadratic f;
};

Sample dyadic(std::mt19937& generator, int seed) {
  const Pieces given =
      oracles::dyadic_pieces(generator, 1 + static_cast<int>(generator() % 7), oracles::all_ends[seed % 5]);
  return {RationalPieces(given), convex::piecewise_quadratic(given.breaks, given.coefficients)};
}

Sample rounded(std::mt19937& generator, int seed) {
  const Pieces given =
      oracles::rounded_pieces(generator, 1 + static_cast<int>(generator() % 7), oracles::all_ends[seed % 5]);
  return {RationalPieces(given), convex::piecewise_quadratic(given.breaks, given.coefficients)};
}

bool meet(const convex::Interval& a, const convex::Interval& b) { return a.low <= b.high && b.low <= a.high; }

double rounded_value(const std::optional<Rational>& value) { return value ? value->get_d() : infinity; }

/// Whether a result that took roundings is the fraction: equal when infinite, else close.
bool close(double found, double expected, double scale = 1) {
  return found == expected || std::abs(found - expected) <= 2e-14 * (scale + std::abs(expected));
}

const std::vector<double>& grid() {
  static const std::vector<double> points = [] {
    std::vector<double> made;
    for (double x = -12; x <= 12; x += 0.375) made.push_back(x);
    return made;
  }();
  return points;
}

}  // namespace

TEST_CASE("the sum and the maximum are taken point by point") {
  std::mt19937 generator(11);
  int sums = 0;
  for (int seed = 0; seed < 400; ++seed) {
    const Sample a = dyadic(generator, seed), b = dyadic(generator, seed / 5);
    if (!meet(convex::domain(a.f), convex::domain(b.f))) {
      CHECK_THROWS_AS(convex::sum(a.f, b.f), convex::InvalidInput);
      CHECK_THROWS_AS(convex::pointwise_max(a.f, b.f), convex::InvalidInput);
      continue;
    }
    ++sums;
    const PiecewiseQuadratic sum = convex::sum(a.f, b.f), most = convex::pointwise_max(a.f, b.f);
    for (double x : grid()) {
      const auto v = a.exact.value(Rational(x)), w = b.exact.value(Rational(x));
      const bool finite = v && w;
      CHECK(sum(x) == (finite ? Rational(*v + *w).get_d() : infinity));
      CHECK(most(x) == (finite ? std::max(*v, *w).get_d() : infinity));
    }
  }
  CHECK(sums > 100);
}

TEST_CASE("the maximum has its breaks at the crossings and the right slopes between") {
  const auto max = convex::pointwise_max(piecewise::quadratic(2), piecewise::constant(1));
  const Pieces found = convex::pieces(max);
  CHECK(found.breaks == Eigen::Vector2d(-1, 1));
  CHECK(found.coefficients == (convex::Matrix(3, 3) << 2, 0, 0, 0, 0, 1, 2, 0, 0).finished());
  // Touching is no crossing.
  CHECK(oracles::same_bytes(convex::pointwise_max(piecewise::quadratic(1), piecewise::constant(0)),
                            piecewise::quadratic(1)));
  CHECK(oracles::same_bytes(convex::pointwise_max(piecewise::constant(0), piecewise::quadratic(1)),
                            piecewise::quadratic(1)));
  CHECK(oracles::same_bytes(convex::pointwise_max(piecewise::linear(1), piecewise::linear(-1)),
                            piecewise::absolute()));
  // Crossing in a corner of both (ylucet/CCA, testQLQ2Max): max(2|x|, |x| + 1).
  const auto kinks =
      convex::pointwise_max(piecewise::absolute(2), convex::add_constant(piecewise::absolute(1), 1));
  CHECK(convex::pieces(kinks).breaks == Eigen::Vector3d(-1, 0, 1));
}

TEST_CASE("the maximum of rounded functions is the larger value, its slopes a subgradient inequality") {
  std::mt19937 generator(12);
  for (int seed = 0; seed < 200; ++seed) {
    const Sample a = rounded(generator, seed), b = rounded(generator, seed / 5);
    if (!meet(convex::domain(a.f), convex::domain(b.f))) continue;
    const PiecewiseQuadratic most = convex::pointwise_max(a.f, b.f);
    for (double x : grid()) {
      const auto v = a.exact.value(Rational(x)), w = b.exact.value(Rational(x));
      if (!v || !w) {
        CHECK(most(x) == infinity);
        continue;
      }
      CHECK(close(most(x), std::max(*v, *w).get_d(), 10));
      const auto range = convex::subdifferential(most, x);
      REQUIRE(range);
      const double y = std::isfinite(range->low) ? range->low : std::isfinite(range->high) ? range->high : 0;
      for (double u : grid()) CHECK(most(u) >= most(x) + y * (u - x) - 1e-12 * (1 + std::abs(y * (u - x))));
    }
  }
}

TEST_CASE("the inf-convolution is the least over all splits of x") {
  std::mt19937 generator(13);
  int found = 0;
  for (int seed = 0; seed < 120; ++seed) {
    const Sample a = dyadic(generator, seed), b = dyadic(generator, seed / 5);
    if (!meet(convex::slopes(a.f), convex::slopes(b.f))) {
      CHECK_THROWS_AS(convex::inf_convolution(a.f, b.f), convex::InvalidInput);
      continue;
    }
    ++found;
    const PiecewiseQuadratic f = convex::inf_convolution(a.f, b.f);
    for (double x : grid())
      CHECK(close(f(x), rounded_value(oracles::inf_convolution_value(a.exact, b.exact, Rational(x))), 10));
  }
  CHECK(found > 50);
}

TEST_CASE("the envelope is the least of f(u) + (x - u)^2/(2 gamma)") {
  std::mt19937 generator(14);
  for (int seed = 0; seed < 100; ++seed) {
    const Sample a = dyadic(generator, seed);
    for (double gamma : {0.25, 1.0, 8.0}) {
      const PiecewiseQuadratic envelope = convex::envelope(a.f, gamma);
      const Pieces square{convex::Vector(), (convex::Matrix(1, 3) << 1 / gamma, 0, 0).finished()};
      const RationalPieces exact_square(square);
      for (double x : grid()) {
        CHECK(close(envelope(x),
                    rounded_value(oracles::inf_convolution_value(a.exact, exact_square, Rational(x))), 10));
        CHECK(close(envelope(x), convex::inf_convolution(a.f, piecewise::quadratic(1 / gamma))(x), 10));
      }
    }
  }
}

TEST_CASE("conjugation turns inf-convolution into sum, envelope into square, scaling into dilation") {
  std::mt19937 generator(15);
  for (int seed = 0; seed < 100; ++seed) {
    const Sample a = rounded(generator, seed), b = rounded(generator, seed / 5);
    const PiecewiseQuadratic g = convex::conjugate(a.f);
    const auto check = [&](const PiecewiseQuadratic& conjugate, const std::function<double(double)>& value) {
      for (double y : grid()) CHECK(close(conjugate(y), value(y), 200));
    };
    const double gamma = 0.7, rho = seed % 2 ? 1.3 : -0.6, c = 0.9;
    if (meet(convex::slopes(a.f), convex::slopes(b.f)))
      check(convex::conjugate(convex::inf_convolution(a.f, b.f)),
            [&](double y) { return g(y) + convex::conjugate(b.f)(y); });
    check(convex::conjugate(convex::envelope(a.f, gamma)),
          [&](double y) { return g(y) + 0.5 * gamma * y * y; });
    if (seed % 5 == 4) continue;  // the rounded products below miss the one point of the domain
    check(convex::conjugate(convex::translate(a.f, c)), [&](double y) { return g(y) + c * y; });
    check(convex::conjugate(convex::dilate(a.f, 2 * (seed % 2 ? 1 : -1))),
          [&](double y) { return g(2 * (seed % 2 ? 1 : -1) * y); });
    check(convex::conjugate(convex::scale(a.f, 4)), [&](double y) { return 4 * g(y / 4); });
    const PiecewiseQuadratic dilated = convex::dilate(a.f, rho);
    for (double x : grid()) {
      CHECK(close(convex::scale(a.f, 3)(x), 3 * a.f(x), 10));
      CHECK(close(convex::tilt(a.f, c)(x), a.f(x) + c * x, 10));
      CHECK(close(convex::add_square(a.f, c)(x), a.f(x) + c / 2 * x * x, 10));
      CHECK(close(convex::add_constant(a.f, c)(x), a.f(x) + c, 10));
      CHECK(close(convex::conjugate(convex::add_constant(a.f, c))(x), g(x) - c, 10));
      if (std::isfinite(a.f(x)) && std::isfinite(dilated(rho * x)))
        CHECK(close(dilated(rho * x), a.f(x), 10));
    }
  }
}

TEST_CASE("the envelope of the proximal average is the average of the envelopes") {
  std::mt19937 generator(16);
  for (int seed = 0; seed < 150; ++seed) {
    const Sample a = seed % 2 ? rounded(generator, seed) : dyadic(generator, seed);
    const Sample b = rounded(generator, seed / 5);
    for (double weight : {0.0, 0.25, 0.3, 1.0})
      for (double gamma : {0.5, 1.7}) {
        const PiecewiseQuadratic average = convex::proximal_average(a.f, b.f, weight, gamma);
        const PiecewiseQuadratic envelope = convex::envelope(average, gamma);
        const PiecewiseQuadratic of_f = convex::envelope(a.f, gamma), of_g = convex::envelope(b.f, gamma);
        for (double x : grid()) CHECK(close(envelope(x), weight * of_f(x) + (1 - weight) * of_g(x), 100));
        // The dual of the average is the average of the duals with 1/gamma.
        const PiecewiseQuadratic dual =
            convex::proximal_average(convex::conjugate(a.f), convex::conjugate(b.f), weight, 1 / gamma);
        const auto range = convex::slopes(average);
        for (double y : grid())
          if (range.low + 1e-9 < y && y < range.high - 1e-9)
            CHECK(close(convex::conjugate(average)(y), dual(y), 100));
      }
  }
  // ylucet/CCA, plq_pa_test.m, testI2Ipa.
  const PiecewiseQuadratic points =
      convex::proximal_average(piecewise::point(6, 4), piecewise::point(5, 1), 0.5, 1);
  CHECK(convex::domain(points).low == 5.5);
  CHECK(convex::domain(points).high == 5.5);
  CHECK(points(5.5) == 2.625);
}

TEST_CASE("known results: x^2/4 with x^2, the square distance, the huber function") {
  const auto box = convex::inf_convolution(piecewise::quadratic(0.5), piecewise::quadratic(2));
  CHECK(convex::pieces(box).coefficients.row(0) == Eigen::RowVector3d(0.4, 0, 0));
  const Pieces huber = convex::pieces(convex::envelope(piecewise::absolute(), 0.3));
  CHECK(huber.breaks == convex::pieces(piecewise::huber(0.3)).breaks);
  CHECK(huber.coefficients == convex::pieces(piecewise::huber(0.3)).coefficients);
  CHECK(huber.coefficients == (convex::Matrix(3, 3) << 0, -1, -0.15, 1 / 0.3, 0, 0, 0, 1, -0.15).finished());
  const PiecewiseQuadratic distance = convex::envelope(piecewise::indicator(-1, 2), 1);
  CHECK(distance(5) == 4.5);
  CHECK(distance(-3) == 2);
  CHECK(distance(1.5) == 0);
  CHECK(piecewise::hinge()(-2) == 3);
  CHECK(piecewise::hinge()(1.5) == 0);
  CHECK(piecewise::squared_hinge(2)(-2) == 9);
  CHECK(piecewise::squared_hinge(2)(2) == 0);
  CHECK(piecewise::elastic_net(2, 3)(-2) == 10);
}

TEST_CASE("a translation by 1e8 and the way back cost no digits of the function") {
  const PiecewiseQuadratic f = convex::add_constant(piecewise::huber(0.25), 1);
  const PiecewiseQuadratic far = convex::translate(f, 1e8);
  CHECK(far(1e8 + 0.125) == f(0.125));
  CHECK(far(1e8 + 2) == f(2));
  CHECK(oracles::same_bytes(convex::translate(far, -1e8), f));
  const PiecewiseQuadratic sum = convex::sum(far, piecewise::linear(1));
  CHECK(sum(1e8 + 2) == f(2) + 1e8 + 2);
  // Nor does a partner whose coefficients are those at 0.
  const PiecewiseQuadratic near = convex::translate(piecewise::quadratic(2), 1e8 - 1);
  const Pieces left_of_all{Eigen::Matrix<double, 1, 1>(1),
                           (convex::Matrix(2, 3) << 1, -1, 0, 0, 0, -0.5).finished()};
  const PiecewiseQuadratic flat = convex::piecewise_quadratic(left_of_all.breaks, left_of_all.coefficients);
  CHECK(convex::sum(near, flat)(1e8 + 0.5) == 1.75);
  CHECK(convex::sum(flat, near)(1e8 + 0.5) == 1.75);
}

TEST_CASE("the minimum and its points") {
  CHECK(convex::minimizers(piecewise::indicator(-1, 2))->low == -1);
  CHECK(convex::minimizers(piecewise::indicator(-1, 2))->high == 2);
  CHECK(convex::minimizers(convex::translate(piecewise::absolute(), 3))->low == 3);
  CHECK_FALSE(convex::minimizers(piecewise::linear(1)).has_value());
  CHECK(convex::infimum(piecewise::linear(1)) == -infinity);
  CHECK(convex::infimum(piecewise::quadratic(1, -2, 5)) == 3);
  CHECK(convex::minimizers(piecewise::constant(4))->low == -infinity);
}

TEST_CASE("what is no function of the class is refused and says why") {
  const auto refused = [](const std::function<void()>& call, const char* part) {
    try {
      call();
      FAIL("accepted");
    } catch (const convex::InvalidInput& error) {
      CHECK_MESSAGE(std::string(error.what()).find(part) != std::string::npos, error.what());
    }
  };
  const PiecewiseQuadratic f = piecewise::absolute();
  refused([&] { convex::sum(piecewise::point(1), piecewise::point(2)); }, "no point in common");
  refused([&] { convex::inf_convolution(piecewise::linear(1), piecewise::linear(2)); }, "-inf everywhere");
  refused([&] { convex::inf_convolution(f, piecewise::linear(2)); }, "[-1, 1]");
  refused([&] { convex::scale(f, 0); }, "alpha");
  refused([&] { convex::scale(f, -1); }, "alpha");
  refused([&] { convex::dilate(f, 0); }, "rho");
  refused([&] { convex::envelope(f, 0); }, "gamma");
  refused([&] { convex::envelope(f, infinity); }, "gamma");
  refused([&] { convex::proximal_average(f, f, 1.5, 1); }, "weight");
  refused([&] { convex::proximal_average(f, f, 0.5, 0); }, "gamma");
  refused([&] { piecewise::indicator(1, 0); }, "empty");
  refused([&] { piecewise::indicator(infinity, infinity); }, "infinite");
  refused([&] { piecewise::quadratic(-1); }, "convex");
  refused([&] { piecewise::huber(0); }, "mu");
  refused([&] { piecewise::absolute(-1); }, "weight");
  refused([&] { convex::scale(piecewise::quadratic(1e200), 1e200); }, "range of doubles");
}
