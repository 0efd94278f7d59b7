#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using OnsetJson = nlohmann::json;

namespace {

/// A liquid on (-1, 1), or another domain, pulled by F from both ends, or a rim, where p is given.
std::string pulled(const std::string& F, const std::string& pressure, const std::string& w,
                   const std::string& domain = "interval(low=-1, high=1)") {
  return "[liquid]\ncoordinates = [\"x\"]\ndomain = \"" + domain + "\"\ndensity = 1\nforce = [\"" + F +
         "\"]\nfree = { ends = { where = \"true\", pressure = \"" + pressure +
         "\" } }\n[liquid.parameters]\nw = " + w + "\n";
}

OnsetJson onset_of_w(const std::string& text) {
  const Folder folder;
  const Outcome outcome = run({"solve", "--json", "--onset", "w", folder.write("liquid.toml", text)});
  CAPTURE(text);
  CAPTURE(outcome.err);
  REQUIRE((outcome.code == 0 || outcome.code == 3));
  return OnsetJson::parse(outcome.out);
}

}  // namespace

TEST_CASE("the onset is the nearest value at which p passes 0, however near to the next it is") {
  // F = w x takes w/2 from the pressure at the ends; the pressure dips as a bell does, and rises again.
  struct Onset {
    std::string text;
    double value;
  };
  const double dip = std::sqrt(std::log(0.51 / 0.5));
  for (const Onset& one : {
           Onset{pulled("x", "1 - 0.51*exp(-((w - 2.3)/0.05)^2)", "2"), 2.3 - 0.05 * dip},
           Onset{pulled("x", "1 - 0.51*exp(-((w - 2.3)/0.05)^2)", "2.6"), 2.3 + 0.05 * dip},
           Onset{pulled("x", "1/2 - (w - 2)*(w + 3)", "-0.2"), 2},
           Onset{pulled("x", "1/2 - (w - 2)*(w + 3)", "-0.8"), -3},
           Onset{pulled("sin(w)*x", "0.4999", "0.1"), std::asin(0.9998)},
           Onset{pulled("0.1*x", "w", "1"), 0.05},  // below 0 it is no pressure
           Onset{pulled("if(w > 2, 2, 0.1)*x", "1/2", "1"), 2},
           Onset{pulled("x", "2", "0.3", "interval(low=-w, high=w)"), 2},
           Onset{pulled("x", "2", "0.3", "ball(center=w, radius=1.5 + w/10)"), 5},
       }) {
    const OnsetJson found = onset_of_w(one.text);
    CAPTURE(one.text);
    CHECK(found["onset_nearest"]["level"] == "intervals");
    const double error = std::abs(found["onset"]["w"].get<double>() - one.value);
    CHECK(error <= found["onset_error"].get<double>() + 1e-15);
    CHECK(error <= 1e-8);
  }
}

TEST_CASE("the onset is exact where the force has kinks, wherever they lie between the points of a rule") {
  // p = 1/2 + w k(x) with k = Σ A (x - c)²/2 over c < x is least at the wall, x = 1.9.
  for (int n = 0; n < 24; ++n) {
    const double first = std::fmod(0.1234 + 0.61803 * n, 1.7), second = std::fmod(0.05 + 0.41421 * n, 1.7);
    const std::string text =
        "[liquid]\ncoordinates = [\"x\"]\ndomain = \"interval(low=0, high=1.9)\"\ndensity = 1\nforce = "
        "[\"-w*(0.4*max(x - " +
        std::to_string(first) + ", 0) + 2.5*max(x - " + std::to_string(second) +
        ", 0))\"]\nfree = { left = { where = \"x <= 1\", pressure = 0.5 } }\nwalls = { right = { where = "
        "\"true\", acceleration = 0 } }\n[liquid.parameters]\nw = 20\n";
    const double a = 1.9 - std::stod(std::to_string(first)), b = 1.9 - std::stod(std::to_string(second)),
                 value = 0.5 / (0.2 * a * a + 1.25 * b * b);
    const OnsetJson found = onset_of_w(text);
    CAPTURE(text);
    CHECK(std::abs(found["onset"]["w"].get<double>() - value) <= 1e-11 * value);
  }
}

TEST_CASE("that a parameter has no onset is shown by intervals, or said to be known of samples") {
  const OnsetJson none = onset_of_w(pulled("sin(w)*x", "0.5001", "0.1")),
                  touches = onset_of_w(pulled("x", "1/2 + (w - 3)^2", "1"));
  CHECK(none["onset"].is_null());
  CHECK(none["onset_nearest"]["level"] == "intervals");
  CHECK(touches["onset"].is_null());
  CHECK(touches["onset_nearest"]["level"] == "samples");
  CHECK(touches["onset_nearest"]["from"].get<double>() == doctest::Approx(3).epsilon(1e-6));
}

