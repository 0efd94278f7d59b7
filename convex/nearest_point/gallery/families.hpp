#pragma once

#include "convex/nearest_point/gallery/gallery.hpp"

/// The makers of the gallery's families; `gallery.cpp` says what each knob is.
namespace convex::inline families {

GalleryInstance well_posed(Index n, double part_held, std::uint32_t seed);
GalleryInstance redundant(Index n, double sums_per_row, std::uint32_t seed);
GalleryInstance repeated(Index n, double copies, std::uint32_t seed);
GalleryInstance no_interior(Index n, double part, std::uint32_t seed);
GalleryInstance weakly_active(Index n, double slack, std::uint32_t seed);
GalleryInstance infeasible(Index n, double margin, std::uint32_t seed);
GalleryInstance tall(Index n, double rows_per_coordinate, std::uint32_t seed);
GalleryInstance scaled(Index n, double unit, std::uint32_t seed);
GalleryInstance ill_conditioned(Index n, double condition, std::uint32_t seed);
GalleryInstance near_parallel(Index n, double angle, std::uint32_t seed);
GalleryInstance near_opposite(Index n, double angle, std::uint32_t seed);
GalleryInstance heavy_on_light(Index bodies, double weight_ratio, std::uint32_t seed);
GalleryInstance chain(Index bodies, double weight_ratio, std::uint32_t seed);
GalleryInstance hexagonal_packing(Index discs, double part_at_rest, std::uint32_t seed);
GalleryInstance obstacle(Index side, double part_touching, std::uint32_t seed);

}  // namespace convex::inline families
