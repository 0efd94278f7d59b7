#include <cmath>

#include "convex/functions/scalar_sum.hpp"
#include "convex/functions/separable_functions.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/infinity.hpp"
#include "convex/prox_formulas/log_barrier.hpp"
#include "convex/prox_formulas/logistic.hpp"

namespace convex::inline named_functions {
namespace {

struct LogBarrier {
  double offset = 0;
  Index dimension() const { return 0; }
  bool finite() const { return false; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {}; }  // open: no point outside counts as inside
  Call call() const {
    if (offset == 0) return {"log_barrier"};
    return {"log_barrier", {argument("offset", offset)}};
  }
  Function conjugate() const;
  Ends domain(Index) const { return {.low = 0}; }
  Ends slopes(Index) const { return {.high = 0}; }
  double value(double x, Index) const { return x > 0 ? offset - std::log(x) : infinity; }
  double terms(double x, Index) const { return std::abs(offset) + std::abs(std::log(x)); }
  double slope(double x, Index) const { return x > 0 ? -1 / x : -infinity; }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_log_barrier(z, d);
  }
};

/// -1 - offset - log(-x).
struct LogBarrierConjugate {
  double offset = 0;
  Index dimension() const { return 0; }
  bool finite() const { return false; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {}; }
  Call call() const { return {"dilate", {argument(LogBarrier{-1 - offset}.call()), argument("rho", -1.0)}}; }
  Function conjugate() const { return log_barrier(offset); }
  Ends domain(Index) const { return {.high = 0}; }
  Ends slopes(Index) const { return {.low = 0}; }
  double value(double x, Index) const { return x < 0 ? -1 - offset - std::log(-x) : infinity; }
  double terms(double x, Index) const { return 1 + std::abs(offset) + std::abs(std::log(-x)); }
  double slope(double x, Index) const { return x < 0 ? -1 / x : infinity; }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_log_barrier_conjugate(z, d);
  }
};

struct Logistic {
  Index dimension() const { return 0; }
  bool finite() const { return true; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {}; }
  Call call() const { return {"logistic"}; }
  Function conjugate() const { return binary_entropy(); }
  Ends domain(Index) const { return {}; }
  Ends slopes(Index) const { return {.low = 0, .high = 1}; }
  double value(double x, Index) const { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }
  double slope(double x, Index) const {
    return x > 0 ? 1 / (1 + std::exp(-x)) : std::exp(x) / (1 + std::exp(x));
  }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_logistic(z, d);
  }
};

struct BinaryEntropy {
  Index dimension() const { return 0; }
  bool finite() const { return false; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {0, 1}; }
  Call call() const { return {"binary_entropy"}; }
  Function conjugate() const { return logistic(); }
  Ends domain(Index) const { return {.low = 0, .high = 1}; }
  Ends slopes(Index) const { return {}; }
  double value(double x, Index) const {
    if (x < 0 || x > 1) return infinity;
    if (x == 0 || x == 1) return 0;
    return x * std::log(x) + (1 - x) * std::log1p(-x);
  }
  double slope(double x, Index) const {
    if (x <= 0) return -infinity;
    if (x >= 1) return infinity;
    return std::log(x) - std::log1p(-x);
  }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_binary_entropy(z, d);
  }
};

Function LogBarrier::conjugate() const { return scalar_sum(LogBarrierConjugate{offset}); }

}  // namespace

Function log_barrier(double offset) {
  require_finite("log_barrier", "offset", offset);
  return scalar_sum(LogBarrier{offset});
}

Function logistic() { return scalar_sum(Logistic{}); }

Function binary_entropy() { return scalar_sum(BinaryEntropy{}); }

}  // namespace convex::inline named_functions
