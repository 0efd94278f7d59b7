#include <doctest/doctest.h>

#include "convex/catalogue/catalogue.hpp"
#include "convex/proved_prox/proved_split.hpp"
#include "convex/sets/subdifferential.hpp"

using namespace convex;

TEST_CASE("a prox with a proof, in fractions, and the subgradients that it rests on") {
  const Call call{"norm1"};  // Σ |x_i|, by its name in the language of functions
  const Metric W = Metric::dense(Matrix{{2, 1}, {1, 2}});
  const Vector z{{3, -0.25}};
  const Decomposition d = decompose(make_function(call, {W}), z, W);

  // A bound on the distance to the exact prox of the doubles z and W, rounding included.
  const SplitQuestion question{call, fractions(z), exact_gram(W)};
  const ProvedSplit proof = prove(question, d);
  CHECK(proof.level == ProofLevel::exact);
  CHECK(proof.error_bound() <= 1e-14);
  // It is a proof of these very numbers: of others it says how far they are.
  Decomposition other = d;
  other.x.x[0] += 1e-9;
  CHECK(prove(question, other).x_bound >= 1e-9);
  // In doubles, at some times the price of the decomposition, where a few roundings more do no harm.
  CHECK(prove(call, z, W, d).error_bound() <= 1e-14);

  // The prox itself in fractions: x = z - W⁻¹v with v a subgradient of f at x, without a tolerance.
  const ExactSplit exact = exact_split(question);
  const Fractions v = multiply(question.W, exact.y);
  const Subdifferential at = subdifferential(call, question.W, exact.x);
  CHECK(at.contains(v));
  CHECK(at.support(v) >= nearest_double(dot(v, v)));
}
