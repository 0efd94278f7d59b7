#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/laws/map_laws.hpp"
#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;
using convex::Fraction;
using convex::Vector;

namespace {

/// A map as the program reads it, its metric, and the same map in C++.
struct KnownMap {
  const char* text;
  const char* metric;  ///< "" for the identity
  std::function<Vector(const Vector&)> map;
};

Vector of(double x) { return Vector::Constant(1, x); }
Vector of(double x, double y) { return Eigen::Vector2d(x, y); }
using In = const Vector&;

std::vector<KnownMap> proxes() {
  return {
      {"x/2", "", [](In z) { return of(z[0] / 2); }},
      {"max(x, 0)", "", [](In z) { return of(std::max(z[0], 0.0)); }},
      {"max(x-1, 0) + min(x+1, 0)", "",
       [](In z) { return of(std::max(z[0] - 1, 0.0) + std::min(z[0] + 1, 0.0)); }},
      {"min(max(x, -1), 2)", "", [](In z) { return of(std::clamp(z[0], -1.0, 2.0)); }},
      {"x/(1 + abs(x))", "", [](In z) { return of(z[0] / (1 + std::abs(z[0]))); }},
      {"[x1/2, x2/3]", "", [](In z) { return of(z[0] / 2, z[1] / 3); }},
      {"[x1 - max(x1+x2, 0)/2, x2 - max(x1+x2, 0)/2]", "",
       [](In z) { return of(z[0] - std::max(z.sum(), 0.0) / 2, z[1] - std::max(z.sum(), 0.0) / 2); }},
      {"[(2*x1 + x2)/5, (x1 + 2*x2)/5]", "",
       [](In z) { return of((2 * z[0] + z[1]) / 5, (z[0] + 2 * z[1]) / 5); }},
      {"[x1/max(1, hypot(x1, x2)), x2/max(1, hypot(x1, x2))]", "",
       [](In z) -> Vector { return z / std::max(1.0, z.norm()); }},
      {"[max(x1, 0), x2 - max(-x1, 0)/2]", "[[2, 1], [1, 2]]",
       [](In z) { return of(std::max(z[0], 0.0), z[1] - std::max(-z[0], 0.0) / 2); }},
  };
}

std::vector<KnownMap> no_proxes() {
  return {
      {"1001*x/1000", "", [](In z) { return of(1.001 * z[0]); }},
      {"-x/2", "", [](In z) { return of(-z[0] / 2); }},
      {"x*step(abs(x) - 1)", "", [](In z) { return of(std::abs(z[0]) >= 1 ? z[0] : 0); }},
      {"sin(x)", "", [](In z) { return of(std::sin(z[0])); }},
      {"x^2/16", "", [](In z) { return of(z[0] * z[0] / 16); }},
      {"[-x2, x1]", "", [](In z) { return of(-z[1], z[0]); }},
      {"[(24*x1 - 7*x2)/25, (7*x1 + 24*x2)/25]", "",
       [](In z) { return of((24 * z[0] - 7 * z[1]) / 25, (7 * z[0] + 24 * z[1]) / 25); }},
      {"[x1/2 - x2/10, x2/2 + x1/10]", "",
       [](In z) { return of(z[0] / 2 - z[1] / 10, z[1] / 2 + z[0] / 10); }},
      // The projection on one line after that on another.
      {"[x1/2, x1/2]", "", [](In z) { return of(z[0] / 2, z[0] / 2); }},
      // The projection of the metric [[2, 1], [1, 2]], in the plain one.
      {"[max(x1, 0), x2 - max(-x1, 0)/2]", "",
       [](In z) { return of(std::max(z[0], 0.0), z[1] - std::max(-z[0], 0.0) / 2); }},
  };
}

Outcome judge(const KnownMap& known) {
  std::vector<std::string> words{"check", "--map", known.text, "--json"};
  if (*known.metric != '\0') words.insert(words.end(), {"--metric", known.metric});
  return run(words);
}

using Point = std::vector<Fraction>;

std::vector<Point> points_of(const Json& list) {
  std::vector<Point> points;
  for (const Json& entries : list) {
    points.emplace_back();
    for (const Json& entry : entries)
      points.back().push_back(*convex::read_fraction(entry.get<std::string>()));
  }
  return points;
}

Point minus(const Point& a, const Point& b) {
  Point d;
  for (std::size_t i = 0; i < a.size(); ++i) d.push_back(a[i] - b[i]);
  return d;
}

Fraction product(const Point& a, const Point& b) {
  Fraction sum{0, 1};
  for (std::size_t i = 0; i < a.size(); ++i) sum = sum + a[i] * b[i];
  return sum;
}

}  // namespace

