#include "tests/cli/error_form.hpp"

using namespace tests;

namespace {

std::string kinetic(const std::string& T) { return point_on_floor({{3, "kinetic = \"" + T + "\""}}); }
std::string constraint(const std::string& line) { return point_on_floor({{9, line}}); }
std::string definitions(const std::string& lines) {
  return point_on_floor({{14, "[system.definitions]\n" + lines}});
}

}  // namespace

TEST_CASE("an unknown key is named with its place and the nearest key that is known") {
  const std::vector<Wrong> table{
      {point_on_floor({{1, "titel = \"a\"\n[system]"}}), "1:1", {"\"titel\"", "\"title\""}},
      {point_on_floor({{4, "  potental = \"m*g*y\""}}), "4:3", {"\"potental\"", "\"potential\""}},
      {point_on_floor({{5, "[system.parameter]"}}), "5:9", {"\"parameter\"", "\"parameters\""}},
      {point_on_floor({{12, "velocities = { x = 1 }"}}), "12:1", {"\"velocities\"", "\"velocity\""}},
      {point_on_floor({{14, "\ttolerence = 1"}}), "14:2", {"\"tolerence\"", "\"tolerance\""}},
      {point_on_floor({{14, "[simulate]\nuntill = 1"}}), "15:1", {"\"untill\"", "\"until\""}},
      {point_on_floor({{14, "[simulation]\nuntil = 1"}}), "14:2", {"\"simulation\"", "\"simulate\""}},
      {two_rows({{5, "t = [0, 0]"}}), "5:1", {"\"t\""}},
      {two_rows({{2, "A = { diagnal = [1, 1] }"}}), "2:7", {"\"diagnal\"", "\"diagonal\""}},
  };
  for (const Wrong& wrong : table) expect_refusal(wrong);
}

TEST_CASE("columns count characters, not bytes") {
  expect_refusal({point_on_floor({{1, "title = \"\u00e9\u4e2d\"\n[system]"}, {4, "\"\u00e9\" = 1"}}),
                  "5:1",
                  {"\u00e9"}});
  expect_refusal({point_on_floor({{11, "position = { \"\u00e9\" = 0, x = 0 }"}}), "11:14", {"\u00e9"}});
}

TEST_CASE("an unknown name is pointed at inside its expression, with the nearest name") {
  const std::vector<Wrong> table{
      {kinetic("m/2*(x'^2 + yy'^2)"), "3:24", {"\"yy\"", "\"y\""}},
      {point_on_floor({{4, "potential = \"\"\"\nm*g*y\n + gg\"\"\""}}), "6:4", {"\"gg\"", "\"g\""}},
      {constraint("floor = \"y >= hight\""), "9:15", {"\"hight\""}},
      {point_on_floor({{6, "m = \"2*k\""}}), "6:8", {"\"k\""}},
      {point_on_floor({{11, "position = { x = 0, y = 0, z = 0 }"}}), "11:28", {"\"z\"", "x, y"}},
      {point_on_floor({{12, "velocity = { w = 0 }"}}), "12:14", {"\"w\""}},
  };
  for (const Wrong& wrong : table) expect_refusal(wrong);
}

TEST_CASE("definitions and parameters that go round in a circle are refused with the circle") {
  expect_refusal({definitions("a = \"b + 1\"\nb = \"c\"\nc = \"a\""), "17:6", {"a -> b -> c -> a"}});
  expect_refusal({definitions("a = \"a\""), "15:6", {"a -> a"}});
  expect_refusal({definitions("\"d[i in 1..3]\" = \"d[4-i]\""), "15:19", {"d[1] -> d[3] -> d[1]"}});
  expect_refusal({point_on_floor({{6, "m = \"g\""}, {7, "g = \"m\""}}), "7:6", {"m -> g -> m"}});
}

TEST_CASE("T that is not quadratic in the velocities is refused with the part at fault") {
  expect_refusal({kinetic("m/2*y'^2 + x'^4"), "3:25", {"not quadratic", "x'^4"}});
  expect_refusal({kinetic("sin(x')^2 + y'^2"), "3:12", {"not quadratic", "sin(x')"}});
}

