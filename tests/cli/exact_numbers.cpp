#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// The double that a value of z is read as.
double read(const std::string& value) {
  const Outcome outcome = run_json_on("derive", two_rows({{3, "z = [" + value + ", 0]"}}));
  CAPTURE(value);
  REQUIRE(outcome.code == 0);
  return Json::parse(outcome.out).at("z").at("q[0]");
}

}  // namespace

TEST_CASE("an exact number in a string is read as the double nearest to it") {
  CHECK(read("\"1/3\"") == 1.0 / 3);
  CHECK(read("\"-1/3\"") == -1.0 / 3);
  CHECK(read("\"+2/6\"") == 1.0 / 3);
  CHECK(read("\"0.1\"") == 0.1);
  CHECK(read("\"-2\"") == -2);
  CHECK(read("\"1e-3\"") == 1e-3);
  CHECK(read("\"1.5e3/4\"") == 375);
  CHECK(read("\" 1 / 3 \"") == 1.0 / 3);
  CHECK(read("\"0\"") == 0);
  CHECK(read("\"1e-5000\"") == 0);
  CHECK(read("\"5e-324\"") == 5e-324);
  CHECK(read("\"1.7976931348623157e308\"") == 1.7976931348623157e308);
}

TEST_CASE("an exact number halfway between two doubles goes to the even one") {
  CHECK(read("\"9007199254740993\"") == 9007199254740992);
  CHECK(read("\"9007199254740995\"") == 9007199254740996);
  CHECK(read("\"-9007199254740993\"") == -9007199254740992);
}

TEST_CASE("integers, floats, underscores and other bases of TOML are numbers") {
  CHECK(read("1_000") == 1000);
  CHECK(read("0x10") == 16);
  CHECK(read("1_0.5e+1") == 105);
  CHECK(read("-0.0") == 0);
}

TEST_CASE("exact strings may stand in A, z, U and s") {
  const std::string text = two_rows({{2, R"(A = [["2/3", 0], [0, "1/3"]])"},
                                     {3, R"(z = ["1/3", "-0.1"])"},
                                     {4, R"(U = [[0, "1/7"], ["1/9", 0]])"},
                                     {5, R"(s = ["1/2", "-1/9"])"}});
  const Json object = Json::parse(run_json_on("solve", text).out);
  CHECK(object.at("status") == "solved");
  CHECK(object.at("acceleration").at("q[0]").get<double>() == doctest::Approx(0.5));
  CHECK(object.at("acceleration").at("q[1]").get<double>() == doctest::Approx(3.5));
}
