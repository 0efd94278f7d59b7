#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

Json solved(const std::string& text) { return Json::parse(run_json_on("solve", text).out); }

std::string digits(double x) {
  std::string text(32, '\0');
  text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.6g", x)));
  return text;
}

std::string string_pendulum(double angle, double speed, const std::string& more = "") {
  return "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"9.81*y\"\n"
         "constraints = { string = \"sqrt(x^2 + y^2) <= 2\" }\n[state]\nposition = { x = " +
         digits(2 * std::sin(angle)) + ", y = " + digits(-2 * std::cos(angle)) +
         " }\nvelocity = { x = " + digits(2 * speed * std::cos(angle)) +
         ", y = " + digits(2 * speed * std::sin(angle)) + " }\n" + more;
}

std::string particle(const std::string& constraints, const std::string& velocity,
                     const std::string& potential = "9.81*y") {
  return "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"" + potential +
         "\"\nconstraints = { " + constraints + " }\n[state]\nposition = { x = 0, y = 0 }\nvelocity = { " +
         velocity + " }\n";
}

const std::string crossing = particle("wires = \"y^2 = x^2\"", "x = 1, y = 1");

}  // namespace

TEST_CASE("no string typed with six digits falls free in silence") {
  int warned = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double angle = 0.02 * trial - 0.55, speed = 0.3 + 0.025 * trial;
    CAPTURE(angle);
    const Outcome outcome = run_json_on("solve", string_pendulum(angle, speed));
    const Json object = Json::parse(outcome.out);
    if (outcome.code == 2) {  // penetrated, or an impact is due
      CHECK(object.at("status") == "error");
      continue;
    }
    const double tension = speed * speed * 2 + 9.81 * std::cos(angle);
    const double x2 = object.at("acceleration").at("x");
    const bool taut = std::abs(x2 + tension * std::sin(angle)) <= 1e-4;
    if (taut) continue;
    REQUIRE(object.at("warnings").size() == 1);
    CHECK(object.at("warnings")[0].at("kind") == "near-contact");
    CHECK(object.at("warnings")[0].at("constraints") == Json{"string"});
    CHECK(outcome.err.find("moreau: warning: ") == 0);
    CHECK(outcome.err.find("contact_tolerance") != std::string::npos);
    ++warned;
  }
  CHECK(warned >= 10);
}

TEST_CASE("the tolerance that a warning names makes the contact one") {
  int tried = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const double angle = 0.031 * trial + 0.2;
    const Json object = solved(string_pendulum(angle, 0.4));
    if (object.at("status") == "error" || object.at("warnings").empty()) continue;
    const std::string message = object.at("warnings")[0].at("message");
    const std::string key = "contact_tolerance = ";
    const std::string named = message.substr(message.find(key) + key.size(), 4);
    const Json again = solved(string_pendulum(angle, 0.4, "[solve]\ncontact_tolerance = " + named + "\n"));
    CHECK(again.at("warnings").empty());
    CHECK(again.at("constraints").at("string").at("state") == "persists");
    ++tried;
  }
  CHECK(tried >= 3);
}

TEST_CASE("what is far, leaves, or is pushed apart is near no contact") {
  const auto quiet = [](const std::string& position, const std::string& velocity, const std::string& force) {
    const Json object =
        solved("[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\nforces = { y = " + force +
               " }\nconstraints = { floor = \"y >= 0\" }\n[state]\nposition = { y = " + position +
               " }\nvelocity = { y = " + velocity + " }\n");
    return object.at("warnings").empty();
  };
  CHECK_FALSE(quiet("1e-5", "0", "-1"));
  CHECK_FALSE(quiet("0", "1e-5", "-1"));
  CHECK_FALSE(quiet("1e-5", "-9e-5", "-1"));
  CHECK(quiet("2e-4", "0", "-1"));
  CHECK(quiet("1e-5", "2e-4", "-1"));
  CHECK(quiet("1e-5", "0", "1"));
  CHECK(quiet("1e-5", "0", "0"));
  CHECK(quiet("0", "0", "-1"));
}

