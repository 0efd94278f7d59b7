#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "convex/nearest_point/methods.hpp"
#include "tests/cli/program.hpp"

using Json = nlohmann::ordered_json;
using tests::Folder;
using tests::Outcome;
using tests::run;

TEST_CASE("every method takes rows that say the same, but for rounding, as dependent and consistent") {
  // Rods at irrational angles, each written twice: of two multipliers of one rod neither is known.
  const Folder folder;
  const std::string rods = folder.write(
      "rods.toml",
      "[system]\ncoordinates = [\"x1\", \"y1\", \"x2\", \"y2\"]\n"
      "kinetic = \"5*(x1'^2 + y1'^2) + 10.789*(x2'^2 + y2'^2)\"\npotential = \"98.1*y1 + 211.68*y2\"\n"
      "[system.forces]\nx1 = 2.92\n[system.constraints]\nrod = \"x1^2 + y1^2 = 1.199926^2\"\n"
      "twin = \"hypot(x1, y1) = 1.199926\"\nstring = \"((x2 - x1)^2 + (y2 - y1)^2)/0.6634 <= 0.3317/2\"\n"
      "[state.position]\nx1 = \"1.199926*sin(pi/4)\"\ny1 = \"-1.199926*cos(pi/4)\"\n"
      "x2 = \"x1 + 0.3317*sin(1)\"\ny2 = \"y1 - 0.3317*cos(1)\"\n[state.velocity]\n"
      "x2 = \"-0.07*0.3317*cos(1)\"\ny2 = \"-0.07*0.3317*sin(1)\"\n");
  // A curve written four times, with one-sided contacts on it.
  const std::string curve = folder.write(
      "curve.toml",
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"x'^2 + y'^2/2\"\npotential = \"9.81*y\"\n"
      "[system.parameters]\nl = 1.7\n[system.constraints]\nc0 = \"log(1 + (x*y - l)) >= 0\"\n"
      "c1 = \"(x*y - l)*(2 + cos(x*y)) = 0\"\nc2 = \"(x*y - l)*(1 + x^2) = 0\"\nc3 = \"exp(x*y - l) - 1 = "
      "0\"\n"
      "c4 = \"(x*y - l) + (x*y - l)^3 >= 0\"\n[state.position]\nx = 2.3\ny = \"l/2.3\"\n[state.velocity]\n"
      "x = 0.3\ny = \"-l/2.3^2*0.3\"\n");
  for (const std::string& file : {rods, curve}) {
    const Json usual = Json::parse(run({"solve", "--json", file}).out);
    REQUIRE(usual["status"] == "solved");
    CHECK(usual["multipliers_unique"] == false);
    for (const convex::Method& method : convex::methods()) {
      if (method.name == "drop-negative") continue;  // the rule that Delassus refuted
      CAPTURE(method.name);
      const Outcome outcome = run({"solve", "--json", "--method", std::string(method.name), file});
      CHECK(outcome.code == 0);
      const Json answer = Json::parse(outcome.out);
      for (const auto& [coordinate, number] : usual["acceleration"].items())
        CHECK(std::abs(answer["acceleration"][coordinate].get<double>() - number.get<double>()) <= 1e-8);
      // Infinite on the same sides.
      for (const auto& [name, range] : usual["multiplier_ranges"].items())
        for (const std::size_t side : {0, 1})
          CHECK(answer["multiplier_ranges"][name][side].is_number() == range[side].is_number());
    }
  }
}

TEST_CASE("every method shows the multipliers of least norm, where rows are one but for rounding too") {
  // In a hoop, r = R at a = π: -r cos(a) >= R is r >= R, but for an entry of 1e-16.
  const Folder folder;
  const std::string hoop = folder.write(
      "hoop.toml",
      "[system]\ncoordinates = [\"r\", \"a\"]\nkinetic = \"r'^2 + r^2*a'^2 + 4*r^2*sin(a)^2\"\n"
      "potential = \"-19.62*r*cos(a)\"\n[system.constraints]\nhoopin = \"r <= 1\"\nhoopout = \"r >= 1\"\n"
      "low = \"-r*cos(a) >= 1\"\n[state]\nposition = { r = 1, a = \"pi\" }\n");
  for (const convex::Method& method : convex::methods()) {
    if (method.name == "drop-negative") continue;  // the rule that Delassus refuted
    CAPTURE(method.name);
    const Json answer = Json::parse(run({"solve", "--json", "--method", std::string(method.name), hoop}).out);
    for (const char* contact : {"hoopout", "low"})
      CHECK(answer["multipliers"][contact].get<double>() == doctest::Approx(9.81).epsilon(1e-9));
    CHECK(answer["multiplier_ranges"]["low"][1].is_null() == false);
  }
}

