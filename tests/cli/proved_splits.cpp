#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

Json json_of(const std::vector<std::string>& arguments) { return Json::parse(run(arguments).out); }

}  // namespace

TEST_CASE(
    "a certified prox says at which level, how far x and y are, and between what f, g and the product lie") {
  const Outcome outcome = run({"prox", "norm1()", "--at", "[3,-1,0.2]", "--certify", "--json"});
  CHECK(outcome.code == 0);
  const Json answer = Json::parse(outcome.out);
  const Json& proof = answer["certificate"];
  CHECK(proof["level"] == "exact");
  CHECK(proof["error_bound"].get<double>() <= 1e-15);
  CHECK(proof["error_bound"].get<double>() == std::max(proof["x"].get<double>(), proof["y"].get<double>()));
  CHECK(proof["sum"].get<double>() <= proof["x"].get<double>() + proof["y"].get<double>());
  CHECK(proof["f_x"][0].get<double>() <= 2);
  CHECK(proof["f_x"][1].get<double>() >= 2);
  CHECK(proof["g_y"][0].get<double>() <= 0);
  CHECK(proof["inner"][1].get<double>() >= 2);
  const Json curved = json_of({"prox", "entropy()", "--at", "[3,-1,0.2]", "--certify", "--json"});
  CHECK(curved["certificate"]["level"] == "enclosure");
  CHECK(curved["certificate"]["error_bound"].get<double>() <= 1e-14);
}

TEST_CASE("method exact prints fractions, of the numbers as they are written") {
  const Json answer = json_of({"prox", "norm1(1/3)", "--at", "[3,-1,0.2]", "--metric",
                               "[[2,1,0],[1,2,0],[0,0,1]]", "--method", "exact", "--json"});
  CHECK(answer["status"] == "solved");
  CHECK(answer["exact"]["x"] == Json::array({"8/3", "-2/3", "0"}));
  CHECK(answer["exact"]["y"] == Json::array({"1/3", "-1/3", "1/5"}));
  CHECK(answer["exact"]["f_x"] == "10/9");
  CHECK(answer["certificate"]["level"] == "exact");
}

TEST_CASE("a decomposition file is proved too: strings are exact, floats are doubles") {
  const std::string bytes =
      "[decomposition]\nz = [\"1/3\", 0.1]\nf = \"norm1(weight=1/3)\"\n"
      "metric = [[\"1/3\", 0], [0, 1]]\n";
  const Folder folder;
  const std::string file = folder.write("split.toml", bytes);
  const Outcome exact = run({"solve", "--json", "--method", "exact", file});
  CHECK(exact.code == 0);
  const Json fractions = Json::parse(exact.out)["exact"];
  CHECK(fractions["y"] == Json::array({"1/3", "3602879701896397/36028797018963968"}));
  const Outcome certified = run({"solve", "--json", "--certify", file});
  CHECK(certified.code == 0);
  CHECK(Json::parse(certified.out)["certificate"]["level"] == "exact");
}

TEST_CASE("without a proof the level is none, the reason is said and the exit code is 3") {
  // A sphere and the surface of a cone.
  const Outcome outcome = run({"prox", "indicator(intersection(ball2(1), second_order_cone()))", "--at",
                               "[3,1,2]", "--certify", "--json"});
  CHECK(outcome.code == 3);
  const Json answer = Json::parse(outcome.out);
  CHECK(answer["certificate"]["level"] == "none");
  CHECK_FALSE(answer["certificate"]["why"].get<std::string>().empty());
}

TEST_CASE("method exact is refused for what is not piecewise linear-quadratic, and says why") {
  const Outcome outcome = run({"prox", "norm2()", "--at", "[1,2]", "--method", "exact"});
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("piecewise linear-quadratic") != std::string::npos);
  CHECK(run({"prox", "norm2()", "--at", "[1,2]", "--method", "admm"}).code == 2);
  CHECK(run({"conjugate", "norm1()", "--certify"}).code == 2);
}

