// Time of the default method on the large families of the gallery, from (A, z, U, s) with A factored or
// diagonal, cold:
//   sparse_speed [--smoke]
// Prints the least of three runs, in wall-clock and in processor time, the error ||q - q*||_A over
// max(||q*||_A,
// ||z||_(A⁻¹)), the bound, and the method. The last lines are chains with one link twice as strong, which is
// no chain.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"

namespace {

using convex::GalleryInstance;
using convex::Index;

void run(const char* name, Index size, const GalleryInstance& instance, bool known) {
  constexpr int repetitions = 3;
  double wall = 1e300, processor = 1e300;
  convex::Solution found;
  for (int k = 0; k < repetitions; ++k) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t begin = std::clock();
    found = convex::automatic(instance.problem);
    processor = std::min(processor, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    wall = std::min(wall, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  double error = -1;
  const convex::NearestPointProblem& problem = instance.problem;
  if (known && found.q.size() == instance.solution.size()) {
    const double scale = std::max(problem.A.norm(instance.solution.hi), problem.A.dual_norm(problem.z));
    error = problem.A.norm(found.q - instance.solution.hi) / scale;
  }
  std::printf("%-18s %8ld %10.3f %10.3f %9.1e %9.1e %9.1e  %s%s\n", name, static_cast<long>(size), 1e3 * wall,
              1e3 * processor, error, found.error_bound, found.residuals.feasibility,
              std::string(found.method).c_str(),
              found.status == convex::Status::solved ? "" : " (not solved)");
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  std::printf("%-18s %8s %10s %10s %9s %9s %9s  %s\n", "family", "size", "wall (ms)", "cpu (ms)", "error",
              "bound", "violation", "method");
  struct Row {
    const char* family;
    std::vector<Index> sizes;
    double difficulty;
  };
  std::vector<Row> rows{{"chain", {100, 1000, 10000, 100000}, 1e3},
                        {"hexagonal-packing", {100, 1000, 10000}, 0.5},
                        {"obstacle", {32, 64, 128, 256, 512, 1024}, 0.5}};
  if (smoke) rows = {{"chain", {100}, 1e3}, {"hexagonal-packing", {100}, 0.5}, {"obstacle", {32}, 0.5}};
  for (const Row& row : rows)
    for (Index size : row.sizes) {
      const convex::GalleryFamily* family = convex::find_family(row.family);
      run(row.family, size, convex::gallery_instance(*family, size, row.difficulty), true);
    }
  for (Index size : smoke ? std::vector<Index>{300} : std::vector<Index>{300, 1000, 10000}) {
    GalleryInstance instance = convex::gallery_instance(*convex::find_family("chain"), size, 1e3);
    convex::SparseRows U = instance.problem.U.sparse();
    U.coeffRef(size / 2, size / 2) *= 2;
    instance.problem.U = convex::ConstraintRows(U);
    run("chain, spoiled", size, instance, false);
  }
}