TEST_CASE("a contact without a force touches, is active, and is said to be undecided") {
  const std::string floor =
      "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\nforces = { y = \"t\" }\nconstraints = { floor "
      "= \"y "
      ">= 0\" }\n[state]\nposition = { y = 0 }\n";
  const Outcome outcome = run_json_on("solve", floor);
  const Json object = Json::parse(outcome.out);
  CHECK(outcome.code == 0);
  CHECK(object.at("constraints").at("floor").at("state") == "touches");
  CHECK(object.at("active") == Json{"floor"});
  REQUIRE(object.at("warnings").size() == 1);
  CHECK(object.at("warnings")[0].at("kind") == "undecided");
  CHECK(object.at("warnings")[0].at("constraints") == Json{"floor"});
  CHECK(run_on("solve", floor).out.find("floor: neither presses nor opens to second order") !=
        std::string::npos);
  CHECK(run_on("solve", floor).err.find("moreau: warning: ") == 0);
  CHECK(run_on("solve", floor).err.find(": undecided: floor") != std::string::npos);
}

TEST_CASE("a contact that some multipliers load persists, one that none can load touches") {
  // The same floor twice may carry the weight in any shares; a wall that is only met may not.
  const Json object = solved(
      particle(R"(floor = "y >= 0", twin = "2*y >= 0", wall = "x >= 0", slope = "x + y >= 0")", "x = 0"));
  CHECK(object.at("multipliers_unique") == false);
  const Json& states = object.at("constraints");
  CHECK(states.at("floor").at("state") == "persists");
  CHECK(states.at("twin").at("state") == "persists");
  CHECK(states.at("wall").at("state") == "touches");
  CHECK(states.at("slope").at("state") == "touches");
  CHECK(object.at("active") == Json{"floor", "twin", "wall", "slope"});
  const Json loaded =
      solved(particle(R"(floor = "y >= 0", wall = "x >= 0", slope = "x + y >= 0")", "x = 0", "9.81*y + x"));
  for (const char* name : {"floor", "wall", "slope"})
    CHECK(loaded.at("constraints").at(name).at("state") == "persists");
}

TEST_CASE("a block in a tight slot may be clamped: the side that need not press persists all the same") {
  const Json object = solved(particle(R"(left = "x >= 0", right = "x <= 0")", "y = 1", "x"));
  CHECK(object.at("multipliers").at("right") == 0);
  for (const char* side : {"left", "right"})
    CHECK(object.at("constraints").at(side).at("state") == "persists");
  CHECK(object.at("warnings").empty());
}

TEST_CASE("an equation of third derivatives is told with its weights, and in text") {
  const Outcome outcome = run_json_on("solve", crossing);
  const Json object = Json::parse(outcome.out);
  CHECK(outcome.code == 0);
  CHECK(object.at("status") == "solved");
  CHECK(object.at("acceleration").at("x").get<double>() == doctest::Approx(-9.81 / 2));
  CHECK(object.at("multipliers").at("wires").is_null());
  CHECK(object.at("multiplier_ranges").at("wires").is_null());
  CHECK(object.at("active") == Json{"wires"});
  REQUIRE(object.at("added_rows").size() == 1);
  const Json& row = object.at("added_rows")[0];
  CHECK(row.at("weights") == Json{{"wires", 1}});
  CHECK(row.at("row") == Json{{"x", -6}, {"y", 6}});
  CHECK(row.at("rhs") == 0);
  for (const char* x : {"x", "y"})  // R = multiplier · row
    CHECK(object.at("reaction").at(x).get<double>() ==
          doctest::Approx(row.at("multiplier").get<double>() * row.at("row").at(x).get<double>()));
  CHECK(object.at("residuals").at("stationarity").get<double>() <= 1e-15);
  CHECK(object.at("warnings")[0].at("kind") == "singular");
  const std::string text = run_on("solve", crossing).out;
  CHECK(text.find("-6 x'' and 6 y''") != std::string::npos);
  CHECK(outcome.err.find("moreau: warning: ") == 0);
  CHECK(outcome.err.find(": singular: wires") != std::string::npos);
}

TEST_CASE("an equation of third derivatives is proved by no certificate, and the laws hold with it") {
  const Folder folder;
  const std::string file = folder.write("crossing.toml", crossing);
  const Outcome certified = run({"solve", "--json", "--certify", file});
  CHECK(certified.code == 3);
  CHECK(Json::parse(certified.out).at("certificate").at("level") == "none");
  const Outcome by_fractions = run({"solve", "--json", "--method", "exact", file});
  CHECK(by_fractions.code == 0);
  CHECK(Json::parse(by_fractions.out).at("certificate").at("level") == "none");
  CHECK(Json::parse(by_fractions.out).at("exact").at("acceleration").at("x") ==
        "-5522539043063071/1125899906842624");
  const Outcome checked = run({"check", "--json", file});
  CHECK(checked.code == 0);
  CHECK(Json::parse(checked.out).at("added_rows").size() == 1);
  for (const char* option : {"--sensitivity", "--null-space", "--ranges"})
    CHECK(run({"solve", "--json", option, file}).code == 0);
  CHECK(run({"solve", "--sensitivity", file}).code == 0);
}