TEST_CASE("maps that are no prox are each refuted by points that fractions confirm") {
  for (const KnownMap& known : no_proxes()) {
    CAPTURE(known.text);
    const Outcome outcome = judge(known);
    CHECK(outcome.code == 1);
    const Json answer = Json::parse(outcome.out);
    REQUIRE(answer.at("status") == "refuted");
    const Json& found = answer.at("counterexample");
    const std::vector<Point> x = points_of(found.at("points")), Tx = points_of(found.at("images"));
    REQUIRE(x.size() >= 2);
    for (std::size_t k = 0; k < x.size(); ++k) {
      Vector at(static_cast<convex::Index>(x[k].size()));
      for (std::size_t i = 0; i < x[k].size(); ++i)
        at[static_cast<convex::Index>(i)] = convex::nearest_double(x[k][i]);
      const Vector image = known.map(at);
      for (std::size_t i = 0; i < x[k].size(); ++i)
        CHECK(convex::nearest_double(Tx[k][i]) ==
              doctest::Approx(image[static_cast<convex::Index>(i)]).epsilon(1e-13));
    }
    Fraction excess{0, 1};
    if (found.at("law") == "nonexpansive") {
      excess =
          product(minus(Tx[0], Tx[1]), minus(Tx[0], Tx[1])) - product(minus(x[0], x[1]), minus(x[0], x[1]));
    } else {
      for (std::size_t k = 0; k < x.size(); ++k)
        excess = excess - product(Tx[k], minus(x[k], x[(k + 1) % x.size()]));
    }
    CHECK(sign(excess) > 0);
    CHECK(excess == *convex::read_fraction(found.at("excess").get<std::string>()));
  }
}

TEST_CASE("maps that are a prox are not refuted, by their expressions or as C++ functions") {
  for (const KnownMap& known : proxes()) {
    CAPTURE(known.text);
    const Outcome outcome = judge(known);
    CHECK(outcome.code == 0);
    CHECK(Json::parse(outcome.out).at("status") == "not-refuted");
    if (*known.metric != '\0') continue;
    const convex::Index n = known.text[0] == '[' ? 2 : 1;
    CHECK_FALSE(laws(convex::map_of(known.map, n), convex::identity_metric(n)).counterexample.has_value());
  }
}

TEST_CASE("a linear map that is not symmetric is refuted however little it turns") {
  for (const auto& [turn, law] : {std::pair{"1/50", "cyclically-monotone"},
                                  {"1/100", "cyclically-monotone"},
                                  {"1/10000000", "symmetric"},
                                  {"1/1000000000000000000000000000000", "symmetric"}}) {
    CAPTURE(turn);
    const Fraction t = *convex::read_fraction(turn), half{1, 2};
    const Outcome outcome = run({"check", "--map", "[x1/2 + x2*" + std::string(turn) + ", x2/2]", "--json"});
    CHECK(outcome.code == 1);
    const Json found = Json::parse(outcome.out).at("counterexample");
    REQUIRE(found.at("law") == law);
    const Fraction excess = *convex::read_fraction(found.at("excess").get<std::string>());
    if (found.at("law") == "symmetric") {
      CHECK(excess == t);
      CHECK(found.at("entries").at("radius") == 0);
      continue;
    }
    const std::vector<Point> x = points_of(found.at("points"));
    CHECK(x.size() > 64);
    Fraction sum{0, 1};
    for (std::size_t k = 0; k < x.size(); ++k)
      sum = sum + product({half * x[k][0] + t * x[k][1], half * x[k][1]}, minus(x[k], x[(k + 1) % x.size()]));
    CHECK(sum == -excess);
    CHECK(sign(sum) < 0);
  }
}

TEST_CASE("of a map that bends the entries of its derivative are enclosed, and their difference refutes it") {
  const Outcome outcome = run({"check", "--map", "[x1/2 + sin(x2)/10^7, x2/2 + 2*sin(x1)/10^7]", "--json"});
  CHECK(outcome.code == 1);
  const Json found = Json::parse(outcome.out).at("counterexample");
  REQUIRE(found.at("law") == "symmetric");
  const Json& entries = found.at("entries");
  CHECK(entries.at("radius") > 0);
  CHECK(entries.at("radius") < 1e-60);
  const Point x = points_of(found.at("points")).front();
  const double of_first = std::cos(convex::nearest_double(x[1])) * 1e-7,
               of_second = 2 * std::cos(convex::nearest_double(x[0])) * 1e-7;
  const double value = convex::nearest_double(*convex::read_fraction(entries.at("value").get<std::string>())),
               mirrored =
                   convex::nearest_double(*convex::read_fraction(entries.at("mirrored").get<std::string>()));
  CHECK(std::max(value, mirrored) == doctest::Approx(std::max(of_first, of_second)).epsilon(1e-12));
  CHECK(std::min(value, mirrored) == doctest::Approx(std::min(of_first, of_second)).epsilon(1e-12));
}

