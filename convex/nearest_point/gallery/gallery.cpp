#include "convex/nearest_point/gallery/gallery.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/gallery/families.hpp"

namespace convex::inline families {
namespace {

constexpr std::array parts{0.0, 0.25, 0.5, 0.75, 1.0};
constexpr std::array positive_parts{0.1, 0.25, 0.5, 0.75, 1.0};
constexpr std::array multiples{0.0, 1.0, 2.0, 4.0, 8.0, 16.0};
constexpr std::array ratios{2.0, 5.0, 10.0, 30.0, 100.0, 300.0, 1000.0};
constexpr std::array large{1.0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12, 1e14, 1e16};
constexpr std::array small{1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16};
constexpr std::array small_or_none{1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 0.0};
constexpr std::array margins{1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13};
constexpr std::array units{1e-150, 1e-100, 1e-50, 1e-20, 1e-10, 1.0, 1e10, 1e20, 1e50, 1e100, 1e150};

constexpr std::string_view coordinates = "coordinates", bodies = "bodies";

constexpr std::array table{
    GalleryFamily{"well-posed", "independent active rows, everything strict", "part of the coordinates held",
                  parts, 0.5, coordinates, 30, false, families::well_posed},
    GalleryFamily{"redundant", "active rows that are sums of others", "sums for each independent row",
                  multiples, 2, coordinates, 30, false, families::redundant},
    GalleryFamily{"repeated", "the same active rows several times", "copies of each row", multiples, 2,
                  coordinates, 30, false, families::repeated},
    GalleryFamily{"no-interior",
                  "groups of rows that only their common boundary satisfies: equalities in disguise",
                  "part of the coordinates so held", positive_parts, 0.5, coordinates, 30, false,
                  families::no_interior},
    GalleryFamily{"weakly-active", "rows without a multiplier that are just apart, or not at all",
                  "their slack", small_or_none, 1e-4, coordinates, 30, false, families::weakly_active},
    GalleryFamily{"tall", "many more rows than coordinates", "rows for each coordinate", ratios, 30,
                  coordinates, 8, false, families::tall},
    GalleryFamily{"ill-conditioned", "A with a spread spectrum in rotated axes", "condition number of A",
                  large, 1e6, coordinates, 16, false, families::ill_conditioned},
    GalleryFamily{"heavy-on-light", "a column of bodies lifted from below, the heaviest on top",
                  "weight of the top over that of the bottom", large, 1e4, bodies, 20, false,
                  families::heavy_on_light},
    GalleryFamily{"near-parallel", "two active rows at a small angle", "the angle", small, 1e-4, coordinates,
                  8, false, families::near_parallel},
    GalleryFamily{"near-opposite", "a vertex, nearly flat: two active rows nearly opposite",
                  "the angle to opposite", small, 1e-4, coordinates, 8, false, families::near_opposite},
    GalleryFamily{"scaled", "a well-posed problem in other units", "the unit of the accelerations", units, 1,
                  coordinates, 12, false, families::scaled},
    GalleryFamily{"infeasible", "three rows that exclude each other, among others", "by how much", margins,
                  1e-2, coordinates, 12, false, families::infeasible},
    GalleryFamily{"chain", "bodies on a line, each pushed by its neighbours",
                  "largest weight over the smallest", large, 1e2, bodies, 1000, true, families::chain},
    GalleryFamily{"hexagonal-packing",
                  "discs that touch six others: more rows than coordinates, the upper rows lifting off",
                  "part of the pile at rest", parts, 0.5, "discs", 400, true, families::hexagonal_packing},
    GalleryFamily{"obstacle", "a membrane above a plane, 5-point Laplacian", "part of the plane touched",
                  parts, 0.5, "points along a side", 32, true, families::obstacle},
};

}  // namespace

std::span<const GalleryFamily> gallery() { return table; }

const GalleryFamily* find_family(std::string_view name) {
  const auto* const found = std::find_if(table.begin(), table.end(),
                                         [&](const GalleryFamily& family) { return family.name == name; });
  return found == table.end() ? nullptr : found;
}

GalleryInstance gallery_instance(const GalleryFamily& family, Index size, double difficulty,
                                 std::uint32_t seed) {
  constexpr Index smallest = 4, largest = 10'000'000;
  const std::string name(family.name);
  if (size < smallest || size > largest)
    throw InvalidInput(name + ": size " + std::to_string(size) + "; give a number of " +
                       std::string(family.size_meaning) + " from 4 to 10000000");
  const auto [least, most] = std::minmax_element(family.ladder.begin(), family.ladder.end());
  if (!(difficulty >= *least && difficulty <= *most)) {
    const auto shown = [](double x) {
      std::array<char, 32> text{};
      std::snprintf(text.data(), text.size(), "%g", x);
      return std::string(text.data());
    };
    throw InvalidInput(name + ": difficulty " + shown(difficulty) + " (" + std::string(family.knob) +
                       ") is outside; give one from " + shown(*least) + " to " + shown(*most));
  }
  return family.make(size, difficulty, seed);
}

}  // namespace convex::inline families
