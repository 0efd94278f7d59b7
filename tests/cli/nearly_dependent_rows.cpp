#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

/// Rows through one point that depend on each other but for 2^-39 to 2^-43. What is claimed was found in
/// fractions.
using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

Outcome run_on(const char* command, const std::vector<std::string>& options, const std::string& problem) {
  const Folder folder;
  std::vector<std::string> arguments{command, folder.write("problem.toml", problem)};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return run(arguments);
}

/// c[6] is c[2] but for 2^-39.
const std::string thin =
    "[projection]\nA = [[3, 0], [0, 2]]\nz = [-10, 0]\n"
    "U = [[1, 1], [1, 1], [-1, 2], [1, -2], [0, 2], [2, 0], [-1, \"1099511627775/549755813888\"]]\n"
    "s = [-1, -3, 2, -4, 2, -4, \"2199023255551/549755813888\"]\ntwo_sided = [4]\n";

/// c[5] is c[1] but for 2^-43, both two-sided.
const std::string twice =
    "[projection]\nA = [[11, -1, 2, -8], [-1, 8, -1, -3], [2, -1, 7, -2], [-8, -3, -2, 14]]\nz = [-5, 2, 1, "
    "-4]\n"
    "U = [[0, 0, -2, 2], [-1, -1, -1, 2], [2, -1, 2, 0], [-1, 0, 2, 0], [-1, 1, 1, -1],\n"
    "  [\"-8796093022209/8796093022208\", -1, -1, 2]]\ns = [0, -1, -1, 0, 1, -1]\ntwo_sided = [1, 5]\n";

/// The second row is 2^-45 off the first.
const std::string wedge =
    "[projection]\nA = [[1, 0], [0, 1]]\nz = [-1, 0]\nU = [[1, 0], [1, \"1/35184372088832\"]]\ns = [1, 1]\n";

}  // namespace

TEST_CASE(
    "the range of a multiplier is infinite where rows are independent by a few roundings, whatever solves") {
  // With weights 2^40 on c[6] and c[3] their sum pulls against c[4] alone.
  const std::vector<std::vector<std::string>> ways{
      {}, {"--certify"}, {"--method", "exact"}, {"--method", "lemke"}, {"--method", "admm"}};
  for (std::vector<std::string> way : ways) {
    CAPTURE(way.size());
    way.push_back("--json");
    const Json answer = Json::parse(run_on("solve", way, thin).out);
    CHECK(answer.at("status") == "solved");
    CHECK(answer.at("multiplier_ranges").at("c[4]") == Json::array({"-inf", "inf"}));
  }
}

TEST_CASE("no law fails on a right answer where the contacts' cone is thin") {
  for (const std::string& problem : {thin, twice}) {
    const Outcome outcome = run_on("check", {}, problem);
    CAPTURE(outcome.out);
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find("FAILED") == std::string::npos);
    CHECK(outcome.out.find("DIFFERS") == std::string::npos);
  }
}

TEST_CASE(
    "where the contacts' cone is so thin that rounding leaves the dual's reaction open, its law says so") {
  CHECK(run_on("check", {}, wedge).out.find("no evidence  z = x + y: the cone") != std::string::npos);
}

TEST_CASE("where nothing may decide whether rows depend on each other, no error is claimed") {
  const Outcome outcome = run_on("solve", {"--limit", "0", "--json"}, twice);
  const Json answer = Json::parse(outcome.out);
  CHECK(outcome.code == 3);
  CHECK(answer.at("status") == "inaccurate");
  CHECK(answer.at("model").at("undecided") == "whether rows depend on each other");
  CHECK(answer.at("certificate").at("error_bound") == "inf");
}

TEST_CASE("rows that are written as doubles keep their angle of 2^-49 beside a z that is rounded") {
  const Json answer = Json::parse(
      run_on(
          "solve", {"--method", "lemke", "--json"},
          "[projection]\nA = [[14, -4, 10, -4], [-4, 17, -4, 8], [10, -4, 12, -6], [-4, 8, -6, 9]]\n"
          "z = [\"-15762598695796737/1125899906842624\", \"-36028797018963967/1125899906842624\", -4, -16]\n"
          "U = [[2, 1, 2, 1], [\"2251799813685249/1125899906842624\", \"1125899906842623/1125899906842624\", "
          "2, 1],\n"
          "  [2, 1, 2, 1]]\ns = [-4, -4, -5]\n")
          .out);
  CHECK(answer.at("multipliers").at("c[0]") == 1);
  CHECK(answer.at("multipliers").at("c[1]") == 1);
}

TEST_CASE("a method that was named does not solve rows that fractions find to contradict each other") {
  // Along the rows q1 >= q0, q2 >= q1, q3 >= q2 + 1e-27 and q0 >= q3.
  const char* const ring =
      "[projection]\nA = { diagonal = [1.0, 3.0, 1e-08, 0.1] }\nz = [-1.0, 1e-17, 0.1, -1.0]\n"
      "U = [[-1e10, 1e10, 0, 0], [0, -0.1, 0.1, 0], [0, 0, -1e10, 1e10], [1, 0, 0, -1]]\n"
      "s = [0, 0, 1e-17, 0]\n";
  CHECK(run_on("solve", {"--json"}, ring).code == 1);
  for (const char* method : {"active-set", "nnls", "lemke", "block-pivoting", "enumerate", "proximal-point",
                             "interior-point", "admm"}) {
    CAPTURE(method);
    CHECK(run_on("solve", {"--json", "--method", method}, ring).code != 0);
    CHECK(run_on("solve", {"--json", "--limit", "0", "--method", method}, ring).code != 0);
  }
}
