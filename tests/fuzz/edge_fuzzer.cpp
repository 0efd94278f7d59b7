#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "convex/nearest_point/repeated_problem.hpp"
#include "tests/fuzz/edge_families.hpp"
#include "tests/oracles/rational_kkt.hpp"

/// edge_fuzzer COUNT [SEED]: draws so many problems at the edge of rounding, solves them by the default
/// method, and verifies each claim in fractions that share nothing with the solver. Exit 1 when one is wrong,
/// or more than one in a thousand is refused. `--repeated`: through RepeatedProblem.

namespace {

using convex::Index;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using oracles::Rational;
using oracles::RationalPoint;
using oracles::RationalVector;

/// The solution by trying the sets of rows in turn, those close to `likely` first; false when no set gives
/// one.
bool find_truth(const NearestPointProblem& problem, const std::vector<Index>& likely, RationalPoint& truth) {
  truth = oracles::solve_kkt(problem, likely);
  if (oracles::is_exact_solution(problem, truth)) return true;
  const Index m = problem.rows();
  for (unsigned long set = 0; set < (1UL << static_cast<unsigned long>(m)); ++set) {
    std::vector<Index> rows;
    for (Index a = 0; a < m; ++a)
      if ((set >> static_cast<unsigned long>(a)) & 1U) rows.push_back(a);
    bool has_all = true;
    for (Index a : problem.two_sided) has_all = has_all && ((set >> static_cast<unsigned long>(a)) & 1U);
    if (!has_all ||
        static_cast<Index>(rows.size()) > problem.dimension() + static_cast<Index>(problem.two_sided.size()))
      continue;
    truth = oracles::solve_kkt(problem, rows);
    if (oracles::is_exact_solution(problem, truth)) return true;
  }
  return false;
}

/// Whether the rows with weights have one dependence, and it is a contradiction.
bool is_contradiction(const NearestPointProblem& problem, const convex::Vector& farkas) {
  std::vector<Index> rows;
  for (Index a = 0; a < farkas.size(); ++a)
    if (farkas[a] != 0) rows.push_back(a);
  const std::size_t k = rows.size(), n = static_cast<std::size_t>(problem.dimension());
  if (k == 0) return false;
  std::vector<RationalVector> M(n, RationalVector(k + 1));
  for (std::size_t r = 0; r < k; ++r) {
    const convex::Vector u = problem.U.row(rows[r]);
    for (std::size_t i = 0; i < n; ++i) M[i][r] = u[static_cast<Index>(i)];
  }
  const std::vector<std::size_t> pivots = oracles::row_reduce(M, k);
  if (pivots.size() + 1 != k) return false;
  std::size_t free = 0;
  while (free < pivots.size() && pivots[free] == free) ++free;
  RationalVector w(static_cast<std::size_t>(problem.rows()));
  w[static_cast<std::size_t>(rows[free])] = 1;
  for (std::size_t row = 0; row < pivots.size(); ++row)
    w[static_cast<std::size_t>(rows[pivots[row]])] = -M[row][free];
  RationalVector opposite = w;
  for (Rational& weight : opposite) weight = -weight;
  return oracles::is_exact_farkas_witness(problem, w) || oracles::is_exact_farkas_witness(problem, opposite);
}

double norm(const convex::Matrix& A, const RationalVector& x) {
  Rational square = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j)
      square += x[i] * Rational(A(static_cast<Index>(i), static_cast<Index>(j))) * x[j];
  return std::sqrt(square.get_d());
}

bool are_independent(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  std::vector<RationalVector> M;
  for (const Index a : rows) {
    const convex::Vector u = problem.U.row(a);
    M.emplace_back(u.begin(), u.end());
  }
  return oracles::row_reduce(M, static_cast<std::size_t>(problem.dimension())).size() == rows.size();
}

/// Whether what is told of the multipliers where doubles are said to know them is wrong: they are unique
/// where all tight rows are independent, and not where two-sided ones depend on each other.
bool is_uniqueness_wrong(const NearestPointProblem& problem, const Solution& found,
                         const RationalPoint& truth) {
  constexpr double tolerance = 1e-9;
  const bool in_fractions = !found.model.islands.empty() && !found.model.islands[0].in_fractions.empty();
  const convex::Multipliers told = convex::multipliers(problem, found, tolerance, true);
  if (told.is_in_doubt || in_fractions) return false;
  std::vector<Index> tight;
  for (Index a = 0; a < problem.rows(); ++a) {
    Rational slack = -Rational(problem.s[a]);
    const convex::Vector u = problem.U.row(a);
    for (Index i = 0; i < u.size(); ++i) slack += Rational(u[i]) * truth.q[static_cast<std::size_t>(i)];
    if (slack == 0) tight.push_back(a);
  }
  // Rows within the tolerance count as tight.
  if (told.tight != tight) return false;
  return told.unique ? !are_independent(problem, problem.two_sided) : are_independent(problem, tight);
}

