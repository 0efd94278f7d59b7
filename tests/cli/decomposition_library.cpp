#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using nlohmann::json;

namespace {

constexpr double tolerance = 1e-12;  // relative to the largest entry of x and y, at least 1

double number(const json& text) {
  const std::string digits = text.get<std::string>();
  const std::size_t slash = digits.find('/');
  if (slash == std::string::npos) return std::stod(digits);
  return std::stod(digits.substr(0, slash)) / std::stod(digits.substr(slash + 1));
}

void compare(const json& found, const json& expected, double scale) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(std::abs(found[i].get<double>() - number(expected[i])) <= tolerance * scale);
}

}  // namespace

TEST_CASE("every decomposition of the library is split as in exact fractions or 60 digits") {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(tests::source_folder() + "docs/problems")) {
    if (!entry.path().stem().string().starts_with("decomposition_")) continue;
    ++count;
    CAPTURE(entry.path().string());
    std::ifstream file(tests::source_folder() + "tests/cases/" + entry.path().stem().string() +
                       ".expected.json");
    REQUIRE(file.good());
    const json expected = json::parse(file);
    const Outcome outcome = run({"solve", "--json", entry.path().string()});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    const json found = json::parse(outcome.out);
    CHECK(found["status"] == expected["status"]);
    double scale = 1;
    for (const char* point : {"x", "y"})
      for (const json& value : expected[point]) scale = std::max(scale, std::abs(number(value)));
    compare(found["x"], expected["x"], scale);
    compare(found["y"], expected["y"], scale);
    for (const char* key : {"f_x", "g_y", "inner"}) {
      CAPTURE(key);
      CHECK(std::abs(found[key].get<double>() - number(expected[key])) <= 10 * tolerance * scale * scale);
    }
    CHECK(std::abs(found["fenchel_gap"].get<double>()) <= 10 * tolerance * scale * scale);
    CHECK(found["residual"].get<double>() <= tolerance * scale);
    CHECK(found["certificate"]["error_bound"].get<double>() <= 1e-10 * scale);
  }
  CHECK(count >= 7);
}
