#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

using namespace tests;
using OrbitJson = nlohmann::json;

namespace {

/// x'' = -x - 0.1 x' + F cos(2.5 t) before a stop at 0, with an orbit of one impact near its state.
std::string stopped_oscillator(const std::string& x = "-0.1", const std::string& v = "0.3") {
  return "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n"
         "[system.parameters]\nF = 1\nw = 2.5\n[system.forces]\nx = \"F*cos(w*t) - 0.1*x'\"\n"
         "[system.constraints]\nstop = \"x <= 0\"\n[simulate]\nrestitution = 0.8\n[state]\nposition = { x "
         "= " +
         x + " }\nvelocity = { x = " + v + " }\n";
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) found.push_back(cell);
  return found;
}

}  // namespace

TEST_CASE("a row of a branch has the state from which its orbit is found again") {
  const Folder folder;
  const std::string file = folder.write("o.toml", stopped_oscillator()), csv = folder.path("b.csv");
  REQUIRE(run({"orbit", file, "--period", "2*pi/w", "--over", "w=2.5:0.1:2.8", "--output", csv}).code == 0);
  std::ifstream table(csv);
  std::string line;
  std::getline(table, line);
  CHECK(line == "w,period,stable,largest_multiplier,impacts,event,x,x'");
  int rows = 0;
  while (std::getline(table, line)) {
    const std::vector<std::string> row = cells(line);
    REQUIRE(row.size() == 8);
    const Outcome again = run({"orbit", "--json", file, "--period", "2*pi/w", "--set", "w=" + row[0], "--set",
                               "position.x=" + row[6], "--set", "velocity.x=" + row[7]});
    REQUIRE(again.code == 0);
    const OrbitJson orbit = OrbitJson::parse(again.out);
    CHECK(std::abs(orbit["position"]["x"].get<double>() - std::stod(row[6])) <= 1e-9);
    CHECK(std::abs(orbit["velocity"]["x"].get<double>() - std::stod(row[7])) <= 1e-9);
    CHECK(std::abs(orbit["period"].get<double>() - std::stod(row[1])) <= 1e-12);
    ++rows;
  }
  CHECK(rows >= 4);
}

TEST_CASE("a branch that does not begin says so, with the value that the state of the file belongs to") {
  // Friction holds the mass for low F: no orbit goes on there.
  const Folder folder;
  const std::string file = folder.write(
      "o.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n"
      "[system.parameters]\nF = 3\n[system.forces]\nx = \"F*cos(1.3*t) - 0.3*sign(x') - 0.1*x'\"\n"
      "[state]\nposition = { x = -4 }\nvelocity = { x = 0.5 }\n");
  const Outcome none = run({"orbit", file, "--period", "2*pi/1.3", "--over", "F=0.45:0.05:3.2"});
  CHECK(none.code == 3);
  for (const char* words :
       {"no branch begins: at F = 0.45", "which has F = 3", "--over F=3:0.05:3.2", "dry friction"})
    CHECK_MESSAGE(none.err.find(words) != std::string::npos, none.err);
  CHECK(none.err.find("branch ends") == std::string::npos);
}

TEST_CASE("what would not be written is refused, and so is a file that is called -") {
  const Folder folder;
  const std::string file = folder.write("o.toml", stopped_oscillator()), csv = folder.path("b.csv");
  const Outcome unwritten = run({"orbit", file, "--period", "2*pi/w", "--output", csv});
  CHECK(unwritten.code == 2);
  CHECK(unwritten.err.find("--over") != std::string::npos);
  for (const char* option : {"--events", "--output"}) {
    const Outcome dash = run({"simulate", file, "--until", "1", option, "-"});
    CHECK(dash.code == 2);
    CHECK(dash.err.find("standard output") != std::string::npos);
  }
}

TEST_CASE("a motion that does not go on has no acceleration in JSON, and a dash in the text") {
  const std::string block =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"2*x^2\"\n"
      "[system.forces]\nx = \"-0.5*sign(x')\"\n[state]\nposition = { x = 1.1 }\n[simulate]\nuntil = 10\n";
  const Folder folder;
  const std::string file = folder.write("b.toml", block);
  const Outcome json = run({"simulate", "--json", file});
  CHECK(json.code == 3);
  CHECK(OrbitJson::parse(json.out)["acceleration"].is_null());
  CHECK(OrbitJson::parse(json.out)["multipliers"].is_null());
  const Outcome text = run({"simulate", file});
  CHECK(text.out.find(" -\n") != std::string::npos);
  CHECK(text.out.find("kink") == std::string::npos);  // no contact has one
  const Outcome steps = run({"simulate", file, "--method", "time-stepping"});
  CHECK(steps.code == 3);
  CHECK(steps.out.find("dry friction") != std::string::npos);
}

