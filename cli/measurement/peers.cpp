#include "cli/measurement/peers.hpp"

#include <dlfcn.h>

#include <array>
#include <filesystem>
#include <memory>

#include "convex/nearest_point/methods/crossover.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using convex::Vector;

/// Of the module: 0 when the solver says that it has solved w = M lambda + q, both >= 0, at right angles.
using SolveLcp = int (*)(const char* solver, int m, double* M, double* q, double tolerance, double* lambda);

/// Beside the program, in the library folder of an installation, or where it was built.
SolveLcp loaded() {
#ifdef MOREAU_SICONOS_MODULE
  namespace fs = std::filesystem;
  const fs::path built(MOREAU_SICONOS_MODULE);
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const fs::path& folder : {program, program.parent_path() / "lib/moreau",
                                 fs::path(MOREAU_SICONOS_FOLDER), built.parent_path()}) {
    const fs::path file = folder / built.filename();
    if (!fs::exists(file, ignored)) continue;
    if (void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL); handle != nullptr)
      return reinterpret_cast<SolveLcp>(dlsym(handle, "moreau_siconos_lcp"));
  }
#endif
  return nullptr;
}

/// In the child alone: what the package does when it is loaded, or at its end, costs nobody else.
Solution solved_by(const char* solver, const NearestPointProblem& problem, const convex::Accuracy& accuracy) {
  static const SolveLcp solve = loaded();
  const Index m = problem.rows();
  Matrix M(m, m);
  for (Index a = 0; a < m; ++a) M.col(a) = problem.U.times(problem.A.solve(problem.U.row(a)));
  Vector free = problem.U.times(problem.A.solve(problem.z)) - problem.s, lambda = Vector::Zero(m);
  const bool says_solved = solve != nullptr && solve(solver, static_cast<int>(m), M.data(), free.data(),
                                                     accuracy.tolerance, lambda.data()) == 0;
  Solution found;
  found.status = says_solved ? Status::solved : Status::gave_up;
  found.lambda = lambda;
  found.q = problem.A.solve(problem.z + problem.U.transpose_times(lambda));
  found.error_bound = accuracy.tolerance * std::max(problem.A.norm(found.q), problem.A.dual_norm(problem.z));
  return found;
}

}  // namespace

std::string why_no_peers() {
#ifdef MOREAU_SICONOS_MODULE
  return "";
#else
  return "--peers: no other package was found when this was built; install libsiconos-numerics-dev (Debian, "
         "Ubuntu) and build again";
#endif
}

std::vector<Contest> peer_contests(const Exam& given) {
  constexpr std::array solvers{"lemke", "pgs", "newton-fb"};
  constexpr Index most_rows = 1500;
  const auto exam = std::make_shared<const Exam>(given);
  const NearestPointProblem& problem = exam->problem;
  std::vector<Contest> all;
  for (const char* solver : solvers) {
    const auto found = std::make_shared<Solution>();
    std::string refused;
    if (!problem.two_sided.empty()) refused = "two-sided rows";
    if (problem.rows() > most_rows) refused = "too many rows for a dense matrix";
    all.push_back({exam->name, problem.dimension(), problem.rows(), std::string("siconos-") + solver,
                   convex::MethodKind::iterative, refused,
                   [exam, found, solver](const convex::Accuracy& accuracy) {
                     const NearestPointProblem& one = exam->problem;
                     *found = solved_by(solver, {anew(one.A), one.z, one.U, one.s, {}}, accuracy);
                   },
                   [exam, found] { return judgement(*exam, *found); }});
  }
  return all;
}

}  // namespace cli
