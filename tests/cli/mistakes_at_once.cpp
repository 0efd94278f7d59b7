#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "cli/problem_file/toml_document.hpp"
#include "tests/cli/program.hpp"

using Json = nlohmann::ordered_json;
using namespace tests;

namespace {

/// The lines on standard error behind "moreau: FILE:", of a file that is refused.
std::vector<std::string> told(const std::string& text) {
  const Folder folder;
  const std::string file = folder.write("a.toml", text);
  const Outcome outcome = run({"solve", file});
  CAPTURE(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  std::vector<std::string> lines;
  const std::string before = "moreau: " + file + ":";
  for (std::size_t at = 0; at < outcome.err.size();) {
    const std::size_t end = outcome.err.find('\n', at);
    const std::string line = outcome.err.substr(at, end - at);
    CHECK(line.starts_with(before));
    CHECK(line.find("; ") != std::string::npos);
    lines.push_back(line.substr(before.size()));
    at = end + 1;
  }
  return lines;
}

void check_told(const std::string& text, const std::vector<std::string>& beginnings) {
  const std::vector<std::string> lines = told(text);
  CAPTURE(text);
  REQUIRE(lines.size() == beginnings.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    CAPTURE(lines[k]);
    CAPTURE(beginnings[k]);
    CHECK(lines[k].starts_with(beginnings[k]));
  }
}

}  // namespace

TEST_CASE("mistakes of a file that do not hang on each other are told at once, in the order of the file") {
  check_told(point_on_floor({{4, "potential = \"m*g*sinn(y)\""},
                             {9, "floor = \"y > 0\""},
                             {12, "velocity = { z = 0.0 }"},
                             {13, "[simulate]\nuntill = 2\nsample = 3"}}),
             {"4:18: potential: \"sinn\" is no function; did you mean \"sin\"?", "9:12: constraint floor: ",
              "12:14: velocity: \"z\" is no coordinate; ", "14:1: unknown key \"untill\" in [simulate]; ",
              "15:1: unknown key \"sample\" in [simulate]; "});
  check_told(point_on_floor({{4, "potental = \"m*g*y\""}, {6, "m = \"2 kg\""}}),
             {"4:1: unknown key \"potental\" in [system]; ", "6:8: parameter m: "});
  check_told(point_on_floor({{11, "position = { x = \"0.0*\", y = \"q\" }"}}),
             {"11:23: position of x: ", "11:31: position of y: "});
  // The state, the settings and the other keys of a table are read without what is wrong in [system].
  check_told(point_on_floor({{2, "coordinate = [\"x\", \"y\"]"},
                             {4, "potential = true"},
                             {12, "velocities = { x = 0.0 }"},
                             {13, "in_contact = 3\n[simulate]\nuntil = false\nstep = -1"}}),
             {"2:1: unknown key \"coordinate\" in [system]; ",
              "4:13: system.potential: ", "12:1: unknown key \"velocities\" in [state]; ",
              "13:14: state.in_contact: ", "15:9: simulate.until: ", "16:8: simulate.step: "});
  check_told(point_on_floor({{13, "[draw]\npoint = 1\npoints = { a = 1, b = [0] }\nsegments = 2"}}),
             {"14:1: unknown key \"point\" in [draw]; ",
              "15:16: draw.points.a: ", "15:23: draw.points.b: ", "16:12: draw.segments: "});
  check_told(point_on_floor({{11, "position = { x = \"0.0*\", y = 0.0 }"}, {12, "velocities = { x = 0.0 }"}}),
             {"11:23: position of x: ", "12:1: unknown key \"velocities\" in [state]; "});
  check_told("[decomposition]\nz = [1, \"two\"]\nf = \"norm1(\"\n", {"2:9: ", "3:"});
  check_told(
      "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"disk(center=[0, 0], radius=1)\"\ndensity = 0\n"
      "force = [\"0\", \"-gg\"]\nfree = { top = { where = \"true\", pressure = \"p0\" } }\n",
      {"3:11: domain: ", "4:11: density: ", "5:17: force: ", "6:46: free.top.pressure: "});
}

TEST_CASE("a slip in a key hides nothing of what stands in the file beside it") {
  const std::pair<int, const char*> floor{9, "floor = \"y > 0\""};
  const std::string wrong_floor = "9:12: constraint floor: ";
  check_told(point_on_floor({{2, "coordinate = [\"x\", \"y\"]"}, floor}),
             {"2:1: unknown key \"coordinate\" in [system]; ", wrong_floor});
  check_told(point_on_floor({{3, "T = \"m/2*(x'^2 + y'^2)\""}, floor}),
             {"3:1: unknown key \"T\" in [system]; ", wrong_floor});
  check_told(point_on_floor({{5, "[system.paramters]"}, floor}),
             {"5:9: unknown key \"paramters\" in [system]; ", wrong_floor});
  check_told(point_on_floor({{8, "[system.constraint]"}, floor}),
             {"8:9: unknown key \"constraint\" in [system]; ", wrong_floor});
  check_told(point_on_floor({floor, {10, "[stat]"}}), {wrong_floor, "10:2: unknown key \"stat\"; "});
  check_told(point_on_floor({floor, {13, "[slve]\ntolerance = 1e-9"}}),
             {wrong_floor, "13:2: unknown key \"slve\"; "});
  check_told(point_on_floor({floor, {13, "[system.looseness]\nplay = { betwen = [\"x\", \"y\"], gap = 1 }"}}),
             {wrong_floor, "14:10: unknown key \"betwen\" in [system.looseness.play]; "});
}

TEST_CASE("a place behind an escape or a continued line is that in the file") {
  check_told(point_on_floor({{4, R"x(potential = "m*g\u002ay\t+ sinn(y)")x"}}), {"4:28: potential: "});
  check_told(point_on_floor({{4, "potential = \"\"\"m*g*y \\\n   + \\\n\n  sinn(y)\"\"\""}}),
             {"7:3: potential: "});
  check_told(point_on_floor({{4, "potential = \"\"\"\n\\\n m*g*y +\n sinn(y)\"\"\""}}), {"7:2: potential: "});
  check_told(point_on_floor({{4, "potential = 'm*g*y + sinn(y)'"}}), {"4:22: potential: "});
}

TEST_CASE("a backslash in a literal string is no escape, whatever the line breaks of the file are") {
  for (const char* text :
       {"a = '\\t+\\n'", "a = '''\\t+\\n'''", "a = '''\n\\t+\\n'''", "a = '''\r\n\\t+\\n'''"}) {
    CAPTURE(text);
    const cli::TomlValue table = cli::parse_toml(text);
    CHECK(table.table[0].value.text == "\\t+\\n");
    CHECK(table.table[0].value.content.jumps.empty());
  }
  CHECK(cli::parse_toml("a = \"\"\"\r\n\\t+\\n\"\"\"").table[0].value.content.jumps.size() == 2);
}

TEST_CASE("what is looked at of a constraint that is a power is told with what is wrong of it") {
  check_told(point_on_floor({{9, "floor = \"y^2 = 0\""}, {12, "velocity = { x = 1.0, y = 2.0 }"}}),
             {"9:1: constraint floor: two-sided, and read as y = 0, of which it is a power, but df/dt = 2 "});
}

TEST_CASE("what follows from a mistake is not told as another one") {
  // Names and tables that stand below a key with a wrong name are missed by nothing.
  check_told(point_on_floor({{5, "[system.paramters]"}}), {"5:9: unknown key \"paramters\" in [system]; "});
  check_told(point_on_floor({{10, "[stat]"}}), {"10:2: unknown key \"stat\"; "});
  check_told(point_on_floor({{1, "[sistem]"}, {5, "[sistem.parameters]"}, {8, "[sistem.constraints]"}}),
             {"1:2: unknown key \"sistem\"; "});
  check_told(point_on_floor({{2, "coordinate = [\"x\", \"y\"]"}}),
             {"2:1: unknown key \"coordinate\" in [system]; "});
  check_told(point_on_floor({{6, "\"m-1\" = 2.0"}}), {"6:2: "});
}

TEST_CASE("the object of an error has the first one, and all of them as a list") {
  const Outcome outcome =
      run_json_on("solve", point_on_floor({{4, "potential = \"m*g*yy\""}, {14, "untill = 2"}}));
  CHECK(outcome.code == 2);
  const Json error = Json::parse(outcome.out);
  CHECK(error.at("status") == "error");
  CHECK(error.at("line") == 4);
  REQUIRE(error.at("errors").size() == 2);
  CHECK(error.at("errors")[0].at("message") == error.at("message"));
  CHECK(error.at("errors")[1].at("line") == 14);
  std::string many = "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2\"\n[state]\nposition = { x = 0 }\n";
  for (int k = 0; k < 30; ++k) many += "key" + std::to_string(k) + " = 1\n";
  const Outcome crowd = run_json_on("solve", many);
  CHECK(Json::parse(crowd.out).at("errors").size() == 20);
  CHECK(crowd.err.find(": and 10 more; ") != std::string::npos);
}