TEST_CASE("the value of a conjugate is proved, +inf included") {
  const Json value = json_of({"conjugate", "huber(1/3)", "--at", "[1/3,0.2]", "--method", "exact", "--json"});
  CHECK(value["exact"]["value"] == "17/675");  // (1/9 + 1/25)/6
  const Json outside = json_of({"conjugate", "norm1()", "--at", "[1.5,0]", "--certify", "--json"});
  CHECK(outside["value"] == "inf");
  CHECK(outside["certificate"]["level"] == "exact");
  CHECK(outside["certificate"]["error_bound"] == 0);
  const Json curved = json_of({"conjugate", "entropy()", "--at", "[1,1]", "--certify", "--json"});
  CHECK(curved["certificate"]["level"] == "enclosure");
  CHECK(curved["certificate"]["value"][0].get<double>() <= 2);  // e^0 + e^0
  CHECK(curved["certificate"]["value"][1].get<double>() >= 2);
  CHECK(curved["error_bound"].get<double>() <= 1e-15);
}

TEST_CASE("the value of a conjugate is proved where no point attains it, and where it is infinite") {
  for (const auto& [f, y, value] :
       std::vector<std::array<const char*, 3>>{{"exponential()", "[0]", "0"},
                                               {"exponential()", "[-1]", "\"inf\""},
                                               {"log_barrier()", "[0]", "\"inf\""},
                                               {"logistic()", "[1]", "0"},
                                               {"inverse_power(1)", "[0]", "0"},
                                               {"norm2()", "[0.6,0.8]", "0"},  // as written: |y| is 1
                                               {"second_order_cone()", "[0.6,0.8,-2]", "0"},
                                               {"sum(exponential(), norm1())", "[2]", "-1"}}) {
    CAPTURE(f);
    const Json found = json_of({"conjugate", f, "--at", y, "--certify", "--json"});
    CHECK(found["value"] == Json::parse(value));
    CHECK(found["certificate"]["level"] != "none");
    CHECK(found["certificate"]["error_bound"].get<double>() <= 1e-300);
  }
}

TEST_CASE("of one variable distances and maxima of parabolas are proved in fractions, at their corners too") {
  for (const auto& [f, z, x] : std::vector<std::array<const char*, 3>>{
           {"distance(box(4,5))", "[1]", "2"},
           {"distance(box(4,5), 1/3)", "[9/2]", "9/2"},
           // 1 - x and 2x² meet at 1/2, with the slopes -1 and 2.
           {"pointwise_max(hinge(), squared_norm2(4))", "[1/2]", "1/2"},
           {"pointwise_max(hinge(), squared_norm2(4))", "[5/2]", "1/2"},
           {"pointwise_max(hinge(), squared_norm2(4))", "[5]", "1"},
           {"precompose(distance(box(-1,1)), [[-2]], [0])", "[1/2]", "1/2"}}) {
    CAPTURE(f);
    CAPTURE(z);
    const Json exact = json_of({"prox", f, "--at", z, "--method", "exact", "--json"});
    CHECK(exact["exact"]["x"][0] == x);
    const Json proved = json_of({"prox", f, "--at", z, "--certify", "--json"});
    CHECK(proved["certificate"]["level"] == "exact");
    CHECK(proved["certificate"]["error_bound"].get<double>() <= 1e-15);
  }
}

TEST_CASE("in a full metric a polyhedral function is proved in fractions as long as these are quick") {
  const auto level = [](int n) {
    std::string metric = "[", z = "[";
    for (int i = 0; i < n; ++i) {
      metric += i > 0 ? ",[" : "[";
      for (int j = 0; j < n; ++j)
        metric += (j > 0 ? "," : "") + std::to_string(i == j ? 2 * n : 1 + (i + j) % 2);
      metric += "]";
      z += (i > 0 ? "," : "") + std::to_string((7 * i) % 11 - 5) + "/3";
    }
    return json_of({"prox", "norm1()", "--at", z + "]", "--metric", metric + "]", "--certify", "--json"});
  };
  for (const int n : {8, 20, 30}) {
    const Json found = level(n);
    CHECK(found["certificate"]["level"] == "exact");
    CHECK(found["certificate"]["error_bound"].get<double>() <= 1e-13);
  }
  CHECK(level(90)["certificate"]["level"] == "enclosure");
}

