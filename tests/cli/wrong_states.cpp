#include "tests/cli/error_form.hpp"

using namespace tests;

namespace {

std::string position(const std::string& table) { return point_on_floor({{11, "position = " + table}}); }
std::string constraint(const std::string& line, const std::string& velocity = "{ }") {
  return point_on_floor({{9, line}, {12, "velocity = " + velocity}});
}

}  // namespace

TEST_CASE("a penetrated constraint is named with its value, its line and what to do") {
  expect_refusal(
      {position("{ x = 0, y = -0.25 }"), "9:1", {"floor", "-0.25", "penetrated", "contact_tolerance"}});
}

TEST_CASE("an impact that is due is named with its speed and refers to simulate") {
  expect_refusal(
      {constraint("floor = \"y >= 0\"", "{ y = -0.5 }"), "9:1", {"floor", "-0.5", "impact", "simulate"}});
}

TEST_CASE("a two-sided constraint that does not hold in f or in df/dt is refused") {
  expect_refusal({constraint("rod = \"x = 1\""), "9:1", {"rod", "f = -1", "two-sided"}});
  expect_refusal({constraint("rod = \"x = 0\"", "{ x = 3 }"), "9:1", {"rod", "df/dt = 3", "two-sided"}});
}

TEST_CASE("a rate that no velocity changes is told as that, and no velocity is advised") {
  for (const auto& [line, velocity] : {std::pair("rod = \"t^2*(x^2 + 1) = 0\"", "{ }"),
                                       {"rod = \"x^2 = y^2 + t\"", "{ x = 3 }"},
                                       {"rod = \"x^2 + 1 >= 1 + t\"", "{ x = 3 }"}})
    expect_refusal(
        {constraint(line, velocity), "9:1", {"rod", "whatever the velocities", "change the constraint"}});
  // Beside such a state a velocity keeps it.
  expect_refusal({constraint("rod = \"x = t\""), "9:1", {"rod", "df/dt = -1", "choose velocities"}});
}

TEST_CASE("the member of a family that is at fault is named") {
  const std::string chain =
      "[system]\ncoordinates = [\"x[1..3]\"]\nkinetic = \"sum(i in 1..3, x[i]'^2)\"\n"
      "[system.constraints]\n\"gap[i in 1..2]\" = \"x[i+1] - x[i] >= 1\"\n[state]\n";
  expect_refusal({chain + "position = { \"x[i]\" = \"i\", \"x[3]\" = 2.5 }\n", "5:1", {"gap[2]", "-0.5"}});
  expect_refusal({chain + "position = { \"x[1]\" = 1, \"x[2]\" = 2 }\n", "7:12", {"x[3]", "missing"}});
  expect_refusal({chain + "position = { \"x[i]\" = \"i\", \"x[4]\" = 4 }\n", "7:28", {"x[4]", "x[1..3]"}});
}

TEST_CASE("an expression that is not finite at the state is refused with the part at fault") {
  const std::vector<Wrong> table{
      {point_on_floor({{4, "potential = \"m/x\""}}), "4:15", {"potential", "m/x", "not finite"}},
      {constraint("floor = \"y + 1/x >= 0\""), "9:15", {"floor", "1/x", "not finite"}},
      {point_on_floor({{4, "potential = \"log(x)\""}}), "4:14", {"log(x)", "not finite"}},
      {point_on_floor({{4, "potential = \"sqrt(x-1)\""}}), "4:14", {"not finite"}},
      {point_on_floor({{4, "potential = \"exp(1e4*(x+1))\""}}), "4:14", {"not finite"}},
      {point_on_floor({{4, "potential = \"0/x\""}}), "4:15", {"0/x", "not finite"}},
      {position("{ x = \"1/0\", y = 0 }"), "11:20", {"position of x", "not finite"}},
      {position("{ x = nan, y = 0 }"), "11:18", {"finite"}},
      {position("{ x = 0, y = inf }"), "11:25", {"finite"}},
  };
  for (const Wrong& wrong : table) expect_refusal(wrong);
}

TEST_CASE("a derivative that does not exist at the state is refused, and named in the file's own words") {
  const std::vector<Wrong> table{
      {point_on_floor({{4, "potential = \"abs(x)\""}}), "4:14", {"abs(x)", "derivative"}},
      {constraint("floor = \"abs(x) >= 0\""), "9:10", {"floor", "abs(x)", "derivative"}},
      {constraint("floor = \"sqrt(y) >= 0\""), "9:10", {"sqrt(y)", "derivative"}},
      {point_on_floor({{5, "[system.forces]\nx = \"abs(x)'\"\n[system.parameters]"}}),
       "6:6",
       {"force on x", "abs(x)"}},
  };
  for (const Wrong& wrong : table) expect_refusal(wrong);
}

TEST_CASE("a missing position is an error, a missing velocity is zero") {
  expect_refusal({position("{ x = 0 }"), "11:12", {"y", "missing"}});
  expect_refusal({position("{ }"), "11:12", {"x, y", "missing"}});
  CHECK(run_on("solve", point_on_floor({{12, ""}})).code == 0);
}

TEST_CASE("values of the state may use parameters, t and the coordinates that are given") {
  CHECK(run_on("solve", point_on_floor({{11, "t = \"m/2\"\nposition = { x = \"g*sin(t)\", y = 0 }"}})).code ==
        0);
  CHECK(run_on("solve", point_on_floor({{11, "position = { x = \"2*y\", y = 0 }"}})).code == 0);
  expect_refusal({position("{ x = \"y\" }"), "11:12", {"\"y\"", "not given"}});
  expect_refusal({point_on_floor({{12, "t = \"t\""}}), "12:6", {"\"t\""}});
}
