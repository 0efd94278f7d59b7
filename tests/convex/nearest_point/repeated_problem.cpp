#include "convex/nearest_point/repeated_problem.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <random>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "tests/convex/nearest_point/pivoting/gram_answer.hpp"
#include "tests/oracles/planted_problem.hpp"

using convex::Accuracy;
using convex::Index;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using convex::Vector;
using oracles::Difficulty;

namespace {

Vector jolted(const Vector& x, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Vector y = x;
  for (Index i = 0; i < y.size(); ++i) y[i] *= 1 + 0.3 * normal(generator);
  return y;
}

/// Integers, of which no coordinate, multiplier or slack is close to 0.
oracles::PlantedProblem clear_of_edges(unsigned seed, Index n, Index m) {
  auto [problem, truth] = oracles::planted_problem(seed, n, m, Difficulty::none);
  const Solution found = convex::active_set(problem);
  REQUIRE(found.status == Status::solved);
  for (Index a = 0; a < m; ++a)
    if (found.lambda[a] < 0.01 && found.slack[a] == 0) problem.s[a] -= 3;
  const Vector shift = (truth.array() == 0).cast<double>();
  problem.z += problem.A.multiply(shift);
  problem.s += problem.U.times(shift);
  return {problem, truth + shift};
}

/// z and s for which q, with the multipliers of the first `held` rows, is the solution; the other rows are
/// clear of theirs.
void plant(NearestPointProblem& problem, const Vector& q, const Vector& lambda, Index held) {
  problem.z = problem.A.multiply(q) - problem.U.transpose_times(lambda);
  problem.s = problem.U.times(q);
  problem.s.tail(problem.rows() - held).array() -= 1;
}

}  // namespace

TEST_CASE("a problem solved again and again, rows coming and going, has the answers of the first solve") {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Index n = 2 + static_cast<Index>((7 * seed) % 45), m = 1 + static_cast<Index>((11 * seed) % 60);
    CAPTURE(n);
    CAPTURE(m);
    auto [problem, truth] = oracles::planted_problem(seed, n, m, Difficulty::none);
    const Vector z = problem.z, s = problem.s;
    for (const bool refine : {true, false}) {
      Accuracy accuracy;
      accuracy.refine = refine;
      convex::RepeatedProblem repeated(problem, accuracy);
      std::mt19937 generator(seed);
      for (int k = 0; k < 60; ++k) {
        problem.z = jolted(z, generator);
        problem.s = jolted(s, generator);
        const Solution once = convex::active_set(problem);
        const Solution& again = repeated.solve(problem.z, problem.s);
        CHECK(again.status == once.status);
        if (once.status != Status::solved) continue;
        const double error = problem.A.norm(again.q - once.q), unit = gram_matrix::scale(problem, once.q);
        if (refine) CHECK(error <= gram_matrix::few_roundings * unit);
        CHECK(error <= again.error_bound + gram_matrix::few_roundings * unit);
      }
    }
  }
}

