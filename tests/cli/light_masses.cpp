#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.hpp"

/// Mechanisms whose A loses in rounding what decides their motion: two masses e, and one of 1 on x + a.
using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

std::string light_pair(const std::string& e, const std::string& constraints) {
  return "[system]\ncoordinates = [\"x\", \"y\", \"a\"]\nkinetic = \"" + e + "/2*x'^2 + 0.1/2*y'^2 + " + e +
         "/2*a'^2 + 1/2*(2*x' + 2*a')^2\"\npotential = \"a\"\n" + constraints +
         "[state]\nposition = { x = 0, y = 0, a = 0 }\n";
}

Json solved(const std::string& text) {
  const Folder folder;
  const Outcome outcome = run({"solve", "--json", folder.write("light.toml", text)});
  CHECK(outcome.code == 0);
  return Json::parse(outcome.out);
}

}  // namespace

TEST_CASE("where the rounding of A spoils an answer, the numbers of the text give it") {
  for (const char* e : {"1e-8", "1e-11", "1e-13"}) {
    CAPTURE(std::string(e));
    const Json found = solved(light_pair(e, ""));
    const double eps = std::stod(e), x = 4 / (eps * (8 + eps)), a = -(4 + eps) / (eps * (8 + eps));
    CHECK(found["status"] == "solved");
    CHECK(found["acceleration"]["x"].get<double>() == doctest::Approx(x).epsilon(1e-14));
    CHECK(found["acceleration"]["a"].get<double>() == doctest::Approx(a).epsilon(1e-14));
  }
}

TEST_CASE("a contact that A as rounded holds opens, and one that it opens presses, as the text says") {
  const auto with_stop = [](const char* e, const std::string& stop) {
    return solved(light_pair(e, "[system.constraints]\nstop = \"" + stop + "\"\n"));
  };
  // x'' = 5.0e12 of itself, and at most 5.01e12 is asked for.
  const Json opens = with_stop("1e-13", "x <= 2.505e12*t^2");
  CHECK(opens["constraints"]["stop"]["state"] == "opens");
  CHECK(opens["acceleration"]["x"].get<double>() == doctest::Approx(4 / (1e-13 * 8)).epsilon(1e-10));
  // x'' = 4.99999999e8 of itself, and 4.9999999e8 is allowed.
  const Json presses = with_stop("1e-9", "x <= 2.4999999e8*t^2");
  CHECK(presses["constraints"]["stop"]["state"] == "persists");
  CHECK(presses["multipliers"]["stop"].get<double>() > 0);
}
