#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/composite/atom.hpp"
#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::inline named_functions {

/// A closed interval.
struct Ends {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  /// sup of v t over the t between.
  double support(double v) const { return v == 0 ? 0 : v * (v > 0 ? high : low); }
};

/// What the laws of sums of any number of entries have in common.
struct AnySize {
  Index dimension() const { return 0; }
};

/// Σ_i f_i(x_i) with smooth f_i given by a law:
///   Call call() const; Function conjugate() const; Index dimension() const (0: any);
///   bool finite() const;                            f_i is finite everywhere
///   double value(double x, Index i) const;          +inf outside the domain
///   double terms(double x, Index i) const;          where terms of f_i(x) may cancel: the sum of their sizes
///   double slope(double x, Index i) const;          f_i'(x); -inf left of the domain, +inf right of it
///   prox_formulas::ScalarProx prox(double z, double d, Index i) const;
///   Ends ends(Index i) const;                       the points that count as inside up to the tolerance
///   Ends domain(Index i) const;                     the closure of the domain
///   Ends slopes(Index i) const;                     the closure of the slopes, the conjugate's domain
template <class Law>
class ScalarSum : public Atom {
 public:
  explicit ScalarSum(Law law) : law_(std::move(law)) {}
  Index dimension() const override { return law_.dimension(); }
  Facts facts() const override {
    return {.separable = true, .smooth = law_.smooth(), .finite = law_.finite()};
  }
  Call call() const override { return law_.call(); }
  Function conjugate() const override { return law_.conjugate(); }
  std::optional<Value> constant_beside_entries() const override { return Value{}; }

  double domain_size() const override {
    double size = 0;
    for (Index i = 0; i < std::max<Index>(1, dimension()); ++i) {
      const auto [low, high] = law_.ends(i);
      for (const double end : {low, high})
        if (std::isfinite(end)) size = std::max(size, std::abs(end));
    }
    return size;
  }

  double value(const Vector& x) const override { return sum_of_entries(x).value; }

  /// Inside of the domain +inf is a number beyond all doubles.
  Value evaluate(const Vector& x) const override {
    Value found = sum_of_entries(x);
    bool is_inside = found.value == std::numeric_limits<double>::infinity();
    for (Index i = 0; i < x.size() && is_inside; ++i) {
      const auto [low, high] = law_.domain(i);
      is_inside = low < x[i] && x[i] < high;
    }
    if (is_inside) found.error = found.value;
    return found;
  }

  std::optional<Vector> subgradient(const Vector& x) const override {
    const double allowance = membership_tolerance * x.cwiseAbs().maxCoeff();
    Vector v(x.size());
    for (Index i = 0; i < x.size(); ++i) v[i] = law_.slope(inside(x[i], allowance, i), i);
    if (!v.allFinite()) return std::nullopt;
    return v;
  }

  double recession(const Vector& d) const override {
    double sum = 0;
    for (Index i = 0; i < d.size(); ++i) sum += law_.slopes(i).support(d[i]);
    return sum;
  }
  double domain_support(const Vector& v) const override {
    double sum = 0;
    for (Index i = 0; i < v.size(); ++i) sum += law_.domain(i).support(v[i]);
    return sum;
  }

  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    Vector x(z.size());
    for (Index i = 0; i < z.size(); ++i) x[i] = law_.prox(z[i], d[i], i).x;
    return x;
  }

  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    Vector slope(z.size());
    for (Index i = 0; i < z.size(); ++i) slope[i] = law_.prox(z[i], d[i], i).slope;
    return slope.asDiagonal();
  }

  /// The slope nearest to the covector among those within the rounding of x, which the bound counts by
  /// itself: near the ends of a domain the slope at the rounded x may be far from that at x.
  std::optional<Vector> prox_covector(const Vector& x, const Vector& z, const Vector& d) const override {
    Vector v(x.size());
    for (Index i = 0; i < x.size(); ++i) {
      const double rounding =
          std::max(roundings_of_x * unit_roundoff * std::abs(x[i]), std::numeric_limits<double>::min());
      const double covector = d[i] * (z[i] - x[i]);
      v[i] = std::max(law_.slope(x[i] - rounding, i), std::min(covector, law_.slope(x[i] + rounding, i)));
    }
    return v;
  }

 private:
  static constexpr double roundings_of_x = 4, roundings_of_a_term = 4;

  /// Entries of both signs may cancel: the rounding is relative to their sizes. Where an entry is off the
  /// domain for sure, what others near its edge leave open does not count.
  Value sum_of_entries(const Vector& x) const {
    const double allowance = membership_tolerance * x.cwiseAbs().maxCoeff();
    double sum = 0, size = 0, doubt = 0;
    for (Index i = 0; i < x.size(); ++i) {
      const double at = inside(x[i], allowance, i), part = law_.value(at, i);
      if (const auto [low, high] = law_.domain(i); at == x[i] && (at < low || at > high))
        return {std::numeric_limits<double>::infinity(), 0};
      sum += part;
      if constexpr (requires { law_.terms(at, i); })
        size += law_.terms(at, i);
      else
        size += std::abs(part);
      doubt += indicated(std::abs(at - x[i]), allowance / membership_tolerance).error;
    }
    return {sum, doubt + (std::isfinite(sum) ? roundings_of_a_term * unit_roundoff * size : 0)};
  }

  /// x, moved to the end of the domain that it misses by no more than `allowance`.
  double inside(double x, double allowance, Index i) const {
    const auto [low, high] = law_.ends(i);
    const double nearest = std::clamp(x, low, high);
    return std::abs(nearest - x) <= allowance ? nearest : x;
  }
  Law law_;
};

template <class Law>
Function scalar_sum(Law law) {
  return Function(std::make_shared<ScalarSum<Law>>(std::move(law)));
}

}  // namespace convex::inline named_functions
