#include "convex/proved_prox/proved_split.hpp"
#include "convex/proved_prox/doubles/metric_bounds.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/pair_search.hpp"

using namespace convex;

namespace {

Fraction read(const char* text) { return read_fraction(text).value(); }

Fractions read(const std::vector<const char*>& texts) {
  Fractions x;
  for (const char* text : texts) x.push_back(read(text));
  return x;
}

SplitQuestion question(const std::string& f, const Vector& z, const Metric& W) {
  return {cli::parse_call(f, "f"), fractions(z), exact_gram(W)};
}

Decomposition in_doubles(const SplitQuestion& q) {
  const Metric W = rounded(q.W);
  return decompose(make_function(q.f, {W}), nearest(q.z), W);
}

/// Functions of every kind of proof: by program, entry by entry, of norms, cones, matrices, by operations.
const std::vector<std::string> proved_calls = {
    "norm1(1/3)",
    "huber(0.1)",
    "indicator(simplex(1))",
    "indicator(polyhedron([[1,1,0],[-1,2,1],[0,0,-1]], [1,2,0]))",
    "total_variation(0.3)",
    "max()",
    "entropy()",
    "logistic()",
    "power(1.5)",
    "inverse_power(2)",
    "norm2(2)",
    "indicator(ball2(0.5))",
    "indicator(second_order_cone())",
    "indicator(rotated_second_order_cone())",
    "indicator(exponential_cone())",
    "indicator(power_cone(0.3))",
    "distance(box(-1, 1), 2)",
    "sum(norm2(), indicator(box(-1, 2)))",
    "sum(norm1(0.3), indicator(ball2(1)))",
    "sum(norm1(), norm2())",
    "inf_convolution(norm2(), norm1(0.75))",
    "envelope(entropy(), 0.25)",
    "conjugate(logistic())",
    "precompose(logistic(), [[1,2,0],[0,1,1]], [1,0])",
    "sum(norm1(0.3), log_sum_exp())",
    "sum(translate(norm2(2), [0.5,1,0]), log_sum_exp())",
    "sum(tilt(dilate(power(3), 2), [1,-0.5,0]), norm1(0.2))",
    "sum(precompose(logistic(), [[1,2,0],[0,1,1]], [1,0]), norm1(0.2))",
    "sum(scale(separable(exponential(), 1, logistic(), 2), 2), max())",
    "sum(sum(power(3), logistic()), norm1(0.2))",
    "inf_convolution(translate(power(3), [1,0,0]), norm2(2))",
    "pointwise_max(log_sum_exp(), hinge())",
    "pointwise_max(power(3), logistic(), max())",
    "pointwise_max(logistic(), indicator(ball2(1)), box(-1,3))"};

std::vector<Metric> some_metrics() {
  Matrix full(3, 3);
  full << 2, 1, 0, 1, 2, 0.5, 0, 0.5, 1;
  return {Metric::identity(3), Metric::diagonal(Vector::LinSpaced(3, 0.5, 3)), Metric::dense(full)};
}

std::vector<Vector> some_points() {
  std::vector<Vector> points;
  for (int k = 0; k < 3; ++k) {
    Vector z(3);
    z << 1.3 - k, -0.7 + 0.9 * k, 2.1 - 1.7 * k;
    points.push_back(z);
  }
  return points;
}

struct Reference {
  const char* call;
  std::vector<double> diagonal, z;
  std::vector<const char*> x;
};

/// tests/oracles/proved_proxes.py
const std::vector<Reference> references = {
    {"entropy()",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"0.6621950814645123395984616417714430041778", "0.07119142831598425687655430874113157296159",
      "0.7365516992819078533871388093721539041706"}},
    {"logistic()",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"0.603535291835346086449197910834743461225", "-0.895035849553747652577616271138394153198",
      "0.7615985909543540404108309314754048398627"}},
    {"exponential()",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"0.1211762030073766846030449283227079568372", "-0.9444472386653190692716305083487966997287",
      "0.04109591689195707977412761310221741051572"}},
    {"log_barrier()",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"1.804247641507075476415082547202830089623", "0.4253905296791060858110272093277266580651",
      "2.831371462260613214622623820804245134434"}},
    {"power(1.5)",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"0.3555631973245609882809835656723764163893", "-0.3234530216933672158840607993488015257917",
      "0.3500498009944333901637098066110938295539"}},
    {"inverse_power(2)",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"1.67533160290949365818175683290723736857", "0.8542349600434467591880460200520328015457",
      "2.410564259766085329851388607531782391586"}},
    {"binary_entropy()",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"0.646464708164653913550802089165256538775", "0.1434525793551443978531807518875967004385",
      "0.6738351216782857644406736833150895697664"}},
    {"kullback_leibler(2)",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"1.522677127091675905585968517687946371842", "0.2634739599954177472794358639566602849578",
      "2.062985728584143248594422160466628559464"}},
    {"log_sum_exp()",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"0.8456823260620500660918070806107481548067", "-0.7894077930892879546905584292494499136729",
      "1.091266520233051686578619555776303345078"}},
    {"norm2()",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"0.6685164735131459726229030238886726000012", "-0.5226823559317473804286316600219069461323",
      "0.7756539906970503225818765376065153286034"}},
    {"indicator(ball2())",
     {1.0, 2.0, 0.5},
     {1.25, -0.75, 2.125},
     {"0.5871437377643287566090236731020883804927", "-0.4793939573385044000915411780158368790881",
      "0.6522604271849253992220637431477734010147"}},
    {"indicator(exponential_cone())",
     {1.0, 1.0, 1.0},
     {0.5, 1.25, 0.375},
     {"0.02985305806613435245790833882575382705457", "0.7974532422690740332225381399399833748667",
      "0.827872120870397701996040866086831159679"}},
};