TEST_CASE("on grids too a cavity that comes and goes between two values is found") {
  // The largest of the torsion function of the square (-1, 1)²: 0.294685413126 (Timoshenko and Goodier 1951).
  const auto square = [](const std::string& pressure) {
    return "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"box(low=[-1, -1], high=[1, 1])\"\ndensity = "
           "1\nforce = [\"x\", \"0\"]\nfree = { rim = { where = \"true\", pressure = \"" +
           pressure + "\" } }\ncells = 64\n[liquid.parameters]\nw = 1\n";
  };
  const OnsetJson found = onset_of_w(square("1 - 0.75*exp(-((w - 3.3)/0.02)^2)")),
                  none = onset_of_w(square("1 + w^2"));
  const double value = 3.3 - 0.02 * std::sqrt(std::log(0.75 / (1 - 0.294685413126)));
  CHECK(std::abs(found["onset"]["w"].get<double>() - value) <= found["onset_error"].get<double>());
  CHECK(none["onset"].is_null());
  CHECK(none["onset_nearest"]["level"] == "intervals");
}

TEST_CASE("x |x| has the derivative 2 |x|, also where |x| has none") {
  // p'' = 2 |x| and p = 1 at the ends.
  for (const std::string force : {"x*abs(x)", "-abs(x)*(-x)", "abs(x)*x + 3"}) {
    CAPTURE(force);
    const Folder folder;
    const Outcome outcome = run({"solve", "--json", "--probe", "x=0", "--probe", "x=1/2",
                                 folder.write("liquid.toml", pulled(force, "1", "1"))});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    const OnsetJson found = OnsetJson::parse(outcome.out);
    CHECK(std::abs(found["probes"][0]["p"].get<double>() - 2.0 / 3) <= 1e-12);
    CHECK(std::abs(found["probes"][1]["p"].get<double>() - (2.0 / 3 + 1.0 / 24)) <= 1e-12);
  }
}

TEST_CASE("what has no Taylor series at an end of the line, as x^(3/2), is solved and proved up to there") {
  // p'' = F' and p = 1 at the ends.
  struct Pulled {
    std::string force;
    double power;
  };
  for (const Pulled& one : {Pulled{"x^1.5", 1.5},
                            {"x*sqrt(x)", 1.5},
                            {"x^2*sqrt(x)", 2.5},
                            {"x^1.2", 1.2},
                            {"-(1 - x)^1.5", 1.5}}) {
    CAPTURE(one.force);
    const Folder folder;
    const Outcome outcome =
        run({"solve", "--json", "--certify", "--probe", "x=1/2",
             folder.write("liquid.toml", pulled(one.force, "1", "1", "interval(low=0, high=1)"))});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    const OnsetJson found = OnsetJson::parse(outcome.out);
    CHECK(found["certificate"]["level"] == "enclosure");
    const double bound = found["certificate"]["error_bound"].get<double>(), e = one.power + 1;
    CHECK(bound <= 1e-12);
    CHECK(std::abs(found["probes"][0]["p"].get<double>() - (1 + (std::pow(0.5, e) - 0.5) / e)) <=
          bound + 1e-15);
  }
}

TEST_CASE("beside a wall that parts p > 0 is told, however steeply it grows from the wall") {
  // The top parts up to a corner. Bilinear finite elements, 256² of them, give p = 0.0729 there.
  const std::string text = R"liquid([liquid]
coordinates = ["x", "y"]
domain = "box(low=[0, 0], high=[1, 1])"
density = 1
force = ["3.397 + 5.437*x - 5.079*y + 7.973*x*y - 4.894*x^2 + 2.734*y^2",
  "-6.531 + 4.124*x - 5.579*y + 3.305*x*y + 3.591*x^2 + 4.255*y^2"]
cells = 128
[liquid.free.bed]
where = "y <= 0"
pressure = "8.696 + 2.749*x - 1.172*x^2"
[liquid.walls.left]
where = "x <= 0"
acceleration = "4.169 + 5.492*x - 5.477*y - 2.77*x*y - 3.114*x^2 + 0.673*y^2"
[liquid.walls.right]
where = "x >= 1"
acceleration = "-2.128 + 6.299*x + 6.794*y - 2.941*x*y + 6.316*x^2 - 6.886*y^2"
[liquid.walls.top]
where = "true"
acceleration = "-6.45 + 2.642*x + 4.785*y + 5.106*x*y + 7.872*x^2 + 5.756*y^2"
)liquid";
  const Folder folder;
  const Outcome outcome =
      run({"solve", "--json", "--probe", "x=0.96875, y=0.984375", folder.write("liquid.toml", text)});
  CAPTURE(outcome.err);
  REQUIRE((outcome.code == 0 || outcome.code == 3));
  const OnsetJson probe = OnsetJson::parse(outcome.out)["probes"][0];
  CHECK(std::abs(probe["p"].get<double>() - 0.0729) <= 5e-4);
  CHECK(probe["growth"].get<double>() == 0);
}

