#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "cli/drawing/drawn_range.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "tests/cli/program.hpp"
#include "tests/cli/svg_text.hpp"

using namespace tests;

namespace {

/// One push p on so many pistons, of which one after the other is pressed against its stop.
std::string pushed_pistons(int count, const std::string& stop = "stop") {
  std::string coordinates, kinetic, potential, constraints, position;
  for (int i = 1; i <= count; ++i) {
    const std::string y = "y" + std::to_string(i), comma = i > 1 ? ", " : "", plus = i > 1 ? " + " : "";
    coordinates += comma + '"' + y + '"';
    kinetic += plus + "m*" + y + "'^2/2";
    potential += plus + "(p - " + std::to_string(i) + "/" + std::to_string(count) + ")*" + y;
    constraints += stop + std::to_string(i) + " = \"" + y + " >= 0\"\n";
    position += comma + y + " = 1";
  }
  return "title = \"pistons\"\n[system]\ncoordinates = [" + coordinates + "]\nkinetic = \"" + kinetic +
         "\"\npotential = \"" + potential + "\"\n[system.parameters]\np = 2\nm = 1\n[system.constraints]\n" +
         constraints + "[state]\nposition = { " + position + " }\n[simulate]\nuntil = 8\nrestitution = 0.5\n";
}

std::string at_the_stops(std::string file) {
  return std::regex_replace(file, std::regex(R"re((y\d+ =) 1)re"), "$1 0");
}

std::string drawn(std::vector<std::string> arguments, const std::string& picture) {
  arguments.insert(arguments.end(), {"--quiet", "--plot", picture});
  const Outcome outcome = run(arguments);
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
  std::stringstream svg;
  svg << std::ifstream(picture).rdbuf();
  return svg.str();
}

std::size_t times(const std::vector<SvgText>& texts, const std::string& words) {
  return static_cast<std::size_t>(
      std::count_if(texts.begin(), texts.end(), [&](const SvgText& t) { return t.text == words; }));
}

/// Where the arrows of a colour begin and end, "x,y" each: their shafts come last in a path. The key is not
/// among them, which is beside the map.
std::vector<std::pair<std::string, std::string>> arrows_of(const std::string& colour,
                                                           const std::string& svg) {
  constexpr double map_ends = 525;
  std::vector<std::pair<std::string, std::string>> found;
  const std::regex shaft("<path +stroke='" + colour + "' *d='[^']*M([-0-9.,]+) +L([-0-9.,]+) *'");
  for (std::sregex_iterator it(svg.begin(), svg.end(), shaft), end; it != end; ++it)
    if (std::stod((*it)[1]) <= map_ends) found.emplace_back((*it)[1], (*it)[2]);
  return found;
}

}  // namespace

TEST_CASE("keys of many lines stand whole beside the curves, and say how many curves are not drawn") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string moving = folder.write("a.toml", pushed_pistons(12)),
                    resting = folder.write("b.toml", at_the_stops(pushed_pistons(12))),
                    picture = folder.path("a.svg");
  const std::string sweep = drawn({"sweep", resting, "--over", "p=-0.2:0.05:1.3"}, picture),
                    motion = drawn({"simulate", moving}, picture);
  for (const std::string& svg : {sweep, motion}) {
    check_legible(svg);
    const std::vector<SvgText> texts = svg_texts(svg);
    CHECK(times(texts, "and 4 more, not drawn") >= 2);
    for (const SvgText& text : texts)
      if (text.text.find("stop") != std::string::npos || text.text.find("y8") != std::string::npos)
        CHECK(text.left >= 500);  // where the diagrams end
  }
  for (const char* name : {"y1''", "y8''", "lambda[stop8]", "no contact", "stop1, stop2", "all 12 contacts"})
    CHECK(times(svg_texts(sweep), name) == 1);
  for (const char* name : {"y1", "y8", "impact", "accumulation"}) CHECK(times(svg_texts(motion), name) == 1);
}

