#include "convex/sets/subdifferential.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <tuple>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_split.hpp"

using namespace convex;

namespace {

Call parsed(const std::string& text) { return cli::parse_call(text, "f"); }

Fractions fractions_of(const std::vector<const char*>& texts) {
  Fractions x;
  for (const char* text : texts) x.push_back(read_fraction(text).value());
  return x;
}

/// The least of f(u) - f(x) - v·(u - x) found at points about x, along rays and at corners: negative beyond
/// rounding where v is no subgradient.
double least_excess(const Function& f, const Vector& x, const Vector& v, std::mt19937& random) {
  std::normal_distribution<double> normal;
  double least = 0;
  for (int k = 0; k < 300; ++k) {
    Vector d = Vector::NullaryExpr(x.size(), [&] { return normal(random); });
    if (k % 3 == 0)  // matrices stay symmetric
      if (const auto side = static_cast<Index>(std::sqrt(static_cast<double>(x.size())));
          side * side == x.size())
        for (Index i = 0; i < side; ++i)
          for (Index j = 0; j < i; ++j) d[i + side * j] = d[j + side * i];
    for (const double length : {1e-3, 0.1, 1.0, 10.0}) {
      const double value = f(x + length * d) - f(x) - length * v.dot(d);
      if (std::isfinite(value)) least = std::min(least, value / (1 + length));
    }
  }
  // u = prox_f(x + v) has x + v - u for a subgradient: the excess there is at most -|u - x|².
  const Vector u = f.prox(x + v, Metric::identity(x.size())).x;
  const double there = f(u) - f(x) - v.dot(u - x);
  return std::isfinite(there) ? std::min(least, there) : least;
}

}  // namespace

