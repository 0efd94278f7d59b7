#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"
#include "tests/fuzz/sparse_families.hpp"
#include "tests/oracles/rational_elimination.hpp"

/// sparse_fuzzer COUNT [SEED [ONLY]]: draws so many sparse problems at the edge of rounding around their
/// solutions, solves them by the default method and by the sparse active set, and compares. Exit 1 when one
/// is wrong, or more than one in a thousand is refused. ONLY: this one alone, with what is off.

namespace {

using convex::Index;
using convex::Solution;
using convex::Status;
using convex::Vector;
using fuzz::PlantedSparse;

/// ||q - q*||_A; both are doubles.
double error(const PlantedSparse& planted, const Vector& q) {
  const Vector off = q - planted.q;
  return planted.problem.A.norm(off);
}

std::string verdict(const PlantedSparse& planted, const Solution& found, bool& refused) {
  char text[200];
  const convex::NearestPointProblem& problem = planted.problem;
  if (found.status == Status::infeasible) return planted.q.size() == 0 ? "" : "infeasible, has a solution";
  refused = found.status != Status::solved;
  if (refused) {
    std::snprintf(text, sizeof text, "%s, bound %.2g, error %.2g", std::string(found.undecided).c_str(),
                  found.error_bound,
                  planted.q.size() == found.q.size() && found.q.size() > 0 ? error(planted, found.q) : -1.0);
    return text;
  }
  if (planted.q.size() == 0) return "solved, has no solution";
  const double off = error(planted, found.q), size = problem.A.norm(planted.q);
  std::snprintf(text, sizeof text, "error %.2g, bound %.2g, size %.2g", off, found.error_bound, size);
  if (!(found.error_bound <= 1.01e-9 * std::max(1.0, size)) ||
      !(off <= 10 * found.error_bound + 0x1p-95 * problem.A.dual_norm(problem.z) || off <= 4e-16 * size))
    return text;
  for (Index a = 0; a < problem.rows(); ++a) {
    if ((found.slack[a] > 0) == (planted.slack[a] > 0) && !(found.slack[a] < 0)) continue;
    std::snprintf(text, sizeof text, "row %ld has the slack %.3g, told as %.3g", static_cast<long>(a),
                  planted.slack[a], found.slack[a]);
    return text;
  }
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 1000;
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atol(argv[2]) : 1966);
  const long only = argc > 3 ? std::atol(argv[3]) : -1;
  long right = 0, refused = 0, wrong = 0, fractions = 0, handed_on = 0;
  for (long k = 0; k < count; ++k) {
    if (only >= 0 && k != only) continue;
    const int family = static_cast<int>(k % fuzz::sparse_family_count);
    fuzz::Random random(seed * 1000003 + static_cast<std::uint64_t>(k));
    const PlantedSparse planted = fuzz::draw_sparse(family, random);
    for (const bool directly : {false, true}) {
      std::string why;
      bool is_refused = false;
      std::string_view method;
      try {
        const Solution found =
            directly ? convex::sparse_active_set(planted.problem) : convex::automatic(planted.problem);
        method = found.method;
        for (const auto& island : found.model.islands)
          if (!island.in_fractions.empty()) {
            ++fractions;
            break;
          }
        why = verdict(planted, found, is_refused);
      } catch (const convex::InvalidInput& failure) {
        why = failure.what();
      }
      if (directly && is_refused) {  // the default method goes on with what it learned
        ++handed_on;
        continue;
      }
      (why.empty() ? right : is_refused ? refused : wrong) += 1;
      if (!why.empty())
        std::printf("%s %s #%ld n %ld m %ld by %s: %s\n", is_refused ? "REFUSED" : "WRONG  ",
                    fuzz::sparse_family(family), k, static_cast<long>(planted.problem.dimension()),
                    static_cast<long>(planted.problem.rows()), std::string(method).c_str(), why.c_str());
    }
  }
  std::printf("right %ld, refused %ld, wrong %ld; %ld decided in fractions, %ld handed on\n", right, refused,
              wrong, fractions, handed_on);
  return wrong > 0 || 1000 * refused > count ? 1 : 0;
}
