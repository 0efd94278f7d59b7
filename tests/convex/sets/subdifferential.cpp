#include "convex/sets/subdifferential.hpp"

#include <doctest/doctest.h>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/cones/cone_operations.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_split.hpp"

using namespace convex;

namespace {

Call call_of(const std::string& text) { return cli::parse_call(text, "f"); }

Fractions point_of(const std::vector<const char*>& texts) {
  Fractions x;
  for (const char* text : texts) x.push_back(read_fraction(text).value());
  return x;
}

const std::vector<std::string> polyhedral_calls = {
    "norm1(1/3)",
    "huber(0.1)",
    "hinge()",
    "max()",
    "sum_largest(2)",
    "norm_inf(2)",
    "total_variation(0.3)",
    "max_affine([[1,2,0],[-1,0,1],[0,-1,-1],[1,1,1]], [0,1,-1,0.5])",
    "quadratic([[1,1,0],[1,1,0],[0,0,0]], c=[1,2,0])",
    "indicator(box(-1, 1/2))",
    "indicator(simplex(1))",
    "indicator(ball1(1))",
    "indicator(cone([[1,0,0],[1,1,0],[1,1,1]]))",
    "indicator(affine([[1,1,1],[1,-1,0]], [1,0]))",
    "sum(norm1(), total_variation(0.5))",
    "inf_convolution(norm1(), squared_norm2(2))"};

std::vector<Fractions> some_points_in_fractions() {
  std::vector<Fractions> points;
  for (int k = 0; k < 7; ++k) {
    Fractions z;
    for (int i = 0; i < 3; ++i) z.push_back(lowest_terms({(5 * k + 7 * i * i) % 11 - 4, 3}));
    points.push_back(z);
  }
  points.emplace_back(3);
  return points;
}

ExactGram full_gram() {
  return exact_gram({point_of({"2", "1", "0"}), point_of({"1", "2", "1/2"}), point_of({"0", "1/2", "1"})});
}

}  // namespace

TEST_CASE("x = prox_f z exactly when W(z - x) is a subgradient at x, without a tolerance") {
  for (const std::string& f : polyhedral_calls)
    for (const ExactGram& W : {identity_gram(3), full_gram()})
      for (const Fractions& z : some_points_in_fractions()) {
        CAPTURE(f);
        const ExactSplit split = exact_split({call_of(f), z, W});
        const Subdifferential at = subdifferential(call_of(f), W, split.x);
        REQUIRE(at.polyhedron);
        const Fractions v = multiply(W, split.y);
        CHECK(at.contains(v));
        // Of another point it is one only where x does not move with it.
        Fractions other = v;
        other[0] = other[0] + read_fraction("1/1000000000000000000").value();
        const Fractions moved = pairs::sum_of(split.x, ProvedMetric(W).solve(other));
        CHECK(at.contains(other) == (exact_split({call_of(f), moved, W}).x == split.x));
      }
}

TEST_CASE("both descriptions of a subdifferential are one set") {
  for (const std::string& f : polyhedral_calls)
    for (const Fractions& z : some_points_in_fractions()) {
      CAPTURE(f);
      const Fractions x = exact_split({call_of(f), z, identity_gram(3)}).x;
      const ExactPolyhedron P = *subdifferential(call_of(f), identity_gram(3), x).polyhedron;
      for (const Fractions& vertex : P.vertices) {
        CHECK(contains(P, vertex));
        for (const IntegerVector& ray : P.rays) {
          Fractions along = vertex, against = vertex;
          for (std::size_t i = 0; i < 3; ++i) {
            along[i] = along[i] + Fraction{ray[i]};
            against[i] = against[i] - Fraction{ray[i]} * Fraction{1000};
          }
          CHECK(contains(P, along));
          CHECK_FALSE(contains(P, against));
        }
      }
      for (const ExactHalfspace& row : P.halfspaces)
        CHECK((support_of(P, [&] {
                 Fractions d;
                 for (const Integer& entry : row.normal) d.push_back(Fraction{entry});
                 return d;
               }()) == std::optional(Fraction{row.limit})));
    }
}

