#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// The split of a point by f, a line of the metric put below.
std::string split(const std::string& z, const std::string& metric) {
  return "[decomposition]\nz = " + z + "\nf = \"quadratic([[1, 0], [0, 1]])\"\nmetric = " + metric + "\n";
}

void check_near(const Json& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(found[i].get<double>() == doctest::Approx(expected[i]).epsilon(1e-14));
}

}  // namespace

TEST_CASE("numbers of z and of the metric may be exact, and the metric is rows, a diagonal or a file") {
  const std::vector<double> x{2.0 / 9, -8.0 / 3};  // (W + I)⁻¹ W z, by hand
  const std::string z = "[\"1/3\", -4]";
  for (const std::string metric : {"[[2, 0], [0, \"2\"]]", "{ diagonal = [2, 2] }"})
    check_near(Json::parse(run_json_on("solve", split(z, metric)).out)["x"], x);
  const Folder folder;
  folder.write("W.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2\n2 2 2\n");
  const std::string file = folder.write("problem.toml", split(z, "{ matrix_market = \"W.mtx\" }"));
  check_near(Json::parse(run({"solve", "--json", file}).out)["x"], x);
}

TEST_CASE("prox on the command line is the same split as from a file") {
  const std::string call = "quadratic([[2, 1], [1, 2]], c=[1, -1])";
  const Outcome outcome = run({"prox", call, "--at", "[3, -1/3]", "--metric", "[[3, 1], [1, 2]]", "--json"});
  CHECK(outcome.code == 0);
  Json typed = Json::parse(outcome.out);
  Json read = Json::parse(run_json_on("solve", "[decomposition]\nz = [3, \"-1/3\"]\nf = \"" + call +
                                                   "\"\nmetric = [[3, 1], [1, 2]]\n")
                              .out);
  read.erase("file");
  read.erase("seconds");
  typed.erase("seconds");
  CHECK(typed == read);
}

TEST_CASE("a diagonal metric is written in words") {
  const auto x = [](const std::string& metric) {
    return Json::parse(
               run({"prox", "quadratic([[1, 1], [1, 3]])", "--at", "[1, 2]", "--metric", metric, "--json"})
                   .out)
        .at("x");
  };
  for (std::size_t i : {0U, 1U})
    CHECK(x("diagonal [1, 4]")[i].get<double>() ==
          doctest::Approx(x("[[1, 0], [0, 4]]")[i].get<double>()).epsilon(1e-14));
}
