#include "mechanics/expression/operation.hpp"

#include <cmath>
#include <limits>

#include "convex/invariant.hpp"
#include "mechanics/expression/rounded.hpp"

namespace mechanics::expression {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

// The functions of doubles; those of numbers with radii are found by their arguments.
using std::abs;
using std::acos;
using std::asin;
using std::atan;
using std::cos;
using std::cosh;
using std::exp;
using std::hypot;
using std::log;
using std::pow;
using std::sin;
using std::sinh;
using std::sqrt;
using std::tan;
using std::tanh;

template <class Real>
Real raised(Real base, Real exponent) {
  if (exponent == 1) return base;
  if (exponent == 2) return base * base;  // exactly rounded and fast; pow is neither promised to be
  return pow(base, exponent);
}

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : undefined; }
/// Unknown where x may be 0.
Rounded sign(Rounded x) {
  return {sign(x.value), x.may_be_zero() ? std::numeric_limits<double>::infinity() : 0};
}

/// b where a >= 0 (or a < 0), else 0. A branch that rounding may have decided otherwise is off by at most b.
double where(bool is_taken, double, double b) { return is_taken ? b : 0; }
Rounded where(bool is_taken, Rounded a, Rounded b) {
  const Rounded taken = is_taken ? b : Rounded(0);
  return a.is_undecided() ? Rounded(taken.value, widened(std::abs(b.value) + b.radius)) : taken;
}

template <class Real>
bool is_taken(Operation operation, Real a) {
  return operation == Operation::where_negative ? a < 0 : !(a < 0);
}

/// The larger (or smaller) of two; between numbers with radii nothing larger than theirs happens.
template <class Real>
bool takes_first(Operation operation, Real a, Real b) {
  const Real difference = operation == Operation::max ? a - b : b - a;
  return !(difference < 0);
}
double chosen(Operation operation, double a, double b) { return takes_first(operation, a, b) ? a : b; }
Rounded chosen(Operation operation, Rounded a, Rounded b) {
  Rounded f = takes_first(operation, a, b) ? a : b;
  if ((a - b).is_undecided()) f.radius = std::max(a.radius, b.radius);
  return f;
}

template <class Real>
PartialsOf<Real> choice_partials(Operation operation, Real a, Real b) {
  const Real difference = operation == Operation::max ? a - b : b - a, one = 1;
  return {where(is_taken(Operation::where_not_negative, difference), difference, one),
          where(is_taken(Operation::where_negative, difference), difference, one)};
}

/// 1 - tanh² without its cancellation.
template <class Real>
Real sech_squared(Real x) {
  const Real e = exp(-2.0 * abs(x));
  return 4.0 * e / ((1.0 + e) * (1.0 + e));
}

/// log(base) where base^exponent · log(base)^k, its limit 0 at base 0 included, is asked for.
template <class Real>
Real log_in_power(Real base, Real exponent) {
  return base == 0 && exponent > 0 ? Real(0) : log(base);
}

template <class Real>
PartialsOf<Real> power_partials(Real a, Real b, Real f, Active active) {
  PartialsOf<Real> p;
  if (active.a) p.a = b == 0 ? Real(0) : b * raised<Real>(a, b - 1.0);
  if (active.b) p.b = f * log_in_power(a, b);
  return p;
}

template <class Real>
SecondPartialsOf<Real> power_second_partials(Real a, Real b, Real f, Active active) {
  SecondPartialsOf<Real> p;
  if (active.a) p.aa = b == 0 || b == 1 ? Real(0) : b * (b - 1.0) * raised<Real>(a, b - 2.0);
  const Real l = active.b ? log_in_power(a, b) : Real(0);
  if (active.b) p.bb = f * l * l;
  if (active.a && active.b) p.ab = raised<Real>(a, b - 1.0) * (1.0 + b * log(a));
  return p;
}

}  // namespace

template <class Real>
Real value(Operation operation, Real a, Real b) {
  switch (operation) {
    case Operation::parameter:
      return a;
    case Operation::negate:
      return -a;
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::power:
      return raised(a, b);
    case Operation::sin:
      return sin(a);
    case Operation::cos:
      return cos(a);
    case Operation::tan:
      return tan(a);
    case Operation::asin:
      return asin(a);
    case Operation::acos:
      return acos(a);
    case Operation::atan:
      return atan(a);
    case Operation::atan2:
      return atan2(a, b);
    case Operation::sinh:
      return sinh(a);
    case Operation::cosh:
      return cosh(a);
    case Operation::tanh:
      return tanh(a);
    case Operation::exp:
      return exp(a);
    case Operation::log:
      return log(a);
    case Operation::sqrt:
      return sqrt(a);
    case Operation::abs:
      return abs(a);
    case Operation::sign:
      return sign(a);
    case Operation::min:
    case Operation::max:
      return chosen(operation, a, b);
    case Operation::where_not_negative:
    case Operation::where_negative:
      return where(is_taken(operation, a), a, b);
    default:
      break;
  }
  convex::invariant(false, "a constant or a variable is not computed from operands");
  return 0;
}

