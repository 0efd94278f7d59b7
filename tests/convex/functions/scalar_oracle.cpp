#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/separable_functions.hpp"

using convex::Function;
using convex::Metric;
using convex::Vector;

namespace {

using Long = long double;

/// A function of one variable and its derivative, in 64 bits of mantissa and in other words than the
/// product's; the derivative is -inf left of the domain, +inf right of it.
struct Oracle {
  std::string name;
  Function f;
  std::function<Long(Long)> value, derivative;
};

constexpr Long infinity = std::numeric_limits<Long>::infinity();

Long left_infinite(Long x, Long inside) { return x > 0 ? inside : -infinity; }

std::vector<Oracle> oracles() {
  const auto xlogx = [](Long x) { return x > 0 ? x * std::log2(x) * std::log(2.0L) : x < 0 ? infinity : 0; };
  std::vector<Oracle> all = {
      {"entropy", convex::entropy(), xlogx, [](Long x) { return left_infinite(x, std::log(x) + 1); }},
      {"kullback_leibler", convex::kullback_leibler(2.5),
       [=](Long x) { return xlogx(x) - x * std::log(2.5L) - x + 2.5L; },
       [](Long x) { return left_infinite(x, std::log(x / 2.5L)); }},
      {"exponential", convex::exponential(), [](Long x) { return std::exp(x); },
       [](Long x) { return std::exp(x); }},
      {"expm1", convex::expm1(0.25), [](Long x) { return (std::exp(x) - 1) / 4; },
       [](Long x) { return std::exp(x) / 4; }},
      {"log_barrier", convex::log_barrier(), [](Long x) { return x > 0 ? -std::log(x) : infinity; },
       [](Long x) { return left_infinite(x, -1 / x); }},
      {"logistic", convex::logistic(), [](Long x) { return x > 100 ? x : std::log1p(std::exp(x)); },
       [](Long x) { return 0.5L + 0.5L * std::tanh(x / 2); }},
      {"binary_entropy", convex::binary_entropy(), [=](Long x) { return xlogx(x) + xlogx(1 - x); },
       [](Long x) { return x >= 1 ? infinity : left_infinite(x, std::log(x / (1 - x))); }},
  };
  for (const Long p : {1.25L, 1.5L, 2.0L, 3.0L, 5.5L})
    all.push_back({"power", convex::power(static_cast<double>(p)),
                   [p](Long x) { return std::pow(std::fabs(x), p); },
                   [p](Long x) { return (x > 0 ? p : -p) * std::pow(std::fabs(x), p - 1); }});
  for (const Long q : {0.5L, 1.0L, 3.0L})
    all.push_back({"inverse_power", convex::inverse_power(static_cast<double>(q)),
                   [q](Long x) { return x > 0 ? std::pow(x, -q) : infinity; },
                   [q](Long x) { return left_infinite(x, -q * std::pow(x, -q - 1)); }});
  for (const Long r : {0.25L, 0.5L, 0.875L})
    all.push_back({"negative_power", convex::negative_power(static_cast<double>(r)),
                   [r](Long x) { return x >= 0 ? -std::pow(x, r) : infinity; },
                   [r](Long x) { return left_infinite(x, -r * std::pow(x, r - 1)); }});
  all.push_back({"huber", convex::huber(0.5),
                 [](Long x) { return std::fabs(x) <= 0.5L ? x * x : std::fabs(x) - 0.25L; },
                 [](Long x) { return std::fabs(x) <= 0.5L ? 2 * x
                                     : x > 0              ? 1.0L
                                                          : -1.0L; }});
  all.push_back({"squared_hinge", convex::squared_hinge(),
                 [](Long x) { return x < 1 ? (1 - x) * (1 - x) : 0; },
                 [](Long x) { return x < 1 ? -2 * (1 - x) : 0; }});
  all.push_back({"hinge", convex::hinge(), [](Long x) { return x < 1 ? 1 - x : 0; },
                 [](Long x) { return x < 1 ? -1.0L : 0; }});
  all.push_back({"elastic_net", convex::elastic_net(2, 3),
                 [](Long x) { return 2 * std::fabs(x) + 1.5L * x * x; },
                 [](Long x) { return (x > 0 ? 2 : -2) + 3 * x; }});
  return all;
}

/// The x where the increasing function df(x) + d (x - z) changes sign.
Long bisected(const std::function<Long(Long)>& df, Long z, Long d) {
  Long low = -1e8L, high = 1e8L;
  for (int step = 0; step < 300; ++step) {
    const Long middle = low + (high - low) / 2;
    (df(middle) + d * (middle - z) < 0 ? low : high) = middle;
  }
  return high;
}

}  // namespace

TEST_CASE("a prox of one variable is where a bisection of the optimality condition ends") {
  for (const Oracle& oracle : oracles())
    for (const double d : {1.0, 0.05, 40.0})
      for (const double z : {-300.0, -7.5, -1.0, -0.01, 0.0, 0.3, 1.0, 2.25, 11.0, 500.0}) {
        CAPTURE(oracle.name);
        CAPTURE(z);
        CAPTURE(d);
        const auto x = oracle.f.prox(Vector::Constant(1, z), Metric::diagonal(Vector::Constant(1, d)));
        const Long expected = bisected(oracle.derivative, z, d);
        const double error = static_cast<double>(std::fabs(x.x[0] - expected));
        CHECK(error <= 1e-15 * (std::abs(z) + std::abs(x.x[0])) + 1e-24);
        CHECK(x.error_bound <= 1e-13 * std::sqrt(d) * (std::abs(z) + std::abs(x.x[0])) + 1e-24);
      }
}

TEST_CASE("a value of one variable is that of the formula in more digits, +inf included") {
  for (const Oracle& oracle : oracles())
    for (const double x : {-400.0, -2.5, -1.0, -1e-3, 0.0, 1e-9, 0.25, 0.5, 1.0, 2.5, 2.500001, 30.0}) {
      CAPTURE(oracle.name);
      CAPTURE(x);
      const double value = oracle.f(Vector::Constant(1, x));
      const Long expected = oracle.value(x);
      if (std::isinf(expected))
        CHECK(std::isinf(value));
      else
        CHECK(std::fabs(value - expected) <= 4e-16L * (std::fabs(expected) + (std::fabs(x) < 5 ? 1 : 0)));
    }
}

TEST_CASE("a conjugate of one variable is the supremum over a fine grid and no less") {
  for (const Oracle& oracle : oracles()) {
    const Function g = oracle.f.conjugate();
    for (const double v : {-3.0, -1.0, -0.4, 0.0, 0.7, 1.0, 2.0}) {
      const double value = g(Vector::Constant(1, v));
      CAPTURE(oracle.name);
      CAPTURE(v);
      Long supremum = -infinity;
      for (int k = -3000; k <= 3000; ++k) {
        const Long x = std::copysign(std::pow(static_cast<Long>(std::abs(k)) / 300, 4), static_cast<Long>(k));
        supremum = std::max(supremum, v * x - oracle.value(x));
      }
      if (std::isinf(value)) {
        CHECK(supremum > 5);
      } else {
        CHECK(supremum <= value + 1e-14L);
        CHECK(supremum >= value - 0.02L * (1 + std::fabs(value)));
      }
    }
  }
}