TEST_CASE("forces that balance as written, though not in doubles, neither open a contact nor press on it") {
  const Folder folder;
  for (const char* force : {"8/5*p - 12/5", "12/5 - 8/5*p", "0.1 + 0.2*p - 0.4"}) {
    CAPTURE(force);
    const std::string file = folder.write(
        "balance.toml",
        std::string("[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.parameters]\np = 1.5\n"
                    "[system.forces]\nx = \"") +
            force + "\"\n[system.constraints]\nwall = \"x >= 0\"\n[state]\nposition = { x = 0 }\n");
    const Json answer = Json::parse(run({"solve", "--json", file}).out);
    CHECK(answer["status"] == "solved");
    CHECK(answer["acceleration"]["x"] == 0);
    CHECK(answer["constraints"]["wall"]["state"] == "touches");
  }
}

TEST_CASE("at a knot of a table that its argument meets as written, though not in doubles, nothing is open") {
  // sin(pi/6) is 1/2, and less in doubles; the spline of the table passes through (1/2, 3/2) smoothly.
  const Folder folder;
  const auto answer = [&](const std::string& force) {
    return Json::parse(
        run({"solve", "--json",
             folder.write("a.toml",
                          "[system]\ncoordinates = [\"a\", \"x\"]\nkinetic = \"(a'^2 + x'^2)/2\"\n"
                          "[system.forces]\nx = \"" +
                              force + "\"\n[state]\nposition = { a = \"pi/6\", x = 0 }\n")})
            .out);
  };
  const Json smooth = answer("table(sin(a), [-2, 0.5, 1, 3], [2, 1.5, -1, 3])");
  CHECK(smooth["status"] == "solved");
  CHECK(std::abs(smooth["acceleration"]["x"].get<double>() - 1.5) <= 1e-15);
  CHECK(smooth["certificate"]["error_bound"].get<double>() <= 1e-14);
  // Where the branches differ, the one of the doubles is not told to be the answer.
  const Json jump = answer("if(sin(a) >= 0.5, 10, -10)");
  CHECK((jump["acceleration"]["x"] == 10 || jump["status"] == "inaccurate"));
}

TEST_CASE("contacts whose gradients are one as written share a force, whatever masses are coupled") {
  // A rod stands upright on a lift, each below a ceiling: cos(pi/2) = 0, but 6e-17 in doubles.
  const Folder folder;
  for (const int force : {1, -1}) {
    CAPTURE(force);
    const std::string file =
        folder.write("lift.toml",
                     "[system]\ncoordinates = [\"y\", \"a\", \"b\"]\n"
                     "kinetic = \"y'^2/2 + (y' + b')^2/2 + (b' + a')^2/2 + a'^2/2\"\n[system.forces]\ny = " +
                         std::to_string(force) +
                         "\n[system.constraints]\nlift = \"y <= 0\"\ntip = \"y + sin(a) <= 1\"\n[state]\n"
                         "position = { y = 0, a = \"pi/2\", b = 0 }\n");
    const Json answer = Json::parse(run({"solve", "--json", file}).out);
    REQUIRE(answer["status"] == "solved");
    const double half = force / 2.0;
    for (const char* name : {"lift", "tip"}) {
      CAPTURE(name);
      CHECK(answer["constraints"][name]["state"] == (force > 0 ? "persists" : "opens"));
      CHECK(answer["two_sided"]["multipliers"][name].get<double>() == doctest::Approx(half).epsilon(1e-12));
    }
    CHECK(answer["hypothesis"]["accepted"] == (force > 0));
    CHECK(answer["multipliers_unique"] == (force < 0));
    CHECK(run({"check", file}).code == 0);
  }
}

TEST_CASE("a slack that rounding hides moves the acceleration by itself over what its gradient leaves") {
  // -y'' >= 11 and 1e-6 x'' + y'' >= -11 + 1e-6 + 8e-16: x'' = 1 + 8e-10.
  const Folder folder;
  // Where fractions do not tell, the bound counts it.
  const std::string irrational = folder.write(
      "irrational.toml",
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + cos(0.3)*y'^2)/2\"\n[system.forces]\nx = "
      "1\n"
      "y = -10\n[system.constraints]\na = \"-y >= 11*t^2/2\"\n"
      "b = \"1e-6*x + y >= (-11 + 1e-6 + 8e-16)*t^2/2\"\n[state]\nposition = { x = 0, y = 0 }\n");
  const Json open = Json::parse(run({"solve", "--json", irrational}).out);
  CHECK(std::abs(open["acceleration"]["x"].get<double>() - (1 + 8e-10)) <=
        open["certificate"]["error_bound"].get<double>() + 1e-15);
  const std::string file = folder.write(
      "hidden.toml",
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n[system.forces]\nx = 1\n"
      "y = -10\n[system.constraints]\na = \"-y >= 11*t^2/2\"\n"
      "b = \"1e-6*x + y >= (-11 + 1e-6 + 8e-16)*t^2/2\"\n[state]\nposition = { x = 0, y = 0 }\n");
  const Json answer = Json::parse(run({"solve", "--json", file}).out);
  REQUIRE(answer["status"] == "solved");
  const double off = std::abs(answer["acceleration"]["x"].get<double>() - (1 + 8e-10));
  CHECK(off <= answer["certificate"]["error_bound"].get<double>() + 1e-15);
  CHECK(off <= 1e-15);
  CHECK(answer["constraints"]["b"]["state"] == "persists");
}