Vector vector_of(const std::vector<double>& x) {
  return Eigen::Map<const Vector>(x.data(), static_cast<Index>(x.size()));
}

}  // namespace

TEST_CASE("what is proved of x and of y is at least the distance to the proxes that mpmath finds") {
  for (const Reference& one : references) {
    CAPTURE(one.call);
    const SplitQuestion q = question(one.call, vector_of(one.z), Metric::diagonal(vector_of(one.diagonal)));
    const Decomposition split = in_doubles(q);
    const ProvedSplit proof = prove(q, split);
    REQUIRE(proof.level == ProofLevel::enclosure);
    const ProvedMetric W(q.W);
    const Fractions x = read(one.x), y = difference(q.z, x);
    CHECK(W.norm_above(difference(fractions(split.x.x), x)) <= proof.x_bound);
    CHECK(W.norm_above(difference(fractions(split.y.x), y)) <= proof.y_bound);
    CHECK(proof.error_bound() <= 1e-13);
  }
}

TEST_CASE("an x that is off by a billionth is told so, by its own proof, and y is not blamed for it") {
  for (const std::string& f : proved_calls)
    for (const Metric& W : some_metrics()) {
      CAPTURE(f);
      const SplitQuestion q = question(f, some_points()[0], W);
      Decomposition split = in_doubles(q);
      const ProvedSplit right = prove(q, split);
      REQUIRE(right.level != ProofLevel::none);
      REQUIRE(right.error_bound() <= 1e-10);
      constexpr double planted = 1e-9;
      const Vector step = planted * Vector::Unit(3, 1) / W.norm(Vector::Unit(3, 1));
      Decomposition wrong_x = split, wrong_y = split;
      wrong_x.x.x += step;
      wrong_y.y.x += step;
      const ProvedSplit of_x = prove(q, wrong_x), of_y = prove(q, wrong_y);
      REQUIRE(of_x.level != ProofLevel::none);
      REQUIRE(of_y.level != ProofLevel::none);
      CHECK(of_x.x_bound >= planted - 1e-10);
      CHECK(of_x.y_bound <= 1e-10);
      CHECK(of_y.y_bound >= planted - 1e-10);
      CHECK(of_y.x_bound <= 1e-10);
      CHECK(std::max(of_x.x_bound, of_y.y_bound) <= 1e-8);
    }
}

