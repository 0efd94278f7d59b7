#include "cli/measurement/exams.hpp"

#include <fmt/format.h>

#include <array>

#include "convex/exact/fraction.hpp"
#include "convex/nearest_point/active_set.hpp"
#include "convex/nearest_point/multipliers.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::Integer;

/// Entries of x as doubles and what the doubles leave.
convex::DoubleDoubleVector twice(const convex::ExactVector& x) {
  convex::DoubleDoubleVector result(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const Integer& numerator = x.numerators[static_cast<std::size_t>(i)];
    result.hi[i] = convex::nearest_double({numerator, x.denominator});
    const convex::Fraction taken = convex::fraction(result.hi[i]);
    result.lo[i] = convex::nearest_double(
        {numerator * taken.denominator - taken.numerator * x.denominator, x.denominator * taken.denominator});
  }
  return result;
}

}  // namespace

Exam gallery_exam(const convex::GalleryFamily& family, Index size, double difficulty, std::uint32_t seed) {
  convex::GalleryInstance instance = convex::gallery_instance(family, size, difficulty, seed);
  return {fmt::format("{} {:g}", family.name, difficulty),
          std::move(instance.problem),
          instance.feasible,
          std::move(instance.solution),
          {}};
}

std::vector<Exam> charted_exams() {
  struct Chosen {
    const char* title;
    const char* family;
    Index size;
    double difficulty;
  };
  constexpr std::array chosen{Chosen{"small dense", "well-posed", 12, 0.5},
                              Chosen{"large dense", "well-posed", 150, 0.5},
                              Chosen{"redundant", "redundant", 40, 4},
                              Chosen{"ill-conditioned (cond 1e8)", "ill-conditioned", 16, 1e8},
                              Chosen{"chain (mass ratio 1e4)", "chain", 300, 1e4},
                              Chosen{"hexagonal packing", "hexagonal-packing", 100, 0.5},
                              Chosen{"obstacle", "obstacle", 16, 0.5}};
  std::vector<Exam> exams;
  for (const auto& [title, family, size, difficulty] : chosen) {
    exams.push_back(gallery_exam(*convex::find_family(family), size, difficulty));
    exams.back().name = title;
  }
  return exams;
}

std::vector<Exam> profile_exams() {
  constexpr Index small = 12;
  std::vector<Exam> exams;
  for (const convex::GalleryFamily& family : convex::gallery())
    for (const double difficulty : family.ladder) {
      Exam exam = gallery_exam(family, small, difficulty);
      if (exam.feasible) exams.push_back(std::move(exam));
    }
  return exams;
}

Exam file_exam(const Scene& scene) {
  Exam exam{
      scene.title.empty() ? scene.file : scene.title, scene.problem, true, convex::DoubleDoubleVector(0), {}};
  const convex::Solution found = convex::active_set(scene.problem);
  if (scene.problem.dimension() > most_exact) {
    if (found.status == convex::Status::gave_up)
      throw convex::InvalidInput(scene.file + ": its truth is not known: the default method gave up");
    exam.feasible = found.status != convex::Status::infeasible;
    exam.solution = convex::DoubleDoubleVector(found.q);
    return exam;
  }
  const convex::ExactSolution exact =
      convex::exact_active_set(convex::exact_problem(scene.problem), found.basis);
  exam.feasible = exact.status != convex::Status::infeasible;
  if (!exam.feasible) return exam;
  exam.solution = twice(exact.q);
  const convex::Multipliers known =
      convex::multipliers(scene.problem, found, scene.solve.accuracy.tolerance, false);
  if (known.unique) exam.multipliers = twice(exact.lambda).hi;
  return exam;
}

}  // namespace cli
