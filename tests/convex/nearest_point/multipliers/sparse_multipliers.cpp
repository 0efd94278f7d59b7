#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>

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

TEST_CASE("multipliers of sparse rows that repeat each other balance A q - z") {
  constexpr Index n = 300, m = 750;
  for (unsigned seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    const auto draw = [&](int low, int high) {
      return std::uniform_int_distribution<int>(low, high)(random);
    };
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<std::vector<std::pair<int, double>>> rows(m);
    Vector planted(m);
    const Vector q = Vector::NullaryExpr(n, [&] { return static_cast<double>(draw(-3, 3)); });
    Vector z = q, s(m);
    for (int a = 0; a < m; ++a) {
      auto& row = rows[static_cast<std::size_t>(a)];
      if (a > 0 && draw(0, 9) == 0) {
        row = rows[static_cast<std::size_t>(draw(0, a - 1))];
        for (auto& entry : row) entry.second *= 2;
      } else {
        const int middle = a * static_cast<int>(n) / static_cast<int>(m);
        for (int k = draw(1, 4); k > 0; --k) {
          const int i = std::clamp(middle + draw(-20, 20), 0, static_cast<int>(n) - 1);
          const bool is_there =
              std::any_of(row.begin(), row.end(), [&](const auto& e) { return e.first == i; });
          if (!is_there) row.emplace_back(i, draw(0, 1) == 0 ? -1 : 2);
        }
      }
      const bool is_tight = draw(0, 9) < 6;
      const int lambda = is_tight ? draw(0, 3) : 0;
      planted[a] = lambda;
      s[a] = is_tight ? 0 : -draw(1, 2);
      for (const auto& [i, u] : row) {
        entries.emplace_back(a, i, u);
        s[a] += u * q[i];
        z[i] -= u * lambda;
      }
    }
    convex::SparseRows U(m, n);
    U.setFromTriplets(entries.begin(), entries.end());
    const convex::NearestPointProblem problem{
        convex::Metric::identity(n), z, convex::ConstraintRows(U), s, {}};
    const convex::Solution solution = convex::automatic(problem);
    REQUIRE(solution.status == convex::Status::solved);
    CHECK((solution.q - q).norm() <= 1e-9 * q.norm());
    for (const bool ranges : {false, true}) {
      const convex::Multipliers found = convex::multipliers(problem, solution, 1e-9, ranges);
      CHECK((problem.U.transpose_times(found.least_norm) - (q - z)).norm() <= 1e-9 * z.norm());
      CHECK(found.least_norm.minCoeff() >= 0);
      if (!ranges) continue;
      REQUIRE(found.ranges.has_value());
      bool all_hold = true;  // both are multipliers of the problem
      for (Index a = 0; a < m; ++a) {
        const auto [low, high] = (*found.ranges)[static_cast<std::size_t>(a)];
        const double most = std::max(planted[a], found.least_norm[a]),
                     least = std::min(planted[a], found.least_norm[a]);
        all_hold = all_hold && low <= least + 1e-9 && most <= high + 1e-9;
      }
      CHECK(all_hold);
    }
  }
}

TEST_CASE("in a stack whose gaps are written twice each of them may carry all that lies above") {
  constexpr int blocks = 200, load = 20;
  std::vector<Eigen::Triplet<double>> entries{{0, 0, 1.0}};
  int row = 1;
  for (int copy = 0; copy < 2; ++copy)
    for (int i = 0; i + 1 < blocks; ++i, ++row) {
      entries.emplace_back(row, i + 1, 1.0);
      entries.emplace_back(row, i, -1.0);
    }
  for (int i = 0; i + 2 < blocks; ++i, ++row) {  // over two: a sum of two gaps
    entries.emplace_back(row, i + 2, 1.0);
    entries.emplace_back(row, i, -1.0);
  }
  convex::SparseRows U(row, blocks);
  U.setFromTriplets(entries.begin(), entries.end());
  const convex::NearestPointProblem problem{convex::Metric::identity(blocks),
                                            Vector::Constant(blocks, -load),
                                            convex::ConstraintRows(U),
                                            Vector::Zero(row),
                                            {}};
  const convex::Solution solution = convex::automatic(problem);
  REQUIRE(solution.status == convex::Status::solved);
  const convex::Multipliers found = convex::multipliers(problem, solution, 1e-9, true);
  CHECK_FALSE(found.unique);
  REQUIRE(found.ranges.has_value());
  CHECK((*found.ranges)[0].low == doctest::Approx(load * blocks));
  for (int i = 0; i + 1 < blocks; ++i) {
    const auto [low, high] = (*found.ranges)[static_cast<std::size_t>(1 + i)];
    CHECK(std::abs(low) <= 1e-9);
    CHECK(high == doctest::Approx(load * (blocks - 1 - i)));
  }
}

