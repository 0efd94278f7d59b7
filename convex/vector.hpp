#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>

/// Vectors, matrices and their index, for every room. All numbers are doubles.
namespace convex {

using Index = Eigen::Index;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using SparseMatrix = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The place i in a container of the standard library.
inline std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Unit roundoff of a double: the relative error of one rounding to nearest (2^-53).
inline constexpr double unit_roundoff = 0x1p-53;

}  // namespace convex
