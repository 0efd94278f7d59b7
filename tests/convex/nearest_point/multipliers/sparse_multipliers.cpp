#include <doctest/doctest.h>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/isotonic/peeling.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "convex/nearest_point/multipliers/sparse_multipliers.hpp"

using convex::Index;
using convex::RowMatrix;
using convex::Vector;

TEST_CASE("sparse factors find the multipliers of least norm that the dense method finds") {
  const convex::GalleryFamily* family = convex::find_family("hexagonal-packing");
  REQUIRE(family != nullptr);
  for (Index discs : {9, 30, 60}) {
    const convex::GalleryInstance instance = convex::gallery_instance(*family, discs, family->usual);
    const convex::Solution solution = convex::automatic(instance.problem);
    const convex::Multipliers dense = convex::multipliers(instance.problem, solution, 1e-9, false);
    Vector lambda = instance.multipliers;
    REQUIRE(convex::least_norm_multipliers(instance.problem, dense.tight, lambda));
    CHECK((lambda - dense.least_norm).norm() <= 1e-10 * (1 + lambda.norm()));
    CHECK(convex::sparse_rows_are_independent(instance.problem, solution.basis));
    if (!dense.unique) CHECK_FALSE(convex::sparse_rows_are_independent(instance.problem, dense.tight));
  }
}

TEST_CASE("peeling leaves the rows of cycles and repetitions, and nothing of a forest") {
  RowMatrix U = RowMatrix::Zero(6, 6);
  U(0, 0) = U(0, 1) = 1;  // a tree
  U(1, 1) = U(1, 2) = 1;
  U(2, 3) = U(2, 4) = 1;  // a triangle with a tail
  U(3, 4) = U(3, 5) = 1;
  U(4, 5) = U(4, 3) = 1;
  U(5, 3) = U(5, 0) = 1;
  CHECK(convex::rows_left_by_peeling(convex::ConstraintRows(U), {0, 1, 5}).empty());
  CHECK(convex::rows_left_by_peeling(convex::ConstraintRows(U), {0, 1, 2, 3, 4, 5}) ==
        std::vector<Index>{2, 3, 4});
  CHECK(convex::rows_left_by_peeling(convex::ConstraintRows(U), {2, 2}) == std::vector<Index>{2, 2});
}
