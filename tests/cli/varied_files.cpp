#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

/// One question asked in many ways: --set, sweep, assemble, convert and the forms of derive.
namespace {

/// A block of mass 2 on a floor, pulled up by P and sideways by P/2: it lifts at P = 2 g.
const char* const pulled_block =
    "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"m/2*(x'^2 + y'^2)\"\npotential = \"m*g*y\"\n"
    "[system.parameters]\nm = 2\ng = 9.81\nP = 1\n[system.forces]\ny = \"P\"\nx = \"P/2\"\n"
    "[system.constraints]\nfloor = \"y >= 0\"\n[state]\nposition = { x = 0, y = 0 }\n";

std::string file_contents(const std::string& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::vector<std::string>> table_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

Json solved(const Folder& folder, const std::string& text, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"solve", "--json", folder.write("a.toml", text)});
  return Json::parse(run(arguments).out);
}

}  // namespace

TEST_CASE("what is set on the command line is solved as if the file said it") {
  const Folder folder;
  const Json set = solved(folder, pulled_block, {"--set", "P=30", "--set", "m=1", "--set", "velocity.x=3"});
  CHECK(set.at("acceleration").at("y") == doctest::Approx(30 - 9.81));
  CHECK(set.at("acceleration").at("x") == 15);
  CHECK(solved(folder, pulled_block, {"--set", "g=4*m"}).at("multipliers").at("floor") == 15);
  CHECK(solved(folder, pulled_block, {"--set", "solve.method=exact"}).at("method") == "exact");
  CHECK(
      solved(folder, two_rows(), {"--set", "z=[0, 5]", "--set", "A[0][0]=8"}).at("acceleration").at("q[1]") ==
      5);
}

TEST_CASE("a setting that the file has no place for is refused") {
  const Folder folder;
  const std::string file = folder.write("a.toml", pulled_block);
  for (const auto& [setting, message] :
       std::vector<std::pair<std::string, std::string>>{{"p=1", "did you mean \"P\"?"},
                                                        {"x=1", "position.x"},
                                                        {"P", "no key and value"},
                                                        {"solve.x=1", "unknown key"}}) {
    const Outcome outcome = run({"solve", file, "--set", setting});
    CAPTURE(setting);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find(message) != std::string::npos);
  }
}

TEST_CASE("a sweep has a row for each value and one where the block lifts") {
  const Folder folder;
  const Outcome outcome = run({"sweep", folder.write("a.toml", pulled_block), "--over", "P=0:2.5:30"});
  CHECK(outcome.code == 0);
  const auto rows = table_of(outcome.out);
  CHECK(rows.front() == std::vector<std::string>{"P", "status", "active", "change", "x''", "y''",
                                                 "lambda[floor]", "error_bound"});
  REQUIRE(rows.size() == 1 + 13 + 1);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double P = std::stod(rows[k][0]);
    CHECK(std::stod(rows[k][5]) == doctest::Approx(std::max(0.0, P / 2 - 9.81)));
    CHECK(std::stod(rows[k][6]) == doctest::Approx(std::max(0.0, 19.62 - P)));
    CHECK((rows[k][3] == "1") == (std::abs(P - 19.62) <= 30e-12));
    CHECK((rows[k][2] == "floor") == (P <= 19.62 + 1e-9));
  }
}

TEST_CASE(
    "several ranges make a grid, the last one running fastest, and a point without an answer is a row") {
  const Folder folder;
  const Outcome grid = run({"sweep", folder.write("a.toml", pulled_block), "--over", "P=0,40", "--over",
                            "m=1,0", "--watch", "y''"});
  CHECK(grid.code == 2);
  const auto rows = table_of(grid.out);
  REQUIRE(rows.size() == 5);
  CHECK(rows[0] == std::vector<std::string>{"P", "m", "status", "active", "y''", "error_bound"});
  CHECK(rows[1][4] == "0");
  CHECK(rows[2][2] == "error");
  CHECK(std::stod(rows[3][4]) == doctest::Approx(40 - 9.81));
}

