#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// N spheres of mass 1 and radius 1/2 on top of each other, under gravity 10.
std::string column(int N) {
  return "[system]\ncoordinates = [\"x[1..N]\"]\nkinetic = \"sum(i in 1..N, m/2*x[i]'^2)\"\n"
         "[system.parameters]\nN = " +
         std::to_string(N) +
         "\nm = 1.0\nr = 0.5\n"
         "[system.forces]\n\"x[i]\" = \"-m*10\"\n"
         "[system.constraints]\nfloor = \"x[1] >= r\"\n\"gap[i in 1..N-1]\" = \"x[i+1] - x[i] >= 2*r\"\n"
         "[state]\nposition = { \"x[i]\" = \"r + 2*r*(i-1)\" }\n";
}

}  // namespace

TEST_CASE("a thousand spheres on top of each other carry the weight of those above") {
  constexpr int N = 1000;
  const Outcome outcome = run_json_on("solve", column(N));
  CHECK(outcome.code == 0);
  const Json object = Json::parse(outcome.out);
  CHECK(object.at("status") == "solved");
  const Json& multipliers = object.at("multipliers");
  REQUIRE(multipliers.size() == N);
  CHECK(multipliers.at("floor").get<double>() == doctest::Approx(10.0 * N));
  for (int i = 1; i < N; ++i)
    CHECK(multipliers.at("gap[" + std::to_string(i) + "]").get<double>() == doctest::Approx(10.0 * (N - i)));
  CHECK(object.at("active").size() == N);
  CHECK(object.at("acceleration").begin().key() == "x[1]");
  CHECK(std::prev(object.at("acceleration").end()).key() == "x[1000]");
}

TEST_CASE("on the screen a long table is cut, and the reader is told where the rest is") {
  const Outcome outcome = run_on("solve", column(1000));
  CHECK(outcome.code == 0);
  CHECK(outcome.out.size() < 20000);
  CHECK(outcome.out.find("--json") != std::string::npos);
}

TEST_CASE("an empty family is a family") {
  const Outcome outcome = run_json_on("solve", column(1));
  CHECK(outcome.code == 0);
  CHECK(Json::parse(outcome.out).at("multipliers") == Json{{"floor", 10}});
  const Json none =
      Json::parse(run_json_on("solve", point_on_floor({{2, R"(coordinates = ["x", "y", "z[1..0]"])"}})).out);
  CHECK(none.at("acceleration").size() == 2);
}

TEST_CASE("a system without coordinates has nothing to find") {
  const Outcome outcome =
      run_json_on("solve", "[system]\ncoordinates = []\nkinetic = \"0\"\n[state]\nposition = { }\n");
  CHECK(outcome.code == 0);
  CHECK(Json::parse(outcome.out).at("acceleration") == Json::object());
}
