#include "mechanics/expression/number.hpp"

#include <cmath>

#include "mechanics/expression/exact_root.hpp"

namespace mechanics::expression {
namespace {

using convex::BallFunction;

const Number zero{}, one{1}, two{2};

std::optional<BallFunction> ball_function(Operation operation) {
  switch (operation) {
    case Operation::power:
      return BallFunction::power;
    case Operation::sin:
      return BallFunction::sin;
    case Operation::cos:
      return BallFunction::cos;
    case Operation::tan:
      return BallFunction::tan;
    case Operation::asin:
      return BallFunction::asin;
    case Operation::acos:
      return BallFunction::acos;
    case Operation::atan:
      return BallFunction::atan;
    case Operation::atan2:
      return BallFunction::atan2;
    case Operation::sinh:
      return BallFunction::sinh;
    case Operation::cosh:
      return BallFunction::cosh;
    case Operation::tanh:
      return BallFunction::tanh;
    case Operation::exp:
      return BallFunction::exp;
    case Operation::log:
      return BallFunction::log;
    case Operation::sqrt:
      return BallFunction::sqrt;
    default:
      return std::nullopt;
  }
}

/// Larger exponents, of fractions beyond so many bits, make numbers that nobody wants to wait for.
constexpr std::int64_t largest_exponent = 64, most_bits = 8192;

bool can_be_raised(const Number& base, std::int64_t e) {
  if (e <= largest_exponent || e > most_bits || !base.is_exact()) return e <= largest_exponent;
  const auto& [above, below] = base.fraction();
  return e * static_cast<std::int64_t>(std::max(above.bits(), below.bits())) <= most_bits;
}

Number raised(const Number& base, std::int64_t exponent) {
  Number result = one, square = base;
  for (std::int64_t e = std::abs(exponent); e > 0; e /= 2) {
    if (e % 2 != 0) result = result * square;
    if (e > 1) square = square * square;
  }
  return exponent < 0 ? one / result : result;
}

/// The value of a function that is no fraction, or not known to be one.
std::optional<Number> enclosed(Operation operation, const Number& a, const Number& b, long precision) {
  const auto function = ball_function(operation);
  if (precision == 0 || !function) return std::nullopt;
  std::optional<SymbolicForm> form;
  const std::string name(symbol(operation));
  if (operation == Operation::power || operation == Operation::atan2) {
    const auto left = a.name(), right = b.name();
    if (left && right) form = atom(name + "(" + *left + ", " + *right + ")", {1, 1});
  } else if (a.name()) {
    form = function_form(name, *a.form());
  }
  return Number(Ball::apply(*function, a.ball(precision), b.ball(precision)), form,
                algebraic_function(name, a.algebraic(), b.algebraic(), a.name().value_or("")));
}

std::optional<Number> root(const Number& a, long precision) {
  if (a.is_exact())
    if (const auto fraction = exact_root(a.fraction())) return Number(*fraction);
  return enclosed(Operation::sqrt, a, a, precision);
}

/// a^b: whole powers of anything, other powers of what is positive.
std::optional<NumberPartials> power(const Number& a, const Number& b, bool b_is_constant, long precision) {
  const bool is_whole =
      b.is_exact() && b.fraction().denominator == 1 && b.fraction().numerator.fits_word() && b_is_constant;
  const std::int64_t e = is_whole ? b.fraction().numerator.word() : 0;
  if (is_whole && can_be_raised(a, std::abs(e))) {
    if (a.is_zero() && e < 0) return std::nullopt;
    NumberPartials p{raised(a, e), zero, zero, zero, zero, zero};
    if (e != 0) p.a = Number(e) * raised(a, e - 1);
    if (e != 0 && e != 1) p.aa = Number(e * (e - 1)) * raised(a, e - 2);
    return p;
  }
  if (a.sign() != std::optional<int>(1)) return std::nullopt;
  std::optional<Number> f;
  if (b.is_exact() && b.fraction().denominator == 2 && b.fraction().numerator.fits_word() &&
      std::abs(b.fraction().numerator.word()) <= largest_exponent) {
    f = root(a, precision);
    if (f) f = raised(*f, b.fraction().numerator.word());
  } else {
    f = enclosed(Operation::power, a, b, precision);
  }
  if (!f) return std::nullopt;
  NumberPartials p{*f, b * *f / a, zero, b * (b - one) * *f / (a * a), zero, zero};
  if (b_is_constant) return p;
  const auto logarithm = a.is_exact() && a.fraction() == Fraction{1, 1}
                             ? std::optional<Number>(zero)
                             : enclosed(Operation::log, a, a, precision);
  if (!logarithm) return std::nullopt;
  p.b = *f * *logarithm;
  p.ab = *f / a * (one + b * *logarithm);
  p.bb = *f * *logarithm * *logarithm;
  return p;
}

/// sin a and cos a, or sinh a and cosh a.
std::optional<std::pair<Number, Number>> sine_and_cosine(const Number& a, bool hyperbolic, long precision) {
  if (a.is_zero()) return std::pair{zero, one};
  const auto sine = enclosed(hyperbolic ? Operation::sinh : Operation::sin, a, a, precision);
  const auto cosine = enclosed(hyperbolic ? Operation::cosh : Operation::cos, a, a, precision);
  if (!sine || !cosine) return std::nullopt;
  return std::pair{*sine, *cosine};
}

/// asin a or acos a.
std::optional<NumberPartials> inverse_sine(Operation operation, const Number& a, long precision) {
  const Number square = (one - a) * (one + a);
  if (square.sign() != std::optional<int>(1)) return std::nullopt;
  const auto cosine = root(square, precision);
  const auto f = operation == Operation::asin && a.is_zero() ? std::optional<Number>(zero)
                                                             : enclosed(operation, a, a, precision);
  if (!f || !cosine) return std::nullopt;
  const Number slope = one / *cosine, bend = a * slope / square;
  if (operation == Operation::asin) return NumberPartials{*f, slope, zero, bend, zero, zero};
  return NumberPartials{*f, -slope, zero, -bend, zero, zero};
}

std::optional<NumberPartials> two_argument_angle(const Number& a, const Number& b, long precision) {
  const Number square = a * a + b * b;
  if (square.sign() != std::optional<int>(1)) return std::nullopt;
  const bool is_zero = a.is_zero() && b.sign() == std::optional<int>(1);
  const auto f = is_zero ? std::optional<Number>(zero) : enclosed(Operation::atan2, a, b, precision);
  if (!f) return std::nullopt;
  const Number bend = two * a * b / (square * square);
  return NumberPartials{*f, b / square, -a / square, -bend, (a * a - b * b) / (square * square), bend};
}

/// Functions of one operand.
std::optional<NumberPartials> function_partials(Operation operation, const Number& a, long precision) {
  const auto of = [](Number f, Number slope, Number bend) {
    return NumberPartials{std::move(f), std::move(slope), zero, std::move(bend), zero, zero};
  };
  switch (operation) {
    case Operation::sin:
    case Operation::sinh: {
      const bool hyperbolic = operation == Operation::sinh;
      const auto s = sine_and_cosine(a, hyperbolic, precision);
      if (!s) return std::nullopt;
      return of(s->first, s->second, hyperbolic ? s->first : -s->first);
    }
    case Operation::cos:
    case Operation::cosh: {
      const bool hyperbolic = operation == Operation::cosh;
      const auto s = sine_and_cosine(a, hyperbolic, precision);
      if (!s) return std::nullopt;
      return of(s->second, hyperbolic ? s->first : -s->first, hyperbolic ? s->second : -s->second);
    }
    case Operation::tan:
    case Operation::tanh: {
      const auto f = a.is_zero() ? std::optional<Number>(zero) : enclosed(operation, a, a, precision);
      if (!f) return std::nullopt;
      const Number slope = operation == Operation::tan ? one + *f * *f : one - *f * *f;
      return of(*f, slope, operation == Operation::tan ? two * *f * slope : -(two * *f * slope));
    }
    case Operation::asin:
    case Operation::acos:
      return inverse_sine(operation, a, precision);
    case Operation::atan: {
      const auto f = a.is_zero() ? std::optional<Number>(zero) : enclosed(operation, a, a, precision);
      if (!f) return std::nullopt;
      const Number slope = one / (one + a * a);
      return of(*f, slope, -(two * a * slope * slope));
    }
    case Operation::exp: {
      const auto f = a.is_zero() ? std::optional<Number>(one) : enclosed(operation, a, a, precision);
      if (!f) return std::nullopt;
      return of(*f, *f, *f);
    }
    case Operation::log: {
      if (a.sign() != std::optional<int>(1)) return std::nullopt;
      const auto f = a.is_exact() && a.fraction() == Fraction{1, 1} ? std::optional<Number>(zero)
                                                                    : enclosed(operation, a, a, precision);
      if (!f) return std::nullopt;
      return of(*f, one / a, -(one / (a * a)));
    }
    case Operation::sqrt: {
      if (a.sign() != std::optional<int>(1)) return std::nullopt;
      const auto f = root(a, precision);
      if (!f) return std::nullopt;
      const Number slope = one / (two * *f);
      return of(*f, slope, -(slope / (two * a)));
    }
    case Operation::abs:
    case Operation::sign: {
      const auto s = a.sign();
      if (!s || *s == 0) return std::nullopt;
      if (operation == Operation::sign) return of(Number(*s), zero, zero);
      return of(Number(*s) * a, Number(*s), zero);
    }
    default:
      return std::nullopt;
  }
}

std::optional<NumberPartials> partials_anyhow(Operation operation, const Number& a, const Number& b,
                                              bool b_is_constant, long precision) {
  switch (operation) {
    case Operation::negate:
      return NumberPartials{-a, -one, zero, zero, zero, zero};
    case Operation::add:
      return NumberPartials{a + b, one, one, zero, zero, zero};
    case Operation::subtract:
      return NumberPartials{a - b, one, -one, zero, zero, zero};
    case Operation::multiply:
      return NumberPartials{a * b, b, a, zero, one, zero};
    case Operation::divide: {
      if (b.is_zero()) return std::nullopt;
      const Number f = a / b, inverse = one / b, square = inverse * inverse;
      return NumberPartials{f, inverse, -f * inverse, zero, -square, two * f * square};
    }
    case Operation::power:
      return power(a, b, b_is_constant, precision);
    case Operation::atan2:
      return two_argument_angle(a, b, precision);
    default:
      return function_partials(operation, a, precision);
  }
}

/// One of the four rules on numbers of which one is a ball.
Ball ruled(BallFunction rule, const Number& a, const Number& b) {
  // A fraction takes the precision of the other.
  if (a.is_exact()) {
    const Ball right = b.ball(0);
    return Ball::apply(rule, a.ball(right.precision()), right);
  }
  const Ball left = a.ball(0);
  return Ball::apply(rule, left, b.ball(left.precision()));
}

/// What a rule makes of two forms, when both are known.
template <class Rule>
std::optional<SymbolicForm> combined(const Number& a, const Number& b, Rule rule) {
  const auto left = a.form(), right = b.form();
  if (!left || !right) return std::nullopt;
  return rule(*left, *right);
}

const Fraction* known_fraction(const Number& x) { return x.is_exact() ? &x.fraction() : nullptr; }

SymbolicForm difference(const SymbolicForm& a, const SymbolicForm& b) { return sum(a, scaled(b, {-1, 1})); }

}  // namespace

Number::Number(Ball ball, const std::optional<SymbolicForm>& form, KnownAlgebraic algebraic)
    : ball_(std::move(ball)) {
  if (!ball_->is_finite()) return;
  algebraic_ = std::move(algebraic);
  if (!form) return;
  if (form->atoms.empty()) {
    fraction_ = convex::lowest_terms(form->constant);
    ball_.reset();
    algebraic_.reset();
  } else if (const auto name = written(*form)) {
    form_ = std::make_shared<const SymbolicForm>(*form);
  }
}

std::optional<SymbolicForm> Number::form() const {
  if (is_exact()) return SymbolicForm{fraction_, {}};
  return form_ ? std::optional<SymbolicForm>(*form_) : std::nullopt;
}

std::optional<std::string> Number::name() const {
  const auto known = form();
  return known ? written(*known) : std::nullopt;
}

Number Number::unnamed() const {
  Number number = *this;
  number.form_.reset();
  number.algebraic_.reset();
  return number;
}

KnownAlgebraic Number::algebraic() const { return is_exact() ? algebraic_fraction(fraction_) : algebraic_; }

Number operator-(const Number& a) {
  if (a.is_exact()) return -a.fraction_;
  return Number(Ball::apply(BallFunction::negate, *a.ball_), combined(Number(), a, difference),
                algebraic_negative(a.algebraic_));
}
Number operator+(const Number& a, const Number& b) {
  if (a.is_exact() && b.is_exact()) return a.fraction_ + b.fraction_;
  if (a.is_zero()) return b;
  if (b.is_zero()) return a;
  return Number(ruled(BallFunction::add, a, b), combined(a, b, sum),
                algebraic_sum(a.algebraic(), b.algebraic()));
}
Number operator-(const Number& a, const Number& b) {
  if (a.is_exact() && b.is_exact()) return a.fraction_ - b.fraction_;
  if (b.is_zero()) return a;
  return Number(ruled(BallFunction::subtract, a, b), combined(a, b, difference),
                algebraic_sum(a.algebraic(), algebraic_negative(b.algebraic())));
}
Number operator*(const Number& a, const Number& b) {
  if (a.is_exact() && b.is_exact()) return a.fraction_ * b.fraction_;
  if (a.is_zero() || b.is_zero()) return zero;
  return Number(ruled(BallFunction::multiply, a, b), combined(a, b, product),
                algebraic_product(a.algebraic(), b.algebraic(), known_fraction(a), known_fraction(b)));
}
Number operator/(const Number& a, const Number& b) {
  if (a.is_exact() && b.is_exact()) return a.fraction_ / b.fraction_;
  const bool is_divisor = b.sign().value_or(0) != 0;
  if (a.is_zero() && is_divisor) return zero;
  if (!is_divisor) return Number(ruled(BallFunction::divide, a, b), std::nullopt, nullptr);
  return Number(ruled(BallFunction::divide, a, b), combined(a, b, quotient),
                algebraic_quotient(a.algebraic(), b.algebraic(), known_fraction(b)));
}

bool NumberPartials::is_finite() const {
  return f.is_finite() && a.is_finite() && b.is_finite() && aa.is_finite() && ab.is_finite() &&
         bb.is_finite();
}

std::optional<NumberPartials> number_partials(Operation operation, const Number& a, const Number& b,
                                              bool b_is_constant, long precision) {
  auto found = partials_anyhow(operation, a, b, b_is_constant, precision);
  if (found && !found->is_finite()) found.reset();
  return found;
}

}  // namespace mechanics::expression
