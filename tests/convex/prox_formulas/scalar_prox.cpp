#include <doctest/doctest.h>

#include <functional>
#include <numbers>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/log_barrier.hpp"
#include "convex/prox_formulas/logistic.hpp"
#include "convex/prox_formulas/power.hpp"
#include "convex/prox_formulas/relative_entropy.hpp"

using convex::unit_roundoff;
using convex::prox_formulas::ScalarProx;

namespace {

/// Numbers with 64 binary digits and an exponent range in which nothing here overflows.
using Long = long double;
static_assert(std::numeric_limits<Long>::digits >= 64 && std::numeric_limits<Long>::max_exponent > 16000);

enum class Domain { line, positive, negative, unit_interval };

/// A function by its derivative (never by its prox). curvature: f''.
struct Case {
  std::string name;
  ScalarProx (*prox)(double z, double d);
  std::function<Long(Long)> derivative, curvature;
  Domain domain = Domain::line;
  /// The derivative tends to a constant, so that the oracle knows small slopes to its own rounding only.
  bool saturates = false;
};

Long sigma(Long x) { return 1 / (1 + std::exp(-x)); }
Long signed_power(Long x, Long q) { return std::copysign(std::pow(std::abs(x), q), x); }

template <int tenths>
Case power() {
  static const double p = tenths / 10.0;
  const Long q = static_cast<Long>(p) - 1;
  return {"power " + std::to_string(p),
          [](double z, double d) { return convex::prox_formulas::prox_power(z, d, p); },
          [q](Long x) { return (q + 1) * signed_power(x, q); },
          [q](Long x) { return (q + 1) * q * std::pow(std::abs(x), q - 1); }};
}

template <int tenths>
Case power_conjugate() {
  static const double p = tenths / 10.0;
  const Long q = static_cast<Long>(p) - 1;
  return {"conjugate of power " + std::to_string(p),
          [](double z, double d) { return convex::prox_formulas::prox_power_conjugate(z, d, p); },
          [q](Long x) { return signed_power(x / (q + 1), 1 / q); },
          [q](Long x) { return std::pow(std::abs(x) / (q + 1), 1 / q - 1) / (q * (q + 1)); }};
}

template <int tenths>
Case inverse_power() {
  static const double p = tenths / 10.0;
  const Long q = p;
  return {"inverse power " + std::to_string(p),
          [](double z, double d) { return convex::prox_formulas::prox_inverse_power(z, d, p); },
          [q](Long x) { return -q * std::pow(x, -q - 1); },
          [q](Long x) { return q * (q + 1) * std::pow(x, -q - 2); }, Domain::positive};
}

template <int tenths>
Case inverse_power_conjugate() {
  static const double p = tenths / 10.0;
  const Long q = p;
  return {"conjugate of inverse power " + std::to_string(p),
          [](double z, double d) { return convex::prox_formulas::prox_inverse_power_conjugate(z, d, p); },
          [q](Long x) { return std::pow(-x / q, -1 / (q + 1)); },
          [q](Long x) { return std::pow(-x / q, -1 / (q + 1)) / (-x * (q + 1)); }, Domain::negative};
}

std::vector<Case> cases() {
  namespace k = convex::prox_formulas;
  return {
      {"entropy", k::prox_entropy, [](Long x) { return std::log(x) + 1; }, [](Long x) { return 1 / x; },
       Domain::positive},
      {"conjugate of entropy", k::prox_entropy_conjugate, [](Long x) { return std::exp(x - 1); },
       [](Long x) { return std::exp(x - 1); }},
      {"Kullback-Leibler", [](double z, double d) { return k::prox_kullback_leibler(z, d, 3); },
       [](Long x) { return std::log(x / 3); }, [](Long x) { return 1 / x; }, Domain::positive},
      {"Kullback-Leibler from a tiny reference",
       [](double z, double d) { return k::prox_kullback_leibler(z, d, 0x1p-500); },
       [](Long x) { return std::log(x * 0x1p500L); }, [](Long x) { return 1 / x; }, Domain::positive},
      {"conjugate of Kullback-Leibler",
       [](double z, double d) { return k::prox_kullback_leibler_conjugate(z, d, 3); },
       [](Long x) { return 3 * std::exp(x); }, [](Long x) { return 3 * std::exp(x); }},
      {"exponential", [](double z, double d) { return k::prox_exponential(z, d); },
       [](Long x) { return std::exp(x); }, [](Long x) { return std::exp(x); }},
      {"conjugate of exponential", k::prox_exponential_conjugate, [](Long x) { return std::log(x); },
       [](Long x) { return 1 / x; }, Domain::positive},
      {"log barrier", k::prox_log_barrier, [](Long x) { return -1 / x; }, [](Long x) { return 1 / (x * x); },
       Domain::positive},
      {"conjugate of log barrier", k::prox_log_barrier_conjugate, [](Long x) { return -1 / x; },
       [](Long x) { return 1 / (x * x); }, Domain::negative},
      {"logistic", k::prox_logistic, sigma, [](Long x) { return sigma(x) * sigma(-x); }, Domain::line, true},
      {"binary entropy", k::prox_binary_entropy, [](Long x) { return std::log(x) - std::log1p(-x); },
       [](Long x) { return 1 / (x * (1 - x)); }, Domain::unit_interval, true},
      power<11>(),
      power<15>(),
      power<20>(),
      power<30>(),
      power<37>(),
      power<40>(),
      power<500>(),
      power_conjugate<11>(),
      power_conjugate<15>(),
      power_conjugate<20>(),
      power_conjugate<30>(),
      power_conjugate<37>(),
      power_conjugate<500>(),
      inverse_power<1>(),
      inverse_power<5>(),
      inverse_power<10>(),
      inverse_power<20>(),
      inverse_power<300>(),
      inverse_power_conjugate<1>(),
      inverse_power_conjugate<10>(),
      inverse_power_conjugate<25>(),
      inverse_power_conjugate<300>()};
}

/// The root of increasing g between lo and hi of one sign, by halving the exponent and then the interval.
Long bisect(const std::function<Long(Long)>& g, Long lo, Long hi) {
  for (int step = 0; step < 400; ++step) {
    const Long near = std::min(std::abs(lo), std::abs(hi)), far = std::max(std::abs(lo), std::abs(hi));
    const Long middle =
        far > 2 * near ? std::copysign(std::sqrt(near) * std::sqrt(far), lo + hi) : lo + (hi - lo) / 2;
    if (!(middle > lo && middle < hi)) break;
    (g(middle) < 0 ? lo : hi) = middle;
  }
  return lo;
}

Long oracle(const Case& f, double z, double d) {
  const auto g = [&](Long x) { return f.derivative(x) + static_cast<Long>(d) * (x - static_cast<Long>(z)); };
  const Long tiny = 1e-4000L, huge = 1e1000L;
  switch (f.domain) {
    case Domain::positive:
      return bisect(g, tiny, huge);
    case Domain::negative:
      return bisect(g, -huge, -tiny);
    case Domain::unit_interval:
      return bisect(g, tiny, 1 - std::numeric_limits<Long>::epsilon() / 2);
    case Domain::line:
      break;
  }
  const Long at_zero = g(0);
  if (!(at_zero < 0 || at_zero > 0)) return 0;
  return at_zero < 0 ? bisect(g, tiny, huge) : bisect(g, -huge, -tiny);
}

/// Roundings that an answer may be off, relative to itself and, but for functions on x > 0, to what z
/// changes.
constexpr double roundings = 12;

void check_against_bisection(const Case& f, double z, double d) {
  CAPTURE(f.name);
  CAPTURE(z);
  CAPTURE(d);
  const Long x = oracle(f, z, d), slope = 1 / (1 + f.curvature(x) / static_cast<Long>(d));
  const ScalarProx found = f.prox(z, d);
  const double exact = static_cast<double>(x);
  CAPTURE(exact);
  CAPTURE(found.x);
  const bool relative = f.domain == Domain::positive || f.domain == Domain::unit_interval;
  const Long scale = std::abs(x) + (relative ? 0 : slope * std::abs(static_cast<Long>(z)));
  const double smallest = 0x1p-1022;  // below it doubles lose digits
  CHECK(std::abs(static_cast<Long>(found.x) - x) <=
        roundings * unit_roundoff * scale + static_cast<Long>(smallest));
  CHECK(found.slope >= 0);
  CHECK(found.slope <= 1);
  if (std::abs(x) > smallest && std::isfinite(static_cast<double>(slope))) {
    CAPTURE(static_cast<double>(slope));
    CAPTURE(found.slope);
    CHECK(std::abs(static_cast<Long>(found.slope) - slope) <=
          (f.saturates ? 1e-12L : 1e-13L) * slope + (f.saturates ? (1 + d) * 1e-18L : 1e-290L));
  }
}

}  // namespace

