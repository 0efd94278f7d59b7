#include "convex/linear_algebra/compiled_products.hpp"

#ifdef MOREAU_PRODUCTS

MOREAU_PRODUCTS(template)

template void Eigen::internal::assign_sparse_to_sparse(convex::SparseMatrix&, const convex::SparseMatrix&);
template void Eigen::internal::assign_sparse_to_sparse(convex::SparseRows&, const convex::SparseRows&);

namespace Eigen::internal {
namespace {

/// Eigen's own rule: entry by entry where packing the factors would cost more.
bool is_small(const MatrixXd& X, Index inner) {
  return inner > 0 && inner + X.rows() + X.cols() < EIGEN_GEMM_TO_COEFFBASED_THRESHOLD;
}

}  // namespace

#define MOREAU_MATRIX_PRODUCT(Lhs, Rhs)                                                                      \
  template <>                                                                                                \
  template <>                                                                                                \
  void generic_product_impl<Lhs, Rhs, DenseShape, DenseShape, GemmProduct>::evalTo(                          \
      MatrixXd& X, const Lhs& A, const Rhs& B) {                                                             \
    if (is_small(X, B.rows())) return lazyproduct::eval_dynamic(X, A, B, assign_op<double, double>());       \
    X.setZero();                                                                                             \
    scaleAndAddTo(X, A, B, 1.0);                                                                             \
  }                                                                                                          \
  template <>                                                                                                \
  template <>                                                                                                \
  void generic_product_impl<Lhs, Rhs, DenseShape, DenseShape, GemmProduct>::addTo(MatrixXd& X, const Lhs& A, \
                                                                                  const Rhs& B) {            \
    if (is_small(X, B.rows())) return lazyproduct::eval_dynamic(X, A, B, add_assign_op<double, double>());   \
    scaleAndAddTo(X, A, B, 1.0);                                                                             \
  }                                                                                                          \
  template <>                                                                                                \
  template <>                                                                                                \
  void generic_product_impl<Lhs, Rhs, DenseShape, DenseShape, GemmProduct>::subTo(MatrixXd& X, const Lhs& A, \
                                                                                  const Rhs& B) {            \
    if (is_small(X, B.rows())) return lazyproduct::eval_dynamic(X, A, B, sub_assign_op<double, double>());   \
    scaleAndAddTo(X, A, B, -1.0);                                                                            \
  }

#define MOREAU_VECTOR_PRODUCT(Lhs)                                                                     \
  template <>                                                                                          \
  template <>                                                                                          \
  void generic_product_impl<Lhs, VectorXd, DenseShape, DenseShape, GemvProduct>::scaleAndAddTo(        \
      VectorXd& y, const Lhs& A, const VectorXd& x, const double& alpha) {                             \
    if (A.rows() == 1) {                                                                               \
      y[0] += alpha * A.row(0).dot(x);                                                                 \
      return;                                                                                          \
    }                                                                                                  \
    gemv_dense_selector<OnTheRight, (int(Lhs::Flags) & RowMajorBit) ? RowMajor : ColMajor, true>::run( \
        A, x, y, alpha);                                                                               \
  }

MOREAU_MATRIX_PRODUCT(MatrixXd, MatrixXd)
MOREAU_MATRIX_PRODUCT(MatrixXd, convex::linear_algebra::Transposed)
MOREAU_MATRIX_PRODUCT(MatrixXd, convex::linear_algebra::ConstTransposed)
MOREAU_MATRIX_PRODUCT(convex::linear_algebra::Transposed, MatrixXd)
MOREAU_MATRIX_PRODUCT(convex::linear_algebra::ConstTransposed, MatrixXd)
MOREAU_VECTOR_PRODUCT(MatrixXd)
MOREAU_VECTOR_PRODUCT(convex::linear_algebra::Transposed)
MOREAU_VECTOR_PRODUCT(convex::linear_algebra::ConstTransposed)

}  // namespace Eigen::internal

#endif
