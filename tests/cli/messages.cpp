#include <doctest/doctest.h>

#include "tests/cli/program.hpp"

using namespace tests;

/// What a user reads; mistakes.txt holds what is read after a mistake.
namespace {

std::string with_line(int line, const std::string& text) { return point_on_floor({{line, text}}); }
std::string floor_as(const std::string& relation) { return with_line(9, "floor = \"" + relation + "\""); }

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

TEST_CASE("where no function is near those that there are are listed, and not the parameters") {
  const Outcome outcome = run_on("solve", floor_as("y >= wibble(x)"));
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("\"wibble\" is no function; the functions are sin, cos, tan, ") !=
        std::string::npos);
  CHECK(outcome.err.find(" m, g") == std::string::npos);  // parameters are no functions
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

TEST_CASE("a family of coordinates whose range runs backwards is refused, an empty one is not") {
  const auto family = [](const std::string& n) {
    return "[system]\ncoordinates = [\"y\", \"x[1..N]\"]\nkinetic = \"y'^2 + sum(i in 1..N, "
           "x[i]'^2)\"\n[system.parameters]\nN = " +
           n + "\n[state]\nposition = { y = 0, \"x[i]\" = 0 }\n";
  };
  const Outcome outcome = run_on("solve", family("-3"));
  CHECK(outcome.code == 2);
  CHECK(
      outcome.err.ends_with("the range 1..-3 runs backwards; give its end a value from 0 (no member) on\n"));
  CHECK(run_on("solve", family("2")).code == 0);
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

TEST_CASE("a number is no rounding of others that nothing couples to it") {
  const std::string beside = point_on_floor({{4, "potential = \"-1e16*x + 9.81*y\""}, {8, ""}, {9, ""}});
  CHECK(run_on("solve", beside).out.find("-4.905") != std::string::npos);
  // 1/3 and 4/3 where A is definite by 1e-33, so that the norm of A sees next to nothing of them.
  const std::string nearly = two_rows(
      {{2,
        R"(A = [["1","1"],["1","1000000000000000000000000000000001/1000000000000000000000000000000000"]])"},
       {3, R"(z = ["-13/3","-833333333333333333333333333333333/250000000000000000000000000000000"])"},
       {4, R"(U = [["1","0"],["1","1"]])"},
       {5, R"(s = ["1/3","5/3"])"}});
  const std::string text = run_on("solve", nearly).out;
  CHECK(text.find("0.333333") != std::string::npos);
  CHECK(text.find("1.33333") != std::string::npos);
}

TEST_CASE("a coordinate is an angle where sums of coordinates are turned, and a length is none") {
  const auto told = [](const std::string& kinetic, const std::string& potential,
                       const std::string& floor = "y >= -9") {
    const Outcome outcome = run_on("solve", point_on_floor({{3, "kinetic = \"" + kinetic + "\""},
                                                            {4, "potential = \"" + potential + "\""},
                                                            {6, "m = 2.0\nal = 0.5"},
                                                            {9, "floor = \"" + floor + "\""},
                                                            {11, "position = { x = 60, y = 0.0 }"}}));
    return outcome.err.find("the angle \"x\", which stands at 60, counts in radians") != std::string::npos;
  };
  const std::string turning = "m/2*y'^2 + m*x'^2", sliding = "m/2*(x'^2 + y'^2)";
  CHECK(told(turning, "cos(x + al)"));
  CHECK(told(turning, "cos(al - x + 2*t)"));
  CHECK(told("m/2*y'^2 + m*(2*sin(x))'^2 + m*(2*cos(x))'^2", "m*g*sin(x)"));
  CHECK(told(turning, "cos(x)", "y - 9*sin(x) >= 0"));  // penetrated: this may be why
  // A length: of a product the sine, or outside of sines, or as heavy as another length.
  CHECK_FALSE(told(turning, "sin(al*x)"));
  CHECK_FALSE(told(turning, "sin(x) + m*g*x"));
  CHECK_FALSE(told(turning, "sin(x)", "x >= -1"));
  CHECK_FALSE(told(sliding, "m*g*y", "y - sin(x) >= -2"));
}

TEST_CASE("a plain number beyond a turn in a sine is told as radians, and one that is computed is not") {
  const auto sliding = [](const std::string& angle) {
    return point_on_floor({{4, "potential = \"m*g*y + sin(a)*x\""}, {6, "m = 2.0\na = " + angle}});
  };
  CHECK(run_on("solve", sliding("30")).err.find("the angle \"a\" = 30 counts in radians; ") !=
        std::string::npos);
  CHECK(run_on("solve", sliding("-45")).err.find("radians") != std::string::npos);
  for (const char* angle : {"\"30*pi/180\"", "6", "0.5", "\"10*pi\""})
    CHECK(run_on("solve", sliding(angle)).err.empty());
  // So does a coordinate that is an angle.
  const auto standing_at = [](const std::string& x) {
    return point_on_floor({{3, "kinetic = \"m/2*y'^2 + m/4*x'^2\""},
                           {4, "potential = \"m*g*y + sin(x) + cos(x)\""},
                           {11, "position = { x = " + x + ", y = 0.0 }"}});
  };
  for (const char* command : {"solve", "derive", "simulate"}) {
    const Outcome told = run_on(command, standing_at("60") + "[simulate]\nuntil = 0.1\n");
    const std::string words =
        ": line 4: the angle \"x\", which stands at 60, counts in radians; where degrees are meant, "
        "give its position as \"60*pi/180\"\n";
    CAPTURE(told.err);
    CHECK(told.err.ends_with(words));
    CHECK(told.err.find(words) == told.err.rfind(words));  // once, of both functions
  }
  for (const char* x : {"\"60*pi/180\"", "6", "59.5"}) CHECK(run_on("solve", standing_at(x)).err.empty());
  const Folder folder;
  const std::string file = folder.write("a.toml", sliding("30"));
  const std::vector<std::string> ways[] = {{"explain", file},
                                           {"derive", file},
                                           {"check", file},
                                           {"sweep", file, "--over", "m=1,2"},
                                           {"simulate", file, "--until", "0.1"},
                                           {"orbit", file, "--period", "1"}};
  for (const auto& way : ways) {
    CAPTURE(way.front());
    CHECK(run(way).err ==
          "moreau: warning: " + file +
              ": line 4: the angle \"a\" = 30 counts in radians; where degrees are meant, write "
              "a*pi/180\n");
  }
  CHECK(run({"sweep", folder.write("b.toml", sliding("0")), "--over", "a=0:15:30"}).err.find("\"a\" = 30") !=
        std::string::npos);
}