TEST_CASE(
    "the critical region of a working set has the doubles nearest to the truth, and all others theirs") {
  for (unsigned seed = 0; seed < 24; ++seed) {
    const Index n = 1 + static_cast<Index>((7 * seed) % (seed < 12 ? 32 : 90)),
                m = 1 + static_cast<Index>((11 * seed) % 60);
    CAPTURE(n);
    CAPTURE(m);
    auto [problem, truth] = clear_of_edges(seed, n, m);
    const Vector z = problem.z, s = problem.s;
    convex::RepeatedProblem repeated(problem);
    std::mt19937 generator(seed);
    for (int k = 1; k <= 160; ++k) {
      const Solution& again = repeated.solve(k * z, k * s);
      CHECK(again.status == Status::solved);
      CHECK(again.q == Vector(k * truth));
      CHECK(again.error_bound <= gram_matrix::few_roundings * problem.A.norm(again.q));
      if (k < 100 || k % 8 > 0) continue;
      problem.z = jolted(z, generator);
      problem.s = jolted(s, generator);
      const Solution once = convex::active_set(problem);
      const Solution& other = repeated.solve(problem.z, problem.s);
      CHECK(other.status == once.status);
      if (once.status != Status::solved) continue;
      CHECK(other.basis.size() == once.basis.size());
      CHECK(problem.A.norm(other.q - once.q) <=
            gram_matrix::few_roundings * gram_matrix::scale(problem, once.q));
    }
    Vector wrong = z;
    wrong[n - 1] = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(repeated.solve(wrong, s), convex::InvalidInput);
    wrong = s;
    wrong[m - 1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(repeated.solve(z, wrong), convex::InvalidInput);
    CHECK(repeated.solve(z, s).q == truth);
  }
}

TEST_CASE("points that come again, each with a working set of its own, keep their answers") {
  for (const auto& [n, m] : {std::pair<Index, Index>{12, 20}, {60, 90}}) {
    CAPTURE(n);
    auto [problem, truth] = oracles::planted_problem(7, n, m, Difficulty::none);
    const Vector z = problem.z, s = problem.s;
    std::mt19937 generator(1);
    convex::RepeatedProblem repeated(problem);
    std::vector<NearestPointProblem> points(6, problem);
    std::vector<Solution> once;
    int solved = 0;
    for (NearestPointProblem& point : points) {
      point.z = jolted(z, generator);
      point.s = jolted(s, generator);
      once.push_back(convex::active_set(point));
      solved += once.back().status == Status::solved;
    }
    CHECK(solved > 1);
    for (int turn = 0; turn < 130; ++turn)
      for (std::size_t k = 0; k < points.size(); ++k) {
        const Solution& again = repeated.solve(points[k].z, points[k].s);
        if (turn % 10 != 9) continue;
        CHECK(again.status == once[k].status);
        if (again.status != Status::solved || once[k].status != Status::solved) continue;
        const double unit = gram_matrix::scale(points[k], once[k].q);
        CHECK(problem.A.norm(again.q - once[k].q) <= gram_matrix::few_roundings * unit);
        CHECK((again.lambda - once[k].lambda).norm() <= 1e-9 * (1 + once[k].lambda.norm()));
        CHECK(again.error_bound <= gram_matrix::few_roundings * unit);
      }
  }
}

TEST_CASE("what an answer by the map of a working set says of itself is so, also where sums cancel") {
  using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  for (const Index n : {3, 8, 12, 30, 50}) {
    CAPTURE(n);
    std::mt19937 generator(static_cast<unsigned>(n));
    const Index held = (n + 1) / 2;
    auto [problem, truth] = oracles::planted_problem(static_cast<unsigned>(n), n, n + 5, Difficulty::none);
    problem.two_sided.clear();
    Vector pushes = Vector::Zero(n + 5);
    pushes.head(held).setLinSpaced(1, 2);
    const Vector q = jolted(Vector::Ones(n), generator),
                 pulled = problem.A.solve(problem.U.transpose_times(pushes));
    convex::RepeatedProblem repeated(problem);
    const auto solve = [&](const Vector& at, const Vector& lambda) -> const Solution& {
      plant(problem, at, lambda, held);
      return repeated.solve(problem.z, problem.s);
    };
    for (int k = 0; k < 150; ++k) REQUIRE(solve(q, pushes).status == Status::solved);
    for (const Vector& at :
         {q, Vector(1e-4 * q), Vector(1e-9 * q), pulled, Vector(q + 1e3 * pulled), Vector(Vector::Zero(n))})
      for (const double size : {1.0, 1 + 1e-7, 1e-6, 1e3}) {
        for (int k = 0; k < 4; ++k) solve(q, pushes);  // the map is used again after what it leaves to others
        const Solution& found = solve(at, size * pushes);
        CHECK(found.status == Status::solved);
        const double force = problem.A.dual_norm(problem.z), motion = problem.A.norm(found.q),
                     largest = std::max(force, motion);
        CHECK(std::abs(found.force_norm - force) <= 1e-12 * largest);
        CHECK(std::abs(found.acceleration_norm - motion) <= 1e-12 * largest);
        const LongMatrix A = problem.A.dense_gram().cast<long double>();
        const LongVector off =
            A * found.q.cast<long double>() - problem.z.cast<long double>() -
            problem.U.dense().cast<long double>().transpose() * found.lambda.cast<long double>();
        const double missing = problem.A.dual_norm(off.cast<double>());
        CHECK(missing <= 2 * found.residuals.stationarity * largest);
        CHECK(found.residuals.stationarity <= 1e-14);
      }
  }
}
