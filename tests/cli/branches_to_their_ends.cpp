#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/drawing/gnuplot.hpp"
#include "tests/cli/program.hpp"

using namespace tests;

TEST_CASE("a branch of one orbit far from a fold is told at once") {
  // The fold was looked for at ever larger c, without end.
  const Folder folder;
  const std::string file = folder.write(
      "o.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[system.parameters]\n"
      "c = 0.1\n[system.forces]\nx = \"cos(0.9*t) - c*x'\"\n[system.constraints]\nstop = \"x <= 0.5\"\n"
      "[simulate]\nrestitution = 0.7\n[state]\nposition = { x = 0 }\n");
  for (const char* range : {"c=0.1:0.01:0.1", "c=0.145:0.01:0.145", "c=0.092:0.002:0.106"}) {
    const Outcome outcome = run({"orbit", "--json", file, "--period", "2*pi/0.9", "--over", range});
    CAPTURE(outcome.err);
    CHECK(outcome.code == 0);
    CHECK(nlohmann::json::parse(outcome.out)["status"] == "solved");
  }
}

namespace {

/// A follower of mass 0.4, pressed onto an eccentric cam, from a state on it.
std::string follower(const std::string& t) {
  return "[system]\ncoordinates = [\"y\"]\nkinetic = \"0.2*y'^2\"\npotential = \"33.924*y + 1500*y^2\"\n"
         "[system.parameters]\nw = 100\n[system.definitions]\nh = \"0.008*(1 - cos(w*t))\"\n"
         "[system.constraints]\ncam = \"y >= h\"\n[simulate]\nrestitution = 0.2\n[state]\nt = " +
         t + "\nposition = { y = \"h\" }\nvelocity = { y = \"h'\" }\n";
}

}  // namespace

TEST_CASE("a branch goes on where its orbits begin at 0, whatever rounding makes of that") {
  const Folder folder;
  const Outcome outcome = run({"orbit", "--json", folder.write("c.toml", follower("0")), "--period", "2*pi/w",
                               "--over", "w=110:5:150"});
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
  CHECK(nlohmann::json::parse(outcome.out)["orbits"] == 9);
}

TEST_CASE("a branch goes on along a contact that is held, wherever the parameter moves it") {
  const Folder folder;
  const Outcome cam = run({"orbit", "--json", folder.write("c.toml", follower("0.008")), "--period", "2*pi/w",
                           "--over", "w=120:1:130"});
  CAPTURE(cam.err);
  CHECK(cam.code == 0);
  CHECK(nlohmann::json::parse(cam.out)["orbits"] == 11);
  const std::string gear = folder.path("gear.toml");
  REQUIRE(run({"new", "looseness", gear}).code == 0);
  const Outcome teeth = run({"orbit", "--json", gear, "--period", "2*pi/w", "--over", "w=20:1:30"});
  CAPTURE(teeth.err);
  CHECK(teeth.code == 0);
  CHECK(nlohmann::json::parse(teeth.out)["orbits"] == 11);
}

TEST_CASE("a branch whose multipliers are all 0 is drawn, and says so") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  for (const char* range : {"w=158:0.5:160", "w=158:0.5:158"}) {
    const std::string picture = folder.path("c.svg");
    const Outcome outcome = run({"orbit", folder.write("c.toml", follower("0")), "--period", "2*pi/w",
                                 "--over", range, "--plot", picture});
    CAPTURE(outcome.err);
    CHECK(outcome.code == 0);
    CHECK(outcome.out.starts_with(std::string(range) == "w=158:0.5:158" ? "1 orbit over" : "5 orbits over"));
    std::stringstream drawn;
    drawn << std::ifstream(picture).rdbuf();
    CHECK(drawn.str().find("all 0") != std::string::npos);
    CHECK(drawn.str().find("</svg>") != std::string::npos);
  }
}

TEST_CASE("a picture that gnuplot leaves half drawn does not stay") {
  const Folder folder;
  const std::string gnuplot = folder.write(
      "gnuplot", "#!/bin/sh\necho half > \"$(sed -n 's/^set output \"\\(.*\\)\"$/\\1/p' \"$1\")\"\nexit 1\n");
  std::filesystem::permissions(gnuplot, std::filesystem::perms::owner_all);
  const std::string picture = folder.path("c.svg"),
                    bin = std::filesystem::path(gnuplot).parent_path().string();
  const Outcome outcome = run_by_shell("PATH=" + bin + ":$PATH exec \"$0\" \"$@\"",
                                       {"orbit", folder.write("c.toml", follower("0")), "--period", "2*pi/w",
                                        "--over", "w=158:0.5:160", "--plot", picture});
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("gnuplot cannot draw it") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(picture));
}

TEST_CASE("a branch on which grazes crowd ends, says so, and keeps its rows") {
  // From w = 34 to 36 impacts of the teeth cease to accumulate: orbits of 72 to 28 impacts a period.
  const Folder folder;
  const std::string gear = folder.path("gear.toml"), table = folder.path("b.csv");
  REQUIRE(run({"new", "looseness", gear}).code == 0);
  const Outcome outcome =
      run({"orbit", gear, "--period", "2*pi/w", "--over", "w=34:2:38", "--output", table});
  CHECK(outcome.code == 3);
  CHECK(outcome.err.find("ends before w = 38: orbits were sought") != std::string::npos);
  std::ifstream rows(table);
  CHECK(std::count(std::istreambuf_iterator<char>(rows), {}, '\n') == 3);
}

TEST_CASE("what crosses a branch is told once, and a branch that two periods go through has what one has") {
  // The orbit of one period flips where that of two, which it is as well, has the multiplier 1.
  const Folder folder;
  const std::string file = folder.write(
      "o.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[system.parameters]\n"
      "w = 2\n[system.forces]\nx = \"cos(w*t) - 0.1*x'\"\n[system.constraints]\nstop = \"x >= 0\"\n"
      "[simulate]\nrestitution = 0.8\n[state]\nposition = { x = 0.5 }\nvelocity = { x = 0.5 }\n");
  const Outcome twice = run({"orbit", file, "--period", "4*pi/w", "--over", "w=2.6:0.05:2.8"}),
                once = run({"orbit", file, "--period", "2*pi/w", "--over", "w=2.6:0.05:2.8"});
  for (const Outcome& outcome : {twice, once}) {
    CHECK(outcome.code == 0);
    CHECK(std::count(outcome.out.begin(), outcome.out.end(), '\n') == 1 + 5 + 1);
  }
  const std::size_t told = twice.err.find("a multiplier passes 1");
  CHECK(told != std::string::npos);
  CHECK(twice.err.find("a multiplier passes 1", told + 1) == std::string::npos);
  const std::size_t flip = once.out.find(",flip,"), row = once.out.rfind('\n', flip) + 1;
  REQUIRE(flip != std::string::npos);
  const std::string value = once.out.substr(row, 12);
  CHECK(twice.err.find("at w = " + value) != std::string::npos);
}
