#pragma once

#include <memory>
#include <vector>

#include "cli/measurement/contest.hpp"
#include "cli/scene.hpp"
#include "convex/double_double.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"

namespace cli::inline measurement {

/// A nearest-point problem with its truth, to be put before methods.
struct Exam {
  std::string name;
  convex::NearestPointProblem problem;
  bool feasible = true;
  convex::DoubleDoubleVector solution;  ///< n, when feasible
  convex::Vector multipliers;           ///< m, where they are known and unique; else empty
};

/// An instance of the gallery as an exam: its truth is known.
Exam gallery_exam(const convex::GalleryFamily&, convex::Index size, double difficulty);

/// The problem of a file, its truth found in fractions (beyond `most_exact` coordinates: the default method,
/// whose answer is refined in twice the precision).
Exam file_exam(const Scene&);

inline constexpr convex::Index most_exact = 120;

/// Every method before an exam, and `certified`: the default's answer with a bound that is proved, in doubles
/// or else in fractions. The error is ||q - q*||_A over max(||q*||_A, ||z||_(A⁻¹)).
std::vector<Contest> contests(Exam);

/// The names of all methods that a chart or a map may show.
std::vector<std::string> contestant_names();

/// The metric made anew from its numbers, factor and all.
convex::Metric anew(const convex::Metric&);

/// A solution compared with the truth of an exam.
Judgement judgement(const Exam&, const convex::Solution&);

}  // namespace cli::inline measurement
