#include "mechanics/expression/exclusion.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "mechanics/assembly.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "tests/mechanics/system_text.hpp"

using namespace tests;

/// What is said to be impossible is impossible, and what is impossible in one of these ways is seen to be.
namespace {

/// Is it proved that these constraints on x, y, z exclude each other?
bool proved(const std::vector<std::string>& relations, const std::vector<std::optional<double>>& held = {}) {
  SystemText text{{"x", "y", "z"}, "(x'^2 + y'^2 + z'^2)/2", "", {{"L", "2.5"}}, {}, {}, {}};
  for (std::size_t k = 0; k < relations.size(); ++k)
    text.constraints.emplace_back("c" + std::to_string(k), relations[k]);
  const auto s = system(text);
  std::vector<mechanics::expression::Demand> demands;
  for (std::size_t k = 0; k < relations.size(); ++k)
    demands.push_back({s->model().f[k], s->model().constraints[k].two_sided});
  return mechanics::expression::excludes(s->model().tape, demands,
                                         held.empty() ? std::vector<std::optional<double>>(3) : held, 0.0);
}

}  // namespace

TEST_CASE("what no position meets is proved: by weights, by ranges, by cutting boxes") {
  const std::vector<std::vector<std::string>> impossible{
      {"x >= y + 1", "y >= x"},                            // weights 1 and 1
      {"x + 2*y >= 1", "z - y >= 1", "x + 2*z <= 2.9"},    // 1, 2, 1
      {"0.1*x + 0.2*x = 0.3", "x >= 1.0000000000000002"},  // decimals as written
      {"y - L*sin(x) >= 1", "y - L*sin(x) <= 0.5"},        // a sine as an unknown
      {"x^2 + y^2 = 1", "x >= 1.001"},
      {"x^2 + y^2 = 1", "x + y >= 1.4143"},                     // the root of 2 is 1.41421
      {"cos(x) + 2*cos(y) = 0.99", "sin(x) + 2*sin(y) = 0.1"},  // links of 1 and 2 reach 1, not 0.995
      {"cos(x) + L*cos(2*y) >= 3.6"},
      {"sqrt(x) + y = 0", "y >= 1e-6"},
      {"log(x) >= 0", "x <= 0.999"},
      {"if(x >= 0, x, -x) <= -1e-3"},
      {"abs(x) + max(y, -y) <= -1"},
      {"exp(x) <= 0", "x >= -5"},
      {"x^2 + y^2 + z^2 <= 1", "x + y + z >= 1.7321"},  // the root of 3
  };
  for (const auto& relations : impossible) {
    CAPTURE(relations.front());
    CHECK(proved(relations));
  }
  CHECK(proved({"x + y = 3", "y = 1"}, {{2.5, std::nullopt, std::nullopt}}));
}

TEST_CASE("what is just possible is never said to be impossible") {
  const std::vector<std::vector<std::string>> possible{
      {"x >= y", "y >= x"},
      {"0.1*x + 0.2*x = 0.3", "x >= 1"},
      {"x^2 + y^2 = 1", "x >= 1"},
      {"cos(x) + 2*cos(y) = 3", "sin(x) = 0"},
      {"cos(x) = -1"},
      {"sin(3*x) = 1", "cos(y) + sin(z) >= 2"},
      {"sqrt(x) <= 0"},
      {"if(x >= 0, x, sqrt(x)) <= 0"},  // the branch that is not taken has no value
      {"abs(x) <= 0"},
      {"x^2 + y^2 + z^2 <= 3", "x + y + z >= 3"},
      {"x*y >= 1", "x^2 + y^2 <= 2"},
      {"exp(x) <= 1e-300"},
      {"x^3 = -8"},
      {"atan2(y, x) >= 3.14"},
  };
  for (const auto& relations : possible) {
    CAPTURE(relations.front());
    CHECK_FALSE(proved(relations));
  }
}

TEST_CASE("constraints drawn through a point do not exclude each other") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> even(-2, 2);
  const auto number = [](double x) { return "(" + std::to_string(x) + ")"; };
  const std::vector<std::string> terms{"x*y",   "sin(x + y)", "z^2",        "cos(z)*x",       "exp(y/2)",
                                       "x",     "y*z",        "abs(x - z)", "sqrt(4 + x*y)",  "atan(z)",
                                       "z^3/4", "max(x, y)",  "y",          "hypot(x, y, 1)", "1/(5 + z)"};
  for (int draw = 0; draw < 60; ++draw) {
    // Rounded to the digits that are written, so that the point is the one meant.
    const double x = std::round(1e6 * even(random)) / 1e6, y = std::round(1e6 * even(random)) / 1e6,
                 z = std::round(1e6 * even(random)) / 1e6;
    std::vector<std::string> relations;
    for (int k = 0; k < 3; ++k) {
      std::string sum;
      for (int j = 0; j < 3; ++j)
        sum += (j > 0 ? " + " : "") + number(even(random)) + "*(" + terms[random() % terms.size()] + ")";
      SystemText text{{"x", "y", "z"}, "(x'^2 + y'^2 + z'^2)/2", "", {}, {}, {}, {{"c", sum + " >= 0"}}};
      const double f = system(text)->constraint_rates(state({x, y, z}, {0, 0, 0})).f[0];
      relations.push_back(sum + (k == 0 ? " >= " : " <= ") + number(f) + (k == 0 ? " - 1e-5" : " + 1e-5"));
    }
    CAPTURE(relations[0]);
    CAPTURE(relations[1]);
    CAPTURE(relations[2]);
    CHECK_FALSE(proved(relations));
  }
}

TEST_CASE("an assembly that is impossible says so, proved, and one that was not found is not said to be") {
  using mechanics::AssemblyStatus;
  const SystemText links{
      {"a", "b"},
      "(a'^2 + b'^2)/2",
      "",
      {},
      {},
      {},
      {{"along", "cos(a) + 2*cos(b) = 0.99"}, {"across", "sin(a) + 2*sin(b) = 0.1"}, {"stop", "a <= 3"}}};
  const auto found = mechanics::assemble(*system(links), state({0.2, 0.3}, {0, 0}), {});
  CHECK(found.status == AssemblyStatus::infeasible);
  CHECK(found.proved);
  CHECK(found.fighting == std::vector<mechanics::Index>{0, 1});
  const SystemText open{
      {"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"bowl", "y >= x^2"}, {"ramp", "y <= 2*x - 1.0001"}}};
  const auto doubt = mechanics::assemble(*system(open), state({0, 0.3}, {0, 0}), {});
  CHECK(doubt.status == AssemblyStatus::infeasible);
  CHECK_FALSE(doubt.proved);  // x has no bound, so that boxes do not tell; nothing is claimed
}
