#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "cli/report/solve_report.hpp"
#include "cli/resolved_scene.hpp"
#include "convex/invalid_input.hpp"
#include "tests/fuzz/redundant_loops.hpp"

/// loop_fuzzer COUNT [SEED]: draws so many linkages with redundant bars, solves each plainly, with --certify
/// and by the method "exact", and compares status and acceleration with the truth, bounds with the error.
/// Exit 1 when an answer is wrong, a proof is false, a proof changes a right answer into another status, or a
/// mechanism with rational numbers is not proved in fractions.

namespace {

using convex::ProofLevel;
using convex::Status;

/// What is wrong with an answer; empty when nothing is.
std::string fault(const fuzz::Loop& loop, bool certify, const char* method) {
  cli::SceneOptions options;
  if (*method != 0) options.method = method;
  cli::Scene scene = cli::make_scene(cli::read_problem(loop.file, "/nowhere"), "loop", options);
  cli::ProvedScene proved = cli::resolve_and_prove(scene, certify);
  mechanics::CertifiedSolution& found = proved.found;
  const bool is_proved = found.certificate.level != ProofLevel::none;
  if (!is_proved) cli::count_evaluation_error(scene, found.solution);
  const convex::Solution& primal = found.solution.primal;
  if (loop.is_contradictory) return primal.status == Status::infeasible ? "" : "not infeasible";
  if (primal.status == Status::infeasible) return "infeasible";
  long double square = 0, size = 0;
  for (std::size_t i = 0; i < loop.mass.size(); ++i) {
    const long double off = primal.q[static_cast<convex::Index>(i)] - loop.acceleration[i];
    square += loop.mass[i] * off * off;
    size += loop.mass[i] * loop.acceleration[i] * loop.acceleration[i];
  }
  const double error = static_cast<double>(std::sqrt(square)), norm = static_cast<double>(std::sqrt(size));
  constexpr double tolerance = 1e-9, rounding_of_truth = 1e-16;
  char text[160];
  std::snprintf(text, sizeof text, "error %.2g, bound %.2g, size %.2g", error, found.certificate.error_bound,
                norm);
  if (error > tolerance * std::max(1.0, norm)) return std::string("wrong acceleration, ") + text;
  if (primal.status != Status::solved) return std::string("not solved, ") + text;
  if (is_proved && error > found.certificate.error_bound + rounding_of_truth * std::max(1.0, norm))
    return std::string("the bound is false, ") + text;
  if ((certify || *method != 0) && loop.is_rational && found.certificate.level != ProofLevel::exact)
    return std::string("rational and not proved in fractions, ") + text;
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 300;
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atol(argv[2]) : 1966);
  long faults = 0;
  std::map<std::string, long> drawn;
  for (long k = 0; k < count; ++k) {
    fuzz::Random random(seed * 1000003 + static_cast<std::uint64_t>(k));
    const fuzz::Loop loop = fuzz::draw_loop(random);
    ++drawn[loop.name];
    const struct {
      bool certify;
      const char *method, *words;
    } ways[] = {{false, "", "plain"}, {true, "", "--certify"}, {false, "exact", "--method exact"}};
    for (const auto& way : ways) {
      std::string why;
      try {
        why = fault(loop, way.certify, way.method);
      } catch (const convex::InvalidInput& error) {
        why = error.what();
      }
      if (why.empty()) continue;
      ++faults;
      std::printf("#%ld %s, %s: %s\n", k, loop.name.c_str(), way.words, why.c_str());
      if (argc > 3) std::printf("%s\n", loop.file.c_str());
    }
  }
  for (const auto& [name, number] : drawn) std::printf("%s %ld, ", name.c_str(), number);
  std::printf("faults %ld\n", faults);
  return faults > 0 ? 1 : 0;
}
