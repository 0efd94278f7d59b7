#include "mechanics/row_space.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics {
namespace {

/// Roundings of the products and sums of an expansion, relative to the lengths of the rows in it.
double rounding_of_expansion(Index kept, Index columns) {
  return 8 * 0x1p-53 * (static_cast<double>(kept) + std::sqrt(static_cast<double>(columns)) + 1);
}

}  // namespace

RowSpace::Expansion RowSpace::expansion(const Vector& row, double radius) const {
  const Index kept = size();
  Expansion found{Vector::Zero(kept), Vector::Zero(kept), row, 0};
  for (int pass = 0; pass < 2; ++pass)  // twice is enough (Kahan; Parlett 1980, section 6.9)
    for (Index p = 0; p < kept; ++p) {
      const double along = basis_[static_cast<std::size_t>(p)].dot(found.rest);
      if (along == 0) continue;
      found.rest -= along * basis_[static_cast<std::size_t>(p)];
      found.coefficients.head(p + 1) += along * by_rows_[static_cast<std::size_t>(p)];
    }
  const double part = rounding_of_expansion(kept, columns_);
  found.bound = radius + part * row.norm();
  for (Index j = 0; j < kept; ++j) {
    const auto row_j = static_cast<std::size_t>(j);
    found.bound += std::abs(found.coefficients[j]) * (radii_[row_j] + part * lengths_[row_j]);
  }
  // A row that is off by a vector of the length `bound` has coefficients that are off by its parts along the
  // basis.
  for (Index p = 0; p < kept; ++p)
    found.radius.head(p + 1) += found.bound * by_rows_[static_cast<std::size_t>(p)].cwiseAbs();
  return found;
}

void RowSpace::keep(const Vector& row, double radius, const Expansion& of_row) {
  const double length = of_row.rest.norm();
  Vector by_rows(size() + 1);
  by_rows.head(size()) = -of_row.coefficients / length;
  by_rows[size()] = 1 / length;
  basis_.push_back(of_row.rest / length);
  by_rows_.push_back(std::move(by_rows));
  radii_.push_back(radius);
  lengths_.push_back(row.norm());
}

Vector RowSpace::off_span(Vector x) const {
  for (int pass = 0; pass < 2; ++pass)
    for (const Vector& direction : basis_) x -= direction.dot(x) * direction;
  return x;
}

SplitRows split_rows(const RowMatrix& rows, const Vector& radius, RowSpace& space) {
  SplitRows found;
  const Index m = rows.rows();
  RowMatrix rest = rows;  // for the choice of the next row alone
  for (Index a = 0; a < m; ++a) rest.row(a) = space.off_span(rows.row(a).transpose()).transpose();
  std::vector<Index> open;
  for (Index a = 0; a < m; ++a) open.push_back(a);
  const auto certainty = [&](Index a) {
    const double length = rest.row(a).norm();
    return length > 0 ? length / (radius[a] + 0x1p-53 * rows.row(a).norm()) : 0.0;
  };
  while (!open.empty()) {
    const auto next = std::max_element(open.begin(), open.end(),
                                       [&](Index a, Index b) { return certainty(a) < certainty(b); });
    const Index a = *next;
    open.erase(next);
    const Vector row = rows.row(a).transpose();
    const RowSpace::Expansion expansion = space.expansion(row, radius[a]);
    if (!expansion.is_independent()) {
      found.dependent.push_back(a);
      continue;
    }
    space.keep(row, radius[a], expansion);
    found.kept.push_back(a);
    const Vector direction = expansion.rest.normalized();
    for (const Index b : open) rest.row(b) -= rest.row(b).dot(direction.transpose()) * direction.transpose();
  }
  std::sort(found.dependent.begin(), found.dependent.end());
  for (const Index a : found.dependent)
    found.expansions.push_back(space.expansion(rows.row(a).transpose(), radius[a]));
  return found;
}

}  // namespace mechanics
