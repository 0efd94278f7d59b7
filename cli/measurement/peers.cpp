#include "cli/measurement/peers.hpp"

#include <array>
#include <cstdio>
#include <memory>

#include "cli/measurement/peer_module/peer_program.hpp"
#include "cli/problem_file/documents.hpp"
#include "convex/invalid_input.hpp"
#include "convex/loaded_module.hpp"
#include "convex/nearest_point/methods/crossover.hpp"

namespace cli::inline measurement {
namespace {

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using convex::Vector;

/// A package with a solver of its own: the Debian package, or what its headers are looked for by.
struct Package {
  const char *name, *how;
};
constexpr std::array quadratic_packages{
    Package{"daqp", "-DDAQP_ROOT=FOLDER"}, Package{"osqp", "version 1, -DOSQP_ROOT=FOLDER"},
    Package{"piqp", "-DPIQP_ROOT=FOLDER"}, Package{"qpoases", "-DQPOASES_ROOT=FOLDER"}};
constexpr Package siconos{"siconos", "libsiconos-numerics-dev"};

/// What was found when this was built: "daqp siconos".
bool is_found(const char* package) {
#ifdef MOREAU_PEERS
  const std::string all = std::string(" ") + MOREAU_PEERS + " ";
  return all.find(std::string(" ") + package + " ") != std::string::npos;
#else
  return package == nullptr;
#endif
}

/// A symbol of a package's module.
void* loaded(const char* package, const char* symbol) {
#ifdef MOREAU_PEERS
  const std::string file = std::string("/moreau_") + package + ".so";
  return convex::load_symbol(MOREAU_PEERS_BUILT + file, MOREAU_PEERS_INSTALLED + file, symbol).symbol;
#else
  (void)package, (void)symbol;
  return nullptr;
#endif
}

/// Of the module: 0 when the solver says that it has solved w = M lambda + q, both >= 0, at right angles.
using SolveLcp = int (*)(const char* solver, int m, double* M, double* q, double tolerance, double* lambda);

/// In the child alone: what the package does when it is loaded, or at its end, costs nobody else.
Solution solved_by(const char* solver, const NearestPointProblem& problem, const convex::Accuracy& accuracy) {
  static const auto solve = reinterpret_cast<SolveLcp>(loaded(siconos.name, "moreau_siconos_lcp"));
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

/// The quadratic program by a package, in the child alone; tight: with the tolerance asked for.
Solution solved_by_package(const char* package, bool tight, const NearestPointProblem& problem,
                           const convex::Accuracy& accuracy) {
  static const auto solve = reinterpret_cast<SolvePeer>(loaded(package, "moreau_peer"));
  const Index n = problem.dimension(), m = problem.rows();
  const Matrix A = full_gram(problem.A);
  convex::RowMatrix U(m, n);
  for (Index a = 0; a < m; ++a) U.row(a) = problem.U.row(a);
  std::vector<unsigned char> two_sided(static_cast<std::size_t>(m), 0);
  for (const Index a : problem.two_sided) two_sided[static_cast<std::size_t>(a)] = 1;
  Solution found;
  found.q = Vector::Zero(n);
  PeerProgram program{static_cast<int>(n),
                      static_cast<int>(m),
                      A.data(),
                      problem.z.data(),
                      U.data(),
                      problem.s.data(),
                      two_sided.data(),
                      tight ? accuracy.tolerance : 0,
                      found.q.data(),
                      0};
  const int said = solve != nullptr ? solve(&program) : peer_failed;
  found.status = said == peer_solved       ? Status::solved
                 : said == peer_infeasible ? Status::infeasible
                                           : Status::gave_up;
  const double tolerance = tight ? accuracy.tolerance : program.own_tolerance;
  found.error_bound = tolerance * std::max(problem.A.norm(found.q), problem.A.dual_norm(problem.z));
  return found;
}

/// A method of a package before an exam.
Contest peer_contest(
    const std::shared_ptr<const Exam>& exam, const std::string& method, convex::MethodKind kind,
    const std::string& refused,
    const std::function<Solution(const NearestPointProblem&, const convex::Accuracy&)>& solve) {
  const auto found = std::make_shared<Solution>();
  return {exam->name,
          exam->problem.dimension(),
          exam->problem.rows(),
          method,
          kind,
          refused,
          [exam, found, solve](const convex::Accuracy& accuracy) {
            const NearestPointProblem& one = exam->problem;
            *found = solve({anew(one.A), one.z, one.U, one.s, one.two_sided}, accuracy);
          },
          [exam, found] { return judgement(*exam, *found); }};
}

}  // namespace

std::string peers_not_found() {
  std::string text;
  const auto tell = [&](const Package& package) {
    if (!is_found(package.name))
      text += (text.empty() ? "" : ", ") + std::string(package.name) + " (" + package.how + ")";
  };
  for (const Package& package : quadratic_packages) tell(package);
  tell(siconos);
  return text.empty() ? "" : "peer not found: " + text;
}

std::string why_no_peers() {
  for (const Package& package : quadratic_packages)
    if (is_found(package.name)) return "";
  if (is_found(siconos.name)) return "";
  return "--peers: " + peers_not_found() +
         "; install one (Debian, Ubuntu: libsiconos-numerics-dev), or name its folder to cmake, and build "
         "again";
}

void require_peers() {
  if (const std::string why = why_no_peers(); !why.empty()) throw convex::InvalidInput(why);
  if (const std::string missing = peers_not_found(); !missing.empty())
    std::fprintf(stderr, "moreau: %s\n", missing.c_str());
}

std::vector<std::string> peer_names() {
  std::vector<std::string> names{"siconos-lemke", "siconos-pgs", "siconos-newton-fb"};
  for (const Package& package : quadratic_packages)
    for (const char* settings : {"", "-tight"}) names.push_back(std::string(package.name) + settings);
  return names;
}

std::vector<Contest> peer_contests(const Exam& given) {
  constexpr std::array solvers{"lemke", "pgs", "newton-fb"};
  constexpr Index most_rows = 1500;
  const auto exam = std::make_shared<const Exam>(given);
  const NearestPointProblem& problem = exam->problem;
  const bool is_large = problem.rows() > most_rows || problem.dimension() > most_rows;
  const std::string too_large = is_large ? "too many rows for a dense matrix" : "";
  std::vector<Contest> all;
  for (const char* solver : solvers)
    if (is_found(siconos.name))
      all.push_back(peer_contest(exam, std::string("siconos-") + solver, convex::MethodKind::iterative,
                                 problem.two_sided.empty() ? too_large : "two-sided rows",
                                 [solver](const NearestPointProblem& one, const convex::Accuracy& accuracy) {
                                   return solved_by(solver, one, accuracy);
                                 }));
  for (const Package& package : quadratic_packages)
    for (const bool tight : {false, true})
      if (is_found(package.name))
        all.push_back(
            peer_contest(exam, std::string(package.name) + (tight ? "-tight" : ""),
                         tight ? convex::MethodKind::iterative : convex::MethodKind::direct, too_large,
                         [&package, tight](const NearestPointProblem& one, const convex::Accuracy& accuracy) {
                           return solved_by_package(package.name, tight, one, accuracy);
                         }));
  return all;
}

std::vector<Contest> everybody(const Exam& exam, bool peers) {
  std::vector<Contest> all = contests(exam);
  if (peers)
    for (Contest& contest : peer_contests(exam)) all.push_back(std::move(contest));
  return all;
}

}  // namespace cli::inline measurement