TEST_CASE("contacts that press or open by less than the error touch, where no fractions decide it") {
  // A block is held on an incline by a force that is its weight's part along it, at an irrational angle.
  const Folder folder;
  const std::string file =
      folder.write("incline.toml",
                   "[system]\ncoordinates = [\"x\", \"s\"]\n"
                   "kinetic = \"0.75*x'^2 + 1/2*((x' + s'*cos(al))^2 + (s'*sin(al))^2)\"\n"
                   "potential = \"9.81*s*sin(al)\"\n[system.parameters]\nal = \"pi/6\"\n[system.forces]\n"
                   "s = \"9.81*tan(al)*cos(al)\"\n[system.constraints]\nlow = \"s >= 0\"\nstop = \"x <= 0\"\n"
                   "again = \"2*s >= 0\"\n[state]\nposition = { x = 0, s = 0 }\n");
  const Json answer = Json::parse(run({"solve", "--json", file}).out);
  REQUIRE(answer["status"] == "solved");
  for (const char* name : {"low", "stop", "again"}) CHECK(answer["constraints"][name]["state"] == "touches");
  CHECK(answer["hypothesis"]["accepted"] == true);
}

TEST_CASE("a condition that no coordinate has a part in is decided as written") {
  const Folder folder;
  const std::pair<const char*, int> conditions[] = {{"1/3 > 0.3333333333333333", 1},
                                                    {"sin(pi) > 0", -1},
                                                    {"pi > 3.141592653589793", 1},
                                                    {"a + b > 0.3", -1},
                                                    {"a + b >= 0.3", 1},
                                                    {"sqrt(2)*sqrt(2) > 2", -1},
                                                    {"3*5 - 14 > 0", 1}};
  for (const auto& [condition, force] : conditions) {
    CAPTURE(condition);
    const std::string file =
        folder.write("condition.toml",
                     "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\n[system.parameters]\n"
                     "a = 0.1\nb = 0.2\n[system.forces]\ny = \"if(" +
                         std::string(condition) + ", 1, -1)\"\n[state]\nposition = { y = 0 }\n");
    for (const bool certify : {false, true}) {
      const Outcome outcome =
          certify ? run({"solve", "--json", "--certify", file}) : run({"solve", "--json", file});
      CHECK(Json::parse(outcome.out)["acceleration"]["y"] == force);
    }
  }
}

TEST_CASE("a light contact is not weighed against a press that nothing couples to it") {
  const Folder folder;
  const std::string file = folder.write(
      "press.toml",
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n[system.forces]\nx = -3\n"
      "y = \"-1e12\"\n[system.constraints]\na = \"x >= 0\"\nb = \"cos(0.7)*x >= 0\"\n"
      "press = \"y >= 0\"\n[state]\nposition = { x = 0, y = 0 }\n");
  const Json answer = Json::parse(run({"solve", "--json", file}).out);
  CHECK(answer["multipliers_unique"] == false);
  for (const char* contact : {"a", "b"}) CHECK(answer["constraints"][contact]["state"] == "persists");
  CHECK(answer["multiplier_ranges"]["a"][1].get<double>() == doctest::Approx(3));
}

TEST_CASE("no law fails by a multiplier that was taken for 0 where all forces are rounding") {
  const Folder folder;
  const std::string file =
      folder.write("rest.toml",
                   "[system]\ncoordinates = [\"a\", \"b\"]\n"
                   "kinetic = \"((sin(a) + sin(b))'^2 + (cos(a) + cos(b))'^2)/2\"\n"
                   "potential = \"1/2*(a - atan(2))^2 + cos(2*b)\"\n[system.constraints]\n"
                   "c0 = \"-9*a - b >= -9*atan(2) - pi/2\"\nc1 = \"sin(2*a) = sin(2*atan(2))\"\n[state]\n"
                   "position = { a = \"atan(2)\", b = \"pi/2\" }\n");
  CHECK(run({"check", file}).code == 0);
}

