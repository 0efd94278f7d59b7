#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

Json derived(const std::string& text) { return Json::parse(run_json_on("derive", text).out); }

}  // namespace

TEST_CASE("derive gives A, z, U and s of the contacts present, by name") {
  const Json object = derived(
      "[system]\ncoordinates = [\"r\", \"a\"]\nkinetic = \"r'^2 + (r*a')^2\"\npotential = \"3*r\"\n"
      "[system.constraints]\nfar = \"r <= 9\"\nnear = \"r >= 2\"\nray = \"a = t\"\n"
      "[state]\nposition = { r = 2, a = 0 }\nvelocity = { a = 1 }\n");
  CHECK(object.at("names") == Json{"r", "a"});
  CHECK(object.at("A") == Json::parse("[[2, 0], [0, 8]]"));
  CHECK(object.at("z") == Json::parse(R"({"r": 1, "a": 0})"));  // 2 r a'^2 - 3, and -4 r r' a'
  CHECK(object.at("U") == Json::parse(R"({"near": {"r": 1, "a": 0}, "ray": {"r": 0, "a": 1}})"));
  CHECK(object.at("s") == Json::parse(R"({"near": 0, "ray": 0})"));
  CHECK(object.at("two_sided") == Json{"ray"});
}

TEST_CASE("derive hands a projection through as it stands") {
  const Json object = derived(two_rows({{2, "A = [[2, 0.5], [0.5, 1]]"}, {6, "two_sided = [1]"}}));
  CHECK(object.at("names") == Json{"q[0]", "q[1]"});
  CHECK(object.at("A") == Json::parse("[[2, 0.5], [0.5, 1]]"));
  CHECK(object.at("z") == Json::parse(R"({"q[0]": 0, "q[1]": -9.81})"));
  CHECK(object.at("U").at("c[1]") == Json::parse(R"({"q[0]": 1, "q[1]": 1})"));
  CHECK(object.at("two_sided") == Json{"c[1]"});
}

TEST_CASE("what derive writes, as a projection, has the same solution") {
  const std::string text = point_on_floor({{9, "floor = \"y >= x^2/2\""}, {12, "velocity = { x = 3 }"}});
  const Json object = derived(text);
  const auto row = [](const Json& by_name) { return Json{by_name.at("x"), by_name.at("y")}.dump(); };
  const std::string projection =
      "[projection]\nA = " + object.at("A").dump() + "\nz = " + row(object.at("z")) + "\nU = [" +
      row(object.at("U").at("floor")) + "]\ns = [" + object.at("s").at("floor").dump() + "]\n";
  const Json whole = Json::parse(run_json_on("solve", text).out),
             numbers = Json::parse(run_json_on("solve", projection).out);
  CHECK(whole.at("acceleration").at("y") == 9);  // f'' = y'' - x'^2 = 0
  CHECK(numbers.at("acceleration").at("q[1]") == whole.at("acceleration").at("y"));
  CHECK(numbers.at("multipliers").at("c[0]") == whole.at("multipliers").at("floor"));
}

TEST_CASE("above two thousand coordinates A is written as triplets") {
  const auto family = [](const std::string& count) {
    return "[system]\ncoordinates = [\"x[1.." + count + "]\"]\nkinetic = \"sum(i in 1.." + count +
           ", i/2*x[i]'^2)\"\n[state]\nposition = { \"x[i]\" = 0 }\n";
  };
  CHECK(run_json_on("derive", family("2000")).out.find("\"A\":[[") != std::string::npos);
  const Json triplets = derived(family("2001")).at("A").at("triplets");
  REQUIRE(triplets.size() == 2001);
  CHECK(triplets.at(2000) == Json::parse("[2000, 2000, 2001]"));
}

TEST_CASE("derive says which equation U and s lack at a singular position, and writes it beside them") {
  const Outcome outcome = run_json_on("derive", pushing_at_dead_centre());
  CHECK(outcome.code == 0);
  CHECK(outcome.err.find("moreau: warning: ") == 0);
  CHECK(outcome.err.find("24 a'' and -24 b'' is 0") != std::string::npos);
  const Json object = Json::parse(outcome.out);
  CHECK(object.at("U").size() == 2);
  REQUIRE(object.at("added_rows").size() == 1);
  const Json& row = object.at("added_rows")[0];
  CHECK(row.at("weights") == Json{{"coupler", 1}});
  CHECK(row.at("row") == Json{{"a", 24}, {"b", -24}, {"c", 0}});
  CHECK(row.at("rhs") == 0);
  CHECK(run_on("derive", pushing_at_dead_centre()).out.find("Added row 1") != std::string::npos);
  const Outcome resting = run_json_on("derive", pushing_at_dead_centre({{12, "a = 0"}, {13, "b = 0"}}));
  CHECK(resting.code == 0);
  CHECK(resting.err.find("several branches") != std::string::npos);
  CHECK(run_json_on("derive", point_on_floor()).err.empty());
}
