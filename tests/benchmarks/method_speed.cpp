// Time of every method from A, z, U, s at hand, as a ratio to active-set, on planted dense problems.
//   method_speed [--smoke]
// Each cell: the median over problems and batches, and how it ended where it is not solved.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <random>
#include <vector>

#include "convex/nearest_point/methods.hpp"

namespace {

using convex::Index;
using convex::Matrix;
using convex::RowMatrix;
using convex::Vector;

convex::NearestPointProblem planted(Index n, Index m, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto fill = [&](auto& M) {
    for (Index i = 0; i < M.size(); ++i) M.data()[i] = normal(generator);
  };
  Matrix B(n, n);
  RowMatrix U(m, n);
  Vector x(n), lambda = Vector::Zero(m);
  fill(B);
  fill(U);
  fill(x);
  Vector s = U * x;
  for (Index a = 0; a < m; ++a) {
    if (a < std::min(n, m) / 2)
      lambda[a] = std::abs(normal(generator)) + 0.01;
    else
      s[a] -= std::abs(normal(generator)) * std::sqrt(static_cast<double>(n));
  }
  const Matrix A = B * B.transpose() / static_cast<double>(n) + Matrix::Identity(n, n);
  return {convex::Metric::dense(A), A * x - U.transpose() * lambda, convex::ConstraintRows(U), s, {}};
}

double seconds(const convex::Method& method, const convex::NearestPointProblem& problem,
               convex::Status& status) {
  const auto start = std::chrono::steady_clock::now();
  status = method.solve(problem, {}).status;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  std::vector<std::pair<Index, Index>> sizes{{6, 4}, {12, 10}, {30, 30}, {60, 120}, {100, 200}, {200, 400}};
  if (smoke) sizes = {{6, 4}};
  const convex::Method& reference = *convex::find_method("active-set");
  for (const auto& [n, m] : sizes) {
    std::printf("n = %ld, m = %ld\n", static_cast<long>(n), static_cast<long>(m));
    double base = 0;
    const auto row = [&](const convex::Method& method) {
      std::vector<double> times;
      bool solved = true;
      for (unsigned seed = 0; seed < 3; ++seed) {
        const convex::NearestPointProblem problem = planted(n, m, seed);
        if (!method.applies(problem).empty()) return;
        convex::Status status{};
        double once = seconds(method, problem, status);
        for (int batch = 0; batch < (once < 0.1 && !smoke ? 9 : 1); ++batch)
          times.push_back(seconds(method, problem, status));
        solved = solved && status == convex::Status::solved;
      }
      std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                       times.end());
      const double median = times[times.size() / 2];
      if (base == 0) base = median;
      std::printf("  %-24s %12.1f us %10.1f x  %s\n", std::string(method.name).c_str(), median * 1e6,
                  median / base, solved ? "solved" : "NOT SOLVED");
    };
    row(reference);
    for (const convex::Method& method : convex::methods())
      if (method.name != reference.name) row(method);
  }
  return 0;
}