TEST_CASE("a few events of a motion are lines, many are marks above the diagrams") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const auto lines_across = [&](const std::string& until) {
    const std::string svg = drawn({"simulate", folder.write("a.toml", pushed_pistons(2)), "--until", until},
                                  folder.path("a.svg"));
    check_legible(svg);
    CHECK(times(svg_texts(svg), "impact") == 1);
    const std::regex line("M([-0-9.]+),([-0-9.]+) +L([-0-9.]+),([-0-9.]+)");
    std::size_t count = 0;
    for (std::sregex_iterator it(svg.begin(), svg.end(), line), end; it != end; ++it)
      if ((*it)[1] == (*it)[3] && std::abs(std::stod((*it)[4]) - std::stod((*it)[2])) >= 150) ++count;
    return count;
  };
  CHECK(lines_across("1.5") >= lines_across("8") + 4);  // in each of four diagrams
}

TEST_CASE("what is pressed for less time than the points of a picture are apart is drawn as high as it is") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  // The ball comes to rest on a table that throws it again, 200 times: 1201 points miss most of the rests.
  const std::string svg =
      drawn({"simulate",
             folder.write("a.toml",
                          "[system]\ncoordinates = [\"y\"]\nkinetic = \"m/2*y'^2\"\npotential = "
                          "\"m*g*y\"\nparameters = { m = 0.2, g = 9.81, A = 0.003, w = \"40*pi\" }\n"
                          "constraints = { table = \"y >= A*sin(w*t)\" }\n[state]\nposition = { y = 0 "
                          "}\nvelocity = { y = \"A*w\" }\n[simulate]\nuntil = 20\nrestitution = 0.2\n")},
            folder.path("a.svg"));
  CHECK(times(svg_texts(svg), "12") == 1);  // m (g + A w^2) = 11.4 at the axis of lambda
}

TEST_CASE("sets of contacts whose long names begin alike are told apart in a sweep and on its map") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = folder.write("a.toml", at_the_stops(pushed_pistons(6, "a_long_name_of_a_stop_")));
  for (const std::vector<std::string>& over : {std::vector<std::string>{"--over", "p=-0.25:0.1:1.15"},
                                               {"--over", "p=-0.25:0.1:1.15", "--over", "m=1,2"}}) {
    std::vector<std::string> arguments{"sweep", file};
    arguments.insert(arguments.end(), over.begin(), over.end());
    const std::string svg = drawn(arguments, folder.path("a.svg"));
    std::set<std::string> sets;
    for (const SvgText& text : svg_texts(svg)) {
      const bool is_set = text.text.rfind("a_long_name", 0) == 0 || text.text.rfind("all ", 0) == 0;
      if (is_set || text.text == "no contact") CHECK(sets.insert(text.text).second);
    }
    CHECK(sets.size() >= 7);  // none, the first, the first two, …
  }
}

TEST_CASE("a long title is cut to what the page holds") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string title(70, 'W'),
      picture = folder.path("a.svg"),
      file = folder.write(
          "a.toml", "title = \"" + title + " " + title + "\"\n" + at_the_stops(pushed_pistons(2)).substr(18));
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"solve", file},
                                                    {"atlas", file},
                                                    {"simulate", file},
                                                    {"sweep", file, "--over", "p=1,2"},
                                                    {"sweep", file, "--over", "p=1,2", "--over", "m=1,2"}}) {
    CAPTURE(arguments[0]);
    const std::string svg = drawn(arguments, picture);
    check_legible(svg);
    for (const SvgText& text : svg_texts(svg))
      if (text.text.rfind("WWW", 0) == 0) CHECK(text.text.find("…") != std::string::npos);
  }
}

