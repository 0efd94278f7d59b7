#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "cli/drawing/gnuplot.hpp"
#include "tests/cli/program.hpp"
#include "tests/cli/svg_text.hpp"

using namespace tests;

namespace {

/// A body that lies on a table which shakes it.
std::string shaken_body(const std::string& e, const std::string& t, const std::string& A) {
  return "[system]\ncoordinates = [\"y\"]\nkinetic = \"m/2*y'^2\"\npotential = \"m*g*y\"\n"
         "parameters = { m = 3, g = 9.81, w = 10, A = " +
         A + " }\nconstraints = { table = \"y >= A*sin(w*t)\" }\n[simulate]\nrestitution = " + e +
         "\n[state]\nt = " + t + "\nposition = { y = \"A*sin(w*t)\" }\nvelocity = { y = \"A*w*cos(w*t)\" }\n";
}

/// A flat follower on an eccentric cam, pressed by a spring; the file's t is a whole turn at 0.
const char* const follower =
    "[system]\ncoordinates = [\"y\"]\nkinetic = \"m/2*y'^2\"\npotential = \"m*g*y + k/2*y^2 + P*y\"\n"
    "parameters = { m = 0.4, k = 3000, P = 30, g = 9.81, e = 0.008, w = 120 }\n"
    "constraints = { cam = \"y >= e*(1 - cos(w*t))\" }\n[simulate]\nrestitution = 0.2\n"
    "[state]\nposition = { y = 0 }\n";

/// The cells of the rows of a branch that have an event, and how many rows follow the first of them.
struct Opening {
  std::vector<std::string> values;
  int rows_behind = 0;
};

Opening openings(const std::string& text, const std::string& over, int code = 0) {
  const Folder folder;
  const Outcome outcome = run({"orbit", folder.write("o.toml", text), "--period", "2*pi/w", "--over", over});
  CAPTURE(outcome.err);
  CHECK(outcome.code == code);
  std::istringstream table(outcome.out);
  Opening found;
  for (std::string line; std::getline(table, line);) {
    if (line.find(",opening,") != std::string::npos)
      found.values.push_back(line.substr(0, line.find(',')));
    else if (!found.values.empty())
      ++found.rows_behind;
  }
  return found;
}

}  // namespace

TEST_CASE(
    "a contact that is held opens on a branch where its multiplier comes to 0, and the branch goes on") {
  for (const char* e : {"0", "0.5"})
    for (const bool up : {true, false}) {
      CAPTURE(e);
      const Opening found = up ? openings(shaken_body(e, "0.3", "0.08"), "A=0.08:0.01:0.14")
                               : openings(shaken_body(e, "0", "0.14"), "A=0.14:-0.01:0.08");
      REQUIRE(found.values.size() == 1);
      CHECK(std::abs(std::stod(found.values[0]) - 0.0981) <= 1e-14);  // A w^2 = g
      CHECK(found.rows_behind == (up ? 5 : 2));
    }
  // At the top of the cam m e w^2 = m g + 2 k e + P.
  const double w = std::sqrt((0.4 * 9.81 + 2 * 3000 * 0.008 + 30) / (0.4 * 0.008));
  const Opening near = openings(follower, "w=158:1:162");
  REQUIRE(near.values.size() == 1);
  CHECK(std::abs(std::stod(near.values[0]) - w) <= 1e-11);
  CHECK(near.rows_behind == 2);
}

TEST_CASE("a velocity that is rounding beside how far the orbit goes is drawn at 0") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = folder.write("o.toml", follower), picture = folder.path("o.svg");
  REQUIRE(run({"orbit", file, "--period", "2*pi/w", "--over", "w=120:5:140", "--plot", picture}).code == 0);
  std::stringstream svg;
  svg << std::ifstream(picture).rdbuf();
  int halves = 0;
  for (const SvgText& text : svg_texts(svg.str())) {
    CAPTURE(text.text);
    CHECK(text.text.find("x10") == std::string::npos);  // no power of ten at an axis
    halves += text.text == "-0.5";
  }
  CHECK(halves == 2);  // y and y' from -1 to 1
}
