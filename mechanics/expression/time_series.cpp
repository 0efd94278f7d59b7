#include "mechanics/expression/time_series.hpp"

#include <cstddef>

namespace mechanics::expression {
namespace {

/// A function without value or derivatives.
TimeSeries undefined_series() {
  TimeSeries f;
  f.c.fill(std::numeric_limits<double>::quiet_NaN());
  return f;
}

/// Taylor arithmetic up to one order.
class Arithmetic {
 public:
  explicit Arithmetic(int order) : last_(static_cast<std::size_t>(order)) {}

  TimeSeries sum(const TimeSeries& a, const TimeSeries& b) const {
    TimeSeries f;
    for (std::size_t k = 0; k <= last_; ++k) f.c[k] = a.c[k] + b.c[k];
    return f;
  }

  TimeSeries negative(const TimeSeries& a) const {
    TimeSeries f;
    for (std::size_t k = 0; k <= last_; ++k) f.c[k] = -a.c[k];
    return f;
  }

  TimeSeries product(const TimeSeries& a, const TimeSeries& b) const {
    TimeSeries f;
    for (std::size_t k = 0; k <= last_; ++k)
      for (std::size_t j = 0; j <= k; ++j) f.c[k] += a.c[j] * b.c[k - j];
    return f;
  }

  /// f b = a.
  TimeSeries quotient(const TimeSeries& a, const TimeSeries& b) const {
    TimeSeries f;
    for (std::size_t k = 0; k <= last_; ++k) {
      Rounded rest = a.c[k];
      for (std::size_t j = 1; j <= k; ++j) rest -= b.c[j] * f.c[k - j];
      f.c[k] = rest / b.c[0];
    }
    return f;
  }

  TimeSeries rate(const TimeSeries& a) const {
    TimeSeries f;
    for (std::size_t k = 0; k < last_; ++k) f.c[k] = number(k + 1) * a.c[k + 1];
    return f;
  }

  /// The function with this rate and this value.
  TimeSeries integral(const TimeSeries& of, Rounded value) const {
    TimeSeries f(value);
    for (std::size_t k = 1; k <= last_; ++k) f.c[k] = of.c[k - 1] / number(k);
    return f;
  }

  /// f² = a.
  TimeSeries root(const TimeSeries& a) const {
    TimeSeries f(sqrt(a.c[0]));
    for (std::size_t k = 1; k <= last_; ++k) {
      Rounded rest = a.c[k];
      for (std::size_t j = 1; j < k; ++j) rest -= f.c[j] * f.c[k - j];
      f.c[k] = rest / (number(2) * f.c[0]);
    }
    return f;
  }

  /// f' = f a'.
  TimeSeries exponential(const TimeSeries& a) const {
    TimeSeries f(exp(a.c[0]));
    for (std::size_t k = 1; k <= last_; ++k) f.c[k] = linked(a, f, k);
    return f;
  }

  TimeSeries logarithm(const TimeSeries& a) const { return integral(quotient(rate(a), a), log(a.c[0])); }

  /// s' = c a', c' = ± s a': sine and cosine, plain (-) or hyperbolic (+).
  struct Pair {
    TimeSeries sine, cosine;
  };
  Pair sine_and_cosine(const TimeSeries& a, bool hyperbolic) const {
    Pair f{TimeSeries(hyperbolic ? sinh(a.c[0]) : sin(a.c[0])),
           TimeSeries(hyperbolic ? cosh(a.c[0]) : cos(a.c[0]))};
    for (std::size_t k = 1; k <= last_; ++k) {
      f.sine.c[k] = linked(a, f.cosine, k);
      const Rounded change = linked(a, f.sine, k);
      f.cosine.c[k] = hyperbolic ? change : -change;
    }
    return f;
  }

  /// f' = (1 - f²) a'.
  TimeSeries hyperbolic_tangent(const TimeSeries& a) const {
    TimeSeries f(tanh(a.c[0])), slope(Rounded(1) - f.c[0] * f.c[0]);
    for (std::size_t k = 1; k <= last_; ++k) {
      f.c[k] = linked(a, slope, k);
      for (std::size_t j = 0; j <= k; ++j) slope.c[k] -= f.c[j] * f.c[k - j];
    }
    return f;
  }

  /// 1 ± a².
  TimeSeries one_and_square(const TimeSeries& a, bool minus) const {
    const TimeSeries square = product(a, a);
    TimeSeries f = minus ? negative(square) : square;
    // (1 - a)(1 + a) keeps its digits near 1.
    f.c[0] = minus ? (Rounded(1) - a.c[0]) * (Rounded(1) + a.c[0]) : Rounded(1) + square.c[0];
    return f;
  }

  /// atan2(y, x)' = (x y' - y x')/(x² + y²).
  TimeSeries angle(const TimeSeries& y, const TimeSeries& x) const {
    const TimeSeries turn = sum(product(x, rate(y)), negative(product(y, rate(x))));
    return integral(quotient(turn, sum(product(x, x), product(y, y))), atan2(y.c[0], x.c[0]));
  }