TEST_CASE("the arrows of an atlas begin where their force is, also where they leave the map") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = tests::source_folder() + "docs/problems/delassus_drops_too_much.toml";
  for (const char* range : {"=-6:6", "=0:6"}) {
    const std::string svg = drawn(
        {"atlas", file, "--over", std::string("force.y") + range, "--over", std::string("force.a") + range},
        folder.path("a.svg"));
    check_legible(svg);
    const auto free = arrows_of("rgb\\(213,  94,   0\\)", svg),
               truth = arrows_of("rgb\\(  0, 114, 178\\)", svg);
    REQUIRE(free.size() >= 2);
    std::set<std::string> tips, begins;
    for (const auto& arrows : {free, truth})
      for (const auto& [from, to] : arrows) {
        CHECK(tips.insert(to).second);
        begins.insert(from);
      }
    for (const std::string& tip : tips) CHECK(begins.count(tip) == 0);
    for (const auto& [from, to] : truth)
      CHECK(std::any_of(free.begin(), free.end(),
                        [&, at = from](const auto& arrow) { return arrow.first == at; }));
  }
}

TEST_CASE("numbers at an axis are told apart, and have one notation") {
  if (!cli::has_gnuplot()) return;
  CHECK(cli::tic_format("y", {0, 30}) == "set format y\n");
  const Folder folder;
  const std::string file = folder.write("a.toml", at_the_stops(pushed_pistons(2)));
  for (const char* over : {"p=1000000:0.25:1000001", "p=0:100000:1000000", "p=100000000,100000001"}) {
    CAPTURE(over);
    const std::vector<SvgText> texts =
        svg_texts(drawn({"sweep", file, "--over", over}, folder.path("a.svg")));
    std::set<std::string> below, beside;
    for (const SvgText& text : texts) {
      if (text.text.find_first_not_of("-.0123456789") != std::string::npos) continue;
      const bool is_beside = text.right <= 84;
      CHECK((is_beside ? beside : below)
                .insert(text.text + (is_beside && text.top < 220 ? " above" : ""))
                .second);
    }
    CHECK(below.size() >= 2);
    CHECK(std::none_of(texts.begin(), texts.end(), [](const SvgText& text) {
      return text.text.find("×") != std::string::npos || text.text.find("x10") != std::string::npos;
    }));
  }
}

TEST_CASE("a sweep of one value is drawn as marks") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = folder.write("a.toml", at_the_stops(pushed_pistons(2)));
  const std::string svg = drawn({"sweep", file, "--over", "p=0.75"}, folder.path("a.svg"));
  for (const char* name : {"y1''", "lambda[stop2]"}) CHECK(times(svg_texts(svg), name) == 1);
  // gnuplot's marks: those of the key and those of the values.
  std::size_t marks = 0;
  for (std::size_t at = 0; (at = svg.find("<use xlink:href='#gpPt", at)) != std::string::npos; ++at) ++marks;
  CHECK(marks >= 8);
}

TEST_CASE("the largest regions of an atlas have fills and names of their own, and the others one together") {
  if (!cli::has_gnuplot()) return;
  constexpr int sides = 20;
  std::string U, s;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    U += (k > 0 ? ", [" : "[") + std::to_string(std::cos(angle)) + ", " + std::to_string(std::sin(angle)) +
         "]";
    s += k > 0 ? ", -1" : "-1";
  }
  const Folder folder;
  const std::string file = folder.write(
      "a.toml", "[projection]\nA = [[2, 0.5], [0.5, 1]]\nz = [9, 4]\nU = [" + U + "]\ns = [" + s + "]\n");
  const std::string svg = drawn({"atlas", file}, folder.path("a.svg"));
  check_legible(svg);
  std::set<std::string> named;
  for (const SvgText& text : svg_texts(svg))
    if (text.text.rfind("c[", 0) == 0 || text.text == "no contact") CHECK(named.insert(text.text).second);
  CHECK(named.size() >= 26);
  CHECK(times(svg_texts(svg), "14 smaller regions") == 1);
}

TEST_CASE("a sweep over two ranges draws the one number that is watched") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = folder.write("a.toml", point_on_floor({{1, "title = \"A point\"\n[system]"}}));
  const std::string svg = drawn({"sweep", file, "--over", "m=1:0.5:4", "--over", "g=-3:1:9", "--watch",
                                 "lambda[floor]", "--output", folder.path("a.csv")},
                                folder.path("a.svg"));
  CHECK(times(svg_texts(svg), "A point: lambda[floor]; lines: the contacts change") == 1);
}
