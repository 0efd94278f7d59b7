#include "convex/composite/jacobian.hpp"

namespace convex::inline composite {

Jacobian::operator Matrix() const {
  if (!is_thin_) return full_;
  Matrix J = a_.asDiagonal();
  if (U_.cols() > 0) J += U_ * C_ * U_.transpose();
  return J;
}

Vector Jacobian::diagonal() const {
  if (!is_thin_) return full_.diagonal();
  if (U_.cols() == 0) return a_;
  return a_ + (U_ * C_).cwiseProduct(U_).rowwise().sum();
}

Vector Jacobian::operator*(const Vector& v) const {
  if (!is_thin_) return full_ * v;
  Vector image = a_.cwiseProduct(v);
  if (U_.cols() > 0) image += U_ * (C_ * (U_.transpose() * v));
  return image;
}

Jacobian Jacobian::of_conjugate(const Vector& d) const {
  const bool commutes = d.size() == 0 || d.maxCoeff() == d.minCoeff();
  if (is_thin_ && (commutes || U_.cols() == 0)) return {Vector(1 - a_.array()), U_, -C_};
  Matrix rest = -(d.cwiseInverse().asDiagonal() * Matrix(*this) * d.asDiagonal());
  rest.diagonal().array() += 1;
  return rest;
}

Jacobian Jacobian::bordered(const Vector& m, const Eigen::Matrix2d& B) const {
  const Index n = m.size();
  if (is_thin_) {
    const Index r = U_.cols();
    Vector a(n + 1);
    a << a_, 0;
    Matrix U = Matrix::Zero(n + 1, r + 2), C = Matrix::Zero(r + 2, r + 2);
    U.topLeftCorner(n, r) = U_;
    U.col(r).head(n) = m;
    U(n, r + 1) = 1;
    C.topLeftCorner(r, r) = C_;
    C.bottomRightCorner(2, 2) = B;
    return {std::move(a), std::move(U), std::move(C)};
  }
  Matrix J(n + 1, n + 1);
  J.topLeftCorner(n, n) = full_ + B(0, 0) * m * m.transpose();
  J.topRightCorner(n, 1) = B(0, 1) * m;
  J.bottomLeftCorner(1, n) = B(0, 1) * m.transpose();
  J(n, n) = B(1, 1);
  return J;
}

}  // namespace convex::inline composite
