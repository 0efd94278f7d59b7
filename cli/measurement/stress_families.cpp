#include "cli/measurement/stress_families.hpp"

#include <algorithm>

#include "cli/measurement/cone_exams.hpp"
#include "cli/measurement/exams.hpp"
#include "cli/measurement/motion_stress.hpp"
#include "cli/measurement/peers.hpp"
#include "cli/measurement/prox_exams.hpp"

namespace cli::inline measurement {
namespace {

using convex::GalleryFamily;
using convex::Index;

/// Sizes at which every method can be expected to end.
Index stressed_size(const GalleryFamily& family, Index size) {
  if (family.name == "obstacle") return std::max<Index>(4, size / 2 + 2);
  return family.sparse ? 4 * size : std::min(family.size, size);
}

}  // namespace

std::vector<StressFamily> stress_families(Index size, bool peers) {
  const std::vector<double> conditions{1, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12},
      gaps{1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 0},
      distances{1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16},
      slopes{1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14};
  std::vector<StressFamily> all;
  for (const GalleryFamily& family : convex::gallery())
    all.push_back({std::string(family.name),
                   std::string(family.knob),
                   {family.ladder.begin(), family.ladder.end()},
                   [&family, size, peers](double setting) {
                     return everybody(gallery_exam(family, stressed_size(family, size), setting), peers);
                   }});
  std::vector<double> sizes{5, 10};
  while (sizes.back() < 10 * static_cast<double>(size)) sizes.push_back(2 * sizes.back());
  all.push_back({"size", "coordinates", sizes, [peers](double setting) {
                   return everybody(
                       gallery_exam(*convex::find_family("well-posed"), static_cast<Index>(setting), 0.5),
                       peers);
                 }});
  const auto add = [&](const char* name, const char* knob, const std::vector<double>& ladder, auto make,
                       auto which) {
    all.push_back({name, knob, ladder, [=](double setting) { return make(which, setting); }});
  };
  add("prox-norm1", "condition number of W", conditions, prox_contests, Charted::norm1);
  add("prox-simplex", "condition number of W", conditions, prox_contests, Charted::simplex);
  add("prox-ball2", "condition number of W", conditions, prox_contests, Charted::ball2);
  add("prox-second-order-cone", "condition number of W", conditions, prox_contests,
      Charted::second_order_cone);
  add("ties-simplex", "how far apart", gaps, tie_contests, Sorting::simplex);
  add("ties-ball1", "how far apart", gaps, tie_contests, Sorting::ball1);
  add("ties-sum-largest", "how far apart", gaps, tie_contests, Sorting::sum_largest);
  add("exponential-cone-boundary", "distance from it", distances, boundary_contests, CurvedCone::exponential);
  add("power-cone-boundary", "distance from it", distances, boundary_contests, CurvedCone::power);
  all.push_back({"flat-cone-polar", "slope of the cone", slopes, flat_polar_contests});
  for (StressFamily& family : motion_families()) all.push_back(std::move(family));
  return all;
}

}  // namespace cli::inline measurement