TEST_CASE("a condition in a state is decided as written, of what the state gives too") {
  const Folder folder;
  const auto y2 = [&](const std::string& state) {
    const std::string file =
        folder.write("state.toml",
                     "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
                     "[system.forces]\ny = \"y' + 10*y + 100*t\"\n[state]\n" +
                         state);
    return Json::parse(run({"solve", "--json", file}).out)["acceleration"]["y"].get<double>();
  };
  const std::string at_rest = "position = { x = \"0.1 + 0.2\", y = 0 }\n";
  CHECK(y2(at_rest + "velocity = { y = \"if(0.1 + 0.2 > 0.3, 5, 1)\" }\n") == 1);
  CHECK(y2(at_rest + "velocity = { y = \"if(x > 0.3, 5, 1)\" }\n") == 1);
  CHECK(y2(at_rest + "t = \"step(0.3 - 0.1 - 0.2)\"\n") == 100);
  CHECK(y2("t = \"0.1 + 0.2 - 0.3\"\nposition = { x = 0, y = \"if(t <= 0, 1, sign(t))\" }\n") ==
        doctest::Approx(10).epsilon(1e-14));
}

TEST_CASE("a gradient that cancels as written is 0, whatever terms it is the sum of") {
  const Folder folder;
  for (const char* ceiling : {"sin(a) + cos(a) <= sqrt(2)", "sin(a)*cos(a) <= 1/2",
                              "sin(a)*sqrt(2) - a <= 1 - pi/4", "sin(2*a) <= 1"}) {
    CAPTURE(ceiling);
    const std::string file =
        folder.write("ceiling.toml",
                     "[system]\ncoordinates = [\"a\"]\nkinetic = \"a'^2/2\"\n[system.forces]\na = 1\n"
                     "[system.constraints]\nceiling = \"" +
                         std::string(ceiling) + "\"\n[state]\nposition = { a = \"pi/4\" }\n");
    const Outcome outcome = run({"solve", "--json", file});
    CHECK(outcome.code == 0);
    CHECK(Json::parse(outcome.out)["acceleration"]["a"] == 1);
  }
}

TEST_CASE(
    "what is within the rounding of z or s presses and opens nothing, proved or not, and no law fails") {
  const Folder folder;
  // s = 0.3 - (0.1 + 0.2) is 0, not 1.1e-16, and the masses are irrational: x'' = 0.
  const std::string rest = folder.write(
      "rest.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2 + cos(0.7)*x'^2\"\n[system.constraints]\n"
      "a = \"x >= 0.3*t^2 - (0.1 + 0.2)*t^2\"\nb = \"x <= 0\"\n[state]\nposition = { x = 0 }\n");
  CHECK(run({"check", rest}).code == 0);
  CHECK(Json::parse(run({"solve", "--json", rest}).out)["hypothesis"]["accepted"] == true);
  // Three contacts leave x0 = x1 = 0 alone.
  const std::string held = folder.write(
      "held.toml",
      "[system]\ncoordinates = [\"x0\", \"x1\"]\nkinetic = \"x1'^2 + cos(0.7)*x0'^2\"\n[system.forces]\n"
      "x1 = -9.81\n[system.constraints]\nc0 = \"-2*x1 >= 0.3*t^2 - (0.1 + 0.2)*t^2\"\n"
      "c3 = \"1000*(3*x0 + (1/2)*x1) >= 0\"\n"
      "close = \"(1/2)*x1 - (3/2)*x0 - (1/2)*x1 >= 0.3*t^2 - (0.1 + 0.2)*t^2\"\n[state]\n"
      "position = { x0 = 0, x1 = 0 }\n");
  // A slack of 6e-12 that is all its own terms, proved to 2e-29.
  const std::string light = folder.write(
      "light.toml",
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"4.15*(x' + sqrt(2)*y')^2 + 3.05*y'^2\"\n"
      "[system.forces]\nx = 1e-10\ny = -50\n[system.constraints]\nc5 = \"tan(pi/7)*x >= 0\"\nc8 = \"y = 0\"\n"
      "[state]\nposition = { x = 0, y = 0 }\n");
  for (const bool certify : {false, true}) {
    CAPTURE(certify);
    const auto state = [&](const std::string& file, const char* contact) {
      const Outcome outcome =
          certify ? run({"solve", "--json", "--certify", file}) : run({"solve", "--json", file});
      return Json::parse(outcome.out)["constraints"][contact]["state"].get<std::string>();
    };
    CHECK(state(held, "c0") != "opens");
    CHECK(state(light, "c5") == "opens");
  }
}
