#include <doctest/doctest.h>

#include <functional>
#include <limits>

#include "tests/mechanics/system_text.hpp"

using namespace tests;

namespace {

struct Wrong {
  std::function<void(SystemText&)> change;
  std::string where;
  std::vector<std::string> named;
};

void expect(const std::string& error, const std::string& where, const std::vector<std::string>& named) {
  CAPTURE(error);
  CHECK(error.starts_with(where + " "));
  for (const auto& name : named) {
    CAPTURE(name);
    CHECK(error.find(name) != std::string::npos);
  }
}

SystemText good() {
  return {{"x", "y", "z[1..N]"},
          "m/2*(x'^2 + y'^2) + sum(i in 1..N, z[i]'^2)",
          "m*g*y",
          {{"m", "2"}, {"g", "9.81"}, {"N", "3"}},
          {{"h", "0.1*sin(t)"}, {"d[i in 1..N]", "z[i]^2"}},
          {{"x", "-3*x'"}},
          {{"floor", "y >= h"}}};
}

}  // namespace

TEST_CASE("what is wrong in a system is named, with its place") {
  const std::vector<Wrong> table{
      {[](auto& s) { s.kinetic = "m/2*vx^2"; }, "2:105", {"kinetic", "\"vx\" is unknown"}},
      {[](auto& s) { s.kinetic = "mm*x'^2"; }, "2:101", {"did you mean \"m\""}},
      {[](auto& s) { s.kinetic = "x'^2 + sine(x)"; }, "2:108", {"\"sine\" is no function", "sin"}},
      {[](auto& s) { s.kinetic = "x'^2 +"; }, "2:107", {"the end", "expected"}},
      {[](auto& s) { s.kinetic = "(x'^2"; }, "2:106", {"expected", "\")\""}},
      {[](auto& s) { s.kinetic = "2x'^2"; }, "2:102", {"\"x\"", "operator"}},
      {[](auto& s) { s.kinetic = "x'**2"; }, "2:103", {"\"**\"", "^"}},
      {[](auto& s) { s.kinetic = "é"; }, "2:101", {"\"é\""}},
      {[](auto& s) { s.kinetic = "x'^2\n + é + q"; }, "3:4", {"\"é\""}},
      {[](auto& s) { s.kinetic = "1e999"; }, "2:101", {"too large"}},
      {[](auto& s) { s.kinetic = ""; }, "2:101", {"the end"}},
      {[](auto& s) { s.kinetic = "x'^2 >= 0"; }, "2:106", {"only a constraint"}},
      {[](auto& s) { s.kinetic = "x''^2"; }, "2:103", {"second derivatives are not allowed"}},
      {[](auto& s) { s.kinetic = "(x*x')'"; }, "2:107", {"second derivatives are not allowed"}},
      {[](auto& s) { s.kinetic = "x'^3"; }, "2:103", {"not quadratic", "x'^3"}},
      {[](auto& s) { s.kinetic = "x'^2 + cos(y')"; }, "2:108", {"not quadratic", "cos(y')"}},
      {[](auto& s) { s.kinetic = "x/y'"; }, "2:102", {"not quadratic"}},
      {[](auto& s) { s.kinetic = "x'^2*y'"; }, "2:105", {"not quadratic"}},
      {[](auto& s) { s.kinetic = "x'^0.5"; }, "2:103", {"not quadratic"}},
      {[](auto& s) { s.kinetic = "x'^m*x'"; }, "2:105", {"not quadratic"}},
      {[](auto& s) { s.kinetic = "abs(x')*x'"; }, "2:101", {"not quadratic", "abs(x')"}},
      {[](auto& s) { s.kinetic = "floor"; }, "2:101", {"\"floor\" is a constraint"}},
      {[](auto& s) { s.kinetic = "z'^2"; }, "2:101", {"\"z\" is a family", "z[i]"}},
      {[](auto& s) { s.kinetic = "x[1]'^2"; }, "2:101", {"\"x\" has no index"}},
      {[](auto& s) { s.kinetic = "z[1,2]'^2"; }, "2:101", {"\"z\" is a family"}},
      {[](auto& s) { s.kinetic = "z[4]'^2"; }, "2:101", {"z[4] does not exist", "z[1..3]"}},
      {[](auto& s) { s.kinetic = "z[m/4]'^2"; }, "2:101", {"0.5 is not an integer"}},
      {[](auto& s) { s.kinetic = "z[x]'^2"; }, "2:103", {"\"x\" is a coordinate", "index"}},
      {[](auto& s) { s.kinetic = "z[t]'^2"; }, "2:103", {"\"t\""}},
      {[](auto& s) { s.kinetic = "sum(i in 1..N+1, z[i]'^2)"; }, "2:118", {"z[4] does not exist"}},
      {[](auto& s) { s.kinetic = "sum(m in 1..N, m)"; }, "2:105", {"\"m\" is taken", "parameter"}},
      {[](auto& s) { s.kinetic = "sum(i in 1..N, sum(i in 1..2, i))"; },
       "2:120",
       {"\"i\" is already in use"}},
      {[](auto& s) { s.kinetic = "sum(1, 2)"; }, "2:101", {"no index"}},
      {[](auto& s) { s.kinetic = "sum(i in 1..2.5, 1)"; }, "2:101", {"2.5 is not an integer"}},
      {[](auto& s) { s.kinetic = "sin x"; }, "2:101", {"\"sin\" is a function"}},
      {[](auto& s) { s.kinetic = "sin(x, y)"; }, "2:108", {"too many"}},
      {[](auto& s) { s.kinetic = "atan2(x)"; }, "2:108", {"too few"}},
      {[](auto& s) { s.potential = "m*g*y'"; }, "3:106", {"potential", "velocity \"y'\""}},
      {[](auto& s) {
         s.parameters.push_back({"w", "x + 1"});
       },
       "13:101",
       {"parameter w", "\"x\" is a coordinate"}},
      {[](auto& s) {
         s.parameters.push_back({"w", "t"});
       },
       "13:101",
       {"parameter w", "\"t\""}},
      {[](auto& s) {
         s.parameters.push_back({"w", "m'"});
       },
       "13:102",
       {"parameter w", "derivative"}},
      {[](auto& s) {
         s.parameters.push_back({"w", "1/(m - 2)"});
       },
       "13:101",
       {"\"w\" is not a finite number"}},
      {[](auto& s) {
         s.parameters.push_back({"w", "u"}), s.parameters.push_back({"u", "2*w"});
       },
       "14:103",
       {"w -> u -> w"}},
      {[](auto& s) {
         s.parameters.push_back({"w[i in 1..2]", "1"});
       },
       "13:1",
       {"a parameter has no index"}},
      {[](auto& s) {
         s.parameters.push_back({"m", "1"});
       },
       "13:1",
       {"\"m\" is taken", "a parameter"}},
      {[](auto& s) {
         s.parameters.push_back({"pi", "3"});
       },
       "13:1",
       {"\"pi\" belongs to the language"}},
      {[](auto& s) {
         s.parameters.push_back({"2w", "3"});
       },
       "13:1",
       {"name"}},
      {[](auto& s) { s.coordinates.push_back("sum"); }, "1:4", {"\"sum\""}},
      {[](auto& s) { s.coordinates.push_back("x"); }, "1:4", {"\"x\" is taken"}},
      {[](auto& s) { s.coordinates.push_back("m"); }, "1:4", {"\"m\" is taken", "a parameter"}},
      {[](auto& s) { s.coordinates.push_back("w[1]"); }, "1:7", {"expected", ".."}},
      {[](auto& s) { s.coordinates.push_back("w[1..K]"); }, "1:9", {"\"K\" is unknown"}},
      {[](auto& s) { s.coordinates.push_back("w[1..y]"); }, "1:9", {"\"y\" is a coordinate"}},
      {[](auto& s) {
         s.definitions.push_back({"x", "1"});
       },
       "22:1",
       {"\"x\" is taken"}},
      {[](auto& s) {
         s.definitions.push_back({"d", "1"});
       },
       "22:1",
       {"\"d\" is taken"}},
      {[](auto& s) {
         s.definitions.push_back({"d[2..3]", "1"});
       },
       "22:3",
       {"i in a..b"}},
      {[](auto& s) {
         s.definitions.push_back({"e[i]", "1"});
       },
       "22:1",
       {"write e[i in 1..N]"}},
      {[](auto& s) {
         s.definitions.push_back({"d[i in 3..4]", "1"});
       },
       "22:1",
       {"d[3] is given twice"}},
      {[](auto& s) {
         s.definitions.push_back({"e[m in 1..2]", "1"});
       },
       "22:3",
       {"\"m\" is taken"}},
      {[](auto& s) {
         s.definitions.push_back({"a", "b"}), s.definitions.push_back({"b", "c + a"}),
             s.definitions.push_back({"c", "b"});
       },
       "24:101",
       {"b -> c -> b"}},
      {[](auto& s) {
         s.definitions.push_back({"e[i in 1..2]", "e[3-i]"});
       },
       "22:101",
       {"e[1] -> e[2] -> e[1]"}},
      {[](auto& s) {
         s.definitions.push_back({"e[i in 1..4]", "z[i]"});
       },
       "22:101",
       {"e[4]", "z[4] does not exist"}},
      {[](auto& s) {
         s.forces.push_back({"xx", "1"});
       },
       "31:1",
       {"forces", "\"xx\" is no coordinate", "did you mean \"x\""}},
      {[](auto& s) {
         s.forces.push_back({"z", "1"});
       },
       "31:1",
       {"\"z\" is a family", "z[i]"}},
      {[](auto& s) {
         s.forces.push_back({"y[1]", "1"});
       },
       "31:1",
       {"\"y\" has no index"}},
      {[](auto& s) {
         s.forces.push_back({"z[9]", "1"});
       },
       "31:1",
       {"z[9] does not exist", "z[1..3]"}},
      {[](auto& s) {
         s.forces.push_back({"z[2]", "1"}), s.forces.push_back({"z[N-1]", "1"});
       },
       "32:1",
       {"z[2] is given twice"}},
      {[](auto& s) {
         s.forces.push_back({"m", "1"});
       },
       "31:1",
       {"\"m\" is a parameter"}},
      {[](auto& s) {
         s.forces.push_back({"y", "y''"});
       },
       "31:103",
       {"force on y", "second derivatives"}},
      {[](auto& s) {
         s.constraints.push_back({"c", "x"});
       },
       "41:101",
       {"constraint c", "no relation"}},
      {[](auto& s) {
         s.constraints.push_back({"c", "x >= 1 >= y"});
       },
       "41:108",
       {"second relation"}},
      {[](auto& s) {
         s.constraints.push_back({"c", "x > 1"});
       },
       "41:103",
       {">="}},
      {[](auto& s) {
         s.constraints.push_back({"c", "x == 1"});
       },
       "41:103",
       {"write ="}},
      {[](auto& s) {
         s.constraints.push_back({"c", "x >= y'"});
       },
       "41:107",
       {"constraint c", "velocity \"y'\""}},
      {[](auto& s) {
         s.constraints.push_back({"floor", "x >= 0"});
       },
       "41:1",
       {"\"floor\" is taken"}},
      {[](auto& s) {
         s.constraints.push_back({"gap[i in 1..N]", "z[i+1] >= z[i]"});
       },
       "41:101",
       {"z[4] does not exist"}},
      {[](auto& s) {
         s.constraints.push_back({"gap[i]", "x >= 0"});
       },
       "41:1",
       {"write gap[i in 1..N]"}},
  };
  CHECK(error_of([] { system(good()); }) == "no error");
  for (std::size_t row = 0; row < table.size(); ++row) {
    CAPTURE(row);
    SystemText text = good();
    table[row].change(text);
    expect(error_of([&] { system(text); }), table[row].where, table[row].named);
  }
}