TEST_CASE(
    "a scalar prox solves its equation to a few roundings, whatever the scales of z and of the metric") {
  for (const Case& f : cases())
    for (double d : {1e-150, 1e-20, 1e-3, 0.25, 1.0, 7.0, 1e5, 1e20, 1e150}) {
      check_against_bisection(f, 0, d);
      for (double magnitude :
           {1e-150, 1e-30, 1e-8, 0.01, 0.3, 0.5, 0.9, 1.0, 1.7, 3.0, 20.0, 700.0, 1e4, 1e9, 1e30, 1e150})
        for (double sign : {1.0, -1.0}) check_against_bisection(f, sign * magnitude, d);
    }
}

TEST_CASE("where the prox of the logistic function turns from one form to the other nothing is lost") {
  for (const Case& f : cases())
    for (double d : {1e-8, 0.5, 3.0})
      for (double z : {0.5 / d, std::nextafter(0.5 / d, 0), std::nextafter(0.5 / d, 1e300), 1 / d, 1 + 1 / d,
                       std::nextafter(0.5, 0), std::nextafter(0.5, 1), std::numbers::e, 1 / std::numbers::e})
        check_against_bisection(f, z, d);
}

TEST_CASE("the power 1 is soft thresholding, its conjugate the interval, and reference 0 allows 0 only") {
  using namespace convex::prox_formulas;
  for (double z : {-3.0, -0.5, -0.25, 0.0, 0.5, 2.0}) {
    CHECK(prox_power(z, 2, 1).x == (z > 0.5 ? z - 0.5 : z < -0.5 ? z + 0.5 : 0));
    CHECK(prox_power_conjugate(z, 2, 1).x == std::min(1.0, std::max(-1.0, z)));
    CHECK(prox_kullback_leibler(z, 2, 0).x == 0);
    CHECK(prox_kullback_leibler_conjugate(z, 2, 0).x == z);
  }
}

TEST_CASE("an exponent that is not convex is refused") {
  using namespace convex::prox_formulas;
  for (double p : {0.5, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    CHECK_THROWS_AS(prox_power(1, 1, p), convex::InvalidInput);
    CHECK_THROWS_AS(prox_power_conjugate(1, 1, p), convex::InvalidInput);
  }
  for (double q : {0.0, -1.0, std::nan("")}) {
    CHECK_THROWS_AS(prox_inverse_power(1, 1, q), convex::InvalidInput);
    CHECK_THROWS_AS(prox_inverse_power_conjugate(1, 1, q), convex::InvalidInput);
  }
}
