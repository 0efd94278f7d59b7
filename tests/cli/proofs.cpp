#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using Json = nlohmann::json;
using tests::Folder;
using tests::Outcome;
using tests::run;

namespace {

/// Two coordinates held by two rows that meet at (1/3, 1/7), the second twice.
constexpr const char* thirds = R"([projection]
A = [["1/3", 0], [0, "1/7"]]
z = [-1, -1]
U = [[3, 0], [0, "0.7"], [0, 7]]
s = [1, "0.1", 1]
)";

/// Rows that contradict each other by less than doubles can tell from rounding.
constexpr const char* contradiction = R"([projection]
A = [[1]]
z = [0]
U = [[3], [-1]]
s = [1, "-0.33333333333333333333"]
)";

Json solved(const std::vector<std::string>& options, const char* bytes, int code) {
  const Folder folder;
  std::vector<std::string> arguments{"solve", "--json", folder.write("problem.toml", bytes)};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run(arguments);
  CHECK(outcome.code == code);
  return Json::parse(outcome.out);
}

}  // namespace

TEST_CASE("--method exact gives fractions of the numbers as written") {
  const Json answer = solved({"--method", "exact"}, thirds, 0);
  CHECK(answer.at("status") == "solved");
  CHECK(answer.at("method") == "exact");
  const Json& exact = answer.at("exact");
  CHECK(exact.at("acceleration") == Json{{"q[0]", "1/3"}, {"q[1]", "1/7"}});
  CHECK(exact.at("reaction") == Json{{"q[0]", "10/9"}, {"q[1]", "50/49"}});
  // The second row and the third, ten times it, share the reaction; of least norm in proportion 1 : 10.
  CHECK(exact.at("multipliers") == Json{{"c[0]", "10/27"}, {"c[1]", "500/34643"}, {"c[2]", "5000/34643"}});
  CHECK(answer.at("multipliers_unique") == false);
  CHECK(answer.at("certificate").at("level") == "exact");
}

TEST_CASE("--null-space gives what multipliers may be changed by, in doubles and in fractions") {
  const Json answer = solved({"--method", "exact", "--null-space"}, thirds, 0);
  // Either row may be the one that is given in terms of the other.
  const Json exact = answer.at("exact").at("null_space"), doubles = answer.at("null_space");
  const bool second = exact == Json::array({{{"c[1]", "1"}, {"c[2]", "-1/10"}}}) &&
                      doubles == Json::array({{{"c[1]", 1}, {"c[2]", -0.1}}});
  const bool third = exact == Json::array({{{"c[1]", "-10"}, {"c[2]", "1"}}}) &&
                     doubles == Json::array({{{"c[1]", -10}, {"c[2]", 1}}});
  CHECK((second || third));
  const Json near = solved({"--null-space"}, thirds, 0);
  REQUIRE(near.at("null_space").size() == 1);
  const Json& mu = near.at("null_space")[0];
  CHECK(0.7 * mu.at("c[1]").get<double>() + 7 * mu.at("c[2]").get<double>() == doctest::Approx(0));
  CHECK_FALSE(solved({}, thirds, 0).contains("null_space"));
}

TEST_CASE("--certify proves a bound, in doubles where signs are strict and else in fractions") {
  const Json answer = solved({"--certify"}, thirds, 0);
  CHECK(answer.at("certificate").at("level") == "exact");
  CHECK(answer.at("certificate").at("error_bound").get<double>() < 1e-16);
}

TEST_CASE("a contradiction below rounding is proved with whole weights") {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--method", "exact"}, std::vector<std::string>{"--certify"}}) {
    const Json answer = solved(options, contradiction, 1);
    CHECK(answer.at("status") == "infeasible");
    CHECK(answer.at("farkas") == Json{{"c[0]", 1}, {"c[1]", 3}});
    CHECK(answer.at("exact").at("farkas") == Json{{"c[0]", "1"}, {"c[1]", "3"}});
  }
}

TEST_CASE("a mechanism is proved from its text: decimals as written, no answer made by rounding alone") {
  // A point on a plane y = x/3, given twice in ways that doubles round apart; gravity 9.81 is 981/100.
  constexpr const char* planes = R"toml([system]
coordinates = ["x", "y"]
kinetic = "m/2*(x'^2 + y'^2)"
potential = "m*g*y"
[system.parameters]
m = 0.3
g = 9.81
[system.constraints]
plane = "y - x/3 >= 0"
again = "(y - x/3)*t >= 0"
[state]
t = 0.7
position = { x = "3/7", y = "1/7" }
velocity = { x = 3, y = 1 }
)toml";
  const Json answer = solved({"--certify"}, planes, 0);
  const Json& text = answer.at("from_text");
  CHECK(text.at("contacts_hold") == true);
  // Down the slope: g sin a cos a and g sin² a with tan a = 1/3.
  CHECK(text.at("acceleration") == Json{{"x", "-2943/1000"}, {"y", "-981/1000"}});
  CHECK(answer.at("certificate").at("level") != "none");
  CHECK(answer.at("certificate").at("error_bound") >= text.at("error_bound"));
  CHECK(text.at("contacts") == Json{{"plane", "touches"}, {"again", "touches"}});
}