TEST_CASE("the support function of the subdifferential is the difference quotient") {
  for (const std::string f : {"norm1(1/3)", "huber(0.1)", "max()", "sum_largest(2)", "total_variation(0.3)"})
    for (const Fractions& x : some_points_in_fractions())
      for (const Fractions& d : some_points_in_fractions()) {
        CAPTURE(f);
        // Piecewise quadratic: along a short step the quotient is f'(x; d) + O(t).
        const double t = 1e-7;
        const Function made = make_function(call_of(f), {Metric::identity(3)});
        const Vector from = nearest(x), along = nearest(d);
        const double quotient = (made(from + t * along) - made(from)) / t;
        const double support = subdifferential(call_of(f), identity_gram(3), x).support(d);
        CHECK(std::abs(quotient - support) <= 1e-5 * (1 + along.squaredNorm()));
      }
}

TEST_CASE("the tangent cone is polar to the normal cone, and holds the way to every other point of the set") {
  for (const std::string C : {"indicator(box(-1, 1/2))", "indicator(simplex(1))", "indicator(ball1(1))",
                              "indicator(cone([[1,0,0],[1,1,0],[1,1,1]]))"}) {
    CAPTURE(C);
    std::vector<Fractions> inside;
    for (const Fractions& z : some_points_in_fractions())
      inside.push_back(exact_split({call_of(C), z, identity_gram(3)}).x);
    for (const Fractions& x : inside) {
      const Subdifferential N = subdifferential(call_of(C), identity_gram(3), x);
      const PolyhedralCone T = tangent_cone(N);
      PolyhedralCone normals = polar(T);
      for (const IntegerVector& ray : N.polyhedron->rays) CHECK(contains(normals, ExactVector{ray, 1}));
      CHECK(normals.generators.size() == N.polyhedron->rays.size());
      CHECK(normals.lines.size() == N.polyhedron->lines.size());
      for (const Fractions& other : inside) CHECK(contains(T, exact_vector(difference(other, x))));
    }
  }
}

TEST_CASE("the critical cone is what is tangent and at right angles to the normal") {
  const ExactGram W = identity_gram(2);
  const Subdifferential N = subdifferential(call_of("indicator(orthant())"), W, point_of({"0", "0"}));
  const PolyhedralCone K = critical_cone(N, point_of({"-1", "0"}));
  CHECK((K.generators == IntegerRows{{0, 1}}));
  CHECK(K.lines.empty());
  CHECK_THROWS_AS(critical_cone(N, point_of({"1", "0"})), InvalidInput);
}

TEST_CASE("a bound of a third is touched by a third, not by its double") {
  const Call box = call_of("indicator(box(0, 1/3))");
  const Subdifferential on = subdifferential(box, identity_gram(1), point_of({"1/3"}));
  CHECK((on.polyhedron->rays == IntegerRows{{1}}));
  const Subdifferential below = subdifferential(box, identity_gram(1), {fraction(1.0 / 3)});
  CHECK(below.is_single());
}

TEST_CASE("outside of the domain and at a vertical slope there is no subgradient") {
  CHECK(subdifferential(call_of("indicator(box(0, 1))"), identity_gram(1), point_of({"2"})).is_empty());
  CHECK(subdifferential(call_of("entropy()"), identity_gram(1), point_of({"0"})).is_empty());
  CHECK(subdifferential(call_of("log_barrier()"), identity_gram(1), point_of({"-1"})).is_empty());
  CHECK(subdifferential(call_of("indicator(ball2(1))"), identity_gram(2), point_of({"1", "1"})).is_empty());
}

TEST_CASE(
    "curved functions: a ball at the corner of a norm, a ray at the boundary of a ball, else a gradient") {
  const Subdifferential corner = subdifferential(call_of("norm2(2)"), identity_gram(2), Fractions(2));
  CHECK(to_text(corner.set->call) == "ball2(radius=2)");
  CHECK(corner.contains(point_of({"1.2", "1.6"})));
  CHECK_FALSE(corner.contains(point_of({"1.3", "1.6"})));
  CHECK(corner.support(point_of({"3", "4"})) == 10);
  const Subdifferential edge =
      subdifferential(call_of("indicator(ball2(5))"), identity_gram(2), point_of({"3", "4"}));
  CHECK((edge.polyhedron->rays == IntegerRows{{3, 4}}));
  const Subdifferential smooth = subdifferential(call_of("norm2(2)"), identity_gram(2), point_of({"3", "4"}));
  CHECK(smooth.is_single());
  CHECK(nearest_double(smooth.polyhedron->vertices[0][0]) == doctest::Approx(1.2).epsilon(1e-15));
  const Subdifferential line =
      subdifferential(call_of("kullback_leibler([1,0])"), identity_gram(2), point_of({"1", "0"}));
  CHECK((line.polyhedron->lines == IntegerRows{{0, 1}}));
  // -log det is blind to skew matrices, and +inf at all others that are not symmetric.
  const Subdifferential det =
      subdifferential(call_of("neg_log_det()"), identity_gram(4), point_of({"1", "0", "0", "2"}));
  CHECK(det.contains(point_of({"-1", "7", "-7", "-1/2"})));
  CHECK_FALSE(det.contains(point_of({"-1", "7", "-7.1", "-1/2"})));
}