TEST_CASE("what is wrong in a state is named, with its place") {
  const auto s = system(good());
  const Lines all{{"x", "0"}, {"y", "m"}, {"z[i]", "i"}};
  const auto error = [&](const Lines& position, const Lines& velocity = {}, const std::string& t = "") {
    return error_of([&] { s->state(state_text(position, velocity, t)); });
  };
  CHECK(error(all) == "no error");
  expect(error({{"x", "0"}, {"z[2]", "i"}}), "61:101", {"position of z[2]", "\"i\" is unknown"});
  expect(error({{"x", "0"}, {"z[2]", "0"}}), "59:1", {"y, z[1], z[3] missing"});
  expect(error({{"x", "0"}, {"yy", "0"}}), "61:1", {"\"yy\" is no coordinate", "\"y\""});
  expect(error(all, {{"h", "1"}}), "70:1", {"velocity", "\"h\" is a definition"});
  expect(error({{"x", "y"}}), "59:1", {"\"y\" is used and not given"});
  expect(error({{"x", "1/0"}}), "60:102", {"position of x", "not finite"});
  expect(error({{"x", "log(-m)"}}), "60:101", {"not finite"});
  expect(error({{"z[i in 1..4]", "1"}}), "60:1", {"z[4] does not exist"});
  expect(error(all, {{"x", "1"}, {"x", "1"}}), "71:1", {"x is given twice"});
  expect(error(all, {}, "t"), "50:101", {"t of the state", "\"t\""});
  expect(error(all, {}, "1/0"), "50:102", {"t of the state", "not finite"});
}

