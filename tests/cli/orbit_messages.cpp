#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;

namespace {

/// A damped oscillator that is driven.
const char* const driven = R"toml([system]
coordinates = ["x"]
kinetic = "x'^2/2"
potential = "x^2/2"
[system.parameters]
w = 2.0
[system.forces]
x = "cos(w*t) - 0.2*x'"
[state]
position = { x = 0 }
)toml";

}  // namespace

TEST_CASE("an orbit that comes back after a part of the periods asked for is told as such") {
  const Folder folder;
  const std::string file = folder.write("a.toml", driven);
  const Outcome three = run({"orbit", file, "--period", "2*pi/w", "--periods", "3"});
  CHECK(three.code == 0);
  CHECK(three.err.find("comes back after 1 of the 3 periods already; give --periods 1") != std::string::npos);
  CHECK(run({"orbit", file, "--period", "2*pi/w"}).err.empty());
  const Outcome branch = run({"orbit", file, "--period", "2*pi/w", "--periods", "2", "--over", "w=2:0.5:3"});
  CHECK(branch.err.find("come back after 1 of the 2 periods already; give --periods 1") != std::string::npos);
}

TEST_CASE("t that stands in the way of a free period is told where it stands") {
  const Folder folder;
  const std::string err = run({"orbit", folder.write("a.toml", driven), "--period", "free"}).err;
  CHECK(err.find("a.toml:8:12: an orbit of unknown period") != std::string::npos);
}

TEST_CASE(
    "where no orbit is found it is told how to begin nearer, and of a drift that it does not come back") {
  const Folder folder;
  const std::string file = folder.write(
      "a.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\nforces = { x = \"1 - x' + cos(t)\" }\n"
      "[state]\nposition = { x = 0 }\n");
  const Outcome drifts = run({"orbit", file, "--period", "2*pi"});
  CHECK(drifts.code == 3);
  CHECK(drifts.out.find("--until \"100*(2*pi)\" --json > end.json`, then --resume end.json") !=
        std::string::npos);
  CHECK(drifts.out.find("drifts by another amount each period does not come back") != std::string::npos);
}

TEST_CASE("an orbit is begun from the end of a motion") {
  const Folder folder;
  // Far up, where the spring is not, nothing that comes back is near.
  std::string far = driven;
  far.replace(far.find("x^2/2"), 5, "-exp(-x^2)");
  far.replace(far.find("{ x = 0 }"), 9, "{ x = 0.5 }");
  const std::string file = folder.write("a.toml", far);
  const std::string end = folder.write("end.json", run({"simulate", "--json", file, "--until", "60*pi"}).out);
  const Outcome begun = run({"orbit", "--json", file, "--period", "2*pi/w", "--resume", end});
  REQUIRE(begun.code == 0);
  const auto orbit = nlohmann::json::parse(begun.out),
             motion = nlohmann::json::parse(run({"simulate", "--json", file, "--until", "60*pi"}).out);
  CHECK(motion["t"].get<double>() > 188);
  CHECK(orbit["t"] == 0);  // sixty periods before
  CHECK(std::abs(orbit["position"]["x"].get<double>() - motion["position"]["x"].get<double>()) <= 1e-6);
  CHECK(run({"orbit", file, "--period", "2*pi/w", "--resume", folder.path("none.json")}).code == 2);
}
