#include "mechanics/motion/taylor_kernels.hpp"

#include "convex/processor.hpp"
#include "mechanics/motion/taylor_order_steps.hpp"

namespace mechanics::inline motions {
namespace {

template <int W>
struct Loops {
  using P = convex::Packs<W, true>;
  using Pack = typename P::Pack;
  static constexpr std::size_t eight = Eight::count;

  MOREAU_INLINE std::size_t find_orders(const TaylorOrders& of, bool& all_finite) {
    if (of.moving_blocks == 1 && of.blocks == 1) {
      if (of.product_blocks == 0) return TaylorOrderSteps<W, 1, 0>::find(of, all_finite);
      if (of.product_blocks == 1) return TaylorOrderSteps<W, 1, 1>::find(of, all_finite);
    }
    if (of.moving_blocks == 1 && of.blocks == 2) {
      if (of.product_blocks == 1) return TaylorOrderSteps<W, 2, 1>::find(of, all_finite);
      if (of.product_blocks == 2) return TaylorOrderSteps<W, 2, 2>::find(of, all_finite);
    }
    return TaylorOrderSteps<W, 0, 0>::find(of, all_finite);
  }

  MOREAU_INLINE void carry_out(const SweepSum* sums, std::size_t count, const SweepPart* parts,
                               const double* c, const double* asked, double* x) {
    std::uint32_t part = 0;
    for (std::size_t s = 0; s < count; ++s) {
      Pack sum = P::load(asked + sums[s].to * eight);
      for (; part < sums[s].end; ++part)
        P::add_product(sum, P::load(x + parts[part].from * eight), c[parts[part].c]);
      P::store(x + sums[s].to * eight, sum);
    }
  }

  MOREAU_INLINE void eliminate_velocities(const VelocityColumns& of) {
    if (of.coordinates == 2 && of.blocks == 2) return eliminate<2, 2>(of);
    eliminate<0, 0>(of);
  }

  /// With so many coordinates and blocks, as constants; none where they are others.
  template <std::size_t known, std::size_t known_blocks>
  MOREAU_INLINE void eliminate(const VelocityColumns& of) {
    const std::size_t n = known > 0 ? known : of.coordinates;
    const std::size_t stride = (known > 0 ? known_blocks : of.blocks) * eight;
    const std::size_t width = blocks_of(of.columns) * eight;
    const auto row = [&](std::size_t i) __attribute__((always_inline)) { return of.change + i * width; };
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < of.columns; ++c) row(i)[c] = -of.column[c * stride + i];
      for (std::size_t c = n; c < 2 * n; ++c) row(i)[c] = c - n == i ? 1 : 0;
    }
    for (std::size_t c = 0; c < width; c += eight) {
      const auto subtract = [&](std::size_t to, std::size_t from, double by) __attribute__((always_inline)) {
        Pack sum = P::load(row(to) + c);
        P::subtract_product(sum, P::load(row(from) + c), by);
        P::store(row(to) + c, sum);
      };
      for (std::size_t i = 1; i < n; ++i)
        for (std::size_t k = 0; k < i; ++k) subtract(i, k, of.L[i * n + k]);
      for (std::size_t i = 0; i < n; ++i)
        P::store(row(i) + c, P::times(P::load(row(i) + c), of.inverse_of_D[i]));
      for (std::size_t i = n; i-- > 1;)
        for (std::size_t k = 0; k < i; ++k) subtract(k, i, of.L[i * n + k]);
    }
    for (std::size_t c = 0; c < of.columns; ++c) {
      double* column = of.column + c * stride;
      const bool is_force = c >= n && c < 2 * n;
      for (std::size_t b = 0; b < stride; b += eight) {
        Pack sum = P::load(column + b);
        if (is_force) sum = P::times(sum, 0);
        for (std::size_t i = 0; i < n; ++i)
          P::add_product(sum, P::load(of.by_velocity + i * stride + b), row(i)[c]);
        if constexpr (known > 0) {  // in their places before they are stored, so that they are read as one
          if (b == 0)
            for (std::size_t i = 0; i < n; ++i) sum.part[i / W][i % W] = row(i)[c];
        }
        P::store(column + b, sum);
      }
      if constexpr (known == 0)
        for (std::size_t i = 0; i < n; ++i) column[i] = row(i)[c];
    }
  }

  /// The newest factors, those of order k - 1, come last: what is older can be summed while they are found.
  MOREAU_INLINE void find_rests(const double* x, const double* y, const double* weighted, double* rest,
                                std::size_t blocks, std::size_t width, std::size_t k) {
    const double more = static_cast<double>(k) - 1;
    const auto product = [&](std::size_t j, Pack & to) __attribute__((always_inline)) {
      P::add_products(to, P::load(x + j * eight), P::load(y + (k - j) * eight));
    };
    for (std::size_t b = 0; b < blocks; ++b, x += width * eight, y += width * eight) {
      Pack sum[2];
      P::clear(sum);
      std::size_t j = 2;
      for (; j + 3 <= k; j += 2) {
        product(j, sum[0]);
        product(j + 1, sum[1]);
      }
      if (j + 2 <= k) product(j, sum[0]);
      Pack all = P::plus(sum[0], sum[1]);
      if (k >= 2) product(1, all);
      if (k >= 3) product(k - 1, all);
      const Pack count = P::plus(P::times(P::load(weighted + b * eight), more), 1);
      P::store(rest + b * eight, P::over(all, count));
    }
  }
};

// Products and sums may be fused in these, as in the dense kernels, but for those that work on orders one by
// one.
#pragma GCC push_options
#pragma GCC optimize("fp-contract=fast")
template <int W>
struct Fused;
#define MOREAU_FUSED(W, target)                                                                   \
  template <>                                                                                     \
  struct Fused<W> {                                                                               \
    target static std::size_t find_orders(const TaylorOrders& of, bool& all_finite) {             \
      return Loops<W>::find_orders(of, all_finite);                                               \
    }                                                                                             \
    target static void carry_out(const SweepSum* sums, std::size_t count, const SweepPart* parts, \
                                 const double* c, const double* asked, double* x) {               \
      Loops<W>::carry_out(sums, count, parts, c, asked, x);                                       \
    }                                                                                             \
    target static void eliminate_velocities(const VelocityColumns& of) {                          \
      Loops<W>::eliminate_velocities(of);                                                         \
    }                                                                                             \
  };
MOREAU_FUSED(2, )
#ifdef MOREAU_HAS_FAMILIES
MOREAU_FUSED(4, [[gnu::target("avx2,fma")]])
MOREAU_FUSED(8, [[gnu::target("avx512f")]])
#endif
#undef MOREAU_FUSED
#pragma GCC pop_options

template <int W>
constexpr TaylorKernels loops_of{Fused<W>::find_orders, Fused<W>::carry_out, Fused<W>::eliminate_velocities,
                                 convex::Compiled<W, &Loops<W>::find_rests>::at};

const TaylorKernels* const families[] = {&loops_of<2>,
#ifdef MOREAU_HAS_FAMILIES
                                         &loops_of<4>, &loops_of<8>
#endif
};

}  // namespace

const TaylorKernels& taylor_kernels() {
  static const TaylorKernels& chosen = *families[static_cast<std::size_t>(convex::processor())];
  return chosen;
}

std::span<const TaylorKernels* const> all_taylor_kernels() {
  return {families, static_cast<std::size_t>(convex::processor()) + 1};
}

}  // namespace mechanics::inline motions
