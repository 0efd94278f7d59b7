#include <algorithm>
#include <chrono>
#include <optional>

#include "cli/commands.hpp"
#include "cli/cone_report.hpp"
#include "cli/decomposition_report.hpp"
#include "cli/drawing/decomposition_drawing.hpp"
#include "cli/each_file.hpp"
#include "cli/resolved_scene.hpp"
#include "cli/singular_report.hpp"
#include "cli/solve_progress.hpp"
#include "mechanics/evaluation_error.hpp"
#include "mechanics/proof_as_written.hpp"

namespace cli {
namespace {

bool has_answer(const mechanics::GaussSolution& solution) {
  return solution.primal.status == convex::Status::solved ||
         solution.primal.status == convex::Status::inaccurate;
}

/// Adds what the rounding of A, z, U, s amounts to; the bound without it.
double count_evaluation_error(const Scene& scene, convex::Solution& solution) {
  const double as_evaluated = solution.error_bound;
  mechanics::count_evaluation_error(solution,
                                    mechanics::evaluation_error(*scene.written, scene.contacts, scene.problem,
                                                                solution, scene.solve.accuracy),
                                    scene.solve.accuracy);
  return as_evaluated;
}

mechanics::CertifiedSolution solve_once(const Scene& scene, const Options& options) {
  if (scene.solve.method->name == "exact")
    return mechanics::solve_by_fractions(scene.problem, scene.exact, scene.solve);
  if (options.certify) return mechanics::solve_certified(scene.problem, scene.exact, scene.solve);
  mechanics::CertifiedSolution found;
  found.solution = mechanics::solve(scene.problem, scene.solve);
  return found;
}

Answer solve_scene(Scene scene, const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const bool proved = scene.solve.method->name == "exact" || options.certify;
  mechanics::CertifiedSolution found;
  std::optional<SolveProgress> progress(std::in_place);
  std::vector<mechanics::Warning> warnings =
      resolve_scene(scene, [&](const Scene& attempt) -> const mechanics::GaussSolution& {
        found = solve_once(attempt, options);
        return found.solution;
      });
  // An added row is known in doubles only: nothing that rests on it is proved of the mechanism.
  if (!scene.added.empty()) found.certificate = {convex::ProofLevel::none, found.solution.primal.error_bound};
  if (options.certify && scene.written && scene.added.empty())
    mechanics::prove_as_written(found, scene.problem, *scene.written, scene.contacts, scene.solve);
  // What is proved of rows that were settled is proved of the mechanism by its text alone.
  if (scene.is_settled && !(found.text && found.text->error_bound))
    found.certificate = {convex::ProofLevel::none, found.solution.primal.error_bound};
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // Part of reading the mechanism, like the evaluation whose rounding it is about.
  std::optional<double> as_evaluated;
  if (scene.written && !proved && scene.added.empty() && has_answer(found.solution))
  if (by_fractions)
    found = mechanics::solve_by_fractions(scene.problem, scene.exact, scene.solve);
  else if (options.certify)
    found = mechanics::solve_certified(scene.problem, scene.exact, scene.solve);
  else
    found.solution = mechanics::solve(scene.problem, scene.solve);
  if (scene.written && options.certify)
    mechanics::prove_as_written(found, scene.problem, *scene.written, scene.contacts, scene.solve);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // Part of reading the mechanism, like the evaluation whose rounding it is about.
  std::optional<double> as_evaluated;
  if (scene.written && !proved && has_answer(found.solution))
