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
