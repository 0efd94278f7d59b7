#include "mechanics/motion/held_rows.hpp"

#include <algorithm>

namespace mechanics::inline motions {
namespace {

/// Whitening rounds a row about so many times, for each coordinate.
constexpr double roundings_of_row = 8;

/// What is left of a vector beside what it is orthogonal to has lost a digit when it is this part of it.
constexpr double digit_lost = 0.1;

}  // namespace

HeldRows::HeldRows(const convex::Metric& A, const std::vector<Vector>& U)
    : A_(A), dimension_(A.dimension()), given_(static_cast<Index>(U.size())) {
  const Index most = std::min(dimension_, given_);
  Q_.resize(dimension_, most);
  R_ = convex::Matrix::Zero(most, most);
  const double rounding = roundings_of_row * static_cast<double>(dimension_) * convex::unit_roundoff;
  for (Index a = 0; a < given_ && count() < most; ++a) {
    const Index k = count();
    Vector w = A.whiten(U[static_cast<std::size_t>(a)]);
    const double length = w.norm();
    Vector along = Vector::Zero(k);
    for (int pass = 0; pass < 2; ++pass) {
      const Vector part = Q_.leftCols(k).transpose() * w;
      w -= Q_.leftCols(k) * part;
      along += part;
    }
    const double rest = w.norm();
    if (!(rest > rounding * A.factor_condition() * length)) continue;
    Q_.col(k) = w / rest;
    R_.col(k).head(k) = along;
    R_(k, k) = rest;
    independent_.push_back(a);
  }
}

HeldRows::Answer HeldRows::solve(const Vector& r, const Vector& s) const {
  const Index k = count();
  if (k == 0) return {A_.solve(r), Vector::Zero(given_)};
  const auto Q = Q_.leftCols(k);
  const auto R = R_.topLeftCorner(k, k);
  // With x = F⁻ᵀ w: w = F⁻¹ r + Q R lambda, Rᵀ Qᵀ w = s.
  Vector w = A_.whiten(r);
  Vector chosen(k);
  for (Index j = 0; j < k; ++j) chosen[j] = s[independent_[static_cast<std::size_t>(j)]];
  for (Index j = 0; j < k; ++j)  // Rᵀ y = s
    chosen[j] = (chosen[j] - R.col(j).head(j).dot(chosen.head(j))) / R(j, j);
  Vector step = chosen - Q.transpose() * w;
  const double before = w.norm();
  w += Q * step;
  // Where rows take up most of r, as those of a body at rest in a corner, its rounding is as much as what is
  // left: twice is enough (Kahan and Parlett, in Parlett 1980, 6.9).
  if (w.norm() <= digit_lost * before) {
    const Vector left = chosen - Q.transpose() * w;
    w += Q * left;
    step += left;
  }
  for (Index j = k; j-- > 0;) {  // R lambda = step
    for (Index l = j + 1; l < k; ++l) step[j] -= R(j, l) * step[l];
    step[j] /= R(j, j);
  }
  Answer answer{A_.unwhiten(w), Vector::Zero(given_)};
  for (Index j = 0; j < k; ++j) answer.lambda[independent_[static_cast<std::size_t>(j)]] = step[j];
  return answer;
}

}  // namespace mechanics::inline motions
