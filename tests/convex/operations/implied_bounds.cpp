// Bounds that the domain of another summand implies.
#include "convex/operations/implied_bounds.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "convex/functions/norms.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/separable_functions.hpp"
#include "convex/functions/sets.hpp"
#include "convex/laws/trial.hpp"
#include "convex/operations/operations.hpp"

using namespace convex;

namespace {

std::vector<std::string> texts(std::span<const Function> parts, Index n) {
  std::vector<std::string> made;
  for (const Function& f : without_implied_bounds(parts, n)) made.push_back(to_text(f.call()));
  return made;
}

}  // namespace

TEST_CASE(
    "beside an entropy the simplex is a hyperplane, and the orthant is nothing; caps and finite parts keep "
    "them") {
  using Texts = std::vector<std::string>;
  CHECK(texts(std::array{indicator(orthant()), entropy()}, 2) == Texts{"entropy()"});
  CHECK(texts(std::array{entropy(), indicator(simplex(3))}, 2) ==
        Texts{"entropy()", to_text(indicator(hyperplane(Vector::Ones(2), 3)).call())});
  CHECK(texts(std::array{log_barrier(), indicator(box(-1, INFINITY))}, 2) ==
        Texts{to_text(log_barrier().call())});
  CHECK(texts(std::array{binary_entropy(), indicator(box(0, 1))}, 2) == Texts{"binary_entropy()"});
  for (const Function& f :
       {indicator(box(0.5, 2)), indicator(capped_simplex(1, 0.75)), indicator(halfspace(Vector{{1, 1}}, 1))})
    CHECK(texts(std::array{entropy(), f}, 2) == Texts{"entropy()", to_text(f.call())});
  CHECK(texts(std::array{logistic(), indicator(simplex(1))}, 2).size() == 2);
  CHECK(texts(std::array{norm1(), indicator(orthant())}, 2).size() == 2);
}

TEST_CASE("the entropic projection on the simplex is solved however small its entries are") {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  const Function f = sum(std::array{entropy(), indicator(simplex(1))});
  for (const Index n : {5, 20, 60})
    for (const double size : {1.0, 10.0, 30.0}) {
      Vector z(n);
      for (double& entry : z) entry = size * normal(generator);
      for (const Metric& W : {Metric::identity(n), Metric::diagonal(Vector::LinSpaced(n, 0.25, 4)),
                              Metric::dense(matrix_of_condition(n, 10))}) {
        CAPTURE(n);
        CAPTURE(size);
        const Prox found = f.prox(z, W);
        REQUIRE(found.status == Status::solved);
        CHECK(std::isfinite(static_cast<double>(f(found.x))));
        CHECK(std::abs(found.x.sum() - 1) <= 1e-13 * static_cast<double>(n) * size);
        // W(z - x) = log x + 1 + t with one t for all entries, the multiplier of their sum; where x is 0 to
        // an absolute error, its logarithm is not known.
        const Vector covector = W.multiply(z - found.x);
        double least = INFINITY, most = -INFINITY;
        for (Index i = 0; i < n; ++i) {
          if (found.x[i] < 1e-3) continue;
          least = std::min(least, covector[i] - std::log(found.x[i]));
          most = std::max(most, covector[i] - std::log(found.x[i]));
        }
        CHECK(most - least <= 1e-8);
      }
    }
}
