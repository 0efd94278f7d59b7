#include <doctest/doctest.h>

#include "tests/cli/error_form.hpp"

using namespace tests;

TEST_CASE("a key of one table within another is told, and what it holds is read") {
  check_told(point_on_floor({{4, "position = { x = 0, z = 1 }"}, {10, ""}, {11, ""}, {12, ""}}),
             {"4:1: unknown key \"position\" in [system]; it is a part of [state], ",
              "4:21: position: \"z\" is no coordinate; "});
  check_told(
      point_on_floor({{4, "step = 0"}}),
      {"4:1: unknown key \"step\" in [system]; it belongs below [simulate]", "4:8: simulate.step: 0 "});
  check_told(
      point_on_floor({{13, "kinetic = \"m\"\nuntil = true"}}),
      {"13:1: unknown key \"kinetic\" in [state]; it belongs below [system]",
       "14:1: unknown key \"until\" in [state]; it belongs below [simulate]", "14:9: simulate.until: "});
}

TEST_CASE("what stands at the top and belongs below a table is read there") {
  check_told(point_on_floor({{8, "[constraints]"}, {9, "floor = \"y => 0\""}}),
             {"8:2: unknown key \"constraints\"; ", "9:12: constraint floor: "});
  check_told(point_on_floor({{1, "until = -1"}, {2, "[system]\ncoordinates = [\"x\", \"y\"]"}}),
             {"1:1: unknown key \"until\"; it belongs below [simulate]"});
  check_told("A = [[1, 0], [0]]\nz = [1, 2]\n", {"1:1: unknown key \"A\"; it belongs below [projection]",
                                                 "1:14: A[1]: 1 entry; ", "2:1: unknown key \"z\"; "});
  check_told(point_on_floor({{1, ""}}),
             {"2:1: unknown key \"coordinates\"; it belongs below [system]", "3:1: unknown key \"kinetic\"; ",
              "4:1: unknown key \"potential\"; "});
}

TEST_CASE("what stands below a table of names and belongs elsewhere is told where, and read there") {
  // Without its place a potential was a definition that nothing uses: the point had no weight, and nothing
  // was said.
  check_told(
      point_on_floor({{4, "[system.definitions]\npotential = \"m*g*y\""}}),
      {"5:1: system.definitions.potential: this is of [system]; write it above [system.definitions], "});
  check_told(point_on_floor({{4, ""}, {7, "g = 9.81\npotential = \"m*g*yy\""}}),
             {"8:1: system.parameters.potential: ", "8:18: potential: \"yy\" is unknown; "});
  check_told(point_on_floor({{10, ""}}),
             {"11:1: system.constraints.position: this is of [state]; write [state] above it",
              "12:1: system.constraints.velocity: "});
  check_told(
      "[liquid]\ncoordinates = [\"x\"]\ndomain = \"interval(low=0, high=1)\"\ndensity = 1\n"
      "[liquid.parameters]\nw = 1\nfree = { top = { where = \"true\", pressure = \"1\" } }\n",
      {"7:1: liquid.parameters.free: this is of [liquid]; write it above [liquid.parameters]"});
  // A name of one's own is one where nothing is missed, and in a liquid.
  const Outcome own = run_on("solve", point_on_floor({{6, "m = 2.0\npotential = 1"}}));
  CHECK(own.code == 0);
}

TEST_CASE("a file of another encoding, or of other line ends, is told how to save it") {
  check_told("[\xff\xfes\x00y\x00", {"1:1: no text in UTF-8; save the file as UTF-8"});
  check_told("[system]\rcoordinates = []\r", {"1:10: a line that ends with a carriage return alone; save"});
  CHECK(told("[system]\r\ncoordinates = [1]\r\nkinetic = \"0\"\r\n").front().starts_with("2:16: "));
}