TEST_CASE("a sweep finds the changes between a point with an answer and one without") {
  // Between a floor that rises with P and a lid at rest x'' is in [P, 0]: none for P > 0. Free it is 1 + 4P,
  // so that the floor persists up to P = -1/3 and the lid from P = -1/4 on.
  const Folder folder;
  const std::string file = folder.write(
      "a.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.parameters]\nP = "
      "-1.0\n[system.forces]\n"
      "x = \"1 + 4*P\"\n[system.constraints]\nfloor = \"x >= P/2*t^2\"\nlid = \"-x >= 0\"\n[state]\nposition "
      "= { x = 0.0 }\n");
  for (const char* over : {"P=-0.9:0.5:0.6", "P=0.6:-0.5:-0.9"}) {
    CAPTURE(over);
    const Json swept = Json::parse(run({"sweep", "--json", file, "--over", over}).out);
    std::vector<double> changes;
    for (const auto& change : swept.at("changes")) changes.push_back(change.at("value"));
    std::sort(changes.begin(), changes.end());
    REQUIRE(changes.size() == 2);
    CHECK(std::abs(changes[0] + 1.0 / 3) <= 1.5e-12);
    CHECK(std::abs(changes[1] + 0.25) <= 1.5e-12);
  }
}

TEST_CASE("a sweep that was cut off goes on to the same table") {
  const Folder folder;
  const std::string file = folder.write("a.toml", pulled_block), whole = folder.path("whole.csv");
  run({"sweep", file, "--over", "P=0:2.5:30", "--output", whole});
  const std::string all = file_contents(whole);
  for (const std::size_t kept : {all.size() / 4, all.size() / 2, all.size() - 60}) {
    const std::string part = folder.write("part.csv", all.substr(0, kept));
    CHECK(run({"sweep", file, "--over", "P=0:2.5:30", "--output", part, "--resume"}).code == 0);
    CHECK(file_contents(part) == all);
  }
}

TEST_CASE("what assemble writes solves with the contacts asked for") {
  const Folder folder;
  const std::string file = folder.write(
      "ladder.toml",
      "[system]\ncoordinates = [\"x\", \"y\", \"th\"]\nkinetic = \"2*(x'^2 + y'^2) + 100/24*th'^2\"\n"
      "[system.constraints]\nfloor = \"y - 2.5*sin(th) >= 0\"\nwall = \"x - 2.5*cos(th) >= 0\"\n"
      "[state]\nposition = { x = 1.8, y = 2.2, th = 0.9 }\n");
  for (const char* name : {"out.toml", "out.json"}) {  // in the form of the name
    const std::string out = folder.path(name);
    const Outcome found =
        run({"assemble", file, "--contact", "floor", "--contact", "wall", "-o", out, "--json"});
    CHECK(found.code == 0);
    const Json state = Json::parse(found.out);
    const double th = state.at("position").at("th");
    CHECK(double(state.at("position").at("x")) == doctest::Approx(2.5 * std::cos(th)).epsilon(1e-14));
    const Json constraints = Json::parse(run({"solve", "--json", out}).out).at("constraints");
    CHECK(constraints.at("floor").at("state") != "inactive");
    CHECK(constraints.at("wall").at("state") != "inactive");
  }
  const Outcome unknown = run({"assemble", file, "--contact", "flor"});
  CHECK(unknown.code == 2);
  CHECK(unknown.err.find("floor") != std::string::npos);
}

TEST_CASE("contacts that the state declares are assembled before it is solved") {
  const Folder folder;
  const std::string text =
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
      "[system.constraints]\nstring = \"x^2 + y^2 <= 25\"\n"
      "[state]\nposition = { x = 3.3, y = 4.4 }\nvelocity = { x = 1 }\nin_contact = [\"string\"]\n";
  const Outcome outcome = run({"solve", "--json", folder.write("a.toml", text)});
  CHECK(outcome.code == 0);
  // The nearest velocity is (1, 0) less its part along (0.6, 0.8): (0.64, -0.48); v²/r of it holds the
  // string.
  CHECK(double(Json::parse(outcome.out).at("acceleration").at("x")) == doctest::Approx(-0.64 / 5 * 0.6));
  CHECK(outcome.err.find("position moved by 0.5") != std::string::npos);
  // What is left off the velocity is its part along (0.6, 0.8).
  CHECK(outcome.err.find("velocity changed by 0.6") != std::string::npos);
}

