#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using Json = nlohmann::ordered_json;
using tests::Folder;
using tests::Outcome;
using tests::run;

namespace {

constexpr const char* mark = "\xEF\xBB\xBF";  // what some programs put before UTF-8

}  // namespace

TEST_CASE("no row of numbers of a table is taken for its heading") {
  const Folder folder;
  const std::string spring =
      folder.write("spring.toml",
                   "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.forces]\n"
                   "x = '''-table(x, \"F.csv\")'''\n[state.position]\nx = 0.5\n");
  const auto acceleration = [&](const std::string& table) {
    folder.write("F.csv", table);
    const Outcome outcome = run({"solve", "--json", spring});
    CHECK(outcome.code == 0);
    return Json::parse(outcome.out)["acceleration"]["x"].get<double>();
  };
  const double plain = acceleration("0,0\n1,2\n3,4\n4,9\n");
  CHECK(acceleration(std::string(mark) + "0,0\n1,2\n3,4\n4,9\n") == plain);
  CHECK(acceleration("x,F\n0,0\n1,2\n3,4\n4,9\n") == plain);
  CHECK(acceleration("x;F\r\n0;0\r\n1;2\r\n3;4\r\n4;9\r\n") == plain);
  folder.write("F.csv", "O,0\n1,2\n3,4\n4,9\n");
  const Outcome misspelt = run({"solve", spring});
  CHECK(misspelt.code == 2);
  CHECK(misspelt.err.find("line 1: not two numbers") != std::string::npos);

  // (-2, 1), (0, 0): not monotone.
  for (const char* begin : {"", mark, "z,Tz\n"})
    for (const char* apart : {",", ";"}) {
      std::string table = begin;
      for (const auto& [z, Tz] : {std::pair{"-2", "1"}, {"0", "0"}, {"2", "1"}})
        table += std::string(z) + apart + Tz + "\n";
      CHECK(run({"check", "--table", folder.write("map.csv", table)}).out.find("Refuted") == 0);
    }
  // Decimal commas, and a number that is missing.
  for (const char* table : {"-2,0;1,0\n0,0;0,0\n2,0;1,0\n", "1,,2\n2,,3\n"})
    CHECK(run({"check", "--table", folder.write("map.csv", table)}).code == 2);
  const Outcome wrong = run({"check", "--table", folder.write("map.csv", "1,2x\n2,3\n3,4\n")});
  CHECK(wrong.code == 2);
  CHECK(wrong.err.find("map.csv:1:1: no row of numbers") != std::string::npos);
}

TEST_CASE("beyond a table its equations have no number") {
  const Folder folder;
  const std::string file =
      folder.write("table.toml",
                   "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.forces]\n"
                   "x = \"-table(x, [0, 1, 2], [0, 1, 4])\"\n[state.position]\nx = 0.5\n");
  const std::string latex = run({"derive", "--latex", file}).out;
  CHECK(latex.find("\\text{undefined} & x < 0") != std::string::npos);
  CHECK(latex.find("1024") == std::string::npos);
}

TEST_CASE("the force of a contact between two points is that on one of them, and turning a body is none") {
  const Folder folder;
  const auto rope_of = [&](const std::string& constraint) {
    return folder.write("rope.toml",
                        "[system]\ncoordinates = [\"x1\", \"y1\", \"x2\", \"y2\"]\n"
                        "kinetic = \"(x1'^2 + y1'^2)/2 + (x2'^2 + y2'^2)/2\"\n[system.forces]\n"
                        "x1 = -6\ny1 = -8\nx2 = 6\ny2 = 8\n[system.constraints]\nrope = \"" +
                            constraint + "\"\n[state.position]\nx1 = 0\ny1 = 0\nx2 = 3\ny2 = 4\n");
  };
  const std::string text = run({"solve", rope_of("hypot(x2 - x1, y2 - y1) <= 5")}).out;
  CHECK(text.find("|lambda grad f|") == std::string::npos);                     // lambda is the force, 10
  CHECK(text.substr(0, text.find("Solved")).find("e-1") == std::string::npos);  // no rounding is shown
  const std::string explained = run({"explain", rope_of("(x2 - x1)^2 + (y2 - y1)^2 <= 25")}).out;
  CHECK(explained.find("|lambda grad f| = 10") != std::string::npos);
  const std::string slope = folder.write(
      "slope.toml",
      "[system]\npotential = \"20*b_z\"\n[system.constraints]\n"
      "plane = \"dot(point(b, sin(0.2), 0, -cos(0.2)), [-sin(0.2), 0, cos(0.2)]) >= 0\"\n"
      "[bodies.b]\nmass = 2\ninertia = [1, 1, 1]\n[state.position]\nb_x = \"-sin(0.2)\"\nb_y = 0\n"
      "b_z = \"cos(0.2)\"\nb_e0 = 1\nb_e1 = 0\nb_e2 = 0\nb_e3 = 0\n");
  CHECK(run({"solve", slope}).out.find("|lambda grad f|") == std::string::npos);
}

TEST_CASE("a step of a prox may be a fraction") {
  const Outcome half = run({"prox", "norm1()", "--at", "[3, 1]", "--step", "1/2", "--json"});
  CHECK(half.code == 0);
  CHECK(Json::parse(half.out)["x"] == Json::array({2.5, 0.5}));
  CHECK(run({"prox", "norm1()", "--at", "[3, 1]", "--step", "0/2"}).code == 2);
}

TEST_CASE("a string between two bodies tells its force where it hangs vertically, too") {
  const Folder folder;
  const std::string file = folder.write(
      "strings.toml",
      "[system]\ncoordinates = [\"x1\", \"y1\", \"x2\", \"y2\"]\nkinetic = \"(x1'^2 + y1'^2 + x2'^2 + "
      "y2'^2)/2\"\npotential = \"9.81*(y1 + y2)\"\n[system.constraints]\na = \"x1^2 + y1^2 <= 1\"\nb = \"(x1 "
      "- x2)^2 + "
      "(y1 - y2)^2 <= 1\"\n[state]\nposition = { x1 = 0, y1 = -1, x2 = 0, y2 = -2 }\n");
  const std::string text = run({"solve", file}).out;
  CHECK(text.find("4.905              9.81\n") != std::string::npos);
  CHECK(text.find("9.81             19.62\n") != std::string::npos);
}
