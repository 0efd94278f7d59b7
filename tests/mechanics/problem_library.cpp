#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/report/solve_report.hpp"
#include "cli/resolved_scene.hpp"
#include "tests/this_build.hpp"

using nlohmann::json;

namespace {

constexpr double tolerance = 1e-11;  // relative to the largest entry of the same kind

double number(const json& text) {
  const std::string digits = text.get<std::string>();
  if (digits == "inf") return INFINITY;
  if (digits == "-inf") return -INFINITY;
  const std::size_t slash = digits.find('/');
  if (slash == std::string::npos) return std::stod(digits);
  return std::stod(digits.substr(0, slash)) / std::stod(digits.substr(slash + 1));
}

double largest(const json& expected) {
  double scale = 1;
  for (const auto& [name, value] : expected.items()) scale = std::max(scale, std::abs(number(value)));
  return scale;
}

void compare(const std::string& what, const json& found, const json& expected) {
  CAPTURE(what);
  const double scale = largest(expected);
  REQUIRE(found.size() >= expected.size());
  for (const auto& [name, value] : expected.items()) {
    CAPTURE(name);
    REQUIRE(found.contains(name));
    CHECK(std::abs(found[name].get<double>() - number(value)) <= tolerance * scale);
  }
}

void compare_ranges(const json& found, const json& expected) {
  for (const auto& [name, range] : expected.items()) {
    CAPTURE(name);
    for (std::size_t end : {0U, 1U}) {
      const double wanted = number(range[end]);
      if (std::isinf(wanted))
        CHECK(found[name][end] == (wanted > 0 ? "inf" : "-inf"));
      else
        CHECK(std::abs(found[name][end].get<double>() - wanted) <= 1e-9 * std::max(1.0, std::abs(wanted)));
    }
  }
}

/// Numbers where some are given, null where none are.
void compare_some(const std::string& what, const json& found, const json& expected) {
  json numbers = json::object();
  for (const auto& [name, value] : expected.items()) {
    CHECK(found.at(name).is_null() == value.is_null());
    if (!value.is_null()) numbers[name] = value;
  }
  compare(what, found, numbers);
}

/// Equations of third derivatives.
void compare_added(const json& found, const json& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    compare("weights", found[k]["weights"], expected[k]["weights"]);
    compare("row", found[k]["row"], expected[k]["row"]);
    compare("right side", {{"rhs", found[k]["rhs"]}}, {{"rhs", expected[k]["rhs"]}});
    compare("multiplier", {{"multiplier", found[k]["multiplier"]}},
            {{"multiplier", expected[k]["multiplier"]}});
  }
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(tests::source_folder() + "docs/problems"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE("every problem of the library has the answer of an independent derivation") {
  const std::vector<std::string> names = cases();
  REQUIRE(names.size() >= 14);
  for (const std::string& name : names) {
    CAPTURE(name);
    std::ifstream file(tests::source_folder() + "tests/cases/" + name + ".expected.json");
    REQUIRE(file.good());
    const json expected = json::parse(file);
    if (expected.contains("kind")) continue;  // no mechanics: tests/cli
    cli::Scene scene = cli::read_scene(tests::source_folder() + "docs/problems/" + name + ".toml", {});
    mechanics::GaussSolution solution;
    const auto warnings =
        cli::resolve_scene(scene, [&](const cli::Scene& attempt) -> const mechanics::GaussSolution& {
          return solution = mechanics::solve(attempt.problem, attempt.solve);
        });
    const cli::SolvedScene solved = cli::solved_scene(scene, solution, 0);
    const json found = json::parse(cli::solve_json(solved));
    CHECK(json(scene.contact_names()) == expected["contacts"]);
    REQUIRE(found["status"] == expected["status"]);
    if (expected["status"] == "infeasible") {
      // Weights are compared up to scale: these scenes have one combination only.
      const json& weights = expected["farkas"];
      const std::string first = weights.items().begin().key();
      for (const auto& [constraint, weight] : weights.items())
        CHECK(found["farkas"][constraint].get<double>() * number(weights[first]) ==
              doctest::Approx(found["farkas"][first].get<double>() * number(weight)));
      continue;
    }
    compare("acceleration", found["acceleration"], expected["acceleration"]);
    compare_some("multipliers", found["multipliers"], expected["multipliers"]);
    compare("reaction", found["reaction"], expected["reaction"]);
    CHECK(std::abs(found["gauss"].get<double>() - number(expected["gauss"])) <=
          tolerance * std::max(1.0, std::abs(number(expected["gauss"]))));
    CHECK(found["active"] == expected["active"]);
    CHECK(warnings.size() == (expected.contains("added_rows") ? expected["added_rows"].size() : 0));
    CHECK(found.contains("added_rows") == expected.contains("added_rows"));
    if (expected.contains("added_rows")) {
      compare_added(found["added_rows"], expected["added_rows"]);
      continue;
    }
    compare("two-sided acceleration", found["two_sided"]["acceleration"],
            expected["two_sided"]["acceleration"]);
    compare("two-sided multipliers", found["two_sided"]["multipliers"], expected["two_sided"]["multipliers"]);
    compare_ranges(found["multiplier_ranges"], expected["multiplier_ranges"]);
    CHECK(found["multipliers_unique"] == expected["multipliers_unique"]);
    CHECK(found["two_sided"]["consistent"] == expected["two_sided"]["consistent"]);
    CHECK(found["hypothesis"] == expected["hypothesis"]);
    if (solution.from_dual) CHECK(solution.from_dual->difference <= tolerance);
    CHECK((solution.from_dual.has_value() == solution.hypothesis.two_sided.consistent));
  }
}
