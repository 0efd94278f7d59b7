#include "convex/dense/padded_triangle.hpp"

#include <cstdint>
#include <new>
#include <utility>

#include "convex/linear_algebra/cholesky.hpp"

namespace convex::inline dense {
namespace {

/// From here on factoring by blocks of many columns, which keeps in the cache what it works on, is faster.
constexpr Index large = 320;

/// The room of the last small triangle that a thread gave back: a solve after the other then takes none from
/// the system, which merges and splits what it gets back of such a size.
constexpr std::size_t small = std::size_t{1} << 20;
struct Spare {
  void* room = nullptr;
  std::size_t size = 0;
  ~Spare() { std::free(room); }
};
thread_local Spare spare;

constexpr std::size_t line = 64;

std::size_t bytes(Index ld) { return sizeof(double) * static_cast<std::size_t>(ld * (ld + 16)) + line; }

double* take_room(std::size_t size) {
  if (spare.room && spare.size == size) return static_cast<double*>(std::exchange(spare.room, nullptr));
  if (void* const room = std::malloc(size)) return static_cast<double*>(room);
  throw std::bad_alloc();
}

double* at_line(double* room) {
  const auto misplaced = reinterpret_cast<std::uintptr_t>(room) % line;
  return room + (misplaced == 0 ? 0 : (line - misplaced) / sizeof(double));
}

}  // namespace

PaddedTriangle::PaddedTriangle(const Matrix& W)
    : n_(W.rows()),
      ld_(padded(n_)),
      room_(take_room(bytes(ld_))),
      T_(at_line(room_)),
      is_exactly_symmetric_(dense_kernels().take_symmetric(n_, ld_, W.data(), T_)) {}

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

PaddedTriangle::~PaddedTriangle() {
  if (bytes(ld_) > small) {
    std::free(room_);
    return;
  }
  std::free(spare.room);
  spare.room = room_;
  spare.size = bytes(ld_);
}

}  // namespace convex::inline dense
