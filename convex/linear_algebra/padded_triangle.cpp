#include "convex/linear_algebra/padded_triangle.hpp"

#include <cstdint>
#include <new>

#include "convex/linear_algebra/cholesky.hpp"

namespace convex::linear_algebra {
namespace {

/// From here on factoring by blocks of many columns, which keeps in the cache what it works on, is faster.
constexpr Index large = 320;

constexpr std::size_t line = 64;

std::size_t bytes(Index ld) { return sizeof(double) * static_cast<std::size_t>(ld * (ld + 16)) + line; }

double* at_line(double* room) {
  const auto misplaced = reinterpret_cast<std::uintptr_t>(room) % line;
  return room + (misplaced == 0 ? 0 : (line - misplaced) / sizeof(double));
}

}  // namespace

bool PaddedTriangle::take(const Matrix& W) {
  n_ = W.rows();
  if (!room_ || ld_ != padded(n_)) {
    ld_ = padded(n_);
    room_.reset();
    room_.reset(static_cast<double*>(std::malloc(bytes(ld_))));
    if (!room_) throw std::bad_alloc();
    T_ = at_line(room_.get());
  }
  return dense_kernels().take_symmetric(n_, ld_, W.data(), T_);
}

void PaddedTriangle::factor() {
  if (n_ < large) {
    dense_kernels().factor(n_, ld_, T_, T_ + ld_ * ld_);
    return;
  }
  Eigen::Map<Matrix, 0, Eigen::OuterStride<>> L(T_, n_, n_, {ld_});
  if (!linear_algebra::factor_in_place(L)) L(0, 0) = 0;
  for (Index j = 0; j < n_; ++j)
    for (Index i = 0; i < j; ++i) L(i, j) = L(j, i);
  dense_kernels().invert_blocks(n_, ld_, T_, T_ + ld_ * ld_);
}

void PaddedTriangle::take_factor(const Matrix& L) {
  take(L.selfadjointView<Eigen::Lower>());
  dense_kernels().invert_blocks(n_, ld_, T_, T_ + ld_ * ld_);
}

}  // namespace convex::linear_algebra
