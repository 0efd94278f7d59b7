#include <doctest/doctest.h>

#include "convex/nearest_point/methods.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "tests/stability/naive_methods.hpp"

using convex::GalleryInstance;
using convex::Index;
using convex::Status;

TEST_CASE("dependent rows: the Delassus matrix has no factor, and its answer is not called solved") {
  for (const char* family : {"redundant", "repeated"})
    for (const double difficulty : {1.0, 2.0, 4.0}) {
      CAPTURE(family);
      CAPTURE(difficulty);
      const GalleryInstance instance = instance_of(family, 12, difficulty);
      const naive::Answer answer = naive::delassus_matrix(instance.problem, loaded_rows(instance));
      CHECK(answer.says_solved);
      CHECK(true_error(instance, answer.q) > 1e-2);
      CHECK(naive::judged(instance.problem, answer) != Status::solved);
      const convex::Solution found = by_default(instance.problem);
      CHECK(found.status == Status::solved);
      CHECK(true_error(instance, found.q) <= few_roundings);
      CHECK_FALSE(convex::multipliers(instance.problem, found, 1e-9, false).unique);
    }
}

TEST_CASE(
    "no point strictly inside: a barrier finds no start, pivoting ends on a ray, the default is right") {
  for (const double part : {0.1, 0.5, 1.0}) {
    CAPTURE(part);
    const GalleryInstance instance = instance_of("no-interior", 12, part);
    CHECK_FALSE(naive::barrier(instance.problem, 1e-9).says_solved);
    const convex::Solution found = by_default(instance.problem);
    CHECK(found.status == Status::solved);
    CHECK(true_error(instance, found.q) <= few_roundings);
  }
  // Which of them end on a ray is up to roundings: opposite rows make the pivot a difference of equal
  // numbers.
  int rays = 0;
  for (Index size = 6; size <= 24; ++size)
    for (const double part : {0.1, 0.25, 0.5, 1.0}) {
      const GalleryInstance instance = instance_of("no-interior", size, part);
      const naive::Answer ray = naive::lemke_by_first_row(instance.problem, 500);
      if (ray.says_solved) continue;
      ++rays;
      CHECK(naive::judged(instance.problem, ray) != Status::solved);
    }
  CHECK(rays > 0);
}

TEST_CASE("a degenerate corner: a barrier loses half of its digits and is told so, the default none") {
  for (const double slack : {1e-4, 1e-8, 0.0}) {
    CAPTURE(slack);
    const GalleryInstance instance = instance_of("weakly-active", 12, slack);
    const naive::Answer answer = naive::barrier(instance.problem, 1e-9);
    CHECK(answer.says_solved);
    CHECK(true_error(instance, answer.q) > 1e-8);
    CHECK(naive::judged(instance.problem, answer) != Status::solved);
    const convex::Solution found = by_default(instance.problem);
    CHECK(found.status == Status::solved);
    CHECK(true_error(instance, found.q) <= few_roundings);
  }
}

TEST_CASE("cycling: changing all wrong rows at once comes back to where it was, the default ends") {
  // Found by trying small integer matrices; by elimination q = (0, 2, 13/11), lambda = (6/11, 0, 0).
  convex::Matrix A(3, 3);
  A << 17, 10, -19, 10, 6, -11, -19, -11, 22;
  const convex::NearestPointProblem problem{
      convex::Metric::dense(A),
      convex::Vector{{-3, -1, 4}},
      convex::ConstraintRows(convex::RowMatrix(convex::RowMatrix::Identity(3, 3))),
      convex::Vector::Zero(3),
      {}};
  for (const int rounds : {1000, 1001, 1002}) {
    const naive::Answer answer = naive::all_at_once(problem, rounds);
    CHECK_FALSE(answer.says_solved);
    CHECK(naive::judged(problem, answer) == Status::gave_up);
  }
  for (const char* method : {"auto", "active-set", "block-pivoting", "lemke", "semismooth-newton"}) {
    CAPTURE(method);
    const convex::Solution found = convex::find_method(method)->solve(problem, {});
    CHECK(found.status == Status::solved);
    CHECK(found.q[0] == 0);
    CHECK(std::abs(found.q[1] - 2) <= 4e-16 * 2);
    CHECK(std::abs(found.q[2] - 13.0 / 11) <= 4e-16 * 2);
    CHECK(std::abs(found.lambda[0] - 6.0 / 11) <= 1e-14);
  }
}