TEST_CASE("T that is not positive definite at the state is refused") {
  for (const std::string T : {"x'^2 - y'^2", "0", "x'^2", "(x' + y')^2", "(x' + y')^2/2", "x*x'^2 + y'^2",
                              "x'*y'", "(3*x' + 7*y')^2", "(x'/3 + y'/7)^2"}) {
    CAPTURE(T);
    expect_refusal({kinetic(T), "3:12", {"not positive definite"}});
  }
}

TEST_CASE("second derivatives, and velocities in constraints and potential, are refused") {
  expect_refusal({kinetic("x''^2"), "3:14", {"second derivatives"}});
  expect_refusal({constraint("floor = \"y' >= 0\""), "9:11", {"floor", "velocity"}});
  expect_refusal({point_on_floor({{4, "potential = \"y'\""}}), "4:15", {"potential", "velocity"}});
}

TEST_CASE("a constraint has exactly one relation") {
  expect_refusal({constraint("floor = \"y\""), "9:10", {"floor", "no relation"}});
  expect_refusal({constraint("floor = \"0 <= y <= 1\""), "9:17", {"second relation"}});
  expect_refusal({constraint("floor = \"y > 0\""), "9:12", {"\">\""}});
  expect_refusal({constraint("floor = \"y == 0\""), "9:12", {"\"==\""}});
}

TEST_CASE("one name means one thing, and words of the language are no names") {
  expect_refusal({point_on_floor({{7, "g = 9.81\nx = 1"}}), "2:17", {"\"x\"", "taken"}});
  expect_refusal({constraint("y = \"y >= 0\""), "9:1", {"\"y\"", "taken"}});
  expect_refusal({point_on_floor({{2, R"(coordinates = ["x", "y", "x"])"}}), "2:27", {"\"x\"", "taken"}});
  for (const char* word : {"t", "pi", "sin", "atan2", "sum", "in"})
    expect_refusal({point_on_floor({{7, "g = 9.81\n" + std::string(word) + " = 1"}}), "8:1", {word}});
}

TEST_CASE("a parameter that is not finite is called just that") {
  for (const char* value : {"nan", "inf", "-inf"})
    expect_refusal({point_on_floor({{6, "m = " + std::string(value)}}), "6:5", {"finite"}});
  expect_refusal({point_on_floor({{6, "m = \"1/0\""}}), "6:6", {"\"m\"", "not a finite number"}});
}

TEST_CASE("a value of the wrong type is refused where it stands") {
  expect_refusal({point_on_floor({{2, "coordinates = \"x\""}}), "2:15", {"list"}});
  expect_refusal({point_on_floor({{2, "coordinates = [\"x\", 1]"}}), "2:21", {"string"}});
  expect_refusal({point_on_floor({{3, "kinetic = [1]"}}), "3:11", {"kinetic"}});
  expect_refusal({point_on_floor({{6, "m = true"}}), "6:5", {"system.parameters.m"}});
  expect_refusal({point_on_floor({{11, "position = 3"}}), "11:12", {"state.position"}});
  expect_refusal({point_on_floor({{11, "position = { x = [0], y = 0 }"}}), "11:18", {"state.position.x"}});
  expect_refusal({"system = 3\n", "1:10", {"[system]"}});
  expect_refusal({"[[system]]\ncoordinates = []\n", "1:1", {"[system]"}});
}

TEST_CASE("a file holds one problem, and it must hold one") {
  expect_refusal({point_on_floor({{14, "[projection]\nz = [1]"}}), "14:2", {"[system]", "[projection]"}});
  expect_refusal({"title = \"nothing\"\n", "1:1", {"[system]", "[projection]"}});
  expect_refusal({two_rows({{7, "[state]\nt = 0"}}), "7:1", {"[state]"}});
  expect_refusal({"[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2\"\n", "1:1", {"[state]"}});
  expect_refusal({"[cone]\nz = [1]\n", "1:1", {"generators", "halfspaces"}});
}
