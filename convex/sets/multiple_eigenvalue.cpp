#include "convex/sets/multiple_eigenvalue.hpp"

#include "convex/exact/fraction_arithmetic.hpp"

namespace convex::inline sets::subgradients {
namespace {

/// Coefficients, the constant first; the last one is not 0.
using Polynomial = std::vector<Fraction>;

void cut_zeros(Polynomial& p) {
  while (!p.empty() && sign(p.back()) == 0) p.pop_back();
}

Polynomial characteristic(const IntegerRows& X) {
  const std::size_t n = X.size();
  Polynomial p(n + 1);
  p[n] = Fraction{1};
  IntegerRows M(n, IntegerVector(n));
  for (std::size_t i = 0; i < n; ++i) M[i][i] = 1;
  for (std::size_t k = 1; k <= n; ++k) {
    IntegerRows product(n, IntegerVector(n));
    Integer trace = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t l = 0; l < n; ++l) product[i][j] += X[i][l] * M[l][j];
      trace += product[i][i];
    }
    const Integer c = -truncated_quotient(trace, Integer{static_cast<std::int64_t>(k)});  // without a rest
    p[n - k] = Fraction{c};
    M = std::move(product);
    for (std::size_t i = 0; i < n; ++i) M[i][i] += c;
  }
  return p;
}

Polynomial derivative_of(const Polynomial& p) {
  Polynomial d;
  for (std::size_t k = 1; k < p.size(); ++k) d.push_back(p[k] * Fraction{static_cast<std::int64_t>(k)});
  return d;
}

/// The greatest common divisor by Euclid's algorithm, its leading coefficient 1.
Polynomial common_divisor(Polynomial a, Polynomial b) {
  cut_zeros(a);
  cut_zeros(b);
  while (!b.empty()) {
    while (a.size() >= b.size()) {
      const Fraction factor = a.back() / b.back();
      const std::size_t shift = a.size() - b.size();
      for (std::size_t k = 0; k < b.size(); ++k) a[k + shift] = a[k + shift] - factor * b[k];
      a.back() = Fraction{};
      cut_zeros(a);
    }
    std::swap(a, b);
  }
  const Fraction leading = a.back();
  for (Fraction& c : a) c = c / leading;
  return a;
}

int sign_at(const Polynomial& p, const Fraction& x) {
  Fraction value;
  for (std::size_t k = p.size(); k-- > 0;) value = value * x + p[k];
  return sign(value);
}

}  // namespace

bool is_multiple_eigenvalue(const IntegerRows& X, Index many, const Fraction& low, const Fraction& high) {
  Polynomial p = characteristic(X);
  for (Index k = 1; k < many && p.size() > 1; ++k) p = common_divisor(p, derivative_of(p));
  return p.size() > 1 && sign_at(p, low) * sign_at(p, high) < 0;
}

}  // namespace convex::inline sets::subgradients