TEST_CASE("the radius covers the true prox for any pair of point and covector, near or far") {
  // With another pair than that of z the residual speaks; at z = x + W⁻¹v of two unrelated pairs the residual
  // is 0, and the gap alone does. A bound without one of the two terms fails here.
  for (const std::string f : {"norm1(1/3)", "huber(0.1)", "total_variation(0.3)", "indicator(simplex(1))"})
    for (const Metric& metric : some_metrics()) {
      CAPTURE(f);
      const ProvedMetric W(exact_gram(metric));
      const Call call = cli::parse_call(f, "f");
      const auto points = some_points();
      for (const Vector& a : points)
        for (const Vector& b : points) {
          PairSearch first = pair_of_call(call, W.gram(), fractions(a), fractions(Vector(0.5 * b)));
          const PairSearch second = pair_of_call(call, W.gram(), fractions(b), fractions(Vector(0.5 * a)));
          REQUIRE(first.pair);
          REQUIRE(second.pair);
          first.pair->v = second.pair->v;
          first.pair->f_v = second.pair->f_v;
          for (const Fractions& z : {fractions(a), pairs::sum_of(first.pair->x, W.solve(first.pair->v))}) {
            const ExactSplit truth = exact_split({call, z, W.gram()});
            const double radius = proved_radius(W, z, *first.pair);
            CHECK(W.norm_above(difference(first.pair->x, truth.x)) <= radius * (1 + 1e-12));
            CHECK(W.norm_above(difference(W.solve(first.pair->v), truth.y)) <= radius * (1 + 1e-12));
          }
        }
    }
}

TEST_CASE("a value of g that is too small contradicts Fenchel's inequality, and proves nothing") {
  for (const std::string& f : proved_calls) {
    CAPTURE(f);
    const SplitQuestion q = question(f, some_points()[0], Metric::identity(3));
    const Decomposition split = in_doubles(q);
    const ProvedMetric W(q.W);
    PairSearch search = pair_of_call(q.f, q.W, fractions(split.x.x), difference(q.z, fractions(split.x.x)));
    REQUIRE(search.pair);
    CHECK(proved_radius(W, q.z, *search.pair) <= 1e-11);
    ProofPair smaller = *search.pair, larger = smaller;
    const Fraction wrong = fraction(1e-9);
    smaller.f_v.high = smaller.f_v.high - wrong;
    larger.f_v.high = larger.f_v.high + wrong;
    CHECK(std::isinf(proved_radius(W, q.z, smaller)));
    CHECK(proved_radius(W, q.z, larger) >= 4.4e-5);  // sqrt(2e-9): a value says that much less than it could
  }
}

TEST_CASE("fractions of the proxes are those that the optimality conditions have by hand") {
  Matrix gram(3, 3);
  gram << 2, 1, 0, 1, 2, 0, 0, 0, 1;
  // W(z - x) = (0, 1/3·…): x = (8/3, -2/3, 0) has W(z - x) = (1/3, -1/3, 1/5), |1/5| < 1/3.
  const ExactSplit norm = exact_split(
      {cli::parse_call("norm1(1/3)", "f"), read({"3", "-1", "0.2"}), exact_gram(Metric::dense(gram))});
  CHECK((norm.x == read({"8/3", "-2/3", "0"})));
  CHECK((norm.y == read({"1/3", "-1/3", "1/5"})));
  CHECK((norm.f_x == read("10/9")));
  CHECK((norm.g_y == Fraction{0}));
  // On the simplex with one entry at 0: (z_1 + z_2 - 1)/2 is taken from the two others.
  const ExactSplit simplex = exact_split(
      {cli::parse_call("indicator(simplex(1))", "f"), read({"1/3", "1", "-5"}), identity_gram(3)});
  CHECK((simplex.x == read({"1/6", "5/6", "0"})));
  CHECK((simplex.y == read({"1/6", "1/6", "-5"})));
  // ½ x²/mu + ½ (x - z)² for |x| <= mu: x = mu z/(1 + mu).
  const ExactSplit huber =
      exact_split({cli::parse_call("huber(1/7)", "f"), read({"1/2", "2"}), identity_gram(2)});
  CHECK((huber.x == read({"1/16", "1"})));
}

