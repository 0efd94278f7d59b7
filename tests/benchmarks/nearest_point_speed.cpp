// Time of the default method from raw (A, z, U, s), cold, beside the floor: one factorisation with the active
// set known.
//   nearest_point_speed [--smoke]
// Problems are planted: A = BBᵀ/n + I and U Gaussian, min(n, m)/2 active rows with random positive
// multipliers, the others apart. Prints the median of batches; the ratio is between medians of the same run,
// taken in turn.
#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <random>
#include <vector>

#include "convex/nearest_point/active_set.hpp"

namespace {

using convex::Index;
using convex::Matrix;
using convex::RowMatrix;
using convex::Vector;

struct RawProblem {
  Matrix A;
  RowMatrix U;
  Vector z, s, solution;
  std::vector<Index> active;
};

RawProblem planted(Index n, Index m, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto fill = [&](auto& M) {
    for (Index i = 0; i < M.size(); ++i) M.data()[i] = normal(generator);
  };
  RawProblem raw;
  Matrix B(n, n);
  fill(B);
  raw.A = B * B.transpose() / static_cast<double>(n) + Matrix::Identity(n, n);
  raw.U.resize(m, n);
  fill(raw.U);
  raw.solution.resize(n);
  fill(raw.solution);
  Vector lambda = Vector::Zero(m);
  raw.s = raw.U * raw.solution;
  std::vector<Index> rows(static_cast<std::size_t>(m));
  for (Index a = 0; a < m; ++a) rows[static_cast<std::size_t>(a)] = a;
  std::shuffle(rows.begin(), rows.end(), generator);
  const Index k = std::min(n, m) / 2;
  for (Index j = 0; j < m; ++j) {
    const Index a = rows[static_cast<std::size_t>(j)];
    if (j < k) {
      lambda[a] = std::abs(normal(generator)) + 0.01;
      raw.active.push_back(a);
    } else {
      raw.s[a] -= std::abs(normal(generator)) * std::sqrt(static_cast<double>(n));
    }
  }
  raw.z = raw.A * raw.solution - raw.U.transpose() * lambda;
  return raw;
}

/// One Cholesky factor, the active rows whitened, one Householder QR, three triangular solves.
Vector floor_solve(const RawProblem& raw) {
  const Eigen::LLT<Matrix> factor(raw.A);
  const Index n = raw.z.size(), k = static_cast<Index>(raw.active.size());
  Matrix V(n, k);
  Vector s(k);
  for (Index j = 0; j < k; ++j) {
    V.col(j) = raw.U.row(raw.active[static_cast<std::size_t>(j)]);
    s[j] = raw.s[raw.active[static_cast<std::size_t>(j)]];
  }
  factor.matrixL().solveInPlace(V);
  const Vector w_free = factor.matrixL().solve(raw.z);
  const Eigen::HouseholderQR<Matrix> qr(V);
  const auto R = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>();
  Vector t = qr.householderQ().transpose() * w_free;
  t.head(k) = R.transpose().solve(s);
  const Vector w = qr.householderQ() * t;
  return factor.matrixU().solve(w);
}

Vector active_set_solve(const RawProblem& raw, convex::Status& status) {
  const convex::NearestPointProblem problem{
      convex::Metric::dense(raw.A), raw.z, convex::ConstraintRows(raw.U), raw.s, {}};
  const convex::Solution solution = convex::active_set(problem);
  status = solution.status;
  return solution.q;
}

template <class Work>
double seconds_per_call(Work work, int calls) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < calls; ++i) work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / calls;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  std::vector<std::pair<Index, Index>> sizes{{6, 4},   {9, 7},    {12, 10},   {17, 20},   {30, 30},
                                             {45, 60}, {60, 120}, {100, 200}, {140, 280}, {200, 400}};
  if (smoke) sizes = {{6, 4}, {30, 30}};
  std::printf("%5s %5s %12s %12s %8s %10s  %s\n", "n", "m", "solve (us)", "floor (us)", "ratio", "error",
              "status");
  for (const auto& [n, m] : sizes) {
    constexpr unsigned problems = 5;
    std::vector<double> solve_times, floor_times;
    double error = 0;
    bool solved = true;
    for (unsigned seed = 0; seed < problems; ++seed) {
      const RawProblem raw = planted(n, m, 100 * static_cast<unsigned>(n) + seed);
      convex::Status status{};
      const Vector q = active_set_solve(raw, status);
      solved = solved && status == convex::Status::solved;
      error = std::max(error, (q - raw.solution).norm() / raw.solution.norm());
      const double once = seconds_per_call([&] { active_set_solve(raw, status); }, 1);
      const int calls = smoke ? 1 : std::max(1, static_cast<int>(2e-3 / once));
      for (int batch = 0; batch < (smoke ? 1 : 15); ++batch) {
        solve_times.push_back(seconds_per_call([&] { active_set_solve(raw, status); }, calls));
        floor_times.push_back(seconds_per_call([&] { floor_solve(raw); }, calls));
      }
    }
    const double solve = median(solve_times), floor = median(floor_times);
    std::printf("%5ld %5ld %12.2f %12.2f %8.2f %10.1e  %s\n", static_cast<long>(n), static_cast<long>(m),
                solve * 1e6, floor * 1e6, solve / floor, error, solved ? "solved" : "NOT SOLVED");
  }
  return 0;
}
