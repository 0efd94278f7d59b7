#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> paragraphs(const std::string& text) {
  std::vector<std::string> found;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find("\n\n", at), text.size());
    if (end > at) found.push_back(text.substr(at, end - at));
    at = end + 2;
  }
  return found;
}

std::vector<std::string> naming(const std::string& text, const std::string& name) {
  std::vector<std::string> found = paragraphs(text);
  std::erase_if(found,
                [&](const std::string& paragraph) { return paragraph.find(name) == std::string::npos; });
  return found;
}

/// A point that is pushed against a wall while it lies on a floor.
std::string pushed_against(const std::string& wall) {
  return point_on_floor({{8, "[system.forces]\nx = -4\n[system.constraints]"},
                         {9, "floor = \"y >= 0\"\nwall = \"" + wall + "\""}});
}

std::vector<std::string> problem_library() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(tests::source_folder() + "docs/problems"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

std::string explained_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("of two scenes that differ in one contact every paragraph that names it differs") {
  const std::vector<std::string> walls{"x >= 0",         "2*x >= 0",     "x >= -1",
                                       "x + 0.1*y >= 0", "x >= 0.5*t^2", "x = 0"};
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j) {
      const auto one = naming(run_on("explain", pushed_against(walls[i])).out, "wall"),
                 other = naming(run_on("explain", pushed_against(walls[j])).out, "wall");
      CHECK_FALSE(one.empty());
      CHECK_FALSE(other.empty());
      for (const std::string& paragraph : one) {
        CAPTURE(paragraph);
        CHECK(std::find(other.begin(), other.end(), paragraph) == other.end());
      }
    }
}

TEST_CASE("an explanation names each contact, its multiplier and the terms of z") {
  const std::string text = run_on("explain", pushed_against("x >= 0")).out;
  for (const char* said :
       {"T = m/2*(x'^2 + y'^2)", "V = m*g*y", "Q_x = -4", "wall, x >= 0: f = 0, df/dt = 0. It is in K",
        "lambda_wall = 4", "lambda_floor = 19.62", "x''^2 + y''^2 + 4 x'' + 19.62 y''"}) {
    CAPTURE(said);
    CHECK(text.find(said) != std::string::npos);
  }
  CHECK(text.find("y             0   -19.62            0              0   -19.62") != std::string::npos);
}

TEST_CASE(
    "an explanation tells the parameters and definitions that it speaks of, and each member's own text") {
  const std::string text = run_on("explain", R"toml(
[system]
coordinates = ["x[1..3]"]
kinetic = "sum(i in 1..3, m/2*x[i]'^2)"
[system.parameters]
m = "2*d"
d = 1.5
[system.definitions]
"middle[i in 1..3]" = "i*d + shift"
shift = "0.25*t"
[system.constraints]
"apart[i in 2..3]" = "x[i] - x[i-1] >= d"
[state]
position = { "x[i]" = "i*d" }
)toml")
                               .out;
  for (const char* said :
       {"m               3", "d             1.5", "m = 2*d", "middle[i] = i*d + shift, i in 1..3",
        "shift = 0.25*t", "apart[2], x[2] - x[1] >= d: f = 0", "apart[3], x[3] - x[2] >= d: f = 0"}) {
    CAPTURE(said);
    CHECK(text.find(said) != std::string::npos);
  }
}

TEST_CASE("of nine names the ninth is told, not that there is one more, and rounding of a gradient is 0") {
  const std::string text = run_on("explain", R"toml(
[system]
coordinates = ["y[1..9]", "a"]
kinetic = "sum(i in 1..9, y[i]'^2/2) + a'^2/2"
potential = "sum(i in 1..9, y[i])"
[system.constraints]
"floor[i in 1..9]" = "y[i] >= 0"
turned = "y[1]*cos(pi/2) + a >= 0"
[state]
position = { "y[i]" = 0, a = 0 }
)toml")
                               .out;
  CHECK(text.find("1 more") == std::string::npos);
  CHECK(text.find("e-17") == std::string::npos);
}

TEST_CASE(
    "the parts of z are those of a rotating frame: centrifugal force from its turning, Coriolis force from "
    "velocities") {
  // A point at (2, 0) with velocity (0, 3) in a frame that turns with 5: centrifugal 5² 2, Coriolis 2 5 3.
  const std::string text =
      run_on("explain",
             "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"1/2*((x' - 5*y)^2 + (y' + 5*x)^2)\"\n"
             "[state]\nposition = { x = 2, y = 0 }\nvelocity = { y = 3 }\n")
          .out;
  CHECK(text.find("x            0        0           30             50   80") != std::string::npos);
  CHECK(text.find("y            0    3   13") != std::string::npos);  // p = y' + 5 x
}

TEST_CASE("every problem of the library is explained in every form, with the exit code of its solution") {
  const Folder folder;
  for (const std::string& file : problem_library()) {
    CAPTURE(file);
    const int code = run({"solve", "--quiet", file}).code;
    for (const char* form : {"", "--markdown", "--latex", "--html"}) {
      std::vector<std::string> arguments{"explain", file};
      if (*form != '\0') arguments.emplace_back(form);
      const Outcome outcome = run(arguments);
      CHECK(outcome.code == code);
      CHECK_FALSE(outcome.out.empty());
    }
  }
}

