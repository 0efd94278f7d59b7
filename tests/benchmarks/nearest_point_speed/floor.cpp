#include "floor.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace speed {
namespace {

Matrix whitened(const Eigen::LLT<Matrix>& factor, const DenseProblem& problem,
                const std::vector<Index>& rows) {
  Matrix V(problem.z.size(), static_cast<Index>(rows.size()));
  for (Index k = 0; k < V.cols(); ++k) V.col(k) = problem.U.row(rows[static_cast<std::size_t>(k)]);
  factor.matrixL().solveInPlace(V);
  return V;
}

Matrix gram_matrix(const Matrix& V) {
  Matrix gram = Matrix::Zero(V.cols(), V.cols());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(V.transpose());
  return gram;
}

}  // namespace

Floor::Floor(const DenseProblem& problem, const Truth& truth)
    : problem_(problem), rows_(truth.rows), feasible_(truth.feasible) {
  if (!feasible_) return;
  const Matrix gram = gram_matrix(whitened(Eigen::LLT<Matrix>(problem.A), problem, rows_));
  orthogonal_ = Eigen::LLT<Matrix>(gram).info() != Eigen::Success;
}

double Floor::run() const { return feasible_ ? point() : contradiction(); }

double Floor::point() const {
  const Eigen::LLT<Matrix> factor(problem_.A);
  const Matrix V = whitened(factor, problem_, rows_);
  Vector y = factor.matrixL().solve(problem_.z);
  if (const Index held = V.cols(); held > 0) {
    Vector missing = problem_.s(rows_) - V.transpose() * y;
    if (orthogonal_) {
      const Eigen::HouseholderQR<Matrix> qr(V);
      Vector turned = Vector::Zero(y.size());
      turned.head(held) =
          qr.matrixQR().topRows(held).triangularView<Eigen::Upper>().transpose().solve(missing);
      y += qr.householderQ() * turned;
    } else {
      gram_matrix(V).selfadjointView<Eigen::Lower>().llt().solveInPlace(missing);
      y += V * missing;
    }
  }
  const Vector q = factor.matrixU().solve(y);
  return (problem_.s - problem_.U * q).maxCoeff();
}

double Floor::contradiction() const {
  const Eigen::LLT<Matrix> factor(problem_.A);
  const Matrix gram = gram_matrix(whitened(factor, problem_, rows_));
  const Index others = gram.rows() - 1;
  Vector weights = gram.row(others).head(others).transpose();
  gram.topLeftCorner(others, others).selfadjointView<Eigen::Lower>().llt().solveInPlace(weights);
  return weights.minCoeff();
}

}  // namespace speed
