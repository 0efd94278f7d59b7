#include "convex/nearest_point/common_size.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "convex/nearest_point/methods.hpp"
#include "tests/oracles/nearest_point_error.hpp"

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Status;
using convex::Vector;

namespace {

/// A = 1, z = (3, -1).
NearestPointProblem in_the_plane(const RowMatrix& U, const Vector& s, std::vector<Index> two_sided = {}) {
  return {convex::Metric::identity(2), Eigen::Vector2d(3, -1), convex::ConstraintRows(U), s,
          std::move(two_sided)};
}

template <class Expect>
void each_method(const NearestPointProblem& problem, Expect expect) {
  for (const convex::Method& method : convex::methods()) {
    if (method.kind == convex::MethodKind::for_comparison || !method.applies(problem).empty()) continue;
    CAPTURE(std::string(method.name));
    for (const double limit : {0.0, 1.0}) {
      CAPTURE(limit);
      expect(method, method.solve(problem, {.limit = limit}));
    }
  }
}

}  // namespace

TEST_CASE("a bound that asks for nothing changes no answer, however large it is") {
  RowMatrix U(3, 2);
  U << 1, 1, -1, 2, 2, 1;
  for (const double none : {-1e50, -1e150, -1e200, -1e300, -1.7e308}) {
    CAPTURE(none);
    // The first row holds: q = (4, 0) on q0 + q1 = 4; the last is far.
    each_method(in_the_plane(U, Eigen::Vector3d(4, none, -5)),
                [](const convex::Method& method, const Solution& found) {
                  CHECK(found.status == Status::solved);
                  if (found.q.size() != 2) return;
                  const double error = std::hypot(found.q[0] - 4, found.q[1]);
                  const double most = method.kind == convex::MethodKind::iterative ? 1e-8 : 1e-14;
                  CHECK(error <= most);
                  CHECK(error <= found.error_bound + oracles::few_roundings * 4);
                });
  }
}

TEST_CASE("rows of any length are rows") {
  for (const double size : {1e-305, 1e-300, 1e-160, 1e160, 1e300}) {
    CAPTURE(size);
    RowMatrix U(3, 2);
    U << size, size, 1, 0, 0, -1 / 3.0;
    each_method(in_the_plane(U, Eigen::Vector3d(4 * size, -9, -9)),
                [](const convex::Method&, const Solution& found) {
                  CHECK(found.status == Status::solved);
                  if (found.q.size() == 2) CHECK(std::hypot(found.q[0] - 4, found.q[1]) <= 1e-8);
                });
  }
}

TEST_CASE("numbers that are lost beside others in every common size are never said to be solved wrongly") {
  const double least = 5e-324;
  RowMatrix opposite(2, 2), with_zero(2, 2), tiny(2, 2);
  opposite << 1, 0, -1, 0;
  with_zero << 1, 0, 0, 0;
  tiny << least, 0, -1, 0;
  // q0 >= 0 and -q0 >= 5e-324; 0 >= 5e-324; 5e-324 q0 >= 5e-324 and -q0 >= 1, which no motion keeps.
  for (const auto& [U, s] : {std::pair<RowMatrix, Vector>{opposite, Eigen::Vector2d(0, least)},
                             {with_zero, Eigen::Vector2d(-1e308, least)},
                             {tiny, Eigen::Vector2d(least, 1)}})
    each_method(in_the_plane(U, s), [](const convex::Method& method, const Solution& found) {
      CHECK(found.status != Status::solved);
      if (method.name == "exact") CHECK(found.status == Status::infeasible);
    });
}

TEST_CASE("rows that motions of the order of 1e300 satisfy contradict nothing") {
  RowMatrix U(2, 2);
  U << 1e-300, 0, 0, 1;
  const NearestPointProblem problem = in_the_plane(U, Eigen::Vector2d(1, -1));  // q = (1e300, -1)
  each_method(problem, [](const convex::Method&, const Solution& found) {
    CHECK(found.status != Status::infeasible);
    if (found.status == Status::solved) CHECK(std::abs(found.q[0] / 1e300 - 1) <= 1e-9);
  });
}
