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

void Arc::state(double tau, State& at) const {
  const Index n = q.rows();
  at.t = t + tau;
  at.q.resize(n);
  at.v.resize(n);
  for (Index i = 0; i < n; ++i) {
    const std::span<const double> c = trimmed(coefficients(q, i));
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
  Vector q2(q.rows());
  for (Index i = 0; i < q2.size(); ++i) {
    const std::span<const double> c = trimmed(coefficients(q, i));
    double sum = 0;
    for (std::size_t k = c.size(); k-- > 2;) sum = sum * tau + static_cast<double>(k * (k - 1)) * c[k];
    q2[i] = sum;
  }
  return q2;
}

Vector Arc::multipliers(double tau) const {
  Vector sum = Vector::Zero(lambda.rows());
  for (Index k = lambda.cols(); k-- > 0;) sum = sum * tau + lambda.col(k);
  return sum;
}

}  // namespace mechanics::inline motions
