#include "convex/prox_formulas/nuclear_norm.hpp"

#include <string>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_algebra/singular_values.hpp"

namespace convex::prox_formulas {

namespace {

using linear_algebra::SingularValues;

void require_weight(double size, const char* name) {
  if (!(size >= 0))
    throw InvalidInput(std::string(name) + " is " + std::to_string(size) +
                       "; give a number that is not negative");
}

/// U diag(w) Vᵀ over the leading columns with w > 0.
Matrix composed(const SingularValues& s, const Vector& w) {
  const Index rank = (w.array() > 0).count();
  return s.U.leftCols(rank) * w.head(rank).asDiagonal() * s.V.leftCols(rank).transpose();
}

}  // namespace

Matrix NuclearNormProx::derivative(const Matrix& H) const {
  const Index k = sigma.size();
  const Vector phi = (sigma.array() - weight).max(0.0);
  const auto grows = [&](Index i) { return sigma[i] > weight || !(weight > 0); };
  Vector ratio(k);
  for (Index i = 0; i < k; ++i) ratio[i] = sigma[i] > 0 ? phi[i] / sigma[i] : grows(i) ? 1 : 0;
  const Matrix M = U.transpose() * H * V;
  Matrix inner(k, k);
  for (Index i = 0; i < k; ++i)
    for (Index j = 0; j < k; ++j) {
      // Both above the threshold or both below it, the difference quotient is 1 or 0.
      const double difference = grows(i) == grows(j)
                                    ? (grows(i) ? 1.0 : 0.0)
                                    : std::abs(phi[i] - phi[j]) / std::abs(sigma[i] - sigma[j]);
      const double sum = sigma[i] + sigma[j], mean = sum > 0 ? (phi[i] + phi[j]) / sum : ratio[i];
      inner(i, j) = difference * (M(i, j) + M(j, i)) / 2 + mean * (M(i, j) - M(j, i)) / 2;
    }
  const Matrix HV = H * V, UH = U.transpose() * H;
  return U * inner * V.transpose() + (HV - U * M) * ratio.asDiagonal() * V.transpose() +
         U * ratio.asDiagonal() * (UH - M * V.transpose());
}

Matrix NuclearNormProx::jacobian() const {
  const Index size = X.size();
  Matrix J(size, size);
  for (Index i = 0; i < size; ++i) {
    Matrix H = Matrix::Zero(X.rows(), X.cols());
    H.data()[i] = 1;
    const Matrix column = derivative(H);
    J.col(i) = Eigen::Map<const Vector>(column.data(), size);
  }
  return 0.5 * J + 0.5 * J.transpose();
}

NuclearNormProx nuclear_norm_prox(const Matrix& Z, double weight) {
  require_weight(weight, "nuclear_norm: the weight");
  const SingularValues s(Z);
  const Vector phi = (s.sigma.array() - weight).max(0.0);
  return {weight > 0 ? composed(s, phi) : Z, s.U, s.V, s.sigma, weight};
}

Matrix proj_spectral_ball(const Matrix& Z, double radius) {
  require_weight(radius, "spectral ball: the radius");
  const SingularValues s(Z);
  if (s.sigma.size() == 0 || s.sigma[0] <= radius) return Z;
  return composed(s, s.sigma.cwiseMin(radius));
}

Vector prox_nuclear_norm(const Vector& z, double weight, Index rows) {
  if (rows < 1 || z.size() % rows != 0)
    throw InvalidInput("nuclear_norm: no matrix of " + counted(rows, "row", "rows") + " has " +
                       counted(z.size(), "entry", "entries") + "; give a multiple");
  const Matrix X = nuclear_norm_prox(Eigen::Map<const Matrix>(z.data(), rows, z.size() / rows), weight).X;
  return Eigen::Map<const Vector>(X.data(), X.size());
}

}  // namespace convex::prox_formulas