TEST_CASE("the catalogue says how many of its examples are proved, and names the others with the reason") {
  const Outcome outcome = run({"check", "--catalogue", "--certify", "--json"});
  const Json answer = Json::parse(outcome.out);
  int proved = 0;
  for (const Json& one : answer["functions"]) {
    CAPTURE(one["call"]);
    const bool all = one["proved"] == one["questions"];
    proved += all ? 1 : 0;
    CHECK(one.contains("why") == !all);
    if (one.contains("error_bound")) CHECK(one["error_bound"].get<double>() <= 1e-9);
  }
  CHECK(answer["proved"] == proved);
  CHECK(outcome.code == (answer["proved"] == answer["examples"] ? 0 : 3));
  CHECK(answer["examples"] == answer["functions"].size());
  CHECK(proved * 20 >= 17 * static_cast<int>(answer["functions"].size()));
}

TEST_CASE(
    "the subdifferential of a set is its normal cone, with the tangent and the critical cone beside it") {
  const Json answer =
      json_of({"subdifferential", "box(0,1/3)", "--at", "[1/3,0]", "--covector", "[2,0]", "--json"});
  CHECK(answer["contains"] == true);
  CHECK(answer["polyhedron"]["rays"] == Json::array({{0, -1}, {1, 0}}));
  CHECK(answer["tangent_cone"]["generators"] == Json::array({{-1, 0}, {0, 1}}));
  CHECK(answer["critical_cone"]["generators"] == Json::array({{0, 1}}));
  const Json empty = json_of({"subdifferential", "box(0,1/3)", "--at", "[0.3333333333333334,0]", "--json"});
  CHECK(empty["empty"] == true);
  CHECK(empty["set"].is_null());
}

TEST_CASE(
    "why a subdifferential is empty is told: x is outside, or outside by a rounding, or a slope is "
    "vertical") {
  const std::vector<std::array<std::string, 3>> table = {
      {"ball2()", "[3, 4]", "x is outside the domain by 4."},
      {"box(0, 1)", "[1.0000000000000002]",
       "x is outside the domain by a rounding, about 2.2e-16; give fractions, or a point inside."},
      {"sum(exponential(), indicator(box(0, 1)))", "[1.0000000000000002]",
       "a slope is vertical at x, or x is outside the domain by a rounding; give fractions, or a point "
       "inside."},
      {"log_barrier()", "[-1]", "x is outside the domain."},
      {"entropy()", "[0]", "a slope is vertical at x"}};
  for (const auto& [f, x, why] : table) {
    const Outcome outcome = run({"subdifferential", f, "--at", x});
    CAPTURE(f);
    CAPTURE(outcome.out);
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find("The subdifferential is empty: " + why) != std::string::npos);
  }
  // The point that a prox returns.
  const Json x = json_of({"prox", "ball2()", "--at", "[3,1,0.2]", "--json"})["x"];
  const Json at = json_of({"subdifferential", "ball2()", "--at", x.dump(), "--json"});
  CHECK(at["why"].get<std::string>().find("by a rounding") != std::string::npos);
}