TEST_CASE("where a multiplier is beyond doubles, none of least norm is claimed") {
  RowMatrix U(2, 1);
  U << 5e-324, 1;
  const NearestPointProblem problem{
      convex::Metric::identity(1), Vector::Constant(1, -1), convex::ConstraintRows(U), Vector::Zero(2), {0}};
  Vector lambda{{std::numeric_limits<double>::infinity(), 0}};
  CHECK_FALSE(convex::least_norm_multipliers(problem, {0, 1}, lambda));
}

TEST_CASE("rows that touch without a load make multipliers not unique where a positive sum of them is held") {
  const auto can_open = [](std::initializer_list<double> last) {
    RowMatrix U(3, 3);
    U << 1, 0, 0, 0, 1, 0, 0, 0, 0;
    std::copy(last.begin(), last.end(), U.row(2).begin());
    return convex::can_open(
        {convex::Metric::identity(3), Vector::Zero(3), convex::ConstraintRows(U), Vector::Zero(3), {}},
        {0, 1}, {2});
  };
  CHECK(can_open({0, 0, 1}));
  CHECK(can_open({1, 1, -1e-6}));
  CHECK_FALSE(can_open({1, 1, 0}));
  CHECK_FALSE(can_open({-1, 1, 0}));
}

TEST_CASE(
    "a copy of every row makes multipliers not unique where there are too many for a dense factor too") {
  constexpr Index n = 1300;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index row = 0; row < 2 * (n - 1); ++row) {
    const Index i = row % (n - 1);
    entries.emplace_back(static_cast<int>(row), static_cast<int>(i), -1.0);
    entries.emplace_back(static_cast<int>(row), static_cast<int>(i + 1), 1.0);
  }
  convex::SparseRows U(2 * (n - 1), n);
  U.setFromTriplets(entries.begin(), entries.end());
  const convex::NearestPointProblem problem{convex::Metric::identity(n),
                                            -Vector::LinSpaced(n, 0, n - 1),
                                            convex::ConstraintRows(U),
                                            Vector::Zero(U.rows()),
                                            {}};
  convex::Solution solution = convex::automatic(problem);
  solution.lambda.head(n - 1) += solution.lambda.tail(n - 1);  // a vertex of the dual optima
  solution.lambda.tail(n - 1).setZero();
  const convex::Multipliers found = convex::multipliers(problem, solution, 1e-9, false);
  CHECK_FALSE(found.null_space);
  CHECK_FALSE(found.unique);
}

TEST_CASE("a row without a gradient that holds has any multiplier, beside one island or many") {
  for (const Index n : {4, 63, 64, 90})
    for (const bool two_sided : {false, true}) {
      CAPTURE(n);
      RowMatrix U = RowMatrix::Zero(n + 1, n);
      U.topRows(n).setIdentity();
      const convex::NearestPointProblem problem{convex::Metric::identity(n), Vector::Constant(n, -1),
                                                convex::ConstraintRows(U), Vector::Zero(n + 1),
                                                two_sided ? std::vector<Index>{n} : std::vector<Index>{}};
      const convex::Multipliers found = convex::multipliers(problem, convex::automatic(problem), 1e-9, true);
      CHECK_FALSE(found.unique);
      REQUIRE(found.ranges);
      constexpr double infinity = std::numeric_limits<double>::infinity();
      CHECK((*found.ranges)[static_cast<std::size_t>(n)].high == infinity);
      CHECK((*found.ranges)[static_cast<std::size_t>(n)].low == (two_sided ? -infinity : 0));
      CHECK((*found.ranges)[0].low == (*found.ranges)[0].high);
    }
}
