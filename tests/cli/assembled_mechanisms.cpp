#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

const char* const four_bar =
    "[system]\ncoordinates = [\"a\", \"b\", \"c\"]\nkinetic = \"a'^2 + b'^2 + c'^2\"\n[system.constraints]\n"
    "along = \"2*cos(a) + 5*cos(b) = 6 + 4*cos(c)\"\nacross = \"2*sin(a) + 5*sin(b) = 4*sin(c)\"\n[state]\n"
    "position = { a = 1.1, b = 0.54, c = 1.42 }\nvelocity = { a = 2.2, b = 0.3, c = 0.9 }\n";

/// Four slots; the pin, on the driver at r, stands in one of them with play on each side.
const char* const geneva_wheel =
    "[system]\ncoordinates = [\"a\", \"b\"]\nkinetic = \"0.01*a'^2 + 0.025*b'^2\"\n[system.parameters]\n"
    "d = 1.0\nr = \"d*sin(pi/4)\"\nplay = 1e-3\n[system.definitions]\nx = \"r*cos(a) - d\"\n"
    "y = \"r*sin(a)\"\n[system.constraints]\nleft = \"-x*sin(b) + y*cos(b) >= -play/2\"\n"
    "right = \"-x*sin(b) + y*cos(b) <= play/2\"\n[state]\nposition = { a = 0.33, b = 2.3 }\n"
    "velocity = { a = 2.2, b = -1.0 }\n";

const char* const cam =
    "[system]\ncoordinates = [\"phi\", \"y\"]\nkinetic = \"0.01*phi'^2 + 0.2*y'^2\"\n[system.definitions]\n"
    "lift = \"table(phi, [0, 0.5, 1, 1.5, 2, 2.5, 3], [0, 0.1, 0.35, 0.6, 0.7, 0.55, 0.2])\"\n"
    "[system.constraints]\nfollower = \"y >= 1 + lift\"\n[state]\nposition = { phi = 1.2, y = 1.6 }\n"
    "velocity = { phi = 10, y = 4 }\n";

Json assembled(const std::string& file, std::vector<std::string> more) {
  std::vector<std::string> arguments{"assemble", file, "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run(arguments);
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  Json answer = Json::parse(outcome.out);
  CHECK(double(answer.at("residual")) <= 1e-14);
  return answer;
}

}  // namespace

TEST_CASE(
    "where a position holds and no velocity does, it is told with its place and what excludes each other") {
  const Folder folder;
  const std::string walls = folder.write(
      "a.toml",
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"x'^2 + y'^2\"\n[system.constraints]\n"
      "floor = \"y >= sin(3*t)\"\nceiling = \"y <= -sin(3*t)\"\n[state]\nposition = { x = 0.5, y = 0 }\n");
  const Outcome closing = run({"assemble", walls});
  CHECK(closing.code == 1);
  CHECK(closing.out.find("No state was found: at x = 0.5, y = 0, t = 0 the constraints hold, but no velocity "
                         "keeps floor, ceiling together (df/dt). ") != std::string::npos);
  const Outcome held = run({"assemble", walls, "--hold", "y"});
  CHECK(held.code == 1);
  CHECK(held.out.find("with y = 0 held") != std::string::npos);
  CHECK(held.out.find("no velocity keeps floor") != std::string::npos);
  const Outcome moved = run({"assemble", folder.write("c.toml", cam)});
  CHECK(moved.out.find("In the kinetic metric the position moved by 0 and the velocity changed by ") !=
        std::string::npos);
}

TEST_CASE(
    "a four-bar, a Geneva wheel, a cam and a slider-crank with clearance close from guesses a tenth off") {
  constexpr double rounding = 1e-14;
  const Folder folder;
  const auto q = [](const Json& answer, const char* name) { return double(answer.at("position").at(name)); };
  const auto v = [](const Json& answer, const char* name) { return double(answer.at("velocity").at(name)); };

  const Json bar = assembled(folder.write("a.toml", four_bar), {"--hold", "a"});
  CHECK(q(bar, "a") == 1.1);
  CHECK(std::abs(2 * std::sin(1.1) + 5 * std::sin(q(bar, "b")) - 4 * std::sin(q(bar, "c"))) <= 4 * rounding);

  const Json wheel = assembled(folder.write("b.toml", geneva_wheel), {"--hold", "a", "--contact", "left"});
  const double x = std::sqrt(0.5) * std::cos(0.33) - 1, y = std::sqrt(0.5) * std::sin(0.33);
  // The pin is half the play from the middle of the slot.
  const double from_axis = std::hypot(x, y), angle = std::atan2(y, x);
  CHECK(q(wheel, "b") == doctest::Approx(angle + std::asin(0.0005 / from_axis)).epsilon(rounding));

  const Json follower = assembled(folder.write("c.toml", cam), {"--contact", "follower"});
  CHECK(v(follower, "y") / v(follower, "phi") > 0);  // it rises with the cam

  const std::string crank = tests::source_folder() + "docs/problems/slider_crank_clearance.toml";
  const Json slider =
      assembled(crank, {"--set", "position.p1=2.3", "--set", "position.p2=-0.48", "--set", "position.p3=0.02",
                        "--hold", "p1", "--contact", "corner3", "--contact", "corner4"});
  // Flat on the lower guide: l1 sin p1 + l2 sin p2 = -c.
  CHECK(std::abs(0.153 * std::sin(2.3) + 0.306 * std::sin(q(slider, "p2")) + 0.001) <= rounding);
  CHECK(std::abs(q(slider, "p3")) <= rounding);
}
