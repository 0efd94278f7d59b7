#include <doctest/doctest.h>

#include "tests/cli/program.hpp"

using namespace tests;

/// What a user reads after a mistake: each row is a command with its mistake and the words that help.
namespace {

/// `arguments`, with "FILE" for a file of these bytes; the whole message behind the place.
struct Mistake {
  std::vector<std::string> arguments;
  std::string bytes;
  std::string message;
};

std::string with_line(int line, const std::string& text) { return point_on_floor({{line, text}}); }
std::string floor_as(const std::string& relation) { return with_line(9, "floor = \"" + relation + "\""); }

void expect_message(const Mistake& mistake) {
  const Folder folder;
  std::vector<std::string> arguments = mistake.arguments;
  const std::string file = folder.write("problem.toml", mistake.bytes);
  for (std::string& argument : arguments)
    if (argument == "FILE") argument = file;
  const Outcome outcome = run(arguments);
  std::string line = outcome.err.substr(0, outcome.err.find('\n'));
  CAPTURE(outcome.err);
  CAPTURE(mistake.message);
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(line.starts_with("moreau: "));
  CHECK(line.ends_with(mistake.message));
  CHECK(outcome.err.find("\"\"") == std::string::npos);  // no empty guess
}

void expect_messages(const std::vector<Mistake>& table) {
  for (const Mistake& mistake : table) expect_message(mistake);
}

const std::vector<std::string> solve_file{"solve", "FILE"};

std::vector<std::string> prox_of(const std::string& f) { return {"prox", f, "--at", "[1, 2]"}; }

/// The commands of `moreau --help`.
std::vector<std::string> commands_of_help() {
  const std::string help = run({"--help"}).out;
  std::vector<std::string> found;
  for (std::size_t at = help.find("Subcommands:"); (at = help.find("\n  ", at)) != std::string::npos;) {
    at += 3;
    const std::string name = help.substr(at, help.find(' ', at) - at);
    if (!name.empty()) found.push_back(name);
  }
  return found;
}

}  // namespace

TEST_CASE("a word of a textbook for a key finds the key, and nothing is guessed where nothing is near") {
  expect_messages({
      {solve_file, with_line(4, "V = \"m*g*y\""),
       "unknown key \"V\" in [system]; did you mean \"potential\"?"},
      {solve_file, with_line(3, "T = \"m/2*x'^2\""),
       "unknown key \"T\" in [system]; did you mean \"kinetic\"?"},
      {solve_file, with_line(2, "q = [\"x\", \"y\"]"),
       "unknown key \"q\" in [system]; did you mean \"coordinates\"?"},
      {solve_file, with_line(12, "v0 = { x = 0.0 }"),
       "unknown key \"v0\" in [state]; did you mean \"velocity\"?"},
      {solve_file, with_line(14, "tol = 1e-9"),
       "unknown key \"tol\" in [solve]; did you mean \"tolerance\"?"},
      {solve_file, with_line(14, "xyzzy = 1"),
       "unknown key \"xyzzy\" in [solve]; known are method, tolerance, contact_tolerance"},
      {solve_file, two_rows({{2, "M = [[2, 0], [0, 1]]"}}),
       "unknown key \"M\" in [projection]; did you mean \"A\"?"},
  });
}

TEST_CASE("a function that expressions do not have is said in the way that they have") {
  expect_messages({
      {solve_file, floor_as("y >= pow(x, 2)"),
       "constraint floor: \"pow\" is no function; write x^p for pow(x, p)"},
      {solve_file, floor_as("y >= arctan(x)"), "constraint floor: \"arctan\" is no function; write atan(x)"},
      {solve_file, floor_as("y >= sine(x)"),
       "constraint floor: \"sine\" is no function; did you mean \"sin\"?"},
      {solve_file, floor_as("y >= log10(x)"),
       "constraint floor: \"log10\" is no function; write log(x)/log(10)"},
  });
  const Outcome outcome = run_on("solve", floor_as("y >= wibble(x)"));
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("\"wibble\" is no function; the functions are sin, cos, tan, ") !=
        std::string::npos);
  CHECK(outcome.err.find(" m, g") == std::string::npos);  // parameters are no functions
}