TEST_CASE("numbers count as they are written, also inside of the function") {
  const SplitQuestion q{cli::parse_call("norm1(weight=0.1)", "f"), Fractions{read("0.3")}, identity_gram(1)};
  CHECK((exact_split(q).x == Fractions{read("1/5")}));
}

TEST_CASE("enclosures of f, g and the product hold the exact values") {
  for (const std::string f : {"norm1(1/3)", "huber(0.1)", "indicator(simplex(1))", "max()"})
    for (const Metric& W : some_metrics())
      for (const Vector& z : some_points()) {
        CAPTURE(f);
        const SplitQuestion q = question(f, z, W);
        const ProvedSplit proof = prove(q, in_doubles(q));
        const ExactSplit truth = exact_split(q);
        const auto holds = [](const ProvedInterval& interval, const Fraction& value) {
          return !(value < fraction(interval.low)) && !(fraction(interval.high) < value);
        };
        CHECK(holds(proof.f_x, truth.f_x));
        CHECK(holds(proof.g_y, truth.g_y));
        CHECK(holds(proof.inner, truth.inner));
      }
}

TEST_CASE(
    "where a corner and a sphere meet, the proof covers the point of the sphere along the soft threshold") {
  // prox of weight |.|_1 on the unit ball is the projection of the soft threshold (Yu 2013).
  for (const Vector& z : {Vector{{2.0, -0.2, 1.0}}, Vector{{0.1, 0.2, -3}}, Vector{{-1.5, 1.25, 0.3}}}) {
    const SplitQuestion q = question("sum(norm1(0.3), indicator(ball2(1)))", z, Metric::identity(3));
    const ProvedSplit proof = prove(q, in_doubles(q));
    REQUIRE(proof.level == ProofLevel::enclosure);
    Vector soft = z;
    for (double& entry : soft) entry = std::copysign(std::max(std::abs(entry) - 0.3, 0.0), entry);
    const Vector truth = soft / std::max(1.0, soft.norm());
    CHECK(proof.error_bound() <= 1e-14);
    CHECK((in_doubles(q).x.x - truth).norm() <= proof.x_bound + 1e-15);
    Decomposition off = in_doubles(q);
    off.x.x *= 1 + 1e-9;
    CHECK(prove(q, off).x_bound >= 0.99e-9 * truth.norm());
  }
}

TEST_CASE("a bound of the least eigenvalue is below it, and near it where that is well conditioned") {
  for (const Metric& W : some_metrics()) {
    if (W.kind() != MetricKind::dense) continue;
    const double least = near_graphs::least_eigenvalue_below(W.dense_gram());
    const double truth = Eigen::SelfAdjointEigenSolver<Matrix>(W.dense_gram()).eigenvalues().minCoeff();
    CHECK(least <= truth);
    CHECK(least >= 0.5 * truth);
  }
}

TEST_CASE(
    "the values that proofs are made of are those of the functions in doubles, over the whole catalogue") {
  int compared = 0;
  for (const CatalogueEntry& entry : catalogue())
    for (const std::string_view example : entry.examples) {
      CAPTURE(example);
      const Call call = cli::parse_call(example, "f");
      const Index n = cli::number_of_entries(call);
      Vector z = Vector::LinSpaced(n, -1.25, 2.25);
      if (n > 1) z[1] = 1.75;
      const Function f = make_function(call, {Metric::identity(n)});
      const Prox at = f.prox(z, Metric::identity(n));
      const PairSearch search = pair_of_call(call, identity_gram(static_cast<std::size_t>(n)),
                                             fractions(at.x), fractions(Vector(z - at.x)));
      if (!search.pair) continue;
      ++compared;
      const ProofPair& pair = *search.pair;
      const auto agrees = [](const FractionInterval& proved, const Value& value) {
        const double size = 1 + std::abs(nearest_double(proved.high));
        return std::abs(nearest_double(proved.high) - value.value) <= 1e-8 * size + value.error;
      };
      CHECK(agrees(pair.f_x, f.evaluate(nearest(pair.x))));
      CHECK(agrees(pair.f_v, f.conjugate().evaluate(nearest(pair.v))));
    }
  CHECK(compared >= 165);
}
