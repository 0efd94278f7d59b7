#include <cstdio>
#include <cstring>
#include <ctime>
#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"

/// Times of proofs: the plain solve, its enclosure in doubles, the exact solution by verification of the
/// active set, and from nothing.
namespace {

using convex::Index;

/// Processor time.
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Full-mantissa doubles, about half the rows active.
convex::NearestPointProblem random_problem(unsigned seed, Index n, Index m) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const auto random = [&](double) { return normal(generator); };
  const convex::Matrix G = convex::Matrix::Zero(n, n).unaryExpr(random);
  convex::Matrix A = G * G.transpose() / static_cast<double>(n) + convex::Matrix::Identity(n, n);
  A = (0.5 * (A + A.transpose())).eval();
  const convex::RowMatrix U = convex::RowMatrix::Zero(m, n).unaryExpr(random);
  const convex::Vector z = convex::Vector::Zero(n).unaryExpr(random);
  const convex::Vector x = convex::Vector::Zero(n).unaryExpr(random);
  convex::Vector s = U * x;
  for (Index a = 0; a < m; ++a) s[a] -= std::abs(normal(generator)) * (a % 2 == 0 ? 0.1 : 3.0);
  return {convex::Metric::dense(A), z, convex::ConstraintRows(U), s, {}};
}

template <class Work>
double best_time(Work work, int repetitions) {
  double best = 1e300;
  for (int k = 0; k < repetitions; ++k) {
    // What takes microseconds is done some times at once: the clock ticks in these.
    const double start = seconds();
    int done = 0;
    do {
      work();
      ++done;
    } while (seconds() - start < 1e-3);
    best = std::min(best, (seconds() - start) / done);
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  const std::vector<std::pair<Index, Index>> sizes =
      smoke ? std::vector<std::pair<Index, Index>>{{6, 8}}
            : std::vector<std::pair<Index, Index>>{{10, 20}, {20, 40}, {40, 80}, {80, 160}, {100, 200}};
  std::printf("%4s %4s %6s %12s %12s %12s %12s %12s\n", "n", "m", "active", "plain s", "enclosed s", "bound",
              "verified s", "cold s");
  for (const auto& [n, m] : sizes) {
    const convex::NearestPointProblem problem = random_problem(7, n, m);
    const convex::Solution plain = convex::active_set(problem);
    const double plain_time = best_time([&] { convex::active_set(problem); }, 5);
    double bound = -1;
    const double enclosed =
        best_time([&] { bound = convex::enclosed_error(problem, plain).value_or(-1); }, 5);
    const double verified = best_time(
        [&] { convex::exact_active_set(convex::exact_problem(problem), plain.basis); }, n > 40 ? 1 : 3);
    const double cold =
        n > 40 ? 0 : best_time([&] { convex::exact_active_set(convex::exact_problem(problem), {}); }, 1);
    std::printf("%4td %4td %6zu %12.3g %12.3g %12.3g %12.3g %12.3g\n", n, m, plain.basis.size(), plain_time,
                enclosed, bound, verified, cold);
  }
  return 0;
}