TEST_CASE("a constraint that is held to linear equations is told once, and not as one of third derivatives") {
  const std::string point = particle("point = \"x^2 + y^2 = 0\"", "x = 0");
  const Json object = solved(point);
  CHECK(object.at("added_rows").size() == 2);
  REQUIRE(object.at("warnings").size() == 1);
  CHECK(object.at("warnings")[0].at("message").get<std::string>().find("vanishes wherever it holds") !=
        std::string::npos);
  const std::string text = run_on("solve", point).out;
  CHECK(text.find("In place of point") != std::string::npos);
  CHECK(text.find("third ones") == std::string::npos);
}

TEST_CASE("a state with several branches is wrong input, at the line of the constraint") {
  const Outcome outcome = run_json_on("solve", particle("wires = \"y^2 = x^2\"", "x = 0"));
  CHECK(outcome.code == 2);
  const Json object = Json::parse(outcome.out);
  CHECK(object.at("status") == "error");
  CHECK(object.at("line") == 5);
  CHECK(object.at("message").get<std::string>().find("several branches; give a velocity or move off it") !=
        std::string::npos);
}

TEST_CASE("one-sided contacts that third derivatives exclude make a problem without a solution") {
  // Along y = x gravity pulls down; a lid over x and a floor that rises under y exclude each other there.
  const Json object =
      solved(particle(R"(wires = "y^2 = x^2", lid = "x <= t", floor = "y >= t + t^2")", "x = 1, y = 1"));
  CHECK(object.at("status") == "infeasible");
  const Json& farkas = object.at("farkas");
  REQUIRE(object.at("added_rows").size() == 1);
  const Json& row = object.at("added_rows")[0];
  const double w = row.at("multiplier");
  // The weights cancel the accelerations: lid is -x, floor is y.
  CHECK(-farkas.at("lid").get<double>() + w * row.at("row").at("x").get<double>() == doctest::Approx(0));
  CHECK(farkas.at("floor").get<double>() + w * row.at("row").at("y").get<double>() == doctest::Approx(0));
  CHECK(farkas.at("floor").get<double>() > 0);
}

TEST_CASE("an ordinary answer has no warning, and numbers alone leave nothing to higher derivatives") {
  CHECK(solved(point_on_floor()).at("warnings") == Json::array());
  const Json numbers = solved(two_rows());
  CHECK(numbers.at("warnings") == Json::array());
  CHECK(numbers.at("constraints").at("c[1]").at("state") == "touches");
  CHECK(run_on("solve", point_on_floor()).err.empty());
}

TEST_CASE("a contact whose gradient vanishes and that the answer would violate leaves nothing known of it") {
  const Outcome falls = run_json_on("solve", particle("floor = \"y^3 >= 0\"", "x = 1"));
  const Json object = Json::parse(falls.out);
  CHECK(falls.code == 3);
  CHECK(object.at("status") == "inaccurate");
  CHECK(object.at("certificate").at("error_bound") == "inf");
  REQUIRE(object.at("warnings").size() == 1);
  CHECK(object.at("warnings")[0].at("constraints") == Json{"floor"});
  // y^2 >= 0 asks for nothing.
  const Outcome free = run_json_on("solve", particle("floor = \"y^2 >= 0\"", "x = 1"));
  CHECK(free.code == 0);
  CHECK(Json::parse(free.out).at("warnings").empty());
}