TEST_CASE("kinks of a text are looked at, however narrow they are or far out") {
  for (const char* map : {"x/2 + max(0, 0.001-abs(x-0.3333))*5", "if(x<77.123, x/2, x/2+0.001)",
                          "if(x<-1/3, x/2, x/2+1/10^9)"}) {
    CAPTURE(map);
    CHECK(run({"check", "--map", map}).code == 1);
  }
  const Json far = Json::parse(run({"check", "--map", "max(x, 100)", "--json"}).out);
  REQUIRE(far.at("f").size() == 1);
  CHECK(far.at("f")[0].at("low") == "100");
  CHECK(far.at("f")[0].at("high").is_null());
  CHECK(far.at("seen")[0] == -4);
  CHECK(far.at("seen")[1] == 108);
  const Json narrow =
      Json::parse(run({"check", "--map", "x/2 + max(0, 0.001-abs(x-0.3333))/4", "--json"}).out);
  CHECK(narrow.at("status") == "not-refuted");
  CHECK(narrow.at("f").size() > 2);
}

TEST_CASE("at a kink no derivative is taken, however its branches are written") {
  // The projection on x1 <= x2; at 0, where all points of this box lie, one row would be that of either side.
  const Outcome outcome = run(
      {"check", "--map", "[x1 - max(x1 - x2, 0)/2, x2 - min(0, x2 - x1)/2]", "--box", "0:0.01", "--json"});
  CHECK(outcome.code == 0);
  CHECK(Json::parse(outcome.out).at("symmetric_at") == 0);
}

TEST_CASE("maps of C++ that are no prox are refuted beyond what rounding of their values could do") {
  for (const KnownMap& known : no_proxes()) {
    CAPTURE(known.text);
    const convex::Index n = known.text[0] == '[' ? 2 : 1;
    CHECK(laws(convex::map_of(known.map, n), convex::identity_metric(n)).counterexample.has_value());
  }
}

TEST_CASE("a map with affine pieces gives the function back that it is the prox of") {
  const Json answer = Json::parse(run({"check", "--map", "max(x-1/3, 0) + min(x+1/3, 0)", "--json"}).out);
  const Json& f = answer.at("f");
  REQUIRE(f.size() == 2);
  CHECK(f[0].at("formula") == "-x/3");
  CHECK(f[1].at("formula") == "x/3");
  CHECK(f[0].at("high") == "0");
}

TEST_CASE("the function on a grid has the values of the one that the prox was made of") {
  const Folder folder;
  const std::string file = folder.path("f.csv");
  // The prox of x²/2 in both coordinates, in steps: T = z/2, f = |p|²/2.
  CHECK(run({"check", "--map", "[x1/2, x2/2]", "--data", file}).code == 0);
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  CHECK(line == "z[0],z[1],Tz[0],Tz[1],f,error");
  int rows = 0;
  while (std::getline(stream, line)) {
    std::vector<double> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    CHECK(row[4] == doctest::Approx((row[2] * row[2] + row[3] * row[3]) / 2).epsilon(1e-9));
    ++rows;
  }
  CHECK(rows == 21 * 21);
}

TEST_CASE("a table of points is judged as it stands, and joined to a function") {
  const Folder folder;
  const std::string good = folder.write("good.csv", "z,T\n-2,-1\n-1,0\n1,0\n2,1\n");
  const Json answer = Json::parse(run({"check", "--table", good, "--json"}).out);
  CHECK(answer.at("status") == "not-refuted");
  CHECK(answer.at("f").size() == 2);
  const Outcome refuted = run({"check", "--table", folder.write("bad.csv", "0,0\n1,3/2\n"), "--json"});
  CHECK(refuted.code == 1);
  CHECK(Json::parse(refuted.out).at("counterexample").at("excess") == "5/4");
  CHECK(run({"check", "--table", folder.write("odd.csv", "0,0,1\n1,2,3\n")}).code == 2);
}

TEST_CASE("what is no map is refused with what to do") {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"check", "--map", "[x1, y]"},
                                                {"check", "--map", "[x1"},
                                                {"check", "--map", ""},
                                                {"check", "--map", "x'", "--json"},
                                                {"check", "--map", "x", "--box", "4:-4"},
                                                {"check", "--map", "x", "--box", "4"},
                                                {"check", "--map", "x", "--metric", "[[2, 1], [1, 2]]"},
                                                {"check", "--map", "x", "--catalogue"}}) {
    CAPTURE(words[2]);
    CHECK(run(words).code == 2);
  }
}

TEST_CASE("a coordinate for which a map has no component is told so, not as a slip of another") {
  const std::string two = run({"check", "--map", "[x1, x3]"}).err;
  CHECK(two.find("--map:1:6") != std::string::npos);
  CHECK(two.find("two components have x1 and x2; a map has as many components as coordinates") !=
        std::string::npos);
  CHECK(run({"check", "--map", "x2"}).err.find("one component has x;") != std::string::npos);
  CHECK(run({"check", "--map", "[x1/2, exp(-x2)]"}).err.find("unknown") == std::string::npos);
}
