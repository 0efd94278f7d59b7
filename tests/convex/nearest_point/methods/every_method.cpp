#include <doctest/doctest.h>

#include <string>
#include <tuple>

#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/methods.hpp"
#include "convex/nearest_point/methods/crossover.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"
#include "tests/oracles/nearest_point_error.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_kkt.hpp"

using convex::Accuracy;
using convex::Index;
using convex::Matrix;
using convex::Method;
using convex::MethodKind;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Status;
using convex::Vector;
using oracles::Difficulty;
using oracles::few_roundings;
using oracles::scale;

namespace {

/// The methods of the table that apply, but for those that only stand for comparison.
std::vector<Method> solvers(const NearestPointProblem& problem) {
  std::vector<Method> found;
  for (const Method& method : convex::methods())
    if (method.kind != MethodKind::for_comparison && method.applies(problem).empty()) found.push_back(method);
  return found;
}

void expect_right(const NearestPointProblem& problem, const Vector& truth) {
  for (const Method& method : solvers(problem)) {
    CAPTURE(std::string(method.name));
    const double tolerance = 1e-10 * std::min(1.0, scale(problem, truth));
    const Solution found = method.solve(problem, {.tolerance = tolerance});
    CHECK(found.status == Status::solved);
    if (found.q.size() != truth.size()) continue;
    const double error = problem.A.norm(found.q - truth), unit = scale(problem, truth);
    CHECK(error <= (method.kind == MethodKind::direct ? few_roundings : 1e-10) * unit);
    CHECK(error <= found.error_bound + few_roundings * unit);
  }
}

NearestPointProblem two_contacts(double coupling, double first, double second) {
  Matrix A(2, 2);
  A << 1, coupling, coupling, 1;  // U = A and A⁻¹ as the metric: M = U A⁻¹Uᵀ = A
  return {convex::Metric::dense(A),
          Vector::Zero(2),
          convex::ConstraintRows(RowMatrix(A)),
          Eigen::Vector2d(-first, -second),
          {}};
}

}  // namespace

TEST_CASE("every method finds planted solutions, whatever the degeneracy") {
  for (Difficulty difficulty :
       {Difficulty::none, Difficulty::repeated_rows, Difficulty::sums_of_rows, Difficulty::at_rest,
        Difficulty::two_sided_rows, Difficulty::opposite_rows, Difficulty::sparse_rows})
    for (unsigned seed = 0; seed < 12; ++seed) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      const Index n = 1 + static_cast<Index>(seed % 9), m = static_cast<Index>((7 * seed) % 19);
      const auto [problem, solution] = oracles::planted_problem(seed, n, m, difficulty);
      expect_right(problem, solution);
    }
}

TEST_CASE(
    "every method finds the solution among twice as many rows as coordinates, half of them sums of others") {
  const auto [problem, solution] = oracles::planted_problem(3, 30, 60, Difficulty::sums_of_rows);
  expect_right(problem, solution);
}

TEST_CASE(
    "every method is right, or says that it is not, on every family of the gallery at every difficulty") {
  for (const convex::GalleryFamily& family : convex::gallery())
    for (double difficulty : family.ladder) {
      const convex::GalleryInstance instance = convex::gallery_instance(family, 6, difficulty, 3);
      if (instance.problem.rows() > 100) continue;
      CAPTURE(std::string(family.name));
      CAPTURE(difficulty);
      const double unit = instance.feasible ? scale(instance.problem, instance.solution.hi) : 1;
      if (!std::isfinite(unit) || unit < 1e-140) continue;  // their squares leave the range: see units.hpp
      for (const Method& method : convex::methods()) {
        if (!method.applies(instance.problem).empty()) continue;
        CAPTURE(std::string(method.name));
        const Solution found = method.solve(instance.problem, {.tolerance = 1e-10, .step_limit = 3000});
        if (found.status == Status::infeasible) {
          CHECK_FALSE(instance.feasible);
          CHECK(oracles::is_farkas_witness(instance.problem, found.farkas, 1e-12));
        } else if (found.status == Status::solved) {
          CHECK(instance.feasible);
          if (!instance.feasible) continue;
          const Vector error = found.q - instance.solution.hi - instance.solution.lo;
          CHECK(instance.problem.A.norm(error) <= found.error_bound + few_roundings * unit);
        }
      }
    }
}

TEST_CASE(
    "on rows that contradict each other by 1 every method finds weights that a check in fractions accepts") {
  for (unsigned seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    const Index n = 2 + static_cast<Index>(seed % 5);
    auto [problem, solution] = oracles::planted_problem(seed, n, n + 3, Difficulty::none);
    RowMatrix U(problem.rows() + 1, n);
    U << problem.U.dense(), -(problem.U.dense().row(0) + 2 * problem.U.dense().row(1));
    Vector s(problem.rows() + 1);
    s << problem.s, 1 - problem.s[0] - 2 * problem.s[1];
    const NearestPointProblem contradictory{problem.A, problem.z, convex::ConstraintRows(U), s, {}};
    for (const Method& method : solvers(contradictory)) {
      CAPTURE(std::string(method.name));
      const Solution found = method.solve(contradictory, {});
      REQUIRE(found.status == Status::infeasible);
      CHECK(oracles::is_farkas_witness(contradictory, found.farkas, 1e-12));
    }
  }
}

