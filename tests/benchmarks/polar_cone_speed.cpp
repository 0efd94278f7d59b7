// Time to find the facets of a pointed cone, exactly and proved, beside the Parma Polyhedra Library (PPL 1.2)
// and cddlib's exact double description where they are installed (Debian: libppl-dev, libcdd-dev).
//   polar_cone_speed [--smoke]
// Generators are random integers: uniform in 0..2, with many ties, or in -9..9 with the last one in 1..9,
// with many redundant. All take the same rows in the same order; the numbers of facets must agree. Medians of
// CPU time over the seeds, each taken in turn in one run. cddlib needs minutes for the last line and sits it
// out.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "convex/cones/polyhedral_cone.hpp"

#ifdef MOREAU_HAS_PPL
#include <ppl.hh>
#endif
#ifdef MOREAU_HAS_CDD
#define GMPRATIONAL
extern "C" {
#include <cddlib/setoper.h>
// After setoper.h, as cddlib wants it.
#include <cddlib/cdd.h>
}
#endif

namespace {

using convex::Index;
using convex::Matrix;

struct Family {
  const char* name;
  int low, high, lowest_height;
};

constexpr Family tied{"0..2", 0, 2, 0}, wide{"-9..9", -9, 9, 1};

Matrix generators(const Family& family, Index d, Index m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> any(family.low, family.high), height(family.lowest_height, family.high);
  Matrix G(m, d);
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < d; ++j) G(i, j) = j + 1 < d ? any(random) : height(random);
  return G;
}

std::size_t ours(const Matrix& G) { return convex::generated_cone(G).halfspaces.size(); }

#ifdef MOREAU_HAS_PPL
std::size_t by_ppl(const Matrix& G) {
  namespace PPL = Parma_Polyhedra_Library;
  PPL::Generator_System rows;
  rows.insert(PPL::point());
  for (Index i = 0; i < G.rows(); ++i) {
    PPL::Linear_Expression sum;
    for (Index j = 0; j < G.cols(); ++j)
      sum += static_cast<int>(G(i, j)) * PPL::Variable(static_cast<PPL::dimension_type>(j));
    rows.insert(PPL::ray(sum));
  }
  const PPL::C_Polyhedron cone(rows);
  const PPL::Constraint_System& facets = cone.minimized_constraints();
  return static_cast<std::size_t>(std::distance(facets.begin(), facets.end()));
}
#endif

#ifdef MOREAU_HAS_CDD
std::size_t by_cdd(const Matrix& G) {
  dd_MatrixPtr rows = dd_CreateMatrix(G.rows(), G.cols() + 1);
  rows->representation = dd_Generator;
  rows->numbtype = dd_Rational;
  for (Index i = 0; i < G.rows(); ++i)
    for (Index j = 0; j < G.cols(); ++j)
      dd_set_si(rows->matrix[i][j + 1], static_cast<long>(G(i, j)));  // column 0: 0, a ray
  dd_ErrorType error = dd_NoError;
  dd_PolyhedraPtr cone = dd_DDMatrix2Poly(rows, &error);
  dd_MatrixPtr facets = dd_CopyInequalities(cone);
  const auto count = static_cast<std::size_t>(facets->rowsize);
  dd_FreeMatrix(facets);
  dd_FreePolyhedra(cone);
  dd_FreeMatrix(rows);
  return count;
}
#endif

struct Contestant {
  std::string name;
  std::function<std::size_t(const Matrix&)> run;
  bool patient = true;  ///< takes part where it needs minutes
  std::vector<double> seconds;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

bool compare(const Family& family, Index d, Index m, unsigned seeds, bool for_all = true) {
  std::vector<Contestant> all{{"moreau", ours, true, {}}};
#ifdef MOREAU_HAS_PPL
  all.push_back({"PPL", by_ppl, true, {}});
#endif
#ifdef MOREAU_HAS_CDD
  all.push_back({"cddlib", by_cdd, false, {}});
#endif
  if (!for_all) std::erase_if(all, [](const Contestant& contestant) { return !contestant.patient; });
  bool agree = true;
  std::vector<double> facets;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const Matrix G = generators(family, d, m, seed);
    for (Contestant& contestant : all) {
      const std::clock_t start = std::clock();
      const std::size_t count = contestant.run(G);
      contestant.seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
      if (&contestant == &all.front())
        facets.push_back(static_cast<double>(count));
      else if (static_cast<double>(count) != facets.back()) {
        std::printf("%s finds %zu facets, moreau %.0f\n", contestant.name.c_str(), count, facets.back());
        agree = false;
      }
    }
  }
  const double own = median(all.front().seconds);
  std::printf("%-6s %3td %5td %8.0f", family.name, d, m, median(facets));
  for (const Contestant& contestant : all)
    std::printf("   %s %.4f s (%.1fx)", contestant.name.c_str(), median(contestant.seconds),
                median(contestant.seconds) / own);
  std::printf("\n");
  std::fflush(stdout);
  return agree;
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
#ifdef MOREAU_HAS_CDD
  dd_set_global_constants();
#endif
  std::printf("entries  d     m   facets   median CPU time (over moreau's)\n");
  if (smoke) return compare(wide, 4, 20, 1) ? 0 : 1;
  bool agree = compare(wide, 4, 200, 3);
  agree = compare(wide, 6, 100, 3) && agree;
  agree = compare(wide, 8, 50, 3) && agree;
  agree = compare(tied, 8, 200, 3) && agree;
  agree = compare(wide, 8, 200, 3, false) && agree;
  return agree ? 0 : 1;
}