TEST_CASE("a liquid that is all cavity is solved: p = 0, also proved") {
  // h = -1 - 3 x²/7 < 0, no pressure at the mouth, and a wall that leaves faster than the liquid follows.
  const Folder folder;
  const std::string file = folder.write(
      "cavity.toml",
      "[liquid]\ncoordinates = [\"x\"]\ndomain = \"interval(low=0, high=1)\"\ndensity = 1\nforce = "
      "[\"x + x^3/7\"]\nfree = { mouth = { where = \"x <= 0\", pressure = 0 } }\nwalls = { lid = { where = "
      "\"true\", acceleration = 3 } }\n");
  for (const bool is_proved : {false, true}) {
    std::vector<std::string> arguments{"solve", "--json", file};
    if (is_proved) arguments.push_back("--certify");
    const Outcome outcome = run(arguments);
    REQUIRE(outcome.code == 0);
    const OnsetJson found = OnsetJson::parse(outcome.out);
    CHECK(found["pressure"]["max"] == 0);
    CHECK(found["cavity"]["fraction"] == 1);
    CHECK(found["certificate"]["error_bound"].get<double>() <= 1e-14);
  }
}

TEST_CASE("a thin layer of force between the points at which loads are taken is found, or counted") {
  // A fan: p jumps by 5 sqrt(pi) across it, as it does in a thicker one. By the ends p(0) = p(1) = 1 its
  // slope elsewhere is less that jump, so that p(0.2) is 1 + 0.2 * 5 sqrt(pi) + O(width) without a cavity.
  const auto fan = [](const std::string& width) {
    return "[liquid]\ncoordinates = [\"x\"]\ndomain = \"interval(low=0, high=1)\"\ndensity = 1\nforce = "
           "[\"5/w*exp(-((x - 0.31)/w)^2)\"]\nfree = { ends = { where = \"true\", pressure = 9 } "
           "}\n[liquid.parameters]\nw = " +
           width + "\n";
  };
  const double jump = 5 * std::sqrt(std::acos(-1.0));
  for (const std::string width : {"1e-3", "1e-4", "1e-5"}) {
    CAPTURE(width);
    const Folder folder;
    const Outcome outcome =
        run({"solve", "--json", "--certify", "--probe", "x=0.2", folder.write("fan.toml", fan(width))});
    const OnsetJson found = OnsetJson::parse(outcome.out);
    const double bound = found["certificate"]["error_bound"].get<double>();
    CHECK(found["certificate"]["level"] == "enclosure");
    CHECK(bound <= 1e-3);
    CHECK(std::abs(found["probes"][0]["p"].get<double>() - (9 - 0.2 * jump)) <= bound + 1e-12);
  }
  const Folder folder;
  const std::string disc =
      "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"disc(center=[0, 0], radius=1)\"\ndensity = "
      "1\nforce = "
      "[\"-40*exp(-((x - 0.3)/0.0004)^2)\", \"0\"]\nfree = { rim = { where = \"true\", pressure = 0.3 } "
      "}\ncells = "
      "64\n";
  const Outcome outcome = run({"solve", "--json", folder.write("disc.toml", disc)});
  CHECK(outcome.code == 3);
  CHECK(OnsetJson::parse(outcome.out)["certificate"]["error_bound"].get<double>() >= 1.4e-2);
}