TEST_CASE(
    "elements of a subdifferential by rules satisfy the inequality that defines it, and others break it") {
  struct Case {
    const char* f;
    std::vector<const char*> x;
    const char* outside;  ///< a covector that is none, by hand
  };
  const std::vector<Case> cases = {
      {"group_norm(2, 2)", {"0", "0", "3", "4"}, "[2,1,1.2,1.6]"},
      {"group_norm(1, [1,3])", {"0", "0", "0", "0"}, "[0,0.8,0.8,0]"},
      {"sum(norm2(), norm1(2))", {"0", "0"}, "[2.8,2.8]"},
      {"sum(norm2(3), max(), exponential())", {"0", "0"}, "[4.5,5]"},
      {"neg_log_det()", {"2", "1", "1", "2"}, "[-0.66,0.33,0.33,-0.66]"},
      {"precompose(norm2(), [[1,1],[1,-1],[2,0]], [0,0,0])", {"0", "0"}, "[3,0.1]"},
      {"nuclear_norm(1, 2)", {"1", "2", "2", "4"}, "[0.2,0.4,0.4,1]"},
      {"nuclear_norm(1, 2)", {"0", "0", "1", "0", "0", "0"}, "[0,0.8,1,0,0,0.8]"},
      {"nuclear_norm(2, 2)", {"0", "0", "0", "0"}, "[1,1,1,-1.8]"},
      {"indicator(psd_cone())", {"1", "0", "0", "0"}, "[0.1,0,0,-1]"},
      {"indicator(psd_cone())", {"1", "1", "1", "1"}, "[-1,0.8,0.8,-1]"},
      {"indicator(second_order_cone())", {"0", "0", "0"}, "[1,0,-0.9]"},
      {"indicator(rotated_second_order_cone())", {"0", "0", "0"}, "[1,-0.5,-0.9]"},
      {"distance(box(0,1))", {"0", "0"}, "[-0.8,-0.8]"},
      {"distance(ball2(1), 2)", {"3", "4"}, "[1.2,1.5]"},
      {"pointwise_max(norm2(), norm1())", {"0", "0"}, "[1.1,0]"},
      {"separable(norm2(), 2, norm1(), 1)", {"0", "0", "1"}, "[0.8,0.8,1]"},
      {"scale(norm2(), 3)", {"0", "0"}, "[3,0.5]"},
      {"translate(norm2(), [1,1])", {"1", "1"}, "[1,0.5]"},
      {"tilt(norm2(), [1,0])", {"0", "0"}, "[2,0.5]"},
      {"dilate(norm2(), 1/2)", {"0", "0"}, "[2,0.5]"},
      {"perspective(log_barrier())", {"3", "2"}, "[-0.6,0.6]"},
      {"perspective(norm2())", {"0", "0", "2"}, "[0.8,0.8,0]"},
      {"envelope(norm2(), 2)", {"0.3", "0.4"}, "[0.2,0.2]"},
      {"conjugate(indicator(ball2(2)))", {"0", "0"}, "[2,0.5]"},
      {"schatten(3)", {"1", "2", "3", "4"}, "[0.2,0.3,0.5,0.8]"},
      {"max_eigenvalue(2)", {"1", "0", "0", "2"}, "[0.1,0,0,1.9]"},
      {"max_eigenvalue()", {"1", "0", "0", "1"}, "[0.5,0.6,0.6,0.5]"},
      {"max_eigenvalue()", {"1", "0", "0", "0", "2", "0", "0", "0", "2"}, "[0,0,0,0,1.2,0,0,0,-0.2]"},
      {"max_eigenvalue(3)", {"2", "-1", "-1", "-1", "2", "-1", "-1", "-1", "2"}, "[3,0,0,0,0,0,0,0,0]"},
      {"indicator(spectraplex(2))", {"2", "0", "0", "0"}, "[0,0,0,1]"},
      {"indicator(spectraplex(2))", {"1", "0.5", "-0.5", "1"}, "[1,0,0,0.5]"},
      {"indicator(exponential_cone())", {"0", "1", "1"}, "[1,1,-0.9]"},
      {"indicator(exponential_cone())", {"0", "0", "2"}, "[0,-1,-0.1]"},
      {"indicator(exponential_cone())", {"-1", "0", "0"}, "[0.1,0,-1]"},
      {"indicator(exponential_cone())", {"-1", "0", "1"}, "[0,-1,-0.1]"},
      {"indicator(dual_exponential_cone())", {"-1", "-1", "1"}, "[0.1,-1,-1]"},
      {"indicator(dual_exponential_cone())", {"0", "1", "0"}, "[1,-0.1,0]"},
      {"indicator(dual_exponential_cone())", {"0", "0", "1"}, "[1,-0.1,0]"},
      {"indicator(power_cone(0.5))", {"4", "1", "2"}, "[-0.25,-1,1.1]"},
      {"indicator(power_cone(1/3))", {"0", "1", "0"}, "[-1,-0.1,0]"},
      {"indicator(dual_power_cone(1/3))", {"8/3", "2/3", "-2"}, "[0,-1,-1]"},
      {"k_support(2)", {"3", "1", "0", "0"}, "[1,0,0.8,0]"},
      {"k_support(2, 0.5)", {"1", "-1", "1"}, "[0.4,-0.3,0.3]"},
      {"k_support(3)", {"0", "2", "0", "0"}, "[0.1,1,0,0]"},
      {"inf_convolution(translate(norm2(),[0.3,0.1]),translate(norm2(0.75),[1,2]))",
       {"13/10", "21/10"},
       "[0.8,0]"},
      {"pointwise_max(norm2(), constant(5))", {"3", "4"}, "[0.6,0.9]"},
      {"pointwise_max(hinge(), distance(box(3, 7/2), 2/5))", {"3"}, "[0.1]"},
      {"pointwise_max(norm2(), linear([1,0]))", {"3", "0"}, "[0.9,0]"},
      {"pointwise_max(norm2(), translate(norm2(),[2,0]))", {"1", "3"}, "[0,0.9]"},
      {"pointwise_max(exponential(), constant(1))", {"0"}, "[1.1]"},
      {"pointwise_max(power(3), linear([4]))", {"2"}, "[13]"},
      // The largest eigenvalue of [[1,1],[1,0]], (1 + sqrt(5))/2, twice.
      {"max_eigenvalue()",
       {"1", "1", "0", "0", "1", "0", "0", "0", "0", "0", "1", "1", "0", "0", "1", "0"},
       "[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]"}};
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (const Case& one : cases) {
    CAPTURE(std::string(one.f));
    const Fractions x = fractions_of(one.x);
    const auto n = static_cast<Index>(x.size());
    const Call call = parsed(one.f);
    const Subdifferential at = subdifferential(call, identity_gram(x.size()), x);
    const Function f = make_function(call, {Metric::identity(n)});
    REQUIRE_FALSE(at.is_empty());
    for (int k = 0; k < 12; ++k) {
      const Vector u = 2 * Vector::NullaryExpr(n, [&] { return normal(random); });
      const Vector v = at.projection(u, Metric::identity(n));
      CHECK(least_excess(f, nearest(x), v, random) >= -1e-7);
      // v is nearest to u: (u - v)·w is the largest at v, of all w of the set.
      const Vector w =
          at.projection(2 * Vector::NullaryExpr(n, [&] { return normal(random); }), Metric::identity(n));
      CHECK((u - v).dot(w - v) <= 1e-7 * (1 + u.squaredNorm()));
    }
    const Vector out = cli::parse_vector(one.outside, "v");
    CHECK_FALSE(at.contains(fractions(out)));
    CHECK(least_excess(f, nearest(x), out, random) < 0);
  }
}

