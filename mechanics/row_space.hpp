#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace mechanics {

using convex::Index;
using convex::Matrix;
using convex::RowMatrix;
using convex::Vector;

/// Rows with radii that are independent whatever numbers within the radii are meant, with an orthonormal
/// basis of their span. All lengths are plain: the caller scales the columns to common units.
class RowSpace {
 public:
  explicit RowSpace(Index columns) : columns_(columns) {}

  /// What a row is over the rows kept: row = Σ coefficients_j row_j + rest.
  struct Expansion {
    Vector coefficients, radius;  ///< one per row kept, and how far each may be off
    Vector rest;
    double bound = 0;  ///< the radii and rounding may make the rest as long as this
    bool is_independent() const { return rest.norm() > bound; }
  };
  Expansion expansion(const Vector& row, double radius) const;

  /// Takes an independent row in.
  void keep(const Vector& row, double radius, const Expansion& of_row);

  Index size() const { return static_cast<Index>(radii_.size()); }
  Index columns() const { return columns_; }
  /// x without its part in the span.
  Vector off_span(Vector x) const;

 private:
  Index columns_;
  std::vector<Vector> basis_, by_rows_;  // orthonormal rows, and each as a combination of the rows kept
  std::vector<double> radii_, lengths_;  // of the rows kept
};

/// Rows split into independent ones, taken into the space in the order of `kept`, and the others with their
/// expansions. `radius`: of each row, as a length.
struct SplitRows {
  std::vector<Index> kept, dependent;
  std::vector<RowSpace::Expansion> expansions;  ///< of the dependent ones, over all rows of the space
};
SplitRows split_rows(const RowMatrix& rows, const Vector& radius, RowSpace& space);

}  // namespace mechanics
