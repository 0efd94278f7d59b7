#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "convex/functions/piecewise_functions.hpp"
#include "convex/invalid_input.hpp"
#include "convex/laws/call_laws.hpp"
#include "convex/laws/laws.hpp"

using namespace convex;

namespace {

/// f(x) = ½ x·Dx + c·x with a diagonal D >= 0, as a user would write it: 0 = W(x - z) + Dx + c.
struct Spring {
  Vector stiffness, load;
  double forgotten = 0;  ///< a planted slip
  double operator()(const Vector& x) const { return 0.5 * x.dot(stiffness.cwiseProduct(x)) + load.dot(x); }
  Vector prox(const Vector& z, const Metric& W) const {
    const Matrix M = gram_matrix(W) + Matrix(stiffness.asDiagonal());
    return M.llt().solve(W.multiply(z) - (1 - forgotten) * load);
  }
};

/// The indicator of {x : a·x <= b}; its prox in any metric is a projection.
struct Wall {
  Vector a;
  double b = 0;
  double operator()(const Vector& x) const {
    const double over = a.dot(x) - b;
    return over <= membership_tolerance * (a.norm() * x.norm() + std::abs(b))
               ? 0.0
               : std::numeric_limits<double>::infinity();
  }
  Vector prox(const Vector& z, const Metric& W) const {
    const Vector normal = W.solve(a);  // a is a covector; W makes it a direction
    return z - std::max(0.0, a.dot(z) - b) / a.dot(normal) * normal;
  }
};

}  // namespace

TEST_CASE("a function that a user writes with two verbs goes through the laws") {
  const Vector stiffness = (Vector(3) << 1, 0, 4).finished(), load = (Vector(3) << 1, -2, 0.5).finished();
  const LawReport springs = laws(Spring{stiffness, load}), wall = laws(Wall{load, 0.5});
  INFO(springs.text());
  INFO(wall.text());
  CHECK(springs.all_passed());
  CHECK(wall.all_passed());
}

TEST_CASE("a small slip in a user's prox fails, and the text shows law, value, bound and counterexample") {
  const Vector stiffness = (Vector(3) << 1, 0, 4).finished(), load = (Vector(3) << 1, -2, 0.5).finished();
  const LawReport report = laws(Spring{stiffness, load, 1e-5});
  CHECK_FALSE(report.all_passed());
  for (const char* words : {"FAILED", "bound", "z = [", "metric"}) {
    CAPTURE(words);
    CHECK(report.text().find(words) != std::string::npos);
  }
}

TEST_CASE(
    "laws of no entries, and a prox that gives another number of them, are refused in their own words") {
  struct Short {
    double operator()(const Vector&) const { return 0; }
    Vector prox(const Vector& z, const Metric&) const { return z.head(1); }
  };
  CHECK_THROWS_WITH_AS(laws(Short{}), "prox: it gave 1 entry at a point of 3; return as many",
                       InvalidInput);
  for (const Index n : {0, -1}) {
    CAPTURE(n);
    CHECK_THROWS_AS(laws(Wall{Vector(), 0.5}, n), InvalidInput);
    CHECK_THROWS_AS(laws(norm1(), n), InvalidInput);
    CHECK_THROWS_AS(laws(Call{"norm1"}, n), InvalidInput);
  }
}
