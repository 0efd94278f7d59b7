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
