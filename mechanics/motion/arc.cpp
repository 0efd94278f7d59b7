#include "mechanics/motion/arc.hpp"

namespace mechanics::inline motions {
namespace {

/// Without the zeros at the end, of which a polynomial has many.
std::span<const double> trimmed(std::span<const double> c) {
  std::size_t count = c.size();
  while (count > 0 && c[count - 1] == 0) --count;
  return c.first(count);
}

}  // namespace

Vector Arc::position(double tau) const {
  Vector sum = Vector::Zero(q.rows());
  for (Index k = q.cols(); k-- > 0;) sum = sum * tau + q.col(k);
  return sum;
}

Vector Arc::velocity(double tau) const {
  Vector sum = Vector::Zero(q.rows());
  for (Index k = q.cols(); k-- > 1;) sum = sum * tau + static_cast<double>(k) * q.col(k);
  return sum;
}

namespace {

/// Beyond so many coefficients the sums of four of them each are taken by themselves.
constexpr std::size_t few_coefficients = 8;

/// Σ of weight(k) c_k τ^(k - from), k >= from, weights up to k²: by Horner's rule in τ⁴.
template <class Weight>
double long_sum(std::span<const double> c, std::size_t from, double tau, double fourth, Weight weight) {
  constexpr std::size_t sums = 4;
  double sum[sums] = {};
  const std::size_t count = c.size() - from, end = count / sums * sums;
  for (std::size_t k = count; k-- > end;) sum[k - end] = weight(k + from) * c[k + from];
  for (std::size_t first = end; first > 0; first -= sums)
    for (std::size_t i = 0; i < sums; ++i) {
      const std::size_t k = first - sums + i + from;
      sum[i] = sum[i] * fourth + weight(k) * c[k];
    }
  return sum[0] + tau * (sum[1] + tau * (sum[2] + tau * sum[3]));
}

double as_number(std::size_t k) { return static_cast<double>(k); }

}  // namespace

void Arc::state(double tau, State& at) const {
  const Index n = q.rows();
  at.t = t + tau;
  at.q.resize(n);
  at.v.resize(n);
  const double fourth = tau * tau * tau * tau;
  for (Index i = 0; i < n; ++i) {
    const std::span<const double> c = trimmed(coefficients(q, i));
    if (c.size() > few_coefficients) {
      at.q[i] = c[0] + tau * (c[1] + tau * long_sum(c, 2, tau, fourth, [](std::size_t) { return 1.0; }));
      at.v[i] = c[1] + tau * long_sum(c, 2, tau, fourth, as_number);
      continue;
    }
    double value = 0, slope = 0;
    for (std::size_t k = c.size(); k-- > 0;) {
      slope = slope * tau + value;
      value = value * tau + c[k];
    }
    at.q[i] = value;
    at.v[i] = slope;
  }
}

State Arc::state(double tau) const {
  State at;
  state(tau, at);
  return at;
}

Vector Arc::acceleration(double tau) const {
  Vector q2;
  acceleration(tau, q2);
  return q2;
}

void Arc::acceleration(double tau, Vector& q2) const {
  q2.setZero(q.rows());
  const double fourth = tau * tau * tau * tau;
  for (Index i = 0; i < q2.size(); ++i)
    if (const std::span<const double> c = trimmed(coefficients(q, i)); c.size() > 2)
      q2[i] = long_sum(c, 2, tau, fourth, [](std::size_t k) { return as_number(k * (k - 1)); });
}

Vector Arc::multipliers(double tau) const {
  Vector sum = Vector::Zero(lambda.rows());
  for (Index k = lambda.cols(); k-- > 0;) sum = sum * tau + lambda.col(k);
  return sum;
}

}  // namespace mechanics::inline motions
