#pragma once

#include <cstring>

#include "convex/dense/dense_kernels.hpp"

// Packs never cross a function that is not inlined, so how they would be passed does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

/// Inlined into kernels that are compiled for a processor family each.
#define MOREAU_INLINE [[gnu::always_inline]] static inline

namespace convex {

template <int W>
struct Register {
  using Doubles [[gnu::vector_size(W * sizeof(double))]] = double;
};

/// Eight doubles in registers of W, and what is done with them entry by entry, so that results do not depend
/// on W. Fused: whether the machine has a fused multiply-add, by which the rounding of a product is found; it
/// is the same number either way.
template <int W, bool Fused>
struct Packs {
  using Part = typename Register<W>::Doubles;
  static constexpr int parts = 8 / W, width = W;
  struct Pack {
    Part part[parts];
  };

  MOREAU_INLINE Pack load(const double* x) {
    Pack pack;
    std::memcpy(&pack, x, sizeof pack);
    return pack;
  }
  MOREAU_INLINE void store(double* x, const Pack& pack) { std::memcpy(x, &pack, sizeof pack); }
  /// Only what lies before `end` may be read; zeros stand for the rest.
  MOREAU_INLINE Pack load_before(const double* x, const double* end) {
    if (end - x >= 8) return load(x);
    double tail[8] = {};
    for (Index i = 0; i < end - x; ++i) tail[i] = x[i];
    return load(tail);
  }
  MOREAU_INLINE Pack times(const Pack& x, double c) {
    Pack product;
    for (int k = 0; k < parts; ++k) product.part[k] = x.part[k] * c;
    return product;
  }
  MOREAU_INLINE Pack times(const Pack& x, const Pack& y) {
    Pack product;
    for (int k = 0; k < parts; ++k) product.part[k] = x.part[k] * y.part[k];
    return product;
  }
  MOREAU_INLINE Pack plus(const Pack& x, const Pack& y) {
    Pack sum;
    for (int k = 0; k < parts; ++k) sum.part[k] = x.part[k] + y.part[k];
    return sum;
  }
  MOREAU_INLINE Pack minus(const Pack& x, const Pack& y) {
    Pack difference;
    for (int k = 0; k < parts; ++k) difference.part[k] = x.part[k] - y.part[k];
    return difference;
  }
  MOREAU_INLINE Pack larger(const Pack& x, const Pack& y) {
    Pack most;
    for (int k = 0; k < parts; ++k) most.part[k] = x.part[k] > y.part[k] ? x.part[k] : y.part[k];
    return most;
  }
  MOREAU_INLINE void add_product(Pack& sum, const Pack& x, double c) {
    for (int k = 0; k < parts; ++k) sum.part[k] = sum.part[k] + x.part[k] * c;
  }
  MOREAU_INLINE void subtract_product(Pack& sum, const Pack& x, double c) {
    for (int k = 0; k < parts; ++k) sum.part[k] = sum.part[k] - x.part[k] * c;
  }
  MOREAU_INLINE void add_products(Pack& sum, const Pack& x, const Pack& y) {
    for (int k = 0; k < parts; ++k) sum.part[k] = sum.part[k] + x.part[k] * y.part[k];
  }
  MOREAU_INLINE double total(const Pack& x) {
    double t[8];
    store(t, x);
    return ((t[0] + t[4]) + (t[2] + t[6])) + ((t[1] + t[5]) + (t[3] + t[7]));
  }
  /// Σ_c columns[8c…] y_c, eight columns.
  MOREAU_INLINE Pack block_times(const double* columns, const double* y) {
    Pack a = times(load(columns), y[0]), b = times(load(columns + 8), y[1]);
    for (int c = 2; c < 8; c += 2) {
      add_product(a, load(columns + 8 * c), y[c]);
      add_product(b, load(columns + 8 * c + 8), y[c + 1]);
    }
    return plus(a, b);
  }

  /// a c - b rounded once. Written in the machine's own words: there is no other that a function compiled for
  /// several machines may use, and entry by entry it is several times slower.
  MOREAU_INLINE Part fused_difference(Part a, const Part& c, const Part& b) {
    if constexpr (W == 8)
      asm("vfmsub132pd %2, %1, %0" : "+v"(a) : "v"(b), "v"(c));
    else
      asm("vfmsub132pd %2, %1, %0" : "+x"(a) : "x"(b), "x"(c));
    return a;
  }

  /// hi + lo += x c in twice the working precision (Ogita, Rump and Oishi 2005; Dekker 1971 for the product).
  MOREAU_INLINE void add_precisely(Pack& hi, Pack& lo, const Pack& x, double c) {
    for (int k = 0; k < parts; ++k) {
      const Part a = x.part[k], product = a * c;
      Part error;
      if constexpr (Fused) {
        error = fused_difference(a, c - Part{}, product);
      } else {
        constexpr double splitter = 0x1p27 + 1;
        const Part ca = splitter * a, a_high = ca - (ca - a), a_low = a - a_high;
        const double cc = splitter * c, c_high = cc - (cc - c), c_low = c - c_high;
        error = a_low * c_low - (((product - a_high * c_high) - a_low * c_high) - a_high * c_low);
      }
      const Part sum = hi.part[k] + product, grown = sum - hi.part[k];
      lo.part[k] = lo.part[k] + (((hi.part[k] - (sum - grown)) + (product - grown)) + error);
      hi.part[k] = sum;
    }
  }
};

}  // namespace convex