TEST_CASE("the gradient of an envelope is right where x and prox x are the same doubles") {
  const Subdifferential at =
      subdifferential(parsed("envelope(norm2())"), identity_gram(2), fractions_of({"3e17", "4e17"}));
  REQUIRE(at.is_single());
  CHECK(nearest(at.polyhedron->vertices.front()).isApprox(Vector{{0.6, 0.8}}, 1e-15));
}

TEST_CASE("where two domains have x on their edge, and one slope is vertical, no empty set is told") {
  // Of the first the derivative at 2 is 1 + log 2; the others are finite at one point alone.
  for (const auto& [f, x] : {std::pair{"precompose(entropy(), [[1],[0]], [0,0])", "2"},
                             {"precompose(negative_power(0.5), [[1],[-1]], [0,0])", "0"},
                             {"sum(entropy(), indicator(point(0)))", "0"},
                             {"sum(entropy(), dilate(entropy(), -1))", "0"}}) {
    CAPTURE(f);
    CHECK_THROWS_AS(subdifferential(parsed(f), identity_gram(1), fractions_of({x})), InvalidInput);
  }
  CHECK(subdifferential(parsed("sum(entropy(), norm1())"), identity_gram(1), fractions_of({"0"})).is_empty());
  CHECK(subdifferential(parsed("sum(entropy(), indicator(box(1,2)))"), identity_gram(1), fractions_of({"0"}))
            .is_empty());
  CHECK(subdifferential(parsed("precompose(entropy(), [[1]], [1])"), identity_gram(1), fractions_of({"-1"}))
            .is_empty());
}

TEST_CASE(
    "values that differ by less than a double's last digit are told apart, and no smaller set is made of "
    "them") {
  // sqrt(2) is above its nearest double's predecessor and below its successor: the larger part alone counts.
  const std::string below = "1.4142135623730950488016887242096980785696718753769480",
                    above = "1.4142135623730950488016887242096980785696718753769481";
  const auto count = [](const std::string& level) {
    return subdifferential(parsed("pointwise_max(norm2(), constant(" + level + "))"), identity_gram(2),
                           fractions_of({"1", "1"}));
  };
  REQUIRE(count(below).is_single());
  CHECK(nearest(count(below).polyhedron->vertices.front())
            .isApprox(Vector{{std::sqrt(0.5), std::sqrt(0.5)}}, 1e-15));
  REQUIRE(count(above).is_single());
  CHECK(nearest(count(above).polyhedron->vertices.front()).isZero(0));
}

TEST_CASE("eigenvalues that differ by less than doubles tell are not taken for one") {
  CHECK_THROWS_AS(
      subdifferential(parsed("max_eigenvalue()"), identity_gram(4),
                      fractions_of({"1", "0", "0", "1000000000000000000001/1000000000000000000000"})),
      InvalidInput);
}

TEST_CASE("what the calculus does not cover is refused, and never told as a smaller set") {
  for (const auto& [f, x] :
       {std::pair<const char*, std::vector<const char*>>{
            "sum(indicator(ball2(1)), indicator(ball2(1, [2,0])))", {"1", "0"}},
        {"precompose(indicator(ball2(1)), [[1,0],[0,0]], [0,1])", {"0", "0"}},
        {"epigraph(norm2())", {"3", "4", "5"}},
        // Equal, for no reason that a formula shows.
        {"pointwise_max(exponential(), tilt(sum(exponential(), zero()), [0]))", {"1"}}}) {
    CAPTURE(f);
    CHECK_THROWS_AS(subdifferential(parsed(f), identity_gram(x.size()), fractions_of(x)), InvalidInput);
  }
}

TEST_CASE(
    "where parts of an inf-convolution share a point, their subgradients meet in what is known by hand") {
  const Call call = parsed("inf_convolution(norm2(), norm1(0.75))");
  const auto read = [](const char* v) { return fractions(cli::parse_vector(v, "v")); };
  // At (2, 0) norm1 moves along its first axis: {0.75} x [-r, r] with 0.75² + r² = 1.
  const Subdifferential edge = subdifferential(call, identity_gram(2), fractions_of({"2", "0"}));
  const double r = std::sqrt(1 - 0.75 * 0.75);
  CHECK(edge.contains(read("[0.75,0.66]")));
  CHECK_FALSE(edge.contains(read("[0.75,0.67]")));
  CHECK_FALSE(edge.contains(read("[0.74,0]")));
  CHECK(edge.support(read("[1,1]")) == doctest::Approx(0.75 + r).epsilon(1e-9));
  // At 0 the ball cut by the box.
  const Subdifferential cut = subdifferential(call, identity_gram(2), fractions_of({"0", "0"}));
  CHECK(cut.contains(read("[0.7,0.7]")));
  CHECK_FALSE(cut.contains(read("[0.72,0.72]")));
  CHECK_FALSE(cut.contains(read("[0.76,0]")));
  // A part with a gradient leaves one covector, that of the prox.
  const Call smooth = parsed("inf_convolution(norm2(2), logistic())");
  const Subdifferential one = subdifferential(smooth, identity_gram(2), fractions_of({"2", "1"}));
  REQUIRE(one.is_single());
  const Vector x{{2, 1}}, v = nearest(one.polyhedron->vertices.front());
  const Prox back = make_function(smooth, {Metric::identity(2)}).prox(x + v, Metric::identity(2));
  CHECK((back.x - x).norm() <= 1e-8);
  // The nuclear norm is above the largest entry: of their maximum at 0 it is the spectral ball.
  const Subdifferential ball = subdifferential(parsed("pointwise_max(nuclear_norm(1, 2), norm_inf())"),
                                               identity_gram(4), Fractions(4));
  CHECK(ball.contains(read("[0.9,0,0,0.9]")));
  CHECK_FALSE(ball.contains(read("[1.1,0,0,1]")));
  CHECK(ball.projection(Vector::Zero(4), Metric::identity(4)).norm() <= 1e-9);
}

