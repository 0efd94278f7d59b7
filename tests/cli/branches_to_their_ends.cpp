#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

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