TEST_CASE("an expression without its quotation marks is told so") {
  expect_messages({
      {solve_file, with_line(9, "floor = y >= 0"),
       "not a TOML value: y >= 0; put it in quotation marks, \"y >= 0\""},
      {solve_file, with_line(6, "m = 2*3"), "not a TOML value: 2*3; put it in quotation marks, \"2*3\""},
      {solve_file, with_line(4, "potential = m*g*y  # weight"),
       "not a TOML value: m*g*y; put it in quotation marks, \"m*g*y\""},
      {solve_file, with_line(11, "position = { x = 0.0, y = 2*pi }"),
       "not a TOML value: 2*pi; put it in quotation marks, \"2*pi\""},
      {solve_file, with_line(2, "coordinates = [x, y]"),
       "not a TOML value: x; put it in quotation marks, \"x\""},
  });
}

TEST_CASE("options, commands and methods are known by their slips") {
  expect_messages({
      {{"solve", "--jsn", "FILE"}, point_on_floor(), "solve has no option --jsn; did you mean --json?"},
      {{"solve", "--xyzzy", "FILE"},
       point_on_floor(),
       "solve has no option --xyzzy; see `moreau solve --help`"},
      {{"check", "--catalog"}, "", "check has no option --catalog; did you mean --catalogue?"},
      {{"slove", "FILE"}, "", "unknown command \"slove\"; did you mean \"solve\"?"},
      {{"methods", "extra"}, "", "\"extra\" is more than methods takes; see `moreau methods --help`"},
      {{"solve", "--method", "actve-set", "FILE"},
       point_on_floor(),
       "unknown method \"actve-set\"; did you mean \"active-set\"?"},
      {{"solve", "--method", "xyzzy", "FILE"},
       point_on_floor(),
       "unknown method \"xyzzy\"; `moreau methods` lists them"},
      {{"gallery", "wel-posed"},
       "",
       "there is no family \"wel-posed\" in the gallery; did you mean \"well-posed\"?"},
      {{"stress", "--method", "lemkee"},
       "",
       "--method lemkee: there is no such method; did you mean \"lemke\"?"},
  });
}

TEST_CASE("every command names an option that it does not have") {
  const std::vector<std::string> all = commands_of_help();
  CHECK(all.size() >= 12);
  for (const std::string& command : all) {
    const Outcome outcome = run({command, "--no-such-thing"});
    CAPTURE(command);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find(command) != std::string::npos);
    CHECK(outcome.err.find("; see `moreau " + command + " --help`") != std::string::npos);
  }
}

TEST_CASE("a function of the catalogue is found by the name that other programs give it") {
  expect_messages({
      {prox_of("l1()"), "", "there is no set, function or operation \"l1\"; here it is norm1()"},
      {prox_of("lasso()"), "", "there is no set, function or operation \"lasso\"; here it is norm1()"},
      {prox_of("nrm1()"), "",
       "there is no set, function or operation \"nrm1\"; did you mean \"norm1\"? `moreau functions` lists "
       "them"},
      {prox_of("xyzzyq()"), "",
       "there is no set, function or operation \"xyzzyq\"; `moreau functions` lists them"},
      {{"functions", "qqqqqqqqq"},
       "",
       "there is no set, function or operation \"qqqqqqqqq\"; `moreau functions` lists them"},
      {prox_of("norm1(x)"), "",
       "f: \"x\": functions are written without their variable; give numbers, vectors, matrices or other "
       "functions, or nothing, as in norm1()"},
      {prox_of("l0()"), "",
       "\"l0\" is not convex; use norm1(), which is the largest convex function below it on the cube"},
      {prox_of("norm1(wieght=2)"), "",
       "norm1: there is no argument \"wieght\"; its one argument is \"weight\""},
  });
}

