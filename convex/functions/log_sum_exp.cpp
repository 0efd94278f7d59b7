#include "convex/functions/log_sum_exp.hpp"

#include <cmath>

#include "convex/composite/atom.hpp"
#include "convex/double_double.hpp"
#include "convex/gamma0/facts.hpp"
#include "convex/infinity.hpp"
#include "convex/prox_formulas/relative_entropy.hpp"
#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::inline named_functions {
namespace {

using prox_formulas::ScalarProx;

Function entropy_on_simplex();

/// log Σ e^(x_i), the largest x_i taken out.
double log_sum(const Vector& x) {
  const double top = x.maxCoeff();
  return top + std::log((x.array() - top).exp().sum());
}

Vector softmax(const Vector& x) {
  const Vector e = (x.array() - x.maxCoeff()).exp();
  return e / e.sum();
}

/// diag(s) + (1 - s) (p∘s)ᵀ / Σ p s: x_i moves with z_i, and with the one level that keeps Σ p = 1. s: the
/// derivative of each entry at a fixed level; p: its weight in the level's equation.
struct LogSumExp final : Atom {
  Index dimension() const override { return 0; }
  void require_size(Index n) const override {
    if (n == 0) throw InvalidInput("log_sum_exp: no entries; give at least one");
  }
  Facts facts() const override { return {.smooth = true, .finite = true}; }
  bool takes_any_diagonal() const override { return true; }
  Call call() const override { return {"log_sum_exp"}; }
  Function conjugate() const override { return entropy_on_simplex(); }
  double value(const Vector& x) const override { return log_sum(x); }
  /// The largest entry and the logarithm of a sum of as many terms as there are entries.
  Value evaluate(const Vector& x) const override {
    const double found = log_sum(x), top = x.maxCoeff(), count = static_cast<double>(x.size());
    Value sum = sum_of_terms(found, std::abs(top) + std::abs(found - top));
    sum.error += count * unit_roundoff * (std::isfinite(found) ? 1 : 0);
    return sum;
  }
  std::optional<Vector> subgradient(const Vector& x) const override { return softmax(x); }
  /// max d_i (Rockafellar 1970, section 8).
  double recession(const Vector& d) const override { return d.maxCoeff(); }

  /// With L the logarithm at x, a = x - L solves d_i (z_i - L - a_i) = e^(a_i), the prox of e^a at z_i - L; L
  /// is where Σ e^(a_i) = 1. Between log Σ e^z - Σ 1/d and log Σ e^z, as x <= z.
  Vector level_parts(const Vector& z, const Vector& d, double& level, Vector& slope) const {
    Vector a(z.size());
    slope.resize(z.size());
    const auto parts = [&](double L) {
      double sum = 0, rate = 0;
      for (Index i = 0; i < z.size(); ++i) {
        const ScalarProx one = prox_formulas::prox_exponential(z[i] - L, d[i]);
        a[i] = one.x;
        slope[i] = one.slope;
        sum += std::exp(one.x);
        rate += std::exp(one.x) * one.slope;
      }
      return std::pair(1 - sum, rate);
    };
    const double high = log_sum(z), reach = d.cwiseInverse().maxCoeff();
    level = prox_formulas::increasing_root(parts, high - reach - unit_roundoff * std::abs(high), high,
                                           high - reach / 2);
    parts(level);
    return a;
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    double level = 0;
    Vector slope;
    const Vector a = level_parts(z, d, level, slope);
    const Vector p = softmax(a);
    return z - p.cwiseQuotient(d);
  }
  std::optional<Vector> prox_covector(const Vector& x, const Vector&, const Vector&) const override {
    return softmax(x);
  }
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    double level = 0;
    Vector slope;
    const Vector a = level_parts(z, d, level, slope), weight = softmax(a).cwiseProduct(slope);
    // In a multiple of the identity 1 - slope is weight/d.
    if (Jacobian::least_thin <= z.size() && d.maxCoeff() == d.minCoeff())
      return {slope, weight, Matrix::Constant(1, 1, 1 / (d[0] * weight.sum()))};
    Matrix J = (Vector::Ones(z.size()) - slope) * (weight / weight.sum()).transpose();
    J += slope.asDiagonal();
    return J;
  }
};

