#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "convex/functions/decomposition.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Decomposition;
using convex::Function;
using convex::Metric;
using convex::Prox;
using convex::Vector;
using convex::WorkLimit;

namespace {

/// A question that is left so much of the work that one may take.
struct Cut {
  explicit Cut(double part) : limit(part) {
    if (part == 0) WorkLimit::count(1000);
  }
  WorkLimit limit;
};

const double parts[] = {0, 1e-5, 1e-4, 1e-3, 1e-2};

}  // namespace

TEST_CASE("a prox cut short is no farther from the solution than its bound, on whatever pieces it was left") {
  const Vector z{{2, 3}};
  const Metric W = Metric::identity(2);
  for (const char* text :
       {"sum(power(3), squared_hinge())", "tilt(sum(power(3), squared_hinge()), [-1, 0])",
        "sum(exponential(), squared_hinge(), power(1.5))", "sum(entropy(), huber(0.5), norm2(0.25))"}) {
    const Function f = samples::function(text, 2);
    const Prox truth = f.prox(z, W);
    REQUIRE(truth.status == convex::Status::solved);
    for (const double part : parts) {
      const Cut question(part);
      const Prox found = f.prox(z, W);
      if (found.x.size() == 0) continue;
      CAPTURE(text);
      CAPTURE(part);
      CHECK((found.x - truth.x).norm() <= found.error_bound + truth.error_bound);
    }
  }
}

TEST_CASE("a decomposition cut short is no farther from the solution than its bound") {
  const Vector z{{2, 0}};
  const Metric W = Metric::identity(2);
  const std::string persp = "scale(perspective(squared_norm2(1024)), 0.0009765625)";
  const Function f = samples::function("inf_convolution(distance(ball2(1), 3), " + persp + ")", 2);
  const Decomposition truth = convex::decompose(f, z, W);
  REQUIRE(truth.status == convex::Status::solved);
  for (const double part : parts) {
    const Cut question(part);
    const Decomposition found = convex::decompose(f, z, W);
    CAPTURE(part);
    CHECK((found.x.x - truth.x.x).norm() <= found.error_bound + truth.error_bound);
    CHECK((found.y.x - truth.y.x).norm() <= found.error_bound + truth.error_bound);
  }
}
