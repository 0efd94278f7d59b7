#include <cmath>

#include "convex/functions/scalar_sum.hpp"
#include "convex/functions/separable_functions.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/infinity.hpp"
#include "convex/prox_formulas/relative_entropy.hpp"

namespace convex::inline named_functions {
namespace {

double x_log_x(double x) { return x > 0 ? x * std::log(x) : x < 0 ? infinity : 0; }

struct OnHalfLine {
  bool finite() const { return false; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {.low = 0}; }
};

struct OnLine {
  bool finite() const { return true; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {}; }
};

/// One number for every entry, or one each.
struct Weights {
  double operator[](Index i) const { return each.size() > 0 ? each[i] : all; }
  Argument written() const { return each.size() > 0 ? Argument(each) : Argument(all); }
  double all = 0;
  Vector each;
};

Weights one_or_each(double all) { return {all, {}}; }
Weights one_or_each(const Vector& each) { return {0, each}; }

struct Entropy : OnHalfLine, AnySize {
  Call call() const { return {"entropy"}; }
  Function conjugate() const;
  Ends domain(Index) const { return {.low = 0}; }
  Ends slopes(Index) const { return {}; }
  double value(double x, Index) const { return x_log_x(x); }
  double slope(double x, Index) const { return x > 0 ? std::log(x) + 1 : -infinity; }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_entropy(z, d);
  }
};

/// e^(x - 1).
struct EntropyConjugate : OnLine, AnySize {
  Call call() const { return {"translate", {argument(Call{"exponential"}), argument("by", 1.0)}}; }
  Function conjugate() const { return entropy(); }
  Ends domain(Index) const { return {}; }
  Ends slopes(Index) const { return {.low = 0}; }
  double value(double x, Index) const { return std::exp(x - 1); }
  double slope(double x, Index) const { return std::exp(x - 1); }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_entropy_conjugate(z, d);
  }
};

struct Exponential : OnLine, AnySize {
  Call call() const { return {"exponential"}; }
  Function conjugate() const;
  Ends domain(Index) const { return {}; }
  Ends slopes(Index) const { return {.low = 0}; }
  double value(double x, Index) const { return std::exp(x); }
  double slope(double x, Index) const { return std::exp(x); }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_exponential(z, d);
  }
};

/// x log x - x.
struct ExponentialConjugate : OnHalfLine, AnySize {
  Call call() const { return {"tilt", {argument(Call{"entropy"}), argument("c", -1.0)}}; }
  Function conjugate() const { return exponential(); }
  Ends domain(Index) const { return {.low = 0}; }
  Ends slopes(Index) const { return {}; }
  double value(double x, Index) const { return x_log_x(x) - x; }
  double terms(double x, Index) const { return std::abs(x_log_x(x)) + std::abs(x); }
  double slope(double x, Index) const { return x > 0 ? std::log(x) : -infinity; }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_exponential_conjugate(z, d);
  }
};

struct KullbackLeibler : OnHalfLine {
  Weights reference;
  Index dimension() const { return reference.each.size(); }
  Call call() const { return {"kullback_leibler", {argument("reference", reference.written())}}; }
  Function conjugate() const;
  Ends ends(Index i) const { return {.low = 0, .high = reference[i] > 0 ? infinity : 0}; }
  Ends domain(Index i) const { return ends(i); }
  Ends slopes(Index) const { return {}; }
  double value(double x, Index i) const {
    const double r = reference[i];
    if (x < 0 || (r == 0 && x > 0)) return infinity;
    if (x == 0) return r;
    // Near r the three terms cancel; x log(x/r) - x + r = r ((1+t) log(1+t) - t) with t = (x - r)/r.
    const double t = (x - r) / r;
    return std::abs(t) < 0.5 ? r * one_plus_log(t) : x * (std::log(x) - std::log(r)) - x + r;
  }
  double terms(double x, Index i) const {
    const double r = reference[i], found = value(x, i);
    if (!(found < infinity) || x == 0) return std::abs(found);
    const double t = (x - r) / r;
    if (std::abs(t) <= 0x1p-10) return found;  // x - r has no rounding, nor does the series cancel
    return std::abs(t) < 0.5 ? r * (std::abs((1 + t) * std::log1p(t)) + std::abs(t))
                             : x * (std::abs(std::log(x)) + std::abs(std::log(r))) + x + r;
  }
  double slope(double x, Index i) const {
    const double r = reference[i];
    if (x < 0) return -infinity;
    if (r == 0) return x > 0 ? infinity : 0;
    if (x == 0) return -infinity;
    return std::abs(x - r) < 0.5 * r ? std::log1p((x - r) / r) : std::log(x) - std::log(r);
  }
  prox_formulas::ScalarProx prox(double z, double d, Index i) const {
    return prox_formulas::prox_kullback_leibler(z, d, reference[i]);
  }

 private:
  /// (1+t) log(1+t) - t = Σ_(k>=2) (-t)^k / (k (k-1)), for |t| < ½.
  static double one_plus_log(double t) {
    if (std::abs(t) > 0x1p-10) return (1 + t) * std::log1p(t) - t;
    return t * t * (0.5 - t * (1.0 / 6 - t * (1.0 / 12 - t * (1.0 / 20 - t * (1.0 / 30 - t / 42)))));
  }
};

/// r (e^x - 1).
struct Expm1 : OnLine {
  Weights weight;
  Index dimension() const { return weight.each.size(); }
  Call call() const { return {"expm1", {argument("weight", weight.written())}}; }
  Function conjugate() const { return scalar_sum(KullbackLeibler{{}, weight}); }
  Ends domain(Index) const { return {}; }
  Ends slopes(Index i) const { return {.low = 0, .high = weight[i] > 0 ? infinity : 0}; }
  double value(double x, Index i) const { return weight[i] == 0 ? 0 : weight[i] * std::expm1(x); }
  double slope(double x, Index i) const { return weight[i] == 0 ? 0 : weight[i] * std::exp(x); }
  prox_formulas::ScalarProx prox(double z, double d, Index i) const {
    return prox_formulas::prox_kullback_leibler_conjugate(z, d, weight[i]);
  }
};

Function Entropy::conjugate() const { return scalar_sum(EntropyConjugate{}); }
Function Exponential::conjugate() const { return scalar_sum(ExponentialConjugate{}); }
Function KullbackLeibler::conjugate() const { return scalar_sum(Expm1{{}, reference}); }

}  // namespace

Function entropy() { return scalar_sum(Entropy{}); }

Function exponential() { return scalar_sum(Exponential{}); }

Function kullback_leibler(double reference) {
  require_nonnegative("kullback_leibler", "reference", reference);
  return scalar_sum(KullbackLeibler{{}, one_or_each(reference)});
}

Function kullback_leibler(const Vector& reference) {
  require_nonnegative("kullback_leibler", "reference", reference);
  return scalar_sum(KullbackLeibler{{}, one_or_each(reference)});
}

Function expm1(double weight) {
  require_nonnegative("expm1", "weight", weight);
  return scalar_sum(Expm1{{}, one_or_each(weight)});
}

Function expm1(const Vector& weight) {
  require_nonnegative("expm1", "weight", weight);
  return scalar_sum(Expm1{{}, one_or_each(weight)});
}

}  // namespace convex::inline named_functions
