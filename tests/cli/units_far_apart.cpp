#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.hpp"

using Json = nlohmann::ordered_json;
using tests::Folder;
using tests::run;

namespace {

/// A mass matrix with sin(0.3) in it: no fractions are asked. All contacts are at f = 0, at rest.
Json solved(const char* kinetic, const char* potential, const char* constraints) {
  const Folder folder;
  const std::string file = folder.write(
      "units.toml", std::string("[system]\ncoordinates = [\"x0\", \"x1\", \"x2\", \"x3\"]\nkinetic = \"") +
                        kinetic + " + 1/2*(x0' + sin(al)*x1')^2\"\npotential = \"" + potential +
                        "\"\n[system.parameters]\ng = 9.81\nal = 0.3\n[system.constraints]\n" + constraints +
                        "[state]\nposition = { x0 = 0, x1 = 0, x2 = 0, x3 = 0 }\n");
  return Json::parse(run({"solve", "--json", file}).out);
}

}  // namespace

TEST_CASE(
    "ranges of multipliers of contacts told in units far apart have the ends that the forces give them") {
  // x1: 25.4 lambda5 - 0.001 lambda2 - lambda6 = 490.5.
  const Json gears = solved("0.1/2*x0'^2 + 10/2*x1'^2 + 1000/2*x2'^2 + x3'^2", "50*g*x0 + 50*g*x1 + g*x2",
                            "c0 = \"1e-3*x0 >= 0\"\nc1 = \"1000*(0.001*x2) <= 0\"\n"
                            "c2 = \"0.001*x1 + sin(al)*x0 <= 0\"\nc3 = \"x2 >= 0\"\n"
                            "c4 = \"1000*(0.001*x0) >= 0\"\nc5 = \"1e-3*x2 + 25.4*x1 + sin(al)*x0 >= 0\"\n"
                            "c6 = \"x1 + 100*x0 <= 0\"\n");
  CHECK(gears["multiplier_ranges"]["c5"][0].get<double>() == doctest::Approx(490.5 / 25.4).epsilon(1e-9));
  // x3: lambda1 + lambda4 = 98.1; x2: 25.4 lambda1 + 0.001 lambda5 = 9.81, and lambda5 >= 490.5.
  const Json lever =
      solved("0.1/2*x0'^2 + 1000/2*x1'^2 + 1/2*x2'^2 + x3'^2", "0.01*g*x0 + 50*g*x1 + g*x2 + 0.01*g*x3",
             "c0 = \"25.4*(1e-3*x1 + 100*x0) <= 0\"\nc1 = \"0.001*x3 + 25.4*x2 + sin(al)*x0 >= 0\"\n"
             "c2 = \"100*x0 + sin(al)*x0 <= 0\"\nc3 = \"1e-3*x0 >= 0\"\nc4 = \"1e-3*x3 >= 0\"\n"
             "c5 = \"x1 + 1e-3*x2 >= 0\"\n");
  const double most = (9.81 - 0.4905) / 25.4;
  CHECK(lever["multiplier_ranges"]["c1"][1].get<double>() == doctest::Approx(most).epsilon(1e-9));
  CHECK(lever["multiplier_ranges"]["c4"][0].get<double>() == doctest::Approx(98.1 - most).epsilon(1e-9));
  CHECK(lever["multiplier_ranges"]["c4"][1].get<double>() == doctest::Approx(98.1).epsilon(1e-9));
}

TEST_CASE("two-sided multipliers of contacts told in units far apart are those of least norm") {
  // From the normal equations in 60 digits. A vertex of them has 5e13 on the first.
  const Json press = solved("x0'^2/2 + x1'^2/2 + x2'^2/2 + x3'^2", "490.5*x1 + 9.81*x2",
                            "c0 = \"1e-3*x2 <= 0\"\nc1 = \"1000*(100*x2) + 0.5*x0 >= 0\"\n"
                            "c2 = \"1e-3*x2 + 0.5*x0 >= 0\"\nc3 = \"x2 + 1e-3*x1 + 0.5*x0 <= 0\"\n"
                            "c4 = \"0.001*x2 + 1000*x0 >= 0\"\n");
  const std::pair<const char*, double> least[] = {{"c0", 4.78227570320362e-08},
                                                  {"c1", -4.90489944629889928},
                                                  {"c2", -0.122623790918036349},
                                                  {"c3", -490500},
                                                  {"c4", -245.247486238381391}};
  for (const auto& [name, lambda] : least) {
    CAPTURE(name);
    CHECK(press["two_sided"]["multipliers"][name].get<double>() == doctest::Approx(lambda).epsilon(1e-8));
  }
}

TEST_CASE("what a plain answer solves of numbers whose ratios leave the range of doubles is certified too") {
  const Folder folder;
  struct Case {
    const char* text;
    std::vector<double> q;
  };
  const Case cases[] = {
      {"[projection]\nA = [[1.0]]\nz = [0.0]\nU = [[1.0], [1e254]]\ns = [0.25, -1e254]\n", {0.25}},
      {"[projection]\nA = [[1e300, 0.0], [0.0, 1e-94]]\nz = [0.0, 0.0]\nU = [[0.0, 2e-59]]\ns = [1.0]\n",
       {0, 5e58}}};
  for (const Case& one : cases) {
    CAPTURE(one.text);
    const std::string file = folder.write("far.toml", one.text);
    for (const bool certify : {false, true}) {
      const auto outcome =
          certify ? run({"solve", "--certify", "--json", file}) : run({"solve", "--json", file});
      REQUIRE(outcome.code == 0);
      const Json found = Json::parse(outcome.out);
      CHECK(found["status"] == "solved");
      for (std::size_t i = 0; i < one.q.size(); ++i)
        CHECK(found["acceleration"]["q[" + std::to_string(i) + "]"].get<double>() ==
              doctest::Approx(one.q[i]).epsilon(1e-15));
      if (certify) CHECK(found["certificate"]["level"] == "exact");
    }
  }
}

TEST_CASE("a constraint of 1e200 that just holds is no wrong input") {
  const Folder folder;
  const std::string file =
      folder.write("far.toml",
                   "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"1/2*(x'^2 + y'^2)\"\n"
                   "potential = \"9.81*y\"\n[system.constraints]\nfloor = \"y >= 0\"\n"
                   "far = \"1e200*x >= -1e200\"\n[state]\nposition = { x = -1, y = 0 }\n");
  const auto outcome = run({"solve", "--json", file});
  REQUIRE(outcome.code == 0);
  const Json found = Json::parse(outcome.out);
  CHECK(found["acceleration"]["x"] == 0);
  CHECK(found["acceleration"]["y"] == 0);
  CHECK(found["multipliers"]["floor"].get<double>() == doctest::Approx(9.81).epsilon(1e-15));
}