TEST_CASE("a projection that goes through every form comes back with the same answer") {
  const Folder folder;
  const std::string text =
      "[projection]\nA = [[4, 1, 0], [1, 3, -0.5], [0, -0.5, 2]]\nz = [1, -6.25, 0.5]\n"
      "U = [[0, 1, 0], [1, 1, 1], [1, -1, 0], [0, 0, -1]]\ns = [-0.5, 0.25, 0.125, -3]\ntwo_sided = [1]\n";
  std::string from = folder.write("a.toml", text);
  const Json expected = Json::parse(run({"solve", "--json", from}).out).at("acceleration");
  for (const char* name : {"b.qps", "c.json", "d.mtx", "e.qps", "f.toml"}) {
    const std::string to = folder.path(name);
    REQUIRE(run({"convert", from, to}).code == 0);
    const Json found = Json::parse(run({"solve", "--json", to}).out).at("acceleration");
    for (const auto& [coordinate, value] : expected.items())
      CHECK(double(found.at(coordinate)) == doctest::Approx(double(value)).epsilon(1e-14));
    from = to;
  }
}

TEST_CASE("a quadratic program is read with its ranges, bounds and default signs") {
  const Folder folder;
  const std::string file =
      folder.write("a.qps",
                   "NAME T\nROWS\n N o\n G g\n L l\n E e\nCOLUMNS\n a o 1 g 1\n a l 1\n b o -8 g 1\n"
                   " b e 1\n c e -1\n c l 1\nRHS\n rhs g 1 l 4\nRANGES\n rng g 2\nBOUNDS\n UP bnd b 3\n"
                   " MI bnd c\nQUADOBJ\n a a 2\n b b 2\n c c 2\nENDATA\n");
  // Least a² + a + b² - 8b + c² with 1 <= a + b <= 3, a + c <= 4, b = c, a >= 0, 0 <= b <= 3: at a = 0, b = c
  // = 2.
  const Json answer = Json::parse(run({"solve", "--json", file}).out).at("acceleration");
  CHECK(double(answer.at("q[0]")) == doctest::Approx(0).scale(1));
  CHECK(double(answer.at("q[1]")) == doctest::Approx(2));
  CHECK(double(answer.at("q[2]")) == doctest::Approx(2));
}

TEST_CASE("what a form cannot hold is named") {
  const Folder folder;
  const std::string file = folder.write("a.toml", pulled_block);
  for (const auto& [to, name] : std::vector<std::pair<std::string, std::string>>{
           {"b.qps", "[system]"}, {"b.mtx", "[system]"}, {"b.txt", ".toml"}}) {
    const Outcome outcome = run({"convert", file, folder.path(to)});
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find(name) != std::string::npos);
  }
  CHECK(run({"convert", file, folder.path("b.json")}).code == 0);
  CHECK(run({"solve", "--quiet", folder.path("b.json")}).code == 0);
}

TEST_CASE("a word of JSON or Python that stands for no number is refused with its key") {
  const Folder folder;
  for (const std::string word : {"null", "NaN", "-Infinity"}) {
    CAPTURE(word);
    const std::string file = folder.write("a.json", R"({"projection": {"A": [[1]], "z": [)" + word + "]}}");
    const auto refused = run({"solve", file});
    CHECK(refused.code == 2);
    CHECK(refused.err.find("a.json:1:35: z: " + word + " is no value here; give") != std::string::npos);
  }
}

TEST_CASE("the function in C computes what derive prints") {
  if (std::system("cc --version > /dev/null 2>&1") != 0) return;
  const Folder folder;
  const std::string file =
      folder.write("2 arms.toml",
                   "[system]\ncoordinates = [\"a\", \"b\"]\nkinetic = \"l*a'^2 + a'*b'*cos(a - b)*t + (2 + "
                   "max(a, b))*b'^2\"\n"
                   "potential = \"if(a < 0, log(-a), a^3) + abs(b)^2.5\"\n[system.parameters]\nl = \"7/3\"\n"
                   "[system.forces]\nb = \"-tanh(b')*hypot(a, b)\"\n[system.constraints]\nstop = \"sin(a*b) "
                   "+ t >= sin(0.3) + 1.5\"\n"
                   "[state]\nt = 1.5\nposition = { a = 0.5, b = 0.6 }\nvelocity = { a = 0.25, b = "
                   "\"-1/cos(0.3)/0.5 - 0.3\" }\n");
  const Json derived = Json::parse(run({"derive", "--json", file}).out);
  const std::string code = run({"derive", "--c", file}).out;
  REQUIRE(code.find("void _2_arms(") != std::string::npos);
  folder.write("f.c", code);
  folder.write(
      "main.c",
      "#include <stdio.h>\n#include \"f.c\"\nint main(void) {\n  double q[2] = {0.5, 0.6}, v[2], A[4], z[2], "
      "U[2], s[1];\n"
      "  int i;\n  v[0] = 0.25;\n  v[1] = -1/cos(0.3)/0.5 - 0.3;\n  _2_arms(q, v, 1.5, A, z, U, s);\n"
      "  for (i = 0; i < 4; i++) printf(\"%.17g \", A[i]);\n  for (i = 0; i < 2; i++) printf(\"%.17g \", "
      "z[i]);\n"
      "  for (i = 0; i < 2; i++) printf(\"%.17g \", U[i]);\n  printf(\"%.17g\\n\", s[0]);\n  return 0;\n}\n");
  const std::string out = folder.path("out");
  REQUIRE(std::system(("cd '" + folder.path("") +
                       "' && cc -std=c99 -pedantic-errors -Wall -Werror main.c -o main -lm && ./main > '" +
                       out + "'")
                          .c_str()) == 0);
  std::istringstream numbers(file_contents(out));
  const auto next = [&] {
    double x = 0;
    numbers >> x;
    return doctest::Approx(x).epsilon(1e-14);
  };
  for (const auto& row : derived.at("A"))
    for (const auto& entry : row) CHECK(double(entry) == next());
  for (const auto& [name, entry] : derived.at("z").items()) CHECK(double(entry) == next());
  REQUIRE(derived.at("U").contains("stop"));
  for (const auto& [name, entry] : derived.at("U").at("stop").items()) CHECK(double(entry) == next());
  CHECK(double(derived.at("s").at("stop")) == next());
}

