#pragma once

#include "convex/vector.hpp"

/// The loops inside Eigen's products of matrices of doubles, compiled once, in compiled_products.cpp; else
/// every file with a product compiles them. For our own targets alone, through their precompiled headers: who
/// links the library may compile for another processor. The names are those of Eigen 3.4; of another version
/// nothing is declared, and each file compiles what it needs.
#if EIGEN_VERSION_AT_LEAST(3, 4, 0) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)

namespace convex::linear_algebra {

using ProductTraits = Eigen::internal::gebp_traits<double, double>;
template <int order>
using ReadMatrix = Eigen::internal::const_blas_data_mapper<double, Index, order>;
using WriteMatrix = Eigen::internal::blas_data_mapper<double, Index, Eigen::ColMajor, Eigen::Unaligned, 1>;

}  // namespace convex::linear_algebra

#define MOREAU_PRODUCTS_OF(instantiate, order)                                                             \
  instantiate struct Eigen::internal::gemm_pack_lhs<                                                       \
      double, Eigen::Index, convex::linear_algebra::ReadMatrix<order>,                                     \
      convex::linear_algebra::ProductTraits::mr, convex::linear_algebra::ProductTraits::LhsProgress,       \
      convex::linear_algebra::ProductTraits::LhsPacket4Packing, order, false, false>;                      \
  instantiate struct Eigen::internal::gemm_pack_rhs<                                                       \
      double, Eigen::Index, convex::linear_algebra::ReadMatrix<order>,                                     \
      convex::linear_algebra::ProductTraits::nr, order, false, false>;                                     \
  instantiate struct Eigen::internal::general_matrix_matrix_product<Eigen::Index, double, order, false,    \
                                                                    double, 0, false, Eigen::ColMajor, 1>; \
  instantiate struct Eigen::internal::general_matrix_matrix_product<Eigen::Index, double, order, false,    \
                                                                    double, 1, false, Eigen::ColMajor, 1>; \
  instantiate struct Eigen::internal::general_matrix_vector_product<                                       \
      Eigen::Index, double, convex::linear_algebra::ReadMatrix<order>, order, false, double,               \
      convex::linear_algebra::ReadMatrix<1 - order>, false, 0>;

/// With the orders of storage 0, by columns, and 1, by rows.
#define MOREAU_PRODUCTS(instantiate)                                                                       \
  instantiate struct Eigen::internal::gebp_kernel<                                                         \
      double, double, Eigen::Index, convex::linear_algebra::WriteMatrix,                                   \
      convex::linear_algebra::ProductTraits::mr, convex::linear_algebra::ProductTraits::nr, false, false>; \
  instantiate struct Eigen::internal::general_matrix_vector_product<                                       \
      Eigen::Index, double, convex::linear_algebra::ReadMatrix<0>, 0, false, double,                       \
      convex::linear_algebra::ReadMatrix<0>, false, 0>;                                                    \
  MOREAU_PRODUCTS_OF(instantiate, 0)                                                                       \
  MOREAU_PRODUCTS_OF(instantiate, 1)

MOREAU_PRODUCTS(extern template)

#endif
