#pragma once

#include <vector>

#include "cli/measurement/trial.hpp"
#include "cli/scene.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"

namespace cli {

/// An instance of the gallery as an exam: its truth is known.
Exam gallery_exam(const convex::GalleryFamily&, convex::Index size, double difficulty,
                  std::uint32_t seed = 1);

/// What `moreau chart` charts without a file: small and large, redundant, ill-conditioned, chain, packing.
std::vector<Exam> charted_exams();

/// What `moreau chart --profile` profiles without a file: every feasible family of the gallery at every
/// setting of its knob, small.
std::vector<Exam> profile_exams();

/// The problem of a file, its truth found in fractions (beyond `most_exact` coordinates: the default method,
/// whose answer is refined in twice the precision).
Exam file_exam(const Scene&);

inline constexpr convex::Index most_exact = 120;

}  // namespace cli