TEST_CASE("a family of coordinates whose range runs backwards is refused, an empty one is not") {
  const auto family = [](const std::string& n) {
    return "[system]\ncoordinates = [\"y\", \"x[1..N]\"]\nkinetic = \"y'^2 + sum(i in 1..N, "
           "x[i]'^2)\"\n[system.parameters]\nN = " +
           n + "\n[state]\nposition = { y = 0, \"x[i]\" = 0 }\n";
  };
  expect_message({solve_file, family("-3"),
                  "the range 1..-3 runs backwards; give its end a value from 0 (no member) on"});
  CHECK(run_on("solve", family("2")).code == 0);
}

TEST_CASE("an impending impact names the command that follows it") {
  expect_message({solve_file, with_line(12, "velocity = { y = -1.0 }"),
                  "constraint floor: an impact is due, f = 0 and df/dt = -1 < 0; give the velocity after the "
                  "impact, or let `moreau simulate` handle it"});
}

TEST_CASE(
    "a picture of several files, of a plane that there is not, or in a format that there is not, is "
    "refused") {
  expect_messages({
      {{"solve", "FILE", "FILE", "--plot", "a.svg"},
       point_on_floor(),
       "--plot takes one problem file; run the files one by one"},
      {{"solve", "FILE", "--plot", "a.gif"},
       point_on_floor(),
       "a.gif: a picture is named .svg, .png or .pdf; give such a name"},
      {{"solve", "FILE", "--plane", "x,y"},
       point_on_floor(),
       "--plane goes with --plot; give a picture to draw it in"},
      {{"solve", "FILE", "--plot", "a.svg", "--plane", "x,w"},
       point_on_floor(),
       "--plane: no coordinate \"w\"; known are x, y"},
      {{"explain", "--html", "--latex", "FILE"},
       point_on_floor(),
       "--markdown, --latex and --html are three ways to write; give one of them"},
  });
}

TEST_CASE("what is set, swept or assembled by a name that there is not is told the names that there are") {
  expect_messages({
      {{"explain", "FILE", "--set", "mm"}, point_on_floor(), "no key and value; write --set \"m=3\""},
      {{"check", "--quiet", "FILE", "--plot", "a.svg"},
       point_on_floor(),
       "check has no option --plot; see `moreau check --help`"},
  });
}

TEST_CASE("a long list says how many more there are") {
  std::string constraints;
  for (int k = 0; k < 12; ++k) constraints += "far" + std::to_string(k) + " = \"y >= -1\"\n";
  const Folder folder;
  const std::string file = folder.write("problem.toml", with_line(9, constraints));
  CHECK(run({"solve", "--verbose", file}).out.find("far7 (apart, f = 1) and 4 more.") != std::string::npos);
}

TEST_CASE("a method is named as what solved it only when it ran") {
  const Folder folder;
  const std::string text = folder.write("free.toml", point_on_floor({{8, ""}, {9, ""}}));
  CHECK(run({"solve", "--verbose", text}).out.find("active-set") == std::string::npos);
}

TEST_CASE("a number that is 0 to rounding is printed as 0") {
  // f = 0.1 + 0.2 - 0.3 is 5.6e-17 in doubles.
  const std::string text = point_on_floor({{9, "floor = \"y + 0.1 + 0.2 - 0.3 >= 0\""}});
  const Folder folder;
  const std::string file = folder.write("problem.toml", text);
  for (const char* command : {"solve", "explain", "check"}) {
    const Outcome outcome = run({command, file});
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find("5.55") == std::string::npos);
  }
  // The number itself stays in the JSON.
  CHECK(run({"solve", "--json", file}).out.find("5.55") != std::string::npos);
}