TEST_CASE("which face of a curved cone a point is on is decided in fractions") {
  const auto normals = [](const char* f, const std::vector<const char*>& x) {
    return subdifferential(parsed(f), identity_gram(3), fractions_of(x));
  };
  // One part in 10^30 inside, on, and outside of the boundary.
  CHECK(normals("exponential_cone()", {"0", "1", "1000000000000000000000000000001e-30"}).is_single());
  CHECK(normals("exponential_cone()", {"0", "1", "1"}).polyhedron->rays.size() == 1);
  CHECK(normals("exponential_cone()", {"0", "1", "999999999999999999999999999999e-30"}).is_empty());
  CHECK(normals("power_cone(1/3)", {"8", "1", "2"}).polyhedron->rays.size() == 1);
  CHECK(normals("power_cone(1/3)", {"8", "1", "2000000000000000000000000000001e-30"}).is_empty());
  CHECK(normals("power_cone(1/3)", {"8", "1", "1999999999999999999999999999999e-30"}).is_single());
  CHECK(normals("power_cone(0.3)", {"1", "-1", "0"}).is_empty());
  // e^(1/2) is no fraction: a point of fractions is inside or outside.
  CHECK(normals("exponential_cone()", {"1", "2", "3.2974425414002562936973015756283"}).is_empty());
  CHECK(normals("exponential_cone()", {"1", "2", "3.2974425414002562936973015756284"}).is_single());
}

TEST_CASE(
    "a set with more vertices than can be written is held by its support function, or refused, at once") {
  const Subdifferential cube = subdifferential(parsed("norm1()"), identity_gram(40), Fractions(40));
  CHECK_FALSE(cube.polyhedron);
  CHECK(cube.contains(Fractions(40, Fraction{1})));
  CHECK_FALSE(cube.contains(Fractions(40, Fraction{1001, 1000})));
  Fractions off(40);
  off[0] = Fraction{1};
  CHECK_THROWS_AS(subdifferential(parsed("norm1()"), identity_gram(40), off), InvalidInput);
  // A corner of a box has forty normals, and no more.
  CHECK(subdifferential(parsed("box(0, 1)"), identity_gram(40), Fractions(40)).polyhedron->rays.size() == 40);
}

TEST_CASE("normals of a ball and of a polyhedron that it crosses add up; where they touch it is refused") {
  const Fractions x = fractions_of({"1", "0"});
  const ExactGram W = identity_gram(2);
  const std::tuple<const char*, IntegerRows> crossing[] = {
      {"intersection(ball2(1), halfspace([1, 1], 1))", {{1, 0}, {1, 1}}},
      {"intersection(ball2(1), box(0, 1))", {{1, 0}, {0, -1}}},
      {"intersection(halfspace([0, 1], 0), ball2(1))", {{1, 0}, {0, 1}}}};
  for (const auto& [text, rays] : crossing) {
    CAPTURE(text);
    const Subdifferential found = subdifferential(parsed(text), W, x);
    REQUIRE(found.polyhedron);
    CHECK(found.polyhedron->lines.empty());
    CHECK(found.polyhedron->rays.size() == 2);
    for (const IntegerVector& ray : rays)
      CHECK(std::find(found.polyhedron->rays.begin(), found.polyhedron->rays.end(), ray) !=
            found.polyhedron->rays.end());
  }
  for (const char* touching :
       {"intersection(ball2(1), halfspace([-1, 0], -1))", "intersection(ball2(1), affine([[1, 0]], [1]))"})
    CHECK_THROWS_AS(subdifferential(parsed(touching), W, x), InvalidInput);
}
