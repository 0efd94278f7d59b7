#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "convex/double_double.hpp"
#include "convex/nearest_point/problem.hpp"

namespace convex::inline families {

/// A nearest-point problem whose truth is known: by construction from numbers of few bits, so that not one
/// rounding happened on the way, or by exact arithmetic on the data as they stand.
struct GalleryInstance {
  NearestPointProblem problem;
  bool feasible = true;
  DoubleDoubleVector solution;  ///< q, n: exact, or right to 2⁻¹⁰⁶ where the truth has more bits
  Vector multipliers;           ///< m: a lambda that proves it (not the only one where rows are redundant)
  Vector farkas;                ///< m: when not feasible, w with wᵀU = 0, w·s > 0, w >= 0
};

/// A family of problems of one kind, harder and harder along one knob.
struct GalleryFamily {
  std::string_view name, summary;  ///< each one line
  std::string_view knob;           ///< what `difficulty` is
  std::span<const double> ladder;  ///< settings of the knob, easiest first
  double usual;                    ///< a setting that most methods should bear
  std::string_view size_meaning;   ///< what `size` counts
  Index size;                      ///< the usual one
  bool sparse;                     ///< A and U are sparse; sizes of 1e5 are meant
  GalleryInstance (*make)(Index size, double difficulty, std::uint32_t seed);
};

/// The one table of families.
std::span<const GalleryFamily> gallery();

/// The family of that name, or null.
const GalleryFamily* find_family(std::string_view name);

/// The instance of a family; the same arguments give the same bits on every machine. Throws InvalidInput when
/// the size is below 4 (or beyond 1e7), or the difficulty outside the ladder's range.
GalleryInstance gallery_instance(const GalleryFamily&, Index size, double difficulty, std::uint32_t seed = 1);

}  // namespace convex::inline families