TEST_CASE("the element of least norm is the projection of 0, in the metric") {
  // {v : v_1 + v_2 = 1, v >= 0} of max at (0, 0): least in the plain norm is (1/2, 1/2), in diag(1, 3) (3/4,
  // 1/4).
  const Subdifferential at = subdifferential(call_of("max()"), identity_gram(2), Fractions(2));
  CHECK((at.projection(Vector::Zero(2), Metric::identity(2)) - Vector::Constant(2, 0.5)).norm() <= 1e-15);
  Vector d(2), least(2);
  d << 1, 3;
  least << 0.75, 0.25;
  CHECK((at.projection(Vector::Zero(2), Metric::diagonal(d)) - least).norm() <= 1e-15);
}

TEST_CASE("the directional derivative of a prox is its difference quotient, without rounding") {
  // prox is piecewise affine: for a short enough step the quotient is the derivative itself.
  const Fraction t = read_fraction("1/1000000000").value();
  for (const std::string& f : polyhedral_calls)
    for (const ExactGram& W : {identity_gram(3), full_gram()})
      for (const Fractions& z : some_points_in_fractions())
        for (const Fractions& d : {point_of({"1", "0", "0"}), point_of({"-1", "2/3", "1"})}) {
          CAPTURE(f);
          const Call call = call_of(f);
          const Fractions here = exact_split({call, z, W}).x,
                          there = exact_split({call, pairs::sum_of(z, pairs::multiple_of(t, d)), W}).x;
          const Fractions quotient = pairs::multiple_of(Fraction{1} / t, difference(there, here));
          CHECK((prox_derivative(call, W, z, d) == quotient));
        }
}

TEST_CASE("the derivative has two sides where the point lies on a boundary between cells") {
  const Call call = call_of("indicator(orthant())");
  CHECK((prox_derivative(call, identity_gram(1), Fractions(1), point_of({"1"})) == point_of({"1"})));
  CHECK((prox_derivative(call, identity_gram(1), Fractions(1), point_of({"-1"})) == point_of({"0"})));
  // The same with rows that repeat each other, so that multipliers are not unique.
  const Call repeated = call_of("indicator(polyhedron([[1,0],[2,0],[1,1]], [0,0,0]))");
  CHECK((prox_derivative(repeated, identity_gram(2), point_of({"1", "0"}), point_of({"0", "1"})) ==
         point_of({"0", "0"})));
  CHECK((prox_derivative(repeated, identity_gram(2), point_of({"1", "0"}), point_of({"0", "-1"})) ==
         point_of({"0", "-1"})));
}

TEST_CASE("a generalised Jacobian agrees with difference quotients where the prox is differentiable") {
  Vector z(3);
  z << 1.3, -0.7, 2.1;
  for (const std::string text : {"norm1(1/3)", "entropy()", "norm2()", "indicator(ball2())"}) {
    CAPTURE(text);
    const Function f = make_function(call_of(text), {Metric::identity(3)});
    const Matrix J = prox_jacobian(f, z, Metric::identity(3));
    CHECK((J - J.transpose()).norm() <= 1e-12);
    for (Index i = 0; i < 3; ++i) {
      const double t = 1e-5;
      const Vector quotient = (f.prox(z + t * Vector::Unit(3, i), Metric::identity(3)).x -
                               f.prox(z - t * Vector::Unit(3, i), Metric::identity(3)).x) /
                              (2 * t);
      CHECK((J.col(i) - quotient).norm() <= 1e-8);
    }
  }
}
