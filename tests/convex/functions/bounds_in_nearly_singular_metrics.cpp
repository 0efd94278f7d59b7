// Metrics whose condition is beyond 1e12: a rounding of x or of its covector may be far in them, and the
// bounds say how far. The points are exact: z = x + W⁻¹v in doubles without rounding, or x is 0.
#include <doctest/doctest.h>

#include "convex/functions/decomposition.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/sets.hpp"

using namespace convex;

namespace {

/// ||x - y||_W for a W of integers and powers of 2, in long double: an error of some 1e-19 of the terms.
double distance_in(const Matrix& W, const Vector& x, const Vector& y) {
  long double square = 0;
  for (Index i = 0; i < x.size(); ++i)
    for (Index j = 0; j < x.size(); ++j)
      square += static_cast<long double>(W(i, j)) * (static_cast<long double>(x[i]) - y[i]) *
                (static_cast<long double>(x[j]) - y[j]);
  return static_cast<double>(std::sqrt(std::max(square, 0.0L)));
}

struct Question {
  const char* name;
  Function f;
  Matrix W;
  Vector z, x;  ///< x the prox at z
};

std::vector<Question> questions() {
  return {
      // v = W(z - x) = (1125.16, -1125.16), the first entry the larger by 1.2e-10: x is the vertex there.
      {"signed_permutahedron", indicator(signed_permutahedron(Vector{{1.9823054250787016, 0}})),
       Matrix{{9.0000000000009095, -9}, {-9, 9.000000000003638}}, Vector{{128, 1}},
       Vector{{1.9823054250787016, 0}}},
      {"signed_permutahedron, near", indicator(signed_permutahedron(Vector{{0.0234375, 0}})),
       Matrix{{4.0000000000000142, -4}, {-4, 4.000000000001819}},
       Vector{{1.376978516875428, 0.017738268307923959}}, Vector{{0.0234375, 0}}},
      // x < 0 where f has the slope 3: x = z - 3 W⁻¹(1, 1, 1), in fractions.
      {"plq", plq(Vector{{0, 1.5}}, Matrix{{0, 3, 2}, {1, 4, 2}, {2, 4.5, 0.125}}),
       Matrix{{4.0000000037252903, 4, -2}, {4, 4.0000000000000142, -2}, {-2, -2, 1.0000000000000142}},
       Vector{{1, 0, 0}}, Vector{{-483182345.24450088, -126663352973918.44, -253327672312528.75}}},
      // z is in the cone of the rows.
      {"cone", indicator(cone(Matrix{{0, 0, -2}, {-1, 1, 1}, {-1, -1, -1}, {1, 0, 1}})),
       Matrix{{5.0000000000145519, 0, -4}, {0, 1.1368683772161603e-13, 0}, {-4, 0, 5.0000000000145519}},
       Vector{{1.5, -1, 0}}, Vector{{1.5, -1, 0}}},
      {"support of a half-space", support(halfspace(Vector{{-4096, 0.015625, 1572864}}, 2)),
       Matrix{{4.0000000000002274, -2, -2}, {-2, 1.000000000007276, 1}, {-2, 1, 1.0000000000000142}},
       Vector{{1048576, -1362130.9797477496, 1048576}}, Vector{{0, 0, 0}}},
  };
}

}  // namespace

TEST_CASE("the bound of a split is no less than its error in a metric that is nearly singular") {
  for (const Question& question : questions()) {
    CAPTURE(question.name);
    const Metric W = Metric::dense(question.W);
    // The given x of the piecewise function is rounded.
    const double rounding = unit_roundoff * question.x.cwiseAbs().dot(question.W.diagonal().cwiseSqrt());
    const Decomposition split = decompose(question.f, question.z, W);
    CHECK(distance_in(question.W, split.x.x, question.x) <= split.error_bound + rounding);
    CHECK(distance_in(question.W, split.y.x, question.z - question.x) <= split.error_bound + 2 * rounding);
  }
}

TEST_CASE("the bound of a prox is no less than its error in a metric that is nearly singular") {
  for (const Question& question : questions()) {
    CAPTURE(question.name);
    const double rounding = unit_roundoff * question.x.cwiseAbs().dot(question.W.diagonal().cwiseSqrt());
    const Prox found = question.f.prox(question.z, Metric::dense(question.W));
    CHECK(distance_in(question.W, found.x, question.x) <= found.error_bound + rounding);
  }
}