TEST_CASE(
    "rows that exclude each other by one rounding of s have no solution, unless numbers are known to that "
    "rounding only") {
  // 0.1 + 0.2 is 0.3 and a rounding: x >= 0.1 + 0.2 and x <= 0.3 touch if the sum stands for 0.3. Rows apart
  // by 2^-50 meet at about 6 where their entries are off by a rounding; apart by 1e-12 only beyond 1e3 of
  // scale.
  for (const auto& [least, most, touch] :
       {std::tuple{0.1 + 0.2, 0.3, true}, {0.3 + 0x1p-50, 0.3, true}, {0.3 + 1e-12, 0.3, false}}) {
    NearestPointProblem wedge{convex::Metric::identity(2),
                              Vector::Zero(2),
                              convex::ConstraintRows(RowMatrix(Eigen::Matrix2d{{1, 1}, {-1, -1}})),
                              Eigen::Vector2d(least, -most),
                              {}};
    for (const Method& method : solvers(wedge)) {
      CAPTURE(std::string(method.name));
      const Solution as_they_stand = method.solve(wedge, {});
      REQUIRE(as_they_stand.status == Status::infeasible);
      CHECK(oracles::is_farkas_witness(wedge, as_they_stand.farkas, 1e-12));
    }
    wedge.radii = convex::rounding_radii(wedge, 1);
    for (const char* name : {"auto", "active-set"})
      CHECK((convex::find_method(name)->solve(wedge, {}).status == Status::solved) == touch);
  }
}

TEST_CASE("where all rows are two-sided every method holds them all, the dependent ones too") {
  // Of the points of the line x + y = 2 in the plane (1, 1) is nearest to the origin.
  const NearestPointProblem line{convex::Metric::identity(2),
                                 Vector::Zero(2),
                                 convex::ConstraintRows(RowMatrix(Eigen::Matrix2d{{1, 1}, {2, 2}})),
                                 Eigen::Vector2d(2, 4),
                                 {0, 1}};
  const NearestPointProblem point{convex::Metric::identity(1),
                                  Vector::Ones(1),
                                  convex::ConstraintRows(RowMatrix::Ones(1, 1)),
                                  Vector::Constant(1, -3),
                                  {0}};
  expect_right(line, Eigen::Vector2d(1, 1));
  expect_right(point, Vector::Constant(1, -3));
}

TEST_CASE("the rejected rule is never called solved where Delassus' examples refute it") {
  const Method& rule = *convex::find_method("drop-negative");
  // docs/theory.md, B.4: it drops too much, it drops too little.
  for (const NearestPointProblem& problem : {two_contacts(-0.8, 0.92, -0.7), two_contacts(0.8, 1, 0.5)}) {
    const Solution found = rule.solve(problem, {});
    CHECK(found.status == Status::inaccurate);
    CHECK(found.error_bound > 0.1);
    for (const Method& method : solvers(problem)) CHECK(method.solve(problem, {}).status == Status::solved);
  }
}

TEST_CASE("a candidate is not called solved beyond its error, wherever its error lies") {
  const auto [problem, solution] = oracles::planted_problem(4, 6, 8, Difficulty::none);
  const Solution right = convex::crossover(
      problem,
      {.method = "none", .q = solution, .lambda = Vector::Zero(8), .farkas = {}, .may_polish = false}, {});
  CHECK(right.status != Status::infeasible);
  for (double shift : {1e-3, 1e-6, 1e-8})
    for (Index i = 0; i < 6; ++i) {
      Vector q = solution;
      q[i] += shift;
      const Solution exact = convex::find_method("active-set")->solve(problem, {});
      const Solution found = convex::crossover(
          problem, {.method = "none", .q = q, .lambda = exact.lambda, .farkas = {}, .may_polish = false},
          {.tolerance = 1e-12});
      CHECK(found.status == Status::inaccurate);
      CHECK(found.error_bound >= problem.A.norm(q - solution) * (1 - 1e-6));
    }
}

TEST_CASE("a limit on the steps ends in gave-up, not in an answer that is not one") {
  const convex::GalleryInstance hard =
      convex::gallery_instance(*convex::find_family("heavy-on-light"), 60, 1e6);
  for (const char* name : {"projected-gauss-seidel", "accelerated-gradient", "admm"}) {
    CAPTURE(std::string(name));
    const Solution found =
        convex::find_method(name)->solve(hard.problem, {.tolerance = 1e-12, .step_limit = 3});
    CHECK((found.status == Status::gave_up || found.status == Status::solved));
    if (found.status != Status::solved) continue;
    CHECK(hard.problem.A.norm(found.q - hard.solution.hi) <= 1e-12 * scale(hard.problem, hard.solution.hi));
  }
}

TEST_CASE("where dense factors are too large, sparse ones find chains, packings and obstacles just as well") {
  for (const auto& [name, size] : {std::pair{"chain", 3000}, {"hexagonal-packing", 1500}, {"obstacle", 60}}) {
    const convex::GalleryFamily& family = *convex::find_family(name);
    const convex::GalleryInstance instance = convex::gallery_instance(family, size, family.usual);
    REQUIRE_FALSE(convex::is_dense_size(instance.problem));
    for (const char* method :
         {"semismooth-newton", "proximal-point", "interior-point", "accelerated-gradient"}) {
      CAPTURE(std::string(name));
      CAPTURE(std::string(method));
      const Solution found = convex::find_method(method)->solve(instance.problem, {.tolerance = 1e-10});
      REQUIRE(found.status == Status::solved);
      const Vector error = found.q - instance.solution.hi - instance.solution.lo;
      CHECK(instance.problem.A.norm(error) <= few_roundings * scale(instance.problem, instance.solution.hi));
    }
  }
}

TEST_CASE("enumerate refuses more rows than it can try, and says so") {
  const auto [problem, solution] = oracles::planted_problem(1, 5, 30, Difficulty::none);
  CHECK(convex::find_method("enumerate")->applies(problem).find("30 one-sided rows") != std::string::npos);
}
