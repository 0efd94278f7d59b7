#pragma once

#include <cstdint>
#include <span>

#include "mechanics/motion/taylor_orders.hpp"

namespace mechanics::inline motions {

/// x_to = Σ c x_from over the parts up to `end`, and what was asked for there.
struct SweepSum {
  std::uint32_t to, end;
};
struct SweepPart {
  std::uint32_t from, c;
};

/// The columns of a `TaylorRecurrence` while velocities are eliminated, and the factors of A = L D Lᵀ.
struct VelocityColumns {
  std::size_t coordinates, columns, blocks;
  const double *L, *inverse_of_D;
  const double* by_velocity;  ///< n columns
  double* column;
  double* change;  ///< n rows of so many numbers as there are columns, in blocks of eight
};

/// The loops that the orders of a series are made of, compiled for one family of processors each.
struct TaylorKernels {
  /// Orders 1 to count - 1, from that of 0. Returns the first one from which on all are 0.
  std::size_t (*find_orders)(const TaylorOrders& of, bool& all_finite);
  /// The sweep backwards, one sum after the other.
  void (*carry_out)(const SweepSum* sums, std::size_t count, const SweepPart* parts, const double* c,
                    const double* asked, double* x);
  /// v = A⁻¹(F_(k-1) / k - p): the first n numbers of each column become those of v, and what follows from v
  /// is added to the others. The columns n to 2n - 1 are those of F_(k-1) / k.
  void (*eliminate_velocities)(const VelocityColumns& of);
  /// R of an order, a block of eight products after the other.
  void (*find_rests)(const double* x, const double* y, const double* weighted, double* rest,
                     std::size_t blocks, std::size_t width, std::size_t k);
};

/// Those for this machine.
const TaylorKernels& taylor_kernels();
/// Those that this machine can run, the widest last.
std::span<const TaylorKernels* const> all_taylor_kernels();

}  // namespace mechanics::inline motions