TEST_CASE(
    "a mechanism whose text is not rational is enclosed from its text, contacts that balls cannot tell are "
    "not") {
  // A pendulum of mass and length 1: a'' = -sin a, no contact; the rods at equal heights may or may not
  // touch.
  constexpr const char* pendulum = R"toml([system]
coordinates = ["a"]
kinetic = "a'^2/2"
potential = "-cos(a)"
[system.constraints]
stop = "a >= 0"
rest = "sin(2*a) <= 2*sin(0.5)*cos(0.5)"
[state]
position = { a = 0.5 }
)toml";
  const Json answer = solved({"--certify"}, pendulum, 0);
  const Json& text = answer.at("from_text");
  CHECK(text.at("contacts") == Json{{"stop", "apart"}, {"rest", "undecided"}});
  CHECK(text.at("contacts_hold") == false);
  CHECK(answer.at("certificate").at("level") == "enclosure");
  // sin(1/2) to 30 digits (Abramowitz and Stegun 1964, table 4.6, has 23 of them).
  CHECK(text.at("acceleration").at("a") == "-4.79425538604203000273287935216e-1");
  CHECK(text.at("error_bound").get<double>() <= 1e-16);
  CHECK(text.at("radius").get<double>() <= 1e-29);
}

TEST_CASE("a contradiction among irrational bounds is proved when the rows are fractions") {
  // Two walls close in on a block, one faster than the other retreats.
  constexpr const char* walls = R"toml([system]
coordinates = ["x"]
kinetic = "x'^2/2"
[system.constraints]
left = "x >= sqrt(2)*t^2"
right = "x <= t^2"
[state]
position = { x = 0 }
)toml";
  const Json answer = solved({"--certify"}, walls, 1);
  CHECK(answer.at("status") == "infeasible");
  CHECK(answer.at("from_text").at("farkas") == Json{{"left", "1"}, {"right", "1"}});
  CHECK(answer.at("from_text").at("contacts_hold") == true);
}

TEST_CASE(
    "nothing is proved where the gradient of a one-sided contact vanishes, for second derivatives do not "
    "tell") {
  const Folder folder;
  for (const char* f : {"y^3 >= 0", "y^3 >= x^2", "y^2 >= x^2 + x^3"}) {
    CAPTURE(f);
    const std::string file = folder.write(
        "p.toml", std::string("[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
                              "potential = \"9.81*y\"\n[system.constraints]\nc = \"") +
                      f + "\"\n[state]\nposition = { x = 0, y = 0 }\n");
    const Outcome outcome = run({"solve", "--certify", "--json", file});
    CHECK(outcome.code == 3);
    const Json answer = Json::parse(outcome.out);
    CHECK(answer["certificate"]["level"] == "none");
    CHECK(answer["from_text"]["vanishing"] == Json::array({"c"}));
  }
}

TEST_CASE("a gradient that is 0 at a right angle is 0, though it is 6e-17 in doubles") {
  const auto answers = [](const char* wall, const char* angle, double force) {
    const Folder folder;
    const std::string file = folder.write(
        "p.toml",
        std::string("[system]\ncoordinates = [\"a\"]\nkinetic = \"a'^2/2\"\n[system.forces]\na = ") +
            std::to_string(force) + "\n[system.constraints]\nw = \"" + wall +
            "\"\n[state]\nposition = { a = \"" + angle + "\" }\n");
    return std::pair{run({"solve", "--json", file}), run({"solve", "--certify", "--json", file})};
  };
  // Never below 0: it asks for nothing.
  for (const double force : {1.0, -1.0})
    for (const auto& [wall, angle] :
         {std::pair{"sin(a) <= 1", "pi/2"}, {"cos(a) >= -1", "pi"}, {"sin(a) >= -1", "3*pi/2"}}) {
      CAPTURE(wall);
      const auto [plain, certified] = answers(wall, angle, force);
      CHECK(plain.code == 0);
      CHECK(Json::parse(plain.out)["acceleration"]["a"] == force);
      CHECK(certified.code == 3);
      CHECK(Json::parse(certified.out)["certificate"]["level"] == "none");
      CHECK(Json::parse(certified.out)["from_text"]["vanishing"] == Json::array({"w"}));
    }
  // 0 at most: it holds at rest alone, and second derivatives do not tell.
  const auto [plain, certified] = answers("1 - sin(a) <= 0", "pi/2", -1);
  CHECK(plain.code == 3);
  CHECK(certified.code == 3);
  CHECK(Json::parse(certified.out)["certificate"]["level"] == "none");
}

TEST_CASE("what fractions decide in a plain answer, they prove in a certified one of the same size") {
  constexpr int n = 300;  // n (n + m) beyond what is tried in fractions for a proof alone
  std::string A, z = "\"1/3\"", U = "1";
  for (int i = 0; i < n; ++i) A += i == 0 ? "1" : ", 1";
  for (int i = 1; i < n; ++i) {
    z += ", -1";
    U += i == 1 ? ", -1" : ", 0";
  }
  const Folder folder;
  const std::string file = folder.write("p.toml", "[projection]\nA = { diagonal = [" + A + "] }\nz = [" + z +
                                                      "]\nU = [[" + U + "]]\ns = [2]\n");
  CHECK(run({"solve", file}).code == 0);
  const Json proved = Json::parse(run({"solve", "--certify", "--json", file}).out);
  CHECK(proved.at("status") == "solved");
  CHECK(proved.at("certificate").at("level") == "exact");
  CHECK(run({"solve", "--certify", file}).out.find("proved in fractions") != std::string::npos);
  // Without fractions nothing is proved, and no more is claimed than without --certify.
  const Json plain = Json::parse(run({"solve", "--limit", "0", "--json", file}).out),
             tried = Json::parse(run({"solve", "--limit", "0", "--certify", "--json", file}).out);
  CHECK(tried.at("status") == plain.at("status"));
  CHECK(tried.at("certificate").at("error_bound") == plain.at("certificate").at("error_bound"));
}