TEST_CASE("where Moreau's law leaves the impulses open, those of least norm are shown, and it is said") {
  // Onto y >= 0, x + y >= 0 and x >= 0 at once: P = (0.9, 1, 0.1) + s (1, -1, 1), the least norm at s = 0.
  const std::string corner =
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n[system.constraints]\n"
      "floor = \"y >= 0\"\nslope = \"x + y >= 0\"\nwall = \"x >= 0\"\n[state]\nposition = { x = 1, y = 1 }\n"
      "velocity = { x = -1, y = -1 }\n[simulate]\nuntil = 2\nrestitution = { floor = 0.9, slope = 0.5, wall "
      "= 0.1 "
      "}\n";
  const Folder folder;
  const std::string file = folder.write("c.toml", corner);
  const OrbitJson moreau =
      OrbitJson::parse(run({"simulate", "--json", "--impact-laws", file}).out)["laws"]["moreau"];
  CHECK(moreau["impulses_unique"] == false);
  for (const auto& [name, P] : {std::pair("floor", 0.9), std::pair("slope", 1.0), std::pair("wall", 0.1)})
    CHECK(std::abs(moreau["impulses"][name].get<double>() - P) <= 1e-12);
  CHECK(run({"simulate", "--impact-laws", file}).out.find("P is not") != std::string::npos);
  const OrbitJson one = OrbitJson::parse(run({"simulate", "--json", "--impact-laws",
                                              folder.write("s.toml", stopped_oscillator()), "--until", "9"})
                                             .out);
  CHECK(one["laws"]["moreau"]["impulses_unique"] == true);
}

TEST_CASE("where no law of impact has a velocity, their table says infeasible, as the motion does") {
  const Folder folder;
  const std::string file = folder.write(
      "d.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.constraints]\nwall = \"x <= 0\"\n"
      "drive = \"x = 2*t\"\n[state]\nposition = { x = 0 }\nvelocity = { x = 2 }\n[simulate]\nuntil = 1\n");
  for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--impact-laws"}}) {
    std::vector<std::string> asked{"simulate", "--json", file};
    asked.insert(asked.end(), options.begin(), options.end());
    const auto told = run(asked);
    CHECK(told.code == 1);
    CHECK(OrbitJson::parse(told.out)["status"] == "infeasible");
  }
}

TEST_CASE(
    "where a law leaves the impulses of redundant contacts open, those of least norm are shown, and it is "
    "said") {
  // One floor twice, the second time three times as steep: P + 3 P' is what v+ tells, and P' = 3 P is least.
  const std::string doubled =
      "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\n[system.constraints]\nfloor = \"y >= 0\"\n"
      "again = \"3*y >= 0\"\n[state]\nposition = { y = 1 }\nvelocity = { y = -1 }\n[simulate]\nuntil = 2\n"
      "restitution = 0.5\n";
  const Folder folder;
  const std::string file = folder.write("d.toml", doubled);
  const OrbitJson laws = OrbitJson::parse(run({"simulate", "--json", "--impact-laws", file}).out)["laws"];
  for (const char* law : {"moreau", "poisson", "sequential"}) {
    CAPTURE(law);
    CHECK(laws[law]["impulses_unique"] == false);
    CHECK(std::abs(laws[law]["velocity_after"]["y"].get<double>() - 0.5) <= 1e-14);
    CHECK(std::abs(laws[law]["impulses"]["floor"].get<double>() - 0.15) <= 1e-13);
    CHECK(std::abs(laws[law]["impulses"]["again"].get<double>() - 0.45) <= 1e-13);
  }
}

TEST_CASE("of too many forces a page draws the strongest, and counts the others") {
  // Discs side by side, each heavier than the one before: the arrows left out are the first ones.
  const Folder folder;
  const std::string file = folder.write(
      "d.toml",
      "[system]\ncoordinates = [\"y[1..450]\"]\nkinetic = \"sum(i in 1..450, i*y[i]'^2/2)\"\n"
      "potential = \"sum(i in 1..450, i*y[i])\"\n[system.constraints]\n\"floor[i in 1..450]\" = \"y[i] >= "
      "0\"\n"
      "[state]\nposition = { \"y[i]\" = 0 }\n[simulate]\nuntil = 0.01\nsamples = 2\nmethod = "
      "\"time-stepping\"\n"
      "[draw.circles]\n\"disc[i in 1..450]\" = { centre = [\"i\", \"y[i]\"], radius = \"0.4\" }\n");
  const std::string page_file = folder.path("d.html");
  const Outcome outcome = run({"simulate", file, "--animate", page_file});
  REQUIRE(outcome.code == 0);
  CHECK(outcome.out.find("410 more coordinates") != std::string::npos);
  std::ostringstream page;
  page << std::ifstream(page_file).rdbuf();
  const std::string text = page.str(), begin = "id=\"motion\">";
  const std::size_t from = text.find(begin) + begin.size();
  const OrbitJson data = OrbitJson::parse(text.substr(from, text.find("</script>", from) - from));
  const OrbitJson& frame = data["frames"].back();
  REQUIRE(frame["lambda"].size() == 450);
  CHECK(frame["arrows"].size() == 400);
  CHECK(frame["forces_left_out"] == 50);
  for (const OrbitJson& arrow : frame["arrows"]) CHECK(arrow[0].get<int>() >= 50);
}

TEST_CASE("a negative radius and an end before the beginning are told where they stand") {
  const Folder folder;
  const std::string file = folder.write("r.toml", stopped_oscillator() +
                                                      "[draw]\ncircles = { c = { centre = "
                                                      "[\"x\", 0], radius = -1 } }\n");
  const Outcome negative = run({"simulate", file, "--until", "1"});
  CHECK(negative.code == 2);
  CHECK(negative.err.find("draw.circles.c.radius: -1 is negative") != std::string::npos);
  const Outcome early =
      run({"simulate", folder.write("e.toml",
                                    "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n"
                                    "[state]\nposition = { x = 0 }\n[simulate]\nuntil = -3\n")});
  CHECK(early.code == 2);
  CHECK(early.err.find("e.toml:7:9") != std::string::npos);
}
