#pragma once

#include <vector>

#include "convex/nearest_point/gallery/draw.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"

namespace convex::inline families {

/// A problem made from its answer: q, and for each row its multiplier and its slack, one of them 0. Then
/// s = Uq - slack and z = Aq - Uᵀlambda, exact as long as the numbers have few bits.
class PlantedRows {
 public:
  PlantedRows(Matrix A, Vector q) : A_(std::move(A)), q_(std::move(q)) {}

  const Vector& q() const { return q_; }
  Index count() const { return static_cast<Index>(rows_.size()); }
  const Vector& row(Index a) const { return rows_[at(a)]; }

  /// A row that holds (slack 0, lambda >= 0) or is apart (lambda 0, slack > 0).
  void add(const Vector& u, double lambda, double slack) {
    rows_.push_back(u);
    lambda_.push_back(lambda);
    slack_.push_back(slack);
  }

  /// `count` rows of small integers that are apart.
  void add_apart(Index count, Draw&);

  /// The problem, its rows in an order drawn by lot.
  GalleryInstance instance(Draw&) const;

 private:
  Matrix A_;
  Vector q_;
  std::vector<Vector> rows_;
  std::vector<double> lambda_, slack_;
};

/// BBᵀ + nI with entries of B in -2..2: n×n, integers, well conditioned.
Matrix integer_inertia(Index n, Draw&);

/// Nonzero, entries in -3..3.
Vector integer_row(Index n, Draw&);

}  // namespace convex::inline families