namespace {

/// Under a pressure that is linear, from the left, in a tank whose walls meet between the nodes of any grid.
std::string tank(const std::string& vertices, const std::string& pressure, const std::string& a) {
  return "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"polygon(vertices=" + vertices +
         ")\"\ndensity = 1000\nforce = [\"a\", \"-9.81\"]\nfree = { mouth = { where = \"x <= 0\", pressure = "
         "\"" +
         pressure +
         "\" } }\nwalls = { rest = { where = \"true\", acceleration = \"0\" } }\n[liquid.parameters]\na = " +
         a + "\n";
}

}  // namespace

TEST_CASE("a liquid parts first at a corner of walls, between the nodes of a grid") {
  // p = 12000 - 9810 y + 1000 a x, least at the corner.
  struct Corner {
    const char* vertices;
    double x, y;
  };
  const Folder folder;
  for (const Corner& one : {Corner{"[[0,0],[3,0],[3,0.61],[0,1]]", 3, 0.61},
                            {"[[0,0],[2.9,0],[2.9,0.77],[0,1]]", 2.9, 0.77},
                            {"[[0,0],[2.2,0.1],[2.3,0.83],[0,1.1]]", 2.3, 0.83}}) {
    CAPTURE(std::string(one.vertices));
    const double value = -(12000 - 9810 * one.y) / (1000 * one.x);
    const std::string file = folder.write("tank.toml", tank(one.vertices, "12000 - 9810*y", "0"));
    const OnsetJson found = OnsetJson::parse(run({"solve", "--json", "--onset", "a", file}).out);
    const double error = std::abs(found["onset"]["a"].get<double>() - value);
    CHECK(error <= found["onset_error"].get<double>());
    CHECK(error <= 1e-6);
    // Beyond it the wall parts, by less than a cell: p there is off by no more than what is told.
    const double beyond = value * (1 + 1e-4), lacks = 1000 * one.x * std::abs(value) * 1e-4;
    const OnsetJson parted =
        OnsetJson::parse(run({"solve", "--json", "--set", "a=" + std::to_string(beyond), file}).out);
    CHECK(parted["parted_walls"] == OnsetJson::array({"rest"}));
    CHECK(parted["certificate"]["error_bound"].get<double>() >= 0.9 * lacks);
    const OnsetJson whole = OnsetJson::parse(
        run({"solve", "--json", "--set", "a=" + std::to_string(value * (1 - 1e-4)), file}).out);
    CHECK(whole["parted_walls"].empty());
  }
}

TEST_CASE("p is largest at a corner of walls, between the nodes of a grid") {
  const Folder folder;
  const std::string file =
      folder.write("tank.toml", tank("[[0,0],[3,0.13],[3,0.61],[0,1]]", "12000 - 9810*y", "2"));
  const OnsetJson found = OnsetJson::parse(run({"solve", "--json", file}).out);
  CHECK(found["pressure"]["max"].get<double>() == doctest::Approx(12000 - 9810 * 0.13 + 6000).epsilon(1e-9));
  CHECK(found["pressure"]["at"]["x"].get<double>() == doctest::Approx(3));
}

TEST_CASE("a closed tank at rest parts nowhere, and its least pressure is at a corner of its walls") {
  const Folder folder;
  const std::string file = folder.write(
      "closed.toml",
      "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = "
      "\"polygon(vertices=[[0,0],[3,0],[2.9,0.61],[0.2,1.03]])\"\ndensity = "
      "1000\nforce = [\"0\", \"-9.81\"]\nwalls = { rest = { where = \"true\", acceleration = \"0\" } }\n");
  const OnsetJson found = OnsetJson::parse(run({"solve", "--json", file}).out);
  CHECK(found["parted_walls"].empty());
  CHECK(found["pressure"]["max"].get<double>() == doctest::Approx(9810 * 1.03).epsilon(1e-6));
}

TEST_CASE("the largest pressure beside a corner of walls is that of the corner") {
  // A hexagon made so that p = c + 0.727 x + 0.869 y; a node beside the corner told of a place beyond it.
  const Folder folder;
  const std::string file = folder.write("hexagon.toml", R"toml([liquid]
coordinates = ["x", "y"]
domain = "polygon(vertices=[[0.5535, 0.7859], [-0.372, 0.7472], [-0.9803, 0.0535], [-0.5002, -0.7084], [0.4182, -0.9664], [1.0143, -0.058]])"
density = 1
force = ["-0.232", "0.691"]
[liquid.free]
top = { where = "-0.2704541354525622*x + -0.9627328604636943*y >= 0.8172811169058527", pressure = "1.029245 + 0.727*x + 0.869*y" }
[liquid.walls]
w0 = { where = "-0.041778725619634846*x + 0.9991268878804129*y >= 0.7620892965547487", acceleration = "-0.13777878817348366" }
w1 = { where = "-0.7518712770924577*x + 0.6593099291557475*y >= 0.7723324941435687", acceleration = "0.6036873873419438" }
w2 = { where = "-0.84603993122593*x + -0.5331195314103806*y >= 0.8008510496503238", acceleration = "0.9062475706367146" }
w4 = { where = "0.8360637421025547*x + -0.5486323168949062*y >= 0.8798401279945258", acceleration = "-0.7041285762690566" }
w5 = { where = "0.8776808544481399*x + 0.47924557142991214*y >= 0.8624354475238134", acceleration = "-0.9270016511302904" }
)toml");
  const OnsetJson found = OnsetJson::parse(run({"solve", "--json", file}).out);
  const double at_corner = 1.029245 + 0.727 * 0.5535 + 0.869 * 0.7859;
  CHECK(std::abs(found["pressure"]["max"].get<double>() - at_corner) <= 1e-8);
}