TEST_CASE("a bound is proved for a state with contacts by declaration, and covers the exact answer") {
  // A mass on a string, moved onto the circle along its ray: at (31, -41)/sqrt(2642) * 5 it hangs at rest,
  // and x'' = -g sin cos, y'' = -g sin^2, sin the horizontal part of the ray.
  const std::string text =
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"9.81*y\"\n"
      "[system.constraints]\nstring = \"x^2 + y^2 <= 25\"\n[state]\nposition = { x = 3.1, y = -4.1 }\n"
      "in_contact = [\"string\"]\n";
  const Folder folder;
  const Outcome outcome = run({"solve", "--certify", "--json", folder.write("problem.toml", text)});
  CHECK(outcome.code == 0);
  const Json found = Json::parse(outcome.out);
  CHECK(found["certificate"]["level"] == "enclosure");
  const double bound = found["certificate"]["error_bound"], length = std::sqrt(3.1 * 3.1 + 4.1 * 4.1);
  CHECK(bound <= 1e-12);
  const double sine = 3.1 / length, cosine = 4.1 / length;
  const double off = std::hypot(found["acceleration"]["x"].get<double>() + 9.81 * sine * cosine,
                                found["acceleration"]["y"].get<double>() + 9.81 * sine * sine);
  CHECK(off <= bound + 4e-15);
  // Without the declaration the digits that were found would not be on the circle.
  CHECK(run({"solve", "--certify", folder.write("typed.toml", R"([system]
coordinates = ["x", "y"]
kinetic = "(x'^2 + y'^2)/2"
potential = "9.81*y"
[system.constraints]
string = "x^2 + y^2 <= 25"
[state]
position = { x = 3.0155487, y = -3.98830635 }
[solve]
contact_tolerance = 1e-3
)")})
            .code == 3);
}

TEST_CASE("a QPS file in fixed columns is read where its names have blanks") {
  // minimise 1/2 (2 x^2 + 2 y^2) - 2 x - 5 y over x + 2 y <= 2, x, y >= 0: by Lagrange's rule
  // 2x - 2 = -l, 2y - 5 = -2l, x + 2y = 2: l = 1.6, x = 0.2, y = 0.9.
  const std::string text =
      "NAME          two plants\n"
      "ROWS\n"
      " N  the cost\n"
      " L  row 1\n"
      "COLUMNS\n"
      "    plant A   the cost           -2.   row 1               1.\n"
      "    plant B   the cost           -5.   row 1               2.\n"
      "RHS\n"
      "    rhs       row 1               2.\n"
      "QUADOBJ\n"
      "    plant A   plant A             2.\n"
      "    plant B   plant B             2.\n"
      "ENDATA\n";
  const Folder folder;
  const Outcome outcome = run({"solve", "--json", folder.write("plants.qps", text)});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  const Json found = Json::parse(outcome.out)["acceleration"];
  CHECK(found["q[0]"].get<double>() == doctest::Approx(0.2).epsilon(1e-13));
  CHECK(found["q[1]"].get<double>() == doctest::Approx(0.9).epsilon(1e-13));
}
