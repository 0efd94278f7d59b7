#include <doctest/doctest.h>

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
  CHECK(drifts.out.find("--until \"100*(2*pi)\"`, and taking its end for [state]") != std::string::npos);
  CHECK(drifts.out.find("drifts by another amount each period does not come back") != std::string::npos);
}
