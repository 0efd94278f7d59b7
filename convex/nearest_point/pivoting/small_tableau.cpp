#include "convex/nearest_point/pivoting/small_tableau.hpp"

#include "convex/nearest_point/pivoting/small_tableau_steps.hpp"
#include "convex/processor.hpp"

namespace convex::inline pivoting {
namespace {

/// f of the steps for as many packs as there are.
#define MOREAU_BY_PACKS(f) \
  t.ld == 8 && t.stride == 8 ? One::f(t) : t.stride <= SmallTableau::few_rows ? Four::f(t) : Eight::f(t)

#define MOREAU_SMALL_TABLE(name, target, W, fused)                                                         \
  struct name {                                                                                            \
    using One = SmallTableauSteps<W, fused, 1>;                                                            \
    using Four = SmallTableauSteps<W, fused, 4>;                                                           \
    using Eight = SmallTableauSteps<W, fused, 8>;                                                          \
    target static bool begin(SmallTableau& t) { return MOREAU_BY_PACKS(begin); }                           \
    target static void append(SmallTableau& t) { Four::append(t); }                                        \
    target static bool begin_again(SmallTableau& t) { return MOREAU_BY_PACKS(begin_again); }               \
    target static bool settle(SmallTableau& t) { return MOREAU_BY_PACKS(settle); }                         \
    target static bool correct(SmallTableau& t) { return MOREAU_BY_PACKS(correct); }                       \
    target static void measure_precisely(SmallTableau& t) { MOREAU_BY_PACKS(measure_precisely); }          \
    target static void measure(SmallTableau& t) { MOREAU_BY_PACKS(measure); }                              \
    target static void dual_rows(const SmallTableau& t, double* dual) { Four::dual_rows(t, dual); }        \
    target static Index close_rows(Index m, const double* slack, const double* s, const double* end,       \
                                   const double* length, double absolute, double by_length, Index* rows) { \
      return Four::close_rows(m, slack, s, end, length, absolute, by_length, rows);                        \
    }                                                                                                      \
    target static void rough_inverse_roots(Index m, const double* squares, double* into) {                 \
      Four::rough_inverse_roots(m, squares, into);                                                         \
    }                                                                                                      \
    target static void deepest(Index m, const double* slack, const double* inverse_length, double* depth,  \
                               double* row) {                                                              \
      Four::deepest(m, slack, inverse_length, depth, row);                                                 \
    }                                                                                                      \
    static constexpr SmallKernels table{                                                                   \
        begin,     append,     begin_again,         settle, correct, measure_precisely, measure,           \
        dual_rows, close_rows, rough_inverse_roots, deepest};                                              \
  };

MOREAU_SMALL_TABLE(Portable, , 2, false)
#ifdef MOREAU_HAS_FAMILIES
MOREAU_SMALL_TABLE(Wide, [[gnu::target("avx2,fma")]], 4, true)
MOREAU_SMALL_TABLE(Widest, [[gnu::target("avx512f")]], 8, true)
constexpr const SmallKernels* tables[] = {&Portable::table, &Wide::table, &Widest::table};
#else
constexpr const SmallKernels* tables[] = {&Portable::table};
#endif

}  // namespace

std::span<const SmallKernels* const> all_small_kernels() { return {tables, all_dense_kernels().size()}; }

const SmallKernels& small_kernels() { return *all_small_kernels().back(); }

}  // namespace convex::inline pivoting
