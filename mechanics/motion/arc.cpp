#include "mechanics/motion/arc.hpp"

namespace mechanics {

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
    const std::span<const double> c = coefficients(q, i);
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
  Vector sum = Vector::Zero(q.rows());
  for (Index k = q.cols(); k-- > 2;) sum = sum * tau + static_cast<double>(k * (k - 1)) * q.col(k);
  return sum;
}

Vector Arc::multipliers(double tau) const {
  Vector sum = Vector::Zero(lambda.rows());
  for (Index k = lambda.cols(); k-- > 0;) sum = sum * tau + lambda.col(k);
  return sum;
}

}  // namespace mechanics
