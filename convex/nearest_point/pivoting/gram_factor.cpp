#include "convex/nearest_point/pivoting/gram_factor.hpp"

#include <algorithm>
#include <cmath>

#include "convex/processor.hpp"

namespace convex::inline pivoting {
namespace {

/// y := (from + sine x) inverse, x := cosine x - sine y.
MOREAU_CLONES void rotate(Index count, const double* __restrict from, double sine, double inverse,
                          double cosine, double* __restrict y, double* __restrict x) {
  for (Index i = 0; i < count; ++i) {
    y[i] = (from[i] + sine * x[i]) * inverse;
    x[i] = cosine * x[i] - sine * y[i];
  }
}

}  // namespace

GramFactor::GramFactor(const GramRows& rows, Arena& arena, Index capacity)
    : rows_(rows), kernels_(dense_kernels()), capacity_(capacity), ld_(padded(capacity)) {
  L_ = arena.take<double>(ld_ * ld_);
  inverse_ = arena.take<double>(16 * ld_);
  column_ = arena.take<double>(ld_);
  at_ = arena.take<Index>(ld_);
}

Index GramFactor::lines(Index capacity) {
  const Index k = padded(capacity);
  return (k * k + 18 * k) / 8;
}

/// The unit matrix from row and column `from` on, up to the end of their pack.
void GramFactor::pad(Index from) {
  for (Index j = from; j < padded(from); ++j) {
    for (Index c = 0; c < padded(from); ++c) L_[c * ld_ + j] = L_[j * ld_ + c] = 0;
    L_[j * (ld_ + 1)] = 1;
  }
}

/// L := the Gram matrix of the working set, its lower part.
void GramFactor::gather() {
  for (Index j = 0; j < size_; ++j) {
    const double* from = rows_.gram(at_[j]);
    for (Index i = j; i < size_; ++i) L_[j * ld_ + i] = from[at_[i]];
  }
  pad(size_);
}

void GramFactor::eliminate_plainly(Index j) {
  const double* const column = L_ + j * ld_;
  for (Index i = j + 1; i < size_; ++i) {
    const Index first = i / 8 * 8;
    kernels_.add_multiple(padded(size_) - first, -column[i] / column[j], column + first,
                          L_ + i * ld_ + first);
  }
}

bool GramFactor::factor(double part) {
  gather();
  kernels_.factor(size_, ld_, L_, inverse_);
  factored_ = true;
  for (Index j = 0; j < size_ && factored_; ++j)
    factored_ = pivot(j) * pivot(j) > part * rows_.square(at_[j]);
  return factored_;
}

double GramFactor::distance(Index place, double* x) const {
  const double* const gram = rows_.gram(place);
  for (Index j = 0; j < padded(size_); ++j) x[j] = j < size_ ? gram[at_[j]] : 0;
  if (size_ == 0) return rows_.square(place);
  kernels_.forward(size_, ld_, L_, inverse_, x);
  return rows_.square(place) - kernels_.dot(padded(size_), x, x);
}

void GramFactor::distances(const Index* places, Index count, double* X, double* squared) const {
  fill_packs(8 * padded(size_), 0, X);
  for (Index l = 0; l < count; ++l) {
    const double* const gram = rows_.gram(places[l]);
    for (Index j = 0; j < size_; ++j) X[8 * j + l] = gram[at_[j]];
    squared[l] = rows_.square(places[l]);
  }
  kernels_.forward_pack(size_, ld_, L_, inverse_, X);
  for (Index j = 0; j < size_; ++j)
    for (Index l = 0; l < count; ++l) squared[l] -= X[8 * j + l] * X[8 * j + l];
}

void GramFactor::append(Index place, const double* x, double distance) {
  const Index k = size_++;
  at_[k] = place;
  if (k % 8 == 0) pad(size_);
  for (Index c = 0; c < k; ++c) L_[c * ld_ + k] = L_[k * ld_ + c] = x[c];
  L_[k * (ld_ + 1)] = std::sqrt(distance);
  const Index first = k / 8 * 8;
  kernels_.invert_blocks(size_ - first, ld_, L_ + first * (ld_ + 1), inverse_ + 16 * first);
}

/// Lᵀ beside L, of the columns from `from` on: eight at a time, for a column alone would touch a line of
/// memory for each of its entries.
MOREAU_CLONES void GramFactor::mirror(Index from) {
  for (Index first = from; first < size_; first += 8) {
    const Index end = std::min(first + 8, size_);
    for (Index c = first; c < end; ++c)
      for (Index i = c + 1; i < end; ++i) L_[i * ld_ + c] = L_[c * ld_ + i];
    if (end < first + 8) break;
    for (Index i = end; i < size_; ++i)
      for (Index c = 0; c < 8; ++c) L_[i * ld_ + first + c] = L_[(first + c) * ld_ + i];
  }
}

/// Without row j, L₃₃ of the rows behind it becomes L' with L'L'ᵀ = L₃₃L₃₃ᵀ + x xᵀ, x what they had in its
/// column.
void GramFactor::remove(Index j) {
  const Index k = size_--;
  double* const x = column_;
  std::copy(L_ + j * ld_ + j + 1, L_ + j * ld_ + k, x + j + 1);
  std::copy(at_ + j + 1, at_ + k, at_ + j);
  for (Index c = 0; c < j; ++c) std::copy(L_ + c * ld_ + j + 1, L_ + c * ld_ + k, L_ + c * ld_ + j);
  for (Index i = j; i < size_; ++i) std::copy_n(L_ + (i + 1) * ld_, j, L_ + i * ld_);
  for (Index c = j + 1; c < k; ++c) {
    const double* const from = L_ + c * ld_;
    double* const to = L_ + (c - 1) * ld_ - 1;
    const double d = from[c], r = std::sqrt(d * d + x[c] * x[c]), inverse = d / r, cosine = r / d,
                 sine = x[c] / d;
    to[c] = r;
    rotate(k - c - 1, from + c + 1, sine, inverse, cosine, to + c + 1, x + c + 1);
  }
  mirror(j);
  pad(size_);
  const Index first = j / 8 * 8;
  if (first < size_)
    kernels_.invert_blocks(size_ - first, ld_, L_ + first * (ld_ + 1), inverse_ + 16 * first);
}

void GramFactor::keep_first(Index count) {
  if (count == size_) return;
  size_ = count;
  pad(size_);
  const Index first = size_ / 8 * 8;
  if (factored_ && first < size_)
    kernels_.invert_blocks(size_ - first, ld_, L_ + first * (ld_ + 1), inverse_ + 16 * first);
}

void GramFactor::solve(double* x) const {
  if (size_ == 0) return;
  kernels_.forward(size_, ld_, L_, inverse_, x);
  kernels_.backward(size_, ld_, L_, inverse_, x);
}

void GramFactor::solve_pack(double* X) const {
  kernels_.forward_pack(size_, ld_, L_, inverse_, X);
  kernels_.backward_pack(size_, ld_, L_, inverse_, X);
}

void GramFactor::solve_upper(double* x) const {
  if (size_ > 0) kernels_.backward(size_, ld_, L_, inverse_, x);
}

}  // namespace convex::inline pivoting
