#include "convex/exact/ball.hpp"

#include <cmath>
#include <cstdlib>

#include "convex/invariant.hpp"
#include "convex/loaded_module.hpp"

namespace convex::inline exact_arithmetic {
namespace {

struct Module {
  const BallOperations* operations = nullptr;
  std::string reason;
};

Module load() {
#ifdef MOREAU_ARB_MODULE
  const LoadedModule found = load_symbol(MOREAU_ARB_MODULE, MOREAU_ARB_FOLDER, "moreau_balls");
  if (found.symbol == nullptr) return {nullptr, "balls: " + found.reason + "; build again"};
  return {reinterpret_cast<const BallOperations* (*)()>(found.symbol)(), {}};
#else
  return {nullptr, "balls: not built; install libflint-arb-dev and build again"};
#endif
}

const Module& module() {
  static const Module loaded = load();
  return loaded;
}

const BallOperations& balls() {
  invariant(module().operations != nullptr, "balls are asked for only where there are any");
  return *module().operations;
}

}  // namespace

const std::string& Ball::why_none() { return module().reason; }

Ball::Ball(long precision) : handle_(balls().make(), balls().release), precision_(precision) {}

Ball Ball::of(const Fraction& value, long precision) {
  Ball result(precision);
  balls().set_fraction(result.handle_.get(), value.numerator.text().c_str(), value.denominator.text().c_str(),
                       precision);
  return result;
}

Ball Ball::pi(long precision) {
  Ball result(precision);
  balls().apply(result.handle_.get(), static_cast<int>(BallFunction::pi), nullptr, nullptr, precision);
  return result;
}

Ball Ball::apply(BallFunction function, const Ball& a) { return apply(function, a, a); }

Ball Ball::apply(BallFunction function, const Ball& a, const Ball& b) {
  Ball result(std::max(a.precision_, b.precision_));
  balls().apply(result.handle_.get(), static_cast<int>(function), a.handle_.get(), b.handle_.get(),
                result.precision_);
  return result;
}

int Ball::sign() const { return balls().sign(handle_.get()); }
bool Ball::is_finite() const { return balls().is_finite(handle_.get()) != 0; }

Fraction Ball::midpoint() const {
  long exponent = 0;
  const std::unique_ptr<char, void (*)(void*)> digits(balls().midpoint(handle_.get(), &exponent), std::free);
  invariant(digits != nullptr, "a midpoint is asked of a finite ball");
  const Integer mantissa = Integer::from_digits(digits.get());
  const auto power = Integer::shifted(1, static_cast<unsigned long>(std::abs(exponent)));
  return exponent >= 0 ? Fraction{mantissa * power, 1} : Fraction{mantissa, power};
}

double Ball::radius() const { return balls().radius(handle_.get()); }

}  // namespace convex::inline exact_arithmetic
