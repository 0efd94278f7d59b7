#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <thread>
#include <vector>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/repeated_problem.hpp"

/// Many small problems in C++, for tests/benchmarks/python_speed: of 6 coordinates and 4 contacts, read as
/// doubles from a file, one after the other A (6×6), z (6), U (4×6), s (4).
namespace {

using convex::Index;
using convex::RowMatrix;
using convex::Vector;

constexpr Index n = 6, m = 4, size = n * n + n + m * n + m;

convex::NearestPointProblem problem_of(const double* numbers) {
  return {convex::Metric::dense(Eigen::Map<const convex::Matrix>(numbers, n, n)),
          Eigen::Map<const Vector>(numbers + n * n, n),
          convex::ConstraintRows(RowMatrix(Eigen::Map<const RowMatrix>(numbers + n * n + n, m, n))),
          Eigen::Map<const Vector>(numbers + n * n + n + m * n, m),
          {}};
}

/// Seconds for all, the least of some runs, shared out over all processors in chunks as `moreau.solve` does.
template <class Chunk>
double seconds(Index count, const Chunk& chunk) {
  constexpr int runs = 5;
  constexpr Index chunk_size = 256;
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    std::atomic<Index> next = 0;
    const auto work = [&] {
      for (Index first; (first = chunk_size * next++) < count;)
        chunk(first, std::min(count, first + chunk_size));
    };
    std::vector<std::thread> others;
    for (unsigned k = 1; k < std::thread::hardware_concurrency(); ++k) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "batch_speed FILE\n"), 2;
  std::ifstream file(argv[1], std::ios::binary | std::ios::ate);
  const auto count = static_cast<Index>(file.tellg()) / (size * static_cast<Index>(sizeof(double)));
  std::vector<double> numbers(static_cast<std::size_t>(count * size));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(numbers.data()), count * size * static_cast<Index>(sizeof(double)));
  RowMatrix q(count, n), lambda(count, m);
  const auto take = [&](Index k, const convex::Solution& solution) {
    q.row(k) = solution.q;
    lambda.row(k) = solution.lambda;
  };
  const double each = seconds(count, [&](Index first, Index last) {
    for (Index k = first; k < last; ++k) take(k, convex::automatic(problem_of(numbers.data() + k * size)));
  });
  const double common = seconds(count, [&](Index first, Index last) {
    convex::RepeatedProblem repeated(problem_of(numbers.data()));
    for (Index k = first; k < last; ++k) {
      const double* const own = numbers.data() + k * size;
      take(k, repeated.solve(Eigen::Map<const Vector>(own + n * n, n),
                             Eigen::Map<const Vector>(own + size - m, m)));
    }
  });
  constexpr int calls = 20000;
  double one = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 5; ++run) {
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < calls; ++k) take(0, convex::automatic(problem_of(numbers.data())));
    one = std::min(one,
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / calls);
  }
  std::printf("%.9g %.9g %.9g\n", one, each, common);
  return 0;
}
