#pragma once

#include <variant>
#include <vector>

#include "convex/double_double.hpp"
#include "convex/vector.hpp"

namespace convex {

/// The rows u_a of U (m×n), dense or sparse: each a covector.
class ConstraintRows {
 public:
  ConstraintRows() : rows_(RowMatrix(0, 0)) {}
  explicit ConstraintRows(RowMatrix U) : rows_(std::move(U)) {}
  explicit ConstraintRows(const SparseRows& U) : rows_(U) {}
  explicit ConstraintRows(SparseRows&& U) : rows_(std::in_place_type<SparseRows>) {
    std::get<SparseRows>(rows_).swap(U);  // Eigen 3.4 would make a copy of what is moved
  }

  Index count() const;
  Index dimension() const;
  bool is_sparse() const { return std::holds_alternative<SparseRows>(rows_); }
  const RowMatrix& dense() const { return std::get<RowMatrix>(rows_); }
  const SparseRows& sparse() const { return std::get<SparseRows>(rows_); }

  bool is_finite() const;

  /// u_a as a dense vector of size n.
  Vector row(Index a) const;
  void copy_row(Index a, Eigen::Ref<Vector> into) const;
  /// visit(i, u_ai) for the entries of u_a that are not 0, in order.
  template <class Visit>
  void for_each_entry(Index a, Visit visit) const {
    if (is_sparse()) {
      for (SparseRows::InnerIterator it(sparse(), a); it; ++it)
        if (it.value() != 0) visit(Index{it.col()}, it.value());
    } else {
      for (Index i = 0; i < dimension(); ++i)
        if (dense()(a, i) != 0) visit(i, dense()(a, i));
    }
  }
  /// U x: m.
  Vector times(const Vector& x) const;
  void times(const Vector& x, Vector& into) const;
  /// Uᵀ lambda: n.
  Vector transpose_times(const Vector& lambda) const;
  /// u_a·x in twice the working precision.
  DoubleDouble dot(Index a, const DoubleDoubleVector& x) const;
  /// sum += c u_a in twice the working precision.
  void add_multiple(Index a, DoubleDouble c, DoubleDoubleVector& sum) const;
  /// Σ_i |u_ai| weight_i.
  double absolute_dot(Index a, const Vector& weight) const;
  /// sqrt(Σ_i u_ai² weight_i) of every row: m.
  Vector lengths(const Vector& weight) const;
  /// The rows chosen, in that order.
  ConstraintRows select(const std::vector<Index>& rows) const;

 private:
  std::variant<RowMatrix, SparseRows> rows_;
};

}  // namespace convex