TEST_CASE(
    "what is not finite at the state is named: T, V, Q and constraints, and the derivatives that are "
    "needed") {
  struct AtState {
    SystemText text;
    std::string where;
    std::vector<std::string> named;
  };
  const auto one = [](const std::string& kinetic, const std::string& potential, const Lines& forces,
                      const Lines& constraints) {
    return SystemText{{"x"}, kinetic, potential, {{"zero", "0"}}, {}, forces, constraints};
  };
  const std::vector<AtState> table{
      {one("x'^2/x", "", {}, {}), "2:105", {"kinetic", "x'^2)/x"}},
      {one("x'^2 + abs(x)*x'", "", {}, {}), "2:108", {"kinetic", "abs(x)", "derivative"}},
      {one("x'^2", "sqrt(x)", {}, {}), "3:101", {"potential", "sqrt(x)", "derivative"}},
      {one("x'^2", "0*log(x)", {}, {}), "3:103", {"potential", "log(x)"}},
      {one("x'^2", "atan(1/zero)*x", {}, {}), "3:107", {"potential", "1/zero"}},
      {one("x'^2", "abs(x)", {}, {}), "3:101", {"potential", "abs(x)"}},
      {one("x'^2", "1/(1/x)", {}, {}), "3:105", {"potential", "1/x"}},
      {one("x'^2", "x*exp(800)", {}, {}), "3:103", {"potential", "exp(800)"}},
      {one("x'^2", "", {{"x", "1/x"}}, {}), "30:102", {"force on x", "1/x"}},
      {one("x'^2", "", {{"x", "abs(x)'"}}, {}), "30:101", {"force on x", "abs(x)"}},
      {one("x'^2", "", {}, {{"c", "log(x) >= 0"}}), "40:101", {"constraint c", "log(x)"}},
      {one("x'^2", "", {}, {{"a", "x >= 0"}, {"c", "abs(x) <= 1"}}), "41:101", {"constraint c", "abs(x)"}},
      {one("x'^2", "", {}, {{"c", "x^1.5 >= 0"}}), "40:102", {"constraint c", "x^1.5", "derivative"}},
  };
  for (const auto& [text, where, named] : table) {
    CAPTURE(text.kinetic);
    const auto s = system(text);
    const auto at = state({0}, {1});
    expect(error_of([&] {
             s->inertia(at);
             s->constraint_rates(at);
             s->contact_rows(at, {0});
           }),
           where, named);
  }
}

TEST_CASE("a value without a derivative is enough where only the value is needed") {
  const auto s =
      system({{"x"}, "x'^2", "sqrt(t)*x + abs(t)", {}, {}, {{"x", "-abs(x') - sqrt(x)*abs(x)"}}, {}});
  CHECK(s->inertia(state({0}, {0})).z[0] == 0);
}

TEST_CASE("energy is T + V and refuses what is not finite") {
  const auto s = system({{"x"}, "3*x'^2", "log(x)", {}, {}, {{"x", "1/0"}}, {}});
  CHECK(s->energy(state({1}, {2})) == 12);
  expect(error_of([&] { s->energy(state({0}, {2})); }), "3:101", {"potential", "log(x)"});
}
