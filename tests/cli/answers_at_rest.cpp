#include <doctest/doctest.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

TEST_CASE(
    "at rest two reactions within rounding do not differ, and a bound above the answer is told as it is") {
  // c0 and c1 are one plane, the second written as an exponential: its second rate is rounding.
  const std::string rest =
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"0.540973*x'^2/2 + 1.60129*y'^2/2\"\n"
      "[system.constraints]\nc0 = \"2.0*x + 0.3*y >= 2.53 + -1.61*t\"\n"
      "c1 = \"exp(-1.4*x + -0.21*y) = exp(-1.771 + 1.127*t)\"\nc2 = \"1.0*x + 1.0*y = 1.35 + -1.4*t\"\n"
      "[state]\nposition = { x = 1.25, y = 0.1 }\nvelocity = { x = -0.7, y = -0.7 }\n";
  const std::string told = run({"solve", "--verbose", "-"}, rest).out;
  CAPTURE(told);
  CHECK(told.find("DIFFERS") == std::string::npos);
  CHECK(told.find("from the dual alone (Moreau 1966, section 5) is as near as the error bound") !=
        std::string::npos);
  CHECK(told.find("in the kinetic norm (it may be 0)") != std::string::npos);
  CHECK(Json::parse(run_json_on("solve", rest).out).at("hypothesis").at("accepted") == true);
}

TEST_CASE("what is left of a contradiction below the rounding of its terms is told as it is, not as 0") {
  // The double 0.1 is 5.55e-18 above a tenth, and ten of it are to be at most 1.
  const std::string rows = "[projection]\nA = [[1]]\nz = [0]\nU = [[1], [-10]]\ns = [0.1, -1]\n";
  const Outcome outcome = run({"solve", "-"}, rows);
  CAPTURE(outcome.out);
  CHECK(outcome.code == 1);
  CHECK(outcome.out.find("what is left reads 0 >= 5.55112e-17 (Farkas)") != std::string::npos);
}

TEST_CASE("what is left of a contradiction of fractions is told by these, not by their doubles") {
  const std::string rows =
      "[projection]\nA = [[1]]\nz = [0]\nU = [[1], [-1]]\n"
      "s = [\"9007199254740993\", \"-9007199254740992\"]\n";
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"solve", "-"},
                                             {"solve", "--method", "exact", "-"},
                                             {"solve", "--certify", "-"},
                                             {"explain", "-"}}) {
    CAPTURE(command[1]);
    std::string told = run(command, rows).out;
    std::replace(told.begin(), told.end(), '\n', ' ');
    CAPTURE(told);
    CHECK(told.find("what is left reads 0 >= 1 (Farkas)") != std::string::npos);
  }
}
