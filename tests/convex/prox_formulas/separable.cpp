#include "convex/prox_formulas/separable.hpp"

#include <doctest/doctest.h>

#include <array>
#include <functional>
#include <string>

#include "convex/invalid_input.hpp"

using convex::Index;
using convex::Vector;
namespace k = convex::prox_formulas;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Long = long double;

/// Of each function: the pieces of its subdifferential (left and right derivative at u), and its prox with
/// one step and with one a coordinate.
struct Case {
  std::string name;
  std::function<std::array<Long, 2>(Long u)> subdifferential;
  std::function<Vector(const Vector&, double)> prox;
  std::function<Vector(const Vector&, const Vector&)> prox_in_metric;
  std::function<Vector(const Vector&, const Vector&)> slope;
};

std::array<Long, 2> step_at(Long u, Long place, Long before, Long after) {
  return {u > place ? after : before, u < place ? before : after};
}

std::vector<Case> cases() {
  const auto huber = [](double mu) {
    return [mu](Long u) {
      const Long g = std::abs(u) <= static_cast<Long>(mu) ? u / mu : std::copysign(1.0L, u);
      return std::array{g, g};
    };
  };
  return {
      {"norm1", [](Long u) { return step_at(u, 0, -1, 1); },
       [](const Vector& z, double t) { return k::prox_norm1(z, t); },
       [](const Vector& z, const Vector& t) { return k::prox_norm1(z, t); }, k::prox_norm1_slope},
      {"huber", huber(0.5), [](const Vector& z, double t) { return k::prox_huber(z, 0.5, t); },
       [](const Vector& z, const Vector& t) { return k::prox_huber(z, 0.5, t); },
       [](const Vector& z, const Vector& t) { return k::prox_huber_slope(z, 0.5, t); }},
      {"huber, nearly the absolute value", huber(0x1p-40),
       [](const Vector& z, double t) { return k::prox_huber(z, 0x1p-40, t); },
       [](const Vector& z, const Vector& t) { return k::prox_huber(z, 0x1p-40, t); },
       [](const Vector& z, const Vector& t) { return k::prox_huber_slope(z, 0x1p-40, t); }},
      {"hinge", [](Long u) { return step_at(u, 1, -1, 0); },
       [](const Vector& z, double t) { return k::prox_hinge(z, t); },
       [](const Vector& z, const Vector& t) { return k::prox_hinge(z, t); }, k::prox_hinge_slope},
      {"squared hinge",
       [](Long u) {
         const Long g = std::min(0.0L, u - 1);
         return std::array{g, g};
       },
       [](const Vector& z, double t) { return k::prox_squared_hinge(z, t); },
       [](const Vector& z, const Vector& t) { return k::prox_squared_hinge(z, t); },
       k::prox_squared_hinge_slope},
      {"elastic net",
       [](Long u) {
         const auto [left, right] = step_at(u, 0, -1, 1);
         return std::array{left + 2 * u, right + 2 * u};
       },
       [](const Vector& z, double t) { return k::prox_elastic_net(z, t, 2 * t); },
       [](const Vector& z, const Vector& t) { return k::prox_elastic_net(z, t, 2 * t); },
       [](const Vector& z, const Vector& t) { return k::prox_elastic_net_slope(z, t, 2 * t); }},
  };
}

Vector points() {
  std::vector<double> found{0.0, -0.0};
  for (double size : {1e-150, 1e-9, 0.25, 0.5, 0.75, 1.0, 1.25, 2.0, 3.0, 1e6, 1e150})
    for (double sign : {1.0, -1.0}) {
      found.push_back(sign * size);
      found.push_back(std::nextafter(sign * size, 0));
      found.push_back(std::nextafter(sign * size, sign * infinity));
    }
  return Eigen::Map<Vector>(found.data(), static_cast<Index>(found.size()));
}

}  // namespace

TEST_CASE("each entry satisfies 0 = x - z + t f'(x), ties and bends and both zeros included") {
  const Vector z = points();
  for (const Case& f : cases())
    for (double t : {0.0, 1e-9, 0.25, 0.5, 1.0, 2.0, 1e9}) {
      const Vector x = f.prox(z, t);
      CHECK(x == f.prox_in_metric(z, Vector::Constant(z.size(), t)));
      for (Index i = 0; i < z.size(); ++i) {
        CAPTURE(f.name);
        CAPTURE(t);
        CAPTURE(z[i]);
        CAPTURE(x[i]);
        const auto [left, right] = f.subdifferential(x[i]);
        const Long pull = static_cast<Long>(z[i]) - static_cast<Long>(x[i]), step = t;
        // A rounding of x moves the derivative as far as the second derivative goes.
        const Long slack =
            4 * convex::unit_roundoff *
            (std::abs(static_cast<Long>(z[i])) + step * std::max(std::abs(left), std::abs(right)) +
             step * std::abs(static_cast<Long>(x[i])));
        CHECK(pull >= step * left - slack);
        CHECK(pull <= step * right + slack);
      }
    }
}

TEST_CASE("the slope is the difference quotient away from bends") {
  const Vector z = Vector::LinSpaced(41, -4.03, 4.11), t = Vector::LinSpaced(41, 0.1, 1.3);
  const double h = 0x1p-20;
  for (const Case& f : cases()) {
    const Vector up = f.prox_in_metric(z.array() + h, t), down = f.prox_in_metric(z.array() - h, t);
    CHECK(((up - down) / (2 * h) - f.slope(z, t)).cwiseAbs().maxCoeff() <= 1e-9);
  }
}

TEST_CASE("small numbers that a huber function near the absolute value leaves keep their digits") {
  const Vector z = Vector::Constant(1, 0.5);
  CHECK(k::prox_huber(z, 0x1p-60, 1)[0] == 0x1p-61);
  CHECK(k::prox_huber(z, 0, 1)[0] == 0);
  CHECK(k::prox_huber(z, 0, 0)[0] == 0.5);
}

TEST_CASE("the box keeps what is inside and takes the nearest bound outside, infinite bounds included") {
  const Vector z = points();
  const Vector x = k::proj_box(z, -0.5, 1);
  for (Index i = 0; i < z.size(); ++i) CHECK(x[i] == std::min(1.0, std::max(-0.5, z[i])));
  CHECK(k::proj_box(z, -infinity, infinity) == z);
  CHECK(k::proj_box(z, Vector::Constant(z.size(), -0.5), Vector::Ones(z.size())) == x);
  CHECK_THROWS_AS(k::proj_box(z, 1, 0), convex::InvalidInput);
  CHECK_THROWS_AS(k::prox_norm1(z, Vector::Ones(2)), convex::InvalidInput);
}

TEST_CASE("an entry's prox is the same, bit by bit, wherever it stands in the vector") {
  const double values[] = {0.0, -0.0, 0.7, -0.7, 0.35, -1.2, 1e-300, -5e-324, 1e300, -3, 1.1999999999999999,
                           1.2};
  for (Index n = 1; n <= 40; ++n) {
    Vector z(n);
    for (Index i = 0; i < n; ++i) z[i] = values[(i * 7 + n) % 12];
    const Vector shrunk = k::prox_norm1(z, 0.7), smooth = k::prox_huber(z, 0.5, 0.7);
    for (Index i = 0; i < n; ++i) {
      CAPTURE(z[i]);
      const Vector alone = Vector::Constant(1, z[i]);
      CHECK(shrunk[i] == k::prox_norm1(alone, 0.7)[0]);
      CHECK(smooth[i] == k::prox_huber(alone, 0.5, 0.7)[0]);
    }
  }
}