template <class Real>
PartialsOf<Real> partials(Operation operation, Real a, Real b, Real f, Active active) {
  switch (operation) {
    case Operation::negate:
      return {-1, 0};
    case Operation::add:
      return {1, 1};
    case Operation::subtract:
      return {1, -1};
    case Operation::multiply:
      return {b, a};
    case Operation::divide:
      return {active.a ? 1.0 / b : 0, active.b ? -f / b : 0};
    case Operation::power:
      return power_partials(a, b, f, active);
    case Operation::sin:
      return {cos(a), 0};
    case Operation::cos:
      return {-sin(a), 0};
    case Operation::tan:
      return {1.0 + f * f, 0};
    case Operation::asin:
      return {1.0 / sqrt((1.0 - a) * (1.0 + a)), 0};
    case Operation::acos:
      return {-1.0 / sqrt((1.0 - a) * (1.0 + a)), 0};
    case Operation::atan:
      return {1.0 / (1.0 + a * a), 0};
    case Operation::atan2: {
      const Real r = hypot(a, b);
      return {active.a ? b / r / r : 0, active.b ? -a / r / r : 0};
    }
    case Operation::sinh:
      return {cosh(a), 0};
    case Operation::cosh:
      return {sinh(a), 0};
    case Operation::tanh:
      return {sech_squared(a), 0};
    case Operation::exp:
      return {f, 0};
    case Operation::log:
      return {1.0 / a, 0};
    case Operation::sqrt:
      return {0.5 / f, 0};
    case Operation::abs:
      return {sign(a), 0};
    case Operation::sign:
      return {0, 0};
    case Operation::min:
    case Operation::max:
      return choice_partials(operation, a, b);
    case Operation::where_not_negative:
    case Operation::where_negative:
      return {0, where(is_taken(operation, a), a, Real(1))};
    default:
      break;
  }
  convex::invariant(false, "a constant or a variable has no operands");
  return {};
}

template <class Real>
SecondPartialsOf<Real> second_partials(Operation operation, Real a, Real b, Real f, Active active) {
  switch (operation) {
    case Operation::multiply:
      return {0, 1, 0};
    case Operation::divide:
      return {0, active.a && active.b ? -1.0 / b / b : 0, active.b ? 2.0 * (f / b) / b : 0};
    case Operation::power:
      return power_second_partials(a, b, f, active);
    case Operation::sin:
    case Operation::cos:
      return {-f, 0, 0};
    case Operation::tan:
      return {2.0 * f * (1.0 + f * f), 0, 0};
    case Operation::asin:
    case Operation::acos: {
      const Real square = (1.0 - a) * (1.0 + a), sense = operation == Operation::asin ? 1 : -1;
      return {sense * a / (square * sqrt(square)), 0, 0};
    }
    case Operation::atan: {
      const Real p = 1.0 / (1.0 + a * a);
      return {-2.0 * a * p * p, 0, 0};
    }
    case Operation::atan2: {
      const Real r = hypot(a, b), s = a / r, c = b / r;
      const Real mixed = 2.0 * s * c / r / r;
      return {active.a ? -mixed : 0, active.a && active.b ? (s - c) * (s + c) / r / r : 0,
              active.b ? mixed : 0};
    }
    case Operation::sinh:
    case Operation::cosh:
      return {f, 0, 0};
    case Operation::tanh:
      return {-2.0 * f * sech_squared(a), 0, 0};
    case Operation::exp:
      return {f, 0, 0};
    case Operation::log:
      return {-1.0 / a / a, 0, 0};
    case Operation::sqrt:
      return {-0.25 / (a * f), 0, 0};
    case Operation::abs:
      return {0 * sign(a), 0, 0};
    default:
      return {};
  }
}

template double value(Operation, double, double);
template PartialsOf<double> partials(Operation, double, double, double, Active);
template SecondPartialsOf<double> second_partials(Operation, double, double, double, Active);
template Rounded value(Operation, Rounded, Rounded);
template PartialsOf<Rounded> partials(Operation, Rounded, Rounded, Rounded, Active);
template SecondPartialsOf<Rounded> second_partials(Operation, Rounded, Rounded, Rounded, Active);

}  // namespace mechanics::expression
