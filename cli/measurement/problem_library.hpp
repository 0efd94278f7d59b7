#pragma once

#include <functional>
#include <string>
#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace cli::inline measurement {

/// A nearest-point problem of the library: a contact problem without friction, its numbers as they stand.
struct LibraryProblem {
  std::string kind;    ///< "family", "scene" or "motion"
  std::string family;  ///< of the gallery, or the name of the scene
  std::string name;    ///< of the problem, unlike all others
  std::string origin;  ///< what makes it again, or at which instant of which file it arises
  convex::NearestPointProblem problem;
  std::vector<std::string> coordinates, constraints;  ///< names; empty for those of the gallery
};

/// Every family of the gallery at every setting of its knob, small, twice.
std::vector<LibraryProblem> family_problems();

/// The contact problem of a file with [system] or [projection] at its state; of a [system] with
/// simulate.until also those along its motion, where contacts persist: up to `most_instants` of them, evenly
/// chosen. None where there are no contacts, or where the file holds another kind of problem; `left_out`
/// hears why.
std::vector<LibraryProblem> file_problems(const std::string& file,
                                          const std::function<void(const std::string& why)>& left_out);

inline constexpr std::size_t most_instants = 6;

/// A and U in full: the form that every format has.
convex::NearestPointProblem in_full(const convex::NearestPointProblem&);

}  // namespace cli::inline measurement
