#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "convex/laws/laws.hpp"

using namespace convex;

/// f(x) = |a·x - b|.
struct Misfit {
  Vector a;
  double b;
  double operator()(const Vector& x) const { return std::abs(a.dot(x) - b); }
  Vector prox(const Vector& z, const Metric& W) const {
    const Vector normal = W.solve(a);  // a is a covector; W makes it a direction
    return z - std::clamp((a.dot(z) - b) / a.dot(normal), -1.0, 1.0) * normal;
  }
};

/// The same with a mistake: the direction of the plain metric in every metric.
struct WrongMetric : Misfit {
  Vector prox(const Vector& z, const Metric&) const {
    return z - std::clamp((a.dot(z) - b) / a.dot(a), -1.0, 1.0) * a;
  }
};

TEST_CASE("a function of your own stands the test of the laws, and a wrong one does not") {
  const LawReport right = laws(Misfit{Vector{{1, 2, 3}}, 0.5});
  CHECK(right.all_passed());
  const LawReport wrong = laws(WrongMetric{{Vector{{1, 2, 3}}, 0.5}});
  CHECK_FALSE(wrong.all_passed());
  CHECK(wrong.text().find("FAILED") != std::string::npos);  // with the smallest counterexample found
}
