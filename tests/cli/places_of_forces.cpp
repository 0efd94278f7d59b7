#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;

namespace {

/// The force of a contact in an animation.
struct DrawnForce {
  double x, y, across, up;
};

/// By constraint, at the instant where the motion begins.
std::map<std::string, std::vector<DrawnForce>> first_forces(const std::string& problem) {
  const Folder folder;
  const std::string page = folder.path("a.html");
  const Outcome outcome =
      run({"simulate", "--quiet", folder.write("a.toml", problem), "--until", "1e-3", "--animate", page});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  std::stringstream text;
  text << std::ifstream(page).rdbuf();
  const std::string whole = text.str(), begin = "{\"title\"";
  const std::size_t from = whole.find(begin);
  REQUIRE(from != std::string::npos);
  const auto data = nlohmann::ordered_json::parse(whole.substr(from, whole.find("</script>", from) - from));
  std::map<std::string, std::vector<DrawnForce>> found;
  for (const auto& arrow : data["frames"][0]["arrows"])
    found[data["constraints"][arrow[0].get<std::size_t>()].get<std::string>()].push_back(
        {arrow[1], arrow[2], arrow[3], arrow[4]});
  return found;
}

void check_force(const DrawnForce& found, const DrawnForce& told) {
  for (const auto& [a, b] : {std::pair{found.x, told.x}, std::pair{found.y, told.y},
                             std::pair{found.across, told.across}, std::pair{found.up, told.up}})
    CHECK(std::abs(a - b) <= 1e-6 * std::max(1.0, std::abs(b)));
}

/// A square block of side 2 and weight 1 on the tip of a finger at (0.5, -1), turned by a moment of 0.5.
const char* const block_on_finger = R"toml(
[system]
coordinates = ["x", "y", "a"]
kinetic = "(x'^2 + y'^2 + a'^2)/2"
potential = "y"
[system.forces]
a = "-0.5"
[system.constraints]
finger = "(0.5 - x)*sin(a) + (y + 1)*cos(a) >= 1"
[state]
position = { x = 0, y = 0, a = 0 }
[draw]
points.tip = ["0.5", "-1"]
segments.base = [["x - cos(a) + sin(a)", "y - cos(a) - sin(a)"], ["x + cos(a) + sin(a)", "y - cos(a) + sin(a)"]]
segments.top = [["x - cos(a) - sin(a)", "y + cos(a) - sin(a)"], ["x + cos(a) - sin(a)", "y + cos(a) + sin(a)"]]
)toml";

/// Two blocks of weight 1, each of height 1, one on the other.
const char* const two_blocks = R"toml(
[system]
coordinates = ["y[1..2]", "a[1..2]"]
kinetic = "sum(i in 1..2, (y[i]'^2 + a[i]'^2)/2)"
potential = "y[1] + y[2]"
[system.constraints]
"floor[s in 0..1]" = "y[1] + (2*s-1)*sin(a[1]) - cos(a[1])/2 >= 0"
"between[s in 0..1]" = "y[2] - y[1] + (2*s-1)*(sin(a[2]) - sin(a[1])) - (cos(a[1]) + cos(a[2]))/2 >= 0"
[state]
position = { "y[i]" = "i - 1/2", "a[i]" = 0 }
[draw]
segments."left[i in 1..2]" = [["-cos(a[i]) + sin(a[i])/2", "y[i] - sin(a[i]) - cos(a[i])/2"], ["-cos(a[i]) - sin(a[i])/2", "y[i] - sin(a[i]) + cos(a[i])/2"]]
segments."right[i in 1..2]" = [["cos(a[i]) + sin(a[i])/2", "y[i] + sin(a[i]) - cos(a[i])/2"], ["cos(a[i]) - sin(a[i])/2", "y[i] + sin(a[i]) + cos(a[i])/2"]]
)toml";

}  // namespace

TEST_CASE(
    "the force of a finger on a block is drawn at its tip, though no point of the block is drawn there") {
  const auto forces = first_forces(block_on_finger);
  REQUIRE(forces.count("finger") == 1);
  REQUIRE(forces.at("finger").size() == 1);
  check_force(forces.at("finger")[0], {0.5, -1, 0, forces.at("finger")[0].up});
  CHECK(forces.at("finger")[0].up > 0);
}

TEST_CASE("the forces of a floor and between blocks are drawn where they meet, not elsewhere in their line") {
  const auto forces = first_forces(two_blocks);
  for (const int s : {0, 1}) {
    const double side = 2 * s - 1;
    const std::string index = "[" + std::to_string(s) + "]";
    REQUIRE(forces.count("floor" + index) == 1);
    REQUIRE(forces.at("floor" + index).size() == 1);
    check_force(forces.at("floor" + index)[0], {side, 0, 0, 1});
    REQUIRE(forces.count("between" + index) == 1);
    REQUIRE(forces.at("between" + index).size() == 2);  // and what acts on the block below
    for (const DrawnForce& force : forces.at("between" + index))
      check_force(force, {side, 1, 0, force.up > 0 ? 0.5 : -0.5});
  }
}

TEST_CASE("a force is drawn at the place that f is the height of, and the moment of a stop at none") {
  const auto forces = first_forces(R"toml(
[system]
coordinates = ["a"]
kinetic = "a'^2/2"
[system.parameters]
b = 0.5
[system.forces]
a = 1
[system.constraints]
above = "sin(a) <= sin(b)"
stop = "a <= b"
[state]
position = { a = "b" }
[draw]
segments.arm = [["0", "0"], ["cos(a)", "sin(a)"]]
segments.platform = [["0", "sin(a)"], ["1", "sin(a)"]]
)toml");
  CHECK(forces.count("stop") == 0);
  REQUIRE(forces.count("above") == 1);
  REQUIRE(forces.at("above").size() == 1);
  const DrawnForce& force = forces.at("above")[0];
  check_force(force, {0, std::sin(0.5), 0, force.up});
  CHECK(force.up < 0);
}

TEST_CASE("the force of a stop that stands still and touches a pendulum is drawn there") {
  const std::string file = tests::source_folder() + "docs/problems/motion_pendulum_stop.toml";
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  std::string problem = text.str();
  const std::string raised = "position = { a = 1.0 }";
  REQUIRE(problem.find(raised) != std::string::npos);
  problem.replace(problem.find(raised), raised.size(), "position = { a = -0.3 }\n[system.forces]\na = -9");
  const auto forces = first_forces(problem);
  REQUIRE(forces.count("stop") == 1);
  CHECK(forces.at("stop")[0].across > 0);
}

TEST_CASE("the force of a corner on a rod of two coordinates is drawn at the corner, not at the rod's tip") {
  const auto forces = first_forces(R"toml(
[system]
coordinates = ["x", "a"]
kinetic = "x'^2/2 + ((x + cos(a))'^2 + sin(a)'^2)/2 + a'^2/6"
potential = "sin(a)"
[system.constraints]
step = "x*sin(a) + 0.6*cos(a) <= 0"
buffer = "x >= -0.8"
[state]
position = { x = -0.8, a = "atan2(0.6, 0.8)" }
[draw]
segments.rod = [["x", "0"], ["x + 2*cos(a)", "2*sin(a)"]]
points.corner = ["0", "0.6"]
)toml");
  // At rest about the lower end: the weight's moment cos(a) over the corner's distance 1.
  REQUIRE(forces.count("step") == 1);
  REQUIRE(forces.at("step").size() == 1);
  check_force(forces.at("step")[0], {0, 0.6, -0.6 * 0.8, 0.8 * 0.8});
}