TEST_CASE(
    "the directional derivative and the element of least norm are printed, and what has no rule is refused") {
  const Json corner =
      json_of({"subdifferential", "norm2(2)", "--at", "[0,0]", "--direction", "[3,4]", "--json"});
  CHECK(corner["along"] == 10);
  CHECK(corner["set"] == "ball2(radius=2)");
  const Json least =
      json_of({"subdifferential", "max()", "--at", "[0,0]", "--metric", "diagonal [1,3]", "--json"});
  CHECK(least["least"] == Json::array({0.25, 0.75}));
  CHECK(least["least_norm"].get<double>() == doctest::Approx(0.5).epsilon(1e-15));
  const Outcome refused = run({"subdifferential", "epigraph(norm2())", "--at", "[1,0,0,1]"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("no rule") != std::string::npos);
  CHECK(run({"subdifferential", "norm1()", "--at", "[1,2]", "--covector", "[1]"}).code == 2);
}

TEST_CASE("numbers whose squares overflow are not called solved within an infinite bound") {
  for (const std::string f : {"point(0)", "norm1()", "squared_norm2()", "max()"})
    for (const std::vector<std::string>& proof :
         {std::vector<std::string>{}, {"--certify"}, {"--method", "exact"}}) {
      CAPTURE(f);
      std::vector<std::string> arguments = {"prox", f, "--at", "[1e200,-1e200]", "--json"};
      arguments.insert(arguments.end(), proof.begin(), proof.end());
      const Json answer = json_of(arguments);
      const Json& bound = answer["certificate"]["error_bound"];
      const bool small = bound.is_number() && bound.get<double>() <= 1e192;
      CHECK((answer["status"] == "solved") == small);
      if (!proof.empty() && proof[0] == "--method") CHECK(small);
    }
}

TEST_CASE("the subgradient of the Euclidean norm is the unit vector at any size of the point") {
  for (const char* at : {"[3e200,4e200]", "[3e-200,4e-200]", "[3,4]"}) {
    CAPTURE(at);
    const Json answer = json_of({"subdifferential", "norm2()", "--at", at, "--json"});
    CHECK(answer["least"][0].get<double>() == doctest::Approx(0.6).epsilon(1e-15));
    CHECK(answer["least"][1].get<double>() == doctest::Approx(0.8).epsilon(1e-15));
  }
}

TEST_CASE("a prox near 0, and far out, is that of an ordinary point, scaled") {
  // prox of w|.|_2 at z is (1 - w/|z|) z.
  for (const double size : {1e-200, 1e-100, 1.0, 1e100}) {
    CAPTURE(size);
    const auto number = [&](double a) {
      return std::to_string(a).substr(0, 3) + "e" +
             std::to_string(static_cast<int>(std::lround(std::log10(size))));
    };
    const Json answer = json_of(
        {"prox", "norm2(" + number(1) + ")", "--at", "[" + number(3) + "," + number(4) + "]", "--json"});
    CHECK(answer["status"] == "solved");
    CHECK(answer["x"][0].get<double>() / size == doctest::Approx(2.4).epsilon(1e-14));
    CHECK(answer["y"][1].get<double>() / size == doctest::Approx(0.8).epsilon(1e-14));
    CHECK(answer["certificate"]["error_bound"].get<double>() > 0);
    // Bounds are made of squares, which are 0 below 1e-160 or so.
    CHECK(answer["certificate"]["error_bound"].get<double>() <= std::max(1e-14 * size, 1e-150));
  }
  const Json box = json_of({"prox", "indicator(box(-1,2))", "--at", "[1e100]", "--json"});
  CHECK(box["x"][0] == 2);
}

TEST_CASE("the gradient of an envelope is right where a point is no longer told from its prox") {
  for (const char* at : {"[3,4]", "[3e16,4e16]", "[3e100,4e100]"}) {
    CAPTURE(at);
    const Json answer = json_of({"subdifferential", "envelope(norm2(),1)", "--at", at, "--json"});
    CHECK(answer["least"][0].get<double>() == doctest::Approx(0.6).epsilon(1e-13));
    CHECK(answer["least"][1].get<double>() == doctest::Approx(0.8).epsilon(1e-13));
  }
}

TEST_CASE("a certified prox whose equations depend on each other is answered, proved or not") {
  const Json answer = json_of({"prox", "perspective(squared_distance(affine([[0,0]],[0]),0.5))", "--at",
                               "[0.625,-3,1]", "--certify", "--json"});
  CHECK(answer["status"] != "error");
  CHECK(answer["x"] == Json::array({0.625, -3, 1}));
}

TEST_CASE(
    "what is proved of a plane is close where two columns of its equations all but depend on each other") {
  // The columns of the first two entries are opposite, but for the last digit of the second row.
  const std::string plane =
      "indicator(affine([[-0.35, 0.35, -1.45, 0.75], [-0.85, 0.8500000000000001, -2.35, 1.15]], [2.5, 4.7]))";
  for (const std::string metric :
       {"diagonal [1, 1, 1, 1]", "[[2, 1, 0, 0], [1, 2, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"}) {
    const Json answer =
        json_of({"prox", plane, "--at", "[-1.3, -1, -0.5, 3]", "--certify", "--json", "--metric", metric});
    CHECK(answer["status"] == "solved");
    CHECK(answer["certificate"]["level"] == "exact");
    CHECK(answer["certificate"]["error_bound"].get<double>() <= 1e-13);
  }
}
