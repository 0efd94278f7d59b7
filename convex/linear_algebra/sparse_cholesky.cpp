#include "convex/linear_algebra/sparse_cholesky.hpp"

#include <Eigen/SparseCholesky>

namespace convex::linear_algebra {

struct SparseCholesky::Factor {
  explicit Factor(const SparseMatrix& W) : LLT(W) {}
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> LLT;
};

SparseCholesky::SparseCholesky(const SparseMatrix& W) : factor_(std::make_unique<const Factor>(W)) {}

SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky::~SparseCholesky() = default;

bool SparseCholesky::is_definite() const { return factor_->LLT.info() == Eigen::Success; }

SparseMatrix SparseCholesky::L() const { return factor_->LLT.matrixL(); }

Vector SparseCholesky::diagonal() const { return SparseMatrix(factor_->LLT.matrixL()).diagonal(); }

Matrix SparseCholesky::permuted_columns(const Matrix& X) const { return factor_->LLT.permutationP() * X; }

Vector SparseCholesky::permuted(const Vector& x) const { return factor_->LLT.permutationP() * x; }

Vector SparseCholesky::permuted_back(const Vector& x) const { return factor_->LLT.permutationPinv() * x; }

Vector SparseCholesky::times_upper(const Vector& x) const { return factor_->LLT.matrixU() * x; }

void SparseCholesky::solve_lower_in_place(Matrix& X) const { factor_->LLT.matrixL().solveInPlace(X); }

void SparseCholesky::solve_upper_in_place(Vector& x) const { factor_->LLT.matrixU().solveInPlace(x); }

Vector SparseCholesky::solve(const Vector& b) const { return factor_->LLT.solve(b); }

struct SparseLdlt::Factor {
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> LDLT;
};

SparseLdlt::SparseLdlt() : factor_(std::make_unique<Factor>()) {}

SparseLdlt::~SparseLdlt() = default;

bool SparseLdlt::factor(const SparseMatrix& K) {
  factor_->LDLT.compute(K);
  return factor_->LDLT.info() == Eigen::Success;
}

Vector SparseLdlt::solve(const Vector& b) const { return factor_->LDLT.solve(b); }

}  // namespace convex::linear_algebra