/// Σ v log v on the simplex.
struct EntropyOnSimplex final : Atom {
  Index dimension() const override { return 0; }
  void require_size(Index n) const override {
    if (n == 0) throw InvalidInput("conjugate(log_sum_exp): no entries; give at least one");
  }
  Facts facts() const override { return {}; }
  bool takes_any_diagonal() const override { return true; }
  Call call() const override {
    const Call simplex{"indicator", {argument(Call{"simplex", {argument("total", 1.0)}})}};
    return {"sum", {argument(Call{"entropy"}), argument(simplex)}};
  }
  Function conjugate() const override { return log_sum_exp(); }
  double domain_size() const override { return 1; }
  double value(const Vector& v) const override {
    const double tolerance = membership_tolerance * (1 + v.norm());
    if (v.minCoeff() < -tolerance || std::abs(v.sum() - 1) > tolerance) return infinity;
    double sum = 0;
    for (const double entry : v) sum += entry > 0 ? entry * std::log(entry) : 0;
    return sum;
  }
  Value evaluate(const Vector& v) const override {
    const double found = value(v);
    if (!std::isfinite(found)) return {found, 0};
    RunningSum total;
    double sizes = 0;
    for (const double entry : v) {
      total.add(entry);
      sizes += entry > 0 ? std::abs(entry * std::log(entry)) : 0;
    }
    total.add(-1);
    // Within the tolerance the point counts as one of the simplex, and what it may stand for is open.
    const Value member =
        indicated(std::max(std::abs(total.value()), std::max(0.0, -v.minCoeff())), 1 + v.norm());
    return {found, sum_of_terms(found, sizes + std::abs(found)).error + member.error};
  }
  std::optional<Vector> subgradient(const Vector& v) const override {
    if (std::isinf(value(v)) || !(v.minCoeff() > 0)) return std::nullopt;
    return v.array().log();
  }
  double domain_support(const Vector& v) const override { return v.maxCoeff(); }

  /// 1 + log v_i + d_i (v_i - z_i) = mu: the prox of v log v at z_i + mu/d_i, and mu where Σ v = 1.
  Vector parts(const Vector& z, const Vector& d, Vector& slope) const {
    Vector v(z.size());
    slope.resize(z.size());
    const auto at = [&](double mu) {
      double rate = 0;
      for (Index i = 0; i < z.size(); ++i) {
        const ScalarProx one = prox_formulas::prox_entropy(z[i] + mu / d[i], d[i]);
        v[i] = one.x;
        slope[i] = one.slope;
        rate += one.slope / d[i];
      }
      return std::pair(v.sum() - 1, rate);
    };
    // At the least mu_i = 1 + log v + d_i (v - z_i) for v = 1/n an entry has 1/n or less each; at the largest
    // of v = 1 some entry has all.
    const auto n = static_cast<double>(z.size());
    double low = infinity, high = infinity;
    for (Index i = 0; i < z.size(); ++i) {
      low = std::min(low, 1 - std::log(n) + d[i] * (1 / n - z[i]));
      high = std::min(high, 1 + d[i] * (1 - z[i]));
    }
    const double margin = unit_roundoff * (std::abs(low) + std::abs(high)) * 4;
    at(prox_formulas::increasing_root(at, low - margin, high + margin, low));
    return v;
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    Vector slope;
    const Vector v = parts(z, d, slope);
    return v / v.sum();
  }
  /// log v + c, c such that it is nearest to D(z - v); where v has underflowed, D(z - v) itself.
  std::optional<Vector> prox_covector(const Vector& v, const Vector& z, const Vector& d) const override {
    Vector covector = d.cwiseProduct(z - v);
    double gap = 0, weight = 0;
    for (Index i = 0; i < v.size(); ++i)
      if (v[i] > 0) {
        gap += (covector[i] - std::log(v[i])) * v[i];
        weight += v[i];
      }
    for (Index i = 0; i < v.size(); ++i)
      if (v[i] > 0) covector[i] = std::log(v[i]) + gap / weight;
    return covector;
  }
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    Vector slope;
    parts(z, d, slope);
    if (Jacobian::least_thin <= z.size() && d.maxCoeff() == d.minCoeff())
      return {slope, slope, Matrix::Constant(1, 1, -1 / slope.sum())};
    const Vector rate = slope.cwiseQuotient(d);
    Matrix J = -rate * slope.transpose() / rate.sum();
    J += slope.asDiagonal();
    return J;
  }
};

Function entropy_on_simplex() { return Function(std::make_shared<EntropyOnSimplex>()); }

}  // namespace

Function log_sum_exp() { return Function(std::make_shared<LogSumExp>()); }

}  // namespace convex::inline named_functions
