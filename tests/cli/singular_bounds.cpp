#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

std::string singular(const std::string& f, const std::string& state) {
  return "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
         "forces = { y = \"(1e8 + 0.1) - 1e8\" }\n[system.constraints]\nf = \"" +
         f + "\"\n[state]\n" + state;
}

}  // namespace

TEST_CASE("the bound at a singular state counts what the text's rounding makes of the equations") {
  struct Case {
    std::string text;
    double x, y;
  };
  // On the branch y = 2x + x²: x'' (1 + 4) = 2 (F - 2), y'' = 2x'' + 2; on y = x each has half of the force.
  for (const auto& [text, x, y] :
       {Case{singular("y*(y - 2*x - x^2) = 0", "position = { x = 0, y = 0 }\nvelocity = { x = 1, y = 2 }\n"),
             -0.76, 0.48},
        Case{singular("exp((x - y)^2) = 1", "position = { x = 1, y = 1 }\nvelocity = { x = 0, y = 0 }\n"),
             0.05, 0.05}}) {
    CAPTURE(text);
    const Json object = Json::parse(run_json_on("solve", text).out);
    REQUIRE(object.at("added_rows").size() == 1);
    const double off = std::hypot(object.at("acceleration").at("x").get<double>() - x,
                                  object.at("acceleration").at("y").get<double>() - y);
    CHECK(off > 1e-9);  // 1e8 + 0.1 has no more digits
    CHECK(off <= object.at("certificate").at("error_bound").get<double>());
  }
}