enum class Outcome { right, refused, wrong };

Outcome outcome(const NearestPointProblem& problem, const Solution& found, std::string& why) {
  if (found.status == Status::infeasible) {
    if (is_contradiction(problem, found.farkas)) return Outcome::right;
    RationalPoint truth;
    why = "infeasible without a contradiction";
    return find_truth(problem, {}, truth) ? (why = "infeasible, has a solution", Outcome::wrong)
                                          : Outcome::right;
  }
  if (found.status != Status::solved) {
    why = std::string(found.undecided);
    return Outcome::refused;
  }
  for (Index a = 0; a < found.lambda.size(); ++a) {
    const bool two_sided = problem.is_two_sided(a);
    if (two_sided ||
        (found.lambda[a] >= 0 && found.slack[a] >= 0 && !(found.lambda[a] > 0 && found.slack[a] > 0)))
      continue;
    why = "a multiplier or slack of the wrong sign";
    return Outcome::wrong;
  }
  RationalPoint truth;
  if (!find_truth(problem, found.basis, truth)) {
    why = "solved, has no solution";
    return Outcome::wrong;
  }
  const convex::Matrix A = oracles::gram(problem.A);
  RationalVector off = truth.q;
  for (std::size_t i = 0; i < off.size(); ++i) off[i] -= Rational(found.q[static_cast<Index>(i)]);
  const double error = norm(A, off), size = norm(A, truth.q);
  if (is_uniqueness_wrong(problem, found, truth)) {
    why = "multipliers that are unique are told not to be, or the other way round";
    return Outcome::wrong;
  }
  const bool bounded = found.error_bound <= 1.01e-9 * std::max(1.0, size);
  why = "error " + std::to_string(error / size) + " of the size, bound " +
        std::to_string(found.error_bound / size);
  char text[120];
  std::snprintf(text, sizeof text, "error %.2g, bound %.2g, size %.2g", error, found.error_bound, size);
  why = text;
  return bounded && (error <= 10 * found.error_bound || error <= 4e-16 * size) ? Outcome::right
                                                                               : Outcome::wrong;
}

}  // namespace

int main(int argc, char** argv) {
  const bool repeated = argc > 1 && std::string(argv[argc - 1]) == "--repeated";
  if (repeated) --argc;
  const long count = argc > 1 ? std::atol(argv[1]) : 10000;
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atol(argv[2]) : 1966);
  long right = 0, refused = 0, wrong = 0, not_drawn = 0, fractions = 0;
  for (long k = 0; k < count; ++k) {
    const int family = static_cast<int>(k % fuzz::edge_family_count);
    const std::uint64_t own = seed * 1000003 + static_cast<std::uint64_t>(k);
    fuzz::Random random(own);
    std::string why;
    try {
      const NearestPointProblem problem = fuzz::draw_edge(family, random);
      Solution found;
      if (repeated) {
        convex::RepeatedProblem again(problem);
        again.solve(problem.z, convex::Vector(problem.s.array() - 1));
        // So many with one working set find its affine piece.
        for (convex::Index turn = 0; turn <= 2 * problem.dimension() + 1; ++turn)
          again.solve(1.5 * problem.z, 1.5 * problem.s);
        found = again.solve(problem.z, problem.s);
      } else {
        found = convex::automatic(problem);
      }
      if (!found.model.islands.empty() && !found.model.islands[0].in_fractions.empty()) ++fractions;
      const Outcome result = outcome(problem, found, why);
      (result == Outcome::right ? right : result == Outcome::refused ? refused : wrong) += 1;
      if (result != Outcome::right)
        std::printf("%s %s #%ld: %s\n", result == Outcome::wrong ? "WRONG  " : "REFUSED",
                    fuzz::edge_family(family), k, why.c_str());
    } catch (const convex::InvalidInput& error) {
      ++not_drawn;  // A is not definite, as doubles or exactly
      if (std::string(error.what()).find("definite") == std::string::npos) {
        ++wrong;
        std::printf("WRONG   %s #%ld: %s\n", fuzz::edge_family(family), k, error.what());
      }
    }
  }
  std::printf(
      "right %ld, refused %ld, wrong %ld; %ld decided in fractions, %ld with an A that is not definite\n",
      right, refused, wrong, fractions, not_drawn);
  return wrong > 0 || 1000 * refused > count ? 1 : 0;
}