  /// a^e by squaring; e >= 0.
  TimeSeries whole_power(TimeSeries a, double e) const {
    TimeSeries f(Rounded(1));
    for (;;) {
      const double half = std::floor(e / 2);
      if (e > 2 * half) f = product(f, a);
      if (half == 0) return f;
      a = product(a, a);
      e = half;
    }
  }

  TimeSeries power(const TimeSeries& a, const TimeSeries& b, bool constant_b) const {
    constexpr double most_factors = 1 << 20;
    if (!constant_b) return exponential(product(b, logarithm(a)));
    const Rounded e = b.c[0];
    if (e.is_exact() && e.value == std::floor(e.value) && std::abs(e.value) <= most_factors) {
      const TimeSeries f = whole_power(a, std::abs(e.value));
      return e.value < 0 ? quotient(TimeSeries(Rounded(1)), f) : f;
    }
    // a f' = e f a'
    TimeSeries f(pow(a.c[0], e));
    for (std::size_t k = 1; k <= last_; ++k) {
      Rounded total;
      for (std::size_t j = 1; j <= k; ++j) total += (number(j) * e - number(k - j)) * (a.c[j] * f.c[k - j]);
      f.c[k] = total / (number(k) * a.c[0]);
    }
    return f;
  }

 private:
  static Rounded number(std::size_t k) { return static_cast<double>(k); }

  /// Coefficient k of the integral of g a', from the coefficients of g below k.
  static Rounded linked(const TimeSeries& a, const TimeSeries& g, std::size_t k) {
    Rounded total;
    for (std::size_t j = 1; j <= k; ++j) total += number(j) * a.c[j] * g.c[k - j];
    return total / number(k);
  }

  std::size_t last_;
};

/// What decides a branch: the value, or of one that is exactly 0 what it is first from there on; then no
/// number where rounding leaves its sign open.
Rounded deciding(const TimeSeries& a, int order, Instant instant) {
  if (instant == Instant::now) return a.c[0];
  std::size_t k = 0;
  while (k < static_cast<std::size_t>(order) && a.c[k].is_exact() && a.c[k].value == 0) ++k;
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  return a.c[k].is_undecided() ? Rounded(nothing, nothing) : a.c[k];
}

}  // namespace

Rounded TimeSeries::derivative(int k) const {
  double factorial = 1;
  for (int j = 2; j <= k; ++j) factorial *= j;
  return Rounded(factorial) * c[static_cast<std::size_t>(k)];
}

TimeSeries applied(Operation operation, const TimeSeries& a, const TimeSeries& b, bool constant_b, int order,
                   Instant instant) {
  const Arithmetic by(order);
  const auto sign_of = [&](const TimeSeries& f) { return deciding(f, order, instant); };
  switch (operation) {
    case Operation::parameter:
      return a;
    case Operation::negate:
      return by.negative(a);
    case Operation::add:
      return by.sum(a, b);
    case Operation::subtract:
      return by.sum(a, by.negative(b));
    case Operation::multiply:
      return by.product(a, b);
    case Operation::divide:
      return by.quotient(a, b);
    case Operation::power:
      return by.power(a, b, constant_b);
    case Operation::sin:
      return by.sine_and_cosine(a, false).sine;
    case Operation::cos:
      return by.sine_and_cosine(a, false).cosine;
    case Operation::tan: {
      const auto [sine, cosine] = by.sine_and_cosine(a, false);
      return by.quotient(sine, cosine);
    }
    case Operation::asin:
      return by.integral(by.quotient(by.rate(a), by.root(by.one_and_square(a, true))), asin(a.c[0]));
    case Operation::acos:
      return by.integral(by.negative(by.quotient(by.rate(a), by.root(by.one_and_square(a, true)))),
                         acos(a.c[0]));
    case Operation::atan:
      return by.integral(by.quotient(by.rate(a), by.one_and_square(a, false)), atan(a.c[0]));
    case Operation::atan2:
      return by.angle(a, b);
    case Operation::sinh:
      return by.sine_and_cosine(a, true).sine;
    case Operation::cosh:
      return by.sine_and_cosine(a, true).cosine;
    case Operation::tanh:
      return by.hyperbolic_tangent(a);
    case Operation::exp:
      return by.exponential(a);
    case Operation::log:
      return by.logarithm(a);
    case Operation::sqrt:
      return by.root(a);
    case Operation::abs: {
      const Rounded first = sign_of(a);
      return first > 0 ? a : first < 0 ? by.negative(a) : undefined_series();
    }
    case Operation::sign: {
      const Rounded first = sign_of(a);
      return first > 0 ? TimeSeries(Rounded(1)) : first < 0 ? TimeSeries(Rounded(-1)) : undefined_series();
    }
    case Operation::min:
    case Operation::max: {
      const TimeSeries difference = by.sum(a, by.negative(b));
      const Rounded first = sign_of(operation == Operation::max ? difference : by.negative(difference));
      return first.is_undecided() ? undefined_series() : first < 0 ? b : a;
    }
    case Operation::where_not_negative:
    case Operation::where_negative: {
      const Rounded first = sign_of(a);
      if (first.is_undecided()) return undefined_series();
      return (first < 0) == (operation == Operation::where_negative) ? b : TimeSeries(Rounded(0));
    }
    default:
      return undefined_series();
  }
}

}  // namespace mechanics::expression
