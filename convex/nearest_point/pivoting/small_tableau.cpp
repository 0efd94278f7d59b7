#include "convex/nearest_point/pivoting/small_tableau.hpp"

#include "convex/nearest_point/pivoting/critical_region_steps.hpp"
#include "convex/nearest_point/pivoting/small_tableau_steps.hpp"
#include "convex/processor.hpp"

namespace convex::inline pivoting {
namespace {

/// The steps for one pack, or for any number. Old processors have them once, for all sizes.
template <int W, bool Fused>
struct SmallTableauSizes {
  using One = SmallTableauSteps<W, Fused, 1>;
  using Four = SmallTableauSteps<W, Fused, 4>;
  MOREAU_INLINE bool is_one_pack(const SmallTableau& t) { return t.ld == 8 && t.stride == 8; }

#define MOREAU_BY_PACKS(Result, f) \
  MOREAU_INLINE Result f(SmallTableau& t) { return W > 2 && is_one_pack(t) ? One::f(t) : Four::f(t); }
  MOREAU_BY_PACKS(bool, begin)
  MOREAU_BY_PACKS(bool, begin_again)
  MOREAU_BY_PACKS(bool, settle)
  MOREAU_BY_PACKS(double, margin)
  MOREAU_BY_PACKS(bool, correct)
  MOREAU_INLINE void take_affine_point(CriticalRegion& region, const double* z, const double* s) {
    if (W > 2 && region.p.ld == 8)
      CriticalRegionSteps<W, Fused, 1>::take_affine_point(region, z, s);
    else
      CriticalRegionSteps<W, Fused, 4>::take_affine_point(region, z, s);
  }
  MOREAU_BY_PACKS(void, measure)
  MOREAU_BY_PACKS(void, measure_balance)
};

template <int W, class All, class Four = typename All::Four>
constexpr SmallKernels small_table{
    Compiled<W, &Four::take_diagonal>::at, Compiled<W, &All::begin>::at,
    Compiled<W, &Four::append>::at,        Compiled<W, &All::begin_again>::at,
    Compiled<W, &All::settle>::at,         Compiled<W, &All::margin>::at,
    Compiled<W, &All::correct>::at,        Compiled<W, &All::take_affine_point>::at,
    Compiled<W, &All::measure>::at,        Compiled<W, &All::measure_balance>::at,
    Compiled<W, &Four::find_column>::at,   Compiled<W, &Four::dual_rows>::at,
    Compiled<W, &Four::close_rows>::at,    Compiled<W, &Four::rough_lengths>::at,
    Compiled<W, &Four::deepest>::at};

const SmallKernels* const small_tables[] = {&small_table<2, SmallTableauSizes<2, false>>,
#ifdef MOREAU_HAS_FAMILIES
                                            &small_table<4, SmallTableauSizes<4, true>>,
                                            &small_table<8, SmallTableauSizes<8, true>>
#endif
};

constinit const SmallKernels* chosen_small =
    &small_table<2, SmallTableauSizes<2, false>>;  // until the choice is made, as the program starts
[[maybe_unused]] const bool made_small =
    (chosen_small = small_tables[static_cast<std::size_t>(processor())], true);

}  // namespace

SmallTableau::SmallTableau() {
  double** const vectors[] = {&diagonal, &inverse_diagonal, &unit, &z, &w_free, &w, &q, &q_low, &dq, &r};
  for (int k = 0; k < 10; ++k) *vectors[k] = room.coordinates[k];
  double** const of_held[] = {&lambda, &lambda_low, &change, &length, &pull, &held_slack};
  for (int k = 0; k < 6; ++k) *of_held[k] = room.held[k];
  lambda_at = room.at_places[0];
  lambda_low_at = room.at_places[1];
  pack = room.pack;
  coefficients = room.coefficients;
  rows = room.rows;
  place = room.place;
}

std::span<const SmallKernels* const> all_small_kernels() {
  return {small_tables, static_cast<std::size_t>(processor()) + 1};
}

const SmallKernels& small_kernels() { return *chosen_small; }

}  // namespace convex::inline pivoting