TEST_CASE(
    "contacts whose gradients cancel and that forbid the acceleration together leave nothing known of it") {
  struct {
    const char *constraints, *x;
    bool is_forbidden;
  } const scenes[] = {
      // Between two circles that touch there is a point; beside them, a gap.
      {"a = \"x^2 + y^2 <= 1\"\nb = \"(x-2)^2 + y^2 <= 1\"", "1", true},
      {"a = \"x^2 + y^2 >= 1\"\nb = \"(x-2)^2 + y^2 >= 1\"", "1", false},
      // A wedge without a width, open to neither side, and to one.
      {"a = \"x >= 0\"\nb = \"x <= -y^2\"", "0", true},
      {"a = \"x >= 0\"\nb = \"x <= y^4\"", "0", false},
      {"a = \"x >= y^2\"\nb = \"x = 0\"", "0", true},
      // Three gradients that cancel: f_a + f_b + f_c = -3 y^2 / 2 leaves one point of the line x = 0.
      {"a = \"x >= y^2/2\"\nb = \"z - x >= y^2/2\"\nc = \"-z >= y^2/2\"", "0", true},
      {"a = \"x >= -y^2/2\"\nb = \"z - x >= y^2/2\"\nc = \"-z >= 0\"", "0", false},
      // No gradient cancels.
      {"a = \"x >= -y^2\"\nb = \"z >= y^2\"", "0", false},
  };
  for (const auto& scene : scenes) {
    CAPTURE(std::string(scene.constraints));
    const Outcome found = run_json_on("solve",
                                      "[system]\ncoordinates = [\"x\", \"y\", \"z\"]\n"
                                      "kinetic = \"(x'^2 + y'^2 + 3*z'^2)/2\"\npotential = \"9.81*y\"\n"
                                      "[system.constraints]\n" +
                                          std::string(scene.constraints) +
                                          "\n[state]\nposition = { x = " + scene.x + ", y = 0, z = 0 }\n");
    const Json object = Json::parse(found.out);
    CHECK(found.code == (scene.is_forbidden ? 3 : 0));
    CHECK((object.at("certificate").at("error_bound") == "inf") == scene.is_forbidden);
    const bool is_told = found.err.find("the gradients cancel here") != std::string::npos;
    CHECK(is_told == scene.is_forbidden);
  }
}

TEST_CASE("a gap that the contact tolerance closes is told, one that is rounding is not") {
  const auto above = [](const std::string& y) {
    return "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\npotential = \"9.81*y\"\n"
           "constraints = { floor = \"sqrt(y^2) >= sqrt(2)\" }\n[state]\nposition = { y = " +
           y + " }\n";
  };
  const Json gap = solved(above("\"sqrt(2) + 5e-10\""));
  CHECK(gap.at("active") == Json{"floor"});
  CHECK(gap.at("closed_by_tolerance") == Json{"floor"});
  const Outcome text = run_on("solve", above("\"sqrt(2) + 5e-10\""));
  CHECK(text.out.find("as written it is not") != std::string::npos);
  CHECK(text.out.find("for the mechanism as written") == std::string::npos);
  CHECK_FALSE(solved(above("\"2/sqrt(2)\"")).contains("closed_by_tolerance"));
}

TEST_CASE("on an edge between branches the answer is told to be that of the branch taken") {
  const std::string edge = particle("floor = \"y >= if(x > 0, -x, 0)\"", "x = 1", "y");
  CHECK(run_on("solve", edge).out.find("on the branch that is taken") != std::string::npos);
}

TEST_CASE(
    "a contact whose gradient vanishes is not taken as kept because higher derivatives may decide, or none "
    "does") {
  for (const std::string floor : {"y^3 >= x^2", "y^5 >= x^2", "y^7 >= 0", "y^3 >= x^2 + x^2*y",
                                  "y*abs(y)^3 >= 0", "x^2*y^2 <= y*abs(y)^3"}) {
    CAPTURE(floor);
    const Outcome falls = run_json_on("solve", particle("floor = \"" + floor + "\"", "x = 0"));
    CHECK(falls.code == 3);
    CHECK(Json::parse(falls.out).at("warnings").size() == 1);
    CHECK(run_json_on("check", particle("floor = \"" + floor + "\"", "x = 0")).code == 3);
  }
  for (const std::string nothing : {"0 >= 0", "x^2 >= 0", "x^4 + y^6 >= 0", "abs(y)^3 >= y^3"}) {
    CAPTURE(nothing);
    CHECK(run_json_on("solve", particle("floor = \"" + nothing + "\"", "x = 0")).code == 0);
  }
}

TEST_CASE("a contact without a gradient stands beside others") {
  const Json object = solved(particle("nothing = \"0 >= 0\", wall = \"x <= 0\"", "x = 0"));
  CHECK(object.at("acceleration").at("x") == 0);
}

TEST_CASE("a velocity on no branch of a singular position is told as what contradicts itself there") {
  const Outcome outcome = run_json_on("solve", pushing_at_dead_centre({{13, "b = 1"}}));
  CHECK(outcome.code == 1);
  CHECK(outcome.err.find("the velocity is on no branch") != std::string::npos);
}

TEST_CASE("a sweep leaves out the multipliers that solve does not give") {
  const Folder folder;
  const Outcome outcome = run({"sweep", folder.write("a.toml", pushing_at_dead_centre()), "--over",
                               "system.forces.a=1,2", "--watch", "lambda[coupler]"});
  CHECK(outcome.out.find("1,solved,coupler push,,") != std::string::npos);
}