TEST_CASE("the derivative of parentheses can be read in LaTeX") {
  const Folder folder;
  const std::string file =
      folder.write("a.toml",
                   "[system]\ncoordinates = [\"a\"]\nkinetic = \"((2*sin(a))'^2 + (3*cos(a))'*a')/2\"\n"
                   "[state]\nposition = { a = 0.1 }\n");
  const std::string text = run({"explain", "--latex", file}).out;
  CHECK(text.find("\\Bigl(\\frac{\\mathrm{d}}{\\mathrm{d}t}(2 \\, \\sin(a))\\Bigr)^{2}") !=
        std::string::npos);
  CHECK(text.find(" + \\frac{\\mathrm{d}}{\\mathrm{d}t}(3 \\, \\cos(a)) \\, \\dot{a}") != std::string::npos);
}

TEST_CASE("columns of a decomposition are columns in every form") {
  const Folder folder;
  const std::string file = folder.write("a.toml", "[decomposition]\nf = \"norm1()\"\nz = [3, 1, -2]\n");
  CHECK(run({"explain", file}).out.find("\n  [0]    3              2              1\n") != std::string::npos);
  CHECK(run({"explain", "--markdown", file}).out.find("\n| [0] | 3 | 2 | 1 |\n") != std::string::npos);
  CHECK(run({"explain", "--latex", file}).out.find("\n{[}0] & 3 & 2 & 1 \\\\\n") != std::string::npos);
  CHECK(run({"explain", "--html", file}).out.find("<td>2</td><td>1</td></tr>") != std::string::npos);
}

TEST_CASE("the HTML file asks nothing of a network, and the LaTeX file is whole") {
  const Folder folder;
  for (const std::string& file : problem_library()) {
    CAPTURE(file);
    const std::string html = run({"explain", "--html", file}).out;
    for (const char* fetched : {"http", "src=", "href=", "@import", "url("})
      CHECK(html.find(fetched) == std::string::npos);
    CHECK(html.ends_with("</html>\n"));
    const std::string latex = folder.path("a.tex");
    run({"explain", "--latex", "-o", latex, file});
    const std::string text = explained_bytes(latex);
    CHECK(std::count(text.begin(), text.end(), '{') == std::count(text.begin(), text.end(), '}'));
    CHECK(text.ends_with("\\end{document}\n"));
  }
}

TEST_CASE("explain writes in the form that an option asks for, else in that of the file's ending") {
  const Folder folder;
  const std::string file = folder.write("a.toml", point_on_floor());
  const auto written = [&](const std::string& name, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"explain", file, "-o", folder.path(name)});
    CHECK(run(more).code == 0);
    return explained_bytes(folder.path(name));
  };
  for (const auto& [ending, option] :
       {std::pair(".html", "--html"), {".tex", "--latex"}, {".md", "--markdown"}}) {
    CHECK(written(std::string("b") + ending) == run({"explain", file, option}).out);
    CHECK(written(std::string("c") + ending, {"--markdown"}) == run({"explain", file, "--markdown"}).out);
  }
  CHECK(written("d.txt") == run({"explain", file}).out);
}

TEST_CASE("explain says in words which equation an added row is") {
  const std::vector<std::string> told =
      naming(run_on("explain", pushing_at_dead_centre()).out, "Added row 1");
  REQUIRE(told.size() == 1);
  CHECK(told.front().find("24 a'' and -24") != std::string::npos);
  CHECK(told.front().find("held with equality") != std::string::npos);
}

TEST_CASE("an explanation tells the accuracy in the words of solve") {
  for (const std::string floor : {"y >= 0", "y >= sin(x) - x"}) {
    const std::string file = point_on_floor({{9, "floor = \"" + floor + "\""}});
    const std::string solved = run_on("solve", file).out;
    const std::size_t at = solved.find("Solved: ");
    REQUIRE(at != std::string::npos);
    const std::string accuracy = solved.substr(at, solved.find('\n', at) - at);
    std::string told = run_on("explain", file).out;
    std::replace(told.begin(), told.end(), '\n', ' ');  // of its lines
    CAPTURE(accuracy);
    CHECK(told.find(accuracy) != std::string::npos);
  }
}

TEST_CASE("a free motion is at the distance 0 of the point nearest to it, and rounding is printed as 0") {
  // sin(pi) is rounding, and beside it x is accelerated.
  const std::string text =
      run_on("explain",
             point_on_floor({{4, "potential = \"-5*x + sin(pi)*y\""}, {11, "position = { x = 0, y = 1 }"}}))
          .out;
  CHECK(text.find("at the distance 0;") != std::string::npos);
  CHECK(text.find("= (2.5, 0)") != std::string::npos);
}

TEST_CASE("the rows of a cone stand below their title, in every form") {
  const std::string cone = "[cone]\ngenerators = [[1, 0], [1, 1]]\n";
  CHECK(run_on("explain", cone).out.find("generators\n  g[0]") != std::string::npos);
  const Folder folder;
  const std::string marked = run({"explain", "--markdown", folder.write("c.toml", cone)}).out;
  CHECK(marked.find("| generators |  |  |\n| --- | ---: | ---: |\n| g[0] | 1 | 0 |\n| g[1] | 1 | 1 |") !=
        std::string::npos);
}

TEST_SUITE("pdflatex") {
  TEST_CASE("the LaTeX file of each problem compiles, and no line of it leaves the page") {
    const Folder folder;
    for (const std::string& file : problem_library()) {
      CAPTURE(file);
      const std::string latex = folder.path("a.tex");
      run({"explain", "--latex", "-o", latex, file});
      CHECK(std::system(("cd " + fs::path(latex).parent_path().string() +
                         " && pdflatex -interaction=nonstopmode -halt-on-error a.tex > /dev/null 2>&1")
                            .c_str()) == 0);
      CHECK(explained_bytes(folder.path("a.log")).find("Overfull") == std::string::npos);
    }
  }
}
